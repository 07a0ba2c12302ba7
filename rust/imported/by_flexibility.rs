//! A bridge given as in KTN73 §2.3: F* at reference stations, masses, outer supports, redundant supports.

use faer::linalg::solvers::{Llt, Solve};
use faer::{Mat, Side};

use super::{Given, Motion, checked_length, checked_matrix, checked_positions};
use crate::bridge::cubics::{COINCIDENT, Line, Mesh, check_lines};
use crate::bridge::support::{Fixity, Support, checked_supports};
use crate::error::{Error, not_negative};
use crate::imported::sides::Sides;
use crate::spline::{End, spline_slopes};
use crate::statics::influence::Responses;
use crate::statics::quantity::Quantity;

/// F* may be unsymmetric by this fraction of its largest element: what a table of five digits rounds away.
const UNSYMMETRIC: f64 = 1e-4;

/// The flexibility of a basic bridge, and what makes it a bridge.
#[derive(Debug, Clone, PartialEq)]
pub struct ByFlexibility {
    /// Length [m].
    pub length: f64,
    /// Supports of the basic bridge, which must be statically determinate: two, or one that holds the rotation too.
    pub supports: Vec<Support>,
    /// Reference stations, left to right [m].
    pub stations: Vec<f64>,
    /// Masses at the stations [kg].
    pub masses: Vec<f64>,
    /// Redundant supports: the stations at which they stand [m], and their stiffness [N/m], infinite where rigid.
    pub redundants: Vec<(f64, f64)>,
    /// Where deflections are known, left to right, the stations among them [m].
    pub path: Vec<f64>,
    /// Deflections there for unit loads at the stations [m/N]: a row for each point of the path.
    pub flexibility: Mat<f64>,
    /// Their slopes along the beam [1/N], if known.
    pub slopes: Option<Mat<f64>>,
}

