//! The bridge in modal coordinates: frequencies, modes along the path of the wheels, damping.

use crate::bridge::Bridge;
use crate::bridge::cubics::{COINCIDENT, Line, Mesh};
use crate::damping::{Damping, ModalDamping};
use crate::error::Error;
use crate::modes::Modes;
use crate::spline::{curvature, slope, value};
use crate::statics::flexibility::Flexibility;
use crate::vehicle::Vehicle;
use crate::vehicle::body::Suspension;

/// Jump of a slope, relative to the steepest, from which on it is a kink and not rounding.
const KINK: f64 = 1e-6;

/// The bridge in modal coordinates, ready to be crossed.
#[derive(Debug, Clone)]
pub struct ModalBridge {
    /// Natural circular frequencies of the included modes [rad/s].
    pub omega: Vec<f64>,
    /// The included modes along the bridge.
    pub shapes: ModeShapes,
    /// Their damping.
    pub damping: ModalDamping,
    /// Shortest distance between neighbouring supports and ends [m].
    pub shortest_span: f64,
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
        Ok(ModalBridge {
            omega: modes.omega.clone(),
            shapes: ModeShapes::new(flexibility.mesh(), lines),
            damping: damping.modal(modes)?,
            shortest_span: shortest_span(bridge.span_bounds()),
        })
    }

    /// Upper bound of the fastest circular frequency of bridge and vehicles together, suspensions locked [rad/s].
    pub fn fastest_frequency<'a>(&self, vehicles: impl Iterator<Item = &'a Vehicle>) -> f64 {
        let [bridge, own, tyres] = self.fastest_parts(vehicles);
        (bridge + own + tyres).sqrt()
    }

    /// What the square of that is the sum of [rad²/s²]: of the bridge, of the vehicles, of tyres on the bridge.
    pub fn fastest_parts<'a>(&self, vehicles: impl Iterator<Item = &'a Vehicle>) -> [f64; 3] {
        // The stiffness is that of the bridge plus that of the contact springs, whose largest eigenvalue is at most the
        // largest of the vehicles' own plus the sum of k φ² (Weyl's inequality, and the trace).
        let bridge = self.omega.iter().copied().fold(0.0, f64::max);
        let (mut own, mut tyres) = (0.0_f64, 0.0);
        for vehicle in vehicles {
            own = vehicle.frequencies(Suspension::Locked).into_iter().fold(own, f64::max);
            tyres += vehicle.assembly().contacts.iter().map(|c| c.law.tyre_stiffness()).sum::<f64>();
        }
        let own = own * std::f64::consts::TAU;
        [bridge.powi(2), own.powi(2), tyres * self.shapes.largest_sum_of_squares()]
    }
}

/// The included modes along the bridge, laid out for evaluation at one point after another.
#[derive(Debug, Clone)]
pub struct ModeShapes {
    mesh: Mesh,
    modes: usize,
    /// Cubics of all modes, panel by panel.
    cubics: Vec<[f64; 4]>,
}

impl ModeShapes {
    /// From the lines of the modes.
    pub fn new(mesh: &Mesh, lines: &[Line]) -> Self {
        let cubics = (0..mesh.panels()).flat_map(|panel| lines.iter().map(move |line| line.cubics()[panel])).collect();
        ModeShapes { mesh: mesh.clone(), modes: lines.len(), cubics }
    }

    /// The mesh of the lines.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// Largest Σ φ² over the included modes along the bridge, from five points a panel [1/kg].
    pub fn largest_sum_of_squares(&self) -> f64 {
        let points = (0..self.mesh.panels()).flat_map(|panel| (0..5).map(move |i| (panel, 0.25 * f64::from(i))));
        points
            .map(|(panel, fraction)| (0..self.modes).map(|m| self.value(panel, fraction, m).powi(2)).sum())
            .fold(0.0, f64::max)
    }

    /// Whether the slope of a mode jumps anywhere but at the ends: at hinges.
    pub fn have_kinks(&self) -> bool {
        (0..self.modes).any(|mode| {
            let slopes = |panel: usize| [0.0, 1.0].map(|fraction| self.rates(panel, fraction, mode)[1]);
            let panels: Vec<[f64; 2]> = (0..self.mesh.panels()).map(slopes).collect();
            let steepest = panels.iter().flatten().fold(0.0_f64, |m, s| m.max(s.abs()));
            panels.windows(2).any(|pair| (pair[1][0] - pair[0][1]).abs() > KINK * steepest)
        })
    }

    /// Number of modes.
    pub fn modes(&self) -> usize {
        self.modes
    }

    /// Adds the modes' values at x, each followed by its first two derivatives if three kinds are asked for.
    pub fn extend_at(&self, x: f64, kinds: usize, values: &mut Vec<f64>) {
        match self.mesh.panel_at(x) {
            Some(panel) => {
                let fraction = self.mesh.fraction(panel, x);
                for mode in 0..self.modes {
                    if kinds == 3 {
                        values.extend(self.rates(panel, fraction, mode));
                    } else {
                        values.push(self.value(panel, fraction, mode));
                    }
                }
            }
            None => values.extend(std::iter::repeat_n(0.0, self.modes * kinds)),
        }
    }

    /// The cubics of all modes on a panel.
    pub fn cubics(&self, panel: usize) -> &[[f64; 4]] {
        &self.cubics[panel * self.modes..(panel + 1) * self.modes]
    }

    fn value(&self, panel: usize, fraction: f64, mode: usize) -> f64 {
        value(self.cubics[panel * self.modes + mode], fraction)
    }

    /// Value, slope and curvature.
    pub fn rates(&self, panel: usize, fraction: f64, mode: usize) -> [f64; 3] {
        let cubic = self.cubics[panel * self.modes + mode];
        let width = self.mesh.width(panel);
        [value(cubic, fraction), slope(cubic, fraction) / width, curvature(cubic, fraction) / width.powi(2)]
    }

    /// Value, slope and curvature at x, zero off the bridge.
    pub fn rates_at(&self, x: f64, mode: usize) -> [f64; 3] {
        let rates = |panel| self.rates(panel, self.mesh.fraction(panel, x), mode);
        self.mesh.panel_at(x).map_or([0.0; 3], rates)
    }

    /// Value, slope, curvature and third derivative: all there is of a cubic.
    pub fn derivatives(&self, panel: usize, fraction: f64, mode: usize) -> [f64; 4] {
        let [value, slope, curvature] = self.rates(panel, fraction, mode);
        let [.., c3] = self.cubics[panel * self.modes + mode];
        [value, slope, curvature, 6.0 * c3 / self.mesh.width(panel).powi(3)]
    }
}

/// Shortest of the spans between these bounds, ascending [m].
pub fn shortest_span(bounds: &[f64]) -> f64 {
    let near = COINCIDENT * (bounds[bounds.len() - 1] - bounds[0]);
    let spans = bounds.windows(2).map(|ends| ends[1] - ends[0]);
    spans.filter(|&span| span > near).fold(f64::INFINITY, f64::min)
}
