//! Environments in a batch behave as alone, and episodes end and begin as configured.

#![allow(clippy::unwrap_used)] // a test that cannot set itself up has failed

use proptest::prelude::*;
use twintac_fast::FastGel;
use twintac_sensors::SensorVariation;
use twintac_tasks::{Answers, Autoreset, Kind, PICTURE_PX, TaskError, Tasks};

fn variation() -> SensorVariation {
    SensorVariation {
        gain_deviation: 0.1,
        offset_deviation_kpa: 0.1,
        noise_deviation_kpa: 0.02,
        quantum_kpa: 0.01,
        hysteresis: 0.03,
        dead_chance: 0.05,
        late_chance: 0.05,
        rate_hz: 55.0,
        jitter: 0.04,
        height_deviation_mm: 0.05,
        tilt_deviation_rad: 0.01,
        ..SensorVariation::default()
    }
}

/// Environments with the outputs of their steps.
struct Driven {
    tasks: Tasks,
    observed: Vec<f32>,
    rewards: Vec<f64>,
    terminated: Vec<bool>,
    truncated: Vec<bool>,
    figures: Vec<f32>,
    last_observed: Vec<f32>,
    last_figures: Vec<f32>,
}

impl Driven {
    fn new(kind: Kind, variation: &SensorVariation, sizes: [usize; 2], autoreset: Autoreset) -> Self {
        let tasks = Tasks::new(kind, &FastGel::phystac().unwrap(), variation, sizes, autoreset).unwrap();
        let n = tasks.n_environments();
        let (n_observed, n_figures) = (n * tasks.n_observed(), n * tasks.figures().len());
        Self {
            tasks,
            observed: vec![0.0; n_observed],
            rewards: vec![0.0; n],
            terminated: vec![false; n],
            truncated: vec![false; n],
            figures: vec![0.0; n_figures],
            last_observed: vec![f32::NAN; n_observed],
            last_figures: vec![f32::NAN; n_figures],
        }
    }

    /// Actions depend only on the environment's number and the step.
    fn step(&mut self, step: usize) {
        let n_actions = self.tasks.n_actions();
        let number = |index: usize| index + 7 * step;
        let actions: Vec<f32> = (0..self.rewards.len() * n_actions)
            .map(|index| {
                (0.37 * number(index) as f32).sin()
                    + if index % n_actions == n_actions - 1 {
                        0.3
                    } else {
                        0.0
                    }
            })
            .collect();
        self.step_with(&actions);
    }

    fn step_with(&mut self, actions: &[f32]) {
        self.tasks.step(
            actions,
            Answers {
                observed: &mut self.observed,
                rewards: &mut self.rewards,
                terminated: &mut self.terminated,
                truncated: &mut self.truncated,
                figures: &mut self.figures,
                last_observed: &mut self.last_observed,
                last_figures: &mut self.last_figures,
            },
        );
    }

    fn is_over(&self, environment: usize) -> bool {
        self.terminated[environment] || self.truncated[environment]
    }

    fn figure(&self, name: &str) -> f32 {
        self.figures[self
            .tasks
            .figures()
            .iter()
            .position(|known| *known == name)
            .unwrap()]
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(9))]

    #[test]
    fn bits_do_not_depend_on_other_environments_or_threads(
        kind in prop::sample::select(Kind::ALL.to_vec()),
        n in 2..30_usize,
        n_threads in 1..5_usize,
        seed in 0..1000_u64,
    ) {
        let mut many = Driven::new(kind, &variation(), [n, n_threads], Autoreset::NextStep);
        let mut few = Driven::new(kind, &variation(), [n / 2 + 1, 1], Autoreset::NextStep);
        // The last environment of `turned` has the seed of the first one of the others.
        let mut turned = Driven::new(kind, &variation(), [n, 2], Autoreset::NextStep);
        for environment in 0..n {
            many.tasks.seed(environment, seed + environment as u64);
            turned.tasks.seed(environment, seed + (n - 1 - environment) as u64);
        }
        for environment in 0..n / 2 + 1 {
            few.tasks.seed(environment, seed + environment as u64);
        }
        let (n_observed, n_figures) = (many.tasks.n_observed(), many.tasks.figures().len());
        for driven in [&mut many, &mut few, &mut turned] {
            for environment in 0..driven.tasks.n_environments() {
                let observed = &mut driven.observed[environment * n_observed..][..n_observed];
                driven.tasks.reset(environment, observed, &mut driven.figures[environment * n_figures..][..n_figures]);
            }
        }
        prop_assert_eq!(&many.figures[..n_figures], &turned.figures[(n - 1) * n_figures..]);
        for step in 0..12 {
            many.step(step);
            few.step(step);
            let n_few = few.rewards.len();
            prop_assert_eq!(&many.observed[..few.observed.len()], &few.observed[..]);
            prop_assert_eq!(&many.rewards[..n_few], &few.rewards[..]);
            prop_assert_eq!(&many.terminated[..n_few], &few.terminated[..]);
            prop_assert_eq!(&many.figures[..few.figures.len()], &few.figures[..]);
        }
    }
}

