//! Settings of all stages of a run: as people write them, and resolved for one sensor and its
//! presses.

use std::path::{Path, PathBuf};

use digitac::{BenchSettings, PairSettings, PlaceSettings, SplitSettings, Taxels, TrainSettings, Variant};
use serde::{Deserialize, Serialize};
use twintac_config::{Checked, ConfigError, Problem, Ranges};
use twintac_model::taxels;
use twintac_recording::Recording;
use twintac_sensor::Sensor;
use twintac_shape::Shape;
use twintac_simulate::SimulateSettings;
use twintac_temperature::Compensation;
use twintac_work::WorkError;

/// Fields that are not settings, although a reader may expect them to be, and what determines them.
const DECIDED: [(&str, &str); 4] = [
    ("split.seed", "it is determined by the run's seed, `--seed`"),
    ("train.seed", "it is determined by the run's seed, `--seed`"),
    (
        "bench.left_out",
        "it is determined by the sensor's description: the taxels that are `doubtful`",
    ),
    (
        "bench.ports_mm",
        "it is determined by the sensor's description: `position_mm` of its taxels; `smooth_factor = false` needs no positions",
    ),
];

/// Settings of all stages of a run; each has a default. A TOML file with other values has a table
/// for each field.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RunSettings {
    /// Simulation of the gel.
    pub simulate: SimulateSettings,
    /// File of a surrogate of the gel, made by `twintac fast train`: it then makes the tables, and
    /// nothing is solved by finite elements.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fast_gel: Option<PathBuf>,
    /// Temperature coefficients of the zeros, as `twintac characterize` finds them in a log.
    /// Recordings with temperatures are compensated, and the model keeps the coefficients.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub temperature: Option<Compensation>,
    /// Depths to which locations are simulated.
    pub places: PlaceSettings,
    /// Setup calibration: which unknowns of the test setup are fitted.
    pub bench: BenchSettings,
    /// Division into training, validation and test presses.
    pub split: SplitSettings,
    /// Alignment of clocks.
    pub pair: PairSettings,
    /// Training of the twins.
    pub train: TrainSettings,
}

impl Checked for RunSettings {
    fn check(&self, ranges: &mut Ranges) {
        let Self {
            simulate,
            fast_gel: _,
            temperature,
            places,
            bench,
            split,
            pair,
            train,
        } = self;
        if let Some(temperature) = temperature {
            ranges.inside("temperature", temperature);
        }
        ranges.inside("simulate", simulate);
        ranges.inside("places", places);
        ranges.inside("bench", bench);
        ranges.inside("split", split);
        ranges.inside("pair", pair);
        ranges.inside("train", train);
    }
}

impl RunSettings {
    /// The default settings, with the values of the file in place of its own, if there is a file.
    ///
    /// # Errors
    /// A file that cannot be read, an unknown field, a value that is not allowed.
    pub fn read(path: Option<&Path>) -> Result<Self, WorkError> {
        Self::default().but(path)
    }

    /// Settings for a few single presses: the gel is simulated more finely than for the many tables
    /// of a run.
    #[must_use]
    pub fn fine() -> Self {
        Self {
            simulate: SimulateSettings::fine(),
            ..Self::default()
        }
    }

    /// These settings, with the values of the file in place of their own, if there is a file.
    ///
    /// # Errors
    /// Those of [`read`](Self::read).
    pub fn but(self, path: Option<&Path>) -> Result<Self, WorkError> {
        let Some(path) = path else {
            return Ok(self);
        };
        let document = twintac_config::read_over(path, &self).map_err(decided)?;
        Ok(document.checked()?)
    }

    /// These settings, with the values of a TOML text in place of their own. Error messages name
    /// `file`.
    ///
    /// # Errors
    /// An unknown field, a value that is not allowed.
    pub fn but_parsed(self, file: &str, text: &str) -> Result<Self, WorkError> {
        let document = twintac_config::parse_over(file, text, &self).map_err(decided)?;
        Ok(document.checked()?)
    }

