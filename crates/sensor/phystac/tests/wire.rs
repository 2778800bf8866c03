//! The bytes on the bus, and how long they take.

mod common;

use common::Bench;
use phystac::{Budget, Channels, Chip, Error, Fault, PhysTac, Settings};
use phystac::{SwitchAddress, Tca9548a, Transfer, Wired, Wiring};

fn lines(text: &str) -> Vec<String> {
    text.split(',').map(|line| line.trim().to_owned()).collect()
}

fn two_taxels() -> Settings<2> {
    Settings::new(Wiring::of_cps135b([3, 5]).expect("two channels"))
}

#[test]
fn first_frame_starts_the_switch_and_later_ones_do_not() {
    let bench = Bench::new();
    let mut sensor = PhysTac::new(bench.clone(), bench.clone(), bench.clock(), two_taxels());
    sensor.frame().unwrap();
    let start = "70 00, 70 -> 00, 6d !, 70 08, 70 -> 08, 6d 30 -> 02, 70 20, 70 -> 20, 6d 30 -> 02, 70 00";
    let frame = "70 28, 6d 30 0a, 70 08, 6d 30 -> 02, 6d 06 -> 31 79 a3 19 03, 70 20, 6d 30 -> 02, 6d 06 -> 31 79 a5 19 05";
    assert_eq!(bench.take_log(), lines(&format!("{start}, {frame}")));
    sensor.frame().unwrap();
    assert_eq!(bench.take_log(), lines(frame));
    sensor.stop().unwrap();
    assert_eq!(bench.take_log(), lines("70 00"));
}

#[test]
fn a_frame_is_what_the_barometers_found_at_its_trigger() {
    let bench = Bench::new();
    let mut sensor = PhysTac::new(bench.clone(), bench.clone(), bench.clock(), Settings::default());
    let frame = sensor.frame().unwrap();
    for (taxel, sample) in frame.taxels.iter().enumerate() {
        let sample = sample.unwrap();
        assert_eq!(sample.counts.signed(), 3_242_400 + taxel as i32);
        assert_eq!(sample.temperature_c, 25.0 + taxel as f32 / 256.0);
    }
    let pressures_pa = frame.pressures_pa(&Transfer::per_pa(32));
    assert_eq!(pressures_pa[4], Ok(101_325.125));
    assert!(frame.read_us.is_sorted());
    assert!(frame.read_us[0] >= frame.triggered_us + 6000);
    assert_eq!(frame.faults().count(), 0);
}

#[test]
fn a_frame_takes_what_the_budget_says() {
    for (bus_hz, conversion_us) in [
        (100_000, 2500),
        (100_000, 6000),
        (400_000, 6000),
        (400_000, 20_000),
    ] {
        let bench = Bench::new();
        bench.with(|world| {
            world.bus_hz = u64::from(bus_hz);
            world
                .parts
                .iter_mut()
                .for_each(|part| part.conversion_ns = 1000 * u64::from(conversion_us));
        });
        let settings = Settings {
            conversion_us,
            ..Settings::default()
        };
        let mut sensor = PhysTac::new(bench.clone(), bench.clone(), bench.clock(), settings);
        sensor.start().unwrap();
        let (clocks, now_ns) = bench.with(|world| (world.clocks, world.now_ns));
        sensor.frame().unwrap();
        let (clocks, passed_ns) = bench.with(|world| (world.clocks - clocks, world.now_ns - now_ns));
        let budget = Budget::new(sensor.settings(), bus_hz);
        assert_eq!(clocks, u64::from(budget.frame_clocks()));
        assert!(
            (passed_ns as f32 / 1000.0 - budget.frame_us()).abs() < 2.0,
            "{passed_ns} ns, {budget:?}"
        );
    }
}

#[test]
fn a_frame_triggered_early_is_not_waited_for() {
    let bench = Bench::new();
    let mut sensor = PhysTac::new(bench.clone(), bench.clone(), bench.clock(), Settings::default());
    sensor.trigger().unwrap();
    sensor.trigger().unwrap(); // already in progress
    bench.with(|world| world.now_ns += 50_000_000);
    let (triggers, now_ns) = (bench.take_log(), bench.with(|world| world.now_ns));
    assert_eq!(triggers.iter().filter(|line| *line == "6d 30 0a").count(), 1);
    let frame = sensor.frame().unwrap();
    assert!(bench.with(|world| world.now_ns) - now_ns < 3_000_000);
    assert!(frame.read_us[0] - frame.triggered_us > 50_000);
}

#[test]
fn slow_barometers_are_asked_again_and_not_believed_before() {
    let bench = Bench::new();
    bench.with(|world| world.parts[2].conversion_ns = 15_000_000);
    let mut sensor = PhysTac::new(bench.clone(), bench.clone(), bench.clock(), Settings::default());
    let frame = sensor.frame().unwrap();
    assert_eq!(frame.taxels[2].unwrap().counts.signed(), 3_242_402);
    let questions = bench
        .take_log()
        .iter()
        .filter(|line| *line == "6d 30 -> 0a")
        .count();
    assert!((20..40).contains(&questions), "{questions}");
}

#[test]
fn oversampling_keeps_the_factorys_bits() {
    let bench = Bench::new();
    bench.with(|world| {
        world.parts[3].configuration = 0xF1;
        world.parts[5].keeps_configuration = false;
    });
    let wired = |channel| Wired {
        samples: Some(16_384),
        ..Wired::on_channel(Chip::Cps135b, channel)
    };
    let settings = Settings::new(Wiring::<2>::new(&[wired(3), wired(5)]).unwrap());
    let mut sensor = PhysTac::new(bench.clone(), bench.clone(), bench.clock(), settings);
    let frame = sensor.frame().unwrap();
    assert!(frame.faults().eq([(1, Fault::Refused)]));
    let log = bench.take_log();
    let first = "70 08, 70 -> 08, 6d 30 -> 02, 6d a6 -> f1, 6d a6 f6, 6d a6 -> f6";
    let second = "70 20, 70 -> 20, 6d 30 -> 02, 6d a6 -> 28, 6d a6 2e, 6d a6 -> 28, 70 00";
    assert_eq!(log[3..16], lines(&format!("{first}, {second}")));
}

#[test]
fn the_switch_by_itself() {
    let bench = Bench::new();
    let mut switch = Tca9548a::new(bench.clone(), SwitchAddress::default());
    let channel = Channels::only(6).unwrap();
    switch.select(channel).unwrap();
    assert_eq!(switch.selected(), Ok(channel));
    assert_eq!(
        switch.verify(Channels::ALL),
        Err(Error::SwitchReset {
            wrote: Channels::ALL,
            found: channel
        })
    );
    let mut nobody = Tca9548a::new(switch.release(), SwitchAddress::new(0x77).unwrap());
    assert_eq!(nobody.select(Channels::NONE), Err(Error::SwitchMissing));
}
