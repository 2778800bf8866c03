//! From a recording to a twin, against formulas whose truth is known.

use std::collections::BTreeSet;
use std::ops::ControlFlow;

use twintac_config::Checked;
use twintac_depth_table::DepthTableSource;

use crate::synthetic::{Formula, Truth};
use crate::*;

struct Made {
    recording: twintac_recording::Recording,
    bench: BenchEstimate,
    presses: Vec<PairedPress>,
    split: Split,
    scale: Scale,
}

fn make(truth: &Truth, n_places: usize) -> Made {
    let recording = truth.recording(n_places);
    let places = Places::of(&recording, &Formula, &PlaceSettings::default()).unwrap();
    let split = Split::new(&recording, &SplitSettings::default(), 1).unwrap();
    let bench = fit_bench(
        &recording,
        &places,
        &split.train,
        &Formula,
        &unknown_tip(),
        &Taxels::default(),
    )
    .unwrap();
    let radius_mm = bench.tip_radius_mm.unwrap().value;
    let places = places.with_tip_radius(Some(radius_mm));
    let tables = Formula.depth_tables(&places.requests).unwrap();
    let bench = refine_bench(
        &recording,
        &places,
        &tables,
        &split.train,
        &bench,
        &unknown_tip(),
        &Taxels::default(),
    )
    .unwrap();
    let presses = pair(&recording, &places, &tables, &bench, &PairSettings::default()).unwrap();
    let scale = Scale::of(&presses, BTreeSet::new());
    Made {
        recording,
        bench,
        presses,
        split,
        scale,
    }
}

fn unknown_tip() -> BenchSettings {
    BenchSettings {
        tip_radii_mm: Some(BenchSettings::UNKNOWN_TIP_RADII_MM.to_vec()),
        ..BenchSettings::default()
    }
}

fn settings(variants: &[Variant], epochs: usize) -> TrainSettings {
    TrainSettings {
        variants: Some(variants.to_vec()),
        epochs,
        ..TrainSettings::default()
    }
}

fn train_quietly(made: &Made, settings: &TrainSettings) -> Vec<Trained> {
    train_from(made, settings, 1)
}

fn train_from(made: &Made, settings: &TrainSettings, seed: u64) -> Vec<Trained> {
    train(
        &made.presses,
        &made.recording.taxels,
        &made.split,
        &made.scale,
        settings,
        seed,
        &mut |_| ControlFlow::Continue(()),
    )
    .unwrap()
}

#[test]
fn the_bench_and_the_gains_are_found_and_the_twin_predicts_unseen_places() {
    let truth = Truth {
        noise: 5e-4,
        ..Truth::new()
    };
    let made = make(&truth, 21);
    let radius = made.bench.tip_radius_mm.unwrap();
    assert!(
        (radius.value - truth.radius_mm).abs() < 0.01 * truth.radius_mm,
        "{:?}",
        made.bench
    );
    assert!(
        (radius.value - truth.radius_mm).abs() < 5.0 * radius.uncertainty + 0.01,
        "{radius:?}"
    );
    for (file, offset_mm) in truth.offsets_mm.iter().enumerate() {
        let found = made.bench.contact_offset_mm(&format!("file{file}"));
        assert!((found - offset_mm).abs() < 0.005, "{found}, expected {offset_mm}");
    }
    assert!(made.bench.doubts.is_empty(), "{:?}", made.bench.doubts);

    let trained = train_quietly(
        &made,
        &settings(&[Variant::Pressure, Variant::PressureMemory], 10),
    );
    let best = choose(&trained).unwrap();
    assert_eq!(best.twin.variant(), Variant::PressureMemory);
    for (found, expected) in best.twin.gains().gain.iter().zip(&truth.gains.gain) {
        assert!((found / expected - 1.0).abs() < 0.02, "{:?}", best.twin.gains());
    }
    let ports_mm = crate::synthetic::TAXELS_X_MM.map(|x| [x, 0.0]);
    let baselines = Baselines::fit(&made.presses, &made.split.train, &ports_mm, &BTreeSet::new()).unwrap();
    let evaluation = evaluate(
        &best.twin,
        &made.presses,
        &made.split.test,
        &made.scale,
        Some(&baselines),
    );
    let headline = |score: &Score| score.overall.nearest_in_contact.percent.unwrap();
    assert!(headline(&evaluation.twin) < 0.3, "{:?}", evaluation.twin);
    assert!(headline(evaluation.polynomial.as_ref().unwrap()) > 3.0 * headline(&evaluation.twin));
    assert!(headline(&evaluation.zero) > 20.0);
}

