//! What an import found and left out.

/// What an import found and left out, file by file.
#[derive(Clone, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct ImportSummary {
    /// One for each file, in the order of their paths.
    pub files: Vec<FileSummary>,
}

/// What the import found in one file and left out of it.
#[derive(Clone, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct FileSummary {
    /// Name of the file, without folders.
    pub file: String,
    /// Rows in the file, without its header line.
    pub rows_read: usize,
    /// Rows left out at its start and, for lagging taxels, at its end.
    pub rows_dropped: usize,
    /// Rows left out because a time, a place or a force is missing in them.
    pub rows_incomplete: usize,
    /// Readings that are missing, in the rows after the dropped ones; of all taxels together.
    pub missing_readings: usize,
    /// Readings outside the usable range, in the rows after the dropped ones; of all taxels together.
    pub clipped_readings: usize,
    /// Static readings that leap out of their neighbours.
    pub outliers: usize,
    /// Presses found.
    pub presses: usize,
    /// Frames that belong to two presses, the one before and the one after: the tip rested at the same place between them.
    pub shared_frames: usize,
    /// Columns that nothing was read of.
    pub unread_columns: Vec<String>,
    /// Presses left out because they are incomplete; the warnings tell where and why.
    pub presses_dropped: usize,
    /// What a person should look at.
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

    /// Whether something was left out or is odd that a person should know. Columns that nothing was read of are neither.
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
