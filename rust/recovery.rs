//! Responses from modal states: force summation in one row per response, and plain superposition for comparison.
//!
//! KTN73 Eqs. 9–16 are linear in the modal coordinates and the axle loads, so all of them fold into
//! R = ρ·A + Σ g(x_k) P_k, with ρ_m the response to the static loads MΦΩ² of mode m and
//! g(x) = IL(x) − Σ ρ_m φ_m(x)/ω_m². The sequence itself stands in [`crate::force_summation`], for reading and for
//! testing.

use faer::Mat;

use crate::bridge::cubics::{Line, Mesh};
use crate::damping::{Damping, ModalDamping};
use crate::lane::wide::Wide;
use crate::modes::Modes;
use crate::spline::value;
use crate::statics::influence::Responses;

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

/// Responses are evaluated this many at a time, in registers.
pub const WIDTH: usize = 8;

/// One number for each of [`WIDTH`] neighbouring responses.
pub type Block = [f64; WIDTH];

/// The same as lanes, responses side by side.
pub type Responding = Wide<WIDTH>;

/// An axle on the bridge or, without a load, off it, in several states: with its load in each.
#[derive(Debug, Clone, Copy)]
pub struct Placed<const STATES: usize> {
    panel: usize,
    fraction: f64,
    loads: [f64; STATES],
}

impl<const STATES: usize> Placed<STATES> {
    /// An axle at a place with its loads [N].
    #[inline(always)]
    pub fn new(place: Place, loads: [f64; STATES]) -> Self {
        match place {
            Some((panel, fraction)) => Placed { panel, fraction, loads },
            None => Placed { panel: 0, fraction: 0.0, loads: [0.0; STATES] },
        }
    }
}

