//! Colours: roles that a page can restyle for a dark screen, a palette for series, and a scale for
//! maps.

/// The role of a mark, which determines its colour. A page restyles roles on a dark screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ink {
    /// Titles and values.
    Text,
    /// Axis labels, notes, reference lines.
    Muted,
    /// Grid lines and frames.
    Grid,
    /// The background.
    Paper,
    /// Measurements of the sensor.
    Sensor,
    /// Predictions of the twin.
    Twin,
    /// Another series, by number; the colours repeat after the length of [`PALETTE`].
    Series(usize),
    /// An exact colour, for maps.
    Rgb([u8; 3]),
}

/// Colours that colour-blind readers can distinguish (Okabe and Ito 2008), without the yellow,
/// which is too pale.
pub const PALETTE: [[u8; 3]; 6] = [
    [0, 114, 178],
    [230, 159, 0],
    [0, 158, 115],
    [204, 121, 167],
    [86, 180, 233],
    [213, 94, 0],
];

impl Ink {
    /// The colour on white paper.
    pub(crate) fn rgb(self) -> [u8; 3] {
        match self {
            Ink::Text => [0x1d, 0x27, 0x30],
            Ink::Muted => [0x5f, 0x6c, 0x78],
            Ink::Grid => [0xe3, 0xe8, 0xec],
            Ink::Paper => [0xff, 0xff, 0xff],
            Ink::Sensor => [0x9a, 0xa8, 0xb5],
            Ink::Twin => [0xd1, 0x49, 0x1b],
            Ink::Series(index) => PALETTE[index % PALETTE.len()],
            Ink::Rgb(rgb) => rgb,
        }
    }

    /// The colour as `#rrggbb`.
    pub(crate) fn hex(self) -> String {
        let [red, green, blue] = self.rgb();
        format!("#{red:02x}{green:02x}{blue:02x}")
    }
}

/// Seventeen evenly spaced colours of the perceptually uniform scale *viridis* (van der Walt and
/// Smith 2015, CC0). Linear interpolation between them stays within five units of 255 of the
/// original.
pub(crate) const VIRIDIS: [[u8; 3]; 17] = [
    [68, 1, 84],
    [72, 24, 106],
    [71, 45, 123],
    [66, 64, 134],
    [59, 82, 139],
    [51, 99, 141],
    [44, 114, 142],
    [38, 130, 142],
    [33, 145, 140],
    [31, 160, 136],
    [40, 174, 128],
    [63, 188, 115],
    [94, 201, 98],
    [132, 212, 75],
    [173, 220, 48],
    [216, 226, 25],
    [253, 231, 37],
];

/// The map colour at `fraction` of the scale: dark blue at 0, yellow at 1. NaN gives mid grey.
pub fn viridis(fraction: f64) -> [u8; 3] {
    if fraction.is_nan() {
        return [0x99, 0x99, 0x99];
    }
    let place = fraction.clamp(0.0, 1.0) * (VIRIDIS.len() - 1) as f64;
    let below = (place as usize).min(VIRIDIS.len() - 2);
    let part = place - below as f64;
    [0, 1, 2].map(|channel| {
        let (low, high) = (
            f64::from(VIRIDIS[below][channel]),
            f64::from(VIRIDIS[below + 1][channel]),
        );
        (low + part * (high - low)).round() as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_map_grows_lighter_all_the_way() {
        let lightness = |[red, green, blue]: [u8; 3]| {
            0.2126 * f64::from(red) + 0.7152 * f64::from(green) + 0.0722 * f64::from(blue)
        };
        let steps: Vec<f64> = (0..=100)
            .map(|step| lightness(viridis(f64::from(step) / 100.0)))
            .collect();
        assert!(steps.windows(2).all(|pair| pair[1] > pair[0]));
    }

    #[test]
    fn what_is_off_the_scale_takes_its_end_and_no_number_is_grey() {
        assert_eq!(viridis(-3.0), viridis(0.0));
        assert_eq!(viridis(f64::INFINITY), viridis(1.0));
        assert_eq!(viridis(f64::NAN), [0x99, 0x99, 0x99]);
    }
}
