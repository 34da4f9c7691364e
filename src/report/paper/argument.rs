use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use super::{MODELS, PaperModel};
use crate::error::{Error, Result};

/// A model as the command line names it.
#[derive(Debug, Clone, PartialEq)]
pub struct ModelArgument {
    /// The file.
    pub file: PathBuf,
    /// Which of the paper's models it is or stands for.
    pub model: Option<&'static PaperModel>,
}

/// Reads `FILE` or `NAME=FILE`, where NAME is a model of the paper; without NAME the file's own name may be one.
///
/// What is there under the whole name is a file, also with `=` in it. So is what has a directory before its `=`, and what
/// is not UTF-8.
///
/// # Errors
/// [`Error::Option`] for a NAME that the paper does not have, naming those that it has, and for a NAME without a FILE.
pub fn parse_model_argument(argument: &OsStr) -> Result<ModelArgument> {
    parse(argument, Path::new(argument).exists())
}

fn parse(argument: &OsStr, is_there: bool) -> Result<ModelArgument> {
    let path = Path::new(argument);
    let parts = argument.to_str().and_then(|text| text.split_once('='));
    let Some((name, file)) = parts.filter(|(name, _)| !is_there && !name.contains(std::path::is_separator)) else {
        return Ok(ModelArgument { file: path.to_owned(), model: PaperModel::named(&stem(path)) });
    };
    let fault = |message: String| Err(Error::Option { name: "MODELS", message });
    match PaperModel::named(name) {
        Some(_) if file.is_empty() => fault(format!("'{name}=' lacks its file; write {name}=FILE")),
        Some(model) => Ok(ModelArgument { file: file.into(), model: Some(model) }),
        None => {
            let names = MODELS.map(|model| model.name.to_lowercase().replace(' ', "_")).join(", ");
            fault(format!("there is no file '{}', and the paper has no model '{name}'; it has {names}", path.display()))
        }
    }
}

/// The file's name up to its first dot: `motor` of `models/motor.ply.zst`.
fn stem(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    name.split('.').next().unwrap_or_default().to_owned()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    fn named(argument: ModelArgument) -> (PathBuf, Option<&'static str>) {
        (argument.file, argument.model.map(|m| m.name))
    }

    fn read(text: &str) -> (PathBuf, Option<&'static str>) {
        named(parse(OsStr::new(text), false).unwrap())
    }

    #[test]
    fn a_name_before_the_equals_sign_wins_over_the_files_own() {
        assert_eq!(read("motor=bunny.ply.zst"), ("bunny.ply.zst".into(), Some("Motor")));
        assert_eq!(read("Foot Bone=a=b.ply"), ("a=b.ply".into(), Some("Foot Bone")));
    }

    #[test]
    fn without_a_name_the_stem_counts() {
        assert_eq!(read("models/locking_tori.ply.zst"), ("models/locking_tori.ply.zst".into(), Some("Locking Tori")));
        assert_eq!(read("buddha_100k.ply"), ("buddha_100k.ply".into(), None));
        assert_eq!(read("-"), ("-".into(), None));
    }

    #[test]
    fn a_file_that_is_there_is_a_file_whatever_its_name() {
        let there = parse(OsStr::new("cow=bunny.ply"), true).unwrap();
        assert_eq!(named(there), ("cow=bunny.ply".into(), None));
        assert_eq!(read("gone/motor=x.ply"), ("gone/motor=x.ply".into(), None));
    }

    #[test]
    fn an_unknown_name_is_told_which_there_are() {
        let fault = |text: &str| parse_model_argument(OsStr::new(text)).unwrap_err().to_string();
        let message = fault("engine=x.ply");
        assert!(message.contains("no model 'engine'"), "{message}");
        assert!(message.contains("bunny, teapot, dragon, buddha, locking_tori, foot_bone"), "{message}");
        assert!(fault("motor=").contains("write motor=FILE"));
    }
}
