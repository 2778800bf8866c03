//! Reads CSV files and bags of any test setup, with a description of what their columns mean.

mod align;
mod bag;
mod buffered;
mod cell;
mod check;
mod clock;
mod correlate;
mod describe;
mod description;
mod guess;
mod header;
mod join;
mod median;
mod open;
mod outliers;
mod plausible;
mod split;
mod summary;
mod suspicious;
mod table;
mod text;
mod track;
mod unit;
mod zero;

use std::path::Path;

pub use bag::{Bag, BagTopic, ReadBag};
use describe::Descriptions;
use description::{Description, Split};
pub use guess::{guess_bag_import, guess_import};
pub use summary::{FileSummary, ImportSummary};

use crate::{Control, Frames, Press, Recording, RecordingError};
use open::open;
use track::Track;

/// Describes how to read the CSV files and bags of a test setup: the meaning and unit of each
/// column, and how the file is split into presses.
///
/// ```
/// let text = r##"
/// sensor = "my-sensor"            # name of the sensor description
/// provenance = "real"
/// indenter = "tip"                # name of the indenter in the sensor description
/// delimiter = ","                 # the default; with " " any number of blanks separates
/// ## columns = ["t", "z", "p"]     # names the columns of files without a header line
/// ## skip_lines = 3                # lines before the header
/// ## comment = "#"                 # lines that begin with it are left out
/// ## decimal = ","
/// ## missing = ["ERR", "-999"]     # a missing reading, beside an empty cell, NaN, NA, null, None and --
/// ## drop_incomplete_rows = true   # leaves out rows without a time, a place or a force
/// drop_rows = 0                   # rows to leave out at the start of each file, a number ...
/// drop_buffered = true            # ... and those that come at less than half the usual time step, read from a buffer
/// gel_top_mm = 6.0                # height of the unloaded gel in its own frame
///
/// ## A column's number becomes mm, N or s as number * scale / divide_by * unit + offset; without `column`, the offset alone.
/// time = { column = "t", unit = "ms" }             # or "clock": 13:05:59.250, or a date and time
/// ## time = { column = "t", unit = "us", wraps_at = 4294967296, repeated = "spread" }    # a counter of 32 bits, rows in bursts
/// x = { column = "x", unit = "um", offset = -14.25 }
/// y = { offset = 0.0 }
/// z = { column = "z", unit = "mm", divide_by = 480.0 }
/// ## rotation = { columns = ["qx", "qy", "qz", "qw"], upright = [0.0, 0.0, 0.0, 1.0] }   # how the indenter is turned
/// contact = { z_mm = 2.08, z_points = "down" }    # the tip touches the gel here, on the z column's scale
/// ## force = { column = "f", unit = "N" }          # measured, or `weight_n = 0.98` for a dead weight
///
/// readings = { unit = "Pa", usable = [0.0, 140500.0] }    # numbers outside are marked as not valid
/// ## temperatures = { column = "temp", unit = "C", scale = 0.01 }    # one thermometer for all taxels; also "K", "F"
/// taxels = [
///     { name = "S0", column = "p", lag_s = 0.112 },       # p(t + lag) belongs to z(t); also scale, offset_kpa, temperature = "t0"
/// ]
///
/// ## "return-to-rest": the tip leaves and returns to rest; "column" (with `column = "..."`): a column's number or text changes;
/// ## "row": each row is a static press; "none": readings alone, which [`Import::read_frames`] reads.
/// presses = { split = "return-to-rest", rest_mm = 0.0, tolerance_mm = 0.005, keep_rest_s = 1.0 }
/// zero = { above_contact_mm = 0.5, window_s = 1.0 }       # zeroes each taxel before each press
/// ## outliers = { within_mm = 0.8, jump = 0.15 }           # static presses: marks what leaps out of its neighbours
///
/// ## [[join]]                       # another file of the same recording, with some of the columns, on a clock of its own
/// ## file = "{stem}-force.csv"      # {stem}: the main file's name without its ending
/// ## columns = ["f"]
/// ## time = { column = "us", unit = "us" }
/// ## clock = "found"                # by the presses; or "same", or { offset_s = 1.12, rate = 1.0 }
/// ## within_s = 0.02                # nearest row in time, no further than that
///
/// [[override]]                    # any of the above, for files whose names match
/// files = "gelA_*"
/// contact = { z_mm = 3.5 }
/// "##;
/// twintac_recording::Import::parse("my-bench.toml", text)?;
/// # Ok::<(), twintac_recording::RecordingError>(())
/// ```
///
/// With `return-to-rest`, a press lasts from the tip's leaving its rest position to its return. Up
/// to `keep_rest_s` more is kept on both sides while the tip stays at the same location. A press
/// that is in the gel when its file starts or ends is dropped, and the summary says so. A press
/// that has left the gel when the file ends is kept. A press without a frame for its zero is
/// dropped as well.
///
/// Texts are UTF-8, UTF-16 or Latin-1. A last row that the logger did not finish is left out, and
/// zero bytes after it as well; the summary says so. A missing reading is NaN and not valid; the
/// rest of its row is kept.
///
/// The readings of a lagging taxel are interpolated linearly onto the clock of the poses. A reading
/// is valid if both neighbours are. Rows at the ends of a file without such neighbours are dropped.
#[derive(Clone, Debug)]
pub struct Import {
    descriptions: Descriptions,
    read_bag: Option<ReadBag>,
}

