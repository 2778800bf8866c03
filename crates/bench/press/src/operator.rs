//! The person at the test setup.

use twintac_protocol::PressPlan;

/// A person at the test setup, or a replacement. Both functions are called with the robot at rest.
pub trait Operator {
    /// Asks to mount an indenter. It is called again while the answer is [`Mounting::Waiting`], so
    /// it must return at once. All devices are heard meanwhile.
    fn mount(&mut self, indenter: &str) -> Mounting;

    /// A press begins; its number counts from 0.
    fn begin(&mut self, index: usize, plan: &PressPlan);
}

/// Whether an indenter is mounted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mounting {
    /// It is mounted and nobody is near the robot, so the robot may move.
    Mounted,
    /// Not yet.
    Waiting,
    /// It will not be mounted: the run stops.
    Refused,
}

/// All indenters are already mounted.
impl<F: FnMut(usize, &PressPlan)> Operator for F {
    fn mount(&mut self, _: &str) -> Mounting {
        Mounting::Mounted
    }

    fn begin(&mut self, index: usize, plan: &PressPlan) {
        self(index, plan);
    }
}
