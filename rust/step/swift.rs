//! Many steps of the usual vehicles: the same as [`Stepper::advance`] takes, to the bit, in fewer instructions.
//!
//! The step asks again and again what does not change from one to the next: how many modes, contacts and coordinates there
//! are, where their numbers are, and which law holds. Here that is known when this is compiled, but for the number of modes,
//! and the state of the vehicle stays where the compiler can see it. It is for one vehicle whose motion is prescribed and
//! steady, either a rigid body on massless axles with Coulomb friction or springs, dampers and masses on tyres, on a bridge
//! that every sample shares, or none.

// Loops over the contacts by their numbers, of a length that the compiler knows: it unrolls them.
#![allow(clippy::needless_range_loop)]

use super::contact::{Contact, HELD, Held};
use super::coupled_forces::SWEEPS;
use super::gait::{COULOMB, DAMPERS, Gait, Slider, Standing, of_mode};
use super::newmark::Newmark;
use super::stepper::{State, Stepper};
use super::unit::Propulsion;
use crate::coordinate::Coordinate;
use crate::lane::Lane;

/// What lies under a contact: elevation [m], and slope [-] if the tyre has a damper.
#[derive(Debug, Clone, Copy)]
pub struct Under<L> {
    /// Elevation [m].
    pub elevation: L,
    /// Slope [-].
    pub slope: L,
}

/// Any number of modes.
pub const ANY: usize = usize::MAX;

