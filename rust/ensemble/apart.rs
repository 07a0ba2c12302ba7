//! Samples side by side each of which goes its own way: positions, panels and roads lane by lane.
//!
//! What holds for a while is held in lanes: of each vehicle the piece of its motion, of each contact the panel and the
//! cubics of the modes on it. A step then is the same arithmetic as that of one crossing alone, and only lanes that come
//! on to another piece or panel are looked up by themselves.

use crate::bridge::cubics::Mesh;
use crate::coordinate::Coordinate;
use crate::crossing::trip::Trip;
use crate::geometry::pavement::{Pavement, Share};
use crate::geometry::{Geometry, Surface};
use crate::lane::Lane;
use crate::modal_bridge::ModeShapes;
use crate::passage::Direction;
use crate::road::b_spline::{first, sum, weights};

/// The roads of the samples: their own random ones, by lane, beside what passages and settings have.
#[derive(Clone, Copy)]
pub struct Roads<'a, L> {
    /// Spline coefficients of the samples' own roads; none without them.
    pub own: &'a [L],
    /// Their period [m].
    pub period: f64,
    /// Way on which all fade in [m].
    pub ramp: f64,
    /// By lane and vehicle, the road that is given, and whether the sample's own is on top of it.
    pub given: &'a [Vec<(Option<Pavement>, bool)>],
}

/// Samples on their own ways, at a step.
pub struct Apart<'a, L> {
    trips: &'a [&'a Trip<'a>],
    shapes: &'a ModeShapes,
    roads: Roads<'a, L>,
    /// How many derivatives of modes and road are asked for, the value included: one or three.
    kinds: usize,
    step: usize,
    vehicles: Vec<Front<L>>,
    contacts: Vec<Under<L>>,
    /// Of the panels below the contacts, by contact and mode.
    cubics: Vec<[L; 4]>,
    /// By contact and mode.
    values: Vec<[L; 3]>,
}

/// The front of a vehicle, from the end at which it enters.
struct Front<L> {
    right: bool,
    /// Way of a step where motion is in equal steps of space, and speed.
    in_space: Option<[L; 2]>,
    h: L,
    entry: L,
    begun: Coordinate<L>,
    from: L,
    until: L,
    now: Coordinate<L>,
    next: Coordinate<L>,
    /// Where the road begins and ends to count.
    start: L,
    end: L,
}

/// What a contact stands on.
struct Under<L> {
    vehicle: usize,
    behind: L,
    motion: Coordinate<L>,
    /// Its panel goes from here to there.
    low: L,
    high: L,
    node: L,
    width: L,
    surface: Surface<L>,
}

impl<'a, L: Lane> Apart<'a, L> {
    /// At the start; of lanes without a sample the last stands for all.
    pub fn new(trips: &'a [&'a Trip<'a>], shapes: &'a ModeShapes, roads: Roads<'a, L>) -> Self {
        const { assert!(L::SAMPLES <= MOST) };
        let zero = L::splat(0.0);
        let trip = |lane: usize| trips[lane.min(trips.len() - 1)];
        let rest = Coordinate::rest();
        let pavement = |lane: usize, v: usize| roads.given[lane.min(trips.len() - 1)][v].0.as_ref();
        let front = |v: usize| Front {
            right: trips[0].courses[v].direction == Direction::Right,
            in_space: trips[0].steps.advance.is_some().then(|| {
                let way = L::from_fn(|lane| trip(lane).steps.advance.unwrap_or_default());
                [way, L::from_fn(|lane| trip(lane).courses[v].speed)]
            }),
            h: L::from_fn(|lane| trip(lane).steps.h),
            entry: L::from_fn(|lane| trip(lane).courses[v].entry),
            begun: rest,
            from: zero,
            until: L::splat(f64::NEG_INFINITY),
            now: rest,
            next: rest,
            start: L::from_fn(|lane| pavement(lane, v).map_or(0.0, |pavement| pavement.start)),
            end: L::from_fn(|lane| pavement(lane, v).map_or(0.0, |pavement| pavement.end)),
        };
        let under = |k: usize| {
            let vehicle = trips[0].owner[k];
            let own = k - trips[0].courses[vehicle].axles.start;
            Under {
                vehicle,
                behind: L::from_fn(|lane| trip(lane).courses[vehicle].behind[own]),
                motion: rest,
                low: L::splat(f64::INFINITY),
                high: L::splat(f64::NEG_INFINITY),
                node: zero,
                width: L::splat(1.0),
                surface: Surface { elevation: zero, slope: zero, curvature: zero },
            }
        };
        let contacts = trips[0].owner.len();
        let mut apart = Apart {
            trips,
            shapes,
            roads,
            kinds: if trips.iter().any(|trip| trip.follows_rates()) { 3 } else { 1 },
            step: 0,
            vehicles: (0..trips[0].courses.len()).map(front).collect(),
            contacts: (0..contacts).map(under).collect(),
            cubics: vec![[zero; 4]; contacts * shapes.modes()],
            values: vec![[zero; 3]; contacts * shapes.modes()],
        };
        apart.go(0);
        apart.arrive();
        apart
    }

