//! What can go wrong in work of the program.

use std::error::Error;
use std::io;
use std::path::{Path, PathBuf};

use twintac_store::StoreError;

/// What is wrong, where, and what to do. The text of an error leaves its [`source`](Error::source) out: print the whole chain.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WorkError {
    /// Where the source happened: a stage, a file, or a press.
    #[error("{place}")]
    In {
        /// The place.
        place: String,
        /// What happened there.
        source: Box<Self>,
    },
    /// A device could not be reached.
    #[error("{action}")]
    Network {
        /// What was tried.
        action: String,
        /// What the operating system says.
        source: io::Error,
    },
    /// A file could not be read or written, a folder is in use, or a stage is not as it would be made now.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// A table could not be read.
    #[error("reading {}", path.display())]
    Csv {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
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
    /// [`Progress::is_stopped`](crate::Progress::is_stopped) said so.
    #[error("stopped before it was done; the same again goes on from there")]
    Stopped,
    /// What was given cannot be used: what is wrong, and what to do.
    #[error("{0}")]
    Input(String),
    /// A setting cannot be what it is.
    #[error("setting {0}")]
    Setting(#[from] twintac_config::Problem),
    /// A file that people write is wrong.
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
    /// Shapes cannot be learned.
    #[error(transparent)]
    Classify(#[from] twintac_classify::ClassifyError),
    /// A shape can't be.
    #[error(transparent)]
    Shape(#[from] twintac_shape::ShapeError),
    /// The fast twin had no lesson.
    #[error(transparent)]
    Teach(#[from] twintac_teach::TeachError),
    /// A fast twin could not be read or written.
    #[error(transparent)]
    Fast(#[from] twintac_fast::FastFileError),
    /// A twin could not be made or judged.
    #[error(transparent)]
    Twin(#[from] digitac::DigitacError),
    /// The emulated bench's physics failed.
    #[error(transparent)]
    Lab(#[from] twintac_lab::LabError),
    /// The emulated devices failed.
    #[error(transparent)]
    Emulate(#[from] twintac_emulate::EmulateError),
    /// The sensor could not be read.
    #[error(transparent)]
    Source(#[from] twintac_source::SourceError),
    /// What was read could not be shown.
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
    /// What a source of tables over depth failed with.
    #[error(transparent)]
    Tables(#[from] Box<dyn Error + Send + Sync>),
}

impl WorkError {
    /// A file with which an action went wrong: `.map_err(WorkError::file("reading", path))`.
    pub fn file(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> Self {
        let path = path.to_owned();
        move |source| Self::Store(StoreError::File { action, path, source })
    }
}

/// Says where an error happened.
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
