//! Paints a scene as a PNG on a white background, anti-aliased, with the embedded font.

use tiny_skia::{
    Color, FillRule, FilterQuality, IntSize, Paint, Path, PathBuilder, Pixmap, PixmapPaint, Stroke,
    StrokeDash, Transform,
};
use ttf_parser::{Face, OutlineBuilder};

use crate::PlotError;
use crate::color::Ink;
use crate::font;
use crate::scene::{Anchor, MARGIN, Mark, Scene};

/// The scene on a white background with a margin, as the bytes of a PNG file, with `scale` pixels
/// for each pixel of the scene (2 looks sharp on paper).
///
/// # Errors
/// [`PlotError::Raster`] if the size is zero or too large for memory.
pub fn png(scene: &Scene, scale: f64) -> Result<Vec<u8>, PlotError> {
    let painted = scene.painted(MARGIN);
    let size_px = size_px(painted, scale);
    let pixmap = paint(scene, painted, scale)?;
    pixmap
        .encode_png()
        .map_err(|error| failed(size_px, error.to_string()))
}

/// The scene on a white background in its own size, without a margin: red, green and blue of each
/// pixel, row by row from the top. What is outside of the scene is cut off.
///
/// # Errors
/// [`PlotError::Raster`] if the size is zero or too large for memory.
pub fn pixels(scene: &Scene) -> Result<Vec<u8>, PlotError> {
    let pixmap = paint(scene, [[0.0, 0.0], [scene.width, scene.height]], 1.0)?;
    let colors = pixmap.pixels().iter();
    Ok(colors
        .flat_map(|color| [color.red(), color.green(), color.blue()])
        .collect())
}

fn size_px([[x0, y0], [x1, y1]]: [[f64; 2]; 2], scale: f64) -> [f64; 2] {
    [x1 - x0, y1 - y0].map(|side| (side * scale).ceil())
}

fn failed([width_px, height_px]: [f64; 2], reason: String) -> PlotError {
    PlotError::Raster {
        width_px,
        height_px,
        reason,
    }
}

/// Paints a rectangle of the scene.
fn paint(scene: &Scene, rectangle: [[f64; 2]; 2], scale: f64) -> Result<Pixmap, PlotError> {
    let [x0, y0] = rectangle[0];
    let is_empty = !(scene.width > 0.0 && scene.height > 0.0);
    let size_px = size_px(rectangle, scale);
    let pixmap = Pixmap::new(size_px[0] as u32, size_px[1] as u32).filter(|_| !is_empty);
    let mut canvas = Canvas {
        pixmap: pixmap.ok_or_else(|| failed(size_px, "the size is not possible".into()))?,
        transform: Transform::from_translate(-x0 as f32, -y0 as f32).post_scale(scale as f32, scale as f32),
        face: font::face().ok_or_else(|| failed(size_px, "the embedded font is damaged".into()))?,
    };
    canvas.pixmap.fill(Color::WHITE);
    for mark in &scene.marks {
        canvas.paint(mark);
    }
    Ok(canvas.pixmap)
}

struct Canvas {
    pixmap: Pixmap,
    /// Transforms pixels of the scene to those of the pixmap.
    transform: Transform,
    face: Face<'static>,
}

impl Canvas {
    fn paint(&mut self, mark: &Mark) {
        match mark {
            Mark::Line {
                points,
                ink,
                width,
                dashed,
            } => {
                let stroke = Stroke {
                    width: *width as f32,
                    dash: dashed.then(|| StrokeDash::new(vec![4.0, 3.0], 0.0)).flatten(),
                    line_join: tiny_skia::LineJoin::Round,
                    ..Stroke::default()
                };
                self.stroke(polygon(points, false).as_ref(), *ink, &stroke, self.transform);
            }
            Mark::Area { points, ink, opacity } => {
                self.fill(polygon(points, true).as_ref(), *ink, *opacity, self.transform);
            }
            Mark::Circle {
                centre: [x, y],
                radius,
                fill,
                stroke,
                opacity,
            } => {
                let path = PathBuilder::from_circle(*x as f32, *y as f32, *radius as f32);
                if let Some(ink) = fill {
                    self.fill(path.as_ref(), *ink, *opacity, self.transform);
                }
                if let Some(ink) = stroke {
                    let stroke = Stroke {
                        width: 1.25,
                        ..Stroke::default()
                    };
                    self.stroke(path.as_ref(), *ink, &stroke, self.transform);
                }
            }
            Mark::Text { .. } => self.text(mark),
            Mark::Image {
                at,
                size,
                columns,
                pixels,
            } => self.image(*at, *size, *columns, pixels),
        }
    }

