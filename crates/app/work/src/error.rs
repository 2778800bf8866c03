//! The errors of the application crates.

use std::error::Error;
use std::io;
use std::path::{Path, PathBuf};

use twintac_store::StoreError;

/// Says what is wrong, where, and what to do. The text of an error does not contain its
/// [`source`](Error::source): print the whole chain.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WorkError {
    /// Adds where the source error happened: a stage, a file, or a press.
    #[error("{place}")]
    In {
        /// The place.
        place: String,
        /// The error that happened there.
        source: Box<Self>,
    },
    /// A device could not be reached.
    #[error("{action}")]
    Network {
        /// What was tried.
        action: String,
        /// The error of the operating system.
        source: io::Error,
    },
    /// A file could not be read or written, a folder is in use, or a stage does not match its
    /// present inputs.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// A table could not be read.
    #[error("reading {}", path.display())]
    Csv {
        /// The file.
        path: PathBuf,
        /// The error of the CSV reader or writer.
        source: csv::Error,
    },
    /// A fitted material could not be written as TOML.
    #[error(transparent)]
    Toml(#[from] toml::ser::Error),
    /// The folder holds no run.
    #[error(
        "{} is not a run; start one with `twintac import` or `twintac record`",
        folder.display()
    )]
    NotARun {
        /// The folder.
        folder: PathBuf,
        /// What was expected in it.
        source: Box<Self>,
    },
    /// The caller stopped the work: [`Progress::is_stopped`](crate::Progress::is_stopped) returned
    /// true.
    #[error("stopped before it was done; the same command continues from there")]
    Stopped,
    /// An input cannot be used. The text says what is wrong and what to do.
    #[error("{0}")]
    Input(String),
    /// A setting has a value that is not allowed.
    #[error("setting {0}")]
    Setting(#[from] twintac_config::Problem),
    /// A file that a person wrote (TOML) has an error.
    #[error(transparent)]
    Config(#[from] twintac_config::ConfigError),
    /// A protocol does not fit the sensor.
    #[error(transparent)]
    Plan(#[from] twintac_protocol::PlanError),
    /// A recording could not be read or written.
    #[error(transparent)]
    Recording(#[from] twintac_recording::RecordingError),
    /// A log could not be read or written.
    #[error(transparent)]
    Log(#[from] twintac_log::LogError),
    /// The gel could not be meshed.
    #[error(transparent)]
    Mesh(#[from] twintac_mesh::MeshError),
    /// The gel could not be pressed.
    #[error(transparent)]
    Simulate(#[from] twintac_simulate::SimulateError),
    /// A material could not be fitted.
    #[error(transparent)]
    Calibrate(#[from] twintac_calibrate::CalibrateError),
    /// The shape classifier could not be trained.
    #[error(transparent)]
    Classify(#[from] twintac_classify::ClassifyError),
    /// A shape is impossible.
    #[error(transparent)]
    Shape(#[from] twintac_shape::ShapeError),
    /// A training press of the surrogate could not be made.
    #[error(transparent)]
    FemPress(#[from] twintac_fem_presses::FemPressError),
    /// A surrogate could not be read or written.
    #[error(transparent)]
    Fast(#[from] twintac_fast::FastFileError),
    /// A twin could not be trained or evaluated.
    #[error(transparent)]
    Twin(#[from] digitac::DigitacError),
    /// The physics of the emulated bench failed.
    #[error(transparent)]
    Lab(#[from] twintac_lab::LabError),
    /// The emulated devices failed.
    #[error(transparent)]
    Emulate(#[from] twintac_emulate::EmulateError),
    /// The sensor could not be read.
    #[error(transparent)]
    Source(#[from] twintac_source::SourceError),
    /// Frames could not be displayed.
    #[error(transparent)]
    Live(#[from] twintac_live::LiveError),
    /// Robot or force sensor could not be used.
    #[error(transparent)]
    Rig(#[from] twintac_rig::RigError),
    /// A protocol could not be carried out.
    #[error(transparent)]
    Press(#[from] twintac_press::PressError),
    /// A sensor could not be characterized.
    #[error(transparent)]
    Characterize(#[from] twintac_characterize::CharacterizeError),
    /// A picture or a page could not be made.
    #[error(transparent)]
    Plot(#[from] twintac_plot::PlotError),
    /// The error of a source of tables over depth.
    #[error(transparent)]
    Tables(#[from] Box<dyn Error + Send + Sync>),
}

impl WorkError {
    /// Wraps the error of an action on a file: `.map_err(WorkError::file("reading", path))`.
    pub fn file(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> Self {
        let path = path.to_owned();
        move |source| Self::Store(StoreError::File { action, path, source })
    }
}

/// Adds where an error happened.
pub trait At<T> {
    /// Puts a place before the error.
    fn at(self, place: impl FnOnce() -> String) -> Result<T, WorkError>;
}

impl<T, E: Into<WorkError>> At<T> for Result<T, E> {
    fn at(self, place: impl FnOnce() -> String) -> Result<T, WorkError> {
        self.map_err(|source| WorkError::In {
            place: place(),
            source: Box::new(source.into()),
        })
    }
}

/// An error with all its sources, as one sentence.
#[must_use]
pub fn in_one_sentence(error: &dyn Error) -> String {
    let mut text = error.to_string();
    let mut source = error.source();
    while let Some(error) = source {
        let next = error.to_string();
        if !text.ends_with(&next) {
            text = format!("{text}: {next}");
        }
        source = error.source();
    }
    text
}
