//! Clock pulses that free a bus whose data line a part holds.

use embedded_hal::delay::DelayNs;
use esp_hal::Async;
use esp_hal::delay::Delay;
use esp_hal::i2c::master::I2c;
use phystac::recovery::RecoveryError;

/// Half a clock period at 100 kHz.
const HALF_CLOCK_US: u32 = 5;

/// Sends nine clock pulses and a STOP, so that a part that holds the data line ends its byte. The
/// peripheral can force both lines low, but does not report their level: the next round shows
/// whether the bus is free.
pub(crate) fn give(bus: &mut I2c<'_, Async>) -> Result<(), RecoveryError> {
    let mut delay = Delay::new();
    for _ in 0..9 {
        bus.force_scl_low(true);
        delay.delay_us(HALF_CLOCK_US);
        bus.force_scl_low(false);
        delay.delay_us(HALF_CLOCK_US);
    }
    bus.force_scl_low(true);
    bus.force_sda_low(true);
    delay.delay_us(HALF_CLOCK_US);
    bus.force_scl_low(false);
    delay.delay_us(HALF_CLOCK_US);
    bus.force_sda_low(false);
    delay.delay_us(HALF_CLOCK_US);
    Ok(())
}
