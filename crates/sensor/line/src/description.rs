//! How a microcontroller sends its readings: one TOML file.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use twintac_config::{ConfigError, Document};

use crate::checksum::Checksum;
use crate::field::{Field, Meaning};
use crate::unit::{PressureUnit, TimeUnit};

/// How frames stand on a line.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Description {
    /// Text, JSON or packets.
    pub form: Form,
    /// What stands where, from left to right; not for JSON.
    #[serde(default)]
    pub fields: Vec<Field>,
    /// Of JSON: under which key what stands. A key whose value is a list has its numbers in order; a pressure may have a key for each taxel.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub keys: BTreeMap<String, Field>,
    /// What text looks like.
    #[serde(default)]
    pub text: Text,
    /// What packets look like.
    #[serde(default)]
    pub binary: Binary,
    /// The clock of the microcontroller.
    #[serde(default)]
    pub time: Time,
    /// Where the frame's number begins anew: left out, at 2³².
    #[serde(default = "two_to_32")]
    pub sequence_wraps_at: f64,
    /// What pressures stand for.
    #[serde(default)]
    pub pressure: Pressure,
    /// What temperatures stand for.
    #[serde(default)]
    pub temperature: Temperature,
    /// Which taxel each pressure is, from 0, in the order of the fields: left out, the order of the sensor's taxels.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub taxel_order: Option<Vec<usize>>,
    /// Frames a second; a time that is further from the one before says that frames are missing. Left out: only numbers of frames say so.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate_hz: Option<f64>,
    /// The port that it comes through.
    #[serde(default)]
    pub serial: Serial,
}

/// What frames are made of.
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

/// What text looks like.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Text {
    /// What stands between numbers: a character, or `blank` for any number of blanks and tabs.
    pub separator: String,
    /// What a line of readings begins with; others are passed over.
    pub prefix: String,
    /// Characters that count as nothing, such as brackets.
    pub strip: String,
    /// What a comment begins with.
    pub comment: String,
    /// What stands for a reading that is missing, besides nothing and `nan`.
    pub missing: Vec<String>,
    /// The checksum of a line, in hexadecimal digits behind a `*` at its end, of all that stands before that.
    pub checksum: Option<Checksum>,
    /// Lines of a frame, ended by an empty line: left out, one.
    pub lines: usize,
    /// The most bytes that a line may have.
    pub longest: usize,
}

/// What packets look like.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Binary {
    /// What tells where a packet begins and ends.
    pub framing: Framing,
    /// Bytes that a packet begins with, not among its fields; for `framing = "sync"`.
    pub sync: Vec<u8>,
    /// Which byte of a number comes first.
    pub order: ByteOrder,
    /// A checksum behind the fields, of the fields alone, in the order of bytes of its numbers.
    pub checksum: Option<Checksum>,
}

/// What tells where a packet begins.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Framing {
    /// Bytes that may occur inside as well. Without a checksum a packet counts once the next one begins right behind it: a frame later.
    #[default]
    Sync,
    /// Consistent overhead byte stuffing: zeros between packets and nowhere else.
    Cobs,
}

/// Which byte of a number comes first.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ByteOrder {
    /// The least significant.
    #[default]
    Little,
    /// The most significant.
    Big,
}

/// The clock of the microcontroller.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Time {
    /// Its unit.
    pub unit: TimeUnit,
    /// Where it begins anew, in its unit: left out, at 2³² of ms and µs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wraps_at: Option<f64>,
}

/// What pressures stand for: `gain · number + offset`, in the unit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Pressure {
    /// The unit; of counts, what `gain` and `offset` make of them is kPa.
    pub unit: PressureUnit,
    /// Units of a number.
    pub gain: f64,
    /// Units at zero.
    pub offset: f64,
}

/// What temperatures stand for: `gain · number + offset`, °C.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Temperature {
    /// °C of a number.
    pub gain: f64,
    /// °C at zero.
    pub offset: f64,
}

/// The port that a line comes through.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Serial {
    /// Bits a second.
    pub baud: u32,
    /// Whether to set DTR when opening it: many boards start anew then.
    pub dtr: bool,
    /// What to send first, such as a command to start.
    pub send: String,
    /// How long to wait before that, for a board that starts anew, s.
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
    /// Reads a description; `file` names it in errors.
    ///
    /// # Errors
    /// What is wrong with which field, in which line.
    pub fn parse(file: &str, text: &str) -> Result<Self, ConfigError> {
        Self::checked(twintac_config::parse(file, text)?)
    }

    /// Reads a description from a file.
    ///
    /// # Errors
    /// A file that cannot be read; what is wrong with which field, in which line.
    pub fn read(path: impl AsRef<std::path::Path>) -> Result<Self, ConfigError> {
        Self::checked(twintac_config::read(path)?)
    }

    fn checked(document: Document<Self>) -> Result<Self, ConfigError> {
        match document.value.wrong() {
            None => Ok(document.value),
            Some((field, problem, hint)) => Err(document.error(field, problem, hint)),
        }
    }

    /// The fields, in whichever form.
    pub(crate) fn all_fields(&self) -> impl Iterator<Item = &Field> {
        self.fields.iter().chain(self.keys.values())
    }

    fn count(&self, meaning: Meaning) -> usize {
        let alike = self.all_fields().filter(|field| field.meaning == meaning);
        alike.map(|field| field.repeats).sum()
    }

    /// Pressures of a frame: as many as the sensor must have taxels.
    #[must_use]
    pub fn n_pressures(&self) -> usize {
        self.count(Meaning::Pressure)
    }

    /// Whether frames say when they were read.
    pub(crate) fn has_time(&self) -> bool {
        self.count(Meaning::Time) > 0
    }

    /// Whether frames have numbers, which alone say for sure that none is missing.
    pub(crate) fn has_sequence(&self) -> bool {
        self.count(Meaning::Sequence) > 0
    }

    fn wrong(&self) -> Option<(&'static str, String, &'static str)> {
        self.wrong_fields().or_else(|| self.wrong_numbers())
    }

    fn wrong_fields(&self) -> Option<(&'static str, String, &'static str)> {
        let is_json = self.form == Form::Json;
        if is_json && (self.keys.is_empty() || !self.fields.is_empty()) {
            let hint =
                "say under `keys` which key has what: `keys.p = \"pressure * 8\"`, and give no `fields`";
            return Some(("keys", "are what JSON is read by".to_owned(), hint));
        }
        if !is_json && (self.fields.is_empty() || !self.keys.is_empty()) {
            let hint = "say what stands where: `fields = [\"time\", \"pressure * 8\"]`, and give no `keys`";
            return Some(("fields", "are what this form is read by".to_owned(), hint));
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
                "say where the taxels' pressures stand: `pressure * 8`",
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
            let problem = "stands without a gain".to_owned();
            return Some((
                "pressure.unit",
                problem,
                "say with `pressure.gain` and `pressure.offset` what kPa counts are",
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
