//! Ctrl-C and friends: the first asks the work to stop, the second ends the process at once.

use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};
use std::time::Instant;

use outsight::Error;
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::iterator::Signals;

use super::console::to_stderr;

/// What asked the work to stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Interruption {
    /// A signal.
    Signal {
        /// 128 plus the signal's number.
        exit_code: u8,
        /// What the user did.
        name: &'static str,
    },
    /// `--time-limit`.
    TimeLimit {
        /// The limit.
        seconds: f64,
    },
}

/// Remembers what asked the work to stop; cheap to ask from every thread.
#[derive(Debug)]
pub struct Interruptions {
    /// Exit code of the first signal, 0 before it.
    signal: Arc<AtomicU8>,
    /// When the time is up, and the seconds that were allowed.
    deadline: Option<(Instant, f64)>,
}

impl Interruptions {
    /// No signal yet; the time starts now.
    pub fn new(time_limit: Option<std::time::Duration>) -> Self {
        let deadline = time_limit.and_then(|d| Some((Instant::now().checked_add(d)?, d.as_secs_f64())));
        Self { signal: Arc::default(), deadline }
    }

    /// Starts to listen for SIGINT and SIGTERM.
    pub fn listen(&self) -> Result<(), Error> {
        let refused = |e: std::io::Error| Error::Unavailable { message: format!("signal handlers: {e}") };
        let mut signals = Signals::new([SIGINT, SIGTERM]).map_err(refused)?;
        let first = Arc::clone(&self.signal);
        let listener = move || {
            for signal in signals.forever() {
                let exit_code = if signal == SIGINT { 130 } else { 143 };
                if first.swap(exit_code, Ordering::Relaxed) != 0 {
                    std::process::exit(i32::from(exit_code));
                }
                to_stderr("stopping; once more ends at once");
            }
        };
        std::thread::Builder::new().name("signals".to_owned()).spawn(listener).map_err(refused)?;
        Ok(())
    }

    /// What asked the work to stop, if anything did.
    pub fn current(&self) -> Option<Interruption> {
        match self.signal.load(Ordering::Relaxed) {
            0 => self
                .deadline
                .filter(|&(end, _)| Instant::now() >= end)
                .map(|(_, seconds)| Interruption::TimeLimit { seconds }),
            143 => Some(Interruption::Signal { exit_code: 143, name: "terminated" }),
            exit_code => Some(Interruption::Signal { exit_code, name: "interrupted" }),
        }
    }
}
