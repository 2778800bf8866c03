//! Kept results never stand for other inputs. Whatever changes between two calls of a command in
//! one folder, the second call gives the same files as in a fresh folder, to the last bit, or is
//! refused with the difference named.

#![allow(clippy::unwrap_used)] // a test that cannot set itself up has failed

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..")
}

/// A box as an STL file: its origin is in the middle of its lowest face.
fn box_stl([half_x_mm, half_y_mm, height_mm]: [f64; 3]) -> String {
    let corner = |index: usize| {
        let side = |bit: usize, half_mm: f64| {
            if index & (1 << bit) == 0 {
                -half_mm
            } else {
                half_mm
            }
        };
        let z_mm = if index & 4 == 0 { 0.0 } else { height_mm };
        [side(0, half_x_mm), side(1, half_y_mm), z_mm]
    };
    let faces: [[usize; 3]; 12] = [
        [0, 2, 1],
        [1, 2, 3],
        [4, 5, 6],
        [5, 7, 6],
        [0, 1, 4],
        [1, 5, 4],
        [2, 6, 3],
        [3, 6, 7],
        [0, 4, 2],
        [2, 4, 6],
        [1, 3, 5],
        [3, 7, 5],
    ];
    let mut text = String::from("solid box\n");
    for face in faces {
        text += "facet normal 0 0 0\nouter loop\n";
        for [x, y, z] in face.map(corner) {
            writeln!(text, "vertex {x} {y} {z}").unwrap();
        }
        text += "endloop\nendfacet\n";
    }
    text + "endsolid box\n"
}

/// The input files of the commands, as coarse and short as still works.
fn inputs() -> BTreeMap<&'static str, String> {
    let read = |path: &str| fs::read_to_string(root().join(path)).unwrap();
    let sensor = read("sensors/phystac.toml");
    let (before, after) = sensor.split_once("[gel.material]").unwrap();
    let (material, after) = after.split_once("\n\n").unwrap();
    let before = before
        .replace("  \"gel.material.shear_modulus_kpa\",\n", "")
        .replace("  \"gel.material.poissons_ratio\",\n", "")
        .replace("[gel.solid]", "[gel]\nmaterial = \"gel.toml\"\n\n[gel.solid]");
    let block = "[[indenters]]\nname = \"block\"\nshape = { kind = \"stl\", path = \"block.stl\" }\n";
    let (ball_and_before, _) = after.split_once("[[indenters]]\nname = \"cube\"").unwrap();
    let sensor = format!("{before}{ball_and_before}{block}").replace("depth_mm = 5.0", "depth_mm = 1.0");
    let solid = "kind = \"block\"\nsize_mm = [34.0, 18.0, 8.5]";
    assert!(sensor.contains(solid));
    let moulded = sensor
        .replace(solid, "kind = \"stl\"\npath = \"gel.stl\"")
        .replace("  \"gel.solid.size_mm\",\n", "");
    let protocol = "summary = \"A few presses\"\nindenters = [\"block\"]\nplaces = { kind = \"random\", x_mm = [-9.0, 9.0], y_mm = [-4.0, 4.0], count = 8 }\n\
                    depth_mm = [0.5, 0.9]\nspeed_mm_per_s = 4.0\nhold_s = 0.2\nclearance_mm = 0.3\n";
    let data = "crates/app/twintac/examples/data";
    let presses: Vec<String> = read(&format!("{data}/presses.csv"))
        .lines()
        .take(100)
        .map(str::to_owned)
        .collect();
    let emulator = read("emulators/default.toml")
        .replace("edges_per_height = 7.0", "edges_per_height = 2.5")
        .replace("edges_per_contact_radius = 6.0", "edges_per_contact_radius = 1.0");
    BTreeMap::from([
        ("sensor.toml", sensor),
        ("gel.toml", material.trim().to_owned()),
        ("block.stl", box_stl([5.0, 5.0, 6.0])),
        ("emulator.toml", emulator),
        (
            "settings.toml",
            "[simulate]\nedges_per_height = 2.0\nedges_per_contact_radius = 1.0\ndepth_step_mm = 0.5\n[bench]\nn_places = 2\n[train]\nepochs = 3\n"
                .to_owned(),
        ),
        (
            "simulate.toml",
            "[simulate]\nedges_per_height = 2.0\nedges_per_contact_radius = 1.0\ndepth_step_mm = 0.5\n".to_owned(),
        ),
        ("protocol.toml", protocol.to_owned()),
        // The sensor's description marks the ball's radius as inferred, so presses with the ball
        // alone have the radius fitted.
        ("ball.toml", protocol.replace("block", "sphere-25")),
        ("one.toml", protocol.replace("count = 8", "count = 1")),
        ("moulded.toml", moulded),
        ("gel.stl", box_stl([17.0, 9.0, 8.5])),
        ("import.toml", read(&format!("{data}/import.toml"))),
        ("presses.csv", presses.join("\n")),
    ])
}

