//! A trained classifier.

use rand::seq::SliceRandom;
use twintac_config::Checked;
use twintac_learn::{AdamW, AdamWSettings, Matrix};
use twintac_random::{RandomStream, normal, stream};

use crate::network::{Network, softmax};
use crate::{ClassifyError, Confusion, Series, TrainSettings, Trial};

/// Fraction of the steps over which the learning rate rises.
const RISE: f64 = 0.1;
/// Inputs that vary less than this over the trials are not scaled up further, because their
/// variation is noise.
const SMALLEST_DEVIATION: f32 = 0.01;

/// Classifies the shape of a press from the readings of the taxels.
#[derive(Clone, Debug, PartialEq)]
pub struct Classifier {
    /// The class probabilities of these networks are averaged.
    networks: Vec<Network>,
    scale: Scale,
    n_classes: usize,
}

/// Progress of the training.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Finished passes over the trials.
    pub epoch: usize,
    /// Number of passes.
    pub of: usize,
    /// Mean cross-entropy over the last pass.
    pub loss: f64,
}

/// Brings every input to zero mean and unit deviation over the trials. The largest reading is on a
/// logarithmic scale.
#[derive(Clone, Debug, PartialEq)]
struct Scale {
    /// `[N_SAMPLES * n_inputs]`.
    means: Vec<f32>,
    /// One over the deviation; `[N_SAMPLES * n_inputs]`.
    per_deviation: Vec<f32>,
}

impl Classifier {
    /// Trains on trials of `n_classes` classes. The same trials in the same order with the same
    /// seed give the same classifier, bit for bit.
    ///
    /// # Errors
    /// No trials; trials with different numbers of taxels, or with a class that is not below
    /// `n_classes`; settings outside their ranges.
    pub fn train(
        trials: &[Trial],
        n_classes: usize,
        settings: &TrainSettings,
        seed: u64,
        progress: &mut dyn FnMut(Progress),
    ) -> Result<Self, ClassifyError> {
        settings.checked()?;
        let first = trials.first().ok_or(ClassifyError::NoTrials)?;
        for trial in trials {
            let (expected, found) = (first.series.n_taxels(), trial.series.n_taxels());
            if found != expected {
                return Err(ClassifyError::Taxels { expected, found });
            }
            if trial.class >= n_classes {
                let class = trial.class;
                return Err(ClassifyError::Class { class, n_classes });
            }
        }
        let scale = Scale::of(trials);
        let school = Training {
            trials,
            scale: &scale,
            settings,
            n_classes,
        };
        let networks = (0..settings.n_networks).map(|index| {
            let mut random = stream(seed, &format!("classify/{index}"));
            school.network(&mut random, &mut |done: Progress| {
                progress(Progress {
                    epoch: index * done.of + done.epoch,
                    of: settings.n_networks * done.of,
                    ..done
                });
            })
        });
        Ok(Self {
            networks: networks.collect(),
            scale,
            n_classes,
        })
    }

    /// The class of a press.
    #[must_use]
    pub fn classify(&self, series: &Series) -> usize {
        let mut input = Matrix::zeros(0, series.n_taxels() + 1);
        input.values = unscaled(series);
        self.scale.apply(&mut input.values);
        let mut probabilities = vec![0.0; self.n_classes];
        for network in &self.networks {
            let mut scores = network.scores(&input).values;
            softmax(&mut scores);
            probabilities
                .iter_mut()
                .zip(scores)
                .for_each(|(sum, own)| *sum += own);
        }
        let classes = probabilities.iter().enumerate();
        classes
            .max_by(|a, b| a.1.total_cmp(b.1))
            .map_or(0, |(class, _)| class)
    }

    /// Classifies trials and counts true against found classes.
    #[must_use]
    pub fn evaluate(&self, trials: &[Trial]) -> Confusion {
        let mut confusion = Confusion::new(self.n_classes);
        for trial in trials {
            confusion.count(trial.class, self.classify(&trial.series));
        }
        confusion
    }
}

/// What the networks are trained with.
struct Training<'a> {
    trials: &'a [Trial],
    scale: &'a Scale,
    settings: &'a TrainSettings,
    n_classes: usize,
}

