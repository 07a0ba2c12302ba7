//! A study: crossings of one bridge by kinds of event, of which each sample is one.

use std::sync::Arc;

use super::path::Advance;
use super::results::{Failure, Format};
use super::sample::{Parameter, Samples};
use super::table::{Feeling, Layout, StudyRoad, Table};
use crate::crossing::analysis::Analysis;
use crate::crossing::tail::FreeRows;
use crate::error::{Error, positive};
use crate::float_mode::Standard;
use crate::geometry::pavement::Pavement;
use crate::passage::planned::Course;
use crate::passage::settings::{Settings, Tail};
use crate::passage::step_length::{Fineness, MAX_STEPS, MOST_HALVINGS, Steps};
use crate::passage::{Direction, Drive, Passage};
use crate::road::random::Synthesis;
use crate::selection::Selection;
use crate::statics::quantity::Quantity;
use crate::stop_token::StopToken;
use crate::vehicle::body::BuildUp;
use crate::vehicle::{MAX_AXLES, Vehicle};

/// One kind of event: a vehicle, or several, on their way.
#[derive(Debug, Clone)]
pub struct Kind {
    /// Who crosses.
    pub passages: Vec<Passage>,
    /// Vertical displacement of every body of the first vehicle, as rows over its coordinates.
    pub(super) bodies: Vec<Vec<f64>>,
}

/// Everything that the samples of a study share.
#[derive(Debug)]
pub struct Study {
    /// The bridge.
    pub analysis: Arc<Analysis>,
    /// The kinds of event, of which each sample is one.
    pub kinds: Vec<Kind>,
    /// How they cross; the speed is that of each sample.
    pub settings: Settings,
    /// What samples' own random roads have in common, and the seed; they come on top of the road of the settings.
    pub own: Option<(Arc<Synthesis>, u64)>,
    /// Longest way per step [m].
    advance: Option<f64>,
    /// The responses looked at.
    pub look: Selection,
    /// Their rows without vehicles on the bridge.
    pub free: FreeRows,
    /// Whether samples share the geometry.
    pub shares: bool,
}

/// How a sample marches: which kind of event, and how often the step is halved.
pub type March = (usize, u32);

/// What a study is to be: crossings of a bridge by kinds of event, on roads that samples share, looking at everything,
/// unless the user says otherwise.
#[derive(Debug, Clone)]
pub struct Plan {
    /// The bridge.
    pub analysis: Arc<Analysis>,
    /// The kinds of event, each with its vehicles.
    pub kinds: Vec<Vec<Passage>>,
    /// How they cross; the speed is that of each sample.
    pub settings: Settings,
    /// What samples' own random roads have in common, and the seed.
    pub own: Option<(Arc<Synthesis>, u64)>,
    /// Longest way per step [m].
    pub advance: Option<f64>,
    /// What is looked at.
    pub quantities: Vec<Quantity>,
}

impl Plan {
    /// Crossings by `kinds` of event.
    pub fn new(analysis: Arc<Analysis>, kinds: Vec<Vec<Passage>>, settings: Settings) -> Self {
        Plan { analysis, kinds, settings, own: None, advance: None, quantities: Quantity::USUAL.to_vec() }
    }

    /// With a random road of its own for each sample, drawn from the seed and the sample's number, on top of that of the
    /// settings.
    pub fn roads(mut self, synthesis: Arc<Synthesis>, seed: u64) -> Self {
        self.own = Some((synthesis, seed));
        self
    }

    /// In steps of this way at most [m].
    pub fn advance(mut self, advance: f64) -> Self {
        self.advance = Some(advance);
        self
    }

    /// Looking at these quantities.
    pub fn quantities(mut self, quantities: &[Quantity]) -> Self {
        self.quantities = quantities.to_vec();
        self
    }

