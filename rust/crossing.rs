//! One crossing: from the front axle at the start of the approach until the last axle has left and the tail is over.

use faer::{Mat, Side};

use crate::bridge::Bridge;
use crate::error::{Error, finite, not_negative, positive};
use crate::flexibility::Flexibility;
use crate::history::History;
use crate::line::Line;
use crate::modes::Modes;
use crate::path::{ModeShapes, Prescribed, Rolling};
use crate::step::{Body, Geometry, ModalDamping, Stepper, Unsettled};
use crate::vehicle::{Suspension, Vehicle};

/// Most steps of one crossing: a mistyped step or speed is told before it takes all memory.
pub const MAX_STEPS: usize = 2_000_000;

/// Most memory that the states of one crossing may take [bytes].
const MAX_HISTORY_BYTES: f64 = 4e9;

/// Steps to the shortest coupled period unless the user gives a step.
const STEPS_PER_PERIOD: f64 = 20.0;

/// Steps to the narrowest panel unless the user gives a step.
const STEPS_PER_PANEL: f64 = 100.0;

/// Steps between two questions whether to go on.
const POLL_EVERY: usize = 1024;

/// How the vehicle moves along the bridge.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Drive {
    /// At the given speed throughout.
    ConstantSpeed,
    /// Traction and resistance in balance on the level: the speed follows the slope under the axles (KTN73 §4).
    ConstantTraction,
}

/// Viscous damping of the bridge.
#[derive(Debug, Clone, PartialEq)]
pub enum Damping {
    /// Ratio to critical, one for all modes or one for each.
    Ratios(Vec<f64>),
    /// C = αM + βK, for α [1/s] and β [s]: the ratio of a mode is α/2ω + βω/2.
    Rayleigh {
        /// α [1/s].
        mass: f64,
        /// β [s].
        stiffness: f64,
    },
    /// C at the mass stations [N s/m]: D = ΦᵀCΦ is full in general.
    Viscous(Mat<f64>),
}

impl Damping {
    /// Checked against the bridge, and projected on the included modes.
    pub fn modal(&self, modes: &Modes) -> Result<ModalDamping, Error> {
        match self {
            Damping::Ratios(ratios) => {
                if ratios.len() != 1 && ratios.len() != modes.len() {
                    let allowed = format!("give one ratio, or one for each of the {} modes", modes.len());
                    return Err(Error::input("damping", format!("{} values", ratios.len()), allowed));
                }
                for &ratio in ratios {
                    if !(ratio.is_finite() && (0.0..1.0).contains(&ratio)) {
                        return Err(Error::input("damping", ratio, "must be a ratio to critical, from 0 to below 1"));
                    }
                }
                let all = (0..modes.len()).map(|m| if ratios.len() == 1 { ratios[0] } else { ratios[m] });
                Ok(ModalDamping::Classical(all.collect()))
            }
            Damping::Rayleigh { mass, stiffness } => {
                not_negative("damping alpha", *mass)?;
                not_negative("damping beta", *stiffness)?;
                let ratios: Vec<f64> = modes.omega.iter().map(|w| 0.5 * (mass / w + stiffness * w)).collect();
                if let Some(m) = ratios.iter().position(|ratio| *ratio >= 1.0) {
                    let allowed = "Rayleigh damping must stay below critical in every included mode";
                    return Err(Error::input(
                        "damping",
                        format!("{} of critical in mode {}", ratios[m], m + 1),
                        allowed,
                    ));
                }
                Ok(ModalDamping::Classical(ratios))
            }
            Damping::Viscous(c) => {
                let n = modes.shapes.nrows();
                if c.nrows() != n || c.ncols() != n {
                    let allowed = format!("C must be square with a row for each of the {n} moving masses");
                    return Err(Error::input("damping", format!("{} x {} matrix", c.nrows(), c.ncols()), allowed));
                }
                let mut largest = 0.0_f64;
                for value in (0..n).flat_map(|j| c.col(j).iter()) {
                    largest = largest.max(finite("damping", *value)?.abs());
                }
                let near = 1e-9 * largest;
                if (0..n).any(|i| (0..i).any(|j| (c[(i, j)] - c[(j, i)]).abs() > near)) {
                    return Err(Error::input("damping", "unsymmetric C", "C must be symmetric"));
                }
                let lowest = c.self_adjoint_eigenvalues(Side::Lower).map_err(|e| Error::Modes(format!("{e:?}")))?[0];
                if lowest < -near {
                    let value = format!("C with the negative eigenvalue {lowest:.3e} N s/m");
                    return Err(Error::input("damping", value, "C must not feed energy in: no negative eigenvalue"));
                }
                Ok(ModalDamping::Coupled(modes.shapes.transpose() * c * &modes.shapes))
            }
        }
    }
}

/// The bridge in modal coordinates, ready to be crossed.
#[derive(Debug, Clone)]
pub struct ModalBridge {
    /// Natural circular frequencies of the included modes [rad/s].
    pub omega: Vec<f64>,
    /// The included modes along the bridge.
    pub shapes: ModeShapes,
    /// Their damping.
    pub damping: ModalDamping,
    /// Narrowest distance between neighbouring stations, supports and ends [m].
    pub narrowest_panel: f64,
}

