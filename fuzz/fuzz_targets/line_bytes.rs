#![no_main]

twintac_fuzz_harness::fuzz!("line_bytes");
