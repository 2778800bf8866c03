//! Compares steps with whole presses, bit for bit.

use glam::DVec3;
use proptest::prelude::*;
use twintac_depth_table::DepthTableSource;
use twintac_shape::Pose;

use crate::network::{Normalization, Parameters, Physics};
use crate::synthetic::{Formula, Truth};
use crate::{
    BenchEstimate, Features, Gains, PlaceSettings, Places, PortEstimate, Twin, TwinAtPlace, Variant, features,
};

const N_TAXELS: usize = 3;

/// A twin with random weights.
fn twin(variant: Variant, seed: u64, n_taxels: usize) -> Twin {
    let each = |values: [f64; 3]| values.into_iter().cycle().take(n_taxels).collect();
    let physics = Physics {
        variant,
        gains: Gains {
            gain: each([0.5, 0.8, 1.1]),
            stiffening_per_kpa: each([0.004, -0.003, 0.0]),
            memory: (0..n_taxels).map(|k| vec![0.1 + 0.05 * k as f64, 0.2]).collect(),
            time_constants_s: vec![0.25, 4.0],
        },
        normalization: Normalization {
            reading_kpa: 80.0,
            pressure_rms_kpa: each([12.0, 7.0, 3.0]),
            stress_mean_kpa_per_mm: each([1.0, 0.5, 0.2]),
            stress_deviation_kpa_per_mm: each([2.0, 1.5, 0.7]),
        },
        correction_limit: 0.3,
    };
    let mut parameters = Parameters::new(&physics, &[9, 6], seed);
    for (number, values) in parameters.arrays_mut().enumerate() {
        for (at, value) in values.iter_mut().enumerate() {
            *value += 0.3 * (1.7 * (at + 13 * number) as f32 + seed as f32).sin();
        }
    }
    Twin::new(vec![String::new(); n_taxels], physics, parameters)
}

/// Frames at rest at first, then with random pressures.
fn press() -> impl Strategy<Value = Features> {
    let frame = (0.0..0.3_f64, prop::array::uniform3(-5.0..60.0_f64));
    let frames = prop::collection::vec(frame, 1..40);
    let since_s = prop::option::of(0.0..8.0_f64);
    (0..4_usize, frames, since_s).prop_map(|(n_rest, frames, since_previous_s)| {
        let rest = (0..n_rest).map(|_| (0.1, [0.0; N_TAXELS]));
        let frames: Vec<_> = rest.chain(frames).collect();
        let mut time_s = 0.0;
        let seen: Vec<Vec<f64>> = frames.iter().map(|(_, row)| row.to_vec()).collect();
        Features {
            time_s: frames
                .iter()
                .map(|(step_s, _)| {
                    time_s += step_s;
                    time_s
                })
                .collect(),
            depth_mm: vec![0.0; frames.len()],
            force_n: vec![0.0; frames.len()],
            pressure_kpa: seen.clone(),
            stress_kpa_per_mm: seen,
            simulated: vec![true; frames.len()],
            since_previous_s,
            zero_frames: 0..n_rest,
        }
    })
}

/// The readings computed by matrices of whole presses.
fn by_matrices(twin: &Twin, presses: &[&Features]) -> Vec<Vec<Vec<f64>>> {
    let (physics, parameters) = (twin.physics(), twin.parameters());
    let elastic = |press: &&Features| {
        let inputs = physics.inputs(press);
        let elastic = parameters.elastic(physics, &inputs, &inputs).readings;
        let in_kpa = |row: &[f32]| {
            row.iter()
                .map(|r| physics.normalization.reading_kpa * f64::from(*r))
                .collect()
        };
        elastic.rows().map(in_kpa).collect()
    };
    twin.gains()
        .remember(presses, presses.iter().map(elastic).collect())
}

