//! What takes the tangents of the elements.

use super::super::deformation::Matrix;
use super::super::table::{NODES, Table};
use crate::wide::Wide;

/// The block of a pair of nodes, in eight tetrahedra.
pub(crate) type NodeBlock = Matrix<f32>;

/// The slopes of the four corners' volumes in a node's displacement, in eight tetrahedra.
pub(crate) type NodeSlopes = [[Wide<f32>; 3]; 4];

/// Takes the tangents of eight coarse tetrahedra at a time.
pub(crate) trait Sink: Send {
    /// `slot` is that of the first; the blocks are those of the table's pairs.
    fn take(&mut self, slot: usize, table: &Table, blocks: &[NodeBlock], slopes: &[NodeSlopes; NODES]);
}
