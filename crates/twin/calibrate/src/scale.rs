//! Scales on which unknowns are sought.

/// The function that maps a coordinate of the search to a value. On each scale, a step of one is a
/// large step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Scale {
    /// `x`.
    Linear,
    /// `exp x`, for values above zero.
    Log,
    /// `-exp x`, for values below zero.
    NegativeLog,
    /// `1/(1 + exp -x)`, for values between 0 and 1.
    Logit,
}

impl Scale {
    pub(crate) fn value(self, x: f64) -> f64 {
        match self {
            Self::Linear => x,
            Self::Log => x.exp(),
            Self::NegativeLog => -x.exp(),
            Self::Logit => 1.0 / (1.0 + (-x).exp()),
        }
    }

    pub(crate) fn coordinate(self, value: f64) -> f64 {
        match self {
            Self::Linear => value,
            Self::Log => value.ln(),
            Self::NegativeLog => (-value).ln(),
            Self::Logit => (value / (1.0 - value)).ln(),
        }
    }

    /// Derivative of the value with respect to the coordinate.
    pub(crate) fn rate(self, x: f64) -> f64 {
        match self {
            Self::Linear => 1.0,
            Self::Log | Self::NegativeLog => self.value(x),
            Self::Logit => self.value(x) * (1.0 - self.value(x)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_lead_back_and_their_rates_are_differences() {
        for scale in [Scale::Linear, Scale::Log, Scale::NegativeLog, Scale::Logit] {
            for size in [0.1, 0.3, 0.49] {
                let value = if scale == Scale::NegativeLog { -size } else { size };
                let x = scale.coordinate(value);
                assert!((scale.value(x) - value).abs() < 1e-12);
                let difference = (scale.value(x + 1e-5) - scale.value(x - 1e-5)) / 2e-5;
                assert!((scale.rate(x) / difference - 1.0).abs() < 1e-6);
            }
        }
    }
}
