//! The vehicle of KTN73 Fig. 2: a rigid body on massless axles, each a tyre in series with a suspension that rubs.

use nalgebra::{Matrix2, SymmetricEigen, Vector2};

use crate::error::{Error, finite, not_negative, positive};

/// A massless axle: tyre spring in series with a suspension spring that Coulomb friction bridges.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Axle {
    /// Distance ahead of the centre of mass [m].
    pub position: f64,
    /// Tyre stiffness [N/m].
    pub tyre_stiffness: f64,
    /// Suspension stiffness [N/m].
    pub suspension_stiffness: f64,
    /// Friction force at which the suspension slides [N]; infinite for a locked suspension.
    pub friction_limit: f64,
    /// Friction force in the static state, from −`friction_limit` to +`friction_limit` [N].
    pub initial_friction: f64,
}

impl Axle {
    /// Stiffness between road and body while the suspension slides: both springs in series [N/m].
    pub fn sliding_stiffness(&self) -> f64 {
        let (t, s) = (self.tyre_stiffness, self.suspension_stiffness);
        t * s / (t + s)
    }

    /// Stiffness between road and body as long as the friction holds or, with none, always [N/m].
    pub fn stiffness(&self, suspension: Suspension) -> f64 {
        match suspension {
            Suspension::Locked => self.tyre_stiffness,
            Suspension::Sliding => self.sliding_stiffness(),
        }
    }
}

/// The two linear states of a suspension with friction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Suspension {
    /// Friction holds it: the tyre alone is a spring.
    Locked,
    /// It slides: tyre and suspension in series.
    Sliding,
}

/// A rigid body on its axles.
#[derive(Debug, Clone, PartialEq)]
pub struct Vehicle {
    mass: f64,
    pitch_inertia: f64,
    cg_height: f64,
    axles: Vec<Axle>,
}

impl Vehicle {
    /// Body `mass` [kg], pitch inertia about the centre of mass [kg m²], its height above the road [m], and the axles,
    /// front first. A vehicle of one axle stands with its centre of mass above it.
    pub fn new(mass: f64, pitch_inertia: f64, cg_height: f64, axles: Vec<Axle>) -> Result<Self, Error> {
        positive("vehicle mass", mass)?;
        positive("pitch_inertia", pitch_inertia)?;
        not_negative("cg_height", cg_height)?;
        if axles.is_empty() {
            return Err(Error::input("axles", "[]", "a vehicle needs at least one axle"));
        }
        for (k, axle) in axles.iter().enumerate() {
            let key = |name: &str| format!("axles[{k}].{name}");
            finite(key("position"), axle.position)?;
            positive(key("tyre_stiffness"), axle.tyre_stiffness)?;
            positive(key("suspension_stiffness"), axle.suspension_stiffness)?;
            if axle.friction_limit.is_nan() || axle.friction_limit < 0.0 {
                let allowed = "must be 0 or more (inf for a locked suspension)";
                return Err(Error::input(key("friction_limit"), axle.friction_limit, allowed));
            }
            finite(key("initial_friction"), axle.initial_friction)?;
            if axle.initial_friction.abs() > axle.friction_limit {
                let allowed = match axle.friction_limit {
                    0.0 => "must be 0 where friction_limit is 0".to_string(),
                    limit => format!("must lie within the friction limit, -{limit} to {limit} N"),
                };
                return Err(Error::input(key("initial_friction"), format!("{} N", axle.initial_friction), allowed));
            }
            if k > 0 && axle.position >= axles[k - 1].position {
                return Err(Error::input(
                    key("position"),
                    format!("{} m", axle.position),
                    format!("axles go from front to rear: must be less than {} m", axles[k - 1].position),
                ));
            }
        }
        let vehicle = Vehicle { mass, pitch_inertia, cg_height, axles };
        for (k, share) in vehicle.load_shares()?.into_iter().enumerate() {
            if !(share.is_finite() && share > 0.0) {
                return Err(Error::input(
                    format!("axles[{k}].position"),
                    format!("{} m", vehicle.axles[k].position),
                    "this axle would carry no load: the centre of mass must lie between the axles",
                ));
            }
        }
        Ok(vehicle)
    }

    /// Body mass [kg].
    pub fn mass(&self) -> f64 {
        self.mass
    }

    /// Pitch inertia about the centre of mass [kg m²].
    pub fn pitch_inertia(&self) -> f64 {
        self.pitch_inertia
    }

    /// Height of the centre of mass above the road [m].
    pub fn cg_height(&self) -> f64 {
        self.cg_height
    }

    /// Axles, front first.
    pub fn axles(&self) -> &[Axle] {
        &self.axles
    }

    /// Distance from the first to the last axle [m].
    pub fn wheelbase(&self) -> f64 {
        self.axles[0].position - self.axles[self.axles.len() - 1].position
    }

    /// Static axle loads [N] under gravity g [m/s²].
    pub fn static_loads(&self, gravity: f64) -> Vec<f64> {
        // `new` has refused every vehicle whose shares cannot be found.
        let shares = self.load_shares().unwrap_or_default();
        shares.into_iter().map(|share| share * self.mass * gravity).collect()
    }

    /// Natural frequencies on rigid ground with every suspension in the given state [Hz], ascending.
    ///
    /// Bounce and pitch; of a single axle bounce alone.
    pub fn frequencies(&self, suspension: Suspension) -> Vec<f64> {
        let stiffness = self.stiffness_matrix(suspension);
        let root = Vector2::new(self.mass, self.pitch_inertia).map(|m| 1.0 / m.sqrt());
        let scaled = Matrix2::from_fn(|i, j| root[i] * stiffness[(i, j)] * root[j]);
        // A bound on the iterations, because stiffnesses that overflow would keep it going.
        let eigen = SymmetricEigen::try_new(scaled, f64::EPSILON, 100);
        let mut values: Vec<f64> = eigen.map_or(vec![f64::NAN; 2], |e| e.eigenvalues.iter().copied().collect());
        values.sort_by(f64::total_cmp);
        let skip = usize::from(self.axles.len() == 1);
        values[skip..].iter().map(|v| v.max(0.0).sqrt() / std::f64::consts::TAU).collect()
    }

    /// Stiffness for bounce and pitch: Σ k [1, a; a, a²].
    fn stiffness_matrix(&self, suspension: Suspension) -> Matrix2<f64> {
        self.axles
            .iter()
            .map(|axle| {
                let a = Vector2::new(1.0, axle.position);
                a * a.transpose() * axle.stiffness(suspension)
            })
            .sum()
    }

    /// Shares of the weight: the lever rule for two axles; for more, as springs without friction under a rigid body.
    fn load_shares(&self) -> Result<Vec<f64>, Error> {
        if let [axle] = self.axles[..] {
            return if axle.position == 0.0 {
                Ok(vec![1.0])
            } else {
                let allowed = "must be 0: a vehicle of one axle has its centre of mass above it";
                Err(Error::input("axles[0].position", format!("{} m", axle.position), allowed))
            };
        }
        let lever = self.stiffness_matrix(Suspension::Sliding).lu().solve(&Vector2::new(1.0, 0.0));
        let sink = lever.ok_or_else(|| Error::input("axles", self.axles.len(), "their positions must differ"))?;
        Ok(self.axles.iter().map(|axle| axle.sliding_stiffness() * (sink[0] + axle.position * sink[1])).collect())
    }
}
