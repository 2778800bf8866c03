//! The error type of the library.

/// Says what is wrong, where, and what to do. The text of an error does not contain its
/// [`source`](std::error::Error::source).
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A sensor description cannot be used.
    #[error(transparent)]
    Sensor(#[from] twintac_sensor::SensorError),
    /// The gel cannot be pressed as requested.
    #[error(transparent)]
    Gel(#[from] twintac_simulate::SimulateError),
    /// The solver found no equilibrium at a depth.
    #[error("the gel cannot be pressed {depth_mm} mm deep: {reason}; press less deep")]
    Depth {
        /// The requested depth, mm.
        depth_mm: f64,
        /// The depth at which the press ended, and why.
        reason: String,
    },
    /// A recording cannot be read.
    #[cfg(feature = "recording")]
    #[error(transparent)]
    Recording(#[from] twintac_recording::RecordingError),
    /// A pressure map cannot be made.
    #[cfg(feature = "map")]
    #[error(transparent)]
    Map(#[from] twintac_map::MapError),
    /// A picture cannot be written.
    #[cfg(feature = "map")]
    #[error(transparent)]
    Picture(#[from] twintac_plot::PlotError),
    /// A twin cannot be read or used.
    #[cfg(feature = "twin")]
    #[error(transparent)]
    Twin(#[from] digitac::DigitacError),
    /// A twin's record does not fit this version of the library.
    #[cfg(feature = "twin")]
    #[error("the twin's settings of the simulation cannot be used")]
    TwinSettings(#[from] serde_json::Error),
    /// A path is impossible.
    #[error(transparent)]
    Path(#[from] twintac_protocol::PathError),
    /// A shape is impossible.
    #[error(transparent)]
    Shape(#[from] twintac_shape::ShapeError),
    /// A surrogate ([`FastGel`](crate::FastGel)) cannot be read.
    #[cfg(feature = "fast")]
    #[error(transparent)]
    Fast(#[from] twintac_fast::FastFileError),
    /// A surrogate ([`FastGel`](crate::FastGel)) belongs to another sensor.
    #[cfg(feature = "fast")]
    #[error(transparent)]
    FastMismatch(#[from] twintac_fast::FastGelMismatch),
    /// A sensor cannot be read.
    #[cfg(feature = "live")]
    #[error(transparent)]
    Live(#[from] twintac_live::LiveError),
    /// A run failed.
    #[cfg(feature = "run")]
    #[error(transparent)]
    Run(#[from] twintac_work::WorkError),
    /// Contacts cannot be estimated from readings.
    #[cfg(feature = "fast")]
    #[error(transparent)]
    Inverse(#[from] twintac_inverse::InverseError),
    /// A reinforcement-learning task cannot be made or stepped as requested.
    #[cfg(feature = "tasks")]
    #[error(transparent)]
    Task(#[from] twintac_tasks::TaskError),
}

/// The place of an error, as far as it is known.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ErrorPlace {
    /// The file, as the caller named it.
    pub file: Option<String>,
    /// Line, from 1.
    pub line: Option<u64>,
    /// The field or the column.
    pub field: Option<String>,
}

impl Error {
    /// Whether the error only says that a source, such as a replayed log, has no more frames.
    #[cfg(feature = "live")]
    #[must_use]
    pub fn is_over(&self) -> bool {
        use twintac_live::LiveError;
        use twintac_source::SourceError;
        matches!(self, Self::Live(LiveError::Source(SourceError::Over)))
    }

    /// The place of the error.
    #[must_use]
    pub fn place(&self) -> ErrorPlace {
        match self {
            Self::Sensor(error) => of_description(error),
            Self::Shape(error) => of_shape(error),
            Self::Path(error) => of_field(&error.field),
            Self::Gel(error) => of_simulation(error),
            #[cfg(feature = "recording")]
            Self::Recording(error) => of_recording(error),
            #[cfg(feature = "fast")]
            Self::Inverse(twintac_inverse::InverseError::Shape(error)) => of_shape(error),
            #[cfg(feature = "fast")]
            Self::Inverse(
                twintac_inverse::InverseError::Setting(problem)
                | twintac_inverse::InverseError::Frame(problem),
            ) => of_field(&problem.field),
            #[cfg(feature = "tasks")]
            Self::Task(twintac_tasks::TaskError::Count { .. }) => of_field("n_environments"),
            #[cfg(feature = "map")]
            Self::Map(twintac_map::MapError::Input { .. }) => of_field("readings_kpa"),
            #[cfg(feature = "map")]
            Self::Picture(
                twintac_plot::PlotError::Format { path } | twintac_plot::PlotError::Write { path, .. },
            ) => of_file(path.display()),
            #[cfg(feature = "twin")]
            Self::Twin(error) => of_twin(error),
            #[cfg(feature = "run")]
            Self::Run(error) => of_run(error),
            _ => ErrorPlace::default(),
        }
    }
}

fn of_description(error: &twintac_sensor::SensorError) -> ErrorPlace {
    ErrorPlace {
        file: Some(error.file.clone()),
        line: u64::try_from(error.line).ok().filter(|line| *line > 0),
        field: Some(error.field.clone()).filter(|field| !field.is_empty()),
    }
}

fn of_shape(error: &twintac_shape::ShapeError) -> ErrorPlace {
    of_field(&error.field)
}

fn of_simulation(error: &twintac_simulate::SimulateError) -> ErrorPlace {
    match error {
        twintac_simulate::SimulateError::NoIndenter { .. } => of_field("indenter"),
        twintac_simulate::SimulateError::ForceLimit { .. } => of_field("force_n"),
        _ => ErrorPlace::default(),
    }
}

#[cfg(feature = "twin")]
fn of_twin(error: &digitac::DigitacError) -> ErrorPlace {
    match error {
        digitac::DigitacError::File { path, .. } | digitac::DigitacError::Model { path, .. } => of_file(path),
        digitac::DigitacError::Setting(problem) => of_field(&problem.field),
        _ => ErrorPlace::default(),
    }
}

fn of_field(field: &str) -> ErrorPlace {
    ErrorPlace {
        field: Some(field.to_owned()),
        ..ErrorPlace::default()
    }
}

#[cfg(any(feature = "map", feature = "twin", feature = "run"))]
fn of_file(file: impl std::fmt::Display) -> ErrorPlace {
    ErrorPlace {
        file: Some(file.to_string()),
        ..ErrorPlace::default()
    }
}

#[cfg(feature = "recording")]
fn of_recording(error: &twintac_recording::RecordingError) -> ErrorPlace {
    use twintac_recording::RecordingError as Wrong;
    let (file, line, field) = match error {
        Wrong::Description(error) => return of_description(error),
        Wrong::MissingColumn { file, column, .. } => (file, Some(1), Some(column)),
        Wrong::BagColumn { file, column, .. } => (file, None, Some(column)),
        Wrong::Line { file, line, .. } => (file, Some(*line), None),
        Wrong::Cell {
            file, line, column, ..
        } => (file, Some(*line), Some(column)),
        Wrong::Read { file, .. }
        | Wrong::Bag { file, .. }
        | Wrong::Write { file, .. }
        | Wrong::NoPresses { file, .. }
        | Wrong::Damaged { file, .. } => (file, None, None),
        _ => return ErrorPlace::default(),
    };
    ErrorPlace {
        file: Some(file.clone()),
        line,
        field: field.cloned(),
    }
}

#[cfg(feature = "run")]
fn of_run(error: &twintac_work::WorkError) -> ErrorPlace {
    use twintac_store::StoreError;
    use twintac_work::WorkError as Wrong;
    let path = match error {
        Wrong::In { source, .. } => return of_run(source),
        Wrong::Config(error) => return of_description(error),
        Wrong::Setting(problem) => return of_field(&problem.field),
        Wrong::Recording(error) => return of_recording(error),
        Wrong::Shape(error) => return of_shape(error),
        Wrong::Simulate(error) => return of_simulation(error),
        Wrong::Twin(error) => return of_twin(error),
        Wrong::Store(StoreError::File { path, .. } | StoreError::Damaged { path, .. })
        | Wrong::Csv { path, .. } => path,
        Wrong::Store(StoreError::InUse { folder, .. }) | Wrong::NotARun { folder, .. } => folder,
        _ => return ErrorPlace::default(),
    };
    of_file(path.display())
}
