//! Views made of simple shapes, one below the other, with dimensions in mm.

use twintac_plot::{Anchor, Ink, SMALL, Scene, extent, short, text_width};

/// The part of the sensor that a shape shows. It sets the shape's colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Part {
    /// The soft gel.
    Gel,
    /// The rigid shell.
    Shell,
    /// The circuit board.
    Board,
    /// The body of a pressure sensor.
    Chip,
    /// The opening of a chip, through which it measures pressure.
    Port,
}

/// The outline of a shape in the plane of its view, mm; the second coordinate points up.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Outline {
    /// A rectangle along the axes.
    Rectangle {
        /// Corner with the smallest coordinates, mm.
        min_mm: [f64; 2],
        /// Corner with the largest coordinates, mm.
        max_mm: [f64; 2],
    },
    /// A closed polygon.
    Polygon {
        /// Corners, mm.
        points_mm: Vec<[f64; 2]>,
    },
    /// A circle.
    Circle {
        /// Centre, mm.
        centre_mm: [f64; 2],
        /// Radius, mm.
        radius_mm: f64,
    },
}

/// One shape of a view.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Shape {
    /// The part that it shows.
    pub(crate) part: Part,
    /// Its outline.
    pub(crate) outline: Outline,
    /// A short label, such as a taxel's name.
    pub(crate) name: Option<String>,
}

/// A dimension: drawn horizontally between vertical lines, or vertically between horizontal ones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Dimension {
    /// First point, mm.
    pub(crate) from_mm: [f64; 2],
    /// Second point, mm. It shares one coordinate with `from_mm`; otherwise the longer direction is
    /// labelled.
    pub(crate) to_mm: [f64; 2],
}

/// One view of the sensor.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct View {
    /// The name above the view, such as "top".
    pub(crate) name: String,
    /// Shapes, from back to front.
    pub(crate) shapes: Vec<Shape>,
    /// Dimensions: horizontal ones below the view, vertical ones on its left, in this order.
    pub(crate) dimensions: Vec<Dimension>,
}

/// A drawing: views one below the other, in one scale.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Sheet {
    /// Title.
    pub(crate) title: String,
    /// Views from top to bottom.
    pub(crate) views: Vec<View>,
}

const WIDTH: f64 = 920.0;
const DIMENSION_ROW: f64 = 24.0;

impl Sheet {
    /// Draws all views, at most 920 px wide.
    pub(crate) fn scene(&self) -> Scene {
        let uprights = |view: &View| view.dimensions.iter().filter(|one| one.is_upright()).count();
        let most_uprights = self.views.iter().map(uprights).max().unwrap_or(0);
        let dimensions = self.views.iter().flat_map(|view| &view.dimensions);
        let labels = dimensions.map(|dimension| text_width(&dimension.label(), SMALL));
        let upright_row = 20.0 + labels.fold(0.0, f64::max);
        let left = 4.0 + upright_row * most_uprights as f64;
        let boxes: Vec<[[f64; 2]; 2]> = self.views.iter().map(View::bounds_mm).collect();
        let widest = boxes.iter().map(|[x, _]| x[1] - x[0]).fold(1e-6, f64::max);
        let highest = boxes.iter().map(|[_, y]| y[1] - y[0]).fold(1e-6, f64::max);
        let scale = ((WIDTH - left - 16.0) / widest).min(360.0 / highest);

        let width = (left + scale * widest + 16.0).clamp(560.0, WIDTH);
        let mut scene = Scene::new(&self.title, width, 0.0);
        let below_title = scene.heading(&self.title);
        let mut top = below_title + 28.0 + scene.legend([0.0, below_title + 16.0], &self.legend());
        for (view, [x_mm, y_mm]) in self.views.iter().zip(boxes) {
            scene.small([0.0, top], &view.name, Ink::Muted, Anchor::Start);
            top += 14.0;
            let frame = Frame {
                origin: [left, top],
                x_low_mm: x_mm[0],
                y_high_mm: y_mm[1],
                scale,
                upright_row,
            };
            let bottom = top + scale * (y_mm[1] - y_mm[0]);
            view.shapes
                .iter()
                .for_each(|shape| shape.draw(&mut scene, &frame));
            let level = view.draw_dimensions(&mut scene, &frame, left, bottom);
            top = bottom + DIMENSION_ROW * level as f64 + 30.0;
        }
        scene.height = top;
        scene
    }

