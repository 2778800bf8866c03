//! Who stands at the bench.

use twintac_protocol::PressPlan;

/// A person at the bench, or what stands in for one. Both are called with the robot at rest.
pub trait Operator {
    /// Is asked to mount an indenter: again and again while the answer is [`Mounting::Waiting`], so it must return at once. All devices are
    /// heard meanwhile.
    fn mount(&mut self, indenter: &str) -> Mounting;

    /// A press begins; its number counts from 0.
    fn begin(&mut self, index: usize, plan: &PressPlan);
}

/// Whether an indenter is mounted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mounting {
    /// It is, and nobody is near the robot: it may move.
    Mounted,
    /// Not yet.
    Waiting,
    /// It will not be: the run stops.
    Refused,
}

/// All indenters are mounted already.
impl<F: FnMut(usize, &PressPlan)> Operator for F {
    fn mount(&mut self, _: &str) -> Mounting {
        Mounting::Mounted
    }

    fn begin(&mut self, index: usize, plan: &PressPlan) {
        self(index, plan);
    }
}