impl Training<'_> {
    /// Trains one network.
    fn network(&self, random: &mut RandomStream, progress: &mut dyn FnMut(Progress)) -> Network {
        let (trials, settings) = (self.trials, self.settings);
        let n_inputs = trials[0].series.n_taxels() + 1;
        let mut network = Network::new(n_inputs, self.n_classes, settings, random);
        let optimizer = AdamWSettings {
            weight_decay: settings.weight_decay as f32,
            gradient_norm: settings.gradient_norm as f32,
        };
        let mut optimizer = AdamW::new(network.arrays(), optimizer);
        let steps_of_epoch = trials.len().div_ceil(settings.batch);
        let epochs = settings.epochs.max(settings.least_steps.div_ceil(steps_of_epoch));
        let n_steps = epochs * steps_of_epoch;
        let mut step = 0;
        let mut order: Vec<usize> = (0..trials.len()).collect();
        for epoch in 0..epochs {
            order.shuffle(random);
            let mut sum = 0.0;
            for batch in order.chunks(settings.batch) {
                let mut input = Matrix::zeros(0, n_inputs);
                let mut classes = Vec::with_capacity(batch.len());
                for &index in batch {
                    self.put_disturbed(&trials[index].series, random, &mut input.values);
                    classes.push(trials[index].class);
                }
                let (loss, slopes) = network.loss_and_slopes(&input, &classes);
                sum += f64::from(loss) * batch.len() as f64;
                let rate = settings.learning_rate * schedule(step as f64 / n_steps as f64);
                optimizer.step(rate, network.arrays_mut(), slopes.arrays());
                step += 1;
            }
            progress(Progress {
                epoch: epoch + 1,
                of: epochs,
                loss: sum / trials.len() as f64,
            });
        }
        network
    }

    /// Appends the inputs of a series with small random changes of the gains, and with noise.
    fn put_disturbed(&self, series: &Series, random: &mut RandomStream, to: &mut Vec<f32>) {
        let settings = self.settings;
        let n_taxels = series.n_taxels();
        let mut noise = |deviation: f64| normal(random, deviation) as f32;
        let gains: Vec<f32> = (0..n_taxels).map(|_| 1.0 + noise(settings.gain_noise)).collect();
        let mut inputs = unscaled(series);
        for row in inputs.chunks_exact_mut(n_taxels + 1) {
            for (share, gain) in row.iter_mut().zip(&gains) {
                *share = *share * gain + noise(settings.sample_noise);
            }
        }
        self.scale.apply(&mut inputs);
        to.append(&mut inputs);
    }
}

/// The inputs of a series before scaling; `[N_SAMPLES][n_taxels + 1]`, the largest reading last in
/// each row.
fn unscaled(series: &Series) -> Vec<f32> {
    let largest = series.largest_kpa.ln();
    let rows = series.shares.iter();
    rows.flat_map(|row| row.iter().copied().chain([largest]))
        .collect()
}

impl Scale {
    fn of(trials: &[Trial]) -> Self {
        let inputs: Vec<Vec<f32>> = trials.iter().map(|trial| unscaled(&trial.series)).collect();
        let n = inputs.len() as f32;
        let mean = |index: usize| inputs.iter().map(|input| input[index]).sum::<f32>() / n;
        let means: Vec<f32> = (0..inputs[0].len()).map(mean).collect();
        let per_deviation = |(index, mean): (usize, &f32)| {
            let squares = inputs.iter().map(|input| (input[index] - mean).powi(2));
            (squares.sum::<f32>() / n).sqrt().max(SMALLEST_DEVIATION).recip()
        };
        Self {
            per_deviation: means.iter().enumerate().map(per_deviation).collect(),
            means,
        }
    }

    fn apply(&self, inputs: &mut [f32]) {
        let scales = self.means.iter().zip(&self.per_deviation);
        for (input, (mean, per_deviation)) in inputs.iter_mut().zip(scales) {
            *input = (*input - mean) * per_deviation;
        }
    }
}

/// The learning rate as a fraction of its largest value, at a fraction of the steps.
fn schedule(part: f64) -> f64 {
    if part < RISE {
        return part / RISE;
    }
    0.5 * (1.0 + (std::f64::consts::PI * (part - RISE) / (1.0 - RISE)).cos())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Sampling;
    use rand::Rng;

    /// Presses whose class depends on which of two taxels rises first, and not on the size of the
    /// readings.
    fn trials(n: usize, seed: u64) -> Vec<Trial> {
        let mut random = stream(seed, "trials");
        (0..n)
            .map(|index| {
                let class = index % 2;
                let peaks: [f64; 2] = [(); 2].map(|()| random.random_range(5.0..50.0));
                let delay_s = random.random_range(0.15..0.3);
                let read = |time_s: f64, taxel: usize| {
                    let start_s = if taxel == class { 0.1 } else { 0.1 + delay_s };
                    peaks[taxel] * ((time_s - start_s) / 0.5).clamp(0.0, 1.0)
                };
                let frame = |i: usize| (0..2).map(|taxel| read(i as f64 / 55.0, taxel)).collect();
                let readings_kpa: Vec<_> = (0..55).map(frame).collect();
                let series = Series::of(&readings_kpa, Sampling::Time).unwrap();
                Trial { class, series }
            })
            .collect()
    }

    fn train(trials: &[Trial]) -> Classifier {
        let settings = TrainSettings {
            n_networks: 2,
            width: 16,
            hidden: 32,
            epochs: 30,
            least_steps: 200,
            ..TrainSettings::default()
        };
        Classifier::train(trials, 2, &settings, 1, &mut |_| ()).unwrap()
    }

    #[test]
    fn order_in_time_is_learned() {
        let classifier = train(&trials(120, 1));
        let found = classifier.evaluate(&trials(100, 2));
        assert!(found.accuracy_percent().unwrap() > 95.0, "{found:?}");
    }

    #[test]
    fn the_same_seed_gives_the_same_classifier() {
        let trials = trials(20, 1);
        assert_eq!(train(&trials), train(&trials));
    }

    #[test]
    fn what_cannot_be_learned_is_an_error() {
        let settings = TrainSettings::default();
        let error = |trials: &[Trial], settings: &TrainSettings| {
            Classifier::train(trials, 1, settings, 1, &mut |_| ())
                .unwrap_err()
                .to_string()
        };
        assert!(error(&[], &settings).contains("no trials"));
        assert!(error(&trials(2, 1), &settings).contains("class 1"));
        let settings = TrainSettings {
            n_heads: 5,
            ..settings
        };
        assert!(error(&trials(2, 1), &settings).contains("`n_heads` is 5"));
    }
}
