//! A sensor as text for people.

use std::fmt::Write;

use glam::DVec3;
use twintac_shape::{Shape, Solid};
use twintac_text::visible;

use crate::Sensor;

/// The mark after inferred values.
const MARK: &str = " *";

impl Sensor {
    /// Whether a field, a part of it or a table around it is inferred and not stated by the source:
    /// `taxels` covers `taxels[2].position_mm`, and `gel.solid.size_mm[2]` marks `gel.solid`.
    #[must_use]
    pub fn is_inferred(&self, field: &str) -> bool {
        self.inferred
            .iter()
            .any(|path| is_within(path, field) || is_within(field, path))
    }

    /// The description as a table for people, with units; inferred values are marked.
    #[must_use]
    pub fn describe(&self) -> String {
        let mut text = String::new();
        // Writing to a string cannot fail.
        let _ = self.write_description(&mut text);
        visible(&text).into_owned()
    }

    fn mark(&self, field: &str) -> &'static str {
        if self.is_inferred(field) { MARK } else { "" }
    }

    fn write_description(&self, out: &mut String) -> std::fmt::Result {
        writeln!(out, "{}: {}", self.name, self.summary)?;
        writeln!(out, "  source      {}", self.source)?;
        self.write_gel(out)?;
        if let Some(shell) = &self.shell {
            let (gap, height) = (self.mark("shell.gap_mm"), self.mark("shell.height_mm"));
            writeln!(
                out,
                "  shell       {} mm{gap} beside the gel, {} mm{height} high",
                shell.gap_mm, shell.height_mm
            )?;
        }
        let readout = &self.readout;
        let mark = self.mark("readout");
        writeln!(
            out,
            "  read-out    {} to {} kPa in steps of {} kPa, {} Hz, reported in {}{mark}",
            readout.min_kpa, readout.max_kpa, readout.resolution_kpa, readout.rate_hz, readout.unit
        )?;
        if self.is_wired() {
            writeln!(out, "  chips       {}", self.chips_in_words())?;
        }
        writeln!(
            out,
            "  taxels      {:<8} {:>7} {:>26} {:>12}",
            "name", "channel", "x, y, z (mm)", "port (mm)"
        )?;
        for (index, taxel) in self.taxels.iter().enumerate() {
            let field = |name: &str| self.mark(&format!("taxels[{index}].{name}"));
            let place = format!("{}{}", triple(taxel.position_mm), field("position_mm"));
            let port = format!("r {}{}", taxel.port_radius_mm, field("port_radius_mm"));
            writeln!(
                out,
                "              {:<8} {:>7} {place:>26} {port:>12}",
                taxel.name,
                taxel
                    .channel
                    .map_or("-".to_owned(), |channel| channel.to_string())
            )?;
        }
        for (index, inclusion) in self.inclusions.iter().enumerate() {
            let title = if index == 0 { "inclusions" } else { "" };
            let mark = self.mark(&format!("inclusions[{index}]"));
            let (min, max) = (triple(inclusion.min_mm), triple(inclusion.max_mm));
            writeln!(
                out,
                "  {title:<11} {:<12} {min} to {max} mm{mark}",
                inclusion.name
            )?;
        }
        for (index, indenter) in self.indenters.iter().enumerate() {
            let title = if index == 0 { "indenters" } else { "" };
            let mark = self.mark(&format!("indenters[{index}].shape"));
            write!(
                out,
                "  {title:<11} {:<12} {}{mark}",
                indenter.name,
                shape_in_words(&indenter.shape)
            )?;
            if let Some(friction) = indenter.friction {
                let mark = self.mark(&format!("indenters[{index}].friction"));
                write!(out, ", friction {friction}{mark}")?;
            }
            writeln!(out)?;
        }
        if !self.inferred.is_empty() {
            writeln!(out, "{MARK} inferred, not stated by the source")?;
        }
        Ok(())
    }

    fn write_gel(&self, out: &mut String) -> std::fmt::Result {
        let (low, high) = self.gel.solid.bounds_mm(&self.surfaces);
        let kind = match &self.gel.solid {
            Solid::Block { edge_radius_mm, .. } if *edge_radius_mm > 0.0 => {
                format!("block, top edges r {edge_radius_mm}")
            }
            Solid::Block { .. } => "block".to_owned(),
            Solid::Dome(_) => "dome".to_owned(),
            Solid::Stl(file) => format!("`{}`", file.name()),
        };
        let mark = self.mark("gel.solid");
        let volume_mm3 = self.gel.solid.volume_mm3(&self.surfaces);
        let (size, low, high) = (size_in_words(high - low), triple(low), triple(high));
        writeln!(
            out,
            "  gel         {kind}, {size} mm{mark}, {volume_mm3:.0} mm³, from {low} to {high}"
        )?;
        let material = &self.gel.material;
        let constants = match material.model.in_words() {
            words if words.is_empty() => words,
            words => format!(" {words},"),
        };
        let mark = self.mark("gel.material");
        writeln!(
            out,
            "  material    {},{constants} E {:.2} kPa, G {:.2} kPa, ν {:.5}, K {:.0} kPa{mark}",
            material.model.name(),
            material.youngs_modulus_kpa(),
            material.shear_modulus_kpa(),
            material.poissons_ratio(),
            material.bulk_modulus_kpa
        )?;
        for term in &material.prony {
            let mark = self.mark("gel.material.prony");
            writeln!(
                out,
                "              {} % relax in {} s{mark}",
                100.0 * term.weight,
                term.time_s
            )?;
        }
        writeln!(out, "              {}", material.source)
    }
}

