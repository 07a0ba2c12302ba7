//! Responses from modal states: force summation in one row per response, and plain superposition as its partner.
//!
//! [KTN73] Eqs. 9–16 are linear in the modal coordinates and the axle loads, so all of them fold into
//! R = ρ·A + Σ g(x_k) P_k, with ρ_m the response to the static loads MΦΩ² of mode m and
//! g(x) = IL(x) − Σ ρ_m φ_m(x)/ω_m². The sequence itself stands in [`crate::sequence`], for reading and for testing.

use faer::Mat;

use crate::bridge::Bridge;
use crate::crossing::{Damping, ModalBridge};
use crate::influence::Responses;
use crate::line::{Line, Mesh};
use crate::modes::Modes;

/// How responses follow from the included modes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Recovery {
    /// Force summation, inertia and damping forces from Ã = A − Ā: [KTN73] Eqs. 9–16 with Eq. 11.
    ForceSummation,
    /// Force summation, inertia and damping forces from accelerations and velocities: Eq. 6 in place of Eqs. 9–11.
    ForceSummationByRates,
    /// Direct coordinate transformation, y = ΦA and the moments and shears of that shape: Eq. 2.
    Superposition,
}

/// A position on the bridge as panel and fraction of it, `None` off the bridge.
pub type Place = Option<(usize, f64)>;

/// Modal state and axle loads at one instant.
#[derive(Debug, Clone, Copy)]
pub struct Instant<'a> {
    /// Modal coordinates.
    pub a: &'a [f64],
    /// Modal velocities.
    pub a_dot: &'a [f64],
    /// Modal accelerations.
    pub a_ddot: &'a [f64],
    /// Axle loads [N].
    pub loads: &'a [f64],
    /// Static axle loads [N].
    pub static_loads: &'a [f64],
    /// Where the axles stand.
    pub places: &'a [Place],
}

/// The rows of all responses, laid out so that evaluating them runs along contiguous numbers.
#[derive(Debug, Clone)]
pub struct Rows {
    responses: usize,
    modes: usize,
    mesh: Mesh,
    recovery: Recovery,
    /// Factors of A, Ȧ and Ä, mode by mode, response by response; empty where all are zero.
    factors: [Vec<f64>; 3],
    /// The four coefficients of g (or IL), panel by panel, power by power, response by response.
    lines: Vec<f64>,
    /// φ/ω² along the bridge, for the modal coordinates Ā_st of the static loads ([KTN73] Eq. 9).
    static_shapes: Vec<Line>,
}

impl Rows {
    /// For `responses` of `bridge` from `modes`; `model` is that bridge in these modes, `damping` as given by the user.
    pub fn new(
        bridge: &Bridge,
        responses: &Responses,
        modes: &Modes,
        mode_lines: &[Line],
        mesh: &Mesh,
        damping: (&Damping, &ModalBridge),
        recovery: Recovery,
    ) -> Self {
        let (n, m) = (responses.len(), modes.len());
        let nodes: Vec<usize> = bridge.stations().iter().map(|s| mesh.node_at(s.at)).collect();
        // Influence of a unit load at every mass station on every response.
        let influence = Mat::from_fn(n, nodes.len(), |r, j| responses.at_station(r, nodes[j]));
        let momentum = Mat::from_fn(nodes.len(), m, |j, i| bridge.stations()[j].mass * modes.shapes[(j, i)]);
        // Static response to the inertia forces of a unit modal acceleration.
        let inertia = &influence * &momentum;
        let by_mode = |value: &dyn Fn(usize, usize) -> f64| -> Vec<f64> {
            (0..m).flat_map(|i| (0..n).map(move |r| (i, r))).map(|(i, r)| value(i, r)).collect()
        };
        let rho = |i: usize, r: usize| modes.omega[i].powi(2) * inertia[(r, i)];
        let factors = match recovery {
            Recovery::ForceSummation | Recovery::Superposition => [by_mode(&rho), Vec::new(), Vec::new()],
            Recovery::ForceSummationByRates => {
                // [KTN73] Eq. 6: P̃ = −(MΦÄ + CΦȦ); with ratios C is such that CΦ = MΦ diag(2ζω).
                let damping = match damping {
                    (Damping::Viscous(c), _) => &influence * &(c * &modes.shapes),
                    (Damping::Ratios(ratios), model) => Mat::from_fn(n, m, |r, i| {
                        2.0 * ratios[i.min(ratios.len() - 1)] * model.omega[i] * inertia[(r, i)]
                    }),
                };
                [Vec::new(), by_mode(&|i, r| -damping[(r, i)]), by_mode(&|i, r| -inertia[(r, i)])]
            }
        };
        let static_shapes: Vec<Line> = match recovery {
            Recovery::ForceSummation => {
                mode_lines.iter().zip(&modes.omega).map(|(line, w)| line.clone().scaled(w.powi(-2))).collect()
            }
            _ => Vec::new(),
        };
        let mut lines = vec![0.0; mesh.panels() * 4 * n];
        for (r, influence) in responses.lines().iter().enumerate() {
            let mut line = influence.clone();
            for (i, shape) in static_shapes.iter().enumerate() {
                line.add_scaled(-rho(i, r), shape);
            }
            for (panel, cubic) in line.cubics().iter().enumerate() {
                for (power, c) in cubic.iter().enumerate() {
                    lines[(panel * 4 + power) * n + r] = *c;
                }
            }
        }
        Rows { responses: n, modes: m, mesh: mesh.clone(), recovery, factors, lines, static_shapes }
    }

