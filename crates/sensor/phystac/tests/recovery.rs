//! Two bus lines, and a part that holds one of them.

use std::cell::RefCell;
use std::convert::Infallible;
use std::rc::Rc;

use embedded_hal::delay::DelayNs;
use embedded_hal::digital::{ErrorType, InputPin, OutputPin};
use phystac::recovery::{RecoveryError, free_bus, reset_switch};

#[derive(Default)]
struct Lines {
    scl: bool,
    sda: bool,
    /// For how many clocks a part keeps holding SDA.
    held_clocks: u32,
    clock_is_held: bool,
    /// Number of clocks on the lines.
    clocks: u32,
    stops: u32,
    now_ns: u64,
    last_edge_ns: u64,
}

impl Lines {
    fn set(&mut self, line: char, high: bool) {
        let (scl, sda) = (self.scl, self.sda);
        if line == 'c' {
            self.scl = high;
            if high && !scl {
                self.clocks += 1;
                self.held_clocks = self.held_clocks.saturating_sub(1);
            }
            if high != scl {
                assert!(self.now_ns - self.last_edge_ns >= 4700, "faster than 100 kHz");
                self.last_edge_ns = self.now_ns;
            }
        } else {
            self.sda = high;
            self.stops += u32::from(self.scl && high && !sda && self.held_clocks == 0);
        }
    }
}

struct Pin(char, Rc<RefCell<Lines>>);
struct Delay(Rc<RefCell<Lines>>);

impl ErrorType for Pin {
    type Error = Infallible;
}

impl OutputPin for Pin {
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.1.borrow_mut().set(self.0, false);
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        self.1.borrow_mut().set(self.0, true);
        Ok(())
    }
}

impl InputPin for Pin {
    fn is_high(&mut self) -> Result<bool, Infallible> {
        let lines = self.1.borrow();
        Ok(if self.0 == 'c' {
            lines.scl && !lines.clock_is_held
        } else {
            lines.sda && lines.held_clocks == 0
        })
    }

    fn is_low(&mut self) -> Result<bool, Infallible> {
        self.is_high().map(|is_high| !is_high)
    }
}

impl DelayNs for Delay {
    fn delay_ns(&mut self, ns: u32) {
        self.0.borrow_mut().now_ns += u64::from(ns);
    }
}

fn freed(held_clocks: u32, clock_is_held: bool) -> (Result<(), RecoveryError>, Rc<RefCell<Lines>>) {
    let lines = Rc::new(RefCell::new(Lines {
        scl: true,
        sda: true,
        held_clocks,
        clock_is_held,
        now_ns: 1_000_000,
        ..Lines::default()
    }));
    let [mut scl, mut sda] = ['c', 'd'].map(|line| Pin(line, Rc::clone(&lines)));
    (free_bus(&mut scl, &mut sda, &mut Delay(Rc::clone(&lines))), lines)
}

#[test]
fn nine_clocks_and_a_stop_free_whatever_byte_is_under_way() {
    for held_clocks in 0..=9 {
        let (result, lines) = freed(held_clocks, false);
        let lines = lines.borrow();
        assert_eq!(
            (result, lines.clocks, lines.stops),
            (Ok(()), 10, 1),
            "{held_clocks} clocks left"
        );
        assert!(lines.scl && lines.sda);
    }
}

#[test]
fn a_line_that_stays_low_is_named() {
    assert_eq!(freed(u32::MAX, false).0, Err(RecoveryError::DataHeldLow));
    assert_eq!(freed(0, true).0, Err(RecoveryError::ClockHeldLow));
}

#[test]
fn reset_is_a_low_pulse() {
    let lines = Rc::new(RefCell::new(Lines {
        sda: true,
        ..Lines::default()
    }));
    reset_switch(&mut Pin('d', Rc::clone(&lines)), &mut Delay(Rc::clone(&lines))).unwrap();
    let lines = lines.borrow();
    assert!(lines.sda && lines.now_ns >= 506);
}