impl ModalBridge {
    /// From the modes of `bridge` and their `lines` on the mesh of `flexibility`.
    pub fn new(
        bridge: &Bridge,
        flexibility: &Flexibility,
        modes: &Modes,
        lines: &[Line],
        damping: &Damping,
    ) -> Result<Self, Error> {
        let mut points: Vec<f64> = bridge.span_bounds().to_vec();
        points.extend(bridge.stations().iter().map(|s| s.at));
        points.sort_by(f64::total_cmp);
        let near = crate::bridge::COINCIDENT * bridge.length();
        let widths = points.windows(2).map(|p| p[1] - p[0]).filter(|&w| w > near);
        Ok(ModalBridge {
            omega: modes.omega.clone(),
            shapes: ModeShapes::new(flexibility.mesh(), lines),
            damping: damping.modal(modes)?,
            narrowest_panel: widths.fold(bridge.length(), f64::min),
        })
    }

    /// Upper bound of the fastest circular frequency of bridge and vehicle together, suspensions locked [rad/s].
    pub fn fastest_frequency(&self, vehicle: &Vehicle) -> f64 {
        // The stiffness is that of the bridge plus that of the contact springs, whose largest eigenvalue is at most the
        // vehicle's own plus the sum of k φ² (Weyl's inequality, and the trace).
        let bridge = self.omega.iter().copied().fold(0.0, f64::max);
        let own = vehicle.frequencies(Suspension::Locked).into_iter().fold(0.0, f64::max) * std::f64::consts::TAU;
        let tyres: f64 = vehicle.axles().iter().map(|axle| axle.tyre_stiffness).sum();
        (bridge.powi(2) + own.powi(2) + tyres * self.shapes.largest_sum_of_squares()).sqrt()
    }
}

/// How a vehicle crosses.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// Speed at the start [m/s].
    pub speed: f64,
    /// How the vehicle moves.
    pub drive: Drive,
    /// Newmark's β, from 1/12 to 1/2 [-].
    pub beta: f64,
    /// Longest time step [s]; shortened so that a whole number of steps spans the crossing. By default a twentieth of the
    /// shortest coupled period or a hundredth of the narrowest panel, whichever takes less time.
    pub step: Option<f64>,
    /// Rigid approach in front of the bridge [m].
    pub approach: f64,
    /// Free vibration kept after the last axle has left [s].
    pub tail: f64,
    /// Gravity [m/s²].
    pub gravity: f64,
}

impl Settings {
    /// Defaults for a given speed [m/s].
    pub fn at_speed(speed: f64) -> Self {
        Settings {
            speed,
            drive: Drive::ConstantSpeed,
            beta: 1.0 / 6.0,
            step: None,
            approach: 0.0,
            tail: 0.0,
            gravity: 9.806_65,
        }
    }

    fn check(&self) -> Result<(), Error> {
        positive("speed", self.speed)?;
        not_negative("approach", self.approach)?;
        not_negative("tail", self.tail)?;
        positive("gravity", self.gravity)?;
        if let Some(step) = self.step {
            positive("step", step)?;
        }
        if !(self.beta >= 1.0 / 12.0 && self.beta <= 0.5) {
            return Err(Error::input(
                "beta",
                self.beta,
                "must be from 1/12 to 1/2 (1/6 linear, 1/4 average acceleration)",
            ));
        }
        Ok(())
    }

    /// Way of the front axle until the last axle leaves the bridge [m].
    fn path(&self, model: &ModalBridge, vehicle: &Vehicle) -> f64 {
        self.approach + model.shapes.mesh().length() + vehicle.wheelbase()
    }

    /// Where the centre of mass starts, from the left end of the bridge [m].
    fn start(&self, vehicle: &Vehicle) -> f64 {
        -self.approach - vehicle.axles()[0].position
    }

