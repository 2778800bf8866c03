//! A contact in a few numbers that do not depend on where on the gel it is, and little on how it is turned about the vertical.

use crate::contact::N_CHANNELS;
use crate::surface::SurfaceGrid;

/// Numbers for each height at which distances are taken.
const N_OF_LEVEL: usize = 5;

/// Numbers of a contact.
pub(crate) const N_TRAITS: usize = N_CHANNELS * N_OF_LEVEL;

/// How deep, how large, how steep and how scattered what touches is, at each height; `None` where nothing is near. A thin body may press with none of the
/// grid's points inside it: what is near counts.
///
/// `inputs` are those of a grid's points. `[n_points * N_CHANNELS]`
pub(crate) fn traits(grid: &SurfaceGrid, inputs: &[f32]) -> Option<[f32; N_TRAITS]> {
    let points = inputs.as_chunks::<N_CHANNELS>().0;
    let mut traits = [0.0; N_TRAITS];
    for (level, traits) in traits.as_chunks_mut::<N_OF_LEVEL>().0.iter_mut().enumerate() {
        *traits = of_level(grid, points, level);
    }
    (traits[0] > 0.0).then_some(traits)
}

fn of_level(grid: &SurfaceGrid, points: &[[f32; N_CHANNELS]], level: usize) -> [f32; N_OF_LEVEL] {
    let [n_x, n_y] = grid.n;
    let share = |i: usize, j: usize| points[j * n_x + i][level];
    let (mut deepest, mut near, mut inside, mut steps) = (0.0_f32, 0.0_f32, 0.0_f32, 0.0_f32);
    let (mut sum, mut squares) = ([0.0_f32; 2], 0.0_f32);
    for j in 0..n_y {
        for i in 0..n_x {
            let here = share(i, j);
            if here <= 0.0 {
                continue;
            }
            let [x, y] = [i as f32, j as f32];
            deepest = deepest.max(here);
            near += here;
            inside += (here - 1.0).max(0.0);
            sum = [sum[0] + here * x, sum[1] + here * y];
            squares += here * (x * x + y * y);
            let beside = [
                (i + 1 < n_x).then(|| share(i + 1, j)),
                (j + 1 < n_y).then(|| share(i, j + 1)),
            ];
            steps += beside
                .into_iter()
                .flatten()
                .map(|beside| (beside - here).abs())
                .sum::<f32>();
        }
    }
    if near <= 0.0 {
        return [0.0; N_OF_LEVEL];
    }
    let [x, y] = sum.map(|sum| sum / near);
    let spread = (squares / near - x * x - y * y).max(0.0);
    // Roots, so that a trait grows with a length of the contact.
    [deepest, near.sqrt(), inside.sqrt(), steps / near, spread.sqrt()]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layout::Layout;
    use twintac_sensor::SensorFile;

    #[test]
    fn traits_do_not_depend_on_the_place() {
        let sensor = SensorFile::phystac().unwrap().sensor;
        let layout = Layout::of(&sensor);
        let grid = layout.grid();
        let at = |column: usize, row: usize| {
            let mut inputs = vec![0.0; grid.len() * N_CHANNELS];
            for (i, j, share) in [(0, 0, 1.5), (1, 0, 1.2), (0, 1, 0.4)] {
                inputs[((row + j) * grid.n[0] + column + i) * N_CHANNELS] = share;
            }
            traits(grid, &inputs)
        };
        let (here, there) = (at(3, 3).unwrap(), at(8, 5).unwrap());
        for (here, there) in here.iter().zip(there) {
            assert!((here - there).abs() < 1e-3, "{here} {there}");
        }
        assert_eq!(traits(grid, &vec![0.0; grid.len() * N_CHANNELS]), None);
    }
}
