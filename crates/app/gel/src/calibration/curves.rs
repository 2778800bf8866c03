//! Measured curves: CSV files, and recorded presses.

use std::path::{Path, PathBuf};

use glam::DQuat;
use serde::Deserialize;
use twintac_calibrate::{Curve, Quantity, Signal};
use twintac_recording::{Control, Import, Press, Provenance, Recording};
use twintac_simulate::Gel;
use twintac_work::{At, WorkError, read_text};

/// Frames of a recorded press count up to this height above the gel, mm.
const ABOVE_MM: f64 = 0.25;

/// If no taxels are named, a taxel counts if its largest reading is above this fraction of the
/// press's largest.
const LOUD: f64 = 0.3;

/// The file that names the curves to fit.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct CurvesFile {
    #[serde(default)]
    curves: Vec<CsvCurve>,
    #[serde(default)]
    recordings: Vec<Recorded>,
}

/// A CSV file with one press: columns `time_s`, `depth_mm`, `force_n`, `<taxel>_kpa`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct CsvCurve {
    file: PathBuf,
    indenter: String,
    #[serde(default)]
    x_mm: f64,
    #[serde(default)]
    y_mm: f64,
}

/// A curve and its provenance.
pub type Measured = (Curve, Provenance);

/// The indenter and the location of a curve from a CSV file.
#[derive(Clone, Debug)]
pub struct CsvPlace {
    /// Name of the sensor's indenter.
    pub indenter: String,
    /// Location of its origin along x, mm.
    pub x_mm: f64,
    /// Location of its origin along y, mm.
    pub y_mm: f64,
}

/// Presses from recordings.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Recorded {
    /// `presses.parquet` of a run, or a CSV file of another laboratory.
    file: PathBuf,
    /// The import description of a CSV file. If absent, the one that the sensor names.
    import: Option<PathBuf>,
    /// Names of presses; all if empty.
    #[serde(default)]
    presses: Vec<String>,
    signals: Signals,
    /// Names of the taxels whose readings count. If empty: those near the press that the
    /// description does not exclude (`doubtful`).
    #[serde(default)]
    taxels: Vec<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Signals {
    Force,
    Readings,
    Both,
}

/// The curves that a TOML file names, in tables `[[curves]]` and `[[recordings]]`. Paths in the
/// file are relative to it. `sensor_import` is the import description for CSV recordings for which
/// the file names none.
///
/// # Errors
/// A file that cannot be read or is wrong; one that names no curves.
pub fn curves_of_file(
    path: &Path,
    gel: &Gel,
    sensor_import: Option<PathBuf>,
) -> Result<Vec<Measured>, WorkError> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let file = twintac_config::read::<CurvesFile>(path)?.value;
    let mut curves = Vec::new();
    for curve in &file.curves {
        let place = CsvPlace {
            indenter: curve.indenter.clone(),
            x_mm: curve.x_mm,
            y_mm: curve.y_mm,
        };
        curves.push(curve_of_csv(&folder.join(&curve.file), &place, gel)?);
    }
    for recorded in &file.recordings {
        let import = recorded.import.as_ref().map(|import| folder.join(import));
        let import = import.or_else(|| sensor_import.clone());
        let found = of_recording(recorded, &folder.join(&recorded.file), import.as_deref(), gel);
        curves.extend(found.at(|| path.display().to_string())?);
    }
    if curves.is_empty() {
        return Err(wrong(path, "names no curves; give [[curves]] or [[recordings]]"));
    }
    Ok(curves)
}

