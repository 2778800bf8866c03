//! The rate of rounds, and their reports of faults, in virtual time.

#![allow(clippy::unwrap_used)] // also in the helpers of tests

use phystac::{Budget, Chip, TaxelState};
use twintac_emulate::{FaultKind, Hertz, LabClock, Moment, ScheduledFault};
use twintac_firmware::{Form, LineBudget, Report, Trouble};
use twintac_microcontroller::{Microcontroller, N_TAXELS, Setup};

fn board(setup: &Setup) -> Microcontroller {
    Microcontroller::new(LabClock::virtual_time(), Hertz::default(), setup).unwrap()
}

/// Carries out rounds until a time, s.
fn rounds_until(board: &mut Microcontroller, end_s: f64) -> Vec<Report<N_TAXELS>> {
    let mut reports = Vec::new();
    while board.clock().now_s() < end_s {
        reports.push(board.round().0);
    }
    reports
}

/// Rounds per second, from the first round to the last.
fn rate_hz(reports: &[Report<N_TAXELS>]) -> f64 {
    let (first, last) = (&reports[0], &reports[reports.len() - 1]);
    1e6 * (reports.len() - 1) as f64 / (last.triggered_us - first.triggered_us) as f64
}

fn fault(what: FaultKind, begins_s: f64, lasts_s: Option<f64>) -> ScheduledFault {
    ScheduledFault {
        what,
        begins: Moment::TimeS(begins_s),
        lasts: lasts_s.map(Moment::TimeS),
    }
}

/// Checks that a taxel that was not read has no number, and that numbers are the true pressures.
fn check(report: &Report<N_TAXELS>) {
    for taxel in &report.taxels {
        assert_eq!(
            taxel.pressure_pa.is_none(),
            taxel.state != TaxelState::Good,
            "{report:?}"
        );
        if let Some(pressure_pa) = taxel.pressure_pa {
            assert!((95_000.0..130_000.0).contains(&pressure_pa), "{report:?}");
        }
    }
}

#[test]
fn rounds_are_as_quick_as_the_budget_says() {
    for (chip, samples, conversion_us) in [
        (Chip::Cps135b, None, 6000),
        (Chip::Cps135b, None, 8000),
        (Chip::Ms5837_30Ba, Some(256), 6000),
        (Chip::Ms5837_30Ba, Some(1024), 6000),
        (Chip::Ms5837_30Ba, None, 6000), // 2048 samples
        (Chip::Ms5837_30Ba, Some(8192), 6000),
        (Chip::Ms5837_02Ba, None, 6000),
        (Chip::Bmp390, None, 6000),
    ] {
        let mut setup = Setup::of(chip);
        let wired = setup.node.sensor.wiring.taxels();
        let wired: Vec<_> = wired.map(|wired| phystac::Wired { samples, ..wired }).collect();
        setup.node.sensor.wiring = phystac::Wiring::new(&wired).unwrap();
        setup.node.sensor.conversion_us = conversion_us;
        let mut board = board(&setup);
        let reports = rounds_until(&mut board, 4.0);
        reports.iter().for_each(check);
        assert!(reports.iter().all(|report| report.trouble == Trouble::None));
        let (found_hz, budget_hz) = (
            rate_hz(&reports),
            f64::from(Budget::new(&setup.node.sensor, 400_000).rate_hz()),
        );
        println!("{chip} {samples:?} {conversion_us}: {found_hz:.1} Hz, budget {budget_hz:.1} Hz");
        assert!(
            (found_hz / budget_hz - 1.0).abs() < 0.02,
            "{chip}: {found_hz} {budget_hz}"
        );
    }
}

#[test]
fn a_rate_is_kept_and_one_that_cannot_be_is_the_most_there_is() {
    let mut board = board(&Setup::of(Chip::Ms5837_30Ba));
    board.hear(b"rate 50\n");
    let reports = rounds_until(&mut board, 4.0);
    for pair in reports[1..].windows(2) {
        let step_us = pair[1].triggered_us - pair[0].triggered_us;
        assert!((19_900..=20_100).contains(&step_us), "{step_us} µs");
    }
    board.hear(b"rate 1000\n");
    let from_s = board.clock().now_s();
    let reports = rounds_until(&mut board, from_s + 2.0);
    let found_hz = rate_hz(&reports[1..]);
    assert!((145.0..160.0).contains(&found_hz), "{found_hz}");
    let sequences: Vec<u32> = reports.iter().map(|report| report.sequence).collect();
    assert!(sequences.windows(2).all(|pair| pair[1] == pair[0] + 1));
}

#[test]
fn a_chip_that_goes_away_is_marked_alone_until_it_is_back() {
    for chip in [Chip::Cps135b, Chip::Ms5837_30Ba] {
        let mut setup = Setup::of(chip);
        setup.faults = vec![fault(
            FaultKind::NoAcknowledge { channel: Some(3) },
            1.0,
            Some(1.0),
        )];
        let mut board = board(&setup);
        let reports = rounds_until(&mut board, 3.0);
        reports.iter().for_each(check);
        for report in &reports {
            let second = report.triggered_us as f64 * 1e-6;
            let is_away = report.taxels[3].state == TaxelState::Missing;
            if (1.0..1.95).contains(&second) {
                assert!(is_away, "{second}: {report:?}");
            } else if !(0.95..2.1).contains(&second) {
                assert_eq!(report.taxels[3].state, TaxelState::Good, "{second}");
            }
            let others = report.taxels.iter().enumerate().filter(|(index, _)| *index != 3);
            assert!(
                { others }.all(|(_, taxel)| taxel.state == TaxelState::Good),
                "{report:?}"
            );
        }
    }
}

