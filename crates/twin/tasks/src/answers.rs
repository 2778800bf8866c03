//! What a step answers.

/// When an environment whose episode is over begins the next one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Autoreset {
    /// In the next step, which ignores its action and has a reward of zero.
    NextStep,
    /// In the same step: what was observed last is handed out beside the new observation.
    SameStep,
    /// When [`Tasks::reset`](crate::Tasks::reset) is called.
    Disabled,
}

/// What a step answers.
pub struct Answers<'a> {
    /// What each robot knows. `[n_environments * n_observed]`
    pub observed: &'a mut [f32],
    /// `[n_environments]`
    pub rewards: &'a mut [f64],
    /// The task is over. `[n_environments]`
    pub terminated: &'a mut [bool],
    /// Time is over. `[n_environments]`
    pub truncated: &'a mut [bool],
    /// What is true beside it, see [`Tasks::figures`](crate::Tasks::figures). `[n_environments * n_figures]`
    pub figures: &'a mut [f32],
    /// What was observed last in episodes that ended: written by [`Autoreset::SameStep`], for these environments alone. `[n_environments * n_observed]`
    pub last_observed: &'a mut [f32],
    /// Figures of the same. `[n_environments * n_figures]`
    pub last_figures: &'a mut [f32],
}
