//! `twintac export`: frames of logs as tables.

use std::io::Write;
use std::path::Path;

use anyhow::{Context, Result};
use serde::Serialize;
use twintac_log::{Ending, LogError, export_frames, recover};

use super::files::expand;
use crate::arguments::Export;

/// A line with `--json`.
#[derive(Serialize)]
struct Written {
    log: String,
    table: String,
    frames: u64,
    gaps: u64,
    last_s: f64,
    is_whole: bool,
}

pub(super) fn run(arguments: &Export) -> Result<()> {
    for log in expand(&arguments.logs)? {
        let whole = whole_name(&log);
        let name = whole.with_extension("parquet");
        let table = match &arguments.out {
            Some(folder) => {
                std::fs::create_dir_all(folder).with_context(|| format!("creating {}", folder.display()))?;
                folder.join(name.file_name().unwrap_or_default())
            }
            None => name,
        };
        let exported = export_frames(&log, &table)?;
        if exported.ending == Ending::Cut {
            make_whole(&log)?;
        }
        let written = Written {
            log: log.display().to_string(),
            table: table.display().to_string(),
            frames: exported.frames,
            gaps: exported.gaps,
            last_s: exported.last_s,
            is_whole: exported.ending == Ending::Whole,
        };
        super::print(&if arguments.json {
            serde_json::to_string(&written)?
        } else {
            format!(
                "{}: {} frames, {} marked gaps",
                written.table, written.frames, written.gaps
            )
        })?;
    }
    Ok(())
}

/// A cut log's name when it is whole.
fn whole_name(log: &Path) -> std::path::PathBuf {
    match log.extension() {
        Some(extension) if extension == "partial" => log.with_extension(""),
        _ => log.to_owned(),
    }
}

/// Puts a whole log beside a cut one.
fn make_whole(log: &Path) -> Result<()> {
    let made = match recover(log) {
        Ok(recovered) => format!("all that was flushed stands in {}", recovered.path.display()),
        Err(LogError::Exists { file }) => format!("{file} is there already"),
        Err(error) => return Err(error.into()),
    };
    let _ = writeln!(std::io::stderr(), "{} was cut; {made}", log.display());
    Ok(())
}
