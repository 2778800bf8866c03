//! The drivers over an async bus; futures are dropped while they wait.

mod common;

use common::{Bench, poll_up_to};
use phystac::{PhysTac, Settings, asynch};

#[test]
fn async_and_blocking_say_the_same() {
    let (one, other) = (Bench::new(), Bench::new());
    let mut blocking = PhysTac::new(one.clone(), one.clone(), one.clock(), Settings::default());
    let mut waiting = asynch::PhysTac::new(other.clone(), other.clone(), other.clock(), Settings::default());
    for _ in 0..3 {
        let frame = poll_up_to(1000, waiting.frame()).expect("no end");
        assert_eq!(blocking.frame(), frame);
        assert_eq!(one.take_log(), other.take_log());
    }
}

#[test]
fn what_is_dropped_at_any_point_leaves_nothing_wrong_behind() {
    for most in 1..100 {
        for drops_frame in [false, true] {
            let bench = Bench::new();
            let mut sensor =
                asynch::PhysTac::new(bench.clone(), bench.clone(), bench.clock(), Settings::default());
            let has_ended = if drops_frame {
                poll_up_to(1000, sensor.trigger()).expect("no end").unwrap();
                poll_up_to(most, sensor.frame()).is_some()
            } else {
                poll_up_to(most, sensor.trigger()).is_some()
            };
            let had_ended = has_ended && !drops_frame;
            let before: Vec<i32> = bench.with(|world| world.parts.iter().map(|part| part.counts).collect());
            bench.with(|world| world.parts.iter_mut().for_each(|part| part.counts += 1000));
            let frame = poll_up_to(1000, sensor.frame()).expect("no end").unwrap();
            for (taxel, sample) in frame.taxels.iter().enumerate() {
                let expected = before[taxel] + if had_ended { 0 } else { 1000 };
                let found = sample.unwrap().counts.signed();
                assert_eq!(
                    found, expected,
                    "dropped after {most} polls, frame: {drops_frame}"
                );
            }
        }
    }
}
