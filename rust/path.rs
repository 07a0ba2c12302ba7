//! Where the contacts are and what lies under them: prescribed beforehand, or following the vehicles.

use crate::lane::Lane;
use crate::line::{Line, Mesh};
use crate::newmark::Coordinate;
use crate::road::Road;
use crate::step::{Geometry, Surface};

/// Jump of a slope, relative to the steepest, from which on it is a kink and not rounding.
const KINK: f64 = 1e-6;

/// Change of an axle's position, relative to the length of the bridge, at which it counts as placed. The guess from the last
/// accelerations is off by the cube of the step, so that this takes nothing from the order.
const PLACED: f64 = 1e-9;

/// The same where forces follow the speed of the axle too, which is off by the square of the step.
const PLACED_BY_RATES: f64 = 1e-11;

/// Steps of prescribed motion that are laid out at a time, so that a crossing can be ended between them.
const LAID: usize = 64;

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

    fn value(&self, panel: usize, fraction: f64, mode: usize) -> f64 {
        let [c0, c1, c2, c3] = self.cubics[panel * self.modes + mode];
        c0 + fraction * (c1 + fraction * (c2 + fraction * c3))
    }

    /// Value, slope and curvature.
    fn rates(&self, panel: usize, fraction: f64, mode: usize) -> [f64; 3] {
        let [_, c1, c2, c3] = self.cubics[panel * self.modes + mode];
        let width = self.mesh.width(panel);
        [
            self.value(panel, fraction, mode),
            (c1 + fraction * (2.0 * c2 + fraction * 3.0 * c3)) / width,
            (2.0 * c2 + fraction * 6.0 * c3) / width.powi(2),
        ]
    }
}

/// How far a road has faded in after a way t, from 0 to 1, of its ramp [m], with two derivatives along the way.
pub fn fade(t: f64, ramp: f64) -> [f64; 3] {
    // 6t⁵ − 15t⁴ + 10t³: no jump in value, slope or curvature at either end.
    [
        t * t * t * (10.0 + t * (6.0 * t - 15.0)),
        30.0 * t * t * (1.0 - t).powi(2) / ramp,
        60.0 * t * (1.0 - t) * (1.0 - 2.0 * t) / ramp.powi(2),
    ]
}

/// A road on the way of one vehicle, its unevenness fading in from where the vehicle starts.
#[derive(Debug, Clone)]
pub struct Pavement {
    /// The road off its datum: see [`Road::datum`].
    pub road: Road,
    /// Where the vehicle's front starts, from the left end of the bridge [m].
    pub start: f64,
    /// From where on it is level, not being known [m].
    pub end: f64,
    /// Way on which the unevenness fades in [m].
    pub ramp: f64,
    /// +1 for travel to the right, −1 to the left.
    pub direction: f64,
}

/// What of a road counts at a place on the way of a vehicle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Share {
    /// Nothing: the road is level there.
    Level,
    /// A part of it, with the first two derivatives along the bridge of that part.
    Faded([f64; 3]),
    /// All of it.
    Whole,
    /// Its elevation where it ends, from where on it is level.
    Beyond,
}

impl Share {
    /// The surface, from elevation, slope and curvature of the road.
    #[inline(always)]
    pub fn of<L: Lane>(&self, [elevation, slope, curvature]: [L; 3]) -> Surface<L> {
        let zero = L::splat(0.0);
        match *self {
            Share::Level => Surface { elevation: zero, slope: zero, curvature: zero },
            Share::Whole => Surface { elevation, slope, curvature },
            Share::Beyond => Surface { elevation, slope: zero, curvature: zero },
            Share::Faded([fade, fade_1, fade_2]) => {
                let (fade, fade_1, fade_2) = (L::splat(fade), L::splat(fade_1), L::splat(fade_2));
                Surface {
                    elevation: fade * elevation,
                    slope: fade * slope + fade_1 * elevation,
                    curvature: fade * curvature + L::splat(2.0) * fade_1 * slope + fade_2 * elevation,
                }
            }
        }
    }
}

impl Pavement {
    /// What of the road counts at x [m], and where to look for it.
    pub fn share(&self, x: f64) -> (Share, f64) {
        let way = self.direction * (x - self.start);
        // Without a ramp the road is there behind the start too, under the axles that follow the first.
        if way <= 0.0 && self.ramp > 0.0 {
            (Share::Level, x)
        } else if self.direction * (x - self.end) > 0.0 {
            (Share::Beyond, self.end)
        } else if self.ramp == 0.0 || way >= self.ramp {
            (Share::Whole, x)
        } else {
            let [fade, fade_1, fade_2] = fade(way / self.ramp, self.ramp);
            (Share::Faded([fade, self.direction * fade_1, fade_2]), x)
        }
    }

