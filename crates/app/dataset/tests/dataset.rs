//! Tests of data sets: all divisions have the same rows, complete shards are not made again, no
//! shard is left half-written, and shards of different data sets are not mixed.

#![allow(clippy::unwrap_used)] // a test that cannot set itself up has failed

use std::fs;
use std::path::Path;

use twintac_dataset::{Dataset, DatasetPlan, FastSource, MadeShard, Shard, check_dataset, merge_dataset};
use twintac_recording::{Provenance, Recording};
use twintac_work::Silent;

/// Settings of the coarsest mesh that still works.
const COARSE: &str =
    "[simulate]\nedges_per_height = 2.0\nedges_per_contact_radius = 1.0\ndepth_step_mm = 0.5\n";

fn fast(n_presses: usize) -> DatasetPlan {
    DatasetPlan {
        n_presses: Some(n_presses),
        seed: 3,
        fast: Some(FastSource::BuiltIn),
        ..DatasetPlan::default()
    }
}

fn make(plan: &DatasetPlan, shard: &str, folder: &Path) -> Result<MadeShard, String> {
    let shard: Shard = shard.parse().unwrap();
    let made = Dataset::open(plan).and_then(|dataset| dataset.make(shard, folder, &Silent));
    made.map_err(|error| error.to_string())
}

/// The merged data set, after all shards of a division were made, the last one first.
fn merged(plan: &DatasetPlan, of: u32, n_threads: usize) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(n_threads)
        .build()
        .unwrap();
    pool.install(|| {
        for number in (1..=of).rev() {
            make(plan, &format!("{number}/{of}"), folder.path()).unwrap();
        }
    });
    let whole = merge_dataset(folder.path(), None, &Silent).unwrap();
    assert_eq!((whole.n_shards, whole.left_out.len()), (of, 0));
    fs::read(whole.merged.unwrap()).unwrap()
}

#[test]
fn all_divisions_and_numbers_of_threads_give_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let settings = folder.path().join("coarse.toml");
    fs::write(&settings, COARSE).unwrap();
    let solved = DatasetPlan {
        n_presses: Some(9),
        indenters: vec!["sphere-25".to_owned(), "cylinder".to_owned()],
        settings: Some(settings),
        ..DatasetPlan::default()
    };
    for plan in [solved, fast(30)] {
        let whole = merged(&plan, 1, 2);
        assert_eq!(whole, merged(&plan, 4, 1));
        assert_eq!(whole, merged(&plan, 9, 3));
        let another_seed = DatasetPlan { seed: 4, ..plan };
        assert_ne!(whole, merged(&another_seed, 2, 2));
    }
}

#[test]
fn a_shard_is_a_simulated_recording_of_every_indenter() {
    let folder = tempfile::tempdir().unwrap();
    let made = make(&fast(28), "2/2", folder.path()).unwrap();
    let recording = Recording::read_parquet(&made.parquet).unwrap();
    assert_eq!(recording.provenance, Provenance::Simulated);
    assert_eq!(recording.sensor, "phystac");
    let names: Vec<&String> = recording.presses.iter().map(|press| &press.name).collect();
    assert!(names.into_iter().eq(&made.manifest.presses));
    let mut indenters: Vec<&str> = recording
        .presses
        .iter()
        .map(|press| press.indenter.as_str())
        .collect();
    indenters.sort_unstable();
    indenters.dedup();
    assert_eq!(indenters.len(), 7);
    for press in &recording.presses {
        let largest = |numbers: &mut dyn Iterator<Item = f64>| numbers.fold(0.0, f64::max);
        let force_n = largest(&mut press.force_n.as_ref().unwrap().iter().copied());
        let reading_kpa = largest(&mut press.taxels_kpa.iter().flatten().copied());
        assert!(
            force_n > 0.05 && reading_kpa > 0.1,
            "{}: {force_n} N, {reading_kpa} kPa",
            press.name
        );
        assert!(press.valid.iter().flatten().all(|valid| *valid));
    }
    let fewer = tempfile::tempdir().unwrap();
    let fewer_made = make(&fast(7), "1/1", fewer.path()).unwrap();
    let first = Recording::read_parquet(&fewer_made.parquet).unwrap();
    make(&fast(28), "1/2", folder.path()).unwrap();
    merge_dataset(folder.path(), None, &Silent).unwrap();
    let all = Recording::read_parquet(&folder.path().join("presses.parquet")).unwrap();
    assert_eq!(
        first.presses,
        all.presses[..7],
        "more presses do not change the first ones"
    );
}