impl Import {
    /// Parses an import description. `file` names it in errors.
    ///
    /// # Errors
    ///
    /// A field is wrong; the error names line and field.
    pub fn parse(file: &str, text: &str) -> Result<Self, RecordingError> {
        let descriptions = Descriptions::parse(file, text)?;
        Ok(Self {
            descriptions,
            read_bag: None,
        })
    }

    /// Also reads bags with `read_bag`: recordings of several topics, whose columns are
    /// `/topic:field`.
    ///
    /// The rows are the messages of the first taxel's topic, or of the topic of `time`. The times
    /// of a topic are those in its headers, or else those at which it was recorded. Without `time`,
    /// they count from the first row. Numbers of other topics are interpolated linearly between two
    /// messages around a row, which may be at most 20 ms, or two periods of their topic, apart. A
    /// row without such messages is left out. For columns of readings the row is kept instead, and
    /// the reading is missing. If `time` is `/topic:log_time`, the times of all topics are those at
    /// which they were recorded.
    #[must_use]
    pub fn with_bags(self, read_bag: ReadBag) -> Self {
        Self {
            read_bag: Some(read_bag),
            ..self
        }
    }

    /// Reads one CSV file, or a bag.
    ///
    /// # Errors
    ///
    /// The file cannot be read, a column is missing or occurs twice, a cell is not a finite number,
    /// times do not increase, or no presses are found; the error names file, line and column. Also
    /// if no press reaches the gel, or if readings are near atmospheric pressure and there is no
    /// `zero`.
    pub fn read_csv(&self, path: &Path) -> Result<(Recording, ImportSummary), RecordingError> {
        self.read_all(std::slice::from_ref(&path))
    }

    /// Height of the unloaded gel above the board that the description gives for a file, mm.
    ///
    /// # Errors
    /// Overrides for this file contradict each other.
    pub fn gel_top_mm(&self, path: &Path) -> Result<f64, RecordingError> {
        Ok(self.descriptions.for_file(path)?.gel_top_mm)
    }

    /// Whether the files contain presses. Otherwise they contain only readings.
    #[must_use]
    pub fn has_presses(&self) -> bool {
        self.descriptions.has_presses()
    }

