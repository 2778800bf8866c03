//! What a sensor consists of.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize, Serializer};
use twintac_shape::{Shape, Solid, SurfaceFile, Surfaces};

use crate::GelMaterial;

/// Points of a port's rim.
const RIM_POINTS: u32 = 16;

/// A sensor, checked: whatever [`Sensor::parse`] gives out makes sense as a whole. It is written with all that it consists of, surfaces with their corners: what is
/// made from a sensor is told by that from what is made from another.
#[derive(Clone, Debug, Serialize)]
pub struct Sensor {
    /// A short name, fit for file names.
    pub name: String,
    /// What this sensor is, in a sentence or two.
    pub summary: String,
    /// Where the description's values come from.
    pub source: String,
    /// Paths of the fields that are inferred rather than stated by the source, such as `gel.solid.size_mm`.
    pub inferred: Vec<String>,
    /// The gel.
    pub gel: Gel,
    /// Rigid boxes that stand on the board inside the gel.
    pub inclusions: Vec<Inclusion>,
    /// The rigid shell around the gel, if there is one.
    pub shell: Option<Shell>,
    /// Where pressure is felt, in the order of all readings.
    pub taxels: Vec<Taxel>,
    /// How readings come out.
    pub readout: Readout,
    /// What the sensor is pressed with.
    pub indenters: Vec<Indenter>,
    /// What it stands, if that is known. A bench that presses it has to know.
    pub limits: Option<LoadLimits>,
    /// Path, relative to the description, of the import description that reads recordings of this sensor.
    pub import: Option<String>,
    /// The triangle surfaces that the gel and the indenters name.
    #[serde(serialize_with = "written")]
    pub surfaces: Surfaces,
}

impl Sensor {
    /// The indenter of a name, if the sensor has one.
    #[must_use]
    pub fn indenter(&self, name: &str) -> Option<&Indenter> {
        self.indenters.iter().find(|indenter| indenter.name == name)
    }

    /// The surfaces (STL) that the gel and the indenters name, each with the field of its path.
    pub(crate) fn surface_files(&self) -> Vec<(String, &SurfaceFile)> {
        surface_files(&self.gel.solid, &self.indenters)
    }

    /// Whether a port reaches out of the gel, over its side: it feels what gel there is below it.
    #[must_use]
    pub fn has_port_at_side(&self) -> bool {
        self.taxels.iter().any(|taxel| {
            let rim = (0..RIM_POINTS).map(|point| TAU * f64::from(point) / f64::from(RIM_POINTS));
            let mut rim = rim.map(|angle| taxel.port_radius_mm * DVec2::from_angle(angle));
            rim.any(|aside_mm| {
                let at = taxel.position_mm + aside_mm.extend(0.0);
                !self.gel.solid.contains(at, 1e-6, &self.surfaces)
            })
        })
    }
}

/// Surfaces as the corners of their triangles.
fn written<S: Serializer>(surfaces: &Surfaces, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(surfaces.iter().map(|(name, surface)| (name, &**surface)))
}

/// The surfaces (STL) that a gel and indenters name, each with the field of its path in a description.
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

/// The soft part. It is bonded to the board at z = 0 and to the inclusions.
#[derive(Clone, Debug, Serialize)]
pub struct Gel {
    /// Its undeformed shape.
    pub solid: Solid,
    /// What it is made of.
    pub material: GelMaterial,
}

/// A rigid box that stands on the board inside the gel, such as a barometer's housing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Inclusion {
    /// A name of its own.
    pub name: String,
    /// Corner with the smallest coordinates, mm; z is 0.
    pub min_mm: DVec3,
    /// Corner with the largest coordinates, mm.
    pub max_mm: DVec3,
}

/// Rigid walls beside the gel. The gel can bulge into the gap between.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Shell {
    /// Distance from the gel's footprint to the walls on all four sides, mm.
    pub gap_mm: f64,
    /// Height of the walls above the board, mm.
    pub height_mm: f64,
}

/// A place where pressure is felt.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Taxel {
    /// A name of its own, fit for column names.
    pub name: String,
    /// Centre of the port, mm: in the gel, on the board or on a face of an inclusion.
    pub position_mm: DVec3,
    /// Radius of the port, a disc with normal z over which pressure is averaged, mm.
    pub port_radius_mm: f64,
    /// Which channel of its switch it is read through, 0 to 7. Left out: its chip is on the bus itself, behind no switch.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub channel: Option<u8>,
    /// The 7-bit address of that switch. Left out: 0x70.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub switch: Option<u8>,
    /// The manufacturer's name for its chip, such as `BMP390`. Left out: [`Readout::chip`].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub chip: Option<String>,
    /// Its chip's 7-bit address. Left out: the first that such chips have.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub address: Option<u8>,
    /// How many samples of its chip make one pressure. Left out: [`Readout::samples`].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub samples: Option<u16>,
    /// Why its readings are not to be trusted, if they are not: it is then left out of headline figures and
    /// reported beside them.
    #[serde(default)]
    pub doubtful: Option<String>,
}

/// How readings come out.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Readout {
    /// Smallest absolute pressure that can be read, kPa.
    pub min_kpa: f64,
    /// Largest absolute pressure that can be read, kPa.
    pub max_kpa: f64,
    /// Smallest step between readings, kPa.
    pub resolution_kpa: f64,
    /// Readings of all taxels in a second, Hz.
    pub rate_hz: f64,
    /// The manufacturer's name for the chips of taxels that name none themselves, such as `MS5837-30BA`. Left out: `CPS135B`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub chip: Option<String>,
    /// How many samples of a chip make one pressure, for taxels that say nothing else. Left out: what is usual of the chip.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub samples: Option<u16>,
    /// Unit that the device itself reports, such as `kPa` or `psi`; for people to read.
    #[serde(default = "kilopascal")]
    pub unit: String,
    /// How many counts of its barometers are a pascal, once somebody who knows the parts has confirmed it: parts that look alike on the
    /// bus differ.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub counts_per_pa: Option<u16>,
    /// What counts stand for, confirmed, where that is not a whole number of counts per pascal from a vacuum on.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub transfer: Option<ConfirmedTransfer>,
}

/// What the counts of a barometer stand for: `pressure_pa = pa_per_count · counts + offset_pa`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ConfirmedTransfer {
    /// Pascal per count.
    pub pa_per_count: f64,
    /// Pressure at 0 counts, Pa.
    #[serde(default)]
    pub offset_pa: f64,
    /// Whether the 24 bits are two's complement.
    pub signed: bool,
}

/// What a sensor stands. Whoever presses it may set lower limits, never higher ones.
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

/// A rigid body that the sensor is pressed with.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Indenter {
    /// A name of its own, by which protocols and recordings call it.
    pub name: String,
    /// Its shape.
    pub shape: Shape,
    /// Coulomb's coefficient of friction on the gel; that of the solver's settings where it is left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub friction: Option<f64>,
}
