//! The command line in one form, for pages: they say how they were made.

use std::ffi::OsStr;
use std::path::Path;

use clap::parser::ValueSource;
use clap::{Arg, ArgMatches, Command};
use outsight::pipeline::shown_names;

/// The command and what was typed behind it: arguments first, then flags under their long names, files without their
/// folders, all quoted as a shell needs it. Flags of every command are left out, but the seed: they change no result.
pub fn shown(command: &Command, matches: &ArgMatches) -> String {
    let (mut command, mut matches) = (command, matches);
    let mut words = vec![command.get_name().to_owned()];
    while let Some((name, more)) = matches.subcommand() {
        let Some(inner) = command.find_subcommand(name) else { break };
        words.push(name.to_owned());
        (command, matches) = (inner, more);
    }
    let typed = |arg: &&Arg| matches.value_source(arg.get_id().as_str()) == Some(ValueSource::CommandLine);
    let matters = |arg: &&Arg| !arg.is_global_set() || arg.get_id() == "seed";
    let (arguments, flags): (Vec<&Arg>, Vec<&Arg>) =
        command.get_arguments().filter(typed).filter(matters).partition(|arg| arg.is_positional());
    let all: Vec<Vec<String>> = arguments.into_iter().chain(flags).flat_map(|arg| occurrences(arg, matches)).collect();
    words.extend(without_folders(all.concat()));
    let quoted = words.iter().map(|word| shlex::try_quote(word).unwrap_or_default());
    quoted.collect::<Vec<_>>().join(" ")
}

/// The words of an argument, for each time that it was given.
fn occurrences(arg: &Arg, matches: &ArgMatches) -> Vec<Vec<String>> {
    let flag = arg.get_long().map(|name| format!("--{name}"));
    if !arg.get_action().takes_values() {
        return vec![flag.into_iter().collect()];
    }
    let given = matches.get_raw_occurrences(arg.get_id().as_str()).into_iter().flatten();
    let words = |values: Vec<&OsStr>| -> Vec<String> {
        let values: Vec<String> = values.into_iter().map(|value| value.to_string_lossy().into_owned()).collect();
        let values = arg.get_value_delimiter().map_or(values.clone(), |comma| vec![values.join(&comma.to_string())]);
        flag.iter().cloned().chain(values).collect()
    };
    given.map(|values| words(values.collect())).collect()
}

/// Whatever has a separator of folders in it is a file, and may have a name before it, as in `motor=parts/engine.ply`.
fn without_folders(words: Vec<String>) -> Vec<String> {
    let has_folders = |path: &str| path.contains(std::path::is_separator);
    let named = |word: &str| word.find('=').map_or(0, |at| if has_folders(&word[..at]) { 0 } else { at + 1 });
    let parts: Vec<(&str, &str)> = words.iter().map(|word| word.split_at(named(word))).collect();
    let names = shown_names(&parts.iter().map(|(_, path)| Path::new(path)).collect::<Vec<_>>());
    let shown = parts.iter().zip(names).map(|((before, path), name)| {
        if has_folders(path) { format!("{before}{name}") } else { format!("{before}{path}") }
    });
    shown.collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use clap::CommandFactory;

    fn shown(arguments: &[&str]) -> String {
        let mut command = crate::cli::Arguments::command();
        let matches = command.try_get_matches_from_mut([&["outsight"], arguments].concat()).unwrap();
        super::shown(&command, &matches)
    }

    #[test]
    fn it_is_told_without_folders_and_without_what_changes_no_result() {
        let typed = ["-q", "simplify", "/home/me/a b.ply", "-o", "out/x.ply", "--lods", "0.5,200", "--threads", "2"];
        assert_eq!(shown(&typed), "outsight simplify 'a b.ply' --output x.ply --lods '0.5,200'");
        let typed = [
            "compare",
            "r.ply",
            "/a/x.ply",
            "b/x.ply",
            "--up=0,-1,0",
            "--seed",
            "7",
            "--weld",
            "--report",
            "../r.html",
        ];
        let told = "outsight compare r.ply a/x.ply b/x.ply --weld --up '0,-1,0' --report r.html --seed 7";
        let sorted = |text: &str| text.split(' ').map(str::to_owned).collect::<std::collections::BTreeSet<_>>();
        assert_eq!(sorted(&shown(&typed)), sorted(told));
        assert!(shown(&typed).starts_with("outsight compare r.ply a/x.ply b/x.ply --"));
    }

    #[test]
    fn flags_that_repeat_are_told_each_time_and_studies_by_both_names() {
        let typed = ["measure", "-", "--input-format", "ply", "--occluder", "/f/floor.ply", "--occluder", "wall.ply"];
        assert_eq!(shown(&typed), "outsight measure - --input-format ply --occluder floor.ply --occluder wall.ply");
        assert_eq!(
            shown(&["study", "convergence", "a.ply", "-o", "d/"]),
            "outsight study convergence a.ply --output d"
        );
        let typed = ["study", "zt", "motor=/x/engine.ply", "skull=/x/a=b/h.ply", "/a=b/c.ply", "-o", "zt/"];
        assert_eq!(shown(&typed), "outsight study zt 'motor=engine.ply' 'skull=h.ply' c.ply --output zt");
    }
}
