//! A vehicle in independent coordinates: the matrices, contacts and friction elements that the time step works with.
//!
//! Coordinates q are counted from the static state, displacements down and rotations nose down. Without contact forces
//! and friction M q̈ + C q̇ + K q = 0; every contact and friction force enters through its row.

use nalgebra::{DMatrix, DVector};

/// A vehicle as the time step sees it.
#[derive(Debug, Clone, PartialEq)]
pub struct Assembly {
    /// What each coordinate is, such as "body 1 heave", "axle 3 hop".
    pub coordinates: Vec<String>,
    /// Mass matrix [kg, kg m, kg m²], positive definite.
    pub mass: DMatrix<f64>,
    /// Damping matrix of the linear dampers between bodies and axles, tyres left out.
    pub damping: DMatrix<f64>,
    /// Stiffness matrix of the linear springs between bodies and axles, tyres left out.
    pub stiffness: DMatrix<f64>,
    /// Points that press on the road, front first.
    pub contacts: Vec<ContactPoint>,
    /// Friction between bodies and axles, apart from that of massless axles.
    pub frictions: Vec<FrictionElement>,
    /// Total mass [kg].
    pub total_mass: f64,
}

/// A wheel line on the road.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactPoint {
    /// Shortening of what presses on the road, d = row·q − w + r [m].
    pub row: DVector<f64>,
    /// Distance ahead of the vehicle's centre of mass in the static state [m].
    pub position: f64,
    /// How the contact moves along the road as the vehicle pitches: x = X + position + surge_row·q, X the centre of mass
    /// of the whole vehicle. Of one rigid body −h in pitch.
    pub surge_row: DVector<f64>,
    /// Static load for a gravity of one [kg].
    pub share: f64,
    /// How the force follows from the shortening.
    pub law: ContactLaw,
}

/// How a contact force follows from the shortening d and its rate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ContactLaw {
    /// A tyre below a mass that is part of M.
    Tyre {
        /// Stiffness [N/m].
        stiffness: f64,
        /// Damping [N s/m].
        damping: f64,
    },
    /// A massless axle: a tyre in series with a suspension.
    Series {
        /// Tyre stiffness [N/m].
        tyre_stiffness: f64,
        /// Tyre damping [N s/m].
        tyre_damping: f64,
        /// Suspension stiffness [N/m].
        suspension_stiffness: f64,
        /// Suspension damping [N s/m].
        suspension_damping: f64,
        /// Friction in the suspension.
        friction: Friction,
    },
    /// A mass [kg] in rigid contact with the road.
    Mass(f64),
    /// A constant force.
    Force,
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

/// A friction element between two parts of the vehicle.
#[derive(Debug, Clone, PartialEq)]
pub struct FrictionElement {
    /// Shortening s = row·q [m].
    pub row: DVector<f64>,
    /// Its friction. Never rigid: without the elasticity of a tyre in series, time steps would make it ring.
    pub friction: Friction,
    /// Stiffness of the spring beside it [N/m], which is part of K too; a leaf spring's envelope has this slope.
    pub stiffness: f64,
}
