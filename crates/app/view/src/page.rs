//! The embedded page.

/// The page that this library was built with: the file that the environment variable `TWINTAC_PAGE`
/// named at build time, if it was set.
pub const PAGE: Option<&[u8]> = page();

#[cfg(has_page)]
const fn page() -> Option<&'static [u8]> {
    Some(include_bytes!(env!("TWINTAC_PAGE")))
}

#[cfg(not(has_page))]
const fn page() -> Option<&'static [u8]> {
    None
}
