//! Responses from modal states: force summation in one row per response, and plain superposition for comparison.
//!
//! KTN73 Eqs. 9–16 are linear in the modal coordinates and the axle loads, so all of them fold into
//! R = ρ·A + Σ g(x_k) P_k, with ρ_m the response to the static loads MΦΩ² of mode m and
//! g(x) = IL(x) − Σ ρ_m φ_m(x)/ω_m². The sequence itself stands in [`crate::force_summation`], for reading and for
//! testing.

use std::ops::Range;

use faer::Mat;

use crate::bridge::cubics::{Line, Mesh};
use crate::crossing::history::History;
use crate::damping::{Damping, ModalDamping};
use crate::error::Error;
use crate::lane::wide::Wide;
use crate::modes::Modes;
use crate::spline::value;
use crate::statics::influence::Responses;
use crate::stop_token::StopToken;

/// How responses follow from the included modes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Recovery {
    /// Force summation, inertia and damping forces from Ã = A − Ā: KTN73 Eqs. 9–16 with Eq. 11.
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

impl<'a> Instant<'a> {
    /// Row i of a history, its axles placed.
    #[inline(always)]
    pub fn of(history: &'a History, i: usize, places: &'a [Place]) -> Self {
        let (m, k) = (history.modes, history.axles);
        Instant {
            a: &history.a[i * m..(i + 1) * m],
            a_dot: &history.a_dot[i * m..(i + 1) * m],
            a_ddot: &history.a_ddot[i * m..(i + 1) * m],
            loads: &history.loads[i * k..(i + 1) * k],
            static_loads: &history.static_loads,
            places,
        }
    }
}

/// Responses are evaluated this many at a time, in registers.
pub const WIDTH: usize = 8;

/// One number for each of [`WIDTH`] neighbouring responses.
pub type Block = [f64; WIDTH];

/// The same as lanes, responses side by side.
pub type Responding = Wide<WIDTH>;

/// Instants made ready for [`Rows::block`], one after another.
#[derive(Debug, Clone, Default)]
pub struct Packed {
    /// Coordinates and axles of each instant.
    width: [usize; 2],
    /// What the factors multiply: A, or Ȧ and Ä.
    coordinates: Vec<f64>,
    /// Ā_st, the modal coordinates of the static loads, or zeros where the rows do not need them.
    static_coordinates: Vec<f64>,
    axles: Vec<Placed>,
}

impl Packed {
    /// Forgets all instants.
    pub fn clear(&mut self) {
        self.coordinates.clear();
        self.static_coordinates.clear();
        self.axles.clear();
    }

    /// Some of the instants.
    #[inline(always)]
    pub fn instants(&self, range: Range<usize>) -> impl Iterator<Item = Ready<'_>> {
        let [width, axles] = self.width;
        let coordinates = width * range.start..width * range.end;
        let coordinates = (self.coordinates[coordinates.clone()].chunks_exact(width))
            .zip(self.static_coordinates[coordinates].chunks_exact(width));
        coordinates
            .zip(self.axles[axles * range.start..axles * range.end].chunks_exact(axles))
            .map(|((coordinates, static_coordinates), axles)| Ready { coordinates, static_coordinates, axles })
    }

    /// Number of instants.
    pub fn len(&self) -> usize {
        self.axles.len().checked_div(self.width[1]).unwrap_or(0)
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.axles.is_empty()
    }
}

/// One of the instants in [`Packed`].
#[derive(Debug, Clone, Copy)]
pub struct Ready<'a> {
    coordinates: &'a [f64],
    static_coordinates: &'a [f64],
    axles: &'a [Placed],
}

/// An axle on the bridge or, without a load, off it.
#[derive(Debug, Clone, Copy)]
pub struct Placed {
    panel: usize,
    fraction: f64,
    load: f64,
    static_load: f64,
}

impl Placed {
    /// An axle at a place with its loads [N].
    #[inline(always)]
    pub fn new(place: Place, load: f64, static_load: f64) -> Self {
        match place {
            Some((panel, fraction)) => Placed { panel, fraction, load, static_load },
            None => Placed { panel: 0, fraction: 0.0, load: 0.0, static_load: 0.0 },
        }
    }
}