#[test]
fn a_correction_repairs_what_the_physics_lacks_and_stays_bounded() {
    let mut truth = Truth::new();
    truth.offsets_mm.truncate(1);
    let mut made = make(&truth, 21);
    // A barometer that saturates, and a physics that does not know it.
    for press in &mut made.presses {
        let readings = press.readings_kpa.iter_mut().flatten();
        readings.for_each(|r| *r -= 0.001 * *r * r.abs());
    }
    made.scale = Scale::of(&made.presses, BTreeSet::new());
    let settings = TrainSettings {
        port_law: false,
        ..settings(&[Variant::PressureMemory, Variant::PressureMemoryMlp], 400)
    };
    let trained = train_quietly(&made, &settings);
    let error = |t: &Trained| t.validation.overall.nearest_in_contact.percent.unwrap();
    assert!(
        error(&trained[1]) < 0.8 * error(&trained[0]),
        "{} {}",
        error(&trained[0]),
        error(&trained[1])
    );
    // Ten times the load: no worse than the bound allows.
    let mut features = made.presses[5].features.clone();
    features
        .pressure_kpa
        .iter_mut()
        .flatten()
        .for_each(|p| *p *= 10.0);
    let corrected = &trained[1].twin;
    let (physical, found) = (
        corrected.gains().readings_kpa(&[&features]).swap_remove(0),
        corrected.predict(&[&features]).swap_remove(0),
    );
    let size = |row: &Vec<f64>| row.iter().map(|p| p * p).sum::<f64>().sqrt();
    let largest = physical.iter().map(size).fold(0.0, f64::max);
    for (physical, found) in physical.iter().flatten().zip(found.iter().flatten()) {
        // The limit, and what the memory may make of it at most.
        assert!(
            (physical - found).abs() < 0.3 * 2.0 * largest,
            "{physical} {found}"
        );
    }
}

#[test]
fn a_seed_gives_the_same_bits_on_one_thread_and_on_two() {
    let mut truth = Truth::new();
    truth.offsets_mm.truncate(1);
    let made = make(&truth, 12);
    let settings = settings(&[Variant::PressureMemoryMlp, Variant::Paper], 4);
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| {
            let trained = train_quietly(&made, &settings);
            trained
                .iter()
                .map(|t| t.twin.parameters().weights())
                .collect::<Vec<_>>()
        })
    };
    let bits = |weights: &[crate::network::Weights]| -> Vec<u32> {
        weights
            .iter()
            .flat_map(|w| w.values().flat_map(|(_, data)| data.iter().map(|x| x.to_bits())))
            .collect()
    };
    let (one, two) = (run(1), run(2));
    assert_eq!(bits(&one), bits(&two));
    let other = train_from(&made, &settings, 2);
    assert_ne!(
        bits(&one)[..],
        bits(
            &other
                .iter()
                .map(|t| t.twin.parameters().weights())
                .collect::<Vec<_>>()
        )[..]
    );
}

#[test]
fn a_new_file_gives_three_presses_for_its_contact_height() {
    let mut truth = Truth::new();
    let made = make(&truth, 21);
    let twin = train_quietly(&made, &settings(&[Variant::PressureMemory], 5))
        .remove(0)
        .twin;
    let known_mm = made.bench.contact_offset_mm("file0");
    truth.offsets_mm = vec![truth.offsets_mm[0] + 0.07];
    let mut new = truth.recording(21);
    new.presses
        .iter_mut()
        .for_each(|press| press.mounting = "new".into());
    let places = Places::of(&new, &Formula, &PlaceSettings::default()).unwrap();
    let places = places.at_bench(&made.bench);
    let tables = Formula.depth_tables(&places.requests).unwrap();
    let found = recalibrate(
        &new,
        (&places, &tables),
        &made.bench,
        &twin,
        "new",
        0.25,
        &BTreeSet::new(),
    )
    .unwrap()
    .unwrap();
    // A radius that is a little off shifts all heights alike.
    assert!(
        (found.contact_offset_mm.value - known_mm - 0.07).abs() < 0.01,
        "{found:?}"
    );
    // The first presses are away from all taxels.
    assert_eq!(found.used, [6, 7, 8]);
    assert!(
        recalibrate(
            &new,
            (&places, &tables),
            &made.bench,
            &twin,
            "none",
            0.25,
            &BTreeSet::new()
        )
        .unwrap()
        .is_none()
    );
}