#[test]
fn what_is_complete_is_kept_and_what_was_altered_is_found_and_made_again() {
    let folder = tempfile::tempdir().unwrap();
    let first = make(&fast(8), "1/2", folder.path()).unwrap();
    assert!(!first.was_kept);
    assert!(make(&fast(8), "1/2", folder.path()).unwrap().was_kept);
    let text = check_dataset(folder.path(), &Silent).unwrap_err().to_string();
    assert!(text.contains("lacks 1 of 2 shards: 2/2"), "{text}");
    make(&fast(8), "2/2", folder.path()).unwrap();
    assert_eq!(check_dataset(folder.path(), &Silent).unwrap().n_presses, 8);

    let whole = fs::read(&first.parquet).unwrap();
    for altered in [&whole[..whole.len() / 2], &[&whole[..], b"x"].concat()] {
        fs::write(&first.parquet, altered).unwrap();
        let text = check_dataset(folder.path(), &Silent).unwrap_err().to_string();
        assert!(
            text.contains("altered or truncated") && text.contains("--shard 1/2"),
            "{text}"
        );
    }
    assert!(!make(&fast(8), "1/2", folder.path()).unwrap().was_kept);
    assert_eq!(fs::read(&first.parquet).unwrap(), whole);

    fs::write(&first.manifest_file, b"{").unwrap();
    let text = check_dataset(folder.path(), &Silent).unwrap_err().to_string();
    assert!(text.contains("not a complete manifest"), "{text}");
    assert!(!make(&fast(8), "1/2", folder.path()).unwrap().was_kept);
    fs::remove_file(&first.parquet).unwrap();
    let text = check_dataset(folder.path(), &Silent).unwrap_err().to_string();
    assert!(text.contains("is missing"), "{text}");
}

#[test]
fn nothing_is_mixed() {
    let folder = tempfile::tempdir().unwrap();
    make(&fast(8), "1/2", folder.path()).unwrap();
    let names = || {
        let mut names: Vec<_> = fs::read_dir(folder.path())
            .unwrap()
            .map(|entry| entry.unwrap().file_name())
            .collect();
        names.sort();
        names
    };
    let before = names();
    let text = make(&DatasetPlan { seed: 4, ..fast(8) }, "2/2", folder.path()).unwrap_err();
    assert!(text.contains("a data set of other settings"), "{text}");
    let text = make(&fast(9), "2/2", folder.path()).unwrap_err();
    assert!(text.contains("a data set of other settings"), "{text}");
    let text = make(&fast(8), "2/4", folder.path()).unwrap_err();
    assert!(text.contains("divided into 2 shards, not 4"), "{text}");
    let text = make(&fast(8), "2/9", folder.path()).unwrap_err();
    assert!(text.contains("at most 8 shards"), "{text}");
    assert_eq!(names(), before, "what is refused leaves nothing");
    let text = check_dataset(&folder.path().join("none"), &Silent)
        .unwrap_err()
        .to_string();
    assert!(text.contains("is not a data set"), "{text}");
    let other = tempfile::tempdir().unwrap();
    let plan = DatasetPlan { seed: 4, ..fast(8) };
    let stray = make(&plan, "2/2", other.path()).unwrap();
    for file in [&stray.parquet, &stray.manifest_file] {
        fs::copy(file, folder.path().join(file.file_name().unwrap())).unwrap();
    }
    let text = merge_dataset(folder.path(), None, &Silent)
        .unwrap_err()
        .to_string();
    assert!(text.contains("is of a data set of other settings"), "{text}");
    assert!(!folder.path().join("presses.parquet").exists());
}

