//! The bridge as an engineer describes it (spans, supports, EI, mass), checked once and valid from then on.

use crate::along::{Along, Distribution, Sign};
use crate::error::{Error, finite, positive};
use crate::float_mode::Standard;

/// Most stations a bridge may have: F is a dense matrix of this order, and its eigensolution grows with the cube.
pub const MAX_STATIONS: usize = 2000;

/// Two points closer than this fraction of the length are one point.
pub const COINCIDENT: f64 = 1e-9;

/// How a support holds the beam.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fixity {
    /// Deflection held, rotation free.
    Pinned,
    /// Deflection and rotation held.
    Clamped,
    /// Held by springs.
    Elastic {
        /// Force for a unit of deflection [N/m], infinite where deflection is held.
        vertical: f64,
        /// Couple for a unit of rotation [N m/rad]: 0 where rotation is free, infinite where it is held.
        rotation: f64,
    },
}

impl Fixity {
    /// Force for a unit of deflection [N/m], infinite where deflection is held.
    pub fn vertical(self) -> f64 {
        match self {
            Fixity::Pinned | Fixity::Clamped => f64::INFINITY,
            Fixity::Elastic { vertical, .. } => vertical,
        }
    }

    /// Couple for a unit of rotation [N m/rad]: 0 where rotation is free, infinite where it is held.
    pub fn rotation(self) -> f64 {
        match self {
            Fixity::Pinned => 0.0,
            Fixity::Clamped => f64::INFINITY,
            Fixity::Elastic { rotation, .. } => rotation,
        }
    }

    /// The same by its simplest name.
    pub(crate) fn simplest(self) -> Self {
        match (self.vertical(), self.rotation()) {
            (f64::INFINITY, 0.0) => Fixity::Pinned,
            (f64::INFINITY, f64::INFINITY) => Fixity::Clamped,
            (vertical, rotation) => Fixity::Elastic { vertical, rotation },
        }
    }
}

/// A support of the beam.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Support {
    /// Position from the left end [m].
    pub at: f64,
    /// What it holds.
    pub fixity: Fixity,
}

/// A lumped mass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Station {
    /// Position from the left end [m].
    pub at: f64,
    /// Mass [kg].
    pub mass: f64,
}

/// Where the distributed mass is lumped.
#[derive(Debug, Clone, PartialEq)]
pub enum Stations {
    /// This many equal shares of every span, each mass in the middle of its share.
    PerSpan(Vec<usize>),
    /// Positions chosen by the user [m]; each takes the mass up to half-way to its neighbours, within its span.
    At(Vec<f64>),
}

/// Everything that makes a bridge, as given.
#[derive(Debug, Clone, PartialEq)]
pub struct Layout {
    /// Length [m].
    pub length: f64,
    /// Supports, in any order.
    pub supports: Vec<Support>,
    /// Positions at which the beam cannot carry a moment [m], in any order.
    pub hinges: Vec<f64>,
    /// EI [N m²].
    pub flexural_rigidity: Along,
    /// Mass per length [kg/m].
    pub mass: Along,
    /// Where the mass is lumped.
    pub stations: Stations,
    /// Point masses (position [m], mass [kg]): stations of their own, or added to the station they stand on.
    pub point_masses: Vec<(f64, f64)>,
}

/// A straight beam on supports, its mass lumped at stations.
///
/// A *span* is a stretch between neighbouring supports or ends, overhangs included.
#[derive(Debug, Clone, PartialEq)]
pub struct Bridge {
    length: f64,
    supports: Vec<Support>,
    /// Ends and supports, left to right: `span i` runs from `bounds[i]` to `bounds[i + 1]` [m].
    bounds: Vec<f64>,
    hinges: Vec<f64>,
    /// EI in pieces of constant value.
    flexural_rigidity: Distribution,
    /// Breakpoints of EI as given, before a taper is cut into pieces [m].
    breakpoints: Vec<f64>,
    stations: Vec<Station>,
}

