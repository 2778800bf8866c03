//! The digital twin: from a simulated gel to what the barometers would read.
