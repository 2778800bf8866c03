//! Finds the location of a weight from `real` readings:
//! `cargo run --release -p twintac-inverse --example locate_a_weight -- DS10_atm_pitch6.75.csv`.
//!
//! The file is one of array8 (Shaevitzaiden/Underwater-Tactile-Sensor, 2024): x and y, mm, on a
//! grid of 0.5 mm, then eight readings, psi. The readings on a lattice of 2, 3 or 4 mm make a
//! table. All other readings are used for evaluation, each by itself.

#![allow(clippy::print_stdout)] // a program

use std::error::Error;

use glam::DVec2;
use twintac_inverse::{Inverse, InverseSettings, ReadingTable, TableModel};

/// kPa of one psi.
const PSI_KPA: f64 = 6.894_757;

/// Distance of the grid's points, mm. The file's numbers are rounded to it.
const GRID_MM: f64 = 0.5;

/// Standard deviation of a reading, as a fraction of the file's largest reading.
const NOISE: f64 = 0.003;

/// The readings at a point of the grid.
struct Point {
    /// Column and row.
    at: [usize; 2],
    readings_kpa: Vec<f64>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).ok_or("the path of a file of array8")?;
    let points = read(&std::fs::read_to_string(&path)?)?;
    println!(
        "real; lattice mm, trained_on, evaluated, of them not felt, median place error mm, 90 of 100 mm, strongest taxel mm, within two deviations %"
    );
    for every in [4, 6, 8] {
        evaluate(&points, every)?;
    }
    Ok(())
}

fn read(text: &str) -> Result<Vec<Point>, Box<dyn Error>> {
    let rows = text.lines().filter(|line| !line.starts_with('x'));
    let rows = rows.map(|line| line.split(',').map(str::parse).collect::<Result<Vec<f64>, _>>());
    let rows = rows.collect::<Result<Vec<_>, _>>()?;
    let least = |axis: usize| rows.iter().map(|row| row[axis]).fold(f64::INFINITY, f64::min);
    let (x_mm, y_mm) = (least(0), least(1));
    let point = |row: &Vec<f64>| Point {
        at: [(row[0] - x_mm) / GRID_MM, (row[1] - y_mm) / GRID_MM].map(|steps| steps.round() as usize),
        readings_kpa: row[2..].iter().map(|psi| psi * PSI_KPA).collect(),
    };
    Ok(rows.iter().map(point).collect())
}

fn evaluate(points: &[Point], every: usize) -> Result<(), Box<dyn Error>> {
    let is_trained_on = |point: &Point| point.at.iter().all(|at| at % every == 0);
    let mut trained_on: Vec<&Point> = points.iter().filter(|point| is_trained_on(point)).collect();
    trained_on.sort_by_key(|point| [point.at[1], point.at[0]]);
    let most = |axis: usize| trained_on.iter().map(|point| point.at[axis]).max().unwrap_or(0);
    let n = [most(0) / every + 1, most(1) / every + 1, 1];
    let step_mm = every as f64 * GRID_MM;
    let table = ReadingTable {
        first_mm: [0.0; 3],
        step_mm: [step_mm, step_mm, 1.0],
        n,
        readings_kpa: trained_on
            .iter()
            .map(|point| point.readings_kpa.clone())
            .collect(),
        force_n: vec![0.0; trained_on.len()],
    };
    let largest_kpa = points
        .iter()
        .flat_map(|point| &point.readings_kpa)
        .copied()
        .fold(0.0, f64::max);
    let settings = InverseSettings {
        noise_kpa: NOISE * largest_kpa,
        n_steps: 8,
        ..InverseSettings::default()
    };
    let inverse = Inverse::new(TableModel::new(vec![table]), settings)?;
    let strongest = strongest(points);
    let (mut errors_mm, mut taxel_errors_mm) = (Vec::new(), Vec::new());
    let (mut n_within, mut n_unfelt) = (0, 0);
    let inside = |point: &&Point| !is_trained_on(point) && (0..2).all(|axis| point.at[axis] <= most(axis));
    for point in points.iter().filter(inside) {
        if let Some(contact) = inverse.start().update(1.0, &point.readings_kpa)? {
            let error = contact.place_mm - place_mm(point);
            errors_mm.push(error.length());
            n_within += usize::from(error.abs().cmplt(2.0 * contact.place_deviation_mm).all());
            let taxel = largest(&point.readings_kpa);
            taxel_errors_mm.push(strongest[taxel].distance(place_mm(point)));
        } else {
            n_unfelt += 1;
        }
    }
    for errors in [&mut errors_mm, &mut taxel_errors_mm] {
        errors.sort_by(f64::total_cmp);
    }
    let at = |errors: &[f64], part: f64| {
        errors
            .get((part * errors.len() as f64) as usize)
            .copied()
            .unwrap_or(f64::NAN)
    };
    println!(
        "{step_mm}, {}, {}, {n_unfelt}, {:.3}, {:.3}, {:.3}, {:.1}",
        trained_on.len(),
        errors_mm.len() + n_unfelt,
        at(&errors_mm, 0.5),
        at(&errors_mm, 0.9),
        at(&taxel_errors_mm, 0.5),
        100.0 * n_within as f64 / errors_mm.len().max(1) as f64
    );
    Ok(())
}

fn place_mm(point: &Point) -> DVec2 {
    GRID_MM * DVec2::new(point.at[0] as f64, point.at[1] as f64)
}

fn largest(readings_kpa: &[f64]) -> usize {
    (0..readings_kpa.len())
        .max_by(|a, b| readings_kpa[*a].total_cmp(&readings_kpa[*b]))
        .unwrap_or(0)
}

/// The location of each taxel's largest reading, mm.
fn strongest(points: &[Point]) -> Vec<DVec2> {
    let n_taxels = points.first().map_or(0, |point| point.readings_kpa.len());
    let of = |taxel: usize| {
        points
            .iter()
            .max_by(|a, b| a.readings_kpa[taxel].total_cmp(&b.readings_kpa[taxel]))
    };
    (0..n_taxels)
        .map(|taxel| of(taxel).map_or(DVec2::ZERO, place_mm))
        .collect()
}
