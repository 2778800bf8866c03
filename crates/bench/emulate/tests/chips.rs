//! Every chip of the drivers' table on an emulated bus: its readings, its rate, and the names of
//! its faults.

#![allow(clippy::unwrap_used)] // also in the helpers of tests

use glam::DVec3;
use phystac::{Budget, Chip, Error, Fault, Frame, PhysTac, Settings, SwitchAddress, Transfer, Wired, Wiring};
use twintac_emulate::i2c::{Board, BoardSettings, Bus, PartSettings};
use twintac_emulate::robot::ArmSettings;
use twintac_emulate::{FaultKind, LabClock, MOST_TAXELS, Moment, Physics, ScheduledFault, Sensed, Workcell};
use twintac_rig::TcpPose;

/// Each taxel feels its own pressure, and the temperature of the chips rises.
struct Felt {
    first_kpa: f64,
    step_kpa: f64,
    warms_k_per_s: f64,
}

impl Felt {
    fn temperature_c(&self, time_s: f64) -> f64 {
        31.0 + self.warms_k_per_s * time_s
    }

    fn pressure_kpa(&self, taxel: usize) -> f64 {
        self.first_kpa + self.step_kpa * taxel as f64
    }
}

impl Physics for Felt {
    fn at(&mut self, _: &TcpPose, time_s: f64) -> Sensed {
        let mut sensed = Sensed::untouched(self.first_kpa, self.temperature_c(time_s));
        sensed.taxel_pressures_kpa = std::array::from_fn(|taxel| self.pressure_kpa(taxel));
        sensed
    }
}

/// Free air, with a slightly higher pressure on each next taxel.
const AIR: Felt = Felt {
    first_kpa: 100.0,
    step_kpa: 0.05,
    warms_k_per_s: 0.0,
};

type Sensor = PhysTac<Bus, LabClock, Box<dyn Fn() -> u64>, MOST_TAXELS>;

/// A board, and the driver for the description of this board.
fn on_the_bench(
    described: &[Wired],
    soldered: &[Wired],
    felt: Felt,
    faults: &[ScheduledFault],
) -> (LabClock, Sensor) {
    let clock = LabClock::virtual_time();
    let nowhere = TcpPose {
        position_mm: DVec3::ZERO,
        roll_pitch_yaw_rad: DVec3::ZERO,
    };
    let workcell = Workcell::new(clock.clone(), felt, nowhere, ArmSettings::default());
    let part = |wired: &Wired| PartSettings {
        chip: wired.chip.to_string(),
        address: Some(wired.address),
        switch: wired.behind.map(|(switch, _)| switch.get()),
        channel: wired.behind.map_or(0, |(_, channel)| channel),
    };
    let settings = BoardSettings {
        parts: soldered.iter().map(part).collect(),
        ..BoardSettings::default()
    };
    let board = Board::new(workcell, &settings, faults).unwrap();
    let now = clock.clone();
    let settings = Settings::new(Wiring::new(described).unwrap());
    let now: Box<dyn Fn() -> u64> = Box::new(move || now.now_us());
    (clock.clone(), PhysTac::new(board.bus(), clock, now, settings))
}

fn sensor(wired: &[Wired], felt: Felt, faults: &[ScheduledFault]) -> (LabClock, Sensor) {
    on_the_bench(wired, wired, felt, faults)
}

fn eight(chip: Chip) -> Vec<Wired> {
    (0..8).map(|channel| Wired::on_channel(chip, channel)).collect()
}

/// The noise of a chip in its usual setting, Pa, slightly above that of the data sheet.
fn noise_pa(wired: &Wired) -> f64 {
    let data = wired.chip.data();
    let samples = wired.samples.or(data.usual_samples);
    let speed = data.speeds.iter().find(|speed| Some(speed.samples) == samples);
    speed
        .and_then(|speed| speed.noise_pa)
        .map_or(15.0, f64::from)
        .max(3.0)
}

fn pressures_pa(frame: &Frame<MOST_TAXELS>) -> Vec<Result<f32, Fault>> {
    let transfer = Transfer::per_pa(32);
    frame
        .pressures_pa(&transfer)
        .into_iter()
        .filter(|taxel| *taxel != Err(Fault::NotWired))
        .collect()
}

