//! The rules of this workspace, each a test of its own name.
//!
//! What a crate must never know stands in `xtask/crates.toml`: there is a test for each crate and
//! word.

#![allow(clippy::print_stderr)] // what keeps the tests from starting

use std::collections::BTreeSet;
use std::path::Path;
use std::process::ExitCode;
use std::sync::Arc;

use anyhow::{Result, ensure};
use libtest_mimic::{Arguments, Failed, Trial};
use xtask::code::{Crate, circles, length, public, tested};
use xtask::layers::{Graph, Layers, page, rule};
use xtask::{documents, results, words};

/// What the tests look at, read once.
struct Workspace {
    layers: Layers,
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
            let mut trials = of_layers(&workspace);
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
        layers: Layers::read(&root)?,
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

fn of_layers(workspace: &Arc<Workspace>) -> Vec<Trial> {
    let mut trials = vec![trial(
        workspace,
        "crates::every_package_has_an_entry".into(),
        |all, _| rule::every_package_has_an_entry(&all.layers, &all.graph),
    )];
    let crates = workspace.layers.crates.iter();
    for entry in crates.filter(|entry| !entry.is_beside_the_workspace()) {
        let place = &entry.folder;
        let (name, own) = (entry.name().to_owned(), entry.package());
        if entry.layer().is_some() {
            trials.push(trial(
                workspace,
                format!("crates::{place}::arrows_point_down"),
                move |all, _| rule::arrows_point_down(&all.layers, &all.graph, all.layers.entry(&name)?),
            ));
        }
        trials.push(trial(
            workspace,
            format!("crates::{place}::has_a_front_page"),
            move |all, root| rule::has_a_front_page(root, all.graph.package(&own)?),
        ));
    }
    let of_table = workspace.layers.crates.iter().flat_map(|entry| {
        let bars = entry
            .never
            .iter()
            .map(|word| (entry.name().to_owned(), word.clone()));
        bars.map(|bar| (format!("crates::{}", entry.folder), bar))
    });
    let of_invariants = workspace.layers.invariants.iter().flat_map(|invariant| {
        let bars = invariant.bars.iter().flat_map(|bar| {
            let crates = workspace.layers.crates.iter().filter(|entry| bar.binds(entry));
            crates.flat_map(|entry| {
                bar.never
                    .iter()
                    .map(move |word| (entry.name().to_owned(), word.clone()))
            })
        });
        bars.map(|bar| (format!("invariants::{}::{}", invariant.name, bar.0), bar))
    });
    for (place, (name, word)) in of_table.chain(of_invariants) {
        trials.push(trial(
            workspace,
            format!("{place}::never::{word}"),
            move |all, _| {
                rule::never_knows(
                    &all.layers,
                    &all.graph,
                    &all.crates,
                    all.layers.entry(&name)?,
                    &word,
                )
            },
        ));
    }
    trials
}

/// Libraries that strangers use, and the one that is a program: what is public there needs no user
/// here.
const EXEMPT: [&str; 3] = ["phystac", "twintac", "xtask"];

fn of_sources(workspace: &Arc<Workspace>) -> Vec<Trial> {
    let mut trials = Vec::new();
    for entry in &workspace.layers.crates {
        if entry.layer().is_some() {
            let folder = entry.folder.clone();
            trials.push(trial(
                workspace,
                format!("sources::{}::says_what_is_tested", entry.folder),
                move |_, root| tested::says_what_is_tested(root, &folder),
            ));
        }
        let folder = entry.folder.clone();
        trials.push(trial(
            workspace,
            format!("sources::{}::long_functions_say_why", entry.folder),
            move |_, root| {
                none(
                    length::long_functions(root, &folder)?,
                    "`// long: why` is missing above",
                )
            },
        ));
        let folder = entry.folder.clone();
        trials.push(trial(
            workspace,
            format!("sources::{}::files_are_one_idea_each", entry.folder),
            move |_, root| none(length::large_files(root, &folder)?, "look for the second idea"),
        ));
        let folder = entry.folder.clone();
        trials.push(trial(
            workspace,
            format!("sources::{}::comments_are_not_wide", entry.folder),
            move |_, root| {
                none(
                    length::wide_comments(root, &folder)?,
                    "a comment is wider than 100 columns",
                )
            },
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
            "documents::crates_are_those_of_crates_toml".into(),
            |all, root| page::is_fresh(root, &all.layers),
        ),
        trial(
            workspace,
            "documents::results_are_those_that_are_kept".into(),
            |_, root| results::is_fresh(root),
        ),
        trial(workspace, "documents::files_named_exist".into(), |_, root| {
            documents::files_named_exist(root)
        }),
        trial(workspace, "documents::lines_are_not_wide".into(), |_, root| {
            none(
                documents::wide_lines(root)?,
                "a line is wider than 100 columns: one sentence or clause a line",
            )
        }),
        trial(
            workspace,
            "documents::words_are_those_of_the_field".into(),
            |_, root| none(words::gone_words(root)?, "words that are not of the field"),
        ),
        trial(
            workspace,
            "sources::names_are_those_of_the_field".into(),
            |_, root| none(words::gone_names(root)?, "names that are not of the field"),
        ),
        trial(workspace, "documents::links_lead_somewhere".into(), |_, root| {
            documents::links_lead_somewhere(root)
        }),
    ]
}

fn none(found: Vec<String>, what: &str) -> Result<()> {
    ensure!(found.is_empty(), "{what}\n{}", found.join("\n"));
    Ok(())
}
