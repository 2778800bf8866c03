//! The head of an HTTP request.

use std::io::{self, Read};

/// Longest head that is accepted, bytes.
const LONGEST: usize = 16 * 1024;
/// Most headers that are accepted.
const MOST_HEADERS: usize = 64;

/// The parts of a request's head that the server uses.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Head {
    pub(crate) method: String,
    /// The path, without the query.
    pub(crate) path: String,
    /// The value of `token` in the query.
    pub(crate) token: Option<String>,
    pub(crate) host: Option<String>,
    pub(crate) origin: Option<String>,
    /// The key of a client that asks for a WebSocket.
    pub(crate) socket_key: Option<String>,
}

impl Head {
    /// Reads a head up to its empty line. Bytes after it are an error: a client has to wait for the
    /// answer.
    pub(crate) fn read(stream: &mut impl Read) -> io::Result<Self> {
        let mut bytes = Vec::new();
        let mut part = [0; 2048];
        loop {
            if let Some(head) = Self::parse(&bytes)? {
                return Ok(head);
            }
            if bytes.len() > LONGEST {
                return Err(bad("the head of a request is too long"));
            }
            match stream.read(&mut part)? {
                0 => return Err(io::ErrorKind::UnexpectedEof.into()),
                n => bytes.extend_from_slice(&part[..n]),
            }
        }
    }

    /// Parses a head; `None` if it is not complete yet.
    pub(crate) fn parse(bytes: &[u8]) -> io::Result<Option<Self>> {
        let mut headers = [httparse::EMPTY_HEADER; MOST_HEADERS];
        let mut request = httparse::Request::new(&mut headers);
        if request.parse(bytes).map_err(bad)?.is_partial() {
            return Ok(None);
        }
        let (path, query) = match request.path.unwrap_or_default().split_once('?') {
            Some((path, query)) => (path, query),
            None => (request.path.unwrap_or_default(), ""),
        };
        let header = |name: &str| -> io::Result<Option<String>> {
            let mut found = request
                .headers
                .iter()
                .filter(|header| header.name.eq_ignore_ascii_case(name));
            let first = found.next().map(|header| header.value);
            if found.next().is_some() {
                return Err(bad(format!("the header {name} is there twice")));
            }
            let text = first.map(|value| std::str::from_utf8(value).map(str::trim));
            Ok(text.transpose().map_err(bad)?.map(str::to_owned))
        };
        let is_socket = header("upgrade")?.is_some_and(|what| what.eq_ignore_ascii_case("websocket"));
        Ok(Some(Self {
            method: request.method.unwrap_or_default().to_owned(),
            path: path.to_owned(),
            token: query
                .split('&')
                .find_map(|field| field.strip_prefix("token="))
                .map(str::to_owned),
            host: header("host")?,
            origin: header("origin")?,
            socket_key: header("sec-websocket-key")?.filter(|_| is_socket),
        }))
    }
}

fn bad(error: impl Into<Box<dyn std::error::Error + Send + Sync>>) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, error)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const HEAD: &[u8] = b"GET /engine?x=1&token=abc HTTP/1.1\r\nHost: 127.0.0.1:8000\r\nupgrade: WebSocket\r\nOrigin: http://127.0.0.1:8000\r\n\
        Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n";

    #[test]
    fn a_head_is_read_however_it_arrives() {
        for n in [1, 7, HEAD.len()] {
            let mut parts = HEAD.chunks(n);
            let mut bytes = Vec::new();
            let head = loop {
                if let Some(head) = Head::parse(&bytes).unwrap() {
                    break head;
                }
                bytes.extend_from_slice(parts.next().unwrap());
            };
            let text = |text: &str| Some(text.to_owned());
            assert_eq!(
                head,
                Head {
                    method: "GET".to_owned(),
                    path: "/engine".to_owned(),
                    token: text("abc"),
                    host: text("127.0.0.1:8000"),
                    origin: text("http://127.0.0.1:8000"),
                    socket_key: text("dGhlIHNhbXBsZSBub25jZQ=="),
                }
            );
        }
    }

    #[test]
    fn a_head_that_never_ends_or_says_two_things_is_refused() {
        let mut endless = io::repeat(b'x');
        assert!(Head::read(&mut endless).is_err());
        let mut many = b"GET / HTTP/1.1\r\n".to_vec();
        many.extend(b"a: b\r\n".repeat(1_000_000));
        assert!(Head::read(&mut many.as_slice()).is_err());
        let twice = b"GET / HTTP/1.1\r\nHost: a\r\nHost: b\r\n\r\n";
        assert!(Head::parse(twice).is_err());
        assert!(Head::read(&mut &HEAD[..40]).is_err(), "cut");
    }

    proptest! {
        #[test]
        fn no_bytes_break_it(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
            let _ = Head::parse(&bytes);
            let mut damaged = HEAD.to_vec();
            for (place, byte) in bytes.iter().enumerate().take(20) {
                let place = (place * 17 + usize::from(*byte)) % damaged.len();
                damaged[place] = *byte;
            }
            let _ = Head::read(&mut damaged.as_slice());
        }
    }
}
