//! What constant loads do to the modes as they go over the bridge at one speed: between two kinks a cubic in time.
//!
//! Where the modes are a cubic in each panel, so is ΦᵀP along the way of each load. Over a step it is the cubic on which
//! the load stands at the beginning, and from each node on that it passes, what the next differs from that.

use super::oscillator::POWERS;
use crate::lane::Lane;
use crate::modal_bridge::ModeShapes;

/// Jump of a derivative at a node, relative to the largest of its kind, from which on it is a kink and not rounding.
const KINK: f64 = 1e-12;

/// Modal forces over a step, by the derivatives of each with respect to time in steps.
#[derive(Debug, Clone)]
pub struct ModalForces<N> {
    /// At the beginning, by mode.
    pub forces: Vec<[N; POWERS]>,
    /// What sets in within the step: how long before its end, in steps, and the least derivative that jumps.
    pub onsets: Vec<(f64, usize)>,
    /// By how much, by onset and mode.
    pub jumps: Vec<[N; POWERS]>,
    /// Modal forces at the end.
    pub end: Vec<N>,
}

impl<N> ModalForces<N> {
    /// Nothing yet.
    pub fn nothing() -> Self {
        ModalForces { forces: Vec::new(), onsets: Vec::new(), jumps: Vec::new(), end: Vec::new() }
    }
}

impl<N: Lane> ModalForces<N> {
    /// Begins anew: so many modes without forces.
    #[inline(always)]
    pub fn clear(&mut self, modes: usize) {
        let zero = N::splat(0.0);
        self.onsets.clear();
        self.jumps.clear();
        self.forces.clear();
        self.forces.resize(modes, [zero; POWERS]);
        self.end.clear();
        self.end.resize(modes, zero);
    }
}

/// The modes along the bridge as loads meet them.
#[derive(Debug, Clone)]
pub struct Drive {
    shapes: ModeShapes,
    /// Way of a step [m], negative to the left, and its powers.
    way: f64,
    ways: [f64; POWERS],
    /// By node, the least derivative that jumps there.
    kinks: Vec<Option<usize>>,
    /// From left to right, by node and mode.
    jumps: Vec<[f64; POWERS]>,
}

impl Drive {
    /// Of loads that go this way in each step [m], to the left if it is negative.
    pub fn new(shapes: &ModeShapes, way: f64) -> Self {
        let (modes, panels) = (shapes.modes(), shapes.mesh().panels());
        let derivatives = |panel: Option<usize>, fraction: f64, mode: usize| match panel {
            Some(panel) if panel < panels => shapes.derivatives(panel, fraction, mode),
            _ => [0.0; POWERS],
        };
        let mut jumps = Vec::with_capacity((panels + 1) * modes);
        let mut largest = vec![[0.0_f64; POWERS]; modes];
        for node in 0..=panels {
            for (mode, largest) in largest.iter_mut().enumerate() {
                let [before, after] = [derivatives(node.checked_sub(1), 1.0, mode), derivatives(Some(node), 0.0, mode)];
                jumps.push(std::array::from_fn(|p| after[p] - before[p]));
                for (p, largest) in largest.iter_mut().enumerate() {
                    *largest = largest.max(before[p].abs()).max(after[p].abs());
                }
            }
        }
        let kink = |of_modes: &[[f64; POWERS]]| {
            let jumps = |p: usize| of_modes.iter().zip(&largest).any(|(jump, most)| jump[p].abs() > KINK * most[p]);
            (0..POWERS).find(|&p| jumps(p))
        };
        let kinks = (0..=panels).map(|node| kink(&jumps[node * modes..(node + 1) * modes])).collect();
        let ways = std::array::from_fn(|p| way.powi(p as i32));
        Drive { shapes: shapes.clone(), way, ways, kinks, jumps }
    }

    /// Bytes of what a step of a path leaves, and of what a load leaves on the way over the whole bridge.
    pub fn bytes(shapes: &ModeShapes) -> [f64; 2] {
        let of_mode = size_of::<[f64; POWERS]>();
        let step = size_of::<ModalForces<f64>>() + shapes.modes() * (of_mode + size_of::<f64>());
        let node = size_of::<(f64, usize)>() + shapes.modes() * of_mode;
        [step as f64, (2 * node * (shapes.mesh().panels() + 1)) as f64]
    }

    /// What these loads [N] do in the step that ends with this number; `x` is where they are at the end of a step [m].
    #[inline(always)]
    pub fn at<N: Lane>(&self, step: usize, x: impl Fn(usize, usize) -> f64, loads: &[N], driving: &mut ModalForces<N>) {
        driving.clear(self.shapes.modes());
        self.add(step, x, loads, driving);
    }

    /// The same beside what others do.
    #[inline(always)]
    pub fn add<N: Lane>(
        &self,
        step: usize,
        x: impl Fn(usize, usize) -> f64,
        loads: &[N],
        driving: &mut ModalForces<N>,
    ) {
        for (axle, load) in loads.iter().enumerate() {
            let now = x(step, axle);
            if let Some((panel, fraction)) = self.place(now) {
                for (mode, end) in driving.end.iter_mut().enumerate() {
                    *end = *end + *load * N::splat(self.shapes.derivatives(panel, fraction, mode)[0]);
                }
            }
            if step > 0 {
                self.load([x(step - 1, axle), now], *load, driving);
            }
        }
    }

    fn place(&self, x: f64) -> Option<(usize, f64)> {
        let mesh = self.shapes.mesh();
        mesh.panel_at(x).map(|panel| (panel, mesh.fraction(panel, x)))
    }

    /// Adds one load on its way from one position to another.
    #[inline(always)]
    fn load<N: Lane>(&self, [from, to]: [f64; 2], load: N, driving: &mut ModalForces<N>) {
        let (modes, mesh, rightward) = (self.shapes.modes(), self.shapes.mesh(), self.way > 0.0);
        let last = mesh.panels();
        let place = self.place(from);
        if let Some((panel, fraction)) = place {
            for (mode, force) in driving.forces.iter_mut().enumerate() {
                let derivatives = self.shapes.derivatives(panel, fraction, mode);
                for p in 0..POWERS {
                    force[p] = force[p] + load * N::splat(self.ways[p] * derivatives[p]);
                }
            }
        }
        // The nodes ahead, as far as it comes.
        let ahead = match (place, rightward) {
            (Some((panel, _)), true) => panel + 1..last + 1,
            (Some((panel, _)), false) => 0..panel + 1,
            (None, right) if right == (from < 0.0) => 0..last + 1,
            (None, _) => 0..0,
        };
        let (first, count) = (ahead.start, ahead.len());
        for i in 0..count {
            let node = if rightward { first + i } else { first + count - 1 - i };
            let since = (to - mesh.nodes()[node]) / self.way;
            if since <= 0.0 {
                break;
            }
            let Some(least) = self.kinks[node] else { continue };
            driving.onsets.push((since, least));
            let sign = if rightward { 1.0 } else { -1.0 };
            for jump in &self.jumps[node * modes..(node + 1) * modes] {
                driving.jumps.push(std::array::from_fn(|p| load * N::splat(sign * self.ways[p] * jump[p])));
            }
        }
    }
}
