//! Differences between test setups of one description.

/// Differences between two test setups: standard deviations of the unknowns of a fit.
pub(super) struct BenchWidths {
    pub(super) contact_offset_mm: f64,
    pub(super) ln_stiffness: f64,
    /// Of a port's location along an axis, and of the radius of all ports.
    pub(super) port_mm: f64,
    /// Of a coefficient of the correction factor.
    pub(super) factor: f64,
}

impl BenchWidths {
    /// Contact heights of installations differ by some hundredths of a millimetre, ports of one
    /// board by less. A tip without documentation has the largest uncertainty.
    pub(super) const USUAL: Self = Self {
        contact_offset_mm: 0.05,
        ln_stiffness: 0.3,
        port_mm: 0.05,
        factor: 0.3,
    };
}
