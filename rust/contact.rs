//! Contact forces: the law of one axle with friction and lift-off, and the solve that couples all axles in a step.

use crate::assembly::{ContactLaw, ContactPoint, FrictionElement};
use crate::friction::{Law, Stroke};
use crate::lane::Lane;

/// Most sweeps of the coupled solve; two to four are usual.
const SWEEPS: usize = 200;

/// Change of a contact force, relative to the weight, at which it counts as found.
const SETTLED: f64 = 1e-13;

/// What a contact force follows: a weighted sum of the shortening d and its derivatives, δ = value·d + rate·ḋ +
/// acceleration·d̈.
#[derive(Debug, Clone, Copy)]
pub struct Weights<L> {
    /// Of d [-].
    pub value: L,
    /// Of ḋ [s]: c/k of a tyre.
    pub rate: L,
    /// Of d̈ [s²]; one for a mass in rigid contact, for which d and ḋ do not count.
    pub acceleration: L,
    /// Whether any lane has more than the value.
    pub plain: bool,
}

/// The force of one axle, as increment p = P − P_st over its static load.
///
/// With shortening d since the static state the tyre of an axle with mass carries p = k_t d + c_t ḋ. On a massless axle
/// the suspension, shortened by s, carries the same force through its spring, damper and friction f:
/// p = k_t (d − s) + c_t (ḋ − ṡ) = k_s s + c_s ṡ + f − f₀, |f| ≤ F (KTN73 Fig. 2, after Veletsos and Huang, without
/// dampers there). The wheel does not pull: p ≥ −P_st, unless the contact is told to.
#[derive(Debug, Clone, Copy)]
pub struct Contact<L> {
    /// Static load [N].
    pub static_load: L,
    /// Least increment: −P_st, or −∞ for a contact that pulls [N].
    floor: L,
    /// Force per unit of δ: k_t [N/m], or a mass [kg].
    stiffness: L,
    /// Whether the force is constant, so that there is nothing to solve for.
    pub constant: bool,
    /// What δ is.
    pub weights: Weights<L>,
    suspension: Option<Suspension<L>>,
    /// f₀.
    initial: L,
    /// Rate at which a suspension begins to move, per unit of δ [1/s]: for steps of no length.
    onset: L,
}

/// The suspension of a massless axle, its rate taken as ṡ = σ s − η over a step.
#[derive(Debug, Clone, Copy)]
struct Suspension<L> {
    /// k_s + σ c_s.
    stiffness: L,
    /// c_s.
    damping: L,
    /// k_t + σ c_t.
    tyre: L,
    /// c_t.
    tyre_damping: L,
    /// f₀.
    initial: L,
    law: Law<L>,
    /// σ: 2/h by the trapezoidal rule; 1/h, backward Euler, beside friction, so that what sticks stands still, and of
    /// dampers too weak to keep up with the springs in one step.
    per_step: L,
    trapezoidal: bool,
}

impl<L: Lane> Suspension<L> {
    fn gather(each: &[&Suspension<f64>]) -> Self {
        let of = |f: fn(&Suspension<f64>) -> f64| L::from_fn(|s| f(each[s]));
        Suspension {
            stiffness: of(|c| c.stiffness),
            damping: of(|c| c.damping),
            tyre: of(|c| c.tyre),
            tyre_damping: of(|c| c.tyre_damping),
            initial: of(|c| c.initial),
            law: Law::gather(&each.iter().map(|c| &c.law).collect::<Vec<_>>()),
            per_step: of(|c| c.per_step),
            trapezoidal: each[0].trapezoidal,
        }
    }

    /// η in ṡ = σ s − η.
    #[inline(always)]
    fn past(&self, before: &Stroke<L>) -> L {
        let past = self.per_step * before.shortening;
        if self.trapezoidal { past + before.rate } else { past }
    }
}