/// The rows of all responses, laid out in blocks so that evaluating them runs along contiguous numbers.
#[derive(Debug, Clone)]
pub struct Rows {
    responses: usize,
    mesh: Mesh,
    recovery: Recovery,
    /// Number of coordinates that the factors multiply.
    width: usize,
    /// Factors of A, or of Ȧ and Ä: block by block, coordinate by coordinate.
    factors: Vec<Block>,
    /// The four coefficients of g (or IL), panel by panel, block by block.
    lines: Vec<[Block; 4]>,
    /// φ/ω² along the bridge, for Ā_st (KTN73 Eq. 9).
    static_shapes: Vec<Line>,
}

/// Static responses to the forces on the masses, mode by mode; a row for each response, a column for each mode.
#[derive(Debug, Clone)]
pub struct ModalFactors {
    /// To MΦ: times ω² they are ρ.
    pub inertia: Mat<f64>,
    /// To CΦ.
    pub damping: Mat<f64>,
}

impl ModalFactors {
    /// From the masses (node, mass [kg]) and the mode shapes at them; `damping` as given and in these modes.
    pub fn of_masses(
        responses: &Responses,
        masses: &[(usize, f64)],
        modes: &Modes,
        damping: (&Damping, &ModalDamping),
    ) -> Self {
        // Influence of a unit load at every mass station on every response.
        let influence = Mat::from_fn(responses.len(), masses.len(), |r, j| responses.at_station(r, masses[j].0));
        let momentum = Mat::from_fn(masses.len(), modes.len(), |j, i| masses[j].1 * modes.shapes[(j, i)]);
        let inertia = &influence * &momentum;
        match damping {
            (Damping::Viscous(c), _) => {
                let damping = &influence * &(c * &modes.shapes);
                ModalFactors { inertia, damping }
            }
            (_, in_modes) => ModalFactors::classical(inertia, &modes.omega, in_modes),
        }
    }

    /// From ρ, the responses of the mode shapes themselves.
    pub fn of_responses(rho: &Mat<f64>, omega: &[f64], damping: &ModalDamping) -> Self {
        let inertia = Mat::from_fn(rho.nrows(), omega.len(), |r, i| rho[(r, i)] / omega[i].powi(2));
        ModalFactors::classical(inertia, omega, damping)
    }

    /// With C such that CΦ = MΦ diag(2ζω).
    fn classical(inertia: Mat<f64>, omega: &[f64], damping: &ModalDamping) -> Self {
        let rate = |i: usize| match damping {
            ModalDamping::Classical(ratios) => 2.0 * ratios[i] * omega[i],
            ModalDamping::Coupled(d) => d[(i, i)],
        };
        let damping = Mat::from_fn(inertia.nrows(), inertia.ncols(), |r, i| rate(i) * inertia[(r, i)]);
        ModalFactors { inertia, damping }
    }
}

impl Rows {
    /// For `responses`, from what they are to each mode.
    pub fn new(
        responses: &Responses,
        factors: &ModalFactors,
        omega: &[f64],
        mode_lines: &[Line],
        mesh: &Mesh,
        recovery: Recovery,
    ) -> Self {
        let (n, m) = (responses.len(), omega.len());
        let ModalFactors { inertia, damping } = factors;
        let rho = |r: usize, i: usize| omega[i].powi(2) * inertia[(r, i)];
        let blocks = |width: usize, value: &dyn Fn(usize, usize) -> f64| -> Vec<Block> {
            let pairs = (0..n.div_ceil(WIDTH)).flat_map(|b| (0..width).map(move |i| (b, i)));
            pairs.map(|(b, i)| block(n, b, |r| value(r, i))).collect()
        };
        let (width, factors) = match recovery {
            Recovery::ForceSummation | Recovery::Superposition => (m, blocks(m, &rho)),
            Recovery::ForceSummationByRates => {
                // [KTN73] Eq. 6: P̃ = −(MΦÄ + CΦȦ).
                (2 * m, blocks(2 * m, &|r, i| if i < m { -damping[(r, i)] } else { -inertia[(r, i - m)] }))
            }
        };
        let static_shapes: Vec<Line> = match recovery {
            Recovery::ForceSummation => {
                mode_lines.iter().zip(omega).map(|(line, w)| line.clone().scaled(w.powi(-2))).collect()
            }
            _ => Vec::new(),
        };
        let row = n.div_ceil(WIDTH);
        let mut lines = vec![[[0.0; WIDTH]; 4]; mesh.panels() * row];
        for (r, influence) in responses.lines().iter().enumerate() {
            let mut line = influence.clone();
            for (i, shape) in static_shapes.iter().enumerate() {
                line.add_scaled(-rho(r, i), shape);
            }
            for (panel, cubic) in line.cubics().iter().enumerate() {
                for (power, c) in cubic.iter().enumerate() {
                    lines[panel * row + r / WIDTH][power][r % WIDTH] = *c;
                }
            }
        }
        Rows { responses: n, mesh: mesh.clone(), recovery, width, factors, lines, static_shapes }
    }