#[test]
fn a_model_survives_its_folder_and_notices_damage() {
    let mut truth = Truth::new();
    truth.offsets_mm.truncate(1);
    let made = make(&truth, 12);
    let settings = settings(&[Variant::PressureMemoryMlp], 3);
    let trained = train_quietly(&made, &settings).remove(0);
    let origin = Origin {
        sensor: "name = \"formula\"".into(),
        simulation: serde_json::json!({"edge_mm": 1.0}),
        bench: made.bench.clone(),
        settings: TrainedWith { settings, seed: 1 },
        provenance: made.recording.provenance,
        files: vec!["file0".into()],
        taught_by: BTreeSet::new(),
        split: made.split.clone(),
        certainty: None,
    };
    let model = Model::new(trained.twin, origin, trained.validation, None);
    let parent = tempfile::tempdir().unwrap();
    let folder = parent.path().join("twin");
    model.save(&folder).unwrap();
    model.save(&folder).unwrap();
    let again = Model::load(&folder).unwrap();
    assert_eq!(again.record, model.record);
    for press in &made.presses {
        assert_eq!(
            again.twin.predict(&[&press.features]),
            model.twin.predict(&[&press.features])
        );
    }
    let card = std::fs::read_to_string(folder.join("CARD.md")).unwrap();
    let percent = model
        .record
        .validation
        .overall
        .nearest_in_contact
        .percent
        .unwrap();
    for part in [&model.record.variant.to_string(), &format!("| {percent:.2} |")] {
        assert!(card.contains(part), "{card}");
    }
    let message = |folder: &std::path::Path| Model::load(folder).unwrap_err().to_string();
    for name in ["weights.safetensors", "twin.json", "checksums.json"] {
        let path = folder.join(name);
        let whole = std::fs::read(&path).unwrap();
        let mut flipped = whole.clone();
        let middle = flipped.len() / 2;
        flipped[middle] ^= 4;
        std::fs::write(&path, flipped).unwrap();
        assert!(Model::load(&folder).is_err(), "{name}");
        std::fs::remove_file(&path).unwrap();
        assert!(
            message(&folder).contains(name) && message(&folder).contains("missing"),
            "{}",
            message(&folder)
        );
        std::fs::write(&path, whole).unwrap();
    }
    let path = folder.join("checksums.json");
    let text = std::fs::read_to_string(&path).unwrap();
    std::fs::write(&path, text.replace("\"version\": 1", "\"version\": 7")).unwrap();
    assert!(message(&folder).contains("version 7"), "{}", message(&folder));
}

/// Writes one number or list of a model's record anew, and its checksum.
fn change_record(folder: &std::path::Path, pointer: &str, value: serde_json::Value) {
    let read = |name: &str| -> serde_json::Value {
        serde_json::from_slice(&std::fs::read(folder.join(name)).unwrap()).unwrap()
    };
    let mut record = read("twin.json");
    *record.pointer_mut(pointer).expect(pointer) = value;
    std::fs::write(folder.join("twin.json"), record.to_string()).unwrap();
    say_checksums(folder);
}

/// Writes checksums of a model's files as they are.
fn say_checksums(folder: &std::path::Path) {
    use sha2::{Digest, Sha256};
    let path = folder.join("checksums.json");
    let mut checksums: serde_json::Value = serde_json::from_slice(&std::fs::read(&path).unwrap()).unwrap();
    for (name, sum) in checksums["sha256"].as_object_mut().unwrap() {
        let digest = Sha256::digest(std::fs::read(folder.join(name)).unwrap());
        *sum = digest
            .iter()
            .map(|byte| format!("{byte:02x}"))
            .collect::<String>()
            .into();
    }
    std::fs::write(path, checksums.to_string()).unwrap();
}

