//! Clocks for a part that holds the bus.

use embedded_hal::delay::DelayNs;
use esp_hal::Async;
use esp_hal::delay::Delay;
use esp_hal::i2c::master::I2c;
use phystac::recovery::RecoveryError;

/// Half a clock at 100 kHz.
const HALF_CLOCK_US: u32 = 5;

/// Gives nine clocks and a STOP: whoever holds the data line ends its byte. The peripheral lets both lines be forced, and does not say what level
/// they have: whether the bus is free is seen in the next round.
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
