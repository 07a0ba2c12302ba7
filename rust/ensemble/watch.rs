//! What is seen of samples side by side as they pass: extremes and when, sums of squares, wheels off the road.
//!
//! A response is a sum of products, Σ factor·coordinate + Σ influence·load. Rounding being monotone, the same sum with
//! every product at its largest over some steps is no less than any value the response takes there, to the last bit. So
//! a glance at every few steps finds values that the extremes must reach, and of the steps between only those are looked
//! at, one by one and in order, whose bounds reach them.

use super::look::Row;
use super::table::{CHUNK, Chunk, Stop};
use crate::lane::Lane;

/// Largest and smallest so far, and when: the number of a step, or of a stop.
#[derive(Debug, Clone, Copy)]
pub struct Watched<L> {
    /// Largest.
    pub max: L,
    /// When.
    pub max_at: L,
    /// Smallest.
    pub min: L,
    /// When.
    pub min_at: L,
}

impl<L: Lane> Watched<L> {
    /// Nothing seen yet.
    #[inline(always)]
    pub fn nothing() -> Self {
        let (low, high, zero) = (L::splat(f64::NEG_INFINITY), L::splat(f64::INFINITY), L::splat(0.0));
        Watched { max: low, max_at: zero, min: high, min_at: zero }
    }

    /// At rest at step zero.
    #[inline(always)]
    pub fn rest() -> Self {
        let zero = L::splat(0.0);
        Watched { max: zero, max_at: zero, min: zero, min_at: zero }
    }

    /// This, but for the lanes of a mask, which are as they were.
    #[inline(always)]
    pub fn unless(self, mask: L::Mask, before: Self) -> Self {
        Watched {
            max: L::select(mask, before.max, self.max),
            max_at: L::select(mask, before.max_at, self.max_at),
            min: L::select(mask, before.min, self.min),
            min_at: L::select(mask, before.min_at, self.min_at),
        }
    }

    /// Takes in a value; of equal values the first counts.
    #[inline(always)]
    pub fn take(&mut self, value: L, at: L) {
        let (above, below) = (self.max.less(value), value.less(self.min));
        self.max_at = L::select(above, at, self.max_at);
        self.min_at = L::select(below, at, self.min_at);
        self.max = value.larger(self.max);
        self.min = value.smaller(self.min);
    }
}

/// What a step leaves for recovery, in a row of numbers: coordinates, loads [N], vertical accelerations of the bodies
/// [m/s²]. Where responses do not feel the loads, zeros stand in their place and the loads follow.
#[derive(Debug, Clone, Copy)]
pub struct Widths {
    /// What the rows multiply.
    pub coordinates: usize,
    /// Axles.
    pub axles: usize,
    /// Bodies.
    pub bodies: usize,
    /// Whether responses feel the loads; by superposition they do not.
    pub felt: bool,
}

impl Widths {
    /// Numbers of a step.
    #[inline(always)]
    pub fn all(&self) -> usize {
        self.accelerations() + self.bodies
    }

    /// Where the loads begin.
    #[inline(always)]
    pub fn loads(&self) -> usize {
        if self.felt { self.coordinates } else { self.coordinates + self.axles }
    }

    /// Where the accelerations begin.
    #[inline(always)]
    pub fn accelerations(&self) -> usize {
        self.loads() + self.axles
    }
}

