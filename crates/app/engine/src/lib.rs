//! A sensor's gel for a page: pressed frame by frame through one function.
//!
//! An [`Engine`] answers requests. A request is a JSON text, with bytes after it where it keeps a file or hands over what came over a line; an answer is a JSON text. What a page draws
//! comes beside it, as flat [`Arrays`]. The engine is the same wherever it works: in a browser (`web/engine`) and behind a WebSocket (`twintac view`).

mod arrays;
mod desk;
mod engine;
mod error;
mod files;
mod lattice;
mod map;
mod outline;
mod press;
mod request;
mod sensor_reply;

pub use arrays::{Array, Arrays};
pub use engine::Engine;
pub use request::Offer;
