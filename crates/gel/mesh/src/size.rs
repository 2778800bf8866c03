//! The requested edge length along one axis.

use crate::MeshError;

/// Largest number of lines of an axis.
const MOST_LINES: usize = 4096;

/// The edge length as a function of one coordinate: short near some positions, and growing linearly
/// away from them up to a largest value.
pub(crate) struct SizeField {
    edge_mm: f64,
    /// Derivative of the edge length by the coordinate. Cells whose length grows with slope `s`
    /// grow by the factor `exp(s)` from one to the next.
    slope: f64,
    pits: Vec<Pit>,
}

/// A stretch of short edges.
struct Pit {
    at_mm: f64,
    reach_mm: f64,
    edge_mm: f64,
}

impl SizeField {
    pub(crate) fn new(edge_mm: f64, growth: f64) -> Self {
        Self {
            edge_mm,
            slope: growth.ln(),
            pits: Vec::new(),
        }
    }

    /// Limits edges to `edge_mm` within `reach_mm` of a position.
    pub(crate) fn refine(&mut self, at_mm: f64, reach_mm: f64, edge_mm: f64) {
        self.pits.push(Pit {
            at_mm,
            reach_mm,
            edge_mm,
        });
    }

    /// Limits edges so that there is a cell between any two of these planes, which are sorted.
    pub(crate) fn separate(&mut self, planes_mm: &[f64]) {
        for pair in planes_mm.windows(2) {
            let gap_mm = pair[1] - pair[0];
            self.refine(0.5 * (pair[0] + pair[1]), 0.5 * gap_mm, 0.75 * gap_mm);
        }
    }

    /// Longest edge at a position.
    pub(crate) fn edge_mm(&self, at_mm: f64) -> f64 {
        self.pits.iter().fold(self.edge_mm, |edge, pit| {
            edge.min(pit.edge_mm + self.slope * ((at_mm - pit.at_mm).abs() - pit.reach_mm).max(0.0))
        })
    }

    /// Appends the planes that divide `[from, to]` into cells of the requested length, without
    /// `from` and with `to`.
    pub(crate) fn divide(&self, from_mm: f64, to_mm: f64, planes_mm: &mut Vec<f64>) -> Result<(), MeshError> {
        const SAMPLES: usize = 512;
        let step_mm = (to_mm - from_mm) / SAMPLES as f64;
        // Number of cells to the left of each sample: the integral of the inverse edge length.
        let mut cells = [0.0; SAMPLES + 1];
        for i in 0..SAMPLES {
            cells[i + 1] = cells[i] + step_mm / self.edge_mm(from_mm + (i as f64 + 0.5) * step_mm);
        }
        // A cell that is a little too short is better than one that is much too long.
        let n_cells = (cells[SAMPLES] - 0.25).ceil().max(1.0) as usize;
        if n_cells > MOST_LINES {
            return Err(MeshError::TooFine {
                found: n_cells,
                most: MOST_LINES,
            });
        }
        let mut sample = 0;
        for cell in 1..n_cells {
            let target = cells[SAMPLES] * cell as f64 / n_cells as f64;
            while cells[sample + 1] < target {
                sample += 1;
            }
            let fraction = (target - cells[sample]) / (cells[sample + 1] - cells[sample]);
            planes_mm.push(from_mm + (sample as f64 + fraction) * step_mm);
        }
        planes_mm.push(to_mm);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_short_in_the_pit_and_grow_no_faster_than_asked() {
        let mut size = SizeField::new(2.0, 1.25);
        size.refine(0.0, 1.0, 0.25);
        let mut planes = vec![-20.0];
        size.divide(-20.0, 20.0, &mut planes).unwrap();
        let cells: Vec<f64> = planes.windows(2).map(|p| p[1] - p[0]).collect();
        assert!(cells.iter().all(|&cell| cell > 0.2 && cell < 2.05), "{cells:?}");
        for pair in cells.windows(2) {
            let ratio = pair[0].max(pair[1]) / pair[0].min(pair[1]);
            assert!(ratio < 1.3, "{ratio}");
        }
        for (a, b) in cells.iter().zip(cells.iter().rev()) {
            assert!((a - b).abs() < 1e-9);
        }
    }

    #[test]
    fn too_many_cells_are_refused() {
        let size = SizeField::new(1e-4, 1.25);
        assert!(matches!(
            size.divide(0.0, 10.0, &mut Vec::new()),
            Err(MeshError::TooFine { .. })
        ));
    }
}
