//! Firmware of a tactile sensor on an ESP32-C3. It has never run on a board.
//!
//! It reads eight barometers of one kind behind a TCA9548A switch on I2C0, and writes to the chip's
//! own USB serial port; `firmware/README.md` has the wiring. At build time `TWINTAC_CHIP` names the
//! kind of chips (default `MS5837-30BA`), and `TWINTAC_SCALE` says how many counts of a CPS135B are
//! 1 Pa.

#![no_std]
#![no_main]

mod clocks;
mod port;

use core::panic::PanicInfo;

use embassy_executor::Spawner;
use embassy_futures::join::join3;
use embassy_sync::blocking_mutex::raw::CriticalSectionRawMutex;
use embassy_sync::channel::Channel;
use embassy_sync::pipe::Pipe;
use embassy_time::{Delay, Instant};
use esp_hal::delay::Delay as Wait;
use esp_hal::gpio::{DriveMode, Level, Output, OutputConfig};
use esp_hal::i2c::master::{Config, I2c};
use esp_hal::time::{Duration, Rate};
use esp_hal::timer::timg::{MwdtStage, TimerGroup};
use esp_hal::usb::usb_serial_jtag::UsbSerialJtag;
use phystac::{Chip, Transfer, recovery};
use twintac_firmware::{Buffer, Firmware, Form, Node, NodeSettings, chip_named, longest, rescue, scale_of};

esp_bootloader_esp_idf::esp_app_desc!();

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

#[esp_rtos::main]
async fn main(_spawner: Spawner) {
    let board = esp_hal::init(esp_hal::Config::default());
    esp_rtos::start(TimerGroup::new(board.TIMG0).timer0, board.FROM_CPU_INTR0);
    let mut watchdog = TimerGroup::new(board.TIMG1).wdt;
    watchdog.set_timeout(MwdtStage::Stage0, WATCHDOG);
    watchdog.enable();
    let (receiver, sender) = UsbSerialJtag::new(board.USB_DEVICE).into_async().split();
    let open_drain = OutputConfig::default().with_drive_mode(DriveMode::OpenDrain);
    let mut reset = Output::new(board.GPIO10, Level::High, open_drain);
    let sense = async {
        // Neither call fails: the peripheral supports this rate, and eight channels of one switch
        // are always different. If one failed, the host would receive nothing.
        let config = Config::default().with_frequency(Rate::from_hz(BUS_HZ));
        let (Ok(bus), Ok(mut settings)) = (I2c::new(board.I2C0, config), NodeSettings::<N_TAXELS>::of(CHIP))
        else {
            return;
        };
        let bus = bus.with_sda(board.GPIO6).with_scl(board.GPIO7).into_async();
        settings.bus_hz = BUS_HZ;
        settings.transfer = (SCALE > 0).then(|| Transfer::per_pa(SCALE));
        let clock = || Instant::now().as_micros();
        let free = |bus: &mut I2c<'_, _>| {
            rescue(
                || clocks::give(bus),
                || recovery::reset_switch(&mut reset, &mut Wait::new()),
            )
        };
        let mut firmware = Firmware::new(Node::new(bus, Delay, clock, free, settings), Form::Csv);
        let mut heard = [0; 32];
        loop {
            while let Ok(n) = HEARD.try_read(&mut heard) {
                heard.iter().take(n).for_each(|byte| firmware.hear(*byte));
            }
            let mut line = Line::new();
            firmware.round(&mut line).await;
            watchdog.feed();
            let _ = LINES.try_send(line);
        }
    };
    join3(port::send(sender), port::hear(receiver), sense).await;
}

/// Restarts the board after any panic. The host counts restarts.
#[panic_handler]
fn panic(_: &PanicInfo<'_>) -> ! {
    esp_hal::system::software_reset()
}
