//! Reports on the line, byte by byte, and as the host reads them.

#![allow(clippy::unwrap_used)] // also in the helpers of tests

use std::path::Path;

use phystac::TaxelState;
use twintac_firmware::{Buffer, Form, Report, Taxel, Trouble, Writer, longest};
use twintac_line::{Decoder, Description, Heard, LineFrame};

const N: usize = 8;

/// A report with every special case: a time beyond 32 bits, a missing taxel, one beyond its range,
/// a negative temperature.
fn report() -> Report<N> {
    let good = |pressure_pa, temperature_c| Taxel {
        pressure_pa: Some(pressure_pa),
        temperature_c: Some(temperature_c),
        state: TaxelState::Good,
    };
    let mut taxels = [good(101_325.0, 25.0); N];
    taxels[1] = good(399_980.47, 19.81);
    taxels[2] = good(100_000.125, -7.25);
    taxels[3] = Taxel {
        state: TaxelState::Missing,
        ..Taxel::default()
    };
    taxels[4] = Taxel {
        temperature_c: Some(26.5),
        state: TaxelState::Saturated,
        ..Taxel::default()
    };
    Report {
        sequence: 259,
        triggered_us: (1 << 32) + 1_000_000,
        taxels,
        trouble: Trouble::None,
        rescues: 2,
    }
}

fn written(writer: &mut Writer<N>, report: &Report<N>) -> Vec<u8> {
    let mut bytes = Buffer::<{ longest(N) }>::new();
    writer.write(report, None, &mut bytes);
    assert!(!bytes.is_full());
    bytes.as_bytes().to_vec()
}

fn heard(name: &str, bytes: &[u8]) -> LineFrame {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../firmware/lines");
    let description = Description::read(folder.join(name)).unwrap();
    let mut frames = Vec::new();
    let mut decoder = Decoder::new(&description, N);
    decoder.push(bytes, &mut |heard| {
        if let Heard::Frame(frame) = heard {
            frames.push(frame);
        }
    });
    assert_eq!(frames.len(), 1, "{:?}", decoder.tally());
    frames.remove(0)
}

fn check(frame: &LineFrame, tolerance_kpa: f64) {
    assert_eq!((frame.sequence, frame.time_s), (Some(259), Some(1.0)));
    let pressures = [
        Some(101.325),
        Some(399.980_47),
        Some(100.000_125),
        None,
        None,
        Some(101.325),
    ];
    for (found, expected) in frame.pressures_kpa.iter().zip(pressures) {
        assert_eq!(found.is_some(), expected.is_some());
        assert!(
            (found.unwrap_or(0.0) - expected.unwrap_or(0.0)).abs() < tolerance_kpa,
            "{found:?}"
        );
    }
    let temperatures = &frame.temperatures_c[..5];
    let expected = [Some(25.0), Some(19.81), Some(-7.25), None, Some(26.5)];
    for (found, expected) in temperatures.iter().zip(expected) {
        assert_eq!(found.is_some(), expected.is_some());
        assert!(
            (found.unwrap_or(0.0) - expected.unwrap_or(0.0)).abs() < 1e-5,
            "{found:?}"
        );
    }
    assert_eq!(frame.faults[..6], [0, 0, 0, 1, 6, 0].map(Some));
}

#[test]
fn a_packet_is_these_bytes() {
    let mut writer = Writer::<N>::default();
    writer.form = Form::Packets;
    let bytes = written(&mut writer, &report());
    let hex: String = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
    assert_eq!(
        hex,
        "030301010440420f0d80e6c5478f4dc3481050c3470103c07f010fc07f80e6c54780e6c54780e6c5470107c841e17a9e410103e8c00103c07f0103d4410103c8410103c8410103c8410101030106010101020203fdca00"
    );
    assert_eq!(bytes.len(), Form::Packets.longest(N));
    check(&heard("packets-8.toml", &bytes), 4e-5); // tolerance of a single-precision number at 400 kPa
}

#[test]
fn a_line_is_these_bytes_behind_what_changed() {
    let mut writer = Writer::<N>::default();
    let mut lines = Vec::new();
    for _ in 0..3 {
        lines.push(String::from_utf8(written(&mut writer, &report())).unwrap());
    }
    let line = "259,1000000,101325.00,399980.47,100000.13,nan,nan,101325.00,101325.00,101325.00,25.00,19.81,-7.25,nan,26.50,25.00,25.00,25.00,0,0,0,1,6,0,0,0,0,2*1CA5\r\n";
    assert_eq!(lines[0], format!("# taxel 3: missing\r\n{line}"));
    assert_eq!(lines[1], format!("# taxel 4: saturated\r\n{line}"));
    assert_eq!(lines[2], line, "what was said is not said again");
    check(&heard("csv-8.toml", lines[2].as_bytes()), 4e-5);
}

#[test]
fn the_longest_line_fits() {
    let mut report = report();
    report.sequence = u32::MAX;
    report.triggered_us = u64::MAX;
    report.rescues = u16::MAX;
    report.trouble = Trouble::Other;
    report.taxels = [Taxel {
        pressure_pa: Some(-999_999_936.0),
        temperature_c: Some(-999_999_936.0),
        state: TaxelState::Unscaled,
    }; N];
    let bytes = written(&mut Writer::default(), &report);
    let line = bytes.len() - bytes.iter().position(|byte| *byte == b'\n').unwrap() - 1;
    assert!(line <= Form::Csv.longest(N), "{line}");
}
