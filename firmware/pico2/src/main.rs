//! Firmware of a tactile sensor on a Raspberry Pi Pico 2. It has never run on a board.
//!
//! It reads eight barometers of one kind behind a TCA9548A switch on I2C0, and writes to a USB
//! serial port; `firmware/README.md` has the wiring. At build time `TWINTAC_CHIP` names the kind of
//! chips (default `MS5837-30BA`), and `TWINTAC_SCALE` says how many counts of a CPS135B are 1 Pa.

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

/// Longer than the longest round: a transaction is given up after 5 ms, and a failed bus is left
/// alone for 1 s.
const WATCHDOG: Duration = Duration::from_secs(5);

type Line = Buffer<{ longest(N_TAXELS) }>;

/// Lines that the host has not received yet. If the host does not listen, later rounds are dropped;
/// gaps in their numbers show it.
static LINES: Channel<CriticalSectionRawMutex, Line, 4> = Channel::new();
/// Bytes that the host sent.
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
        // This does not fail, because eight channels of one switch are always different. If it
        // failed, the host would receive nothing.
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

/// Restarts the board after any panic. The host counts restarts.
#[panic_handler]
fn panic(_: &PanicInfo<'_>) -> ! {
    cortex_m::peripheral::SCB::sys_reset()
}
