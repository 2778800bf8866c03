//! Chance, by name.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// A stream of random numbers that depends on the seed and a name alone, so that nothing depends on the order of work.
#[derive(Debug)]
pub(crate) struct Chance(ChaCha8Rng);

impl Chance {
    pub(crate) fn new(seed: u64, name: &str) -> Self {
        // FNV-1a; the stream's number keeps equal seeds apart by name.
        let hash = name.bytes().fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
        });
        let mut stream = ChaCha8Rng::seed_from_u64(seed);
        stream.set_stream(hash);
        Self(stream)
    }

    /// A normally distributed number (Box and Muller 1958).
    pub(crate) fn normal(&mut self, deviation: f64) -> f64 {
        let radius: f64 = 1.0 - self.0.random::<f64>();
        let angle: f64 = self.0.random::<f64>();
        deviation * (-2.0 * radius.ln()).sqrt() * (std::f64::consts::TAU * angle).cos()
    }
}