    /// Where contacts are along the bridge [m].
    pub fn x(&self, contact: usize) -> L {
        self.contacts[contact].motion.x
    }

    /// Works out the fronts at a step, and at the one after.
    #[inline(always)]
    fn go(&mut self, step: usize) {
        for v in 0..self.vehicles.len() {
            let now = if step == 0 { self.front(v, 0) } else { self.vehicles[v].next };
            let next = self.front(v, step + 1);
            let vehicle = &mut self.vehicles[v];
            (vehicle.now, vehicle.next) = (now, next);
        }
    }

    /// Where the front of a vehicle is at a step.
    #[inline(always)]
    fn front(&mut self, v: usize, step: usize) -> Coordinate<L> {
        let vehicle = &mut self.vehicles[v];
        let step = L::splat(step as f64);
        if let Some([way, speed]) = vehicle.in_space {
            return Coordinate { x: way * step - L::splat(self.trips[0].approach), v: speed, a: L::splat(0.0) };
        }
        let t = step * vehicle.h - vehicle.entry;
        if L::any(!t.less(vehicle.until)) {
            Self::take_up(self.trips, v, vehicle, t);
        }
        let Coordinate { x, v, a } = vehicle.begun;
        let dt = t - vehicle.from;
        Coordinate { x: x + dt * (v + L::splat(0.5) * a * dt), v: v + a * dt, a }
    }