impl Bridge {
    /// A bridge of `length` [m] on `supports`, with EI [N m²] and mass per length [kg/m] given once or per span.
    ///
    /// Point masses (position [m], mass [kg]) are stations of their own, or add to the station they stand on.
    pub fn new(
        length: f64,
        supports: Vec<Support>,
        flexural_rigidity: &[f64],
        mass: &[f64],
        stations: &Stations,
        point_masses: &[(f64, f64)],
    ) -> Result<Self, Error> {
        Bridge::from_layout(Layout {
            length,
            supports,
            hinges: Vec::new(),
            flexural_rigidity: Along::PerSpan(flexural_rigidity.to_vec()),
            mass: Along::PerSpan(mass.to_vec()),
            stations: stations.clone(),
            point_masses: point_masses.to_vec(),
        })
    }

    /// A bridge from all that can be said of one. That its hinges make no mechanism is left to
    /// [`crate::flexibility::Flexibility::new`].
    pub fn from_layout(layout: Layout) -> Result<Self, Error> {
        let _mode = Standard::set();
        let length = positive("length", layout.length)?;
        let supports = checked_supports(length, layout.supports)?;
        let hinges = checked_hinges(length, layout.hinges, &supports)?;
        let near = COINCIDENT * length;
        let mut bounds = vec![0.0];
        bounds.extend(supports.iter().map(|s| s.at).filter(|&x| x > near && x < length - near));
        bounds.push(length);

        let flexural_rigidity = Distribution::new("EI", &layout.flexural_rigidity, &bounds, Sign::Positive)?
            .stepped("EI", layout.flexural_rigidity.pieces())?;
        let mass = Distribution::new("mass", &layout.mass, &bounds, Sign::NotNegative)?;

        let held = |x: f64| supports.iter().any(|s| (s.at - x).abs() <= near && s.fixity.vertical().is_infinite());
        let mut lumps = match &layout.stations {
            Stations::PerSpan(counts) => equal_shares(&bounds, &hinges, &mass, counts)?,
            Stations::At(positions) => tributary_shares(&bounds, &mass, positions, &held)?,
        };
        for (i, &(at, m)) in layout.point_masses.iter().enumerate() {
            on_the_bridge(&format!("point_masses[{i}]"), at, length)?;
            positive(format!("point_masses[{i}] mass"), m)?;
            match lumps.iter_mut().find(|s| (s.at - at).abs() <= near) {
                Some(station) => station.mass += m,
                None => lumps.push(Station { at, mass: m }),
            }
        }
        if lumps.len() > MAX_STATIONS {
            return Err(too_many("stations", lumps.len()));
        }
        lumps.sort_by(|a, b| a.at.total_cmp(&b.at));
        let total: f64 = lumps.iter().map(|s| s.mass).sum();
        // A mass over a rigid support does not move: it takes no part in the dynamics.
        lumps.retain(|s| s.mass > 0.0 && !held(s.at));
        if lumps.is_empty() {
            let allowed = "at least one station off the supports must carry mass";
            return Err(match total > 0.0 {
                true => Error::input("stations", "all on supports", allowed),
                // So short that the mass on it is lost in rounding.
                false if length < 1e-9 => Error::input("spans", format!("{length:e} m in all"), allowed),
                false => Error::input("mass", 0, allowed),
            });
        }
        let breakpoints = layout.flexural_rigidity.breakpoints().to_vec();
        Ok(Bridge { length, supports, bounds, hinges, flexural_rigidity, breakpoints, stations: lumps })
    }

    /// A bridge laid out as consecutive `spans` [m] with supports between them and the given ends (`None` is free).
    pub fn continuous(
        spans: &[f64],
        ends: [Option<Fixity>; 2],
        flexural_rigidity: &[f64],
        mass: &[f64],
        stations: &Stations,
        point_masses: &[(f64, f64)],
    ) -> Result<Self, Error> {
        let (length, supports) = Bridge::consecutive(spans, ends)?;
        Bridge::new(length, supports, flexural_rigidity, mass, stations, point_masses)
    }

