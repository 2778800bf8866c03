//! The parts of a sensor.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize, Serializer};
use twintac_shape::{Shape, Solid, SurfaceFile, Surfaces};

use crate::GelMaterial;

/// Absolute pressure of the air at sea level (ISO 2533), which an untouched barometer reads, kPa.
pub const ATMOSPHERE_KPA: f64 = 101.325;

/// Number of points on a port's rim.
const RIM_POINTS: u32 = 16;

/// A checked sensor: [`Sensor::parse`] returns only sensors that are consistent as a whole. Its
/// serialized form contains everything, also the corners of its surfaces, so that results made from
/// different sensors can be told apart.
#[derive(Clone, Debug, Serialize)]
pub struct Sensor {
    /// A short name, valid in file names.
    pub name: String,
    /// What this sensor is, in a sentence or two.
    pub summary: String,
    /// Source of the values in the description.
    pub source: String,
    /// Paths of the fields that are inferred and not stated by the source, such as
    /// `gel.solid.size_mm`.
    pub inferred: Vec<String>,
    /// The gel.
    pub gel: Gel,
    /// Rigid boxes that stand on the board inside the gel.
    pub inclusions: Vec<Inclusion>,
    /// The rigid shell around the gel, if there is one.
    pub shell: Option<Shell>,
    /// Taxels, in the order of all readings.
    pub taxels: Vec<Taxel>,
    /// Read-out: range, resolution, rate and chips.
    pub readout: Readout,
    /// Indenters that the sensor is pressed with.
    pub indenters: Vec<Indenter>,
    /// Largest force and depth that the sensor withstands, if known. A real or emulated test setup
    /// that presses it needs them.
    pub limits: Option<LoadLimits>,
    /// Path of the import description that reads recordings of this sensor, relative to the
    /// description.
    pub import: Option<String>,
    /// The triangle surfaces of the gel and the indenters, by name.
    #[serde(serialize_with = "written")]
    pub surfaces: Surfaces,
}

impl Sensor {
    /// The indenter with this name, if the sensor has one.
    #[must_use]
    pub fn indenter(&self, name: &str) -> Option<&Indenter> {
        self.indenters.iter().find(|indenter| indenter.name == name)
    }

    /// The surface files (STL) of the gel and the indenters, each with the field that has its path.
    pub(crate) fn surface_files(&self) -> Vec<(String, &SurfaceFile)> {
        surface_files(&self.gel.solid, &self.indenters)
    }

    /// Whether a port extends over the gel's side. Such a port reads only the gel within it.
    #[must_use]
    pub fn has_port_at_side(&self) -> bool {
        let is_beside = |at: DVec3| !self.gel.solid.contains(at, 1e-6, &self.surfaces);
        self.taxels.iter().any(|taxel| taxel.rim_mm().any(is_beside))
    }
}

/// Serializes surfaces as the corners of their triangles.
fn written<S: Serializer>(surfaces: &Surfaces, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(surfaces.iter().map(|(name, surface)| (name, &**surface)))
}

/// The surface files (STL) of a gel and of indenters, each with the field of a description that has
/// its path.
pub(crate) fn surface_files<'a>(
    solid: &'a Solid,
    indenters: &'a [Indenter],
) -> Vec<(String, &'a SurfaceFile)> {
    let of_gel = match solid {
        Solid::Stl(file) => Some(("gel.solid.path".to_owned(), file)),
        _ => None,
    };
    let of_indenters = indenters.iter().enumerate().flat_map(|(index, indenter)| {
        let files = indenter.shape.surface_files().into_iter();
        files.map(move |(field, file)| (format!("indenters[{index}].shape.{field}"), file))
    });
    of_gel.into_iter().chain(of_indenters).collect()
}

/// The gel. It is bonded to the board at z = 0 and to the inclusions.
#[derive(Clone, Debug, Serialize)]
pub struct Gel {
    /// The undeformed shape.
    pub solid: Solid,
    /// The material.
    pub material: GelMaterial,
}

/// A rigid box that stands on the board inside the gel, such as a barometer's housing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Inclusion {
    /// A unique name.
    pub name: String,
    /// Corner with the smallest coordinates, mm; z is 0.
    pub min_mm: DVec3,
    /// Corner with the largest coordinates, mm.
    pub max_mm: DVec3,
}

