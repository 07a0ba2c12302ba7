//! Deflected shapes of the bridge under unit actions: the basic flexibility matrix F*, then F of the actual bridge.
//!
//! Reference: H. Kishan and R. W. Traill-Nash, "Calculation of response and loading of highway bridges from modal
//! coordinates", IABSE Publications 33 (1973), cited as KTN73 here and in the files that follow.
//!
//! A statically determinate beam is integrated panel by panel, exactly. Restraints are then added in two layers: the
//! other outer restraints make it the *basic bridge*, the intermediate redundant ones make it the bridge without its
//! hinges. Each layer is KTN73 Eqs. 12–14 with a unit action for the load; a spring adds its compliance to the diagonal
//! of the restraints' flexibility. Hinges come last, as the kinks that take the moments there away. No stiffness matrix
//! is formed or inverted except K^R, of the order of the number of redundants. Once the redundants' forces are known the
//! beam is integrated anew under all of them, so that a shape costs no more than its panels and K^R.

use faer::linalg::solvers::{Llt, Solve};
use faer::{Mat, Side};

use crate::bridge::Bridge;
use crate::bridge::cubics::{Line, Mesh};
use crate::bridge::support::Fixity;
use crate::error::Error;
use crate::float_mode::Standard;

/// Softest outer spring of a beam on more than two supports, as a fraction of EI/L³: below it rounding shows.
const SOFT: f64 = 1e-6;

/// What is done to the beam at a node to deflect it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Action {
    /// Unit force, down.
    Force(usize),
    /// Unit couple, in the sense of positive slope dw/dx (clockwise, with x to the right and w down).
    Couple(usize),
    /// Slope falling by one at the node: by reciprocity, the influence line of the bending moment there. A support that
    /// holds the rotation at the node stays with the part to the right, so the moment is the one just left of it.
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
    /// The bridge without its hinges and its intermediate redundant supports (KTN73 §2.3).
    Basic,
    /// The bridge as it is.
    Actual,
}

/// The statically determinate beam at the bottom.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Determinate {
    /// Held at one node, deflection and slope.
    Cantilever(usize),
    /// Resting on two nodes, with overhangs where these are not the ends.
    SimplySupported(usize, usize),
}

/// A restraint, and how far it gives way under a unit force or couple [m/N or rad/(N m)]: zero where it is rigid.
type Spring = (Restraint, f64);

/// Actions that come together, and how much of each.
pub type Actions = Vec<(f64, Action)>;

/// Shapes that are worked out together: enough for one pass over K^R to serve many, few enough to ask in between.
pub const TOGETHER: usize = 64;

/// Restraints added to the structure below.
#[derive(Debug, Clone)]
struct Layer {
    restraints: Vec<Restraint>,
    /// Cholesky factor of the restraints' flexibility in the structure below, their own included: F*_RR + C_s for the
    /// intermediate supports.
    factor: Option<Llt<f64>>,
}

impl Layer {
    const NONE: Layer = Layer { restraints: Vec::new(), factor: None };

    /// From the lower triangle of the flexibility.
    fn new(restraints: Vec<Restraint>, flexibility: &Mat<f64>) -> Result<Self, Error> {
        let factor = match restraints.len() {
            0 => None,
            _ => Some(Llt::new(flexibility.as_ref(), Side::Lower).map_err(|e| Error::Singular(format!("{e:?}")))?),
        };
        Ok(Layer { restraints, factor })
    }

    /// Restraint forces (down; couples in the sense of positive slope) that displace the restraints by `displacements`,
    /// their springs included: a column for each case.
    fn forces(&self, mut displacements: Mat<f64>) -> Mat<f64> {
        if let Some(factor) = &self.factor {
            factor.solve_in_place(displacements.as_mut());
        }
        displacements
    }
}

