//! Checks of a sensor as a whole.

use std::collections::BTreeMap;

use glam::DVec3;
use twintac_config::{ConfigError, Document};
use twintac_shape::{ExtentError, SignedDistance, Solid, Surfaces};

use crate::file::SensorToml;
use crate::{ATMOSPHERE_KPA, Indenter, Sensor, Taxel};

/// Lengths that differ by less count as equal, mm.
const TOLERANCE_MM: f64 = 1e-6;
/// Gel above a port that is less high than this is none, mm.
const COVER_MM: f64 = 1e-3;
/// A surface from a file counts as standing on the board if the height of its lowest point is at
/// most this, mm.
const ON_BOARD_MM: f64 = 1e-3;

/// Largest numbers in a description: lengths, mm; pressures, kPa; forces, N; rates, Hz; friction;
/// counts.
mod most {
    pub(super) const LENGTH_MM: f64 = 1e3;
    pub(super) const PRESSURE_KPA: f64 = 1e6;
    pub(super) const FORCE_N: f64 = 1e6;
    pub(super) const RATE_HZ: f64 = 1e4;
    pub(super) const FRICTION: f64 = 10.0;
    pub(super) const PRESSURE_PA: f64 = 1e9;
}

struct Checker<'a> {
    sensor: &'a Sensor,
    document: &'a Document<SensorToml>,
}

type Checked = Result<(), ConfigError>;

impl Sensor {
    pub(crate) fn check(&self, document: &Document<SensorToml>) -> Checked {
        let checker = Checker {
            sensor: self,
            document,
        };
        checker.names()?;
        checker.gel()?;
        checker.inclusions()?;
        checker.shell()?;
        checker.taxels()?;
        checker.readout()?;
        checker.limits()?;
        checker.indenters()?;
        checker.inferred()
    }

    /// Whether a point is in the gel, on its border, or in an inclusion.
    fn is_within_gel(&self, point_mm: DVec3) -> bool {
        self.gel.solid.contains(point_mm, TOLERANCE_MM, &self.surfaces)
    }
}

