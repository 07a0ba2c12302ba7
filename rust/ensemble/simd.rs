//! The instruction set that samples are marched with: the widest that the processor has, unless told otherwise.

use crate::error::Error;
use crate::lane::Lane;
use crate::lane::wide::Wide;
#[cfg(target_arch = "x86_64")]
use crate::lane::x86::{Avx2, Avx512};

/// Samples side by side in one group of lanes.
pub const SAMPLES: usize = 8;

/// The environment variable that chooses another than the widest.
pub const VARIABLE: &str = "SPANWISE_ISA";

/// An instruction set.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Isa {
    /// What every processor of its kind has: on x86-64 SSE2, on AArch64 NEON.
    Scalar,
    /// AVX2.
    Avx2,
    /// AVX-512.
    Avx512,
    /// NEON, which every AArch64 processor has.
    Neon,
}

impl Isa {
    /// All of them, from the narrowest to the widest.
    pub const ALL: [Isa; 4] = [Isa::Scalar, Isa::Neon, Isa::Avx2, Isa::Avx512];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Isa::Scalar => "scalar",
            Isa::Avx2 => "avx2",
            Isa::Avx512 => "avx512",
            Isa::Neon => "neon",
        }
    }

    /// Whether this processor has it.
    pub fn is_present(self) -> bool {
        match self {
            Isa::Scalar => true,
            #[cfg(target_arch = "x86_64")]
            Isa::Avx2 => pulp::x86::V3::try_new().is_some(),
            #[cfg(target_arch = "x86_64")]
            Isa::Avx512 => pulp::x86::V4::try_new().is_some(),
            #[cfg(target_arch = "aarch64")]
            Isa::Neon => true,
            #[allow(unreachable_patterns)] // on some processors
            _ => false,
        }
    }

    /// The widest that the processor has, or the one that the environment asks for.
    pub fn chosen() -> Result<Self, Error> {
        match std::env::var(VARIABLE) {
            Ok(name) if !name.is_empty() => Isa::named(&name),
            _ => Ok(Isa::present().last().unwrap_or(Isa::Scalar)),
        }
    }

    /// Those that the processor has, from the narrowest to the widest.
    pub fn present() -> impl Iterator<Item = Self> {
        Isa::ALL.into_iter().filter(|isa| isa.is_present())
    }

    fn named(name: &str) -> Result<Self, Error> {
        Isa::present().find(|isa| isa.name() == name).ok_or_else(|| {
            let names: Vec<&str> = Isa::present().map(Isa::name).collect();
            let allowed = format!("this processor has {}", names.join(", "));
            Error::input(VARIABLE, format!("\"{name}\""), allowed)
        })
    }
}

/// A loop that is compiled once for each instruction set.
pub trait Work {
    /// What comes of it.
    type Output;

    /// Goes through it; must be inlined, with all that it calls, or the instruction set is lost.
    fn run(self) -> Self::Output;
}

struct Compiled<W>(W);

impl<W: Work> pulp::NullaryFnOnce for Compiled<W> {
    type Output = W::Output;

    #[inline(always)]
    fn call(self) -> W::Output {
        self.0.run()
    }
}

/// Lanes that work is done in.
pub trait Lanes: Lane {
    /// Does the work with the instruction set that these lanes are made for, which the processor must have.
    fn dispatch<W: Work>(work: W) -> W::Output;
}

impl Lanes for f64 {
    fn dispatch<W: Work>(work: W) -> W::Output {
        work.run()
    }
}

impl<const N: usize> Lanes for Wide<N> {
    fn dispatch<W: Work>(work: W) -> W::Output {
        work.run()
    }
}

#[cfg(target_arch = "x86_64")]
impl Lanes for Avx2 {
    fn dispatch<W: Work>(work: W) -> W::Output {
        pulp::x86::V3::try_new().expect("this processor has AVX2").vectorize(Compiled(work))
    }
}

#[cfg(target_arch = "x86_64")]
impl Lanes for Avx512 {
    fn dispatch<W: Work>(work: W) -> W::Output {
        pulp::x86::V4::try_new().expect("this processor has AVX-512").vectorize(Compiled(work))
    }
}

/// Something to be done in lanes yet to be chosen.
pub trait InLanes {
    /// What comes of it.
    type Output;

    /// Does it in these, [`SAMPLES`] side by side.
    fn run<L: Lanes>(self) -> Self::Output;
}

/// Does something in the lanes of an instruction set, or in plain ones where the processor does not have it.
pub fn with<T: InLanes>(isa: Isa, what: T) -> T::Output {
    match isa {
        #[cfg(target_arch = "x86_64")]
        Isa::Avx512 if isa.is_present() => what.run::<Avx512>(),
        #[cfg(target_arch = "x86_64")]
        Isa::Avx2 if isa.is_present() => what.run::<Avx2>(),
        _ => what.run::<Wide<SAMPLES>>(),
    }
}
