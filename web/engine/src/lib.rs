//! The engine of the interactive page (`crates/app/engine`) as a WebAssembly module. The module
//! `exports` has the functions that a page calls.

#[cfg(target_arch = "wasm32")]
mod exports;
