//! A passage worked out: where every axle of the vehicle is at any time, on which road, and when it has left.

use std::ops::Range;

use crate::coordinate::Coordinate;
use crate::error::{Error, finite, not_negative, positive};
use crate::geometry::pavement::Pavement;
use crate::modal_bridge::ModeShapes;
use crate::passage::motion::{Motion, reasonable};
use crate::passage::settings::Settings;
use crate::passage::{Braking, Direction, Drive, Passage};
use crate::road::datum::Datum;
use crate::road::{Road, down_to_mm};
use crate::vehicle::Vehicle;
use crate::vehicle::equations::ContactLaw;

/// A vehicle on its way: what a passage and the settings come to.
pub struct Course<'a> {
    /// The vehicle.
    pub vehicle: &'a Vehicle,
    /// Where it goes.
    pub direction: Direction,
    /// Its lane.
    pub lane: i64,
    /// The road under it.
    pub road: &'a Road,
    /// Its axles among all.
    pub axles: Range<usize>,
    /// Distance of each behind the first [m].
    pub behind: Vec<f64>,
    /// The front axle, from the end of the bridge at which it enters, in time since its entry; if it rolls freely, as it
    /// would at the speed it starts with.
    pub motion: Motion,
    /// When its front axle is at the start of the approach [s].
    pub entry: f64,
    /// Speed at the start [m/s].
    pub speed: f64,
    /// Whether it rolls freely.
    pub rolls: bool,
    /// How it brakes, if it does.
    pub braking: Option<Braking>,
}

impl<'a> Course<'a> {
    /// Checked; `first` is the number of its first axle, and `key` stands before the names of what is refused.
    pub fn new(passage: &'a Passage, settings: &'a Settings, key: &str, first: usize) -> Result<Self, Error> {
        let speed = passage.speed.unwrap_or(settings.speed);
        let drive = passage.drive.as_ref().unwrap_or(&settings.drive);
        not_negative(format!("{key}entry"), passage.entry)?;
        reasonable(format!("{key}speed"), speed, "m/s")?;
        let start = -settings.approach;
        let own = |error: Error| error.within(key);
        let motion = match drive {
            Drive::Speeds { times, speeds } => Motion::through(start, times, speeds).map_err(own)?,
            Drive::Acceleration(a) => {
                Motion::accelerated(start, positive(format!("{key}speed"), speed)?, *a).map_err(own)?
            }
            _ => Motion::steady(start, positive(format!("{key}speed"), speed)?),
        };
        let rolls = matches!(drive, Drive::ConstantTraction | Drive::Braking(_));
        let assembly = passage.vehicle.assembly();
        if rolls && assembly.mass.nrows() == 0 {
            let allowed = "forces and masses without a vehicle move as prescribed: use constant-speed, an acceleration \
                           or a speed history";
            let name = if matches!(drive, Drive::Braking(_)) { "braking" } else { "constant-traction" };
            return Err(Error::input(format!("{key}drive"), format!("\"{name}\""), allowed));
        }
        let braking = match drive {
            Drive::Braking(braking) => {
                positive(format!("{key}braking deceleration"), braking.deceleration)?;
                finite(format!("{key}braking start"), braking.from)?;
                not_negative(format!("{key}braking ramp"), braking.ramp)?;
                positive(format!("{key}braking friction"), braking.adhesion)?;
                Some(*braking)
            }
            _ => None,
        };
        let behind: Vec<f64> = assembly.contacts.iter().map(|contact| contact.behind).collect();
        Ok(Course {
            vehicle: &passage.vehicle,
            direction: passage.direction,
            lane: passage.lane,
            road: passage.road.as_deref().unwrap_or(&settings.road),
            axles: first..first + behind.len(),
            behind,
            speed: motion.at(0.0).v,
            motion,
            entry: passage.entry,
            rolls,
            braking,
        })
    }

    /// From the first to the last axle [m].
    pub fn wheelbase(&self) -> f64 {
        self.behind[self.behind.len() - 1]
    }

    /// An own axle at time t, along the bridge.
    pub fn axle(&self, own: usize, t: f64, length: f64) -> Coordinate<f64> {
        let Coordinate { x, v, a } = self.motion.at(t - self.entry);
        self.along(Coordinate { x: x - self.behind[own], v, a }, length)
    }

    /// An own axle at the speed at the start, along the bridge; the front axle is `front` [m] from the end at which it
    /// enters.
    pub fn steady_axle(&self, own: usize, front: f64, length: f64) -> Coordinate<f64> {
        self.along(Coordinate { x: front - self.behind[own], v: self.speed, a: 0.0 }, length)
    }

    /// Seen from the left end of the bridge.
    fn along(&self, Coordinate { x, v, a }: Coordinate<f64>, length: f64) -> Coordinate<f64> {
        match self.direction {
            Direction::Right => Coordinate { x, v, a },
            Direction::Left => Coordinate { x: length - x, v: -v, a: -a },
        }
    }

    /// The centre of mass at time t, from the end at which the vehicle enters.
    pub fn centre(&self, t: f64) -> Coordinate<f64> {
        let Coordinate { x, v, a } = self.motion.at(t - self.entry);
        Coordinate { x: x - self.vehicle.assembly().contacts[0].position, v, a }
    }

