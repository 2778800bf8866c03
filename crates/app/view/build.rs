//! Embeds the page that `TWINTAC_PAGE` names into the library, if it names one.

fn main() {
    println!("cargo::rerun-if-env-changed=TWINTAC_PAGE");
    println!("cargo::rustc-check-cfg=cfg(has_page)");
    if let Ok(page) = std::env::var("TWINTAC_PAGE") {
        println!("cargo::rerun-if-changed={page}");
        println!("cargo::rustc-env=TWINTAC_PAGE={page}");
        println!("cargo::rustc-cfg=has_page");
    }
}
