//! Shape-preserving interpolation of a table.

/// Monotone piecewise cubic through a table, known as PCHIP (Fritsch and Butland, SIAM J. Sci.
/// Stat. Comput. 5, 1984). It never overshoots the data.
#[derive(Clone, Debug)]
pub struct MonotoneCubic {
    x: Vec<f64>,
    y: Vec<f64>,
    slope: Vec<f64>,
}

impl MonotoneCubic {
    /// Interpolates `y` over strictly increasing `x`; `None` if there are no points, the lengths
    /// differ, or `x` does not increase.
    #[must_use]
    pub fn new(x: Vec<f64>, y: Vec<f64>) -> Option<Self> {
        if x.is_empty() || x.len() != y.len() || x.windows(2).any(|pair| pair[0] >= pair[1]) {
            return None;
        }
        let slope = slopes(&x, &y);
        Some(Self { x, y, slope })
    }

    /// The value at a point. Beyond the table's last point, it continues in a straight line with
    /// the slope at its end.
    #[must_use]
    pub(crate) fn straight_on(&self, x: f64) -> f64 {
        let last = self.x.len() - 1;
        self.at(x) + self.slope[last] * (x - self.x[last]).max(0.0)
    }

    /// The value at a point; beyond the table, the value at its end.
    #[must_use]
    pub fn at(&self, x: f64) -> f64 {
        let last = self.x.len() - 1;
        if x <= self.x[0] {
            return self.y[0];
        }
        if x >= self.x[last] {
            return self.y[last];
        }
        let i = self.x.partition_point(|&knot| knot <= x) - 1;
        let width = self.x[i + 1] - self.x[i];
        let t = (x - self.x[i]) / width;
        let (t2, t3) = (t * t, t * t * t);
        self.y[i] * (2.0 * t3 - 3.0 * t2 + 1.0)
            + self.slope[i] * width * (t3 - 2.0 * t2 + t)
            + self.y[i + 1] * (3.0 * t2 - 2.0 * t3)
            + self.slope[i + 1] * width * (t3 - t2)
    }
}

/// Weighted harmonic means of neighbouring secants, zero at an extremum; at the ends, the secant
/// itself.
fn slopes(x: &[f64], y: &[f64]) -> Vec<f64> {
    let n = x.len();
    if n == 1 {
        return vec![0.0];
    }
    let width: Vec<f64> = x.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let secant: Vec<f64> = y
        .windows(2)
        .zip(&width)
        .map(|(pair, h)| (pair[1] - pair[0]) / h)
        .collect();
    let mut slope = vec![0.0; n];
    slope[0] = secant[0];
    slope[n - 1] = secant[n - 2];
    for i in 1..n - 1 {
        let (left, right) = (secant[i - 1], secant[i]);
        if left * right > 0.0 {
            let (w1, w2) = (2.0 * width[i] + width[i - 1], width[i] + 2.0 * width[i - 1]);
            slope[i] = (w1 + w2) / (w1 / left + w2 / right);
        }
    }
    slope
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn knots_are_met_and_nothing_overshoots() {
        let x = vec![0.0, 0.3, 1.0, 1.2, 2.0];
        let y = vec![0.0, 0.1, 1.0, 1.0, 0.2];
        let curve = MonotoneCubic::new(x.clone(), y.clone()).unwrap();
        for (x, y) in x.iter().zip(&y) {
            assert!((curve.at(*x) - y).abs() < 1e-12);
        }
        for i in 0..=400 {
            let value = curve.at(f64::from(i) * 0.005);
            assert!((0.0..=1.0).contains(&value), "{value}");
        }
    }

    #[test]
    fn a_smooth_curve_is_followed_to_third_order() {
        let error = |n: i32| {
            let x: Vec<f64> = (0..=n).map(|i| f64::from(i) / f64::from(n)).collect();
            let y = x.iter().map(|x| x.exp()).collect();
            let curve = MonotoneCubic::new(x, y).unwrap();
            (10..90)
                .map(|i| f64::from(i) / 100.0)
                .map(|x| (curve.at(x) - x.exp()).abs())
                .fold(0.0, f64::max)
        };
        assert!(error(40) < error(10) / 16.0);
    }

    #[test]
    fn knots_that_do_not_increase_are_refused() {
        assert!(MonotoneCubic::new(vec![], vec![]).is_none());
        assert!(MonotoneCubic::new(vec![0.0, 0.0], vec![1.0, 2.0]).is_none());
        assert!(MonotoneCubic::new(vec![0.0], vec![1.0, 2.0]).is_none());
    }
}