    /// Takes up the piece of each lane's motion at these times.
    #[inline(never)]
    fn take_up(trips: &[&Trip<'_>], v: usize, vehicle: &mut Front<L>, t: L) {
        let piece = |lane: usize| trips[lane.min(trips.len() - 1)].courses[v].motion.piece(t.get(lane));
        vehicle.begun = Coordinate {
            x: L::from_fn(|lane| piece(lane).0.x),
            v: L::from_fn(|lane| piece(lane).0.v),
            a: L::from_fn(|lane| piece(lane).0.a),
        };
        vehicle.from = L::from_fn(|lane| piece(lane).1[0]);
        vehicle.until = L::from_fn(|lane| piece(lane).1[1]);
    }

    /// Puts the contacts where their vehicles are.
    #[inline(always)]
    fn arrive(&mut self) {
        let (modes, length) = (self.shapes.modes(), L::splat(self.trips[0].length));
        for k in 0..self.contacts.len() {
            let Under { vehicle, behind, .. } = self.contacts[k];
            let front = &self.vehicles[vehicle];
            let Coordinate { x, v, a } = front.now;
            let way = x - behind;
            let motion = match front.right {
                true => Coordinate { x: way, v, a },
                false => Coordinate { x: length - way, v: -v, a: -a },
            };
            let x = motion.x;
            let contact = &mut self.contacts[k];
            contact.motion = motion;
            let cubics = &mut self.cubics[k * modes..][..modes];
            if L::any(x.less(contact.low)) || L::any(!x.less(contact.high)) {
                find_panel(self.shapes, contact, cubics);
            }
            let (t, width) = ((x - contact.node) / contact.width, contact.width);
            let values = &mut self.values[k * modes..][..modes];
            for (value, [c0, c1, c2, c3]) in values.iter_mut().zip(cubics) {
                value[0] = *c0 + t * (*c1 + t * (*c2 + t * *c3));
            }
            if self.kinds == 3 {
                let (two, three, six) = (L::splat(2.0), L::splat(3.0), L::splat(6.0));
                for (value, [_, c1, c2, c3]) in values.iter_mut().zip(&self.cubics[k * modes..][..modes]) {
                    value[1] = (*c1 + t * (two * *c2 + t * three * *c3)) / width;
                    value[2] = (two * *c2 + t * six * *c3) / (width * width);
                }
            }
            let surface = self.look_down(vehicle, x);
            self.contacts[k].surface = surface;
        }
    }

    /// Whether all of the road counts at these places in every lane: see [`Pavement::share`].
    #[inline(always)]
    fn is_whole(&self, vehicle: usize, x: L) -> bool {
        let Front { start, end, right, .. } = &self.vehicles[vehicle];
        let (way, beyond) = if *right { (x - *start, x - *end) } else { (*start - x, *end - x) };
        let faded = if self.roads.ramp > 0.0 { way.less(L::splat(self.roads.ramp)) } else { L::never() };
        !L::any(faded | L::splat(0.0).less(beyond))
    }

    /// What lies at these places under a contact of a vehicle.
    #[inline(always)]
    fn look_down(&self, vehicle: usize, x: L) -> Surface<L> {
        let Roads { own, period, given, .. } = self.roads;
        let zero = L::splat(0.0);
        let level = Surface { elevation: zero, slope: zero, curvature: zero };
        let samples = self.trips.len();
        let of = |lane: usize| &given[lane.min(samples - 1)][vehicle];
        if of(0).0.is_none() {
            return level;
        }
        let mut places = x;
        let mut shares = [Share::Whole; MOST];
        let whole = self.is_whole(vehicle, x);
        if !whole {
            for (lane, share) in shares.iter_mut().enumerate().take(L::SAMPLES) {
                let Some(pavement) = &of(lane).0 else { continue };
                let place;
                (*share, place) = pavement.share(x.get(lane));
                let before = places;
                places = L::from_fn(|other| if other == lane { place } else { before.get(other) });
            }
        }
        let mut parts = [zero; 3];
        if of(0).0.as_ref().is_some_and(|pavement| !pavement.road.is_smooth()) {
            let point = |lane: usize| {
                let point = of(lane).0.as_ref().map(|pavement| pavement.road.at(places.get(lane)));
                point.map_or([0.0; 3], |point| [point.elevation, point.slope, point.curvature])
            };
            let points: [[f64; 3]; MOST] =
                std::array::from_fn(|lane| if lane < L::SAMPLES { point(lane) } else { [0.0; 3] });
            for (kind, part) in parts.iter_mut().enumerate().take(self.kinds) {
                *part = L::from_fn(|lane| points[lane][kind]);
            }
        }
        if of(0).1 {
            let (points, per_metre) = (own.len(), own.len() as f64 / period);
            let position = places * L::splat(per_metre);
            let cell = L::from_fn(|lane| position.get(lane).floor());
            let all = weights(position - cell, per_metre);
            let mask = points - 1;
            let mut firsts = [0; MOST];
            for (lane, own) in firsts.iter_mut().enumerate().take(L::SAMPLES) {
                *own = first(cell.get(lane)) & mask;
            }
            let mut near = [zero; 4];
            for (k, near) in near.iter_mut().enumerate() {
                *near = L::from_fn(|lane| own[(firsts[lane] + k) & mask].get(lane));
            }
            for (part, weights) in parts.iter_mut().zip(all).take(self.kinds) {
                *part = *part + sum(weights, near);
            }
        }
        if whole {
            let [elevation, slope, curvature] = parts;
            return Surface { elevation, slope, curvature };
        }
        let each: [Surface<f64>; MOST] = std::array::from_fn(|lane| {
            if lane < L::SAMPLES { shares[lane].of(parts.map(|part| part.get(lane))) } else { Surface::LEVEL }
        });
        Surface {
            elevation: L::from_fn(|lane| each[lane].elevation),
            slope: L::from_fn(|lane| each[lane].slope),
            curvature: L::from_fn(|lane| each[lane].curvature),
        }
    }
}

/// Most lanes.
const MOST: usize = 16;

/// Finds the panels below a contact, and the modes on them.
#[inline(never)]
fn find_panel<L: Lane>(shapes: &ModeShapes, contact: &mut Under<L>, cubics: &mut [[L; 4]]) {
    let mesh = shapes.mesh();
    let x = contact.motion.x;
    let panels: [Option<usize>; MOST] =
        std::array::from_fn(|lane| if lane < L::SAMPLES { mesh.panel_at(x.get(lane)) } else { None });
    let stretch = |lane: usize| stretch(mesh, panels[lane], x.get(lane));
    contact.low = L::from_fn(|lane| stretch(lane)[0]);
    contact.high = L::from_fn(|lane| stretch(lane)[1]);
    contact.node = L::from_fn(|lane| panels[lane].map_or(0.0, |panel| mesh.nodes()[panel]));
    contact.width = L::from_fn(|lane| panels[lane].map_or(1.0, |panel| mesh.width(panel)));
    for (m, cubic) in cubics.iter_mut().enumerate() {
        for (power, own) in cubic.iter_mut().enumerate() {
            *own = L::from_fn(|lane| panels[lane].map_or(0.0, |panel| shapes.cubics(panel)[m][power]));
        }
    }
}

/// From where to where the panel of a place is the same, the end not among it; so where there is none.
fn stretch(mesh: &Mesh, panel: Option<usize>, x: f64) -> [f64; 2] {
    let rounding = 1e-12 * mesh.length();
    let ends = [-rounding, (mesh.length() + rounding).next_up()];
    match panel {
        None if x < 0.0 => [f64::NEG_INFINITY, ends[0]],
        None => [ends[1], f64::INFINITY],
        Some(panel) => [
            if panel == 0 { ends[0] } else { mesh.nodes()[panel] },
            if panel + 1 == mesh.panels() { ends[1] } else { mesh.nodes()[panel + 1] },
        ],
    }
}

impl<L: Lane> Geometry<L> for Apart<'_, L> {
    #[inline(always)]
    fn advance(&mut self) {
        self.step += 1;
        self.go(self.step);
        self.arrive();
    }

    #[inline(always)]
    fn steady(&self) -> bool {
        let zero = L::splat(0.0);
        self.vehicles.iter().all(|vehicle| !L::any(vehicle.next.a.less(zero) | zero.less(vehicle.next.a)))
    }

    #[inline(always)]
    fn motion(&self, contact: usize) -> Coordinate<L> {
        self.contacts[contact].motion
    }

    #[inline(always)]
    fn shapes(&self, contact: usize, shapes: &mut [L]) {
        for (shape, value) in shapes.iter_mut().zip(&self.values[contact * self.shapes.modes()..]) {
            *shape = value[0];
        }
    }

    #[inline(always)]
    fn slope(&self, contact: usize, mode: usize) -> L {
        self.values[contact * self.shapes.modes() + mode][1]
    }

    #[inline(always)]
    fn curvature(&self, contact: usize, mode: usize) -> L {
        self.values[contact * self.shapes.modes() + mode][2]
    }

    #[inline(always)]
    fn surface(&self, contact: usize) -> Surface<L> {
        self.contacts[contact].surface
    }
}
