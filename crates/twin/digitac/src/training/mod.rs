//! Training: division of presses into training, validation and test presses, training of each
//! variant, and selection of a variant.

mod batch;
mod held_out;
mod settings;
mod split;
mod train;

pub use held_out::{Fold, HeldOut};
pub(crate) use settings::{MOST_LAYERS, MOST_WIDTH};
pub use settings::{TrainSettings, TrainedWith};
pub use split::{Split, SplitSettings};
pub use train::{Epoch, Progress, Trained, choose, train};
