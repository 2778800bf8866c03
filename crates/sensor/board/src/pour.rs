//! The ground pour: copper polygons that fill the area that tracks and pads of other nets leave
//! free.
//!
//! At each grid point the exact distance to everything that the pour must keep away from is known.
//! A disc with this radius around the grid point is free. The pour is the union of all free discs
//! that are at least as wide as the pour's smallest width ([`Field`]). Its border is traced between
//! grid points. Holes are connected to their border by slits, as in KiCad's own polygons
//! ([`crate::contour`]). Polygons that no ground track or via touches are left out. Pads of ground
//! are connected by their tracks only, so that the pour does not draw heat from a soldering iron.

use glam::DVec2;

use crate::contour::{Polygon, loops, polygons};
use crate::land::Side;
use crate::outline::Outline;
use crate::route::{Grid, PadCopper, Routed, Via};
use crate::rules::{
    CLEARANCE_MM, EDGE_CLEARANCE_MM, POUR_WIDTH_MM, VIA_DRILL_MM, VIA_MM, VIA_TO_PAD_MM, VIA_TO_VIA_MM,
};
use crate::shapes::Shape;

/// Distance that the pour keeps in addition to the clearance, mm: its border is straight between
/// grid points where the exact border is round.
const ROUND_MM: f64 = 0.03;
/// Larger discs are reduced to this radius, mm: neighbouring discs cover the rest.
const LARGEST_MM: f64 = 0.3;
/// Distance of the vias that connect the pours of both layers, mm.
const STITCH_MM: f64 = 4.0;

/// Free distance that a via needs around its centre in addition to the clearance, mm. It also holds
/// for pads of ground, where it exceeds [`VIA_TO_PAD_MM`].
const NEEDS_MM: f64 = 0.5 * VIA_MM + ROUND_MM;
const _: () = assert!(VIA_TO_PAD_MM <= CLEARANCE_MM);

/// Distances at grid points, mm.
struct Field {
    grid: Grid,
    /// Distance to the nearest thing that the pour must keep away from, minus the clearance; at
    /// most 1 mm.
    free: Vec<f64>,
    /// Distance to the pour's border, positive in the pour.
    inside: Vec<f64>,
}

/// The pour of both layers and the vias that join them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pour {
    pub(crate) top: Vec<Polygon>,
    pub(crate) bottom: Vec<Polygon>,
    pub(crate) vias: Vec<Via>,
}

/// Fills the free area. `ground` is the number of the ground net.
pub(crate) fn pour(outline: &Outline, pads: &[PadCopper], routed: &Routed, ground: usize) -> Pour {
    let fields = [Side::Top, Side::Bottom].map(|side| Field::new(outline, pads, routed, ground, side));
    let mut kept = [Vec::new(), Vec::new()];
    let mut islands = [Vec::new(), Vec::new()];
    for (layer, side) in [Side::Top, Side::Bottom].into_iter().enumerate() {
        let all = polygons(loops(&fields[layer].grid, &fields[layer].inside));
        (kept[layer], islands[layer]) = all
            .into_iter()
            .partition(|polygon| is_touched(polygon, routed, ground, side));
    }
    let mut vias = stitches(outline, &kept, &fields, routed, ground);
    // An area without ground is connected by a via to the other layer, if there is ground opposite.
    for layer in [0, 1, 0, 1] {
        for island in std::mem::take(&mut islands[layer]) {
            match via_to(&island, &kept[1 - layer], &fields, routed, &vias, ground) {
                Some(via) => {
                    vias.push(via);
                    kept[layer].push(island);
                }
                None => islands[layer].push(island),
            }
        }
    }
    let [top, bottom] = kept;
    Pour { top, bottom, vias }
}

/// The position with most room for a via in an island with pour opposite.
fn via_to(
    island: &Polygon,
    opposite: &[Polygon],
    fields: &[Field; 2],
    routed: &Routed,
    vias: &[Via],
    ground: usize,
) -> Option<Via> {
    let grid = &fields[0].grid;
    let room = |node: usize| fields[0].free[node].min(fields[1].free[node]);
    let mut nodes: Vec<usize> = (0..grid.len()).filter(|node| room(*node) > NEEDS_MM).collect();
    nodes.sort_by(|one, two| room(*two).total_cmp(&room(*one)).then(one.cmp(two)));
    nodes
        .into_iter()
        .map(|node| Via {
            net: ground,
            at: grid.at(node),
        })
        .find(|via| {
            island.holds(via.at)
                && opposite.iter().any(|polygon| polygon.holds(via.at))
                && is_apart(via.at, routed, vias, ground)
        })
}

