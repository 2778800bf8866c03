//! House rules and checks.
fn main() {}