/// Checks that the mean of the frames equals the true pressures within a fraction of the chips'
/// noise.
fn check_readings(wired: &[Wired], sensor: &mut Sensor, felt: &Felt) {
    const FRAMES: usize = 40;
    let mut sums_pa = vec![0.0; wired.len()];
    for _ in 0..FRAMES {
        let frame = sensor
            .frame()
            .unwrap_or_else(|error| panic!("{}: {error}", wired[0].chip));
        for (taxel, pressure) in pressures_pa(&frame).into_iter().enumerate() {
            let chip = wired[taxel].chip;
            sums_pa[taxel] +=
                f64::from(pressure.unwrap_or_else(|fault| panic!("{chip}, taxel {taxel}: {fault}")));
            let temperature_c = frame.taxels[taxel].unwrap().temperature_c;
            assert!((temperature_c - 31.0).abs() < 0.1, "{chip}: {temperature_c} °C");
        }
    }
    for (taxel, (wired, sum_pa)) in wired.iter().zip(sums_pa).enumerate() {
        let error_pa = sum_pa / FRAMES as f64 - 1000.0 * felt.pressure_kpa(taxel);
        let most_pa = 5.0 * noise_pa(wired) / (FRAMES as f64).sqrt() + 1.5;
        assert!(
            error_pa.abs() < most_pa,
            "{}, taxel {taxel}: {error_pa} Pa off, at most {most_pa}",
            wired.chip
        );
    }
}

#[test]
fn eight_of_each_chip_read_what_is_felt() {
    for chip in Chip::ALL {
        let (_, mut sensor) = sensor(&eight(*chip), AIR, &[]);
        check_readings(&eight(*chip), &mut sensor, &AIR);
    }
}

#[test]
fn every_speed_of_each_chip_reads_what_is_felt() {
    for chip in Chip::ALL {
        for speed in chip
            .data()
            .speeds
            .iter()
            .filter(|speed| speed.conversion_us.is_none_or(|us| us < 100_000))
        {
            let wired = [Wired {
                samples: Some(speed.samples),
                ..Wired::on_channel(*chip, 3)
            }];
            let (_, mut sensor) = sensor(&wired, AIR, &[]);
            check_readings(&wired, &mut sensor, &AIR);
        }
    }
}

/// Three kinds behind two switches, and one on the bus itself.
fn mixed() -> Vec<Wired> {
    let behind = |chip: Chip, address: u8, switch: u8, channel: u8| Wired {
        chip,
        address,
        behind: SwitchAddress::new(switch).map(|switch| (switch, channel)),
        samples: None,
    };
    vec![
        behind(Chip::Cps135b, 0x6D, 0x70, 0),
        behind(Chip::Ms5837_30Ba, 0x76, 0x70, 1),
        behind(Chip::Bmp390, 0x76, 0x70, 2),
        behind(Chip::Bmp390, 0x77, 0x70, 2),
        behind(Chip::Cps135b, 0x6D, 0x72, 0),
        behind(Chip::Ms5837_30Ba, 0x76, 0x72, 1),
        behind(Chip::Bmp390, 0x77, 0x72, 7),
        Wired {
            chip: Chip::Lps22hb,
            address: 0x5D,
            behind: None,
            samples: None,
        },
    ]
}

#[test]
fn kinds_are_mixed_on_one_bus_with_two_switches() {
    let (_, mut sensor) = sensor(&mixed(), AIR, &[]);
    check_readings(&mixed(), &mut sensor, &AIR);
}

#[test]
fn sixty_four_taxels_are_read() {
    let wired: Vec<Wired> = (0..64)
        .map(|taxel| Wired {
            behind: SwitchAddress::new(0x70 + taxel / 8).map(|switch| (switch, taxel % 8)),
            ..Wired::on_channel(Chip::Mpl3115a2, 0)
        })
        .collect();
    let felt = || Felt {
        step_kpa: 0.01,
        ..AIR
    };
    let (_, mut sensor) = sensor(&wired, felt(), &[]);
    check_readings(&wired, &mut sensor, &felt());
}

