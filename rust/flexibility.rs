//! Deflected shapes of the bridge under unit actions: the basic flexibility matrix F*, then F of the actual bridge.
//!
//! Reference: H. Kishan and R. W. Traill-Nash, "Calculation of response and loading of highway bridges from modal
//! coordinates", IABSE Publications 33 (1973), cited as KTN73 here and in the files that follow.
//!
//! A statically determinate beam is integrated panel by panel, exactly. Restraints are then added in two layers: the
//! other outer support makes it the *basic bridge*, the intermediate redundant supports make it the actual bridge.
//! Each layer is KTN73 Eqs. 12–14 with a unit action for the load. No stiffness matrix is formed or inverted except
//! K^R, of the order of the number of redundants.

use faer::linalg::solvers::{Llt, Solve};
use faer::{Mat, Side};

use crate::bridge::{Bridge, Fixity};
use crate::error::Error;
use crate::line::{Line, Mesh};

/// What is done to the beam at a node to deflect it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Action {
    /// Unit force, down.
    Force(usize),
    /// Unit couple, in the sense of positive slope dw/dx (clockwise, with x to the right and w down).
    Couple(usize),
    /// Slope falling by one at the node: by reciprocity, the influence line of the bending moment there.
    Kink(usize),
    /// Deflection rising by one at the node: the influence line of the shear there. A support at the node stays with
    /// the part to the right.
    Jump(usize),
    /// Unit settlement (down) or unit rotation (positive slope) of a restraint: the influence line of its reaction.
    Settlement(Restraint),
}

/// One degree of freedom held by a support, at a node.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Restraint {
    /// Deflection held.
    Deflection(usize),
    /// Slope held.
    Slope(usize),
}

/// Which structure is deflected.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Structure {
    /// The bridge without its intermediate redundant supports (KTN73 §2.3).
    Basic,
    /// The bridge as it is.
    Actual,
}

/// The statically determinate beam at the bottom.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Determinate {
    CantileverFromLeft,
    CantileverFromRight,
    /// Resting on two nodes, with overhangs where these are not the ends.
    SimplySupported(usize, usize),
}

/// Restraints added to the structure below, with its deflected shapes under their unit forces.
#[derive(Debug, Clone)]
struct Layer {
    restraints: Vec<Restraint>,
    lines: Vec<Line>,
    /// Cholesky factor of the restraints' flexibility in the structure below: F*_RR for the intermediate supports.
    factor: Option<Llt<f64>>,
}

impl Layer {
    fn new(mesh: &Mesh, restraints: Vec<Restraint>, lines: Vec<Line>) -> Result<Self, Error> {
        let n = restraints.len();
        let flexibility = Mat::from_fn(n, n, |i, j| displacement(mesh, &lines[j.min(i)], restraints[j.max(i)]));
        let factor = match n {
            0 => None,
            _ => Some(Llt::new(flexibility.as_ref(), Side::Lower).map_err(|e| Error::Singular(format!("{e:?}")))?),
        };
        Ok(Layer { restraints, lines, factor })
    }

    /// Restraint forces (down; couples in the sense of positive slope) that displace the restraints by `displacements`.
    fn forces(&self, displacements: &[f64]) -> Vec<f64> {
        let Some(factor) = &self.factor else { return Vec::new() };
        let mut forces = Mat::from_fn(displacements.len(), 1, |i, _| displacements[i]);
        factor.solve_in_place(forces.as_mut());
        forces.col(0).iter().copied().collect()
    }

    fn add_forces(&self, line: &mut Line, forces: &[f64]) {
        for (&force, unit) in forces.iter().zip(&self.lines) {
            line.add_scaled(force, unit);
        }
    }

    /// Restrains a shape of the structure below.
    fn restrain(&self, mesh: &Mesh, line: &mut Line) {
        // [KTN73] Eq. 13: R = -K^R y^R, then Eq. 14.
        let opposite: Vec<f64> = self.restraints.iter().map(|&r| -displacement(mesh, line, r)).collect();
        self.add_forces(line, &self.forces(&opposite));
    }
}

fn displacement(mesh: &Mesh, line: &Line, restraint: Restraint) -> f64 {
    match restraint {
        Restraint::Deflection(node) => line.at_node(node),
        Restraint::Slope(node) => line.slope_at_node(mesh, node),
    }
}

/// The flexibility of a bridge on a mesh.
#[derive(Debug, Clone)]
pub struct Flexibility {
    mesh: Mesh,
    /// EI of each panel [N m²].
    flexural_rigidity: Vec<f64>,
    determinate: Determinate,
    /// Restraints of the determinate beam, left to right.
    support: Vec<Restraint>,
    /// The outer redundants, then the intermediate ones.
    layers: [Layer; 2],
}