impl Given {
    /// Of a bridge given by its flexibility.
    ///
    /// With slopes the columns of F* are the Hermite cubics through the path; without them the natural splines through
    /// the path and the supports, level where the beam is built in at an end.
    pub fn by_flexibility(data: &ByFlexibility) -> Result<Self, Error> {
        let length = checked_length(data.length)?;
        let near = COINCIDENT * length;
        let outer = checked_supports(length, data.supports.clone())?;
        let statics = Statics::new(&outer)?;
        checked_positions("stations", &data.stations, length)?;
        checked_positions("path", &data.path, length)?;
        let n = data.stations.len();
        if data.masses.len() != n {
            let allowed = format!("give one mass for each of the {n} stations");
            return Err(Error::input("masses", format!("{} values", data.masses.len()), allowed));
        }
        for (i, &mass) in data.masses.iter().enumerate() {
            not_negative(format!("masses[{i}]"), mass)?;
        }
        let shape = (data.path.len(), n);
        checked_matrix(
            "flexibility",
            &data.flexibility,
            shape,
            "a row for each point of the path, a column for each station",
        )?;
        if let Some(slopes) = &data.slopes {
            checked_matrix("slopes", slopes, shape, "as many as the flexibility has")?;
        }
        let on_path = |x: f64| data.path.iter().position(|p| (p - x).abs() <= near);
        let rows = (data.stations.iter().enumerate())
            .map(|(i, &x)| {
                let allowed = "must be a point of the path";
                on_path(x).ok_or_else(|| Error::input(format!("stations[{i}]"), format!("{x} m"), allowed))
            })
            .collect::<Result<Vec<usize>, Error>>()?;
        check_symmetry(&data.flexibility, &rows)?;

        // Of every station in the basic bridge and in the actual one, of its moment and both shears, and some of them twice.
        check_lines("stations", n, (7 * n) as f64, data.path.len() + outer.len(), "lines of so many along the path")?;
        let mesh = Mesh::new(length, data.path.iter().copied().chain(outer.iter().map(|s| s.at)));
        let basic: Vec<Line> = (0..n).map(|j| column(data, &mesh, &outer, j)).collect::<Result<_, Error>>()?;
        let node = |station: usize| mesh.node_at(data.stations[station]);

        // Redundant supports: their stations, and the reactions up to a unit load along the path.
        let mut redundants: Vec<(usize, f64)> = Vec::new();
        for (i, &(at, stiffness)) in data.redundants.iter().enumerate() {
            let key = format!("redundants[{i}]");
            let Some(station) = data.stations.iter().position(|x| (x - at).abs() <= near) else {
                return Err(Error::input(key, format!("{at} m"), "must be one of the stations"));
            };
            if stiffness.is_nan() || stiffness <= 0.0 {
                let allowed = "must be greater than 0 [N/m], or inf where the deflection is held";
                return Err(Error::input(format!("{key} vertical"), stiffness, allowed));
            }
            if outer.iter().any(|s| (s.at - at).abs() <= near) || redundants.iter().any(|r| r.0 == station) {
                return Err(Error::input(key, format!("{at} m"), "two supports must not stand at the same position"));
            }
            redundants.push((station, 1.0 / stiffness));
        }
        redundants.sort_by_key(|r| r.0);
        let reactions = redundant_reactions(&mesh, &basic, &redundants, &node)?;
        // [KTN73] Eqs. 12–14: a response of the actual bridge is that of the basic one less what the redundants do.
        let actual = |line: &Line, at_redundant: &dyn Fn(usize) -> f64| {
            let mut line = line.clone();
            for (&(station, _), reaction) in redundants.iter().zip(&reactions) {
                line.add_scaled(-at_redundant(node(station)), reaction);
            }
            line
        };
        let columns: Vec<Line> = basic.iter().map(|line| actual(line, &|node| line.at_node(node))).collect();

        let rigid = |x: f64| {
            outer.iter().any(|s| (s.at - x).abs() <= near && s.fixity.vertical().is_infinite())
                || redundants.iter().any(|&(station, c)| c == 0.0 && (data.stations[station] - x).abs() <= near)
        };
        let moving: Vec<usize> = (0..n).filter(|&i| data.masses[i] > 0.0 && !rigid(data.stations[i])).collect();
        if moving.is_empty() {
            return Err(Error::input("masses", 0, "at least one station off the supports must carry mass"));
        }
        let masses: Vec<(usize, f64)> = moving.iter().map(|&i| (node(i), data.masses[i])).collect();
        let matrix = Mat::from_fn(moving.len(), moving.len(), |i, j| columns[moving[j]].at_node(masses[i].0));
        let of_masses = moving.iter().map(|&i| columns[i].clone()).collect();

        // Sections: the stations, and the rigid supports beside them.
        let mut sections: Vec<(usize, Line)> = (0..n).map(|i| (node(i), columns[i].clone())).collect();
        for support in outer.iter().filter(|s| s.fixity.vertical().is_infinite()) {
            let here = mesh.node_at(support.at);
            if sections.iter().all(|s| s.0 != here) {
                sections.push((here, Line::straight(&mesh, 0.0, 0.0)));
            }
        }
        sections.sort_by_key(|s| s.0);
        let (nodes, mut lines): (Vec<usize>, Vec<Line>) = sections.into_iter().unzip();
        for &section in &nodes {
            let line = statics.moment(&mesh, section);
            lines.push(actual(&line, &|node| line.at_node(node)));
        }
        for right in [false, true] {
            for &section in &nodes {
                let line = statics.shear(&mesh, section, right);
                // A redundant at the section itself stands to the right of its left side, to the left of its right side.
                let at_redundant = |node: usize| match node == section {
                    true if right && node == 0 => line.after(node) - 1.0,
                    true if right => line.before(node),
                    true if node == mesh.panels() => line.before(node) + 1.0,
                    true => line.after(node),
                    false => line.at_node(node),
                };
                lines.push(actual(&line, &at_redundant));
            }
        }
        let mut supports: Vec<(Support, Line)> = Vec::new();
        for (i, support) in outer.iter().enumerate() {
            let line = statics.reaction(&mesh, i);
            supports.push((*support, actual(&line, &|node| line.at_node(node))));
        }
        for (&(station, compliance), line) in redundants.iter().zip(&reactions) {
            let fixity = Fixity::Elastic { vertical: 1.0 / compliance, rotation: 0.0 }.simplest();
            supports.push((Support { at: data.stations[station], fixity }, line.clone()));
        }
        supports.sort_by(|a, b| a.0.at.total_cmp(&b.0.at));
        let (supports, of_supports): (Vec<Support>, Vec<Line>) = supports.into_iter().unzip();
        lines.extend(of_supports);
        if let Some(line) = statics.clamp_moment(&mesh) {
            lines.push(actual(&line, &|node| line.at_node(node)));
        }
        let held = supports.iter().filter(|s| s.fixity.vertical().is_infinite()).map(|s| mesh.node_at(s.at)).collect();
        let responses = Responses::from_lines(nodes, supports.len(), held, lines);
        let motion = Motion::Flexibility { matrix, columns: of_masses };
        Ok(Given { mesh, supports, masses, motion, responses, missing: vec![Quantity::Slope] })
    }
}

