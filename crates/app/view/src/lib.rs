//! A page and its WebSocket, served to whoever has the token.
//!
//! A page that is open in a browser must not be reachable by other pages in that browser, nor by other machines: a request has to name the address that
//! is listened on (so that no other name can be made to point here), come from the page itself, and have the token that is in the printed address.
//! What is answered, a [`Session`] says: one for each client.

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
