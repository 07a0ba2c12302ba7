//! The recovery of KTN73 step by step, Eqs. 5–20, as the paper writes it: the reference for [`crate::recovery`].
//!
//! Slow and plain on purpose. It shares the basic bridge with the engine, and nothing after that.

use faer::Mat;

use crate::bridge::Bridge;
use crate::flexibility::{Flexibility, Restraint, Structure};
use crate::influence;
use crate::line::Line;
use crate::modes::Modes;

/// The matrices that the sequence needs at every instant.
#[derive(Debug, Clone)]
pub struct Sequence {
    flexibility: Flexibility,
    omega: Vec<f64>,
    /// Φ at the mass stations.
    shapes: Mat<f64>,
    mode_lines: Vec<Line>,
    /// Masses and their nodes.
    masses: Vec<(usize, f64)>,
    /// C at the mass stations [N s/m].
    damping: Mat<f64>,
    /// Nodes of the redundant supports.
    redundants: Vec<usize>,
    /// Columns of F*: deflections of the basic bridge for a unit load at the masses, then at the redundant supports.
    columns: Vec<Line>,
    /// Influence lines of the outer reactions of the basic bridge (R*, Q* and their like), left to right.
    outer: Vec<(Restraint, Line)>,
}

/// What the sequence gives at one instant.
#[derive(Debug, Clone, PartialEq)]
pub struct Recovered {
    /// P̃: inertia and damping forces at the mass stations, down [N].
    pub inertia_forces: Vec<f64>,
    /// R: redundant reactions as loads, down [N].
    pub redundant_reactions: Vec<f64>,
    /// y at every node of the mesh [m].
    pub deflections: Vec<f64>,
    /// Reactions of the basic bridge on it: forces up [N], clamp moments sagging [N m].
    pub outer_reactions: Vec<f64>,
    /// M at every node [N m].
    pub moments: Vec<f64>,
    /// V just left and just right of every node [N].
    pub shears: Vec<[f64; 2]>,
}

impl Sequence {
    /// For `modes` of `bridge`; `damping` is C at the mass stations, used by Eq. 6 alone.
    pub fn new(bridge: &Bridge, flexibility: &Flexibility, modes: &Modes, damping: Mat<f64>) -> Self {
        let mesh = flexibility.mesh();
        let masses: Vec<(usize, f64)> = bridge.stations().iter().map(|s| (mesh.node_at(s.at), s.mass)).collect();
        let redundants: Vec<usize> = flexibility.redundants().iter().map(|r| r.node()).collect();
        let stations = masses.iter().map(|m| m.0).chain(redundants.iter().copied());
        let columns = stations.map(|node| influence::deflection(flexibility, node, Structure::Basic)).collect();
        let outer = flexibility.outer_restraints().into_iter();
        let outer = outer.map(|r| (r, influence::reaction(flexibility, r, Structure::Basic))).collect();
        Sequence {
            omega: modes.omega.clone(),
            shapes: modes.shapes.clone(),
            mode_lines: modes.lines(bridge, flexibility),
            flexibility: flexibility.clone(),
            masses,
            damping,
            redundants,
            columns,
            outer,
        }
    }

    /// Eqs. 9–11: inertia and damping forces from the modal coordinates A alone, given axles at x [m] with loads P̄ [N].
    pub fn inertia_forces(&self, a: &[f64], axles: &[(f64, f64)]) -> Vec<f64> {
        let mesh = self.flexibility.mesh();
        let mut forces = vec![0.0; self.masses.len()];
        for (m, &omega) in self.omega.iter().enumerate() {
            // [KTN73] Eq. 9: Ā = Ω⁻² (Φ⁰)ᵀ P̄.
            let generalised: f64 = axles.iter().map(|&(x, p)| self.mode_lines[m].at(mesh, x) * p).sum();
            let a_bar = generalised / omega.powi(2);
            // [KTN73] Eq. 10: Ã = A − Ā.
            let a_tilde = a[m] - a_bar;
            // [KTN73] Eq. 11: P̃ = M Φ Ω² Ã.
            for (j, &(_, mass)) in self.masses.iter().enumerate() {
                forces[j] += mass * self.shapes[(j, m)] * omega.powi(2) * a_tilde;
            }
        }
        forces
    }

    /// Eq. 6: inertia and damping forces from the modal accelerations and velocities.
    pub fn inertia_forces_by_rates(&self, a_dot: &[f64], a_ddot: &[f64]) -> Vec<f64> {
        let column = |v: &[f64]| Mat::from_fn(v.len(), 1, |i, _| v[i]);
        let acceleration = &self.shapes * &column(a_ddot);
        let damping = &self.damping * &(&self.shapes * &column(a_dot));
        let masses = self.masses.iter().enumerate();
        masses.map(|(j, &(_, mass))| -(mass * acceleration[(j, 0)] + damping[(j, 0)])).collect()
    }

