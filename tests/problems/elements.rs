//! Beam elements assembled by the direct stiffness method: an independent route to static answers.
//!
//! Hermite cubics are exact under nodal forces, so the only error is rounding. Nothing of the library's flexibility is
//! used, only the data of the bridge.

use faer::Mat;
use faer::linalg::solvers::Solve;
use spanwise::bridge::{Bridge, Support};
use spanwise::statics::Structure;

use super::outer_supports;

/// Static answers to nodal forces.
pub struct Solved {
    nodes: Vec<f64>,
    /// Deflection and slope of every node, then the slopes just left of the hinges.
    u: Vec<f64>,
    /// Force down and couple in the sense of positive slope that every element takes at its left and right end.
    ends: Vec<[f64; 4]>,
    /// Of the supports, on the beam: forces up.
    pub reactions: Vec<f64>,
    /// Of the supports that hold the rotation, on the beam: sagging at an end, elsewhere in the sense of positive slope.
    pub clamp_moments: Vec<f64>,
}

/// Deflects `bridge`, or without its hinges and intermediate supports, under forces (position [m], down [N]), with nodes
/// there, at all supports and hinges and at `points` [m].
pub fn solve(bridge: &Bridge, structure: Structure, forces: &[(f64, f64)], points: &[f64]) -> Solved {
    match structure {
        Structure::Actual => {
            let supports = bridge.supports();
            assembled(bridge, supports, bridge.hinges(), forces, &vec![0.0; supports.len()], points)
        }
        Structure::Basic => {
            let supports = outer_supports(bridge);
            assembled(bridge, &supports, &[], forces, &vec![0.0; supports.len()], points)
        }
    }
}

/// Settles the supports of `bridge` by so much, down [m].
pub fn settle(bridge: &Bridge, settlements: &[f64], points: &[f64]) -> Solved {
    assembled(bridge, bridge.supports(), bridge.hinges(), &[], settlements, points)
}

fn assembled(
    bridge: &Bridge,
    supports: &[Support],
    hinges: &[f64],
    forces: &[(f64, f64)],
    settlements: &[f64],
    points: &[f64],
) -> Solved {
    let length = bridge.length();
    let near = 1e-9 * length;
    let mut nodes: Vec<f64> = bridge.span_bounds().to_vec();
    nodes.extend(bridge.rigidity_bounds());
    nodes.extend(bridge.hinges());
    nodes.extend(forces.iter().map(|f| f.0));
    nodes.extend(points);
    nodes.sort_by(f64::total_cmp);
    nodes.dedup_by(|b, a| *b - *a <= near);
    let node = |x: f64| nodes.iter().position(|n| (n - x).abs() <= near).unwrap();

    let n = nodes.len();
    let hinges: Vec<usize> = hinges.iter().map(|&x| node(x)).collect();
    let unknowns = 2 * n + hinges.len();
    // An element that ends at a hinge has a slope of its own there.
    let of_element = |e: usize| {
        let turned = hinges.iter().position(|&h| h == e + 1).map_or(2 * e + 3, |k| 2 * n + k);
        [2 * e, 2 * e + 1, 2 * e + 2, turned]
    };
    let mut stiffness = Mat::<f64>::zeros(unknowns, unknowns);
    let elements: Vec<[[f64; 4]; 4]> =
        nodes.windows(2).map(|e| element(e[1] - e[0], rigidity(bridge, 0.5 * (e[0] + e[1])))).collect();
    for (e, k) in elements.iter().enumerate() {
        let dofs = of_element(e);
        for i in 0..4 {
            for j in 0..4 {
                stiffness[(dofs[i], dofs[j])] += k[i][j];
            }
        }
    }
    let mut load = vec![0.0; unknowns];
    for &(x, force) in forces {
        load[2 * node(x)] += force;
    }
    // Degrees of freedom that are held, and where.
    let mut u = vec![0.0; unknowns];
    let mut held: Vec<usize> = Vec::new();
    let mut spring_load = load.clone();
    for (support, &settlement) in supports.iter().zip(settlements) {
        let dof = 2 * node(support.at);
        for (dof, k, at) in [(dof, support.fixity.vertical(), settlement), (dof + 1, support.fixity.rotation(), 0.0)] {
            if k.is_infinite() {
                held.push(dof);
                u[dof] = at;
            } else {
                stiffness[(dof, dof)] += k;
                spring_load[dof] += k * at;
            }
        }
    }
    let free: Vec<usize> = (0..unknowns).filter(|dof| !held.contains(dof)).collect();
    let reduced = Mat::from_fn(free.len(), free.len(), |i, j| stiffness[(free[i], free[j])]);
    let right = Mat::from_fn(free.len(), 1, |i, _| {
        spring_load[free[i]] - held.iter().map(|&dof| stiffness[(free[i], dof)] * u[dof]).sum::<f64>()
    });
    let solution = reduced.partial_piv_lu().solve(&right);
    for (i, &dof) in free.iter().enumerate() {
        u[dof] = solution[(i, 0)];
    }
    let ends: Vec<[f64; 4]> = (elements.iter().enumerate())
        .map(|(e, k)| {
            let dofs = of_element(e);
            std::array::from_fn(|i| (0..4).map(|j| k[i][j] * u[dofs[j]]).sum())
        })
        .collect();
    // What the elements take at a node less the load there comes from the support.
    let from_support = |dof: usize| {
        let (node, slot) = (dof / 2, dof % 2);
        let left = if node > 0 { ends[node - 1][2 + slot] } else { 0.0 };
        let right = if node < n - 1 { ends[node][slot] } else { 0.0 };
        left + right - load[dof]
    };
    let reactions = supports.iter().map(|s| -from_support(2 * node(s.at))).collect();
    let clamps = supports.iter().filter(|s| s.fixity.rotation() > 0.0);
    // A couple in the sense of positive slope is sagging on a left end and hogging on a right end.
    let clamp_moments = clamps
        .map(|s| {
            let couple = from_support(2 * node(s.at) + 1);
            if s.at == length { -couple } else { couple }
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

    /// Sagging moment at a node, from the element to its left or, at the left end, to its right.
    pub fn moment(&self, x: f64) -> f64 {
        match self.node(x) {
            0 => self.ends[0][1],
            node => -self.ends[node - 1][3],
        }
    }

    /// Sum of upward forces left of a node, without and with the forces at the node itself.
    pub fn shears(&self, x: f64) -> [f64; 2] {
        let node = self.node(x);
        let left = if node == 0 { 0.0 } else { self.ends[node - 1][2] };
        [left, self.ends.get(node).map_or(0.0, |end| -end[0])]
    }
}

fn rigidity(bridge: &Bridge, x: f64) -> f64 {
    let piece = bridge.rigidity_bounds().windows(2).position(|b| x > b[0] && x < b[1]).unwrap();
    bridge.flexural_rigidity()[piece]
}

/// Stiffness of an element for deflections (down) and slopes of its ends.
fn element(length: f64, ei: f64) -> [[f64; 4]; 4] {
    let [a, b, c, d] =
        [12.0, 6.0 * length, 4.0 * length.powi(2), 2.0 * length.powi(2)].map(|k| k * ei / length.powi(3));
    [[a, b, -a, b], [b, c, -b, d], [-a, -b, a, -b], [b, d, -b, c]]
}