    /// Length [m] and supports of consecutive `spans` [m] with the given ends (`None` is free).
    pub fn consecutive(spans: &[f64], ends: [Option<Fixity>; 2]) -> Result<(f64, Vec<Support>), Error> {
        let _mode = Standard::set();
        if spans.is_empty() {
            return Err(Error::input("spans", "[]", "needs at least one length in metres"));
        }
        if spans.len() > MAX_STATIONS {
            return Err(Error::input("spans", format!("{} spans", spans.len()), format!("at most {MAX_STATIONS}")));
        }
        let mut supports = Vec::with_capacity(spans.len() + 1);
        let mut x = 0.0;
        for (i, &span) in spans.iter().enumerate() {
            positive(format!("spans[{i}]"), span)?;
            let fixity = if i == 0 { ends[0] } else { Some(Fixity::Pinned) };
            supports.extend(fixity.map(|fixity| Support { at: x, fixity }));
            x += span;
        }
        finite("spans", x)?;
        if let Some((i, span)) = spans.iter().enumerate().find(|(_, span)| **span <= COINCIDENT * x) {
            let allowed = format!("too short beside the whole length of {x:e} m");
            return Err(Error::input(format!("spans[{i}]"), format!("{span:e} m"), allowed));
        }
        supports.extend(ends[1].map(|fixity| Support { at: x, fixity }));
        Ok((x, supports))
    }

    /// Length [m].
    pub fn length(&self) -> f64 {
        self.length
    }

    /// Supports, left to right.
    pub fn supports(&self) -> &[Support] {
        &self.supports
    }

    /// Ends and supports, left to right [m]: the spans are the stretches between them.
    pub fn span_bounds(&self) -> &[f64] {
        &self.bounds
    }

    /// Hinges, left to right [m].
    pub fn hinges(&self) -> &[f64] {
        &self.hinges
    }

    /// EI of each piece of the beam [N m²]: of each span, unless given otherwise.
    pub fn flexural_rigidity(&self) -> Vec<f64> {
        self.flexural_rigidity.values()
    }

    /// Ends of the pieces of constant EI, left to right [m].
    pub fn rigidity_bounds(&self) -> &[f64] {
        self.flexural_rigidity.bounds()
    }

    /// The moving masses, left to right (masses over supports are left out: they do not move).
    pub fn stations(&self) -> &[Station] {
        &self.stations
    }

    /// EI at x [N m²], to the right of x where it changes there.
    pub fn flexural_rigidity_at(&self, x: f64) -> f64 {
        self.flexural_rigidity.piece_at(x)
    }

    /// Every position at which something happens: ends, supports, hinges, changes of EI, masses [m].
    pub fn points(&self) -> impl Iterator<Item = f64> {
        let stations = self.stations.iter().map(|s| s.at);
        let given = self.bounds.iter().chain(&self.hinges).copied();
        given.chain(stations).chain(self.flexural_rigidity.bounds().iter().copied())
    }

    /// Sections looked at unless the user chooses: mass stations, supports, hinges, breakpoints of EI and the tenth
    /// points of every span [m].
    pub fn default_sections(&self) -> Vec<f64> {
        let mut sections: Vec<f64> = self.stations.iter().map(|s| s.at).collect();
        sections.extend(self.hinges.iter().chain(&self.breakpoints).map(|x| x.clamp(0.0, self.length)));
        for span in self.bounds.windows(2) {
            sections.extend((0..=10).map(|i| match i {
                10 => span[1],
                _ => span[0] + (span[1] - span[0]) * f64::from(i) / 10.0,
            }));
        }
        sections.sort_by(f64::total_cmp);
        sections.dedup_by(|b, a| *b - *a <= COINCIDENT * self.length);
        sections
    }
}

/// Supports in order, each on the beam, none twice, their springs sound, no rigid-body motion left.
pub(crate) fn checked_supports(length: f64, supports: Vec<Support>) -> Result<Vec<Support>, Error> {
    let supports = checked_supports_of_given(length, supports)?;
    let turned_back = supports.iter().any(|s| s.fixity.rotation() > 0.0);
    if !turned_back && supports.len() < 2 {
        let listed: Vec<String> = supports
            .iter()
            .map(|s| match s.fixity.vertical() {
                f64::INFINITY => format!("pinned at {} m", s.at),
                k => format!("spring of {k:e} N/m at {} m", s.at),
            })
            .collect();
        let motion = if supports.is_empty() { "fall" } else { "rotate about its only support" };
        return Err(Error::Unstable { supports: listed.join(", "), motion });
    }
    Ok(supports)
}