    /// Time step and number of steps for a path of this length [m], without the tail.
    fn steps(&self, model: &ModalBridge, vehicle: &Vehicle, path: f64) -> Result<(f64, usize), Error> {
        let fastest = model.fastest_frequency(vehicle);
        let limit = if self.beta < 0.25 { 1.0 / (fastest * (0.25 - self.beta).sqrt()) } else { f64::INFINITY };
        let resolved = std::f64::consts::TAU / fastest / STEPS_PER_PERIOD;
        let longest = self.step.unwrap_or(resolved.min(model.narrowest_panel / STEPS_PER_PANEL / self.speed));
        if longest > limit {
            let frequency = fastest / std::f64::consts::TAU;
            return Err(Error::StepTooLong { step: longest, beta: self.beta, limit, frequency });
        }
        // A path of a whole number of steps is not given one more because of rounding.
        let count = (path / (self.speed * longest) - 1e-9).ceil().max(1.0);
        let steps = count + self.tail / longest;
        if steps > MAX_STEPS as f64 {
            let (key, value) = match self.step {
                _ if self.tail / longest > 0.5 * steps => ("tail", format!("{:e} s", self.tail)),
                _ if self.approach > 0.5 * path => ("approach", format!("{:e} m", self.approach)),
                Some(step) => ("step", format!("{step:e} s")),
                None => ("speed", format!("{:e} m/s", self.speed)),
            };
            let mut allowed = format!("the crossing would take {steps:.3e} steps, at most {MAX_STEPS} are allowed");
            if self.step.is_none() {
                allowed += &format!(
                    " (the default step is {longest:.3e} s, for a narrowest panel of {:.3e} m and a shortest period of \
                     {:.3e} s; give step to choose another)",
                    model.narrowest_panel,
                    std::f64::consts::TAU / fastest
                );
            }
            return Err(Error::input(key, value, allowed));
        }
        // Rows of the history, of the same made ready for recovery, and of the table of mode shapes under the axles.
        let (modes, axles) = (model.omega.len(), vehicle.axles().len());
        let bytes = steps * (size_of::<f64>() * (10 + 5 * modes + 8 * axles + modes * axles)) as f64;
        if bytes > MAX_HISTORY_BYTES {
            let allowed = format!(
                "{steps:.3e} steps would take {:.1} GB of memory, more than {:.1}: use fewer modes or a longer step",
                bytes / 1e9,
                MAX_HISTORY_BYTES / 1e9
            );
            return Err(Error::input("modes", modes, allowed));
        }
        Ok((path / (self.speed * count), count as usize))
    }
}

/// Crosses the bridge once. `go_on` is asked now and then; when it says no, the crossing ends as interrupted.
pub fn cross(
    model: &ModalBridge,
    vehicle: &Vehicle,
    settings: &Settings,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<History, Error> {
    settings.check()?;
    let path = settings.path(model, vehicle);
    let (h, steps) = settings.steps(model, vehicle, path)?;
    match settings.drive {
        Drive::ConstantSpeed => {
            let front = vehicle.axles()[0].position;
            let behind = vehicle.axles().iter().map(|axle| front - axle.position).collect();
            // One more than needed, so that rounding of the tail does not matter.
            let with_tail = steps + (settings.tail / h).ceil() as usize + 1;
            let advance = path / steps as f64;
            let geometry = Prescribed::new(&model.shapes, behind, -settings.approach, advance, with_tail);
            march(model, vehicle, settings, h, geometry, go_on)
        }
        Drive::ConstantTraction => {
            let arms = vehicle.axles().iter().map(|axle| axle.position).collect();
            let geometry = Rolling::new(&model.shapes, arms, vehicle.cg_height(), settings.start(vehicle));
            march(model, vehicle, settings, h, geometry, go_on)
        }
    }
}

fn march(
    model: &ModalBridge,
    vehicle: &Vehicle,
    settings: &Settings,
    h: f64,
    mut geometry: impl Geometry<f64>,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<History, Error> {
    let path = settings.path(model, vehicle);
    let rolling = settings.drive == Drive::ConstantTraction;
    let body = Body::new(vehicle, settings.gravity);
    let mut stepper = Stepper::new(&model.omega, &model.damping, body, rolling, h, settings.beta);
    let mut state = stepper.start(settings.start(vehicle), settings.speed, &geometry);

    let static_loads = vehicle.static_loads(settings.gravity);
    let axles = static_loads.len();
    let length = model.shapes.mesh().length();
    let mut history = History { axles, modes: model.omega.len(), step: h, static_loads, ..History::default() };
    history.reserve(((path / settings.speed + settings.tail) / h) as usize + 16);
    history.record(0.0, &state, &geometry);
    let mut left_at = None;
    for n in 1.. {
        let time = n as f64 * h;
        let front = geometry.position(0);
        stepper.advance(&mut state, &mut geometry).map_err(|unsettled| {
            let what = match unsettled {
                Unsettled::ContactForces => "contact forces",
                Unsettled::AxlePositions => "axle positions",
            };
            Error::NoConvergence { what, time, position: front }
        })?;
        let position = geometry.position(0);
        let accelerations = state.modes.iter().fold(state.heave.a + state.pitch.a, |sum, c| sum + c.a);
        if !accelerations.is_finite() || !position.is_finite() {
            return Err(Error::NotFinite { time, position: front });
        }
        if rolling && state.travel.v <= 0.0 {
            return Err(Error::Stopped { time, position });
        }
        history.record(time, &state, &geometry);

        let last = geometry.position(axles - 1);
        if left_at.is_none() && last >= length - 1e-12 * path {
            let before = history.positions[history.positions.len() - axles - 1];
            left_at = Some(time - h * ((last - length) / (last - before)).max(0.0));
        }
        if let Some(left) = left_at {
            let end = left + settings.tail;
            if time >= end - 1e-9 * h {
                if time > end + 1e-9 * h {
                    history.shorten_last(1.0 - (time - end) / h);
                }
                return Ok(history);
            }
        }
        if n > 2 * MAX_STEPS {
            return Err(Error::Stopped { time, position });
        }
        if n % POLL_EVERY == 0 && !go_on() {
            return Err(Error::Interrupted);
        }
    }
    unreachable!("the loop over steps has no end")
}