/// The rows of all responses, laid out in blocks so that evaluating them runs along contiguous numbers.
#[derive(Debug, Clone)]
pub struct Rows {
    responses: usize,
    mesh: Mesh,
    recovery: Recovery,
    /// Whether the factors multiply A, Ȧ and Ä.
    orders: [bool; 3],
    /// Number of coordinates that the factors multiply.
    width: usize,
    /// Factors of A, Ȧ and Ä as far as they are asked for: block by block, coordinate by coordinate.
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
        let mut orders = [false; 3];
        for quantity in responses.quantities() {
            match (quantity.order(), recovery) {
                (0, Recovery::ForceSummationByRates) => (orders[1], orders[2]) = (true, true),
                (order, _) => orders[order] = true,
            }
        }
        let of_order = |r: usize, order: usize, i: usize| match (responses.quantity_of(r), order, recovery) {
            // Deck motion is that of the modes.
            ((quantity, number), order, _) if quantity.order() > 0 => match quantity.order() == order {
                true => mode_lines[i].at_node(responses.sections()[number]),
                false => 0.0,
            },
            (_, 0, Recovery::ForceSummation | Recovery::Superposition) => rho(r, i),
            // [KTN73] Eq. 6: P̃ = −(MΦÄ + CΦȦ).
            (_, 1, Recovery::ForceSummationByRates) => -damping[(r, i)],
            (_, 2, Recovery::ForceSummationByRates) => -inertia[(r, i)],
            _ => 0.0,
        };
        let columns: Vec<(usize, usize)> =
            (0..3).filter(|&order| orders[order]).flat_map(|order| (0..m).map(move |i| (order, i))).collect();
        let blocks = (0..n.div_ceil(WIDTH)).flat_map(|b| columns.iter().map(move |&column| (b, column)));
        let factors = blocks.map(|(b, (order, i))| block(n, b, |r| of_order(r, order, i))).collect();
        let width = columns.len();
        let static_shapes: Vec<Line> = match recovery {
            Recovery::ForceSummation if orders[0] => {
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
        Rows { responses: n, mesh: mesh.clone(), recovery, orders, width, factors, lines, static_shapes }
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

    /// Number of coordinates that the factors multiply.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Whether they are A, Ȧ and Ä.
    pub fn orders(&self) -> [bool; 3] {
        self.orders
    }

    /// Whether forces on the masses follow from Ȧ and Ä.
    pub fn by_rates(&self) -> bool {
        self.recovery == Recovery::ForceSummationByRates
    }

    /// Factor of a mode's coordinate or its derivative in a response.
    pub fn factor_of(&self, response: usize, order: usize, mode: usize) -> f64 {
        let modes = self.width / self.orders.iter().filter(|&&used| used).count();
        let before = self.orders[..order].iter().filter(|&&used| used).count();
        if self.orders[order] { self.factor(response, before * modes + mode) } else { 0.0 }
    }

    /// Factor of a coordinate in a response.
    pub fn factor(&self, response: usize, coordinate: usize) -> f64 {
        self.factors[response / WIDTH * self.width + coordinate][response % WIDTH]
    }

    /// Influence of an axle load on a response.
    pub fn influence_of(&self, response: usize, (panel, f): (usize, f64)) -> f64 {
        let [c0, c1, c2, c3] = &self.lines[panel * self.blocks() + response / WIDTH];
        let i = response % WIDTH;
        value([c0[i], c1[i], c2[i], c3[i]], f)
    }

    /// The influence line of a response on a panel, or that of the load as it stands, with what it makes of Ā.
    pub fn cubic_of(&self, response: usize, panel: usize, at_rest: bool) -> [f64; 4] {
        let cubics = &self.lines[panel * self.blocks() + response / WIDTH];
        let mut cubic = [0, 1, 2, 3].map(|power| cubics[power][response % WIDTH]);
        for (i, shape) in self.static_shapes.iter().enumerate().filter(|_| at_rest) {
            for (own, c) in cubic.iter_mut().zip(shape.cubics()[panel]) {
                *own += self.factor(response, i) * c;
            }
        }
        cubic
    }

    /// First and second derivative along the path of the influence of an axle load on a response [1/m, 1/m²].
    pub fn derivatives_of(&self, response: usize, (panel, f): (usize, f64)) -> [f64; 2] {
        let cubics = &self.lines[panel * self.blocks() + response / WIDTH];
        let [_, b, c, d] = [0, 1, 2, 3].map(|power| cubics[power][response % WIDTH]);
        let width = self.mesh.width(panel);
        [(b + f * (2.0 * c + f * 3.0 * d)) / width, (2.0 * c + f * 6.0 * d) / (width * width)]
    }

    /// Influence of loads at these places on a response, zero off the bridge.
    pub fn influences(&self, response: usize, places: &[Place], influence: &mut Vec<f64>) {
        influence.clear();
        self.add_influences(response, places, influence);
    }

    /// Adds the same to others.
    pub fn add_influences(&self, response: usize, places: &[Place], influence: &mut Vec<f64>) {
        influence.extend(places.iter().map(|place| place.map_or(0.0, |place| self.influence_of(response, place))));
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

    /// Ā_st under loads at their places, or zeros where the rows do not need it.
    pub fn static_coordinates<'v>(
        &self,
        places: &'v [Place],
        loads: &'v [f64],
    ) -> impl Iterator<Item = f64> + use<'_, 'v> {
        let under = move |line: &Line| {
            let placed = places.iter().zip(loads);
            placed.fold(0.0, |sum, (place, load)| place.map_or(sum, |(p, f)| sum + load * line.value(p, f)))
        };
        (0..self.width).map(move |i| self.static_shapes.get(i).map_or(0.0, under))
    }

    /// Adds, mode by mode, what a static load of one at a place adds to Ā_st; nothing where the rows do not need it.
    pub fn extend_static(&self, place: Place, values: &mut Vec<f64>) {
        let shape = |i: usize| self.static_shapes.get(i).zip(place).map_or(0.0, |(line, (p, f))| line.value(p, f));
        values.extend((0..self.width).map(shape));
    }

    /// The same of a position that may be on the same panel as another.
    #[inline]
    pub fn place_near(&self, x: f64, other: Place) -> Place {
        match other {
            Some((panel, _)) if self.mesh.is_within(panel, x) => Some((panel, self.mesh.fraction(panel, x))),
            _ => self.place(x),
        }
    }

    /// Panel and fraction of a position [m].
    pub fn place(&self, x: f64) -> Place {
        self.mesh.panel_at(x).map(|panel| (panel, self.mesh.fraction(panel, x)))
    }

    /// What the responses of a block multiply the coordinates by.
    #[inline(always)]
    pub fn factors_of_block(&self, b: usize) -> &[Block] {
        &self.factors[b * self.width..(b + 1) * self.width]
    }

    /// The rows of one block.
    #[inline(always)]
    pub fn of_block(&self, b: usize) -> BlockRows<'_> {
        BlockRows {
            factors: &self.factors[b * self.width..(b + 1) * self.width],
            lines: &self.lines[b..],
            blocks: self.blocks(),
        }
    }
}

/// The rows of a block of responses.
#[derive(Debug, Clone, Copy)]
pub struct BlockRows<'a> {
    factors: &'a [Block],
    /// From its cubics on the first panel on, and how far it is to those on the next.
    lines: &'a [[Block; 4]],
    blocks: usize,
}

impl BlockRows<'_> {
    /// Its responses to the coordinates and the loads of each state.
    // Always inlined, so that it is compiled for the instruction set of the loop around it.
    #[inline(always)]
    pub fn at<const STATES: usize>(self, coordinates: &[[f64; STATES]], axles: &[Placed<STATES>]) -> [Block; STATES] {
        let mut values = [[0.0; WIDTH]; STATES];
        for (factor, a) in self.factors.iter().zip(coordinates) {
            for (values, a) in values.iter_mut().zip(a) {
                for i in 0..WIDTH {
                    values[i] += factor[i] * a;
                }
            }
        }
        let mut of_loads = [[0.0; WIDTH]; STATES];
        for Placed { panel, fraction, loads } in axles {
            let [c0, c1, c2, c3] = &self.lines[panel * self.blocks];
            for i in 0..WIDTH {
                let g = value([c0[i], c1[i], c2[i], c3[i]], *fraction);
                for (of_loads, load) in of_loads.iter_mut().zip(loads) {
                    of_loads[i] += g * load;
                }
            }
        }
        for (values, of_loads) in values.iter_mut().zip(of_loads) {
            for i in 0..WIDTH {
                values[i] += of_loads[i];
            }
        }
        values
    }
}

/// The values of block b of n responses, zero beyond the last.
fn block(n: usize, b: usize, value: impl Fn(usize) -> f64) -> Block {
    std::array::from_fn(|i| if b * WIDTH + i < n { value(b * WIDTH + i) } else { 0.0 })
}