    /// Eqs. 12–16 and force summation, for axles at x [m] with loads [N] and inertia forces P̃; without P̃, Eqs. 17–20.
    pub fn recover(&self, axles: &[(f64, f64)], inertia_forces: &[f64]) -> Recovered {
        let mesh = self.flexibility.mesh();
        let on_bridge: Vec<(f64, f64)> = axles.iter().copied().filter(|&(x, _)| mesh.panel_at(x).is_some()).collect();

        // [KTN73] Eq. 12: y* = F̄* P̄ + F* P̃*, here at the redundant supports. By Maxwell's theorem the deflection at a
        // support due to a unit load at an axle is the support's own column of F*, interpolated at the axle.
        let masses = self.masses.len();
        let y_r: Vec<f64> = (0..self.redundants.len())
            .map(|i| {
                let column = &self.columns[masses + i];
                let loads: f64 = on_bridge.iter().map(|&(x, p)| column.at(mesh, x) * p).sum();
                let forces = self.masses.iter().zip(inertia_forces);
                loads + forces.map(|(&(node, _), p)| column.at_node(node) * p).sum::<f64>()
            })
            .collect();

        // [KTN73] Eq. 13: R = −K^R y^R.
        let redundant_reactions = self.flexibility.redundant_reactions(&y_r);

        // P*: the reactions take the place of the null elements of P̃*.
        let p_star: Vec<(usize, f64)> = (self.masses.iter().map(|m| m.0).zip(inertia_forces.iter().copied()))
            .chain(self.redundants.iter().copied().zip(redundant_reactions.iter().copied()))
            .collect();

        // [KTN73] Eq. 14: y* = F̄* P̄ + F* P*, at every node; by Maxwell again, row and column change places.
        let deflections = (0..mesh.nodes().len())
            .map(|node| {
                let here = influence::deflection(&self.flexibility, node, Structure::Basic);
                let loads: f64 = on_bridge.iter().map(|&(x, p)| here.at(mesh, x) * p).sum();
                loads + self.columns.iter().zip(&p_star).map(|(column, p)| column.at_node(node) * p.1).sum::<f64>()
            })
            .collect();

        // [KTN73] Eq. 16: R¹ = (R*)ᵀ P* + (R̄*)ᵀ P̄, and Q¹ likewise. R enters as a load, so reactions on the bridge, up,
        // come out positive.
        let outer_reactions: Vec<f64> = self
            .outer
            .iter()
            .map(|(_, line)| {
                let loads: f64 = on_bridge.iter().map(|&(x, p)| line.at(mesh, x) * p).sum();
                loads + p_star.iter().map(|&(node, p)| line.at_node(node) * p).sum::<f64>()
            })
            .collect();

        // Equilibrium with everything to the left of a section ([KTN73] Table 1: the outer reactions that stand there).
        let forces: Vec<(f64, f64)> = (on_bridge.iter().map(|&(x, p)| (x, -p)))
            .chain(p_star.iter().map(|&(node, p)| (mesh.nodes()[node], -p)))
            .chain(self.outer.iter().zip(&outer_reactions).filter_map(|((restraint, _), &r)| match restraint {
                Restraint::Deflection(node) => Some((mesh.nodes()[*node], r)),
                Restraint::Slope(_) => None,
            }))
            .collect();
        let clamp: f64 = (self.outer.iter().zip(&outer_reactions))
            .filter(|((restraint, _), _)| *restraint == Restraint::Slope(0))
            .map(|(_, &q)| q)
            .sum();
        let up_to = |x: f64, inclusive: bool| {
            forces.iter().filter(move |&&(at, _)| at < x || (inclusive && at == x)).map(|&(_, f)| f).sum::<f64>()
        };
        let moments = (mesh.nodes().iter())
            .map(|&x| clamp + forces.iter().filter(|f| f.0 < x).map(|&(at, f)| f * (x - at)).sum::<f64>())
            .collect();
        let shears = mesh.nodes().iter().map(|&x| [up_to(x, false), up_to(x, true)]).collect();
        Recovered {
            inertia_forces: inertia_forces.to_vec(),
            redundant_reactions,
            deflections,
            outer_reactions,
            moments,
            shears,
        }
    }

    /// Eq. 15: y = F̄ P̄ + F P̃ at every node, with the flexibility of the actual bridge.
    pub fn deflections_by_actual_bridge(&self, axles: &[(f64, f64)], inertia_forces: &[f64]) -> Vec<f64> {
        let mesh = self.flexibility.mesh();
        (0..mesh.nodes().len())
            .map(|node| {
                let here = influence::deflection(&self.flexibility, node, Structure::Actual);
                let loads: f64 = axles.iter().map(|&(x, p)| here.at(mesh, x) * p).sum();
                let forces = self.masses.iter().zip(inertia_forces);
                loads + forces.map(|(&(station, _), p)| here.at_node(station) * p).sum::<f64>()
            })
            .collect()
    }
}
