//! `--cache`: measurements kept from run to run.

use std::path::PathBuf;

use clap::Args;
use outsight::Result;
use outsight::pipeline::cache_is_file;

use super::outputs::{check_place, check_place_to_be};

/// Stands in for `--cache` where that is not given. Off unless asked for: nothing is written where nobody looks for it.
const VARIABLE: &str = "OUTSIGHT_CACHE";

/// Where measurements are kept.
#[derive(Debug, Clone, Default, Args)]
#[command(next_help_heading = "Looking")]
pub struct CacheFlags {
    /// Keep measurements in this directory, or in one file FILE.seen, and reuse them [env: OUTSIGHT_CACHE]
    #[arg(long, value_name = "DIR")]
    cache: Option<PathBuf>,
}

impl CacheFlags {
    /// The cache, if one is asked for and can be written.
    ///
    /// # Errors
    /// [`outsight::Error::Write`] now rather than after a long look.
    pub fn place(&self) -> Result<Option<PathBuf>> {
        let variable = || std::env::var_os(VARIABLE).filter(|value| !value.is_empty()).map(PathBuf::from);
        let Some(cache) = self.cache.clone().or_else(variable) else { return Ok(None) };
        if cache_is_file(&cache) {
            check_place(&cache, true)?;
        } else {
            check_place_to_be(&cache.join("any.seen"), true)?;
        }
        Ok(Some(cache))
    }
}

/// What the text of a command says behind the time that looking took.
pub fn reused(cache: Option<&str>) -> &'static str {
    match cache {
        Some("hit") => ", reused from the cache",
        Some("partial") => ", in part from the cache",
        _ => "",
    }
}
