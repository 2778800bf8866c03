//! Frees a bus that hangs.

use phystac::recovery::RecoveryError;

/// Frees a bus. It sends clocks first, because a chip that holds the bus gets them only while its
/// channel is open. Then it pulses the switch's RESET, which closes all channels. It sends clocks
/// again if the first ones did not free the bus.
///
/// `clock_out` sends nine clocks and a STOP, and checks that both lines are high. `reset` pulses
/// RESET low, if it is wired.
///
/// # Errors
/// A line stays low, or a pin fails.
pub fn rescue(
    mut clock_out: impl FnMut() -> Result<(), RecoveryError>,
    reset: impl FnOnce() -> Result<(), RecoveryError>,
) -> Result<(), RecoveryError> {
    let clocked = clock_out();
    reset()?;
    match clocked {
        Ok(()) => Ok(()),
        Err(_) => clock_out(),
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use std::cell::RefCell;
    use std::vec::Vec;

    use super::*;

    #[test]
    fn clocks_come_before_the_reset_and_again_if_they_did_not_help() {
        for (first, expected) in [
            (Ok(()), &["clocks", "reset"][..]),
            (Err(RecoveryError::DataHeldLow), &["clocks", "reset", "clocks"]),
        ] {
            let done = RefCell::new(Vec::new());
            let clock_out = || {
                done.borrow_mut().push("clocks");
                if done.borrow().len() == 1 { first } else { Ok(()) }
            };
            let reset = || {
                done.borrow_mut().push("reset");
                Ok(())
            };
            assert_eq!(rescue(clock_out, reset), Ok(()));
            assert_eq!(*done.borrow(), expected);
        }
    }
}
