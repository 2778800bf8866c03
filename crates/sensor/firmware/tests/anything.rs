//! Whatever the bus answers, the firmware continues, and the host never gets a reading that no chip
//! gave.

#![allow(clippy::unwrap_used)] // also in the helpers of tests

use std::cell::{Cell, RefCell};
use std::path::Path;
use std::rc::Rc;

use embedded_hal::delay::DelayNs;
use embedded_hal::i2c::{ErrorKind, ErrorType, I2c, NoAcknowledgeSource, Operation};
use phystac::{AtOnce, Chip, TaxelState, Transfer, now};
use proptest::prelude::*;
use twintac_firmware::{Buffer, Firmware, Form, Node, NodeSettings, Report, longest};
use twintac_line::{Decoder, Description, Heard, LineFrame};

const N: usize = 8;
const NACK: ErrorKind = ErrorKind::NoAcknowledge(NoAcknowledgeSource::Address);

/// Time, which passes while somebody waits.
#[derive(Clone)]
struct Time(Rc<Cell<u64>>);

impl Time {
    fn pass(&self, us: u64) {
        self.0.set(self.0.get() + us);
    }
}

impl DelayNs for Time {
    fn delay_ns(&mut self, ns: u32) {
        self.pass(u64::from(ns.div_ceil(1000)));
    }
}

/// A switch and eight CPS135B that behave as the script says.
struct Wild {
    time: Time,
    /// What happens in the next transactions. After the end of the script everything works.
    script: Vec<u8>,
    at: usize,
    mask: u8,
    /// The pressures read in this round: which channels were open, and which counts were given.
    given: Rc<RefCell<Vec<(u8, u32)>>>,
}

impl Wild {
    fn answer(&self, address: u8, register: u8, read: &mut [u8], salt: u8) {
        match (address, register, read.len()) {
            (0x70, ..) => read[0] = self.mask,
            (_, 0x06, 5) => {
                // An atmosphere in counts, different for each channel and moment.
                let counts =
                    3_242_400 + 100 * u32::from(self.mask.trailing_zeros() as u8) + u32::from(salt % 64);
                let [_, bytes @ ..] = counts.to_be_bytes();
                read.copy_from_slice(&[bytes[0], bytes[1], bytes[2], 25, 0]);
            }
            (_, 0x30, 1) => read[0] = 0x02, // converts no more
            _ => read.fill(0x28),
        }
    }
}

impl ErrorType for Wild {
    type Error = ErrorKind;
}

