//! A bridge modelled in another program, given by its modes and influence lines along the path of the wheels.

use faer::Mat;

use super::{Given, Motion, checked_matrix, checked_positions};
use crate::bridge::cubics::{COINCIDENT, Line, Mesh, check_lines};
use crate::bridge::support::{Support, checked_supports_of_given};
use crate::error::{Error, not_negative, positive};
use crate::imported::sides::Sides;
use crate::modes::Modes;
use crate::spline::{End, spline_slopes};
use crate::statics::influence::Responses;
use crate::statics::quantity::Quantity;

/// Given masses and shapes agree if ΦᵀMΦ is the unit matrix to this.
const NORMALISED: f64 = 1e-3;

/// A shape that is less than this fraction of its largest value at an end of the path is held there.
const HELD: f64 = 1e-9;

/// Numbers just right of the points of the path and, where these differ, just left of them.
#[derive(Debug, Clone, PartialEq)]
pub struct TwoSided {
    /// Just right; at the last point just left.
    pub right: Mat<f64>,
    /// Just left.
    pub left: Option<Mat<f64>>,
}

/// Influence lines of one kind of response: a row for each section, support or clamp, a column for each point.
#[derive(Debug, Clone, PartialEq)]
pub struct GivenLines {
    /// The kind.
    pub quantity: Quantity,
    /// Response to a unit load at the points of the path.
    pub values: TwoSided,
    /// Its derivative along the path, if known.
    pub slopes: Option<TwoSided>,
    /// Response of each mode shape, if known: a row for each response, a column for each mode.
    pub modal: Option<Mat<f64>>,
}

/// The modes of a bridge along the path of the wheels, and what is wanted of it.
#[derive(Debug, Clone, PartialEq)]
pub struct ByModes {
    /// Points of the path, left to right, from 0 to the length [m].
    pub path: Vec<f64>,
    /// Natural frequencies, ascending [Hz].
    pub frequencies: Vec<f64>,
    /// Mode shapes of unit modal mass: a row for each point, a column for each mode [kg^-½].
    pub shapes: TwoSided,
    /// Their derivatives along the path, if known.
    pub slopes: Option<TwoSided>,
    /// Where deflection, moment and shear are looked at, points of the path [m].
    pub sections: Vec<f64>,
    /// Supports whose reactions are looked at.
    pub supports: Vec<Support>,
    /// Influence lines of the responses wanted.
    pub influence: Vec<GivenLines>,
    /// Masses at the points of the path [kg], if known.
    pub masses: Option<Vec<f64>>,
}