/// The hinges.
#[derive(Debug, Clone)]
struct Hinges {
    nodes: Vec<usize>,
    /// Cholesky factor of the moments that resist a unit kink at each, in the bridge without hinges [N m/rad].
    factor: Option<Llt<f64>>,
}

/// A hinge turns freely if what resists its kink is less than this fraction of EI/L, or if all but this fraction of it
/// is gone once the hinges to its left turn too. Rounding leaves about 10⁻¹³; two hinges L/10⁴ apart leave 10⁻⁸.
const FREE_TO_TURN: f64 = 1e-10;

impl Hinges {
    const NONE: Hinges = Hinges { nodes: Vec::new(), factor: None };

    /// At the `nodes`, left to right, of a bridge without hinges.
    fn new(nodes: Vec<usize>, flexibility: &Flexibility) -> Result<Self, Error> {
        let n = nodes.len();
        if n == 0 {
            return Ok(Hinges::NONE);
        }
        // By rows of the lower triangle: symmetric by reciprocity.
        let mut resistance: Vec<Vec<f64>> = (0..n).map(|i| Vec::with_capacity(i + 1)).collect();
        for some in nodes.chunks(TOGETHER) {
            let kinks: Vec<Actions> = some.iter().map(|&node| vec![(1.0, Action::Kink(node))]).collect();
            for line in flexibility.shapes(&kinks, 2) {
                let first = resistance[n - 1].len();
                for (row, &node) in resistance.iter_mut().zip(&nodes).skip(first) {
                    row.push(-flexibility.bending_moment(&line, node));
                }
            }
        }
        let softest = flexibility.flexural_rigidity.iter().copied().fold(f64::INFINITY, f64::min);
        let scale = softest / flexibility.mesh.length();
        let mut lower: Vec<Vec<f64>> = vec![Vec::new(); n];
        for j in 0..n {
            let known = |i: usize, lower: &[Vec<f64>]| lower[i].iter().zip(&lower[j]).map(|(a, b)| a * b).sum::<f64>();
            let whole = resistance[j][j];
            let left = whole - known(j, &lower);
            // Written so that a NaN fails.
            if !(whole > FREE_TO_TURN * scale && left > FREE_TO_TURN * whole) {
                let at = flexibility.mesh.nodes()[nodes[j]];
                return Err(Error::Mechanism { hinge: j, at });
            }
            let root = left.sqrt();
            for i in j + 1..n {
                let entry = (resistance[i][j] - known(i, &lower)) / root;
                lower[i].push(entry);
            }
        }
        let resistance = Mat::from_fn(n, n, |i, j| resistance[i.max(j)][i.min(j)]);
        let factor = Llt::new(resistance.as_ref(), Side::Lower).map_err(|e| Error::Singular(format!("{e:?}")))?;
        Ok(Hinges { nodes, factor: Some(factor) })
    }