/// Contact forces and accelerations over a crossing.
#[derive(Debug, Clone)]
pub struct Ride<L> {
    /// Extremes of the axle loads.
    pub loads: Vec<Watched<L>>,
    /// Sums of the deviations of the loads from their static values and of their squares, on the bridge.
    pub sums: Vec<[L; 2]>,
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
            sums: vec![[zero; 2]; axles],
            aloft: vec![zero; axles],
            lift_offs: vec![zero; axles],
            grounded: vec![one; axles],
            accelerations: vec![zero; bodies],
            squares: vec![zero; bodies],
        }
    }

    /// Takes in the rows of steps from number `from` on; `left` says how much of the step that follows a step the lanes
    /// go, and sums grow where the steps are `counted`. Lanes that have ended go on as they were.
    #[inline(always)]
    pub fn take(
        &mut self,
        rows: &[L],
        widths: &Widths,
        static_loads: &[L],
        from: usize,
        left: impl Fn(usize) -> L,
        counted: bool,
    ) {
        let (zero, one) = (L::splat(0.0), L::splat(1.0));
        for (k, static_load) in static_loads.iter().enumerate() {
            let (mut watched, [mut sum, mut squares]) = (self.loads[k], self.sums[k]);
            let (mut aloft, mut lift_offs, mut grounded) = (self.aloft[k], self.lift_offs[k], self.grounded[k]);
            for (i, row) in rows.chunks_exact(widths.all()).enumerate() {
                let load = row[widths.loads() + k];
                watched.take(load, L::splat((from + i) as f64));
                if counted {
                    let deviation = load - *static_load;
                    sum = sum + deviation;
                    squares = squares + deviation * deviation;
                }
                // Exactly zero is what a wheel off the road carries.
                let off = !(load.less(zero) | zero.less(load));
                if L::any(off) || L::any(grounded.less(one)) {
                    let now = L::select(off, zero, one);
                    aloft = aloft + left(from + i) * (one - now);
                    lift_offs = lift_offs + grounded * (one - now);
                    grounded = now;
                }
            }
            (self.loads[k], self.sums[k]) = (watched, [sum, squares]);
            (self.aloft[k], self.lift_offs[k], self.grounded[k]) = (aloft, lift_offs, grounded);
        }
        for (b, (largest, squares)) in self.accelerations.iter_mut().zip(&mut self.squares).enumerate() {
            let (mut most, mut sum) = (*largest, *squares);
            for row in rows.chunks_exact(widths.all()) {
                let a = row[widths.accelerations() + b];
                most = most.larger(a.magnitude());
                if counted {
                    sum = sum + a * a;
                }
            }
            (*largest, *squares) = (most, sum);
        }
    }
}

/// One response at a step.
#[inline(always)]
fn value<L: Lane>(factors: &[f64], influence: &[f64], row: &[L]) -> L {
    let mut value = L::splat(factors[0]) * row[0];
    for (factor, a) in factors[1..].iter().zip(&row[1..]) {
        value = value + L::splat(*factor) * *a;
    }
    for (g, load) in influence.iter().zip(&row[factors.len()..]) {
        value = value + L::splat(*g) * *load;
    }
    value
}

/// Scratch of a [`Survey`].
#[derive(Debug, Clone)]
pub struct Glance<L> {
    /// What the extremes of each response must reach.
    glanced: Vec<[L; 2]>,
    /// Largest and smallest of what the responses are sums of.
    ends: Vec<[L; 2]>,
}

impl<L: Lane> Glance<L> {
    /// Nothing yet.
    pub fn new() -> Self {
        Glance { glanced: Vec::new(), ends: Vec::new() }
    }
}

impl<L: Lane> Default for Glance<L> {
    fn default() -> Self {
        Glance::new()
    }
}

/// Extremes of every response over a stretch of steps with loads on the bridge.
#[derive(Debug)]
pub struct Survey<'a, L> {
    /// The responses.
    pub rows: &'a [Row],
    /// Influence of the loads, chunk by chunk of the stretch.
    pub chunks: &'a [Chunk],
    /// Rows of the steps.
    pub steps: &'a [L],
    /// Numbers in these.
    pub widths: Widths,
    /// Number of the first step.
    pub from: usize,
}

impl<L: Lane> Survey<'_, L> {
    /// Looks at all of it.
    #[inline(always)]
    pub fn take(&self, watched: &mut [Watched<L>], scratch: &mut Glance<L>) {
        // What is known when this is compiled runs much faster: the usual numbers of modes and axles.
        macro_rules! sizes {
            ($($c:literal $a:literal),*) => {
                match (self.widths.coordinates, self.widths.axles) {
                    $(($c, $a) => self.of_sizes($c, $a, watched, scratch),)*
                    (c, a) => self.of_sizes(c, a, watched, scratch),
                }
            };
        }
        sizes!(2 2, 2 3, 2 5, 3 2, 3 3, 3 5, 4 2, 4 3, 4 5)
    }

    #[inline(always)]
    fn of_sizes(&self, c: usize, a: usize, watched: &mut [Watched<L>], scratch: &mut Glance<L>) {
        let Glance { glanced, ends } = scratch;
        let width = self.widths.all();
        let felt = c + a;
        let chunks = || self.steps.chunks(CHUNK * width).zip(self.chunks).enumerate();
        // The glance, at the middle of every chunk.
        glanced.clear();
        for (r, (Row { factors, .. }, seen)) in self.rows.iter().zip(watched.iter()).enumerate() {
            let (mut most, mut least) = (seen.max, seen.min);
            for (_, (steps, Chunk { influence, .. })) in chunks() {
                let count = steps.len() / width;
                let middle = count / 2;
                let influence = &influence[(r * count + middle) * a..][..a];
                let value = value(&factors[..c], influence, &steps[middle * width..][..felt]);
                most = value.larger(most);
                least = value.smaller(least);
            }
            glanced.push([most, least]);
        }
        // Largest and smallest of every number of a step over a chunk, in memory: it is chosen between them by address.
        ends.clear();
        ends.resize(felt, [L::splat(0.0); 2]);
        let ends = &mut ends[..felt];
        for (chunk, (steps, Chunk { influence, bounds })) in chunks() {
            let count = steps.len() / width;
            let mut positive = true;
            for (i, ends) in ends.iter_mut().enumerate() {
                let (mut most, mut least) = (steps[i], steps[i]);
                for step in 1..count {
                    let now = steps[step * width + i];
                    most = now.larger(most);
                    least = now.smaller(least);
                }
                *ends = [most, least];
                positive &= i < c || !L::any(least.less(L::splat(0.0)));
            }
            for (r, Row { factors, .. }) in self.rows.iter().enumerate() {
                let factors = &factors[..c];
                let seen = &mut watched[r];
                let [high, low] = reach(factors, &bounds[r * a..][..a], ends, positive);
                let [most, least] = glanced[r];
                let above = !(!seen.max.less(high) | high.less(most));
                let below = !(!low.less(seen.min) | least.less(low));
                if !L::any(above | below) {
                    continue;
                }
                let mut own = *seen;
                let influence = &influence[r * count * a..][..count * a];
                for step in 0..count {
                    let row = &steps[step * width..][..felt];
                    let value = value(factors, &influence[step * a..][..a], row);
                    own.take(value, L::splat((self.from + chunk * CHUNK + step) as f64));
                }
                *seen = own;
            }
        }
    }
}