    /// Reads the frames of a CSV file without presses, for a description with
    /// `presses = { split = "none" }`. Readings are in kPa and unchanged: no zero is subtracted.
    ///
    /// # Errors
    /// See [`read_csv`](Self::read_csv). [`RecordingError::Inconsistent`]: the description has
    /// presses.
    pub fn read_frames(&self, path: &Path) -> Result<(Frames, FileSummary), RecordingError> {
        let description = self.descriptions.for_file(path)?;
        if !matches!(description.presses, Split::None) {
            return Err(RecordingError::Inconsistent {
                place: path.display().to_string(),
                problem: "its import description has presses; `presses = { split = \"none\" }` reads a log of readings alone".to_owned(),
            });
        }
        let (frames, summary) = read_frames(path, &description, self.read_bag)?;
        frames.check()?;
        Ok((frames, summary))
    }

    /// Reads CSV files of one sensor into one recording, in the order of their paths, whatever the
    /// order given.
    ///
    /// # Errors
    ///
    /// See [`read_csv`](Self::read_csv); also if the files differ in sensor, taxels or provenance,
    /// or have the same name.
    pub fn read_all<P: AsRef<Path>>(
        &self,
        paths: &[P],
    ) -> Result<(Recording, ImportSummary), RecordingError> {
        let mut paths: Vec<&Path> = paths.iter().map(AsRef::as_ref).collect();
        paths.sort_unstable();
        let mut summary = ImportSummary::default();
        let mut recording: Option<Recording> = None;
        for path in paths {
            let description = self.descriptions.for_file(path)?;
            let (presses, found) = read_file(path, &description, self.read_bag)?;
            summary.files.push(found);
            let taxels = description.taxels.into_iter().map(|taxel| taxel.name);
            let next = Recording {
                sensor: description.sensor,
                provenance: description.provenance,
                taxels: taxels.collect(),
                presses,
            };
            match &mut recording {
                None => recording = Some(next),
                Some(recording) => {
                    let different = |mixed: RecordingError| RecordingError::Inconsistent {
                        place: path.display().to_string(),
                        problem: mixed.to_string(),
                    };
                    recording.expect_alike(&next).map_err(different)?;
                    recording.expect_no_copy(&next).map_err(different)?;
                    recording.presses.extend(next.presses);
                }
            }
        }
        let recording = recording.ok_or_else(|| RecordingError::Inconsistent {
            place: "import".to_owned(),
            problem: "expected at least one file, found none".to_owned(),
        })?;
        recording.check()?;
        Ok((recording, summary))
    }
}

/// The rows of a file on the clock of the poses, and a summary of what was left out so far.
fn read_track(
    path: &Path,
    description: &Description,
    read_bag: Option<ReadBag>,
) -> Result<(Track, FileSummary), RecordingError> {
    let (wanted, time) = (description.wanted_of(None), description.time.as_ref());
    let mut table = open(path, description, &wanted, time, read_bag)?;
    let own_clock = Description {
        time: description.time.clone().or_else(|| table.clock.take()),
        ..description.clone()
    };
    let description = &own_clock;
    let n_rows_read = table.rows() + table.incomplete_rows + table.rows_alone;
    let mut summary = FileSummary::new(file_name(path), n_rows_read);
    summary.rows_incomplete = table.incomplete_rows;
    summary.unread_columns.clone_from(&table.unread);
    table.notes.iter().for_each(|note| summary.warn(note.clone()));
    let mut times_s = clock::times_s(&table, description.time.as_ref());
    let notes = join::join(path, &mut table, &mut times_s, description, read_bag)?;
    notes.into_iter().for_each(|note| summary.warn(note));
    let n_rows = table.rows();
    let dropped = buffered::leading_rows(&table, &times_s, description)?;
    let track = Track::new(table, times_s, description, dropped)?;
    summary.missing_readings = track.raw.iter().flatten().filter(|raw| raw.is_nan()).count();
    let unusable = track.usable.iter().flatten().filter(|&&usable| !usable).count();
    summary.clipped_readings = unusable - summary.missing_readings;
    let track = align::onto_pose_clock(track, description);
    summary.rows_dropped = n_rows - track.time_s.len();
    Ok((track, summary))
}

