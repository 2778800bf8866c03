//! The barometers whose land pattern is known, or is a guess that is marked as one.

use glam::DVec2;

use crate::BoardError;
use crate::device::{Device, Electrical, pins};
use crate::land::{Land, Pad};
use crate::shapes::Area;

/// A barometer as a part of the board.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Barometer {
    /// The manufacturer's name.
    pub(crate) name: &'static str,
    pub(crate) device: Device,
    /// Size of its body, mm.
    pub(crate) body_mm: [f64; 2],
    /// Height of its port above the board, mm.
    pub(crate) height_mm: f64,
    /// Whether land pattern, pins and height come from a data sheet.
    pub(crate) is_confirmed: bool,
}

impl Barometer {
    /// The barometer with this name.
    pub(crate) fn named(name: &str) -> Result<Self, BoardError> {
        let all = [ms5837("MS5837-30BA"), ms5837("MS5837-02BA"), cps135b()];
        let known: Vec<&str> = all.iter().map(|chip| chip.name).collect();
        let known = known.join(", ");
        all.into_iter()
            .find(|chip| chip.name == name)
            .ok_or_else(|| BoardError::UnknownChip {
                name: name.to_owned(),
                known,
            })
    }
}

fn land(
    name: &'static str,
    description: &'static str,
    pads: Vec<Pad>,
    room: [f64; 2],
    body: [f64; 3],
) -> Land {
    let half = DVec2::new(0.5 * body[0], 0.5 * body[1]);
    Land {
        name,
        description,
        pads,
        courtyard: Area::about(DVec2::ZERO, room.into()),
        body: Area::about(DVec2::ZERO, half),
        height_mm: body[2],
        silk: Vec::new(),
        bridge: None,
        is_placed: true,
    }
}

/// A mark beside pin 1, at the upper left corner of the courtyard.
fn corner_mark(land: &mut Land) {
    let corner = land.courtyard.min;
    land.silk = vec![
        [[corner.x, corner.y + 0.8], [corner.x, corner.y]],
        [[corner.x, corner.y], [corner.x + 0.8, corner.y]],
    ];
}

/// TE's MS5837: data sheet REV C2 (12/2019), land pattern as in KiCad's `TE_MS5837-xxBA`.
fn ms5837(name: &'static str) -> Barometer {
    use Electrical::{Input, Supply, TwoWay};
    let pads = [
        ("1", [-1.0, -1.0]),
        ("2", [-1.0, 1.0]),
        ("3", [1.0, 1.0]),
        ("4", [1.0, -1.0]),
    ];
    let pads = pads.map(|(number, at)| Pad::new(number, at, [1.3, 1.3]));
    let (body, height_mm) = ([3.3, 3.3], 2.75);
    let mut land = land(
        "TE_MS5837-xxBA",
        "TE MS5837, four pads under a body of 3.3 mm",
        pads.to_vec(),
        [1.95, 1.95],
        [3.3, 3.3, height_mm],
    );
    corner_mark(&mut land);
    Barometer {
        name,
        device: Device {
            symbol: name,
            prefix: "U",
            pins: [
                pins(true, &[("2", "VDD", Supply), ("1", "GND", Supply)]),
                pins(false, &[("4", "SDA", TwoWay), ("3", "SCL", Input)]),
            ]
            .concat(),
            land,
            bought: Some(name),
        },
        body_mm: body,
        height_mm,
        is_confirmed: true,
    }
}

/// Consensic's CPS135B, the chip of the TwinTac paper. **To be confirmed**: no land pattern, pin
/// order or height is public. The pads are those of the related CPS123 (two rows of four, pitch
/// 0.65 mm, rows 1.45 mm apart). The pin order, the body and the height are guesses. The land
/// pattern of the chips with the same registers (XGZP6897, pads over 11.5 mm) does not fit the
/// paper's pitch of 8 mm.
fn cps135b() -> Barometer {
    use Electrical::{Input, Supply, TwoWay, Unused};
    let column = |index: u8| f64::from(index) * 0.65 - 0.975;
    let numbers = ["1", "2", "3", "4", "5", "6", "7", "8"];
    let pads = (0..8_u8).map(|index| {
        let at = if index < 4 {
            [column(index), 0.725]
        } else {
            [-column(index - 4), -0.725]
        };
        Pad::new(numbers[usize::from(index)], at, [0.35, 0.5])
    });
    let mut land = land(
        "CPS135B_to_be_confirmed",
        "TO BE CONFIRMED: pads of the sibling CPS123; no data sheet of the CPS135B is public",
        pads.collect(),
        [1.5, 1.25],
        [2.5, 2.0, 1.0],
    );
    let corner = DVec2::new(-1.5, 1.25);
    land.silk = vec![
        [[corner.x, corner.y - 0.8], [corner.x, corner.y]],
        [[corner.x, corner.y], [corner.x + 0.8, corner.y]],
    ];
    Barometer {
        name: "CPS135B",
        device: Device {
            symbol: "CPS135B",
            prefix: "U",
            pins: [
                pins(
                    true,
                    &[
                        ("1", "VDD", Supply),
                        ("4", "GND", Supply),
                        ("5", "NC5", Unused),
                        ("6", "NC6", Unused),
                    ],
                ),
                pins(
                    false,
                    &[
                        ("2", "SDA", TwoWay),
                        ("3", "SCL", Input),
                        ("7", "NC7", Unused),
                        ("8", "NC8", Unused),
                    ],
                ),
            ]
            .concat(),
            land,
            bought: Some("CPS135B"),
        },
        body_mm: [2.5, 2.0],
        height_mm: 1.0,
        is_confirmed: false,
    }
}