impl<L: Lane> Contact<L> {
    /// Of a contact under gravity [m/s²], for steps of h [s]; a `bilateral` one pulls rather than lift off.
    pub fn new(point: &ContactPoint, gravity: f64, h: f64, bilateral: bool) -> Self {
        let static_load = point.static_load(gravity);
        let (value, rate, acceleration, stiffness) = match point.law {
            ContactLaw::Tyre { stiffness, damping } => (1.0, damping / stiffness, 0.0, stiffness),
            ContactLaw::Series { tyre_stiffness, tyre_damping, .. } => {
                (1.0, tyre_damping / tyre_stiffness, 0.0, tyre_stiffness)
            }
            ContactLaw::Mass(mass) => (0.0, 0.0, 1.0, mass),
            ContactLaw::Force => (1.0, 0.0, 0.0, 0.0),
        };
        let (mut initial, mut stiffness, mut onset) = (0.0, stiffness, 0.0);
        let suspension = match point.law {
            ContactLaw::Series { tyre_stiffness, tyre_damping, suspension_stiffness, suspension_damping, friction } => {
                // A damper too weak to keep up with the springs in one step would make the rule ring.
                let weak = h * (tyre_stiffness + suspension_stiffness) > 2.0 * (tyre_damping + suspension_damping);
                let trapezoidal = friction.limit == 0.0 && !weak;
                let damped = tyre_damping != 0.0 || suspension_damping != 0.0;
                let per_step = match (damped, trapezoidal) {
                    (false, _) => 0.0,
                    (true, true) => 2.0 / h,
                    (true, false) => 1.0 / h,
                };
                initial = friction.initial;
                if damped && h == 0.0 && trapezoidal {
                    // In no time dampers alone move: c_s ṡ = k_t d + c_t (ḋ − ṡ). Friction holds at first.
                    onset = tyre_stiffness / (tyre_damping + suspension_damping);
                    stiffness = suspension_damping * onset;
                }
                (!damped || h > 0.0).then(|| Suspension {
                    stiffness: L::splat(suspension_stiffness + per_step * suspension_damping),
                    damping: L::splat(suspension_damping),
                    tyre: L::splat(tyre_stiffness + per_step * tyre_damping),
                    tyre_damping: L::splat(tyre_damping),
                    initial: L::splat(friction.initial),
                    law: Law::new(&friction, suspension_stiffness),
                    per_step: L::splat(per_step),
                    trapezoidal,
                })
            }
            _ => None,
        };
        Contact {
            static_load: L::splat(static_load),
            // A mass in rigid contact has no way to leave the road and come back.
            floor: L::splat(if bilateral || acceleration != 0.0 { f64::NEG_INFINITY } else { -static_load }),
            stiffness: L::splat(stiffness),
            constant: point.law == ContactLaw::Force,
            weights: Weights {
                value: L::splat(value),
                rate: L::splat(rate),
                acceleration: L::splat(acceleration),
                plain: rate == 0.0 && acceleration == 0.0,
            },
            suspension,
            initial: L::splat(initial),
            onset: L::splat(onset),
        }
    }

    /// From those of each sample, all of one kind.
    pub fn gather(each: &[&Contact<f64>]) -> Self {
        let of = |f: fn(&Contact<f64>) -> f64| L::from_fn(|s| f(each[s]));
        Contact {
            static_load: of(|c| c.static_load),
            floor: of(|c| c.floor),
            stiffness: of(|c| c.stiffness),
            constant: each[0].constant,
            initial: of(|c| c.initial),
            onset: of(|c| c.onset),
            weights: Weights {
                value: of(|c| c.weights.value),
                rate: of(|c| c.weights.rate),
                acceleration: of(|c| c.weights.acceleration),
                plain: each.iter().all(|c| c.weights.plain),
            },
            suspension: each[0]
                .suspension
                .is_some()
                .then(|| Suspension::gather(&each.iter().filter_map(|c| c.suspension.as_ref()).collect::<Vec<_>>())),
        }
    }

