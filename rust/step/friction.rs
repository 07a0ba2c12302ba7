//! Friction beside a spring: how the force follows the stroke, and where it meets what the rest of the step asks for.

use crate::lane::Lane;
use crate::lane::gather::Gather;
use crate::vehicle::body::{BuildUp, Friction};

/// Most iterations for a leaf spring; four to eight are usual.
const ITERATIONS: usize = 60;

/// Change of stroke, relative to the distance in which a leaf spring's force builds up, at which it counts as found.
const FOUND: f64 = 1e-14;

/// A suspension at the end of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stroke<L> {
    /// Shortening since the static state [m].
    pub shortening: L,
    /// Its rate [m/s], known where a damper needs it.
    pub rate: L,
    /// Friction force [N].
    pub friction: L,
}

impl<L: Lane> Stroke<L> {
    /// At rest, with the friction of the static state [N].
    pub fn at_rest(friction: L) -> Self {
        Stroke { shortening: L::splat(0.0), rate: L::splat(0.0), friction }
    }
}

/// The law f(s) of a friction element from one instant to the next.
#[derive(Debug, Clone, Copy)]
pub enum Law<L> {
    /// Coulomb: any force up to the limit while it sticks.
    Rigid {
        /// F [N].
        limit: L,
    },
    /// Coulomb behind an elastic stick (Jenkins element).
    Elastic {
        /// F [N].
        limit: L,
        /// Compliance of the stick [m/N].
        give: L,
    },
    /// Leaf spring: the total force tends exponentially to the envelope k s ± F, whichever way it moves.
    ///
    /// This is dT/ds = (T_env − T)/β along a straight envelope, solved exactly, so that the way is the same however
    /// many steps it takes; for short steps it is the recursion of P. S. Fancher, R. D. Ervin, C. C. MacAdam and
    /// C. B. Winkler, SAE paper 800905 (1980).
    Leaf {
        /// F [N].
        limit: L,
        /// β [m].
        decay: L,
        /// kβ, by which the force lags behind the envelope [N].
        lag: L,
    },
}

impl<L: Lane> Gather<L> for Law<f64> {
    type Lanes = Law<L>;

    fn gather<'a>(each: impl Fn(usize) -> &'a Self) -> Law<L> {
        let numbers = |law: &Law<f64>| match *law {
            Law::Rigid { limit } => [limit, 0.0, 0.0],
            Law::Elastic { limit, give } => [limit, give, 0.0],
            Law::Leaf { limit, decay, lag } => [limit, decay, lag],
        };
        let [limit, second, third] = [0, 1, 2].map(|k| L::from_fn(|sample| numbers(each(sample))[k]));
        match each(0) {
            Law::Rigid { .. } => Law::Rigid { limit },
            Law::Elastic { .. } => Law::Elastic { limit, give: second },
            Law::Leaf { .. } => Law::Leaf { limit, decay: second, lag: third },
        }
    }

    fn ways(&self, ways: &mut Vec<bool>) {
        ways.extend([matches!(self, Law::Elastic { .. }), matches!(self, Law::Leaf { .. })]);
    }
}

impl<L: Lane> Law<L> {
    /// Of friction beside a spring of this stiffness [N/m].
    pub fn new(friction: &Friction, spring: f64) -> Self {
        let limit = L::splat(friction.limit);
        match friction.build_up {
            BuildUp::Rigid => Law::Rigid { limit },
            BuildUp::Elastic(stick) => Law::Elastic { limit, give: L::splat(1.0 / stick) },
            BuildUp::Leaf(decay) => Law::Leaf { limit, decay: L::splat(decay), lag: L::splat(spring * decay) },
        }
    }

    /// Friction where the law, coming from `before`, meets the falling line f = trial − b (s − s₀), s₀ its shortening
    /// before.
    ///
    /// The law and its spring rise with s, and b is at least the spring's stiffness, so there is one such point.
    #[inline(always)]
    pub fn friction(&self, trial: L, b: L, before: &Stroke<L>) -> L {
        match *self {
            Law::Rigid { limit } => trial.smaller(limit).larger(-limit),
            Law::Elastic { limit, give } => {
                let softening = b * give;
                let trial = (trial + softening * before.friction) / (L::splat(1.0) + softening);
                trial.smaller(limit).larger(-limit)
            }
            Law::Leaf { limit, decay, lag } => leaf(trial - before.friction, b, before, limit, decay, lag),
        }
    }
}

#[inline(always)]
fn leaf<L: Lane>(excess: L, b: L, before: &Stroke<L>, limit: L, decay: L, lag: L) -> L {
    let (zero, one) = (L::splat(0.0), L::splat(1.0));
    // Everything in the direction in which it moves: x ≥ 0 from here, and the force there on tends to `far`.
    let sense = L::select(excess.less(zero), -one, one);
    let excess = sense * excess;
    let far = limit - lag;
    let apart = sense * before.friction - far;
    // Newton on b x + apart (e^(−x/β) − 1) = excess: convex or concave throughout, so it converges from zero.
    let mut x = zero;
    let mut done = L::never();
    for _ in 0..ITERATIONS {
        let fading = (-x / decay).exp();
        let residual = b * x + apart * (fading - one) - excess;
        let next = x - residual / (b - apart * fading / decay);
        let change = (next - x).magnitude();
        x = L::select(done, x, next);
        done = done | change.less(L::splat(FOUND) * decay);
        if L::all(done) {
            break;
        }
    }
    sense * (far + apart * (-x / decay).exp())
}
