//! The plot of designs: two goals as axes, a third as colour.

use twintac_plot::{Scatter, ScatterPoint};

use crate::{Designs, Figure, Wishes};

/// The plot of all designs that could be evaluated. If there are fewer than three goals, the first
/// one is used again.
pub(crate) fn plot(designs: &Designs, wishes: &Wishes) -> Scatter {
    let goal = |index: usize| wishes.goals.get(index).or(wishes.goals.first()).copied();
    let [x, y, color] = [0, 1, 2].map(|index| goal(index).unwrap_or(Figure::RangeN));
    let (front, best) = (designs.front(wishes), designs.best(wishes));
    let points = designs.evaluated().filter_map(|(design, figures)| {
        Some(ScatterPoint {
            at: [x.of(figures)?, y.of(figures)?],
            value: color.of(figures)?,
            is_ringed: front.contains(&design.number),
            name: match best == Some(design.number) {
                true => format!("best: design {}", design.number),
                false => String::new(),
            },
        })
    });
    Scatter {
        title: format!(
            "{}: {} designs, simulated; ringed: Pareto-optimal",
            designs.sensor,
            designs.designs.len()
        ),
        x_label: x.label().to_owned(),
        y_label: y.label().to_owned(),
        value_label: color.label().to_owned(),
        points: points.collect(),
    }
}
