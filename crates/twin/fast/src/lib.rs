//! The twin without finite elements.

mod contact;
mod distance;
mod engine;
mod file;
mod judge;
mod lesson;
mod model;
mod network;
mod read;
mod surface;
mod training;

pub use distance::Body;
pub use file::FastFileError;
pub use judge::{GroupErrors, Judgement};
pub use lesson::{Lesson, LessonFrame, lesson_places_mm};
pub use model::FastGel;
pub use read::FastReader;
pub use training::{REPORT_STEPS, TrainProgress, TrainSettings};