/// Whether a via is far enough from the other ground vias for drilling.
fn is_apart(at: DVec2, routed: &Routed, vias: &[Via], ground: usize) -> bool {
    let mut others = routed.vias.iter().filter(|via| via.net == ground).chain(vias);
    others.all(|via| via.at.distance(at) > VIA_TO_VIA_MM + VIA_DRILL_MM)
}

impl Field {
    fn new(outline: &Outline, pads: &[PadCopper], routed: &Routed, ground: usize, side: Side) -> Self {
        let grid = Grid::over(outline);
        let nodes = 0..grid.len();
        let edge = |node| outline.inside_mm(grid.at(node)) - EDGE_CLEARANCE_MM - ROUND_MM;
        let mut free: Vec<f64> = nodes.map(|node| edge(node).min(1.0)).collect();
        let mut keep_away = |shape: &Shape, gap: f64| {
            for node in grid.near(shape, 1.0 + gap) {
                free[node] = free[node].min(shape.distance(grid.at(node)) - gap);
            }
        };
        for screw in outline.screws() {
            keep_away(&screw, ROUND_MM);
        }
        for pad in pads.iter().filter(|pad| pad.side == side) {
            keep_away(&pad.shape, CLEARANCE_MM + ROUND_MM);
        }
        let tracks = routed.tracks.iter();
        for track in tracks.filter(|track| track.net != ground && track.side == side) {
            keep_away(&track.shape(), CLEARANCE_MM + ROUND_MM);
        }
        for via in routed.vias.iter().filter(|via| via.net != ground) {
            keep_away(&via.shape(), CLEARANCE_MM + ROUND_MM);
        }
        let inside = discs(&grid, &free);
        Self { grid, free, inside }
    }
}

/// Depth of each grid point in the union of free discs.
fn discs(grid: &Grid, free: &[f64]) -> Vec<f64> {
    let mut inside = vec![-LARGEST_MM; free.len()];
    for (node, free) in free.iter().enumerate() {
        if *free < 0.5 * POUR_WIDTH_MM {
            continue;
        }
        let radius = free.min(LARGEST_MM);
        let center = grid.at(node);
        let disc = Shape::disc(center, 0.0);
        for near in grid.near(&disc, radius + 0.15) {
            let depth = radius - center.distance(grid.at(near));
            inside[near] = inside[near].max(depth);
        }
    }
    inside
}

/// Whether a ground track or via is in a polygon.
fn is_touched(polygon: &Polygon, routed: &Routed, ground: usize, side: Side) -> bool {
    let vias = routed.vias.iter().filter(|via| via.net == ground);
    let tracks = routed.tracks.iter();
    let own = tracks.filter(|track| track.net == ground && track.side == side);
    let points = own.flat_map(|track| [track.from, track.to, 0.5 * (track.from + track.to)]);
    vias.map(|via| via.at)
        .chain(points)
        .any(|point| polygon.holds(point))
}

/// Vias on a coarse lattice, where both layers have room.
fn stitches(
    outline: &Outline,
    kept: &[Vec<Polygon>; 2],
    fields: &[Field; 2],
    routed: &Routed,
    ground: usize,
) -> Vec<Via> {
    let bounds = outline.bounds();
    let count = (bounds.size() / STITCH_MM).floor();
    let first = bounds.center() - 0.5 * STITCH_MM * count;
    let mut vias: Vec<Via> = Vec::new();
    for row in 0..=count.y as usize {
        for column in 0..=count.x as usize {
            let at = first + STITCH_MM * DVec2::new(column as f64, row as f64);
            let at = (at * 10.0).round() / 10.0;
            let has_room = fields.iter().all(|field| {
                let nodes = field.grid.next_to(at);
                !nodes.is_empty() && nodes.iter().all(|node| field.free[*node] > NEEDS_MM)
            });
            let is_poured = kept.iter().all(|all| all.iter().any(|polygon| polygon.holds(at)));
            if has_room && is_poured && is_apart(at, routed, &vias, ground) {
                vias.push(Via { net: ground, at });
            }
        }
    }
    vias
}
