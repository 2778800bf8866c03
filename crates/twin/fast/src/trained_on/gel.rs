//! The gel that a surrogate was trained on.

use glam::DVec2;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use twintac_material::Model;
use twintac_sensor::{Sensor, Shell};
use twintac_shape::{Solid, Surfaces, TriangleSurface};

use super::mismatch::Difference;
use super::same::same;

/// Tolerance for rounding, mm.
const ROUNDING_MM: f64 = 1e-6;

/// Everything that presses of a gel depend on. Names do not count. Properties that a surrogate does
/// not have do not count either: relaxation (the surrogate gives the instantaneous response), and
/// the friction of indenters (it was trained without).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct TrainedOn {
    solid: SolidTrainedOn,
    material: Model,
    bulk_modulus_kpa: f64,
    shell: Option<Shell>,
    /// Corners of the boxes that are cast into the gel, smallest and largest coordinates, mm.
    inclusions_mm: Vec<[glam::DVec3; 2]>,
}

/// Shape of a gel; a surface of triangles by its content.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
enum SolidTrainedOn {
    Described(Solid),
    Surface {
        /// Digest of the vertices and triangles.
        sha256: String,
        n_triangles: usize,
        low_mm: glam::DVec3,
        high_mm: glam::DVec3,
    },
}

impl TrainedOn {
    /// The gel of a sensor.
    pub(crate) fn of(sensor: &Sensor) -> Self {
        let (gel, material) = (&sensor.gel, &sensor.gel.material);
        let inclusions = sensor.inclusions.iter();
        Self {
            solid: SolidTrainedOn::of(sensor),
            material: material.model.clone(),
            bulk_modulus_kpa: gel.material.bulk_modulus_kpa,
            shell: sensor.shell.clone(),
            inclusions_mm: inclusions.map(|chip| [chip.min_mm, chip.max_mm]).collect(),
        }
    }

    /// Whether a disc on the base is within the gel. A gel that is a surface of triangles is known
    /// by its bounds alone.
    pub(crate) fn has_base_under(&self, center_mm: DVec2, radius_mm: f64) -> bool {
        let ways = [DVec2::X, DVec2::Y, DVec2::NEG_X, DVec2::NEG_Y];
        let mut rim_mm = ways.iter().map(|way| center_mm + radius_mm * *way);
        match &self.solid {
            SolidTrainedOn::Described(solid) => {
                let none = Surfaces::new();
                let base_mm = solid.bounds_mm(&none).0.z;
                rim_mm.all(|at| solid.contains(at.extend(base_mm), ROUNDING_MM, &none))
            }
            SolidTrainedOn::Surface { low_mm, high_mm, .. } => {
                let (low_mm, high_mm) = (low_mm.truncate() - ROUNDING_MM, high_mm.truncate() + ROUNDING_MM);
                rim_mm.all(|at| at.cmpge(low_mm).all() && at.cmple(high_mm).all())
            }
        }
    }

    /// Whether boxes are cast into the gel.
    pub(crate) fn has_inclusions(&self) -> bool {
        !self.inclusions_mm.is_empty()
    }

    /// The differences between a sensor's gel and this one.
    pub(crate) fn differences(&self, sensors: &Self) -> Vec<Difference> {
        let differs = |what: &str, is_same: bool, describe: &dyn Fn(&Self) -> String| {
            (!is_same).then(|| Difference {
                what: what.to_owned(),
                fast: describe(self),
                sensor: describe(sensors),
            })
        };
        let is_one_material = same(&self.material, &sensors.material)
            && same(&self.bulk_modulus_kpa, &sensors.bulk_modulus_kpa);
        let found = [
            differs("gel", same(&self.solid, &sensors.solid), &|gel| gel.solid.text()),
            differs("material", is_one_material, &Self::material_text),
            differs("shell", same(&self.shell, &sensors.shell), &Self::shell_text),
            differs(
                "boxes in the gel",
                same(&self.inclusions_mm, &sensors.inclusions_mm),
                &Self::inclusions_text,
            ),
        ];
        found.into_iter().flatten().collect()
    }

    fn material_text(&self) -> String {
        let (bulk, shear) = (self.bulk_modulus_kpa, self.material.shear_modulus_kpa());
        let youngs_kpa = 9.0 * bulk * shear / (3.0 * bulk + shear);
        let constants = serde_json::to_value(&self.material).expect("constants are numbers");
        let constants = constants.as_object().expect("a model has named constants");
        let constants = constants.iter().filter(|(name, _)| *name != "model");
        let constants: Vec<String> = constants
            .map(|(name, value)| format!("{name} = {value}"))
            .collect();
        format!(
            "{} of {youngs_kpa:.1} kPa ({}, bulk_modulus_kpa = {bulk})",
            self.material.name(),
            constants.join(", ")
        )
    }