/// A trained model in a folder.
fn saved(folder: &std::path::Path) -> Model {
    let mut truth = Truth::new();
    truth.offsets_mm.truncate(1);
    let mut made = make(&truth, 12);
    made.bench.ports = vec![PortEstimate::default(); 4];
    let settings = settings(&[Variant::PressureMemoryMlp], 1);
    let trained = train_quietly(&made, &settings).remove(0);
    let origin = Origin {
        sensor: "name = \"formula\"".into(),
        simulation: serde_json::json!({}),
        bench: made.bench.clone(),
        settings: TrainedWith { settings, seed: 1 },
        provenance: made.recording.provenance,
        files: vec!["file0".into()],
        taught_by: BTreeSet::new(),
        split: made.split.clone(),
        certainty: None,
    };
    let model = Model::new(trained.twin, origin, trained.validation, None);
    model.save(folder).unwrap();
    model
}

#[test]
fn a_model_that_cannot_be_is_refused_with_its_file_and_field() {
    use serde_json::json;
    let parent = tempfile::tempdir().unwrap();
    let good = parent.path().join("good");
    saved(&good);
    for (pointer, value, field) in [
        (
            "/start/gains/time_constants_s/0",
            json!(0.0),
            "start.gains.time_constants_s[0]` is 0",
        ),
        (
            "/start/gains/time_constants_s/1",
            json!(-4.0),
            "start.gains.time_constants_s[1]` is -4",
        ),
        (
            "/start/gains/gain/2",
            json!(1e300),
            "start.gains.gain[2]` is 1e300",
        ),
        (
            "/start/gains/memory/3",
            json!([0.1]),
            "start.gains.memory[3]` has 1 entries",
        ),
        (
            "/start/normalization/reading_kpa",
            json!(0.0),
            "start.normalization.reading_kpa` is 0",
        ),
        (
            "/start/normalization/pressure_rms_kpa/1",
            json!(0.0),
            "pressure_rms_kpa[1]` is 0",
        ),
        (
            "/start/hidden",
            json!([1_000_000_000, 1_000_000_000]),
            "start.hidden[0]` is 1e9",
        ),
        (
            "/start/correction_limit",
            json!(1e9),
            "start.correction_limit` is 1e9",
        ),
        (
            "/taxels",
            json!(["S0", "S1", "S2"]),
            "start.gains.gain` has 4 entries; one for each of 3 taxels",
        ),
        ("/taxels", json!([]), "taxels` names 0 taxels"),
        (
            "/bench/ports",
            json!([{"shift_mm": [0.0, 0.0], "wider_mm": 0.0}]),
            "bench.ports` has 1 entries",
        ),
        (
            "/bench/contact_offset_elsewhere_mm",
            json!(1e300),
            "bench.contact_offset_elsewhere_mm` is 1e300",
        ),
        (
            "/bench/gains/gain",
            json!([1.0]),
            "bench.gains.gain` has 1 entries",
        ),
    ] {
        let folder = parent.path().join("bad");
        Model::load(&good).unwrap().save(&folder).unwrap();
        change_record(&folder, pointer, value);
        let error = Model::load(&folder).unwrap_err().to_string();
        assert!(
            error.contains("twin.json") && error.contains(field),
            "{pointer}: {error}"
        );
    }
}

#[test]
fn weights_that_cannot_be_are_refused_with_their_place() {
    use safetensors::{Dtype, tensor::TensorView};
    let parent = tempfile::tempdir().unwrap();
    let folder = parent.path().join("twin");
    let model = saved(&folder);
    for (name, wrong) in [
        ("layer0.weight", f32::NAN),
        ("layer1.bias", f32::INFINITY),
        ("memory_change", 1e30),
        ("gain_change", 1e3),
    ] {
        let mut weights = model.twin.parameters().weights();
        weights.get_mut(name).unwrap().1[1] = wrong;
        let bytes: Vec<_> = weights
            .iter()
            .map(|(name, (shape, data))| {
                let bytes: Vec<u8> = data.iter().flat_map(|number| number.to_le_bytes()).collect();
                (name, shape, bytes)
            })
            .collect();
        let views = bytes.iter().map(|(name, shape, data)| {
            (
                *name,
                TensorView::new(Dtype::F32, (*shape).clone(), data).unwrap(),
            )
        });
        let packed = safetensors::serialize(views, None).unwrap();
        std::fs::write(folder.join("weights.safetensors"), packed).unwrap();
        say_checksums(&folder);
        let error = Model::load(&folder).unwrap_err().to_string();
        let place = format!("`{name}[1]`");
        assert!(
            error.contains("weights.safetensors") && error.contains(&place),
            "{error}"
        );
    }
}

