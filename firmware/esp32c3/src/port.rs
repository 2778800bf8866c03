//! The chip's own serial port over USB.

use embassy_time::{Duration, Instant};
use embedded_io_async::{Read, Write};
use esp_hal::Async;
use esp_hal::usb::usb_serial_jtag::{UsbSerialJtagRx, UsbSerialJtagTx};

use crate::{HEARD, LINES};

/// What took longer than this waited for a host.
const HOST_AWAY: Duration = Duration::from_millis(500);

/// Sends what rounds wrote.
pub(crate) async fn send(mut sender: UsbSerialJtagTx<'static, Async>) -> ! {
    loop {
        let line = LINES.receive().await;
        let begun = Instant::now();
        // The port has no errors: without a host it waits.
        let _ = sender.write_all(line.as_bytes()).await;
        let _ = sender.flush().await;
        if begun.elapsed() > HOST_AWAY {
            LINES.clear(); // what waited for a host is of another time
        }
    }
}

/// Takes what the host sends.
pub(crate) async fn hear(mut receiver: UsbSerialJtagRx<'static, Async>) -> ! {
    let mut packet = [0; 64];
    loop {
        let Ok(n) = receiver.read(&mut packet).await; // the port has no errors
        HEARD.write_all(packet.get(..n).unwrap_or_default()).await;
    }
}
