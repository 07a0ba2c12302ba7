//! What free vibration after a crossing can reach, and how long it is kept: until no response can exceed what it has
//! reached.
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

use serde::{Deserialize, Serialize};

use crate::crossing::ModalBridge;
use crate::error::Error;
use crate::history::History;
use crate::influence::{Quantity, Responses};
use crate::lane::Lane;
use crate::modal::{ModalDamping, ModalSolve};
use crate::newmark::{Coordinate, Newmark};
use crate::recovery::Rows;

/// Steps from one look whether the tail may end to the next; the first is when the last vehicle has left.
pub const LOOK_EVERY: usize = 32;

/// The longest tail, in periods of the slowest included mode.
pub const PERIODS: f64 = 10.0;

/// Part of an extreme by which the tail may still have exceeded it.
const TOLERANCE: f64 = 1e-3;

/// Response that is nothing but rounding, relative to what the static loads can come to.
const ROUNDING: f64 = 1e-9;

/// Parts of an extreme, and of the largest of its kind along the bridge, which to exceed is worth a word.
const WORTH: [f64; 2] = [1e-2, 1e-3];

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
    newmark: Newmark<L>,
    modal: ModalSolve<L>,
    /// ω² of each mode.
    stiffness: Vec<L>,
    /// 1 − kω² of each mode.
    mass: Vec<L>,
    /// Largest |x| of each mode by √E.
    most: Vec<L>,
    /// Largest |ẋ| of any mode by √E.
    fastest: L,
    predicted: Vec<Coordinate<L>>,
    forces: Vec<L>,
    accelerations: Vec<L>,
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
            predicted: vec![Coordinate::rest(); modes],
            forces: vec![zero; modes],
            accelerations: vec![zero; modes],
            newmark,
            modal,
            stiffness,
            mass,
        }
    }

    /// ω² of the slowest mode in a lane.
    pub fn slowest(&self, lane: usize) -> f64 {
        self.stiffness.iter().fold(f64::INFINITY, |least, w2| least.min(w2.get(lane)))
    }

    /// Advances the modes by one step, as [`crate::step`] does where no contact is on the bridge, to the bit.
    #[inline(always)]
    pub fn swing(&mut self, modes: &mut [Coordinate<L>]) {
        for (predicted, mode) in self.predicted.iter_mut().zip(modes.iter()) {
            *predicted = self.newmark.predict(*mode);
        }
        self.modal.resist(self.modal.classical, &self.predicted, &mut self.forces);
        for force in &mut self.forces {
            *force = -*force;
        }
        self.modal.apply(self.modal.classical, &self.forces, &mut self.accelerations);
        for ((mode, predicted), a) in modes.iter_mut().zip(&self.predicted).zip(&self.accelerations) {
            *mode = self.newmark.correct(*predicted, *a);
        }
    }

    /// What free vibration can reach from here on: an axle that stands on a free end of the bridge now, and is gone in
    /// the next step, makes no difference.
    #[inline(always)]
    pub fn reach(&mut self, modes: &[Coordinate<L>]) -> Reach<L> {
        let mut next = modes.to_vec();
        self.swing(&mut next);
        let k = L::splat(0.25) * self.newmark.h * self.newmark.h - self.newmark.new;
        let energy = |m: usize, c: &Coordinate<L>| {
            let z = c.x + k * c.a;
            self.mass[m] * c.v * c.v + self.stiffness[m] * z * z
        };
        let both = modes.iter().zip(&next).enumerate().map(|(m, (now, next))| [energy(m, now), energy(m, next)]);
        let zero = L::splat(0.0);
        let [now, next] = both.clone().fold([zero; 2], |[a, b], [now, next]| [a + now, b + next]);
        let all = root(now.larger(next));
        let (most, apart) = (&self.most, self.modal.apart);
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
    fn of(&self, (factors, rest): (&[f64], f64)) -> L {
        let zero = L::splat(0.0);
        let terms = factors.iter().zip(&self.modes).map(|(c, most)| L::splat(c.abs()) * *most);
        let sum = match self.apart {
            true => terms.fold(zero, |sum, term| sum + term),
            false => root(terms.fold(zero, |sum, term| sum + term * term)),
        };
        sum + L::splat(rest) * self.velocity
    }
}

/// Responses of the bridge in free vibration, as sums over the modal coordinates.
#[derive(Debug, Clone)]
pub struct FreeRows {
    /// Which of all responses each row is.
    pub responses: Vec<usize>,
    modes: usize,
    /// What multiplies the modal coordinates, row by row.
    factors: Vec<f64>,
    /// Length of what multiplies the modal velocities besides, by row.
    rest: Vec<f64>,
    /// The kind of each, shears on both sides of a section being one.
    kinds: Vec<usize>,
    /// What of each kind is rounding, by the static loads of all axles [unit/N].
    rounding: [f64; KINDS],
}

/// Kinds of response: deflections, moments, shears, reactions, moments of clamps.
const KINDS: usize = 5;

