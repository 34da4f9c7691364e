//! `outsight completions`: the completion script of a shell.

use clap::{Args, CommandFactory};
use clap_complete::Shell;

use super::Arguments;
use super::console::Console;
use super::failure::Failure;

#[derive(Debug, Args)]
pub struct Flags {
    /// The shell
    #[arg(value_name = "SHELL")]
    shell: Shell,
}

/// Prints the script.
pub fn run(flags: &Flags, console: &Console) -> Result<(), Failure> {
    let mut script = Vec::new();
    clap_complete::generate(flags.shell, &mut Arguments::command(), "outsight", &mut script);
    console.data(script)
}
