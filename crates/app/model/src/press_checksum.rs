//! Identifies a recorded press, whatever file it is in.

use twintac_recording::Press;
use twintac_work::sha256;

/// SHA-256 of a press's times and readings, as hexadecimal digits. Names, files and formats do not
/// count.
pub fn press_checksum(press: &Press) -> String {
    let numbers = press.time_s.iter().chain(press.taxels_raw.iter().flatten());
    let bytes: Vec<u8> = numbers.flat_map(|number| number.to_le_bytes()).collect();
    sha256(&bytes)
}
