//! The description of how a microcontroller sends its readings, as a TOML file.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use twintac_config::{ConfigError, Document};

use crate::checksum::Checksum;
use crate::field::{Field, Meaning};
use crate::unit::{PressureUnit, TimeUnit};

/// How frames are sent over a line.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Description {
    /// Text, JSON or packets.
    pub form: Form,
    /// The fields of a line or a packet, from left to right; not for JSON.
    #[serde(default)]
    pub fields: Vec<Field>,
    /// For JSON: the field for each key. A key with a list has its numbers in order; pressures may
    /// have a key for each taxel.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub keys: BTreeMap<String, Field>,
    /// The format of text.
    #[serde(default)]
    pub text: Text,
    /// The format of packets.
    #[serde(default)]
    pub binary: Binary,
    /// The clock of the microcontroller.
    #[serde(default)]
    pub time: Time,
    /// The value at which the frame number rolls over to 0. Default 2³².
    #[serde(default = "two_to_32")]
    pub sequence_wraps_at: f64,
    /// The scale of pressures.
    #[serde(default)]
    pub pressure: Pressure,
    /// The scale of temperatures.
    #[serde(default)]
    pub temperature: Temperature,
    /// The index of the taxel of each pressure, from 0, in the order of the fields. Default: the
    /// order of the sensor's taxels.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub taxel_order: Option<Vec<usize>>,
    /// Frame rate, Hz. A longer time between two frames then means that frames are missing. If left
    /// out, only frame numbers show missing frames.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate_hz: Option<f64>,
    /// The serial port.
    #[serde(default)]
    pub serial: Serial,
}

/// The kind of frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Form {
    /// A line of numbers for each frame.
    Text,
    /// A JSON object on a line for each frame.
    Json,
    /// Packets of bytes.
    Binary,
}

/// The format of text.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Text {
    /// The separator of numbers: a character, or `blank` for any number of blanks and tabs.
    pub separator: String,
    /// The beginning of a line of readings; other lines are passed over.
    pub prefix: String,
    /// Characters that are ignored, such as brackets.
    pub strip: String,
    /// The beginning of a comment.
    pub comment: String,
    /// Texts for a missing reading, in addition to an empty text and `nan`.
    pub missing: Vec<String>,
    /// The checksum of a line: hexadecimal digits after a `*` at its end, computed over everything
    /// before the `*`.
    pub checksum: Option<Checksum>,
    /// Number of lines of a frame, if an empty line ends each frame. Default 1.
    pub lines: usize,
    /// Largest length of a line, bytes.
    pub longest: usize,
}

/// The format of packets.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Binary {
    /// How the beginning and end of a packet are marked.
    pub framing: Framing,
    /// Bytes at the beginning of a packet, before its fields; for `framing = "sync"`.
    pub sync: Vec<u8>,
    /// The byte order of numbers.
    pub order: ByteOrder,
    /// The checksum after the fields, computed over the fields only, in the byte order of numbers.
    pub checksum: Option<Checksum>,
}

/// How the beginning of a packet is marked.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Framing {
    /// By the bytes of `sync`, which may also occur inside. Without a checksum a packet is accepted
    /// only when the next one begins directly after it, which is a frame later.
    #[default]
    Sync,
    /// By consistent overhead byte stuffing (COBS): zeros occur between packets only.
    Cobs,
}

/// The byte order of numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ByteOrder {
    /// Least significant byte first.
    #[default]
    Little,
    /// Most significant byte first.
    Big,
}

/// The clock of the microcontroller.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Time {
    /// The unit of its time.
    pub unit: TimeUnit,
    /// The value at which it rolls over to 0, in its unit. Default 2³² for ms and µs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wraps_at: Option<f64>,
}

/// The scale of pressures: `gain · number + offset`, in the unit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Pressure {
    /// The unit. For counts, `gain` and `offset` convert to kPa.
    pub unit: PressureUnit,
    /// Units per number.
    pub gain: f64,
    /// Pressure at the number 0, in units.
    pub offset: f64,
}

/// The scale of temperatures: `gain · number + offset`, °C.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Temperature {
    /// °C per number.
    pub gain: f64,
    /// Temperature at the number 0, °C.
    pub offset: f64,
}

/// The serial port.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Serial {
    /// Baud rate, bits per second.
    pub baud: u32,
    /// Whether DTR is set when the port is opened. Many boards restart then.
    pub dtr: bool,
    /// Text to send first, such as a start command.
    pub send: String,
    /// Wait before that text is sent, for a board that restarts, s.
    pub wait_s: f64,
}

