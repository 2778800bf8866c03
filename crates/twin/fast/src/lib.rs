//! The twin without finite elements.

mod contact;
mod distance;
mod engine;
mod judge;
mod lesson;
mod model;
mod network;
mod read;
mod surface;
mod training;

pub use distance::Body;
pub use judge::{GroupErrors, Judgement};
pub use lesson::{Lesson, LessonFrame, lesson_places_mm};
pub use model::FastGel;
pub use read::FastReader;
pub use training::{TrainProgress, TrainSettings};
