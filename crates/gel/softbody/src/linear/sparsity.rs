//! Numbering and sparsity of the coarse system.

/// For each pair of corners, at `a (a + 1) / 2 + b`: whether the first is eliminated later, and
/// where its rows begin in the columns of the other.
pub(super) type TetBlocks = [(bool, u32); 10];

/// Number of unknowns of a node: its pressure, and for a free node its displacement.
pub(super) fn unknowns(free: &[bool], node: u32) -> u32 {
    if free[node as usize] { 4 } else { 1 }
}

/// Nodes that share a tetrahedron with each node, including itself, ascending.
pub(super) fn neighbours(n_nodes: usize, corners: &[[u32; 4]]) -> Vec<Vec<u32>> {
    let mut neighbours: Vec<Vec<u32>> = vec![Vec::new(); n_nodes];
    for corners in corners {
        for &node in corners {
            neighbours[node as usize].extend(corners);
        }
    }
    for neighbours in &mut neighbours {
        neighbours.sort_unstable();
        neighbours.dedup();
    }
    neighbours
}

/// Positions of the nodes, and of their unknowns, in the order of elimination.
pub(super) struct Numbering {
    pub(super) rank: Vec<u32>,
    pub(super) first: Vec<u32>,
    pub(super) n_unknowns: u32,
}

impl Numbering {
    pub(super) fn new(order: &[u32], free: &[bool]) -> Self {
        let (mut rank, mut first) = (vec![0; order.len()], vec![0; order.len()]);
        let mut n_unknowns = 0;
        for (position, &node) in order.iter().enumerate() {
            rank[node as usize] = position as u32;
            first[node as usize] = n_unknowns;
            n_unknowns += unknowns(free, node);
        }
        Self {
            rank,
            first,
            n_unknowns,
        }
    }
}

/// Where the lower triangle has entries, column by column.
pub(super) struct Sparsity {
    pub(super) columns: Vec<u32>,
    pub(super) rows: Vec<u32>,
    pub(super) later: Vec<Vec<(u32, u32)>>,
}

impl Sparsity {
    pub(super) fn new(
        order: &[u32],
        neighbours: &[Vec<u32>],
        free: &[bool],
        rank: &[u32],
        first: &[u32],
    ) -> Self {
        let mut columns = vec![0];
        let mut rows = Vec::new();
        let mut later: Vec<Vec<(u32, u32)>> = vec![Vec::new(); order.len()];
        for &node in order {
            let mut below: Vec<u32> = neighbours[node as usize]
                .iter()
                .copied()
                .filter(|&n| rank[n as usize] >= rank[node as usize])
                .collect();
            below.sort_unstable_by_key(|&n| rank[n as usize]);
            let mut offset = 0;
            for &n in &below {
                later[node as usize].push((n, offset));
                offset += unknowns(free, n);
            }
            for column in 0..unknowns(free, node) {
                let unknowns_below = below
                    .iter()
                    .flat_map(|&n| (0..unknowns(free, n)).map(move |row| (n, row)));
                rows.extend(
                    unknowns_below
                        .skip(column as usize)
                        .map(|(n, row)| first[n as usize] + row),
                );
                columns.push(rows.len() as u32);
            }
        }
        Self { columns, rows, later }
    }
}

/// Where the blocks of a tetrahedron are added.
pub(super) fn tet_blocks(corners: &[u32; 4], rank: &[u32], later: &[Vec<(u32, u32)>]) -> TetBlocks {
    let offset = |row: u32, column: u32| {
        let blocks = &later[column as usize];
        let block = blocks.iter().find(|(n, _)| *n == row);
        block.expect("the nodes of a tetrahedron are neighbours").1
    };
    let mut blocks = [(true, 0); 10];
    for a in 0..4 {
        for b in 0..=a {
            let (row, column) = (corners[a], corners[b]);
            let is_later = rank[row as usize] >= rank[column as usize];
            let at = if is_later {
                offset(row, column)
            } else {
                offset(column, row)
            };
            blocks[a * (a + 1) / 2 + b] = (is_later, at);
        }
    }
    blocks
}
