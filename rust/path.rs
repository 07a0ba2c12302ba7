//! Where the axles are and which mode deflections lie under them: prescribed beforehand, or following the body.

use crate::lane::Lane;
use crate::line::{Line, Mesh};
use crate::step::Geometry;

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

    fn value(&self, panel: usize, fraction: f64, mode: usize) -> f64 {
        let [c0, c1, c2, c3] = self.cubics[panel * self.modes + mode];
        c0 + fraction * (c1 + fraction * (c2 + fraction * c3))
    }

    fn slope(&self, panel: usize, fraction: f64, mode: usize) -> f64 {
        let [_, c1, c2, c3] = self.cubics[panel * self.modes + mode];
        (c1 + fraction * (2.0 * c2 + fraction * 3.0 * c3)) / self.mesh.width(panel)
    }
}

/// Prescribed motion: equal steps in space, so that the table serves every sample whatever its speed.
#[derive(Debug, Clone)]
pub struct Prescribed<'a> {
    shapes: &'a ModeShapes,
    /// Distance of each axle behind the first [m].
    behind: Vec<f64>,
    /// Front axle at the start [m].
    start: f64,
    /// Advance per step [m].
    advance: f64,
    step: usize,
    /// Φ⁰ by step, axle and mode.
    table: Vec<f64>,
}

impl<'a> Prescribed<'a> {
    /// Front axle from `start` in `steps` equal steps of `advance` [m], the others `behind` it [m].
    pub fn new(shapes: &'a ModeShapes, behind: Vec<f64>, start: f64, advance: f64, steps: usize) -> Self {
        let mut path = Prescribed { shapes, behind, start, advance, step: 0, table: Vec::new() };
        path.table.reserve_exact((steps + 1) * path.behind.len() * shapes.modes);
        for step in 0..=steps {
            for axle in 0..path.behind.len() {
                let x = path.place(step, axle);
                match shapes.mesh.panel_at(x) {
                    Some(panel) => {
                        let fraction = shapes.mesh.fraction(panel, x);
                        path.table.extend((0..shapes.modes).map(|m| shapes.value(panel, fraction, m)));
                    }
                    None => path.table.extend(std::iter::repeat_n(0.0, shapes.modes)),
                }
            }
        }
        path
    }

    fn place(&self, step: usize, axle: usize) -> f64 {
        self.start + self.advance * step as f64 - self.behind[axle]
    }
}

impl<L: Lane> Geometry<L> for Prescribed<'_> {
    fn predict(&mut self, _travel: L, _pitch: L) {
        self.step += 1;
    }

    fn follow(&mut self, _travel: L, _pitch: L) -> L::Mask {
        L::never()
    }

    fn shape(&self, axle: usize, mode: usize) -> L {
        L::splat(self.table[(self.step * self.behind.len() + axle) * self.shapes.modes + mode])
    }

    fn slope(&self, axle: usize, mode: usize) -> L {
        let mesh = &self.shapes.mesh;
        let x = self.place(self.step, axle);
        L::splat(mesh.panel_at(x).map_or(0.0, |panel| self.shapes.slope(panel, mesh.fraction(panel, x), mode)))
    }

    fn position(&self, axle: usize) -> L {
        L::splat(self.place(self.step, axle))
    }
}

/// Free rolling: the axles go with the body, x_k = X + a_k − h θ, and everything is evaluated where they are.
#[derive(Debug, Clone)]
pub struct Rolling<'a> {
    shapes: &'a ModeShapes,
    arms: Vec<f64>,
    cg_height: f64,
    /// Change of position [m] from pass to pass at which an axle counts as placed: what remains is far less.
    tolerance: f64,
    positions: Vec<f64>,
    /// The panel of each axle, from its predicted position and held through the step, so that passes converge.
    panels: Vec<Option<usize>>,
    /// φ and φ' by axle and mode.
    values: Vec<[f64; 2]>,
}

impl<'a> Rolling<'a> {
    /// With the centre of mass at `travel` [m], not pitched.
    pub fn new(shapes: &'a ModeShapes, arms: Vec<f64>, cg_height: f64, travel: f64) -> Self {
        let axles = arms.len();
        let mut path = Rolling {
            shapes,
            arms,
            cg_height,
            tolerance: 1e-11 * shapes.mesh.length(),
            positions: vec![0.0; axles],
            panels: vec![None; axles],
            values: vec![[0.0; 2]; axles * shapes.modes],
        };
        path.predict(travel, 0.0);
        path
    }

    fn place(&mut self, axle: usize, x: f64) {
        self.positions[axle] = x;
        let values = &mut self.values[axle * self.shapes.modes..(axle + 1) * self.shapes.modes];
        match self.panels[axle] {
            Some(panel) => {
                let fraction = self.shapes.mesh.fraction(panel, x);
                for (m, value) in values.iter_mut().enumerate() {
                    *value = [self.shapes.value(panel, fraction, m), self.shapes.slope(panel, fraction, m)];
                }
            }
            None => values.fill([0.0; 2]),
        }
    }
}

impl Geometry<f64> for Rolling<'_> {
    fn predict(&mut self, travel: f64, pitch: f64) {
        for axle in 0..self.arms.len() {
            let x = travel + self.arms[axle] - self.cg_height * pitch;
            self.panels[axle] = self.shapes.mesh.panel_at(x);
            self.place(axle, x);
        }
    }

    fn follow(&mut self, travel: f64, pitch: f64) -> bool {
        let mut moving = false;
        for axle in 0..self.arms.len() {
            let x = travel + self.arms[axle] - self.cg_height * pitch;
            if (x - self.positions[axle]).abs() > self.tolerance {
                self.place(axle, x);
                moving = true;
            }
        }
        moving
    }

    fn shape(&self, axle: usize, mode: usize) -> f64 {
        self.values[axle * self.shapes.modes + mode][0]
    }

    fn slope(&self, axle: usize, mode: usize) -> f64 {
        self.values[axle * self.shapes.modes + mode][1]
    }

    fn position(&self, axle: usize) -> f64 {
        self.positions[axle]
    }
}