    /// The surface at x [m].
    pub fn at(&self, x: f64) -> Surface<f64> {
        if self.road.is_smooth() {
            return Surface::LEVEL;
        }
        let (share, x) = self.share(x);
        if share == Share::Level {
            return Surface::LEVEL;
        }
        let point = self.road.at(x);
        share.of([point.elevation, point.slope, point.curvature])
    }
}

/// What is common to both ways of moving: the bridge, and under each contact the road of its vehicle.
#[derive(Debug, Clone)]
pub struct Ground<'a> {
    /// The modes along the bridge.
    pub shapes: &'a ModeShapes,
    /// Roads, vehicle by vehicle.
    pub pavements: Vec<Option<Pavement>>,
    /// The vehicle of each contact.
    pub vehicle: Vec<usize>,
}

impl Ground<'_> {
    fn pavement(&self, contact: usize) -> Option<&Pavement> {
        self.pavements[self.vehicle[contact]].as_ref()
    }
}

/// Prescribed motion: known beforehand, so that one table serves every sample that moves alike.
#[derive(Debug, Clone)]
pub struct Prescribed<'a, M> {
    ground: Ground<'a>,
    /// Motion along the bridge of a contact at a step.
    motion: M,
    contacts: usize,
    step: usize,
    /// Motion along the bridge by step and contact.
    motions: Vec<Coordinate<f64>>,
    /// How many derivatives the table holds, the value included: one or three.
    kinds: usize,
    /// Φ⁰ and its derivatives by step, contact and mode.
    table: Vec<f64>,
    surfaces: Vec<Surface<f64>>,
}

impl<'a, M: Fn(usize, usize) -> Coordinate<f64>> Prescribed<'a, M> {
    /// With the contacts moving along the bridge as `motion` says at each step, of which there will be so many and perhaps a
    /// tail; with `slopes` and curvatures of the modes if the step asks for them.
    pub fn new(ground: Ground<'a>, motion: M, steps: usize, slopes: bool) -> Self {
        let kinds = if slopes { 3 } else { 1 };
        let (shapes, contacts) = (ground.shapes, ground.vehicle.len());
        let mut motions = Vec::new();
        motions.reserve_exact((steps + 2) * contacts);
        let mut table = Vec::new();
        table.reserve_exact((steps + 2) * contacts * shapes.modes * kinds);
        let surfaces = vec![Surface::LEVEL; contacts];
        let mut path = Prescribed { ground, motion, contacts, step: 0, motions, kinds, table, surfaces };
        path.lay(2);
        path.look_down();
        path
    }

    /// Lays the table out for so many more steps.
    fn lay(&mut self, steps: usize) {
        let from = self.motions.len() / self.contacts;
        for step in from..from + steps {
            for contact in 0..self.contacts {
                let motion = (self.motion)(step, contact);
                self.motions.push(motion);
                self.ground.shapes.extend_at(motion.x, self.kinds, &mut self.table);
            }
        }
    }

    fn here(&self) -> &[Coordinate<f64>] {
        &self.motions[self.step * self.contacts..(self.step + 1) * self.contacts]
    }

    fn look_down(&mut self) {
        let here = &self.motions[self.step * self.contacts..];
        for (contact, (surface, motion)) in self.surfaces.iter_mut().zip(here).enumerate() {
            if let Some(pavement) = self.ground.pavement(contact) {
                *surface = pavement.at(motion.x);
            }
        }
    }

    fn entry(&self, contact: usize, mode: usize) -> usize {
        ((self.step * self.contacts + contact) * self.ground.shapes.modes + mode) * self.kinds
    }
}

impl<L: Lane, M: Fn(usize, usize) -> Coordinate<f64>> Geometry<L> for Prescribed<'_, M> {
    fn advance(&mut self) {
        self.step += 1;
        // One more than where they are, for the look ahead.
        if self.motions.len() < (self.step + 2) * self.contacts {
            self.lay(LAID);
        }
        self.look_down();
    }

    fn follow(&mut self, _contact: usize, _motion: Coordinate<L>, _new_step: bool) -> L::Mask {
        L::never()
    }

    fn steady(&self) -> bool {
        let next = &self.motions[(self.step + 1) * self.contacts..];
        next.iter().take(self.contacts).all(|motion| motion.a == 0.0)
    }

    fn motion(&self, contact: usize) -> Coordinate<L> {
        let Coordinate { x, v, a } = self.here()[contact];
        Coordinate { x: L::splat(x), v: L::splat(v), a: L::splat(a) }
    }

    fn shapes(&self, contact: usize, shapes: &mut [L]) {
        let table = self.table[self.entry(contact, 0)..].iter().step_by(self.kinds);
        for (shape, &value) in shapes.iter_mut().zip(table) {
            *shape = L::splat(value);
        }
    }

    fn slope(&self, contact: usize, mode: usize) -> L {
        L::splat(self.table[self.entry(contact, mode) + 1])
    }

    fn curvature(&self, contact: usize, mode: usize) -> L {
        L::splat(self.table[self.entry(contact, mode) + 2])
    }

    fn surface(&self, contact: usize) -> Surface<L> {
        let Surface { elevation, slope, curvature } = self.surfaces[contact];
        Surface { elevation: L::splat(elevation), slope: L::splat(slope), curvature: L::splat(curvature) }
    }
}

