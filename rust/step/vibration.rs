//! Free vibration after a crossing: the bridge by itself, and how far it can still swing.
//!
//! Once all vehicles have left, nothing but the modes moves: ẍ + Dẋ + Ω²x = 0, by Newmark's method with γ = ½. With
//! k = (¼ − β)h² and z = x + kẍ that method is the trapezoidal rule, z₁ − z₀ = h(ẋ₀ + ẋ₁)/2 and ẋ₁ − ẋ₀ = h(ẍ₀ + ẍ₁)/2,
//! for (1 − kΩ²)z̈ + Dż + Ω²z = 0. So with v̄ = (ẋ₀ + ẋ₁)/2 the energy
//!
//! E = ẋ·(1 − kΩ²)ẋ + z·Ω²z changes by E₁ − E₀ = −2h v̄·Dv̄
//!
//! in a step: it never grows, is positive within the limit of stability (kω² < 1), and is each mode's own where the
//! damping is classical. It is that of the *discrete* solution, so what follows from it holds whatever the step. With
//! g = 1/(1 − kω²) it is x = g(z + kdẋ), and the largest |x| of energy E is √E g √(1/ω² + k²d²g); a response
//! R = Σ c x is at most the sum of these, each times |c|.
//!
//! Without loads on the bridge every recovery comes to such a sum: that from rates, with classical damping, is
//! −Σ i(ẍ + dẋ) = Σ iω²x. A full D hands energy from mode to mode: E is then that of all together, R at most √E times
//! the length of its coefficients of ωz and ẋ/√g (Cauchy and Schwarz), and what is not in proportion to D of the damping
//! forces in the rows from rates, q·ẋ, adds at most √E |q| √g.
//!
//! Modes that are followed exactly have k = 0: E is the energy itself.

use serde::{Deserialize, Serialize};

use super::bridge_step::ModalSolve;
use super::newmark::Newmark;
use super::oscillator::Oscillator;
use crate::coordinate::Coordinate;
use crate::lane::Lane;

/// Steps from one look whether the tail may end to the next; the first is when the last vehicle has left.
pub const LOOK_EVERY: usize = 32;

/// The longest tail, in periods of the slowest included mode.
pub const PERIODS: f64 = 10.0;

/// Most steps of a tail that is not given, a whole number of looks, with steps of `h` [s] and the slowest mode's ω²;
/// there is room for so many.
pub fn most_steps(slowest: f64, h: f64, room: f64) -> usize {
    let looks = PERIODS * std::f64::consts::TAU / slowest.sqrt() / h / LOOK_EVERY as f64;
    LOOK_EVERY * looks.ceil().min((room / LOOK_EVERY as f64).floor()).max(0.0) as usize
}

fn root<L: Lane>(value: L) -> L {
    L::from_fn(|lane| value.get(lane).sqrt())
}

/// The bridge by itself, without loads.
#[derive(Debug, Clone)]
pub struct Vibration<L> {
    swing: Swing<L>,
    /// k.
    lag: L,
    /// Whether no energy goes from mode to mode.
    apart: bool,
    /// ω² of each mode.
    stiffness: Vec<L>,
    /// 1 − kω² of each mode.
    mass: Vec<L>,
    /// Largest |x| of each mode by √E.
    most: Vec<L>,
    /// Largest |ẋ| of any mode by √E.
    fastest: L,
}

/// How the modes come from one step to the next.
#[derive(Debug, Clone)]
enum Swing<L> {
    /// By Newmark's method, with room to work in.
    Newmark {
        newmark: Newmark<L>,
        modal: ModalSolve<L>,
        predicted: Vec<Coordinate<L>>,
        forces: Vec<L>,
        accelerations: Vec<L>,
    },
    /// Exactly.
    Exact(Vec<Oscillator<L>>),
}

impl<L: Lane> Vibration<L> {
    /// In these steps.
    pub fn new(newmark: Newmark<L>, modal: ModalSolve<L>) -> Self {
        let (zero, one) = (L::splat(0.0), L::splat(1.0));
        let k = L::splat(0.25) * newmark.h * newmark.h - newmark.new;
        let stiffness = modal.omega2().to_vec();
        let mass: Vec<L> = stiffness.iter().map(|w2| one - k * *w2).collect();
        let fastest = mass.iter().fold(zero, |most, mass| (one / *mass).larger(most));
        let (modes, rates) = (modal.modes(), modal.rates());
        let whole = rates.iter().fold(zero, |sum, d| sum + *d * *d);
        let most = (mass.iter().zip(&stiffness).enumerate()).map(|(m, (mass, w2))| {
            let own = if modal.classical { rates[m] } else { rates[m * modes + m] };
            let by_rate = if modal.apart { own * own / *mass } else { whole * fastest };
            root(one / *w2 + k * k * by_rate) / *mass
        });
        Vibration {
            most: most.collect(),
            fastest: root(fastest),
            lag: k,
            apart: modal.apart,
            stiffness,
            mass,
            swing: Swing::Newmark {
                predicted: vec![Coordinate::rest(); modes],
                forces: vec![zero; modes],
                accelerations: vec![zero; modes],
                newmark,
                modal,
            },
        }
    }