#[test]
fn the_rate_that_is_stated_is_met() {
    let mut boards: Vec<Vec<Wired>> = Chip::ALL.iter().map(|chip| eight(*chip)).collect();
    boards.push(mixed());
    for wired in boards {
        let (clock, mut sensor) = sensor(&wired, AIR, &[]);
        let budget = Budget::new(sensor.settings(), 400_000);
        sensor.frame().unwrap();
        let begun_s = clock.now_s();
        for _ in 0..160 {
            sensor.frame().unwrap();
        }
        let rate_hz = 160.0 / (clock.now_s() - begun_s);
        let ratio = rate_hz / f64::from(budget.rate_hz());
        assert!(
            (0.97..1.05).contains(&ratio),
            "{}: {rate_hz} Hz, stated {}",
            wired[0].chip,
            budget.rate_hz()
        );
    }
}

#[test]
fn temperature_that_is_converted_apart_is_never_older_than_sixteen_frames() {
    for chip in [Chip::Ms5837_30Ba, Chip::Dps310] {
        let felt = Felt {
            warms_k_per_s: 1.0,
            ..AIR
        };
        let (clock, mut sensor) = sensor(&eight(chip), felt, &[]);
        for _ in 0..60 {
            let begun_s = clock.now_s();
            let frame = sensor.frame().unwrap();
            let frame_s = clock.now_s() - begun_s;
            let shown_c = f64::from(frame.taxels[0].unwrap().temperature_c);
            let late_k = 31.0 + clock.now_s() - shown_c;
            assert!(
                (-0.02..18.0 * frame_s + 0.1).contains(&late_k),
                "{chip}: {late_k} K late, frames of {frame_s} s"
            );
        }
    }
}

/// The faults of a taxel in the frames after a fault begins, each kind once.
fn faults_of(chip: Chip, what: FaultKind, lasts: Option<Moment>) -> Vec<Fault> {
    let begins = Moment::TimeS(1.0);
    let fault = ScheduledFault { what, begins, lasts };
    let (clock, mut sensor) = sensor(&eight(chip), AIR, &[fault]);
    let mut found = Vec::new();
    while clock.now_s() < 2.5 {
        let Ok(frame) = sensor.frame() else { continue };
        for (taxel, fault) in frame.faults() {
            assert_eq!(taxel, 5, "{chip}: {fault}");
            assert!(clock.now_s() >= 1.0, "{chip}: {fault}");
            if !found.contains(&fault) {
                found.push(fault);
            }
        }
        let pressure_pa = pressures_pa(&frame)[5];
        if let Ok(pressure_pa) = pressure_pa {
            let off_pa = f64::from(pressure_pa) - 1000.0 * AIR.pressure_kpa(5);
            let most_pa = 6.0 * noise_pa(&eight(chip)[5]) + 2.0;
            assert!(
                off_pa.abs() < most_pa,
                "{chip}: {off_pa} Pa off without a fault at {} s",
                clock.now_s()
            );
        }
    }
    let frame = sensor.frame().unwrap();
    let is_over = lasts.is_some() || !what.lasts();
    if is_over && !matches!(what, FaultKind::LostCalibration { .. }) {
        assert!(
            frame.taxels[5].is_ok(),
            "{chip} does not come back: {:?}",
            frame.taxels[5]
        );
    }
    found
}

#[test]
fn a_chip_that_goes_away_is_missing_and_comes_back() {
    let away = FaultKind::NoAcknowledge { channel: Some(5) };
    for chip in Chip::ALL {
        assert_eq!(
            faults_of(*chip, away, Some(Moment::TimeS(0.5))),
            [Fault::Missing],
            "{chip}"
        );
    }
}

#[test]
fn a_chip_whose_conversion_does_not_end_is_stuck() {
    let endless = FaultKind::EndlessConversion { channel: 5 };
    for chip in Chip::ALL {
        assert_eq!(
            faults_of(*chip, endless, Some(Moment::TimeS(0.5))),
            [Fault::Stuck],
            "{chip}"
        );
    }
}

