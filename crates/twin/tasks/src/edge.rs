//! The edge of an object's face.

use glam::DVec2;

/// A closed convex polygon, counterclockwise.
pub(crate) struct Edge {
    corners_mm: Vec<DVec2>,
    /// Arc length from the start to each corner, mm, and that of the whole edge. `[n_corners + 1]`
    along_mm: Vec<f64>,
}

/// The nearest point of an edge.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Nearest {
    /// Arc length from the start, mm.
    pub(crate) along_mm: f64,
    /// Distance, mm; negative over the face.
    pub(crate) beside_mm: f64,
}

impl Edge {
    /// Through these corners, mm.
    pub(crate) fn of(corners_mm: Vec<DVec2>) -> Self {
        let mut along_mm = vec![0.0];
        for (number, corner) in corners_mm.iter().enumerate() {
            let next = corners_mm[(number + 1) % corners_mm.len()];
            along_mm.push(along_mm[number] + corner.distance(next));
        }
        Self { corners_mm, along_mm }
    }

    /// Length of the whole edge, mm.
    pub(crate) fn length_mm(&self) -> f64 {
        self.along_mm[self.corners_mm.len()]
    }

    /// The point of the edge nearest to a location.
    pub(crate) fn nearest(&self, at_mm: DVec2) -> Nearest {
        let n = self.corners_mm.len();
        let mut best = (f64::INFINITY, 0.0);
        let mut is_inside = true;
        for number in 0..n {
            let (from, to) = (self.corners_mm[number], self.corners_mm[(number + 1) % n]);
            let side = to - from;
            let part = ((at_mm - from).dot(side) / side.length_squared()).clamp(0.0, 1.0);
            let far = at_mm.distance_squared(from + part * side);
            if far < best.0 {
                best = (far, self.along_mm[number] + part * side.length());
            }
            is_inside &= side.perp_dot(at_mm - from) >= 0.0;
        }
        let (far, along_mm) = best;
        Nearest {
            along_mm,
            beside_mm: if is_inside { -far.sqrt() } else { far.sqrt() },
        }
    }

    /// The point at a fraction of the edge's length, mm, and the outward normal there.
    pub(crate) fn at(&self, part: f64) -> (DVec2, DVec2) {
        let along_mm = part * self.length_mm();
        let n = self.corners_mm.len();
        let side = (1..n)
            .find(|number| along_mm < self.along_mm[*number])
            .unwrap_or(n)
            - 1;
        let (from, to) = (self.corners_mm[side], self.corners_mm[(side + 1) % n]);
        let way = (to - from).normalize();
        (from + (along_mm - self.along_mm[side]) * way, -way.perp())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn beside_a_square_are_its_sides_and_corners() {
        let square = Edge::of(
            [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]]
                .map(DVec2::from)
                .to_vec(),
        );
        assert_eq!(square.length_mm(), 16.0);
        for (place, along_mm, beside_mm) in [
            ([3.5, 1.0], 5.0, -0.5),
            ([7.0, 8.0], 8.0, 5.0),
            ([-2.0, 1.0], 15.0, 2.0),
        ] {
            let nearest = square.nearest(DVec2::from(place));
            assert_eq!((nearest.along_mm, nearest.beside_mm), (along_mm, beside_mm));
        }
        assert_eq!(square.at(0.375), (DVec2::new(4.0, 2.0), DVec2::X));
    }
}
