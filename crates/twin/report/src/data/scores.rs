//! Errors, in % of the largest reading.

use super::Provenance;

/// The twin's error in one number.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Headline {
    /// Number of held-out presses behind the number.
    pub presses: usize,
    /// Mean absolute error of the nearest taxel while in contact, % of the largest reading.
    pub nearest_in_contact_percent: f64,
    /// Mean absolute error of all taxels in all frames, % of the largest reading.
    pub all_percent: f64,
    /// How the two are defined, in a sentence or two.
    pub definition: String,
    /// What to compare with, by the same measure. The paper's figure is added by the page.
    pub references: Vec<Reference>,
}

/// What a reference stands for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ReferenceKind {
    /// A simpler predictor, which a twin must beat.
    #[default]
    Baseline,
    /// The sensor's own repeatability, which no twin can beat.
    Floor,
}

/// Something to compare the twin with, by the same measure and on the same presses.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reference {
    /// Its name, such as "zero" or "polynomial".
    pub name: String,
    /// What it stands for.
    pub kind: ReferenceKind,
    /// Error of the nearest taxel in contact, %.
    pub nearest_in_contact_percent: f64,
    /// Error of all taxels in all frames, %.
    pub all_percent: Option<f64>,
}

/// One of the twins that were compared.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Variant {
    /// Its name.
    pub name: String,
    /// Held-out error of the nearest taxel in contact, %.
    pub nearest_in_contact_percent: f64,
    /// Held-out error of all taxels in all frames, %.
    pub all_percent: f64,
    /// Error on the validation presses, by which the choice was made, %.
    pub validation_percent: f64,
    /// Whether this is the one behind the headline.
    pub chosen: bool,
}

/// Errors on one recording.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FileError {
    /// The recording.
    pub name: String,
    /// What it was used for: training, validation or test.
    pub role: String,
    /// Where its readings come from; the report's if `None`.
    pub provenance: Option<Provenance>,
    /// Number of presses.
    pub presses: usize,
    /// Number of frames.
    pub frames: usize,
    /// Largest reading, kPa.
    pub largest_kpa: f64,
    /// Error of the nearest taxel in contact, %.
    pub nearest_in_contact_percent: f64,
    /// Error of all taxels in all frames, %.
    pub all_percent: f64,
}

/// Errors of one taxel.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TaxelError {
    /// The taxel.
    pub name: String,
    /// Error where it is the nearest and in contact, %; NaN where it never is.
    pub nearest_in_contact_percent: f64,
    /// Error in all frames, %.
    pub all_percent: f64,
    /// Mean signed error (twin minus sensor), %.
    pub bias_percent: f64,
    /// Anything special about it.
    pub note: String,
}

/// Errors of frames within a range of depths.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DepthError {
    /// From this depth, mm.
    pub from_mm: f64,
    /// To this depth, mm.
    pub to_mm: f64,
    /// Number of frames.
    pub frames: usize,
    /// Error of the nearest taxel in contact, %.
    pub nearest_in_contact_percent: f64,
}