/// One curve from a CSV file with columns `time_s`, `depth_mm`, and `force_n` or `<taxel>_kpa`. Its
/// provenance is `real`.
///
/// # Errors
/// A file that cannot be read, a missing column, a cell that is no finite number, an indenter that
/// the sensor does not have.
pub fn curve_of_csv(path: &Path, place: &CsvPlace, gel: &Gel) -> Result<Measured, WorkError> {
    let unreadable = |source: csv::Error| WorkError::Csv {
        path: path.to_owned(),
        source,
    };
    let mut reader = csv::Reader::from_path(path).map_err(unreadable)?;
    let headers = reader.headers().map_err(unreadable)?.clone();
    let column = |name: &str| headers.iter().position(|header| header.trim() == name);
    let needed = |name: &str| {
        column(name).ok_or_else(|| {
            let expected = "expected time_s, depth_mm, and force_n or <taxel>_kpa";
            wrong(path, &format!("there is no column `{name}`; {expected}"))
        })
    };
    let (time, depth) = (needed("time_s")?, needed("depth_mm")?);
    let mut columns: Vec<(usize, Quantity)> = Vec::new();
    columns.extend(column("force_n").map(|column| (column, Quantity::Force)));
    for (taxel, described) in gel.sensor().taxels.iter().enumerate() {
        let found = column(&format!("{}_kpa", described.name));
        columns.extend(found.map(|column| (column, Quantity::Taxel(taxel))));
    }
    if columns.is_empty() {
        needed("force_n")?;
    }
    let mut curve = Curve {
        name: path
            .file_stem()
            .map_or_else(String::new, |stem| stem.to_string_lossy().into_owned()),
        shape: gel
            .shape(&place.indenter)
            .at(|| path.display().to_string())?
            .clone(),
        friction: gel.friction(&place.indenter),
        x_mm: place.x_mm,
        y_mm: place.y_mm,
        rotation: DQuat::IDENTITY,
        time_s: Vec::new(),
        depth_mm: Vec::new(),
        signals: columns
            .iter()
            .map(|(_, quantity)| Signal {
                quantity: *quantity,
                values: Vec::new(),
            })
            .collect(),
    };
    for (row, record) in reader.records().enumerate() {
        // Line 1 is the header.
        let line = row + 2;
        let record = record.map_err(unreadable)?;
        let number = |column: usize| -> Result<f64, WorkError> {
            let text = record.get(column).unwrap_or_default().trim();
            let parsed: Option<f64> = text.parse().ok().filter(|value: &f64| value.is_finite());
            parsed.ok_or_else(|| {
                WorkError::Input(format!(
                    "{}:{line}: `{}` is `{text}`, expected a finite number",
                    path.display(),
                    &headers[column]
                ))
            })
        };
        curve.time_s.push(number(time)?);
        curve.depth_mm.push(number(depth)?);
        for ((column, _), signal) in columns.iter().zip(&mut curve.signals) {
            signal.values.push(number(*column)?);
        }
    }
    Ok((curve, Provenance::Real))
}

/// The error of a file with wrong content.
fn wrong(path: &Path, problem: &str) -> WorkError {
    WorkError::Input(format!("{}: {problem}", path.display()))
}

fn of_recording(
    recorded: &Recorded,
    path: &Path,
    import: Option<&Path>,
    gel: &Gel,
) -> Result<Vec<Measured>, WorkError> {
    let sensor = gel.sensor();
    let is_parquet = path.extension().is_some_and(|extension| extension == "parquet");
    let recording = if is_parquet {
        Recording::read_parquet(path)?
    } else {
        let import = import.ok_or_else(|| wrong(path, "nothing says how to read it; give `import`"))?;
        Import::parse(&import.display().to_string(), &read_text(import)?)?
            .with_bags(twintac_log::read_bag)
            .read_csv(path)?
            .0
    };
    if recording.sensor != sensor.name {
        return Err(wrong(
            path,
            &format!(
                "is a recording of `{}`, expected `{}`",
                recording.sensor, sensor.name
            ),
        ));
    }
    let named: Vec<&Press> = if recorded.presses.is_empty() {
        recording.presses.iter().collect()
    } else {
        recorded
            .presses
            .iter()
            .map(|name| {
                let found = recording.presses.iter().find(|press| press.name == *name);
                found.ok_or_else(|| wrong(path, &format!("there is no press `{name}`")))
            })
            .collect::<Result<_, WorkError>>()?
    };
    let chosen: Vec<usize> = recorded
        .taxels
        .iter()
        .map(|name| {
            let found = recording.taxels.iter().position(|taxel| taxel == name);
            found.ok_or_else(|| wrong(path, &format!("there is no taxel `{name}`")))
        })
        .collect::<Result<_, WorkError>>()?;
    named
        .into_iter()
        .map(|press| {
            let curve = of_press(press, recorded.signals, &chosen, gel);
            Ok((curve.at(|| press.name.clone())?, recording.provenance))
        })
        .collect()
}

/// The forces of all presses of a recording.
///
/// # Errors
/// A press of prescribed force, or one that never comes near the gel; an indenter that the gel does
/// not have.
pub fn force_curves(recording: &Recording, gel: &Gel) -> Result<Vec<Measured>, WorkError> {
    let curve = |press: &Press| {
        let curve = of_press(press, Signals::Force, &[], gel).at(|| press.name.clone())?;
        Ok((curve, recording.provenance))
    };
    recording.presses.iter().map(curve).collect()
}

