//! What all work of the program shares: its error [`WorkError`], who follows and stops it ([`Progress`], [`Caller`]), and protocols planned for a
//! sensor ([`Planned`]).

mod caller;
mod error;
mod files;
mod planned;
mod progress;

pub use caller::Caller;
pub use error::{At, WorkError, in_one_sentence};
pub use files::{read_text, sha256, sha256_of_file};
pub use planned::{Planned, target};
pub use progress::{Progress, Silent, Work, go_on};
