//! Joins recordings of the same sensor.

use std::collections::BTreeSet;

use crate::{Press, Recording, RecordingError};

/// Two presses with fewer frames can have the same numbers by chance.
const FEWEST_FRAMES: usize = 10;

impl Recording {
    /// Appends the presses of another recording. A press whose name exists gets a number, as in
    /// `name (2)`.
    ///
    /// # Errors
    ///
    /// [`RecordingError::Mixed`]: sensor, taxels or provenance differ.
    /// [`RecordingError::Repeated`]: a press is a copy of one that is there. Nothing is appended
    /// then.
    pub fn append(&mut self, next: Self) -> Result<(), RecordingError> {
        self.expect_alike(&next)?;
        self.expect_no_copy(&next)?;
        let names = self.presses.iter().map(|press| press.name.clone());
        let mut taken: BTreeSet<String> = names.collect();
        for mut press in next.presses {
            if taken.contains(&press.name) {
                let mut numbered = (2..).map(|number| format!("{} ({number})", press.name));
                if let Some(free) = numbered.find(|name| !taken.contains(name)) {
                    press.name = free;
                }
            }
            taken.insert(press.name.clone());
            self.presses.push(press);
        }
        Ok(())
    }

    /// Checks that presses of both can be in one recording.
    pub(crate) fn expect_alike(&self, next: &Self) -> Result<(), RecordingError> {
        let facts = |recording: &Self| {
            [
                ("sensor", format!("`{}`", recording.sensor)),
                ("taxels", recording.taxels.join(", ")),
                ("provenance", recording.provenance.to_string()),
            ]
        };
        for ((what, expected), (_, found)) in facts(self).into_iter().zip(facts(next)) {
            if found != expected {
                return Err(RecordingError::Mixed {
                    what,
                    expected,
                    found,
                });
            }
        }
        Ok(())
    }

    /// Checks that no press of `next` is a copy of one of these: a twin would be trained on it and
    /// evaluated on it.
    pub(crate) fn expect_no_copy(&self, next: &Self) -> Result<(), RecordingError> {
        for press in &next.presses {
            if let Some(same) = self.presses.iter().find(|other| press.is_copy_of(other)) {
                return Err(RecordingError::Repeated {
                    press: press.name.clone(),
                    of: same.name.clone(),
                });
            }
        }
        Ok(())
    }
}

impl Press {
    /// Whether both have the same times, poses and readings, to the last bit.
    fn is_copy_of(&self, other: &Self) -> bool {
        fn bits(press: &Press) -> impl Iterator<Item = u64> {
            press.taxels_raw.iter().flatten().map(|reading| reading.to_bits())
        }
        self.time_s.len() >= FEWEST_FRAMES
            && self.time_s == other.time_s
            && self.gel_from_indenter == other.gel_from_indenter
            && bits(self).eq(bits(other))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Control, Press, Provenance};

    fn recording(names: &[&str]) -> Recording {
        let press = |name: &&str| Press {
            name: (*name).to_owned(),
            mounting: "press.mcap".to_owned(),
            indenter: "ball".to_owned(),
            control: Control::Pose,
            time_s: Vec::new(),
            gel_from_indenter: Vec::new(),
            force_n: None,
            taxels_kpa: Vec::new(),
            taxels_raw: Vec::new(),
            temperature_c: None,
            valid: Vec::new(),
        };
        Recording {
            sensor: "strip".to_owned(),
            provenance: Provenance::Emulated,
            taxels: vec!["a".to_owned(), "b".to_owned()],
            presses: names.iter().map(press).collect(),
        }
    }

    #[test]
    fn names_that_are_taken_get_a_number() {
        let mut all = recording(&["p#1", "p#2"]);
        all.append(recording(&["p#1", "q#1"])).unwrap();
        all.append(recording(&["p#1"])).unwrap();
        let names: Vec<&str> = all.presses.iter().map(|press| press.name.as_str()).collect();
        assert_eq!(names, ["p#1", "p#2", "p#1 (2)", "q#1", "p#1 (3)"]);
    }

    #[test]
    fn a_copy_of_a_press_is_refused_under_any_name() {
        let with_frames = |name: &str, n_frames: usize| {
            let mut recording = recording(&[name]);
            let press = &mut recording.presses[0];
            press.time_s = (0..n_frames).map(|frame| frame as f64).collect();
            press.taxels_raw = vec![vec![f64::NAN, 0.5]; n_frames];
            recording
        };
        let mut all = with_frames("p", 20);
        let error = all.append(with_frames("q", 20)).unwrap_err().to_string();
        assert!(
            error.starts_with("press `q` has the same times, poses and readings as `p`"),
            "{error}"
        );
        let mut other = with_frames("q", 20);
        other.presses[0].taxels_raw[7][1] = 0.51;
        all.append(other).unwrap();
        all.append(with_frames("r", 1)).unwrap();
        all.append(with_frames("s", 1)).unwrap();
        assert_eq!(all.presses.len(), 4);
    }

    #[test]
    fn what_differs_is_said_and_nothing_is_added() {
        let differs = |change: fn(&mut Recording), words: &str| {
            let (mut all, mut next) = (recording(&["p"]), recording(&["q"]));
            change(&mut next);
            let text = all.append(next).unwrap_err().to_string();
            assert!(text.contains(words), "{text}");
            assert_eq!(all.presses.len(), 1);
        };
        differs(
            |next| next.sensor = "tip".to_owned(),
            "sensor `tip`, the previous ones have `strip`",
        );
        differs(
            |next| next.taxels.truncate(1),
            "taxels a, the previous ones have a, b",
        );
        differs(
            |next| next.provenance = Provenance::Real,
            "provenance real, the previous ones have emulated",
        );
    }
}