    /// The suspension in the static state.
    #[inline(always)]
    pub fn at_rest(&self) -> Stroke<L> {
        Stroke::at_rest(self.initial)
    }

    /// The suspension in the static state, which begins to move under the given δ; of a contact for steps of no length.
    pub fn at_onset(&self, delta: L) -> Stroke<L> {
        Stroke { rate: self.onset * delta, ..self.at_rest() }
    }

    /// Everything in p = law(u − S p) that holds for a whole step, for a suspension that was at `before` at its start.
    #[inline(always)]
    pub fn prepare(&self, compliance: L, before: &Stroke<L>) -> Prepared<L> {
        let softened = L::splat(1.0) / (L::splat(1.0) + self.stiffness * compliance);
        let gain = self.stiffness * softened;
        match &self.suspension {
            None => Prepared { gain, past: L::splat(0.0), slope: L::splat(0.0), beside: L::splat(0.0) },
            Some(suspension) => {
                let past = suspension.past(before);
                Prepared {
                    gain,
                    past: suspension.tyre_damping * past * softened,
                    slope: suspension.tyre * softened,
                    beside: suspension.initial + suspension.damping * past,
                }
            }
        }
    }

    /// The increment p that solves p = law(u − S p).
    ///
    /// The law rises with δ and S ≥ 0, so the solution is unique.
    #[inline(always)]
    pub fn solve(&self, u: L, prepared: &Prepared<L>, before: &Stroke<L>) -> L {
        let p = match &self.suspension {
            None => prepared.gain * u,
            Some(suspension) => {
                // From the tyre p = A − B s, which the suspension meets.
                let top = prepared.gain * u + prepared.past;
                let b = prepared.slope + suspension.stiffness;
                let (s, _) = suspension.law.meet(top + prepared.beside, b, before);
                top - prepared.slope * s
            }
        };
        // In this order, so that what is not a number stays so and is found.
        self.floor.larger(p)
    }

    /// The suspension at the end of a step that ended with increment p.
    #[inline(always)]
    pub fn settle(&self, p: L, before: &Stroke<L>) -> Stroke<L> {
        let Some(suspension) = &self.suspension else { return *before };
        let past = suspension.past(before);
        let a = p + suspension.initial + suspension.damping * past;
        let (shortening, friction) = suspension.law.meet(a, suspension.stiffness, before);
        Stroke { shortening, rate: suspension.per_step * shortening - past, friction }
    }
}

/// What holds for a whole step of one axle: from the tyre p = gain·u + past − slope·s.
#[derive(Debug, Clone, Copy)]
pub struct Prepared<L> {
    gain: L,
    past: L,
    slope: L,
    /// What the suspension carries besides its spring and the change of its friction: f₀ + c_s η.
    beside: L,
}

/// A friction element between parts that have mass: f − f₀ is its force, beside a spring that is part of the vehicle.
#[derive(Debug, Clone, Copy)]
pub struct Rubbing<L> {
    initial: L,
    law: Law<L>,
    /// Whether time passes in a step; if not, nothing moves.
    moves: bool,
}

impl<L: Lane> Rubbing<L> {
    /// The same in every lane, for steps of h [s].
    pub fn new(element: &FrictionElement, h: f64) -> Self {
        Rubbing {
            moves: h > 0.0,
            initial: L::splat(element.friction.initial),
            law: Law::new(&element.friction, element.stiffness),
        }
    }

    /// In the static state.
    #[inline(always)]
    pub fn at_rest(&self) -> Stroke<L> {
        Stroke::at_rest(self.initial)
    }

    /// From those of each sample, all of one kind.
    pub fn gather(each: &[&Rubbing<f64>]) -> Self {
        Rubbing {
            initial: L::from_fn(|s| each[s].initial),
            law: Law::gather(&each.iter().map(|r| &r.law).collect::<Vec<_>>()),
            moves: each[0].moves,
        }
    }