    fn fill(&mut self, path: Option<&Path>, ink: Ink, opacity: f64, transform: Transform) {
        if let Some(path) = path {
            let paint = solid(ink, opacity);
            self.pixmap
                .fill_path(path, &paint, FillRule::Winding, transform, None);
        }
    }

    fn stroke(&mut self, path: Option<&Path>, ink: Ink, stroke: &Stroke, transform: Transform) {
        if let Some(path) = path {
            self.pixmap
                .stroke_path(path, &solid(ink, 1.0), stroke, transform, None);
        }
    }

    fn text(&mut self, mark: &Mark) {
        let Mark::Text {
            at,
            text,
            size,
            ink,
            anchor,
            bold,
            upwards,
        } = mark
        else {
            return;
        };
        let (path, width_em) = letters(&self.face, text);
        let shift_em = match anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => -0.5 * width_em,
            Anchor::End => -width_em,
        };
        let turn = if *upwards {
            Transform::from_rotate(-90.0)
        } else {
            Transform::identity()
        };
        let placed = Transform::from_translate(shift_em as f32, 0.0)
            .post_scale(*size as f32, *size as f32)
            .post_concat(turn)
            .post_translate(at[0] as f32, at[1] as f32)
            .post_concat(self.transform);
        self.fill(path.as_ref(), *ink, 1.0, placed);
        // The embedded font is light: an outline gives it the weight of a browser's text.
        let stroke = Stroke {
            width: if *bold { 0.055 } else { 0.018 },
            ..Stroke::default()
        };
        self.stroke(path.as_ref(), *ink, &stroke, placed);
    }

    fn image(&mut self, at: [f64; 2], size: [f64; 2], columns: usize, pixels: &[[u8; 3]]) {
        let Some(image) = pixmap_of(columns, pixels) else {
            return;
        };
        let (across, down) = (image.width() as f32, image.height() as f32);
        let placed = Transform::from_scale(size[0] as f32 / across, size[1] as f32 / down)
            .post_translate(at[0] as f32, at[1] as f32)
            .post_concat(self.transform);
        let style = PixmapPaint {
            quality: FilterQuality::Bilinear,
            ..PixmapPaint::default()
        };
        self.pixmap
            .draw_pixmap(0, 0, image.as_ref(), &style, placed, None);
    }
}

fn solid(ink: Ink, opacity: f64) -> Paint<'static> {
    let [red, green, blue] = ink.rgb();
    let mut paint = Paint::default();
    paint.set_color_rgba8(red, green, blue, (opacity.clamp(0.0, 1.0) * 255.0).round() as u8);
    paint
}

fn polygon(points: &[[f64; 2]], closed: bool) -> Option<Path> {
    let mut builder = PathBuilder::new();
    for (index, &[x, y]) in points.iter().enumerate() {
        if index == 0 {
            builder.move_to(x as f32, y as f32)
        } else {
            builder.line_to(x as f32, y as f32)
        }
    }
    if closed {
        builder.close();
    }
    builder.finish()
}

