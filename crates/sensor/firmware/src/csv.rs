//! A report as a line of text. `firmware/lines/csv-8.toml` describes it to the host.
//!
//! Fields: sequence, time in µs, pressures in Pa, temperatures in °C, fault codes, trouble, number
//! of rescues; then a `*` and the CRC-16 of CCITT (start value 0xFFFF) of all bytes before it, as
//! four hexadecimal digits. `nan` stands for a missing value.

use core::fmt::Write;

use crate::buffer::Buffer;
use crate::packet::CRC;
use crate::report::Report;

/// The largest size of a line of `n` taxels, bytes.
pub(crate) const fn line_bytes(n: usize) -> usize {
    let pressure = ",-1000000000.00".len();
    let temperature = ",-1000000000.00".len();
    "4294967295,4294967295".len() + n * (pressure + temperature + ",11".len()) + ",7,65535*FFFF\r\n".len()
}

pub(crate) fn write<const N: usize, const B: usize>(report: &Report<N>, out: &mut Buffer<B>) {
    let begin = out.len();
    let _ = write!(out, "{},{}", report.sequence, report.triggered_us as u32);
    for taxel in &report.taxels {
        number(taxel.pressure_pa, out);
    }
    for taxel in &report.taxels {
        number(taxel.temperature_c, out);
    }
    for taxel in &report.taxels {
        let _ = write!(out, ",{}", taxel.state as u8);
    }
    let _ = write!(out, ",{},{}", report.trouble as u8, report.rescues);
    let line = out.as_bytes().get(begin..).unwrap_or_default();
    let checksum = CRC.checksum(line);
    let _ = write!(out, "*{checksum:04X}\r\n");
}

/// A comma, and a number with two decimals. The standard library's formatting of floating-point
/// numbers would need as much memory as all the rest.
fn number<const B: usize>(number: Option<f32>, out: &mut Buffer<B>) {
    let Some(number) = number else {
        let _ = out.write_str(",nan");
        return;
    };
    let hundredths = f64::from(number) * 100.0;
    let hundredths = (if hundredths < 0.0 {
        hundredths - 0.5
    } else {
        hundredths + 0.5
    }) as i64;
    let sign = if hundredths < 0 { "-" } else { "" };
    let size = hundredths.unsigned_abs();
    let _ = write!(out, ",{sign}{}.{:02}", size / 100, size % 100);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_two_decimals() {
        for (value, text) in [
            (Some(101_325.0), ",101325.00"),
            (Some(-0.004), ",0.00"),
            (Some(-0.006), ",-0.01"),
            (Some(-12.345), ",-12.35"), // the nearest single-precision number is -12.3450003
            (Some(1.999), ",2.00"),
            (Some(999_999_936.0), ",999999936.00"),
            (None, ",nan"),
        ] {
            let mut out = Buffer::<32>::new();
            number(value, &mut out);
            assert_eq!(core::str::from_utf8(out.as_bytes()), Ok(text));
        }
    }
}
