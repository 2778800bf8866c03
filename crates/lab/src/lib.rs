//! An emulated bench with physics and imperfections of its own.