    /// Takes the moments at the hinges out of shapes of the bridge without hinges.
    fn release(&self, flexibility: &Flexibility, lines: &mut [Line]) {
        let Some(factor) = &self.factor else { return };
        // M_h + Σ α_j M_h(kink j) = 0.
        let moment = |i: usize, j: usize| flexibility.bending_moment(&lines[j], self.nodes[i]);
        let mut kinks = Mat::from_fn(self.nodes.len(), lines.len(), moment);
        factor.solve_in_place(kinks.as_mut());
        let turned = |j: usize| {
            kinks.col(j).iter().zip(&self.nodes).map(|(&k, &node)| (k, Action::Kink(node))).collect::<Actions>()
        };
        let turned: Vec<Actions> = (0..lines.len()).map(turned).collect();
        for (line, turned) in lines.iter_mut().zip(flexibility.shapes(&turned, 2)) {
            line.add_scaled(1.0, &turned);
        }
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
    support: Vec<Spring>,
    /// The outer redundants, then the intermediate ones.
    layers: [Layer; 2],
    hinges: Hinges,
}

impl Flexibility {
    /// Of `bridge`, with nodes at its stations, supports, hinges, changes of EI and at `sections` [m].
    ///
    /// Fails if the hinges make a mechanism of the bridge.
    pub fn new(bridge: &Bridge, sections: &[f64]) -> Result<Self, Error> {
        let _mode = Standard::set();
        let mesh = Mesh::new(bridge.length(), bridge.points().chain(sections.iter().copied()));
        let middle = |panel: usize| mesh.nodes()[panel] + 0.5 * mesh.width(panel);
        let flexural_rigidity: Vec<f64> = (0..mesh.panels()).map(|p| bridge.flexural_rigidity_at(middle(p))).collect();

        let supports = bridge.supports();
        let last = supports.len() - 1;
        let node = |i: usize| mesh.node_at(supports[i].at);
        let deflection = |i: usize| (Restraint::Deflection(node(i)), 1.0 / supports[i].fixity.vertical());
        // The rotation of a support that holds it in some way.
        let slope = |i: usize| {
            let stiffness = supports[i].fixity.rotation();
            (stiffness > 0.0).then(|| (Restraint::Slope(node(i)), 1.0 / stiffness))
        };
        let built_in = |i: usize| supports[i].fixity == Fixity::Clamped;
        let mut outer: Vec<Spring> = Vec::new();
        let (determinate, support) = if last == 0 || (built_in(0) && supports[0].at == 0.0) {
            if last > 0 {
                outer.push(deflection(last));
                outer.extend(slope(last));
            }
            (Determinate::Cantilever(node(0)), [Some(deflection(0)), slope(0)].into_iter().flatten().collect())
        } else if built_in(last) && supports[last].at == bridge.length() {
            outer.push(deflection(0));
            outer.extend(slope(0));
            (Determinate::Cantilever(node(last)), [Some(deflection(last)), slope(last)].into_iter().flatten().collect())
        } else {
            outer.extend(slope(0));
            outer.extend(slope(last));
            (Determinate::SimplySupported(node(0), node(last)), vec![deflection(0), deflection(last)])
        };
        let intermediate: Vec<Spring> =
            (1..last.max(1)).flat_map(|i| [Some(deflection(i)), slope(i)]).flatten().collect();

        refuse_soft_base(bridge, [0, last], &flexural_rigidity)?;
        let hinges: Vec<usize> = bridge.hinges().iter().map(|&x| mesh.node_at(x)).collect();
        let mut flexibility = Flexibility {
            mesh,
            flexural_rigidity,
            determinate,
            support,
            layers: [Layer::NONE, Layer::NONE],
            hinges: Hinges::NONE,
        };
        for (depth, springs) in [outer, intermediate].into_iter().enumerate() {
            let mut among = Mat::zeros(springs.len(), springs.len());
            for (j, &(restraint, compliance)) in springs.iter().enumerate() {
                let line = flexibility.shape(&[(1.0, unit_force(restraint))], depth);
                for (i, &(other, _)) in springs.iter().enumerate().skip(j) {
                    among[(i, j)] = displacement(&flexibility.mesh, &line, other);
                }
                among[(j, j)] += compliance;
            }
            let restraints = springs.iter().map(|spring| spring.0).collect();
            flexibility.layers[depth] = Layer::new(restraints, &among)?;
        }
        flexibility.hinges = Hinges::new(hinges, &flexibility)?;
        Ok(flexibility)
    }

    /// The mesh that every line of this flexibility lives on.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// Deflected shape under a unit action [m per N, per N m, per rad or per m].
    pub fn deflected(&self, action: Action, structure: Structure) -> Line {
        self.deflected_by(&[(1.0, action)], structure)
    }

    /// Deflected shape under several actions that come together.
    pub fn deflected_by(&self, actions: &[(f64, Action)], structure: Structure) -> Line {
        self.all_of(&[actions], structure).swap_remove(0)
    }

