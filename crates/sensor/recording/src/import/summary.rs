//! A summary of an import.

/// What an import found and left out, for each file.
#[derive(Clone, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct ImportSummary {
    /// One summary for each file, in the order of their paths.
    pub files: Vec<FileSummary>,
}

/// What the import found in one file and left out of it.
#[derive(Clone, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct FileSummary {
    /// Name of the file, without its folder.
    pub file: String,
    /// Number of rows in the file, without its header line.
    pub rows_read: usize,
    /// Number of rows left out at its start and, for lagging taxels, at its end.
    pub rows_dropped: usize,
    /// Number of rows left out because a time, a position or a force is missing.
    pub rows_incomplete: usize,
    /// Number of missing readings in the rows after the dropped ones, of all taxels.
    pub missing_readings: usize,
    /// Number of readings outside the usable range in the rows after the dropped ones, of all
    /// taxels.
    pub clipped_readings: usize,
    /// Number of outliers among static readings.
    pub outliers: usize,
    /// Number of presses found.
    pub presses: usize,
    /// Number of frames that belong to two presses, the one before and the one after: the tip
    /// rested at the same location between them.
    pub shared_frames: usize,
    /// Columns that were not read.
    pub unread_columns: Vec<String>,
    /// Number of presses left out because they are incomplete; the warnings say where and why.
    pub presses_dropped: usize,
    /// Warnings for people.
    pub warnings: Vec<String>,
}

impl FileSummary {
    pub(crate) fn new(file: String, rows_read: usize) -> Self {
        Self {
            file,
            rows_read,
            ..Self::default()
        }
    }

    /// Whether something was left out or is unusual. Unread columns do not count.
    #[must_use]
    pub fn is_notable(&self) -> bool {
        let plain = Self {
            file: self.file.clone(),
            rows_read: self.rows_read,
            presses: self.presses,
            unread_columns: self.unread_columns.clone(),
            ..Self::default()
        };
        *self != plain
    }

    pub(crate) fn warn(&mut self, warning: String) {
        self.warnings.push(warning);
    }

    pub(crate) fn drop_press(&mut self, why: String) {
        self.presses_dropped += 1;
        self.warn(format!("dropped a press {why}"));
    }
}

impl std::fmt::Display for FileSummary {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "{}: {} presses from {} rows",
            self.file, self.presses, self.rows_read
        )?;
        for (count, what) in [
            (self.rows_dropped, "rows dropped"),
            (self.rows_incomplete, "rows incomplete"),
            (self.presses_dropped, "presses dropped"),
            (self.missing_readings, "readings missing"),
            (self.clipped_readings, "readings out of the usable range"),
            (self.outliers, "outliers"),
            (self.shared_frames, "frames shared by two presses"),
        ] {
            if count > 0 {
                write!(f, ", {count} {what}")?;
            }
        }
        if !self.unread_columns.is_empty() {
            write!(f, "\n  columns not read: {}", self.unread_columns.join(", "))?;
        }
        self.warnings
            .iter()
            .try_for_each(|warning| write!(f, "\n  {warning}"))
    }
}