impl Checker<'_> {
    fn error(&self, field: &str, problem: impl Into<String>, hint: &str) -> ConfigError {
        self.document.error(field, problem, hint)
    }

    fn above_zero(&self, field: &str, value: f64, most: f64) -> Checked {
        if value > 0.0 && value <= most {
            return Ok(());
        }
        let hint = format!("give a number above 0, {most} at most");
        Err(self.error(field, format!("is {value}"), &hint))
    }

    fn within(&self, field: &str, value: f64, most: f64) -> Checked {
        if value.abs() <= most {
            return Ok(());
        }
        Err(self.error(
            field,
            format!("is {value}"),
            &format!("give a number from -{most} to {most}"),
        ))
    }

    fn names(&self) -> Checked {
        self.name("name", &self.sensor.name)?;
        if self.sensor.summary.trim().is_empty() {
            return Err(self.error("summary", "is empty", "say what this sensor is"));
        }
        let list = |list: &str, names: Vec<&String>| {
            let mut seen: BTreeMap<&String, usize> = BTreeMap::new();
            for (index, name) in names.into_iter().enumerate() {
                let field = format!("{list}[{index}].name");
                self.name(&field, name)?;
                if let Some(first) = seen.insert(name, index) {
                    let problem = format!("is `{name}`, the same as that of {list}[{first}]");
                    return Err(self.error(&field, problem, "give each a name of its own"));
                }
            }
            Ok(())
        };
        list(
            "taxels",
            self.sensor.taxels.iter().map(|taxel| &taxel.name).collect(),
        )?;
        list(
            "inclusions",
            self.sensor
                .inclusions
                .iter()
                .map(|inclusion| &inclusion.name)
                .collect(),
        )?;
        list(
            "indenters",
            self.sensor
                .indenters
                .iter()
                .map(|indenter| &indenter.name)
                .collect(),
        )
    }

    fn name(&self, field: &str, name: &str) -> Checked {
        check_name(self.document, field, name)
    }

    fn gel(&self) -> Checked {
        let gel = &self.sensor.gel;
        gel.solid.validate().map_err(|error| {
            let hint = format!("give {}", error.expected);
            self.error(
                &format!("gel.solid.{}", error.field),
                format!("is {}", error.found),
                &hint,
            )
        })?;
        let Solid::Stl(file) = &gel.solid else {
            return Ok(());
        };
        let surface = &self.sensor.surfaces[&*file.name()];
        let lowest_mm = surface.bounds_mm().0.z;
        if lowest_mm.abs() > ON_BOARD_MM {
            let problem = format!("names a surface whose lowest point is at z = {lowest_mm} mm");
            return Err(self.error(
                "gel.solid.path",
                problem,
                "move it so that it stands on the board at z = 0",
            ));
        }
        if let Some(at_mm) = surface.bodies_meet_at_mm() {
            let problem =
                format!("names a surface of bodies that touch or overlap, for example at {at_mm} mm");
            return Err(self.error("gel.solid.path", problem, "unite them into one body"));
        }
        Ok(())
    }

    fn inclusions(&self) -> Checked {
        for (index, inclusion) in self.sensor.inclusions.iter().enumerate() {
            let field = |name: &str| format!("inclusions[{index}].{name}");
            let (min, max) = (inclusion.min_mm, inclusion.max_mm);
            if min.cmpge(max).any() {
                let problem = format!("is {max}, not above min_mm {min}");
                return Err(self.error(
                    &field("max_mm"),
                    problem,
                    "give larger values for all three coordinates",
                ));
            }
            if min.z.abs() > TOLERANCE_MM {
                let problem = format!("has its lowest point at z = {} mm", min.z);
                return Err(self.error(
                    &field("min_mm"),
                    problem,
                    "put its lowest point on the board, at z = 0",
                ));
            }
            let corners = (0..8).map(|bits| {
                let pick = |axis: usize| {
                    if bits >> axis & 1 == 0 {
                        min[axis]
                    } else {
                        max[axis]
                    }
                };
                DVec3::new(pick(0), pick(1), pick(2))
            });
            for corner in corners {
                if !self.sensor.is_within_gel(corner) {
                    let problem = format!("is a box with a corner at {corner} mm, outside the gel");
                    return Err(self.error(
                        &format!("inclusions[{index}]"),
                        problem,
                        "keep it inside the gel",
                    ));
                }
            }
        }
        Ok(())
    }

    fn shell(&self) -> Checked {
        let Some(shell) = &self.sensor.shell else {
            return Ok(());
        };
        self.above_zero("shell.gap_mm", shell.gap_mm, most::LENGTH_MM)?;
        self.above_zero("shell.height_mm", shell.height_mm, most::LENGTH_MM)
    }

    fn taxels(&self) -> Checked {
        if self.sensor.taxels.is_empty() {
            return Err(self.error("taxels", "is empty", "describe at least one taxel"));
        }
        for (index, taxel) in self.sensor.taxels.iter().enumerate() {
            let field = |name: &str| format!("taxels[{index}].{name}");
            let at = taxel.position_mm;
            if !self.sensor.is_within_gel(at) {
                let (low, high) = self.sensor.gel.solid.bounds_mm(&self.sensor.surfaces);
                let problem = format!("is {at}, outside the gel, which spans {low} to {high}");
                return Err(self.error(&field("position_mm"), problem, "put the taxel into the gel"));
            }
            let buried = self.sensor.inclusions.iter().find(|inclusion| {
                let inside = (at - inclusion.min_mm).min(inclusion.max_mm - at);
                inside.truncate().min_element() > TOLERANCE_MM && at.z < inclusion.max_mm.z - TOLERANCE_MM
            });
            if let Some(inclusion) = buried {
                let problem = format!("is {at}, inside the rigid `{}`", inclusion.name);
                return Err(self.error(&field("position_mm"), problem, "put the taxel onto its face"));
            }
            self.above_zero(&field("port_radius_mm"), taxel.port_radius_mm, most::LENGTH_MM)?;
            self.port(index)?;
        }
        match self.sensor.miswired() {
            Some(wrong) => Err(self.error(&wrong.field, wrong.problem, &wrong.remedy)),
            None => Ok(()),
        }
    }

    /// Checks that gel presses on a port, and on no other port at the same point.
    fn port(&self, index: usize) -> Checked {
        let taxel = &self.sensor.taxels[index];
        let (at, radius_mm) = (taxel.position_mm, taxel.port_radius_mm);
        let field = |name: &str| format!("taxels[{index}].{name}");
        if !self.sensor.is_within_gel(at + DVec3::Z * COVER_MM) {
            let problem = format!("is {at}, on the free surface of the gel, where nothing is above the port");
            return Err(self.error(
                &field("position_mm"),
                problem,
                "put the port under the gel: on the board at z = 0, or on an inclusion",
            ));
        }
        if taxel.rim_mm().all(|at| !self.sensor.is_within_gel(at)) {
            let problem = format!("is {radius_mm}: the whole rim of the port is outside the gel");
            return Err(self.error(
                &field("port_radius_mm"),
                problem,
                "give the radius of the hole that the gel presses on, mm",
            ));
        }
        let mut before = self.sensor.taxels[..index].iter().enumerate();
        let is_on = |other: &Taxel| {
            let between = other.position_mm - at;
            let is_level = between.z.abs() <= TOLERANCE_MM;
            is_level && between.length() < radius_mm + other.port_radius_mm - TOLERANCE_MM
        };
        let Some((other, taxel)) = before.find(|(_, other)| is_on(other)) else {
            return Ok(());
        };
        let apart_mm = taxel.position_mm.distance(at);
        let problem = format!(
            "is {at}, {apart_mm:.2} mm from that of taxels[{other}]: ports with radii of {radius_mm} and {} mm overlap",
            taxel.port_radius_mm
        );
        Err(self.error(
            &field("position_mm"),
            problem,
            "give each port a place of its own",
        ))
    }

    fn readout(&self) -> Checked {
        let readout = &self.sensor.readout;
        self.within("readout.min_kpa", readout.min_kpa, most::PRESSURE_KPA)?;
        self.within("readout.max_kpa", readout.max_kpa, most::PRESSURE_KPA)?;
        if readout.min_kpa >= readout.max_kpa {
            let problem = format!("is {}, not above min_kpa {}", readout.max_kpa, readout.min_kpa);
            return Err(self.error("readout.max_kpa", problem, "give the larger pressure here"));
        }
        let (low, high) = (readout.min_kpa, readout.max_kpa);
        if !(low..=high).contains(&ATMOSPHERE_KPA) {
            let (field, value) = if low > ATMOSPHERE_KPA {
                ("min_kpa", low)
            } else {
                ("max_kpa", high)
            };
            let problem = format!("is {value}, and the pressure of the air is {ATMOSPHERE_KPA} kPa");
            return Err(self.error(
                &format!("readout.{field}"),
                problem,
                "give absolute pressures in kPa, with that of the air between them",
            ));
        }
        self.above_zero(
            "readout.resolution_kpa",
            readout.resolution_kpa,
            most::PRESSURE_KPA,
        )?;
        let is_scaled = readout.counts_per_pa.is_some() || readout.transfer.is_some();
        if is_scaled && !self.sensor.has_unscaled_chips() {
            let field = if readout.transfer.is_some() {
                "readout.transfer"
            } else {
                "readout.counts_per_pa"
            };
            let problem = "is given, but the scale of the chips is known".to_owned();
            return Err(self.error(field, problem, "leave it out"));
        }
        if readout.counts_per_pa == Some(0) {
            let problem = "is 0".to_owned();
            return Err(self.error(
                "readout.counts_per_pa",
                problem,
                "give the counts of a pascal, or leave it out",
            ));
        }
        if let Some(transfer) = &readout.transfer {
            self.above_zero(
                "readout.transfer.pa_per_count",
                transfer.pa_per_count,
                most::PRESSURE_PA,
            )?;
            self.within(
                "readout.transfer.offset_pa",
                transfer.offset_pa,
                most::PRESSURE_PA,
            )?;
            if readout.counts_per_pa.is_some() {
                let problem = "is given beside counts_per_pa".to_owned();
                return Err(self.error("readout.transfer", problem, "give one of the two"));
            }
        }
        self.above_zero("readout.rate_hz", readout.rate_hz, most::RATE_HZ)
    }

    fn limits(&self) -> Checked {
        let Some(limits) = self.sensor.limits else {
            return Ok(());
        };
        self.above_zero("limits.force_n", limits.force_n, most::FORCE_N)?;
        self.above_zero("limits.depth_mm", limits.depth_mm, most::LENGTH_MM)?;
        let (low, high) = self.sensor.gel.solid.bounds_mm(&self.sensor.surfaces);
        let height_mm = high.z - low.z;
        if limits.depth_mm < height_mm {
            return Ok(());
        }
        let problem = format!("is {}, but the gel is {height_mm} mm high", limits.depth_mm);
        Err(self.error(
            "limits.depth_mm",
            problem,
            "give a depth that leaves gel under the indenter",
        ))
    }

    fn indenters(&self) -> Checked {
        for (index, indenter) in self.sensor.indenters.iter().enumerate() {
            let within = format!("indenters[{index}].");
            indenter.check(self.document, &within)?;
            indenter.check_size(self.document, &within, &self.sensor.surfaces)?;
            indenter.check_reach(self.document, &within, self.sensor)?;
        }
        Ok(())
    }

    fn inferred(&self) -> Checked {
        for (index, path) in self.sensor.inferred.iter().enumerate() {
            if !self.document.has(path) {
                let problem = format!("names `{path}`, which this file does not have");
                return Err(self.error(
                    &format!("inferred[{index}]"),
                    problem,
                    "give the path of a field, such as gel.solid.size_mm",
                ));
            }
        }
        Ok(())
    }
}

