//! Routes all nets. Tracks in the way are removed and routed again later.

use std::collections::VecDeque;

use super::PadCopper;
use super::cells::Cells;
use super::grid::{Fixed, Grid, VIA, layer_of, track_kind};
use super::net::{Net, Path, Spot};
use super::search::{Scratch, Search};
use crate::outline::Outline;
use crate::rules::{CLEARANCE_MM, VIA_TO_VIA_MM};
use crate::shapes::{Shape, between_segments};

/// Average number of new routings for each net, after which the board counts as too dense.
const TRIES_PER_NET: usize = 60;

/// A net without a path: start and end, mm, and the nets in the way.
#[derive(Clone, Debug)]
pub(crate) struct Failure {
    pub(crate) net: usize,
    pub(crate) from: glam::DVec2,
    pub(crate) to: glam::DVec2,
    /// Numbers of the nets that it would have to cross.
    pub(crate) across: Vec<usize>,
}

/// All nets, and the state of the grid.
pub(super) struct Router {
    pub(super) grid: Grid,
    pub(super) fixed: Fixed,
    pub(super) cells: Cells,
    pub(super) nets: Vec<Net>,
    pub(super) scratch: Scratch,
}

impl Router {
    pub(super) fn new(
        outline: &Outline,
        pads: &[PadCopper],
        n_nets: usize,
        is_power: &dyn Fn(usize) -> bool,
    ) -> Self {
        let grid = Grid::over(outline);
        let nets = (0..n_nets).map(|number| {
            let own = pads.iter().filter(|pad| pad.is_pin && pad.net == Some(number));
            let pins = own.map(|pad| {
                let (min, max) = pad.shape.bounds();
                let nodes = grid.next_to(0.5 * (min + max)).into_iter();
                let layer = layer_of(pad.side) as u8;
                nodes.map(|node| (layer, node as u32)).collect()
            });
            Net {
                number,
                is_power: is_power(number),
                pins: pins.collect(),
                paths: Vec::new(),
            }
        });
        Self {
            nets: nets.collect(),
            fixed: Fixed::new(&grid, outline, pads),
            cells: Cells::new(&grid),
            scratch: Scratch::default(),
            grid,
        }
    }

    pub(super) fn run(&mut self) -> Result<(), Failure> {
        let mut order: Vec<usize> = (0..self.nets.len()).collect();
        order.sort_by_key(|&net| (self.nets[net].pins.len(), self.reach(net), net));
        let mut waiting: VecDeque<usize> = order.into();
        let mut tries = TRIES_PER_NET * self.nets.len();
        while let Some(net) = waiting.pop_front() {
            let crossed = self.join(net, true)?;
            if tries < crossed.len() {
                let (from, to) = self.ends(net);
                let across = crossed;
                return Err(Failure {
                    net,
                    from,
                    to,
                    across,
                });
            }
            tries -= crossed.len();
            for other in crossed {
                if !waiting.contains(&other) {
                    waiting.push_back(other);
                }
            }
        }
        Ok(())
    }

    /// Half the perimeter of the box around a net's pins, in grid steps.
    fn reach(&self, net: usize) -> i64 {
        let columns = self.grid.columns as u32;
        let spots = || self.nets[net].pins.iter().flatten();
        let extent = |along: &dyn Fn(u32) -> u32| {
            let all = || spots().map(|(_, node)| i64::from(along(*node)));
            all().max().unwrap_or_default() - all().min().unwrap_or_default()
        };
        extent(&|node| node % columns) + extent(&|node| node / columns)
    }

    fn ends(&self, net: usize) -> (glam::DVec2, glam::DVec2) {
        let at = |pin: Option<&Vec<Spot>>| {
            let spot = pin.and_then(|spots| spots.first());
            spot.map_or(glam::DVec2::ZERO, |(_, node)| self.grid.at(*node as usize))
        };
        let pins = &self.nets[net].pins;
        (at(pins.first()), at(pins.last()))
    }

