//! Lists the ports of a computer, and reports what arrives on one.

use std::time::{Duration, Instant};

use serialport::SerialPortType;

use crate::line::Wire;
use crate::{SerialLine, SourceError};

/// A port to which a sensor may be connected.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Port {
    /// The path to open: `/dev/ttyACM0`, `COM3`, `/dev/i2c-1`.
    pub path: String,
    /// A description for people.
    pub what: String,
    /// Whether it is a serial port and not an I²C bus.
    pub is_serial: bool,
}

/// What arrived on a port.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sound {
    /// Bytes per second.
    pub bytes_per_s: f64,
    /// Whole lines per second.
    pub lines_per_s: f64,
    /// How many numbers most lines have, and what separates them. `None` if it is no text.
    pub numbers: Option<(usize, &'static str)>,
    /// One of the lines.
    pub example: Option<String>,
}

/// The ports of this computer: serial ports, and I²C buses on Linux.
#[must_use]
pub fn ports() -> Vec<Port> {
    let serial = serialport::available_ports().unwrap_or_default();
    let mut ports: Vec<Port> = serial
        .into_iter()
        .map(|port| Port {
            what: match port.port_type {
                SerialPortType::UsbPort(usb) => {
                    let named = [usb.manufacturer, usb.product].into_iter().flatten();
                    let name: Vec<String> = named.collect();
                    let number = usb
                        .serial_number
                        .map_or(String::new(), |number| format!(", number {number}"));
                    format!("USB {:04x}:{:04x} {}{number}", usb.vid, usb.pid, name.join(" "))
                }
                SerialPortType::BluetoothPort => "Bluetooth".to_owned(),
                SerialPortType::PciPort | SerialPortType::Unknown => "serial port".to_owned(),
            },
            path: port.port_name,
            is_serial: true,
        })
        .collect();
    ports.extend(buses());
    ports.sort_by(|one, other| one.path.cmp(&other.path));
    ports
}

#[cfg(target_os = "linux")]
fn buses() -> Vec<Port> {
    let Ok(entries) = std::fs::read_dir("/dev") else {
        return Vec::new();
    };
    let paths = entries.filter_map(|entry| Some(entry.ok()?.path()));
    let is_bus = |path: &std::path::PathBuf| {
        path.file_name()
            .is_some_and(|name| name.to_string_lossy().starts_with("i2c-"))
    };
    let bus = |path: std::path::PathBuf| {
        let number = path
            .display()
            .to_string()
            .rsplit('-')
            .next()
            .unwrap_or_default()
            .to_owned();
        let name = std::fs::read_to_string(format!("/sys/class/i2c-dev/i2c-{number}/name"));
        Port {
            path: path.display().to_string(),
            what: format!("I2C bus: {}", name.unwrap_or_default().trim()),
            is_serial: false,
        }
    };
    paths.filter(is_bus).map(bus).collect()
}

#[cfg(not(target_os = "linux"))]
fn buses() -> Vec<Port> {
    Vec::new()
}

/// Listens to a serial port at `baud` bits per second.
///
/// # Errors
/// A port that cannot be opened or read.
pub fn listen(path: &str, baud: u32, for_how_long: Duration) -> Result<Sound, SourceError> {
    let text = format!("form = \"text\"\nfields = [\"pressure\"]\nserial.baud = {baud}");
    let description = twintac_line::Description::parse("ports", &text)?;
    let mut line = SerialLine::open(path, &description)?;
    let (begun, mut heard, mut bytes) = (Instant::now(), Vec::new(), [0; 4096]);
    while begun.elapsed() < for_how_long && heard.len() < 1 << 20 {
        let left = for_how_long.saturating_sub(begun.elapsed());
        let read = line.read(&mut bytes, left.min(Duration::from_millis(50)));
        let n = read.map_err(|error| SourceError::Wire {
            problem: error.to_string(),
        })?;
        heard.extend_from_slice(&bytes[..n]);
    }
    Ok(sound(&heard, begun.elapsed()))
}

/// What bytes look like that arrived within a time.
#[must_use]
pub fn sound(heard: &[u8], in_how_long: Duration) -> Sound {
    let seconds = in_how_long.as_secs_f64().max(1e-3);
    let pieces: Vec<&[u8]> = heard.split(|byte| *byte == b'\n').collect();
    // The first and the last piece may be incomplete.
    let whole = pieces.get(1..pieces.len().saturating_sub(1)).unwrap_or_default();
    let lines: Vec<&str> = whole
        .iter()
        .filter_map(|piece| std::str::from_utf8(piece).ok())
        .map(str::trim)
        .collect();
    let is_text = !whole.is_empty() && 2 * lines.len() > whole.len();
    let counted: Vec<(usize, &'static str)> = lines.iter().filter_map(|line| numbers(line)).collect();
    let usual = counted
        .iter()
        .copied()
        .max_by_key(|one| counted.iter().filter(|other| *other == one).count());
    Sound {
        bytes_per_s: heard.len() as f64 / seconds,
        lines_per_s: if is_text {
            lines.len() as f64 / seconds
        } else {
            0.0
        },
        numbers: usual.filter(|_| is_text),
        example: lines.last().filter(|_| is_text).map(|line| (*line).to_owned()),
    }
}

/// How many numbers a line has, and what separates them.
fn numbers(line: &str) -> Option<(usize, &'static str)> {
    if line.starts_with('{') {
        return Some((line.matches(':').count(), "JSON"));
    }
    let is_number = |cell: &str| cell.trim().parse::<f64>().is_ok();
    [
        (",", "commas"),
        (";", "semicolons"),
        ("\t", "tabs"),
        (" ", "blanks"),
    ]
    .into_iter()
    .find_map(|(separator, name)| {
        let cells: Vec<&str> = line
            .split(separator)
            .filter(|cell| !cell.trim().is_empty())
            .collect();
        let n = cells.iter().filter(|cell| is_number(cell)).count();
        (n > 1 && n == cells.len()).then_some((n, name))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_comes_is_told_apart() {
        let second = Duration::from_secs(1);
        let csv = sound(b"2.5\n1,2,3\n4,5,6\nboot\n7,8,9\n1,", second);
        assert_eq!((csv.numbers, csv.lines_per_s), (Some((3, "commas")), 4.0));
        assert_eq!(csv.example.as_deref(), Some("7,8,9"));
        assert_eq!(
            sound(b"\n{\"a\": 1, \"b\": 2}\n", second).numbers,
            Some((2, "JSON"))
        );
        assert_eq!(sound(b"\n1 2  3 \n", second).numbers, Some((3, "blanks")));
        let binary = sound(&[0xAA, 0x55, 0xFF, b'\n', 0xFE, 0x80, b'\n', 3], second);
        assert_eq!((binary.numbers, binary.lines_per_s), (None, 0.0));
        assert_eq!(sound(b"", second), Sound::default());
    }
}
