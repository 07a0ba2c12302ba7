//! What differs from sample to sample: number, kind of event, speed, and factors on vehicle and bridge.

use crate::error::Error;
use crate::vehicle::Vehicle;
use crate::vehicle::body::{Coupling, Friction};

/// What a factor multiplies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Parameter {
    /// Masses of the bodies; loads or masses of a train.
    BodyMass,
    /// Pitch inertias of the bodies.
    PitchInertia,
    /// Tyre stiffnesses.
    TyreStiffness,
    /// Tyre dampings.
    TyreDamping,
    /// Stiffnesses of the suspensions; one factor for all takes the springs between bodies along.
    SuspensionStiffness,
    /// Dampings of the suspensions; one factor for all takes the dampers between bodies along.
    SuspensionDamping,
    /// Friction limits of the suspensions, and with them the friction of the static state.
    FrictionLimit,
    /// No factor but the friction in the static state itself, from −1 to 1 times its limit.
    InitialFriction,
    /// Stiffness of the bridge, its supports included: modes stay, frequencies go with its root, deflections with its
    /// inverse.
    BridgeStiffness,
    /// Damping of the bridge.
    BridgeDamping,
}

impl Parameter {
    /// All of them.
    pub const ALL: [Parameter; 10] = [
        Parameter::BodyMass,
        Parameter::PitchInertia,
        Parameter::TyreStiffness,
        Parameter::TyreDamping,
        Parameter::SuspensionStiffness,
        Parameter::SuspensionDamping,
        Parameter::FrictionLimit,
        Parameter::InitialFriction,
        Parameter::BridgeStiffness,
        Parameter::BridgeDamping,
    ];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Parameter::BodyMass => "body_mass",
            Parameter::PitchInertia => "pitch_inertia",
            Parameter::TyreStiffness => "tyre_stiffness",
            Parameter::TyreDamping => "tyre_damping",
            Parameter::SuspensionStiffness => "suspension_stiffness",
            Parameter::SuspensionDamping => "suspension_damping",
            Parameter::FrictionLimit => "friction_limit",
            Parameter::InitialFriction => "initial_friction",
            Parameter::BridgeStiffness => "bridge_stiffness",
            Parameter::BridgeDamping => "bridge_damping",
        }
    }

    /// The parameter of this name.
    pub fn named(name: &str) -> Result<Self, Error> {
        Parameter::ALL.into_iter().find(|p| p.name() == name).ok_or_else(|| {
            let names: Vec<&str> = Parameter::ALL.iter().map(|p| p.name()).collect();
            Error::input("factors", format!("\"{name}\""), format!("must be one of {}", names.join(", ")))
        })
    }
}

/// Factors on one parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct Factors {
    /// What they multiply.
    pub parameter: Parameter,
    /// Numbers of each sample: one for all bodies or axles, or one for each, front first.
    pub width: usize,
    /// The numbers, sample after sample; or those of one sample, which are then all samples'.
    pub values: Vec<f64>,
}

impl Factors {
    /// Those of a sample.
    #[inline]
    fn of(&self, sample: usize) -> &[f64] {
        if self.values.len() == self.width {
            &self.values
        } else {
            &self.values[sample * self.width..(sample + 1) * self.width]
        }
    }
}

/// The samples of a run, column by column.
#[derive(Debug, Clone, PartialEq)]
pub struct Samples {
    /// Number of the first; the others follow. With the seed it names what is drawn for a sample.
    pub first: u64,
    /// How many.
    pub count: usize,
    /// The kind of event of each; none if all are of the first.
    pub kinds: Vec<u32>,
    /// Speeds [m/s]: of each sample, or of all; of each vehicle, or of all.
    pub speeds: Vec<f64>,
    /// What is varied.
    pub factors: Vec<Factors>,
}

impl Samples {
    /// Samples `first` and following at one speed [m/s].
    pub fn at_speed(first: u64, count: usize, speed: f64) -> Self {
        Samples { first, count, kinds: Vec::new(), speeds: vec![speed], factors: Vec::new() }
    }

    /// Kind of event of a sample.
    pub fn kind(&self, sample: usize) -> usize {
        self.kinds.get(sample).map_or(0, |&kind| kind as usize)
    }

    /// Speed of a vehicle of a sample [m/s].
    pub fn speed(&self, sample: usize, vehicle: usize) -> f64 {
        if self.speeds.len() == 1 {
            return self.speeds[0];
        }
        let width = self.speeds.len() / self.count;
        self.speeds[sample * width + if width == 1 { 0 } else { vehicle }]
    }

