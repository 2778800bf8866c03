//! Order and limits of the unknowns of a fit.

use super::prior::{BarometerWidths, Prior};
use crate::Features;
use crate::features::Gains;
use crate::numerics::{Unknown, median};

/// Largest change of a time constant from its start, as a factor.
const TIME_CONSTANT_REACH: f64 = 6.0;
/// Smallest and largest share of an overstress in the reading.
const SHARES: [f64; 2] = [0.0, 5.0];
/// Smallest and largest relative growth of a reading at the largest reading of all.
const STIFFENING: [f64; 2] = [-1.0, 3.0];
/// Regularization of the growth that is common to all taxels, towards zero.
const STIFFENING_PULL: f64 = 1e-5;
/// Regularization of a taxel's own growth, towards the common one.
const OWN_STIFFENING_PULL: f64 = 1e-3;
/// Largest change of a gain from its start, as a factor.
const GAIN_REACH: f64 = 100.0;
/// Gains below this fraction of the largest start at it.
const SMALLEST_GAIN: f64 = 1e-4;

/// The model of the barometers.
#[derive(Clone, Debug)]
pub(crate) struct BarometerModel {
    /// Initial time constants, s; empty for barometers without relaxation.
    pub(crate) time_constants_s: Vec<f64>,
    /// Whether the response to pressure may be nonlinear.
    pub(crate) has_port_law: bool,
}

impl BarometerModel {
    /// The model for readings of some presses. If each press is a single frame, there is neither
    /// relaxation nor a static nonlinearity: the pressure at a port then depends on its distance
    /// alone, and a nonlinearity cannot be separated from differences between the real and the
    /// simulated tip.
    pub(crate) fn new<'a>(
        presses: impl IntoIterator<Item = &'a Features>,
        time_constants_s: &[f64],
        has_port_law: bool,
    ) -> Self {
        if presses.into_iter().all(|features| features.n_frames() < 2) {
            return Self {
                time_constants_s: Vec::new(),
                has_port_law: false,
            };
        }
        Self {
            time_constants_s: time_constants_s.to_vec(),
            has_port_law,
        }
    }
}

/// Order of the unknowns: those of the port pressures; ln time constants; the relative growth and
/// the ln gain that are common to all taxels; then for each taxel its own ln gain, its own relative
/// growth, and its shares of the overstresses.
///
/// The common ln gain is zero except where gains are regularized towards those of another sensor,
/// because a whole sensor may have larger readings than another one.
///
/// The common growth belongs to the gel: at the same port pressure it is the same for any gain. It
/// is given at the largest reading, for a taxel of the usual gain. A taxel's own growth is given at
/// the largest reading.
pub(super) struct Layout {
    pub(super) n_elastic: usize,
    pub(super) n_constants: usize,
    pub(super) largest_kpa: f64,
    pub(super) usual_gain: f64,
}

impl Layout {
    pub(super) fn unknowns(&self, gains: &Gains, model: &BarometerModel) -> Vec<Unknown> {
        let unknown = |start: f64, bounds: [f64; 2], pull: f64| Unknown {
            start,
            bounds,
            center: 0.0,
            pull,
        };
        let around = |center: f64, reach: f64| unknown(center, [center - reach, center + reach], 0.0);
        let constants = gains.time_constants_s.iter();
        let mut unknowns: Vec<Unknown> = constants
            .map(|tau| around(tau.ln(), TIME_CONSTANT_REACH.ln()))
            .collect();
        let largest = gains.gain.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        let limits = if model.has_port_law { STIFFENING } else { [0.0; 2] };
        let at_usual_gain = gains
            .gain
            .iter()
            .zip(&gains.stiffening_per_kpa)
            .map(|(gain, per_kpa)| self.largest_kpa * per_kpa * gain / self.usual_gain);
        let common = median(at_usual_gain.collect());
        unknowns.push(unknown(common, limits, STIFFENING_PULL));
        unknowns.push(around(0.0, 0.0));
        for (k, (gain, shares)) in gains.gain.iter().zip(&gains.memory).enumerate() {
            let gain = gain.max(SMALLEST_GAIN * largest);
            unknowns.push(around(gain.ln(), GAIN_REACH.ln()));
            let own = self.largest_kpa * gains.stiffening_per_kpa[k] - common * self.usual_gain / gain;
            unknowns.push(unknown(own, limits, OWN_STIFFENING_PULL));
            unknowns.extend(shares.iter().map(|share| unknown(*share, SHARES, 0.0)));
        }
        unknowns
    }

    /// Regularizes the unknowns of the barometers towards their start, and frees the common gain.
    pub(super) fn pull(&self, unknowns: &mut [Unknown], prior: Prior) {
        let widths = BarometerWidths::USUAL;
        let common = self.common() - self.n_elastic;
        unknowns[common + 1].bounds = [-GAIN_REACH.ln(), GAIN_REACH.ln()];
        for (i, unknown) in unknowns.iter_mut().enumerate() {
            let width = match i {
                i if i < common => widths.ln_time_constant,
                i if i == common => widths.common_growth,
                i if i == common + 1 => widths.common_ln_gain,
                i => match (i - common - 2) % (2 + self.n_constants) {
                    0 => widths.own_ln_gain,
                    1 => widths.own_growth,
                    _ => widths.share,
                },
            };
            prior.pull(unknown, unknown.start, width);
        }
    }

    /// Index of the growth that is common to all taxels.
    pub(super) fn common(&self) -> usize {
        self.n_elastic + self.n_constants
    }

    /// The unknowns of the port pressures.
    pub(super) fn of_elastic<'x>(&self, x: &'x [f64]) -> &'x [f64] {
        &x[..self.n_elastic]
    }

    /// Index of the first unknown of a taxel.
    pub(super) fn of_taxel(&self, k: usize) -> usize {
        self.common() + 2 + k * (2 + self.n_constants)
    }

    pub(super) fn gains(&self, x: &[f64], n_taxels: usize) -> Gains {
        let of = |k: usize| &x[self.of_taxel(k)..self.of_taxel(k + 1)];
        let constants = &x[self.n_elastic..self.common()];
        let gain = |k: usize| (of(k)[0] + x[self.common() + 1]).exp();
        let stiffening = |k: usize| of(k)[1] + x[self.common()] * self.usual_gain / gain(k);
        Gains {
            gain: (0..n_taxels).map(gain).collect(),
            stiffening_per_kpa: (0..n_taxels)
                .map(|k| stiffening(k) / self.largest_kpa.max(f64::MIN_POSITIVE))
                .collect(),
            memory: (0..n_taxels).map(|k| of(k)[2..].to_vec()).collect(),
            time_constants_s: constants.iter().map(|ln| ln.exp()).collect(),
        }
    }
}
