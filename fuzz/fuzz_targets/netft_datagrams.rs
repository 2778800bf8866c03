#![no_main]

twintac_fuzz_harness::fuzz!("netft_datagrams");
