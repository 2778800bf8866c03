//! Arguments of `twintac design`.

use std::path::PathBuf;

use clap::Args;
use twintac_design::{Figure, Variable};

/// Each design is a description with other numbers. Its gel is meshed and pressed by a ball with
/// finite elements. This gives sensitivity, range, cross-talk, localization error, hysteresis and
/// smallest force. All figures are simulated, with the noise of the chips alone. Results are kept,
/// so a search that was killed continues.
#[derive(Args, Debug)]
pub(crate) struct Design {
    /// Sensor description (TOML) [default: PhysTac].
    #[arg(long, value_name = "FILE")]
    pub(crate) sensor: Option<PathBuf>,
    /// A number of the description and its bounds, such as `gel.height_mm=4..10`,
    /// `taxels.pitch_mm=6..10` (the sides of a block move along),
    /// `gel.material.shear_modulus_kpa=8..40`, `gel.solid.size_mm[0]=30..50`,
    /// `taxels.port_radius_mm=0.5..2`. Repeat for more numbers.
    #[arg(long, value_name = "FIELD=LOW..HIGH", required = true)]
    pub(crate) vary: Vec<Variable>,
    /// Number of designs of a Latin hypercube [default: 50].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) designs: Option<u32>,
    /// Instead: all combinations of this many values of each number, bounds included.
    #[arg(long, value_name = "N", conflicts_with_all = ["designs", "seed"], value_parser = clap::value_parser!(u32).range(2..))]
    pub(crate) grid: Option<u32>,
    /// Seed of all random choices [default: 1].
    #[arg(long)]
    pub(crate) seed: Option<u64>,
    /// Figure to optimize. Repeat for more; the first three are the plot's axes and colour
    /// [default: range_n, smallest_force_n, localization_error_mm].
    #[arg(long, value_name = "FIGURE")]
    pub(crate) goal: Vec<Figure>,
    /// Limit of a figure that the best design has to meet, such as range_n=20 or
    /// cross_talk_percent=30. Repeat for more.
    #[arg(long, value_name = "FIGURE=VALUE", value_parser = need)]
    pub(crate) need: Vec<(Figure, f64)>,
    /// Force at which the figures are computed, N [default: 0.5].
    #[arg(long, value_name = "N")]
    pub(crate) force_n: Option<f64>,
    /// Radius of the ball, mm [default: 5].
    #[arg(long, value_name = "MM")]
    pub(crate) ball_radius_mm: Option<f64>,
    /// Standard deviation of a single reading's noise, kPa [default: the chip's by its data sheet,
    /// at least the readings' resolution].
    #[arg(long, value_name = "KPA")]
    pub(crate) noise_kpa: Option<f64>,
    /// Most nodes of each gel's mesh [default: 16000].
    #[arg(long, value_name = "N")]
    pub(crate) nodes: Option<usize>,
    /// Folder of the designs: designs.csv, designs.json, designs.png, best.toml.
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
    /// Print all designs as JSON.
    #[arg(long)]
    pub(crate) json: bool,
}

fn need(text: &str) -> Result<(Figure, f64), String> {
    let form = || format!("`{text}` is not of the form FIGURE=VALUE, such as range_n=20");
    let (figure, value) = text.split_once('=').ok_or_else(form)?;
    let value: f64 = value.trim().parse().map_err(|_| form())?;
    if !value.is_finite() {
        return Err(form());
    }
    Ok((figure.trim().parse()?, value))
}
