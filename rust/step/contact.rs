//! The contact law of an axle, tyre and suspension with friction and lift-off, and where it meets δ = u − S p.
//!
//! The law stands at [`Contact`]; its numbers come from the [`ContactLaw`] of a vehicle.

use super::friction::{Law, Stroke};
use super::gait::Slider;
use crate::lane::Lane;
use crate::lane::gather::gather;
use crate::vehicle::equations::{ContactLaw, ContactPoint};

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
    /// Whether no lane has more than the value: δ = d.
    pub plain: bool,
}

gather!(Weights { value, rate, acceleration, plain });

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
    /// k_s + σ c_s, and one over it.
    stiffness: L,
    give: L,
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
    /// Whether any lane has dampers, so that rates count.
    damped: bool,
}

gather!(Suspension { stiffness, give, damping, tyre, tyre_damping, initial, law, per_step, trapezoidal, damped });

impl<L: Lane> Suspension<L> {
    /// η in ṡ = σ s − η.
    #[inline(always)]
    fn past(&self, before: &Stroke<L>) -> L {
        let past = self.per_step * before.shortening;
        if self.trapezoidal { past + before.rate } else { past }
    }

    /// As [`Law::friction`].
    #[inline(always)]
    fn friction(&self, trial: L, b: L, before: &Stroke<L>, coulomb: bool) -> L {
        match self.law {
            Law::Rigid { limit } => trial.smaller(limit).larger(-limit),
            _ if coulomb => unreachable!(),
            law => law.friction(trial, b, before),
        }
    }
}

