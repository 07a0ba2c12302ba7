//! A vehicle in a step: what its coordinates do under contact forces, friction and forces along the road.

use nalgebra::{DMatrix, DVector};

use super::newmark::Newmark;
use crate::coordinate::Coordinate;
use crate::lane::Lane;
use crate::lane::gather::gather;
use crate::vehicle::dense;
use crate::vehicle::equations::Assembly;

/// A vehicle's matrices for steps of one length. Elements are its contacts, then its friction elements.
#[derive(Debug, Clone)]
pub struct VehicleSolve<L> {
    /// Number of coordinates.
    pub size: usize,
    /// Number of contacts.
    pub contacts: usize,
    /// Number of elements.
    pub elements: usize,
    /// Mass of the whole vehicle [kg].
    pub total_mass: L,
    /// C and K by rows; none where both are zero, as of a body on massless axles.
    linear: Option<Linear<L>>,
    /// (M + ½hC + βh²K)⁻¹ by rows.
    inverse: Vec<L>,
    /// Shortening of each element per unit of each coordinate, by rows.
    rows: Vec<L>,
    /// Accelerations under unit element forces, inverse·rowᵀ, element by element.
    receptance: Vec<L>,
    /// Accelerations of the elements under unit element forces, row_i·inverse·row_jᵀ, by rows.
    coupling: Vec<L>,
    /// How the contacts move along the road with the coordinates, by rows; none where that makes no difference.
    surge_rows: Option<Vec<L>>,
    /// Accelerations under unit forces along the road at the contacts.
    surge_receptance: Vec<L>,
    /// Accelerations without element forces; zero while nothing but those acts.
    free: Vec<L>,
    /// The end of the step without element forces.
    unloaded: Vec<Coordinate<L>>,
    /// −(C v + K x) of the prediction.
    resisting: Vec<L>,
}

gather!(VehicleSolve {
    size,
    contacts,
    elements,
    total_mass,
    linear,
    inverse,
    rows,
    receptance,
    coupling,
    surge_rows,
    surge_receptance,
    free,
    unloaded,
    resisting,
});

/// Springs and dampers between the coordinates: C and K by rows.
#[derive(Debug, Clone)]
struct Linear<L> {
    damping: Vec<L>,
    stiffness: Vec<L>,
}

gather!(Linear { damping, stiffness });

impl<L: Lane> VehicleSolve<L> {
    /// The same vehicle in every lane. One that `rolls` freely has inertia against the pitching of its parts along the
    /// road; `extra_mass` is added to M besides, if given.
    pub fn new(assembly: &Assembly, rolls: bool, extra_mass: Option<&DMatrix<f64>>, h: f64, beta: f64) -> Self {
        let size = assembly.mass.nrows();
        let mut mass = assembly.mass.clone();
        if rolls {
            mass += &assembly.surge_mass;
        }
        if let Some(extra) = extra_mass {
            mass += extra;
        }
        let effective = &mass + &assembly.damping * (0.5 * h) + &assembly.stiffness * (beta * h * h);
        // An assembly's mass matrix is positive definite, and the rest does not take from it.
        let inverse = dense::inverse(effective).unwrap_or_else(|| DMatrix::from_element(size, size, f64::NAN));
        let contact_rows = assembly.contacts.iter().map(|c| &c.row);
        let rows: Vec<&DVector<f64>> = contact_rows.chain(assembly.frictions.iter().map(|f| &f.row)).collect();
        let receptance: Vec<DVector<f64>> = rows.iter().map(|row| product(&inverse, row)).collect();
        let couplings = rows.iter().flat_map(|row| receptance.iter().map(|r| row.dot(r)));
        let by_rows = |m: &DMatrix<f64>| m.transpose().iter().copied().map(L::splat).collect::<Vec<L>>();
        let flat = |all: &[DVector<f64>]| all.iter().flat_map(|v| v.iter().copied().map(L::splat)).collect::<Vec<L>>();
        let surge_rows: Vec<DVector<f64>> = assembly.contacts.iter().map(|c| c.surge_row.clone()).collect();
        let surge_receptance: Vec<DVector<f64>> = surge_rows.iter().map(|row| product(&inverse, row)).collect();
        let zero = L::splat(0.0);
        let linear = assembly.damping.iter().chain(assembly.stiffness.iter()).any(|&v| v != 0.0);
        VehicleSolve {
            size,
            contacts: assembly.contacts.len(),
            elements: rows.len(),
            total_mass: L::splat(assembly.total_mass),
            linear: linear
                .then(|| Linear { damping: by_rows(&assembly.damping), stiffness: by_rows(&assembly.stiffness) }),
            inverse: by_rows(&inverse),
            coupling: couplings.map(L::splat).collect(),
            receptance: flat(&receptance),
            rows: rows.iter().flat_map(|row| row.iter().copied().map(L::splat)).collect(),
            surge_rows: surge_rows.iter().any(|row| row.iter().any(|&v| v != 0.0)).then(|| flat(&surge_rows)),
            surge_receptance: flat(&surge_receptance),
            free: vec![zero; size],
            unloaded: vec![Coordinate::rest(); size],
            resisting: vec![zero; size],
        }
    }

    /// C, K and (M + ½hC + βh²K)⁻¹ by rows; the first two empty where both are zero.
    pub fn matrices(&self) -> [&[L]; 3] {
        let [damping, stiffness] = match &self.linear {
            Some(Linear { damping, stiffness }) => [&damping[..], stiffness],
            None => [&[][..]; 2],
        };
        [damping, stiffness, &self.inverse]
    }

    /// Shortening of each element per unit of each coordinate, by rows.
    pub fn rows(&self) -> &[L] {
        &self.rows
    }

