//! Statistics of samples side by side: axle loads, wheels off the road, accelerations, and responses as axles pass.

use super::selection::Selection;
use super::table::{PassingInfluence, Stop};
use super::tape::{Tape, Widths};
use crate::crossing::watched::Watched;
use crate::lane::Lane;

/// Contact forces and accelerations over a crossing.
#[derive(Debug, Clone)]
pub struct Ride<L> {
    /// Extremes of the axle loads.
    pub loads: Vec<Watched<L>>,
    /// Sums of the squares by which the loads differ from their static values, on the bridge.
    pub deviations: Vec<L>,
    /// Steps off the road.
    pub aloft: Vec<L>,
    /// Times the axle left it.
    pub lift_offs: Vec<L>,
    /// Zero while it is off.
    grounded: Vec<L>,
    /// Largest magnitude of the accelerations.
    pub accelerations: Vec<L>,
    /// Sums of their squares, on the bridge.
    pub squares: Vec<L>,
}

impl<L: Lane> Ride<L> {
    /// Nothing seen yet.
    pub fn nothing(axles: usize, bodies: usize) -> Self {
        let (zero, one) = (L::splat(0.0), L::splat(1.0));
        Ride {
            loads: vec![Watched::nothing(); axles],
            deviations: vec![zero; axles],
            aloft: vec![zero; axles],
            lift_offs: vec![zero; axles],
            grounded: vec![one; axles],
            accelerations: vec![zero; bodies],
            squares: vec![zero; bodies],
        }
    }

    /// Takes in the last chunk of a stretch; `left` says how much of the step that follows a step the lanes go, and sums
    /// grow where the steps are `counted`. Lanes that have ended go on as they were.
    #[inline(always)]
    pub fn take(&mut self, stretch: &Tape<L>, static_loads: &[L], left: impl Fn(usize) -> L, counted: bool) {
        let (zero, one) = (L::splat(0.0), L::splat(1.0));
        let Some(chunk) = stretch.chunks().last() else { return };
        let (widths, width, from) = (&stretch.widths, stretch.widths.all(), chunk.from);
        for (k, static_load) in static_loads.iter().enumerate() {
            let number = widths.loads() + k;
            let loads = || chunk.rows.chunks_exact(width).map(|row| row[number]).enumerate();
            let [most, least] = chunk.ends[number];
            if L::any(self.loads[k].max.less(most) | least.less(self.loads[k].min)) {
                let mut watched = self.loads[k];
                for (i, load) in loads() {
                    watched.take(load, L::splat((from + i) as f64));
                }
                self.loads[k] = watched;
            }
            if counted {
                let mut squares = self.deviations[k];
                for (_, load) in loads() {
                    let deviation = load - *static_load;
                    squares = squares + deviation * deviation;
                }
                self.deviations[k] = squares;
            }
            // Most of the time no wheel is off the road.
            if !L::any(!zero.less(least) | self.grounded[k].less(one)) {
                continue;
            }
            let (mut aloft, mut lift_offs, mut grounded) = (self.aloft[k], self.lift_offs[k], self.grounded[k]);
            for (i, load) in loads() {
                // Exactly zero is what a wheel off the road carries.
                let now = L::select(!(load.less(zero) | zero.less(load)), zero, one);
                aloft = aloft + left(from + i) * (one - now);
                lift_offs = lift_offs + grounded * (one - now);
                grounded = now;
            }
            (self.aloft[k], self.lift_offs[k], self.grounded[k]) = (aloft, lift_offs, grounded);
        }
        for (b, (largest, squares)) in self.accelerations.iter_mut().zip(&mut self.squares).enumerate() {
            let number = widths.accelerations() + b;
            let [most, least] = chunk.ends[number];
            *largest = largest.larger(most.magnitude()).larger(least.magnitude());
            if counted {
                let mut sum = *squares;
                for row in chunk.rows.chunks_exact(width) {
                    sum = sum + row[number] * row[number];
                }
                *squares = sum;
            }
        }
    }
}

/// One response at a step.
#[inline(always)]
pub fn value<L: Lane>(factors: &[f64], influence: &[f64], row: &[L]) -> L {
    let mut value = L::splat(factors[0]) * row[0];
    for (factor, a) in factors[1..].iter().zip(&row[1..]) {
        value = value + L::splat(*factor) * *a;
    }
    for (g, load) in influence.iter().zip(&row[factors.len()..]) {
        value = value + L::splat(*g) * *load;
    }
    value
}

/// Takes in a moment between two steps, given their rows. From coordinate number `jumps` on they jump with a load: Ä
/// follows it at once, A and Ȧ do not. `between` is scratch.
#[inline(always)]
#[allow(clippy::too_many_arguments)] // each is one thing
pub fn watch_stop<L: Lane>(
    watched: &mut [Watched<L>],
    look: &Selection,
    (stop, number, moment): (&Stop, usize, &PassingInfluence),
    [before, after]: [&[L]; 2],
    widths: &Widths,
    jumps: usize,
    between: &mut Vec<L>,
) {
    let fraction = L::splat(stop.fraction);
    let (c, a) = (widths.coordinates, widths.axles);
    between.clear();
    for i in 0..c + a {
        between.push(before[i] + fraction * (after[i] - before[i]));
    }
    if let Some(step) = stop.jump {
        let side = if step == stop.step { after } else { before };
        between[jumps..c].copy_from_slice(&side[jumps..c]);
        between[c + stop.axle] = side[c + stop.axle];
    }
    watch_moment(watched, look, (stop, number, moment), between);
}

/// Takes in a moment at which an axle passes, given coordinates and loads then.
#[inline(always)]
pub fn watch_moment<L: Lane>(
    watched: &mut [Watched<L>],
    look: &Selection,
    (stop, number, moment): (&Stop, usize, &PassingInfluence),
    then: &[L],
) {
    let at = L::splat(number as f64);
    let c = look.rows.first().map_or(0, |row| row.factors.len());
    for (&r, influence) in look.asked[stop.asked].iter().zip(moment.influence.chunks_exact(then.len() - c)) {
        let value = value(&look.rows[r].factors, influence, then);
        watched[r].take(value, at);
        if let Some((tip, sign)) = stop.tip
            && tip == r
        {
            watched[r].take(value + L::splat(sign) * then[c + stop.axle], at);
        }
    }
}
