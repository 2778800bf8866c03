//! Settings of a map.

/// The radial basis function around each taxel. A map is a weighted sum of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kernel {
    /// A Gaussian, as in the paper: the map falls to the baseline away from the taxels.
    #[default]
    Gaussian,
    /// `r² ln r` and a plane: the surface through the readings with the least bending energy
    /// (Duchon 1977). It has no width. Beyond the taxels it continues as a slope.
    ThinPlate,
}

/// How the weights of the taxels' functions are found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Weights {
    /// The weight is the reading above the baseline, as in the paper: contributions of neighbours
    /// add up at the taxels. Requires [`Kernel::Gaussian`].
    Readings,
    /// The weights are solved so that the map passes through every taxel's reading above the
    /// baseline.
    Interpolating,
    /// The weights minimise the sum of squared errors at the taxels plus this factor times the
    /// roughness of the map (`wᵀ K w`), for noisy readings (ridge regression; smoothing spline,
    /// Wahba 1990). 0 interpolates. The kernel has no unit.
    Regularised(f64),
}

/// Settings of a map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapSettings {
    /// Columns and rows of the grid.
    pub grid: [usize; 2],
    /// The function around each taxel.
    pub kernel: Kernel,
    /// Standard deviation of the Gaussian, mm. `None`: if weights are solved, the width with the
    /// smallest leave-one-out error; else half the pitch of the taxels.
    pub width_mm: Option<f64>,
    /// How the weights are found.
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