/// The same, but that they hold the beam is left to who gave the bridge.
pub(crate) fn checked_supports_of_given(length: f64, mut supports: Vec<Support>) -> Result<Vec<Support>, Error> {
    let near = COINCIDENT * length;
    if supports.len() > MAX_STATIONS {
        return Err(Error::input(
            "supports",
            format!("{} supports", supports.len()),
            format!("at most {MAX_STATIONS}"),
        ));
    }
    for (i, support) in supports.iter_mut().enumerate() {
        on_the_bridge(&format!("supports[{i}]"), support.at, length)?;
        for end in [0.0, length] {
            if (support.at - end).abs() <= near {
                support.at = end;
            }
        }
        if let Fixity::Elastic { vertical, rotation } = support.fixity {
            if vertical.is_nan() || vertical <= 0.0 {
                let allowed = "must be greater than 0 [N/m], or inf where the deflection is held";
                return Err(Error::input(format!("supports[{i}] vertical"), vertical, allowed));
            }
            if rotation.is_nan() || rotation < 0.0 {
                let allowed = "must be 0 or more [N m/rad]: 0 where rotation is free, inf where it is held";
                return Err(Error::input(format!("supports[{i}] rotation"), rotation, allowed));
            }
        }
        support.fixity = support.fixity.simplest();
    }
    supports.sort_by(|a, b| a.at.total_cmp(&b.at));
    for pair in supports.windows(2) {
        if pair[1].at - pair[0].at <= near {
            return Err(Error::input(
                "supports",
                format!("{} m and {} m", pair[0].at, pair[1].at),
                "two supports must not stand at the same position",
            ));
        }
    }
    Ok(supports)
}

/// Hinges in order, each inside the beam, none twice, none where a support holds the rotation.
fn checked_hinges(length: f64, mut hinges: Vec<f64>, supports: &[Support]) -> Result<Vec<f64>, Error> {
    let near = COINCIDENT * length;
    if hinges.len() > MAX_STATIONS {
        let allowed = format!("at most {MAX_STATIONS}");
        return Err(Error::input("hinges", format!("{} hinges", hinges.len()), allowed));
    }
    for (i, hinge) in hinges.iter_mut().enumerate() {
        let key = format!("hinges[{i}]");
        if !(hinge.is_finite() && *hinge > near && *hinge < length - near) {
            let allowed =
                format!("must lie inside the beam, between 0 and {length} m; its ends carry no moment unless held");
            return Err(Error::input(key, format!("{hinge} m"), allowed));
        }
        if let Some(support) = supports.iter().find(|s| (s.at - *hinge).abs() <= near) {
            if support.fixity.rotation() > 0.0 {
                let allowed = "must not stand on a support that holds the rotation: put it to the side that is \
                               released, or leave the support pinned";
                return Err(Error::input(key, format!("{hinge} m"), allowed));
            }
            *hinge = support.at;
        }
    }
    hinges.sort_by(f64::total_cmp);
    for pair in hinges.windows(2) {
        if pair[1] - pair[0] <= near {
            let value = format!("{} m and {} m", pair[0], pair[1]);
            return Err(Error::input("hinges", value, "two hinges must not stand at the same position"));
        }
    }
    Ok(hinges)
}

fn on_the_bridge(key: &str, at: f64, length: f64) -> Result<(), Error> {
    if at.is_finite() && at >= -COINCIDENT * length && at <= length * (1.0 + COINCIDENT) {
        Ok(())
    } else {
        Err(Error::input(key, format!("{at} m"), format!("must lie on the beam, 0 to {length} m")))
    }
}

