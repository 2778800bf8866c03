#![no_main]

twintac_fuzz_harness::fuzz!("log_file");
