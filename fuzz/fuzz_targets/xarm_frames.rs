#![no_main]

twintac_fuzz_harness::fuzz!("xarm_frames");