/// A chip that lost its power gives no wrong reading: its next sample is as good as any, or it
/// reports that it has none.
#[test]
fn a_chip_that_loses_its_power_gives_no_wrong_number() {
    let power = FaultKind::BarometerBrownOut { channel: 5 };
    for chip in Chip::ALL {
        let found = faults_of(*chip, power, None);
        let allowed = [Fault::Stuck, Fault::Restarted];
        assert!(
            found.iter().all(|fault| allowed.contains(fault)),
            "{chip}: {found:?}"
        );
    }
    // These chips need the settings that were lost, and report the loss.
    for chip in [Chip::Mpl3115a2, Chip::Bmp581, Chip::Bmp585, Chip::Dps310] {
        assert_eq!(faults_of(chip, power, None), [Fault::Restarted], "{chip}");
    }
}

#[test]
fn a_calibration_that_is_lost_is_named_when_the_chip_is_switched_on() {
    let lost = FaultKind::LostCalibration { channel: 5 };
    let kept_apart = [Chip::Cps135b, Chip::Mpl3115a2, Chip::Lps22hb]; // their calibration is internal and cannot be read
    for chip in Chip::ALL.iter().filter(|chip| !kept_apart.contains(chip)) {
        let fault = ScheduledFault {
            what: lost,
            begins: Moment::Count(0),
            lasts: None,
        };
        let (_, mut sensor) = sensor(&eight(*chip), AIR, &[fault]);
        let frame = sensor.frame().unwrap_or_else(|error| panic!("{chip}: {error}"));
        assert!(
            frame.faults().eq([(5, Fault::Uncalibrated)]),
            "{chip}: {:?}",
            frame.taxels[5]
        );
    }
}

#[test]
fn another_chip_at_the_address_is_told_from_the_one_described() {
    let address_of = |chip: Chip| chip.data().addresses;
    for described in Chip::ALL {
        for soldered in Chip::ALL.iter().filter(|soldered| *soldered != described) {
            let Some(shared) = address_of(*described)
                .iter()
                .find(|address| address_of(*soldered).contains(address))
            else {
                continue;
            };
            let twins = [Chip::Bmp384, Chip::Bmp388];
            if twins.contains(described) && twins.contains(soldered) {
                continue; // they have one identity and are read in the same way
            }
            let at = |chip: Chip| Wired {
                address: *shared,
                ..Wired::on_channel(chip, 0)
            };
            let others = || (1..4).map(|channel| Wired::on_channel(Chip::Cps135b, channel));
            let with = |chip: Chip| -> Vec<Wired> { std::iter::once(at(chip)).chain(others()).collect() };
            let (_, mut sensor) = on_the_bench(&with(*described), &with(*soldered), AIR, &[]);
            let frame = sensor.frame().unwrap();
            let found: Vec<_> = frame.faults().collect();
            assert!(
                matches!(
                    found[..],
                    [(
                        0,
                        Fault::WrongChip | Fault::Uncalibrated | Fault::Missing | Fault::Stuck
                    )]
                ),
                "{soldered} in place of {described}: {found:?}"
            );
        }
    }
}

#[test]
fn what_is_beyond_a_chips_range_is_saturated_and_not_held_at_its_end() {
    for chip in Chip::ALL.iter().filter(|chip| chip.data().knows_its_scale) {
        let beyond = f64::from(chip.data().range_pa[1]) * 1.02e-3;
        let felt = Felt {
            first_kpa: beyond - 4.0 * 0.05 * beyond,
            step_kpa: 0.05 * beyond,
            warms_k_per_s: 0.0,
        };
        let (_, mut sensor) = sensor(&eight(*chip), felt, &[]);
        let read = pressures_pa(&sensor.frame().unwrap());
        let saturated = read.iter().map(|taxel| *taxel == Err(Fault::Saturated));
        assert!(
            saturated.eq([false, false, false, false, true, true, true, true]),
            "{chip}: {read:?}"
        );
    }
}

#[test]
fn an_address_conflict_on_the_bus_itself_is_noticed_when_switched_on() {
    for chip in Chip::ALL {
        let mut soldered = eight(*chip);
        soldered.push(Wired {
            behind: None,
            ..soldered[0]
        });
        let (_, mut sensor) = on_the_bench(&eight(*chip), &soldered, AIR, &[]);
        let address = chip.data().addresses[0];
        assert_eq!(sensor.frame(), Err(Error::AddressConflict { address }), "{chip}");
    }
}