#[test]
fn a_model_of_before_the_seed_stood_beside_the_settings_is_read() {
    let text = r#"{"variants": ["pressure"], "seed": 7, "epochs": 3}"#;
    let read: TrainedWith = serde_json::from_str(text).unwrap();
    assert_eq!((read.seed, read.settings.epochs), (7, 3));
    assert_eq!(read.settings.variants, Some(vec![Variant::Pressure]));
    let again: TrainedWith = serde_json::from_str(&serde_json::to_string(&read).unwrap()).unwrap();
    assert_eq!(again, read);
}

#[test]
fn a_gel_that_no_press_touches_is_not_adapted_to() {
    let truth = Truth::new();
    let made = make(&truth, 21);
    let twin = train_quietly(&made, &settings(&[Variant::PressureMemory], 1))
        .remove(0)
        .twin;
    let mut other = truth.recording(21);
    let places = Places::of(&other, &Formula, &PlaceSettings::default()).unwrap();
    let places = places.at_bench(&made.bench);
    let tables = Formula.depth_tables(&places.requests).unwrap();
    for press in &mut other.presses {
        for pose in &mut press.gel_from_indenter {
            pose.position_mm.z += 5.0;
        }
    }
    let nothing = BTreeSet::new();
    let sensor = NewSensor {
        recording: &other,
        places: &places,
        tables: &tables,
        twin: &twin,
        bench: &made.bench,
        left_out: &nothing,
    };
    let refused = |error: DigitacError| {
        let text = error.to_string();
        assert!(
            text.contains("presses that touch the gel") && text.contains("mm above it"),
            "{text}"
        );
    };
    refused(choose_presses(&sensor, &[1, 2, 3], 2, 1).unwrap_err());
    refused(adapt(&sensor, &[2, 7, 12]).unwrap_err());
    // Judged all the same: no frame is in contact, and no figure is said.
    let pairs = pair(&other, &places, &tables, &made.bench, &PairSettings::default()).unwrap();
    let found = evaluate(&twin, &pairs, &[0, 1, 2], &made.scale, None)
        .twin
        .overall;
    assert_eq!(found.nearest_in_contact, Mean::default());
    // Nor is a contact height fitted to what nobody feels.
    let height = recalibrate(
        &other,
        (&places, &tables),
        &made.bench,
        &twin,
        "file0",
        0.25,
        &nothing,
    );
    assert_eq!(height.unwrap(), None);
}

#[test]
fn a_variant_that_no_validation_press_in_contact_judges_is_not_chosen() {
    let made = make(&Truth::new(), 12);
    let variants = [Variant::Pressure, Variant::PressureMemory];
    let mut trained = train_quietly(&made, &settings(&variants, 1));
    assert!(choose(&trained).is_ok());
    trained[0].validation.overall = Errors::default();
    assert_eq!(choose(&trained).unwrap().twin.variant(), Variant::PressureMemory);
    trained[1].validation.overall = Errors::default();
    let error = choose(&trained).unwrap_err().to_string();
    assert!(error.contains("validation presses in contact"), "{error}");
    assert!(choose(&[]).is_err());
}

