//! The parts of a vehicle as they are given: rigid bodies, axles, what joins them and what rubs.

/// Stiffness of a stick, as a multiple of the spring it is measured by, where none is given.
///
/// High enough that the deformation before sliding is small beside that of the tyre, low enough for a time step.
pub const STICK: f64 = 20.0;

/// An axle: a tyre below a suspension, with an unsprung mass between them or none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Axle {
    /// Distance ahead of the centre of mass of its body [m].
    pub position: f64,
    /// Unsprung mass [kg]; 0 for a massless axle.
    pub mass: f64,
    /// Tyre stiffness [N/m].
    pub tyre_stiffness: f64,
    /// Tyre damping [N s/m].
    pub tyre_damping: f64,
    /// Suspension stiffness [N/m].
    pub suspension_stiffness: f64,
    /// Suspension damping [N s/m].
    pub suspension_damping: f64,
    /// Friction in the suspension. Beside an unsprung mass a rigid build-up becomes elastic, with
    /// [`STICK`] times the tyre stiffness.
    pub friction: Friction,
}

impl Axle {
    /// Massless, without damping and friction.
    pub fn new(position: f64, tyre_stiffness: f64, suspension_stiffness: f64) -> Self {
        Axle {
            position,
            mass: 0.0,
            tyre_stiffness,
            tyre_damping: 0.0,
            suspension_stiffness,
            suspension_damping: 0.0,
            friction: Friction::NONE,
        }
    }
}

/// The two linear states of suspensions with friction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Suspension {
    /// Friction holds: of a massless axle the tyre alone is a spring, elsewhere the stick acts beside the spring.
    Locked,
    /// They slide: springs alone.
    Sliding,
}

/// What joins a body to an earlier one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Coupling {
    /// A fifth wheel, a drawbar, or the pivot of a bogie that equalises its axle loads.
    Hinge {
        /// Index of the earlier body.
        to: usize,
        /// Distance ahead of the centre of mass of that body [m].
        at: f64,
        /// Distance ahead of the centre of mass of the body that has the hinge [m].
        own: f64,
        /// Height above the road [m].
        height: f64,
    },
    /// An upright spring and damper: a secondary suspension.
    Spring {
        /// Index of the earlier body.
        to: usize,
        /// Distance ahead of the centre of mass of that body [m].
        at: f64,
        /// Distance ahead of the centre of mass of the body that has the spring [m].
        own: f64,
        /// Stiffness [N/m].
        stiffness: f64,
        /// Damping [N s/m].
        damping: f64,
        /// Friction beside it. A rigid build-up becomes elastic, with [`STICK`] times the
        /// stiffness of the spring.
        friction: Friction,
    },
}

impl Coupling {
    /// The earlier body, and where it holds on that one and on its own.
    pub fn ends(&self) -> (usize, f64, f64) {
        let (Coupling::Hinge { to, at, own, .. } | Coupling::Spring { to, at, own, .. }) = *self;
        (to, at, own)
    }

    /// Whether it is a hinge.
    pub fn is_hinge(&self) -> bool {
        matches!(self, Coupling::Hinge { .. })
    }
}

/// A rigid body.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    /// Mass [kg].
    pub mass: f64,
    /// Pitch inertia about the centre of mass [kg m²].
    pub pitch_inertia: f64,
    /// Height of the centre of mass above the road [m].
    pub cg_height: f64,
    /// Axles, front first.
    pub axles: Vec<Axle>,
    /// What joins it to earlier bodies: nothing for the first.
    pub couplings: Vec<Coupling>,
}

/// Whether anything acts on a body away from its centre of mass, so that it pitches.
#[cfg(feature = "python")] // which may leave out the inertia of one that does not
pub fn pitches(bodies: &[Body], number: usize) -> bool {
    let own = bodies[number].axles.iter().map(|axle| axle.position);
    let joints = bodies[number].couplings.iter().map(|coupling| coupling.ends().2);
    let all = bodies.iter().flat_map(|body| &body.couplings).map(Coupling::ends);
    let there = all.filter(|&(to, ..)| to == number).map(|(_, at, _)| at);
    own.chain(joints).chain(there).any(|place| place != 0.0)
}

/// Friction between two parts, beside a spring.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Friction {
    /// Force at which it slides [N]; infinite for locked.
    pub limit: f64,
    /// Force in the static state, from −`limit` to `limit` [N].
    pub initial: f64,
    /// How the force builds up before it slides.
    pub build_up: BuildUp,
}

/// How friction builds up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum BuildUp {
    /// At once: Coulomb's law.
    Rigid,
    /// Through an elastic stick [N/m] (Jenkins element).
    Elastic(f64),
    /// Towards the limit within this stroke [m]: a leaf spring (Fancher et al. 1980).
    Leaf(f64),
}

impl Friction {
    /// None.
    pub const NONE: Friction = Friction { limit: 0.0, initial: 0.0, build_up: BuildUp::Rigid };

    /// Coulomb's law with this limit [N], none in the static state.
    pub fn coulomb(limit: f64) -> Self {
        Friction { limit, ..Friction::NONE }
    }

    /// The same beside inertia, where nothing builds up at once: rigid becomes elastic with `STICK` times a stiffness.
    pub(super) fn softened(self, stiffness: f64) -> Self {
        match self.build_up {
            BuildUp::Rigid => Friction { build_up: BuildUp::Elastic(STICK * stiffness), ..self },
            _ => self,
        }
    }

    /// Largest stiffness before it slides [N/m]; a leaf spring's on the way from one limit to the other.
    pub fn stick_stiffness(&self) -> f64 {
        match self.build_up {
            _ if self.limit == 0.0 => 0.0,
            BuildUp::Rigid => f64::INFINITY,
            BuildUp::Elastic(stiffness) => stiffness,
            BuildUp::Leaf(stroke) => 2.0 * self.limit / stroke,
        }
    }
}