    /// Accelerations under unit element forces, element by element.
    pub fn receptance(&self) -> &[L] {
        &self.receptance
    }

    /// Whether there are no springs and dampers between the coordinates.
    pub fn bare(&self) -> bool {
        self.linear.is_none()
    }

    /// Whether forces along the road move the coordinates.
    pub fn surges(&self) -> bool {
        self.surge_rows.is_some()
    }

    /// Begins a step, `passive` if nothing but element forces acts on the coordinates in it; `predicted` is where they
    /// would be at its end if their accelerations there were zero.
    #[inline(always)]
    pub fn predict(
        &mut self,
        newmark: &Newmark<L>,
        state: &[Coordinate<L>],
        predicted: &mut [Coordinate<L>],
        passive: bool,
    ) {
        let size = state.len();
        for (predicted, c) in predicted.iter_mut().zip(state) {
            *predicted = newmark.predict(*c);
        }
        if passive {
            return;
        }
        if let Some(Linear { damping, stiffness }) = &self.linear {
            for (i, resisting) in self.resisting[..size].iter_mut().enumerate() {
                let (c, k) = (&damping[i * size..][..size], &stiffness[i * size..][..size]);
                let mut sum = L::splat(0.0);
                for ((c, k), q) in c.iter().zip(k).zip(predicted.iter()) {
                    sum = sum - (*c * q.v + *k * q.x);
                }
                *resisting = sum;
            }
        }
    }

    /// Works out the step without element forces, under forces along the road at the contacts [N].
    #[inline(always)]
    pub fn surge(&mut self, newmark: &Newmark<L>, predicted: &[Coordinate<L>], along: &[L]) {
        let size = self.size;
        let free = &mut self.free[..size];
        for (i, free) in free.iter_mut().enumerate() {
            *free = L::splat(0.0);
            if self.linear.is_some() {
                for (e, f) in self.inverse[i * size..][..size].iter().zip(&self.resisting) {
                    *free = *free + *e * *f;
                }
            }
        }
        if self.surge_rows.is_some() {
            for (k, force) in along.iter().enumerate() {
                for (free, r) in free.iter_mut().zip(&self.surge_receptance[k * size..][..size]) {
                    *free = *free + *r * *force;
                }
            }
        }
        for ((unloaded, predicted), a) in self.unloaded.iter_mut().zip(predicted).zip(free.iter()) {
            *unloaded = newmark.correct(*predicted, *a);
        }
    }

    /// How an element's shortening follows from the coordinates, and what they are without element forces.
    #[inline(always)]
    pub fn unloaded<'s>(
        &'s self,
        element: usize,
        predicted: &'s [Coordinate<L>],
        passive: bool,
    ) -> impl Iterator<Item = (&'s L, &'s Coordinate<L>)> {
        let size = predicted.len();
        let unloaded = if passive { predicted } else { &self.unloaded[..size] };
        self.rows[element * size..][..size].iter().zip(unloaded)
    }

    /// Shortening of an element.
    pub fn shortening(&self, element: usize, coordinates: &[L]) -> L {
        let rows = self.rows[element * self.size..][..self.size].iter().zip(coordinates);
        rows.fold(L::splat(0.0), |sum, (row, q)| sum + *row * *q)
    }

    /// Accelerations of element i under unit forces of all elements.
    pub fn coupling(&self, i: usize) -> &[L] {
        &self.coupling[i * self.elements..(i + 1) * self.elements]
    }

    /// Ends a step under the element forces: contacts', then friction's.
    #[inline(always)]
    pub fn correct(
        &self,
        newmark: &Newmark<L>,
        predicted: &[Coordinate<L>],
        [contacts, frictions]: [&[L]; 2],
        state: &mut [Coordinate<L>],
        passive: bool,
    ) {
        let size = state.len();
        let receptance = &self.receptance[..(contacts.len() + frictions.len()) * size];
        for (i, (state, predicted)) in state.iter_mut().zip(predicted).enumerate() {
            let mut a = if passive { L::splat(0.0) } else { self.free[i] };
            for (k, force) in contacts.iter().enumerate() {
                a = a - receptance[k * size + i] * *force;
            }
            for (k, force) in (contacts.len()..).zip(frictions) {
                a = a - receptance[k * size + i] * *force;
            }
            *state = newmark.correct(*predicted, a);
        }
    }

    /// How far a contact is along the road beyond its place in the static state [m], and the two derivatives of that.
    #[inline(always)]
    pub fn along(&self, contact: usize, state: &[Coordinate<L>]) -> Coordinate<L> {
        let mut sum = Coordinate::rest();
        if let Some(rows) = &self.surge_rows {
            for (c, q) in rows[contact * self.size..(contact + 1) * self.size].iter().zip(state) {
                sum = Coordinate { x: sum.x + *c * q.x, v: sum.v + *c * q.v, a: sum.a + *c * q.a };
            }
        }
        sum
    }

    /// The coordinates at the end of the step if their accelerations stayed as they were in `state`.
    #[inline(always)]
    pub fn guess(
        newmark: &Newmark<L>,
        predicted: &[Coordinate<L>],
        state: &[Coordinate<L>],
        guess: &mut [Coordinate<L>],
    ) {
        for ((guess, predicted), before) in guess.iter_mut().zip(predicted).zip(state) {
            *guess = newmark.correct(*predicted, before.a);
        }
    }
}

/// A matrix times a vector that is mostly zero.
fn product(matrix: &DMatrix<f64>, vector: &DVector<f64>) -> DVector<f64> {
    let mut product = DVector::zeros(matrix.nrows());
    for (j, &factor) in vector.iter().enumerate().filter(|(_, factor)| **factor != 0.0) {
        product.axpy(factor, &matrix.column(j), 1.0);
    }
    product
}
