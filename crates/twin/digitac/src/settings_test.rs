//! Settings at the ends of their ranges and beyond, and presses that cannot be evaluated.

use std::collections::BTreeSet;
use std::ops::ControlFlow;

use twintac_config::Checked;
use twintac_depth_table::DepthTableSource;

use crate::pipeline_test::{make, settings, train_quietly, unknown_tip};
use crate::synthetic::{Formula, Truth};
use crate::*;

/// With settings at the ends of their ranges, and with zeros that disable something, a test setup
/// is fitted and a twin is trained all the same.
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
    let training_presses = &made.split.train;
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
            training_presses,
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
fn a_variant_without_a_validation_press_in_contact_is_not_chosen() {
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
