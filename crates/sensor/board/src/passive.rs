//! Capacitors, resistors, jumpers and test pads.

use crate::device::{Device, Electrical, Pin, pins};
use crate::land::{Land, Pad};
use crate::shapes::Area;

fn area(half_x: f64, half_y: f64) -> Area {
    Area::about(glam::DVec2::ZERO, [half_x, half_y].into())
}

fn two_pins() -> Vec<Pin> {
    let side = |is_left, number, name| pins(is_left, &[(number, name, Electrical::Passive)]);
    [side(true, "1", "1"), side(false, "2", "2")].concat()
}

fn chip_land(
    name: &'static str,
    description: &'static str,
    pads: [f64; 3],
    room: [f64; 2],
    body: [f64; 3],
) -> Land {
    let [at, along, across] = pads;
    Land {
        name,
        description,
        pads: vec![
            Pad::new("1", [-at, 0.0], [along, across]),
            Pad::new("2", [at, 0.0], [along, across]),
        ],
        courtyard: area(room[0], room[1]),
        body: area(0.5 * body[0], 0.5 * body[1]),
        height_mm: body[2],
        silk: Vec::new(),
        bridge: None,
        is_placed: true,
    }
}

/// 100 nF, 0402: close to each chip.
pub(crate) fn capacitor_100n() -> Device {
    Device {
        symbol: "C",
        prefix: "C",
        pins: two_pins(),
        land: chip_land(
            "C_0402",
            "Capacitor 0402 (1005 metric), pads as in KiCad's library",
            [0.48, 0.56, 0.62],
            [0.91, 0.46],
            [1.0, 0.5, 0.55],
        ),
        bought: Some("capacitor-100nF-0402"),
    }
}

/// 10 uF, 0603: at the supply.
pub(crate) fn capacitor_10u() -> Device {
    Device {
        symbol: "C",
        prefix: "C",
        pins: two_pins(),
        land: chip_land(
            "C_0603",
            "Capacitor 0603 (1608 metric), pads as in KiCad's library",
            [0.775, 0.9, 0.95],
            [1.48, 0.73],
            [1.6, 0.8, 0.9],
        ),
        bought: Some("capacitor-10uF-0603"),
    }
}

/// 10 kOhm, 0402: pull-ups.
pub(crate) fn resistor_10k() -> Device {
    Device {
        symbol: "R",
        prefix: "R",
        pins: two_pins(),
        land: chip_land(
            "R_0402",
            "Resistor 0402 (1005 metric), pads as in KiCad's library",
            [0.51, 0.54, 0.64],
            [0.93, 0.47],
            [1.0, 0.5, 0.4],
        ),
        bought: Some("resistor-10kOhm-0402"),
    }
}

/// A solder jumper for an address pin: the pin in the middle, ground at one end, the supply at the
/// other. Copper connects the pin to one of them until it is cut.
pub(crate) fn address_jumper(is_high: bool) -> Device {
    let (name, symbol, joined, middle) = if is_high {
        ("Jumper_3_Bridged23", "Jumper_3_Bridged23", ["2", "3"], 0.55)
    } else {
        ("Jumper_3_Bridged12", "Jumper_3_Bridged12", ["1", "2"], -0.55)
    };
    let mut pads = vec![
        Pad::new("1", [-1.1, 0.0], [0.8, 1.2]),
        Pad::new("2", [0.0, 0.0], [0.8, 1.2]),
        Pad::new("3", [1.1, 0.0], [0.8, 1.2]),
    ];
    pads.iter_mut().for_each(|pad| pad.has_paste = false);
    Device {
        symbol,
        prefix: "JP",
        pins: [
            pins(true, &[("1", "GND", Electrical::Passive)]),
            pins(
                false,
                &[("2", "A", Electrical::Passive), ("3", "VCC", Electrical::Passive)],
            ),
        ]
        .concat(),
        land: Land {
            name,
            description: "Solder jumper of three pads, two of them joined by copper 0.3 mm wide that a knife can cut",
            pads,
            courtyard: area(1.75, 0.85),
            body: area(1.5, 0.6),
            height_mm: 0.0,
            silk: Vec::new(),
            bridge: Some((joined, Area::about([middle, 0.0].into(), [0.17, 0.15].into()))),
            is_placed: false,
        },
        bought: None,
    }
}

/// A bare pad of 1.2 mm, for a probe or a wire.
pub(crate) fn test_pad() -> Device {
    let mut pad = Pad::new("1", [0.0, 0.0], [1.2, 1.2]);
    (pad.is_round, pad.has_paste) = (true, false);
    Device {
        symbol: "TestPad",
        prefix: "TP",
        pins: pins(true, &[("1", "1", Electrical::Passive)]),
        land: Land {
            name: "TestPad_D1.2mm",
            description: "Bare round pad, 1.2 mm",
            pads: vec![pad],
            courtyard: area(0.85, 0.85),
            body: area(0.6, 0.6),
            height_mm: 0.0,
            silk: Vec::new(),
            bridge: None,
            is_placed: false,
        },
        bought: None,
    }
}
