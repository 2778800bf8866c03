//! The TwinTac paper's experiments (arXiv 2509.10063) on the emulated bench, from nothing to one page.
//!
//! A folder with a run for each recording, and a stage for each experiment:
//!
//! ```text
//! presses/           a run: the paper's presses, as the bench records them
//! force-presses/     a run: presses of every shape, for their forces
//! material/          what the gel is made of and how rough it is, fitted to them
//! data/              a run: the presses on a gel that is levelled and fitted, and twins trained on them
//! pairs/             every frame of the bench beside the simulation, as one array, and a data card
//! trials/            a run: presses of the bench that shapes are told by
//! simulated/         the same as the twins feel them (Parquet)
//! shapes/            classifiers, and which shapes they tell
//! five-shapes/       a run: the presses of the pressure maps
//! maps/              what sensor and twin read of them
//! under-a-ball/      a run: presses that characterize the sensor
//! characterization/  report, data sheet and figures of them
//! report.html, metrics.json
//! ```

mod blocks;
mod data;
mod effort;
mod experiments;
mod finish;
mod level;
mod maps;
mod material;
mod metrics;
mod mixture;
mod page;
mod pairs;
mod shapes;
mod shapes_section;
mod structured_array;
mod trials;
mod under_a_ball;

pub use effort::Effort;
pub use experiments::Paper;
pub use maps::ShapeMap;
pub use material::GelMaterial;
pub use metrics::PaperMetrics;
pub use mixture::{Mixture, Simulated};
pub use shapes::ShapesResult;
pub use under_a_ball::SensorFigures;
