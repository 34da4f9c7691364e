//! `outsight man`: the manual pages.

use std::path::{Path, PathBuf};

use clap::{Args, Command, CommandFactory};
use clap_mangen::Man;
use outsight::{Error, io};

use super::Arguments;
use super::console::Console;
use super::failure::Failure;
use super::outputs;

#[derive(Debug, Args)]
pub struct Flags {
    /// Write one page per command into this directory
    #[arg(long, value_name = "DIR")]
    dir: Option<PathBuf>,
}

/// Prints the main page, or writes them all.
pub fn run(flags: &Flags, console: &Console) -> Result<(), Failure> {
    // Building carries the global flags into every command.
    let mut program = Arguments::command();
    program.build();
    match &flags.dir {
        None => console.data(page(program).map_err(Failure::Stdout)?),
        Some(directory) => write_all(&program, directory, console),
    }
}

fn write_all(program: &Command, directory: &Path, console: &Console) -> Result<(), Failure> {
    let commands: Vec<&Command> = std::iter::once(program).chain(program.get_subcommands()).collect();
    let force = console.global.force;
    // Of `outsight measure`, the page and its file are called `outsight-measure`.
    let name = |command: &Command| command.get_display_name().unwrap_or_else(|| command.get_name()).to_owned();
    let place = |command: &Command| directory.join(format!("{}.1", name(command)));
    for command in &commands {
        outputs::check_place(&place(command), force)?;
    }
    for command in &commands {
        let path = place(command);
        let fail = |e: std::io::Error| Error::Write { path: path.clone(), message: e.to_string() };
        let text = page((*command).clone()).map_err(fail)?;
        io::write_atomic(&path, force, |out| out.write_all(&text))?;
    }
    console.note(&format!("{} pages written to {}", commands.len(), directory.display()));
    Ok(())
}

fn page(command: Command) -> std::io::Result<Vec<u8>> {
    let mut text = Vec::new();
    Man::new(command).render(&mut text)?;
    Ok(text)
}
