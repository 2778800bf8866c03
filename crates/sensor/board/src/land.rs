//! Land patterns: pads, outline and courtyard of a part, as seen in KiCad's libraries: x to the
//! right, y **down**.

use glam::{DVec2, Vec2Swizzles as _};

use crate::shapes::{Area, Shape};

/// A pad to which a part is soldered.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Pad {
    /// Its number in symbol and footprint.
    pub(crate) number: &'static str,
    pub(crate) at: DVec2,
    pub(crate) size: DVec2,
    /// Whether it is a disc of diameter `size.x`.
    pub(crate) is_round: bool,
    /// Whether it gets solder paste.
    pub(crate) has_paste: bool,
}

impl Pad {
    pub(crate) fn new(number: &'static str, at: [f64; 2], size: [f64; 2]) -> Self {
        Self {
            number,
            at: at.into(),
            size: size.into(),
            is_round: false,
            has_paste: true,
        }
    }
}

/// A land pattern.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Land {
    /// Its name in the project's library.
    pub(crate) name: &'static str,
    /// A description, with the source of its dimensions.
    pub(crate) description: &'static str,
    pub(crate) pads: Vec<Pad>,
    /// The courtyard: no other part may enter it.
    pub(crate) courtyard: Area,
    /// The part's body, and its height.
    pub(crate) body: Area,
    pub(crate) height_mm: f64,
    /// Lines of the silk screen.
    pub(crate) silk: Vec<[[f64; 2]; 2]>,
    /// Copper that connects two pads until it is cut: the numbers of the pads, and the copper.
    pub(crate) bridge: Option<([&'static str; 2], Area)>,
    /// Whether a machine places a part here. Not so for jumpers and test pads.
    pub(crate) is_placed: bool,
}

/// The face that a part is on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Side {
    Top,
    Bottom,
}

/// The position of a part in the sensor's frame: x to the right and y **up**, seen from above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Placement {
    pub(crate) at: DVec2,
    /// Number of quarter turns, counter-clockwise on KiCad's screen.
    pub(crate) quarters: u8,
    pub(crate) side: Side,
}

impl Placement {
    /// A point of the land pattern in the footprint's own frame in a board file. Parts on the
    /// bottom are turned over.
    pub(crate) fn local(&self, point: DVec2) -> DVec2 {
        match self.side {
            Side::Top => point,
            Side::Bottom => DVec2::new(point.x, -point.y),
        }
    }

    /// A point of the land pattern on the board.
    pub(crate) fn on_board(&self, point: DVec2) -> DVec2 {
        let local = self.local(point);
        let turned = match self.quarters % 4 {
            0 => local,
            1 => DVec2::new(local.y, -local.x),
            2 => -local,
            _ => DVec2::new(-local.y, local.x),
        };
        self.at + DVec2::new(turned.x, -turned.y)
    }

    /// A box of the land pattern on the board.
    pub(crate) fn area(&self, area: &Area) -> Area {
        let (one, two) = (self.on_board(area.min), self.on_board(area.max));
        Area {
            min: one.min(two),
            max: one.max(two),
        }
    }

    /// A pad's copper on the board.
    pub(crate) fn pad(&self, pad: &Pad) -> Shape {
        let center = self.on_board(pad.at);
        if pad.is_round {
            return Shape::disc(center, 0.5 * pad.size.x);
        }
        let half = if self.quarters.is_multiple_of(2) {
            0.5 * pad.size
        } else {
            0.5 * pad.size.yx()
        };
        Shape::Rect { center, half }
    }
}
