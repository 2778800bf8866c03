//! The copper of a board file: shapes with nets, their exact distances, and what is connected.

use std::collections::BTreeMap;

use super::expression::Expression;

type Point = [f64; 2];

/// A shape: all points within `radius` of a rectangle or of a line segment.
#[derive(Clone, Debug)]
enum Form {
    Rect { center: Point, half: Point },
    Line { from: Point, to: Point, radius: f64 },
}

/// A piece of copper.
#[derive(Clone, Debug)]
pub(crate) struct Copper {
    pub(crate) net: String,
    /// The name of the pad, such as `U1.3`; empty for tracks and vias.
    pub(crate) pad: String,
    on_top: bool,
    on_bottom: bool,
    form: Form,
}

/// A board file.
pub(crate) struct Written {
    pub(crate) copper: Vec<Copper>,
    /// Borders of the pour with their layer.
    pub(crate) pour: Vec<(bool, Vec<Point>)>,
    pub(crate) outline: Vec<(Point, Point)>,
    pub(crate) vias: Vec<Point>,
}

fn point(of: &Expression) -> Point {
    [of.number(1), of.number(2)]
}

impl Written {
    pub(crate) fn read(text: &str) -> Self {
        let board = Expression::parse(text);
        let names: BTreeMap<String, String> = board
            .all("net")
            .map(|net| (net.word(1).to_owned(), net.word(2).to_owned()))
            .collect();
        let net = |of: &Expression| names[of.first("net").unwrap().word(1)].clone();
        let mut copper = Vec::new();
        for footprint in board.all("footprint") {
            copper.extend(pads(footprint));
        }
        for track in board.all("segment") {
            let is_top = track.first("layer").unwrap().word(1) == "F.Cu";
            copper.push(Copper {
                net: net(track),
                pad: String::new(),
                on_top: is_top,
                on_bottom: !is_top,
                form: Form::Line {
                    from: point(track.first("start").unwrap()),
                    to: point(track.first("end").unwrap()),
                    radius: 0.5 * track.first("width").unwrap().number(1),
                },
            });
        }
        let mut vias = Vec::new();
        for via in board.all("via") {
            let at = point(via.first("at").unwrap());
            vias.push(at);
            copper.push(Copper {
                net: net(via),
                pad: String::new(),
                on_top: true,
                on_bottom: true,
                form: Form::Line {
                    from: at,
                    to: at,
                    radius: 0.5 * via.first("size").unwrap().number(1),
                },
            });
        }
        let mut pour = Vec::new();
        for filled in board.all("zone").flat_map(|zone| zone.all("filled_polygon")) {
            let is_top = filled.first("layer").unwrap().word(1) == "F.Cu";
            pour.push((
                is_top,
                filled.first("pts").unwrap().all("xy").map(point).collect(),
            ));
        }
        let edges = board
            .all("gr_line")
            .filter(|line| line.first("layer").unwrap().word(1) == "Edge.Cuts");
        Self {
            copper,
            pour,
            outline: edges
                .map(|line| {
                    (
                        point(line.first("start").unwrap()),
                        point(line.first("end").unwrap()),
                    )
                })
                .collect(),
            vias,
        }
    }

    /// Nets whose pads are not all connected by tracks and vias (without the pour), and nets that
    /// touch each other.
    pub(crate) fn open_and_shorted(&self) -> Vec<String> {
        let mut piece: Vec<usize> = (0..self.copper.len()).collect();
        fn root(piece: &[usize], mut of: usize) -> usize {
            while piece[of] != of {
                of = piece[of];
            }
            of
        }
        let mut found = Vec::new();
        for one in 0..self.copper.len() {
            for two in 0..one {
                let (this, that) = (&self.copper[one], &self.copper[two]);
                if this.shares_layer(that) && distance(&this.form, &that.form) <= 0.0 {
                    if this.net != that.net {
                        found.push(format!("{} touches {}", this.net, that.net));
                    }
                    let (this, that) = (root(&piece, one), root(&piece, two));
                    piece[this.max(that)] = this.min(that);
                }
            }
        }
        let mut first: BTreeMap<&str, usize> = BTreeMap::new();
        for (index, copper) in self
            .copper
            .iter()
            .enumerate()
            .filter(|(_, copper)| !copper.pad.is_empty())
        {
            let own = root(&piece, index);
            let other = *first.entry(&copper.net).or_insert(own);
            if own != other {
                found.push(format!("{} of {} hangs loose", copper.pad, copper.net));
            }
        }
        found
    }

