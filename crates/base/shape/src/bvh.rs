//! A bounding volume hierarchy: a tree of boxes around triangles.

use glam::{DVec2, DVec3};

/// Largest number of triangles in a leaf.
const LEAF: usize = 4;

/// A binary tree of boxes over triangles. Each node is halved by number of triangles, along the
/// longest axis of their centres.
#[derive(Clone, Debug)]
pub(crate) struct Bvh {
    /// Nodes; children follow their parent.
    nodes: Vec<Node>,
    /// Indices of triangles; each leaf has a contiguous range of them.
    order: Vec<usize>,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    low: DVec3,
    high: DVec3,
    content: Content,
}

#[derive(Clone, Copy, Debug)]
enum Content {
    Leaf { start: usize, end: usize },
    Children([usize; 2]),
}

impl Node {
    fn square_distance(&self, point: DVec3) -> f64 {
        point.clamp(self.low, self.high).distance_squared(point)
    }
}

impl Bvh {
    /// A tree over some triangles (at least one), from the (minimum, maximum) corners of the boxes
    /// of all triangles.
    pub(crate) fn new(boxes: &[(DVec3, DVec3)], triangles: Vec<usize>) -> Self {
        let n_triangles = triangles.len();
        let mut tree = Self {
            nodes: Vec::new(),
            order: triangles,
        };
        tree.grow(boxes, 0, n_triangles);
        tree
    }

    /// Indices of the tree's triangles.
    pub(crate) fn triangles(&self) -> &[usize] {
        &self.order
    }

    /// Distance from a point to the box around all triangles, mm; 0 inside.
    pub(crate) fn box_distance_mm(&self, point: DVec3) -> f64 {
        self.nodes[0].square_distance(point).sqrt()
    }

    fn grow(&mut self, boxes: &[(DVec3, DVec3)], start: usize, end: usize) -> usize {
        let nothing = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let join = |(low, high): (DVec3, DVec3), (a, b): (DVec3, DVec3)| (low.min(a), high.max(b));
        let members = &mut self.order[start..end];
        let (low, high) = members
            .iter()
            .map(|&triangle| boxes[triangle])
            .fold(nothing, join);
        let index = self.nodes.len();
        self.nodes.push(Node {
            low,
            high,
            content: Content::Leaf { start, end },
        });
        if end - start > LEAF {
            let center = |triangle: usize| boxes[triangle].0 + boxes[triangle].1;
            let (first, last) = members
                .iter()
                .map(|&triangle| (center(triangle), center(triangle)))
                .fold(nothing, join);
            let spread = last - first;
            let axis = if spread.x >= spread.y && spread.x >= spread.z {
                0
            } else if spread.y >= spread.z {
                1
            } else {
                2
            };
            members.sort_by(|&a, &b| center(a)[axis].total_cmp(&center(b)[axis]));
            let middle = start + (end - start) / 2;
            let children = [self.grow(boxes, start, middle), self.grow(boxes, middle, end)];
            self.nodes[index].content = Content::Children(children);
        }
        index
    }

    /// The box around all triangles.
    pub(crate) fn bounds_mm(&self) -> (DVec3, DVec3) {
        (self.nodes[0].low, self.nodes[0].high)
    }

    /// Visits triangles that may be closest; `visit` returns the smallest squared distance so far.
    pub(crate) fn closest(&self, point: DVec3, visit: &mut dyn FnMut(usize) -> f64) {
        let mut best = f64::INFINITY;
        let mut pending = vec![(0.0, 0)];
        while let Some((square, index)) = pending.pop() {
            if square >= best {
                continue;
            }
            match self.nodes[index].content {
                Content::Leaf { start, end } => {
                    for &triangle in &self.order[start..end] {
                        best = visit(triangle);
                    }
                }
                Content::Children(children) => {
                    let [a, b] = children.map(|child| (self.nodes[child].square_distance(point), child));
                    // The nearer child is visited first.
                    pending.extend(if a.0 < b.0 { [b, a] } else { [a, b] });
                }
            }
        }
    }

    /// Visits the triangles whose boxes a ray may meet. No component of its direction may be zero.
    pub(crate) fn along(&self, from: DVec3, direction: DVec3, visit: &mut dyn FnMut(usize)) {
        self.visit(visit, &|node| {
            let (to_low, to_high) = ((node.low - from) / direction, (node.high - from) / direction);
            let (enters, leaves) = (
                to_low.min(to_high).max_element(),
                to_low.max(to_high).min_element(),
            );
            // Some slack for the rounding errors of flat boxes.
            let slack = 1e-9 * (enters.abs() + leaves.abs());
            leaves >= -slack && enters <= leaves + slack
        });
    }

    /// Visits the triangles whose boxes contain a location of the xy plane, seen along z.
    pub(crate) fn over(&self, at: DVec2, visit: &mut dyn FnMut(usize)) {
        self.visit(visit, &|node| {
            !(at.cmplt(node.low.truncate()).any() || at.cmpgt(node.high.truncate()).any())
        });
    }

    /// Visits the triangles of all leaves for which `is_met` holds, as for all nodes above them.
    fn visit(&self, visit: &mut dyn FnMut(usize), is_met: &dyn Fn(&Node) -> bool) {
        let mut pending = vec![0];
        while let Some(index) = pending.pop() {
            let node = &self.nodes[index];
            if !is_met(node) {
                continue;
            }
            match node.content {
                Content::Leaf { start, end } => self.order[start..end]
                    .iter()
                    .for_each(|&triangle| visit(triangle)),
                Content::Children(children) => pending.extend(children),
            }
        }
    }
}
