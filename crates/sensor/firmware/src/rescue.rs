//! Freeing a bus that hangs.

use phystac::recovery::RecoveryError;

/// Frees a bus: clocks first, as a chip that holds it gets them only while its channel is open; then the switch's RESET, which closes all
/// channels; and clocks once more if the bus was still held before.
///
/// `clock_out` gives nine clocks and a STOP, and sees whether both lines are high; `reset` pulls RESET low for a moment, if it is wired.
///
/// # Errors
/// A line that stays low, or a pin that does not do as it is told.
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
