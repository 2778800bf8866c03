//! What a report shows: plain data that other crates fill in. Every part is optional, and what is absent is not shown.

mod evidence;
mod presses;
mod scores;

pub use evidence::{BenchFit, Gain, Parameter, SimulationQuality, Stage, TrainingCurve, WarpPath};
pub use presses::{Agreement, PlaceErrors, PressPeak, PressSeries};
pub use scores::{DepthError, FileError, Headline, Reference, ReferenceKind, TaxelError, Variant};

use twintac_plot::Scene;
use twintac_plot::page::{Badge, Fact};

/// The twin's error that the paper reports: mean absolute error over the largest contact pressure, %.
///
/// It was measured on the paper's own eight-taxel sensor, over another protocol.
pub const PAPER_ERROR_PERCENT: f64 = 5.95;

/// Where a number comes from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Provenance {
    /// Measured on a physical sensor.
    Real,
    /// Measured on an emulated bench: it says nothing about a physical sensor.
    Emulated,
    /// Computed.
    #[default]
    Simulated,
}

impl Provenance {
    pub(crate) fn badge(self) -> Badge {
        let word = match self {
            Provenance::Real => "real",
            Provenance::Emulated => "emulated",
            Provenance::Simulated => "simulated",
        };
        Badge(word.into())
    }
}

/// The sensor in a few facts and a drawing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SensorSummary {
    /// Its name.
    pub name: String,
    /// Dimensions, material, taxels.
    pub facts: Vec<Fact>,
    /// Top view and section.
    pub drawing: Option<Scene>,
}

/// Everything that a report shows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReportData {
    /// Title of the page.
    pub title: String,
    /// Where the sensor's readings come from; the badge of everything that is judged against them.
    pub provenance: Provenance,
    /// The command line that made the report.
    pub command: String,
    /// Versions of the program, the models and the data.
    pub versions: Vec<Fact>,
    /// The seed of all random streams.
    pub seed: Option<u64>,
    /// What the reader must know before trusting a number.
    pub warnings: Vec<String>,
    /// The sensor.
    pub sensor: Option<SensorSummary>,
    /// The twin's error in one number, with what it is compared to.
    pub headline: Option<Headline>,
    /// Readings over time for a few presses: the best, the median and the worst.
    pub presses: Vec<PressSeries>,
    /// Readings at the peak of a few presses, shown as pressure maps.
    pub peaks: Vec<PressPeak>,
    /// Errors over the places of static presses.
    pub places: Option<PlaceErrors>,
    /// All predicted against all measured readings.
    pub agreement: Option<Agreement>,
    /// Errors of each taxel.
    pub taxels: Vec<TaxelError>,
    /// Errors by the depth of the press.
    pub depths: Vec<DepthError>,
    /// Errors of each recording.
    pub files: Vec<FileError>,
    /// Twins that were compared.
    pub variants: Vec<Variant>,
    /// How each variant learned.
    pub training: Vec<TrainingCurve>,
    /// What was fitted about the bench.
    pub bench: Option<BenchFit>,
    /// How measured and simulated times were matched.
    pub warps: Vec<WarpPath>,
    /// How far the simulation can be trusted.
    pub simulation: Option<SimulationQuality>,
    /// Settings used, as the text of their file.
    pub settings: String,
    /// Wall time of each stage.
    pub stages: Vec<Stage>,
}
