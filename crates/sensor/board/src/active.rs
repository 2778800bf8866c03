//! The I2C switch and the connector.

use crate::device::{Device, Electrical, pins};
use crate::land::{Land, Pad};
use crate::shapes::Area;

/// Names of the switch's data pins, by channel.
pub(crate) const DATA: [&str; 8] = ["SD0", "SD1", "SD2", "SD3", "SD4", "SD5", "SD6", "SD7"];
/// Names of its clock pins, by channel.
pub(crate) const CLOCK: [&str; 8] = ["SC0", "SC1", "SC2", "SC3", "SC4", "SC5", "SC6", "SC7"];
/// Names of its address pins, lowest bit first.
pub(crate) const ADDRESS: [&str; 3] = ["A0", "A1", "A2"];

const NUMBERS: [&str; 24] = [
    "1", "2", "3", "4", "5", "6", "7", "8", "9", "10", "11", "12", "13", "14", "15", "16", "17", "18", "19",
    "20", "21", "22", "23", "24",
];

/// TCA9548A in TSSOP-24. Pins: data sheet SCPS207; land pattern: KiCad's
/// `TSSOP-24_4.4x7.8mm_P0.65mm`.
pub(crate) fn switch() -> Device {
    use Electrical::{Input, Supply, TwoWay};
    let pads = (0..24_u8).map(|index| {
        let row = f64::from(index % 12) * 0.65 - 3.575;
        let at = if index < 12 {
            [-2.8625, row]
        } else {
            [2.8625, -row]
        };
        Pad::new(NUMBERS[usize::from(index)], at, [1.475, 0.4])
    });
    let left = [
        ("24", "VCC", Supply),
        ("23", "SDA", TwoWay),
        ("22", "SCL", Input),
        ("3", "~{RESET}", Input),
        ("1", "A0", Input),
        ("2", "A1", Input),
        ("21", "A2", Input),
        ("12", "GND", Supply),
    ];
    let channels = [
        (4, 5),
        (6, 7),
        (8, 9),
        (10, 11),
        (13, 14),
        (15, 16),
        (17, 18),
        (19, 20),
    ];
    let right: Vec<_> = channels
        .into_iter()
        .enumerate()
        .flat_map(|(channel, (data, clock))| {
            [
                (NUMBERS[data - 1], DATA[channel], TwoWay),
                (NUMBERS[clock - 1], CLOCK[channel], TwoWay),
            ]
        })
        .collect();
    Device {
        symbol: "TCA9548A",
        prefix: "U",
        pins: [pins(true, &left), pins(false, &right)].concat(),
        land: Land {
            name: "TSSOP-24_4.4x7.8mm_P0.65mm",
            description: "TSSOP of 24 pins, pads as in KiCad's library",
            pads: pads.collect(),
            courtyard: Area::about([0.0, 0.0].into(), [3.85, 4.15].into()),
            body: Area::about([0.0, 0.0].into(), [2.2, 3.9].into()),
            height_mm: 1.2,
            silk: vec![
                [[-2.0, -4.03], [2.2, -4.03]],
                [[-2.2, 4.03], [2.2, 4.03]],
                [[-3.6, -4.03], [-2.4, -4.03]], // at pin 1
            ],
            bridge: None,
            is_placed: true,
        },
        bought: Some("TCA9548APWR"),
    }
}

/// JST-SH connector with four pins and side entry, in the pin order that Qwiic and STEMMA QT share.
/// Its opening is at the largest y.
pub(crate) fn connector() -> Device {
    use Electrical::Passive;
    let table = [
        ("1", "GND", Passive),
        ("2", "3V3", Passive),
        ("3", "SDA", Passive),
        ("4", "SCL", Passive),
        ("MP", "MP", Passive),
    ];
    Device {
        symbol: "Qwiic",
        prefix: "J",
        pins: pins(false, &table),
        land: Land {
            name: "JST_SH_SM04B-SRSS-TB",
            description: "JST SH, four pins, side entry, pads as in KiCad's library",
            pads: vec![
                Pad::new("1", [-1.5, -2.0], [0.6, 1.55]),
                Pad::new("2", [-0.5, -2.0], [0.6, 1.55]),
                Pad::new("3", [0.5, -2.0], [0.6, 1.55]),
                Pad::new("4", [1.5, -2.0], [0.6, 1.55]),
                Pad::new("MP", [-2.8, 1.875], [1.2, 1.8]),
                Pad::new("MP", [2.8, 1.875], [1.2, 1.8]),
            ],
            courtyard: Area::about([0.0, 0.0].into(), [3.9, 3.28].into()),
            body: Area {
                min: [-3.0, -1.675].into(),
                max: [3.0, 2.575].into(),
            },
            height_mm: 2.95,
            silk: vec![
                [[-3.11, 0.715], [-3.11, -1.785]],
                [[-3.11, -1.785], [-2.06, -1.785]],
                [[-2.06, -1.785], [-2.06, -2.775]], // at pin 1
                [[3.11, 0.715], [3.11, -1.785]],
                [[3.11, -1.785], [2.06, -1.785]],
                [[-1.94, 2.685], [1.94, 2.685]],
            ],
            bridge: None,
            is_placed: true,
        },
        bought: Some("SM04B-SRSS-TB"),
    }
}

/// Distance from the connector's centre to the end of its copper and its opening, towards the edge,
/// mm.
pub(crate) const CONNECTOR_REACH_MM: f64 = 2.775;
