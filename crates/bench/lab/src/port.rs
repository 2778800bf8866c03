//! A barometer's port.

/// Pressure of the air, kPa.
const ATMOSPHERE_KPA: f64 = 101.325;

/// What becomes of the gel's pressure at a barometer's port.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Port {
    pub(crate) gain: f64,
    pub(crate) offset_kpa: f64,
    pub(crate) offset_kpa_per_k: f64,
}

impl Port {
    /// A perfect one.
    pub(crate) const PERFECT: Self = Self {
        gain: 1.0,
        offset_kpa: 0.0,
        offset_kpa_per_k: 0.0,
    };

    /// Absolute pressure in it, kPa, under a pressure of the gel, kPa, so much warmer than when it was cast, K.
    pub(crate) fn absolute_kpa(&self, gel_kpa: f64, warmed_k: f64) -> f64 {
        ATMOSPHERE_KPA + self.offset_kpa + self.offset_kpa_per_k * warmed_k + self.gain * gel_kpa
    }
}
