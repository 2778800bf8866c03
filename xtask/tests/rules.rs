//! The rules of this workspace, each a test of its own name.
//!
//! What a crate must never know stands in `xtask/rooms.toml`: there is a test for each crate and word.

#![allow(clippy::print_stderr)] // what keeps the tests from starting

use std::collections::BTreeSet;
use std::path::Path;
use std::process::ExitCode;
use std::sync::Arc;

use anyhow::{Result, ensure};
use libtest_mimic::{Arguments, Failed, Trial};
use xtask::code::{Crate, circles, length, public, tested};
use xtask::rooms::{Graph, Rooms, page, rule};
use xtask::{documents, results};

/// What the tests look at, read once.
struct Workspace {
    rooms: Rooms,
    graph: Graph,
    crates: Vec<Crate>,
    words: public::Words,
    /// What the facade exports of other crates.
    passed_on: BTreeSet<String>,
}

fn main() -> ExitCode {
    match read() {
        Ok(workspace) => {
            let workspace = Arc::new(workspace);
            let mut trials = of_rooms(&workspace);
            trials.extend(of_sources(&workspace));
            trials.extend(of_documents(&workspace));
            libtest_mimic::run(&Arguments::from_args(), trials).exit_code()
        }
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn read() -> Result<Workspace> {
    let root = xtask::root();
    let graph = Graph::read(&root)?;
    let crates = Crate::read_all(&root, &graph)?;
    let facade = crates.iter().filter(|sources| sources.package == "twintac");
    Ok(Workspace {
        rooms: Rooms::read(&root)?,
        passed_on: facade.flat_map(public::passed_on).collect(),
        crates,
        words: public::Words::read(&root)?,
        graph,
    })
}

/// A test that ends well if `check` does.
fn trial(
    workspace: &Arc<Workspace>,
    name: String,
    check: impl Fn(&Workspace, &Path) -> Result<()> + Send + 'static,
) -> Trial {
    let workspace = Arc::clone(workspace);
    let name = name.replace(' ', "_");
    Trial::test(name, move || {
        check(&workspace, &xtask::root()).map_err(|error| Failed::from(format!("{error:#}")))
    })
}

fn of_rooms(workspace: &Arc<Workspace>) -> Vec<Trial> {
    let mut trials = vec![trial(
        workspace,
        "rooms::every_package_has_one".into(),
        |all, _| rule::every_package_has_a_room(&all.rooms, &all.graph),
    )];
    let rooms = workspace.rooms.rooms.iter();
    for room in rooms.filter(|room| !room.is_beside_the_workspace()) {
        let place = &room.folder;
        let (name, own) = (room.name().to_owned(), room.package());
        if room.shelf().is_some() {
            trials.push(trial(
                workspace,
                format!("rooms::{place}::arrows_point_down"),
                move |all, _| rule::arrows_point_down(&all.rooms, &all.graph, all.rooms.room(&name)?),
            ));
        }
        trials.push(trial(
            workspace,
            format!("rooms::{place}::has_a_front_page"),
            move |all, root| rule::has_a_front_page(root, all.graph.package(&own)?),
        ));
    }
    let of_table = workspace.rooms.rooms.iter().flat_map(|room| {
        let bars = room
            .never
            .iter()
            .map(|word| (room.name().to_owned(), word.clone()));
        bars.map(|bar| (format!("rooms::{}", room.folder), bar))
    });
    let of_invariants = workspace.rooms.invariants.iter().flat_map(|invariant| {
        let bars = invariant.bars.iter().flat_map(|bar| {
            let rooms = workspace.rooms.rooms.iter().filter(|room| bar.binds(room));
            rooms.flat_map(|room| {
                bar.never
                    .iter()
                    .map(move |word| (room.name().to_owned(), word.clone()))
            })
        });
        bars.map(|bar| (format!("invariants::{}::{}", invariant.name, bar.0), bar))
    });
    for (place, (name, word)) in of_table.chain(of_invariants) {
        trials.push(trial(
            workspace,
            format!("{place}::never::{word}"),
            move |all, _| {
                rule::never_knows(&all.rooms, &all.graph, &all.crates, all.rooms.room(&name)?, &word)
            },
        ));
    }
    trials
}

/// Libraries that strangers use, and the one that is a program: what is public there needs no user here.
const EXEMPT: [&str; 3] = ["phystac", "twintac", "xtask"];

fn of_sources(workspace: &Arc<Workspace>) -> Vec<Trial> {
    let mut trials = Vec::new();
    for room in &workspace.rooms.rooms {
        if room.shelf().is_some() {
            let folder = room.folder.clone();
            trials.push(trial(
                workspace,
                format!("sources::{}::says_what_is_tested", room.folder),
                move |_, root| tested::says_what_is_tested(root, &folder),
            ));
        }
        let folder = room.folder.clone();
        trials.push(trial(
            workspace,
            format!("sources::{}::long_functions_say_why", room.folder),
            move |_, root| {
                none(
                    length::long_functions(root, &folder)?,
                    "`// long: why` is missing above",
                )
            },
        ));
        let folder = room.folder.clone();
        trials.push(trial(
            workspace,
            format!("sources::{}::files_are_one_idea_each", room.folder),
            move |_, root| none(length::large_files(root, &folder)?, "look for the missing room"),
        ));
    }
    for (index, sources) in workspace.crates.iter().enumerate() {
        let kind = if sources.is_library { "library" } else { "program" };
        let name = format!("sources::{}::{kind}_has_no_circles", sources.package);
        trials.push(trial(workspace, name, move |all, _| {
            none(circles::circles(&all.crates[index]), "")
        }));
        if sources.is_library && !EXEMPT.contains(&sources.package.as_str()) {
            let name = format!("sources::{}::what_is_public_is_used", sources.package);
            trials.push(trial(workspace, name, move |all, _| {
                none(
                    public::unused(&all.crates[index], &all.graph, &all.words, &all.passed_on)?,
                    "nobody outside uses",
                )
            }));
        }
    }
    trials
}

fn of_documents(workspace: &Arc<Workspace>) -> Vec<Trial> {
    vec![
        trial(
            workspace,
            "documents::rooms_are_those_of_rooms_toml".into(),
            |all, root| page::is_fresh(root, &all.rooms),
        ),
        trial(
            workspace,
            "documents::results_are_those_that_are_kept".into(),
            |_, root| results::is_fresh(root),
        ),
        trial(workspace, "documents::files_named_exist".into(), |_, root| {
            documents::files_named_exist(root)
        }),
        trial(workspace, "documents::links_lead_somewhere".into(), |_, root| {
            documents::links_lead_somewhere(root)
        }),
    ]
}

fn none(found: Vec<String>, what: &str) -> Result<()> {
    ensure!(found.is_empty(), "{what}\n{}", found.join("\n"));
    Ok(())
}
