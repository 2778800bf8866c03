//! One fault at a time, at every transaction at which it can occur.

mod common;

use common::{Bench, NACK};
use embedded_hal::i2c::ErrorKind;
use phystac::{Error, Fault, Frame, PhysTac, Settings};

type Sensor<C> = PhysTac<Bench, Bench, C, 8>;
type Outcome = Result<Frame<8>, Error<ErrorKind>>;

fn sensor_on(bench: &Bench) -> Sensor<impl Fn() -> u64 + use<>> {
    PhysTac::new(bench.clone(), bench.clone(), bench.clock(), Settings::default())
}

/// Reads a frame with a pressure that no earlier frame had. A value that the frame contains must be
/// of this frame.
fn next_frame<C: Fn() -> u64>(bench: &Bench, sensor: &mut Sensor<C>) -> Outcome {
    bench.with(|world| world.parts.iter_mut().for_each(|part| part.counts += 1000));
    let frame = sensor.frame()?;
    for (taxel, sample) in frame.taxels.iter().enumerate() {
        if let Ok(sample) = sample {
            assert_eq!(
                sample.counts.signed(),
                bench.with(|world| world.parts[taxel].counts),
                "taxel {taxel} is stale"
            );
        }
    }
    Ok(frame)
}

fn faults(frame: &Frame<8>) -> Vec<(usize, Fault)> {
    frame.faults().collect()
}

fn is_complete(outcome: &Outcome) -> bool {
    outcome.as_ref().is_ok_and(|frame| frame.faults().count() == 0)
}

/// Transactions of a start and two frames.
fn n_transactions() -> usize {
    let bench = Bench::new();
    let mut sensor = sensor_on(&bench);
    assert!(is_complete(&next_frame(&bench, &mut sensor)));
    assert!(is_complete(&next_frame(&bench, &mut sensor)));
    bench.with(|world| world.count)
}

#[test]
fn a_missing_barometer_is_named_and_stops_no_other() {
    for missing in 0..8 {
        let bench = Bench::new();
        let mut sensor = sensor_on(&bench);
        bench.with(|world| world.parts[missing].is_present = false);
        assert_eq!(
            faults(&next_frame(&bench, &mut sensor).unwrap()),
            [(missing, Fault::Missing)]
        );
        bench.with(|world| world.parts[missing].is_present = true);
        assert!(is_complete(&next_frame(&bench, &mut sensor)));
    }
}

#[test]
fn a_barometer_that_comes_back_after_the_trigger_has_no_sample_of_this_frame() {
    for missing in 0..8 {
        let bench = Bench::new();
        let mut sensor = sensor_on(&bench);
        assert!(is_complete(&next_frame(&bench, &mut sensor)));
        bench.with(|world| world.parts[missing].is_present = false);
        assert_eq!(
            faults(&next_frame(&bench, &mut sensor).unwrap()),
            [(missing, Fault::Missing)]
        );
        sensor.trigger().unwrap();
        bench.with(|world| world.parts[missing].is_present = true);
        // Its registers still hold a sample of an earlier frame.
        assert_eq!(faults(&sensor.frame().unwrap()), [(missing, Fault::Missing)]);
        assert!(is_complete(&next_frame(&bench, &mut sensor)));
    }
}

#[test]
fn without_any_barometer_or_without_the_switch_there_is_no_frame() {
    let bench = Bench::new();
    let mut sensor = sensor_on(&bench);
    bench.with(|world| world.parts.iter_mut().for_each(|part| part.is_present = false));
    assert_eq!(next_frame(&bench, &mut sensor), Err(Error::NotTriggered));
    bench.with(|world| world.has_switch = false);
    assert_eq!(next_frame(&bench, &mut sensor), Err(Error::SwitchMissing));
    bench.with(|world| {
        world.has_switch = true;
        world.parts.iter_mut().for_each(|part| part.is_present = true);
    });
    assert!(is_complete(&next_frame(&bench, &mut sensor)));
}