impl Default for Text {
    fn default() -> Self {
        Self {
            separator: ",".to_owned(),
            prefix: String::new(),
            strip: String::new(),
            comment: "#".to_owned(),
            missing: Vec::new(),
            checksum: None,
            lines: 1,
            longest: 4096,
        }
    }
}

impl Default for Binary {
    fn default() -> Self {
        Self {
            framing: Framing::Sync,
            sync: vec![0xAA, 0x55],
            order: ByteOrder::Little,
            checksum: None,
        }
    }
}

impl Default for Time {
    fn default() -> Self {
        Self {
            unit: TimeUnit::Ms,
            wraps_at: None,
        }
    }
}

impl Default for Pressure {
    fn default() -> Self {
        Self {
            unit: PressureUnit::Kilopascal,
            gain: 1.0,
            offset: 0.0,
        }
    }
}

impl Default for Temperature {
    fn default() -> Self {
        Self {
            gain: 1.0,
            offset: 0.0,
        }
    }
}

impl Default for Serial {
    fn default() -> Self {
        Self {
            baud: 115_200,
            dtr: true,
            send: String::new(),
            wait_s: 0.0,
        }
    }
}

const fn two_to_32() -> f64 {
    4_294_967_296.0
}

impl Description {
    /// Reads a description. `file` names it in errors.
    ///
    /// # Errors
    /// A field is wrong; the error names its line.
    pub fn parse(file: &str, text: &str) -> Result<Self, ConfigError> {
        Self::checked(twintac_config::parse(file, text)?)
    }

    /// Reads a description from a file.
    ///
    /// # Errors
    /// The file cannot be read, or a field is wrong; the error names its line.
    pub fn read(path: impl AsRef<std::path::Path>) -> Result<Self, ConfigError> {
        Self::checked(twintac_config::read(path)?)
    }

    fn checked(document: Document<Self>) -> Result<Self, ConfigError> {
        match document.value.wrong() {
            None => Ok(document.value),
            Some((field, problem, hint)) => Err(document.error(field, problem, hint)),
        }
    }

    /// The fields, for every form.
    pub(crate) fn all_fields(&self) -> impl Iterator<Item = &Field> {
        self.fields.iter().chain(self.keys.values())
    }

    fn count(&self, meaning: Meaning) -> usize {
        let alike = self.all_fields().filter(|field| field.meaning == meaning);
        alike.map(|field| field.repeats).sum()
    }

    /// Number of pressures in a frame; the sensor must have as many taxels.
    #[must_use]
    pub fn n_pressures(&self) -> usize {
        self.count(Meaning::Pressure)
    }

    /// Whether frames contain the time at which they were read.
    pub(crate) fn has_time(&self) -> bool {
        self.count(Meaning::Time) > 0
    }

    /// Whether frames contain numbers. Only these show for certain that no frame is missing.
    pub(crate) fn has_sequence(&self) -> bool {
        self.count(Meaning::Sequence) > 0
    }

    fn wrong(&self) -> Option<(&'static str, String, &'static str)> {
        self.wrong_fields().or_else(|| self.wrong_numbers())
    }