    fn legend(&self) -> Vec<(&'static str, Ink, bool)> {
        let parts = [Part::Gel, Part::Shell, Part::Board, Part::Chip, Part::Port];
        let shown = |part: &Part| {
            self.views
                .iter()
                .flat_map(|view| &view.shapes)
                .any(|shape| shape.part == *part)
        };
        parts
            .into_iter()
            .filter(shown)
            .map(|part| (part.name(), part.ink(), false))
            .collect()
    }
}

impl Part {
    fn name(self) -> &'static str {
        match self {
            Part::Gel => "gel",
            Part::Shell => "shell",
            Part::Board => "board",
            Part::Chip => "chip",
            Part::Port => "port",
        }
    }

    fn ink(self) -> Ink {
        match self {
            Part::Gel => Ink::Rgb([0x8c, 0xc4, 0xe8]),
            Part::Shell => Ink::Rgb([0x8a, 0x94, 0x9e]),
            Part::Board => Ink::Rgb([0x2f, 0x8f, 0x6b]),
            Part::Chip => Ink::Rgb([0x4a, 0x55, 0x60]),
            Part::Port => Ink::Rgb([0xf4, 0xc5, 0x42]),
        }
    }

    fn opacity(self) -> f64 {
        match self {
            Part::Gel => 0.4,
            Part::Shell => 0.55,
            _ => 1.0,
        }
    }
}

/// Position of a view on the sheet.
struct Frame {
    origin: [f64; 2],
    x_low_mm: f64,
    y_high_mm: f64,
    scale: f64,
    /// Width of a vertical dimension with its label, px.
    upright_row: f64,
}

impl Frame {
    fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [
            self.origin[0] + self.scale * (x - self.x_low_mm),
            self.origin[1] + self.scale * (self.y_high_mm - y),
        ]
    }
}

impl Shape {
    fn corners_mm(&self) -> Vec<[f64; 2]> {
        match &self.outline {
            Outline::Rectangle {
                min_mm: [x0, y0],
                max_mm: [x1, y1],
            } => {
                vec![[*x0, *y0], [*x1, *y0], [*x1, *y1], [*x0, *y1]]
            }
            Outline::Polygon { points_mm } => points_mm.clone(),
            Outline::Circle { centre_mm, radius_mm } => {
                let angles = (0..48).map(|step| f64::from(step) * std::f64::consts::TAU / 48.0);
                angles
                    .map(|a| {
                        [
                            centre_mm[0] + radius_mm * a.cos(),
                            centre_mm[1] + radius_mm * a.sin(),
                        ]
                    })
                    .collect()
            }
        }
    }

    fn draw(&self, scene: &mut Scene, frame: &Frame) {
        let corners: Vec<[f64; 2]> = self
            .corners_mm()
            .into_iter()
            .map(|corner| frame.place(corner))
            .collect();
        let Some((x, y)) = extent(corners.iter().map(|c| c[0])).zip(extent(corners.iter().map(|c| c[1])))
        else {
            return;
        };
        scene.area(corners.clone(), self.part.ink(), self.part.opacity());
        if matches!(self.part, Part::Gel | Part::Shell) {
            scene.line(
                corners.iter().chain(corners.first()).copied(),
                self.part.ink(),
                1.25,
            );
        }
        let Some(name) = &self.name else { return };
        let middle = 0.5 * (x[0] + x[1]);
        let fits = text_width(name, SMALL) < x[1] - x[0] - 2.0 && y[1] - y[0] > SMALL + 4.0;
        let dark = matches!(self.part, Part::Chip | Part::Board);
        let ink = if fits && dark {
            Ink::Rgb([255; 3])
        } else {
            Ink::Text
        };
        let baseline = if fits {
            0.5 * (y[0] + y[1]) + 0.35 * SMALL
        } else {
            y[0] - 4.0
        };
        scene.small([middle, baseline], name, ink, Anchor::Middle);
    }
}

impl Dimension {
    fn is_upright(&self) -> bool {
        (self.to_mm[1] - self.from_mm[1]).abs() > (self.to_mm[0] - self.from_mm[0]).abs()
    }

    fn label(&self) -> String {
        let axis = usize::from(self.is_upright());
        let distance_mm = (self.to_mm[axis] - self.from_mm[axis]).abs();
        format!("{} mm", short(distance_mm))
    }
}

