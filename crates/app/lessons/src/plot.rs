//! The picture of a judgement.

use twintac_fast::GroupErrors;
use twintac_plot::{Bar, Bars, Ink};

use crate::train::FastResult;

impl FastResult {
    /// What the exams press with, in words.
    #[must_use]
    pub fn exams_name(&self) -> &'static str {
        match self.own_indenters {
            true => "own indenters, not taught",
            false => "shapes never taught",
        }
    }

    /// Errors of the taxel that reads most: of exams, by shape and by depth, and of slides.
    pub(super) fn plot(&self) -> Bars {
        let mut bars = Vec::new();
        // A group without frames has no errors to draw.
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
        let like_lessons = "like lessons, not taught";
        bar(like_lessons.into(), &self.held_out.overall, Ink::Muted);
        bar(self.exams_name().into(), &self.exams.overall, Ink::Twin);
        for (shape, errors) in &self.exams.by_shape {
            bar(shape.clone(), errors, Ink::Twin);
        }
        for (depth_mm, errors) in &self.exams.by_depth_mm {
            let name = format!("{depth_mm} to {} mm deep", depth_mm + 1);
            bar(name, errors, Ink::Twin);
        }
        bar("sliding and tilting".into(), &self.slides.overall, Ink::Twin);
        Bars {
            title: format!(
                "{}: fast gel against solved gel, {} data",
                self.sensor, self.provenance
            ),
            x_label: "mean error of the taxel that reads most, % of the press's largest reading".into(),
            bars,
        }
    }
}