/// The ends of ranges, and the zeros that switch something off: a bench is fitted all the same, and a twin trained.
#[test]
fn the_ends_of_ranges_are_settings_like_others() {
    let mut truth = Truth::new();
    truth.offsets_mm.truncate(1);
    let made = make(&truth, 8);
    let places = Places::of(&made.recording, &Formula, &PlaceSettings::default()).unwrap();
    let places = places.with_tip_radius(Some(2.7));
    let tables = Formula.depth_tables(&places.requests).unwrap();
    let taxels = Taxels {
        ports_mm: crate::synthetic::TAXELS_X_MM.map(|x| [x, 0.0]).to_vec(),
        left_out: BTreeSet::new(),
    };
    let teachers = &made.split.train;
    let benches: [fn(&mut BenchSettings); 9] = [
        |settings| settings.contact_offset_limit_mm = 0.0,
        |settings| settings.contact_offset_limit_mm = 5.0,
        |settings| settings.port_shift_limit_mm = 0.0,
        |settings| (settings.port_shift_limit_mm, settings.port_radius_limit_mm) = (5.0, 5.0),
        |settings| (settings.port_shift_pull, settings.smooth_factor_pull) = (0.0, 0.0),
        |settings| (settings.port_shift_pull, settings.smooth_factor_pull) = (1e6, 1e6),
        |settings| settings.port_radius_limit_mm = 0.0,
        |settings| settings.time_constants_s = vec![1e-3, 1e4],
        |settings| settings.time_constants_s.clear(),
    ];
    for change in benches {
        let mut settings = BenchSettings {
            n_blocks: 2,
            ..BenchSettings::default()
        };
        change(&mut settings);
        settings.checked().unwrap();
        let nominal = BenchEstimate::nominal();
        let found = refine_bench(
            &made.recording,
            &places,
            &tables,
            teachers,
            &nominal,
            &settings,
            &taxels,
        )
        .unwrap();
        assert!(found.deviation_percent.is_finite(), "{settings:?}");
        assert!(found.contact_offset_mm("file0").abs() <= settings.contact_offset_limit_mm);
    }
    let warps: [fn(&mut WarpSettings); 6] = [
        |warp| warp.window_s = 0.0,
        |warp| warp.window_s = 10.0,
        |warp| warp.step_cost = 0.0,
        |warp| warp.smoothing_s = 0.0,
        |warp| warp.smoothing_s = 10.0,
        |warp| warp.believed_below = 0.0,
    ];
    for change in warps {
        let mut settings = PairSettings::default();
        change(&mut settings.warp);
        settings.checked().unwrap();
        let pairs = pair(&made.recording, &places, &tables, &made.bench, &settings).unwrap();
        let warped = pairs.iter().flat_map(|pair| &pair.warp.measured_index);
        assert!(warped.clone().all(|index| index.is_finite()), "{settings:?}");
    }
    let trainings: [fn(&mut TrainSettings); 6] = [
        |settings| (settings.weight_decay, settings.correction_noise) = (0.0, 0.0),
        |settings| settings.correction_limit = 0.0,
        |settings| settings.correction_hidden.clear(),
        |settings| settings.correction_hidden = vec![1; 8],
        |settings| (settings.batch_frames, settings.max_frames) = (1, 2),
        |settings| settings.learning_rate = 1e-6,
    ];
    for change in trainings {
        let mut settings = settings(&[Variant::PressureMemoryMlp], 2);
        change(&mut settings);
        let trained = train_quietly(&made, &settings);
        let percent = trained[0].validation.overall.all.percent;
        assert!(percent.is_some_and(f64::is_finite), "{settings:?}");
    }
}

#[test]
fn settings_that_cannot_be_are_refused_before_anything_is_fitted() {
    let made = make(&Truth::new(), 12);
    let places = Places::of(&made.recording, &Formula, &PlaceSettings::default()).unwrap();
    let bench = |settings: BenchSettings| {
        let taxels = Taxels::default();
        let found = fit_bench(
            &made.recording,
            &places,
            &made.split.train,
            &Formula,
            &settings,
            &taxels,
        );
        found.unwrap_err().to_string()
    };
    let error = bench(BenchSettings {
        contact_offset_limit_mm: 1e300,
        ..unknown_tip()
    });
    assert_eq!(
        error,
        "setting `contact_offset_limit_mm` is 1e300; give 0, or 0.001 to 5"
    );
    let error = bench(BenchSettings {
        tip_radii_mm: Some(vec![0.001, 900.0]),
        ..BenchSettings::default()
    });
    assert_eq!(error, "setting `tip_radii_mm[0]` is 0.001; give 0.1 to 100");
    let settings = TrainSettings {
        correction_hidden: vec![1_000_000_000; 2],
        ..settings(&[Variant::PressureMlp], 1)
    };
    let trained = train(
        &made.presses,
        &made.recording.taxels,
        &made.split,
        &made.scale,
        &settings,
        1,
        &mut |_| ControlFlow::Continue(()),
    );
    let error = trained.unwrap_err().to_string();
    assert_eq!(error, "setting `correction_hidden[0]` is 1e9; give 1 to 1024");
}

#[test]
fn a_twin_can_be_shared_between_threads() {
    fn shared<T: Send + Sync>() {}
    shared::<Twin>();
    shared::<Model>();
}

