//! Progress on standard error: bars on a terminal, a line every tenth in a log.

use std::io::IsTerminal;
use std::sync::Mutex;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::console::to_stderr;

/// At most this often a second a bar is drawn anew.
const FRAMES_PER_SECOND: u8 = 10;
/// A bar shows that the program is alive this often, even while nothing is reported.
const TICK: Duration = Duration::from_millis(200);

/// When progress is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, clap::ValueEnum)]
pub enum Show {
    // Only on a terminal.
    #[default]
    Auto,
    // Also in a pipe or a file, as lines.
    Always,
    // Never.
    Never,
}

/// Shows the phase a run is in and how far it is.
#[derive(Debug)]
pub enum ProgressDisplay {
    /// Shows nothing.
    Hidden,
    /// One bar, replaced from phase to phase.
    Bar(Mutex<Option<Phase>>),
    /// A line whenever a tenth of a phase is done.
    Lines(Mutex<Option<(&'static str, u64)>>),
}

/// The bar of one phase.
#[derive(Debug)]
pub struct Phase {
    name: &'static str,
    bar: ProgressBar,
}

impl ProgressDisplay {
    /// What `show` means where standard error goes.
    pub fn new(show: Show) -> Self {
        match (show, std::io::stderr().is_terminal()) {
            (Show::Never, _) | (Show::Auto, false) => Self::Hidden,
            (_, true) => Self::Bar(Mutex::default()),
            (Show::Always, false) => Self::Lines(Mutex::default()),
        }
    }

    /// `done` of `total` units of `phase` are finished.
    pub fn report(&self, phase: &'static str, done: u64, total: u64) {
        match self {
            Self::Hidden => {}
            Self::Bar(current) => {
                // Progress is a courtesy: a poisoned lock (some thread panicked) only stops it.
                let Ok(mut current) = current.lock() else { return };
                let same = current.take().filter(|p| p.name == phase);
                let shown = same.unwrap_or_else(|| Phase { name: phase, bar: new_bar(phase, total) });
                // Threads may report out of order; a bar never goes back.
                shown.bar.set_length(total);
                shown.bar.set_position(done.max(shown.bar.position()));
                *current = Some(shown);
            }
            Self::Lines(last) => {
                let Ok(mut last) = last.lock() else { return };
                let tenth = 10 * done.min(total) / total.max(1);
                let shown = last.filter(|(name, _)| *name == phase).map(|(_, tenth)| tenth);
                if shown.is_none_or(|shown| tenth > shown) {
                    to_stderr(&format!("{phase} {} %", 10 * tenth));
                    *last = Some((phase, tenth));
                }
            }
        }
    }

    /// Takes what is shown away, so that a message can follow.
    pub fn clear(&self) {
        if let Self::Bar(current) = self
            && let Ok(mut current) = current.lock()
            && let Some(phase) = current.take()
        {
            phase.bar.finish_and_clear();
        }
    }
}

fn new_bar(phase: &'static str, total: u64) -> ProgressBar {
    let target = ProgressDrawTarget::stderr_with_hz(FRAMES_PER_SECOND);
    let style = ProgressStyle::with_template("{prefix:>12} {bar:32} {percent:>3} %  {elapsed}, {eta} left")
        .unwrap_or_else(|_| ProgressStyle::default_bar());
    let bar = ProgressBar::with_draw_target(Some(total), target).with_style(style).with_prefix(phase);
    bar.enable_steady_tick(TICK);
    bar
}
