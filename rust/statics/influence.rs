//! Influence lines: each response of the bridge, at any section, to a unit load anywhere on it.
//!
//! By reciprocity the influence line of a response is a deflected shape of the same bridge: under a unit force for a
//! deflection, a unit kink for a moment, a unit jump for a shear, a unit settlement for a reaction. All are exact.

use std::ops::Range;

use crate::bridge::Bridge;
use crate::bridge::cubics::{Line, Mesh};
use crate::error::Error;
use crate::statics::flexibility::{Action, Actions, Flexibility, Restraint, Structure, TOGETHER};
use crate::statics::quantity::{At, Quantity};
use crate::stop_token::StopToken;

/// Slope at a node [rad] per unit load along the bridge.
pub fn slope(flexibility: &Flexibility, node: usize, structure: Structure) -> Line {
    flexibility.deflected(Action::Couple(node), structure)
}

/// Deflection at a node [m] per unit load along the bridge.
pub fn deflection(flexibility: &Flexibility, node: usize, structure: Structure) -> Line {
    flexibility.deflected(Action::Force(node), structure)
}

/// Reaction of a restraint per unit load along the bridge: a force up [N/N]; of a rotational one at an end of the bridge
/// the sagging moment there, elsewhere the couple in the sense of positive slope, by which the bending moment is greater
/// just right of it than just left [N m/N].
pub fn reaction(flexibility: &Flexibility, restraint: Restraint, structure: Structure) -> Line {
    flexibility.deflected_by(&[of_reaction(flexibility, restraint)], structure)
}

/// Bending moment at a node [N m/N] per unit load along the bridge: just left of it, where a support holds the rotation.
pub fn moment(flexibility: &Flexibility, node: usize, structure: Structure) -> Line {
    flexibility.deflected_by(&of_moment(flexibility, node, structure), structure)
}

/// Shear just left and just right of a node [N/N] per unit load along the bridge.
pub fn shear(flexibility: &Flexibility, node: usize, structure: Structure) -> [Line; 2] {
    of_shear(flexibility, node, structure).map(|actions| flexibility.deflected_by(&actions, structure))
}

/// The action whose shape is the influence line of a reaction.
fn of_reaction(flexibility: &Flexibility, restraint: Restraint) -> (f64, Action) {
    let sign = match restraint {
        // A couple in the sense of positive slope opposes the settlement, so its work changes sign; at the right end
        // the sagging moment is the opposite couple.
        Restraint::Slope(node) if node < flexibility.mesh().panels() => -1.0,
        _ => 1.0,
    };
    (sign, Action::Settlement(restraint))
}

/// The same of a bending moment: none where there is no moment.
fn of_moment(flexibility: &Flexibility, node: usize, structure: Structure) -> Actions {
    if node == 0 || node == flexibility.mesh().panels() {
        held(flexibility, Restraint::Slope(node), structure)
    } else if structure == Structure::Actual && flexibility.hinges().contains(&node) {
        Actions::new()
    } else {
        vec![(1.0, Action::Kink(node))]
    }
}

/// The same of the shear on the left and on the right.
fn of_shear(flexibility: &Flexibility, node: usize, structure: Structure) -> [Actions; 2] {
    let support = held(flexibility, Restraint::Deflection(node), structure);
    if node == 0 {
        // No force stands to the left of the left end.
        [Actions::new(), support]
    } else if node == flexibility.mesh().panels() {
        // No force stands to the right of the right end.
        [support.into_iter().map(|(size, action)| (-size, action)).collect(), Actions::new()]
    } else {
        let jump = (1.0, Action::Jump(node));
        [vec![jump], std::iter::once(jump).chain(support).collect()]
    }
}

/// That of the reaction of a restraint if the structure has it.
fn held(flexibility: &Flexibility, restraint: Restraint, structure: Structure) -> Actions {
    let held = flexibility.holds(restraint, structure);
    held.then(|| of_reaction(flexibility, restraint)).into_iter().collect()
}

/// Every response looked at, kind by kind, and its influence line.
#[derive(Debug, Clone)]
pub struct Responses {
    sections: Vec<usize>,
    /// The kinds, and which of the lines are theirs.
    ranges: Vec<(Quantity, Range<usize>)>,
    /// Nodes at which deflection is held.
    held: Vec<usize>,
    lines: Vec<Line>,
}

impl Responses {
    /// Of some kinds at `sections` [m], which must be nodes of the flexibility's mesh; `stop` is asked now and then whether
    /// to.
    pub fn new(
        flexibility: &Flexibility,
        bridge: &Bridge,
        sections: &[f64],
        quantities: &[Quantity],
        stop: StopToken<'_>,
    ) -> Result<Self, Error> {
        let mesh = flexibility.mesh();
        let sections: Vec<usize> = sections.iter().map(|&x| mesh.node_at(x)).collect();
        let rigid = bridge.supports().iter().filter(|s| s.fixity.vertical().is_infinite());
        let held = rigid.map(|s| mesh.node_at(s.at)).collect();
        let actual = Structure::Actual;
        let (clamps, vertical): (Vec<Restraint>, Vec<Restraint>) =
            flexibility.restraints(actual).into_iter().partition(|r| matches!(r, Restraint::Slope(_)));
        let at_sections = |actions: &dyn Fn(usize) -> Actions| sections.iter().map(|&node| actions(node)).collect();
        let of_restraints = |all: &[Restraint]| all.iter().map(|&r| vec![of_reaction(flexibility, r)]).collect();
        let of = |quantity: Quantity| -> Vec<Actions> {
            match quantity {
                Quantity::Deflection => at_sections(&|node| vec![(1.0, Action::Force(node))]),
                Quantity::Slope => at_sections(&|node| vec![(1.0, Action::Couple(node))]),
                Quantity::Moment => at_sections(&|node| of_moment(flexibility, node, actual)),
                Quantity::ShearLeft => at_sections(&|node| of_shear(flexibility, node, actual)[0].clone()),
                Quantity::ShearRight => at_sections(&|node| of_shear(flexibility, node, actual)[1].clone()),
                Quantity::Reaction => of_restraints(&vertical),
                Quantity::ClampMoment => of_restraints(&clamps),
                // Motion is that of the modes alone.
                Quantity::Velocity | Quantity::Acceleration => at_sections(&|_| Actions::new()),
            }
        };
        let (mut ranges, mut all) = (Vec::with_capacity(quantities.len()), Vec::new());
        for &quantity in quantities {
            let first = all.len();
            all.extend(of(quantity));
            ranges.push((quantity, first..all.len()));
        }
        let mut lines = Vec::with_capacity(all.len());
        for some in all.chunks(TOGETHER) {
            lines.extend(flexibility.each_deflected(some, actual));
            stop.check()?;
        }
        Ok(Responses { sections, ranges, held, lines })
    }