    /// Deflected shapes under one case of actions after another.
    pub fn each_deflected(&self, cases: &[Actions], structure: Structure) -> Vec<Line> {
        cases.chunks(TOGETHER).flat_map(|some| self.all_of(some, structure)).collect()
    }

    fn all_of<A: AsRef<[(f64, Action)]>>(&self, cases: &[A], structure: Structure) -> Vec<Line> {
        match structure {
            Structure::Basic => self.shapes(cases, 1),
            Structure::Actual => {
                let mut lines = self.shapes(cases, 2);
                self.hinges.release(self, &mut lines);
                lines
            }
        }
    }

    /// Nodes of the hinges, left to right.
    pub fn hinges(&self) -> &[usize] {
        &self.hinges.nodes
    }

    /// Bending moment just left of a node in a deflected shape, −EI w'' [N m]; at the left end just right of it.
    pub fn bending_moment(&self, line: &Line, node: usize) -> f64 {
        let (panel, fraction) = if node == 0 { (0, 0.0) } else { (node - 1, 1.0) };
        self.moment_in(line, panel, fraction)
    }

    /// Bending moment at a fraction of a panel, −EI w'' [N m].
    pub fn moment_in(&self, line: &Line, panel: usize, fraction: f64) -> f64 {
        let [_, _, c2, c3] = line.cubics()[panel];
        -self.flexural_rigidity[panel] / self.mesh.width(panel).powi(2) * (2.0 * c2 + 6.0 * c3 * fraction)
    }

    /// Shear in a panel, the derivative of the bending moment [N].
    pub fn shear_in(&self, line: &Line, panel: usize) -> f64 {
        -self.flexural_rigidity[panel] / self.mesh.width(panel).powi(3) * 6.0 * line.cubics()[panel][3]
    }

    /// The restraints of the basic bridge, left to right: deflection before slope.
    pub fn outer_restraints(&self) -> Vec<Restraint> {
        let mut all: Vec<Restraint> =
            self.support.iter().map(|s| s.0).chain(self.layers[0].restraints.iter().copied()).collect();
        all.sort_by_key(order);
        all
    }

    /// The restraints of the intermediate redundant supports, left to right: deflection before slope.
    pub fn redundants(&self) -> &[Restraint] {
        &self.layers[1].restraints
    }

    /// Whether a structure has a restraint.
    pub fn holds(&self, restraint: Restraint, structure: Structure) -> bool {
        let layers = if structure == Structure::Actual { &self.layers[..] } else { &self.layers[..1] };
        self.support.iter().any(|s| s.0 == restraint) || layers.iter().any(|l| l.restraints.contains(&restraint))
    }

    /// All restraints of a structure, left to right: deflection before slope.
    pub fn restraints(&self, structure: Structure) -> Vec<Restraint> {
        let mut all = self.outer_restraints();
        if structure == Structure::Actual {
            all.extend(self.redundants());
        }
        all.sort_by_key(order);
        all
    }

    /// R = −K^R y^R: the redundant reactions as loads (down, couples in the sense of positive slope) that undo the
    /// deflections y^R [m] and slopes [rad] (KTN73 Eq. 13).
    pub fn redundant_reactions(&self, deflections: &[f64]) -> Vec<f64> {
        let forces = self.layers[1].forces(Mat::from_fn(deflections.len(), 1, |i, _| -deflections[i]));
        forces.col(0).iter().copied().collect()
    }

    /// K^R, the inverse of F*_RR and the redundants' own flexibility, by its Cholesky factor [N/m] (KTN73 §2.3).
    pub fn redundant_stiffness(&self) -> Mat<f64> {
        let n = self.redundants().len();
        self.layers[1].forces(Mat::identity(n, n))
    }

