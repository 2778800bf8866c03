//! From a recording to a twin, tested with formulas whose true values are known.

use std::collections::BTreeSet;
use std::ops::ControlFlow;

use twintac_depth_table::DepthTableSource;

use crate::synthetic::{Formula, Truth};
use crate::*;

pub(crate) struct Made {
    pub(crate) recording: twintac_recording::Recording,
    pub(crate) bench: BenchEstimate,
    pub(crate) presses: Vec<PairedPress>,
    pub(crate) split: Split,
    pub(crate) scale: Scale,
}

pub(crate) fn make(truth: &Truth, n_places: usize) -> Made {
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

pub(crate) fn unknown_tip() -> BenchSettings {
    BenchSettings {
        tip_radii_mm: Some(BenchSettings::UNKNOWN_TIP_RADII_MM.to_vec()),
        ..BenchSettings::default()
    }
}

pub(crate) fn settings(variants: &[Variant], epochs: usize) -> TrainSettings {
    TrainSettings {
        variants: Some(variants.to_vec()),
        epochs,
        ..TrainSettings::default()
    }
}

pub(crate) fn train_quietly(made: &Made, settings: &TrainSettings) -> Vec<Trained> {
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
    // Barometers that saturate, and physics without a nonlinearity.
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
    // At ten times the load, the correction stays within its limit.
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
        // The limit of the correction, with the largest possible effect of the relaxation on it.
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
    // A small error of the radius shifts all heights alike.
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
    // The evaluation works all the same: no frame is in contact, and the figure is `None`.
    let pairs = pair(&other, &places, &tables, &made.bench, &PairSettings::default()).unwrap();
    let found = evaluate(&twin, &pairs, &[0, 1, 2], &made.scale, None)
        .twin
        .overall;
    assert_eq!(found.nearest_in_contact, Mean::default());
    // A contact height is not fitted to presses without contact either.
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

    // For the last taxel, one press beside the first taxel leaves the usual difference between the
    // chips of one gel: a fifth.
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
    // The tables have no derivatives with respect to the ports' locations, so presses carry no
    // information about them.
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
fn what_is_held_out_is_evaluated_by_twins_of_the_rest() {
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
            let found = evaluate_fold(&bench, fold).unwrap();
            let percent = found.twin.nearest_in_contact.percent.unwrap();
            assert!(
                percent > 0.0 && percent < limit,
                "by {by}, {}: {percent} %",
                fold.held_out
            );
            assert_eq!(found.kernel.is_none(), by == HeldOut::Taxel);
            // In a file without training presses, three presses are used for the contact height.
            let spent = if by == HeldOut::File { 3 } else { 0 };
            assert_eq!(found.n_presses, fold.split.test.len() - spent);
        }
    }
}