gather!(Contact { static_load, floor, stiffness, constant, weights, suspension, initial, onset });

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
                let both = suspension_stiffness + per_step * suspension_damping;
                (!damped || h > 0.0).then(|| Suspension {
                    stiffness: L::splat(both),
                    give: L::splat(1.0 / both),
                    damped,
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

    /// Least increment [N].
    pub fn floor(&self) -> L {
        self.floor
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

    /// Everything in p = law(u − S p) that follows from S alone.
    #[inline(always)]
    pub fn hold(&self, compliance: L) -> Held<L> {
        let hardening = L::splat(1.0) + self.stiffness * compliance;
        let Some(suspension) = &self.suspension else {
            return Held::rising(self.stiffness / hardening);
        };
        // With the tyre's p = A − B s the suspension meets f = a − (B + k_s) s; 1/(1 + k S) and 1/(B + k_s) from the
        // reciprocal of their product.
        let joint = suspension.tyre + suspension.stiffness * hardening;
        let reciprocal = L::splat(1.0) / (hardening * joint);
        let softened = reciprocal * joint;
        let slope = suspension.tyre * softened;
        Held {
            gain: self.stiffness * softened,
            slope,
            softened,
            share: suspension.tyre * (reciprocal * hardening),
            resistance: slope + suspension.stiffness,
            reach: L::splat(0.0),
        }
    }

    /// Whether this is a massless axle with rigid Coulomb friction and without dampers.
    pub fn is_coulomb(&self) -> bool {
        let coulomb = |s: &Suspension<L>| !s.damped && matches!(s.law, Law::Rigid { .. });
        self.suspension.as_ref().is_some_and(coulomb) && !self.constant
    }

    /// Whether this is a tyre under a mass, or several lanes of such.
    pub fn is_tyre(&self) -> bool {
        let Weights { value, acceleration, .. } = self.weights;
        let (zero, one) = (L::splat(0.0), L::splat(1.0));
        let massless = !(value.less(one) | one.less(value) | acceleration.less(zero) | zero.less(acceleration));
        self.suspension.is_none() && !self.constant && L::all(massless)
    }

    /// The suspension of a massless axle with rigid Coulomb friction and without dampers.
    #[inline(always)]
    pub fn slider(&self) -> Option<Slider<L>> {
        let Suspension { stiffness, give, initial, law, .. } = self.suspension?;
        let Law::Rigid { limit } = law else { return None };
        Some(Slider { stiffness, give, initial, limit })
    }

    /// The suspension. Callers who know that it is a `coulomb` one say so in a literal, and what others do is not there.
    #[inline(always)]
    fn suspension(&self, coulomb: bool) -> Option<&Suspension<L>> {
        match &self.suspension {
            None if coulomb => unreachable!(),
            suspension => suspension.as_ref(),
        }
    }

    /// The rest that holds for a whole step, for a suspension that was at `before` at its start.
    #[inline(always)]
    pub fn prepare(&self, held: Held<L>, before: &Stroke<L>, coulomb: bool) -> Prepared<L> {
        let zero = L::splat(0.0);
        let Some(suspension) = self.suspension(coulomb) else { return Prepared { held, stuck: zero, beside: zero } };
        let (mut stuck, mut beside) = (zero, suspension.initial);
        if !coulomb && suspension.damped {
            let past = suspension.past(before);
            stuck = suspension.tyre_damping * past * held.softened;
            beside = beside + suspension.damping * past;
        }
        Prepared {
            held,
            stuck: stuck - held.slope * before.shortening,
            beside: beside - suspension.stiffness * before.shortening,
        }
    }

    /// The increment p that solves p = law(u − S p).
    ///
    /// The law rises with δ and S ≥ 0, so the solution is unique.
    #[inline(always)]
    pub fn solve(&self, u: L, prepared: &Prepared<L>, before: &Stroke<L>, coulomb: bool) -> L {
        let Prepared { held, stuck, beside } = *prepared;
        let mut p = held.gain * u;
        if let Some(suspension) = self.suspension(coulomb) {
            p = p + stuck;
            let trial = p + beside;
            let friction = suspension.friction(trial, held.resistance, before, coulomb);
            p = p - held.share * (trial - friction);
        }
        // In this order, so that what is not a number stays so and is found.
        self.floor.larger(p)
    }

    /// The suspension at the end of a step that ended with increment p.
    #[inline(always)]
    pub fn commit(&self, p: L, prepared: &Prepared<L>, before: &Stroke<L>, coulomb: bool) -> Stroke<L> {
        let Some(suspension) = self.suspension(coulomb) else { return *before };
        let trial = p + prepared.beside;
        let friction = suspension.friction(trial, suspension.stiffness, before, coulomb);
        let shortening = before.shortening + (trial - friction) * suspension.give;
        let rate = match !coulomb && suspension.damped {
            true => suspension.per_step * shortening - suspension.past(before),
            false => before.rate,
        };
        Stroke { shortening, rate, friction }
    }
}

/// How many numbers a [`Held`] is.
pub const HELD: usize = 6;

/// What holds of one element wherever it stands with the same compliance, whatever its state.
///
/// Of a contact: while the suspension stays where it was, p rises by the gain with u; of what is too much for friction the
/// contact loses its share. Of a friction element: as long as it sticks, its force rises by the gain.
#[derive(Debug, Clone, Copy)]
pub struct Held<L> {
    pub gain: L,
    /// By how much less p there is, per unit by which the suspension was shortened.
    pub slope: L,
    /// 1/(1 + k S).
    softened: L,
    pub share: L,
    /// By how much less force there is for friction, per unit that the suspension moves.
    resistance: L,
    /// By how much the forces of the elements before this one may still be off, all together, per change of this one's.
    pub reach: L,
}

impl<L: Lane> Held<L> {
    /// Of an element that does nothing.
    #[inline(always)]
    pub fn nothing() -> Self {
        Held::of(&[L::splat(0.0); HELD])
    }

    /// Of an element whose force rises by the gain with u, and that is all.
    #[inline(always)]
    pub fn rising(gain: L) -> Self {
        Held { gain, ..Held::nothing() }
    }

    /// From its numbers.
    #[inline(always)]
    pub fn of(numbers: &[L]) -> Self {
        let n = &numbers[..HELD];
        Held { gain: n[0], slope: n[1], softened: n[2], share: n[3], resistance: n[4], reach: n[5] }
    }

    /// As numbers.
    #[inline(always)]
    pub fn numbers(&self) -> [L; HELD] {
        [self.gain, self.slope, self.softened, self.share, self.resistance, self.reach]
    }
}

/// What holds for a whole step of one element: without slip p = gain·u + stuck, and a suspension carries p + beside
/// against friction.
#[derive(Debug, Clone, Copy)]
pub struct Prepared<L> {
    pub held: Held<L>,
    pub stuck: L,
    pub beside: L,
}

impl<L: Lane> Prepared<L> {
    /// Of an element that does nothing.
    #[inline(always)]
    pub fn nothing() -> Self {
        Prepared { held: Held::nothing(), stuck: L::splat(0.0), beside: L::splat(0.0) }
    }
}
