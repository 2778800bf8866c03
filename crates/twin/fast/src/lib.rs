//! A surrogate of a sensor's gel: small neural networks that replace the finite-element (FEM)
//! solution, fast enough for reinforcement learning.
//!
//! Inputs are rigid shapes and their poses in the gel's frame, mm. Outputs are the hydrostatic
//! pressure at each port, kPa, the force on the gel, N, and the torque about the centre of the top
//! of the gel's bounding box, N mm. All outputs are `simulated`.
//!
//! - [`FastGel`]: the trained surrogate of one sensor's gel. Those of PhysTac and of its domed
//!   fingertip are built in ([`FastGel::phystac`], [`FastGel::phystac_tip`]). [`FastGel::train`]
//!   makes one from training presses ([`FemPress`]), which `twintac-fem-presses` computes by FEM.
//! - [`Body`]: a rigid shape, prepared so that distances to it are fast.
//! - [`FastReader`] and [`FastBatch`]: evaluate the surrogate for one sensor or for many.
//!   [`FastReader::ood_score`] returns the out-of-distribution (OOD) score of a contact.
//! - [`Friction`]: adds the friction of one body to force, torque and pressures.
//! - [`FastGel::evaluate`]: errors on test presses, as an [`Evaluation`].
//!
//! # How it works
//!
//! ```text
//! shapes, poses ─► contact: proximity to bodies at three heights, on a grid over the gel (2 mm)
//!                     │ each point by itself: features (network/local)
//!                     ├─► the patch around a port ─► pressure there   one for all locations
//!                     ├─► the whole grid ─────────► force, torque    another; a third at the side
//!                     └─► a few numbers of it ────► OOD score
//! ```
//!
//! ```text
//! distance, columns    signed distances to shapes, also to shapes that continue upward above their
//!                      tops
//! contact, surface     the grids over the gel, and the network inputs on them
//! layout               which grids and patches a sensor has
//! network, networks    the networks, their forward and backward passes
//! fem_press, training  training presses, and the steps of the optimizer
//! engine               the trained networks, laid out for fast evaluation
//! read, batch          evaluation of one sensor, and of many on several threads
//! out_of_distribution  the OOD score
//! friction, shear, footprint
//!                      friction, its effect on pressures, and the area that carries a body
//! evaluation           errors on test presses
//! trained_on           which gel the surrogate was trained on, and whether it is that of a sensor
//! model, file          the surrogate, and its file
//! ```
//!
//! ## Networks
//!
//! The effect of a shape on a location of the gel's base depends on where the shape presses
//! relative to that location, and little on where the gel's edges are. One network therefore
//! computes the pressure at any location. Its inputs also say how near each edge of the gel is.
//! Each press trains this network at a hundred locations of the base, not only at eight ports.
//!
//! Whether a grid point is in contact does not depend on its neighbours. So the network first
//! computes a few features of each point by itself, and only then sums over points. Without these
//! features it needs hidden units for every point. Three heights are needed because a narrow punch
//! is no deeper inside the surface than half its width.
//!
//! The points stand on grids with a spacing of 2 mm, or more over gels higher than 20 mm. Each port
//! has a grid with a point above it: PhysTac's eight ports share one grid, ports at irregular
//! locations have up to one grid each. A patch reaches about as far as the gel is high. Between the
//! points the inputs are interpolated linearly, which is accurate enough for a pressure map, but
//! not for a port.
//!
//! The third network is for sensors with a port at the side of the gel. The pressure where the
//! gel's side meets its base does not converge as meshes get finer. A port there averages the gel
//! that it covers over its radius, and the training presses for such a sensor have meshes with
//! edges of one length everywhere. The pressure at the port then depends on that length by a
//! factor, which the gains of a twin absorb, and not on where the press is. Few locations respond
//! like a port at the side, and one network for all locations does not learn it. The taxels of such
//! a sensor therefore have a network of their own, from the whole grid to all taxels at once. Where
//! gel and taxels are their own mirror image, as those of the fingertip are across y, each training
//! press is also used mirrored.
//!
//! ## Shapes that go deep
//!
//! The gel is never above a rigid body that came from outside. So a body that is deeper in the gel
//! than half of its thickness is continued upward above its tops (`distance/open` by formulas;
//! `columns` for bodies known by samples, from below in each column), and closed cavities are
//! filled. A body that is less deep gives exactly the bits that the networks were trained with. A
//! side is not a top, although leaning boxes have gel above their sides: the training presses
//! contain such boxes.
//!
//! The result for bars and walls narrower than 1.25 grid spacings depends on where they lie
//! relative to the points. `out_of_distribution/narrow` therefore measures how
//! wide a body is where it presses.
//!
//! ## Training
//!
//! Training presses are computed on meshes from coarse to fine. One network input says how much
//! longer than the finest a mesh's edges are; after training the networks are evaluated at the
//! finest edges ([`finest_edge_mm`]).
//!
//! A flat shape that hovers is as near to the gel as one that presses next to its edge. Each
//! training press therefore adds two frames in which its shape does not touch, with targets of
//! zero. Their gaps are spread evenly over all presses: a network trained at only two gaps gave a
//! kilopascal between them.
//!
//! Training distributes its samples over threads in parts that fit the caches, and adds the parts'
//! gradients in a fixed order. The result has the same bits for any number of threads.
//!
//! ## OOD score
//!
//! The score is computed by a call of its own, so that the evaluation stays cheap. It
//! contains the distance to the nearest of all training contacts, in numbers that do not depend on
//! the location: how deep, steep, large, tilted and uneven a contact is at each height. The
//! threshold, a score of 1, is the 99th percentile of the distances from an eighth of the training
//! presses to all the others. The score also rises above 1 where a contact is deeper than the
//! training presses, where few of them pressed, and where a body is too narrow for the grid.
//!
//! ## Friction
//!
//! The training presses have no friction. [`Friction`] adds it for one body. Force and torque are
//! those of an elastic layer under a rigid disc of the contact's area, in increments, up to
//! Coulomb's limit. The effect of that force on the pressure at the ports is the one at the base of
//! such a layer (`shear`: a closed form for each wave, summed once). Friction needs the sensor's
//! description and nothing that is learned.
//!
//! ## Speed
//!
//! Most grid points have nothing near them, and their features are zero, so only the others are
//! multiplied. A few sensors are evaluated together (`engine`): the products are sorted by their
//! location in the patch, so that the weights of a location are fetched from memory once for all of
//! these sensors. Each sum is added in the order of the locations, so one sensor alone gives the
//! same bits as the same sensor among a thousand.
//!
//! Balls, boxes and cylinders have formulas for their distances. Other bodies have samples, of
//! which four corners of a cell are read at once. The products use vectors of eight numbers at most
//! and fused multiply-add on every processor, which gives the same bits everywhere. Loops that have
//! to be fast are plain loops, because closures and maps over arrays were not inlined into their
//! callers.
//!
//! The crate does not depend on solvers, meshes, the emulated bench, recordings or files; the
//! caller passes the bytes of a surrogate's file.

mod batch;
mod columns;
mod contact;
mod distance;
mod engine;
mod evaluation;
mod fem_press;
mod file;
mod footprint;
mod friction;
mod layout;
mod model;
mod network;
mod networks;
mod out_of_distribution;
mod read;
mod shear;
mod simd;
mod surface;
mod touch;
mod trained_on;
mod training;

pub use batch::FastBatch;
pub use distance::Body;
pub use evaluation::{Evaluation, GroupErrors};
pub use fem_press::{FemFrame, FemPress, training_places_mm};
pub use file::FastFileError;
pub use friction::Friction;
pub use layout::finest_edge_mm;
pub use model::{FastGel, PortElsewhere};
pub use read::FastReader;
pub use touch::Touch;
pub use trained_on::FastGelMismatch;
pub use training::{REPORT_STEPS, TrainProgress, TrainSettings};
