//! Contact forces: the law of one axle with friction and lift-off, and the solve that couples all axles in a step.

use crate::assembly::{ContactLaw, ContactPoint, FrictionElement};
use crate::friction::{Law, Stroke};
use crate::lane::Lane;

/// Most sweeps of the coupled solve; two to four are usual.
const SWEEPS: usize = 200;

/// Error of a contact force, relative to the weight, at which it counts as found.
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

impl<L: Lane> Suspension<L> {
    fn gather(each: &[&Suspension<f64>]) -> Self {
        let of = |f: fn(&Suspension<f64>) -> f64| L::from_fn(|s| f(each[s]));
        Suspension {
            stiffness: of(|c| c.stiffness),
            give: of(|c| c.give),
            damping: of(|c| c.damping),
            tyre: of(|c| c.tyre),
            tyre_damping: of(|c| c.tyre_damping),
            initial: of(|c| c.initial),
            law: Law::gather(&each.iter().map(|c| &c.law).collect::<Vec<_>>()),
            per_step: of(|c| c.per_step),
            trapezoidal: each[0].trapezoidal,
            damped: each.iter().any(|c| c.damped),
        }
    }

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

    /// What samples must have in common to be gathered: in these their steps take other ways, not only other numbers.
    pub fn ways(&self) -> [bool; 6] {
        let has = |of: fn(&Suspension<L>) -> bool| self.suspension.as_ref().is_some_and(of);
        let [elastic, leaf] = self.suspension.as_ref().map_or([false; 2], |s| s.law.kind());
        [self.weights.plain, self.suspension.is_some(), has(|s| s.trapezoidal), has(|s| s.damped), elastic, leaf]
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
            return Held { gain: self.stiffness / hardening, ..Held::nothing() };
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
    fn is_coulomb(&self) -> bool {
        let coulomb = |s: &Suspension<L>| !s.damped && matches!(s.law, Law::Rigid { .. });
        self.suspension.as_ref().is_some_and(coulomb) && !self.constant
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
    pub fn settle(&self, p: L, prepared: &Prepared<L>, before: &Stroke<L>, coulomb: bool) -> Stroke<L> {
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
    gain: L,
    /// By how much less p there is, per unit by which the suspension was shortened.
    slope: L,
    /// 1/(1 + k S).
    softened: L,
    share: L,
    /// By how much less force there is for friction, per unit that the suspension moves.
    resistance: L,
    /// By how much the forces of the elements before this one may still be off, all together, per change of this one's.
    reach: L,
}

impl<L: Lane> Held<L> {
    #[inline(always)]
    fn nothing() -> Self {
        Held::of(&[L::splat(0.0); HELD])
    }

    /// From its numbers.
    #[inline(always)]
    fn of(numbers: &[L]) -> Self {
        let n = &numbers[..HELD];
        Held { gain: n[0], slope: n[1], softened: n[2], share: n[3], resistance: n[4], reach: n[5] }
    }

    /// As numbers.
    #[inline(always)]
    fn numbers(&self) -> [L; HELD] {
        [self.gain, self.slope, self.softened, self.share, self.resistance, self.reach]
    }
}

/// What holds for a whole step of one element: without slip p = gain·u + stuck, and a suspension carries p + beside
/// against friction.
#[derive(Debug, Clone, Copy)]
pub struct Prepared<L> {
    held: Held<L>,
    stuck: L,
    beside: L,
}

impl<L: Lane> Prepared<L> {
    /// Of an element that does nothing.
    #[inline(always)]
    pub fn nothing() -> Self {
        Prepared { held: Held::nothing(), stuck: L::splat(0.0), beside: L::splat(0.0) }
    }
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

    /// See [`Contact::ways`].
    pub fn ways(&self) -> [bool; 2] {
        self.law.kind()
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

    /// What follows from the compliance alone.
    #[inline(always)]
    fn hold(&self, compliance: L) -> Held<L> {
        let gain = if self.moves { L::splat(1.0) / compliance } else { L::splat(0.0) };
        Held { gain, ..Held::nothing() }
    }

    /// The rest that holds for a whole step.
    #[inline(always)]
    fn prepare(&self, held: Held<L>, before: &Stroke<L>) -> Prepared<L> {
        Prepared { stuck: self.initial - held.gain * before.shortening, beside: L::splat(0.0), held }
    }

    /// Friction force for shortening u − S (f − f₀).
    #[inline(always)]
    fn friction(&self, trial: L, prepared: &Prepared<L>, before: &Stroke<L>) -> L {
        if self.moves { self.law.friction(trial, prepared.held.gain, before) } else { before.friction }
    }

    /// The same as force increment.
    #[inline(always)]
    fn solve(&self, u: L, prepared: &Prepared<L>, before: &Stroke<L>) -> L {
        self.friction(prepared.held.gain * u + prepared.stuck, prepared, before) - self.initial
    }

    /// The element at the end of a step.
    #[inline(always)]
    fn settle(&self, u: L, compliance: L, prepared: &Prepared<L>, before: &Stroke<L>) -> Stroke<L> {
        if !self.moves {
            return *before;
        }
        let trial = prepared.held.gain * u + prepared.stuck;
        let friction = self.friction(trial, prepared, before);
        let shortening = before.shortening + (trial - friction) * compliance;
        Stroke { shortening, rate: before.rate, friction }
    }
}

/// What a caller knows of the elements; in literals, loops over them run a known number of times.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Known {
    /// Number of contacts.
    pub contacts: usize,
    /// Number of friction elements.
    pub rubbing: usize,
    /// Whether all contacts are massless axles with rigid Coulomb friction and without dampers.
    pub coulomb: bool,
}

impl Known {
    /// Number of elements.
    #[inline(always)]
    pub fn all(self) -> usize {
        self.contacts + self.rubbing
    }
}

/// Contacts, then friction elements: the unknown forces of a step are numbered in this order.
#[derive(Debug, Clone)]
pub struct Elements<L> {
    /// All contacts.
    pub contacts: Vec<Contact<L>>,
    /// All friction elements between parts that have mass.
    pub rubbing: Vec<Rubbing<L>>,
    /// Error of a contact force [N] at which it counts as found.
    tolerance: L,
}

impl<L: Lane> Elements<L> {
    /// Of these.
    pub fn new(contacts: Vec<Contact<L>>, rubbing: Vec<Rubbing<L>>) -> Self {
        let weight = contacts.iter().fold(L::splat(0.0), |sum, c| sum + c.static_load);
        Elements { contacts, rubbing, tolerance: weight * L::splat(SETTLED) }
    }

    /// What there is to know of them.
    pub fn known(&self) -> Known {
        let coulomb = self.contacts.iter().all(Contact::is_coulomb);
        Known { contacts: self.contacts.len(), rubbing: self.rubbing.len(), coulomb }
    }

    /// What holds of all elements with a compliance S, by rows: [`HELD`] of each. What is
    /// `known` is said again by callers who know it.
    #[inline(always)]
    pub fn hold(&self, known: Known, compliance: &[L], held: &mut [L]) {
        let (contacts, n) = (known.contacts, known.all());
        let (compliance, held) = (&compliance[..n * n], &mut held[..n * HELD]);
        let (wheels, rubbing) = (&self.contacts[..contacts], &self.rubbing[..known.rubbing]);
        for k in 0..n {
            let own = compliance[k * n + k];
            let mut of = if k < contacts { wheels[k].hold(own) } else { rubbing[k - contacts].hold(own) };
            for j in 0..k {
                let gain = held[j * HELD];
                of.reach = of.reach + gain * compliance[j * n + k].magnitude();
            }
            held[k * HELD..][..HELD].copy_from_slice(&of.numbers());
        }
    }

    /// What holds for a whole step that begins with the strokes `before`.
    #[inline(always)]
    pub fn prepare(&self, known: Known, held: &[L], before: &[Stroke<L>], prepared: &mut [Prepared<L>]) {
        let (contacts, n) = (known.contacts, known.all());
        let (before, prepared) = (&before[..n], &mut prepared[..n]);
        let (wheels, rubbing) = (&self.contacts[..contacts], &self.rubbing[..known.rubbing]);
        for k in 0..n {
            let held = Held::of(&held[k * HELD..]);
            prepared[k] = if k < contacts {
                wheels[k].prepare(held, &before[k], known.coulomb)
            } else {
                rubbing[k - contacts].prepare(held, &before[k])
            };
        }
    }

    /// Solves p_k = law_k(u_k − Σ S_kj p_j) for all elements, starting from the p given; `compliance` is S by rows, and
    /// lanes that are `frozen` keep their p. What is `known` is as in [`Elements::hold`]; what comes second after the p is
    /// room for as many.
    ///
    /// One element after the other with its own equation solved exactly (nonlinear Gauss–Seidel): the laws rise and S
    /// is positive definite, so this is descent on a strictly convex energy and converges from anywhere, through slip
    /// and lift-off alike. (Tyre damping adds a part to S that is not symmetric, of the order of the step.) After a
    /// sweep an equation is off only by what the later forces have changed since, and no law follows its u more steeply
    /// than while friction holds, by the gain: that bounds what is left. A lane that has settled is frozen, hence no
    /// sample depends on its neighbours. False if one did not.
    #[inline(always)]
    #[allow(clippy::too_many_arguments)] // each is one thing
    pub fn solve(
        &self,
        known: Known,
        u: &[L],
        compliance: &[L],
        before: &[Stroke<L>],
        prepared: &[Prepared<L>],
        [p, fresh]: [&mut [L]; 2],
        frozen: L::Mask,
    ) -> bool {
        let (contacts, n) = (known.contacts, known.all());
        let (u, compliance, before) = (&u[..n], &compliance[..n * n], &before[..n]);
        let (prepared, p, fresh) = (&prepared[..n], &mut p[..n], &mut fresh[..n]);
        let (wheels, rubbing) = (&self.contacts[..contacts], &self.rubbing[..known.rubbing]);
        let mut done = frozen;
        for _ in 0..SWEEPS {
            let mut left = L::splat(0.0);
            for k in 0..n {
                if k < contacts && !known.coulomb && wheels[k].constant {
                    fresh[k] = p[k];
                    continue;
                }
                let row = &compliance[k * n..][..n];
                let mut others = u[k];
                for j in 0..n {
                    if j != k {
                        others = others - row[j] * if j < k { fresh[j] } else { p[j] };
                    }
                }
                let found = if k < contacts {
                    wheels[k].solve(others, &prepared[k], &before[k], known.coulomb)
                } else {
                    rubbing[k - contacts].solve(others, &prepared[k], &before[k])
                };
                // Not where it came from: the compiler would store it lane by lane, which is slow.
                fresh[k] = L::select(done, p[k], found);
                // The first one has none before it.
                if k > 0 {
                    left = left + prepared[k].held.reach * (fresh[k] - p[k]).magnitude();
                }
            }
            p.copy_from_slice(fresh);
            // A single axle is exact at once; a NaN never counts as settled.
            done = done | left.less(self.tolerance);
            if n <= 1 || L::all(done) {
                return true;
            }
        }
        false
    }

    /// Commits suspensions and friction elements to the end of a step that ended with the forces p.
    #[inline(always)]
    pub fn settle(
        &self,
        known: Known,
        u: &[L],
        compliance: &[L],
        prepared: &[Prepared<L>],
        p: &[L],
        strokes: &mut [Stroke<L>],
    ) {
        let (contacts, n) = (known.contacts, known.all());
        let (prepared, p, strokes) = (&prepared[..n], &p[..n], &mut strokes[..n]);
        for (k, contact) in self.contacts[..contacts].iter().enumerate() {
            strokes[k] = contact.settle(p[k], &prepared[k], &strokes[k], known.coulomb);
        }
        for (k, rubbing) in (contacts..n).zip(&self.rubbing) {
            let row = &compliance[k * n..][..n];
            let mut others = u[k];
            for j in 0..n {
                if j != k {
                    others = others - row[j] * p[j];
                }
            }
            strokes[k] = rubbing.settle(others, row[k], &prepared[k], &strokes[k]);
        }
    }
}