/// The changes between two calls: a file, and the text in it. Surfaces become smaller; a model is
/// replaced by another.
const CHANGES: [(&str, &str, &str, &str); 13] = [
    (
        "the gel's material",
        "gel.toml",
        "shear_modulus_kpa = 15.2",
        "shear_modulus_kpa = 19.0",
    ),
    ("the indenter's surface", "block.stl", "", ""),
    (
        "the gel's size",
        "sensor.toml",
        "[34.0, 18.0, 8.5]",
        "[34.0, 18.0, 8.0]",
    ),
    (
        "a taxel's name",
        "sensor.toml",
        "name = \"t0\"",
        "name = \"first\"",
    ),
    (
        "the sensor's name",
        "sensor.toml",
        "name = \"phystac\"",
        "name = \"other\"",
    ),
    (
        "the meshes",
        "settings.toml",
        "edges_per_height = 2.0",
        "edges_per_height = 2.2",
    ),
    ("the training", "settings.toml", "epochs = 3", "epochs = 4"),
    ("the bench", "emulator.toml", "seed = 7", "seed = 8"),
    ("the protocol", "protocol.toml", "[0.5, 0.9]", "[0.4, 0.8]"),
    ("the gel's surface", "gel.stl", "", ""),
    ("the model", "first/model", "", ""),
    (
        "how logs are read",
        "import.toml",
        "{ unit = \"kPa\" }",
        "{ unit = \"hPa\" }",
    ),
    ("the presses of a ball", "ball.toml", "[0.5, 0.9]", "[0.4, 0.8]"),
];

/// Inputs, and a folder to which commands write.
struct Desk(tempfile::TempDir);

impl Desk {
    fn new() -> Self {
        let desk = Self(tempfile::tempdir().unwrap());
        for (name, text) in inputs() {
            fs::write(desk.path(name), text).unwrap();
        }
        desk
    }

    /// A copy at another path, with all outputs of commands.
    fn copied(&self) -> Self {
        let desk = Self(tempfile::tempdir().unwrap());
        copy(self.0.path(), desk.0.path());
        desk
    }