impl FreeRows {
    /// Of all responses.
    pub fn new(rows: &Rows, responses: &Responses, model: &ModalBridge) -> Self {
        let modes = model.omega.len();
        let (mut factors, mut rest) = (Vec::with_capacity(rows.len() * modes), Vec::with_capacity(rows.len()));
        for r in 0..rows.len() {
            if !rows.by_rates() {
                factors.extend((0..modes).map(|m| rows.factor(r, m)));
                rest.push(0.0);
                continue;
            }
            let inertia = |m: usize| -rows.factor(r, modes + m);
            factors.extend((0..modes).map(|m| inertia(m) * model.omega[m].powi(2)));
            rest.push(match &model.damping {
                ModalDamping::Classical(_) => 0.0,
                ModalDamping::Coupled(d) => {
                    let rate = |m: usize| (0..modes).map(|i| inertia(i) * d[(i, m)]).sum::<f64>() + rows.factor(r, m);
                    (0..modes).map(|m| rate(m).powi(2)).sum::<f64>().sqrt()
                }
            });
        }
        let kind = |quantity: Quantity| match quantity {
            Quantity::Deflection => 0,
            Quantity::Moment => 1,
            Quantity::ShearLeft | Quantity::ShearRight => 2,
            Quantity::Reaction => 3,
            Quantity::ClampMoment => 4,
        };
        let mut kinds = vec![0; rows.len()];
        for quantity in Quantity::ALL {
            kinds[responses.range(quantity)].fill(kind(quantity));
        }
        let slowest = model.omega.iter().copied().fold(f64::INFINITY, f64::min);
        let length = model.shapes.mesh().length();
        let deflection = model.shapes.largest_sum_of_squares() / slowest.powi(2);
        let rounding = [deflection, length, 1.0, 1.0, length].map(|largest| ROUNDING * largest);
        FreeRows { responses: (0..rows.len()).collect(), modes, factors, rest, kinds, rounding }
    }

    /// Some of them.
    pub fn of(&self, some: impl Iterator<Item = usize> + Clone) -> Self {
        FreeRows {
            responses: some.clone().collect(),
            modes: self.modes,
            factors: some.clone().flat_map(|r| self.row(r).0).copied().collect(),
            rest: some.clone().map(|r| self.rest[r]).collect(),
            kinds: some.map(|r| self.kinds[r]).collect(),
            rounding: self.rounding,
        }
    }

    fn row(&self, r: usize) -> (&[f64], f64) {
        (&self.factors[r * self.modes..(r + 1) * self.modes], self.rest[r])
    }

    /// Largest magnitude of every response.
    pub fn bounds<L: Lane>(&self, reach: &Reach<L>) -> Vec<L> {
        (0..self.rest.len()).map(|r| reach.of(self.row(r))).collect()
    }

    /// In which lanes no response can exceed by more than a thousandth what it has reached, its largest and its smallest
    /// being those that `seen` tells; the static `load` is that of all axles [N].
    #[inline(always)]
    pub fn settled<L: Lane>(&self, reach: &Reach<L>, load: L, seen: impl Fn(usize) -> [L; 2]) -> L::Mask {
        let mut unsettled = L::never();
        for r in 0..self.rest.len() {
            unsettled = unsettled | self.unsettled(r, reach, load, seen(r));
            if !L::any(!unsettled) {
                break;
            }
        }
        !unsettled
    }

    /// In which lanes one row can.
    #[inline(always)]
    pub fn unsettled<L: Lane>(&self, r: usize, reach: &Reach<L>, load: L, [max, min]: [L; 2]) -> L::Mask {
        let (bound, floor) = (reach.of(self.row(r)), L::splat(self.rounding[self.kinds[r]]) * load);
        let beyond = |extreme: L| extreme + L::splat(TOLERANCE) * extreme.magnitude() + floor;
        // What is no number is not settled.
        !bound.less(beyond(max)) | !bound.less(beyond(-min))
    }

    /// How far free vibration can exceed what has been seen, in parts of the largest of its kind along the bridge, and
    /// the row where it is most: twice its number, and one more of the smallest. Zero where that is not worth a word.
    #[inline(always)]
    pub fn growth<L: Lane>(&self, reach: &Reach<L>, seen: impl Fn(usize) -> [L; 2]) -> [L; 2] {
        let zero = L::splat(0.0);
        let mut largest = [zero; KINDS];
        for (r, &kind) in self.kinds.iter().enumerate() {
            let [max, min] = seen(r);
            largest[kind] = max.magnitude().larger(min.magnitude()).larger(largest[kind]);
        }
        let (mut growth, mut side_of_row) = (zero, zero);
        for (r, &kind) in self.kinds.iter().enumerate() {
            let (bound, [max, min]) = (reach.of(self.row(r)), seen(r));
            for (side, extreme) in [max, -min].into_iter().enumerate() {
                let excess = bound - extreme;
                let least = L::splat(WORTH[0]) * extreme.magnitude() + L::splat(WORTH[1]) * largest[kind];
                let part = excess / largest[kind];
                let more = !(!least.less(excess) | !growth.less(part));
                growth = L::select(more, part, growth);
                side_of_row = L::select(more, L::splat((2 * r + side) as f64), side_of_row);
            }
        }
        [growth, side_of_row]
    }
}

/// Looks at a crossing on its way.
pub trait Watch {
    /// Whether nothing that follows what has been recorded can matter, given what free vibration can reach.
    fn enough(
        &mut self,
        history: &mut History,
        reach: &Reach<f64>,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<bool, Error>;
}

/// Looks at nothing, so that a tail that is not given is as long as it may be.
pub struct Blind;

impl Watch for Blind {
    fn enough(&mut self, _: &mut History, _: &Reach<f64>, _: &mut dyn FnMut() -> bool) -> Result<bool, Error> {
        Ok(false)
    }
}
