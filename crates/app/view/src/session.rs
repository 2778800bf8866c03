//! The session of a client.

/// The session of one client, from its first request to its last.
pub trait Session: Send {
    /// Answers a request. Both are whole messages.
    fn answer(&mut self, request: &[u8]) -> Vec<u8>;
}
