//! Every argument is used or refused.

use clap::Parser;

use super::Arguments;

/// Whether a command line is accepted.
fn is_taken(line: &str) -> bool {
    Arguments::try_parse_from(["twintac"].into_iter().chain(line.split(' '))).is_ok()
}

/// clap does not check that an argument's required argument is present if a third argument excludes
/// that one. Without checks of our own the argument would be ignored.
#[test]
fn no_argument_is_ignored_beside_another() {
    for line in [
        "simulate --run r --settings s.toml",
        "simulate --run r --out o",
        "simulate --run r --seed 3",
        "simulate --run r --vtk",
        "simulate --run r --profile",
        "simulate --run r --json",
        "simulate --sensor s --protocol p --out o --json",
        "simulate --sensor s --protocol p --out o --profile",
        "simulate --run r --deadline-ms 15",
        "simulate --sensor s --protocol p --out o --deadline-ms 15",
        "simulate --sensor s --path p --deadline-ms 0",
        "simulate --sensor s --path p --vtk",
        "simulate --sensor s --path p --out o",
        "simulate --sensor s --path p --seed 3",
        "reproduce --quick --sensor s --recordings r.csv",
        "reproduce --json --sensor s --recordings r.csv",
        "reproduce --paper --sensor s",
        "mesh --check m.msh --out o",
        "mesh --sensor s --out o --unit m",
        "calibrate --sensor s --curves c --free mu --x-mm 3",
        "record --protocol p --bench b --scale 5 --faults f",
        "record --protocol p --bench b --altitude-m 5 --faults f",
        "record --protocol p --at-once --scale 5",
        "record --protocol p --lab --dry-run --faults f",
        "adapt --model m --out o --recordings r --curve 3",
        "adapt --model m --out o --recordings r --seeds 3",
        "predict --model m --path p --seed 3",
        "stream --lab --out o --frames 3",
        "stream --lab --out o --seconds 3",
        "stream --lab --out o --log l.mcap",
        "stream --lab --log l.txt",
        "export l.mcap --topic wrench=/w",
        "export l.mcap --ros r --topic wrench",
        "export l.mcap --ros r --out o",
    ] {
        assert!(!is_taken(line), "{line}");
    }
}

#[test]
fn what_goes_together_is_taken() {
    for line in [
        "simulate --run r",
        "simulate --sensor s --protocol p --out o --seed 3 --vtk --settings t",
        "simulate --sensor s --path p --json --profile --settings t --deadline-ms 15",
        "fast train --sensor s --out o --training-presses 9 --test-presses 1",
        "fast train --sensor s --out o --lessons 9 --exams 1",
        "reproduce --paper --quick --json --seed 3",
        "reproduce --sensor s --recordings r.csv --settings t --seed 3",
        "mesh --sensor s --out o",
        "calibrate --sensor s --csv a.csv --indenter ball --x-mm 3 --free mu",
        "record --protocol p --lab --faults f",
        "record --protocol p --lab --at-once",
        "adapt --model m --out o --recordings r --presses 3 --seed 2",
        "adapt --model m --out o --run r --curve 3,5 --seeds 2",
        "predict --model m --protocol p --seed 3",
        "predict --model m --path p",
        "stream --lab --out o",
        "stream --lab --format csv --frames 3 --seconds 2",
        "stream --lab --log l.mcap --frames 3 --seconds 2",
        "stream --lab --log l.mcap --format csv",
        "export l.mcap --ros r --topic wrench=/w --topic pose=/p",
        "dataset --out o --settings t",
    ] {
        assert!(is_taken(line), "{line}");
    }
}