/// Bounds of a response where coordinates and loads are between their `ends`, largest and smallest; whether the loads
/// are all `positive`.
#[inline(always)]
fn reach<L: Lane>(factors: &[f64], bounds: &[[f64; 2]], ends: &[[L; 2]], positive: bool) -> [L; 2] {
    // A negative factor takes the other end.
    let first = L::splat(factors[0]);
    let turned = usize::from(factors[0] < 0.0);
    let mut high = first * ends[0][turned];
    let mut low = first * ends[0][1 - turned];
    for (i, &factor) in factors.iter().enumerate().skip(1) {
        let turned = usize::from(factor < 0.0);
        high = high + L::splat(factor) * ends[i][turned];
        low = low + L::splat(factor) * ends[i][1 - turned];
    }
    for (k, &[from, to]) in bounds.iter().enumerate() {
        let ends = &ends[factors.len() + k];
        let (least, most) = (L::splat(from), L::splat(to));
        if positive {
            high = high + most * ends[usize::from(to < 0.0)];
            low = low + least * ends[usize::from(from >= 0.0)];
        } else {
            let (a, b) = (most * ends[0], most * ends[1]);
            let (c, d) = (least * ends[0], least * ends[1]);
            high = high + a.larger(b).larger(c.larger(d));
            low = low + a.smaller(b).smaller(c.smaller(d));
        }
    }
    [high, low]
}

/// Takes in steps at which no axle is on the bridge.
#[inline(always)]
pub fn watch_free<L: Lane>(watched: &mut [Watched<L>], rows: &[Row], steps: &[L], widths: &Widths, from: usize) {
    for (seen, row) in watched.iter_mut().zip(rows) {
        for (i, step) in steps.chunks_exact(widths.all()).enumerate() {
            let value = value(&row.factors, &[], &step[..row.factors.len()]);
            seen.take(value, L::splat((from + i) as f64));
        }
    }
}

/// Takes in a moment between two steps, given their rows. From coordinate number `jumps` on they jump with a load: Ä
/// follows it at once, A and Ȧ do not. `between` is scratch.
#[inline(always)]
#[allow(clippy::too_many_arguments)] // each is one thing
pub fn watch_stop<L: Lane>(
    watched: &mut [Watched<L>],
    rows: &[Row],
    stop: &Stop,
    number: usize,
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
    watch_moment(watched, rows, stop, number, between);
}

/// Takes in a moment at which an axle passes, given coordinates and loads then.
#[inline(always)]
pub fn watch_moment<L: Lane>(watched: &mut [Watched<L>], rows: &[Row], stop: &Stop, number: usize, then: &[L]) {
    let at = L::splat(number as f64);
    let c = rows.first().map_or(0, |row| row.factors.len());
    for (&r, influence) in stop.rows.iter().zip(stop.influence.chunks_exact(then.len() - c)) {
        let value = value(&rows[r].factors, influence, then);
        watched[r].take(value, at);
        if let Some((tip, sign)) = stop.tip
            && tip == r
        {
            watched[r].take(value + L::splat(sign) * then[c + stop.axle], at);
        }
    }
}
