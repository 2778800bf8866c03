//! Uncertainty of a twin, tested on a gel of formulas.

use std::collections::BTreeSet;
use std::ops::ControlFlow;

use twintac_depth_table::{DepthTable, DepthTableSource};
use twintac_protocol::PressPlan;
use twintac_recording::Recording;
use twintac_shape::{Shape, Surfaces, Underside};

use super::*;
use crate::synthetic::{Formula, Truth};
use crate::{
    BenchEstimate, BenchSettings, PairSettings, PairedPress, PlaceSettings, Places, Scale, Split,
    SplitSettings, Taxels, TrainSettings, Twin, Variant, pair, predict, refine_bench, train,
};

/// A twin of the formulas, and everything that it was made of.
struct Made {
    recording: Recording,
    places: Places,
    tables: Vec<DepthTable>,
    contacts: Vec<Contact>,
    settings: BenchSettings,
    bench: BenchEstimate,
    presses: Vec<PairedPress>,
    split: Split,
    scale: Scale,
    train: TrainSettings,
    twin: Twin,
}

fn make(truth: &Truth, n_places: usize) -> Made {
    let recording = truth.recording(n_places);
    let places = Places::of(&recording, &Formula, &PlaceSettings::default()).unwrap();
    let places = places.with_tip_radius(Some(truth.radius_mm));
    let tables = Formula.depth_tables(&places.requests).unwrap();
    let split = Split::new(&recording, &SplitSettings::default(), 1).unwrap();
    let settings = BenchSettings::default();
    let training_presses = [&split.train[..], &split.validation].concat();
    let nominal = BenchEstimate::nominal();
    let taxels = Taxels::default();
    let bench = refine_bench(
        &recording,
        &places,
        &tables,
        &training_presses,
        &nominal,
        &settings,
        &taxels,
    )
    .unwrap();
    let presses = pair(&recording, &places, &tables, &bench, &PairSettings::default()).unwrap();
    let scale = Scale::of(&presses, BTreeSet::new());
    let train_settings = TrainSettings {
        variants: Some(vec![Variant::PressureMemory]),
        ..TrainSettings::default()
    };
    let trained = train(
        &presses,
        &recording.taxels,
        &split,
        &scale,
        &train_settings,
        1,
        &mut |_| ControlFlow::Continue(()),
    );
    Made {
        contacts: Contact::of_places(&places, &Formula).unwrap(),
        twin: trained.unwrap().remove(0).twin,
        recording,
        places,
        tables,
        settings,
        bench,
        presses,
        split,
        scale,
        train: train_settings,
    }
}

impl Made {
    fn certainty(&self) -> Certainty {
        let data = TrainingData {
            recording: &self.recording,
            presses: &self.presses,
            places: &self.places,
            tables: &self.tables,
            contacts: &self.contacts,
            bench: &self.bench,
            bench_settings: &self.settings,
            taxels: &Taxels::default(),
            train: &self.train,
            seed: 1,
            block_mm: 0.1,
            scale: &self.scale,
        };
        calibrate(&data, &self.split, self.twin.variant())
            .unwrap()
            .unwrap()
    }
}

#[test]
fn intervals_cover_what_they_promise_on_presses_that_nothing_was_trained_on() {
    let made = make(&Truth::new(), 33);
    let certainty = made.certainty();
    let text = serde_json::to_string(&certainty).unwrap();
    let former = text.replace("\"training_set\"", "\"taught\"");
    assert_ne!(former, text);
    assert_eq!(serde_json::from_str::<Certainty>(&former).unwrap(), certainty);

    let chosen = &made.split.test;
    let places = (&made.places, &made.contacts[..]);
    let found = score_certainty(
        (&made.twin, &certainty),
        &made.presses,
        places,
        chosen,
        &made.scale,
    );
    assert!(
        found.n_in_contact > 1000 && found.n_readings > found.n_in_contact,
        "{found:?}"
    );
    for covered in [found.covered_percent, found.covered_in_contact_percent].map(Option::unwrap) {
        assert!((87.0..=93.0).contains(&covered), "{found:?}");
    }
    // With noise alone, 90 % of the readings are within 1.645 standard deviations; one is 0.3 % of
    // 130 kPa.
    let largest_kpa = made.scale.largest_kpa.values().copied().fold(0.0, f64::max);
    let of_noise = 200.0 * 1.645 * 0.003 * 130.0 / largest_kpa;
    let width_percent = found.mean_width_percent.unwrap();
    assert!(width_percent > 0.9 * of_noise, "{found:?}");
    assert!(width_percent < 3.0 * of_noise, "{found:?}");
    assert!(found.flagged_percent.unwrap() < 10.0, "{found:?}");
    let none = score_certainty((&made.twin, &certainty), &made.presses, places, &[], &made.scale);
    assert_eq!(none, CertaintyScore::default());
    assert_eq!(none.covered_percent, None);
    assert_eq!(certainty, made.certainty());
}

