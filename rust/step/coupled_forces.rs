//! All contact and friction forces of a step together: p_k = law_k(u_k − Σ S_kj p_j), element after element.

use super::contact::{Contact, HELD, Held, Prepared};
use super::friction::{Law, Stroke};
use crate::lane::Lane;
use crate::lane::gather::gather;
use crate::vehicle::equations::FrictionElement;

/// Most sweeps of the coupled solve; two to four are usual.
pub(super) const SWEEPS: usize = 200;

/// Error of a contact force, relative to the weight, at which it counts as found.
const SETTLED: f64 = 1e-13;

/// A friction element between parts that have mass: f − f₀ is its force, beside a spring that is part of the vehicle.
#[derive(Debug, Clone, Copy)]
pub struct Rubbing<L> {
    initial: L,
    law: Law<L>,
    /// Whether time passes in a step; if not, nothing moves.
    moves: bool,
}

gather!(Rubbing { initial, law, moves });

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

    /// What follows from the compliance alone.
    #[inline(always)]
    fn hold(&self, compliance: L) -> Held<L> {
        let gain = if self.moves { L::splat(1.0) / compliance } else { L::splat(0.0) };
        Held::rising(gain)
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
    fn commit(&self, u: L, compliance: L, prepared: &Prepared<L>, before: &Stroke<L>) -> Stroke<L> {
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
    pub(super) tolerance: L,
}

gather!(Elements { contacts, rubbing, tolerance });

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

    /// Solves p_k = law_k(u_k − Σ S_kj p_j) for all elements, starting from the p given; `compliance` is S by rows. What is
    /// `known` is as in [`Elements::hold`]; what comes second after the p is room for as many.
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
    ) -> bool {
        let (contacts, n) = (known.contacts, known.all());
        let (u, compliance, before) = (&u[..n], &compliance[..n * n], &before[..n]);
        let (prepared, p, fresh) = (&prepared[..n], &mut p[..n], &mut fresh[..n]);
        let (wheels, rubbing) = (&self.contacts[..contacts], &self.rubbing[..known.rubbing]);
        let mut done = L::never();
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
    pub fn commit(
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
            strokes[k] = contact.commit(p[k], &prepared[k], &strokes[k], known.coulomb);
        }
        for (k, rubbing) in (contacts..n).zip(&self.rubbing) {
            let row = &compliance[k * n..][..n];
            let mut others = u[k];
            for j in 0..n {
                if j != k {
                    others = others - row[j] * p[j];
                }
            }
            strokes[k] = rubbing.commit(others, row[k], &prepared[k], &strokes[k]);
        }
    }
}
