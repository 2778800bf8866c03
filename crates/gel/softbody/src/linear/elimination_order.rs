//! The order in which nodes are eliminated: nested dissection by coordinates (George, SIAM J.
//! Numer. Anal. 10, 1973).
//!
//! A set of nodes is cut by a plane. The nodes on one side that touch the other side separate the
//! two halves, and are eliminated after both. On bodies of gel this leaves less fill than minimum
//! degree, and its separators form large dense blocks.

use glam::DVec3;

/// Sets of this size are not cut further.
const LEAF: usize = 24;

/// Nodes in the order of elimination, and the numbers of nodes in the two halves that come first
/// and do not touch each other. `neighbours[n]` are the nodes that share a tetrahedron with node
/// `n`.
pub(crate) fn elimination_order(positions_mm: &[DVec3], neighbours: &[Vec<u32>]) -> (Vec<u32>, [usize; 2]) {
    let mut order = Vec::with_capacity(positions_mm.len());
    let mut side = vec![0; positions_mm.len()];
    let all = (0..positions_mm.len() as u32).collect();
    let halves = dissect(all, positions_mm, neighbours, &mut side, &mut 0, &mut order);
    (order, halves)
}

fn dissect(
    nodes: Vec<u32>,
    positions_mm: &[DVec3],
    neighbours: &[Vec<u32>],
    side: &mut [u32],
    last_mark: &mut u32,
    order: &mut Vec<u32>,
) -> [usize; 2] {
    if nodes.len() <= LEAF {
        order.extend(nodes);
        return [0, 0];
    }
    let best = (0..3)
        .map(|axis| {
            *last_mark += 1;
            cut(&nodes, axis, positions_mm, neighbours, side, *last_mark)
        })
        .min_by_key(|[low, high, separator]| separator.len() * nodes.len() + low.len().max(high.len()));
    match best {
        Some([low, high, separator]) if !low.is_empty() && !high.is_empty() => {
            let halves = [low.len(), high.len()];
            dissect(low, positions_mm, neighbours, side, last_mark, order);
            dissect(high, positions_mm, neighbours, side, last_mark, order);
            order.extend(separator);
            halves
        }
        _ => {
            order.extend(nodes);
            [0, 0]
        }
    }
}

/// Cuts a set in two along an axis: the nodes below, those above, and those below that touch the
/// ones above.
fn cut(
    nodes: &[u32],
    axis: usize,
    positions_mm: &[DVec3],
    neighbours: &[Vec<u32>],
    side: &mut [u32],
    mark: u32,
) -> [Vec<u32>; 3] {
    let along = |node: u32| positions_mm[node as usize][axis];
    let mut sorted = nodes.to_vec();
    sorted.sort_by(|&a, &b| along(a).total_cmp(&along(b)).then(a.cmp(&b)));
    // Moves the cut from the middle of a plane of nodes to the nearer end of the plane.
    let middle = along(sorted[sorted.len() / 2]);
    let span = along(sorted[sorted.len() - 1]) - along(sorted[0]);
    let first = sorted.partition_point(|&node| along(node) < middle - 1e-6 * span);
    let after = sorted.partition_point(|&node| along(node) <= middle + 1e-6 * span);
    let split = if sorted.len() / 2 - first < after - sorted.len() / 2 && first > 0 {
        first
    } else {
        after
    };
    let (low, high) = sorted.split_at(split);
    high.iter().for_each(|&node| side[node as usize] = mark);
    let (separator, low) = low.iter().partition(|&&node| {
        neighbours[node as usize]
            .iter()
            .any(|&other| side[other as usize] == mark)
    });
    [low, high.to_vec(), separator]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_node_is_eliminated_once() {
        let n = 500;
        let positions: Vec<DVec3> = (0..n)
            .map(|i| DVec3::new(f64::from(i % 10), f64::from(i / 10 % 10), f64::from(i / 100)))
            .collect();
        let neighbours: Vec<Vec<u32>> = positions
            .iter()
            .map(|a| {
                (0..n as u32)
                    .filter(|&b| a.distance(positions[b as usize]) < 1.5)
                    .collect()
            })
            .collect();
        let (mut order, [low, high]) = elimination_order(&positions, &neighbours);
        let (low, high) = order[..low + high].split_at(low);
        let touches = |node: &u32| {
            neighbours[*node as usize]
                .iter()
                .any(|other| high.contains(other))
        };
        assert!(!low.is_empty() && !low.iter().any(touches));
        order.sort_unstable();
        assert_eq!(order, (0..n as u32).collect::<Vec<_>>());
    }
}
