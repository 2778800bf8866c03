//! Receivers of the tangents of the elements.

use super::super::deformation::Matrix;
use super::super::table::{NODES, Table};
use crate::wide::Wide;

/// The block of a pair of nodes, for eight tetrahedra.
pub(crate) type NodeBlock = Matrix<f32>;

/// Derivatives of the volumes of the four corners by a node's displacement, for eight tetrahedra.
pub(crate) type NodeSlopes = [[Wide<f32>; 3]; 4];

/// Receives the tangents of eight coarse tetrahedra at a time.
pub(crate) trait Sink: Send {
    /// `slot` is that of the first tetrahedron; the blocks are those of the pairs of the table.
    fn take(&mut self, slot: usize, table: &Table, blocks: &[NodeBlock], slopes: &[NodeSlopes; NODES]);
}