    /// Number of responses.
    pub fn len(&self) -> usize {
        self.responses
    }

    /// Whether there are none (never so).
    pub fn is_empty(&self) -> bool {
        self.responses == 0
    }

    /// The mesh on which axles are placed.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// Panel and fraction of a position [m].
    pub fn place(&self, x: f64) -> Place {
        self.mesh.panel_at(x).map(|panel| (panel, self.mesh.fraction(panel, x)))
    }

    /// All responses at one instant, dynamic and static.
    pub fn evaluate(&self, now: &Instant<'_>, dynamic: &mut [f64], at_rest: &mut [f64]) {
        self.evaluate_range(now, 0, dynamic, at_rest);
    }

    /// The responses from `first` on, as many as the outputs hold.
    pub fn evaluate_range(&self, now: &Instant<'_>, first: usize, dynamic: &mut [f64], at_rest: &mut [f64]) {
        let n = self.responses;
        let count = dynamic.len();
        dynamic.fill(0.0);
        at_rest.fill(0.0);
        let add_modes = |factors: &[f64], mode: usize, coordinate: f64, out: &mut [f64]| {
            let row = &factors[mode * n + first..][..count];
            for (o, f) in out.iter_mut().zip(row) {
                *o += f * coordinate;
            }
        };
        for (factors, coordinates) in self.factors.iter().zip([now.a, now.a_dot, now.a_ddot]) {
            if !factors.is_empty() {
                for (mode, &coordinate) in coordinates.iter().enumerate() {
                    add_modes(factors, mode, coordinate, dynamic);
                }
            }
        }
        for (mode, shape) in self.static_shapes.iter().enumerate() {
            let places = now.places.iter().zip(now.static_loads);
            let coordinate = places.filter_map(|(place, load)| place.map(|(p, f)| load * shape.value(p, f))).sum();
            add_modes(&self.factors[0], mode, coordinate, at_rest);
        }
        let weight = if self.recovery == Recovery::Superposition { 0.0 } else { 1.0 };
        for ((place, load), static_load) in now.places.iter().zip(now.loads).zip(now.static_loads) {
            let Some((panel, f)) = *place else { continue };
            let load = weight * load;
            let power = |k: usize| &self.lines[(panel * 4 + k) * n + first..][..count];
            let [c0, c1, c2, c3] = [power(0), power(1), power(2), power(3)];
            for r in 0..count {
                let g = c0[r] + f * (c1[r] + f * (c2[r] + f * c3[r]));
                dynamic[r] += g * load;
                at_rest[r] += g * static_load;
            }
        }
    }

    /// Number of modes.
    pub fn modes(&self) -> usize {
        self.modes
    }
}