impl Given {
    /// Of a bridge given by its modes.
    pub fn by_modes(data: &ByModes) -> Result<Self, Error> {
        let count = data.path.len();
        if count < 2 {
            return Err(Error::input(
                "path",
                format!("{count} points"),
                "give two points or more, from 0 to the length",
            ));
        }
        let length = positive(format!("path[{}]", count - 1), data.path[count - 1])?;
        checked_positions("path", &data.path, length)?;
        if data.path[0] != 0.0 {
            return Err(Error::input("path[0]", format!("{} m", data.path[0]), "the path must begin at 0"));
        }
        let mesh = Mesh::new(length, data.path.iter().copied());
        let modes = data.frequencies.len();
        if modes == 0 {
            return Err(Error::input("frequencies", "[]", "give one frequency in hertz or more"));
        }
        for (i, &f) in data.frequencies.iter().enumerate() {
            positive(format!("frequencies[{i}]"), f)?;
            if i > 0 && f < data.frequencies[i - 1] {
                let allowed = format!("must not be less than the one before it, {} Hz", data.frequencies[i - 1]);
                return Err(Error::input(format!("frequencies[{i}]"), format!("{f} Hz"), allowed));
            }
        }
        let supports = checked_supports_of_given(length, data.supports.clone())?;
        let shapes =
            sides_checked("shapes", &data.shapes, (count, modes), "a row for each point, a column for each mode")?;
        let slopes = (data.slopes.as_ref())
            .map(|s| sides_checked("slopes", s, (count, modes), "as many as there are shapes"))
            .transpose()?;
        if slopes.is_none() && data.shapes.left.is_some() {
            return Err(two_sided_without_slopes("shapes"));
        }
        let level = built_in(&supports, length);
        let x = mesh.nodes();
        let lines: Vec<Line> = (0..modes)
            .map(|m| {
                let values = [0, 1].map(|side: usize| column(&shapes[side], m));
                let sides = match &slopes {
                    Some(slopes) => Sides { values, slopes: [0, 1].map(|side: usize| column(&slopes[side], m)) },
                    None => {
                        let slopes = spline_slopes(x, &values[1], level);
                        Sides::smooth(values[1].clone(), slopes)
                    }
                };
                sides.line(&mesh)
            })
            .collect();
        let largest = (0..modes).flat_map(|m| column(&shapes[1], m)).fold(0.0_f64, |m, v| m.max(v.abs()));
        if largest == 0.0 {
            return Err(Error::input("shapes", 0, "must not be zero everywhere"));
        }
        let still = |node: usize| lines.iter().all(|line| line.at_node(node).abs() <= HELD * largest);
        let held = [0, mesh.panels()].into_iter().filter(|&node| still(node)).collect();

        let masses = masses(data, &mesh, &shapes[1])?;
        let near = COINCIDENT * length;
        let mut sections: Vec<usize> = Vec::with_capacity(data.sections.len());
        checked_positions("sections", &data.sections, length)?;
        for (i, &at) in data.sections.iter().enumerate() {
            let node = mesh.node_at(at);
            if (x[node] - at).abs() > near {
                let allowed = "must be a point of the path";
                return Err(Error::input(format!("sections[{i}]"), format!("{at} m"), allowed));
            }
            sections.push(node);
        }

        let responses = 4 * sections.len() + 2 * supports.len();
        check_lines("path", count, (modes + responses) as f64, count, "lines of so many points")?;
        let clamps: Vec<usize> =
            supports.iter().filter(|s| s.fixity.rotation() > 0.0).map(|s| mesh.node_at(s.at)).collect();
        let mut all: Vec<Line> = Vec::new();
        let mut missing = Vec::new();
        for quantity in Quantity::USUAL {
            let rows = match quantity {
                Quantity::Reaction => supports.iter().map(|s| mesh.node_at(s.at)).collect(),
                Quantity::ClampMoment => clamps.clone(),
                _ => sections.clone(),
            };
            match data.influence.iter().find(|g| g.quantity == quantity) {
                Some(given) => all.extend(influence_lines(given, &rows, &mesh, level)?),
                // Without a clamp there is no moment of one to be missing.
                None if quantity == Quantity::ClampMoment && rows.is_empty() => {}
                None => {
                    missing.push(quantity);
                    all.extend(vec![Line::straight(&mesh, 0.0, 0.0); rows.len()]);
                }
            }
        }
        if missing.contains(&Quantity::ShearLeft) != missing.contains(&Quantity::ShearRight) {
            return Err(Error::input("influence", "shear on one side only", "give both shear-left and shear-right"));
        }
        if data.influence.is_empty() {
            let allowed = "give the influence lines of one response or more: deflection, moment, shear-left and \
                           shear-right, reaction, clamp-moment";
            return Err(Error::input("influence", "{}", allowed));
        }
        let responses = Responses::from_lines(sections, supports.len(), held, all);
        let omega: Vec<f64> = data.frequencies.iter().map(|f| std::f64::consts::TAU * f).collect();
        let rho = modal_responses(data, &responses, &lines, &masses, &shapes[1], &omega, &mesh, &missing)?;
        let at_masses = Mat::from_fn(masses.len(), modes, |j, m| shapes[1][(masses[j].0, m)]);
        let motion = Motion::Modes { modes: Modes { omega, shapes: at_masses }, lines, rho };
        missing.push(Quantity::Slope);
        Ok(Given { mesh, supports, masses, motion, responses, missing })
    }
}

fn column(m: &Mat<f64>, j: usize) -> Vec<f64> {
    m.col(j).iter().copied().collect()
}

fn row(m: &Mat<f64>, i: usize) -> Vec<f64> {
    m.row(i).iter().copied().collect()
}

/// Left and right, checked.
fn sides_checked(key: &str, given: &TwoSided, shape: (usize, usize), what: &str) -> Result<[Mat<f64>; 2], Error> {
    checked_matrix(key, &given.right, shape, what)?;
    let left = given.left.as_ref().unwrap_or(&given.right);
    checked_matrix(key, left, shape, what)?;
    Ok([left.clone(), given.right.clone()])
}

fn two_sided_without_slopes(key: &str) -> Error {
    let allowed = "a spline cannot pass a jump: give slopes as well, or values on the right only";
    Error::input(key, "values on both sides", allowed)
}

/// How splines of deflected shapes end.
fn built_in(supports: &[Support], length: f64) -> [End; 2] {
    [0.0, length].map(|end| {
        let level = supports.iter().any(|s| s.at == end && s.fixity.rotation().is_infinite());
        if level { End::Slope(0.0) } else { End::Natural }
    })
}

/// Masses off the held points, if given, checked against the shapes.
fn masses(data: &ByModes, mesh: &Mesh, shapes: &Mat<f64>) -> Result<Vec<(usize, f64)>, Error> {
    let Some(given) = &data.masses else { return Ok(Vec::new()) };
    let count = mesh.nodes().len();
    if given.len() != count {
        let allowed = format!("give one for each of the {count} points of the path");
        return Err(Error::input("masses", format!("{} values", given.len()), allowed));
    }
    for (i, &mass) in given.iter().enumerate() {
        not_negative(format!("masses[{i}]"), mass)?;
    }
    for i in 0..shapes.ncols() {
        for j in 0..=i {
            let product: f64 = (0..count).map(|k| given[k] * shapes[(k, i)] * shapes[(k, j)]).sum();
            if (product - f64::from(i == j)).abs() > NORMALISED {
                let value = format!("{product:.6} for modes {} and {}", j + 1, i + 1);
                let allowed = "shapes must be scaled to unit modal mass with these masses: 1 for each mode with itself, \
                               0 for two";
                return Err(Error::input("shapes^T masses shapes", value, allowed));
            }
        }
    }
    Ok((0..count).filter(|&k| given[k] > 0.0).map(|k| (k, given[k])).collect())
}

