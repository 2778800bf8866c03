//! Which rows of a first layer are used by which port, for which point of the grids.

use std::collections::BTreeMap;

use glam::DVec2;

use crate::layout::Layout;

/// Which points are in the patches of which ports. A *place* is a position in a patch, relative to
/// the port.
#[derive(Clone, Debug)]
pub(super) struct Places {
    /// Sorted by point.
    uses: Vec<Use>,
    /// Where the uses of each point begin, and where those of the last one end. `[n_points + 1]`
    first_use: Vec<u32>,
    /// Number of uses of all places before each place, and of all places. `[n_places + 1]`
    before: Vec<u32>,
}

/// A port that has a point of a grid in its patch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Use {
    /// Number of the place in the patch, whose rows multiply the features.
    pub(super) place: u32,
    pub(super) port: u32,
    /// Number of uses of all places before that one.
    pub(super) before: u32,
}

impl Places {
    /// From uses with their points, and the numbers of places and points.
    fn of(mut uses: Vec<(u32, Use)>, n_places: usize, n_points: usize) -> Self {
        uses.sort_by_key(|(point, pair)| (*point, pair.port));
        let first_use = |point| uses.partition_point(|pair| pair.0 < point as u32) as u32;
        let first_use = (0..=n_points).map(first_use).collect();
        let mut before = vec![0; n_places + 1];
        for (_, pair) in &uses {
            before[pair.place as usize + 1] += 1;
        }
        for place in 0..n_places {
            before[place + 1] += before[place];
        }
        for (_, pair) in &mut uses {
            pair.before = before[pair.place as usize];
        }
        Self {
            first_use,
            uses: uses.into_iter().map(|(_, pair)| pair).collect(),
            before,
        }
    }

    /// One port that has every point of the first grid in its patch.
    pub(super) fn everywhere(layout: &Layout) -> Self {
        let n_places = layout.grid().len();
        let point = |number: u32| {
            (
                number,
                Use {
                    place: number,
                    port: 0,
                    before: 0,
                },
            )
        };
        Self::of(
            (0..n_places as u32).map(point).collect(),
            n_places,
            layout.n_points(),
        )
    }

    /// The patches of ports. A port that lies on none of the grids gets rows of its own on the
    /// first grid, which are appended to `rows`, `[n_places][n_own]`: the inputs between the points
    /// are interpolated linearly. Ports with the same offset within their cells share these rows.
    pub(super) fn around(ports_mm: &[DVec2], layout: &Layout, rows: &mut Vec<f32>, n_own: usize) -> Self {
        let mut known = BTreeMap::new();
        let mut uses = Vec::new();
        for (port, at) in ports_mm.iter().enumerate() {
            let number = layout.grid_at(*at).unwrap_or(0);
            let grid = &layout.grids[number];
            let first = layout.first_point(number);
            let (cell, part) = grid.cell(*at);
            // In millionths of the spacing.
            let behind = [part.x, part.y].map(|part| (1e6 * part).round() as i64);
            let places = known
                .entry(behind)
                .or_insert_with(|| places_behind(part, layout, rows, n_own));
            for (offset, place) in places {
                let point = grid.point([cell[0] + offset[0], cell[1] + offset[1]]);
                uses.extend(point.map(|point| {
                    let (place, port) = (*place, port as u32);
                    let before = 0;
                    ((first + point) as u32, Use { place, port, before })
                }));
            }
        }
        Self::of(uses, rows.len() / n_own, layout.n_points())
    }

    #[inline(always)]
    pub(super) fn of_point(&self, point: u32) -> &[Use] {
        let [first, end] = [0, 1].map(|next| self.first_use[point as usize + next] as usize);
        &self.uses[first..end]
    }

    /// Number of uses of the places before a place.
    #[inline(always)]
    pub(super) fn before(&self, place: usize) -> usize {
        self.before[place] as usize
    }

    pub(super) fn n(&self) -> usize {
        self.before.len() - 1
    }

    pub(super) fn n_uses(&self) -> usize {
        self.uses.len()
    }
}

/// The places of a port with this offset within its cell, by their offsets from the cell: those of
/// the patch, or new ones that are interpolated between them.
fn places_behind(part: DVec2, layout: &Layout, rows: &mut Vec<f32>, n_own: usize) -> BTreeMap<[i32; 2], u32> {
    let offsets = layout.patch.offsets.iter().enumerate();
    if part.length() < 1e-6 {
        return offsets.map(|(place, offset)| (*offset, place as u32)).collect();
    }
    let mut between: BTreeMap<[i32; 2], Vec<f32>> = BTreeMap::new();
    for corner in [[0, 0], [1, 0], [0, 1], [1, 1]] {
        let along = |axis: usize| {
            if corner[axis] == 1 {
                part[axis]
            } else {
                1.0 - part[axis]
            }
        };
        let share = along(0) * along(1);
        if share < 1e-6 {
            continue;
        }
        for (place, offset) in offsets.clone() {
            let from_cell = [0, 1].map(|axis| offset[axis] + corner[axis]);
            let own = between.entry(from_cell).or_insert_with(|| vec![0.0; n_own]);
            for (own, row) in own.iter_mut().zip(&rows[place * n_own..]) {
                *own += share as f32 * row;
            }
        }
    }
    let mut places = BTreeMap::new();
    for (from_cell, own) in between {
        places.insert(from_cell, (rows.len() / n_own) as u32);
        rows.extend(own);
    }
    places
}
