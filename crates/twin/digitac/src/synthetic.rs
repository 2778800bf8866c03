//! A gel of formulas: Hertz's contact, with pressures from a kernel that widens with the contact,
//! so that the crate can be tested without finite elements.

use glam::DVec3;
use twintac_depth_table::{
    DepthTable, DepthTableRequest, DepthTableSource, PressFrame, SolveQuality, SourceError,
};
use twintac_recording::{Control, Press, Provenance, Recording};
use twintac_shape::{Pose, Shape, Surfaces, Underside};

use crate::seed;
use crate::{Features, Gains};

const TOP_MM: f64 = 6.0;
const MODULUS_KPA: f64 = 1500.0;
pub(crate) const TAXELS_X_MM: [f64; 4] = [-6.0, 0.0, 6.0, 12.0];
pub(crate) const DESCRIBED_RADIUS_MM: f64 = 2.0;

/// The formulas, as the twin simulates them.
pub(crate) struct Formula;

impl Formula {
    /// Force, port pressures and stress features.
    pub(crate) fn at(place: DVec3, depth_mm: f64, radius_mm: f64) -> (f64, Vec<f64>, Vec<f64>) {
        let depth_mm = depth_mm.max(0.0);
        let force_n = 4.0 / 3.0 * MODULUS_KPA * 1e-3 * radius_mm.sqrt() * depth_mm.powf(1.5);
        let width2 = 9.0 + 1.5 * radius_mm * depth_mm;
        let read = |x: f64| {
            let r2 = (place.x - x).powi(2) + place.y.powi(2);
            let shape = (1.0 + r2 / width2).powf(-2.5) * (1.0 - 0.04 * r2 / width2);
            1000.0 * force_n / (std::f64::consts::PI * width2) * shape
        };
        let pressure = TAXELS_X_MM.map(read).to_vec();
        let stress = TAXELS_X_MM.map(|x| read(x).abs().powf(0.8) / 3.0).to_vec();
        (force_n, pressure, stress)
    }
}

impl DepthTableSource for Formula {
    fn touch(&self, _indenter: &str, above: &Pose) -> Result<Pose, SourceError> {
        Ok(Pose {
            position_mm: above.position_mm.with_z(TOP_MM),
            rotation: above.rotation,
        })
    }

    fn underside(&self, request: &DepthTableRequest) -> Result<Underside, SourceError> {
        let radius_mm = request.tip_radius_mm.unwrap_or(DESCRIBED_RADIUS_MM);
        let ball = Shape::Sphere { radius_mm };
        let ball = ball.signed_distance_field(&Surfaces::default())?;
        Ok(Underside::of(
            ball.as_ref(),
            request.gel_from_indenter_at_touch.rotation,
        ))
    }

    fn depth_tables(&self, requests: &[DepthTableRequest]) -> Result<Vec<DepthTable>, SourceError> {
        let quality = SolveQuality {
            iterations: 3,
            residual: 0.0,
            penetration_mm: 0.0,
            smallest_volume_ratio: 0.9,
            wall_time_s: 0.0,
        };
        let table = |request: &DepthTableRequest| {
            let touch = request.gel_from_indenter_at_touch;
            let frames = (0..=14).map(|i| {
                let depth_mm = request.max_depth_mm * (f64::from(i) / 14.0).powf(1.25);
                let radius_mm = request.tip_radius_mm.unwrap_or(DESCRIBED_RADIUS_MM);
                let (force_n, pressure, stress) = Formula::at(touch.position_mm, depth_mm, radius_mm);
                PressFrame {
                    depth_mm,
                    force_n,
                    port_pressure_kpa: pressure,
                    port_slope_kpa_per_mm: vec![[0.0; 3]; TAXELS_X_MM.len()],
                    stress_feature_kpa_per_mm: stress,
                    quality,
                }
            });
            DepthTable {
                indenter: request.indenter.clone(),
                gel_from_indenter_at_touch: touch,
                n_nodes: 1,
                frames: frames.collect(),
                failure: None,
            }
        };
        Ok(requests.iter().map(table).collect())
    }
}

/// True values that the fits have to find.
#[derive(Clone)]
pub(crate) struct Truth {
    pub(crate) radius_mm: f64,
    pub(crate) gains: Gains,
    pub(crate) offsets_mm: Vec<f64>,
    /// Standard deviation of the noise over the largest reading.
    pub(crate) noise: f64,
    pub(crate) modulus: f64,
}