/// Rigid walls beside the gel. The gel can bulge into the gap between them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Shell {
    /// Distance from the gel's outline to the walls on all four sides, mm.
    pub gap_mm: f64,
    /// Height of the walls above the board, mm.
    pub height_mm: f64,
}

/// A taxel: a pressure port with its chip.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Taxel {
    /// A unique name, valid as a column name.
    pub name: String,
    /// Centre of the port, mm; in the gel, on the board or on a face of an inclusion.
    pub position_mm: DVec3,
    /// Radius of the port, mm. The pressure is averaged over this disc, whose normal is z.
    pub port_radius_mm: f64,
    /// The channel of the switch that the chip is read through, 0 to 7. If left out, the chip is on
    /// the bus itself.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub channel: Option<u8>,
    /// The 7-bit address of that switch. Default 0x70.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub switch: Option<u8>,
    /// The manufacturer's name of the chip, such as `BMP390`. Default [`Readout::chip`].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub chip: Option<String>,
    /// The chip's 7-bit address. Default: the chip's first address.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub address: Option<u8>,
    /// Number of samples averaged for one pressure. Default [`Readout::samples`].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub samples: Option<u16>,
    /// Why the taxel is excluded, if its readings cannot be trusted: it is left out of headline
    /// figures and reported beside them.
    #[serde(default)]
    pub doubtful: Option<String>,
}

impl Taxel {
    /// Points on the rim of the port, mm.
    pub(crate) fn rim_mm(&self) -> impl Iterator<Item = DVec3> + use<> {
        let (center_mm, radius_mm) = (self.position_mm, self.port_radius_mm);
        (0..RIM_POINTS).map(move |point| {
            let angle = TAU * f64::from(point) / f64::from(RIM_POINTS);
            center_mm + (radius_mm * DVec2::from_angle(angle)).extend(0.0)
        })
    }
}

/// Read-out of the sensor.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Readout {
    /// Smallest absolute pressure in the range, kPa.
    pub min_kpa: f64,
    /// Largest absolute pressure in the range, kPa.
    pub max_kpa: f64,
    /// Smallest step between readings, kPa.
    pub resolution_kpa: f64,
    /// Frame rate, Hz: a frame has the readings of all taxels.
    pub rate_hz: f64,
    /// The manufacturer's name of the chips of all taxels without a `chip` of their own, such as
    /// `MS5837-30BA`. Default `CPS135B`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub chip: Option<String>,
    /// Number of samples averaged for one pressure, for taxels without `samples` of their own.
    /// Default: the chip's usual number.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub samples: Option<u16>,
    /// The unit that the device itself reports, such as `kPa` or `psi`; only a text for people.
    #[serde(default = "kilopascal")]
    pub unit: String,
    /// Counts of the barometers per pascal, confirmed by somebody who knows the parts: parts that
    /// look alike on the bus can differ.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub counts_per_pa: Option<u16>,
    /// The confirmed scale of counts, if it is not a whole number of counts per pascal with zero at
    /// vacuum.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub transfer: Option<ConfirmedTransfer>,
}

/// The scale of a barometer's counts: `pressure_pa = pa_per_count · counts + offset_pa`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ConfirmedTransfer {
    /// Pascals per count.
    pub pa_per_count: f64,
    /// Pressure at 0 counts, Pa.
    #[serde(default)]
    pub offset_pa: f64,
    /// Whether the 24 bits are two's complement.
    pub signed: bool,
}

/// Largest force and depth that a sensor withstands. Limits set for a press may be lower, but never
/// higher.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LoadLimits {
    /// Largest force, N.
    pub force_n: f64,
    /// Largest depth below the surface at rest, mm.
    pub depth_mm: f64,
}

fn kilopascal() -> String {
    "kPa".to_owned()
}

/// A rigid body that presses the sensor.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Indenter {
    /// A unique name. Protocols and recordings use it.
    pub name: String,
    /// The shape.
    pub shape: Shape,
    /// Coulomb's coefficient of friction on the gel. Default: the one in the solver's settings.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub friction: Option<f64>,
}
