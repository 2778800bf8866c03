//! Static nonlinearity of a port: its reading is proportional to small pressures in the gel, then
//! steeper or flatter.
//!
//! A port that holds a bubble of air, or that the gel fills only under load, reads a larger
//! fraction of a large pressure than of a small one. With the elastic reading e = gain × pressure,
//! the port reads e (1 + s e) for s ≥ 0 and e / (1 - s e) for s < 0, which never falls. Tension is
//! read proportionally.

/// The reading, in the unit of `elastic`.
pub(crate) fn reading(stiffening: f64, elastic: f64) -> f64 {
    if elastic <= 0.0 {
        elastic
    } else if stiffening >= 0.0 {
        elastic * (1.0 + stiffening * elastic)
    } else {
        elastic / (1.0 - stiffening * elastic)
    }
}

/// Derivatives of the reading with respect to the elastic reading and to the stiffening.
pub(crate) fn slopes(stiffening: f64, elastic: f64) -> [f64; 2] {
    if elastic <= 0.0 {
        [1.0, 0.0]
    } else if stiffening >= 0.0 {
        [1.0 + 2.0 * stiffening * elastic, elastic * elastic]
    } else {
        let share = 1.0 / (1.0 - stiffening * elastic);
        [share * share, (elastic * share).powi(2)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slopes_are_quotients_of_differences_and_readings_never_fall() {
        for stiffening in [-0.4, 0.0, 0.7] {
            for elastic in [-1.3, 0.2, 2.5] {
                let step = 1e-6;
                let by_elastic = (reading(stiffening, elastic + step) - reading(stiffening, elastic - step))
                    / (2.0 * step);
                let by_stiffening =
                    (reading(stiffening + step, elastic) - reading(stiffening, elastic)) / step;
                let found = slopes(stiffening, elastic);
                assert!((found[0] - by_elastic).abs() < 1e-6 && (found[1] - by_stiffening).abs() < 1e-4);
                assert!(found[0] > 0.0);
            }
        }
    }
}
