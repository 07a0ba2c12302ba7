//! Refuses samples that cannot be: columns that do not fit the kinds of event, and values outside of what is allowed.

use super::sample::{Factors, Parameter, Samples};
use crate::damping::ModalDamping;
use crate::error::{Error, not_negative, positive};
use crate::passage::motion::reasonable;
use crate::vehicle::Vehicle;
use crate::vehicle::equations::ContactLaw;

/// What numbers on a parameter are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Numbers {
    /// Factors on what there is.
    Factors,
    /// What is to be there instead.
    Values,
}

impl Numbers {
    fn name(self) -> &'static str {
        match self {
            Numbers::Factors => "factors",
            Numbers::Values => "values",
        }
    }

    fn check(self, parameter: Parameter, value: f64) -> Result<f64, Error> {
        match (parameter, self) {
            // Limits are those of the axles, which tell what it can be.
            (Parameter::InitialFriction, Numbers::Values) => Ok(value),
            (Parameter::InitialFriction, Numbers::Factors) if (-1.0..=1.0).contains(&value) => Ok(value),
            (Parameter::InitialFriction, Numbers::Factors) => {
                Err(Error::input("", value, "must be from -1 to 1, in friction limits"))
            }
            (
                Parameter::TyreDamping
                | Parameter::SuspensionDamping
                | Parameter::FrictionLimit
                | Parameter::BridgeDamping,
                _,
            ) => not_negative("", value),
            _ => positive("", value),
        }
    }
}

impl Parameter {
    fn is_of_bridge(self) -> bool {
        matches!(self, Parameter::BridgeStiffness | Parameter::BridgeDamping)
    }

    fn is_of_bodies(self) -> bool {
        matches!(self, Parameter::BodyMass | Parameter::PitchInertia)
    }
}

impl Samples {
    /// Refuses columns that do not fit each other or the kinds of event, each with its vehicles, and values that cannot
    /// be.
    pub fn check(&self, kinds: &[Vec<&Vehicle>]) -> Result<(), Error> {
        let count = self.count;
        if !self.kinds.is_empty() && self.kinds.len() != count {
            let allowed = format!("must be one for each of the {count} samples");
            return Err(Error::input("kind", format!("{} numbers", self.kinds.len()), allowed));
        }
        if let Some((i, kind)) = self.kinds.iter().enumerate().find(|&(_, &kind)| kind as usize >= kinds.len()) {
            let allowed = format!("must be from 0 to {}", kinds.len() - 1);
            return Err(Error::input(format!("kind[{i}]"), kind, allowed));
        }
        let most = kinds.iter().map(Vec::len).max().unwrap_or(1);
        if ![1, count, count * most].contains(&self.speeds.len()) {
            let allowed = format!("must be one for all, or one for each of the {count} samples");
            return Err(Error::input("speed", format!("{} values", self.speeds.len()), allowed));
        }
        let width = if self.speeds.len() == 1 { 1 } else { self.speeds.len() / count };
        let speed = |speed: f64| reasonable("", positive("", speed)?, "m/s");
        all(&self.speeds, width, speed).map_err(|error| error.within("speed"))?;
        self.factors.iter().try_for_each(|factors| factors.check(Numbers::Factors, count, kinds))
    }

    /// Refuses factors that bring the damping of the bridge to its critical value.
    pub fn check_damping(&self, damping: &ModalDamping) -> Result<(), Error> {
        let ModalDamping::Classical(ratios) = damping else { return Ok(()) };
        let most = ratios.iter().copied().fold(0.0, f64::max);
        let of_damping = self.factors.iter().filter(|factors| factors.parameter == Parameter::BridgeDamping);
        for Factors { parameter, width, values } in of_damping {
            if let Some(i) = values.iter().position(|factor| factor * most >= 1.0) {
                let which = match values.len() {
                    1 => "every sample".to_string(),
                    _ => format!("sample {}", self.first + (i / width) as u64),
                };
                let key = format!("factors['{}']{}", parameter.name(), place(i, values.len(), *width));
                let reached = values[i] * most;
                let allowed = format!("makes of damping = {most} in {which} {reached} of critical; must stay below 1");
                return Err(Error::input(key, values[i], allowed));
            }
        }
        Ok(())
    }
}