    /// Way of its front axle from the start of the approach until its last axle has left [m].
    pub fn path(&self, settings: &Settings, length: f64) -> f64 {
        settings.approach + length + self.wheelbase()
    }

    /// Whether it keeps its speed from time zero on.
    pub fn is_steady(&self) -> bool {
        !self.rolls && self.entry == 0.0 && self.motion.is_steady()
    }

    /// When it has left the bridge, or stands for good; of one that rolls, an estimate.
    pub fn end(&self, length: f64) -> f64 {
        let exit = self.motion.time_at(length + self.wheelbase());
        self.entry + exit.or(self.motion.stands_from()).unwrap_or(f64::INFINITY)
    }

    /// Refuses what a contact cannot follow: a mass in rigid contact neither a kink of the bridge nor one of the road,
    /// which strike it; a damped tyre no jump of the road.
    pub fn check_contact(&self, shapes: &ModeShapes) -> Result<(), Error> {
        let laws = || self.vehicle.assembly().contacts.iter().map(|contact| contact.law);
        let rigid = laws().any(|law| matches!(law, ContactLaw::Mass(_)));
        let damped = laws().any(|law| !law.is_plain());
        if rigid && shapes.have_kinks() {
            let allowed = "a hinge strikes them as they pass; give them stiff tyres instead";
            return Err(Error::input("vehicle", "masses in rigid contact on a bridge with hinges", allowed));
        }
        let smoothness = self.road.smoothness();
        if rigid && smoothness < 1 {
            let allowed =
                "its kinks or jumps strike them; give its features edges or a contact_patch, or the masses tyres";
            return Err(Error::input("road", "not smooth below masses in rigid contact", allowed));
        }
        if damped && smoothness < 0 {
            let allowed = "a damped tyre cannot follow it; give the step or the edges a contact_patch";
            return Err(Error::input("road", "jumps below damped tyres", allowed));
        }
        Ok(())
    }

    /// Refuses a road that ends before the vehicle has left the bridge.
    pub fn check_road(&self, settings: &Settings, length: f64) -> Result<(), Error> {
        if self.road.is_smooth() {
            return Ok(());
        }
        let [from, to] = self.paved(settings, length);
        let [first, last] = self.road.ends();
        // How much of it there is before the bridge and behind it, as the vehicle comes.
        let (covered, before, behind) = match self.direction {
            Direction::Right => (self.road.check_covers(from, to), -first, last - length),
            Direction::Left => (self.road.check_covers(length - to, length - from), last - length, -first),
        };
        let longest = if settings.ramp > 0.0 && before > 0.0 { before } else { before - self.wheelbase() };
        // Without an approach, or behind the bridge, the road is too short for the vehicle itself.
        let helps = before < -from && behind >= to - length && (0.0..settings.approach).contains(&longest);
        covered.map_err(|error| match helps {
            true => error.advising(&format!(", or approach = {} at most", down_to_mm(longest))),
            false => error,
        })
    }

    /// From where to where the road counts under its axles, from the end at which it enters [m].
    pub fn paved(&self, settings: &Settings, length: f64) -> [f64; 2] {
        // Without a ramp from where the last axle is at the beginning, before the vehicle's entry.
        let first =
            if settings.ramp > 0.0 { -settings.approach } else { self.motion.at(-self.entry).x - self.wheelbase() };
        [first, length + self.wheelbase()]
    }

    /// Where it is after a way from the end at which it enters, seen from the left end of the bridge [m].
    pub fn place(&self, way: f64, length: f64) -> f64 {
        if self.direction == Direction::Right { way } else { length - way }
    }

    /// How far a place [m] is from the end of the bridge at which it enters.
    pub fn way(&self, x: f64, length: f64) -> f64 {
        if self.direction == Direction::Right { x } else { length - x }
    }

    /// The line from which it feels its road: see [`Road::datum`].
    pub fn datum(&self, settings: &Settings, length: f64) -> Datum {
        self.road.datum(self.place(-settings.approach, length), self.place(length, length))
    }

    /// How much lower than that line the one is from which motion is told, at the end at which the vehicle enters, and how
    /// much more per way. A vehicle feels a measured road from the line of the first 10 m of its way, which leads off the
    /// road in the end: its motion is told from the line of the whole way instead.
    #[cfg(feature = "python")] // which shows it
    pub fn drift(&self, settings: &Settings, length: f64) -> [f64; 2] {
        let [near, far] = self.road.drift(self.place(-settings.approach, length), self.place(length, length));
        let steeper = (far - near) / (settings.approach + length);
        [near + steeper * settings.approach, steeper]
    }

    /// How much that line rises per way [-].
    pub fn grade(&self, settings: &Settings, length: f64) -> f64 {
        self.direction.sign() * self.datum(settings, length).slope
    }

    /// The road on its way, if that is uneven. It goes on in the tail; where what was measured ends, at the last elevation.
    pub fn pavement(&self, settings: &Settings, length: f64) -> Option<Pavement> {
        let place = |way: f64| self.place(way, length);
        (!self.road.is_smooth()).then(|| Pavement {
            road: self.road.off(self.datum(settings, length)),
            start: place(-settings.approach),
            end: self.road.ends()[usize::from(self.direction == Direction::Right)],
            ramp: settings.ramp,
            direction: self.direction.sign(),
        })
    }
}