    /// Gives another desk this one's runs: a model, recordings that the model has not seen, another
    /// model, and a surrogate.
    fn give(&self, other: &Self) {
        copy(&self.path("run"), &other.path("first"));
        copy(&self.path("second"), &other.path("second"));
        copy(&self.path("fast"), &other.path("first-fast"));
        copy(&self.path("other-model"), &other.path("other-model"));
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn change(&self, (_, file, from, to): (&str, &str, &str, &str)) {
        let path = self.path(file);
        if file == "first/model" {
            fs::remove_dir_all(&path).unwrap();
            copy(&self.path("other-model"), &path);
            return;
        }
        let text = fs::read_to_string(&path).unwrap();
        let changed = match file {
            "block.stl" => box_stl([4.0, 4.0, 6.0]),
            "gel.stl" => box_stl([17.0, 9.0, 8.0]),
            _ => text.replacen(from, to, 1),
        };
        assert_ne!(text, changed, "{file}");
        fs::write(path, changed).unwrap();
        let simulate = self.path("simulate.toml");
        if file == "settings.toml" && from.starts_with("edges") {
            let text = fs::read_to_string(&simulate).unwrap();
            fs::write(simulate, text.replacen(from, to, 1)).unwrap();
        }
    }

    /// Runs a command. Words that name inputs or outputs become paths.
    fn call(&self, command: &str) -> Output {
        let words = command
            .split_whitespace()
            .map(|word| match word.strip_prefix('@') {
                Some(name) => self.path(name).display().to_string(),
                None => word.to_owned(),
            });
        Command::new(env!("CARGO_BIN_EXE_twintac"))
            .args(words)
            .current_dir(self.0.path())
            .output()
            .unwrap()
    }

    /// Runs commands until one is refused, and returns its error.
    fn all(&self, commands: &[&str]) -> Result<(), String> {
        for command in commands {
            let output = self.call(command);
            if !output.status.success() {
                return Err(String::from_utf8_lossy(&output.stderr).into_owned());
            }
        }
        Ok(())
    }

    /// The contents of files, without the path of the desk.
    fn results(&self, files: &[&str]) -> Vec<Vec<u8>> {
        let here = self.0.path().display().to_string();
        let read = |file: &&str| {
            let bytes = fs::read(self.path(file)).unwrap_or_default();
            String::from_utf8(bytes).map_or_else(
                |binary| binary.into_bytes(),
                |text| text.replace(&here, "").into_bytes(),
            )
        };
        files.iter().map(read).collect()
    }
}

fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let path = entry.unwrap().path();
        let target = to.join(path.file_name().unwrap());
        if path.is_dir() {
            copy(&path, &target);
        } else {
            fs::copy(&path, &target).unwrap();
        }
    }
}

/// Commands that work in one folder, and the files of their results.
struct Work {
    commands: &'static [&'static str],
    results: &'static [&'static str],
    /// The changes that affect the results: all changes of a file, or one by its name.
    reached_by: &'static [&'static str],
}

impl Work {
    fn is_reached_by(&self, (name, file, ..): (&str, &str, &str, &str)) -> bool {
        self.reached_by.contains(&file) || self.reached_by.contains(&name)
    }
}

const RECORD: &str = "record --at-once --lab @emulator.toml --sensor @sensor.toml --protocol @protocol.toml --settings @settings.toml --out @run";

/// Presses that are not used for training.
const UNSEEN: &str = "record --at-once --lab @emulator.toml --sensor @sensor.toml --protocol @protocol.toml --settings @settings.toml --seed 2 --out @second";