proptest! {
    #[test]
    fn steps_read_what_whole_presses_read(presses in prop::collection::vec(press(), 1..4), seed in 0..1000_u64) {
        let presses: Vec<&Features> = presses.iter().collect();
        for variant in Variant::ALL {
            let twin = twin(variant, seed, N_TAXELS);
            let whole = twin.predict(&presses);
            prop_assert_eq!(&whole, &by_matrices(&twin, &presses), "{}", variant);
            let mut state = twin.state();
            let mut readings_kpa = [0.0; N_TAXELS];
            // The first press starts at rest, so a tare there is the zero of the whole press.
            let press = presses[0];
            for (frame, expected) in whole[0].iter().enumerate() {
                let since_s = if frame > 0 { press.time_s[frame] - press.time_s[frame - 1] } else { 1.0 };
                state.step(since_s, &press.pressure_kpa[frame], &mut readings_kpa);
                if frame + 1 == press.zero_frames.end {
                    state.tare();
                } else if frame >= press.zero_frames.end {
                    prop_assert_eq!(&readings_kpa[..], &expected[..], "{} frame {}", variant, frame);
                }
            }
        }
    }

    #[test]
    fn sensors_that_are_stepped_together_read_what_each_reads_alone(
        n_sensors in 1..150_usize,
        steps in prop::collection::vec((0.0..0.3_f64, prop::option::of(0..1000_usize)), 1..12),
        seed in 0..1000_u64,
    ) {
        for variant in Variant::ALL {
            let twin = twin(variant, seed, N_TAXELS);
            let (mut together, mut alone) = (twin.states(n_sensors), vec![twin.state(); n_sensors]);
            let mut readings_kpa = vec![0.0; n_sensors * N_TAXELS];
            for (number, (since_s, rests)) in steps.iter().enumerate() {
                let wave = |at: usize| 30.0 * (0.37 * (at * (number + 1)) as f64 + seed as f64).sin();
                let seen: Vec<f64> = (0..n_sensors * N_TAXELS).map(wave).collect();
                if let Some(sensor) = rests.map(|number| number % n_sensors) {
                    together.rest(sensor);
                    alone[sensor].rest(0);
                }
                together.step(*since_s, &seen, &mut readings_kpa);
                for (sensor, state) in alone.iter_mut().enumerate().rev() {
                    let own = sensor * N_TAXELS..(sensor + 1) * N_TAXELS;
                    let mut expected = [0.0; N_TAXELS];
                    state.step(*since_s, &seen[own.clone()], &mut expected);
                    prop_assert_eq!(&readings_kpa[own], &expected[..], "{} sensor {}", variant, sensor);
                }
                if number == 1 {
                    together.tare();
                    alone.iter_mut().for_each(|state| state.tare());
                }
            }
        }
    }
}

proptest! {
    #[test]
    fn readings_without_memory_are_those_of_a_rested_gel(press in press(), seed in 0..1000_u64, zero_kpa in -900.0..900.0_f64) {
        for variant in [Variant::PressureMemory, Variant::PressureMemoryMlp] {
            let twin = twin(variant, seed, N_TAXELS);
            let (mut state, mut rested, mut undo) = (twin.state(), twin.state(), twin.without_memory());
            state.tare_untouched();
            rested.tare_untouched();
            let frames = std::iter::once([0.0; N_TAXELS].to_vec()).chain(press.pressure_kpa.clone());
            for (number, seen) in frames.enumerate() {
                let since_s = 0.02 + 0.3 * (number % 3) as f64;
                let (mut readings_kpa, mut expected_kpa) = ([0.0; N_TAXELS], [0.0; N_TAXELS]);
                state.step(since_s, &seen, &mut readings_kpa);
                rested.rest(0);
                rested.step(since_s, &seen, &mut expected_kpa);
                readings_kpa.iter_mut().for_each(|reading| *reading += zero_kpa);
                undo.step(since_s, &mut readings_kpa);
                for (found, expected) in readings_kpa.iter().zip(expected_kpa) {
                    prop_assert!((found - expected).abs() < 1e-9, "{}: {} {}", variant, found, expected);
                }
            }
        }
    }
}

#[test]
fn the_zero_follows_an_untouched_sensor_that_drifts() {
    let twin = twin(Variant::PressureMemory, 3, N_TAXELS);
    let mut undo = twin.without_memory();
    let mut readings_kpa = [0.0; N_TAXELS];
    for frame in 0..2000 {
        readings_kpa = [100.0 + 0.001 * f64::from(frame); N_TAXELS];
        undo.step(0.02, &mut readings_kpa);
        undo.settle(0.02);
    }
    assert!(
        readings_kpa.iter().all(|reading| reading.abs() < 0.1),
        "{readings_kpa:?}"
    );
    undo.tare();
    readings_kpa = [-40.0; N_TAXELS];
    undo.step(0.5, &mut readings_kpa);
    assert!(
        readings_kpa.iter().all(|reading| reading.abs() < 1e-9),
        "{readings_kpa:?}"
    );
}

#[test]
fn an_untouched_sensor_reads_zero_after_either_tare() {
    for variant in Variant::ALL {
        let twin = twin(variant, 5, N_TAXELS);
        let (mut now, mut untouched) = (twin.states(2), twin.states(2));
        let mut readings_kpa = [1.0; 2 * N_TAXELS];
        now.step(0.0, &[0.0; 2 * N_TAXELS], &mut readings_kpa);
        now.tare();
        untouched.tare_untouched();
        for state in [&mut now, &mut untouched] {
            state.step(0.1, &[0.0; 2 * N_TAXELS], &mut readings_kpa);
            assert_eq!(readings_kpa, [0.0; 2 * N_TAXELS], "{variant}");
        }
    }
}

