//! What data sheets say of a chip.

/// What is known of a chip.
#[derive(Debug)]
pub struct ChipData {
    /// The manufacturer's name for it.
    pub name: &'static str,
    /// The 7-bit addresses that it can have.
    pub addresses: &'static [u8],
    /// The pressures that it measures, Pa: what is beyond is [`Fault::Saturated`](crate::Fault::Saturated).
    pub range_pa: [f32; 2],
    /// What it can do, the quickest first.
    pub speeds: &'static [Speed],
    /// [`Speed::samples`] where nobody asks for others. `None`: as it wakes up.
    pub usual_samples: Option<u16>,
    /// Whether it says itself what it counts: of others a [`Transfer`](crate::Transfer) must be confirmed.
    pub knows_its_scale: bool,
    /// What its register of identity holds; 0 where it has none.
    pub(super) identity: u8,
    /// What its answer costs on the bus.
    pub(crate) cost: Cost,
}

/// How often a chip samples for one pressure, and what that costs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Speed {
    /// Samples that make one pressure.
    pub samples: u16,
    /// The longest time that a conversion takes, µs. `None`: not published.
    pub conversion_us: Option<u32>,
    /// Noise, Pa rms. `None`: not published.
    pub noise_pa: Option<f32>,
    /// What the chip is told for it.
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

/// What a chip costs on the bus.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cost {
    /// Bytes of the command that starts a conversion, its address not counted.
    pub(crate) command: u32,
    /// Clocks of what is read at the end of a conversion.
    pub(crate) collect_clocks: u32,
    /// Whether temperature is a conversion of its own.
    pub(crate) is_temperature_apart: bool,
}

impl Cost {
    /// Clocks of a read of so many bytes from a register: address, register; address, bytes.
    pub(crate) const fn read_clocks(bytes: u32) -> u32 {
        9 * (3 + bytes) + 3
    }
}

impl ChipData {
    /// The speed with so many samples; without a number the usual one. `None`: the chip cannot.
    pub(crate) fn speed(&self, samples: Option<u16>) -> Option<Option<Speed>> {
        let Some(samples) = samples.or(self.usual_samples) else {
            return Some(None);
        };
        let found = self.speeds.iter().find(|speed| speed.samples == samples);
        found.map(|speed| Some(*speed))
    }
}