    /// From their influence lines: deflections, moments, shears on the left and on the right of every section (nodes),
    /// then so many reactions, then clamp moments; `held` are the nodes at which deflection is held.
    pub fn from_lines(sections: Vec<usize>, reactions: usize, held: Vec<usize>, lines: Vec<Line>) -> Self {
        let (n, mut first) = (sections.len(), 0);
        let ranges = Quantity::USUAL.map(|quantity| {
            let count = match quantity.at() {
                At::Sections => n,
                At::Supports => reactions,
                At::Clamps => lines.len() - first,
            };
            first += count;
            (quantity, first - count..first)
        });
        Responses { sections, ranges: ranges.to_vec(), held, lines }
    }

    /// Only some of the kinds; what is not there and looked at at sections has no lines, as motion has none.
    pub fn of_quantities(&self, quantities: &[Quantity], mesh: &Mesh) -> Self {
        let (mut ranges, mut lines) = (Vec::with_capacity(quantities.len()), Vec::new());
        for &quantity in quantities {
            let first = lines.len();
            match self.range(quantity) {
                own if !own.is_empty() || quantity.at() != At::Sections => lines.extend_from_slice(&self.lines[own]),
                _ => lines.resize(first + self.sections.len(), Line::straight(mesh, 0.0, 0.0)),
            }
            ranges.push((quantity, first..lines.len()));
        }
        Responses { ranges, lines, ..self.clone() }
    }

    /// The same of some of the sections only, by their numbers.
    pub fn of_sections(&self, chosen: &[usize]) -> Self {
        let mut end = 0;
        let ranges = self.ranges.iter().map(|(quantity, range)| {
            let first = end;
            end += if quantity.at() == At::Sections { chosen.len() } else { range.len() };
            (*quantity, first..end)
        });
        Responses {
            ranges: ranges.collect(),
            sections: chosen.iter().map(|&s| self.sections[s]).collect(),
            lines: self.numbers_at(chosen).map(|r| self.lines[r].clone()).collect(),
            held: self.held.clone(),
        }
    }

    /// Numbers of the responses at some of the sections, and of all that are not at sections.
    pub fn numbers_at(&self, chosen: &[usize]) -> impl Iterator<Item = usize> {
        self.ranges.iter().flat_map(move |(quantity, range)| -> Vec<usize> {
            match quantity.at() {
                At::Sections => chosen.iter().map(|section| range.start + section).collect(),
                _ => range.clone().collect(),
            }
        })
    }

    /// The kind of a response, and its number among those of its kind.
    pub fn quantity_of(&self, response: usize) -> (Quantity, usize) {
        let own = self.ranges.iter().find(|(_, range)| range.contains(&response));
        own.map_or((Quantity::Deflection, response), |(quantity, range)| (*quantity, response - range.start))
    }

    /// The kinds.
    pub fn quantities(&self) -> impl Iterator<Item = Quantity> {
        self.ranges.iter().map(|range| range.0)
    }

    /// Nodes of the sections.
    pub fn sections(&self) -> &[usize] {
        &self.sections
    }

    /// Number of responses.
    pub fn len(&self) -> usize {
        self.lines.len()
    }

    /// Whether nothing is looked at (never so: a bridge has a support).
    pub fn is_empty(&self) -> bool {
        self.lines.is_empty()
    }

    /// Indices of the responses of one kind, in the order of sections or of restraints; of one that is not looked at none.
    pub fn range(&self, quantity: Quantity) -> Range<usize> {
        self.ranges.iter().find(|range| range.0 == quantity).map_or(0..0, |range| range.1.clone())
    }

    /// Whether a support holds the deflection at a node; one on a spring does not.
    pub fn supported(&self, node: usize) -> bool {
        self.held.contains(&node)
    }

    /// The influence lines.
    pub fn lines(&self) -> &[Line] {
        &self.lines
    }

    /// Value of influence line `response` for a load that stays at a mass station.
    ///
    /// A mass at a section stands between its left and its right side: for the shear on the left it is to the right.
    pub fn at_station(&self, response: usize, node: usize) -> f64 {
        let line = &self.lines[response];
        let own_section =
            |range: Range<usize>| range.contains(&response) && self.sections[response - range.start] == node;
        // Across its own section a shear's line rises by one, at the ends too, where there is no panel on one side.
        if own_section(self.range(Quantity::ShearLeft)) {
            if node == line.cubics().len() { line.before(node) + 1.0 } else { line.after(node) }
        } else if own_section(self.range(Quantity::ShearRight)) {
            if node == 0 { line.after(node) - 1.0 } else { line.before(node) }
        } else {
            line.at_node(node)
        }
    }
}
