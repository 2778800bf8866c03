//! What is public, and who uses it.
//!
//! A name that a library exports is used if it stands in the sources of another crate, or in tests,
//! examples or benchmarks of any. A type that nobody names is used if the signature of something
//! that is used has it. Names are compared as text: a method counts as used if anything of its name
//! is used anywhere, so the check finds less than there is, and nothing that is not.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use anyhow::{Context, Result};

use super::module::{Item, ModulePath};
use super::tree::{Crate, Target};
use super::{identifiers, rust_files};
use crate::layers::Graph;

/// Identifiers of every source file of the workspace and of the packages beside it, by path from
/// the root.
pub struct Words(BTreeMap<String, BTreeSet<String>>);

impl Words {
    /// Reads them all.
    pub fn read(root: &Path) -> Result<Self> {
        let mut words = BTreeMap::new();
        for path in rust_files(root, &["crates", "xtask", "firmware", "fuzz", "python", "web"])? {
            let text = fs::read_to_string(&path)?;
            let tokens = text.parse().map_err(|error| anyhow::anyhow!("{error}"));
            let found = identifiers(tokens.with_context(|| format!("reading {}", path.display()))?);
            let place = path.strip_prefix(root).unwrap_or(&path);
            words.insert(place.to_string_lossy().into_owned(), found);
        }
        Ok(Self(words))
    }

    /// All but those of a library's own sources.
    fn outside(&self, package: &str, sources: &Crate) -> BTreeSet<&str> {
        let own: BTreeSet<&str> = sources.files.iter().map(|file| file.path.as_str()).collect();
        let own_tests = format!("{package}/src/"); // files of unit tests, which are not in the module tree
        self.0
            .iter()
            .filter(|(path, _)| !own.contains(path.as_str()) && !path.starts_with(&own_tests))
            .flat_map(|(_, words)| words.iter().map(String::as_str))
            .collect()
    }
}

/// Public names of a library that nobody uses outside it, one text each.
/// Methods of types that `passed_on` names are for strangers, and need no user here.
pub fn unused(
    sources: &Crate,
    graph: &Graph,
    words: &Words,
    passed_on: &BTreeSet<String>,
) -> Result<Vec<String>> {
    let folder = &graph.package(&sources.package)?.folder;
    let outside = words.outside(folder, sources);
    let mut exported = Exported::default();
    exported.add_module(sources, &[]);

    // What is used, and what the signatures of what is used name.
    let mut named: BTreeSet<String> = outside.iter().map(|&word| word.to_owned()).collect();
    let mut pending: Vec<&Item> = Vec::new();
    let mut seen = BTreeSet::new();
    loop {
        for (name, (module, item)) in &exported.items {
            if named.contains(name) && seen.insert((module.clone(), name.clone())) {
                pending.push(item);
                let methods = sources.modules.values().flat_map(|module| &module.methods);
                pending.extend(
                    methods
                        .filter(|(of, method)| {
                            *of == item.name && (!method.is_public || outside.contains(method.name.as_str()))
                        })
                        .map(|(_, method)| method),
                );
            }
        }
        if pending.is_empty() {
            break;
        }
        for item in pending.drain(..) {
            named.extend(item.signature.iter().cloned());
        }
    }

    let mut found = Vec::new();
    for (name, (module, item)) in &exported.items {
        let place = &sources.files[sources.modules[module].file].path;
        if !named.contains(name) {
            found.push(format!("{place}:{}: `{name}`", item.line));
        }
        if !named.contains(name) || passed_on.contains(name) {
            continue;
        }
        for module in sources.modules.values() {
            for (of, method) in &module.methods {
                if *of == item.name && method.is_public && !outside.contains(method.name.as_str()) {
                    let place = &sources.files[module.file].path;
                    found.push(format!("{place}:{}: `{name}::{}`", method.line, method.name));
                }
            }
        }
    }
    found.sort();
    Ok(found)
}

/// What can be reached from a library's root, by the name that it is exported under.
#[derive(Default)]
struct Exported {
    items: BTreeMap<String, (ModulePath, Item)>,
    modules: BTreeSet<ModulePath>,
}

impl Exported {
    fn add_module(&mut self, sources: &Crate, path: &[String]) {
        let Some(module) = sources.modules.get(path) else {
            return;
        };
        if !self.modules.insert(path.to_vec()) {
            return;
        }
        for item in module.items.values().filter(|item| item.is_public) {
            self.items
                .insert(item.name.clone(), (path.to_vec(), item.clone()));
        }
        for (child, below) in &sources.modules {
            if below.is_public && child.len() == path.len() + 1 && child.starts_with(path) {
                self.add_module(sources, child);
            }
        }
        for (name, (import, is_public)) in &module.imports {
            if *is_public {
                self.add(sources, sources.resolve(path, import), name);
            }
        }
        for (import, is_public) in &module.globs {
            if *is_public {
                self.add(sources, sources.resolve(path, import), "");
            }
        }
    }

    fn add(&mut self, sources: &Crate, target: Option<Target>, name: &str) {
        match target {
            Some(Target::Item(module, original)) => {
                let item = sources.modules[&module].items[&original].clone();
                self.items.insert(name.to_owned(), (module, item));
            }
            Some(Target::Module(module)) => self.add_module(sources, &module),
            None => {}
        }
    }
}

/// Names of other crates that a library exports.
pub fn passed_on(sources: &Crate) -> BTreeSet<String> {
    let imports = sources.modules.values().flat_map(|module| &module.imports);
    let public = imports.filter(|(_, (path, is_public))| *is_public && sources.resolve(&[], path).is_none());
    public.map(|(name, _)| name.clone()).collect()
}