    /// The study, if it can be one.
    pub fn study(self) -> Result<Study, Error> {
        let _mode = Standard::set();
        let Plan { analysis, kinds, settings, own, advance, quantities } = self;
        settings.check()?;
        if kinds.is_empty() || kinds.iter().any(Vec::is_empty) {
            return Err(Error::input("vehicles", "[]", "at least one vehicle must cross"));
        }
        let advance = advance.map(|advance| positive("advance", advance)).transpose()?;
        let constant = |passage: &Passage| *passage.drive.as_ref().unwrap_or(&settings.drive) == Drive::ConstantSpeed;
        let shares = kinds.iter().all(|passages| match &passages[..] {
            [one] => {
                let plain = one.direction == Direction::Right && one.entry == 0.0 && one.road.is_none();
                plain && constant(one) && one.speed.is_none()
            }
            _ => false,
        });
        // What is not prepared for is prepared now, and nothing else.
        let analysis = match quantities.iter().all(|quantity| analysis.responses.quantities().any(|q| q == *quantity)) {
            true => analysis,
            false => Arc::new(analysis.looking_at(&quantities, StopToken::NEVER)?),
        };
        let look = Selection::new(&analysis.rows, &analysis.responses, &quantities);
        if look.chosen.is_empty() {
            return Err(Error::input("quantities", "[]", "at least one response must be looked at"));
        }
        let free = analysis.free.of(look.rows.iter().map(|row| analysis.look.row_of[row.response]));
        let mut study = Study { analysis, kinds: Vec::new(), settings, own, advance, look, free, shares };
        for passages in kinds {
            let bodies = passages[0].vehicle.heaves();
            study.kinds.push(Kind { passages, bodies });
        }
        for kind in 0..study.kinds.len() {
            study.check_axles(kind)?;
            study.check_road(kind, 1.0)?;
        }
        if !shares && advance.is_some() {
            let allowed = "only for vehicles that cross alone from the left at constant speed: use step";
            return Err(Error::input("advance", format!("{} m", advance.unwrap_or_default()), allowed));
        }
        Ok(study)
    }
}

impl Study {
    /// Whether a passage has its speed from its drive.
    pub fn brings_speeds(&self, passage: &Passage) -> bool {
        matches!(passage.drive.as_ref().unwrap_or(&self.settings.drive), Drive::Speeds { .. })
    }

    /// Refuses more axles than a crossing can have, and steps in which one would pass the whole bridge.
    pub(super) fn check_axles(&self, kind: usize) -> Result<(), Error> {
        let axles: usize = self.kinds[kind].passages.iter().map(|p| p.vehicle.assembly().contacts.len()).sum();
        if axles > MAX_AXLES {
            return Err(Error::input("vehicles", format!("{axles} axles"), format!("at most {MAX_AXLES} in all")));
        }
        let length = self.analysis.model.shapes.mesh().length();
        match self.advance {
            Some(advance) if self.shares && self.plan(kind).1 >= length => {
                let allowed = format!("must be less than the length of the bridge, {length} m");
                Err(Error::input("advance", format!("{advance} m"), allowed))
            }
            Some(advance) if self.shares && (length + self.vehicle(kind).wheelbase()) / advance > MAX_STEPS as f64 => {
                let allowed = format!("the crossing would take more than {MAX_STEPS} steps");
                Err(Error::input("advance", format!("{advance:e} m"), allowed))
            }
            _ if self.shares && self.plan(kind).0 > MAX_STEPS => {
                let allowed = format!("the crossing would take more than {MAX_STEPS} steps");
                Err(Error::input("approach", format!("{:e} m", self.settings.approach), allowed))
            }
            _ => Ok(()),
        }
    }

    /// Refuses a road that repeats on the way at this speed [m/s], where none is given, and contacts that cannot follow it.
    pub(super) fn check_road(&self, kind: usize, speed: f64) -> Result<(), Error> {
        let length = self.analysis.model.shapes.mesh().length();
        for passage in &self.kinds[kind].passages {
            let speed = passage.speed.or((!self.brings_speeds(passage)).then_some(speed));
            let passage = Passage { speed, ..passage.clone() };
            let course = Course::new(&passage, &self.settings, "", 0)?;
            course.check_road(&self.settings, length)?;
            course.check_contact(&self.analysis.model.shapes)?;
            let [from, to] = course.paved(&self.settings, length);
            let path = to - from;
            if let Some((synthesis, _)) = self.own.as_ref().filter(|(own, _)| path > own.period()) {
                let allowed = format!(
                    "it repeats after its period of {} m, and the path is longer; give a longer one",
                    synthesis.period()
                );
                return Err(Error::input("road", format!("path of {path} m"), allowed));
            }
        }
        Ok(())
    }

