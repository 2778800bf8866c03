//! The same over an async bus, which may be dropped while it waits.

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
fn a_frame_dropped_at_any_point_leaves_nothing_wrong_behind() {
    for most in 0..100 {
        let bench = Bench::new();
        let mut sensor =
            asynch::PhysTac::new(bench.clone(), bench.clone(), bench.clock(), Settings::default());
        poll_up_to(1000, sensor.trigger()).expect("no end").unwrap();
        let dropped = poll_up_to(most, sensor.frame());
        bench.with(|world| world.parts.iter_mut().for_each(|part| part.counts += 1000));
        let frame = poll_up_to(1000, sensor.frame()).expect("no end").unwrap();
        for (taxel, sample) in frame.taxels.iter().enumerate() {
            let expected = bench.with(|world| world.parts[taxel].counts);
            assert_eq!(
                sample.unwrap().counts.signed(),
                expected,
                "dropped after {most} polls: {dropped:?}"
            );
        }
    }
}
