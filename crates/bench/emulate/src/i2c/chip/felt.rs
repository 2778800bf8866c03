//! What is felt, and when.

/// What a chip feels.
#[derive(Clone, Copy, Debug)]
pub(in crate::i2c) struct Felt {
    /// Absolute pressure, Pa.
    pub(in crate::i2c) pressure_pa: f64,
    /// °C.
    pub(in crate::i2c) temperature_c: f64,
}

/// A moment of a chip.
pub(in crate::i2c) struct Now<'a> {
    /// The lab's clock, ns.
    pub(in crate::i2c) ns: u64,
    /// Whether conversions do not end.
    pub(in crate::i2c) is_endless: bool,
    /// What it felt, at a time of the lab's clock, ns.
    pub(in crate::i2c) felt: &'a dyn Fn(u64) -> Felt,
}