#[test]
fn conversions_that_never_end_cost_the_frame_its_patience_once() {
    for stuck in [vec![0], vec![7], vec![1, 2, 5], (0..8).collect()] {
        let bench = Bench::new();
        let mut sensor = sensor_on(&bench);
        assert!(is_complete(&next_frame(&bench, &mut sensor)));
        for taxel in &stuck {
            bench.with(|world| world.parts[*taxel].conversion_ns = u64::MAX);
        }
        let before_ns = bench.with(|world| world.now_ns);
        let frame = next_frame(&bench, &mut sensor).unwrap();
        let expected: Vec<_> = stuck.iter().map(|taxel| (*taxel, Fault::Stuck)).collect();
        assert_eq!(faults(&frame), expected);
        let passed_ns = bench.with(|world| world.now_ns) - before_ns;
        assert!((20_000_000..32_000_000).contains(&passed_ns), "{passed_ns} ns");

        // The driver does not wait for it again, and does not trigger it before its conversion has
        // ended.
        let before_ns = bench.with(|world| world.now_ns);
        match next_frame(&bench, &mut sensor) {
            Ok(frame) => {
                assert_eq!(faults(&frame), expected);
                assert!(bench.with(|world| world.now_ns) - before_ns < 10_000_000);
            }
            Err(error) => assert_eq!((error, stuck.len()), (Error::NotTriggered, 8)),
        }
        bench.with(|world| {
            for part in &mut world.parts {
                part.conversion_ns = 6_000_000;
                part.restart();
            }
        });
        let next = next_frame(&bench, &mut sensor);
        assert!(is_complete(&next), "{stuck:?}: {next:?}");
    }
}

#[test]
fn a_conversion_that_outlasts_its_frame_is_not_taken_for_the_next() {
    for conversion_ms in [21, 25, 33, 60] {
        let bench = Bench::new();
        let mut sensor = sensor_on(&bench);
        bench.with(|world| world.parts[4].conversion_ns = 1_000_000 * conversion_ms);
        for _ in 0..20 {
            let frame = next_frame(&bench, &mut sensor).unwrap();
            assert!(
                frame.faults().all(|fault| fault == (4, Fault::Stuck)),
                "{frame:?}"
            );
        }
    }
}

#[test]
fn starting_anew_lets_conversions_under_way_end() {
    let bench = Bench::new();
    bench.with(|world| {
        world
            .parts
            .iter_mut()
            .for_each(|part| part.conversion_ns = 40_000_000)
    });
    let settings = Settings {
        conversion_us: 40_000,
        ..Settings::default()
    };
    let mut sensor = PhysTac::new(bench.clone(), bench.clone(), bench.clock(), settings);
    sensor.trigger().unwrap();
    sensor.stop().unwrap();
    assert!(is_complete(&next_frame(&bench, &mut sensor)));
}

#[test]
fn a_clock_that_stands_still_or_jumps_back_hangs_nothing() {
    let bench = Bench::new();
    let jumping = std::cell::Cell::new(1_000_000_u64);
    let clock = || {
        jumping.set(jumping.get() / 2);
        jumping.get()
    };
    let mut sensor = PhysTac::new(bench.clone(), bench.clone(), clock, Settings::default());
    for _ in 0..30 {
        assert_eq!(sensor.frame().unwrap().faults().count(), 0);
    }
}

#[test]
fn an_error_at_any_transaction_is_typed_and_over_with_the_next_frame() {
    let kinds = [
        ErrorKind::Bus,
        ErrorKind::ArbitrationLoss,
        ErrorKind::Overrun,
        ErrorKind::Other,
        NACK,
    ];
    for failure in kinds {
        for failing_are_heard in [false, true] {
            for index in 0..n_transactions() {
                let bench = Bench::new();
                let mut sensor = sensor_on(&bench);
                bench.with(|world| {
                    world.failing = index..index + 1;
                    world.failure = failure;
                    world.failing_are_heard = failing_are_heard;
                });
                let place = format!("{failure:?} at {index}, heard: {failing_are_heard}");
                let mut outcomes: Vec<Outcome> = Vec::new();
                while bench.with(|world| world.count) <= index {
                    outcomes.push(next_frame(&bench, &mut sensor));
                }
                let last = outcomes.pop().unwrap();
                assert!(outcomes.iter().all(is_complete), "{place}: {outcomes:?}");
                match &last {
                    Ok(frame) if failure == NACK => {
                        assert!(
                            frame.faults().all(|(_, fault)| fault == Fault::Missing),
                            "{place}: {frame:?}"
                        );
                    }
                    Ok(frame) => {
                        assert!(
                            frame.faults().all(|(_, fault)| fault == Fault::Bus(failure)),
                            "{place}: {frame:?}"
                        );
                    }
                    Err(error) if failure == NACK => {
                        assert!(
                            matches!(error, Error::SwitchMissing | Error::NotTriggered),
                            "{place}: {error}"
                        );
                    }
                    Err(error) => assert_eq!(*error, Error::Bus(failure), "{place}"),
                }
                let next = next_frame(&bench, &mut sensor);
                assert!(is_complete(&next), "{place}: {last:?}, then {next:?}");
            }
        }
    }
}

