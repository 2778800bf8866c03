//! Systems of linear equations with a positive definite matrix.

/// Solves by Cholesky's method; only the lower triangle is read. Not faer's: `digitac` needs nothing else of faer, which takes longer to
/// compile than `digitac` itself, and these sums have the same order, and so the same bits, on every processor.
pub(crate) fn solve_symmetric(mut l: Vec<f64>, mut x: Vec<f64>) -> Vec<f64> {
    let n = x.len();
    for i in 0..n {
        for j in 0..=i {
            let dot: f64 = (0..j).map(|k| l[i * n + k] * l[j * n + k]).sum();
            let left = l[i * n + j] - dot;
            l[i * n + j] = if i == j {
                left.max(f64::MIN_POSITIVE).sqrt()
            } else {
                left / l[j * n + j]
            };
        }
    }
    for i in 0..n {
        let dot: f64 = (0..i).map(|k| l[i * n + k] * x[k]).sum();
        x[i] = (x[i] - dot) / l[i * n + i];
    }
    for i in (0..n).rev() {
        let dot: f64 = (i + 1..n).map(|k| l[k * n + i] * x[k]).sum();
        x[i] = (x[i] - dot) / l[i * n + i];
    }
    x
}
