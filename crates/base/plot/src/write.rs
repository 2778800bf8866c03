//! A scene as a file.

use std::path::Path;

use crate::scene::MARGIN;
use crate::svg::svg_with_margin;
use crate::{PlotError, Scene, png};

impl Scene {
    /// Writes the picture as `.svg` or `.png` (at twice the size), depending on the extension of
    /// the file name. The file appears complete or not at all.
    ///
    /// # Errors
    /// [`PlotError::Format`] for another extension, [`PlotError::Raster`] for an impossible size,
    /// [`PlotError::Write`] if the file cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), PlotError> {
        match path.extension().and_then(|ending| ending.to_str()) {
            Some("svg") => PlotError::write_whole(path, svg_with_margin(self, MARGIN).as_bytes()),
            Some("png") => PlotError::write_whole(path, &png(self, 2.0)?),
            _ => Err(PlotError::Format {
                path: path.to_owned(),
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_formats_are_written_and_others_refused() {
        let folder = tempfile::tempdir().unwrap();
        let scene = Scene::new("empty", 20.0, 10.0);
        for (name, begin) in [("a.svg", &b"<svg"[..]), ("a.png", &b"\x89PNG"[..])] {
            let path = folder.path().join(name);
            scene.write(&path).unwrap();
            assert!(std::fs::read(&path).unwrap().starts_with(begin));
        }
        let error = scene.write(&folder.path().join("a.gif")).unwrap_err();
        assert!(error.to_string().contains(".svg or .png"));
    }
}
