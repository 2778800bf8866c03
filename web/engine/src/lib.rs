//! The engine of a sensor's gel (`crates/app/engine`) as a WebAssembly module: `exports` is what it shows to a page.

#[cfg(target_arch = "wasm32")]
mod exports;
