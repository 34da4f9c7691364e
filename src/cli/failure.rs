//! How the program ends: exit codes, the message before them, and what happens when a bug makes it panic.

use std::panic::{self, AssertUnwindSafe, PanicHookInfo};

use outsight::Error;

use super::console::{Console, to_stderr};
use super::signals::Interruption;

/// Exit code of `doctor` when its self-check finds a wrong number: the asked condition is false.
const CONDITION_FALSE: u8 = 1;
/// Exit code for output that could not be written.
const OUTPUT: u8 = 4;
/// Exit code when a limit was reached.
const LIMIT: u8 = 5;
/// Exit code of a bug in Outsight (`EX_SOFTWARE` of sysexits.h).
const BUG: u8 = 70;

/// Where bugs go.
const REPORT_TO: &str = "please report it with the command you ran and the output of `outsight doctor`";

/// Why a command did not reach its end.
#[derive(Debug)]
pub enum Failure {
    /// The library said so.
    Error(Error),
    /// Standard output could not be written for another reason.
    Stdout(std::io::Error),
    /// The answer is no, and it was already printed.
    ConditionFalse,
    /// A panic was caught, and the hook has already told about it.
    Bug,
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        Self::Error(error)
    }
}

/// Prints the message of a failure and returns the exit code of the process.
pub fn conclude(failure: &Failure, console: &Console) -> u8 {
    match failure {
        Failure::ConditionFalse => CONDITION_FALSE,
        Failure::Bug => BUG,
        Failure::Stdout(error) => {
            to_stderr(&format!("error: standard output: {error}"));
            OUTPUT
        }
        Failure::Error(Error::ClosedPipe) => 0,
        Failure::Error(Error::Cancelled) => conclude_cancelled(console),
        Failure::Error(error) => {
            to_stderr(&format!("error: {error}"));
            if error.exit_code() == BUG {
                to_stderr(&format!("this is a bug in Outsight; {REPORT_TO}"));
            }
            error.exit_code()
        }
    }
}

fn conclude_cancelled(console: &Console) -> u8 {
    match console.interruption() {
        Some(Interruption::Signal { exit_code, name }) => {
            to_stderr(&format!("error: {name}: {}", Error::Cancelled));
            exit_code
        }
        Some(Interruption::TimeLimit { seconds }) => {
            to_stderr(&format!(
                "error: --time-limit {seconds}: the time is up; no file is left half-written; allow more, or try fewer --cameras \
                 or a smaller --resolution"
            ));
            LIMIT
        }
        None => Error::Cancelled.exit_code(),
    }
}

/// Makes a panic say that it is a bug, where it happened and what to do, in place of Rust's own message.
pub fn report_bugs() {
    panic::set_hook(Box::new(|info| to_stderr(&bug_message(info))));
}

fn bug_message(info: &PanicHookInfo<'_>) -> String {
    let payload = info.payload();
    let text = payload.downcast_ref::<&str>().copied().or_else(|| payload.downcast_ref::<String>().map(String::as_str));
    let what = text.unwrap_or("no message");
    let place = info.location().map(|l| format!("{}:{}", l.file(), l.line())).unwrap_or_default();
    format!("error: bug in Outsight {} at {place}: {what}\n{REPORT_TO}", env!("CARGO_PKG_VERSION"))
}

/// Runs `work`, and turns a panic in it into [`Failure::Bug`].
pub fn guarded(work: impl FnOnce() -> Result<(), Failure>) -> Result<(), Failure> {
    // Nothing that `work` may have left half-changed is looked at afterwards but the console's flags.
    panic::catch_unwind(AssertUnwindSafe(work)).unwrap_or(Err(Failure::Bug))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::panic)]

    use super::*;

    #[test]
    fn panic_becomes_exit_code_70() {
        let console = Console::silent();
        let failure = guarded(|| panic!("planted")).expect_err("a panic is not a success");
        assert!(matches!(failure, Failure::Bug));
        assert_eq!(conclude(&failure, &console), 70);
    }

    #[test]
    fn broken_invariant_of_the_library_counts_as_bug() {
        let failure = Failure::Error(Error::ShapeMismatch { what: "importance", got: 1, expected: 2 });
        assert_eq!(conclude(&failure, &Console::silent()), 70);
    }

    #[test]
    fn closed_pipe_is_a_quiet_success() {
        assert_eq!(conclude(&Failure::Error(Error::ClosedPipe), &Console::silent()), 0);
    }
}
