//! The twin without finite elements.

mod batch;
mod columns;
mod contact;
mod distance;
mod engine;
mod file;
mod footprint;
mod friction;
mod judge;
mod layout;
mod lesson;
mod model;
mod network;
mod networks;
mod novelty;
mod read;
mod shear;
mod simd;
mod surface;
mod taught;
mod touch;
mod training;

pub use batch::FastBatch;
pub use distance::Body;
pub use file::FastFileError;
pub use friction::Friction;
pub use judge::{GroupErrors, Judgement};
pub use layout::finest_edge_mm;
pub use lesson::{Lesson, LessonFrame, lesson_places_mm};
pub use model::FastGel;
pub use read::FastReader;
pub use taught::FastGelMismatch;
pub use touch::Touch;
pub use training::{REPORT_STEPS, TrainProgress, TrainSettings};
