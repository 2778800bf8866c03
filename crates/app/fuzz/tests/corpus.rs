//! Runs all checks on the seeds and on the corpus that fuzzing found, without a fuzzer.

#![allow(clippy::unwrap_used)]

use std::path::Path;

use twintac_fuzz::TARGETS;

#[test]
fn seeds_and_corpus_hold() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../fuzz");
    for target in TARGETS {
        for seed in (target.seeds)() {
            (target.run)(&seed);
        }
        let corpus = folder.join("corpus").join(target.name);
        let mut n_inputs = 0;
        for entry in std::fs::read_dir(&corpus).unwrap() {
            (target.run)(&std::fs::read(entry.unwrap().path()).unwrap());
            n_inputs += 1;
        }
        assert!(n_inputs > 0, "{} is empty", corpus.display());
        let harness = folder.join(format!("fuzz_targets/{}.rs", target.name));
        assert!(harness.exists(), "{} is missing", harness.display());
    }
}
