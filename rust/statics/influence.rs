//! Influence lines: each response of the bridge, at any section, to a unit load anywhere on it.
//!
//! By reciprocity the influence line of a response is a deflected shape of the same bridge: under a unit force for a
//! deflection, a unit kink for a moment, a unit jump for a shear, a unit settlement for a reaction. All are exact.

use crate::bridge::Bridge;
use crate::bridge::cubics::Line;
use crate::error::Error;
use crate::statics::flexibility::{Action, Actions, Flexibility, Restraint, Structure, TOGETHER};
use crate::stop_token::StopToken;

/// A kind of response. Signs: deflection down, sagging moment, shear as the sum of upward forces to the left, reactions
/// up and clamp moments sagging, all positive.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Quantity {
    /// Deflection at the sections [m].
    Deflection,
    /// Bending moment at the sections [N m].
    Moment,
    /// Shear just left of the sections [N].
    ShearLeft,
    /// Shear just right of the sections [N].
    ShearRight,
    /// Vertical reactions of the supports, on the bridge [N].
    Reaction,
    /// Moments of the supports that hold the rotation, on the bridge [N m]: at an end sagging, elsewhere the rise of the
    /// bending moment across the support.
    ClampMoment,
}

impl Quantity {
    /// All kinds, in the order in which responses are laid out.
    pub const ALL: [Quantity; 6] = [
        Quantity::Deflection,
        Quantity::Moment,
        Quantity::ShearLeft,
        Quantity::ShearRight,
        Quantity::Reaction,
        Quantity::ClampMoment,
    ];

    /// Those that each section has, and the first in that order.
    pub const OF_SECTIONS: [Quantity; 4] =
        [Quantity::Deflection, Quantity::Moment, Quantity::ShearLeft, Quantity::ShearRight];

    /// What it is called in messages and among the arguments of a bridge given by its modes.
    pub fn name(self) -> &'static str {
        match self {
            Quantity::Deflection => "deflection",
            Quantity::Moment => "moment",
            Quantity::ShearLeft => "shear-left",
            Quantity::ShearRight => "shear-right",
            Quantity::Reaction => "reaction",
            Quantity::ClampMoment => "clamp-moment",
        }
    }
}

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

/// Every response looked at: deflection, moment and both shears at the sections, reactions, clamp moments.
#[derive(Debug, Clone)]
pub struct Responses {
    sections: Vec<usize>,
    /// Number of reactions; the clamp moments come after them.
    reactions: usize,
    /// Nodes at which deflection is held.
    held: Vec<usize>,
    lines: Vec<Line>,
}

impl Responses {
    /// At `sections` [m], which must be nodes of the flexibility's mesh; `stop` is asked now and then whether to.
    pub fn new(
        flexibility: &Flexibility,
        bridge: &Bridge,
        sections: &[f64],
        stop: StopToken<'_>,
    ) -> Result<Self, Error> {
        let mesh = flexibility.mesh();
        let sections: Vec<usize> = sections.iter().map(|&x| mesh.node_at(x)).collect();
        let rigid = bridge.supports().iter().filter(|s| s.fixity.vertical().is_infinite());
        let held = rigid.map(|s| mesh.node_at(s.at)).collect();
        let actual = Structure::Actual;
        let (clamps, vertical): (Vec<Restraint>, Vec<Restraint>) =
            flexibility.restraints(actual).into_iter().partition(|r| matches!(r, Restraint::Slope(_)));

        let deflections = sections.iter().map(|&node| vec![(1.0, Action::Force(node))]);
        let moments = sections.iter().map(|&node| of_moment(flexibility, node, actual));
        let shears: Vec<[Actions; 2]> = sections.iter().map(|&node| of_shear(flexibility, node, actual)).collect();
        let side = |side: usize| shears.iter().map(move |both| both[side].clone());
        let reactions = vertical.iter().chain(&clamps).map(|&r| vec![of_reaction(flexibility, r)]);
        let all: Vec<Actions> = deflections.chain(moments).chain(side(0)).chain(side(1)).chain(reactions).collect();
        let mut lines = Vec::with_capacity(all.len());
        for some in all.chunks(TOGETHER) {
            lines.extend(flexibility.each_deflected(some, actual));
            stop.check()?;
        }
        Ok(Responses { sections, reactions: vertical.len(), held, lines })
    }

    /// From their influence lines: deflections, moments, shears on the left and on the right of every section (nodes),
    /// then so many reactions, then clamp moments; `held` are the nodes at which deflection is held.
    pub fn from_lines(sections: Vec<usize>, reactions: usize, held: Vec<usize>, lines: Vec<Line>) -> Self {
        Responses { sections, reactions, held, lines }
    }

    /// The same of some of the sections only, by their numbers.
    pub fn of_sections(&self, chosen: &[usize]) -> Self {
        Responses {
            sections: chosen.iter().map(|&s| self.sections[s]).collect(),
            lines: self.numbers_at(chosen).map(|r| self.lines[r].clone()).collect(),
            ..self.clone()
        }
    }

    /// Numbers of the responses at some of the sections, and of all that are not at sections.
    pub fn numbers_at(&self, chosen: &[usize]) -> impl Iterator<Item = usize> {
        let of_sections = Quantity::OF_SECTIONS.map(|quantity| self.range(quantity).start);
        let at = of_sections.into_iter().flat_map(move |first| chosen.iter().map(move |s| first + s));
        at.chain(self.range(Quantity::Reaction).start..self.len())
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

    /// Indices of the responses of one kind, in the order of sections or of restraints.
    pub fn range(&self, quantity: Quantity) -> std::ops::Range<usize> {
        let n = self.sections.len();
        let vertical = self.reactions;
        match quantity {
            Quantity::Deflection => 0..n,
            Quantity::Moment => n..2 * n,
            Quantity::ShearLeft => 2 * n..3 * n,
            Quantity::ShearRight => 3 * n..4 * n,
            Quantity::Reaction => 4 * n..4 * n + vertical,
            Quantity::ClampMoment => 4 * n + vertical..self.lines.len(),
        }
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
            |range: std::ops::Range<usize>| range.contains(&response) && self.sections[response - range.start] == node;
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