    /// Pairs of copper of different nets that are closer than `least` mm: tracks, vias, pads, pour.
    pub(crate) fn too_close(&self, least: f64) -> Vec<String> {
        let mut found = Vec::new();
        for (index, one) in self.copper.iter().enumerate() {
            for two in &self.copper[..index] {
                if one.net != two.net && one.shares_layer(two) {
                    let apart = distance(&one.form, &two.form);
                    if apart < least - 1e-6 {
                        found.push(format!("{one:?} and {two:?}: {apart}"));
                    }
                }
            }
            for (is_top, border) in self.pour.iter().filter(|_| one.net != "GND") {
                let is_beside = if *is_top { one.on_top } else { one.on_bottom };
                if is_beside {
                    let apart = to_border(&one.form, border);
                    if apart < least - 1e-6 {
                        found.push(format!("{one:?} and the pour: {apart}"));
                    }
                }
            }
        }
        found
    }

    /// Copper whose distance to the board's edge is less than `least`, mm.
    pub(crate) fn near_edge(&self, least: f64) -> Vec<String> {
        let mut found = Vec::new();
        for (from, to) in &self.outline {
            let edge = Form::Line {
                from: *from,
                to: *to,
                radius: 0.0,
            };
            let close = self
                .copper
                .iter()
                .filter(|copper| distance(&copper.form, &edge) < least - 1e-6);
            found.extend(close.map(|copper| format!("{copper:?}")));
            for (_, border) in &self.pour {
                if to_border(&edge, border) < least - 1e-6 {
                    found.push("the pour".to_owned());
                }
            }
        }
        found
    }

    /// The smallest distance between the centres of two vias, mm.
    pub(crate) fn nearest_vias(&self) -> f64 {
        let pairs = self.vias.iter().enumerate().flat_map(|(index, one)| {
            self.vias[..index]
                .iter()
                .map(move |two| (one[0] - two[0]).hypot(one[1] - two[1]))
        });
        pairs.fold(f64::INFINITY, f64::min)
    }

    /// Nets of the pads, by pad.
    pub(crate) fn nets(&self) -> BTreeMap<&str, &str> {
        let pads = self.copper.iter().filter(|copper| !copper.pad.is_empty());
        pads.map(|copper| (copper.pad.as_str(), copper.net.as_str()))
            .collect()
    }
}

impl Copper {
    fn shares_layer(&self, other: &Self) -> bool {
        self.on_top && other.on_top || self.on_bottom && other.on_bottom
    }
}

fn pads(footprint: &Expression) -> Vec<Copper> {
    let at = footprint.first("at").unwrap();
    let angle = at.number(3).to_radians();
    let is_reference = |property: &&Expression| property.word(1) == "Reference";
    let reference = footprint.all("property").find(is_reference).unwrap().word(2);
    let mut found = Vec::new();
    for pad in footprint.all("pad").filter(|pad| pad.word(2) == "smd") {
        let [x, y] = point(pad.first("at").unwrap());
        let center = [
            at.number(1) + x * angle.cos() + y * angle.sin(),
            at.number(2) - x * angle.sin() + y * angle.cos(),
        ];
        let size = pad.first("size").unwrap();
        let mut half = [0.5 * size.number(1), 0.5 * size.number(2)];
        if (pad.first("at").unwrap().number(3) / 90.0).round() as i64 % 2 == 1 {
            half.swap(0, 1);
        }
        let is_top = pad.first("layers").unwrap().word(1) == "F.Cu";
        found.push(Copper {
            net: pad.first("net").unwrap().word(2).to_owned(),
            pad: format!("{reference}.{}", pad.word(1)),
            on_top: is_top,
            on_bottom: !is_top,
            form: if pad.word(3) == "circle" {
                Form::Line {
                    from: center,
                    to: center,
                    radius: half[0],
                }
            } else {
                Form::Rect { center, half }
            },
        });
    }
    found
}

