//! A bridge prepared for crossings, its modes, influence lines and recovery worked out once; and what one crossing
//! gives.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::bridge::Bridge;
use crate::bridge::cubics::{COINCIDENT, Line, check_lines};
use crate::crossing::cross;
use crate::crossing::envelope::{Envelope, axle_loads};
use crate::crossing::history::History;
use crate::crossing::observer::Observer;
use crate::crossing::tail::FreeRows;
use crate::damping::Damping;
use crate::error::Error;
use crate::float_mode::Standard;
use crate::imported::Given;
use crate::memory;
use crate::modal_bridge::{ModalBridge, ModeShapes};
use crate::modes::Modes;
use crate::passage::Passage;
use crate::passage::settings::Settings;
use crate::recovery::{ModalFactors, Recovery, Rows};
use crate::selection::Selection;
use crate::statics::flexibility::Flexibility;
use crate::statics::influence::Responses;
use crate::statics::quantity::{At, Quantity};
use crate::statistics::Ride;
use crate::stop_token::StopToken;
use crate::vehicle::Vehicle;

/// Most memory that the histories of one quantity may take [bytes].
pub const MAX_HISTORY_BYTES: f64 = (2u64 << 30) as f64;

/// Most sections looked at: their influence lines take memory with the square of the number.
pub const MAX_SECTIONS: usize = 2000;

/// A bridge with everything that does not depend on the vehicle, worked out once.
#[derive(Debug, Clone)]
pub struct Analysis {
    /// Positions of the sections [m].
    pub sections: Vec<f64>,
    /// The included modes.
    pub modes: Modes,
    /// The bridge in these modes.
    pub model: ModalBridge,
    /// The responses looked at.
    pub responses: Responses,
    /// Kinds of response that a bridge given by its modes came without; their lines are zero.
    pub missing: Vec<Quantity>,
    /// How they follow from modal states.
    pub rows: Rows,
    /// What other responses can be made of.
    source: Arc<Source>,
    /// The distinct ones among them, all of them looked at.
    pub look: Selection,
    /// The same without vehicles on the bridge.
    pub free: FreeRows,
}

/// What an analysis was prepared from.
#[derive(Debug)]
struct Source {
    preparation: Preparation,
    subject: Subject,
    /// The modes along the bridge.
    lines: Vec<Line>,
}

/// A bridge, described or given; of one that is given with the numbers of the sections looked at.
#[derive(Debug)]
enum Subject {
    Described(Bridge),
    Given(Given, Vec<usize>),
}

/// How a bridge is prepared for crossings: undamped, looked at where it is interesting, by force summation, unless the user
/// says otherwise.
#[derive(Debug, Clone, PartialEq)]
pub struct Preparation {
    /// Damping of the bridge.
    pub damping: Damping,
    /// Positions of the sections [m]; none for [`Bridge::default_sections`].
    pub sections: Option<Vec<f64>>,
    /// How responses follow from modal states.
    pub recovery: Recovery,
}

impl Default for Preparation {
    fn default() -> Self {
        Preparation { damping: Damping::Ratios(vec![0.0]), sections: None, recovery: Recovery::ForceSummation }
    }
}

impl Preparation {
    /// With this damping.
    pub fn damping(mut self, damping: Damping) -> Self {
        self.damping = damping;
        self
    }

    /// Looking at these sections [m].
    pub fn sections(mut self, sections: &[f64]) -> Self {
        self.sections = Some(sections.to_vec());
        self
    }

    /// With responses recovered in this way.
    pub fn recovery(mut self, recovery: Recovery) -> Self {
        self.recovery = recovery;
        self
    }