#[test]
fn a_stuck_bus_is_freed_and_the_round_says_so() {
    for (channel, is_reset_wired) in [(None, true), (Some(2), true), (None, false)] {
        let mut setup = Setup::of(Chip::Ms5837_30Ba);
        setup.faults = vec![fault(FaultKind::StuckBus { channel }, 1.0, None)];
        setup.is_reset_wired = is_reset_wired;
        let mut board = board(&setup);
        let reports = rounds_until(&mut board, 2.0);
        reports.iter().for_each(check);
        let failed: Vec<&Report<N_TAXELS>> = { reports.iter() }
            .filter(|report| report.trouble != Trouble::None)
            .collect();
        let last = reports.last().unwrap();
        println!(
            "{channel:?} {is_reset_wired}: {} rounds lost, {} resets",
            failed.len(),
            last.rescues
        );
        assert_eq!(failed.len(), 1, "{channel:?}");
        assert!(failed.iter().all(|report| report.trouble == Trouble::BusHung));
        assert!(failed.iter().all(|report| {
            report
                .taxels
                .iter()
                .all(|taxel| taxel.state == TaxelState::BusError)
        }));
        assert!(
            last.taxels.iter().all(|taxel| taxel.state == TaxelState::Good),
            "{last:?}"
        );
        assert!(last.rescues >= 1);
    }
}

#[test]
fn a_shorted_channel_is_kept_closed_and_taken_up_again() {
    let mut setup = Setup::of(Chip::Ms5837_30Ba);
    setup.faults = vec![fault(FaultKind::Short { channel: 5 }, 1.0, Some(2.0))];
    let mut board = board(&setup);
    let reports = rounds_until(&mut board, 8.0);
    reports.iter().for_each(check);
    let at = |second: f64| {
        let is_then = |report: &&Report<N_TAXELS>| report.triggered_us as f64 * 1e-6 > second;
        *reports.iter().find(is_then).unwrap()
    };
    let amid = at(1.5);
    assert_eq!(amid.taxels[5].state, TaxelState::Isolated, "{amid:?}");
    assert!(
        amid.taxels
            .iter()
            .filter(|taxel| taxel.state == TaxelState::Good)
            .count()
            == 7
    );
    assert!(at(7.5).taxels.iter().all(|taxel| taxel.state == TaxelState::Good));
}

#[test]
fn a_bus_without_a_switch_is_asked_ever_less_and_taken_up_when_it_is_back() {
    let mut setup = Setup::of(Chip::Cps135b);
    setup.faults = vec![fault(FaultKind::NoAcknowledge { channel: None }, 1.0, Some(20.0))];
    setup.form = Form::Packets;
    let mut board = board(&setup);
    let reports = rounds_until(&mut board, 24.0);
    reports.iter().for_each(check);
    let away: Vec<&Report<N_TAXELS>> = { reports.iter() }
        .filter(|report| report.trouble == Trouble::SwitchMissing)
        .collect();
    println!("{} rounds without a switch in 20 s", away.len());
    assert!((20..40).contains(&away.len()), "{}", away.len());
    for pair in away.windows(2) {
        assert!(
            pair[1].triggered_us - pair[0].triggered_us < 1_050_000,
            "the host hears of it each second"
        );
    }
    assert!(
        reports
            .last()
            .unwrap()
            .taxels
            .iter()
            .all(|taxel| taxel.state == TaxelState::Good)
    );
}

#[test]
fn a_scale_is_asked_for_and_never_guessed() {
    let mut setup = Setup::of(Chip::Cps135b);
    setup.node.transfer = None;
    setup.tool_mm[2] = 150.0; // free air
    let mut board = board(&setup);
    let mut text = String::new();
    for _ in 0..20 {
        let (report, bytes) = board.round();
        text += &String::from_utf8(bytes).unwrap();
        assert!(
            report
                .taxels
                .iter()
                .all(|taxel| taxel.state == TaxelState::Unscaled && taxel.pressure_pa.is_none())
        );
    }
    assert!(
        text.contains("# free air would be 32 counts per Pa: send `scale 32` if you agree\r\n"),
        "{text}"
    );
    board.hear(b"scale 32\n");
    let (report, _) = board.round();
    check(&report);
    assert!(report.taxels.iter().all(|taxel| taxel.state == TaxelState::Good));
}

#[test]
fn a_line_carries_what_a_bus_gives() {
    for (form, baud) in [(Form::Packets, 230_400), (Form::Csv, 1_000_000)] {
        let budget = LineBudget::of(form, N_TAXELS);
        let mut setup = Setup::of(Chip::Ms5837_30Ba);
        setup.form = form;
        let mut board = board(&setup);
        board.round(); // reports which board it is
        for _ in 0..100 {
            let (_, bytes) = board.round();
            assert!(bytes.len() <= budget.bytes(), "{form:?}: {} bytes", bytes.len());
        }
        assert!(
            budget.rate_hz(baud) > 158,
            "{form:?}: {} Hz",
            budget.rate_hz(baud)
        );
    }
}