#[test]
fn where_nobody_has_pressed_intervals_are_wider_and_contacts_are_flagged() {
    let made = make(&Truth::new(), 17);
    let certainty = made.certainty();
    let known = made.contacts[made.places.of_press[made.split.train[5]]].clone();
    let box_ = Shape::Box {
        size_mm: [8.0, 8.0, 8.0],
        edge_radius_mm: 0.5,
    };
    let box_ = box_.signed_distance_field(&Surfaces::default()).unwrap();
    let other_shape = Contact {
        underside: Underside::of(box_.as_ref(), glam::DQuat::IDENTITY),
        ..known.clone()
    };
    let elsewhere = Contact {
        place_mm: [known.place_mm[0], 12.0],
        ..known.clone()
    };
    let readings_kpa = [40.0, 3.0, 0.5, 0.0];
    let half_widths = |contact: &Contact, depth_mm: f64| {
        let ood_score = certainty.ood_score(contact, depth_mm);
        let mut half_widths_kpa = [0.0; 4];
        certainty.half_widths_kpa(
            (ood_score, depth_mm),
            &readings_kpa,
            &[0.0; 4],
            &mut half_widths_kpa,
        );
        (ood_score > certainty.threshold, half_widths_kpa)
    };
    let (is_flagged, usual) = half_widths(&known, 1.2);
    assert!(!is_flagged && usual.iter().all(|kpa| *kpa > 0.0));
    for (contact, depth_mm) in [(&other_shape, 1.2), (&elsewhere, 1.2), (&known, 2.6)] {
        let (is_flagged, wider) = half_widths(contact, depth_mm);
        assert!(is_flagged, "{contact:?} at {depth_mm} mm");
        for (usual, wider) in usual.iter().zip(wider) {
            assert!(wider > 1.2 * usual, "{wider} {usual}");
        }
    }
    assert_eq!(certainty.ood_score(&other_shape, -0.5), 0.0);
}

#[test]
fn predictions_say_how_sure_they_are() {
    let made = make(&Truth::new(), 17);
    let certainty = made.certainty();
    let plan = PressPlan {
        name: "tip#0".into(),
        indenter: "tip".into(),
        x_mm: 1.3,
        y_mm: 0.0,
        rotation: glam::DQuat::IDENTITY,
        clearance_mm: 0.5,
        depth_mm: 1.0,
        speed_mm_per_s: 2.0,
        hold_s: 0.5,
    };
    let predicted = predict(
        (&made.twin, Some(&certainty)),
        &made.bench,
        &Formula,
        &[plan],
        30.0,
    )
    .unwrap();
    let sure = predicted[0].certainty.as_ref().unwrap();
    let n_frames = predicted[0].readings_kpa.len();
    assert_eq!(
        [
            sure.half_width_kpa.len(),
            sure.ood_score.len(),
            sure.is_out_of_distribution.len()
        ],
        [n_frames; 3]
    );
    for (frame, depth_mm) in predicted[0].depth_mm.iter().enumerate() {
        assert_eq!(sure.ood_score[frame] > 0.0, *depth_mm > 0.0);
        assert_eq!(
            sure.is_out_of_distribution[frame],
            sure.ood_score[frame] > certainty.threshold
        );
    }
    let text = serde_json::to_string(&certainty).unwrap();
    assert_eq!(serde_json::from_str::<Certainty>(&text).unwrap(), certainty);
}
