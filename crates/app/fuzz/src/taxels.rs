//! The tactile sensor on a bus that returns any bytes.

use std::cell::Cell;
use std::rc::Rc;

use embedded_hal::delay::DelayNs;
use embedded_hal::i2c::{ErrorKind, ErrorType, I2c, NoAcknowledgeSource, Operation};
use phystac::{
    Chip, Fault, FreeAir, Health, PhysTac, Settings, Thresholds, Transfer, Wired, Wiring, scale_hint,
};

const SWITCH: u8 = 0x70;
const COMMAND: u8 = 0x30;
const PRESSURE_CONFIGURATION: u8 = 0xA6;
/// Largest cost of one call, whatever the bus does: transactions, and µs.
const MOST_TRANSACTIONS: usize = 3000;
const MOST_US: u64 = 200_000;
/// Largest additional time to start one chip, µs.
const MOST_START_US: u64 = 200_000;

/// The first byte of a transaction chooses its result. Up to this value the bus works, and only the
/// data are arbitrary.
const HONEST: u8 = 0xDF;

/// A bus that answers with the given bytes, and with zeros after them.
struct Bytes<'a> {
    bytes: &'a [u8],
    chip: Chip,
    mask: u8,
    configuration: u8,
    transactions: Rc<Cell<usize>>,
}

impl Bytes<'_> {
    fn byte(&mut self) -> u8 {
        let Some((first, rest)) = self.bytes.split_first() else {
            return 0;
        };
        self.bytes = rest;
        *first
    }

    fn check_write(&mut self, address: u8, bytes: &[u8]) {
        match (address, bytes) {
            (SWITCH, [mask]) => self.mask = *mask,
            _ if self.chip != Chip::Cps135b => {}
            (_, [COMMAND, command]) => assert_eq!(command & 0b111, 0b010, "no other is for us to write"),
            (_, [PRESSURE_CONFIGURATION, configuration]) => {
                assert_eq!(
                    configuration & !0b111,
                    self.configuration & !0b111,
                    "the factory's bits"
                );
            }
            (_, [_register]) => {}
            _ => panic!("nobody may write {bytes:02x?}"),
        }
    }
}

impl ErrorType for Bytes<'_> {
    type Error = ErrorKind;
}

impl I2c for Bytes<'_> {
    fn transaction(&mut self, address: u8, operations: &mut [Operation<'_>]) -> Result<(), ErrorKind> {
        self.transactions.set(self.transactions.get() + 1);
        let how = self.byte();
        let mut register = 0;
        for operation in operations {
            match operation {
                Operation::Write(bytes) => {
                    self.check_write(address, bytes);
                    register = bytes.first().copied().unwrap_or_default();
                }
                Operation::Read(bytes) => {
                    for byte in bytes.iter_mut() {
                        *byte = match (address, register) {
                            (SWITCH, _) if how <= HONEST => self.mask,
                            (_, COMMAND) if how <= HONEST => 0b010,
                            (_, PRESSURE_CONFIGURATION) if how <= HONEST => self.configuration,
                            _ => self.byte(),
                        };
                        if register == PRESSURE_CONFIGURATION {
                            self.configuration = *byte;
                        }
                    }
                }
            }
        }
        match how {
            0xF0..=0xF5 => Err(ErrorKind::NoAcknowledge(NoAcknowledgeSource::Address)),
            0xF6..=0xFA => Err(ErrorKind::Bus),
            0xFB.. => Err(ErrorKind::ArbitrationLoss),
            _ => Ok(()),
        }
    }
}

/// A clock that advances when the driver waits.
#[derive(Clone)]
struct Time(Rc<Cell<u64>>);

impl DelayNs for Time {
    fn delay_ns(&mut self, ns: u32) {
        self.0.set(self.0.get() + u64::from(ns));
    }
}

/// Checks a sensor whose bus answers with these bytes. The first byte chooses the calls between
/// frames, the second the kind of chips.
pub(crate) fn bus(bytes: &[u8]) {
    let [calls, chip, bytes @ ..] = bytes else {
        return;
    };
    let chip = Chip::ALL[usize::from(*chip) % Chip::ALL.len()];
    let samples = (calls & 1 == 1).then(|| chip.data().speeds[0].samples);
    let wired = [0, 1, 2, 3, 4, 5, 6, 7].map(|channel| Wired {
        samples,
        ..Wired::on_channel(chip, channel)
    });
    let Ok(wiring) = Wiring::new(&wired) else {
        return;
    };
    let transactions = Rc::new(Cell::new(0));
    let time = Time(Rc::new(Cell::new(0)));
    let clock = time.clone();
    let bus = Bytes {
        bytes,
        chip,
        mask: 0,
        configuration: 0,
        transactions: Rc::clone(&transactions),
    };
    let settings = Settings::<8>::new(wiring);
    let mut sensor = PhysTac::new(bus, time.clone(), move || clock.0.get() / 1000, settings);
    let transfer = Transfer::per_pa(32);
    let mut health = Health::new(transfer, Thresholds::default());
    for turn in 0..8 {
        let (before, before_ns) = (transactions.get(), time.0.get());
        let called = match (calls >> turn & 1, turn) {
            (0, _) => sensor.trigger(),
            (_, 1 | 5) => sensor.stop(),
            (_, 2 | 6) => {
                sensor.readmit();
                Ok(())
            }
            _ => sensor.start(),
        };
        let frame = sensor.frame();
        assert!(transactions.get() - before <= MOST_TRANSACTIONS);
        assert!(time.0.get() - before_ns <= 1000 * (MOST_US + 16 * MOST_START_US));
        if let Err(error) = called {
            assert!(!error.to_string().is_empty());
        }
        if let Ok(mut frame) = frame {
            check(&mut frame, &mut health, &transfer);
        }
    }
}

fn check(frame: &mut phystac::Frame<8>, health: &mut Health<8>, transfer: &Transfer) {
    assert!(frame.read_us.iter().all(|read_us| *read_us >= frame.triggered_us));
    for (taxel, pressure_pa) in frame.taxels.iter().zip(frame.pressures_pa(transfer)) {
        if let (Ok(sample), Ok(pressure_pa)) = (taxel, pressure_pa) {
            assert!(!sample.temperature_c.is_nan());
            assert!(pressure_pa.is_finite(), "{pressure_pa} Pa");
        }
    }
    let air = FreeAir::default();
    if let Ok(hint) = scale_hint(frame, air) {
        assert!(air.lowest_pa <= hint.lowest_pa && hint.highest_pa <= air.highest_pa);
        assert!(hint.lowest_pa <= hint.highest_pa);
    }
    let before = *frame;
    health.screen(frame);
    for (before, after) in before.taxels.iter().zip(&frame.taxels) {
        let is_new = matches!(after, Err(Fault::Saturated | Fault::Frozen));
        assert!(before == after || before.is_ok() && is_new);
    }
    let drifts = health.at_rest(frame);
    for (taxel, drift) in frame.taxels.iter().zip(drifts) {
        assert_eq!(drift.is_some(), taxel.is_ok());
        assert!(drift.is_none_or(|drift| drift.drift_pa.is_finite()));
    }
}
