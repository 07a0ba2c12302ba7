//! What is seen of samples side by side as they pass: extremes and when, sums of squares, wheels off the road.
//!
//! A response is a sum of products, Σ factor·coordinate + Σ influence·load. Rounding being monotone, the same sum with
//! every product at its largest over some steps is no less than any value the response takes there, to the last bit. So
//! a glance at one step of every chunk finds values that the extremes must reach, and only those chunks are looked at
//! whose bounds reach them, and of these only the parts whose bounds do, one step after the other.

use super::look::Row;
use super::table::{CHUNK, Chunk, PART, PARTS, Stop, middle};
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

    /// Whether values within these bounds, the upper and the lower, can be new extremes in any lane, where it is known
    /// what the extremes will reach in the end.
    #[inline(always)]
    fn may_grow(&self, [high, low]: [L; 2], [most, least]: [L; 2]) -> bool {
        let above = !(!self.max.less(high) | high.less(most));
        let below = !(!low.less(self.min) | least.less(low));
        L::any(above | below)
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

    /// Takes in the last chunk of a stretch; `left` says how much of the step that follows a step the lanes go, and sums
    /// grow where the steps are `counted`. Lanes that have ended go on as they were.
    #[inline(always)]
    pub fn take(&mut self, stretch: &Stretch<L>, static_loads: &[L], left: impl Fn(usize) -> L, counted: bool) {
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
                let [mut sum, mut squares] = self.sums[k];
                for (_, load) in loads() {
                    let deviation = load - *static_load;
                    sum = sum + deviation;
                    squares = squares + deviation * deviation;
                }
                self.sums[k] = [sum, squares];
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

/// Steps that are kept until their responses are looked at.
#[derive(Debug, Clone)]
pub struct Stretch<L> {
    /// What a step consists of.
    pub widths: Widths,
    /// Number of the first step.
    pub from: usize,
    /// How many there are.
    pub steps: usize,
    /// The step before, and then these.
    rows: Vec<L>,
    /// Largest and smallest of each number of a step, by chunk.
    ends: Vec<[L; 2]>,
    /// The same by part of a chunk.
    parts: Vec<[L; 2]>,
}

/// A chunk of a stretch.
struct Kept<'s, L> {
    /// Number of its first step.
    from: usize,
    /// Its steps.
    rows: &'s [L],
    /// Largest and smallest of each number of a step.
    ends: &'s [[L; 2]],
    /// The same, part by part.
    parts: &'s [[L; 2]],
}

impl<L: Lane> Stretch<L> {
    /// Nothing yet.
    pub fn new() -> Self {
        let widths = Widths { coordinates: 0, axles: 0, bodies: 0, felt: true };
        Stretch { widths, from: 0, steps: 0, rows: Vec::new(), ends: Vec::new(), parts: Vec::new() }
    }

    /// Begins anew with a step of this number, with room for so many chunks.
    pub fn begin(&mut self, widths: Widths, from: usize, chunks: usize) {
        let width = widths.all();
        (self.widths, self.from, self.steps) = (widths, from, 0);
        // Never less, so that memory is asked for once.
        let zero = L::splat(0.0);
        self.rows.resize(self.rows.len().max((chunks * CHUNK + 1) * width), zero);
        self.ends.resize(self.ends.len().max(chunks * width), [zero; 2]);
        self.parts.resize(self.parts.len().max(chunks * PARTS * width), [zero; 2]);
    }

    /// Begins anew behind its last step.
    pub fn go_on(&mut self) {
        let width = self.widths.all();
        self.rows.copy_within(self.steps * width..(self.steps + 1) * width, 0);
        self.begin(self.widths, self.from + self.steps, 0);
    }

    /// The row of a step, or of the one before the first.
    #[inline(always)]
    pub fn row(&self, step: usize) -> &[L] {
        let width = self.widths.all();
        &self.rows[(step + 1 - self.from) * width..][..width]
    }

    /// The same, to be written, and the row before it.
    #[inline(always)]
    pub fn row_mut(&mut self, step: usize) -> [&mut [L]; 2] {
        let width = self.widths.all();
        let (before, row) = self.rows[(step - self.from) * width..][..2 * width].split_at_mut(width);
        [before, row]
    }

    /// Takes in a chunk of so many steps, whose rows have been written.
    #[inline(always)]
    pub fn take(&mut self, count: usize) {
        let width = self.widths.all();
        let chunk = self.steps / CHUNK;
        let rows = &self.rows[(self.steps + 1) * width..][..count * width];
        let all = &mut self.ends[chunk * width..][..width];
        let parts = self.parts[chunk * PARTS * width..][..PARTS * width].chunks_exact_mut(width);
        for (p, (rows, parts)) in rows.chunks(PART * width).zip(parts).enumerate() {
            for (i, (part, all)) in parts.iter_mut().zip(all.iter_mut()).enumerate() {
                let (mut most, mut least) = (rows[i], rows[i]);
                for row in rows[width..].chunks_exact(width) {
                    most = row[i].larger(most);
                    least = row[i].smaller(least);
                }
                *part = [most, least];
                let [high, low] = *all;
                *all = if p == 0 { [most, least] } else { [most.larger(high), least.smaller(low)] };
            }
        }
        self.steps += count;
    }

    #[inline(always)]
    fn chunks(&self) -> impl DoubleEndedIterator<Item = Kept<'_, L>> {
        let width = self.widths.all();
        (0..self.steps.div_ceil(CHUNK)).map(move |chunk| {
            let from = chunk * CHUNK;
            let count = CHUNK.min(self.steps - from);
            Kept {
                from: self.from + from,
                rows: &self.rows[(from + 1) * width..][..count * width],
                ends: &self.ends[chunk * width..][..width],
                parts: &self.parts[chunk * PARTS * width..][..PARTS * width],
            }
        })
    }
}