fn too_many(key: &str, count: usize) -> Error {
    Error::input(key, format!("{count} stations"), format!("at most {MAX_STATIONS} mass stations in all"))
}

/// n equal shares of every span, the mass of each in its middle. No share reaches across a hinge: between the hinges of a
/// span the shares are as nearly equal as their number allows, one at least.
fn equal_shares(bounds: &[f64], hinges: &[f64], mass: &Distribution, counts: &[usize]) -> Result<Vec<Station>, Error> {
    let spans = bounds.len() - 1;
    if counts.len() != 1 && counts.len() != spans {
        return Err(Error::input(
            "stations_per_span",
            format!("{} values", counts.len()),
            format!("give one whole number, or one for each of the {spans} spans (overhangs count as spans)"),
        ));
    }
    let count_of = |span: usize| if counts.len() == 1 { counts[0] } else { counts[span] };
    let total = (0..spans).fold(0_usize, |sum, span| sum.saturating_add(count_of(span)));
    if total > MAX_STATIONS {
        return Err(too_many("stations_per_span", total));
    }
    let mut stations = Vec::with_capacity(total);
    for span in 0..spans {
        let count = count_of(span);
        if count == 0 && mass.integral(bounds[span], bounds[span + 1]) > 0.0 {
            return Err(Error::input("stations_per_span", 0, "must be 1 or more in a span that has mass"));
        }
        if count == 0 {
            continue;
        }
        let (start, end) = (bounds[span], bounds[span + 1]);
        let mut cuts = vec![start];
        cuts.extend(hinges.iter().filter(|&&x| x > start && x < end));
        cuts.push(end);
        let pieces = cuts.len() - 1;
        let (mut begun, count) = (0, count.max(pieces));
        for (k, piece) in cuts.windows(2).enumerate() {
            let wanted = ((piece[1] - start) / (end - start) * count as f64).round() as usize;
            let ended = wanted.clamp(begun + 1, count + k + 1 - pieces);
            let shares = ended - begun;
            let share = (piece[1] - piece[0]) / shares as f64;
            stations.extend((0..shares).map(|i| {
                let from = piece[0] + share * i as f64;
                Station { at: piece[0] + share * (i as f64 + 0.5), mass: mass.integral(from, from + share) }
            }));
            begun = ended;
        }
    }
    Ok(stations)
}

/// Each station takes the mass up to half-way to its neighbours; no share reaches across a support.
fn tributary_shares(
    bounds: &[f64],
    mass: &Distribution,
    positions: &[f64],
    held: &dyn Fn(f64) -> bool,
) -> Result<Vec<Station>, Error> {
    let length = bounds[bounds.len() - 1];
    let near = COINCIDENT * length;
    if positions.len() > MAX_STATIONS {
        return Err(too_many("stations", positions.len()));
    }
    for (i, &at) in positions.iter().enumerate() {
        on_the_bridge(&format!("stations[{i}]"), at, length)?;
        if i > 0 && at - positions[i - 1] <= near {
            return Err(Error::input(
                format!("stations[{i}]"),
                format!("{at} m"),
                format!("must be greater than the station before it, {} m", positions[i - 1]),
            ));
        }
    }
    let mut stations: Vec<Station> = positions.iter().map(|&at| Station { at, mass: 0.0 }).collect();
    for bound in bounds.windows(2) {
        let first = positions.partition_point(|&x| x < bound[0] - near);
        let last = positions.partition_point(|&x| x <= bound[1] + near);
        if positions[first..last].iter().all(|&x| held(x)) && mass.integral(bound[0], bound[1]) > 0.0 {
            return Err(Error::input(
                "stations",
                format!("none from {} m to {} m", bound[0], bound[1]),
                "every span that has mass needs at least one station off its supports",
            ));
        }
        for i in first..last {
            let from = if i == first { bound[0] } else { 0.5 * (positions[i - 1] + positions[i]) };
            let to = if i + 1 == last { bound[1] } else { 0.5 * (positions[i] + positions[i + 1]) };
            stations[i].mass += mass.integral(from, to);
        }
    }
    Ok(stations)
}
