//! Steps do not allocate memory; the start of an episode does.

#![allow(clippy::unwrap_used)] // a test that cannot set itself up has failed

use twintac_fast::FastGel;
use twintac_tasks::{Answers, Autoreset, Kind, Tasks, usual_variation};

#[path = "../../sensors/examples/rate/counting.rs"]
mod counting;

const N: usize = 64;

/// Number of allocations in `n_steps` steps, after `n_before` steps that are not counted.
fn counted(kind: Kind, n_threads: usize, [n_before, n_steps]: [usize; 2]) -> usize {
    let gel = FastGel::phystac().unwrap();
    let sizes = [N, n_threads];
    let mut tasks = Tasks::new(kind, &gel, &usual_variation(), sizes, Autoreset::NextStep).unwrap();
    let actions = vec![0.05; N * tasks.n_actions()];
    let (n_observed, n_figures) = (N * tasks.n_observed(), N * tasks.figures().len());
    let (mut observed, mut last_observed) = (vec![0.0; n_observed], vec![0.0; n_observed]);
    let (mut figures, mut last_figures) = (vec![0.0; n_figures], vec![0.0; n_figures]);
    let (mut rewards, mut terminated, mut truncated) = (vec![0.0; N], vec![false; N], vec![false; N]);
    let mut before = 0;
    for step in 0..n_before + n_steps {
        if step == n_before {
            before = counting::n_allocations();
        }
        let answers = Answers {
            observed: &mut observed,
            rewards: &mut rewards,
            terminated: &mut terminated,
            truncated: &mut truncated,
            figures: &mut figures,
            last_observed: &mut last_observed,
            last_figures: &mut last_figures,
        };
        tasks.step(&actions, answers);
    }
    counting::n_allocations() - before
}

/// This is one test, because the allocations of another test that runs at the same time would be
/// counted too.
#[test]
fn steps_allocate_nothing() {
    for (kind, steps) in [
        (Kind::HoldForce, [5, 100]),
        (Kind::FollowEdge, [5, 40]),
        (Kind::ExploreShape, [1, 3]),
    ] {
        for n_threads in [1, 2] {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(n_threads)
                .build()
                .unwrap();
            let fewest = pool.install(|| counting::fewest_of_runs(|| counted(kind, n_threads, steps)));
            assert_eq!(fewest, 0, "{kind:?}, {n_threads} threads");
        }
    }
    assert!(counted(Kind::ExploreShape, 1, [3, 4]) > 0, "nothing was counted");
}