fn check_symmetry(f: &Mat<f64>, rows: &[usize]) -> Result<(), Error> {
    let largest = rows.iter().flat_map(|&i| f.row(i).iter()).fold(0.0_f64, |m, v| m.max(v.abs()));
    for i in 0..rows.len() {
        for j in 0..i {
            let (one, other) = (f[(rows[i], j)], f[(rows[j], i)]);
            if (one - other).abs() > UNSYMMETRIC * largest {
                let value = format!("{one:e} in row {i} and column {j}, {other:e} the other way round");
                let allowed = "must be symmetric at the stations (Maxwell's theorem)";
                return Err(Error::input("flexibility", value, allowed));
            }
        }
        if f[(rows[i], i)] < 0.0 {
            let value = format!("{:e} in row and column {i}", f[(rows[i], i)]);
            return Err(Error::input("flexibility", value, "a load must not lift its own station"));
        }
    }
    Ok(())
}

/// Deflections of the basic bridge along the path for a unit load at station j.
fn column(data: &ByFlexibility, mesh: &Mesh, outer: &[Support], j: usize) -> Result<Line, Error> {
    let length = mesh.length();
    let near = COINCIDENT * length;
    let mut x = data.path.clone();
    let mut values: Vec<f64> = data.flexibility.col(j).iter().copied().collect();
    let mut slopes: Option<Vec<f64>> = data.slopes.as_ref().map(|s| s.col(j).iter().copied().collect());
    let mut ends = [End::Natural; 2];
    for (i, support) in outer.iter().enumerate() {
        let rigid = support.fixity.vertical().is_infinite();
        let side = usize::from(support.at == length);
        let at_end = support.at == 0.0 || support.at == length;
        if support.fixity.rotation().is_infinite() && at_end {
            ends[side] = End::Slope(0.0);
        }
        if x.iter().any(|p| (p - support.at).abs() <= near) {
            continue;
        }
        let unknown = |why: &str| {
            let value = format!("no point at {} m", support.at);
            Error::input("path", value, format!("must contain supports[{i}], {why}"))
        };
        if !rigid {
            return Err(unknown("which stands on a spring"));
        }
        if support.fixity.rotation() > 0.0 && ends[side] == End::Natural {
            return Err(unknown("which holds the rotation"));
        }
        let at = x.partition_point(|p| *p < support.at);
        if let Some(slopes) = &mut slopes {
            let slope = match ends[side] {
                End::Slope(slope) => slope,
                // The end carries no moment: the cubic from the nearest point to it has no curvature there.
                _ if at_end => {
                    let next = if side == 0 { 0 } else { x.len() - 1 };
                    let h = x[next] - support.at;
                    values[next] / h - 0.5 * (slopes[next] - values[next] / h)
                }
                _ => {
                    return Err(unknown("which does not stand at an end of the beam, where slopes are given"));
                }
            };
            slopes.insert(at, slope);
        }
        x.insert(at, support.at);
        values.insert(at, 0.0);
    }
    let mut slopes = slopes.unwrap_or_else(|| spline_slopes(&x, &values, ends));
    // Beyond the outermost points the beam is straight.
    if x[0] > near {
        values.insert(0, values[0] - slopes[0] * x[0]);
        slopes.insert(0, slopes[0]);
    }
    let last = x[x.len() - 1];
    if length - last > near {
        let (value, slope) = (values[values.len() - 1], slopes[slopes.len() - 1]);
        values.push(value + slope * (length - last));
        slopes.push(slope);
    }
    Ok(Sides::smooth(values, slopes).line(mesh))
}

