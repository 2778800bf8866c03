//! How a map is made.

/// The function around each taxel that a map is a weighted sum of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kernel {
    /// A Gaussian, as in the paper: the map fades to the baseline away from the taxels.
    #[default]
    Gaussian,
    /// `r² ln r` and a plane: the surface through the readings that bends least (Duchon 1977). It has no width, and goes on as a
    /// slope beyond the taxels.
    ThinPlate,
}

/// How the weight of each taxel's function is found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Weights {
    /// The weight is the reading above the baseline, as in the paper: neighbours add up at the taxels. Wants [`Kernel::Gaussian`].
    Readings,
    /// The weights are solved so that the map meets every taxel's reading above the baseline.
    Interpolating,
    /// The weights are solved so that squared misses at the taxels, and this many times the map's roughness (`wᵀ K w`), are least:
    /// for noisy readings (ridge regression; smoothing spline, Wahba 1990). 0 interpolates; the kernel has no unit.
    Regularised(f64),
}

/// How to draw a map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapSettings {
    /// Columns and rows of the grid.
    pub grid: [usize; 2],
    /// The function around each taxel.
    pub kernel: Kernel,
    /// Standard deviation of the Gaussian, mm. `None`: where weights are solved, the one with which each taxel is told best by the others;
    /// else half the pitch of the taxels.
    pub width_mm: Option<f64>,
    /// How weights are found.
    pub weights: Weights,
}

impl Default for MapSettings {
    fn default() -> Self {
        MapSettings {
            grid: [96, 64],
            kernel: Kernel::Gaussian,
            width_mm: None,
            weights: Weights::Interpolating,
        }
    }
}
