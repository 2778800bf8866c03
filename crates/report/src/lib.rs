//! Pressure maps, plots and the HTML report.