fn to_line(at: Point, from: Point, to: Point) -> f64 {
    let along = [to[0] - from[0], to[1] - from[1]];
    let squared = along[0] * along[0] + along[1] * along[1];
    let dot = (at[0] - from[0]) * along[0] + (at[1] - from[1]) * along[1];
    let part = if squared > 0.0 {
        (dot / squared).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (at[0] - from[0] - part * along[0]).hypot(at[1] - from[1] - part * along[1])
}

fn line_to_line(one: (Point, Point), two: (Point, Point)) -> f64 {
    let side = |(from, to): (Point, Point), at: Point| {
        (to[0] - from[0]) * (at[1] - from[1]) - (to[1] - from[1]) * (at[0] - from[0])
    };
    let splits = |line, other: (Point, Point)| side(line, other.0) * side(line, other.1) < 0.0;
    if splits(one, two) && splits(two, one) {
        return 0.0;
    }
    [
        to_line(one.0, two.0, two.1),
        to_line(one.1, two.0, two.1),
        to_line(two.0, one.0, one.1),
        to_line(two.1, one.0, one.1),
    ]
    .into_iter()
    .fold(f64::INFINITY, f64::min)
}

fn sides(center: Point, half: Point) -> [(Point, Point); 4] {
    let corner = |x: f64, y: f64| [center[0] + x * half[0], center[1] + y * half[1]];
    let corners = [
        corner(-1.0, -1.0),
        corner(1.0, -1.0),
        corner(1.0, 1.0),
        corner(-1.0, 1.0),
    ];
    [0, 1, 2, 3].map(|side| (corners[side], corners[(side + 1) % 4]))
}

/// Distance of two shapes; 0 or less if they touch.
fn distance(one: &Form, two: &Form) -> f64 {
    match (one, two) {
        (
            Form::Line { from, to, radius },
            Form::Line {
                from: other,
                to: end,
                radius: width,
            },
        ) => line_to_line((*from, *to), (*other, *end)) - radius - width,
        (Form::Rect { center, half }, Form::Line { from, to, radius }) => {
            let is_inside = |at: &Point| (0..2).all(|axis| (at[axis] - center[axis]).abs() <= half[axis]);
            if is_inside(from) || is_inside(to) {
                return -radius;
            }
            let all = sides(*center, *half).map(|side| line_to_line(side, (*from, *to)));
            all.into_iter().fold(f64::INFINITY, f64::min) - radius
        }
        (Form::Line { .. }, Form::Rect { .. }) => distance(two, one),
        (
            Form::Rect { center, half },
            Form::Rect {
                center: other,
                half: size,
            },
        ) => {
            let gap = [0, 1].map(|axis| (center[axis] - other[axis]).abs() - half[axis] - size[axis]);
            if gap[0] <= 0.0 && gap[1] <= 0.0 {
                gap[0].max(gap[1])
            } else {
                gap[0].max(0.0).hypot(gap[1].max(0.0))
            }
        }
    }
}

/// A box around all points within 1 mm of a shape.
fn reach(form: &Form) -> (Point, Point) {
    let around = |one: Point, two: Point, by: Point| {
        (
            [0, 1].map(|axis| one[axis].min(two[axis]) - by[axis] - 1.0),
            [0, 1].map(|axis| one[axis].max(two[axis]) + by[axis] + 1.0),
        )
    };
    match form {
        Form::Rect { center, half } => around(*center, *center, *half),
        Form::Line { from, to, radius } => around(*from, *to, [*radius; 2]),
    }
}

/// Distance of a shape to a filled polygon, if it is less than 1 mm; negative inside.
fn to_border(form: &Form, border: &[Point]) -> f64 {
    let edges = || border.iter().zip(border.iter().cycle().skip(1));
    let (low, high) = reach(form);
    let is_near = |(from, to): &(&Point, &Point)| {
        (0..2).all(|axis| from[axis].min(to[axis]) < high[axis] && from[axis].max(to[axis]) > low[axis])
    };
    let nearest = edges()
        .filter(is_near)
        .map(|(from, to)| {
            let edge = Form::Line {
                from: *from,
                to: *to,
                radius: 0.0,
            };
            distance(form, &edge)
        })
        .fold(f64::INFINITY, f64::min);
    let at = match form {
        Form::Rect { center, .. } => *center,
        Form::Line { from, .. } => *from,
    };
    let crossed = edges().filter(|(from, to)| {
        (from[1] > at[1]) != (to[1] > at[1])
            && at[0] < from[0] + (at[1] - from[1]) / (to[1] - from[1]) * (to[0] - from[0])
    });
    if crossed.count() % 2 == 1 {
        -nearest.abs()
    } else {
        nearest
    }
}