    /// A described bridge in its `modes`; `stop` is asked now and then.
    pub fn of(&self, bridge: &Bridge, modes: Modes, stop: StopToken<'_>) -> Result<Analysis, Error> {
        let Preparation { damping, sections, .. } = self;
        let _mode = Standard::set();
        let sections = match sections {
            Some(sections) => checked_sections(sections, bridge.length())?,
            None => {
                let sections = bridge.default_sections();
                if sections.len() > MAX_SECTIONS {
                    let size = format!("{} stations, supports and tenth points", sections.len());
                    let allowed = format!("too many to look at by default, at most {MAX_SECTIONS}: give sections");
                    return Err(Error::input("bridge", size, allowed));
                }
                checked_sections(&sections, bridge.length())?
            }
        };
        check_memory(
            sections.len(),
            modes.len(),
            bridge.supports().len(),
            bridge.span_bounds().len() + bridge.stations().len(),
        )?;
        let flexibility = Flexibility::new(bridge, &sections)?;
        let lines = modes.lines(bridge, &flexibility);
        let model = ModalBridge::new(bridge, &flexibility, &modes, &lines, damping)?;
        let responses = Responses::new(&flexibility, bridge, &sections, &Quantity::USUAL, stop)?;
        let source = Source { preparation: self.clone(), subject: Subject::Described(bridge.clone()), lines };
        let source = Arc::new(source);
        Ok(Analysis::new(source, sections, modes, model, responses, Vec::new()))
    }

    /// A bridge given by its flexibility or its modes, in `count` modes.
    pub fn of_given(&self, given: &Given, count: usize) -> Result<Analysis, Error> {
        let Preparation { damping, sections, .. } = self;
        let _mode = Standard::set();
        let (modes, lines) = given.modes(count)?;
        let (sections, chosen) = given.chosen(sections.as_deref())?;
        check_memory(chosen.len(), count, given.responses().len(), given.mesh().panels())?;
        let responses = given.responses().of_sections(&chosen);
        let model = ModalBridge {
            omega: modes.omega.clone(),
            shapes: ModeShapes::new(given.mesh(), &lines),
            damping: given.damping(&modes, damping)?,
            shortest_span: given.shortest_span(),
        };
        let source = Source { preparation: self.clone(), subject: Subject::Given(given.clone(), chosen), lines };
        Ok(Analysis::new(Arc::new(source), sections, modes, model, responses, given.missing().to_vec()))
    }
}

impl Analysis {
    fn new(
        source: Arc<Source>,
        sections: Vec<f64>,
        modes: Modes,
        model: ModalBridge,
        responses: Responses,
        missing: Vec<Quantity>,
    ) -> Self {
        let Source { preparation: Preparation { damping, recovery, .. }, subject, lines } = &*source;
        let mesh = model.shapes.mesh();
        let in_both = (damping, &model.damping);
        let factors = match subject {
            Subject::Described(bridge) => {
                let masses: Vec<(usize, f64)> =
                    bridge.stations().iter().map(|s| (mesh.node_at(s.at), s.mass)).collect();
                ModalFactors::of_masses(&responses, &masses, &modes, in_both)
            }
            Subject::Given(given, chosen) => given.factors(&responses, chosen, &modes, in_both),
        };
        let rows = Rows::new(&responses, &factors, &modes.omega, lines, mesh, *recovery);
        let quantities: Vec<Quantity> = responses.quantities().collect();
        let look = Selection::new(&rows, &responses, &quantities);
        let free = FreeRows::new(&rows, &responses, &model).of(look.rows.iter().map(|row| row.response));
        Analysis { sections, modes, model, responses, missing, rows, source, look, free }
    }

    /// The same bridge, looked at for other kinds of response.
    pub fn looking_at(&self, quantities: &[Quantity], stop: StopToken<'_>) -> Result<Self, Error> {
        let _mode = Standard::set();
        let known = |quantity: &Quantity| quantity.order() > 0 || self.responses.quantities().any(|q| q == *quantity);
        let responses = match &self.source.subject {
            Subject::Described(bridge) if !quantities.iter().all(known) => {
                let flexibility = Flexibility::new(bridge, &self.sections)?;
                Responses::new(&flexibility, bridge, &self.sections, quantities, stop)?
            }
            _ => self.responses.of_quantities(quantities, self.model.shapes.mesh()),
        };
        let (source, sections, modes) = (Arc::clone(&self.source), self.sections.clone(), self.modes.clone());
        Ok(Analysis::new(source, sections, modes, self.model.clone(), responses, self.missing.clone()))
    }

