//! Whether work that takes long is still wanted.

use crate::error::Error;

/// Asked now and then by everything that may take long; a copy asks the same.
#[derive(Clone, Copy)]
pub struct StopToken<'a>(Option<&'a dyn Fn() -> bool>);

impl<'a> StopToken<'a> {
    /// Goes on to the end.
    pub const NEVER: StopToken<'static> = StopToken(None);

    /// Stops when `asked` says so.
    pub fn when(asked: &'a dyn Fn() -> bool) -> Self {
        StopToken(Some(asked))
    }

    /// An error if it is to stop.
    pub fn check(self) -> Result<(), Error> {
        match self.0 {
            Some(asked) if asked() => Err(Error::Interrupted),
            _ => Ok(()),
        }
    }
}
