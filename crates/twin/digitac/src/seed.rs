//! Random streams, each with a name, so that adding one does not change the others.

pub(crate) use twintac_random::digest_stream as stream;

/// A number of the standard normal distribution.
pub(crate) fn normal(random: &mut impl rand::Rng) -> f64 {
    twintac_random::normal(random, 1.0)
}
