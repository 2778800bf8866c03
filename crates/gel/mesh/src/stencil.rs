//! The part of a tetrahedron inside of a surface that cuts it.

use glam::DVec3;

/// Position of a corner relative to the surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    Inside,
    On,
    Outside,
}

/// A corner of the inner part: a number that is the same in all tetrahedra around it, and its
/// position, mm.
pub(crate) type Corner = (u32, DVec3);

/// Divides the inner part of a tetrahedron into tetrahedra with the same orientation.
///
/// `cut(a, b)` gives the point where the edge between corners `a` (inside) and `b` (outside) is
/// cut. A face that two tetrahedra share is divided in the same way in both. `center` makes a new
/// corner, which is rarely needed, for a part that cannot be divided without one.
pub(crate) fn inner_part(
    corners: [Corner; 4],
    sides: [Side; 4],
    cut: impl Fn(usize, usize) -> Corner,
    mut center: impl FnMut(DVec3) -> Corner,
    out: &mut Vec<[u32; 4]>,
) {
    let of = |side: Side| (0..4).filter(move |&corner| sides[corner] == side);
    let (inside, on, outside): (Vec<_>, Vec<_>, Vec<_>) = (
        of(Side::Inside).collect(),
        of(Side::On).collect(),
        of(Side::Outside).collect(),
    );
    let at = |corner: usize| corners[corner];
    match (inside.as_slice(), on.as_slice(), outside.as_slice()) {
        ([], ..) => {}
        (_, _, []) => push(corners, true, out),
        (&[a], _, _) => {
            // The corners outside are moved inwards along their edges.
            push(
                [0, 1, 2, 3].map(|c| {
                    if sides[c] == Side::Outside {
                        cut(a, c)
                    } else {
                        at(c)
                    }
                }),
                true,
                out,
            );
        }
        (&[a, b], &[apex], &[c]) => {
            for [p, q, r] in halves([at(a), at(b), cut(b, c), cut(a, c)]) {
                push([at(apex), p, q, r], is_even([apex, a, b, c]), out);
            }
        }
        (&[a, b], _, &[c, d]) => {
            prism(
                [at(a), cut(a, c), cut(a, d)],
                [at(b), cut(b, c), cut(b, d)],
                is_even([a, c, d, b]),
                &mut center,
                out,
            );
        }
        (&[a, b, c], _, &[d]) => {
            prism(
                [at(a), at(b), at(c)],
                [cut(a, d), cut(b, d), cut(c, d)],
                is_even([a, b, c, d]),
                &mut center,
                out,
            );
        }
        // Four corners leave no other case.
        _ => {}
    }
}

/// The two triangles of a quadrilateral, divided by the shorter diagonal. Of equal ones, the
/// diagonal with the lowest number is taken.
fn halves(quad: [Corner; 4]) -> [[Corner; 3]; 2] {
    let [a, b, c, d] = quad;
    let (ac, bd) = (a.1.distance_squared(c.1), b.1.distance_squared(d.1));
    let alike = (ac - bd).abs() <= 1e-9 * (ac + bd);
    let take_ac = if alike {
        a.0.min(c.0) < b.0.min(d.0)
    } else {
        ac < bd
    };
    if take_ac {
        [[a, b, c], [a, c, d]]
    } else {
        [[a, b, d], [b, c, d]]
    }
}

/// Divides a prism between two triangles, given corner by corner, into three tetrahedra, or into
/// eight around its centre if necessary. `even` states that the bottom and a corner of the top are
/// oriented like the tetrahedron that is cut.
fn prism(
    bottom: [Corner; 3],
    top: [Corner; 3],
    even: bool,
    center: &mut impl FnMut(DVec3) -> Corner,
    out: &mut Vec<[u32; 4]>,
) {
    let mut triangles = vec![[bottom[0], bottom[2], bottom[1]], top];
    for (i, j) in [(0, 1), (1, 2), (2, 0)] {
        triangles.extend(halves([bottom[i], bottom[j], top[j], top[i]]));
    }
    // A corner at which both of its quadrilaterals are divided is in five triangles; the other
    // three triangles face it.
    let touching = |corner: Corner| {
        triangles
            .iter()
            .filter(|t| t.iter().any(|c| c.0 == corner.0))
            .count()
    };
    let hub = bottom
        .into_iter()
        .chain(top)
        .find(|&corner| touching(corner) == 5);
    let hub = hub.unwrap_or_else(|| center(bottom.iter().chain(&top).map(|c| c.1).sum::<DVec3>() / 6.0));
    for [a, b, c] in triangles {
        if [a, b, c].iter().all(|corner| corner.0 != hub.0) {
            push([hub, a, b, c], even, out);
        }
    }
}

/// Whether an order of the corners is an even permutation of `[0, 1, 2, 3]`.
fn is_even([a, b, c, d]: [usize; 4]) -> bool {
    let swaps = [(a, b), (a, c), (a, d), (b, c), (b, d), (c, d)];
    swaps.iter().filter(|(first, second)| first > second).count() % 2 == 0
}

/// Adds a tetrahedron, with the opposite orientation unless `even`.
fn push(corners: [Corner; 4], even: bool, out: &mut Vec<[u32; 4]>) {
    let [a, b, c, d] = corners.map(|corner| corner.0);
    out.push(if even { [a, b, c, d] } else { [a, b, d, c] });
}