const WORKS: [Work; 10] = [
    Work {
        commands: &[
            RECORD,
            "align --run @run",
            "train --run @run",
            "evaluate --run @run",
            "report --run @run",
            "cross-validate --run @run --seeds 1",
        ],
        results: &[
            "run/recordings/presses.parquet",
            "run/simulation/places.json",
            "run/simulation/tables.json",
            "run/metrics.json",
            "run/model/weights.safetensors",
            "run/cross_validation/result.json",
        ],
        reached_by: &[
            "gel.toml",
            "block.stl",
            "sensor.toml",
            "settings.toml",
            "emulator.toml",
            "protocol.toml",
        ],
    },
    // The model comes from a first run, the recordings come from a second one, and the sensor is
    // another.
    Work {
        commands: &[
            "adapt --model @first/model --recordings @second/recordings/presses.parquet --sensor @sensor.toml --presses 3 --out @adapted",
        ],
        results: &["adapted/model/weights.safetensors", "adapted/adaptation.json"],
        reached_by: &["gel.toml", "block.stl", "sensor.toml", "first/model"],
    },
    Work {
        commands: &[
            "adapt --model @first/model --recordings @second/recordings/presses.parquet --sensor @moulded.toml --presses 3 --out @moulded",
        ],
        results: &["moulded/model/weights.safetensors", "moulded/adaptation.json"],
        reached_by: &["gel.stl"],
    },
    Work {
        commands: &[
            "fast train --sensor @sensor.toml --own-indenters --training-presses 5 --test-presses 1 --steps 20 --out @fast",
            "dataset --sensor @sensor.toml --fast @fast/fast.safetensors --protocol @protocol.toml --presses 2 --out @felt",
        ],
        results: &[
            "fast/fast.safetensors",
            "fast/evaluation.json",
            "felt/shard-000001-of-000001.parquet",
        ],
        // This is by far the slowest, and the sensor's description affects it as it affects the
        // others, so it is tested there.
        reached_by: &["gel.toml", "block.stl"],
    },
    Work {
        commands: &[
            "dataset --sensor @sensor.toml --fast @first-fast/fast.safetensors --protocol @protocol.toml --presses 2 --out @first-felt",
        ],
        results: &["first-felt/shard-000001-of-000001.parquet"],
        reached_by: &["sensor.toml", "protocol.toml"],
    },
    Work {
        commands: &[
            "dataset --sensor @sensor.toml --protocol @protocol.toml --settings @simulate.toml --presses 2 --out @data",
        ],
        results: &["data/shard-000001-of-000001.parquet"],
        reached_by: &[
            "gel.toml",
            "block.stl",
            "sensor.toml",
            "settings.toml",
            "protocol.toml",
        ],
    },
    Work {
        commands: &[
            "simulate --sensor @sensor.toml --protocol @protocol.toml --settings @simulate.toml --out @simulated",
        ],
        results: &["simulated/block-000.json"],
        reached_by: &[
            "gel.toml",
            "block.stl",
            "sensor.toml",
            "settings.toml",
            "protocol.toml",
        ],
    },
    Work {
        commands: &[
            "design --sensor @sensor.toml --vary taxels.port_radius_mm=0.8..1.2 --grid 2 --force-n 0.03 --nodes 500 --out @designs",
        ],
        results: &["designs/designs.csv", "designs/best.toml"],
        reached_by: &["gel.toml", "sensor.toml"],
    },
    // A ball whose radius is fitted: cross-validation has tables of several radii, which it keeps
    // itself.
    Work {
        commands: &[
            "record --at-once --lab @emulator.toml --sensor @sensor.toml --protocol @ball.toml --settings @settings.toml --out @ball",
            "align --run @ball",
            "cross-validate --run @ball --seeds 1",
        ],
        results: &["ball/simulation/bench.json", "ball/cross_validation/result.json"],
        reached_by: &["gel.toml", "settings.toml", "ball.toml"],
    },
    Work {
        commands: &[
            "import --sensor @sensor.toml --import @import.toml --recordings @presses.csv --out @imported",
        ],
        results: &["imported/recordings/presses.parquet"],
        reached_by: &["import.toml"],
    },
];

/// Words of errors that name a difference.
const REFUSALS: [&str; 7] = [
    "another",
    "other settings",
    "are of sensor",
    "are of the sensor",
    "taxels",
    "is of the sensor",
    "is not that of",
];