    /// Connects all pieces of a net. Removes the paths of other nets that it crosses, and returns
    /// these nets.
    pub(super) fn join(&mut self, net: usize, may_cross: bool) -> Result<Vec<usize>, Failure> {
        while let Some(loose) = self.nets[net].loose_path() {
            let path = self.nets[net].paths.remove(loose);
            self.cells.remove(&path.cells);
        }
        let mut crossed = Vec::new();
        loop {
            let pieces = self.nets[net].pieces();
            if pieces.len() < 2 {
                return Ok(crossed);
            }
            let start =
                (0..pieces.len()).min_by_key(|&piece| (pieces[piece].1, pieces[piece].0.len(), piece));
            let start = start.unwrap_or_default();
            let others = pieces.iter().enumerate().filter(|(piece, _)| *piece != start);
            let targets: Vec<Spot> = others.flat_map(|(_, (spots, _))| spots.clone()).collect();
            self.lift(net);
            let search = Search {
                grid: &self.grid,
                fixed: &self.fixed,
                cells: &self.cells,
                may_cross,
            };
            let found = search.way(&self.nets[net], &pieces[start].0, &targets, &mut self.scratch);
            self.lay(net);
            let Some((spots, cost)) = found else {
                let at = |spots: &[Spot]| self.grid.at(spots[0].1 as usize);
                return Err(Failure {
                    net,
                    from: at(&pieces[start].0),
                    to: at(&targets),
                    across: Vec::new(),
                });
            };
            let path = Path::new(&self.grid, spots, self.nets[net].is_power, cost);
            if may_cross {
                crossed.extend(self.take_out(net, &path));
            }
            self.cells.add(&path.cells);
            self.nets[net].paths.push(path);
        }
    }

    /// Removes a net's own paths from the cells, so that the net does not block itself.
    fn lift(&mut self, net: usize) {
        for path in &self.nets[net].paths {
            self.cells.remove(&path.cells);
        }
    }

    fn lay(&mut self, net: usize) {
        for path in &self.nets[net].paths {
            self.cells.add(&path.cells);
        }
    }

    /// Removes the paths of other nets that are too close to a new path, and returns these nets.
    fn take_out(&mut self, own: usize, path: &Path) -> Vec<usize> {
        let is_power = self.nets[own].is_power;
        let mut fought = Vec::new();
        for &(layer, node) in &path.spots {
            let kind = track_kind(is_power, usize::from(layer));
            fought.push((kind, node as usize));
        }
        fought.extend(path.via_nodes().map(|node| (VIA, node)));
        self.lift(own);
        for (kind, node) in fought {
            if self.cells.is_taken(kind, node) {
                self.cells.fought(&self.grid, kind, node);
            }
        }
        self.lay(own);
        let mut crossed = Vec::new();
        for other in (0..self.nets.len()).filter(|other| *other != own) {
            let paths = std::mem::take(&mut self.nets[other].paths);
            let (out, kept): (Vec<Path>, Vec<Path>) =
                paths.into_iter().partition(|other| collide(path, other));
            self.nets[other].paths = kept;
            for path in &out {
                self.cells.remove(&path.cells);
            }
            if !out.is_empty() {
                crossed.push(other);
            }
        }
        crossed
    }
}

/// Whether two paths of different nets are too close to each other.
fn collide(one: &Path, two: &Path) -> bool {
    let close = |one: &Shape, two: &Shape, gap: f64| match (one, two) {
        (
            Shape::Capsule { from, to, radius },
            Shape::Capsule {
                from: other_from,
                to: other_to,
                radius: other_radius,
            },
        ) => between_segments((*from, *to), (*other_from, *other_to)) < radius + other_radius + gap - 1e-9,
        _ => false,
    };
    let tracks = |one: &Path, two: &Path| {
        one.tracks.iter().any(|(layer, shape)| {
            let same = two.tracks.iter().filter(|(other, _)| other == layer);
            same.into_iter()
                .any(|(_, other)| close(shape, other, CLEARANCE_MM))
        })
    };
    let through = |one: &Path, two: &Path| {
        one.vias.iter().any(|via| {
            two.tracks
                .iter()
                .any(|(_, shape)| close(via, shape, CLEARANCE_MM))
                || two.vias.iter().any(|other| {
                    let apart = VIA_TO_VIA_MM - 2.0 * super::grid::half_width(VIA);
                    close(via, other, apart)
                })
        })
    };
    tracks(one, two) || through(one, two) || through(two, one)
}