    /// Force increment for shortening u − S (f − f₀), and the element then.
    #[inline(always)]
    fn solve(&self, u: L, compliance: L, before: &Stroke<L>) -> (L, Stroke<L>) {
        if !self.moves {
            return (before.friction - self.initial, *before);
        }
        let stiffness = L::splat(1.0) / compliance;
        let (shortening, friction) = self.law.meet(self.initial + stiffness * u, stiffness, before);
        (friction - self.initial, Stroke { shortening, rate: before.rate, friction })
    }
}

/// Contacts, then friction elements: the unknown forces of a step are numbered in this order.
#[derive(Debug, Clone)]
pub struct Elements<L> {
    /// All contacts.
    pub contacts: Vec<Contact<L>>,
    /// All friction elements between parts that have mass.
    pub rubbing: Vec<Rubbing<L>>,
}

impl<L: Lane> Elements<L> {
    /// Number of unknown forces.
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.contacts.len() + self.rubbing.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Solves p_k = law_k(u_k − Σ S_kj p_j) for all elements, starting from the p given; `compliance` is S by rows, and
    /// lanes that are `frozen` keep their p.
    ///
    /// One element after the other with its own equation solved exactly (nonlinear Gauss–Seidel): the laws rise and S
    /// is positive definite, so this is descent on a strictly convex energy and converges from anywhere, through slip
    /// and lift-off alike. (Tyre damping adds a part to S that is not symmetric, of the order of the step.) A lane that
    /// has settled is frozen, hence no sample depends on its neighbours. False if one did not.
    #[inline(always)]
    pub fn solve(
        &self,
        u: &[L],
        compliance: &[L],
        before: &[Stroke<L>],
        prepared: &mut Vec<Prepared<L>>,
        p: &mut [L],
        frozen: L::Mask,
    ) -> bool {
        let n = self.len();
        prepared.clear();
        prepared.extend(self.contacts.iter().enumerate().map(|(k, c)| c.prepare(compliance[k * n + k], &before[k])));
        let weight = self.contacts.iter().fold(L::splat(0.0), |sum, c| sum + c.static_load);
        let tolerance = weight * L::splat(SETTLED);
        let mut done = frozen;
        for _ in 0..SWEEPS {
            let mut change = L::splat(0.0);
            for k in 0..n {
                if self.contacts.get(k).is_some_and(|contact| contact.constant) {
                    continue;
                }
                let row = &compliance[k * n..(k + 1) * n];
                let mut others = u[k];
                for (j, (s, p)) in row.iter().zip(p.iter()).enumerate() {
                    if j != k {
                        others = others - *s * *p;
                    }
                }
                let found = match self.contacts.get(k) {
                    Some(contact) => contact.solve(others, &prepared[k], &before[k]),
                    None => self.rubbing[k - self.contacts.len()].solve(others, row[k], &before[k]).0,
                };
                let next = L::select(done, p[k], found);
                change = change.larger((next - p[k]).magnitude());
                p[k] = next;
            }
            // A single axle is exact at once; a NaN never counts as settled.
            done = done | change.less(tolerance);
            if n <= 1 || L::all(done) {
                return true;
            }
        }
        false
    }

    /// Commits suspensions and friction elements to the end of a step that ended with the forces p.
    #[inline(always)]
    pub fn settle(&self, u: &[L], compliance: &[L], p: &[L], strokes: &mut [Stroke<L>]) {
        let n = self.len();
        for (k, contact) in self.contacts.iter().enumerate() {
            strokes[k] = contact.settle(p[k], &strokes[k]);
        }
        for (i, rubbing) in self.rubbing.iter().enumerate() {
            let k = self.contacts.len() + i;
            let row = &compliance[k * n..(k + 1) * n];
            let others = (0..n).filter(|&j| j != k).fold(u[k], |sum, j| sum - row[j] * p[j]);
            strokes[k] = rubbing.solve(others, row[k], &strokes[k]).1;
        }
    }
}
