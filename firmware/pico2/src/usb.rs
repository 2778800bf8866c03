//! A serial port over USB.

use core::fmt::Write;

use embassy_rp::peripherals::USB;
use embassy_rp::usb::{Driver, InterruptHandler};
use embassy_rp::{Peri, bind_interrupts, otp};
use embassy_usb::class::cdc_acm::{CdcAcmClass, Receiver, Sender, State};
use embassy_usb::driver::EndpointError;
use embassy_usb::{Builder, Config, UsbDevice};
use static_cell::StaticCell;

use crate::{HEARD, LINES};

bind_interrupts!(struct Irqs {
    USBCTRL_IRQ => InterruptHandler<USB>;
});

/// Largest packet at full speed, bytes.
const PACKET: u16 = 64;

type UsbDriver = Driver<'static, USB>;

/// The parts of the port. Each is a future that has to run.
pub(crate) struct Port {
    pub(crate) device: UsbDevice<'static, UsbDriver>,
    pub(crate) sender: Sender<'static, UsbDriver>,
    pub(crate) receiver: Receiver<'static, UsbDriver>,
}

/// The number of this chip as hexadecimal digits. The host uses it to distinguish boards.
fn serial_number() -> &'static str {
    static TEXT: StaticCell<Digits> = StaticCell::new();
    let digits = TEXT.init(Digits {
        bytes: [b'0'; 16],
        len: 0,
    });
    let _ = write!(digits, "{:016X}", otp::get_chipid().unwrap_or_default());
    core::str::from_utf8(&digits.bytes).unwrap_or("0")
}

struct Digits {
    bytes: [u8; 16],
    len: usize,
}

impl Write for Digits {
    fn write_str(&mut self, text: &str) -> core::fmt::Result {
        for byte in text.bytes() {
            *self.bytes.get_mut(self.len).ok_or(core::fmt::Error)? = byte;
            self.len += 1;
        }
        Ok(())
    }
}

impl Port {
    pub(crate) fn new(usb: Peri<'static, USB>) -> Self {
        static CONFIGURATION: StaticCell<[u8; 256]> = StaticCell::new();
        static CAPABILITIES: StaticCell<[u8; 64]> = StaticCell::new();
        static CONTROL: StaticCell<[u8; 64]> = StaticCell::new();
        static STATE: StaticCell<State> = StaticCell::new();
        // Numbers of pid.codes for tests. A vendor of boards has to request its own.
        let mut config = Config::new(0x1209, 0x0001);
        config.manufacturer = Some("TwinTac");
        config.product = Some("TwinTac tactile sensor");
        config.serial_number = Some(serial_number());
        let mut builder = Builder::new(
            Driver::new(usb, Irqs),
            config,
            CONFIGURATION.init([0; 256]),
            CAPABILITIES.init([0; 64]),
            &mut [],
            CONTROL.init([0; 64]),
        );
        let class = CdcAcmClass::new(&mut builder, STATE.init(State::new()), PACKET);
        let (sender, receiver) = class.split();
        Self {
            device: builder.build(),
            sender,
            receiver,
        }
    }
}

/// Sends the lines of all rounds whenever a host is connected.
pub(crate) async fn send(mut sender: Sender<'static, UsbDriver>) -> ! {
    loop {
        sender.wait_connection().await;
        LINES.clear(); // lines that waited for a host are out of date
        while send_one(&mut sender).await.is_ok() {}
    }
}

async fn send_one(sender: &mut Sender<'static, UsbDriver>) -> Result<(), EndpointError> {
    let line = LINES.receive().await;
    let mut packets = line.as_bytes().chunks(usize::from(PACKET)).peekable();
    while let Some(packet) = packets.next() {
        sender.write_packet(packet).await?;
        if packet.len() == usize::from(PACKET) && packets.peek().is_none() {
            sender.write_packet(&[]).await?; // a full last packet does not end a transfer; an empty one does
        }
    }
    Ok(())
}

/// Receives bytes of the host.
pub(crate) async fn hear(mut receiver: Receiver<'static, UsbDriver>) -> ! {
    let mut packet = [0; PACKET as usize];
    loop {
        receiver.wait_connection().await;
        while let Ok(n) = receiver.read_packet(&mut packet).await {
            HEARD.write_all(packet.get(..n).unwrap_or_default()).await;
        }
    }
}
