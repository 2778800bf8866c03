//! `twintac export`: frames of logs as tables.

use anyhow::Result;
use twintac_recorded::{export, export_lerobot};
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
            } = written;
            format!(
                "{}: {episodes} episodes, {frames} frames, {tasks} tasks",
                folder.display()
            )
        });
    }
    for log in expand(&arguments.logs)? {
        let exported = export(&log, arguments.out.as_deref())?;
        if let Some(recovered) = &exported.recovered {
            say(&format!("{} {recovered}", log.display()));
        }
        print(&if arguments.json {
            serde_json::to_string(&exported)?
        } else {
            format!(
                "{}: {} frames, {} marked gaps",
                exported.table.display(),
                exported.frames,
                exported.gaps
            )
        })?;
    }
    Ok(())
}
