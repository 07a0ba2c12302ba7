//! Contact forces: the law of one axle with friction and lift-off, and the solve that couples all axles in a step.

use crate::lane::Lane;
use crate::vehicle::Axle;

/// Most sweeps of the coupled solve; two to four are usual.
const SWEEPS: usize = 200;

/// Change of a contact force, relative to the weight, at which it counts as found.
const SETTLED: f64 = 1e-13;

/// The force of one axle, as increment p = P − P_st over its static load.
///
/// With total shortening d and suspension shortening s since the static state, the tyre carries p = k_t (d − s), and the
/// suspension the same through its spring and the friction f: p = k_s s + f − f₀, |f| ≤ F (KTN73 Fig. 2, after
/// Veletsos and Huang). The wheel does not pull: p ≥ −P_st.
#[derive(Debug, Clone, Copy)]
pub struct Contact<L> {
    /// Static load [N].
    pub static_load: L,
    /// Tyre stiffness k_t [N/m].
    pub tyre: L,
    /// Suspension stiffness k_s [N/m].
    pub suspension: L,
    /// Both in series, the stiffness while sliding [N/m].
    pub series: L,
    /// Friction limit F [N].
    pub limit: L,
    /// Friction in the static state f₀ [N].
    pub initial: L,
}

impl<L: Lane> Contact<L> {
    /// Of an axle under its static load.
    pub fn new(axle: &Axle, static_load: f64) -> Self {
        Contact {
            static_load: L::splat(static_load),
            tyre: L::splat(axle.tyre_stiffness),
            suspension: L::splat(axle.suspension_stiffness),
            series: L::splat(axle.sliding_stiffness()),
            limit: L::splat(axle.friction.limit),
            initial: L::splat(axle.friction.initial),
        }
    }

    /// The increment p that solves p = law(u − S p) for suspension shortening `s` at the start of the step.
    ///
    /// The law rises with d and S ≥ 0, so the solution is unique: whichever branch its trial confirms.
    pub fn solve(&self, u: L, compliance: L, s: L) -> L {
        let one = L::splat(1.0);
        let mut p = self.tyre * (u - s) / (one + self.tyre * compliance);
        let friction = self.initial + p - self.suspension * s;
        let slips = self.limit.less(friction.magnitude());
        if L::any(slips) {
            // Sliding: p = k_t k_s/(k_t + k_s) (d + (±F − f₀)/k_s).
            let limit = L::select(friction.less(L::splat(0.0)), -self.limit, self.limit);
            let shortening = u + (limit - self.initial) / self.suspension;
            p = L::select(slips, self.series * shortening / (one + self.series * compliance), p);
        }
        p.larger(-self.static_load)
    }

    /// Suspension shortening and friction at the end of a step that ended with increment p.
    pub fn settle(&self, p: L, s: L) -> (L, L) {
        let trial = self.initial + p - self.suspension * s;
        let friction = trial.smaller(self.limit).larger(-self.limit);
        (s + (trial - friction) / self.suspension, friction)
    }
}

/// Solves p_k = law_k(u_k − Σ S_kj p_j) for all axles, starting from the p given; `compliance` is S by rows, and lanes
/// that are `frozen` keep their p.
///
/// One axle after the other with its own equation solved exactly (nonlinear Gauss–Seidel): the laws rise and S is
/// positive definite, so this is descent on a strictly convex energy and converges from anywhere, through slip and
/// lift-off alike. A lane that has settled is frozen, hence no sample depends on its neighbours. False if one did not.
pub fn solve<L: Lane>(
    contacts: &[Contact<L>],
    u: &[L],
    compliance: &[L],
    s: &[L],
    p: &mut [L],
    frozen: L::Mask,
) -> bool {
    let n = contacts.len();
    let weight = contacts.iter().fold(L::splat(0.0), |sum, c| sum + c.static_load);
    let tolerance = weight * L::splat(SETTLED);
    let mut done = frozen;
    for _ in 0..SWEEPS {
        let mut change = L::splat(0.0);
        for k in 0..n {
            let row = &compliance[k * n..(k + 1) * n];
            let mut others = u[k];
            for (j, (s, p)) in row.iter().zip(p.iter()).enumerate() {
                if j != k {
                    others = others - *s * *p;
                }
            }
            let next = L::select(done, p[k], contacts[k].solve(others, row[k], s[k]));
            change = change.larger((next - p[k]).magnitude());
            p[k] = next;
        }
        // A single axle is exact at once; a NaN never counts as settled.
        done = done | change.less(tolerance);
        if n == 1 || L::all(done) {
            return true;
        }
    }
    false
}
