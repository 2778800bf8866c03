#![no_main]

twintac_fuzz_harness::fuzz!("bench_texts");
