//! The recovery of KTN73 step by step, Eqs. 5–20, as the paper writes it: the reference for [`crate::recovery`].
//!
//! Slow and plain on purpose. It shares the basic bridge with the engine, and nothing after that.

use faer::Mat;
use faer::linalg::solvers::Solve;

use crate::bridge::Bridge;
use crate::bridge::cubics::Line;
use crate::modes::Modes;
use crate::statics::flexibility::{Action, Flexibility, Restraint, Structure};
use crate::statics::influence;

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
    /// Redundant restraints of the intermediate supports.
    redundants: Vec<Restraint>,
    /// Columns of F*: deflections of the basic bridge for a unit load at the masses, then at the redundant supports (a
    /// unit couple where these hold the rotation).
    columns: Vec<Line>,
    /// Nodes of the hinges, and the deflections of the basic bridge for a unit kink at each.
    hinges: Vec<(usize, Line)>,
    /// Influence lines of the outer reactions of the basic bridge (R*, Q* and their like), left to right.
    outer: Vec<(Restraint, Line)>,
}

impl Recovered {
    /// Adds `factor` times another state of the bridge, whose inertia forces are left out.
    fn add_scaled(&mut self, factor: f64, other: &Recovered) {
        let add = |mine: &mut [f64], theirs: &[f64]| mine.iter_mut().zip(theirs).for_each(|(m, t)| *m += factor * t);
        add(&mut self.redundant_reactions, &other.redundant_reactions);
        add(&mut self.deflections, &other.deflections);
        add(&mut self.outer_reactions, &other.outer_reactions);
        add(&mut self.moments, &other.moments);
        add(self.shears.as_flattened_mut(), other.shears.as_flattened());
    }
}

/// What the sequence gives at one instant.
#[derive(Debug, Clone, PartialEq)]
pub struct Recovered {
    /// P̃: inertia and damping forces at the mass stations, down [N].
    pub inertia_forces: Vec<f64>,
    /// R: redundant reactions as loads, down [N], and couples in the sense of positive slope [N m].
    pub redundant_reactions: Vec<f64>,
    /// y at every node of the mesh [m].
    pub deflections: Vec<f64>,
    /// Reactions of the basic bridge on it: forces up [N], clamp moments at the ends sagging [N m], elsewhere in the
    /// sense of positive slope.
    pub outer_reactions: Vec<f64>,
    /// M at every node, just left of it where a support holds the rotation [N m].
    pub moments: Vec<f64>,
    /// V just left and just right of every node [N].
    pub shears: Vec<[f64; 2]>,
}

