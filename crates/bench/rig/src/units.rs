//! Units of force and torque, as force sensors name them.

/// Newtons per unit of force, by the name of the unit in sensors and calibration files.
pub(crate) fn newtons(unit: &str) -> Option<f64> {
    Some(match plain(unit).as_str() {
        "n" | "newton" | "newtons" => 1.0,
        "kn" => 1000.0,
        "lbf" | "lb" => POUND_N,
        "klbf" | "klb" => 1000.0 * POUND_N,
        "kgf" | "kg" => KILOGRAM_N,
        "gf" | "g" => KILOGRAM_N / 1000.0,
        _ => return None,
    })
}

/// Newton millimetres per unit of torque, by the name of the unit in sensors and calibration files.
pub(crate) fn newton_millimetres(unit: &str) -> Option<f64> {
    Some(match plain(unit).as_str() {
        "nm" | "newtonmeter" | "newtonmeters" => 1000.0,
        "nmm" => 1.0,
        "knm" => 1e6,
        "lbfin" | "inlbf" | "lbin" | "inlb" => POUND_N * INCH_MM,
        "lbfft" | "ftlbf" | "lbft" | "ftlb" => POUND_N * 12.0 * INCH_MM,
        "kgfcm" | "kgcm" => KILOGRAM_N * 10.0,
        _ => return None,
    })
}

/// One pound-force and, below, one kilogram-force, N. Both are exact by definition (BIPM, The
/// International System of Units).
const POUND_N: f64 = 4.448_221_615_260_5;
const KILOGRAM_N: f64 = 9.806_65;
const INCH_MM: f64 = 25.4;

/// The letters alone, in lower case: `N-m`, `N·m` and `Nm` are the same unit.
fn plain(unit: &str) -> String {
    unit.chars()
        .filter(|c| c.is_ascii_alphabetic())
        .map(|c| c.to_ascii_lowercase())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_known_however_they_are_written() {
        assert_eq!(newtons("N"), Some(1.0));
        assert_eq!(newtons("lbf"), Some(4.448_221_615_260_5));
        assert_eq!(newtons("stone"), None);
        for name in ["Nm", "N-m", "N·m", " N m "] {
            assert_eq!(newton_millimetres(name), Some(1000.0), "{name}");
        }
        assert_eq!(newton_millimetres("N-mm"), Some(1.0));
        // One pound-force inch is 0.112 984 829 N m.
        assert!((newton_millimetres("lbf-in").unwrap() - 112.984_829).abs() < 1e-6);
        assert_eq!(newton_millimetres(""), None);
    }
}
