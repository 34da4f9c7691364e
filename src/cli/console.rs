//! Everything the program says: data to standard output, all else to standard error.

use std::io::{ErrorKind, Write};
use std::path::Path;
use std::sync::Mutex;

use outsight::error::{Error, Result};
use outsight::progress::Progress;
use serde::Serialize;

use super::failure::Failure;
use super::flags::GlobalFlags;
use super::progress::{ProgressDisplay, Show};
use super::signals::{Interruption, Interruptions};

/// Version of the JSON objects; grows when a key changes its meaning or goes.
pub const JSON_SCHEMA: u32 = 1;

/// Where a command talks, and what may interrupt it.
#[derive(Debug)]
pub struct Console {
    /// What every command was asked.
    pub global: GlobalFlags,
    /// What was typed, as pages tell it.
    pub command_line: String,
    display: ProgressDisplay,
    interruptions: Interruptions,
    warnings: Mutex<Vec<String>>,
}

/// A result as it goes to standard output under `--json`: the schema first, then the result, then what every command adds.
#[derive(Debug, Serialize)]
struct JsonObject<'a, T: Serialize> {
    schema: u32,
    #[serde(flatten)]
    result: &'a T,
    warnings: Vec<String>,
}

impl Console {
    /// The console that the flags ask for, which were given in this command line.
    pub fn new(flags: &GlobalFlags, command_line: String) -> Self {
        let show = if flags.quiet { Show::Never } else { flags.progress };
        Self {
            global: flags.clone(),
            command_line,
            display: ProgressDisplay::new(show),
            interruptions: Interruptions::new(flags.time_limit),
            warnings: Mutex::default(),
        }
    }

    /// Starts to listen for Ctrl-C.
    pub fn watch_signals(&self) -> Result<()> {
        self.interruptions.listen()
    }

    /// What asked the work to stop, if anything did.
    pub fn interruption(&self) -> Option<Interruption> {
        self.interruptions.current()
    }

    /// Takes progress bars away.
    pub fn finish_bars(&self) {
        self.display.clear();
    }

    /// Writes the data of a command to standard output.
    pub fn data(&self, bytes: impl AsRef<[u8]>) -> std::result::Result<(), Failure> {
        self.display.clear();
        let mut out = std::io::stdout().lock();
        match out.write_all(bytes.as_ref()).and_then(|()| out.flush()) {
            Ok(()) => Ok(()),
            Err(e) if e.kind() == ErrorKind::BrokenPipe => Err(Error::ClosedPipe.into()),
            Err(e) => Err(Failure::Stdout(e)),
        }
    }

    /// Prints a result: as one JSON object under `--json`, else as `text` unless `--quiet`.
    ///
    /// With `to_stdout` false (a mesh goes there) the text moves to standard error.
    pub fn result(&self, result: &impl Serialize, text: &str, to_stdout: bool) -> std::result::Result<(), Failure> {
        if self.global.json {
            return self.data(self.to_json(result)?);
        }
        if !to_stdout {
            self.note(text.trim_end());
            return Ok(());
        }
        if self.global.quiet { Ok(()) } else { self.data(text) }
    }

    /// The JSON object of a result, with a line feed behind it.
    pub fn to_json(&self, result: &impl Serialize) -> std::result::Result<String, Failure> {
        let warnings = self.warnings.lock().map(|w| w.clone()).unwrap_or_default();
        let object = JsonObject { schema: JSON_SCHEMA, result, warnings };
        let text = serde_json::to_string(&object).map_err(|e| Failure::Stdout(e.into()))?;
        Ok(text + "\n")
    }

    /// Warns in one line; under `--strict` the warning is an error instead.
    ///
    /// # Errors
    /// [`Error::Parse`] under `--strict`, naming `place`.
    pub fn warn(&self, place: &Path, message: &str) -> Result<()> {
        if self.global.strict {
            let message = format!("{message} (--strict makes this an error)");
            return Err(Error::Parse { place: place.display().to_string(), message });
        }
        self.announce(&format!("{}: {message}", place.display()));
        Ok(())
    }

    /// Prints `warning: …`, and keeps it for the JSON object.
    pub fn announce(&self, message: &str) {
        if let Ok(mut warnings) = self.warnings.lock() {
            warnings.push(message.to_owned());
        }
        self.note(&format!("warning: {message}"));
    }

    /// Tells something that is no data, unless `--quiet`.
    pub fn note(&self, message: &str) {
        if !self.global.quiet {
            self.display.clear();
            to_stderr(message);
        }
    }

    /// Tells something that only `--verbose` asks for.
    pub fn detail(&self, message: &str) {
        if self.global.verbose {
            self.note(message);
        }
    }

    /// A console that shows no progress and was asked nothing.
    #[cfg(test)]
    pub fn silent() -> Self {
        let flags = GlobalFlags { quiet: true, progress: Show::Never, ..GlobalFlags::default() };
        Self::new(&flags, String::new())
    }
}

impl Progress for Console {
    fn report(&self, phase: &'static str, done: u64, total: u64) {
        self.display.report(phase, done, total);
    }

    fn is_cancelled(&self) -> bool {
        self.interruptions.current().is_some()
    }
}

/// Writes a line to standard error; when even that is closed, there is nowhere left to complain.
pub fn to_stderr(line: &str) {
    let _ = writeln!(std::io::stderr().lock(), "{line}");
}
