//! Reproducible streams of random numbers, each given by a seed and a name.
//!
//! Input: a seed and a name. Output: a [`RandomStream`], a generator for the crate `rand`.
//! [`normal`] draws normally distributed numbers from it.
//!
//! # How it works
//!
//! A stream depends on its seed and its name alone, never on the order of work: presses that are
//! computed in parallel draw the same numbers as presses that are computed one after the other, and
//! a new stream does not change the others.
//!
//! There are two ways from a seed and a name to a stream, because numbers that were drawn once must
//! stay as they are: the training of the twin and of the surrogate of the gel, and data sets, use
//! [`digest_stream`]; press protocols, emulated devices, the emulated bench and the rest use
//! [`stream`].
//!
//! Normal numbers are made here by the method of Box and Muller: `rand_distr` uses another method,
//! and every emulated recording would change with it.
//!
//! This crate knows neither sensors nor files.
//!
//! ```
//! use twintac_random::{normal, stream};
//!
//! let mut noise = stream(1, "press 7");
//! let reading_kpa = 20.0 + normal(&mut noise, 0.1);
//! # assert_eq!(reading_kpa, 20.0 + normal(&mut stream(1, "press 7"), 0.1));
//! ```

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sha2::{Digest, Sha256};

/// A generator of random numbers: ChaCha with 8 rounds.
pub type RandomStream = ChaCha8Rng;

/// The stream of a seed and a name: the seed is the key of ChaCha, and the 64-bit FNV-1a hash of
/// the name is the number of the stream.
#[must_use]
pub fn stream(seed: u64, name: &str) -> RandomStream {
    let hash = name.bytes().fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    });
    let mut stream = ChaCha8Rng::seed_from_u64(seed);
    stream.set_stream(hash);
    stream
}

/// The stream of a seed and a name: the key of ChaCha is the SHA-256 digest of both.
#[must_use]
pub fn digest_stream(seed: u64, name: &str) -> RandomStream {
    let mut hash = Sha256::new();
    hash.update(seed.to_le_bytes());
    hash.update(name.as_bytes());
    ChaCha8Rng::from_seed(hash.finalize().into())
}

/// A normally distributed number with mean zero and the given standard deviation, in the unit of
/// the deviation (Box and Muller, 1958).
///
/// `rand_distr` draws normal numbers by another method (ziggurat): with it, every emulated
/// recording would change.
pub fn normal(random: &mut impl Rng, deviation: f64) -> f64 {
    let radius: f64 = 1.0 - random.random::<f64>();
    let angle: f64 = random.random();
    deviation * (-2.0 * radius.ln()).sqrt() * (std::f64::consts::TAU * angle).cos()
}

#[cfg(test)]
mod tests {
    use rand::RngCore;

    use super::*;

    /// Existing recordings and networks were made with these numbers.
    #[test]
    fn streams_stay_as_they_are() {
        let first = |mut stream: RandomStream| [stream.next_u64(), stream.next_u64()];
        assert_eq!(
            first(stream(1, "force")),
            [0x1ea9_3c62_6cdd_1778, 0x9d8d_c359_66bc_4174]
        );
        assert_eq!(
            first(stream(1, "")),
            [0xa2dc_e3cb_d39c_17c6, 0x32ad_d84f_aafd_e730]
        );
        assert_eq!(
            first(digest_stream(1, "force")),
            [0x4f95_aa87_f76a_66dc, 0xa060_8f5d_cca0_5683]
        );
        assert_eq!(
            normal(&mut stream(1, "force"), 2.0).to_bits(),
            0xbfe8_307f_7943_27a8
        );
    }

    #[test]
    fn names_give_independent_repeatable_normals() {
        let draw = |name: &str| -> Vec<f64> {
            let mut random = stream(1, name);
            (0..4000).map(|_| normal(&mut random, 2.0)).collect()
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