/// Free motion: each contact goes where its vehicle or a schedule has it, and everything is evaluated there.
#[derive(Debug, Clone)]
pub struct Free<'a, M> {
    ground: Ground<'a>,
    /// Prescribed motion of a contact along the bridge at a step, or none where it follows its vehicle.
    motion: M,
    step: usize,
    /// Whether a vehicle travels to the left.
    mirrored: Vec<bool>,
    /// Change of position [m] from the guess, or from pass to pass, at which an axle counts as placed.
    tolerance: f64,
    motions: Vec<Coordinate<f64>>,
    /// The panel of each contact, from its predicted position and held through the step, so that passes converge.
    panels: Vec<Option<usize>>,
    /// φ, φ' and φ'' by contact and mode.
    values: Vec<[f64; 3]>,
    surfaces: Vec<Surface<f64>>,
}

impl<'a, M: Fn(usize, usize) -> Option<Coordinate<f64>>> Free<'a, M> {
    /// With the contacts at `start`, in the direction of the bridge; `rates` tells whether forces follow rates too.
    pub fn new(ground: Ground<'a>, motion: M, mirrored: Vec<bool>, start: Vec<Coordinate<f64>>, rates: bool) -> Self {
        let (contacts, modes) = (start.len(), ground.shapes.modes);
        let mut path = Free {
            tolerance: if rates { PLACED_BY_RATES } else { PLACED } * ground.shapes.mesh.length(),
            ground,
            motion,
            step: 0,
            mirrored,
            motions: start.clone(),
            panels: vec![None; contacts],
            values: vec![[0.0; 3]; contacts * modes],
            surfaces: vec![Surface::LEVEL; contacts],
        };
        for (contact, motion) in start.into_iter().enumerate() {
            path.put(contact, motion, true);
        }
        path
    }

    /// Stops a contact where it is.
    pub fn stop(&mut self, contact: usize) {
        let Coordinate { x, .. } = self.motions[contact];
        self.motions[contact] = Coordinate { x, v: 0.0, a: 0.0 };
    }

    fn put(&mut self, contact: usize, motion: Coordinate<f64>, new_step: bool) {
        let (shapes, x) = (self.ground.shapes, motion.x);
        if new_step {
            self.panels[contact] = shapes.mesh.panel_at(x);
        }
        self.motions[contact] = motion;
        if let Some(pavement) = self.ground.pavement(contact) {
            self.surfaces[contact] = pavement.at(x);
        }
        let values = &mut self.values[contact * shapes.modes..(contact + 1) * shapes.modes];
        match self.panels[contact] {
            Some(panel) => {
                let fraction = shapes.mesh.fraction(panel, x);
                for (m, value) in values.iter_mut().enumerate() {
                    *value = shapes.rates(panel, fraction, m);
                }
            }
            None => values.fill([0.0; 3]),
        }
    }
}

impl<M: Fn(usize, usize) -> Option<Coordinate<f64>>> Geometry<f64> for Free<'_, M> {
    fn advance(&mut self) {
        self.step += 1;
        for contact in 0..self.motions.len() {
            if let Some(motion) = (self.motion)(self.step, contact) {
                self.put(contact, motion, true);
            }
        }
    }

    fn follow(&mut self, contact: usize, motion: Coordinate<f64>, new_step: bool) -> bool {
        let motion = match self.mirrored[self.ground.vehicle[contact]] {
            false => motion,
            true => Coordinate { x: self.ground.shapes.mesh.length() - motion.x, v: -motion.v, a: -motion.a },
        };
        let moving = new_step || (motion.x - self.motions[contact].x).abs() > self.tolerance;
        if moving {
            self.put(contact, motion, new_step);
        }
        moving
    }

    fn motion(&self, contact: usize) -> Coordinate<f64> {
        self.motions[contact]
    }

    fn shapes(&self, contact: usize, shapes: &mut [f64]) {
        for (shape, value) in shapes.iter_mut().zip(&self.values[contact * self.ground.shapes.modes..]) {
            *shape = value[0];
        }
    }

    fn slope(&self, contact: usize, mode: usize) -> f64 {
        self.values[contact * self.ground.shapes.modes + mode][1]
    }

    fn curvature(&self, contact: usize, mode: usize) -> f64 {
        self.values[contact * self.ground.shapes.modes + mode][2]
    }

    fn surface(&self, contact: usize) -> Surface<f64> {
        self.surfaces[contact]
    }
}