/// Whether a field is the whole or a part of another.
fn is_within(whole: &str, field: &str) -> bool {
    field
        .strip_prefix(whole)
        .is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
}

fn triple(place_mm: DVec3) -> String {
    // Adding zero makes -0 a plain 0.
    let DVec3 { x, y, z } = place_mm + DVec3::ZERO;
    format!("({x:.2}, {y:.2}, {z:.2})")
}

fn size_in_words(size_mm: DVec3) -> String {
    let round = |length: f64| (length * 1e6).round() / 1e6;
    format!(
        "{} × {} × {}",
        round(size_mm.x),
        round(size_mm.y),
        round(size_mm.z)
    )
}

fn shape_in_words(shape: &Shape) -> String {
    let edges = |radius_mm: f64| {
        if radius_mm > 0.0 {
            format!(", edges r {radius_mm} mm")
        } else {
            String::new()
        }
    };
    match shape {
        Shape::Sphere { radius_mm } => format!("sphere, r {radius_mm} mm"),
        Shape::Cylinder {
            radius_mm,
            height_mm,
            edge_radius_mm,
        } => {
            format!(
                "cylinder, r {radius_mm} mm, {height_mm} mm high{}",
                edges(*edge_radius_mm)
            )
        }
        Shape::Box {
            size_mm,
            edge_radius_mm,
        } => {
            format!(
                "box, {} mm{}",
                size_in_words(DVec3::from(*size_mm)),
                edges(*edge_radius_mm)
            )
        }
        Shape::X {
            length_mm,
            width_mm,
            height_mm,
            edge_radius_mm,
        } => {
            format!(
                "X, bars {length_mm} × {width_mm} mm, {height_mm} mm high{}",
                edges(*edge_radius_mm)
            )
        }
        Shape::Ring {
            outer_radius_mm,
            inner_radius_mm,
            height_mm,
            edge_radius_mm,
        } => {
            format!(
                "ring, r {inner_radius_mm} to {outer_radius_mm} mm, {height_mm} mm high{}",
                edges(*edge_radius_mm)
            )
        }
        Shape::Triangle {
            side_mm,
            height_mm,
            edge_radius_mm,
        } => {
            format!(
                "triangle, side {side_mm} mm, {height_mm} mm high{}",
                edges(*edge_radius_mm)
            )
        }
        Shape::Wedge {
            angle_rad,
            length_mm,
            height_mm,
            edge_radius_mm,
        } => format!(
            "wedge, {angle_rad:.3} rad, ridge {length_mm} mm, {height_mm} mm high{}",
            edges(*edge_radius_mm)
        ),
        Shape::Stl(file) => format!("triangle surface `{}`", file.name()),
        Shape::Union { parts } => {
            let parts: Vec<String> = parts.iter().map(|part| shape_in_words(&part.shape)).collect();
            parts.join(" with ")
        }
    }
}
