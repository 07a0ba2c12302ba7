//! A function along the bridge that is one cubic per panel: deflected shapes, influence lines and modes are all this.
//!
//! Between neighbouring nodes the beam carries no mass and no load, so EI·w'''' = 0 and w is exactly a cubic there.
//! Every point at which something happens (station, support, change of EI, section looked at) is a node, hence no
//! function here needs more than one cubic per panel, and nothing is approximated by interpolating.

use crate::error::Error;
use crate::memory;
use crate::spline::{slope, value};

/// Most stations a bridge may have: F is a dense matrix of this order, and its eigensolution grows with the cube.
pub const MAX_STATIONS: usize = 2000;

/// Two points closer than this fraction of the length are one point.
pub const COINCIDENT: f64 = 1e-9;

/// The nodes of the bridge, strictly increasing from 0 to the length [m].
#[derive(Debug, Clone, PartialEq)]
pub struct Mesh {
    nodes: Vec<f64>,
}

impl Mesh {
    /// The nodes at `points` and at both ends; of points that coincide, the earlier in the list stands for all.
    pub fn new(length: f64, points: impl IntoIterator<Item = f64>) -> Self {
        let mut candidates: Vec<f64> = [0.0, length].into_iter().chain(points).collect();
        // A stable sort by position keeps list order only for equal values, so coincident neighbours carry their rank.
        let mut ranked: Vec<(f64, usize)> = candidates.drain(..).zip(0..).collect();
        ranked.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut nodes: Vec<(f64, usize)> = Vec::with_capacity(ranked.len());
        for point in ranked {
            match nodes.last_mut() {
                Some(last) if point.0 - last.0 <= COINCIDENT * length => {
                    if point.1 < last.1 {
                        *last = point;
                    }
                }
                _ => nodes.push(point),
            }
        }
        Mesh { nodes: nodes.into_iter().map(|(x, _)| x).collect() }
    }

    /// Node positions [m].
    pub fn nodes(&self) -> &[f64] {
        &self.nodes
    }

    /// Number of panels.
    pub fn panels(&self) -> usize {
        self.nodes.len() - 1
    }

    /// Length of the bridge [m].
    pub fn length(&self) -> f64 {
        self.nodes[self.panels()]
    }

    /// Width of a panel [m].
    pub fn width(&self, panel: usize) -> f64 {
        self.nodes[panel + 1] - self.nodes[panel]
    }

    /// The node nearest to x: exact for the points the mesh was made of.
    pub fn node_at(&self, x: f64) -> usize {
        let right = self.nodes.partition_point(|&node| node < x).min(self.panels());
        if right > 0 && x - self.nodes[right - 1] < self.nodes[right] - x { right - 1 } else { right }
    }

    /// The panel that holds x (the one to the right of a node), or `None` off the bridge.
    pub fn panel_at(&self, x: f64) -> Option<usize> {
        if self.is_on(x) { Some(self.nodes[1..self.panels()].partition_point(|&node| node <= x)) } else { None }
    }

    /// Whether x is on the bridge, where rounding does not decide.
    #[inline]
    pub fn is_on(&self, x: f64) -> bool {
        let rounding = 1e-12 * self.length();
        x >= -rounding && x <= self.length() + rounding
    }

    /// Whether a panel holds x, as [`Mesh::panel_at`] has it, its ends apart.
    #[inline]
    pub fn is_within(&self, panel: usize, x: f64) -> bool {
        self.nodes[panel] <= x && x < self.nodes[panel + 1]
    }

    /// x as a fraction of a panel's width, 0 at its left node.
    pub fn fraction(&self, panel: usize, x: f64) -> f64 {
        (x - self.nodes[panel]) / self.width(panel)
    }
}

/// One cubic per panel of a [`Mesh`], in powers of the fraction of the panel.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    cubics: Vec<[f64; 4]>,
}

impl Line {
    /// From the cubic of every panel.
    pub fn from_cubics(cubics: Vec<[f64; 4]>) -> Self {
        Line { cubics }
    }

    /// The straight line a + b·x.
    pub fn straight(mesh: &Mesh, a: f64, b: f64) -> Self {
        Line { cubics: (0..mesh.panels()).map(|p| [a + b * mesh.nodes()[p], b * mesh.width(p), 0.0, 0.0]).collect() }
    }

    /// The cubic of each panel.
    pub fn cubics(&self) -> &[[f64; 4]] {
        &self.cubics
    }

    /// Adds `factor` times another line on the same mesh.
    pub fn add_scaled(&mut self, factor: f64, other: &Line) {
        for (mine, theirs) in self.cubics.iter_mut().zip(&other.cubics) {
            for (c, d) in mine.iter_mut().zip(theirs) {
                *c += factor * d;
            }
        }
    }

    /// This line times `factor`.
    pub fn scaled(mut self, factor: f64) -> Self {
        self.cubics.iter_mut().flatten().for_each(|c| *c *= factor);
        self
    }

    /// Value at a fraction of a panel.
    pub fn value(&self, panel: usize, fraction: f64) -> f64 {
        value(self.cubics[panel], fraction)
    }

    /// Derivative with respect to x at a fraction of a panel.
    pub fn slope(&self, mesh: &Mesh, panel: usize, fraction: f64) -> f64 {
        slope(self.cubics[panel], fraction) / mesh.width(panel)
    }

    /// Value at x, zero off the bridge; to the right of x where the line jumps.
    pub fn at(&self, mesh: &Mesh, x: f64) -> f64 {
        mesh.panel_at(x).map_or(0.0, |panel| self.value(panel, mesh.fraction(panel, x)))
    }

    /// Limit at a node from the left; zero at the left end, beyond which there is no bridge.
    pub fn before(&self, node: usize) -> f64 {
        if node == 0 { 0.0 } else { self.value(node - 1, 1.0) }
    }

    /// Limit at a node from the right; zero at the right end.
    pub fn after(&self, node: usize) -> f64 {
        self.cubics.get(node).map_or(0.0, |cubic| cubic[0])
    }

    /// Value at a node on the bridge: from the right, or at the right end from the left.
    pub fn at_node(&self, node: usize) -> f64 {
        if node == self.cubics.len() { self.before(node) } else { self.after(node) }
    }

    /// Derivative with respect to x at a node, from the right, or at the right end from the left.
    pub fn slope_at_node(&self, mesh: &Mesh, node: usize) -> f64 {
        if node == self.cubics.len() { self.slope(mesh, node - 1, 1.0) } else { self.slope(mesh, node, 0.0) }
    }
}

/// Refuses so many lines over so many panels if there is no memory for them; `key` and `value` are what asked for them.
pub fn check_lines(key: &str, value: usize, lines: f64, panels: usize, what: &str) -> Result<(), Error> {
    let bytes = size_of::<[f64; 4]>() as f64 * lines * panels as f64;
    memory::check(key, value, bytes, f64::INFINITY, what, "use fewer")
}