#[test]
fn a_press_that_cannot_be_simulated_is_left_out_and_said() {
    let folder = tempfile::tempdir().unwrap();
    let part = |name: &str, x_mm: f64| {
        format!(
            "[[parts]]\nname = \"{name}\"\nsummary = \"\"\nindenters = [\"sphere-25\"]\n\
             places = {{ kind = \"random\", x_mm = [{x_mm}, {x_mm}], y_mm = [0.0, 0.0], count = 2 }}\n\
             depth_mm = 1.0\nspeed_mm_per_s = 4.0\nhold_s = 0.0\nclearance_mm = 0.3\n"
        )
    };
    let protocol = folder.path().join("protocol.toml");
    fs::write(
        &protocol,
        format!("summary = \"\"\n{}{}", part("on", 0.0), part("beside", 60.0)),
    )
    .unwrap();
    let plan = DatasetPlan {
        protocol: Some(protocol.clone()),
        fast: Some(FastSource::BuiltIn),
        ..DatasetPlan::default()
    };
    let made = make(&plan, "1/1", &folder.path().join("some")).unwrap();
    assert_eq!(made.manifest.presses, ["on-sphere-25#000", "on-sphere-25#001"]);
    let left_out: Vec<&str> = made
        .manifest
        .left_out
        .iter()
        .map(|left| left.press.as_str())
        .collect();
    assert_eq!(left_out, ["beside-sphere-25#000", "beside-sphere-25#001"]);
    assert!(
        made.manifest.left_out[0].why.contains("60"),
        "{:?}",
        made.manifest.left_out
    );
    fs::write(&protocol, format!("summary = \"\"\n{}", part("beside", 60.0))).unwrap();
    let text = make(&plan, "1/1", &folder.path().join("none")).unwrap_err();
    assert!(
        text.contains("none of the 2 presses of shard 1/1 can be simulated"),
        "{text}"
    );
}

#[test]
fn each_press_has_an_imperfect_sensor_of_its_own() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("variation.toml");
    fs::write(
        &file,
        "[variation]\noffset_deviation_kpa = 0.5\nheight_deviation_mm = 0.1\n",
    )
    .unwrap();
    let plan = DatasetPlan {
        variation: Some(file),
        ..fast(14)
    };
    assert_eq!(merged(&plan, 1, 2), merged(&plan, 5, 1));
    let made = make(&plan, "1/1", &folder.path().join("data")).unwrap();
    let recording = Recording::read_parquet(&made.parquet).unwrap();
    let zeros: Vec<f64> = recording
        .presses
        .iter()
        .map(|press| press.taxels_kpa[0][0])
        .collect();
    assert!(zeros.windows(2).all(|pair| pair[0] != pair[1]), "{zeros:?}");
    let text = make(&DatasetPlan { fast: None, ..plan }, "1/1", folder.path()).unwrap_err();
    assert!(text.contains("needs --fast"), "{text}");
}

#[test]
fn what_does_not_fit_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let error = |plan: DatasetPlan| make(&plan, "1/1", folder.path()).unwrap_err();
    let text = error(DatasetPlan {
        indenters: vec!["thumb".to_owned()],
        ..fast(1)
    });
    assert!(text.contains("`thumb`") && text.contains("sphere-25"), "{text}");
    assert!(error(fast(0)).contains("--presses is 0"));
    let strip = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../sensors/strip4-gel-d.toml");
    let text = error(DatasetPlan {
        sensor: Some(strip),
        ..fast(1)
    });
    assert!(text.contains("number of ports: 8, the sensor's 4"), "{text}");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn the_fast_gel_of_another_gel_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let of = |from: &str, to: &str| {
        let text = twintac_sensor::SensorFile::phystac().unwrap().text.clone();
        assert!(text.contains(from));
        let sensor = folder.path().join("mine.toml");
        fs::write(&sensor, text.replace(from, to)).unwrap();
        let plan = DatasetPlan {
            sensor: Some(sensor),
            ..fast(2)
        };
        Dataset::open(&plan).err().map(|error| error.to_string())
    };
    let stiff = of("shear_modulus_kpa = 15.2", "shear_modulus_kpa = 64.5").unwrap();
    assert!(
        stiff.contains("45.4 kPa") && stiff.contains("192.9 kPa"),
        "{stiff}"
    );
    let low = of("size_mm = [34.0, 18.0, 8.5]", "size_mm = [34.0, 18.0, 6.0]").unwrap();
    assert!(low.contains("8.5 mm high") && low.contains("6 mm high"), "{low}");
    assert_eq!(of("name = \"phystac\"", "name = \"mine\""), None);
}
