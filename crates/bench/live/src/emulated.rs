//! The emulated sensor, pressed by a moving ball, for trials without hardware.

use std::f64::consts::{PI, TAU};

use glam::DVec3;
use phystac::{PhysTac, Wired};
use twintac_emulate::i2c::{BarometerSettings, Board, BoardSettings, Bus, PartSettings};
use twintac_emulate::robot::ArmSettings;
use twintac_emulate::{Hertz, LabClock, Physics, ScheduledFault, Sensed, Workcell};
use twintac_rig::TcpPose;
use twintac_sensor::Sensor;
use twintac_source::{BoxedClock, TAXELS, driver_settings, emulated_scale, full_scale_kpa};

use crate::LiveError;

/// A ball that moves over the taxels and presses every few seconds. It is a function of time alone.
#[derive(Clone, Debug)]
struct WanderingBall {
    hertz: Hertz,
    middle_mm: DVec3,
    half_mm: DVec3,
}

impl WanderingBall {
    /// Time without contact before the first press, s: time to take a tare.
    const FREE_S: f64 = 1.0;
    /// Time of a press, from touch to touch, s.
    const PRESS_S: f64 = 3.0;
    /// Time of one round over the taxels, s.
    const ROUND_S: f64 = 19.0;
    /// Depth in the middle of a press, mm.
    const DEPTH_MM: f64 = 2.0;

    /// A ball over a sensor's taxels. Their positions become those of the physics.
    fn over(sensor: &Sensor) -> Self {
        let hertz = Hertz {
            taxels_mm: sensor
                .taxels
                .iter()
                .map(|taxel| taxel.position_mm.with_z(0.0))
                .collect(),
            ..Hertz::default()
        };
        let least = hertz.taxels_mm.iter().copied().fold(DVec3::INFINITY, DVec3::min);
        let most = hertz
            .taxels_mm
            .iter()
            .copied()
            .fold(DVec3::NEG_INFINITY, DVec3::max);
        Self {
            hertz,
            middle_mm: 0.5 * (least + most),
            half_mm: 0.5 * (most - least),
        }
    }

    /// Position of the ball's lowest point, mm. The surface at rest is z = 0.
    fn tip_mm(&self, time_s: f64) -> DVec3 {
        let pressing_s = (time_s - Self::FREE_S).max(0.0);
        let (sine, cosine) = (TAU * pressing_s / Self::ROUND_S).sin_cos();
        let depth_mm = Self::DEPTH_MM * (PI * pressing_s / Self::PRESS_S).sin().powi(2);
        self.middle_mm + self.half_mm * DVec3::new(cosine, sine, 0.0) + depth_mm * DVec3::NEG_Z
    }
}

impl Physics for WanderingBall {
    fn at(&mut self, tool: &TcpPose, time_s: f64) -> Sensed {
        let tip = TcpPose {
            position_mm: self.tip_mm(time_s),
            ..*tool
        };
        self.hertz.at(&tip, time_s)
    }
}

/// The driver of an emulated sensor.
pub type EmulatedPhysTac = PhysTac<Bus, LabClock, BoxedClock, TAXELS>;

/// A sensor as described, on [`emulated_board`], pressed by a ball that moves over its taxels, with
/// faults of its bus. Its clock must stand at zero. There is neither robot nor force sensor.
///
/// # Errors
/// The sensor cannot be read by this driver; a fault is not valid.
pub fn emulated_phystac(
    sensor: &Sensor,
    clock: LabClock,
    faults: &[ScheduledFault],
) -> Result<EmulatedPhysTac, LiveError> {
    let settings = driver_settings(sensor)?;
    let nowhere = TcpPose {
        position_mm: DVec3::ZERO,
        roll_pitch_yaw_rad: DVec3::new(PI, 0.0, 0.0),
    };
    let ball = WanderingBall::over(sensor);
    let workcell = Workcell::new(clock.clone(), ball, nowhere, ArmSettings::default());
    let board = Board::new(workcell, &emulated_board(sensor), faults)?;
    let now = clock.clone();
    let now: BoxedClock = Box::new(move || now.now_us());
    Ok(PhysTac::new(board.bus(), clock, now, settings))
}

/// The emulated board of a sensor: the chips that the description names. A CPS135B has the scale
/// that the description confirms, else the finest scale that reaches the description's range.
#[must_use]
pub fn emulated_board(sensor: &Sensor) -> BoardSettings {
    let readout = &sensor.readout;
    let counts_per_pa = readout.counts_per_pa.unwrap_or_else(|| emulated_scale(sensor));
    let barometer = match readout.transfer {
        Some(transfer) => BarometerSettings {
            counts_per_pa: 1.0 / transfer.pa_per_count,
            offset_pa: transfer.offset_pa,
            is_signed: transfer.signed,
            ..BarometerSettings::default()
        },
        None => BarometerSettings {
            counts_per_pa: f64::from(counts_per_pa),
            is_signed: full_scale_kpa(counts_per_pa, true) >= readout.max_kpa,
            ..BarometerSettings::default()
        },
    };
    BoardSettings {
        parts: sensor.wiring().map_or(Vec::new(), |wiring| {
            wiring.taxels().map(|wired| part(&wired)).collect()
        }),
        barometer,
        ..BoardSettings::default()
    }
}

fn part(wired: &Wired) -> PartSettings {
    PartSettings {
        chip: wired.chip.to_string(),
        address: Some(wired.address),
        switch: wired.behind.map(|(switch, _)| switch.get()),
        channel: wired.behind.map_or(0, |(_, channel)| channel),
    }
}
