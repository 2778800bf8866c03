//! A small web server for one page and its WebSocket, for clients that have the token.
//!
//! [`Server::bind`] listens on an address and makes a random token; [`Server::url`] is the address
//! to open; [`Server::serve`] answers until it is stopped. A [`View`] has the page (HTML) and makes
//! a [`Session`] for each client. A [`GelSession`] is the session of `twintac view`: a sensor's gel
//! that the page presses, beside a connected sensor ([`Desk`]), if there is one.
//!
//! # How it works
//!
//! Other pages in the same browser, and other machines, must not be able to reach the server. A
//! request is therefore refused unless
//!
//! - its `Host` is the address that is listened on, given as an IP address or `localhost`: any
//!   other name could be made to point here;
//! - its `Origin`, if there is one, is the page itself: browsers send it with every WebSocket, and
//!   other programs do not;
//! - it has the token (128 random bits) of the printed address.
//!
//! At most 32 clients are served at a time, each on a thread of its own. A client that fails or is
//! slow ends alone: heads of requests have at most 16 KiB and 10 s, messages at most 64 MiB.
//! Messages of the WebSocket are binary: the length of a JSON text in 4 bytes (little-endian), the
//! text, and then bytes (see [`GelSession`]). The engine behind them is `crates/app/engine`.
//!
//! The crate reads no environment variable and no argument, prints nothing, and does not depend on
//! `crates/app/run`.

mod desk;
mod gel;
mod guard;
mod head;
mod page;
mod patient;
mod server;
mod session;
mod socket;

pub use desk::Desk;
pub use gel::{Begin, GelSession};
pub use page::PAGE;
pub use server::{Server, View, ViewError};
pub use session::Session;
