//! Which responses a study looks at, each distinct row once.

use crate::influence::{Quantity, Responses};
use crate::recovery::Rows;

/// A row that is evaluated.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// The response, among all.
    pub response: usize,
    /// What multiplies the modal coordinates.
    pub factors: Vec<f64>,
    /// 1 where such a factor is negative, else 0.
    pub turned: Vec<usize>,
}

/// The responses of a study.
#[derive(Debug, Clone)]
pub struct Look {
    /// Chosen responses, in the order of the results.
    pub chosen: Vec<usize>,
    /// The distinct rows among them.
    pub rows: Vec<Row>,
    /// The row of each chosen response.
    pub row_of: Vec<usize>,
    /// Whether each chosen response is a deflection.
    pub deflections: Vec<bool>,
}

impl Look {
    /// At all responses of some quantities.
    pub fn new(rows: &Rows, responses: &Responses, quantities: &[Quantity]) -> Self {
        let deflections = responses.range(Quantity::Deflection);
        let ends = [0, rows.mesh().panels()];
        let sections = responses.sections().len();
        let mut look = Look { chosen: Vec::new(), rows: Vec::new(), row_of: Vec::new(), deflections: Vec::new() };
        for &quantity in quantities {
            for (section, response) in responses.range(quantity).enumerate() {
                // But at stations, supports and ends, the shears left and right of a section differ only while an axle
                // stands on it, which is not a matter of their rows. An axle on a free end, whose rows are nothing, adds
                // to the one inside.
                let shear = quantity == Quantity::ShearRight && !ends.contains(&responses.sections()[section]);
                let twin = shear
                    .then(|| look.rows.iter().position(|row| row.response == response - sections))
                    .flatten()
                    .filter(|&twin| rows.same(look.rows[twin].response, response));
                look.row_of.push(twin.unwrap_or(look.rows.len()));
                if twin.is_none() {
                    let factors: Vec<f64> = (0..rows.width()).map(|i| rows.factor(response, i)).collect();
                    let turned = factors.iter().map(|&factor| usize::from(factor < 0.0)).collect();
                    look.rows.push(Row { response, factors, turned });
                }
                look.chosen.push(response);
                look.deflections.push(deflections.contains(&response));
            }
        }
        look
    }

    /// The first of the chosen responses that a row stands for.
    pub fn place(&self, row: usize) -> usize {
        self.row_of.iter().position(|&r| r == row).unwrap_or(0)
    }

    /// The row that stands for a response, if it is looked at.
    pub fn row(&self, response: usize) -> Option<usize> {
        self.chosen.iter().position(|&r| r == response).map(|place| self.row_of[place])
    }
}