    /// The vehicles of every kind.
    pub(super) fn vehicles(&self) -> Vec<Vec<&Vehicle>> {
        self.kinds.iter().map(|kind| kind.passages.iter().map(|p| &p.vehicle).collect()).collect()
    }

    /// Where things stand in the rows of a run's results.
    pub fn format(&self, samples: &Samples) -> Format {
        let most = |count: &dyn Fn(&Vehicle) -> usize| {
            let of = self.kinds.iter().map(|k| k.passages.iter().map(|p| count(&p.vehicle)).sum());
            of.max().unwrap_or(0)
        };
        Format {
            responses: self.look.chosen.len(),
            axles: most(&|v| v.assembly().contacts.len()),
            bodies: most(&|v| v.bodies().len()),
            own_statics: !self.shares || samples.varies_loads() || samples.varies(Parameter::BridgeStiffness),
            own_times: !self.shares,
        }
    }

    /// The vehicle of a kind whose samples share the geometry.
    pub fn vehicle(&self, kind: usize) -> &Vehicle {
        &self.kinds[kind].passages[0].vehicle
    }

    /// Steps of a kind that is not refined, and the way of each [m].
    pub fn plan(&self, kind: usize) -> (usize, f64) {
        let model = &self.analysis.model;
        let vehicle = self.vehicle(kind);
        let path = self.settings.approach + model.shapes.mesh().length() + vehicle.wheelbase();
        let longest = self.advance.unwrap_or_else(|| {
            let mut road = self.settings.road.texture(-self.settings.approach, path - self.settings.approach);
            if let Some((own, _)) = &self.own {
                road = road.with(own.texture());
            }
            Fineness::of(&self.settings).way(model.shortest_span, road, vehicle.assembly())
        });
        Steps::in_space(path, longest)
    }

    /// How the axles of a kind move whose step is halved so many times.
    pub fn path(&self, (kind, halvings): March) -> Advance {
        let wheelbase = self.vehicle(kind).wheelbase();
        let length = self.analysis.model.shapes.mesh().length();
        let steps = self.plan(kind).0 << halvings;
        let advance = (self.settings.approach + length + wheelbase) / steps as f64;
        let beyond = usize::from(self.settings.tail != Tail::Fixed(0.0));
        let behind = self.vehicle(kind).assembly().contacts.iter().map(|contact| contact.behind).collect();
        Advance { start: -self.settings.approach, advance, behind, steps, beyond }
    }

    /// Whether a kind is of constant loads on a bridge whose modes they drive each by itself: no step couples them.
    pub fn is_driven(&self, kind: usize) -> bool {
        let model = &self.analysis.model;
        self.vehicle(kind).is_of_forces() && model.damping.rates(&model.omega).is_some()
    }

    /// What is laid out for many samples of a kind.
    pub fn layout(&self, kind: usize, samples: &Samples) -> Layout {
        match self.is_driven(kind) && !samples.varies_loads() {
            true => Layout::Together(self.vehicle(kind).static_loads(self.settings.gravity)),
            false => Layout::Each,
        }
    }

    /// The geometry of a kind whose step is halved so many times.
    pub fn table(&self, march: March, layout: Layout, stop: StopToken<'_>) -> Result<Table, Error> {
        let Analysis { model, rows, .. } = &*self.analysis;
        let (vehicle, length) = (self.vehicle(march.0), model.shapes.mesh().length());
        let pavement = Pavement {
            road: self.settings.road.off(self.settings.road.datum(-self.settings.approach, length)),
            start: -self.settings.approach,
            end: self.settings.road.ends()[1],
            ramp: self.settings.ramp,
            direction: 1.0,
        };
        if self.is_driven(march.0) {
            return Table::new(self.path(march), &model.shapes, (rows, &self.look), Feeling::Nothing, layout, stop);
        }
        let slopes = !vehicle.assembly().contacts.iter().all(|contact| contact.law.is_plain());
        let ground = StudyRoad { pavement: &pavement, own: self.own.as_ref().map(|(own, _)| &**own) };
        let feeling = Feeling::Below(ground, slopes);
        Table::new(self.path(march), &model.shapes, (rows, &self.look), feeling, layout, stop)
    }