impl Flexibility {
    /// Of `bridge`, with nodes at its stations, supports, changes of EI and at `sections` [m].
    pub fn new(bridge: &Bridge, sections: &[f64]) -> Result<Self, Error> {
        let stations = bridge.stations().iter().map(|s| s.at);
        let points = bridge.span_bounds().iter().copied().chain(stations).chain(sections.iter().copied());
        let mesh = Mesh::new(bridge.length(), points);
        let flexural_rigidity = mesh.nodes()[..mesh.panels()].iter().map(|&x| bridge.flexural_rigidity_at(x)).collect();

        let supports = bridge.supports();
        let node = |i: usize| mesh.node_at(supports[i].at);
        let last = supports.len() - 1;
        let clamped = |i: usize| supports[i].fixity == Fixity::Clamped;
        let mut outer = Vec::new();
        let (determinate, support) = if clamped(0) && supports[0].at == 0.0 {
            if last > 0 {
                outer.push(Restraint::Deflection(node(last)));
                if clamped(last) {
                    outer.push(Restraint::Slope(node(last)));
                }
            }
            (Determinate::CantileverFromLeft, vec![Restraint::Deflection(0), Restraint::Slope(0)])
        } else if clamped(last) {
            if last > 0 {
                outer.push(Restraint::Deflection(node(0)));
            }
            let end = mesh.panels();
            (Determinate::CantileverFromRight, vec![Restraint::Deflection(end), Restraint::Slope(end)])
        } else {
            let (a, b) = (node(0), node(last));
            (Determinate::SimplySupported(a, b), vec![Restraint::Deflection(a), Restraint::Deflection(b)])
        };
        let intermediate: Vec<Restraint> = (1..last.max(1)).map(|i| Restraint::Deflection(node(i))).collect();

        let none = Layer { restraints: Vec::new(), lines: Vec::new(), factor: None };
        let mut flexibility =
            Flexibility { mesh, flexural_rigidity, determinate, support, layers: [none.clone(), none] };
        for (depth, restraints) in [outer, intermediate].into_iter().enumerate() {
            let lines = restraints.iter().map(|&r| flexibility.deflected_to(unit_force(r), depth)).collect();
            flexibility.layers[depth] = Layer::new(&flexibility.mesh, restraints, lines)?;
        }
        Ok(flexibility)
    }

    /// The mesh that every line of this flexibility lives on.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// Deflected shape under a unit action [m per N, per N m, per rad or per m].
    pub fn deflected(&self, action: Action, structure: Structure) -> Line {
        self.deflected_to(
            action,
            match structure {
                Structure::Basic => 1,
                Structure::Actual => 2,
            },
        )
    }

    /// The restraints of the basic bridge, left to right: deflection before slope.
    pub fn outer_restraints(&self) -> Vec<Restraint> {
        let mut all: Vec<Restraint> = self.support.iter().chain(&self.layers[0].restraints).copied().collect();
        all.sort_by_key(|r| match *r {
            Restraint::Deflection(node) => (node, 0),
            Restraint::Slope(node) => (node, 1),
        });
        all
    }

    /// The intermediate redundant supports, left to right.
    pub fn redundants(&self) -> &[Restraint] {
        &self.layers[1].restraints
    }

    /// R = −K^R y^R: the redundant reactions as loads (down) that undo the deflections y^R [m] (KTN73 Eq. 13).
    pub fn redundant_reactions(&self, deflections: &[f64]) -> Vec<f64> {
        let opposite: Vec<f64> = deflections.iter().map(|y| -y).collect();
        self.layers[1].forces(&opposite)
    }

    /// K^R, the inverse of F*_RR, by its Cholesky factor [N/m] (KTN73 §2.3).
    pub fn redundant_stiffness(&self) -> Mat<f64> {
        let n = self.redundants().len();
        let columns: Vec<Vec<f64>> =
            (0..n).map(|j| self.layers[1].forces(&(0..n).map(|i| f64::from(i == j)).collect::<Vec<_>>())).collect();
        Mat::from_fn(n, n, |i, j| columns[j][i])
    }

    /// Deflections at `rows` for unit forces at `columns` (nodes) [m/N]: F* on the basic bridge, F on the actual one.
    pub fn matrix(&self, rows: &[usize], columns: &[usize], structure: Structure) -> Mat<f64> {
        let lines: Vec<Line> = columns.iter().map(|&node| self.deflected(Action::Force(node), structure)).collect();
        Mat::from_fn(rows.len(), columns.len(), |i, j| lines[j].at_node(rows[i]))
    }

    /// Nodes of the mass stations and the intermediate redundant supports, left to right: the order of F* in KTN73.
    pub fn reference_nodes(&self, bridge: &Bridge) -> Vec<usize> {
        let mut nodes: Vec<usize> = bridge.stations().iter().map(|s| self.mesh.node_at(s.at)).collect();
        nodes.extend(self.redundants().iter().map(|r| r.node()));
        nodes.sort_unstable();
        nodes
    }

