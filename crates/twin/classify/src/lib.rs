//! Telling shapes by touch: a time-series transformer on what the taxels read during a press.
//!
//! The TwinTac paper (arXiv 2509.10063, section IV-C) names "a time-series transformer" and neither its size nor its inputs. This one has the usual
//! structure (Zerveas et al., *A Transformer-based Framework for Multivariate Time Series Representation Learning*, KDD 2021): samples are projected
//! to tokens, places in time are learned, encoder layers follow, and the tokens of all times together give the class.
//!
//! ```
//! use twintac_classify::{Classifier, Sampling, Series, TrainSettings, Trial};
//!
//! let press = |peak_kpa: [f64; 2]| -> Vec<Vec<f64>> {
//!     let share = |frame: usize| (std::f64::consts::PI * frame as f64 / 40.0).sin();
//!     (0..=40).map(|frame| peak_kpa.map(|kpa| kpa * share(frame)).to_vec()).collect()
//! };
//! let series = |peak_kpa| Series::of(&press(peak_kpa), Sampling::Load).unwrap();
//! let trial = |class, peak_kpa| Trial { class, series: series(peak_kpa) };
//! let trials: Vec<Trial> = (0..8)
//!     .flat_map(|i| [trial(0, [9.0 + f64::from(i), 2.0]), trial(1, [9.0 + f64::from(i), 8.0])])
//!     .collect();
//! let settings = TrainSettings { n_networks: 1, epochs: 40, ..TrainSettings::default() };
//! let classifier = Classifier::train(&trials, 2, &settings, 1, &mut |_| ()).unwrap();
//! assert_eq!(classifier.classify(&trial(1, [12.5, 7.0]).series), 1);
//! ```

mod classifier;
mod confusion;
mod error;
mod network;
mod series;
mod settings;

pub use classifier::{Classifier, Progress};
pub use confusion::Confusion;
pub use error::ClassifyError;
pub use series::{Sampling, Series, Trial};
pub use settings::TrainSettings;
