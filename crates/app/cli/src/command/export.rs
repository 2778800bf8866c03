//! `twintac export`: frames of logs as tables.

use anyhow::Result;
use twintac_run::export::export;

use super::files::expand;
use crate::arguments::Export;
use crate::output::print;
use crate::progress::say;

pub(super) fn run(arguments: &Export) -> Result<()> {
    for log in expand(&arguments.logs)? {
        let exported = export(&log, arguments.out.as_deref())?;
        if let Some(recovered) = &exported.recovered {
            say(&format!("{} was cut; {recovered}", log.display()));
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
