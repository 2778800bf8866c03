//! The format of a file, from its first bytes.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use crate::mcap::MAGIC;

/// Number of bytes that are read.
const LOOKED_AT: u64 = 16;

/// The format of a file.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Is {
    Mcap,
    /// A recording in a format that is not read, with advice.
    Other(&'static str),
    /// Not a recording of ROS.
    NoBag,
}

/// The format of a file. A file that cannot be read is not a recording.
pub(super) fn look(path: &Path) -> Is {
    if path.join("metadata.yaml").is_file() {
        return Is::Other("is the folder of a bag; give the *.mcap files in it; each is read on its own");
    }
    let mut bytes = Vec::new();
    let read = File::open(path).and_then(|file| file.take(LOOKED_AT).read_to_end(&mut bytes));
    match read {
        Ok(_) => of(&bytes),
        Err(_) => Is::NoBag,
    }
}

fn of(bytes: &[u8]) -> Is {
    const SQLITE: &[u8] = b"SQLite format 3\0";
    const ROS_1: &[u8] = b"#ROSBAG V";
    const ZSTD: &[u8] = &[0x28, 0xB5, 0x2F, 0xFD];
    match bytes {
        _ if bytes.starts_with(&MAGIC) => Is::Mcap,
        _ if bytes.starts_with(SQLITE) => Is::Other(
            "is a bag in SQLite (.db3); `ros2 bag convert -i FILE -o mcap.yaml` converts it to MCAP, with `output_bags: [{ uri: converted, storage_id: mcap, all: true }]` in mcap.yaml",
        ),
        _ if bytes.starts_with(ROS_1) => Is::Other(
            "is a bag of ROS 1; `rosbags-convert` (of the Python package rosbags) converts it to a bag of ROS 2, in MCAP",
        ),
        _ if bytes.starts_with(ZSTD) => Is::Other("is compressed as a whole; `zstd -d FILE` unpacks it"),
        _ => Is::NoBag,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bags_of_other_kinds_are_known_by_their_first_bytes() {
        assert_eq!(of(b"\x89MCAP0\r\n\x01"), Is::Mcap);
        for (bytes, remedy) in [
            (&b"SQLite format 3\0rest"[..], "ros2 bag convert"),
            (b"#ROSBAG V2.0\n", "rosbags-convert"),
            (b"\x28\xB5\x2F\xFD\x04", "zstd -d"),
        ] {
            let Is::Other(said) = of(bytes) else {
                panic!("{bytes:?}")
            };
            assert!(said.contains(remedy), "{said}");
        }
        for bytes in [&b""[..], b"time,z\n", b"\x89MCAP"] {
            assert_eq!(of(bytes), Is::NoBag);
        }
    }
}