/// Outlines of a text that starts at the origin, one em high, y down; and its width, em.
fn letters(face: &Face<'_>, text: &str) -> (Option<Path>, f64) {
    let (glyphs, width_em) = font::layout(face, text);
    let unit = 1.0 / f32::from(face.units_per_em());
    let mut pen = Pen {
        builder: PathBuilder::new(),
        start: 0.0,
        unit,
    };
    for (glyph, start_em) in glyphs {
        pen.start = start_em as f32;
        face.outline_glyph(glyph, &mut pen);
    }
    (pen.builder.finish(), width_em)
}

struct Pen {
    builder: PathBuilder,
    start: f32,
    unit: f32,
}

impl Pen {
    fn at(&self, x: f32, y: f32) -> (f32, f32) {
        (self.start + x * self.unit, -y * self.unit)
    }
}

impl OutlineBuilder for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.at(x, y);
        self.builder.move_to(x, y);
    }
    fn line_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.at(x, y);
        self.builder.line_to(x, y);
    }
    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        let ((x1, y1), (x, y)) = (self.at(x1, y1), self.at(x, y));
        self.builder.quad_to(x1, y1, x, y);
    }
    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        let ((x1, y1), (x2, y2), (x, y)) = (self.at(x1, y1), self.at(x2, y2), self.at(x, y));
        self.builder.cubic_to(x1, y1, x2, y2, x, y);
    }
    fn close(&mut self) {
        self.builder.close();
    }
}

/// A grid of colours as a PNG, one pixel each; `None` if it is empty or its rows differ in length.
pub(crate) fn rgb_png(columns: usize, pixels: &[[u8; 3]]) -> Option<Vec<u8>> {
    pixmap_of(columns, pixels)?.encode_png().ok()
}

fn pixmap_of(columns: usize, pixels: &[[u8; 3]]) -> Option<Pixmap> {
    if columns == 0 || !pixels.len().is_multiple_of(columns) {
        return None;
    }
    let rows = pixels.len() / columns;
    let data = pixels
        .iter()
        .flat_map(|&[red, green, blue]| [red, green, blue, 255])
        .collect();
    Pixmap::from_vec(data, IntSize::from_wh(columns as u32, rows as u32)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample() -> Scene {
        let mut scene = Scene::new("sample", 80.0, 40.0);
        scene.rectangle([10.0, 10.0], [20.0, 20.0], Ink::Rgb([10, 200, 30]), 1.0);
        scene.small([40.0, 20.0], "kPa", Ink::Text, Anchor::Start);
        scene
    }

    #[test]
    fn colours_land_where_they_belong_and_letters_leave_ink() {
        let pixmap = Pixmap::decode_png(&png(&sample(), 2.0).unwrap()).unwrap();
        assert_eq!((pixmap.width(), pixmap.height()), (208, 128));
        let at = |x, y| {
            let pixel = pixmap.pixel(x, y).unwrap();
            [pixel.red(), pixel.green(), pixel.blue()]
        };
        assert_eq!(at(64, 64), [10, 200, 30]);
        assert_eq!(at(4, 4), [255, 255, 255]);
        let dark = (104..184)
            .flat_map(|x| (24..104).map(move |y| (x, y)))
            .filter(|&(x, y)| at(x, y)[0] < 100);
        assert!(dark.count() > 50);
    }

    #[test]
    fn the_same_scene_gives_the_same_bytes() {
        assert_eq!(png(&sample(), 1.5).unwrap(), png(&sample(), 1.5).unwrap());
    }

    #[test]
    fn an_impossible_size_is_refused() {
        assert!(matches!(
            png(&Scene::new("none", 0.0, 5.0), 1.0),
            Err(PlotError::Raster { .. })
        ));
        assert!(matches!(
            png(&Scene::new("none", f64::NAN, 5.0), 1.0),
            Err(PlotError::Raster { .. })
        ));
    }

    #[test]
    fn a_ragged_image_is_left_out() {
        assert!(rgb_png(3, &[[0; 3]; 4]).is_none());
        assert!(rgb_png(0, &[]).is_none());
        assert!(rgb_png(2, &[[0; 3]; 4]).is_some());
    }
}
