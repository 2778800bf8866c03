//! Data of a chip, from its data sheet.

/// Data of a chip.
#[derive(Debug)]
pub struct ChipData {
    /// The manufacturer's name of the chip.
    pub name: &'static str,
    /// The 7-bit addresses that the chip can have.
    pub addresses: &'static [u8],
    /// The range of pressures that the chip measures, Pa. A pressure beyond is
    /// [`Fault::Saturated`](crate::Fault::Saturated).
    pub range_pa: [f32; 2],
    /// The oversampling settings of the chip, fastest first.
    pub speeds: &'static [Speed],
    /// The default for [`Speed::samples`]. `None`: the chip's own setting after power-on.
    pub usual_samples: Option<u16>,
    /// Whether the chip's output has a known scale. For other chips a [`Transfer`](crate::Transfer)
    /// must be confirmed.
    pub knows_its_scale: bool,
    /// Expected content of the identity register; 0 if the chip has none.
    pub(super) identity: u8,
    /// Bus cost of a conversion.
    pub(crate) cost: Cost,
}

/// An oversampling setting of a chip, with its time and noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Speed {
    /// Number of samples averaged for one pressure.
    pub samples: u16,
    /// The longest conversion time, µs. `None`: not published.
    pub conversion_us: Option<u32>,
    /// Noise, Pa rms. `None`: not published.
    pub noise_pa: Option<f32>,
    /// The code of this setting in the chip's register.
    pub(super) code: u8,
}

impl Speed {
    pub(super) const fn new(samples: u16, conversion_us: u32, noise_pa: Option<f32>, code: u8) -> Self {
        Self {
            samples,
            conversion_us: Some(conversion_us),
            noise_pa,
            code,
        }
    }
}

/// Bus cost of a chip.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cost {
    /// Bytes of the command that starts a conversion, without the address.
    pub(crate) command: u32,
    /// Clocks to read the result of a conversion.
    pub(crate) collect_clocks: u32,
    /// Whether temperature is a separate conversion.
    pub(crate) is_temperature_apart: bool,
}

impl Cost {
    /// Clocks to read `bytes` bytes from a register: address, register; address, bytes.
    pub(crate) const fn read_clocks(bytes: u32) -> u32 {
        9 * (3 + bytes) + 3
    }
}

impl ChipData {
    /// The setting with this number of samples; without a number the default one. Outer `None`: the
    /// chip has no such setting.
    pub(crate) fn speed(&self, samples: Option<u16>) -> Option<Option<Speed>> {
        let Some(samples) = samples.or(self.usual_samples) else {
            return Some(None);
        };
        let found = self.speeds.iter().find(|speed| speed.samples == samples);
        found.map(|speed| Some(*speed))
    }
}
