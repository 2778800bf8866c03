//! Presses that are kept in a folder, one file each, so that a killed run goes on.

use std::path::Path;

use rayon::prelude::*;
use twintac_fast::Lesson;
use twintac_teach::TeachError;

use crate::error::At;
use crate::files::{read_json, write_file};
use crate::progress::Work;
use crate::{Progress, RunError};

/// Presses from their files, or solved now.
pub(super) fn presses(
    name: &str,
    n: u64,
    folder: &Path,
    progress: &dyn Progress,
    solve: &(dyn Fn(u64) -> Result<Lesson, TeachError> + Sync),
) -> Result<Vec<Lesson>, RunError> {
    let work = Work::start(progress, name, n as usize);
    let presses = (0..n as usize).into_par_iter().with_max_len(1).map(|number| {
        let path = folder.join(name).join(format!("{number:06}.json"));
        let press = match read_json(&path) {
            Ok(press) => press,
            Err(_) => {
                let press = solve(number as u64).at(|| format!("{name}, press {number}"))?;
                let bytes = serde_json::to_vec(&press).map_err(|source| RunError::Json {
                    what: path.display().to_string(),
                    source,
                })?;
                write_file(&path, &bytes)?;
                press
            }
        };
        work.step("");
        Ok(press)
    });
    presses.collect()
}