    /// The factor of a sample on a part of what the parameter belongs to, if it is varied.
    pub fn factor(&self, parameter: Parameter, sample: usize, part: usize) -> Option<f64> {
        let factors = self.factors.iter().find(|factors| factors.parameter == parameter)?;
        let own = factors.of(sample);
        Some(own[if own.len() == 1 { 0 } else { part }])
    }

    /// The factor of a sample that is farthest from 1, if it is far enough to be what makes its steps too short: 100 times
    /// as stiff or as light.
    pub fn farthest(&self, sample: usize) -> Option<(&'static str, f64)> {
        const FAR: f64 = 100.0;
        let distance = |factor: f64| factor.max(1.0 / factor);
        let all = self.factors.iter().flat_map(|factors| {
            let name = factors.parameter.name();
            factors.of(sample).iter().map(move |&factor| (name, factor))
        });
        let far = all.filter(|&(_, factor)| distance(factor) > FAR);
        far.max_by(|a, b| distance(a.1).total_cmp(&distance(b.1)))
    }

    /// Whether a parameter is varied.
    pub fn varies(&self, parameter: Parameter) -> bool {
        self.factors.iter().any(|factors| factors.parameter == parameter)
    }

    /// Whether static axle loads are varied: by masses, or by springs that share them out.
    pub fn varies_loads(&self) -> bool {
        let shares = [Parameter::BodyMass, Parameter::TyreStiffness, Parameter::SuspensionStiffness];
        shares.into_iter().any(|parameter| self.varies(parameter))
    }

    /// Whether all samples of a kind are alike but for their roads.
    pub fn alike(&self) -> bool {
        self.factors.iter().all(|factors| factors.values.len() == factors.width) && self.speeds.len() == 1
    }

    /// A vehicle as a sample has it; its bodies and axles are counted from these among those of the event.
    pub fn vehicle(&self, vehicle: &Vehicle, sample: usize, [body, axle]: [usize; 2]) -> Result<Vehicle, Error> {
        let factor = |parameter: Parameter, part: usize| self.factor(parameter, sample, part).unwrap_or(1.0);
        let contacts = &vehicle.assembly().contacts;
        if vehicle.bodies().is_empty() {
            let shares = contacts.iter().enumerate();
            let scaled: Vec<f64> = shares.map(|(k, c)| c.share * factor(Parameter::BodyMass, axle + k)).collect();
            return vehicle.with_shares(&scaled);
        }
        let mut bodies = vehicle.bodies().to_vec();
        let rubs = |friction: &mut Friction, limit: f64, initial: Option<f64>| {
            friction.limit *= limit;
            friction.initial = initial.map_or(friction.initial * limit, |part| part * friction.limit);
        };
        // One factor for all axles holds between bodies too.
        let common = |parameter: Parameter| {
            let factors = self.factors.iter().find(|factors| factors.parameter == parameter);
            factors.filter(|factors| factors.width == 1).map(|factors| factors.of(sample)[0])
        };
        for (b, scaled) in bodies.iter_mut().enumerate() {
            scaled.mass *= factor(Parameter::BodyMass, body + b);
            scaled.pitch_inertia *= factor(Parameter::PitchInertia, body + b);
            for coupling in &mut scaled.couplings {
                if let Coupling::Spring { stiffness, damping, friction, .. } = coupling {
                    *stiffness *= common(Parameter::SuspensionStiffness).unwrap_or(1.0);
                    *damping *= common(Parameter::SuspensionDamping).unwrap_or(1.0);
                    let limit = common(Parameter::FrictionLimit).unwrap_or(1.0);
                    rubs(friction, limit, common(Parameter::InitialFriction));
                }
            }
        }
        for (k, (b, i)) in vehicle.axle_order().into_iter().enumerate() {
            let (scaled, part) = (&mut bodies[b].axles[i], axle + k);
            scaled.tyre_stiffness *= factor(Parameter::TyreStiffness, part);
            scaled.tyre_damping *= factor(Parameter::TyreDamping, part);
            scaled.suspension_stiffness *= factor(Parameter::SuspensionStiffness, part);
            scaled.suspension_damping *= factor(Parameter::SuspensionDamping, part);
            let limit = factor(Parameter::FrictionLimit, part);
            rubs(&mut scaled.friction, limit, self.factor(Parameter::InitialFriction, sample, part));
        }
        Vehicle::of_bodies(bodies)
    }
}