#[test]
fn what_is_kept_is_what_a_fresh_folder_has() {
    let first = Desk::new();
    first.all(WORKS[0].commands).unwrap();
    first.all(&[UNSEEN]).unwrap();
    first.all(&WORKS[3].commands[..1]).unwrap();
    let other = first.copied();
    other.change(CHANGES[6]);
    other.all(&WORKS[0].commands[..5]).unwrap();
    copy(&other.path("run/model"), &first.path("other-model"));
    let base = Desk::new();
    first.give(&base);
    copy(&first.path("fast"), &base.path("fast"));
    for work in &WORKS {
        base.all(work.commands).unwrap();
    }
    assert!(base.path("ball/cross_validation/depth_tables").is_dir());
    let mut wrong = String::new();
    for change in CHANGES {
        let (name, file, ..) = change;
        let (again, fresh) = (base.copied(), Desk::new());
        first.give(&fresh);
        again.change(change);
        fresh.change(change);
        for work in WORKS.iter().filter(|work| work.is_reached_by(change)) {
            let was = again.results(work.results);
            let (kept, made) = (again.all(work.commands), fresh.all(work.commands));
            match (&kept, &made) {
                (Err(refused), _) if REFUSALS.iter().any(|words| refused.contains(words)) => {}
                (Ok(()), Ok(())) if again.results(work.results) == fresh.results(work.results) => {
                    let is_same = again.results(work.results) == was;
                    if is_same && file != "settings.toml" && !name.ends_with("name") {
                        writeln!(wrong, "{name}, {}: no result depends on it", work.commands[0]).unwrap();
                    }
                }
                _ => {
                    let (kept_in, fresh_in) = (again.results(work.results), fresh.results(work.results));
                    let pairs = work.results.iter().zip(kept_in.iter().zip(&fresh_in));
                    let differ: Vec<&str> = pairs
                        .filter_map(|(file, (kept, fresh))| (kept != fresh).then_some(*file))
                        .collect();
                    writeln!(
                        wrong,
                        "{name}, {}: kept {kept:?}, fresh {made:?}; {differ:?} differ",
                        work.commands[0]
                    )
                    .unwrap();
                }
            }
        }
    }
    assert!(wrong.is_empty(), "\n{wrong}");
}

/// A folder that was moved stays valid. A stage whose inputs have changed since is refused by name.
#[test]
fn stages_are_read_only_as_they_would_be_made_now() {
    let desk = Desk::new();
    desk.all(&[
        RECORD,
        "align --run @run",
        "train --run @run",
        "evaluate --run @run",
        "report --run @run",
    ])
    .unwrap();
    let moved = desk.copied();
    let when = |desk: &Desk| {
        fs::metadata(desk.path("run/training/stage.json"))
            .unwrap()
            .modified()
            .unwrap()
    };
    let before = when(&moved);
    moved
        .all(&[RECORD, "align --run @run", "train --run @run"])
        .unwrap();
    assert_eq!(when(&moved), before);

    moved.change(CHANGES[6]);
    moved.all(&[RECORD, "align --run @run"]).unwrap();
    for stage in ["evaluate", "report"] {
        let refused = moved.all(&[&format!("{stage} --run @run")]).unwrap_err();
        assert!(
            refused.contains("another train") && refused.contains("`twintac train`"),
            "{refused}"
        );
    }
    moved.all(&["train --run @run"]).unwrap();
    let refused = moved.all(&["report --run @run"]).unwrap_err();
    assert!(refused.contains("`twintac evaluate`"), "{refused}");
    fs::write(moved.path("run/pairs/paired.json"), "[]").unwrap();
    let refused = moved.all(&["evaluate --run @run"]).unwrap_err();
    assert!(refused.contains("changed since"), "{refused}");

    // Other presses, drawn with another seed.
    let again = desk.copied();
    again
        .all(&[&RECORD.replace("record", "record --seed 7")])
        .unwrap();
    for stage in ["train", "evaluate", "report"] {
        let refused = again.all(&[&format!("{stage} --run @run")]).unwrap_err();
        assert!(
            refused.contains("seed") || refused.contains("recordings"),
            "{refused}"
        );
    }
}

