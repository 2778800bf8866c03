//! Design search: sensors that differ in numbers of their description, simulated and compared
//! before one is cast.
//!
//! [`search`] takes a sensor's description, the numbers to vary ([`Variable`], for example
//! `gel.height_mm=4..10`), how many designs to try ([`Plan`]), how to measure them ([`Measure`]),
//! and what is wanted ([`Wishes`]). It returns [`Designs`]: for each design its [`Figures`], for
//! example sensitivity in kPa/N, range in N, and localization error in mm. The folder gets
//! `designs.csv`, `designs.json`, `designs.png`, and `best.toml`, the description of the best
//! design.
//!
//! All figures are `simulated`. They hold for one ball near the middle of the ports, and for the
//! noise of the chips alone.
//!
//! # How it works
//!
//! 1. Every design is written as a description and checked, before anything is solved.
//! 2. The gel of each design is pressed by a ball (`press`): above the taxel nearest to the middle
//!    of all ports, and at the location farthest from it and its next neighbours ("between"). The
//!    depth goes to half of the gel's height, or to the description's limit. Results are kept, so a
//!    search that was killed continues.
//! 3. Most figures hold at a given force of the ball ([`Measure::force_n`]). The range ends where
//!    the chip saturates, at the limits of the description, or where the solver finds no
//!    equilibrium ([`RangeEnd`]).
//! 4. The localization error is the Cramér–Rao bound: the covariance of unknown location and depth
//!    is `σ² (Jᵀ J)⁻¹`, with the noise `σ` of a reading and the derivatives `J` of all readings
//!    with respect to the unknowns. The derivatives are differences over 0.5 mm and over 5 % of the
//!    depth.
//! 5. Hysteresis needs a material that relaxes: the ball goes down to the depth and up again at 1
//!    mm/s.
//! 6. [`Wishes`] has goals and needs. The Pareto front ([`Designs::front`]) has the designs that no
//!    other design beats in all goals. The best design ([`Designs::best`]) meets all needs, and its
//!    worst goal is the best, with each goal scaled from 0 (best of these designs) to 1 (worst).
//!
//! The crate reads no environment variable and no argument, prints nothing, and does not depend on
//! `crates/app/run`.

mod described;
mod design;
mod figures;
mod measure;
mod plan;
mod plot;
mod press;
mod search;
mod variable;
mod wishes;

pub use design::{Design, Designs};
pub use figures::{Figure, Figures, RangeEnd};
pub use measure::Measure;
pub use plan::Plan;
pub use search::search;
pub use variable::Variable;
pub use wishes::Wishes;