#[test]
fn poses_at_a_place_read_what_the_whole_press_reads() {
    let recording = Truth::new().recording(2);
    let press = &recording.presses[0];
    let mut bench = BenchEstimate::nominal();
    bench.contact_offset_elsewhere_mm = 0.03;
    bench.ports = vec![
        PortEstimate {
            shift_mm: [0.1, -0.2],
            wider_mm: 0.1,
        };
        4
    ];
    let places = Places::of(&recording, &Formula, &PlaceSettings::default()).unwrap();
    let mut tables = Formula.depth_tables(&places.requests).unwrap();
    for frame in tables.iter_mut().flat_map(|table| &mut table.frames) {
        frame
            .port_slope_kpa_per_mm
            .fill([frame.depth_mm, 0.5, -frame.depth_mm]);
    }
    let along = &features(&recording, &places, &tables, &bench).unwrap()[0];
    for variant in [Variant::Paper, Variant::PressureMemoryMlp] {
        let twin = twin(variant, 3, 4);
        let whole = twin.predict(&[along]).swap_remove(0);
        let table = &tables[places.of_press[0]];
        let mut at_place = TwinAtPlace::new(&twin, table, &bench, &press.mounting).unwrap();
        let mut readings_kpa = [0.0; 4];
        for (frame, pose) in press.gel_from_indenter.iter().enumerate() {
            let since_s = press.time_s[frame] - press.time_s[frame.saturating_sub(1)];
            at_place.step_to(since_s, pose, &mut readings_kpa);
            assert_eq!(readings_kpa[..], whole[frame][..], "{variant} frame {frame}");
            assert_eq!(at_place.force_n(), along.force_n[frame]);
        }
        let elsewhere = Pose::from_position(DVec3::Z * press.gel_from_indenter[0].position_mm.z);
        at_place.rest();
        at_place.step_to(9.0, &elsewhere, &mut readings_kpa);
        assert_eq!(readings_kpa[..], whole[0][..]);
    }
}

/// Values that are neither a pressure nor a reading.
const BAD: [f64; 6] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e39, -1e300, 2e6];

#[test]
fn what_is_not_a_pressure_is_read_as_nan_in_its_frame_alone() {
    let seen = |frame: usize| [8.0, 20.0, 3.0].map(|kpa| kpa * (1.0 + (frame as f64).sin()));
    for (variant, bad) in Variant::ALL
        .into_iter()
        .flat_map(|variant| BAD.map(|bad| (variant, bad)))
    {
        let twin = twin(variant, 3, N_TAXELS);
        for at in [0, 4] {
            let (mut state, mut held) = (twin.state(), twin.state());
            for frame in 0..9 {
                let (mut read, mut expected) = ([0.0; N_TAXELS], [0.0; N_TAXELS]);
                let good = seen(if frame == at && at > 0 { frame - 1 } else { frame });
                let mut given = seen(frame);
                if frame == at {
                    given[1] = bad;
                }
                state.step(0.02, &given, &mut read);
                if frame == at {
                    assert!(read[1].is_nan(), "{variant} {bad}: {read:?}");
                    if at == 0 {
                        continue; // the state starts one frame later
                    }
                }
                held.step(0.02, &good, &mut expected);
                if frame > at {
                    assert!(
                        read.iter().all(|kpa| kpa.is_finite()),
                        "{variant} {bad}: {read:?}"
                    );
                    // The state of the taxel is that of the frame before.
                    assert_eq!(read[1], expected[1], "{variant} {bad}, frame {frame}");
                }
            }
            state.tare();
            let mut read = [0.0; N_TAXELS];
            state.step(0.02, &[bad; N_TAXELS], &mut read);
            state.tare();
            state.step(0.02, &seen(0), &mut read);
            assert!(
                read.iter().all(|kpa| kpa.is_finite()),
                "{variant} {bad}: {read:?}"
            );
        }
    }
}

#[test]
fn what_is_no_reading_is_nothing_in_its_frame_alone() {
    let twin = twin(Variant::PressureMemory, 3, N_TAXELS);
    for bad in BAD {
        let mut relaxed = twin.without_memory();
        for frame in 0..12 {
            let mut readings = [5.0, 50.0, 0.5].map(|kpa| 100.0 + if frame == 0 { 0.0 } else { kpa });
            if frame == 3 {
                readings[2] = bad;
            }
            relaxed.step(0.02, &mut readings);
            assert_eq!(readings[2].is_nan(), frame == 3, "{bad}: {readings:?}");
            assert!(readings[0].is_finite() && readings[1].is_finite());
        }
        // If the frame without contact is missing, the next one is used.
        relaxed.tare();
        let mut readings = [7.0, bad, 7.0];
        relaxed.step(0.02, &mut readings);
        readings = [7.0; 3];
        relaxed.step(0.02, &mut readings);
        let mut later = [9.0; 3];
        relaxed.step(0.02, &mut later);
        assert!(later.iter().all(|kpa| kpa.is_finite()), "{bad}: {later:?}");
        assert!(later[1] - readings[1] > 1.0, "{bad}: {readings:?} {later:?}");
    }
}

#[test]
#[should_panic(expected = "a time that does not run backwards")]
fn time_does_not_run_backwards() {
    twin(Variant::PressureMemory, 3, N_TAXELS)
        .state()
        .step(-0.1, &[0.0; N_TAXELS], &mut [0.0; N_TAXELS]);
}
