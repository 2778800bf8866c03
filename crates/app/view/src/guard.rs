//! Access control.

use std::net::{IpAddr, SocketAddr};

use crate::head::Head;

/// The conditions that a request has to meet.
#[derive(Clone, Debug)]
pub(crate) struct Guard {
    /// The address that the server listens on.
    pub(crate) address: SocketAddr,
    pub(crate) token: String,
}

/// Why a request is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub(crate) enum Refusal {
    #[error("the request is for another address")]
    Host,
    #[error("the request comes from another page")]
    Origin,
    #[error("the token is missing or wrong: open the address that `twintac view` printed")]
    Token,
}

impl Guard {
    /// Accepts a request, or says why it is refused.
    pub(crate) fn check(&self, head: &Head) -> Result<(), Refusal> {
        let host = head.host.as_deref().unwrap_or_default();
        if !self.is_here(host) {
            return Err(Refusal::Host);
        }
        // Browsers send the origin of the page that opens a WebSocket; other programs do not.
        if head
            .origin
            .as_deref()
            .is_some_and(|origin| origin.strip_prefix("http://") != Some(host))
        {
            return Err(Refusal::Origin);
        }
        if !is_same(head.token.as_deref().unwrap_or_default(), &self.token) {
            return Err(Refusal::Token);
        }
        Ok(())
    }

    /// Whether a host with its port means this server. Only addresses and `localhost` are accepted,
    /// because any other name could be made to point here.
    fn is_here(&self, host: &str) -> bool {
        let Some((name, port)) = host.rsplit_once(':') else {
            return false;
        };
        if port != self.address.port().to_string() {
            return false;
        }
        if name.eq_ignore_ascii_case("localhost") {
            return true;
        }
        let name = name
            .strip_prefix('[')
            .and_then(|name| name.strip_suffix(']'))
            .unwrap_or(name);
        let Ok(address) = name.parse::<IpAddr>() else {
            return false;
        };
        address == self.address.ip() || self.address.ip().is_unspecified()
    }
}

/// Whether two texts are equal, in a time that does not depend on how many characters agree.
fn is_same(a: &str, b: &str) -> bool {
    let differing = a.bytes().zip(b.bytes()).fold(0, |all, (a, b)| all | (a ^ b));
    a.len() == b.len() && differing == 0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn head(host: &str, origin: Option<&str>, token: Option<&str>) -> Head {
        Head {
            host: Some(host.to_owned()),
            origin: origin.map(str::to_owned),
            token: token.map(str::to_owned),
            ..Head::default()
        }
    }

    #[test]
    fn only_the_page_itself_is_let_in() {
        let guard = Guard {
            address: "127.0.0.1:8000".parse().unwrap(),
            token: "secret".to_owned(),
        };
        let here = Some("http://127.0.0.1:8000");
        for (host, origin, token, expected) in [
            ("127.0.0.1:8000", here, Some("secret"), Ok(())),
            ("127.0.0.1:8000", None, Some("secret"), Ok(())),
            (
                "localhost:8000",
                Some("http://localhost:8000"),
                Some("secret"),
                Ok(()),
            ),
            ("127.0.0.1:8000", here, None, Err(Refusal::Token)),
            ("127.0.0.1:8000", here, Some(""), Err(Refusal::Token)),
            ("127.0.0.1:8000", here, Some("secreT"), Err(Refusal::Token)),
            ("127.0.0.1:8000", here, Some("secret1"), Err(Refusal::Token)),
            ("127.0.0.1:8000", here, Some("secre"), Err(Refusal::Token)),
            (
                "127.0.0.1:8000",
                Some("http://evil.example"),
                Some("secret"),
                Err(Refusal::Origin),
            ),
            (
                "127.0.0.1:8000",
                Some("https://127.0.0.1:8000"),
                Some("secret"),
                Err(Refusal::Origin),
            ),
            (
                "127.0.0.1:8000",
                Some("null"),
                Some("secret"),
                Err(Refusal::Origin),
            ),
            (
                "127.0.0.1:8000",
                Some("http://127.0.0.1:80001"),
                Some("secret"),
                Err(Refusal::Origin),
            ),
            (
                "evil.example:8000",
                Some("http://evil.example:8000"),
                Some("secret"),
                Err(Refusal::Host),
            ),
            (
                "localhost.evil.example:8000",
                None,
                Some("secret"),
                Err(Refusal::Host),
            ),
            ("127.0.0.1:8001", here, Some("secret"), Err(Refusal::Host)),
            ("127.0.0.1", None, Some("secret"), Err(Refusal::Host)),
            ("192.168.0.2:8000", None, Some("secret"), Err(Refusal::Host)),
            ("", None, Some("secret"), Err(Refusal::Host)),
        ] {
            assert_eq!(
                guard.check(&head(host, origin, token)),
                expected,
                "{host} {origin:?} {token:?}"
            );
        }
    }

    #[test]
    fn where_all_addresses_are_listened_on_names_are_still_refused() {
        let guard = Guard {
            address: "[::]:8000".parse().unwrap(),
            token: "secret".to_owned(),
        };
        for host in ["192.168.0.2:8000", "[fe80::1]:8000", "localhost:8000"] {
            assert_eq!(guard.check(&head(host, None, Some("secret"))), Ok(()), "{host}");
        }
        for host in ["robot.example:8000", "192.168.0.2:80", "192.168.0.2"] {
            assert_eq!(
                guard.check(&head(host, None, Some("secret"))),
                Err(Refusal::Host),
                "{host}"
            );
        }
    }
}