    fn wrong_fields(&self) -> Option<(&'static str, String, &'static str)> {
        let is_json = self.form == Form::Json;
        if is_json && (self.keys.is_empty() || !self.fields.is_empty()) {
            let hint = "give the meaning of each key: `keys.p = \"pressure * 8\"`";
            return Some((
                "keys",
                "are required for JSON, and `fields` are not allowed".to_owned(),
                hint,
            ));
        }
        if !is_json && (self.fields.is_empty() || !self.keys.is_empty()) {
            let hint = "give the meaning of each field: `fields = [\"time\", \"pressure * 8\"]`";
            return Some((
                "fields",
                "are required for this form, and `keys` are not allowed".to_owned(),
                hint,
            ));
        }
        let is_typed = |field: &&Field| field.number.is_some() != (self.form == Form::Binary);
        if let Some(field) = self.all_fields().find(is_typed) {
            let place = if is_json { "keys" } else { "fields" };
            let problem = format!("have `{field}`");
            return Some(match self.form {
                Form::Binary => (
                    place,
                    problem,
                    "give each a type, such as `u32 time` or `i16 pressure * 8`",
                ),
                _ => (place, problem, "give no types: they are for packets"),
            });
        }
        let place = if is_json { "keys" } else { "fields" };
        let n = self.n_pressures();
        if n == 0 {
            return Some((
                place,
                "have no pressure".to_owned(),
                "say where the taxels' pressures are: `pressure * 8`",
            ));
        }
        for meaning in [Meaning::Time, Meaning::Sequence] {
            if self.count(meaning) > 1 {
                return Some((
                    place,
                    "have a time or a sequence twice".to_owned(),
                    "give each once",
                ));
            }
        }
        if !matches!(self.count(Meaning::Temperature), 0 | 1) && self.count(Meaning::Temperature) != n {
            let problem = format!(
                "have {} temperatures beside {n} pressures",
                self.count(Meaning::Temperature)
            );
            return Some((place, problem, "give one temperature, or one of each taxel"));
        }
        if !matches!(self.count(Meaning::Fault), 0) && self.count(Meaning::Fault) != n {
            let problem = format!("have {} faults beside {n} pressures", self.count(Meaning::Fault));
            return Some((place, problem, "give a fault of each taxel, or none"));
        }
        if let Some(order) = &self.taxel_order {
            let mut sorted = order.clone();
            sorted.sort_unstable();
            if !sorted.into_iter().eq(0..n) {
                let problem = format!("is {order:?}");
                return Some((
                    "taxel_order",
                    problem,
                    "give each number from 0 on once, as many as there are pressures",
                ));
            }
        }
        None
    }

    fn wrong_numbers(&self) -> Option<(&'static str, String, &'static str)> {
        let positive = |number: f64| number > 0.0 && number.is_finite();
        if self.time.wraps_at.is_some_and(|at| !positive(at)) {
            return Some((
                "time.wraps_at",
                "is not above 0".to_owned(),
                "give a number above 0",
            ));
        }
        if !positive(self.sequence_wraps_at) {
            return Some((
                "sequence_wraps_at",
                "is not above 0".to_owned(),
                "give a number above 0",
            ));
        }
        if self.rate_hz.is_some_and(|rate_hz| !positive(rate_hz)) {
            return Some(("rate_hz", "is not above 0".to_owned(), "give frames a second"));
        }
        for (name, number) in [
            ("pressure.gain", self.pressure.gain),
            ("pressure.offset", self.pressure.offset),
            ("temperature.gain", self.temperature.gain),
            ("temperature.offset", self.temperature.offset),
        ] {
            if !number.is_finite() || (number == 0.0 && name.ends_with("gain")) {
                return Some((
                    name,
                    format!("is {number}"),
                    "give a finite number; a gain is not 0",
                ));
            }
        }
        if self.pressure.unit == PressureUnit::Counts
            && self.pressure.gain == 1.0
            && self.pressure.offset == 0.0
        {
            let problem = "is given without a gain".to_owned();
            return Some((
                "pressure.unit",
                problem,
                "give `pressure.gain` and `pressure.offset`, which convert counts to kPa",
            ));
        }
        if self.text.separator.chars().count() != 1 && self.text.separator != "blank" {
            let problem = format!("is `{}`", self.text.separator);
            return Some((
                "text.separator",
                problem,
                "give one character, or `blank` for blanks and tabs",
            ));
        }
        if !(16..=1 << 20).contains(&self.text.longest) {
            return Some((
                "text.longest",
                format!("is {}", self.text.longest),
                "give 16 to 1048576 bytes",
            ));
        }
        if !(1..=1024).contains(&self.text.lines) {
            return Some(("text.lines", format!("is {}", self.text.lines), "give 1 to 1024"));
        }
        let is_sync = self.form == Form::Binary && self.binary.framing == Framing::Sync;
        if is_sync && !(1..=16).contains(&self.binary.sync.len()) {
            let problem = format!("has {} bytes", self.binary.sync.len());
            return Some((
                "binary.sync",
                problem,
                "give 1 to 16 bytes, or `framing = \"cobs\"`",
            ));
        }
        if !(300..=12_000_000).contains(&self.serial.baud) {
            return Some((
                "serial.baud",
                format!("is {}", self.serial.baud),
                "give 300 to 12000000",
            ));
        }
        if !(0.0..=60.0).contains(&self.serial.wait_s) {
            return Some((
                "serial.wait_s",
                format!("is {}", self.serial.wait_s),
                "give 0 to 60 s",
            ));
        }
        None
    }
}