impl Truth {
    pub(crate) fn new() -> Self {
        Self {
            radius_mm: 2.7,
            gains: Gains {
                gain: vec![0.5, 0.8, 1.1, 0.65],
                stiffening_per_kpa: vec![0.0; 4],
                memory: vec![vec![0.2, 0.05], vec![0.1, 0.2], vec![0.3, 0.0], vec![0.15, 0.1]],
                time_constants_s: vec![0.25, 4.0],
            },
            offsets_mm: vec![0.05, -0.04],
            noise: 0.003,
            modulus: 1.0,
        }
    }

    /// Presses along the strip, one file for each contact offset, with holds of different lengths.
    pub(crate) fn recording(&self, n_places: usize) -> Recording {
        let mut presses = Vec::new();
        for (file, offset_mm) in self.offsets_mm.iter().enumerate() {
            for number in 0..n_places {
                let x = -7.0 + 20.0 * number as f64 / (n_places - 1) as f64;
                let deepest_mm = [2.0, 1.5][file % 2];
                let hold_s = [4.0, 7.0][file % 2];
                presses.push(self.press(&format!("file{file}"), number, x, deepest_mm, hold_s, *offset_mm));
            }
        }
        Recording {
            sensor: "formula".into(),
            provenance: Provenance::Emulated,
            taxels: ["S0", "S1", "S2", "S3"].map(String::from).to_vec(),
            presses,
        }
    }

    fn press(
        &self,
        file: &str,
        number: usize,
        x: f64,
        deepest_mm: f64,
        hold_s: f64,
        offset_mm: f64,
    ) -> Press {
        let mut random = seed::stream(7, &format!("{file}/{number}"));
        let down_s = deepest_mm + 0.8;
        let time_s: Vec<f64> = (0..)
            .map(|i| 0.061 * f64::from(i))
            .take_while(|t| *t < 2.0 * down_s + hold_s + 0.5)
            .collect();
        let said_mm: Vec<f64> = time_s
            .iter()
            .map(|t| t.min(down_s).min(2.0 * down_s + hold_s - t).max(0.0) - 0.8)
            .collect();
        let frame =
            |depth_mm: f64| Formula::at(DVec3::new(x, 0.0, TOP_MM), depth_mm + offset_mm, self.radius_mm);
        let frames: Vec<_> = said_mm.iter().map(|depth_mm| frame(*depth_mm)).collect();
        let features = Features {
            time_s: time_s.clone(),
            depth_mm: said_mm.clone(),
            force_n: frames.iter().map(|f| self.modulus * f.0).collect(),
            pressure_kpa: frames
                .iter()
                .map(|f| f.1.iter().map(|p| self.modulus * p).collect())
                .collect(),
            stress_kpa_per_mm: frames.iter().map(|f| f.2.clone()).collect(),
            simulated: vec![true; time_s.len()],
            since_previous_s: None,
            zero_frames: 0..0,
        };
        let mut taxels_kpa = self.gains.readings_kpa(&[&features]).swap_remove(0);
        let largest = 130.0;
        taxels_kpa
            .iter_mut()
            .flatten()
            .for_each(|r| *r += self.noise * largest * seed::normal(&mut random));
        let n_frames = time_s.len();
        Press {
            name: format!("{file}#{number}"),
            mounting: file.into(),
            indenter: "tip".into(),
            control: Control::Pose,
            time_s,
            gel_from_indenter: said_mm
                .iter()
                .map(|d| Pose::from_position(DVec3::new(x, 0.0, TOP_MM - d)))
                .collect(),
            force_n: None,
            temperature_c: None,
            taxels_raw: taxels_kpa.clone(),
            taxels_kpa,
            valid: vec![vec![true; 4]; n_frames],
        }
    }
}

/// A press of two taxels by hand; frames are (depth, readings).
pub(crate) fn by_hand(
    name: &str,
    mounting: &str,
    place_mm: [f64; 2],
    frames: &[(f64, [f64; 2])],
) -> crate::PairedPress {
    let n_frames = frames.len();
    crate::PairedPress {
        name: name.into(),
        mounting: mounting.into(),
        indenter: "tip".into(),
        place_mm,
        features: Features {
            time_s: (0..n_frames).map(|i| 0.1 * i as f64).collect(),
            depth_mm: frames.iter().map(|f| f.0).collect(),
            force_n: vec![0.0; n_frames],
            pressure_kpa: vec![vec![0.0; 2]; n_frames],
            stress_kpa_per_mm: vec![vec![0.0; 2]; n_frames],
            simulated: vec![true; n_frames],
            since_previous_s: None,
            zero_frames: 0..0,
        },
        measured_force_n: None,
        readings_kpa: frames.iter().map(|f| f.1.to_vec()).collect(),
        valid: vec![vec![true; 2]; n_frames],
        warp: crate::Warp::identity(n_frames),
    }
}
