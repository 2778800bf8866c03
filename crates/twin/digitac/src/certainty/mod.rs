//! Uncertainty of a twin: a 90 % interval for every reading, and an out-of-distribution (OOD) score
//! for every contact (in code: ood_score).
//!
//! ```text
//! calibrate   setup and twin fitted again, four times without a quarter of the training locations,
//!             and without
//!             the deepest and the outermost fifth of the presses
//! spread      the probable size of an error, from what is known before the measurement: the
//!             reading, its rate,
//!             the frame's largest reading, the OOD score
//! training_set  the OOD score of a contact: location, depth, and the contact geometry of the
//!             indenter
//! certain     both together: half widths, OOD score and flag of each frame
//! score       coverage and width of the intervals on presses that were not used for training
//! ```
//!
//! **Intervals** are split-conformal (Lei et al., JASA 113, 2018). Half an interval is the spread
//! times the factor that covers 90 % of the readings of left-out presses. There is one factor for
//! non-contact frames and one for contact. The twins that are fitted again have no perceptron,
//! because it corrects little and takes most of the time of a training. A left-out location lies
//! between training locations, as locations that are held out for testing do.
//!
//! **OOD score.** An indenter is known by its contact geometry, not by its name: heights on rings
//! around its origin (`twintac_shape::Underside`), rotated as it presses. The difference of two
//! contact geometries at a depth is the volume that only one of them displaces, over the volume
//! that either displaces. A shape from a file of its own is therefore scored like any other. The
//! training set is kept press by press, with the largest depth of each, because a press has passed
//! every depth above its deepest. The score of a contact is the larger of two numbers: the distance
//! to the nearest training location, in spacings of the training locations; and the distance to the
//! nearest training press in depth, contact geometry and location, the last of these with a scale
//! three times as long. Contacts between training contacts have a score below about 1.
//!
//! A frame is flagged above a threshold. The threshold is the score that 99 % of the frames of
//! left-out presses in contact stay below, and at least 1. Above a score of 1, intervals widen with
//! the score. The rate of widening is such that 90 % of the readings of the deepest and the
//! outermost presses are covered when these presses are left out.
//!
//! The published twin is made of all presses, including test presses. Its intervals are those of
//! the twin without the test presses. All presses form its training set for the OOD score.

mod calibrate;
mod certain;
mod score;
mod spread;
#[cfg(test)]
mod tests;
mod training_set;

pub use calibrate::{TrainingData, calibrate};
pub use certain::{Certainty, PressCertainty};
pub use score::{CertaintyScore, area_under_curve, score_certainty};
pub use training_set::Contact;
pub(crate) use training_set::TrainingSet;
