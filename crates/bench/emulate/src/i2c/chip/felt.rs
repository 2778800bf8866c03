//! Pressure, temperature and time at a chip.

/// The pressure and temperature at a chip.
#[derive(Clone, Copy, Debug)]
pub(in crate::i2c) struct Felt {
    /// Absolute pressure, Pa.
    pub(in crate::i2c) pressure_pa: f64,
    /// Temperature, °C.
    pub(in crate::i2c) temperature_c: f64,
}

/// A moment of a chip.
pub(in crate::i2c) struct Now<'a> {
    /// Time of the emulator's clock, ns.
    pub(in crate::i2c) ns: u64,
    /// Whether conversions do not end.
    pub(in crate::i2c) is_endless: bool,
    /// Pressure and temperature at the chip at a time of the emulator's clock, ns.
    pub(in crate::i2c) felt: &'a dyn Fn(u64) -> Felt,
}
