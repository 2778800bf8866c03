//! Errors other than those of the test setup itself.

use std::path::Path;

use glam::DVec3;
use twintac_config::ConfigError;
use twintac_log::LogError;
use twintac_rig::RigError;

/// Why a run did not begin, or could not be recorded. A cause to stop the test setup is a
/// [`Cause`](twintac_rig::Cause) instead.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PressError {
    /// The settings are wrong.
    #[error(transparent)]
    Settings(#[from] ConfigError),
    /// Settings that a program made or changed are wrong, or the devices are not supervised closely
    /// enough.
    #[error("the hardware configuration: `{field}` {problem}; {hint}")]
    Setting {
        /// The field, as a dotted path.
        field: &'static str,
        /// What is wrong with it, read after its name.
        problem: String,
        /// What to do about it.
        hint: String,
    },
    /// The settings do not say where the devices of a real setup are.
    #[error(
        "the hardware configuration has no [devices]: say where robot, force and tactile are, or press on the emulated bench"
    )]
    NoDevices,
    /// The sensor's description gives no limits.
    #[error(
        "the description of sensor `{sensor}` does not say which force and depth it withstands; add a table [limits] with force_n and depth_mm"
    )]
    NoLimits {
        /// Name of the description.
        sensor: String,
    },
    /// The robot's controller has another tool centre point than the settings.
    #[error(
        "the robot's controller has a TCP offset of {found_mm} mm, and `devices.tcp_offset_mm` is {expected_mm}: the robot would go to wrong poses; make them equal and measure [placement] again"
    )]
    OtherTool {
        /// The tool centre point of the controller in the flange's frame, mm.
        found_mm: DVec3,
        /// The tool centre point of the settings, mm.
        expected_mm: DVec3,
    },
    /// The supervisor refuses the settings.
    #[error(transparent)]
    Rig(#[from] RigError),
    /// A log could not be written or read.
    #[error(transparent)]
    Log(#[from] LogError),
    /// A file of the run's folder could not be read or written.
    #[error("{file}: {source}")]
    File {
        /// The file.
        file: String,
        /// What the operating system says.
        source: std::io::Error,
    },
    /// The folder holds another run.
    #[error("{folder} has a run of other presses: {problem}; choose another folder")]
    OtherRun {
        /// The folder.
        folder: String,
        /// What differs.
        problem: String,
    },
    /// No thread could be started.
    #[error("cannot start a thread for {what}: {source}")]
    Thread {
        /// What it is for.
        what: &'static str,
        /// What the operating system says.
        source: std::io::Error,
    },
    /// A planned press has a number that cannot be carried out.
    #[error("press `{press}`: `{field}` is {found}")]
    Plan {
        /// The press.
        press: String,
        /// The field.
        field: &'static str,
        /// Its value.
        found: f64,
    },
}

impl PressError {
    pub(crate) fn file(file: &Path, source: std::io::Error) -> Self {
        let file = file.display().to_string();
        Self::File { file, source }
    }
}
