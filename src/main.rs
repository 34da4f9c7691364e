//! The `outsight` program: the library with flags, progress bars and exit codes.

mod cli;

use std::process::ExitCode;

fn main() -> ExitCode {
    cli::main()
}