/// Steps until each kind of autoreset has ended two episodes. The episodes are the same.
#[test]
fn episodes_are_the_same_however_the_next_one_begins() {
    for (kind, limit) in [
        (Kind::ExploreShape, 20),
        (Kind::HoldForce, 700),
        (Kind::FollowEdge, 800),
    ] {
        let mut next = Driven::new(kind, &variation(), [1, 1], Autoreset::NextStep);
        let mut same = Driven::new(kind, &variation(), [1, 1], Autoreset::SameStep);
        let actions = vec![0.05; next.tasks.n_actions()];
        let mut ends = 0;
        for _ in 0..limit {
            next.step_with(&actions);
            same.step_with(&actions);
            assert_eq!(
                (next.rewards[0], next.is_over(0)),
                (same.rewards[0], same.is_over(0))
            );
            if next.is_over(0) {
                assert_eq!(next.observed, same.last_observed);
                assert_eq!(next.figures, same.last_figures);
                next.step_with(&actions);
                assert_eq!((next.rewards[0], next.is_over(0)), (0.0, false));
                assert_eq!(next.figures, same.figures);
                ends += 1;
            }
            assert_eq!(next.observed, same.observed);
        }
        assert!(ends >= 2, "{kind:?} ended {ends} times");
    }
}

#[test]
fn without_autoreset_an_episode_waits_for_a_reset() {
    let mut driven = Driven::new(Kind::ExploreShape, &variation(), [2, 2], Autoreset::Disabled);
    for step in 0..5 {
        driven.step(step);
    }
    assert!(driven.is_over(0) && driven.is_over(1));
    driven.step(5);
    assert!(driven.is_over(0), "it is over until it is reset");
    let (mut observed, mut figures) = (vec![0.0; driven.tasks.n_observed()], vec![0.0; 3]);
    driven.tasks.reset(0, &mut observed, &mut figures);
    driven.step(6);
    assert!(!driven.is_over(0) && driven.is_over(1));
}

/// A seed gives the same episodes again, and other episodes than another seed.
#[test]
fn a_seed_repeats_its_episodes() {
    let mut driven = Driven::new(Kind::HoldForce, &variation(), [1, 1], Autoreset::Disabled);
    let (mut observed, mut figures) = (vec![0.0; driven.tasks.n_observed()], vec![0.0; 4]);
    let mut begin = |driven: &mut Driven, seed: Option<u64>| {
        if let Some(seed) = seed {
            driven.tasks.seed(0, seed);
        }
        driven.tasks.reset(0, &mut observed, &mut figures);
        figures.clone()
    };
    let [first, second] = [Some(7), None].map(|seed| begin(&mut driven, seed));
    let [again, after] = [Some(7), None].map(|seed| begin(&mut driven, seed));
    assert_eq!((&first, &second), (&again, &after));
    assert_ne!(first, second);
    assert_ne!(first, begin(&mut driven, Some(8)));
}

/// As the press goes deeper, the force grows, and the readings with it.
#[test]
fn a_body_that_is_pressed_on_is_felt_more_and_more() {
    let perfect = SensorVariation::default();
    let mut driven = Driven::new(Kind::HoldForce, &perfect, [1, 1], Autoreset::Disabled);
    let (mut before_n, mut most_kpa) = (0.0, 0.0_f32);
    for step in 0..220 {
        driven.step_with(&[0.5]);
        let force_n = driven.figure("force_n");
        assert!(
            force_n >= before_n - 0.05,
            "step {step}: {force_n} N after {before_n} N"
        );
        before_n = force_n;
        most_kpa = driven.observed[..8]
            .iter()
            .fold(most_kpa, |most, reading| most.max(*reading));
        if driven.terminated[0] {
            break;
        }
    }
    assert!(
        before_n > 1.0 && most_kpa > 0.05,
        "{before_n} N, {most_kpa} × 10 kPa"
    );
}

/// A press on a shape is felt by at least one taxel.
#[test]
fn a_shape_is_felt_where_it_is() {
    let perfect = SensorVariation::default();
    let mut driven = Driven::new(Kind::ExploreShape, &perfect, [8, 1], Autoreset::Disabled);
    let press = |place: [f32; 2]| -> Vec<f32> {
        let action = [place[0], place[1], 1.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        (0..8).flat_map(|_| action).collect()
    };
    driven.step_with(&press([0.0, 0.0]));
    let n = driven.tasks.n_observed();
    for observed in driven.observed.chunks_exact(n) {
        assert!(
            observed[..8].iter().any(|reading| *reading > 0.2),
            "{:?}",
            &observed[..8]
        );
    }
    // The reward of equal scores for all shapes is zero.
    assert!(
        driven.rewards.iter().all(|reward| reward.abs() < 1e-9),
        "nothing was said"
    );
}

#[test]
fn as_many_environments_as_memory_has_no_room_for_are_refused() {
    let gel = FastGel::phystac().unwrap();
    for n in [0, 10_000_000_000_000, usize::MAX] {
        let made = Tasks::new(Kind::HoldForce, &gel, &variation(), [n, 2], Autoreset::Disabled);
        assert!(matches!(made, Err(TaskError::Count { found, .. }) if found == n));
    }
}

#[test]
fn a_picture_has_its_size_and_shows_the_contact() {
    for kind in Kind::ALL {
        let mut driven = Driven::new(kind, &variation(), [2, 1], Autoreset::Disabled);
        let untouched = driven.tasks.picture(1).unwrap();
        assert_eq!(untouched.len(), 3 * PICTURE_PX[0] * PICTURE_PX[1]);
        let actions = vec![0.6; 2 * driven.tasks.n_actions()];
        for _ in 0..4 {
            driven.step_with(&actions);
        }
        assert_ne!(untouched, driven.tasks.picture(1).unwrap());
    }
}
