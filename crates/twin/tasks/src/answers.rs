//! The outputs of a step.

/// When an environment whose episode has ended begins the next one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Autoreset {
    /// In the next step, which ignores its action and has a reward of zero.
    NextStep,
    /// In the same step: the last observation is returned beside the first one of the new episode.
    SameStep,
    /// When [`Tasks::reset`](crate::Tasks::reset) is called.
    Disabled,
}

/// The outputs of a step.
pub struct Answers<'a> {
    /// Observations. `[n_environments * n_observed]`
    pub observed: &'a mut [f32],
    /// `[n_environments]`
    pub rewards: &'a mut [f64],
    /// Whether the task has ended. `[n_environments]`
    pub terminated: &'a mut [bool],
    /// Whether the time limit has ended the episode. `[n_environments]`
    pub truncated: &'a mut [bool],
    /// Figures that are true but not observed, see [`Tasks::figures`](crate::Tasks::figures).
    /// `[n_environments * n_figures]`
    pub figures: &'a mut [f32],
    /// Last observations of episodes that ended: written by [`Autoreset::SameStep`], for these
    /// environments only. `[n_environments * n_observed]`
    pub last_observed: &'a mut [f32],
    /// Last figures of these episodes. `[n_environments * n_figures]`
    pub last_figures: &'a mut [f32],
}