    fn shell_text(&self) -> String {
        match &self.shell {
            None => "none".to_owned(),
            Some(Shell { gap_mm, height_mm }) => format!("{height_mm} mm high and {gap_mm} mm away"),
        }
    }

    fn inclusions_text(&self) -> String {
        let corners = self.inclusions_mm.iter();
        let corners: Vec<String> = corners
            .map(|[low, high]| format!("from {low} to {high} mm"))
            .collect();
        match corners.is_empty() {
            true => "none".to_owned(),
            false => corners.join(", "),
        }
    }
}

impl SolidTrainedOn {
    fn of(sensor: &Sensor) -> Self {
        let solid = &sensor.gel.solid;
        match solid {
            Solid::Block { .. } | Solid::Dome(_) => Self::Described(solid.clone()),
            Solid::Stl(file) => {
                let surface = sensor
                    .surfaces
                    .get(&*file.name())
                    .expect("a checked sensor has its surfaces");
                let (low_mm, high_mm) = solid.bounds_mm(&sensor.surfaces);
                Self::Surface {
                    sha256: digest(surface),
                    n_triangles: surface.triangles().len(),
                    low_mm,
                    high_mm,
                }
            }
        }
    }

    fn text(&self) -> String {
        match self {
            Self::Described(Solid::Block {
                size_mm: [x, y, z],
                center_mm: [x_mm, y_mm],
                edge_radius_mm,
            }) => {
                let mut text = format!("{x} x {y} mm and {z} mm high");
                if [*x_mm, *y_mm] != [0.0; 2] {
                    text += &format!(" about [{x_mm}, {y_mm}] mm");
                }
                if *edge_radius_mm > 0.0 {
                    text += &format!(" with edges rounded by {edge_radius_mm} mm");
                }
                text
            }
            Self::Described(Solid::Dome(dome)) => format!(
                "a dome of {:?} x {:?} mm, {} mm high at {:?} mm, that falls by {:?} and {:?} mm",
                dome.x_mm, dome.y_mm, dome.crown_mm, dome.crown_at_mm, dome.drop_x_mm, dome.drop_y_mm
            ),
            Self::Described(Solid::Stl(file)) => format!("the surface {}", file.path),
            Self::Surface {
                sha256,
                n_triangles,
                low_mm,
                high_mm,
            } => {
                let [x, y, z] = (*high_mm - *low_mm).to_array();
                let short = sha256.get(..8).unwrap_or(sha256);
                format!("a surface of {n_triangles} triangles, {x} x {y} mm and {z} mm high ({short}…)")
            }
        }
    }
}

/// SHA-256 of a surface's vertices and triangles.
fn digest(surface: &TriangleSurface) -> String {
    let mut digest = Sha256::new();
    for mm in surface.vertices_mm().iter().flat_map(|at| at.to_array()) {
        digest.update(mm.to_le_bytes());
    }
    for vertex in surface.triangles().as_flattened() {
        digest.update(vertex.to_le_bytes());
    }
    let bytes = digest.finalize();
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::DVec3;
    use twintac_sensor::SensorFile;
    use twintac_shape::SurfaceFile;

    use super::*;

    /// PhysTac with a gel of four triangles in the file `gel.stl`.
    fn of_a_surface(height_mm: f64) -> TrainedOn {
        let [a, b, c] = [[0.0, 0.0], [20.0, 0.0], [0.0, 20.0]].map(|[x, y]| DVec3::new(x, y, 0.0));
        let top = DVec3::new(5.0, 5.0, height_mm);
        let triangles = [[a, c, b], [a, b, top], [b, c, top], [c, a, top]];
        let surface = TriangleSurface::from_triangles(&triangles).unwrap();
        let mut sensor = (*SensorFile::phystac().unwrap().sensor).clone();
        sensor.surfaces.insert("gel.stl".to_owned(), Arc::new(surface));
        sensor.gel.solid = Solid::Stl(SurfaceFile::new("gel.stl"));
        TrainedOn::of(&sensor)
    }

    #[test]
    fn a_surface_counts_by_its_content() {
        assert!(of_a_surface(8.0).differences(&of_a_surface(8.0)).is_empty());
        let [difference] = &of_a_surface(8.0).differences(&of_a_surface(7.0))[..] else {
            panic!("one difference");
        };
        let text = difference.to_string();
        assert!(text.contains("8 mm high") && text.contains("7 mm high"), "{text}");
    }
}
