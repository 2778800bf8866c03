//! What an import found and left out.

/// What an import found and left out, file by file.
#[derive(Clone, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct ImportSummary {
    /// One for each file, in the order of their paths.
    pub files: Vec<FileSummary>,
}

/// What the import found in one file and left out of it.
#[derive(Clone, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct FileSummary {
    /// Name of the file, without folders.
    pub file: String,
    /// Rows in the file, without its header line.
    pub rows_read: usize,
    /// Rows left out at its start and, for lagging taxels, at its end.
    pub rows_dropped: usize,
    /// Readings outside the usable range, in the rows after the dropped ones; of all taxels together.
    pub clipped_readings: usize,
    /// Static readings that leap out of their neighbours.
    pub outliers: usize,
    /// Presses found.
    pub presses: usize,
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
        let Self {
            file,
            rows_read,
            rows_dropped,
            clipped_readings,
            outliers,
            presses,
            ..
        } = self;
        write!(
            f,
            "{file}: {presses} presses from {rows_read} rows, {rows_dropped} rows dropped"
        )?;
        write!(f, ", {clipped_readings} readings clipped, {outliers} outliers")?;
        self.warnings
            .iter()
            .try_for_each(|warning| write!(f, "\n  {warning}"))
    }
}
