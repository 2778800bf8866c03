//! The chips of the taxels and their locations on the bus.

#![allow(clippy::unwrap_used)] // also in the helpers of tests

use phystac::Chip;
use twintac_sensor::{Sensor, SensorError};

const SENSOR: &str = r#"
name = "mixed"
summary = "Two chips behind a switch, one behind another, one on the bus itself"
source = "a test"

[gel.solid]
kind = "block"
size_mm = [20.0, 10.0, 6.0]

[gel.material]
shear_modulus_kpa = 15.0
poissons_ratio = 0.49
source = "a test"

[readout]
min_kpa = 30.0
max_kpa = 125.0
resolution_kpa = 0.01
rate_hz = 50.0
chip = "BMP390"

[[taxels]]
name = "a"
position_mm = [0.0, 0.0, 0.0]
port_radius_mm = 0.5
channel = 2

[[taxels]]
name = "b"
position_mm = [2.0, 0.0, 0.0]
port_radius_mm = 0.5
channel = 2
address = 0x77
samples = 4

[[taxels]]
name = "c"
position_mm = [4.0, 0.0, 0.0]
port_radius_mm = 0.5
chip = "ms5837-30ba"
switch = 0x71
channel = 2

[[taxels]]
name = "d"
position_mm = [6.0, 0.0, 0.0]
port_radius_mm = 0.5
chip = "LPS22HB"

[[indenters]]
name = "ball"
shape = { kind = "sphere", radius_mm = 5.0 }
"#;

fn parse(text: &str) -> Result<Sensor, SensorError> {
    Sensor::parse("mixed.toml", text, &|name| {
        Err(std::io::Error::other(name.to_owned()))
    })
}

fn error_with(from: &str, to: &str) -> String {
    let text = SENSOR.replacen(from, to, 1);
    assert_ne!(text, SENSOR);
    parse(&text).unwrap_err().to_string()
}

#[test]
fn a_description_says_where_each_chip_is() {
    let sensor = parse(SENSOR).unwrap();
    let wired: Vec<_> = sensor.wiring().unwrap().taxels().collect();
    let seen = wired.iter().map(|wired| {
        let behind = wired.behind.map(|(switch, channel)| (switch.get(), channel));
        (wired.chip, wired.address, behind, wired.samples)
    });
    let expected = [
        (Chip::Bmp390, 0x76, Some((0x70, 2)), None),
        (Chip::Bmp390, 0x77, Some((0x70, 2)), Some(4)),
        (Chip::Ms5837_30Ba, 0x76, Some((0x71, 2)), None),
        (Chip::Lps22hb, 0x5C, None, None),
    ];
    assert!(seen.eq(expected), "{wired:?}");
    assert!(!sensor.has_unscaled_chips());
}

#[test]
fn what_cannot_be_wired_is_an_error_of_the_field() {
    for (from, to, expected) in [
        (
            "chip = \"BMP390\"",
            "chip = \"BMP280\"",
            "`readout.chip` is `BMP280`, which cannot be read; give one of CPS135B,",
        ),
        ("chip = \"LPS22HB\"", "chip = \"\"", "`taxels[3].chip` is ``"),
        (
            "address = 0x77",
            "address = 0x75",
            "`taxels[1].address` cannot be: 0x75 is not an address of a BMP390",
        ),
        (
            "address = 0x77\n",
            "",
            "`taxels[1].channel` is 2, the same as that of taxels[0], whose chip has the same address",
        ),
        (
            "switch = 0x71\nchannel = 2",
            "channel = 2",
            "`taxels[2].channel` is 2, the same as that of taxels[0]",
        ),
        (
            "switch = 0x71\nchannel = 2",
            "switch = 0x71",
            "`taxels[2].switch` is given without a channel",
        ),
        ("switch = 0x71", "switch = 0x6F", "`taxels[2].switch` is 0x6f"),
        (
            "switch = 0x71",
            "switch = 0x76",
            "`taxels[2].address` cannot be: a switch has the address of a barometer",
        ),
        (
            "channel = 2\naddress",
            "channel = 8\naddress",
            "`taxels[1].channel` cannot be: 8 is not a channel of a switch",
        ),
        (
            "samples = 4",
            "samples = 3",
            "`taxels[1].samples` cannot be: a BMP390 cannot average over 3 samples",
        ),
        (
            "chip = \"LPS22HB\"",
            "chip = \"BMP388\"",
            "`taxels[3].channel` is wrong: this taxel or taxels[0] is not behind a switch",
        ),
        (
            "rate_hz = 50.0",
            "rate_hz = 50.0\ncounts_per_pa = 8",
            "`readout.counts_per_pa` is given, but the scale of the chips is known",
        ),
    ] {
        let error = error_with(from, to);
        assert!(error.contains(expected), "{to}: {error}");
    }
}

#[test]
fn a_sensor_that_is_not_read_over_i2c_needs_no_wiring() {
    let mut text = SENSOR.to_owned();
    for line in [
        "chip = \"BMP390\"\n",
        "channel = 2\n",
        "address = 0x77\n",
        "switch = 0x71\n",
        "chip = \"ms5837-30ba\"\n",
        "chip = \"LPS22HB\"\n",
    ] {
        text = text.replace(line, "");
    }
    assert!(!parse(&text).unwrap().is_wired());
}
