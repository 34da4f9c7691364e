//! The command line: parse flags, fill options, call the library, print.
//!
//! One file a command. This is the only place that prints, reads flags or decides how the program ends; `console` does
//! the first, `flags` and `presets` the second, `failure` the third.

mod bundled;
mod cache;
mod cameras;
mod collapsing;
mod command_line;
mod compare;
mod completions;
mod console;
mod convert;
mod demo;
mod doctor;
mod estimate;
mod explain;
mod failure;
mod flags;
mod help;
mod in_force;
mod info;
mod man;
mod measure;
mod outputs;
mod presets;
mod progress;
mod render;
mod signals;
mod simplify;
mod study;
mod system;
mod text;
mod values;
mod verify;
mod watch;

use std::process::ExitCode;

use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};

use console::Console;
use failure::{Failure, guarded};
use flags::GlobalFlags;

/// Measures how well each triangle of a mesh can be seen from outside, and simplifies it where nobody looks.
#[derive(Debug, Parser)]
#[command(name = "outsight", version, propagate_version = false, after_help = help::OUTSIGHT, max_term_width = 100)]
#[command(subcommand_required = true, arg_required_else_help = true)]
pub struct Arguments {
    #[command(flatten)]
    global: GlobalFlags,
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Show the whole story on a bundled model, in ./outsight-demo/
    #[command(after_help = help::DEMO)]
    Demo(demo::Flags),
    /// Say what a mesh file holds, and what measuring it would cost
    #[command(after_help = help::INFO)]
    Info(info::Flags),
    /// Measure how well each triangle is seen from outside
    #[command(after_help = help::MEASURE)]
    Measure(measure::Flags),
    /// Say which cameras see a triangle, and what hides it from the others
    #[command(after_help = help::EXPLAIN, mut_args(|a| hidden_if(a, &explain::REFUSED)))]
    Explain(explain::Flags),
    /// Put the same question to several backends and estimators: do they agree?
    #[command(after_help = help::VERIFY, mut_arg("backend", |a| a.hide(true)), mut_arg("estimator", |a| a.hide(true)))]
    Verify(verify::Flags),
    /// Reduce the triangles of a mesh, first where nobody looks
    #[command(after_help = help::SIMPLIFY, override_usage = help::SIMPLIFY_USAGE)]
    Simplify(simplify::Flags),
    /// Say how far meshes differ from a reference, in pictures and in space
    #[command(after_help = help::COMPARE)]
    Compare(compare::Flags),
    /// Draw a mesh, shaded or coloured by visibility
    #[command(after_help = help::RENDER)]
    Render(render::Flags),
    /// Write a mesh in another format
    #[command(after_help = help::CONVERT)]
    Convert(convert::Flags),
    /// Make tables and figures about the method itself
    Study(study::Flags),
    /// Say what works on this machine, and why the rest does not
    #[command(after_help = help::DOCTOR)]
    Doctor(doctor::Flags),
    /// Print the completion script of a shell
    #[command(after_help = help::COMPLETIONS)]
    Completions(completions::Flags),
    /// Print the manual page
    #[command(after_help = help::MAN)]
    Man(man::Flags),
}

/// A flag that a command always refuses, and shares with others that do not, stays out of its help.
fn hidden_if(flag: clap::Arg, refused: &[&str]) -> clap::Arg {
    let hidden = refused.contains(&flag.get_id().as_str());
    if hidden { flag.hide(true) } else { flag }
}

/// Runs the program on the process's arguments and says how it ends.
pub fn main() -> ExitCode {
    failure::report_bugs();
    match parsed() {
        Ok((arguments, command_line)) => ExitCode::from(run(&arguments, command_line)),
        // Help and version come as "errors" that belong on stdout with code 0; a closed pipe there is nobody's fault.
        Err(asked_or_wrong) => {
            let _ = asked_or_wrong.print();
            ExitCode::from(u8::try_from(asked_or_wrong.exit_code()).unwrap_or(2))
        }
    }
}

/// The process's arguments, and the command line as pages tell it.
fn parsed() -> Result<(Arguments, String), clap::Error> {
    let mut command = Arguments::command();
    let matches = command.try_get_matches_from_mut(std::env::args_os())?;
    let arguments = Arguments::from_arg_matches(&matches).map_err(|wrong| wrong.format(&mut command))?;
    Ok((arguments, command_line::shown(&command, &matches)))
}

fn run(arguments: &Arguments, command_line: String) -> u8 {
    let console = Console::new(&arguments.global, command_line);
    let outcome = guarded(|| {
        check_names(arguments.global.json)?;
        console.watch_signals()?;
        arguments.global.start_threads()?;
        dispatch(&arguments.command, &console)
    });
    console.finish_bars();
    match outcome {
        Ok(()) => 0,
        Err(failure) => failure::conclude(&failure, &console),
    }
}

/// JSON holds text alone: better to refuse a name that is none than to fail when everything is done.
fn check_names(json: bool) -> outsight::Result<()> {
    match std::env::args_os().find(|argument| json && argument.to_str().is_none()) {
        None => Ok(()),
        Some(name) => Err(outsight::Error::Option {
            name: "--json",
            message: format!("{} is not Unicode, which JSON cannot hold; rename it", name.display()),
        }),
    }
}

fn dispatch(command: &Command, console: &Console) -> Result<(), Failure> {
    match command {
        Command::Demo(flags) => demo::run(flags, console),
        Command::Info(flags) => info::run(flags, console),
        Command::Measure(flags) => measure::run(flags, console),
        Command::Explain(flags) => explain::run(flags, console),
        Command::Verify(flags) => verify::run(flags, console),
        Command::Simplify(flags) => simplify::run(flags, console),
        Command::Compare(flags) => compare::run(flags, console),
        Command::Render(flags) => render::run(flags, console),
        Command::Convert(flags) => convert::run(flags, console),
        Command::Study(flags) => study::run(flags, console),
        Command::Doctor(flags) => doctor::run(flags, console),
        Command::Completions(flags) => completions::run(flags, console),
        Command::Man(flags) => man::run(flags, console),
    }
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    #[test]
    fn flags_of_all_commands_agree_with_each_other() {
        super::Arguments::command().debug_assert();
    }
}