    /// How often the step of each sample must be halved: a function of the sample alone. Samples that would take too many
    /// steps are told, in order.
    pub(super) fn marches(&self, samples: &Samples) -> (Vec<March>, Vec<Failure>) {
        let (beta, fineness) = (self.settings.beta, Fineness::of(&self.settings));
        // Squared frequencies of bridge, vehicle and tyres on the bridge, of each kind as it is.
        let model = &self.analysis.model;
        let fastest: Vec<[f64; 3]> =
            (0..self.kinds.len()).map(|kind| model.fastest_parts(std::iter::once(self.vehicle(kind)))).collect();
        let plans: Vec<(usize, f64)> = (0..self.kinds.len()).map(|kind| self.plan(kind)).collect();
        // Leaf springs are the stiffer, the more they rub.
        let builds_up: Vec<bool> = (0..self.kinds.len())
            .map(|kind| {
                let frictions = &self.vehicle(kind).assembly().frictions;
                frictions.iter().any(|element| matches!(element.friction.build_up, BuildUp::Leaf(_)))
            })
            .collect();
        let march = |sample: usize| {
            let kind = samples.kind(sample);
            let [bodies, axles] = [self.vehicle(kind).bodies().len(), self.vehicle(kind).assembly().contacts.len()];
            let extreme = |parameter: Parameter, count: usize, pick: fn(f64, f64) -> f64| {
                let all = (0..count).filter_map(|part| samples.factor(parameter, sample, part));
                all.fold(1.0, pick)
            };
            let tyres = extreme(Parameter::TyreStiffness, axles, f64::max);
            let mut springs = tyres.max(extreme(Parameter::SuspensionStiffness, axles, f64::max));
            if builds_up[kind] {
                springs = springs.max(extreme(Parameter::FrictionLimit, axles, f64::max));
            }
            let inertia =
                extreme(Parameter::BodyMass, bodies, f64::min).min(extreme(Parameter::PitchInertia, bodies, f64::min));
            let [bridge, own, on_bridge] = fastest[kind];
            let stiffness = extreme(Parameter::BridgeStiffness, 1, f64::max);
            let fastest = (bridge * stiffness + own * springs / inertia + on_bridge * tyres).sqrt();
            let [resolved, limit] = fineness.step(fastest, beta, self.is_driven(kind));
            let longest = match (self.settings.step, self.advance) {
                (Some(step), _) => step.min(limit),
                (None, Some(_)) => limit,
                (None, None) => resolved.min(limit),
            };
            let speed = samples.speed(sample, 0);
            let (steps, way) = plans[kind];
            let (times, halvings) = Steps::halved(way, longest * speed);
            let way = way / times;
            let tail = self.settings.tail.seconds().unwrap_or(0.0);
            let count = (steps as f64) * times + tail * speed / way;
            if halvings > MOST_HALVINGS || count > MAX_STEPS as f64 {
                let usual = way > resolved.min(limit) * speed;
                let (key, value) = match self.settings.step {
                    _ if steps as f64 * times < 0.5 * count => ("tail".to_string(), format!("{tail} s")),
                    Some(step) if !usual => ("step".to_string(), format!("{step} s")),
                    _ => match samples.farthest(sample) {
                        Some((name, factor)) => (format!("factors['{name}']"), factor.to_string()),
                        None => (format!("speed[{sample}]"), format!("{speed} m/s")),
                    },
                };
                let allowed = format!("sample {sample} would take more than {MAX_STEPS} steps, or too short ones");
                return Err(Error::input(key, value, allowed));
            }
            Ok((kind, halvings))
        };
        let of_all = samples.alike() && samples.kinds.is_empty();
        let first = (of_all && samples.count > 0).then(|| march(0));
        let mut lost = Vec::new();
        let mut found = |sample: usize| match first.clone().unwrap_or_else(|| march(sample)) {
            Ok(march) => march,
            Err(cause) => {
                lost.push(Failure { sample, step: None, cause });
                (samples.kind(sample), 0)
            }
        };
        let marches = (0..samples.count).map(&mut found).collect();
        (marches, lost)
    }
}