impl Sequence {
    /// For `modes` of `bridge`; `damping` is C at the mass stations, used by Eq. 6 alone.
    pub fn new(bridge: &Bridge, flexibility: &Flexibility, modes: &Modes, damping: Mat<f64>) -> Self {
        let mesh = flexibility.mesh();
        let masses: Vec<(usize, f64)> = bridge.stations().iter().map(|s| (mesh.node_at(s.at), s.mass)).collect();
        let redundants = flexibility.redundants().to_vec();
        let basic = Structure::Basic;
        let columns = masses.iter().map(|m| influence::deflection(flexibility, m.0, basic));
        let columns = columns.chain(redundants.iter().map(|r| match *r {
            Restraint::Deflection(node) => influence::deflection(flexibility, node, basic),
            Restraint::Slope(node) => influence::slope(flexibility, node, basic),
        }));
        let columns = columns.collect();
        let kinked = |&node: &usize| (node, flexibility.deflected(Action::Kink(node), basic));
        let hinges = flexibility.hinges().iter().map(kinked).collect();
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
            hinges,
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
    ///
    /// Where the bridge has hinges, the whole is done for a unit kink at each as well, and as much of these is added as
    /// takes the moments at the hinges away.
    pub fn recover(&self, axles: &[(f64, f64)], inertia_forces: &[f64]) -> Recovered {
        let mut recovered = self.recover_without_hinges(axles, inertia_forces, None);
        if self.hinges.is_empty() {
            return recovered;
        }
        let kinked: Vec<Recovered> =
            self.hinges.iter().map(|(_, line)| self.recover_without_hinges(&[], &[], Some(line))).collect();
        let n = self.hinges.len();
        let moments = Mat::from_fn(n, n, |i, j| kinked[j].moments[self.hinges[i].0]);
        let opposite = Mat::from_fn(n, 1, |i, _| -recovered.moments[self.hinges[i].0]);
        let kinks = moments.partial_piv_lu().solve(&opposite);
        for (j, unit) in kinked.iter().enumerate() {
            recovered.add_scaled(kinks[(j, 0)], unit);
        }
        recovered
    }

    /// Of the bridge without its hinges, which the basic bridge may enter with a deflected shape of its own.
    fn recover_without_hinges(&self, axles: &[(f64, f64)], inertia_forces: &[f64], shape: Option<&Line>) -> Recovered {
        let mesh = self.flexibility.mesh();
        let on_bridge: Vec<(f64, f64)> = axles.iter().copied().filter(|&(x, _)| mesh.panel_at(x).is_some()).collect();

        // [KTN73] Eq. 12: y* = F̄* P̄ + F* P̃*, here at the redundant supports. By Maxwell's theorem the deflection at a
        // support due to a unit load at an axle is the support's own column of F*, interpolated at the axle.
        let masses = self.masses.len();
        let y_r: Vec<f64> = (self.redundants.iter().enumerate())
            .map(|(i, redundant)| {
                let column = &self.columns[masses + i];
                let loads: f64 = on_bridge.iter().map(|&(x, p)| column.at(mesh, x) * p).sum();
                let forces = self.masses.iter().zip(inertia_forces);
                let own = shape.map_or(0.0, |shape| match *redundant {
                    Restraint::Deflection(node) => shape.at_node(node),
                    Restraint::Slope(node) => shape.slope_at_node(mesh, node),
                });
                own + loads + forces.map(|(&(node, _), p)| column.at_node(node) * p).sum::<f64>()
            })
            .collect();

        // [KTN73] Eq. 13: R = −K^R y^R.
        let redundant_reactions = self.flexibility.redundant_reactions(&y_r);

        // P*: the reactions take the place of the null elements of P̃*.
        let masses = self.masses.iter().map(|m| Restraint::Deflection(m.0));
        let p_star: Vec<(Restraint, f64)> = (masses.zip(inertia_forces.iter().copied().chain(std::iter::repeat(0.0))))
            .chain(self.redundants.iter().copied().zip(redundant_reactions.iter().copied()))
            .collect();

        // [KTN73] Eq. 14: y* = F̄* P̄ + F* P*, at every node; by Maxwell again, row and column change places.
        let deflections = (0..mesh.nodes().len())
            .map(|node| {
                let here = influence::deflection(&self.flexibility, node, Structure::Basic);
                let loads: f64 = on_bridge.iter().map(|&(x, p)| here.at(mesh, x) * p).sum();
                let own = shape.map_or(0.0, |shape| shape.at_node(node));
                own + loads
                    + self.columns.iter().zip(&p_star).map(|(column, p)| column.at_node(node) * p.1).sum::<f64>()
            })
            .collect();

        // [KTN73] Eq. 16: R¹ = (R*)ᵀ P* + (R̄*)ᵀ P̄, and Q¹ likewise. R enters as a load, so reactions on the bridge, up,
        // come out positive.
        let outer_reactions: Vec<f64> = (self.outer.iter())
            .map(|(restraint, line)| {
                let loads: f64 = on_bridge.iter().map(|&(x, p)| line.at(mesh, x) * p).sum();
                let own = shape.map_or(0.0, |shape| self.reaction_in(shape, *restraint));
                let forces = p_star.iter().map(|&(place, p)| match place {
                    Restraint::Deflection(node) => line.at_node(node) * p,
                    Restraint::Slope(node) => line.slope_at_node(mesh, node) * p,
                });
                own + loads + forces.sum::<f64>()
            })
            .collect();

        // Equilibrium with everything to the left of a section ([KTN73] Table 1: the outer reactions that stand there).
        let mut forces: Vec<(f64, f64)> = on_bridge.iter().map(|&(x, p)| (x, -p)).collect();
        let mut couples: Vec<(f64, f64)> = Vec::new();
        let end = mesh.panels();
        for &(place, p) in &p_star {
            match place {
                Restraint::Deflection(node) => forces.push((mesh.nodes()[node], -p)),
                Restraint::Slope(node) => couples.push((mesh.nodes()[node], p)),
            }
        }
        for ((restraint, _), &r) in self.outer.iter().zip(&outer_reactions) {
            match *restraint {
                Restraint::Deflection(node) => forces.push((mesh.nodes()[node], r)),
                Restraint::Slope(node) if node < end => couples.push((mesh.nodes()[node], r)),
                Restraint::Slope(_) => {}
            }
        }
        let up_to = |x: f64, inclusive: bool| {
            forces.iter().filter(move |&&(at, _)| at < x || (inclusive && at == x)).map(|&(_, f)| f).sum::<f64>()
        };
        // A couple at the left end is a moment there; elsewhere the moment is the one just left of it.
        let turned = |x: f64| couples.iter().filter(|c| c.0 < x || c.0 == 0.0).map(|c| c.1).sum::<f64>();
        let moments = (mesh.nodes().iter())
            .map(|&x| turned(x) + forces.iter().filter(|f| f.0 < x).map(|&(at, f)| f * (x - at)).sum::<f64>())
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

    /// Reaction of an outer restraint in a deflected shape of the basic bridge: the jump of its shear or moment.
    fn reaction_in(&self, shape: &Line, restraint: Restraint) -> f64 {
        let f = &self.flexibility;
        let end = f.mesh().panels();
        let jump = |node: usize, value: &dyn Fn(usize, f64) -> f64| {
            let after = if node < end { value(node, 0.0) } else { 0.0 };
            after - if node > 0 { value(node - 1, 1.0) } else { 0.0 }
        };
        match restraint {
            Restraint::Deflection(node) => jump(node, &|panel, _| f.shear_in(shape, panel)),
            Restraint::Slope(node) => {
                let rise = jump(node, &|panel, fraction| f.moment_in(shape, panel, fraction));
                if node < end { rise } else { -rise }
            }
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
