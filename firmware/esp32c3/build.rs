//! What is built depends on the variables that name the chips.

fn main() {
    println!("cargo:rerun-if-env-changed=TWINTAC_CHIP");
    println!("cargo:rerun-if-env-changed=TWINTAC_SCALE");
}
