//! The mechanics around a board, made by Python programs of the checkout.

use std::ffi::OsStr;
use std::path::Path;
use std::process::Command;

use anyhow::{Context, Result, ensure};

/// The environment variable that names a Python interpreter with the programs' packages.
const PYTHON: &str = "TWINTAC_HARDWARE_PYTHON";

/// Makes and checks the parts, and draws the casting sheet, if an interpreter is named. A failed
/// check is an error.
pub(crate) fn make(root: &Path, geometry: &Path, out: &Path) -> Result<()> {
    let Some(python) = std::env::var_os(PYTHON) else {
        eprintln!("  skipped: mechanics ({PYTHON} names no Python interpreter)");
        return Ok(());
    };
    let run = |program: &str, arguments: &[&OsStr]| {
        let program = root.join("hardware/mechanics").join(program);
        let output = Command::new(&python)
            .arg(&program)
            .args(arguments)
            .output()
            .with_context(|| format!("starting {}", python.display()))?;
        ensure!(
            output.status.success(),
            "{}:\n{}{}",
            program.display(),
            String::from_utf8_lossy(&output.stdout),
            String::from_utf8_lossy(&output.stderr)
        );
        Ok(())
    };
    run(
        "make.py",
        &[geometry.as_os_str(), "--out".as_ref(), out.as_os_str()],
    )?;
    run("check.py", &[out.as_os_str()])?;
    eprintln!("  mechanics: nothing found");
    match run("sheet.py", &[out.as_os_str()]) {
        Ok(()) => eprintln!("  casting sheet"),
        // The casting sheet contains a rendered picture.
        Err(error) => eprintln!(
            "  skipped: casting sheet, which takes an OpenGL that draws without a display ({error:#})"
        ),
    }
    Ok(())
}