    /// The settings, completed with all that depends on the sensor, its presses and the seed.
    pub(crate) fn resolve(
        &self,
        sensor: &Sensor,
        recording: &Recording,
        seed: u64,
        is_fast: bool,
    ) -> Result<ResolvedSettings, Problem> {
        self.checked()?;
        let Self {
            simulate: _,    // unchanged
            fast_gel: _,    // an input of its own
            temperature: _, // applied when recordings are read
            places,
            mut bench,
            split,
            pair,
            mut train,
        } = self.clone();
        match (&bench.tip_radii_mm, has_unknown_tip(sensor, recording)) {
            (None, true) => bench.tip_radii_mm = Some(BenchSettings::UNKNOWN_TIP_RADII_MM.to_vec()),
            (Some(radii_mm), false) if !radii_mm.is_empty() => {
                return Err(Problem::new(
                    "bench.tip_radii_mm",
                    "has no effect: it is fitted only to presses with one ball whose radius is inferred in the sensor's description",
                    "leave it out, or say in the description that the radius is `inferred`",
                ));
            }
            _ => {}
        }
        if is_fast {
            train.variants = Some(without_paper(train.variants)?);
        }
        Ok(ResolvedSettings {
            places,
            bench,
            split,
            pair,
            train,
            seed,
            taxels: taxels(sensor),
        })
    }
}

/// The settings from which stages compute: resolved for one sensor, its presses and a seed.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ResolvedSettings {
    pub(crate) places: PlaceSettings,
    pub(crate) bench: BenchSettings,
    pub(crate) split: SplitSettings,
    pub(crate) pair: PairSettings,
    pub(crate) train: TrainSettings,
    /// Seed of all random choices.
    pub(crate) seed: u64,
    /// The taxels by the sensor's description.
    pub(crate) taxels: Taxels,
}

/// The variants that can be trained with a surrogate, which has no stress features.
fn without_paper(variants: Option<Vec<Variant>>) -> Result<Vec<Variant>, Problem> {
    match variants {
        Some(variants) if variants.contains(&Variant::Paper) => Err(Problem::new(
            "train.variants",
            "names the paper's network, which reads stresses, but a surrogate does not compute them",
            "leave `paper` or `fast_gel` out",
        )),
        Some(variants) => Ok(variants),
        None => Ok(Variant::ALL
            .into_iter()
            .filter(|variant| *variant != Variant::Paper)
            .collect()),
    }
}

/// Adds to the error of an unknown field what determines its value instead.
fn decided(error: ConfigError) -> ConfigError {
    match DECIDED.iter().find(|(field, _)| *field == error.field) {
        Some((_, hint)) => ConfigError {
            problem: "is an unknown field".to_owned(),
            hint: (*hint).to_owned(),
            ..error
        },
        None => error,
    }
}

