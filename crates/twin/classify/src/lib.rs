//! Classification of shapes by touch: a time-series transformer on the readings of the taxels
//! during a press.
//!
//! In: for each press a [`Series`], made from the readings of all taxels (kPa;
//! `[n_frames][n_taxels]`), and for training its class, together a [`Trial`]. Out:
//! [`Classifier::classify`] gives the class of a press, and [`Classifier::evaluate`] counts true
//! against found classes in a [`Confusion`] matrix. [`TrainSettings`] has the size of the network
//! and its training.
//!
//! The crate sees series of readings alone. It depends neither on the twin, nor on the emulated
//! bench, recordings, solvers or files, so it classifies `real`, `emulated` and `simulated` presses
//! alike.
//!
//! # How it works
//!
//! The TwinTac paper (arXiv 2509.10063, section IV-C) names "a time-series transformer" and states
//! neither its size nor its inputs. This one has the usual structure (Zerveas et al., *A
//! Transformer-based Framework for Multivariate Time Series Representation Learning*, KDD 2021):
//! samples are projected to tokens, positions in time are learned, encoder layers follow, and the
//! tokens of all times together give the class.
//!
//! **Inputs.** A press is reduced to 12 samples. They are at equal steps of load
//! ([`Sampling::Load`]), because with equal steps of time ([`Sampling::Time`]) speeds and holds
//! hide the shape. Each sample has the readings of the taxels over the largest reading of the
//! sample, and the logarithm of the largest reading of the press. Every input is brought to zero
//! mean and unit deviation over the training set.
//!
//! **Training.** The loss is the mean cross-entropy, the optimizer AdamW. In training, each trial
//! gets random gains of its taxels and noise on its samples. Several networks are trained; the
//! class with the largest mean probability counts. The same trials, settings and seed give the same
//! classifier, bit for bit.
//!
//! **Gradients** are written by hand and tested against difference quotients. The framework `burn`
//! with its smallest backend for processors took seven processor minutes to build, as long as
//! everything else together.
//!
//! ```text
//! series      readings of a press as samples
//! network     embedding, encoder layers, classification, and their gradients: attention, layer,
//!             norm
//! classifier  training, and the vote of several networks
//! confusion   the confusion matrix
//! settings    size and training
//! ```
//!
//! # Example
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