    /// One crossing by one vehicle.
    pub fn cross(&self, vehicle: &Vehicle, settings: &Settings, stop: StopToken<'_>) -> Result<Outcome, Error> {
        self.cross_all(&[Passage::of(vehicle.clone())], settings, stop)
    }

    /// One crossing by several vehicles.
    pub fn cross_all(&self, passages: &[Passage], settings: &Settings, stop: StopToken<'_>) -> Result<Outcome, Error> {
        let _mode = Standard::set();
        let mut observer = Observer::new(&self.rows, &self.look, &self.free, None);
        let history = cross(&self.model, passages, settings, &mut observer, stop)?;
        let envelope = observer.conclude(&history, stop)?;
        let bodies: Vec<_> = passages.iter().map(|passage| passage.vehicle.heaves()).collect();
        let rides = history.rides(&bodies, self.rows.mesh(), stop)?;
        Ok(Outcome { axle_loads: axle_loads(&history, &rides), history, envelope, rides })
    }

    /// An outcome that has travelled, if it is one of this bridge.
    pub fn received(&self, outcome: Outcome) -> Result<Outcome, Error> {
        let found = [outcome.history.modes, outcome.envelope.dynamic.max.len()];
        let own = [self.modes.len(), self.responses.len()];
        if found != own {
            let [modes, responses] = found;
            let allowed = format!("must be of {} modes and {} responses, as the bridge beside it", own[0], own[1]);
            return Err(Error::input("state", format!("{modes} modes, {responses} responses"), allowed));
        }
        Ok(outcome)
    }

    /// How many responses of a quantity there are.
    pub fn count(&self, quantity: Quantity) -> usize {
        match quantity.at() {
            At::Sections => self.sections.len(),
            At::Supports | At::Clamps => self.responses.range(quantity).len(),
        }
    }

    /// The responses of one quantity at every instant, dynamic and static, row by row.
    pub fn histories(
        &self,
        outcome: &Outcome,
        quantity: Quantity,
        stop: StopToken<'_>,
    ) -> Result<[Vec<f64>; 2], Error> {
        if self.missing.contains(&quantity) {
            let allowed = "this bridge was given without influence lines of it";
            return Err(Error::input("quantity", quantity.name(), allowed));
        }
        let count = self.count(quantity);
        let bytes = 2.0 * size_of::<f64>() as f64 * outcome.history.len() as f64 * count as f64;
        let size = format!("{count} positions at {} instants", outcome.history.len());
        let mend = "use fewer sections or a longer step";
        memory::check("sections", size, bytes, MAX_HISTORY_BYTES, "histories there", mend)?;
        let _mode = Standard::set();
        if self.responses.quantities().any(|own| own == quantity) {
            return outcome.history.responses(&self.rows, self.responses.range(quantity), stop);
        }
        let other = self.looking_at(&[quantity], stop)?;
        outcome.history.responses(&other.rows, other.responses.range(quantity), stop)
    }

    /// The quasi-static part of the deck's acceleration at every instant, which is that of the modes left out: see
    /// [`History::quasi_static_acceleration`]. Only by force summation.
    pub fn quasi_static_acceleration(&self, outcome: &Outcome, stop: StopToken<'_>) -> Result<Vec<f64>, Error> {
        if self.rows.weight() == 0.0 || self.rows.by_rates() {
            let recovery = if self.rows.by_rates() { "force-summation-by-rates" } else { "superposition" };
            let allowed =
                "quasi_static_acceleration needs \"force-summation\", which adds what the modes left out carry";
            return Err(Error::input("recovery", format!("\"{recovery}\""), allowed));
        }
        let _mode = Standard::set();
        outcome.history.quasi_static_acceleration(&self.rows, self.responses.range(Quantity::Deflection), stop)
    }

