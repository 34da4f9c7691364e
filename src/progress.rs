//! How long work tells its caller how far it is, and how the caller stops it.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::error::Error;

/// Receives the progress of long work and may ask it to stop.
///
/// Every long routine of the library takes one. Calls come from any thread, often, and must be cheap.
pub trait Progress: Sync {
    /// `done` of `total` units of the named phase are finished. `phase` is a short lower-case noun ("visibility").
    fn report(&self, phase: &'static str, done: u64, total: u64);

    /// True once the work should end as soon as it can; it then returns [`Error::Cancelled`].
    fn is_cancelled(&self) -> bool {
        false
    }

    /// [`Error::Cancelled`] once the work should end, for use with `?` between two steps.
    ///
    /// # Errors
    /// [`Error::Cancelled`] if [`Progress::is_cancelled`].
    fn check(&self) -> Result<(), Error> {
        if self.is_cancelled() { Err(Error::Cancelled) } else { Ok(()) }
    }
}

/// Listens to nothing and never stops the work.
#[derive(Debug, Clone, Copy, Default)]
pub struct Silent;

impl Progress for Silent {
    fn report(&self, _phase: &'static str, _done: u64, _total: u64) {}
}

/// Listens to nothing; stops the work once its flag is set (from a signal handler, another thread, a test).
#[derive(Debug, Default)]
pub struct CancelFlag(AtomicBool);

impl CancelFlag {
    /// Asks the work to stop.
    pub fn cancel(&self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

impl Progress for CancelFlag {
    fn report(&self, _phase: &'static str, _done: u64, _total: u64) {}

    fn is_cancelled(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}
