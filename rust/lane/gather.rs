//! Vehicle, bridge and contacts in lanes, gathered number by number from those of each sample.

use std::ops::Range;

use super::Lane;

/// What can be gathered, as a `Contact<f64>` of each sample becomes one `Contact<L>`.
pub trait Gather<L: Lane> {
    /// In lanes.
    type Lanes;

    /// From those of each sample, which must have the same [`ways`](Gather::ways).
    fn gather(each: &[&Self]) -> Self::Lanes;

    /// Adds what samples must have in common to be gathered: in these they differ in the way they go, not only in numbers.
    fn ways(&self, ways: &mut Vec<bool>);
}

impl<L: Lane> Gather<L> for f64 {
    type Lanes = L;

    fn gather(each: &[&f64]) -> L {
        L::from_fn(|sample| *each[sample])
    }

    fn ways(&self, _: &mut Vec<bool>) {}
}

impl<L: Lane> Gather<L> for bool {
    type Lanes = bool;

    fn gather(each: &[&bool]) -> bool {
        *each[0]
    }

    fn ways(&self, ways: &mut Vec<bool>) {
        ways.push(*self);
    }
}

impl<L: Lane> Gather<L> for usize {
    type Lanes = usize;

    fn gather(each: &[&usize]) -> usize {
        *each[0]
    }

    fn ways(&self, _: &mut Vec<bool>) {}
}

impl<L: Lane> Gather<L> for Range<usize> {
    type Lanes = Range<usize>;

    fn gather(each: &[&Range<usize>]) -> Range<usize> {
        each[0].clone()
    }

    fn ways(&self, _: &mut Vec<bool>) {}
}

impl<L: Lane, T: Gather<L>> Gather<L> for Vec<T> {
    type Lanes = Vec<T::Lanes>;

    fn gather(each: &[&Vec<T>]) -> Vec<T::Lanes> {
        (0..each[0].len()).map(|i| T::gather(&each.iter().map(|all| &all[i]).collect::<Vec<_>>())).collect()
    }

    fn ways(&self, ways: &mut Vec<bool>) {
        self.iter().for_each(|one| one.ways(ways));
    }
}

impl<L: Lane, T: Gather<L>> Gather<L> for Option<T> {
    type Lanes = Option<T::Lanes>;

    fn gather(each: &[&Option<T>]) -> Option<T::Lanes> {
        each.iter().map(|one| one.as_ref()).collect::<Option<Vec<_>>>().map(|each| T::gather(&each))
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

            fn gather(each: &[&Self]) -> $name<L> {
                $name {
                    $($field: $crate::lane::gather::Gather::<L>::gather(
                        &each.iter().map(|one| &one.$field).collect::<Vec<_>>(),
                    ),)*
                }
            }

            fn ways(&self, ways: &mut Vec<bool>) {
                $($crate::lane::gather::Gather::<L>::ways(&self.$field, ways);)*
            }
        }
    };
}
pub(crate) use gather;
