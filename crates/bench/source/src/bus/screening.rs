//! Turns frames of the driver into messages of a log.

use phystac::{Fault, Frame, Health, Pressure, Thresholds, Transfer};
use twintac_log::{CountTransfer, TactileFrame, TaxelReading, TaxelState};

/// Placeholder for a sensor whose counts need no conversion.
pub(crate) const UNUSED: Transfer = Transfer::per_pa(1);

/// Turns frames of the driver into messages, one after the other.
#[derive(Clone, Debug)]
pub(crate) struct Screening<const N: usize> {
    /// The conversion from counts to pressure. Without meaning if all chips know their own scale.
    transfer: Transfer,
    health: Health<N>,
}

impl<const N: usize> Screening<N> {
    /// `transfer` is the conversion of chips that do not know their own scale. No frame has been
    /// screened yet.
    #[must_use]
    pub(crate) const fn new(transfer: Option<Transfer>, thresholds: Thresholds) -> Self {
        let transfer = match transfer {
            Some(transfer) => transfer,
            None => UNUSED,
        };
        Self {
            transfer,
            health: Health::new(transfer, thresholds),
        }
    }

    /// The next frame as a message. A taxel that is saturated or frozen keeps its counts and has no
    /// pressure.
    pub(crate) fn frame(&mut self, mut frame: Frame<N>) -> TactileFrame {
        let mut message = tactile_frame(&frame, &self.transfer);
        self.health.screen(&mut frame);
        for (index, fault) in frame.faults() {
            message.taxels[index].state = TaxelState::from(fault);
            message.taxels[index].pressure_pa = None;
        }
        message
    }
}

/// The driver's conversion in the form of a log. A person who knows the parts has confirmed it.
#[must_use]
pub fn confirmed_transfer(transfer: &Transfer) -> CountTransfer {
    CountTransfer {
        pa_per_count: f64::from(transfer.pa_per_count),
        offset_pa: f64::from(transfer.offset_pa),
        signed: transfer.signed,
        is_confirmed: true,
    }
}

/// A frame as a message, before it is compared with earlier frames.
fn tactile_frame<const N: usize>(frame: &Frame<N>, transfer: &Transfer) -> TactileFrame {
    let taxels = frame.taxels.iter().zip(frame.read_us);
    let taxels = taxels.filter(|(taxel, _)| **taxel != Err(Fault::NotWired));
    TactileFrame {
        triggered_us: frame.triggered_us,
        taxels: taxels
            .map(|(taxel, read_us)| taxel_reading(*taxel, read_us, transfer))
            .collect(),
    }
}

fn taxel_reading(taxel: Result<phystac::Sample, Fault>, read_us: u64, transfer: &Transfer) -> TaxelReading {
    let pressure_pa = taxel.and_then(|sample| sample.pressure_pa(transfer));
    let count = |sample: phystac::Sample| match sample.pressure == Pressure::Unscaled && transfer.signed {
        true => sample.counts.signed(),
        false => sample.counts.unsigned().cast_signed(),
    };
    TaxelReading {
        state: pressure_pa.map_or_else(TaxelState::from, |_| TaxelState::Good),
        read_us,
        counts: taxel.ok().map(count),
        pressure_pa: pressure_pa.ok().map(f64::from),
        temperature_c: taxel.ok().map(|sample| f64::from(sample.temperature_c)),
    }
}

#[cfg(test)]
mod tests {
    use phystac::{Counts, Sample};
    use proptest::prelude::*;

    use super::*;

    fn sample(bytes: [u8; 3]) -> Sample {
        Sample {
            counts: Counts::from_be_bytes(bytes),
            pressure: Pressure::Unscaled,
            temperature_c: 21.5,
        }
    }

    #[test]
    fn a_saturated_taxel_keeps_its_counts_and_a_missing_one_has_none() {
        let frame = Frame {
            triggered_us: 5,
            read_us: [11, 12, 13],
            taxels: [
                Ok(sample([0, 0, 64])),
                Ok(sample([0x7F, 0xFF, 0xFF])),
                Err(Fault::Missing),
            ],
        };
        let taxels = tactile_frame(&frame, &Transfer::per_pa(32)).taxels;
        let good = TaxelReading {
            state: TaxelState::Good,
            read_us: 11,
            counts: Some(64),
            pressure_pa: Some(2.0),
            temperature_c: Some(21.5),
        };
        assert_eq!(taxels[0], good);
        assert_eq!(taxels[1].state, TaxelState::Saturated);
        assert_eq!((taxels[1].counts, taxels[1].pressure_pa), (Some(0x7F_FFFF), None));
        assert_eq!((taxels[2].state, taxels[2].counts), (TaxelState::Missing, None));
    }

    proptest! {
        #[test]
        fn a_taxel_has_counts_if_it_was_read_and_is_good_if_it_has_a_pressure(
            bytes in prop::option::of(any::<[u8; 3]>()),
            signed in any::<bool>(),
        ) {
            let transfer = Transfer { signed, ..Transfer::per_pa(8) };
            let taxel = bytes.map(sample).ok_or(Fault::Stuck);
            let frame = Frame { triggered_us: 0, read_us: [1], taxels: [taxel] };
            let said = tactile_frame(&frame, &transfer).taxels[0];
            let pressure_pa = frame.pressures_pa(&transfer)[0];
            prop_assert_eq!(said.counts.is_some(), taxel.is_ok());
            prop_assert_eq!(said.state == TaxelState::Good, pressure_pa.is_ok());
            prop_assert_eq!(said.pressure_pa, pressure_pa.ok().map(f64::from));
        }
    }
}
