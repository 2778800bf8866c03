//! What a client talks to.

/// What a client talks to: it has one for itself, from its first request to its last.
pub trait Session: Send {
    /// The answer to a request; both are whole messages.
    fn answer(&mut self, request: &[u8]) -> Vec<u8>;
}
