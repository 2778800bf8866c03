//! A force sensor with analog gauges, read through a measuring card, as a user's own program does
//! it.

use std::time::Duration;

use twintac_rig::{Analog, AnalogCalibration, BenchClock, VoltageSample, Wrench, WrenchSource};

const CALIBRATION: &str = "matrix = [\n  [2.0, 0.0, 0.0, 0.0, 0.0, 0.0],\n  [0.0, 1.0, 0.0, 0.0, 0.0, 0.0],\n  \
    [0.0, 0.0, 1.0, 0.0, 0.0, 0.0],\n  [0.0, 0.0, 0.0, 1.0, 0.0, 0.0],\n  [0.0, 0.0, 0.0, 0.0, 1.0, 0.0],\n  \
    [0.0, 0.0, 0.0, 0.0, 0.0, 1.0],\n]\n";

#[test]
fn voltages_become_wrenches_with_their_stamp_and_their_gap() {
    let clock = BenchClock::start();
    let unloaded_v = [0.5; 6];
    let calibration = AnalogCalibration::parse_toml("calibration.toml", CALIBRATION).unwrap();
    let mut samples = [[0.5; 6], [1.5; 6], [11.0; 6]]
        .into_iter()
        .map(|volts| VoltageSample {
            stamp: clock.stamp(Some(3.0)),
            volts,
            lost_before: 2,
        });
    let mut source = Analog::new(|_| Ok(samples.next()), calibration.with_bias(unloaded_v));
    let unloaded = source.next_sample(Duration::ZERO).unwrap().unwrap();
    assert_eq!(unloaded.wrench, Wrench::ZERO);
    let loaded = source.next_sample(Duration::ZERO).unwrap().unwrap();
    assert_eq!(loaded.wrench, Wrench::from_axes([2.0, 1.0, 1.0, 1.0, 1.0, 1.0]));
    assert_eq!((loaded.stamp.source_s, loaded.lost_before), (Some(3.0), 2));
    assert!(source.next_sample(Duration::ZERO).is_err(), "saturated");
    assert_eq!(
        source.next_sample(Duration::ZERO).unwrap(),
        None,
        "nothing came in time"
    );
}