impl Factors {
    /// Refuses numbers of so many samples by these kinds of event that cannot be.
    pub fn check(&self, numbers: Numbers, count: usize, kinds: &[Vec<&Vehicle>]) -> Result<(), Error> {
        let Factors { parameter, width, values } = self;
        let key = format!("{}['{}']", numbers.name(), parameter.name());
        for (number, vehicles) in kinds.iter().enumerate() {
            let kind = || if kinds.len() == 1 { "the event".to_string() } else { format!("kind {number}") };
            self.check_kind(&key, numbers, vehicles, kind)?;
        }
        if values.len() != *width && values.len() != count * width {
            let allowed = format!("must be one for all, or one for each of the {count} samples");
            return Err(Error::input(key, format!("{} values", values.len()), allowed));
        }
        all(values, *width, |value| numbers.check(*parameter, value)).map_err(|error| error.within(&key))
    }

    /// Refuses numbers on what the vehicles of an event do not have, or have another number of.
    fn check_kind(
        &self,
        key: &str,
        numbers: Numbers,
        vehicles: &[&Vehicle],
        kind: impl Fn() -> String,
    ) -> Result<(), Error> {
        let Factors { parameter, width, .. } = self;
        let refused = |allowed: String| Err(Error::input(key, format!("{width} {} a sample", numbers.name()), allowed));
        let unknown = |allowed: String| Err(Error::input(numbers.name(), format!("\"{}\"", parameter.name()), allowed));
        if parameter.is_of_bridge() {
            return match width {
                1 => Ok(()),
                _ => refused("must be one for each sample, for there is one bridge".into()),
            };
        }
        let trains = vehicles.iter().filter(|vehicle| vehicle.bodies().is_empty()).count();
        let mixed = trains > 0 && trains < vehicles.len();
        // What all are to have comes to other factors for each.
        if parameter.is_of_bodies() && mixed && (*width > 1 || numbers == Numbers::Values) {
            let why = "vehicles and trains in one event have no common parts";
            return refused(format!("{why}; give factors, one for each sample"));
        }
        for vehicle in vehicles {
            if vehicle.bodies().is_empty() && *parameter != Parameter::BodyMass {
                let what = match vehicle.assembly().contacts[0].law {
                    ContactLaw::Force => "forces",
                    _ => "masses",
                };
                return unknown(format!("a train of {what} has no such thing, only body_mass"));
            }
            let locked = vehicle.axles().iter().any(|axle| axle.friction.limit.is_infinite());
            if locked && matches!(parameter, Parameter::FrictionLimit | Parameter::InitialFriction) {
                return unknown("not with locked suspensions, whose friction has no limit".into());
            }
        }
        let of_bodies = parameter.is_of_bodies() && trains == 0;
        let parts: usize = match of_bodies {
            true => vehicles.iter().map(|vehicle| vehicle.bodies().len()).sum(),
            false => vehicles.iter().map(|vehicle| vehicle.assembly().contacts.len()).sum(),
        };
        let [one, many] = if of_bodies { ["body", "bodies"] } else { ["axle", "axles"] };
        match parts {
            _ if *width == 1 || *width == parts => Ok(()),
            1 => refused(format!("must be one for each sample, for {} has one {one}", kind())),
            _ => refused(format!("must be one for each sample, or one for each of the {parts} {many} of {}", kind())),
        }
    }
}

/// Checks numbers of samples, and names the place of the first that is refused.
fn all(values: &[f64], width: usize, check: impl Fn(f64) -> Result<f64, Error>) -> Result<(), Error> {
    let checked = values.iter().enumerate();
    checked
        .map(|(i, &value)| check(value).map_err(|error| error.within(&place(i, values.len(), width))))
        .try_for_each(|checked| checked.map(drop))
}

/// Where one of so many numbers stands, of which each sample has `width`; nothing if there is but one.
fn place(i: usize, count: usize, width: usize) -> String {
    match (count, width) {
        (1, _) => String::new(),
        (_, 1) => format!("[{i}]"),
        _ => format!("[{}, {}]", i / width, i % width),
    }
}
