//! The instruction set that a study runs on: the widest that the processor has, unless told otherwise.

use super::{Outcome, Plan, Sample};
use crate::error::Error;
use crate::lane::wide::Wide;

/// Samples side by side.
const SAMPLES: usize = 8;

/// An instruction set.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Isa {
    /// None in particular.
    Scalar,
    /// AVX2.
    Avx2,
}

impl Isa {
    /// The widest that the processor has.
    pub fn best() -> Self {
        #[cfg(target_arch = "x86_64")]
        if pulp::x86::V3::try_new().is_some() {
            return Isa::Avx2;
        }
        Isa::Scalar
    }
}

/// Samples side by side.
pub fn samples(_isa: Isa) -> usize {
    SAMPLES
}

struct Block<'a> {
    plan: &'a Plan,
    samples: &'a [Sample],
}

#[cfg(target_arch = "x86_64")]
impl pulp::NullaryFnOnce for Block<'_> {
    type Output = Result<Vec<Outcome>, Error>;

    #[inline(always)]
    fn call(self) -> Self::Output {
        self.plan.block::<Wide<SAMPLES>>(self.samples)
    }
}

/// Runs one block.
pub fn run(isa: Isa, plan: &Plan, samples: &[Sample]) -> Result<Vec<Outcome>, Error> {
    let block = Block { plan, samples };
    match isa {
        #[cfg(target_arch = "x86_64")]
        Isa::Avx2 => match pulp::x86::V3::try_new() {
            Some(simd) => simd.vectorize(block),
            None => Err(Error::input("SPANWISE_SIMD", "avx2", "this processor does not have it")),
        },
        _ => block.plan.block::<Wide<SAMPLES>>(block.samples),
    }
}
