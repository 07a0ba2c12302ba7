//! Vehicle, bridge and contacts in lanes, gathered number by number from those of each sample.

use std::ops::Range;

use super::Lane;

/// What can be gathered, as a `Contact<f64>` of each sample becomes one `Contact<L>`.
pub trait Gather<L: Lane> {
    /// In lanes.
    type Lanes;

    /// From that of each sample, by its number; all must have the same [`ways`](Gather::ways).
    fn gather<'a>(each: impl Fn(usize) -> &'a Self) -> Self::Lanes
    where
        Self: 'a;

    /// Adds what samples must have in common to be gathered: in these they differ in the way they go, not only in numbers.
    fn ways(&self, ways: &mut Vec<bool>);
}

impl<L: Lane> Gather<L> for f64 {
    type Lanes = L;

    fn gather<'a>(each: impl Fn(usize) -> &'a f64) -> L {
        L::from_fn(|sample| *each(sample))
    }

    fn ways(&self, _: &mut Vec<bool>) {}
}

impl<L: Lane> Gather<L> for bool {
    type Lanes = bool;

    fn gather<'a>(each: impl Fn(usize) -> &'a bool) -> bool {
        *each(0)
    }

    fn ways(&self, ways: &mut Vec<bool>) {
        ways.push(*self);
    }
}

impl<L: Lane> Gather<L> for usize {
    type Lanes = usize;

    fn gather<'a>(each: impl Fn(usize) -> &'a usize) -> usize {
        *each(0)
    }

    fn ways(&self, _: &mut Vec<bool>) {}
}

impl<L: Lane> Gather<L> for Range<usize> {
    type Lanes = Range<usize>;

    fn gather<'a>(each: impl Fn(usize) -> &'a Range<usize>) -> Range<usize> {
        each(0).clone()
    }

    fn ways(&self, _: &mut Vec<bool>) {}
}

impl<L: Lane, T: Gather<L>> Gather<L> for Vec<T> {
    type Lanes = Vec<T::Lanes>;

    fn gather<'a>(each: impl Fn(usize) -> &'a Vec<T>) -> Vec<T::Lanes>
    where
        T: 'a,
    {
        (0..each(0).len()).map(|i| T::gather(|sample| &each(sample)[i])).collect()
    }

    fn ways(&self, ways: &mut Vec<bool>) {
        self.iter().for_each(|one| one.ways(ways));
    }
}

impl<L: Lane, T: Gather<L>> Gather<L> for Option<T> {
    type Lanes = Option<T::Lanes>;

    fn gather<'a>(each: impl Fn(usize) -> &'a Option<T>) -> Option<T::Lanes>
    where
        T: 'a,
    {
        each(0).as_ref().map(|first| T::gather(|sample| each(sample).as_ref().unwrap_or(first)))
    }

    fn ways(&self, ways: &mut Vec<bool>) {
        ways.push(self.is_some());
        self.iter().for_each(|one| one.ways(ways));
    }
}

/// Gathers a struct field by field; all must be named, or it does not compile.
macro_rules! gather {
    ($name:ident { $($field:ident),* $(,)? }) => {
        impl<L: $crate::lane::Lane> $crate::lane::gather::Gather<L> for $name<f64> {
            type Lanes = $name<L>;

            fn gather<'a>(each: impl Fn(usize) -> &'a Self) -> $name<L> {
                $name {
                    $($field: $crate::lane::gather::Gather::<L>::gather(|sample| &each(sample).$field),)*
                }
            }

            fn ways(&self, ways: &mut Vec<bool>) {
                $($crate::lane::gather::Gather::<L>::ways(&self.$field, ways);)*
            }
        }
    };
}
pub(crate) use gather;
