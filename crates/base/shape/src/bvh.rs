//! A tree of boxes around triangles.

use glam::{DVec2, DVec3};

/// Triangles of a leaf.
const LEAF: usize = 4;

/// A binary tree of boxes over triangles, halved by number along the longest axis of their centres.
#[derive(Clone, Debug)]
pub(crate) struct Bvh {
    /// Children come after their parent.
    nodes: Vec<Node>,
    /// Numbers of triangles; each leaf has a stretch of them.
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
    /// A tree over some triangles, at least one, by the (minimum, maximum) corners of all triangles' boxes.
    pub(crate) fn new(boxes: &[(DVec3, DVec3)], triangles: Vec<usize>) -> Self {
        let n_triangles = triangles.len();
        let mut tree = Self {
            nodes: Vec::new(),
            order: triangles,
        };
        tree.grow(boxes, 0, n_triangles);
        tree
    }

    /// The numbers of its triangles.
    pub(crate) fn triangles(&self) -> &[usize] {
        &self.order
    }

    /// Distance from a point to the box around everything, mm; 0 inside.
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

    /// Box around everything.
    pub(crate) fn bounds_mm(&self) -> (DVec3, DVec3) {
        (self.nodes[0].low, self.nodes[0].high)
    }

    /// Visits triangles that may be closest; `visit` returns the smallest square of a distance so far.
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
                    // The nearer one is looked at first.
                    pending.extend(if a.0 < b.0 { [b, a] } else { [a, b] });
                }
            }
        }
    }

    /// Visits the triangles whose boxes a ray may meet; no component of its direction may be zero.
    pub(crate) fn along(&self, from: DVec3, direction: DVec3, visit: &mut dyn FnMut(usize)) {
        self.visit(visit, &|node| {
            let (to_low, to_high) = ((node.low - from) / direction, (node.high - from) / direction);
            let (enters, leaves) = (
                to_low.min(to_high).max_element(),
                to_low.max(to_high).min_element(),
            );
            // A little more, for what rounding takes of flat boxes.
            let slack = 1e-9 * (enters.abs() + leaves.abs());
            leaves >= -slack && enters <= leaves + slack
        });
    }

    /// Visits the triangles whose boxes stand over or below a place of the xy plane.
    pub(crate) fn over(&self, at: DVec2, visit: &mut dyn FnMut(usize)) {
        self.visit(visit, &|node| {
            !(at.cmplt(node.low.truncate()).any() || at.cmpgt(node.high.truncate()).any())
        });
    }

    /// Visits the triangles of all leaves whose boxes, and those around them, are met.
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
