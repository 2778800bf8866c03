//! Pictures of a sensor and of a press.

use twintac_plot::{Ink, Panel, Panels, Series};

use crate::{PressFrame, Pressed, Sensor};

/// Width of a line, px.
const LINE_PX: f64 = 1.5;

impl Sensor {
    /// The sensor from above and in section, with dimensions in mm, as the text of an SVG file.
    #[must_use]
    pub fn svg(&self) -> String {
        twintac_plot::svg(&twintac_drawing::drawing(&self.file().sensor))
    }
}

impl Pressed {
    /// Pressures at the ports and force over depth, as the text of an SVG file.
    #[must_use]
    pub fn svg(&self) -> String {
        let over_depth = |name: String, ink: Ink, value: &dyn Fn(&PressFrame) -> f64| Series {
            name,
            points: self
                .frames()
                .iter()
                .map(|frame| [frame.depth_mm, value(frame)])
                .collect(),
            ink,
            width_px: LINE_PX,
            dashed: false,
        };
        let pressures = (0..self.readings_kpa().len()).map(|taxel| {
            over_depth(format!("taxel {taxel}"), Ink::Series(taxel), &|frame| {
                frame.port_pressure_kpa[taxel]
            })
        });
        let panel = |y_label: &str, series: Vec<Series>| Panel {
            y_label: y_label.to_owned(),
            series,
            ..Panel::default()
        };
        let panels = Panels {
            title: format!("Press, {}", Self::PROVENANCE),
            x_label: "depth below first touch, mm".to_owned(),
            panels: vec![
                panel("pressure at ports, kPa", pressures.collect()),
                panel(
                    "force, N",
                    vec![over_depth(String::new(), Ink::Text, &|frame| frame.force_n)],
                ),
            ],
            panel_height_px: 120.0,
            logarithmic: false,
        };
        twintac_plot::svg(&panels.scene())
    }
}
