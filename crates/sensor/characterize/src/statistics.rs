//! Means, standard deviations, lines and tables.

/// The mean. `None` for an empty slice.
pub(crate) fn mean(values: &[f64]) -> Option<f64> {
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}

/// Standard deviation of a sample with `n - 1` degrees of freedom. `None` for fewer than two
/// values.
pub(crate) fn deviation(values: &[f64]) -> Option<f64> {
    let middle = mean(values)?;
    let squares: f64 = values.iter().map(|value| (value - middle).powi(2)).sum();
    (values.len() > 1).then(|| (squares / (values.len() - 1) as f64).sqrt())
}

/// The median. `None` for an empty slice.
pub(crate) fn median(values: &[f64]) -> Option<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let half = sorted.len() / 2;
    match sorted.len() {
        0 => None,
        n if n % 2 == 1 => Some(sorted[half]),
        _ => Some(0.5 * (sorted[half - 1] + sorted[half])),
    }
}

/// Slope and offset of the least-squares line `y = slope · x + offset`. `None` without two
/// different `x`.
pub(crate) fn line(points: &[[f64; 2]]) -> Option<[f64; 2]> {
    let n = points.len() as f64;
    let [mut x_mean, mut y_mean] = [0.0, 0.0];
    for [x, y] in points {
        x_mean += x / n;
        y_mean += y / n;
    }
    let (mut xx, mut xy) = (0.0, 0.0);
    for [x, y] in points {
        xx += (x - x_mean).powi(2);
        xy += (x - x_mean) * (y - y_mean);
    }
    (xx > 0.0).then(|| [xy / xx, y_mean - xy / xx * x_mean])
}

/// Means of the points in equal steps of `x` from 0 to `end`. Steps without points are left out.
pub(crate) fn binned(points: &[[f64; 2]], end: f64, bins: usize) -> Vec<[f64; 2]> {
    let mut sums = vec![(0.0, 0.0, 0_u32); bins];
    for [x, y] in points.iter().filter(|[x, _]| (0.0..=end).contains(x)) {
        let bin = ((x / end * bins as f64) as usize).min(bins - 1);
        let (x_sum, y_sum, count) = &mut sums[bin];
        *x_sum += x;
        *y_sum += y;
        *count += 1;
    }
    let filled = sums.into_iter().filter(|(_, _, count)| *count > 0);
    filled
        .map(|(x, y, count)| [x / f64::from(count), y / f64::from(count)])
        .collect()
}

/// Linear interpolation in a table with increasing `x`. `None` outside the table.
pub(crate) fn between(table: &[[f64; 2]], x: f64) -> Option<f64> {
    let after = table.partition_point(|point| point[0] < x);
    let right = table.get(after)?;
    if right[0] == x {
        return Some(right[1]);
    }
    let left = table.get(after.checked_sub(1)?)?;
    Some(left[1] + (right[1] - left[1]) * (x - left[0]) / (right[0] - left[0]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_answers() {
        assert_eq!(mean(&[1.0, 2.0, 6.0]), Some(3.0));
        assert_eq!(deviation(&[1.0, 3.0]), Some(2.0_f64.sqrt()));
        assert_eq!((deviation(&[1.0]), mean(&[])), (None, None));
        assert_eq!(
            (median(&[5.0, 1.0, 3.0]), median(&[4.0, 2.0])),
            (Some(3.0), Some(3.0))
        );
        let [slope, offset] = line(&[[0.0, 1.0], [1.0, 3.0], [2.0, 5.0]]).unwrap();
        assert!((slope - 2.0).abs() < 1e-12 && (offset - 1.0).abs() < 1e-12);
        assert_eq!(line(&[[1.0, 1.0], [1.0, 2.0]]), None);
    }

    #[test]
    fn a_table_is_read_between_its_points_and_not_beyond() {
        let table = binned(&[[0.1, 1.0], [0.3, 3.0], [1.2, 5.0], [9.0, 9.0]], 2.0, 2);
        assert_eq!(table, [[0.2, 2.0], [1.2, 5.0]]);
        assert!((between(&table, 0.7).unwrap() - 3.5).abs() < 1e-12);
        assert_eq!((between(&table, 0.1), between(&table, 1.3)), (None, None));
    }
}