fn of_press(press: &Press, signals: Signals, chosen: &[usize], gel: &Gel) -> Result<Curve, WorkError> {
    if press.control != Control::Pose {
        return Err(WorkError::Input(
            "was made with a prescribed force: how deep it went is not known, and a curve needs that"
                .to_owned(),
        ));
    }
    let shape = gel.shape(&press.indenter)?;
    let Some(first) = press.gel_from_indenter.first() else {
        return Err(WorkError::Input("has no frames".to_owned()));
    };
    let touch_mm = gel.touch(shape, first)?.position_mm.z;
    let depth = |frame: usize| touch_mm - press.gel_from_indenter[frame].position_mm.z;
    let near: Vec<usize> = (0..press.time_s.len())
        .filter(|&frame| depth(frame) > -ABOVE_MM)
        .collect();
    let (Some(&from), Some(&to)) = (near.first(), near.last()) else {
        return Err(WorkError::Input("never comes near the gel".to_owned()));
    };
    let frames = from..=to;
    let mut found = Vec::new();
    if signals != Signals::Readings {
        let force_n = press.force_n.as_ref();
        let force_n =
            force_n.ok_or_else(|| WorkError::Input("no force was recorded; ask for readings".to_owned()))?;
        found.push(Signal {
            quantity: Quantity::Force,
            values: force_n[frames.clone()].to_vec(),
        });
    }
    if signals != Signals::Force {
        let reading = |frame: usize, taxel: usize| {
            let valid = press.valid[frame][taxel];
            if valid {
                press.taxels_kpa[frame][taxel]
            } else {
                f64::NAN
            }
        };
        let peak = |taxel: usize| {
            frames
                .clone()
                .map(|frame| reading(frame, taxel))
                .fold(0.0, f64::max)
        };
        let taxels = &gel.sensor().taxels;
        let loudest = (0..taxels.len()).map(peak).fold(0.0, f64::max);
        let counts = |taxel: &usize| {
            if chosen.is_empty() {
                taxels[*taxel].doubtful.is_none() && peak(*taxel) > LOUD * loudest
            } else {
                chosen.contains(taxel)
            }
        };
        found.extend((0..taxels.len()).filter(counts).map(|taxel| Signal {
            quantity: Quantity::Taxel(taxel),
            values: frames.clone().map(|frame| reading(frame, taxel)).collect(),
        }));
    }
    Ok(Curve {
        name: press.name.clone(),
        shape: shape.clone(),
        friction: gel.friction(&press.indenter),
        x_mm: first.position_mm.x,
        y_mm: first.position_mm.y,
        rotation: first.rotation,
        time_s: press.time_s[frames.clone()].to_vec(),
        depth_mm: frames.clone().map(depth).collect(),
        signals: found,
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::print_stdout)] // a test that cannot set itself up has failed
    use std::error::Error;

    use super::*;

    #[test]
    fn a_recorded_press_becomes_a_curve_of_the_taxels_below_it() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..");
        let file = root.join("../shared/data/strip4/gelD_test_20230706_164635.csv");
        if !file.exists() {
            println!("skipped: no recording at {}", file.display());
            return;
        }
        let sensor = twintac_sensor::Sensor::read(root.join("sensors/strip4-gel-d.toml")).unwrap();
        let gel = Gel::new(
            std::sync::Arc::new(sensor),
            twintac_simulate::SimulateSettings::fine(),
        );
        let recorded = |presses: &[&str], signals| Recorded {
            file: file.clone(),
            import: None,
            presses: presses.iter().map(|name| (*name).to_owned()).collect(),
            signals,
            taxels: Vec::new(),
        };
        let import = root.join("imports/strip4.toml");
        let read = |recorded: &Recorded| of_recording(recorded, &file, Some(&import), &gel);
        let name = "gelD_test_20230706_164635#7";
        let curves = read(&recorded(&[name], Signals::Readings)).unwrap();
        // At x = 6.03 mm, beside S2: 4 mm of travel, of which the first 2.08 mm lead to the gel.
        assert_eq!(curves.len(), 1);
        let (curve, provenance) = &curves[0];
        assert_eq!(*provenance, Provenance::Real);
        assert!(
            curve
                .signals
                .iter()
                .any(|signal| signal.quantity == Quantity::Taxel(2))
        );
        let deepest_mm = curve.depth_mm.iter().copied().fold(0.0, f64::max);
        assert!((deepest_mm - 1.92).abs() < 0.02, "{deepest_mm}");
        assert!(curve.depth_mm.iter().all(|depth_mm| *depth_mm > -0.3));
        let no_force = read(&recorded(&[name], Signals::Force)).unwrap_err();
        assert!(
            no_force
                .source()
                .unwrap()
                .to_string()
                .contains("no force was recorded")
        );
        let no_press = read(&recorded(&["nothing"], Signals::Readings)).unwrap_err();
        assert!(no_press.to_string().contains("there is no press `nothing`"));
    }
}
