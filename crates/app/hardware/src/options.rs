//! What the program is asked for.

use std::path::PathBuf;

use clap::Parser;

/// Writes board project, geometry, parts list and, where `kicad-cli` 9 is installed, checked
/// fabrication files.
#[derive(Parser)]
#[command(name = "cargo xtask hardware")]
pub(crate) struct Options {
    /// The description of a sensor; left out: the three variants that ship
    #[arg(long)]
    pub(crate) sensor: Option<PathBuf>,
    /// The barometer on the board, such as MS5837-30BA; left out: that of the description
    #[arg(long, requires = "sensor")]
    pub(crate) chip: Option<String>,
    /// Where files are written: a folder for each variant
    #[arg(long, default_value = "target/hardware")]
    pub(crate) out: PathBuf,
    /// Also write one archive for each variant
    #[arg(long)]
    pub(crate) release: bool,
    /// The root of the checkout
    #[arg(long, default_value = ".", hide = true)]
    pub(crate) root: PathBuf,
}