    fn deflected_to(&self, action: Action, depth: usize) -> Line {
        let settling = match action {
            Action::Settlement(restraint) => self.layers.iter().position(|l| l.restraints.contains(&restraint)),
            _ => None,
        };
        let mut line = match settling {
            // A restraint above the determinate beam settles: nothing happens below its layer.
            Some(_) => Line::straight(&self.mesh, 0.0, 0.0),
            None => self.determinate_shape(action),
        };
        for (level, layer) in self.layers[..depth].iter().enumerate() {
            match (settling, action) {
                (Some(own), _) if level < own => {}
                (Some(own), Action::Settlement(restraint)) if level == own => {
                    let unit: Vec<f64> = layer.restraints.iter().map(|&r| f64::from(r == restraint)).collect();
                    layer.add_forces(&mut line, &layer.forces(&unit));
                }
                _ => layer.restrain(&self.mesh, &mut line),
            }
        }
        line
    }

    /// Shape of the determinate beam: moments from the left, curvature −M/EI integrated twice, rigid body to the supports.
    fn determinate_shape(&self, action: Action) -> Line {
        let x = self.mesh.nodes();
        let end = self.mesh.panels();
        if let Action::Settlement(restraint) = action {
            return self.rigid_settlement(restraint);
        }
        let (force, couple, at) = match action {
            Action::Force(node) => (1.0, 0.0, node),
            Action::Couple(node) => (0.0, 1.0, node),
            Action::Kink(node)
            | Action::Jump(node)
            | Action::Settlement(Restraint::Deflection(node) | Restraint::Slope(node)) => (0.0, 0.0, node),
        };
        let (mut w, mut slope) = (0.0, 0.0);
        let mut cubics = Vec::with_capacity(end);
        for panel in 0..end {
            match action {
                Action::Kink(node) if node == panel => slope -= 1.0,
                Action::Jump(node) if node == panel => w += 1.0,
                _ => {}
            }
            let h = self.mesh.width(panel);
            // A couple at a node acts on the panel to its right.
            let couple_here = if at <= panel { couple } else { 0.0 };
            let moment = |node: usize| self.determinate_moment(x[node], x[at], force, couple) + couple_here;
            let (left, right) = (moment(panel), moment(panel + 1));
            let scale = h * h / self.flexural_rigidity[panel];
            let cubic = [w, slope * h, -0.5 * scale * left, -scale * (right - left) / 6.0];
            w += cubic[1] + cubic[2] + cubic[3];
            slope += (2.0 * cubic[2] + 3.0 * cubic[3]) / h;
            cubics.push(cubic);
        }
        let mut line = Line::from_cubics(cubics);
        let (a, b) = match self.determinate {
            Determinate::CantileverFromLeft => (0.0, 0.0),
            Determinate::CantileverFromRight => (-(w - slope * x[end]), -slope),
            Determinate::SimplySupported(left, right) => {
                let (wl, wr) = (line.at_node(left), line.at_node(right));
                let b = -(wr - wl) / (x[right] - x[left]);
                (-wl - b * x[left], b)
            }
        };
        line.add_scaled(1.0, &Line::straight(&self.mesh, a, b));
        line
    }

    /// Bending moment at x of the determinate beam under a force at `at` and the reactions to a force and a couple
    /// there, from everything to the left of x except the couple itself.
    fn determinate_moment(&self, x: f64, at: f64, force: f64, couple: f64) -> f64 {
        let arm = |from: f64| if x > from { x - from } else { 0.0 };
        let reactions = match self.determinate {
            Determinate::CantileverFromLeft => force * x - force * at - couple,
            Determinate::CantileverFromRight => 0.0,
            Determinate::SimplySupported(left, right) => {
                let (a, b) = (self.mesh.nodes()[left], self.mesh.nodes()[right]);
                let at_b = (force * (at - a) + couple) / (b - a);
                (force - at_b) * arm(a) + at_b * arm(b)
            }
        };
        reactions - force * arm(at)
    }

    fn rigid_settlement(&self, restraint: Restraint) -> Line {
        let x = self.mesh.nodes();
        let (a, b) = match (self.determinate, restraint) {
            (Determinate::SimplySupported(left, right), Restraint::Deflection(node)) => {
                let other = if node == left { right } else { left };
                let b = 1.0 / (x[node] - x[other]);
                (-b * x[other], b)
            }
            (_, Restraint::Deflection(_)) => (1.0, 0.0),
            (_, Restraint::Slope(node)) => (-x[node], 1.0),
        };
        Line::straight(&self.mesh, a, b)
    }
}

impl Restraint {
    /// The node at which it holds.
    pub fn node(self) -> usize {
        match self {
            Restraint::Deflection(node) | Restraint::Slope(node) => node,
        }
    }
}

fn unit_force(restraint: Restraint) -> Action {
    match restraint {
        Restraint::Deflection(node) => Action::Force(node),
        Restraint::Slope(node) => Action::Couple(node),
    }
}
