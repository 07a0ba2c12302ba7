//! Beam elements assembled by the direct stiffness method: an independent route to static answers.
//!
//! Hermite cubics are exact under nodal forces, so the only error is rounding. Nothing of the library's flexibility is
//! used, only the data of the bridge.

use faer::Mat;
use faer::linalg::solvers::Solve;
use spanwise::bridge::{Bridge, Fixity, Support};

/// Static answers to nodal forces.
pub struct Solved {
    nodes: Vec<f64>,
    /// Deflection and slope of every node.
    u: Vec<f64>,
    /// Force down and couple in the sense of positive slope that every element takes at its left and right end.
    ends: Vec<[f64; 4]>,
    /// Of the supports, on the beam: forces up.
    pub reactions: Vec<f64>,
    /// Of the clamps, on the beam: sagging.
    pub clamp_moments: Vec<f64>,
}

/// Deflects the beam of `bridge` on `supports`, its own or fewer, under forces (position [m], down [N]), with nodes
/// there, at all supports and at `points` [m].
pub fn solve(bridge: &Bridge, supports: &[Support], forces: &[(f64, f64)], points: &[f64]) -> Solved {
    let length = bridge.length();
    let near = 1e-9 * length;
    let mut nodes: Vec<f64> = bridge.span_bounds().to_vec();
    nodes.extend(forces.iter().map(|f| f.0));
    nodes.extend(points);
    nodes.sort_by(f64::total_cmp);
    nodes.dedup_by(|b, a| *b - *a <= near);
    let node = |x: f64| nodes.iter().position(|n| (n - x).abs() <= near).unwrap();

    let n = nodes.len();
    let mut stiffness = Mat::<f64>::zeros(2 * n, 2 * n);
    let elements: Vec<[[f64; 4]; 4]> =
        nodes.windows(2).map(|e| element(e[1] - e[0], rigidity(bridge, 0.5 * (e[0] + e[1])))).collect();
    for (e, k) in elements.iter().enumerate() {
        for i in 0..4 {
            for j in 0..4 {
                stiffness[(2 * e + i, 2 * e + j)] += k[i][j];
            }
        }
    }
    let mut load = Mat::<f64>::zeros(2 * n, 1);
    for &(x, force) in forces {
        load[(2 * node(x), 0)] += force;
    }
    let mut held: Vec<usize> = Vec::new();
    for support in supports {
        held.push(2 * node(support.at));
        if support.fixity == Fixity::Clamped {
            held.push(2 * node(support.at) + 1);
        }
    }
    let free: Vec<usize> = (0..2 * n).filter(|dof| !held.contains(dof)).collect();
    let reduced = Mat::from_fn(free.len(), free.len(), |i, j| stiffness[(free[i], free[j])]);
    let right = Mat::from_fn(free.len(), 1, |i, _| load[(free[i], 0)]);
    let solution = reduced.partial_piv_lu().solve(&right);
    let mut u = vec![0.0; 2 * n];
    for (i, &dof) in free.iter().enumerate() {
        u[dof] = solution[(i, 0)];
    }
    let ends: Vec<[f64; 4]> = elements
        .iter()
        .enumerate()
        .map(|(e, k)| std::array::from_fn(|i| (0..4).map(|j| k[i][j] * u[2 * e + j]).sum()))
        .collect();
    // What the elements take at a node less the load there comes from the support.
    let from_support = |dof: usize| {
        let (node, slot) = (dof / 2, dof % 2);
        let left = if node > 0 { ends[node - 1][2 + slot] } else { 0.0 };
        let right = if node < n - 1 { ends[node][slot] } else { 0.0 };
        left + right - load[(dof, 0)]
    };
    let reactions = supports.iter().map(|s| -from_support(2 * node(s.at))).collect();
    let clamps = supports.iter().filter(|s| s.fixity == Fixity::Clamped);
    // A couple in the sense of positive slope is sagging on a left end and hogging on a right end.
    let clamp_moments = clamps
        .map(|s| {
            let couple = from_support(2 * node(s.at) + 1);
            if s.at == 0.0 { couple } else { -couple }
        })
        .collect();
    Solved { nodes, u, ends, reactions, clamp_moments }
}

impl Solved {
    fn node(&self, x: f64) -> usize {
        let near = 1e-9 * self.nodes[self.nodes.len() - 1];
        self.nodes.iter().position(|n| (n - x).abs() <= near).unwrap()
    }

    pub fn deflection(&self, x: f64) -> f64 {
        self.u[2 * self.node(x)]
    }

    pub fn slope(&self, x: f64) -> f64 {
        self.u[2 * self.node(x) + 1]
    }

    /// Sagging moment at a node, from the element to its right or, at the right end, to its left.
    pub fn moment(&self, x: f64) -> f64 {
        let node = self.node(x);
        self.ends.get(node).map_or_else(|| -self.ends[node - 1][3], |end| end[1])
    }

    /// Sum of upward forces left of a node, without and with the forces at the node itself.
    pub fn shears(&self, x: f64) -> [f64; 2] {
        let node = self.node(x);
        let left = if node == 0 { 0.0 } else { self.ends[node - 1][2] };
        [left, self.ends.get(node).map_or(0.0, |end| -end[0])]
    }
}

fn rigidity(bridge: &Bridge, x: f64) -> f64 {
    let span = bridge.span_bounds().windows(2).position(|b| x > b[0] && x < b[1]).unwrap();
    bridge.flexural_rigidity()[span]
}

/// Stiffness of an element for deflections (down) and slopes of its ends.
fn element(length: f64, ei: f64) -> [[f64; 4]; 4] {
    let [a, b, c, d] =
        [12.0, 6.0 * length, 4.0 * length.powi(2), 2.0 * length.powi(2)].map(|k| k * ei / length.powi(3));
    [[a, b, -a, b], [b, c, -b, d], [-a, -b, a, -b], [b, d, -b, c]]
}