#[test]
fn a_bus_that_dies_at_any_transaction_is_said_to_hang_until_it_is_freed() {
    for index in 0..n_transactions() {
        let bench = Bench::new();
        let mut sensor = sensor_on(&bench);
        bench.with(|world| world.failing = index..usize::MAX);
        let error = loop {
            match next_frame(&bench, &mut sensor) {
                Ok(frame) => assert_eq!(frame.faults().count(), 0, "dead at {index}"),
                Err(error) => break error,
            }
        };
        assert!(
            matches!(
                error,
                Error::BusHung {
                    source: ErrorKind::Bus,
                    ..
                }
            ),
            "dead at {index}: {error}"
        );
        assert!(bench.with(|world| world.count) <= index + 2, "dead at {index}");
        assert!(matches!(
            next_frame(&bench, &mut sensor),
            Err(Error::BusHung { taxel: None, .. })
        ));
        sensor.recover(|bus, _| bus.reset());
        assert!(is_complete(&next_frame(&bench, &mut sensor)), "dead at {index}");
    }
}

#[test]
fn a_switch_that_loses_its_mask_at_any_transaction_gives_no_wrong_value() {
    for index in 0..n_transactions() {
        let bench = Bench::new();
        let mut sensor = sensor_on(&bench);
        bench.with(|world| world.brown_out_at = Some(index));
        while bench.with(|world| world.count) <= index {
            let outcome = next_frame(&bench, &mut sensor);
            let is_reset = matches!(outcome, Err(Error::SwitchReset { .. }));
            assert!(is_reset || is_complete(&outcome), "at {index}: {outcome:?}");
        }
        assert!(is_complete(&next_frame(&bench, &mut sensor)), "at {index}");
    }
}

/// Reads until a frame succeeds, with the switch's RESET after each error. Returns the number of
/// errors, and the frame.
fn frame_with_resets<C: Fn() -> u64>(bench: &Bench, sensor: &mut Sensor<C>) -> (usize, Frame<8>) {
    for n_resets in 0..10 {
        match next_frame(bench, sensor) {
            Ok(frame) => return (n_resets, frame),
            Err(error) => assert!(matches!(error, Error::BusHung { .. }), "{error}"),
        }
        sensor.recover(|bus, _| bus.reset());
    }
    panic!("no frame after ten resets");
}

#[test]
fn a_shorted_taxel_is_found_and_left_out() {
    for shorted in 0..8 {
        let bench = Bench::new();
        let mut sensor = sensor_on(&bench);
        assert!(is_complete(&next_frame(&bench, &mut sensor)));
        bench.with(|world| world.parts[shorted].is_shorted = true);
        let (n_resets, frame) = frame_with_resets(&bench, &mut sensor);
        assert_eq!((n_resets, faults(&frame)), (3, vec![(shorted, Fault::Isolated)]));
        assert_eq!(
            faults(&next_frame(&bench, &mut sensor).unwrap()),
            [(shorted, Fault::Isolated)]
        );

        sensor.readmit();
        let (_, frame) = frame_with_resets(&bench, &mut sensor);
        assert_eq!(faults(&frame), [(shorted, Fault::Isolated)]);

        bench.with(|world| world.parts[shorted].is_shorted = false);
        sensor.readmit();
        assert!(is_complete(&next_frame(&bench, &mut sensor)));
    }
}

/// Reads frames for a given time, with the switch's RESET after each error. Returns when the taxel
/// has a value again, ms, and how many frames were lost.
fn frames_for<C: Fn() -> u64>(
    bench: &Bench,
    sensor: &mut Sensor<C>,
    taxel: usize,
    seconds: u64,
) -> (Option<u64>, usize) {
    let start_ns = bench.with(|world| world.now_ns);
    let (mut back_ms, mut lost) = (None, 0);
    while bench.with(|world| world.now_ns) < start_ns + seconds * 1_000_000_000 {
        // Counts have 24 bits.
        bench.with(|world| world.parts.iter_mut().for_each(|part| part.counts %= 8_000_000));
        match next_frame(bench, sensor) {
            Ok(frame) if frame.taxels[taxel].is_ok() => {
                back_ms.get_or_insert((bench.with(|world| world.now_ns) - start_ns) / 1_000_000);
            }
            Ok(frame) => assert_eq!(faults(&frame), [(taxel, Fault::Isolated)]),
            Err(_) => {
                lost += 1;
                sensor.recover(|bus, _| bus.reset());
            }
        }
    }
    (back_ms, lost)
}

