//! The module tree of a library or a program, and what its paths stand for.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};

use super::file::SourceFile;
use super::module::{self, Module, ModulePath};
use crate::layers::Graph;

/// A library or a program of a package.
#[derive(Debug)]
pub struct Crate {
    /// The name of its package.
    pub package: String,
    /// Its source files, the root first.
    pub files: Vec<SourceFile>,
    /// Its modules, by path.
    pub modules: BTreeMap<ModulePath, Module>,
    /// It is a library.
    pub is_library: bool,
}

/// What a path stands for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Target {
    /// Something that a module of this crate defines.
    Item(ModulePath, String),
    /// A module of this crate.
    Module(ModulePath),
}

impl Crate {
    /// Reads the library and the programs of every package.
    pub fn read_all(root: &Path, graph: &Graph) -> Result<Vec<Self>> {
        let mut crates = Vec::new();
        for (name, package) in &graph.packages {
            for file in package.lib_file.iter().chain(&package.programs) {
                let is_library = package.lib_file.as_ref() == Some(file);
                crates.push(Self::read(root, name, file, is_library)?);
            }
        }
        Ok(crates)
    }

    /// Reads the library or program whose root file this is.
    pub(super) fn read(root: &Path, package: &str, file: &Path, is_library: bool) -> Result<Self> {
        let mut read = Self {
            package: package.to_owned(),
            files: Vec::new(),
            modules: BTreeMap::new(),
            is_library,
        };
        read.add_file(root, file, Vec::new(), true)?;
        Ok(read)
    }

    fn add_file(&mut self, root: &Path, file: &Path, path: ModulePath, is_public: bool) -> Result<()> {
        let text = fs::read_to_string(file).with_context(|| format!("reading {}", file.display()))?;
        let syntax = syn::parse_file(&text).with_context(|| format!("parsing {}", file.display()))?;
        let place = file.strip_prefix(root).unwrap_or(file);
        self.files.push(SourceFile {
            path: place.to_string_lossy().into_owned(),
            lines: text.lines().map(str::to_owned).collect(),
            mentions: Vec::new(),
        });
        let stem = file
            .file_stem()
            .and_then(|stem| stem.to_str())
            .unwrap_or_default();
        let folder = file.parent().unwrap_or(Path::new(""));
        let below = if ["lib", "main", "mod"].contains(&stem) {
            folder.to_owned()
        } else {
            folder.join(stem)
        };
        self.add_module(root, &below, self.files.len() - 1, path, is_public, &syntax.items)
    }

    /// `below` is where files of its modules stand.
    fn add_module(
        &mut self,
        root: &Path,
        below: &Path,
        file: usize,
        path: ModulePath,
        is_public: bool,
        items: &[syn::Item],
    ) -> Result<()> {
        let mut contents = module::read(&path, items);
        self.files[file].mentions.append(&mut contents.mentions);
        for (name, is_public, inline) in contents.children {
            let mut child = path.clone();
            child.push(name.clone());
            match inline {
                Some(items) => self.add_module(root, &below.join(&name), file, child, is_public, &items)?,
                None => self.add_file(root, &file_of(below, &name), child, is_public)?,
            }
        }
        let module = Module {
            file,
            is_public,
            ..contents.module
        };
        self.modules.insert(path, module);
        Ok(())
    }

    /// What `segments`, written in the module `from`, stands for; `None` if it is nothing of this
    /// crate.
    pub fn resolve(&self, from: &[String], segments: &[String]) -> Option<Target> {
        self.resolve_within(from, segments, 0)
    }

    fn resolve_within(&self, from: &[String], segments: &[String], depth: usize) -> Option<Target> {
        if depth > 16 {
            return None; // imports that lead round and round
        }
        let mut at: ModulePath = match segments.first()?.as_str() {
            "crate" => Vec::new(),
            "self" | "super" => from.to_vec(),
            _ => return self.look_up(from, segments, depth),
        };
        let mut rest = segments;
        while let Some(first) = rest.first() {
            match first.as_str() {
                "crate" | "self" => {}
                "super" => {
                    at.pop();
                }
                _ => return self.look_up(&at, rest, depth),
            }
            rest = &rest[1..];
        }
        Some(Target::Module(at))
    }

    /// A name in a module: its own, an imported one, or one of a module all of whose names are
    /// imported.
    fn look_up(&self, at: &[String], segments: &[String], depth: usize) -> Option<Target> {
        let module = self.modules.get(at)?;
        let Some((name, rest)) = segments.split_first() else {
            return Some(Target::Module(at.to_vec()));
        };
        let mut child = at.to_vec();
        child.push(name.clone());
        if module.items.contains_key(name) {
            return Some(Target::Item(at.to_vec(), name.clone()));
        }
        if self.modules.contains_key(&child) {
            return self.look_up(&child, rest, depth);
        }
        if let Some((path, _)) = module.imports.get(name) {
            let longer: Vec<String> = path.iter().chain(rest).cloned().collect();
            if longer == segments {
                return None; // `use name;` of another crate
            }
            return self.resolve_within(at, &longer, depth + 1);
        }
        module.globs.iter().find_map(|(path, _)| {
            let longer: Vec<String> = path.iter().chain(segments).cloned().collect();
            self.resolve_within(at, &longer, depth + 1)
        })
    }
}

fn file_of(below: &Path, name: &str) -> PathBuf {
    let file = below.join(format!("{name}.rs"));
    if file.exists() {
        file
    } else {
        below.join(name).join("mod.rs")
    }
}
