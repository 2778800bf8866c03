//! Training and evaluation of the surrogate (`FastGel`, the gel without finite elements) from a
//! sensor's description alone.
//!
//! [`train_fast`] takes a sensor's description, [`FastSettings`] and a seed. It simulates random
//! training presses with finite elements, trains the surrogate on them, evaluates it on presses
//! that it was not trained on, and writes `fast.safetensors` (the surrogate), `evaluation.json` and
//! `evaluation.png` (its errors) into a folder. The result is a [`FastResult`]; all its numbers are
//! `simulated`.
//!
//! # How it works
//!
//! 1. All presses are drawn from the seed and their number (`crates/twin/fem_presses`), solved in
//!    parallel, and kept one a file in `presses/`: a training that was killed continues with what
//!    is there.
//! 2. Of the training presses, one in 20 is held out for evaluation (one in 5 if there are fewer
//!    than 500), if its mesh is nearly as fine as the finest (edges at most 1.2 times as long): on
//!    coarser meshes the FEM solution itself reads too little.
//! 3. The networks are trained (`crates/twin/fast`).
//! 4. The surrogate is evaluated on the held-out presses, on test presses of shapes that no
//!    training press has, and on test presses that slide and tilt. Errors are those of the
//!    pressures at the ports and of the force against the FEM solution.
//! 5. [`OodEvaluation`] evaluates the OOD score: presses deeper, thinner, sharper, more tilted or
//!    with more bodies than trained on are compared with held-out ones. It has the fraction of
//!    frames above the threshold of 1, and the AUROC.
//!
//! With `own_indenters` all presses use the sensor's own indenters, upright and near its ports, and
//! there are no sliding and no out-of-distribution presses: such a surrogate serves the twin of one
//! test setup.
//!
//! The crate reads no environment variable and no argument, prints nothing, and does not depend on
//! `crates/app/run`.

mod out_of_distribution;
mod plot;
mod presses;
mod train;

pub use out_of_distribution::{OodEvaluation, OodKindEvaluation};
pub use train::{FastResult, FastSettings, train_fast};
