//! The firmware of a tactile sensor on a Raspberry Pi Pico 2. Never run on a board.
//!
//! Eight barometers of a kind behind a TCA9548A on I2C0, a serial port over USB: `firmware/README.md` has the wiring. When it is built,
//! `TWINTAC_CHIP` says which chips they are (`MS5837-30BA` if it does not), and `TWINTAC_SCALE` how many counts a Pa is, of a CPS135B.

#![no_std]
#![no_main]

mod bus;
mod usb;

use core::panic::PanicInfo;

use embassy_executor::Spawner;
use embassy_futures::join::join4;
use embassy_rp::gpio::{Level, OutputOpenDrain};
use embassy_rp::watchdog::Watchdog;
use embassy_sync::blocking_mutex::raw::CriticalSectionRawMutex;
use embassy_sync::channel::Channel;
use embassy_sync::pipe::Pipe;
use embassy_time::{Delay, Duration, Instant};
use phystac::{Chip, Transfer, recovery};
use twintac_firmware::{Buffer, Firmware, Form, Node, NodeSettings, chip_named, longest, rescue, scale_of};

use crate::bus::Bus;
use crate::usb::Port;

const N_TAXELS: usize = 8;
const CHIP: Chip = chip_named(match option_env!("TWINTAC_CHIP") {
    Some(name) => name,
    None => "MS5837-30BA",
});
const SCALE: u16 = scale_of(match option_env!("TWINTAC_SCALE") {
    Some(text) => text,
    None => "",
});
const BUS_HZ: u32 = 400_000;

/// Longer than the longest round: a transaction is given up after 5 ms, a bus is left alone for a second.
const WATCHDOG: Duration = Duration::from_secs(5);

type Line = Buffer<{ longest(N_TAXELS) }>;

/// What rounds wrote and the host has not got yet. If it does not listen, later rounds are left out; their numbers tell.
static LINES: Channel<CriticalSectionRawMutex, Line, 4> = Channel::new();
/// What the host sent.
static HEARD: Pipe<CriticalSectionRawMutex, 128> = Pipe::new();

#[embassy_executor::main]
async fn main(_spawner: Spawner) {
    let board = embassy_rp::init(Default::default());
    let bus = Bus {
        i2c: board.I2C0,
        sda: board.PIN_4,
        scl: board.PIN_5,
        bus_hz: BUS_HZ,
    };
    let mut reset = OutputOpenDrain::new(board.PIN_6, Level::High);
    let free = move |bus: &mut Bus| {
        rescue(
            || bus.clock_out(),
            || recovery::reset_switch(&mut reset, &mut Delay),
        )
    };
    let clock = || Instant::now().as_micros();
    let mut port = Port::new(board.USB);
    let mut watchdog = Watchdog::new(board.WATCHDOG);
    watchdog.start(WATCHDOG);
    let sense = async {
        // Eight places behind one switch are always different ones: this does not fail, and if it did the host would hear nothing.
        let Ok(mut settings) = NodeSettings::<N_TAXELS>::of(CHIP) else {
            return;
        };
        settings.bus_hz = BUS_HZ;
        settings.transfer = (SCALE > 0).then(|| Transfer::per_pa(SCALE));
        let mut firmware = Firmware::new(Node::new(bus, Delay, clock, free, settings), Form::Csv);
        let mut heard = [0; 32];
        loop {
            while let Ok(n) = HEARD.try_read(&mut heard) {
                heard.iter().take(n).for_each(|byte| firmware.hear(*byte));
            }
            let mut line = Line::new();
            firmware.round(&mut line).await;
            watchdog.feed(WATCHDOG);
            let _ = LINES.try_send(line);
        }
    };
    join4(
        port.device.run(),
        usb::send(port.sender),
        usb::hear(port.receiver),
        sense,
    )
    .await;
}

/// Whatever it was, the board starts anew; the host counts that.
#[panic_handler]
fn panic(_: &PanicInfo<'_>) -> ! {
    cortex_m::peripheral::SCB::sys_reset()
}
