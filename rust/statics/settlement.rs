//! What settling supports do to the bridge: deflection, moment, shear and reactions, at rest.

use crate::bridge::Bridge;
use crate::bridge::cubics::Line;
use crate::error::{Error, finite};
use crate::statics::flexibility::{Action, Flexibility, Restraint, Structure};

/// The state of the bridge after its supports have settled.
#[derive(Debug, Clone, PartialEq)]
pub struct Settled {
    /// Deflections at the sections, down [m].
    pub deflection: Vec<f64>,
    /// Bending moments at the sections, sagging; just left of a support that holds the rotation [N m].
    pub moment: Vec<f64>,
    /// Shears just left and just right of the sections [N].
    pub shear: Vec<[f64; 2]>,
    /// Reactions of the supports, up [N].
    pub reactions: Vec<f64>,
    /// Moments of the supports that hold the rotation, signed as in [`crate::statics::influence::reaction`] [N m].
    pub clamp_moments: Vec<f64>,
}

impl Settled {
    /// The ground under each support, left to right, settles by so much, down [m]; looked at in `sections` [m].
    pub fn new(bridge: &Bridge, settlements: &[f64], sections: &[f64]) -> Result<Self, Error> {
        let supports = bridge.supports();
        if settlements.len() != supports.len() {
            let allowed = format!("give one for each of the {} supports", supports.len());
            return Err(Error::input("settlements", format!("{} values", settlements.len()), allowed));
        }
        let flexibility = Flexibility::new(bridge, sections)?;
        let mesh = flexibility.mesh();
        let end = mesh.panels();
        let mut line = Line::straight(mesh, 0.0, 0.0);
        for (i, (support, &settlement)) in supports.iter().zip(settlements).enumerate() {
            finite(format!("settlements[{i}]"), settlement)?;
            if settlement != 0.0 {
                let restraint = Restraint::Deflection(mesh.node_at(support.at));
                line.add_scaled(settlement, &flexibility.deflected(Action::Settlement(restraint), Structure::Actual));
            }
        }
        let shear = |node: usize| {
            let left = if node == 0 { 0.0 } else { flexibility.shear_in(&line, node - 1) };
            [left, if node == end { 0.0 } else { flexibility.shear_in(&line, node) }]
        };
        let moments = |node: usize| {
            let left = if node == 0 { 0.0 } else { flexibility.moment_in(&line, node - 1, 1.0) };
            [left, if node == end { 0.0 } else { flexibility.moment_in(&line, node, 0.0) }]
        };
        let nodes: Vec<usize> = sections.iter().map(|&x| mesh.node_at(x)).collect();
        let of_supports: Vec<usize> = supports.iter().map(|s| mesh.node_at(s.at)).collect();
        let turned = supports.iter().zip(&of_supports).filter(|(s, _)| s.fixity.rotation() > 0.0);
        Ok(Settled {
            deflection: nodes.iter().map(|&node| line.at_node(node)).collect(),
            moment: nodes
                .iter()
                .map(|&node| match flexibility.hinges().contains(&node) {
                    true => 0.0,
                    false => flexibility.bending_moment(&line, node),
                })
                .collect(),
            shear: nodes.iter().map(|&node| shear(node)).collect(),
            reactions: of_supports.iter().map(|&node| shear(node)[1] - shear(node)[0]).collect(),
            clamp_moments: turned
                .map(|(_, &node)| {
                    let [left, right] = moments(node);
                    if node == end { left } else { right - left }
                })
                .collect(),
        })
    }
}
