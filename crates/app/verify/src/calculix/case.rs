//! The presses that are compared, and the reference mesh of each.

use std::sync::Arc;

use anyhow::{Result, bail};
use glam::{DVec2, DVec3};
use twintac_protocol::PressPath;
use twintac_sensor::Sensor;
use twintac_shape::Shape;

use super::bricks::Bricks;
use super::plan::{Fine, Plan, divide};

/// Size of the gel, mm.
pub(super) const SIZE_MM: DVec3 = DVec3::new(34.0, 18.0, 8.5);

/// Young's modulus, kPa.
const YOUNGS_MODULUS_KPA: f64 = 70.0;

/// The y coordinate of a line of points on the board, through the row of taxels at y = 4 mm.
pub(super) const LINE_Y_MM: f64 = 4.0;

/// One press.
pub(super) struct Case {
    /// Its name in one word.
    pub(super) name: String,
    /// The indenter.
    pub(super) shape: Shape,
    /// The location, mm.
    pub(super) place_mm: DVec2,
    /// The depths, mm.
    pub(super) depths_mm: Vec<f64>,
    /// Poisson's ratio.
    pub(super) poissons_ratio: f64,
}

/// Fineness of the reference mesh.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Level {
    /// Used to estimate the error of the fine one.
    Coarse,
    /// The reference.
    Fine,
}

/// All presses: each indenter with both of Poisson's ratios.
pub(super) fn all() -> Vec<Case> {
    let mut cases = Vec::new();
    for poissons_ratio in [0.49, 0.4999] {
        let mut add = |name: &str, shape: Shape, place_mm: [f64; 2], depths_mm: &[f64]| {
            cases.push(Case {
                name: format!("{name}-{}", poissons_ratio.to_string().replace("0.", "nu")),
                shape,
                place_mm: DVec2::from_array(place_mm),
                depths_mm: depths_mm.to_vec(),
                poissons_ratio,
            });
        };
        add(
            "sphere",
            Shape::Sphere { radius_mm: 12.5 },
            [0.0, 0.0],
            &[0.5, 1.0, 2.0, 4.0],
        );
        let cylinder = Shape::Cylinder {
            radius_mm: 5.0,
            height_mm: 10.0,
            edge_radius_mm: 0.8,
        };
        add("cylinder", cylinder, [3.0, 2.0], &[0.5, 1.0, 2.0]);
        let bar = Shape::Box {
            size_mm: [3.0, 10.0, 10.0],
            edge_radius_mm: 0.5,
        };
        add("bar", bar, [-5.0, 1.0], &[0.5, 1.0, 2.0]);
    }
    cases
}

impl Case {
    /// Shear modulus, kPa.
    pub(super) fn shear_modulus_kpa(&self) -> f64 {
        YOUNGS_MODULUS_KPA / (2.0 * (1.0 + self.poissons_ratio))
    }

    /// Bulk modulus, kPa.
    pub(super) fn bulk_modulus_kpa(&self) -> f64 {
        YOUNGS_MODULUS_KPA / (3.0 * (1.0 - 2.0 * self.poissons_ratio))
    }

    /// Whether the reference models a quarter of the gel.
    pub(super) fn is_quarter(&self) -> bool {
        matches!(self.shape, Shape::Sphere { .. }) && self.place_mm == DVec2::ZERO
    }

    /// The reference mesh.
    pub(super) fn bricks(&self, level: Level) -> Result<Bricks> {
        let half_mm = 0.5 * SIZE_MM.truncate();
        let scale = if level == Level::Fine { 1.0 } else { 1.5 };
        let edge_mm = 1.6 * scale;
        let stretch = |from_mm: f64, to_mm: f64, edge_mm: f64| Fine {
            from_mm,
            to_mm,
            edge_mm: edge_mm * scale,
        };
        let (plan, level_edges_mm) = match self.shape {
            Shape::Sphere { .. } if self.is_quarter() => {
                // Pressures are compared 1 mm from the bonded edge at the end of the block, where
                // the stress is singular.
                let (contact, end) = (stretch(0.0, 7.5, 0.75), stretch(half_mm.x - 1.5, half_mm.x, 0.4));
                let x_mm = divide([0.0, half_mm.x], edge_mm, &[contact, end]);
                let y_mm = divide([0.0, half_mm.y], edge_mm, &[contact]);
                (Plan::tensor(&x_mm, &y_mm), [0.4, 0.5])
            }
            Shape::Cylinder {
                radius_mm,
                edge_radius_mm,
                ..
            } => {
                let flat_mm = radius_mm - edge_radius_mm;
                let rim = stretch(flat_mm, radius_mm + 0.2, 0.5 * edge_radius_mm);
                let radii_mm = divide([0.8 * flat_mm, radius_mm + 1.5], edge_mm, &[rim]);
                let bounds_mm = [-half_mm, half_mm];
                let outwards = divide([0.0, 1.0], 0.25 * scale, &[stretch(0.0, 0.0, 0.15)]);
                let n_side = (9.0 / scale).round() as usize;
                let plan = Plan::rings(self.place_mm, n_side, &radii_mm, &outwards[1..], bounds_mm);
                (plan, [edge_mm, 0.5])
            }
            Shape::Box {
                size_mm,
                edge_radius_mm,
            } => {
                let lines = |axis: usize| {
                    let (at_mm, half_width_mm) = (self.place_mm[axis], 0.5 * size_mm[axis]);
                    let flat_mm = half_width_mm - edge_radius_mm;
                    let edge_rim_mm = 0.8 * edge_radius_mm;
                    let rims = [
                        stretch(at_mm - half_width_mm - 0.2, at_mm - flat_mm, edge_rim_mm),
                        stretch(at_mm + flat_mm, at_mm + half_width_mm + 0.2, edge_rim_mm),
                    ];
                    divide([-half_mm[axis], half_mm[axis]], edge_mm, &rims)
                };
                (Plan::tensor(&lines(0), &lines(1)), [edge_mm, 0.5])
            }
            _ => bail!("{}: there is no reference mesh for this indenter", self.name),
        };
        let [board_edge_mm, top_edge_mm] = level_edges_mm;
        let levels_mm = divide(
            [0.0, SIZE_MM.z],
            edge_mm,
            &[
                stretch(0.0, 0.0, board_edge_mm),
                stretch(SIZE_MM.z, SIZE_MM.z, top_edge_mm),
            ],
        );
        Ok(Bricks::extrude(&plan, &levels_mm))
    }

