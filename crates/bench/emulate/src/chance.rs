//! Chance, by name.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// A stream of random numbers that depends on the seed and a name alone, so that nothing depends on the order of work.
#[derive(Debug)]
pub struct Chance(ChaCha8Rng);

impl Chance {
    /// The stream of a seed and a name.
    #[must_use]
    pub fn new(seed: u64, name: &str) -> Self {
        // FNV-1a; the stream's number keeps equal seeds apart by name.
        let hash = name.bytes().fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
        });
        let mut stream = ChaCha8Rng::seed_from_u64(seed);
        stream.set_stream(hash);
        Self(stream)
    }

    /// The next number of a normal distribution about zero with a standard deviation (Box and Muller 1958).
    pub fn normal(&mut self, deviation: f64) -> f64 {
        let radius: f64 = 1.0 - self.0.random::<f64>();
        let angle: f64 = self.0.random::<f64>();
        deviation * (-2.0 * radius.ln()).sqrt() * (std::f64::consts::TAU * angle).cos()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_give_independent_repeatable_normals() {
        let draw = |name: &str| -> Vec<f64> {
            let mut chance = Chance::new(1, name);
            (0..4000).map(|_| chance.normal(2.0)).collect()
        };
        let (a, b) = (draw("a"), draw("b"));
        assert_eq!(a, draw("a"));
        assert_ne!(a, b);
        let mean = a.iter().sum::<f64>() / 4000.0;
        let variance = a.iter().map(|x| x * x).sum::<f64>() / 4000.0;
        let correlation = a.iter().zip(&b).map(|(x, y)| x * y).sum::<f64>() / 4000.0;
        assert!(mean.abs() < 0.15 && (variance - 4.0).abs() < 0.4 && correlation.abs() < 0.3);
    }
}
