//! Synthetic presses with known answers, for tests.

use glam::DVec3;
use twintac_recording::{Control, Frames, Press, Provenance, Recording};
use twintac_shape::Pose;

use crate::phases::Phases;
use crate::recorded::Recorded;
use crate::rest::Rest;

/// A trapezoid of force on one taxel, starting after a rest. A second taxel reads a fraction of it.
pub(crate) struct Shape {
    pub(crate) peak_n: f64,
    pub(crate) loading_s: f64,
    pub(crate) hold_s: f64,
    pub(crate) rate_hz: f64,
    pub(crate) control: Control,
    /// Standard deviation of both taxels' readings, kPa.
    pub(crate) noise_kpa: f64,
    pub(crate) rest_s: f64,
    /// The taxel's reading, kPa, from the force, N, the phase (0 loading, 1 hold, 2 unloading), and
    /// the time since the phase began, s.
    pub(crate) reads: fn(f64, u32, f64) -> f64,
}

impl Default for Shape {
    fn default() -> Self {
        Self {
            peak_n: 2.0,
            loading_s: 2.0,
            hold_s: 0.0,
            rate_hz: 50.0,
            control: Control::Pose,
            noise_kpa: 0.0,
            rest_s: 1.0,
            reads: |force_n, _, _| 7.0 * force_n,
        }
    }
}

/// Deterministic numbers of mean 0 and standard deviation 1 that look like noise: fractional parts
/// of multiples of the golden ratio.
pub(crate) fn noise(seed: f64, index: usize) -> f64 {
    (((index as f64 + seed) * 0.618_033_988_749_895).fract() - 0.5) * 12.0_f64.sqrt()
}

pub(crate) fn press(shape: &Shape) -> Press {
    let total_s = 2.0 * shape.rest_s + 2.0 * shape.loading_s + shape.hold_s;
    let n = (total_s * shape.rate_hz).round() as usize + 1;
    let mut made = Press {
        name: "ball#0".into(),
        mounting: "synthetic".into(),
        indenter: "ball".into(),
        control: shape.control,
        time_s: Vec::new(),
        gel_from_indenter: Vec::new(),
        force_n: Some(Vec::new()),
        taxels_kpa: Vec::new(),
        temperature_c: None,
        taxels_raw: Vec::new(),
        valid: vec![vec![true; 2]; n],
    };
    for frame in 0..n {
        let time_s = frame as f64 / shape.rate_hz;
        let since_s = time_s - shape.rest_s;
        let (phase, into_s) = if since_s < shape.loading_s {
            (0, since_s)
        } else if since_s <= shape.loading_s + shape.hold_s {
            (1, since_s - shape.loading_s)
        } else {
            (2, since_s - shape.loading_s - shape.hold_s)
        };
        let part = match phase {
            0 => since_s / shape.loading_s,
            1 => 1.0,
            _ => 1.0 - into_s / shape.loading_s,
        };
        let force_n = shape.peak_n * part.clamp(0.0, 1.0);
        let reading_kpa = (shape.reads)(force_n, phase, into_s);
        let readings = vec![
            reading_kpa + shape.noise_kpa * noise(0.0, frame),
            0.25 * reading_kpa + shape.noise_kpa * noise(0.3, frame),
        ];
        made.time_s.push(time_s);
        made.gel_from_indenter.push(Pose {
            position_mm: DVec3::new(0.0, 0.0, 8.0 - part.max(-0.5)),
            ..Pose::IDENTITY
        });
        if let Some(forces_n) = &mut made.force_n {
            forces_n.push(force_n);
        }
        made.taxels_raw
            .push(readings.iter().map(|kpa| kpa + 101.0).collect());
        made.taxels_kpa.push(readings);
    }
    made
}

/// A press above the first of two taxels, cut into phases.
pub(crate) fn recorded(press: &Press) -> Recorded<'_> {
    Recorded {
        press,
        phases: Phases::of(press).unwrap(),
        taxel: Some(0),
    }
}

/// [`recorded`] for many presses.
pub(crate) fn all(presses: &[Press]) -> Vec<Recorded<'_>> {
    presses.iter().map(recorded).collect()
}

/// The unloaded frames of presses, from their force.
pub(crate) fn rests(presses: &[Press]) -> Vec<Rest<'_>> {
    let rest = |press| {
        let phases = Phases::of(press).unwrap();
        Rest {
            press,
            before: phases.rest,
            after: phases.rest_after,
        }
    };
    presses.iter().map(rest).collect()
}

/// Presses of a sensor with two taxels.
pub(crate) fn recording(presses: Vec<Press>) -> Recording {
    Recording {
        sensor: "synthetic".into(),
        provenance: Provenance::Simulated,
        taxels: vec!["a".into(), "b".into()],
        presses,
    }
}

/// A log of two taxels that nothing touches, at 50 Hz. `reads_kpa` gives both readings, kPa, and
/// `is_c` the temperature of both, °C, at a time, s.
pub(crate) fn untouched(
    seconds: f64,
    reads_kpa: impl Fn(f64) -> [f64; 2],
    is_c: impl Fn(f64) -> f64,
) -> Frames {
    let mut frames = Frames::new("pair", Provenance::Real, &["a".to_owned(), "b".to_owned()]);
    for frame in 0..(50.0 * seconds) as u32 {
        let at_s = f64::from(frame) / 50.0;
        frames.time_s.push(at_s);
        frames.gap_before.push(false);
        frames.readings_kpa.push(reads_kpa(at_s).to_vec());
        frames.temperature_c.push(vec![is_c(at_s); 2]);
    }
    frames
}