impl I2c for Wild {
    fn transaction(&mut self, address: u8, operations: &mut [Operation<'_>]) -> Result<(), ErrorKind> {
        self.time.pass(100);
        let what = self.script.get(self.at).copied().unwrap_or(0);
        self.at += 1;
        match what {
            200..=219 => return Err(NACK),
            220..=234 => return Err(ErrorKind::Bus),
            235..=239 => self.mask = 0, // loses power
            _ => {}
        }
        let is_chip = address == 0x6D && self.mask != 0;
        if address != 0x70 && !is_chip {
            return Err(NACK);
        }
        let mut register = 0;
        for operation in operations {
            match operation {
                Operation::Write(bytes) => {
                    register = bytes.first().copied().unwrap_or(0);
                    if address == 0x70 {
                        self.mask = register;
                    }
                }
                Operation::Read(read) => {
                    self.answer(address, register, read, what);
                    if what >= 240 {
                        read.iter_mut().for_each(|byte| *byte ^= what.rotate_left(3)); // sends wrong bytes
                    }
                    if let (0x6D, 0x06, [high, middle, low, _, _]) = (address, register, &**read) {
                        let counts = u32::from_be_bytes([0, *high, *middle, *low]);
                        self.given.borrow_mut().push((self.mask, counts));
                    }
                }
            }
        }
        Ok(())
    }
}

fn description(form: Form) -> Description {
    let name = match form {
        Form::Csv => "csv-8.toml",
        Form::Packets => "packets-8.toml",
    };
    Description::read(
        Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("../../../firmware/lines")
            .join(name),
    )
    .unwrap()
}

/// The pressure of this part's counts, Pa.
fn pressure_pa(counts: u32) -> f64 {
    f64::from((counts << 8).cast_signed() >> 8) / 32.0
}

/// Checks that a frame contains only readings of its round.
fn check(frame: &LineFrame, report: &Report<N>, given: &[(u8, u32)]) {
    assert_eq!(frame.sequence, Some(u64::from(report.sequence)));
    for (index, (pressure_kpa, fault)) in frame.pressures_kpa.iter().zip(&frame.faults).enumerate() {
        let fault = fault.unwrap();
        assert_eq!(fault, report.taxels[index].state as u8);
        assert_eq!(pressure_kpa.is_none(), fault != TaxelState::Good as u8);
        let Some(pressure_kpa) = pressure_kpa else {
            continue;
        };
        let is_it = |(mask, counts): &(u8, u32)| {
            *mask == 1 << index && (1000.0 * pressure_kpa - pressure_pa(*counts)).abs() < 0.0051
        };
        assert!(
            given.iter().any(is_it),
            "taxel {index} gave no {pressure_kpa} kPa: {given:?}"
        );
    }
}

fn run(script: Vec<u8>, said: &[u8], form: Form, n_rounds: usize) {
    let time = Time(Rc::default());
    let given = Rc::new(RefCell::new(Vec::new()));
    let wild = Wild {
        time: time.clone(),
        script,
        at: 0,
        mask: 0,
        given: Rc::clone(&given),
    };
    let mut settings = NodeSettings::<N>::of(Chip::Cps135b).unwrap();
    settings.transfer = Some(Transfer::per_pa(32));
    let clock = {
        let time = time.clone();
        move || time.0.get()
    };
    let rescue = |bus: &mut AtOnce<Wild>| {
        bus.0.mask = 0;
        Ok(())
    };
    let node = Node::new(AtOnce(wild), AtOnce(time), clock, rescue, settings);
    let mut firmware = Firmware::new(node, form);
    let mut decoder = Decoder::new(&description(form), N);
    let mut n_frames = 0;
    for round in 0..n_rounds {
        if round == n_rounds / 2 {
            said.iter().for_each(|byte| firmware.hear(*byte));
            let name = if form == Form::Csv { "csv" } else { "packets" };
            format!("\nform {name}\nscale 32\n")
                .bytes()
                .for_each(|byte| firmware.hear(byte));
        }
        given.borrow_mut().clear();
        let mut bytes = Buffer::<{ longest(N) }>::new();
        let report = now(firmware.round(&mut bytes));
        assert!(!bytes.is_full());
        decoder.push(bytes.as_bytes(), &mut |heard| {
            if let Heard::Frame(frame) = heard {
                check(&frame, &report, &given.borrow());
                n_frames += 1;
            }
        });
    }
    let tally = decoder.tally();
    assert_eq!(
        (n_frames, tally.frames, tally.lost),
        (n_rounds, n_rounds as u64, 0),
        "{tally:?}"
    );
    assert_eq!(
        (tally.torn, tally.checksum, tally.endless, tally.text),
        (0, 0, 0, 0)
    );
}

#[test]
fn all_goes_well_on_a_bus_that_does() {
    for form in [Form::Csv, Form::Packets] {
        run(Vec::new(), b"", form, 40);
    }
}

proptest! {
    #[test]
    fn nothing_is_heard_that_was_not_given(
        script in proptest::collection::vec(prop_oneof![3 => 0_u8..200, 1 => 200_u8..=255], 0..1200),
        said in proptest::collection::vec(any::<u8>(), 0..60),
        is_text: bool,
    ) {
        run(script, &said, if is_text { Form::Csv } else { Form::Packets }, 40);
    }
}
