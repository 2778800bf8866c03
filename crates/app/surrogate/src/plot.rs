//! The plot of an evaluation.

use twintac_fast::GroupErrors;
use twintac_plot::{Bar, Bars, Ink};

use crate::train::FastResult;

impl FastResult {
    /// What presses in the test presses, in words.
    #[must_use]
    pub fn test_presses_name(&self) -> &'static str {
        match self.own_indenters {
            true => "own indenters, held out",
            false => "held-out shapes",
        }
    }

    /// Errors of the taxel that reads most: for test presses by shape and by depth, and for sliding
    /// ones.
    pub(super) fn plot(&self) -> Bars {
        let mut bars = Vec::new();
        // A group without frames has no errors to plot.
        let mut bar = |name: String, errors: &Option<GroupErrors>, ink: Ink| {
            bars.extend(errors.map(|errors| Bar {
                name,
                value: errors.nearest_percent,
                uncertainty: None,
                text: format!(
                    "{:.1} %, force {:.1} %",
                    errors.nearest_percent, errors.force_percent
                ),
                ink,
            }));
        };
        let like_training = "held-out presses";
        bar(like_training.into(), &self.held_out.overall, Ink::Muted);
        bar(
            self.test_presses_name().into(),
            &self.test_presses.overall,
            Ink::Twin,
        );
        for (shape, errors) in &self.test_presses.by_shape {
            bar(shape.clone(), errors, Ink::Twin);
        }
        for (depth_mm, errors) in &self.test_presses.by_depth_mm {
            let name = format!("{depth_mm} to {} mm deep", depth_mm + 1);
            bar(name, errors, Ink::Twin);
        }
        bar("sliding and tilting".into(), &self.slides.overall, Ink::Twin);
        Bars {
            title: format!(
                "{}: surrogate against FEM solution, {} data",
                self.sensor, self.provenance
            ),
            x_label: "mean error of the taxel with the largest reading, % of the press's largest reading"
                .into(),
            bars,
        }
    }
}
