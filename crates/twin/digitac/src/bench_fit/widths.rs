//! By how much benches of one description differ.

/// By how much two benches differ: standard deviations of the unknowns of a fit.
pub(super) struct BenchWidths {
    pub(super) contact_offset_mm: f64,
    pub(super) ln_stiffness: f64,
    /// Of a port's place along an axis, and of all ports' radius.
    pub(super) port_mm: f64,
    /// Of a coefficient of the smooth factor.
    pub(super) factor: f64,
}

impl BenchWidths {
    /// Mountings differ by some hundredths of a millimetre, ports of one board less; a tip that nobody documented leaves the most unknown.
    pub(super) const USUAL: Self = Self {
        contact_offset_mm: 0.05,
        ln_stiffness: 0.3,
        port_mm: 0.05,
        factor: 0.3,
    };
}
