//! The bridge as an engineer describes it (spans, supports, EI, mass), checked once and valid from then on.
//!
//! EI and mass are a [`distribution`] along it, each [`support`] holds it, its mass is lumped at stations
//! ([`lumping`]), and every function along it is made of [`cubics`].

pub(crate) mod cubics;
pub(crate) mod distribution;
pub(crate) mod lumping;
pub(crate) mod support;

pub use cubics::{Line, MAX_STATIONS, Mesh};
pub use distribution::{Along, TAPER_PIECES};
pub use lumping::Stations;
pub use support::{Fixity, Support};

use crate::error::{Error, finite, positive};
use crate::float_mode::Standard;
use cubics::COINCIDENT;
use distribution::{Distribution, Sign};
use lumping::{Station, equal_shares, too_many, tributary_shares};
use support::{checked_supports, on_the_bridge};

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

/// Ten equal shares of the mass of every span, unless the user says otherwise.
const USUAL_STATIONS: usize = 10;

impl Layout {
    /// A beam of `length` [m] on `supports`, with EI [N m²] and mass per length [kg/m], lumped at ten stations a span.
    pub fn new(
        length: f64,
        supports: Vec<Support>,
        flexural_rigidity: impl Into<Along>,
        mass: impl Into<Along>,
    ) -> Self {
        Layout {
            length,
            supports,
            hinges: Vec::new(),
            flexural_rigidity: flexural_rigidity.into(),
            mass: mass.into(),
            stations: Stations::PerSpan(vec![USUAL_STATIONS]),
            point_masses: Vec::new(),
        }
    }

    /// The same of consecutive `spans` [m], pinned between them and at the ends.
    pub fn of_spans(spans: &[f64], flexural_rigidity: impl Into<Along>, mass: impl Into<Along>) -> Result<Self, Error> {
        let (length, supports) = Bridge::consecutive(spans, [Some(Fixity::Pinned); 2])?;
        Ok(Layout::new(length, supports, flexural_rigidity, mass))
    }

    /// With these hinges [m].
    pub fn hinges(mut self, hinges: &[f64]) -> Self {
        self.hinges = hinges.to_vec();
        self
    }

    /// With its mass lumped at these stations.
    pub fn stations(mut self, stations: Stations) -> Self {
        self.stations = stations;
        self
    }

    /// With point masses besides (position [m], mass [kg]).
    pub fn point_masses(mut self, point_masses: &[(f64, f64)]) -> Self {
        self.point_masses = point_masses.to_vec();
        self
    }

    /// The bridge, if it is one.
    pub fn build(self) -> Result<Bridge, Error> {
        Bridge::from_layout(self)
    }
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
    /// A bridge from all that can be said of one. That its hinges make no mechanism is left to
    /// [`crate::statics::flexibility::Flexibility::new`].
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