/// The state of a vehicle with what its steps need, on K contacts and with N coordinates.
pub struct Swift<'s, L, const K: usize, const N: usize, const LAW: u8> {
    newmark: Newmark<L>,
    speed: L,
    modal: [&'s [L]; 3],
    /// C, K and the inverse.
    linear: [&'s [L]; 3],
    rows: &'s [L],
    receptance: &'s [L],
    floors: [L; K],
    /// Damping of the tyres by their stiffness.
    rates: [L; K],
    sliders: [Slider<L>; K],
    tolerance: L,
    /// The vehicle.
    pub coordinates: [Coordinate<L>; N],
    /// Increments of the contact forces.
    pub increments: [L; K],
    shortenings: [L; K],
    frictions: [L; K],
}

/// How contacts feel each other: compliance, and what holds of each.
#[derive(Debug, Clone, Copy)]
pub struct Coupling<L, const K: usize> {
    compliance: [[L; K]; K],
    held: [Held<L>; K],
}

impl<L: Lane, const K: usize> Coupling<L, K> {
    /// That of a stepper without a bridge.
    #[inline(always)]
    pub fn alone(stepper: &Stepper<L>) -> Self {
        Coupling::of(&stepper.alone, |number| number)
    }

    #[inline(always)]
    fn of<T: Copy>(numbers: &[T], lane: impl Fn(T) -> L) -> Self {
        let (compliance, held) = numbers[..K * K + K * HELD].split_at(K * K);
        let mut coupling = Coupling { compliance: [[L::splat(0.0); K]; K], held: [Held::nothing(); K] };
        for k in 0..K {
            for j in 0..K {
                coupling.compliance[k][j] = lane(compliance[k * K + j]);
            }
            let mut own = [L::splat(0.0); HELD];
            for (own, number) in own.iter_mut().zip(&held[k * HELD..][..HELD]) {
                *own = lane(*number);
            }
            coupling.held[k] = Held::of(&own);
        }
        coupling
    }
}

impl<L: Lane> Stepper<L> {
    /// What its vehicle is like, if it is one of those that have their own steps.
    pub(super) fn find_gait(&self) -> Option<Gait> {
        let [unit] = &self.units[..] else { return None };
        let contacts = &self.elements.contacts;
        let tyres = || contacts.iter().all(Contact::is_tyre);
        let law = if self.form.elements.coulomb && self.form.bare {
            Standing::Coulomb
        } else if self.form.bare || !tyres() {
            return None;
        } else if self.form.plain {
            Standing::Springs
        } else {
            Standing::Dampers
        };
        let known = self.form.elements.rubbing == 0 && self.form.classical && unit.propulsion == Propulsion::Prescribed;
        known.then_some(Gait { contacts: contacts.len(), coordinates: unit.coordinates.len(), law })
    }
}

impl<'s, L: Lane, const K: usize, const N: usize, const LAW: u8> Swift<'s, L, K, N, LAW> {
    /// From where a stepper of this gait is, at a speed [m/s].
    #[inline(always)]
    pub fn new(stepper: &'s Stepper<L>, state: &State<L>, speed: L) -> Self {
        let zero = L::splat(0.0);
        let rig = &stepper.units[0].rig;
        let mut swift = Swift {
            newmark: stepper.newmark,
            speed,
            modal: [stepper.modal.omega2(), stepper.modal.rates(), stepper.modal.inverse()],
            linear: rig.matrices().map(|matrix| if LAW == COULOMB { &[][..] } else { &matrix[..N * N] }),
            rows: &rig.rows()[..K * N],
            receptance: &rig.receptance()[..K * N],
            floors: [zero; K],
            rates: [zero; K],
            sliders: [Slider { stiffness: zero, give: zero, initial: zero, limit: zero }; K],
            tolerance: stepper.elements.tolerance,
            coordinates: [Coordinate::rest(); N],
            increments: [zero; K],
            shortenings: [zero; K],
            frictions: [zero; K],
        };
        swift.coordinates.copy_from_slice(&state.coordinates[..N]);
        for (k, contact) in stepper.elements.contacts[..K].iter().enumerate() {
            swift.floors[k] = contact.floor();
            swift.rates[k] = contact.weights.rate;
            if let Some(slider) = contact.slider() {
                swift.sliders[k] = slider;
            }
            swift.increments[k] = state.increments[k];
            swift.shortenings[k] = state.strokes[k].shortening;
            swift.frictions[k] = state.strokes[k].friction;
        }
        swift
    }

    /// Hands the state of the vehicle back.
    #[inline(always)]
    pub fn end(&self, state: &mut State<L>) {
        state.coordinates[..N].copy_from_slice(&self.coordinates);
        state.increments[..K].copy_from_slice(&self.increments);
        for (k, stroke) in state.strokes[..K].iter_mut().enumerate() {
            (stroke.shortening, stroke.friction) = (self.shortenings[k], self.frictions[k]);
        }
    }

    /// Advances the modes and the vehicle by one step, with the interaction where it ends, mode by mode and then what is
    /// of all, and what lies under each contact; how contacts feel each other `alone` counts where there is no bridge. Says
    /// whether the forces were found. There are M modes, or [`ANY`] number.
    #[inline(always)]
    pub fn step<const M: usize>(
        &mut self,
        modes: &mut [Coordinate<L>],
        interaction: &[f64],
        alone: &Coupling<L, K>,
        under: [Under<L>; K],
    ) -> bool {
        let zero = L::splat(0.0);
        let newmark = self.newmark;
        // The vehicle without the increments of the forces.
        let mut ahead = [Coordinate::rest(); N];
        for i in 0..N {
            ahead[i] = newmark.predict(self.coordinates[i]);
        }
        let mut free = [zero; N];
        let mut unloaded = ahead;
        if LAW != COULOMB {
            let [damping, stiffness, inverse] = self.linear;
            let (damping, stiffness, inverse) = (&damping[..N * N], &stiffness[..N * N], &inverse[..N * N]);
            let mut resisting = [zero; N];
            for i in 0..N {
                for j in 0..N {
                    let q = ahead[j];
                    resisting[i] = resisting[i] - (damping[i * N + j] * q.v + stiffness[i * N + j] * q.x);
                }
            }
            for i in 0..N {
                for j in 0..N {
                    free[i] = free[i] + inverse[i * N + j] * resisting[j];
                }
                unloaded[i] = newmark.correct(ahead[i], free[i]);
            }
        }
        // The modes under the static loads, and what they leave of the gaps.
        let mut gaps = [zero; K];
        for k in 0..K {
            gaps[k] = under[k].elevation;
        }
        if LAW == DAMPERS {
            for k in 0..K {
                gaps[k] = gaps[k] + self.rates[k] * self.speed * under[k].slope;
            }
        }
        let (each, count) = (of_mode(K, LAW), if M == ANY { modes.len() } else { M });
        let modes = &mut modes[..count];
        let [omega2, damping, inverse] = self.modal;
        let (omega2, damping, inverse) = (&omega2[..count], &damping[..count], &inverse[..count]);
        let (of_modes, of_all) = interaction.split_at(if count == 0 { 0 } else { each * count });
        for ((m, mode), of) in modes.iter_mut().enumerate().zip(of_modes.chunks_exact(each)) {
            let predicted = newmark.predict(*mode);
            let resisting = omega2[m] * predicted.x + damping[m] * predicted.v;
            let mut force = L::splat(of[K]) - resisting;
            for k in 1..K {
                force = force + L::splat(of[K + k]);
            }
            let a = inverse[m] * force;
            let loaded = newmark.correct(predicted, a);
            for k in 0..K {
                let mut value = L::splat(of[k]) * loaded.x;
                if LAW == DAMPERS {
                    let rate = L::splat(of[k]) * loaded.v + L::splat(of[3 * K + k]) * loaded.x;
                    value = value + self.rates[k] * rate;
                }
                gaps[k] = gaps[k] - value;
            }
            *mode = Coordinate { a, ..predicted };
        }
        for k in 0..K {
            for (row, q) in self.rows[..K * N][k * N..][..N].iter().zip(&unloaded) {
                let value = if LAW == DAMPERS { q.x + self.rates[k] * q.v } else { q.x };
                gaps[k] = gaps[k] + *row * value;
            }
        }
        // The forces.
        let solved = match count {
            0 => self.solve(alone, gaps),
            _ => self.solve(&Coupling::of(of_all, L::splat), gaps),
        };
        let Some(increments) = solved else { return false };
        self.increments = increments;
        // All under them.
        for (mode, of) in modes.iter_mut().zip(of_modes.chunks_exact(each)) {
            let mut a = mode.a;
            for k in 0..K {
                a = a + L::splat(of[2 * K + k]) * increments[k];
            }
            *mode = newmark.correct(*mode, a);
        }
        for (i, (own, ahead)) in self.coordinates.iter_mut().zip(&ahead).enumerate() {
            let mut a = free[i];
            for k in 0..K {
                a = a - self.receptance[..K * N][k * N + i] * increments[k];
            }
            *own = newmark.correct(*ahead, a);
        }
        true
    }

    /// Solves for the increments as [`super::Elements::solve`] does, and commits the suspensions to them.
    #[inline(always)]
    fn solve(&mut self, coupling: &Coupling<L, K>, gaps: [L; K]) -> Option<[L; K]> {
        let zero = L::splat(0.0);
        let held = &coupling.held;
        let (mut stuck, mut beside) = ([zero; K], [zero; K]);
        for k in 0..K {
            if LAW == COULOMB {
                let slider = &self.sliders[k];
                stuck[k] = zero - held[k].slope * self.shortenings[k];
                beside[k] = slider.initial - slider.stiffness * self.shortenings[k];
            }
        }
        let mut p = self.increments;
        let mut done = self.sweep(coupling, &gaps, (&stuck, &beside), None, &mut p);
        if K > 1 {
            // The second sweep comes without asking whether the first was enough, as it hardly ever is: in lanes that are
            // done it changes nothing.
            done = self.sweep(coupling, &gaps, (&stuck, &beside), Some(done), &mut p);
            for _ in 2..SWEEPS {
                if L::all(done) {
                    break;
                }
                done = self.sweep(coupling, &gaps, (&stuck, &beside), Some(done), &mut p);
            }
            if !L::all(done) {
                return None;
            }
        }
        for k in 0..K {
            if LAW == COULOMB {
                let slider = &self.sliders[k];
                let trial = p[k] + beside[k];
                let friction = slip(trial, slider.limit);
                self.shortenings[k] = self.shortenings[k] + (trial - friction) * slider.give;
                self.frictions[k] = friction;
            }
        }
        Some(p)
    }

    /// Goes once through the increments `p`, in lanes that are not `done` yet; says which are then.
    #[inline(always)]
    fn sweep(
        &self,
        Coupling { compliance, held }: &Coupling<L, K>,
        gaps: &[L; K],
        (stuck, beside): (&[L; K], &[L; K]),
        done: Option<L::Mask>,
        p: &mut [L; K],
    ) -> L::Mask {
        let mut left = L::splat(0.0);
        for k in 0..K {
            let mut others = gaps[k];
            for j in 0..K {
                if j != k {
                    others = others - compliance[k][j] * p[j];
                }
            }
            let mut found = held[k].gain * others;
            if LAW == COULOMB {
                found = found + stuck[k];
                let trial = found + beside[k];
                found = found - held[k].share * (trial - slip(trial, self.sliders[k].limit));
            }
            found = self.floors[k].larger(found);
            if let Some(done) = done {
                found = L::select(done, p[k], found);
            }
            if k > 0 {
                left = left + held[k].reach * (found - p[k]).magnitude();
            }
            p[k] = found;
        }
        let settled = left.less(self.tolerance);
        done.map_or(settled, |done| done | settled)
    }
}

/// Friction of a suspension that would carry so much if it did not slip.
#[inline(always)]
fn slip<L: Lane>(trial: L, limit: L) -> L {
    trial.smaller(limit).larger(-limit)
}
