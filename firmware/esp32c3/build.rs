//! Rebuilds when the variables change that name the chips.

fn main() {
    println!("cargo:rerun-if-env-changed=TWINTAC_CHIP");
    println!("cargo:rerun-if-env-changed=TWINTAC_SCALE");
}
