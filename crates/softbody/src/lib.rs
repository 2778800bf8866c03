//! Finite-strain FEM of a soft body pressed by rigid shapes.
