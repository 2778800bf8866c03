//! The project file and the tables of libraries.

use super::text::{LIBRARY, quoted};
use crate::rules::{CLEARANCE_MM, EDGE_CLEARANCE_MM, SIGNAL_WIDTH_MM, VIA_DRILL_MM, VIA_MM};

/// The project file, with the limits for design rule checks.
pub(super) fn project(name: &str) -> String {
    let ring = 0.5 * (VIA_MM - VIA_DRILL_MM);
    format!(
        r#"{{
  "board": {{
    "design_settings": {{
      "rules": {{
        "min_clearance": {CLEARANCE_MM},
        "min_copper_edge_clearance": {EDGE_CLEARANCE_MM},
        "min_hole_clearance": 0.25,
        "min_hole_to_hole": 0.5,
        "min_through_hole_diameter": {VIA_DRILL_MM},
        "min_track_width": {SIGNAL_WIDTH_MM},
        "min_via_annular_width": {ring},
        "min_via_diameter": {VIA_MM},
        "solder_mask_to_copper_clearance": 0.0
      }}
    }}
  }},
  "meta": {{
    "filename": {},
    "version": 3
  }},
  "net_settings": {{
    "classes": [
      {{
        "clearance": {CLEARANCE_MM},
        "name": "Default",
        "track_width": {SIGNAL_WIDTH_MM},
        "via_diameter": {VIA_MM},
        "via_drill": {VIA_DRILL_MM}
      }}
    ],
    "meta": {{
      "version": 4
    }}
  }}
}}
"#,
        quoted(&format!("{name}.kicad_pro"))
    )
}

/// A table with one library.
pub(super) fn table(kind: &str, file: &str) -> String {
    format!(
        "({kind}\n  (version 7)\n  (lib (name \"{LIBRARY}\")(type \"KiCad\")(uri \
        \"${{KIPRJMOD}}/{file}\")(options \"\")(descr \"\"))\n)\n"
    )
}