fn read_frames(
    path: &Path,
    description: &Description,
    read_bag: Option<ReadBag>,
) -> Result<(Frames, FileSummary), RecordingError> {
    let (track, mut summary) = read_track(path, description, read_bag)?;
    let names: Vec<String> = description
        .taxels
        .iter()
        .map(|taxel| taxel.name.clone())
        .collect();
    let mut frames = Frames::new(&description.sensor, description.provenance, &names);
    let taxels = 0..names.len();
    for row in 0..track.time_s.len() {
        let reading_kpa = |taxel: usize| match track.usable[taxel][row] {
            true => track.kpa(row, taxel, description),
            false => f64::NAN,
        };
        let temperature_c = |taxel: usize| {
            track
                .temperature_c
                .get(taxel)
                .map_or(f64::NAN, |column| column[row])
        };
        frames
            .readings_kpa
            .push(taxels.clone().map(reading_kpa).collect());
        frames
            .temperature_c
            .push(taxels.clone().map(temperature_c).collect());
    }
    frames.gap_before = vec![false; track.time_s.len()];
    frames.time_s = track.time_s;
    if frames.time_s.is_empty() {
        summary.warn("has no rows".to_owned());
    }
    Ok((frames, summary))
}

fn read_file(
    path: &Path,
    description: &Description,
    read_bag: Option<ReadBag>,
) -> Result<(Vec<Press>, FileSummary), RecordingError> {
    let file = path.display().to_string();
    let (track, mut summary) = read_track(path, description, read_bag)?;
    let stem = path
        .file_stem()
        .map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
    let mut presses = Vec::new();
    let spans = split::presses(&track, &description.presses, &mut summary);
    let ends = spans.windows(2);
    summary.shared_frames = ends.map(|pair| pair[0].end.saturating_sub(pair[1].start)).sum();
    if !matches!(description.presses, Split::None) {
        plausible::check(&file, &track, &spans, description)?;
    }
    let unusual = suspicious::units(&track, description);
    unusual.into_iter().for_each(|warning| summary.warn(warning));
    for (index, span) in spans.into_iter().enumerate() {
        let number = index + 1;
        let Some(zero_kpa) = zero::before_press(&track, span.clone(), description) else {
            summary.drop_press(format!(
                "press {number}, from {}: no frame before the contact to take the zero from",
                track.place(span.start)
            ));
            continue;
        };
        let mut press = Press {
            name: format!("{stem}#{number}"),
            mounting: file_name(path),
            indenter: description.indenter.clone(),
            control: if description.weight_n.is_some() {
                Control::Force
            } else {
                Control::Pose
            },
            time_s: Vec::new(),
            gel_from_indenter: Vec::new(),
            force_n: (description.weight_n.is_some() || description.force.is_some()).then(Vec::new),
            taxels_kpa: Vec::new(),
            taxels_raw: Vec::new(),
            temperature_c: (!track.temperature_c.is_empty()).then(Vec::new),
            valid: Vec::new(),
        };
        for frame in span {
            track.push_frame(frame, &zero_kpa, description, &mut press);
        }
        presses.push(press);
    }
    if let Some(outliers) = description.outliers {
        summary.outliers = outliers::mark(&mut presses, outliers);
    }
    summary.presses = presses.len();
    let unusual = suspicious::presses(&presses, description);
    unusual.into_iter().for_each(|warning| summary.warn(warning));
    if presses.is_empty() {
        return Err(RecordingError::NoPresses {
            file,
            rows: summary.rows_read,
            why: split::explain(&description.presses, &summary),
        });
    }
    Ok((presses, summary))
}

fn file_name(path: &Path) -> String {
    path.file_name()
        .map_or_else(String::new, |name| name.to_string_lossy().into_owned())
}
