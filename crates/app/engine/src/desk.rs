//! The connected sensor beside its twin: its readings, relative to its untouched state.

use serde::Serialize;
use twintac_line::{Decoder, Description, Heard};
use twintac_sensor::Sensor;

use crate::arrays::{Array, Arrays};
use crate::error::EngineError;
use crate::map::Map;

/// Number of frames whose mean is the zero.
const ZERO_FRAMES: u32 = 32;

/// A connected sensor. Its incoming pressures are absolute, kPa.
pub(crate) struct Desk {
    source: String,
    provenance: String,
    /// Decodes the bytes that a page reads from a serial port itself.
    decoder: Option<Decoder>,
    map: Option<Map>,
    zero: Zero,
    last_kpa: Vec<Option<f64>>,
    n_frames: u64,
    remarks: Vec<String>,
}

/// The zero of each taxel: the mean of the first frames, in which nothing touches.
#[derive(Default)]
struct Zero {
    n_frames: u32,
    /// Sum, kPa, and number of pressures, of each taxel.
    sums: Vec<(f64, u32)>,
}

/// The state of the connected sensor.
#[derive(Debug, Serialize)]
pub(crate) struct DeskFrame {
    source: String,
    provenance: String,
    /// Number of frames so far.
    n_frames: u64,
    /// Whether the zero is still being measured. Nothing may touch the sensor meanwhile.
    is_zeroing: bool,
    /// Pressures of the last frame above the zero, kPa; null for a taxel without a reading. Empty
    /// while the zero is measured.
    pressure_kpa: Vec<Option<f64>>,
    /// Remarks about the frames so far, one sentence each.
    remarks: Vec<String>,
}

impl Desk {
    /// A sensor whose frames the surrounding program hands over.
    pub(crate) fn new(source: &str, provenance: &str) -> Self {
        Self {
            source: source.to_owned(),
            provenance: provenance.to_owned(),
            decoder: None,
            map: None,
            zero: Zero::default(),
            last_kpa: Vec::new(),
            n_frames: 0,
            remarks: Vec::new(),
        }
    }

    /// A sensor whose line is decoded byte by byte, according to a description.
    pub(crate) fn on_line(description: &Description, sensor: &Sensor) -> Result<Self, EngineError> {
        let (n_taxels, n_pressures) = (sensor.taxels.len(), description.n_pressures());
        if n_taxels != n_pressures {
            return Err(EngineError::Taxels {
                n_taxels,
                n_pressures,
            });
        }
        let mut desk = Self::new("serial port", "real");
        desk.decoder = Some(Decoder::new(description, n_taxels));
        desk.set_sensor(sensor);
        Ok(desk)
    }

    /// Declares that the connected sensor is of this description.
    pub(crate) fn set_sensor(&mut self, sensor: &Sensor) {
        self.map = Map::of(sensor, Array::DeskMapKpa);
    }

    /// Starts measuring the zero again, from the next frames.
    pub(crate) fn take_zero(&mut self) {
        self.zero = Zero::default();
    }

    /// Whether its frames come byte by byte over a line.
    pub(crate) fn has_line(&self) -> bool {
        self.decoder.is_some()
    }

    pub(crate) fn set_remarks(&mut self, remarks: Vec<String>) {
        self.remarks = remarks;
    }

    pub(crate) fn take_bytes(&mut self, bytes: &[u8]) {
        let Some(mut decoder) = self.decoder.take() else {
            return;
        };
        decoder.push(bytes, &mut |heard| {
            if let Heard::Frame(frame) = heard {
                self.take_frame(frame.pressures_kpa);
            }
        });
        self.remarks = decoder.tally().remarks();
        self.decoder = Some(decoder);
    }

    pub(crate) fn take_frame(&mut self, pressures_kpa: Vec<Option<f64>>) {
        self.n_frames += 1;
        self.zero.take(&pressures_kpa);
        self.last_kpa = pressures_kpa;
    }

    /// Updates the map of the last frame, and returns the state.
    pub(crate) fn show(&mut self, sensor: &Sensor, arrays: &mut Arrays) -> Result<DeskFrame, EngineError> {
        let (n_taxels, n_pressures) = (sensor.taxels.len(), self.last_kpa.len());
        if self.n_frames > 0 && n_taxels != n_pressures {
            return Err(EngineError::Taxels {
                n_taxels,
                n_pressures,
            });
        }
        let is_zeroing = self.zero.n_frames < ZERO_FRAMES;
        let pressure_kpa = if is_zeroing {
            Vec::new()
        } else {
            self.zero.above_kpa(&self.last_kpa)
        };
        // Without the reading of every taxel there is no map: its values there would be invented.
        let all_kpa: Option<Vec<f64>> = pressure_kpa.iter().copied().collect();
        match (&mut self.map, all_kpa.filter(|kpa| !kpa.is_empty())) {
            (Some(map), Some(kpa)) => map.show(&kpa, arrays),
            _ => arrays.set_numbers(Array::DeskMapKpa, &[]),
        }
        Ok(DeskFrame {
            source: self.source.clone(),
            provenance: self.provenance.clone(),
            n_frames: self.n_frames,
            is_zeroing,
            pressure_kpa,
            remarks: self.remarks.clone(),
        })
    }
}

impl Zero {
    fn take(&mut self, pressures_kpa: &[Option<f64>]) {
        if self.n_frames >= ZERO_FRAMES {
            return;
        }
        self.n_frames += 1;
        self.sums.resize(pressures_kpa.len(), (0.0, 0));
        for ((sum_kpa, n), kpa) in self.sums.iter_mut().zip(pressures_kpa) {
            if let Some(kpa) = kpa {
                *sum_kpa += kpa;
                *n += 1;
            }
        }
    }

    /// Pressures above the zero; `None` for a taxel that has no reading now, or had none then.
    fn above_kpa(&self, pressures_kpa: &[Option<f64>]) -> Vec<Option<f64>> {
        let above = |(kpa, (sum_kpa, n)): (&Option<f64>, &(f64, u32))| {
            let zero_kpa = (*n > 0).then(|| sum_kpa / f64::from(*n))?;
            Some((*kpa)? - zero_kpa)
        };
        pressures_kpa.iter().zip(&self.sums).map(above).collect()
    }
}
