//! Which responses are looked at, equal rows once, and the sections and ends where a passing axle can make an extreme.

use crate::recovery::{Place, Rows};
use crate::statics::influence::Responses;
use crate::statics::quantity::{At, Quantity};

/// A row that is evaluated.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// The response, among all.
    pub response: usize,
    /// What multiplies the modal coordinates.
    pub factors: Vec<f64>,
}

/// A section or an end of the bridge, where extremes are looked for as an axle passes.
#[derive(Debug, Clone)]
pub struct Mark {
    /// Position [m].
    pub x: f64,
    /// Where an axle stands on it as it comes from the left, and from the right.
    pub sides: [Place; 2],
    /// Whether nothing jumps as an axle passes: everywhere but on the free ends, whose tip the wheel drops on or off.
    pub held: bool,
    /// Which list of rows in [`Selection::asked`].
    pub asked: usize,
    /// The row of the shear just inside an end of the bridge, and the sign with which an axle on that end adds to it.
    pub tip: Option<(usize, f64)>,
}

/// The responses looked at.
#[derive(Debug, Clone)]
pub struct Selection {
    /// Chosen responses, in the order of the results.
    pub chosen: Vec<usize>,
    /// The distinct rows among them.
    pub rows: Vec<Row>,
    /// What multiplies the modal coordinates in all of them, one after the other.
    pub factors: Vec<f64>,
    /// The row of each chosen response.
    pub row_of: Vec<usize>,
    /// The first of the chosen responses that each row stands for.
    pub first_of_row: Vec<usize>,
    /// The kind of each chosen response.
    pub quantities: Vec<Quantity>,
    /// By response, the row that stands for it, if it is looked at.
    row_for: Vec<Option<usize>>,
    /// Where extremes are looked for as an axle passes, from left to right.
    pub marks: Vec<Mark>,
    /// Rows to look at there: deflection, moment and shears of each section, and last, for the ends, all.
    pub asked: Vec<Vec<usize>>,
}

impl Selection {
    /// At all responses of some quantities.
    pub fn new(rows: &Rows, responses: &Responses, quantities: &[Quantity]) -> Self {
        let ends = [0, rows.mesh().panels()];
        let sections = responses.sections().len();
        let mut look = Selection {
            chosen: Vec::new(),
            rows: Vec::new(),
            factors: Vec::new(),
            row_of: Vec::new(),
            first_of_row: Vec::new(),
            quantities: Vec::new(),
            row_for: vec![None; responses.len()],
            marks: Vec::new(),
            asked: Vec::new(),
        };
        // By response, so that many sections are no more work each than few.
        let mut own_row: Vec<Option<usize>> = vec![None; responses.len()];
        for &quantity in quantities {
            for (section, response) in responses.range(quantity).enumerate() {
                // But at stations, supports and ends, the shears left and right of a section differ only while an axle
                // stands on it, which is not a matter of their rows. An axle on a free end, whose rows are nothing, adds
                // to the one inside.
                let shear = quantity == Quantity::ShearRight && !ends.contains(&responses.sections()[section]);
                let twin = shear
                    .then(|| own_row[response - sections])
                    .flatten()
                    .filter(|&twin| rows.same(look.rows[twin].response, response));
                let row = twin.unwrap_or(look.rows.len());
                look.row_of.push(row);
                look.row_for[response] = Some(row);
                if twin.is_none() {
                    look.first_of_row.push(look.chosen.len());
                    own_row[response] = Some(row);
                    let factors: Vec<f64> = (0..rows.width()).map(|i| rows.factor(response, i)).collect();
                    look.factors.extend_from_slice(&factors);
                    look.rows.push(Row { response, factors });
                }
                look.chosen.push(response);
                look.quantities.push(quantity);
            }
        }
        look.find_marks(rows, responses);
        look
    }

    /// Of twice the number of a row, and one more of its smallest: the same by the first of the chosen responses that the
    /// row stands for.
    pub fn side(&self, of_row: f64) -> f64 {
        let place = self.first_of_row.get(of_row as usize / 2).copied().unwrap_or_default();
        (2 * place) as f64 + of_row % 2.0
    }

    /// Every section and both ends.
    fn find_marks(&mut self, rows: &Rows, responses: &Responses) {
        let (nodes, last) = (rows.mesh().nodes(), rows.mesh().panels());
        let sections = responses.sections();
        let count = sections.len();
        // Of a section deflection, moment and both shears: what else is looked at must not matter. On an end all.
        let own = |section: usize| {
            let of_section = responses.quantities().filter(|quantity| quantity.at() == At::Sections);
            let responses = of_section.map(|quantity| responses.range(quantity).start + section);
            let mut rows: Vec<usize> = responses.filter_map(|response| self.row(response)).collect();
            rows.dedup();
            rows
        };
        self.asked = (0..count).map(own).collect();
        self.asked.push((0..self.rows.len()).collect());
        let inner = sections.iter().enumerate().filter(|&(_, &node)| node != 0 && node != last);
        let mut places: Vec<(usize, usize)> = inner.map(|(section, &node)| (node, section)).collect();
        places.extend([(0, count), (last, count)]);
        places.sort_unstable();
        let shear = |node: usize| {
            let (quantity, sign) = match node {
                0 => (Quantity::ShearRight, -1.0),
                _ => (Quantity::ShearLeft, 1.0),
            };
            let section = sections.iter().position(|&s| s == node)?;
            let response = responses.range(quantity).nth(section)?;
            Some((self.row(response)?, sign))
        };
        let marks = places.into_iter().map(|(node, asked)| {
            let (left, right) = (node.checked_sub(1).map(|panel| (panel, 1.0)), (node < last).then_some((node, 0.0)));
            let end = node == 0 || node == last;
            Mark {
                x: nodes[node],
                sides: [left, right],
                held: !end || responses.supported(node),
                asked,
                tip: if end { shear(node) } else { None },
            }
        });
        self.marks = marks.collect();
    }

    /// The row that stands for a response, if it is looked at.
    pub fn row(&self, response: usize) -> Option<usize> {
        self.row_for[response]
    }
}
