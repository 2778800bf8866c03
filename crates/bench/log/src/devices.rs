//! What drivers and clients give, as messages.

use phystac::{Fault, Frame, Health, Thresholds, Transfer};
use twintac_rig::{Stamp, TcpPose, WrenchSample};

use crate::{CountTransfer, PoseReading, TactileFrame, TaxelReading, TaxelState, WrenchReading};

impl TactileFrame {
    /// A frame of the driver. A taxel whose counts are at an end of the range keeps them, and has no pressure.
    #[must_use]
    pub fn from_driver<const N: usize>(frame: &Frame<N>, transfer: &Transfer) -> Self {
        let taxels = frame.taxels.iter().zip(frame.read_us);
        Self {
            triggered_us: frame.triggered_us,
            taxels: taxels
                .map(|(taxel, read_us)| TaxelReading::from_driver(*taxel, read_us, transfer))
                .collect(),
        }
    }
}

/// Makes messages of the driver's frames, one after the other.
#[derive(Clone, Debug)]
pub struct Screening<const N: usize> {
    transfer: Transfer,
    health: Health<N>,
}

impl<const N: usize> Screening<N> {
    /// Of a sensor whose counts stand for this, of which no frame has been seen.
    #[must_use]
    pub const fn new(transfer: Transfer, thresholds: Thresholds) -> Self {
        Self {
            transfer,
            health: Health::new(transfer, thresholds),
        }
    }

    /// The next frame as a message. A taxel that is saturated or frozen keeps its counts and has no pressure.
    pub fn frame(&mut self, mut frame: Frame<N>) -> TactileFrame {
        let mut message = TactileFrame::from_driver(&frame, &self.transfer);
        self.health.screen(&mut frame);
        for (index, fault) in frame.faults() {
            message.taxels[index].state = TaxelState::from(fault);
            message.taxels[index].pressure_pa = None;
        }
        message
    }
}

impl TaxelReading {
    fn from_driver(taxel: Result<phystac::Sample, Fault>, read_us: u64, transfer: &Transfer) -> Self {
        let pressure_pa = taxel.and_then(|sample| transfer.pressure_pa(sample.counts));
        let count = |sample: phystac::Sample| match transfer.signed {
            true => sample.counts.signed(),
            false => sample.counts.unsigned().cast_signed(),
        };
        Self {
            state: pressure_pa.map_or_else(TaxelState::from, |_| TaxelState::Good),
            read_us,
            counts: taxel.ok().map(count),
            pressure_pa: pressure_pa.ok().map(f64::from),
            temperature_c: taxel.ok().map(|sample| f64::from(sample.temperature_c)),
        }
    }
}

impl From<Fault> for TaxelState {
    fn from(fault: Fault) -> Self {
        match fault {
            Fault::Missing => Self::Missing,
            Fault::Stuck => Self::Stuck,
            Fault::Bus(_) => Self::BusError,
            Fault::Isolated => Self::Isolated,
            Fault::Refused => Self::Refused,
            Fault::Saturated => Self::Saturated,
            Fault::Frozen => Self::Frozen,
        }
    }
}

impl CountTransfer {
    /// The driver's transfer, and whether somebody who knows the parts confirmed it.
    #[must_use]
    pub fn from_driver(transfer: &Transfer, is_confirmed: bool) -> Self {
        Self {
            pa_per_count: f64::from(transfer.pa_per_count),
            offset_pa: f64::from(transfer.offset_pa),
            signed: transfer.signed,
            is_confirmed,
        }
    }
}

impl From<&WrenchSample> for WrenchReading {
    fn from(sample: &WrenchSample) -> Self {
        Self {
            source_s: sample.stamp.source_s,
            sequence: sample.sequence,
            status: sample.status,
            lost_before: sample.lost_before,
            force_n: sample.wrench.force_n,
            torque_n_mm: sample.wrench.torque_n_mm,
        }
    }
}

impl PoseReading {
    /// What the robot reported.
    #[must_use]
    pub fn new(pose: &TcpPose, stamp: Stamp) -> Self {
        Self {
            source_s: stamp.source_s,
            position_mm: pose.position_mm,
            base_from_tool: pose.base_from_tool(),
        }
    }
}

#[cfg(test)]
mod tests {
    use phystac::{Counts, Sample};

    use super::*;

    #[test]
    fn a_saturated_taxel_keeps_its_counts_and_a_missing_one_has_none() {
        let sample = |bytes| Sample {
            counts: Counts::from_be_bytes(bytes),
            temperature_c: 21.5,
        };
        let frame = Frame {
            triggered_us: 5,
            read_us: [11, 12, 13],
            taxels: [
                Ok(sample([0, 0, 64])),
                Ok(sample([0x7F, 0xFF, 0xFF])),
                Err(Fault::Missing),
            ],
        };
        let taxels = TactileFrame::from_driver(&frame, &Transfer::per_pa(32)).taxels;
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
}