    /// Of modes each of which is followed exactly.
    pub fn exact(modes: Vec<Oscillator<L>>) -> Self {
        let one = L::splat(1.0);
        let stiffness: Vec<L> = modes.iter().map(Oscillator::omega2).collect();
        Vibration {
            lag: L::splat(0.0),
            apart: true,
            mass: vec![one; modes.len()],
            most: stiffness.iter().map(|w2| root(one / *w2)).collect(),
            fastest: one,
            stiffness,
            swing: Swing::Exact(modes),
        }
    }

    /// Advances the modes by one step, as [`crate::step`] does where no contact is on the bridge, to the bit.
    #[inline(always)]
    pub fn swing(&mut self, modes: &mut [Coordinate<L>]) {
        match &mut self.swing {
            Swing::Newmark { newmark, modal, predicted, forces, accelerations } => {
                for (predicted, mode) in predicted.iter_mut().zip(modes.iter()) {
                    *predicted = newmark.predict(*mode);
                }
                modal.resist(modal.classical, predicted, forces);
                for force in forces.iter_mut() {
                    *force = -*force;
                }
                modal.apply(modal.classical, forces, accelerations);
                for ((mode, predicted), a) in modes.iter_mut().zip(predicted).zip(accelerations) {
                    *mode = newmark.correct(*predicted, *a);
                }
            }
            Swing::Exact(own) => {
                for (mode, own) in modes.iter_mut().zip(own) {
                    *mode = own.accelerated(own.swing(*mode), L::splat(0.0));
                }
            }
        }
    }

    /// What free vibration can reach from here on: an axle that stands on a free end of the bridge now, and is gone in
    /// the next step, makes no difference.
    #[inline(always)]
    pub fn reach(&mut self, modes: &[Coordinate<L>]) -> Reach<L> {
        let mut next = modes.to_vec();
        self.swing(&mut next);
        let energy = |m: usize, c: &Coordinate<L>| {
            let z = c.x + self.lag * c.a;
            self.mass[m] * c.v * c.v + self.stiffness[m] * z * z
        };
        let both = modes.iter().zip(&next).enumerate().map(|(m, (now, next))| [energy(m, now), energy(m, next)]);
        let zero = L::splat(0.0);
        let [now, next] = both.clone().fold([zero; 2], |[a, b], [now, next]| [a + now, b + next]);
        let all = root(now.larger(next));
        let (most, apart) = (&self.most, self.apart);
        let each = both.zip(most).map(|([now, next], most)| {
            let own = if apart { root(now.larger(next)) } else { all };
            own * *most
        });
        Reach { modes: each.collect(), apart, velocity: all * self.fastest }
    }
}

/// What free vibration can reach.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Reach<L> {
    /// Largest magnitude of each modal coordinate.
    modes: Vec<L>,
    /// Whether all can be so large at a time, energy not going from mode to mode.
    apart: bool,
    /// Largest length of all modal velocities.
    velocity: L,
}

impl<L: Lane> Reach<L> {
    /// That of one lane.
    pub fn one(&self, lane: usize) -> Reach<f64> {
        let modes = self.modes.iter().map(|mode| mode.get(lane)).collect();
        Reach { modes, apart: self.apart, velocity: self.velocity.get(lane) }
    }

    /// Of a bridge on whose A and Ȧ the rows have these factors, as [`crate::ensemble`] varies bridges.
    pub fn scaled(mut self, coordinates: L, rates: L) -> Self {
        self.modes.iter_mut().for_each(|mode| *mode = coordinates * *mode);
        self.velocity = rates * self.velocity;
        self
    }

    /// Largest magnitude of each modal coordinate.
    pub fn coordinates(&self) -> &[L] {
        &self.modes
    }

    /// For the lanes of a mask that of `other`.
    pub fn select(&mut self, mask: L::Mask, other: &Self) {
        for (own, other) in self.modes.iter_mut().zip(&other.modes) {
            *own = L::select(mask, *other, *own);
        }
        self.velocity = L::select(mask, other.velocity, self.velocity);
    }

    /// Largest magnitude of a response.
    #[inline(always)]
    pub fn of(&self, (factors, rest): (&[f64], f64)) -> L {
        let zero = L::splat(0.0);
        let terms = factors.iter().zip(&self.modes).map(|(c, most)| L::splat(c.abs()) * *most);
        let sum = match self.apart {
            true => terms.fold(zero, |sum, term| sum + term),
            false => root(terms.fold(zero, |sum, term| sum + term * term)),
        };
        sum + L::splat(rest) * self.velocity
    }
}
