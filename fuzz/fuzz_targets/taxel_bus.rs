#![no_main]

twintac_fuzz_harness::fuzz!("taxel_bus");