/// A model folder is complete: it has the description of its training, and the surfaces that the
/// description names.
#[test]
fn a_model_stands_alone() {
    let desk = Desk::new();
    desk.all(&WORKS[0].commands[..5]).unwrap();
    desk.all(&[UNSEEN]).unwrap();
    let elsewhere = Desk::new();
    copy(&desk.path("run/model"), &elsewhere.path("model"));
    copy(&desk.path("second"), &elsewhere.path("second"));
    for file in ["block.stl", "sensor.toml", "gel.toml"] {
        fs::remove_file(elsewhere.path(file)).unwrap();
    }
    elsewhere
        .all(&[
            "predict --model @model --protocol @one.toml",
            "evaluate --model @model --recordings @second/recordings/presses.parquet",
            "adapt --model @model --recordings @second/recordings/presses.parquet --presses 3 --out @adapted",
            "dataset --twin @model --protocol @one.toml --out @data",
        ])
        .unwrap();
    let surface = fs::read_dir(elsewhere.path("model/surfaces")).unwrap().next();
    let surface = surface.unwrap().unwrap().path();
    let mut bytes = fs::read(&surface).unwrap();
    bytes[100] ^= 1;
    fs::write(surface, bytes).unwrap();
    let refused = elsewhere
        .all(&["predict --model @model --protocol @one.toml"])
        .unwrap_err();
    assert!(refused.contains("SHA-256"), "{refused}");
}

/// Logs of one bench are not used for another: nothing is recorded beside them, and nothing is
/// overwritten.
#[test]
fn logs_are_of_one_bench_and_sensor() {
    let wired = "record --lab @emulator.toml --sensor @sensor.toml --protocol @one.toml --settings @settings.toml --out @run";
    let desk = Desk::new();
    let sensor = fs::read_to_string(desk.path("sensor.toml")).unwrap();
    fs::write(
        desk.path("sensor.toml"),
        sensor.replace("depth_mm = 1.0", "depth_mm = 5.0"),
    )
    .unwrap();
    desk.all(&[wired]).unwrap();
    for change in [CHANGES[7], CHANGES[4]] {
        let other = desk.copied();
        other.change(change);
        let was = other.results(&[
            "run/recordings/presses.parquet",
            "run/sensor.toml",
            "run/run.json",
        ]);
        let refused = other.all(&[wired]).unwrap_err();
        assert!(refused.contains("another"), "{}: {refused}", change.0);
        assert_eq!(
            other.results(&[
                "run/recordings/presses.parquet",
                "run/sensor.toml",
                "run/run.json"
            ]),
            was,
            "{}",
            change.0
        );
    }
}

/// One program at a time works in a run.
#[test]
fn a_run_has_one_owner() {
    let desk = Desk::new();
    let commands: Vec<&str> = RECORD.split_whitespace().collect();
    let spawn = || {
        Command::new(env!("CARGO_BIN_EXE_twintac"))
            .args(commands.iter().map(|word| word.strip_prefix('@').unwrap_or(word)))
            .current_dir(desk.0.path())
            .output()
    };
    let outputs: Vec<Output> = std::thread::scope(|scope| {
        let works: Vec<_> = (0..4).map(|_| scope.spawn(spawn)).collect();
        works
            .into_iter()
            .map(|work| work.join().unwrap().unwrap())
            .collect()
    });
    for output in &outputs {
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(
            output.status.success() || said.contains("in use by another program"),
            "{said}"
        );
    }
    desk.all(&["align --run @run", "train --run @run", "evaluate --run @run"])
        .unwrap();
}

/// While a program works in a folder, every other command that would work there fails at once.
#[test]
fn a_folder_in_use_is_refused() {
    let desk = Desk::new();
    desk.all(&[RECORD]).unwrap();
    let held: Vec<fs::File> = ["run", "paper", "fast"]
        .map(|folder| {
            fs::create_dir_all(desk.path(folder)).unwrap();
            let file = fs::File::create(desk.path(folder).join(".in-use")).unwrap();
            file.lock().unwrap();
            file
        })
        .into();
    for command in [
        RECORD,
        "align --run @run",
        "train --run @run",
        "cross-validate --run @run --seeds 1",
        "reproduce --paper --quick --out @paper",
        "fast train --sensor @sensor.toml --training-presses 5 --test-presses 1 --steps 1 --out @fast",
    ] {
        let refused = desk.all(&[command]).unwrap_err();
        assert!(
            refused.contains("in use by another program"),
            "{command}: {refused}"
        );
    }
    drop(held);
    desk.all(&["align --run @run"]).unwrap();
}