impl View {
    fn bounds_mm(&self) -> [[f64; 2]; 2] {
        let corners: Vec<[f64; 2]> = self.shapes.iter().flat_map(Shape::corners_mm).collect();
        [0, 1].map(|axis| extent(corners.iter().map(|corner| corner[axis])).unwrap_or([0.0, 1.0]))
    }

    /// Draws horizontal dimensions below `bottom` and vertical ones left of `left`. Returns the
    /// number of horizontal ones.
    fn draw_dimensions(&self, scene: &mut Scene, frame: &Frame, left: f64, bottom: f64) -> usize {
        let (mut level, mut upright) = (0, 0);
        for dimension in &self.dimensions {
            let (from, to) = (frame.place(dimension.from_mm), frame.place(dimension.to_mm));
            if dimension.is_upright() {
                upright += 1;
                let x = left - frame.upright_row * (upright - 1) as f64 - 12.0;
                let (top, low) = (from[1].min(to[1]), from[1].max(to[1]));
                for point in [from, to] {
                    scene.line([[x - 4.0, point[1]], [point[0] - 2.0, point[1]]], Ink::Muted, 0.6);
                }
                arrow(scene, [x, top], [x, low]);
                let text = dimension.label();
                scene.small([x - 6.0, 0.5 * (top + low) + 4.0], text, Ink::Text, Anchor::End);
            } else {
                level += 1;
                let y = bottom + DIMENSION_ROW * level as f64 - 4.0;
                let (start, end) = (from[0].min(to[0]), from[0].max(to[0]));
                for point in [from, to] {
                    scene.line([[point[0], point[1] + 2.0], [point[0], y + 4.0]], Ink::Muted, 0.6);
                }
                arrow(scene, [start, y], [end, y]);
                let text = dimension.label();
                if text_width(&text, SMALL) < end - start - 4.0 {
                    scene.small([0.5 * (start + end), y - 5.0], text, Ink::Text, Anchor::Middle);
                } else {
                    scene.small([end + 6.0, y + 4.0], text, Ink::Text, Anchor::Start);
                }
            }
        }
        level
    }
}

/// A line with an arrowhead at each end.
fn arrow(scene: &mut Scene, from: [f64; 2], to: [f64; 2]) {
    scene.line([from, to], Ink::Muted, 1.0);
    let length = (to[0] - from[0]).hypot(to[1] - from[1]).max(1e-9);
    let along = [(to[0] - from[0]) / length, (to[1] - from[1]) / length];
    let head = 6.0f64.min(0.4 * length);
    for (tip, sign) in [(from, 1.0), (to, -1.0)] {
        let back = [tip[0] + sign * head * along[0], tip[1] + sign * head * along[1]];
        let (side_x, side_y) = (0.4 * head * along[1], 0.4 * head * along[0]);
        let corners = vec![
            tip,
            [back[0] + side_x, back[1] - side_y],
            [back[0] - side_x, back[1] + side_y],
        ];
        scene.area(corners, Ink::Muted, 1.0);
    }
}

#[cfg(test)]
mod tests {
    use twintac_plot::svg;

    use super::*;

    fn sheet(size_mm: f64) -> Sheet {
        let outline = Outline::Rectangle {
            min_mm: [0.0; 2],
            max_mm: [size_mm, 6.0],
        };
        let shapes = vec![Shape {
            part: Part::Gel,
            outline,
            name: Some("S0".into()),
        }];
        let dimensions = vec![
            Dimension {
                from_mm: [0.0; 2],
                to_mm: [size_mm, 0.0],
            },
            Dimension {
                from_mm: [0.0; 2],
                to_mm: [0.0, 6.0],
            },
        ];
        Sheet {
            title: "t".into(),
            views: vec![View {
                name: "top".into(),
                shapes,
                dimensions,
            }],
        }
    }

    #[test]
    fn dimensions_are_labelled_in_mm() {
        let text = svg(&sheet(30.4).scene());
        assert!(text.contains(">30.4 mm<") && text.contains(">6 mm<") && text.contains(">S0<"));
    }

    #[test]
    fn nothing_and_no_numbers_can_be_drawn() {
        assert!(!svg(&sheet(f64::NAN).scene()).contains("NaN"));
        assert!(svg(&Sheet::default().scene()).ends_with("</svg>"));
    }
}
