//! The chip's own serial port over USB.

use embassy_time::{Duration, Instant};
use embedded_io_async::{Read, Write};
use esp_hal::Async;
use esp_hal::usb::usb_serial_jtag::{UsbSerialJtagRx, UsbSerialJtagTx};

use crate::{HEARD, LINES};

/// If sending a line took longer than this, no host was listening.
const HOST_AWAY: Duration = Duration::from_millis(500);

/// Sends the lines of all rounds.
pub(crate) async fn send(mut sender: UsbSerialJtagTx<'static, Async>) -> ! {
    loop {
        let line = LINES.receive().await;
        let begun = Instant::now();
        // The port reports no errors: without a host it waits.
        let _ = sender.write_all(line.as_bytes()).await;
        let _ = sender.flush().await;
        if begun.elapsed() > HOST_AWAY {
            LINES.clear(); // lines that waited for a host are out of date
        }
    }
}

/// Receives bytes of the host.
pub(crate) async fn hear(mut receiver: UsbSerialJtagRx<'static, Async>) -> ! {
    let mut packet = [0; 64];
    loop {
        let Ok(n) = receiver.read(&mut packet).await; // the port reports no errors
        HEARD.write_all(packet.get(..n).unwrap_or_default()).await;
    }
}