#[test]
fn another_sensor_is_met_with_its_gains_and_its_height() {
    let mut truth = Truth::new();
    truth.gains.gain = vec![0.8; 4];
    let made = make(&truth, 21);
    let twin = train_quietly(&made, &settings(&[Variant::PressureMemory], 1))
        .remove(0)
        .twin;
    let factors = [1.2, 0.9, 1.1, 0.8];
    let gains = truth.gains.gain.iter_mut().zip(factors);
    gains.for_each(|(gain, factor)| *gain *= factor);
    let center_mm = made.bench.contact_offset_elsewhere_mm;
    let moved_mm = truth.offsets_mm.iter().sum::<f64>() / 2.0 + 0.06;
    truth.offsets_mm = vec![moved_mm];
    let other = truth.recording(21);
    let places = Places::of(&other, &Formula, &PlaceSettings::default()).unwrap();
    let places = places.at_bench(&made.bench);
    let tables = Formula.depth_tables(&places.requests).unwrap();
    let sensor = NewSensor {
        recording: &other,
        places: &places,
        tables: &tables,
        twin: &twin,
        bench: &made.bench,
        left_out: &BTreeSet::new(),
    };
    let adapted = |used: &[usize]| adapt(&sensor, used).unwrap();
    let used = [2, 7, 12, 16, 19];
    let found = adapted(&used);
    let height = found.adaptation.contact_offset_mm["file0"];
    assert!((height.value - center_mm - 0.06).abs() < 0.03, "{height:?}");
    let learned = &twin.gains().gain;
    for ((found, factor), learned) in found.adaptation.gain.iter().zip(factors).zip(learned) {
        let factor_found = found.value / learned;
        assert!(
            (factor_found / factor - 1.0).abs() < 0.05,
            "{factor_found}, truly {factor}"
        );
    }
    let pairs = pair(&other, &places, &tables, &found.bench, &PairSettings::default()).unwrap();
    let rest: Vec<usize> = (0..21).filter(|press| !used.contains(press)).collect();
    let error = |twin: &Twin| {
        let errors = evaluate(twin, &pairs, &rest, &made.scale, None).twin.overall;
        errors.nearest_in_contact.percent.unwrap()
    };
    assert!(error(&found.twin) < 1.0 && error(&twin) > 5.0);

    // One press beside the first taxel tells of the last one no more than chips of one gel differ: by a fifth.
    let by_one = adapted(&[1]);
    let relative = |adapted: &Adapted, taxel: usize| {
        adapted.adaptation.gain[taxel].uncertainty / adapted.adaptation.gain[taxel].value
    };
    assert!(relative(&by_one, 0) < 0.15, "{:?}", by_one.adaptation.gain);
    assert!(relative(&by_one, 3) > 0.2, "{:?}", by_one.adaptation.gain);
    assert!(relative(&found, 3) < 0.15, "{:?}", found.adaptation.gain);
    let moved = by_one.adaptation.gain[3].value / learned[3];
    let by_first = by_one.adaptation.gain[0].value / learned[0];
    assert!((moved / by_first - 1.0).abs() < 0.2, "{moved} and {by_first}");
    let constant_s = by_one.adaptation.time_constants_s[1].value / twin.gains().time_constants_s[1];
    assert!((constant_s - 1.0).abs() < 0.3, "{constant_s}");
}

#[test]
fn a_port_beside_its_description_is_not_carried_over_to_another_sensor() {
    let truth = Truth::new();
    let mut made = make(&truth, 21);
    let twin = train_quietly(&made, &settings(&[Variant::PressureMemory], 1))
        .remove(0)
        .twin;
    // The tables have no slopes by the ports' places: presses say nothing of them.
    let shifted = PortEstimate {
        shift_mm: [0.3, 0.0],
        wider_mm: 0.0,
    };
    made.bench.ports = vec![shifted; 4];
    let other = truth.recording(21);
    let places = Places::of(&other, &Formula, &PlaceSettings::default()).unwrap();
    let places = places.at_bench(&made.bench);
    let tables = Formula.depth_tables(&places.requests).unwrap();
    let sensor = NewSensor {
        recording: &other,
        places: &places,
        tables: &tables,
        twin: &twin,
        bench: &made.bench,
        left_out: &BTreeSet::new(),
    };
    let found = adapt(&sensor, &[2, 7, 12, 16, 19]).unwrap();
    assert_eq!(found.bench.ports.len(), 4);
    let mut shifts_mm = found.bench.ports.iter().map(|port| port.shift_mm[0]);
    assert!(
        shifts_mm.all(|shift_mm| shift_mm.abs() < 1e-6),
        "{:?}",
        found.bench.ports
    );
}