    /// Number of responses.
    pub fn len(&self) -> usize {
        self.responses
    }

    /// Whether there are none (never so).
    pub fn is_empty(&self) -> bool {
        self.responses == 0
    }

    /// Number of blocks, the last one filled up with zeros.
    pub fn blocks(&self) -> usize {
        self.responses.div_ceil(WIDTH)
    }

    /// The mesh on which axles are placed.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// How much of an axle load enters dynamic responses directly: all by force summation, nothing by superposition.
    pub fn weight(&self) -> f64 {
        if self.recovery == Recovery::Superposition { 0.0 } else { 1.0 }
    }

    /// Number of coordinates that the factors multiply: A, or Ȧ and Ä.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Whether the coordinates are Ȧ and Ä, not A.
    pub fn by_rates(&self) -> bool {
        self.recovery == Recovery::ForceSummationByRates
    }

    /// Factor of a coordinate in a response.
    pub fn factor(&self, response: usize, coordinate: usize) -> f64 {
        self.factors[response / WIDTH * self.width + coordinate][response % WIDTH]
    }

    /// Influence of an axle load on a response.
    pub fn influence_of(&self, response: usize, (panel, f): (usize, f64)) -> f64 {
        let cubics = &self.lines[panel * self.blocks() + response / WIDTH];
        value(cubics.map(|each| each[response % WIDTH]), f)
    }

    /// Whether two responses have the same row, to the bit.
    pub fn same(&self, a: usize, b: usize) -> bool {
        let [row_a, row_b] = [a / WIDTH, b / WIDTH];
        let [i, j] = [a % WIDTH, b % WIDTH];
        (0..self.width).all(|k| self.factor(a, k) == self.factor(b, k))
            && self
                .lines
                .chunks_exact(self.blocks())
                .all(|panel| (0..4).all(|p| panel[row_a][p][i] == panel[row_b][p][j]))
    }

    /// Adds, mode by mode, what a static load of one at a place adds to Ā_st; nothing where the rows do not need it.
    pub fn extend_static(&self, place: Place, values: &mut Vec<f64>) {
        let shape = |i: usize| self.static_shapes.get(i).zip(place).map_or(0.0, |(line, (p, f))| line.value(p, f));
        values.extend((0..self.width).map(shape));
    }

    /// Panel and fraction of a position [m].
    pub fn place(&self, x: f64) -> Place {
        self.mesh.panel_at(x).map(|panel| (panel, self.mesh.fraction(panel, x)))
    }

    /// Makes an instant ready and adds it to the others.
    pub fn pack(&self, now: &Instant<'_>, packed: &mut Packed) {
        packed.width = [self.width, now.places.len()];
        match self.recovery {
            Recovery::ForceSummation | Recovery::Superposition => packed.coordinates.extend_from_slice(now.a),
            Recovery::ForceSummationByRates => {
                packed.coordinates.extend_from_slice(now.a_dot);
                packed.coordinates.extend_from_slice(now.a_ddot);
            }
        }
        for i in 0..self.width {
            let placed = now.places.iter().zip(now.static_loads);
            packed.static_coordinates.push(self.static_shapes.get(i).map_or(0.0, |shape| {
                placed.fold(0.0, |sum, (place, load)| place.map_or(sum, |(p, f)| sum + load * shape.value(p, f)))
            }));
        }
        let weight = self.weight();
        for ((place, load), &static_load) in now.places.iter().zip(now.loads).zip(now.static_loads) {
            packed.axles.push(Placed::new(*place, weight * load, static_load));
        }
    }

    /// One block of responses at one instant, dynamic and static.
    // Always inlined, so that it is compiled for the instruction set of the loop around it.
    #[inline(always)]
    pub fn block(&self, b: usize, now: Ready<'_>) -> (Block, Block) {
        let (mut dynamic, mut at_rest) = ([0.0; WIDTH], [0.0; WIDTH]);
        let factors = &self.factors[b * self.width..(b + 1) * self.width];
        for ((factor, a), a_static) in factors.iter().zip(now.coordinates).zip(now.static_coordinates) {
            for i in 0..WIDTH {
                dynamic[i] += factor[i] * a;
                at_rest[i] += factor[i] * a_static;
            }
        }
        for axle in now.axles {
            let [c0, c1, c2, c3] = &self.lines[axle.panel * self.blocks() + b];
            let f = axle.fraction;
            for i in 0..WIDTH {
                let g = value([c0[i], c1[i], c2[i], c3[i]], f);
                dynamic[i] += g * axle.load;
                at_rest[i] += g * axle.static_load;
            }
        }
        (dynamic, at_rest)
    }