    /// The gel as a sensor, described as users describe theirs.
    pub(super) fn sensor(&self) -> Result<Arc<Sensor>> {
        let mut text = format!(
            r#"
name = "block"
summary = "a bonded block above eight taxels"
source = "chosen"
inferred = []

[gel.solid]
kind = "block"
size_mm = [{:?}, {:?}, {:?}]

[gel.material]
youngs_modulus_kpa = {YOUNGS_MODULUS_KPA:?}
poissons_ratio = {}
source = "chosen"

[readout]
min_kpa = 0.0
max_kpa = 1500.0
resolution_kpa = 0.01
rate_hz = 55.0
"#,
            SIZE_MM.x, SIZE_MM.y, SIZE_MM.z, self.poissons_ratio
        );
        for (channel, (name, at_mm)) in taxels_mm().into_iter().enumerate() {
            text += &format!(
                "\n[[taxels]]\nname = \"{name}\"\nposition_mm = [{:?}, {:?}, 0.0]\nport_radius_mm = {PORT_RADIUS_MM:?}\nchannel = {channel}\n",
                at_mm.x, at_mm.y
            );
        }
        let shape = serde_json::to_value(&self.shape)?;
        let fields = shape.as_object().into_iter().flatten();
        let fields: Vec<String> = fields
            .map(|(field, value)| format!("{field} = {value}"))
            .collect();
        text += &format!(
            "\n[[indenters]]\nname = \"indenter\"\nshape = {{ {} }}\n",
            fields.join(", ")
        );
        Ok(Arc::new(Sensor::parse("block", &text, &no_files)?))
    }

    /// The press as a path, with points on the board at which the pressure is read.
    pub(super) fn path(&self) -> Result<PressPath> {
        let mut text = "summary = \"straight down\"\nindenter = \"indenter\"\nzero = \"touch\"\n".to_owned();
        for (time_s, depth_mm) in std::iter::once(&0.0).chain(&self.depths_mm).enumerate() {
            let DVec2 { x, y } = self.place_mm;
            text += &format!(
                "[[poses]]\ntime_s = {time_s:?}\nposition_mm = [{x:?}, {y:?}, {:?}]\n",
                -depth_mm
            );
        }
        for (index, at_mm) in line_mm().into_iter().enumerate() {
            text += &format!(
                "[[points]]\nname = \"line{index:02}\"\nposition_mm = [{:?}, {:?}, 0.0]\nradius_mm = 0.0\n",
                at_mm.x, at_mm.y
            );
        }
        Ok(PressPath::parse("path", &text)?)
    }
}

/// Radius of a taxel's port, mm.
pub(super) const PORT_RADIUS_MM: f64 = 1.0;

/// The taxels of the sensor PhysTac.
pub(super) fn taxels_mm() -> Vec<(String, DVec2)> {
    let rows = [-4.0, 4.0].into_iter();
    rows.flat_map(|y| [-12.0, -4.0, 4.0, 12.0].map(|x| DVec2::new(x, y)))
        .enumerate()
        .map(|(index, at_mm)| (format!("t{index}"), at_mm))
        .collect()
}

/// Points on the board.
pub(super) fn line_mm() -> Vec<DVec2> {
    (-32..=32)
        .map(|i| DVec2::new(0.5 * f64::from(i), LINE_Y_MM))
        .collect()
}

fn no_files(path: &str) -> std::io::Result<Vec<u8>> {
    Err(std::io::Error::other(format!("{path} is not read here")))
}
