//! Why a board cannot be made.

use thiserror::Error;

/// Why a board cannot be made from a description, and what to change.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum BoardError {
    /// The chip's land pattern is not in the table.
    #[error("the land pattern of `{name}` is unknown; give one of {known}")]
    UnknownChip {
        /// The chip's name.
        name: String,
        /// The known names.
        known: String,
    },
    /// A taxel is not behind a switch.
    #[error("taxel `{taxel}` has no channel of a switch; give its `channel`, 0 to 7, in the description")]
    NoChannel {
        /// The taxel's name.
        taxel: String,
    },
    /// Two taxels have the same channel of the same switch.
    #[error(
        "taxels `{taxel}` and `{other}` are both on channel {channel} of the switch at {switch:#04x}; give each \
        a channel of its own"
    )]
    SameChannel {
        /// The taxel's name.
        taxel: String,
        /// The other taxel's name.
        other: String,
        /// The channel.
        channel: u8,
        /// The switch's address.
        switch: u8,
    },
    /// A taxel's port is not in the plane z = 0, in which the board's chips end.
    #[error("the port of taxel `{taxel}` is at z = {z_mm} mm; a flat board has all ports at z = 0")]
    PortNotInPlane {
        /// The taxel's name.
        taxel: String,
        /// Its height, mm.
        z_mm: f64,
    },
    /// The courtyards of two chips overlap.
    #[error(
        "the chips of taxels `{taxel}` and `{other}` collide: they are {apart_mm} mm apart and need \
        {need_mm:.2} mm along x or y; give a larger pitch or a smaller chip"
    )]
    ChipsCollide {
        /// The taxel's name.
        taxel: String,
        /// The other taxel's name.
        other: String,
        /// Distance of their centres along x and y, mm.
        apart_mm: String,
        /// The distance that they need along one of the two axes, mm.
        need_mm: f64,
    },
    /// There is no room for a part on the board's bottom face.
    #[error(
        "there is no room for {part} on the bottom face, {size_mm} mm; make the gel's footprint larger or give \
        fewer taxels"
    )]
    NoRoom {
        /// The part.
        part: String,
        /// Size of the board's middle part, mm.
        size_mm: String,
    },
    /// The router found no path for a net.
    #[error(
        "net {net} cannot be routed: no path is left from {from} to {to}{across}; give a larger pitch or a \
        larger footprint of the gel"
    )]
    NoRoute {
        /// The net.
        net: String,
        /// Where the path begins.
        from: String,
        /// Where it should end.
        to: String,
        /// The nets that are in the way.
        across: String,
    },
}
