//! The measurements.

use std::error::Error;
use std::hint::black_box;
use std::time::Instant;

use digitac::Twin;
use serde::{Deserialize, Serialize};

use crate::counting;
use crate::scene::{Kind, Scene};

/// Steps that are timed, and warm-up steps before them.
pub(crate) const N_STEPS: usize = 300;
pub(crate) const N_WARM_UP: usize = 20;

/// Timed calls of a single sensor.
const N_CALLS: usize = 5000;

/// Bytes that are copied at once: more than the caches hold.
const N_COPIED: usize = 256 << 20;

/// Copies; their median is used.
const N_COPIES: usize = 11;

/// The median of many measurements, and the limits of the middle 80 % of them.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(crate) struct Spread {
    pub(crate) median: f64,
    pub(crate) lowest_tenth: f64,
    pub(crate) highest_tenth: f64,
}

impl Spread {
    pub(crate) fn of(mut values: Vec<f64>) -> Self {
        values.sort_by(f64::total_cmp);
        let at = |part: f64| values[(part * (values.len() - 1) as f64).round() as usize];
        Self {
            median: at(0.5),
            lowest_tenth: at(0.1),
            highest_tenth: at(0.9),
        }
    }
}

/// Rate at which a scene is stepped.
#[derive(Serialize, Deserialize)]
pub(crate) struct Rate {
    /// The body that presses.
    pub(crate) body: String,
    /// Whether the sensors have a twin's relaxation and the whole sensor variation.
    pub(crate) is_imperfect: bool,
    /// A reading is that of all taxels of a sensor, with force and torque.
    pub(crate) readings_per_s: Spread,
    /// Fraction of the sensors that were touched in the last step.
    pub(crate) touched: f64,
}

/// Steps all scenes in turn, so that other work of the machine affects all of them alike.
pub(crate) fn rates(twin: &Twin, [n_sensors, n_threads]: [usize; 2]) -> Result<Vec<Rate>, Box<dyn Error>> {
    let kinds = [Some(twin), None]
        .into_iter()
        .flat_map(|twin| Kind::ALL.map(|kind| (kind, twin)));
    let mut scenes = kinds
        .map(|(kind, twin)| {
            let scene = Scene::new(kind, twin, [n_sensors, n_threads])?;
            Ok((kind, twin.is_some(), scene, Vec::new()))
        })
        .collect::<Result<Vec<_>, Box<dyn Error>>>()?;
    for step in 0..N_WARM_UP + N_STEPS {
        for (_, _, scene, rates) in &mut scenes {
            scene.move_on();
            let started = Instant::now();
            scene.step();
            if step >= N_WARM_UP {
                rates.push(n_sensors as f64 / started.elapsed().as_secs_f64());
            }
        }
    }
    let rate = |(kind, is_imperfect, scene, rates): (Kind, bool, Scene, Vec<f64>)| Rate {
        body: kind.name().to_owned(),
        is_imperfect,
        readings_per_s: Spread::of(rates),
        touched: scene.touched(),
    };
    Ok(scenes.into_iter().map(rate).collect())
}

/// Time of a step of one sensor on the calling thread, µs.
#[derive(Serialize, Deserialize)]
pub(crate) struct Latency {
    pub(crate) body: String,
    pub(crate) call_us: Spread,
}

pub(crate) fn latencies(twin: &Twin) -> Result<Vec<Latency>, Box<dyn Error>> {
    let latency = |kind: Kind| {
        let mut scene = Scene::new(kind, Some(twin), [1, 1])?;
        let calls = (0..N_CALLS).map(|_| {
            scene.move_on();
            let started = Instant::now();
            scene.step();
            1e6 * started.elapsed().as_secs_f64()
        });
        Ok(Latency {
            body: kind.name().to_owned(),
            call_us: Spread::of(calls.collect()),
        })
    };
    Kind::ALL.into_iter().map(latency).collect()
}

/// Bytes that sensors with relaxation and all deviations take, divided by their number. Shared data
/// and the body are included.
pub(crate) fn bytes_per_sensor(
    twin: &Twin,
    [n_sensors, n_threads]: [usize; 2],
) -> Result<f64, Box<dyn Error>> {
    let before = counting::n_bytes();
    let scene = Scene::new(Kind::Ball, Some(twin), [n_sensors, n_threads])?;
    let n_bytes = counting::n_bytes() - before;
    drop(black_box(scene));
    Ok(n_bytes as f64 / n_sensors as f64)
}

/// Bytes that one thread copies in a second.
pub(crate) fn copied_per_s() -> f64 {
    let from = vec![1_u8; N_COPIED];
    let mut to = vec![0_u8; N_COPIED];
    let rates = (0..N_COPIES).map(|_| {
        let started = Instant::now();
        to.copy_from_slice(black_box(&from));
        black_box(&mut to);
        N_COPIED as f64 / started.elapsed().as_secs_f64()
    });
    Spread::of(rates.collect()).median
}
