//! A net during routing: its pins, its paths, and which of them are connected.

use std::collections::HashMap;

use super::cells::cells_of;
use super::grid::{Grid, half_width, track_kind};
use super::{Track, Via, grid};
use crate::shapes::Shape;

/// A grid point on a layer.
pub(super) type Spot = (u8, u32);

/// A path through the grid. A change of layer is a via.
#[derive(Clone, Debug)]
pub(super) struct Path {
    pub(super) spots: Vec<Spot>,
    /// The kinds and nodes that it blocks for other nets.
    pub(super) cells: Vec<(u8, u32)>,
    /// Its straight segments as copper, with their layer.
    pub(super) tracks: Vec<(usize, Shape)>,
    pub(super) vias: Vec<Shape>,
    pub(super) cost: u32,
}

impl Path {
    pub(super) fn new(grid: &Grid, spots: Vec<Spot>, is_power: bool, cost: u32) -> Self {
        let radius = half_width(track_kind(is_power, 0));
        let mut tracks = Vec::new();
        let mut vias = Vec::new();
        for (layer, from, to) in straight_pieces(grid, &spots) {
            let shape = Shape::Capsule {
                from: grid.at(from),
                to: grid.at(to),
                radius,
            };
            tracks.push((layer, shape));
        }
        for pair in spots.windows(2) {
            if pair[0].0 != pair[1].0 {
                vias.push(Shape::disc(grid.at(pair[0].1 as usize), half_width(grid::VIA)));
            }
        }
        Self {
            cells: cells_of(grid, &tracks, &vias),
            spots,
            tracks,
            vias,
            cost,
        }
    }

    /// The nodes of its vias.
    pub(super) fn via_nodes(&self) -> impl Iterator<Item = usize> + '_ {
        let pairs = self.spots.windows(2);
        pairs
            .filter(|pair| pair[0].0 != pair[1].0)
            .map(|pair| pair[0].1 as usize)
    }
}

/// The straight segments of a path, from node to node.
fn straight_pieces(grid: &Grid, spots: &[Spot]) -> Vec<(usize, usize, usize)> {
    let mut pieces: Vec<(usize, usize, usize)> = Vec::new();
    let step = |from: usize, to: usize| {
        let of = |node: usize| ((node % grid.columns) as i64, (node / grid.columns) as i64);
        let ((x, y), (next_x, next_y)) = (of(from), of(to));
        (next_x - x, next_y - y)
    };
    let mut last_step = None;
    for pair in spots.windows(2) {
        let ((layer, from), (next_layer, to)) = (pair[0], pair[1]);
        if layer != next_layer {
            last_step = None;
            continue;
        }
        let (from, to) = (from as usize, to as usize);
        let this = step(from, to);
        match pieces.last_mut() {
            Some(piece) if last_step == Some(this) => piece.2 = to,
            _ => pieces.push((usize::from(layer), from, to)),
        }
        last_step = Some(this);
    }
    pieces
}

/// A net.
#[derive(Clone, Debug)]
pub(super) struct Net {
    pub(super) number: usize,
    pub(super) is_power: bool,
    /// The spots of each pin.
    pub(super) pins: Vec<Vec<Spot>>,
    pub(super) paths: Vec<Path>,
}

impl Net {
    /// Connected pieces: the spots of each, and its number of pins. The piece with the first pin
    /// comes first.
    pub(super) fn pieces(&self) -> Vec<(Vec<Spot>, usize)> {
        let things = || {
            let pins = self.pins.iter();
            pins.chain(self.paths.iter().map(|path| &path.spots))
        };
        let mut piece_of: Vec<usize> = (0..things().count()).collect();
        let mut first_at: HashMap<Spot, usize> = HashMap::new();
        for (thing, spots) in things().enumerate() {
            for spot in spots {
                let other = *first_at.entry(*spot).or_insert(thing);
                let (one, two) = (root(&piece_of, thing), root(&piece_of, other));
                piece_of[one.max(two)] = one.min(two);
            }
        }
        let mut pieces: Vec<(usize, Vec<Spot>, usize)> = Vec::new();
        for (thing, spots) in things().enumerate() {
            let root = root(&piece_of, thing);
            let is_pin = usize::from(thing < self.pins.len());
            match pieces.iter_mut().find(|(of, ..)| *of == root) {
                Some((_, all, pins)) => {
                    all.extend(spots);
                    *pins += is_pin;
                }
                None => pieces.push((root, spots.clone(), is_pin)),
            }
        }
        pieces.into_iter().map(|(_, spots, pins)| (spots, pins)).collect()
    }

    /// A path with an end that touches neither a pin nor another path.
    pub(super) fn loose_path(&self) -> Option<usize> {
        let touches = |own: usize, spot: &Spot| {
            let is_at_pin = self.pins.iter().any(|pin| pin.contains(spot));
            let mut others = self.paths.iter().enumerate().filter(|(other, _)| *other != own);
            is_at_pin || others.any(|(_, path)| path.spots.contains(spot))
        };
        self.paths.iter().enumerate().position(|(own, path)| {
            let mut ends = path.spots.first().into_iter().chain(path.spots.last());
            ends.any(|end| !touches(own, end))
        })
    }

    pub(super) fn cost(&self) -> u32 {
        self.paths.iter().map(|path| path.cost).sum()
    }

    /// Appends the net's tracks and vias.
    pub(super) fn copper(&self, tracks: &mut Vec<Track>, vias: &mut Vec<Via>) {
        for path in &self.paths {
            for (layer, shape) in &path.tracks {
                if let Shape::Capsule { from, to, radius } = *shape {
                    tracks.push(Track {
                        net: self.number,
                        side: grid::side_of(*layer),
                        from,
                        to,
                        width: 2.0 * radius,
                    });
                }
            }
            for via in &path.vias {
                let at = 0.5 * (via.bounds().0 + via.bounds().1);
                let via = Via { net: self.number, at };
                if !vias.contains(&via) {
                    vias.push(via);
                }
            }
        }
    }
}

fn root(piece_of: &[usize], mut thing: usize) -> usize {
    while piece_of[thing] != thing {
        thing = piece_of[thing];
    }
    thing
}