    /// Deflections at `rows` for unit forces at `columns` (nodes) [m/N]: F* on the basic bridge, F on the actual one.
    pub fn matrix(&self, rows: &[usize], columns: &[usize], structure: Structure) -> Mat<f64> {
        let mut matrix = Mat::zeros(rows.len(), columns.len());
        for (part, some) in columns.chunks(TOGETHER).enumerate() {
            let forces: Vec<Actions> = some.iter().map(|&node| vec![(1.0, Action::Force(node))]).collect();
            for (j, line) in (part * TOGETHER..).zip(self.all_of(&forces, structure)) {
                for (i, &row) in rows.iter().enumerate() {
                    matrix[(i, j)] = line.at_node(row);
                }
            }
        }
        matrix
    }

    /// Nodes of the mass stations and the intermediate redundant supports, left to right: the order of F* in KTN73.
    pub fn reference_nodes(&self, bridge: &Bridge) -> Vec<usize> {
        let mut nodes: Vec<usize> = bridge.stations().iter().map(|s| self.mesh.node_at(s.at)).collect();
        nodes.extend(self.redundants().iter().filter(|r| matches!(r, Restraint::Deflection(_))).map(|r| r.node()));
        nodes.sort_unstable();
        // A mass on a spring support is both.
        nodes.dedup();
        nodes
    }

    fn shape(&self, actions: &[(f64, Action)], depth: usize) -> Line {
        self.shapes(&[actions], depth).swap_remove(0)
    }

    /// Shapes under several cases of actions, of the structure with so many layers of restraints.
    fn shapes<A: AsRef<[(f64, Action)]>>(&self, cases: &[A], depth: usize) -> Vec<Line> {
        let mut lines: Vec<Line> = cases.iter().map(|actions| self.determinate_shape(actions.as_ref())).collect();
        for (level, layer) in self.layers[..depth].iter().enumerate().filter(|(_, layer)| layer.factor.is_some()) {
            // [KTN73] Eq. 13: R = -K^R y^R, then Eq. 14; a restraint that settles is displaced by that much more.
            let missing = |i: usize, j: usize| {
                let restraint = layer.restraints[i];
                settlement(cases[j].as_ref(), restraint) - displacement(&self.mesh, &lines[j], restraint)
            };
            let forces = layer.forces(Mat::from_fn(layer.restraints.len(), cases.len(), missing));
            let reactions = |j: usize| {
                let forces = forces.col(j).iter().zip(&layer.restraints);
                forces.map(|(&force, &restraint)| (force, unit_force(restraint))).collect::<Actions>()
            };
            let reactions: Vec<Actions> = (0..cases.len()).map(reactions).collect();
            for (line, restrained) in lines.iter_mut().zip(self.shapes(&reactions, level)) {
                line.add_scaled(1.0, &restrained);
            }
        }
        lines
    }

    /// Shape of the determinate beam on its springs: on rigid supports, and each spring gives way under its reaction.
    fn determinate_shape(&self, actions: &[(f64, Action)]) -> Line {
        let mut line = self.rigidly_supported_shape(actions);
        for &(restraint, compliance) in &self.support {
            let settles = settlement(actions, restraint);
            if compliance == 0.0 && settles == 0.0 {
                continue;
            }
            let settled = self.rigid_settlement(restraint);
            // By virtual work the reaction, here as a load on the spring, is what the action does on a unit settlement;
            // a kink or a jump calls for none.
            let work = actions.iter().map(|&(size, action)| match action {
                Action::Force(node) => size * settled.at_node(node),
                Action::Couple(node) => size * settled.slope_at_node(&self.mesh, node),
                Action::Kink(_) | Action::Jump(_) | Action::Settlement(_) => 0.0,
            });
            line.add_scaled(compliance * work.sum::<f64>() + settles, &settled);
        }
        line
    }

