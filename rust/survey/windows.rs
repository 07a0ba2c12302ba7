//! Least and largest influence of a load between any two places: the lines of all responses over cells of the bridge, and
//! over twice, four times, ... as many, of which two cover any stretch.

use crate::bridge::cubics::Mesh;
use crate::error::Error;
use crate::lane::Lane;
use crate::recovery::{Block, Responding, Rows, WIDTH};
use crate::spline::{Cubic, value};
use crate::stop_token::StopToken;

/// Cells along the bridge, at most.
const MOST_CELLS: usize = 256;

/// Most cells of all blocks together, unless there are few along the bridge.
const OF_ALL: usize = 1 << 16;

/// As many as there are at least.
const FEWEST_CELLS: usize = 32;

/// By how much a computed influence can lie beyond what the cubic comes to, in parts of its coefficients.
const ROUNDING: f64 = 1e-12;

/// The same of influences at rest, which are put together from those of modes, in parts of the largest.
const AT_REST: f64 = 1e-9;

/// Cells that a load comes through: the first and the last of them, and whether it comes off the bridge.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Reached {
    first: usize,
    last: usize,
    off: bool,
}

/// Least and largest influence by stretches of the bridge.
#[derive(Debug, Clone)]
pub struct Windows {
    length: f64,
    cells: usize,
    blocks: usize,
    /// Over 2ⁱ cells from each on, block by block.
    levels: Vec<Vec<[Block; 2]>>,
}

impl Windows {
    /// Of the rows' influence lines; of those at rest, under loads that stand, if `at_rest`.
    pub fn new(rows: &Rows, at_rest: bool, stop: StopToken<'_>) -> Result<Self, Error> {
        let (mesh, blocks) = (rows.mesh(), rows.blocks());
        let count = Windows::cells(blocks);
        let cell = mesh.length() / count as f64;
        let mut cells = vec![[[0.0; WIDTH]; 2]; count * blocks];
        for response in 0..rows.len() {
            stop.check()?;
            let (block, i) = (response / WIDTH, response % WIDTH);
            let cubics: Vec<Cubic> = (0..mesh.panels()).map(|panel| rows.cubic_of(response, panel, at_rest)).collect();
            // What is summed up of modes and loads at rest is not what the line is, but for rounding.
            let size = |panel: usize| rows.cubic_of(response, panel, false).iter().map(|c| c.abs()).sum::<f64>();
            let largest = (0..mesh.panels()).map(size).fold(0.0, f64::max);
            let largest = cubics.iter().flatten().fold(largest, |most, c| most.max(c.abs()));
            let beyond = if at_rest { AT_REST * largest } else { 0.0 };
            for number in 0..count {
                // A little more, so that it does not matter to which cell rounding puts a place.
                let stretch = [number as f64 * cell - 1e-9 * cell, (number + 1) as f64 * cell + 1e-9 * cell];
                let [least, most] = range(mesh, &cubics, stretch);
                let [least, most] = [least - beyond, most + beyond];
                let own = &mut cells[number * blocks + block];
                (own[0][i], own[1][i]) = (least, most);
            }
        }
        let mut levels = vec![cells];
        let mut reach = 1;
        while 2 * reach <= count {
            let below = &levels[levels.len() - 1];
            let both = |number: usize, block: usize| {
                let other = (number + reach).min(count - 1);
                let [a, b] = [below[number * blocks + block], below[other * blocks + block]];
                let pick =
                    |side: usize, pick: fn(f64, f64) -> f64| std::array::from_fn(|i| pick(a[side][i], b[side][i]));
                [pick(0, f64::min), pick(1, f64::max)]
            };
            levels.push(
                (0..count)
                    .flat_map(|number| (0..blocks).map(move |block| (number, block)))
                    .map(|(n, b)| both(n, b))
                    .collect(),
            );
            reach *= 2;
        }
        Ok(Windows { length: mesh.length(), cells: count, blocks, levels })
    }

    /// Cells along the bridge with so many blocks of rows.
    fn cells(blocks: usize) -> usize {
        let most = (OF_ALL / blocks.max(1)).clamp(FEWEST_CELLS, MOST_CELLS);
        1 << most.ilog2()
    }

    /// Bytes of those of all rows.
    pub fn bytes(rows: &Rows) -> f64 {
        let cells = Windows::cells(rows.blocks());
        (size_of::<[Block; 2]>() * cells * rows.blocks()) as f64 * f64::from(cells.ilog2() + 1)
    }

    /// What lies between two places [m]; nothing where that is off the bridge.
    #[inline(always)]
    pub fn reached(&self, a: f64, b: f64) -> Option<Reached> {
        let (from, to) = (a.min(b), a.max(b));
        let rounding = 1e-9 * self.length;
        if !(to >= -rounding && from <= self.length + rounding) {
            return None;
        }
        let cell =
            |x: f64| ((x.clamp(0.0, self.length) * (self.cells as f64 / self.length)) as usize).min(self.cells - 1);
        let off = from < rounding || to > self.length - rounding;
        Some(Reached { first: cell(from), last: cell(to), off })
    }

    /// Least and largest influence there on the responses of a block.
    #[inline(always)]
    pub fn of(&self, block: usize, reached: &Reached) -> [Responding; 2] {
        let Reached { first, last, off } = *reached;
        let level = (last + 1 - first).ilog2() as usize;
        let second = last + 1 - (1 << level);
        let cells = &self.levels[level];
        let [a, b] = [cells[first * self.blocks + block], cells[second * self.blocks + block]];
        let least = Responding::from(a[0]).smaller(Responding::from(b[0]));
        let most = Responding::from(a[1]).larger(Responding::from(b[1]));
        let zero = Responding::splat(0.0);
        if off { [least.smaller(zero), most.larger(zero)] } else { [least, most] }
    }
}

/// Least and largest of a line of cubics on a stretch [m] of the bridge.
fn range(mesh: &Mesh, cubics: &[Cubic], [from, to]: [f64; 2]) -> [f64; 2] {
    let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
    let nodes = mesh.nodes();
    let first = nodes[1..mesh.panels()].partition_point(|&node| node < from);
    for panel in (first.saturating_sub(1)..mesh.panels()).take_while(|&panel| nodes[panel] <= to || panel == 0) {
        if nodes[panel + 1] < from && panel + 1 < mesh.panels() {
            continue;
        }
        let [a, b] = [from, to].map(|x| mesh.fraction(panel, x).clamp(-1e-6, 1.0 + 1e-6));
        let cubic @ [c0, c1, c2, c3] = cubics[panel];
        let rounding = ROUNDING * (c0.abs() + c1.abs() + c2.abs() + c3.abs());
        // Where c₁ + 2c₂t + 3c₃t² vanishes, in the form that does not cancel.
        let root = (c2 * c2 - 3.0 * c1 * c3).max(0.0).sqrt();
        let sum = -(c2 + root.copysign(c2));
        let both = [sum / (3.0 * c3), c1 / sum];
        for t in [a, b].into_iter().chain(both.into_iter().filter(|t| *t > a && *t < b)) {
            let own = value(cubic, t);
            (least, most) = (least.min(own - rounding), most.max(own + rounding));
        }
    }
    [least, most]
}