impl<L: Lane> Default for Stretch<L> {
    fn default() -> Self {
        Stretch::new()
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

/// Looks for the extremes of every response at the steps of a stretch: `chunks` of the influence of the loads, none where
/// there is no axle on the bridge. `glanced` is scratch.
#[inline(always)]
pub fn survey<L: Lane>(
    watched: &mut [Watched<L>],
    rows: &[Row],
    stretch: &Stretch<L>,
    chunks: Option<&[Chunk]>,
    glanced: &mut Vec<[L; 2]>,
) {
    // What is known when this is compiled runs much faster: the usual numbers of modes and axles.
    macro_rules! sizes {
        ($($c:literal $a:literal),*) => {
            match (stretch.widths.coordinates, if chunks.is_some() { stretch.widths.axles } else { 0 }) {
                $(($c, $a) => survey_sizes($c, $a, watched, rows, stretch, chunks, glanced),)*
                (c, a) => survey_sizes(c, a, watched, rows, stretch, chunks, glanced),
            }
        };
    }
    sizes!(2 2, 2 3, 2 5, 3 2, 3 3, 3 5, 4 2, 4 3, 4 5)
}

/// [`survey`] with so many coordinates and axles.
#[inline(always)]
fn survey_sizes<L: Lane>(
    c: usize,
    a: usize,
    watched: &mut [Watched<L>],
    rows: &[Row],
    stretch: &Stretch<L>,
    chunks: Option<&[Chunk]>,
    glanced: &mut Vec<[L; 2]>,
) {
    let free = Chunk::default();
    let chunk_of = |chunk: usize| chunks.map_or(&free, |chunks| &chunks[chunk]);
    let (felt, width) = (c + a, stretch.widths.all());
    // What the extremes must reach.
    glanced.clear();
    for (r, (Row { factors, .. }, seen)) in rows.iter().zip(watched.iter()).enumerate() {
        let (mut most, mut least) = (seen.max, seen.min);
        for (chunk, kept) in stretch.chunks().enumerate() {
            let at = middle(kept.rows.len() / width);
            let value = value(&factors[..c], &chunk_of(chunk).middles[r * a..][..a], &kept.rows[at * width..][..felt]);
            most = value.larger(most);
            least = value.smaller(least);
        }
        glanced.push([most, least]);
    }
    for (chunk, kept) in stretch.chunks().enumerate() {
        let Chunk { influence, bounds, parts, .. } = chunk_of(chunk);
        let count = kept.rows.len() / width;
        let ends = &kept.ends[..felt];
        let mut positive = true;
        for [_, least] in &ends[c..] {
            positive &= !L::any(least.less(L::splat(0.0)));
        }
        for (r, Row { factors, turned, .. }) in rows.iter().enumerate() {
            let (factors, turned) = (&factors[..c], &turned[..c]);
            if !watched[r].may_grow(reach(factors, turned, &bounds[r * a..][..a], ends, positive), glanced[r]) {
                continue;
            }
            let mut seen = watched[r];
            for part in 0..count.div_ceil(PART) {
                let ends = &kept.parts[part * width..][..felt];
                let reached = reach(factors, turned, &parts[(r * PARTS + part) * a..][..a], ends, positive);
                if !seen.may_grow(reached, glanced[r]) {
                    continue;
                }
                let first = part * PART;
                let influence = &influence[(r * count + first) * a..(r + 1) * count * a];
                let mut at = (kept.from + first) as f64;
                for (step, row) in kept.rows[first * width..].chunks_exact(width).take(PART).enumerate() {
                    seen.take(value(factors, &influence[step * a..][..a], &row[..felt]), L::splat(at));
                    at += 1.0;
                }
            }
            watched[r] = seen;
        }
    }
}

/// Bounds of a response where coordinates and loads are between their `ends`, largest and smallest; whether the loads
/// are all `positive`.
#[inline(always)]
fn reach<L: Lane>(
    factors: &[f64],
    turned: &[usize],
    bounds: &[[f64; 2]],
    ends: &[[L; 2]],
    positive: bool,
) -> [L; 2] {
    // A negative factor takes the other end.
    let first = L::splat(factors[0]);
    let mut high = first * ends[0][turned[0]];
    let mut low = first * ends[0][1 - turned[0]];
    for i in 1..factors.len() {
        let factor = L::splat(factors[i]);
        high = high + factor * ends[i][turned[i]];
        low = low + factor * ends[i][1 - turned[i]];
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