    /// One response at one instant, to the bit as [`Rows::block`] has it.
    pub fn value(&self, r: usize, now: Ready<'_>) -> f64 {
        let modal = now.coordinates.iter().enumerate().fold(0.0, |sum, (i, a)| sum + self.factor(r, i) * a);
        let axles = now.axles.iter();
        axles.fold(modal, |sum, axle| sum + self.influence_of(r, (axle.panel, axle.fraction)) * axle.load)
    }

    /// One block of responses to coordinates and to loads at their places.
    #[inline(always)]
    pub fn block_of(&self, b: usize, coordinates: &[f64], axles: &[Placed]) -> Block {
        let mut values = [0.0; WIDTH];
        for (factor, a) in self.factors[b * self.width..(b + 1) * self.width].iter().zip(coordinates) {
            for i in 0..WIDTH {
                values[i] += factor[i] * a;
            }
        }
        for axle in axles {
            let [c0, c1, c2, c3] = &self.lines[axle.panel * self.blocks() + b];
            let f = axle.fraction;
            for i in 0..WIDTH {
                values[i] += value([c0[i], c1[i], c2[i], c3[i]], f) * axle.load;
            }
        }
        values
    }

    /// All instants of a history made ready.
    pub fn pack_history(&self, history: &History) -> Packed {
        let mut packed = Packed::default();
        self.pack_on(history, &mut packed);
        packed
    }

    /// The same, of the instants that have been added to the history since.
    pub fn pack_on(&self, history: &History, packed: &mut Packed) {
        let (axles, from) = (history.axles, packed.len());
        // For all that the history has room for, so that numbers are not moved each time that it has grown.
        let more = history.time.capacity() - from;
        packed.coordinates.reserve(self.width * more);
        packed.static_coordinates.reserve(self.width * more);
        packed.axles.reserve(axles * more);
        let mut places = vec![None; axles];
        for (i, positions) in history.positions.chunks_exact(axles).enumerate().skip(from) {
            for (place, &x) in places.iter_mut().zip(positions) {
                *place = self.place(x);
            }
            self.pack(&Instant::of(history, i, &places), packed);
        }
    }

    /// The responses of a range at every instant, dynamic and static, row by row.
    pub fn histories(&self, packed: &Packed, range: Range<usize>, stop: StopToken<'_>) -> Result<[Vec<f64>; 2], Error> {
        let count = range.len() * packed.len();
        let mut filling = Filling {
            rows: self,
            packed,
            range,
            instants: 0..0,
            out: [Vec::with_capacity(count), Vec::with_capacity(count)],
        };
        let arch = pulp::Arch::new();
        for from in (0..packed.len()).step_by(POLL_EVERY) {
            filling.instants = from..(from + POLL_EVERY).min(packed.len());
            arch.dispatch(&mut filling);
            stop.check()?;
        }
        Ok(filling.out)
    }
}

/// Instants between two questions whether to go on.
const POLL_EVERY: usize = 1024;

/// Histories being filled in, compiled once for each instruction set.
struct Filling<'a> {
    rows: &'a Rows,
    packed: &'a Packed,
    range: Range<usize>,
    instants: Range<usize>,
    out: [Vec<f64>; 2],
}

impl pulp::WithSimd for &mut Filling<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _simd: S) {
        for now in self.packed.instants(self.instants.clone()) {
            for b in self.range.start / WIDTH..self.range.end.div_ceil(WIDTH) {
                let (dynamic, at_rest) = self.rows.block(b, now);
                let first = b * WIDTH;
                let wanted = self.range.start.max(first) - first..self.range.end.min(first + WIDTH) - first;
                self.out[0].extend_from_slice(&dynamic[wanted.clone()]);
                self.out[1].extend_from_slice(&at_rest[wanted]);
            }
        }
    }
}

/// The values of block b of n responses, zero beyond the last.
fn block(n: usize, b: usize, value: impl Fn(usize) -> f64) -> Block {
    std::array::from_fn(|i| if b * WIDTH + i < n { value(b * WIDTH + i) } else { 0.0 })
}
