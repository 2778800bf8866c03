//! Command-line options.

use std::path::PathBuf;

use clap::Parser;

/// Writes the board project, geometry and parts list, and checked fabrication files if `kicad-cli`
/// 9 is installed.
#[derive(Parser)]
#[command(name = "cargo xtask hardware")]
pub(crate) struct Options {
    /// Description of a sensor; default: the three shipped variants
    #[arg(long)]
    pub(crate) sensor: Option<PathBuf>,
    /// Barometer on the board, such as MS5837-30BA; default: that of the description
    #[arg(long, requires = "sensor")]
    pub(crate) chip: Option<String>,
    /// Folder to write to; each variant has a folder in it
    #[arg(long, default_value = "target/hardware")]
    pub(crate) out: PathBuf,
    /// Also write one archive for each variant
    #[arg(long)]
    pub(crate) release: bool,
    /// Root of the checkout
    #[arg(long, default_value = ".", hide = true)]
    pub(crate) root: PathBuf,
}