/// The influence lines of one kind, for sections or supports at these nodes.
fn influence_lines(given: &GivenLines, nodes: &[usize], mesh: &Mesh, level: [End; 2]) -> Result<Vec<Line>, Error> {
    let name = given.quantity.name();
    let x = mesh.nodes();
    let end = mesh.panels();
    let shape = (nodes.len(), x.len());
    let what = "a row for each section or support, a column for each point of the path";
    let [left, right] = sides_checked(&format!("influence {name}"), &given.values, shape, what)?;
    let slopes = match &given.slopes {
        Some(slopes) => Some((sides_checked(&format!("influence slopes {name}"), slopes, shape, what)?, slopes)),
        None if given.values.left.is_some() => return Err(two_sided_without_slopes(&format!("influence {name}"))),
        None => None,
    };
    let shear = matches!(given.quantity, Quantity::ShearLeft | Quantity::ShearRight);
    let lines = nodes.iter().enumerate().map(|(r, &own)| {
        let inside = own > 0 && own < end;
        let mut values = [row(&left, r), row(&right, r)];
        // Across its own section the line of a shear rises by one, that of a moment has a slope that falls by one.
        let (jump, kink) = (shear && inside, given.quantity == Quantity::Moment && inside);
        let sides = match &slopes {
            Some(([left, right], given_slopes)) => {
                let mut slopes = [row(left, r), row(right, r)];
                if jump && given.values.left.is_none() {
                    values[0][own] -= 1.0;
                }
                if kink && given_slopes.left.is_none() {
                    slopes[0][own] += 1.0;
                }
                Sides { values, slopes }
            }
            None => {
                // What is left without the jump or the kink is smooth.
                let values = &values[1];
                let beyond = |i: usize| i >= own;
                let smooth: Vec<f64> = (values.iter().enumerate())
                    .map(|(i, v)| match beyond(i) {
                        true if jump => v - 1.0,
                        true if kink => v + (x[i] - x[own]),
                        _ => *v,
                    })
                    .collect();
                // A clamp turns by one for the line of its own moment.
                let turned = match given.quantity {
                    Quantity::ClampMoment | Quantity::Moment if own == 0 => [Some(-1.0), None],
                    Quantity::ClampMoment | Quantity::Moment if own == end => [None, Some(1.0)],
                    _ => [None, None],
                };
                let ends = [0, 1].map(|side: usize| match (level[side], turned[side]) {
                    (End::Slope(_), Some(slope)) => End::Slope(slope),
                    (usual, _) => usual,
                });
                let mut sides = Sides::smooth(smooth.clone(), spline_slopes(x, &smooth, ends));
                for i in own..x.len() {
                    for (side, here) in [(0, i > own), (1, true)] {
                        if jump && here {
                            sides.values[side][i] += 1.0;
                        }
                        if kink && here {
                            sides.slopes[side][i] -= 1.0;
                        }
                    }
                    if kink {
                        (0..2).for_each(|side| sides.values[side][i] -= x[i] - x[own]);
                    }
                }
                sides
            }
        };
        sides.line(mesh)
    });
    Ok(lines.collect())
}

/// Responses of the mode shapes: as given, or from the masses, or for deflections the shapes themselves.
#[allow(clippy::too_many_arguments)] // called once
fn modal_responses(
    data: &ByModes,
    responses: &Responses,
    lines: &[Line],
    masses: &[(usize, f64)],
    shapes: &Mat<f64>,
    omega: &[f64],
    mesh: &Mesh,
    missing: &[Quantity],
) -> Result<Mat<f64>, Error> {
    let mut rho = Mat::<f64>::zeros(responses.len(), omega.len());
    for quantity in Quantity::USUAL.into_iter().filter(|q| !missing.contains(q)) {
        let range = responses.range(quantity);
        let modal = data.influence.iter().find(|g| g.quantity == quantity).and_then(|g| g.modal.as_ref());
        if let Some(modal) = modal {
            let what = "a row for each section or support, a column for each mode";
            checked_matrix(&format!("modal {}", quantity.name()), modal, (range.len(), omega.len()), what)?;
        }
        for r in range.clone() {
            for m in 0..omega.len() {
                rho[(r, m)] = match modal {
                    Some(modal) => modal[(r - range.start, m)],
                    None if quantity == Quantity::Deflection => {
                        lines[m].at(mesh, mesh.nodes()[responses.sections()[r - range.start]])
                    }
                    None if !masses.is_empty() => {
                        let forces = masses.iter().map(|&(node, mass)| {
                            responses.at_station(r, node) * mass * shapes[(node, m)] * omega[m].powi(2)
                        });
                        forces.sum()
                    }
                    None => {
                        let name = quantity.name();
                        let allowed = "give the response of each mode, or the masses along the path";
                        return Err(Error::input(format!("modal {name}"), "nothing", allowed));
                    }
                };
            }
        }
    }
    Ok(rho)
}
