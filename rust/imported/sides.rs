//! Modes and influence lines of an imported bridge as cubics, from values and slopes on both sides of its nodes.

use crate::bridge::cubics::{Line, Mesh};
use crate::spline::between;

/// Values and slopes of a line just left and just right of every node.
#[derive(Debug, Clone, PartialEq)]
pub struct Sides {
    /// Left, then right.
    pub values: [Vec<f64>; 2],
    /// Left, then right.
    pub slopes: [Vec<f64>; 2],
}

impl Sides {
    /// Of a line without jump or kink.
    pub fn smooth(values: Vec<f64>, slopes: Vec<f64>) -> Self {
        Sides { values: [values.clone(), values], slopes: [slopes.clone(), slopes] }
    }

    /// The cubics that have them.
    pub fn line(&self, mesh: &Mesh) -> Line {
        let cubic = |panel: usize| {
            let h = mesh.width(panel);
            let values = [self.values[1][panel], self.values[0][panel + 1]];
            between(values, [h * self.slopes[1][panel], h * self.slopes[0][panel + 1]])
        };
        Line::from_cubics((0..mesh.panels()).map(cubic).collect())
    }
}