/// Whether all presses were made with one ball whose radius the sensor's description marks as
/// inferred.
fn has_unknown_tip(sensor: &Sensor, recording: &Recording) -> bool {
    let Some(first) = recording.presses.first() else {
        return false;
    };
    let one = recording
        .presses
        .iter()
        .all(|press| press.indenter == first.indenter);
    let is_inferred = |index: usize| sensor.is_inferred(&format!("indenters[{index}].shape.radius_mm"));
    one && sensor.indenters.iter().enumerate().any(|(index, indenter)| {
        indenter.name == first.indenter
            && matches!(indenter.shape, Shape::Sphere { .. })
            && is_inferred(index)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values for fields that have none by default, so that every number of every table is tested.
    const ALL: &str = "
[simulate]
contact_edge_mm = 0.5
[bench]
tip_radii_mm = [2.0, 3.6, 6.5]
[split]
block_mm = 0.1
training_places = 8
";

    /// Fields for which zero is allowed: it switches their feature off.
    const ZERO_IS_NONE: [&str; 16] = [
        "bench.contact_offset_limit_mm",
        "bench.n_blocks",
        "bench.port_radius_limit_mm",
        "bench.port_shift_limit_mm",
        "bench.port_shift_pull",
        "bench.smooth_factor_pull",
        "pair.warp.believed_below",
        "pair.warp.smoothing_s",
        "pair.warp.step_cost",
        "pair.warp.window_s",
        "simulate.solver.friction",
        "simulate.solver.obstacle_friction",
        "train.correction_limit",
        "train.correction_noise",
        "train.paper_noise",
        "train.weight_decay",
    ];

    fn parse(text: &str) -> Result<RunSettings, WorkError> {
        RunSettings::default().but_parsed("a.toml", text)
    }

    fn refused(text: &str) -> ConfigError {
        match parse(text) {
            Err(WorkError::Config(error)) => error,
            other => panic!("{text}: {other:?}"),
        }
    }

    #[test]
    fn every_number_has_a_range() {
        let all = toml::to_string(&parse(ALL).unwrap()).unwrap();
        let mut accepted = std::collections::BTreeSet::new();
        let mut n_numbers = 0;
        for wrong in [-1.0, 1e300, 1e-300, f64::NAN, f64::INFINITY, 0.0] {
            for (field, text) in twintac_config::with_each_number(&all, wrong) {
                n_numbers += 1;
                match parse(&text) {
                    Ok(_) => {
                        assert_eq!(wrong, 0.0, "{field}");
                        accepted.insert(field);
                    }
                    Err(WorkError::Config(error)) => {
                        assert_eq!(error.field, field, "{wrong}: {error}");
                        assert!(error.line > 0 && error.to_string().starts_with("a.toml:"));
                    }
                    Err(other) => panic!("{field} = {wrong}: {other}"),
                }
            }
        }
        assert!(n_numbers >= 6 * 50, "{n_numbers}");
        assert_eq!(accepted, ZERO_IS_NONE.into_iter().map(str::to_owned).collect());
    }

    #[test]
    fn defaults_are_in_their_ranges() {
        assert_eq!(RunSettings::default().checked(), Ok(()));
        assert_eq!(RunSettings::fine().checked(), Ok(()));
    }

    #[test]
    fn former_names_are_read() {
        let former = parse("[split]\nteaching_places = 8\n").unwrap();
        assert_eq!(former, parse("[split]\ntraining_places = 8\n").unwrap());
        assert_ne!(former, RunSettings::default());
    }

    #[test]
    fn what_something_else_decides_is_no_setting_and_the_error_says_what_does() {
        for (text, field, hint) in [
            ("[split]\nseed = 3\n", "split.seed", "--seed"),
            ("[train]\nepochs = 5\nseed = 3\n", "train.seed", "--seed"),
            ("[bench]\nleft_out = [1]\n", "bench.left_out", "doubtful"),
            (
                "[bench]\nports_mm = [[0.0, 1.0]]\n",
                "bench.ports_mm",
                "position_mm",
            ),
        ] {
            let error = refused(text);
            assert_eq!((&error.field[..], error.line), (field, text.lines().count()));
            assert!(
                error.to_string().contains("unknown field") && error.hint.contains(hint),
                "{error}"
            );
        }
    }

    #[test]
    fn what_nobody_means_is_refused_with_line_field_value_and_range() {
        for (text, expected) in [
            (
                "[bench]\nn_places = 0\n",
                "a.toml:2: `bench.n_places` is 0; give 1 to 10000",
            ),
            (
                "[simulate]\nmax_nodes = 0\n",
                "a.toml:2: `simulate.max_nodes` is 0; give 100 to 1000000",
            ),
            (
                "[pair.warp]\nwindow_s = -3\n",
                "a.toml:2: `pair.warp.window_s` is -3; give 0, or 0.001 to 10",
            ),
            (
                "[bench]\ntip_radii_mm = [0.001, 900]\n",
                "a.toml:2: `bench.tip_radii_mm[0]` is 0.001; give 0.1 to 100",
            ),
            (
                "[bench]\nport_shift_limit_mm = -5\n",
                "a.toml:2: `bench.port_shift_limit_mm` is -5; give 0, or 0.001 to 5",
            ),
            (
                "[train]\ncorrection_hidden = [1000000000, 1000000000]\n",
                "a.toml:2: `train.correction_hidden[0]` is 1e9; give 1 to 1024",
            ),
            (
                "[places]\nmargin_mm = 1e6\n",
                "a.toml:2: `places.margin_mm` is 1000000; give 0.01 to 5",
            ),
            (
                "[simulate]\ndepth_step_mm = 1e-9\n",
                "a.toml:2: `simulate.depth_step_mm` is 1e-9; give 0.01 to 5",
            ),
            (
                "[train]\nvariants = []\n",
                "a.toml:2: `train.variants` is []; name one variant or more, each once",
            ),
        ] {
            assert_eq!(refused(text).to_string(), expected);
        }
    }

    #[test]
    fn what_cannot_be_trained_on_a_fast_gel_is_left_out_or_refused() {
        let all = without_paper(None).unwrap();
        assert_eq!(all.len(), Variant::ALL.len() - 1);
        assert_eq!(
            without_paper(Some(vec![Variant::Pressure])),
            Ok(vec![Variant::Pressure])
        );
        let error = without_paper(Some(vec![Variant::Pressure, Variant::Paper])).unwrap_err();
        assert_eq!(error.field, "train.variants");
    }
}
