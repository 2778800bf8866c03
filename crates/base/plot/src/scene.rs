//! A picture as plain data: marks in pixels, x right and y down. Charts build one; `svg` and `raster` paint it.

use crate::color::Ink;
use crate::font;

/// Where a text sits relative to its point, along its own direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// The text starts at the point.
    Start,
    /// The text is centred on the point.
    Middle,
    /// The text ends at the point.
    End,
}

/// One thing to paint.
#[derive(Clone, Debug, PartialEq)]
pub enum Mark {
    /// A stroked line through points.
    Line {
        /// Corners, px.
        points: Vec<[f64; 2]>,
        /// Colour of the stroke.
        ink: Ink,
        /// Width of the stroke, px.
        width: f64,
        /// Whether the stroke is interrupted.
        dashed: bool,
    },
    /// A filled polygon.
    Area {
        /// Corners, px.
        points: Vec<[f64; 2]>,
        /// Colour of the filling.
        ink: Ink,
        /// 0 is clear, 1 is solid.
        opacity: f64,
    },
    /// A circle, filled, outlined or both.
    Circle {
        /// Centre, px.
        centre: [f64; 2],
        /// Radius, px.
        radius: f64,
        /// Colour of the filling.
        fill: Option<Ink>,
        /// Colour of the outline, 1.25 px wide.
        stroke: Option<Ink>,
        /// Opacity of the filling: 0 is clear, 1 is solid.
        opacity: f64,
    },
    /// One line of text on its baseline.
    Text {
        /// Anchor point on the baseline, px.
        at: [f64; 2],
        /// The words.
        text: String,
        /// Height of the font, px.
        size: f64,
        /// Colour.
        ink: Ink,
        /// Which part of the text sits at the point.
        anchor: Anchor,
        /// Whether the text is heavier.
        bold: bool,
        /// Whether the text is turned a quarter to the left.
        upwards: bool,
    },
    /// A grid of colours stretched over a rectangle, the first row at the top.
    Image {
        /// Upper left corner, px.
        at: [f64; 2],
        /// Width and height, px.
        size: [f64; 2],
        /// Number of columns of `pixels`.
        columns: usize,
        /// Colours, row by row.
        pixels: Vec<[u8; 3]>,
    },
}

/// A picture with its size and its name.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// What the picture shows, for readers who cannot see it.
    pub name: String,
    /// Width, px.
    pub width: f64,
    /// Height, px.
    pub height: f64,
    /// What to paint, from back to front.
    pub marks: Vec<Mark>,
}

/// The one size of small print in all pictures, px.
pub const SMALL: f64 = 11.0;
/// The one size of titles in all pictures, px.
pub(crate) const TITLE: f64 = 13.0;

impl Scene {
    /// An empty picture of `width` by `height` pixels.
    pub fn new(name: impl Into<String>, width: f64, height: f64) -> Self {
        Scene {
            name: name.into(),
            width,
            height,
            marks: Vec::new(),
        }
    }

    /// Adds a line, interrupted where a coordinate is not a finite number.
    pub fn line(&mut self, points: impl IntoIterator<Item = [f64; 2]>, ink: Ink, width: f64) {
        self.stroke(points, ink, width, false);
    }

    /// Adds an interrupted line.
    pub fn dashes(&mut self, points: impl IntoIterator<Item = [f64; 2]>, ink: Ink, width: f64) {
        self.stroke(points, ink, width, true);
    }

    fn stroke(&mut self, points: impl IntoIterator<Item = [f64; 2]>, ink: Ink, width: f64, dashed: bool) {
        let mut run = Vec::new();
        let mut finish = |run: &mut Vec<[f64; 2]>| {
            let points = std::mem::take(run);
            if points.len() > 1 {
                self.marks.push(Mark::Line {
                    points,
                    ink,
                    width,
                    dashed,
                });
            }
        };
        for point in points {
            if is_finite(point) {
                run.push(point);
            } else {
                finish(&mut run);
            }
        }
        finish(&mut run);
    }

    /// Adds a filled polygon; one with a coordinate that is not a finite number is left out.
    pub fn area(&mut self, points: Vec<[f64; 2]>, ink: Ink, opacity: f64) {
        if points.len() > 2 && points.iter().copied().all(is_finite) {
            self.marks.push(Mark::Area { points, ink, opacity });
        }
    }

    /// Adds a filled rectangle.
    pub fn rectangle(&mut self, at: [f64; 2], size: [f64; 2], ink: Ink, opacity: f64) {
        let ([x, y], [width, height]) = (at, size);
        self.area(
            vec![[x, y], [x + width, y], [x + width, y + height], [x, y + height]],
            ink,
            opacity,
        );
    }

    /// Adds a dot.
    pub fn dot(&mut self, centre: [f64; 2], radius: f64, ink: Ink, opacity: f64) {
        if is_finite(centre) {
            let (fill, stroke) = (Some(ink), None);
            self.marks.push(Mark::Circle {
                centre,
                radius,
                fill,
                stroke,
                opacity,
            });
        }
    }

    /// Adds a circle, with a filling if `fill` is given.
    pub fn ring(&mut self, centre: [f64; 2], radius: f64, stroke: Ink, fill: Option<Ink>) {
        if is_finite(centre) && radius.is_finite() {
            let stroke = Some(stroke);
            self.marks.push(Mark::Circle {
                centre,
                radius,
                fill,
                stroke,
                opacity: 1.0,
            });
        }
    }

    /// Adds small print.
    pub fn small(&mut self, at: [f64; 2], text: impl Into<String>, ink: Ink, anchor: Anchor) {
        self.text(at, text, SMALL, ink, anchor, false);
    }

    /// Adds a title.
    pub fn title(&mut self, at: [f64; 2], text: impl Into<String>) {
        self.text(at, text, TITLE, Ink::Text, Anchor::Start, true);
    }

    /// Adds a text on its baseline.
    pub fn text(
        &mut self,
        at: [f64; 2],
        text: impl Into<String>,
        size: f64,
        ink: Ink,
        anchor: Anchor,
        bold: bool,
    ) {
        let text = text.into();
        if is_finite(at) && !text.is_empty() {
            self.marks.push(Mark::Text {
                at,
                text,
                size,
                ink,
                anchor,
                bold,
                upwards: false,
            });
        }
    }

    /// Adds small print that reads upwards, centred on the point.
    pub fn upwards(&mut self, at: [f64; 2], text: impl Into<String>) {
        let (text, size, ink, anchor) = (text.into(), SMALL, Ink::Muted, Anchor::Middle);
        if is_finite(at) && !text.is_empty() {
            self.marks.push(Mark::Text {
                at,
                text,
                size,
                ink,
                anchor,
                bold: false,
                upwards: true,
            });
        }
    }

    /// Adds a row of named swatches from `at` on, wrapped at the right edge; returns the height used, px.
    pub fn legend(&mut self, at: [f64; 2], entries: &[(&str, Ink, bool)]) -> f64 {
        let [left, mut y] = at;
        let mut x = left;
        for &(name, ink, dashed) in entries {
            let width = 24.0 + font::text_width(name, SMALL) + 14.0;
            if x > left && x + width > self.width {
                (x, y) = (left, y + 16.0);
            }
            self.stroke([[x, y - 4.0], [x + 18.0, y - 4.0]], ink, 3.0, dashed);
            self.small([x + 24.0, y], name, Ink::Muted, Anchor::Start);
            x += width;
        }
        if entries.is_empty() { 0.0 } else { y - at[1] + 16.0 }
    }
}

fn is_finite(point: [f64; 2]) -> bool {
    point[0].is_finite() && point[1].is_finite()
}