    /// Largest magnitude of every response of a quantity that free vibration after the end can reach; none where a vehicle
    /// stands on the bridge.
    pub fn bounds_of(
        &self,
        outcome: &Outcome,
        quantity: Quantity,
        stop: StopToken<'_>,
    ) -> Result<Option<Vec<f64>>, Error> {
        let Some(reach) = &outcome.history.reach else { return Ok(None) };
        if !self.responses.quantities().any(|own| own == quantity) {
            return self.looking_at(&[quantity], stop)?.bounds_of(outcome, quantity, stop);
        }
        let of_rows = self.free.bounds(reach);
        Ok(Some(self.responses.range(quantity).map(|response| of_rows[self.look.row_of[response]]).collect()))
    }

    /// Extremes of one quantity; shears on both sides of a section count together.
    pub fn envelope_of(&self, outcome: &Outcome, quantity: Quantity, stop: StopToken<'_>) -> Result<Envelope, Error> {
        let _mode = Standard::set();
        if !self.responses.quantities().any(|own| own == quantity) {
            let Analysis { rows, look, free, .. } = &self.looking_at(&[quantity], stop)?;
            let mut envelope = Observer::new(rows, look, free, None).conclude(&outcome.history, stop)?;
            if self.missing.contains(&quantity) {
                envelope.forget();
            }
            return Ok(envelope);
        }
        let of = |quantity| {
            let mut envelope = outcome.envelope.of(self.responses.range(quantity));
            if self.missing.contains(&quantity) {
                envelope.forget();
            }
            envelope
        };
        Ok(match quantity {
            Quantity::ShearLeft | Quantity::ShearRight => of(Quantity::ShearLeft).merged(&of(Quantity::ShearRight)),
            other => of(other),
        })
    }
}

/// What a crossing gives.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Outcome {
    /// States, step after step.
    pub history: History,
    /// Extremes of all responses.
    pub envelope: Envelope,
    /// Extremes of the axle loads.
    pub axle_loads: Envelope,
    /// Contact forces and accelerations of each vehicle.
    pub rides: Vec<Ride<f64>>,
}

impl Outcome {
    /// Root mean square of each axle load about its static value, by that value, while its vehicle is on the bridge [-].
    pub fn load_coefficients(&self) -> Vec<f64> {
        let axles = self.rides.iter().flat_map(|ride| (0..ride.loads.len()).map(move |own| (ride, own)));
        axles.zip(&self.history.static_loads).map(|((ride, own), &load)| ride.load_coefficient(own, 0, load)).collect()
    }
}

/// Refuses sections whose influence lines there is no memory for: twice each, as lines and in the rows, over the panels
/// between them and a number of other points, for deflection, moment and both shears, and for the supports; or modes whose
/// lines there is none for.
fn check_memory(sections: usize, modes: usize, supports: usize, points: usize) -> Result<(), Error> {
    // Of every row its factors are kept too, in some copies.
    let (lines, panels) = (4 * sections + 2 * supports, sections + points + modes);
    check_lines("sections", sections, 2.0 * lines as f64, panels, "influence lines of so many")?;
    check_lines("modes", modes, 2.0 * modes as f64, panels, "lines of so many along the bridge")
}

fn checked_sections(sections: &[f64], length: f64) -> Result<Vec<f64>, Error> {
    if sections.is_empty() || sections.len() > MAX_SECTIONS {
        let allowed = format!("give 1 to {MAX_SECTIONS} positions in metres");
        return Err(Error::input("sections", format!("{} positions", sections.len()), allowed));
    }
    for (i, &x) in sections.iter().enumerate() {
        if !(x.is_finite() && x >= 0.0 && x <= length) {
            let allowed = format!("must lie on the beam, 0 to {length} m");
            return Err(Error::input(format!("sections[{i}]"), format!("{x} m"), allowed));
        }
        if i > 0 && x - sections[i - 1] <= COINCIDENT * length {
            let allowed = format!("must be greater than the section before it, {} m", sections[i - 1]);
            return Err(Error::input(format!("sections[{i}]"), format!("{x} m"), allowed));
        }
    }
    Ok(sections.to_vec())
}