    /// Shear and moment from the left, curvature −M/EI integrated twice, rigid body to the supports.
    fn rigidly_supported_shape(&self, actions: &[(f64, Action)]) -> Line {
        let x = self.mesh.nodes();
        let end = self.mesh.panels();
        // A couple at a node acts on the panel to its right.
        let mut nodes = vec![AtNode::default(); end + 1];
        let (mut force, mut couple, mut about) = (0.0, 0.0, 0.0);
        let held = match self.determinate {
            Determinate::Cantilever(node) | Determinate::SimplySupported(node, _) => node,
        };
        for &(size, action) in actions {
            match action {
                Action::Force(node) => {
                    nodes[node].force += size;
                    force += size;
                    about += size * (x[node] - x[held]);
                }
                Action::Couple(node) => {
                    nodes[node].couple += size;
                    couple += size;
                }
                Action::Kink(node) => nodes[node].kink += size,
                Action::Jump(node) => nodes[node].jump += size,
                Action::Settlement(_) => {}
            }
        }
        match self.determinate {
            Determinate::Cantilever(node) => {
                nodes[node].force -= force;
                nodes[node].couple -= about + couple;
            }
            Determinate::SimplySupported(left, right) => {
                let at_right = (about + couple) / (x[right] - x[left]);
                nodes[right].force -= at_right;
                nodes[left].force -= force - at_right;
            }
        }
        let (mut w, mut slope, mut shear, mut moment) = (0.0, 0.0, 0.0, 0.0);
        let mut cubics = Vec::with_capacity(end);
        for (panel, node) in nodes[..end].iter().enumerate() {
            w += node.jump;
            slope -= node.kink;
            shear -= node.force;
            moment += node.couple;
            let h = self.mesh.width(panel);
            let scale = h * h / self.flexural_rigidity[panel];
            let cubic = [w, slope * h, -0.5 * scale * moment, -scale * (shear * h) / 6.0];
            w += cubic[1] + cubic[2] + cubic[3];
            slope += (2.0 * cubic[2] + 3.0 * cubic[3]) / h;
            moment += shear * h;
            cubics.push(cubic);
        }
        let mut line = Line::from_cubics(cubics);
        let (a, b) = match self.determinate {
            Determinate::Cantilever(node) => {
                let (w, slope) = (line.at_node(node), line.slope_at_node(&self.mesh, node));
                (-(w - slope * x[node]), -slope)
            }
            Determinate::SimplySupported(left, right) => {
                let (wl, wr) = (line.at_node(left), line.at_node(right));
                let b = -(wr - wl) / (x[right] - x[left]);
                (-wl - b * x[left], b)
            }
        };
        line.add_scaled(1.0, &Line::straight(&self.mesh, a, b));
        line
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

/// What happens to the determinate beam at a node.
#[derive(Debug, Clone, Copy, Default)]
struct AtNode {
    force: f64,
    couple: f64,
    kink: f64,
    jump: f64,
}

/// By how much a restraint settles.
fn settlement(actions: &[(f64, Action)], restraint: Restraint) -> f64 {
    actions.iter().filter(|(_, action)| *action == Action::Settlement(restraint)).map(|(size, _)| size).sum()
}

/// Left to right, deflection before slope.
fn order(restraint: &Restraint) -> (usize, u8) {
    match *restraint {
        Restraint::Deflection(node) => (node, 0),
        Restraint::Slope(node) => (node, 1),
    }
}

/// Refuses outer springs so soft, beside other supports, that the beam would be carried by the difference of large numbers.
fn refuse_soft_base(bridge: &Bridge, outer: [usize; 2], flexural_rigidity: &[f64]) -> Result<(), Error> {
    let supports = bridge.supports();
    if supports.len() <= 2 {
        return Ok(());
    }
    let softest = flexural_rigidity.iter().copied().fold(f64::INFINITY, f64::min);
    let least = SOFT * softest / bridge.length().powi(3);
    for i in outer {
        let stiffness = supports[i].fixity.vertical();
        if stiffness < least {
            let allowed =
                format!("must be at least {least:.3e} N/m beside other supports; leave it out if it is softer");
            return Err(Error::input(format!("supports[{i}].vertical"), format!("{stiffness:e} N/m"), allowed));
        }
    }
    Ok(())
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