#[test]
fn presses_to_adapt_with_are_spread_over_files_and_taxels() {
    let truth = Truth::new();
    let made = make(&truth, 21);
    let twin = train_quietly(&made, &settings(&[Variant::PressureMemory], 1))
        .remove(0)
        .twin;
    let other = truth.recording(21);
    let places = Places::of(&other, &Formula, &PlaceSettings::default()).unwrap();
    let places = places.at_bench(&made.bench);
    let tables = Formula.depth_tables(&places.requests).unwrap();
    let all: Vec<usize> = (0..other.presses.len()).collect();
    let sensor = NewSensor {
        recording: &other,
        places: &places,
        tables: &tables,
        twin: &twin,
        bench: &made.bench,
        left_out: &BTreeSet::new(),
    };
    let choose = |n_presses, seed| choose_presses(&sensor, &all, n_presses, seed).unwrap();
    let chosen = choose(5, 1);
    let files: BTreeSet<&str> = chosen
        .iter()
        .map(|&press| &other.presses[press].mounting[..])
        .collect();
    assert_eq!((chosen.len(), files.len()), (5, 2));
    let x_mm = |press: usize| other.presses[press].gel_from_indenter[0].position_mm.x;
    let spread_mm = |side: f64| {
        chosen
            .iter()
            .map(|&press| side * x_mm(press))
            .fold(f64::NEG_INFINITY, f64::max)
    };
    assert!(spread_mm(1.0) + spread_mm(-1.0) > 8.0, "{chosen:?}");
    assert_eq!(chosen, choose(5, 1));
    assert_ne!(choose(20, 1), choose(20, 2));
    assert_eq!(choose(1000, 1).len(), all.len());
}

#[test]
fn what_is_held_out_is_judged_by_what_teaches() {
    let mut truth = Truth::new();
    truth.gains.memory = vec![vec![0.2, 0.1]; 4];
    let recording = truth.recording(21);
    let places = Places::of(&recording, &Formula, &PlaceSettings::default()).unwrap();
    let bench_settings = BenchSettings {
        smooth_factor: false,
        ..unknown_tip()
    };
    let tables: Vec<_> = BenchSettings::UNKNOWN_TIP_RADII_MM
        .iter()
        .map(|radius_mm| {
            let requests = places.clone().with_tip_radius(Some(*radius_mm)).requests;
            Formula.depth_tables(&requests).unwrap()
        })
        .collect();
    let taxels = Taxels {
        ports_mm: crate::synthetic::TAXELS_X_MM.map(|x| [x, 0.0]).to_vec(),
        left_out: BTreeSet::new(),
    };
    let contacts = Contact::of_places(&places, &Formula).unwrap();
    let bench = Bench {
        contacts: &contacts,
        intervals_block_mm: None,
        recording: &recording,
        places: &places,
        tables: &tables,
        bench: &bench_settings,
        pair: &PairSettings::default(),
        train: &settings(&[Variant::PressureMemory], 1),
        seed: 1,
        taxels: &taxels,
    };
    for (by, n_folds, limit) in [
        (HeldOut::Place, 1, 1.0),
        (HeldOut::File, 2, 2.0),
        (HeldOut::Taxel, 4, 3.0),
    ] {
        let folds = Fold::all(&recording, by, (&SplitSettings::default(), 1), &BTreeSet::new()).unwrap();
        assert_eq!(folds.len(), n_folds);
        for fold in &folds {
            let found = judge(&bench, fold).unwrap();
            let percent = found.twin.nearest_in_contact.percent.unwrap();
            assert!(
                percent > 0.0 && percent < limit,
                "by {by}, {}: {percent} %",
                fold.held_out
            );
            assert_eq!(found.kernel.is_none(), by == HeldOut::Taxel);
            // Of a file of which nothing teaches, three presses give the height.
            let spent = if by == HeldOut::File { 3 } else { 0 };
            assert_eq!(found.n_presses, fold.split.test.len() - spent);
        }
    }
}