#[test]
fn a_taxel_whose_short_has_passed_takes_part_again() {
    for shorted in [0, 3, 7] {
        let bench = Bench::new();
        let mut sensor = sensor_on(&bench);
        assert!(is_complete(&next_frame(&bench, &mut sensor)));
        bench.with(|world| world.parts[shorted].is_shorted = true);
        frame_with_resets(&bench, &mut sensor);
        bench.with(|world| world.parts[shorted].is_shorted = false);
        let (back_ms, lost) = frames_for(&bench, &mut sensor, shorted, 3);
        assert!(
            back_ms.is_some_and(|ms| (900..1100).contains(&ms)),
            "taxel {shorted}: {back_ms:?}"
        );
        assert_eq!(lost, 0);
        assert!(is_complete(&next_frame(&bench, &mut sensor)));
    }
}

#[test]
fn a_short_that_stays_costs_ever_fewer_frames() {
    let bench = Bench::new();
    let mut sensor = sensor_on(&bench);
    bench.with(|world| world.parts[5].is_shorted = true);
    frame_with_resets(&bench, &mut sensor);
    // After 1, 2, 4, ... 32 s, then every 64 s.
    assert_eq!(frames_for(&bench, &mut sensor, 5, 60), (None, 5));
    assert_eq!(frames_for(&bench, &mut sensor, 5, 400), (None, 7));
}

#[test]
fn each_of_two_isolated_taxels_is_looked_into() {
    let bench = Bench::new();
    let mut sensor = sensor_on(&bench);
    bench.with(|world| {
        world.parts[1].is_shorted = true;
        world.parts[6].is_shorted = true;
    });
    frame_with_resets(&bench, &mut sensor);
    bench.with(|world| world.parts[6].is_shorted = false);
    let start_ns = bench.with(|world| world.now_ns);
    while bench.with(|world| world.now_ns) < start_ns + 3_000_000_000 {
        frame_with_resets(&bench, &mut sensor);
    }
    let frame = frame_with_resets(&bench, &mut sensor).1;
    assert_eq!(faults(&frame), [(1, Fault::Isolated)]);
}

#[test]
fn two_shorted_taxels_are_left_out_and_a_passing_short_is_forgiven() {
    let bench = Bench::new();
    let mut sensor = sensor_on(&bench);
    bench.with(|world| {
        world.parts[1].is_shorted = true;
        world.parts[6].is_shorted = true;
    });
    let (_, frame) = frame_with_resets(&bench, &mut sensor);
    assert_eq!(faults(&frame), [(1, Fault::Isolated), (6, Fault::Isolated)]);

    bench.with(|world| world.parts[3].is_shorted = true);
    assert!(next_frame(&bench, &mut sensor).is_err());
    bench.with(|world| world.parts[3].is_shorted = false);
    let (_, frame) = frame_with_resets(&bench, &mut sensor);
    assert!(frame.taxels[3].is_ok());
}

#[test]
fn only_a_taxel_that_hangs_the_bus_twice_running_is_left_out() {
    let bench = Bench::new();
    let mut sensor = sensor_on(&bench);
    let mut hang_at = |taxel: Option<usize>| {
        sensor.recover(|bus, _| bus.reset()); // so that the next frame looks into each channel, with three transactions
        if let Some(taxel) = taxel {
            bench.with(|world| world.failing = world.count + 3 + 3 * taxel + 2..usize::MAX);
        }
        next_frame(&bench, &mut sensor)
    };
    let hung = |taxel: usize| {
        let (taxel, source) = (Some(taxel), ErrorKind::Bus);
        Err(Error::BusHung { taxel, source })
    };
    // different ones in turn
    for taxel in [2, 5, 2, 5] {
        assert_eq!(hang_at(Some(taxel)), hung(taxel));
    }
    assert!(is_complete(&hang_at(None)));
    // the same one, with a good frame between
    for _ in 0..3 {
        assert_eq!(hang_at(Some(5)), hung(5));
        assert!(is_complete(&hang_at(None)));
    }
    // the same one twice running
    assert_eq!(hang_at(Some(5)), hung(5));
    assert_eq!(hang_at(Some(5)), hung(5));
    assert_eq!(faults(&hang_at(None).unwrap()), [(5, Fault::Isolated)]);
}
