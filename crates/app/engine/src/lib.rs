//! The engine behind the interactive web page: it presses a sensor's gel frame by frame, and
//! answers requests in JSON.
//!
//! An [`Engine`] answers requests ([`Engine::answer`]). A request is a JSON text; bytes follow it
//! if it stores a file or passes on what came over a serial line. An answer is a JSON text: forces
//! in N, torques in N mm, pressures in kPa, depth in mm. What a page draws is beside it, as flat
//! [`Arrays`]: nodes, displacements, pressures, a pressure map, the indenter's surface. The same
//! engine works in a browser (`web/engine`) and behind a WebSocket (`twintac view`).
//!
//! # How it works
//!
//! - A page opens a sensor's description (and stores the surface files that it names), prepares a
//!   mesh for one indenter, and then moves the indenter: each step solves one frame from the last
//!   one, with friction and relaxation as described. The mesh is fine at locations all over the
//!   gel, 0.6 gel heights apart, because the user may press anywhere.
//! - The indenter is drawn from the same signed distance that presses (surface nets on a grid), so
//!   what is drawn is what presses.
//! - A real or emulated sensor can be shown beside its twin. Its frames come byte by byte over a
//!   line that the page reads, or the program around the engine hands them over
//!   ([`Engine::take_frame`]). The mean of the first 32 frames is its zero. [`Offer`] says what the
//!   surrounding program provides.
//! - With a surrogate of the gel (`twintac-fast`), several shapes press at once, without friction
//!   or viscoelastic relaxation. The drawn gel is then only moved out of the shapes: a surrogate
//!   has pressures at the taxels and the force, and no stress elsewhere.
//! - A wrong request is answered by `{"error": "…"}` in the words of the command line, and leaves
//!   the engine as it was.
//!
//! The crate uses no files, reads no environment variable and no argument, and prints nothing: it
//! also runs in a browser.

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
mod surrogate;

pub use arrays::{Array, Arrays};
pub use engine::Engine;
pub use request::Offer;