/// Redundant reactions, up, to a unit load along the path: [KTN73] Eq. 13.
fn redundant_reactions(
    mesh: &Mesh,
    basic: &[Line],
    redundants: &[(usize, f64)],
    node: &dyn Fn(usize) -> usize,
) -> Result<Vec<Line>, Error> {
    let n = redundants.len();
    if n == 0 {
        return Ok(Vec::new());
    }
    let f = Mat::from_fn(n, n, |i, j| {
        let both = [(i, j), (j, i)].map(|(i, j)| basic[redundants[j].0].at_node(node(redundants[i].0)));
        0.5 * (both[0] + both[1]) + if i == j { redundants[i].1 } else { 0.0 }
    });
    let factor = Llt::new(f.as_ref(), Side::Lower).map_err(|_| {
        let allowed = "the flexibility at the redundant supports must be positive definite";
        Error::input("flexibility", "one that is not positive definite", allowed)
    })?;
    let mut stiffness = Mat::from_fn(n, n, |i, j| f64::from(i == j));
    factor.solve_in_place(stiffness.as_mut());
    Ok((0..n)
        .map(|i| {
            let mut line = Line::straight(mesh, 0.0, 0.0);
            for (j, redundant) in redundants.iter().enumerate() {
                line.add_scaled(stiffness[(i, j)], &basic[redundant.0]);
            }
            line
        })
        .collect())
}

/// Statics of a determinate beam: [KTN73] Table 1.
struct Statics {
    /// Position of every support, and its reaction up to a unit load at x: a + b x.
    forces: Vec<(f64, [f64; 2])>,
    /// The support that holds the rotation, and its couple in the sense of positive slope: a + b x.
    couple: Option<(f64, [f64; 2])>,
}

impl Statics {
    fn new(supports: &[Support]) -> Result<Self, Error> {
        let held = supports.iter().filter(|s| s.fixity.rotation() > 0.0).count();
        match supports {
            [one] if held == 1 => {
                let forces = vec![(one.at, [1.0, 0.0])];
                Ok(Statics { forces, couple: Some((one.at, [one.at, -1.0])) })
            }
            [a, b] if held == 0 => {
                let span = b.at - a.at;
                let forces = vec![(a.at, [b.at / span, -1.0 / span]), (b.at, [-a.at / span, 1.0 / span])];
                Ok(Statics { forces, couple: None })
            }
            _ => {
                let value = format!("{} supports, {held} of which hold the rotation", supports.len());
                let allowed = "the basic bridge must be statically determinate, on two supports that let it turn or one \
                               that does not; name the other supports as redundants";
                Err(Error::input("supports", value, allowed))
            }
        }
    }

    /// a + b x, less f(s − x) to the left of a section.
    fn line(mesh: &Mesh, [a, b]: [f64; 2], section: usize, left: [f64; 2]) -> Line {
        let mut line = Line::straight(mesh, a, b);
        let sub = Line::straight(mesh, left[0], left[1]);
        let cubics = line.cubics().iter().zip(sub.cubics()).enumerate();
        let cubics = cubics.map(|(panel, (whole, less))| match panel < section {
            true => std::array::from_fn(|i| whole[i] - less[i]),
            false => *whole,
        });
        line = Line::from_cubics(cubics.collect());
        line
    }

    fn moment(&self, mesh: &Mesh, section: usize) -> Line {
        let s = mesh.nodes()[section];
        let [mut a, mut b] = [0.0; 2];
        for &(at, reaction) in self.forces.iter().filter(|f| f.0 < s) {
            a += reaction[0] * (s - at);
            b += reaction[1] * (s - at);
        }
        // A couple at the left end is a moment there; elsewhere the moment is the one just left of it.
        for &(_, couple) in self.couple.iter().filter(|c| c.0 < s || c.0 == 0.0) {
            a += couple[0];
            b += couple[1];
        }
        Self::line(mesh, [a, b], section, [s, -1.0])
    }

    fn shear(&self, mesh: &Mesh, section: usize, right: bool) -> Line {
        let s = mesh.nodes()[section];
        let [mut a, mut b] = [0.0; 2];
        let near = COINCIDENT * mesh.length();
        for &(_, reaction) in self.forces.iter().filter(|f| f.0 < s - near || (right && f.0 <= s + near)) {
            a += reaction[0];
            b += reaction[1];
        }
        Self::line(mesh, [a, b], section, [1.0, 0.0])
    }

    fn reaction(&self, mesh: &Mesh, support: usize) -> Line {
        let [a, b] = self.forces[support].1;
        Line::straight(mesh, a, b)
    }

    fn clamp_moment(&self, mesh: &Mesh) -> Option<Line> {
        let &(at, [a, b]) = self.couple.as_ref()?;
        // On the right end the sagging moment is the opposite couple.
        let sign = if at == mesh.length() { -1.0 } else { 1.0 };
        Some(Line::straight(mesh, sign * a, sign * b))
    }
}
