//! The numbers of a frame and their meaning.

use crate::description::{Description, Pressure};
use crate::field::Meaning;

/// A frame from a line.
#[derive(Clone, Debug, PartialEq)]
pub struct LineFrame {
    /// Its number with roll-overs undone, if the line numbers its frames.
    pub sequence: Option<u64>,
    /// Time of reading on the microcontroller's clock, s, with roll-overs undone, if the line
    /// contains it.
    pub time_s: Option<f64>,
    /// Pressures of the taxels, kPa; `None` if missing. `[n_taxels]`
    pub pressures_kpa: Vec<Option<f64>>,
    /// Temperatures of the taxels, °C; `None` if missing. `[n_taxels]`
    pub temperatures_c: Vec<Option<f64>>,
    /// Fault codes of the board for each taxel: 0 if it has a reading, `None` if the line does not
    /// contain codes. `[n_taxels]`
    pub faults: Vec<Option<u8>>,
    /// Number of missing frames between the one before and this one.
    pub lost_before: u64,
}

/// The numbers of a frame, as sent.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Row {
    pub(crate) time: Option<f64>,
    pub(crate) sequence: Option<f64>,
    pub(crate) pressures: Vec<Option<f64>>,
    pub(crate) temperatures: Vec<Option<f64>>,
    pub(crate) faults: Vec<Option<f64>>,
}

impl Row {
    pub(crate) fn push(&mut self, meaning: Meaning, number: Option<f64>) {
        match meaning {
            Meaning::Pressure => self.pressures.push(number),
            Meaning::Temperature => self.temperatures.push(number),
            Meaning::Time => self.time = number,
            Meaning::Sequence => self.sequence = number,
            Meaning::Fault => self.faults.push(number),
            Meaning::Ignored => {}
        }
    }

    pub(crate) fn clear(&mut self) {
        self.time = None;
        self.sequence = None;
        self.pressures.clear();
        self.temperatures.clear();
        self.faults.clear();
    }

    /// Pressures of the taxels, kPa, in the sensor's order. A taxel with a fault has none, whatever
    /// number was sent.
    pub(crate) fn pressures_kpa(&self, description: &Description) -> Vec<Option<f64>> {
        let Pressure { unit, gain, offset } = description.pressure;
        let kpa = |number: f64| unit.kilopascals() * (gain * number + offset);
        let pressures = in_order(description, &self.pressures, kpa);
        let faults = self.faults(description);
        let sound =
            |(pressure, fault): (Option<f64>, Option<u8>)| pressure.filter(|_| fault.unwrap_or(0) == 0);
        pressures.into_iter().zip(faults).map(sound).collect()
    }

    /// Fault codes of the taxels, in the sensor's order.
    pub(crate) fn faults(&self, description: &Description) -> Vec<Option<u8>> {
        if self.faults.is_empty() {
            return vec![None; self.pressures.len()];
        }
        // A number that is no valid code also counts as a fault.
        let number = |number: f64| {
            if number == 0.0 {
                0
            } else {
                number.clamp(1.0, 255.0) as u8
            }
        };
        in_order(description, &self.faults, number)
    }

    /// Temperatures of the taxels, °C, in the sensor's order.
    pub(crate) fn temperatures_c(&self, description: &Description) -> Vec<Option<f64>> {
        let n = self.pressures.len();
        let celsius = |number: f64| description.temperature.gain * number + description.temperature.offset;
        match self.temperatures.as_slice() {
            [] => vec![None; n],
            [one] if n != 1 => vec![one.map(celsius); n],
            all => in_order(description, all, celsius),
        }
    }
}

fn in_order<T: Clone>(
    description: &Description,
    numbers: &[Option<f64>],
    convert: impl Fn(f64) -> T,
) -> Vec<Option<T>> {
    let convert = |number: &Option<f64>| number.map(&convert);
    let Some(order) = &description.taxel_order else {
        return numbers.iter().map(convert).collect();
    };
    let mut ordered = vec![None; numbers.len()];
    for (taxel, number) in order.iter().zip(numbers) {
        ordered[*taxel] = convert(number);
    }
    ordered
}
