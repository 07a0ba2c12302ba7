//! The tables of geometry of a run: each made when the first samples that share it come, gone when the last have.
//!
//! Samples that share a table, those of one kind of event and step, are one march. Workers take portions of samples in
//! order, march after march, so that no more tables stand here at a time than there are workers, however many kinds of
//! event there are.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use super::results::Format;
use super::side_by_side;
use super::study::{March, Study};
use super::table::Layout;
use super::tabulated::Shared;
use crate::error::Error;
use crate::stop_token::StopToken;

/// So many samples are less work on their own ways than to lay out the geometry for all.
const FEW: usize = 8;

/// The same of constant loads, which nobody else's go beside.
const FEW_DRIVEN: usize = 2;

/// Whether so many samples of a march are few.
pub fn are_few(samples: usize, driven: bool) -> bool {
    samples <= if driven { FEW_DRIVEN } else { FEW }
}

/// The place of a march.
#[derive(Debug)]
pub struct Shelf {
    march: March,
    /// Whether its samples are few: they go their own ways, and nothing is laid out for them.
    pub few: bool,
    layout: Layout,
    shared: Mutex<Option<Arc<Shared>>>,
    /// Portions of its samples that are not done.
    left: AtomicUsize,
    /// What stays of it: its static extremes, if samples share them.
    stays: OnceLock<Vec<f64>>,
}

impl Shelf {
    /// Of a march that this many portions of samples take.
    pub fn new(march: March, few: bool, layout: Layout, portions: usize) -> Self {
        let left = AtomicUsize::new(portions);
        Shelf { march, few, layout, shared: Mutex::new(None), left, stays: OnceLock::new() }
    }

    /// What its samples share, made now if nobody has.
    pub fn take(&self, study: &Study, format: &Format, stop: StopToken<'_>) -> Result<Arc<Shared>, Error> {
        let mut shared = self.shared.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(shared) = &*shared {
            return Ok(Arc::clone(shared));
        }
        let table = study.table(self.march, self.layout.clone(), stop)?;
        if !format.own_statics {
            self.stays.get_or_init(|| side_by_side::at_rest(study, self.march.0, &table));
        }
        Ok(Arc::clone(shared.insert(Arc::new(Shared::new(table)))))
    }

    /// One portion is done.
    pub fn give_back(&self) {
        if self.left.fetch_sub(1, Ordering::Relaxed) == 1 {
            *self.shared.lock().unwrap_or_else(PoisonError::into_inner) = None;
        }
    }

    /// Leaves static extremes that were found otherwise.
    pub fn leave(&self, statics: impl FnOnce() -> Vec<f64>) {
        self.stays.get_or_init(statics);
    }

    /// Static extremes, largest of all responses and then smallest; not numbers where no sample came.
    pub fn leaves(self, format: &Format) -> Vec<f64> {
        self.stays.into_inner().unwrap_or_else(|| vec![f64::NAN; 2 * format.responses])
    }
}
