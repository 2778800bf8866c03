//! A picture as plain data: marks in pixels, x right and y down. Charts build a scene; `svg` and
//! `raster` paint it.

use crate::color::Ink;
use crate::font;

/// Position of a text relative to its point, along the direction of the text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// The text starts at the point.
    Start,
    /// The text is centred on the point.
    Middle,
    /// The text ends at the point.
    End,
}

/// An element to paint.
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
        /// Whether the line is dashed.
        dashed: bool,
    },
    /// A filled polygon.
    Area {
        /// Corners, px.
        points: Vec<[f64; 2]>,
        /// Colour of the filling.
        ink: Ink,
        /// 0 is transparent, 1 is opaque.
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
        /// Opacity of the filling: 0 is transparent, 1 is opaque.
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
        /// Which part of the text is at the point.
        anchor: Anchor,
        /// Whether the text is bold.
        bold: bool,
        /// Whether the text is turned by 90° to the left.
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

/// Font size of small print in all pictures, px.
pub const SMALL: f64 = 11.0;
/// Margin around a picture in its own file, px.
pub(crate) const MARGIN: f64 = 12.0;
/// Font size of titles in all pictures, px.
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

    /// Adds a line. It is interrupted where a coordinate is not finite.
    pub fn line(&mut self, points: impl IntoIterator<Item = [f64; 2]>, ink: Ink, width: f64) {
        self.stroke(points, ink, width, false);
    }

    /// Adds a dashed line.
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

    /// Adds a filled polygon. It is left out if a coordinate is not finite.
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

    /// Adds small print centred on a point; it is moved and, if necessary, shortened so that it
    /// stays in the picture.
    pub fn centred(&mut self, [x, y]: [f64; 2], text: &str, ink: Ink) {
        let text = font::fitted(text, SMALL, self.width);
        let half = 0.5 * font::text_width(&text, SMALL);
        let inside = x.clamp(
            half.min(0.5 * self.width),
            (self.width - half).max(0.5 * self.width),
        );
        self.small([inside, y], text, ink, Anchor::Middle);
    }

    /// Adds the title in the upper left corner, in as many lines as it needs; returns the y where
    /// it ends, px.
    pub fn heading(&mut self, text: &str) -> f64 {
        const LINE: f64 = 17.0;
        let mut baseline = 14.0 - LINE;
        for line in font::bold_lines(text, TITLE, self.width) {
            baseline += LINE;
            self.text([0.0, baseline], line, TITLE, Ink::Text, Anchor::Start, true);
        }
        baseline + 6.0
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

    /// Adds small print that reads upwards, centred on a point; it is moved and shortened so that
    /// it stays in the picture.
    pub fn upwards(&mut self, [x, y]: [f64; 2], text: &str) {
        let text = font::fitted(text, SMALL, self.height);
        let half = 0.5 * font::text_width(&text, SMALL);
        let inside = y.clamp(
            half.min(0.5 * self.height),
            (self.height - half).max(0.5 * self.height),
        );
        let (at, size, ink, anchor) = ([x, inside], SMALL, Ink::Muted, Anchor::Middle);
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

    /// Adds a row of legend entries that starts at `at` and is wrapped at the right edge; returns
    /// the height, px. An entry is a name, its colour, and whether its line is dashed.
    pub fn legend(&mut self, at: [f64; 2], entries: &[(&str, Ink, bool)]) -> f64 {
        let [left, mut y] = at;
        let mut x = left;
        for &(name, ink, dashed) in entries {
            let name = font::fitted(name, SMALL, self.width - left - 24.0);
            let width = 24.0 + font::text_width(&name, SMALL);
            if x > left && x + width > self.width {
                (x, y) = (left, y + 16.0);
            }
            self.stroke([[x, y - 4.0], [x + 18.0, y - 4.0]], ink, 3.0, dashed);
            self.small([x + 24.0, y], name, Ink::Muted, Anchor::Start);
            x += width + 14.0;
        }
        if entries.is_empty() { 0.0 } else { y - at[1] + 16.0 }
    }

    /// Texts that extend beyond the picture. A test checks that no plot has any. If there is one
    /// all the same, the picture is painted larger, so that nothing is ever cut off.
    pub fn overflow(&self) -> Vec<&str> {
        let is_outside = |mark: &&Mark| {
            text_box(mark).is_some_and(|[[x0, y0], [x1, y1]]| {
                const ROUNDING: f64 = 1e-6;
                x0.min(y0) < -ROUNDING || x1 > self.width + ROUNDING || y1 > self.height + ROUNDING
            })
        };
        let texts = self.marks.iter().filter(is_outside);
        texts
            .filter_map(|mark| match mark {
                Mark::Text { text, .. } => Some(text.as_str()),
                _ => None,
            })
            .collect()
    }

    /// The rectangle that is painted, upper left and lower right corner: the picture with all of
    /// its texts, and a margin, px.
    pub(crate) fn painted(&self, margin: f64) -> [[f64; 2]; 2] {
        let boxes = self.marks.iter().filter_map(text_box);
        let [[x0, y0], [x1, y1]] = boxes.fold([[0.0, 0.0], [self.width, self.height]], |all, one| {
            [
                [f64::min(all[0][0], one[0][0]), f64::min(all[0][1], one[0][1])],
                [f64::max(all[1][0], one[1][0]), f64::max(all[1][1], one[1][1])],
            ]
        });
        [[x0 - margin, y0 - margin], [x1 + margin, y1 + margin]]
    }
}

/// Upper left and lower right corner of a text, px; `None` for other marks.
fn text_box(mark: &Mark) -> Option<[[f64; 2]; 2]> {
    const ABOVE: f64 = 0.8;
    const BELOW: f64 = 0.25;
    let Mark::Text {
        at: [x, y],
        size,
        anchor,
        upwards,
        ..
    } = mark
    else {
        return None;
    };
    let width = mark.text_width();
    let start = match anchor {
        Anchor::Start => 0.0,
        Anchor::Middle => -0.5 * width,
        Anchor::End => -width,
    };
    Some(if *upwards {
        [
            [x - ABOVE * size, y - start - width],
            [x + BELOW * size, y - start],
        ]
    } else {
        [
            [x + start, y - ABOVE * size],
            [x + start + width, y + BELOW * size],
        ]
    })
}

impl Mark {
    /// Width of a text along its direction, px; 0 for other marks.
    pub(crate) fn text_width(&self) -> f64 {
        match self {
            Mark::Text {
                text,
                size,
                bold: true,
                ..
            } => font::bold_width(text, *size),
            Mark::Text { text, size, .. } => font::text_width(text, *size),
            _ => 0.0,
        }
    }
}

fn is_finite(point: [f64; 2]) -> bool {
    point[0].is_finite() && point[1].is_finite()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_beyond_the_picture_is_found_and_painted_all_the_same() {
        let mut scene = Scene::new("narrow", 60.0, 40.0);
        scene.small([2.0, 12.0], "inside", Ink::Text, Anchor::Start);
        assert!(scene.overflow().is_empty());
        scene.small([10.0, 30.0], "pressure of a taxel", Ink::Text, Anchor::End);
        assert_eq!(scene.overflow(), ["pressure of a taxel"]);
        let [[left, top], [right, bottom]] = scene.painted(0.0);
        assert!(left < -50.0 && (top, right, bottom) == (0.0, 60.0, 40.0));
    }

    #[test]
    fn labels_and_legends_stay_in_the_picture_however_long_they_are() {
        let long = "a very long label indeed, ".repeat(9);
        let mut scene = Scene::new("narrow", 120.0, 300.0);
        scene.heading(&long);
        scene.centred([0.0, 200.0], &long, Ink::Text);
        scene.centred([118.0, 220.0], "short, kPa", Ink::Text);
        scene.upwards([20.0, 290.0], &long);
        scene.legend(
            [0.0, 240.0],
            &[(&long, Ink::Twin, false), ("b", Ink::Sensor, true)],
        );
        assert_eq!(scene.overflow(), Vec::<&str>::new());
    }
}
