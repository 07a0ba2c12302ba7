//! The instruction set that samples are computed with: the widest that the processor has, unless told otherwise.

use super::Lanes;
use super::wide::Wide;
#[cfg(target_arch = "x86_64")]
use super::x86::{Avx2, Avx512};
use crate::error::Error;

/// Lanes that any processor has: eight numbers, which the compiler keeps in the registers there are.
type Baseline = Wide<8>;

/// The environment variable that chooses another than the widest.
pub const VARIABLE: &str = "SPANWISE_ISA";

/// An instruction set.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Isa {
    /// What every processor of its kind has: on x86-64 SSE2, on AArch64 NEON.
    Baseline,
    /// AVX2.
    Avx2,
    /// AVX-512.
    Avx512,
    /// NEON, which every AArch64 processor has.
    Neon,
}

impl Isa {
    /// All of them, from the narrowest to the widest.
    pub const ALL: [Isa; 4] = [Isa::Baseline, Isa::Neon, Isa::Avx2, Isa::Avx512];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Isa::Baseline => "baseline",
            Isa::Avx2 => "avx2",
            Isa::Avx512 => "avx512",
            Isa::Neon => "neon",
        }
    }

    /// Whether this processor has it.
    pub fn is_present(self) -> bool {
        match self {
            Isa::Baseline => true,
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
            _ => Ok(Isa::present().last().unwrap_or(Isa::Baseline)),
        }
    }

    /// Those that the processor has, from the narrowest to the widest.
    pub fn present() -> impl Iterator<Item = Self> {
        Isa::ALL.into_iter().filter(|isa| isa.is_present())
    }

    /// Samples that are marched side by side.
    pub fn samples(self) -> usize {
        struct Count;

        impl InLanes for Count {
            type Output = usize;

            fn run<L: Lanes>(self) -> usize {
                L::SAMPLES
            }
        }

        with(self, Count)
    }

    fn named(name: &str) -> Result<Self, Error> {
        Isa::present().find(|isa| isa.name() == name).ok_or_else(|| {
            let names: Vec<&str> = Isa::present().map(Isa::name).collect();
            let allowed = format!("this processor has {}", names.join(", "));
            Error::input(VARIABLE, format!("\"{name}\""), allowed)
        })
    }
}

/// Something to be done in lanes yet to be chosen.
pub trait InLanes {
    /// What comes of it.
    type Output;

    /// Does it in these.
    fn run<L: Lanes>(self) -> Self::Output;
}

/// Does something in the lanes of an instruction set, or in those of any processor where this one does not have it.
///
/// It is the only way to the lanes of an instruction set, so that safe code cannot reach an instruction that the processor
/// lacks. They have no name outside:
///
/// ```compile_fail
/// #![forbid(unsafe_code)]
/// use spanwise::lane::{Lane, x86::Avx512};
/// assert_eq!(Avx512::splat(1.0).get(0), 1.0);
/// ```
///
/// where those of any processor have one:
///
/// ```
/// #![forbid(unsafe_code)]
/// use spanwise::lane::{Lane, Wide};
/// assert_eq!(Wide::<8>::splat(1.0).get(0), 1.0);
/// ```
///
/// and what is done in lanes cannot bring them out, for it does not know which they are:
///
/// ```compile_fail
/// #![forbid(unsafe_code)]
/// use spanwise::lane::{InLanes, Isa, Lanes, with};
///
/// struct One;
///
/// impl InLanes for One {
///     type Output = impl Lanes;
///
///     fn run<L: Lanes>(self) -> Self::Output {
///         L::splat(1.0)
///     }
/// }
///
/// with(Isa::Avx512, One);
/// ```
pub fn with<T: InLanes>(isa: Isa, what: T) -> T::Output {
    match isa {
        #[cfg(target_arch = "x86_64")]
        Isa::Avx512 if isa.is_present() => what.run::<Avx512>(),
        #[cfg(target_arch = "x86_64")]
        Isa::Avx2 if isa.is_present() => what.run::<Avx2>(),
        _ => what.run::<Baseline>(),
    }
}