fn check_name<T>(document: &Document<T>, field: &str, name: &str) -> Checked {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "-_.".contains(c);
    if !name.is_empty() && !name.starts_with('.') && name.chars().all(is_plain) {
        return Ok(());
    }
    let hint = "use letters, digits, `-`, `_` and `.`, so that the name can be used for files";
    Err(document.error(field, format!("is `{name}`"), hint))
}

impl Indenter {
    /// Checks the indenter. `within` is the path of the table with the indenter's fields.
    pub(crate) fn check<T>(&self, document: &Document<T>, within: &str) -> Checked {
        check_name(document, &format!("{within}name"), &self.name)?;
        self.shape.validate().map_err(|error| {
            let field = format!("{within}shape.{}", error.field);
            let hint = format!("give {}", error.expected);
            document.error(&field, format!("is {}", error.found), hint)
        })?;
        let can_be = |friction: &f64| (0.0..=most::FRICTION).contains(friction);
        if let Some(friction) = self.friction.filter(|friction| !can_be(friction)) {
            let field = format!("{within}friction");
            let hint = format!("give zero or more, {} at most", most::FRICTION);
            return Err(document.error(&field, format!("is {friction}"), &hint));
        }
        Ok(())
    }

    /// Checks that the size of the whole indenter is plausible in mm.
    pub(crate) fn check_size<T>(&self, document: &Document<T>, within: &str, surfaces: &Surfaces) -> Checked {
        let (low_mm, high_mm) = self.bounds_mm(surfaces);
        ExtentError::check(low_mm, high_mm)
            .map_err(|error| document.error(&format!("{within}shape"), error.problem(), error.remedy()))
    }

    /// Checks that the indenter can touch the sensor's gel from above. Presses are placed by the
    /// indenter's origin, so it must not be too far beside that origin.
    pub(crate) fn check_reach<T>(&self, document: &Document<T>, within: &str, sensor: &Sensor) -> Checked {
        let (low, high) = self.bounds_mm(&sensor.surfaces);
        let aside_mm = low.max(-high).max(DVec3::ZERO).truncate().length();
        let (gel_low, gel_high) = sensor.gel.solid.bounds_mm(&sensor.surfaces);
        let reach_mm = (gel_high - gel_low).truncate().length();
        if aside_mm <= reach_mm {
            return Ok(());
        }
        let problem = format!(
            "lies {aside_mm:.1} mm beside its origin, farther than the gel is long, {reach_mm:.1} mm: it never touches"
        );
        Err(document.error(
            &format!("{within}shape"),
            problem,
            "move it over its origin, or give its `unit`",
        ))
    }

    fn bounds_mm(&self, surfaces: &Surfaces) -> (DVec3, DVec3) {
        let field = self.shape.signed_distance_field(surfaces);
        field
            .expect("the shape is checked and its surfaces are loaded")
            .bounds_mm()
    }
}
