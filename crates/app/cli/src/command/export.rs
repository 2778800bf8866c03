//! `twintac export`: exports frames of logs as tables, and logs to other formats.

use std::path::Path;

use anyhow::Result;
use serde::Serialize;
use twintac_recorded::{LogFound, export, export_lerobot, export_ros};
use twintac_recording::LeRobotSummary;

use super::files::expand;
use crate::arguments::Export;
use crate::output::print;
use crate::progress::{Bars, say};

pub(super) fn run(arguments: &Export) -> Result<()> {
    if let Some(folder) = &arguments.lerobot {
        let written = export_lerobot(&expand(&arguments.logs)?, folder, &Bars::default())?;
        return print(&if arguments.json {
            serde_json::to_string(&written)?
        } else {
            let LeRobotSummary {
                episodes,
                frames,
                tasks,
                fps,
                resampled_from_hz,
            } = written;
            let resampled = resampled_from_hz.map_or(String::new(), |from_hz| {
                format!(", resampled from {from_hz:.2} Hz")
            });
            format!(
                "{}: {episodes} episodes, {frames} frames, {tasks} tasks, {fps} frames a second{resampled}",
                folder.display()
            )
        });
    }
    if let Some(folder) = &arguments.ros {
        return for_ros(arguments, folder);
    }
    for log in expand(&arguments.logs)? {
        let exported = export(&log, arguments.out.as_deref())?;
        tell(arguments, &log, (&exported, &exported.table), &exported.found)?;
    }
    Ok(())
}

fn for_ros(arguments: &Export, folder: &Path) -> Result<()> {
    for log in expand(&arguments.logs)? {
        let exported = export_ros(&log, folder, &arguments.topic)?;
        tell(arguments, &log, (&exported, &exported.bag), &exported.found)?;
    }
    Ok(())
}

/// Prints the content of a log, and the file that was written.
fn tell(
    arguments: &Export,
    log: &Path,
    (exported, file): (&impl Serialize, &Path),
    found: &LogFound,
) -> Result<()> {
    if let Some(recovered) = &found.recovered {
        say(&format!("{} {recovered}", log.display()));
    }
    let LogFound { frames, gaps, .. } = found;
    print(&if arguments.json {
        serde_json::to_string(exported)?
    } else {
        format!("{}: {frames} frames, {gaps} marked gaps", file.display())
    })
}
