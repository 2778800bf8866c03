//! Fabrication rules of the board: every maker of two-layer boards can produce it at the standard
//! price.
//!
//! The limits are looser than the trade's usual ones (tracks and gaps of 0.15 mm, drills of 0.2
//! mm).

/// Thickness of the board, mm.
pub const THICKNESS_MM: f64 = 1.6;
/// Smallest distance between copper of different nets, mm.
pub const CLEARANCE_MM: f64 = 0.2;
/// Width of signal tracks, mm.
pub const SIGNAL_WIDTH_MM: f64 = 0.2;
/// Width of tracks of the supply and of ground, mm.
pub(crate) const POWER_WIDTH_MM: f64 = 0.3;
/// Diameter of a via's copper, mm.
pub const VIA_MM: f64 = 0.6;
/// Diameter of a via's drill, mm.
pub const VIA_DRILL_MM: f64 = 0.3;
/// Smallest distance from copper to the board's edge, mm.
pub const EDGE_CLEARANCE_MM: f64 = 0.3;
/// Smallest width of the ground pour, mm.
pub(crate) const POUR_WIDTH_MM: f64 = 0.2;

/// Smallest distance of a via to any pad, mm, so that solder mask remains between and no solder
/// flows into the via.
pub(crate) const VIA_TO_PAD_MM: f64 = 0.12;
/// Smallest distance between the centres of vias, mm: half a millimetre between the edges of the
/// drills is easy to drill.
pub(crate) const VIA_TO_VIA_MM: f64 = 0.8;
/// Margin added to clearances in planning, mm. It keeps distances between grid points too, and when
/// numbers are rounded.
pub(crate) const MARGIN_MM: f64 = 0.012;

/// Drill of a hole for an M2 screw (ISO 273, medium), mm. The 0.2 mm for the maker's tolerance are
/// left out on purpose.
pub(crate) const SCREW_DRILL_MM: f64 = 2.2;
/// Radius around a screw that parts, tracks and pour keep free, mm: a pan head is 4 mm wide (ISO
/// 7045).
pub(crate) const SCREW_FREE_MM: f64 = 2.3;
