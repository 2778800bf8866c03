//! Who depends on whom, as Cargo says it.

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, bail};
use serde::Deserialize;

/// The packages of this workspace, by name.
#[derive(Debug)]
pub struct Graph {
    /// By package name.
    pub packages: BTreeMap<String, Package>,
}

/// A package of this workspace.
#[derive(Debug)]
pub struct Package {
    /// Its folder, from the root of the checkout.
    pub folder: String,
    /// What its `Cargo.toml` says it is.
    pub description: Option<String>,
    /// The root file of its library, if it has one.
    pub lib_file: Option<PathBuf>,
    /// The root files of its programs, and of a library for other languages.
    pub programs: Vec<PathBuf>,
    /// Packages that it is built with, those of others included.
    pub dependencies: BTreeSet<String>,
    /// Packages that only its tests, examples and benchmarks are built with.
    pub dev_dependencies: BTreeSet<String>,
}

#[derive(Deserialize)]
struct Metadata {
    packages: Vec<MetadataPackage>,
}

#[derive(Deserialize)]
struct MetadataPackage {
    name: String,
    description: Option<String>,
    manifest_path: PathBuf,
    dependencies: Vec<MetadataDependency>,
    targets: Vec<MetadataTarget>,
}

#[derive(Deserialize)]
struct MetadataDependency {
    name: String,
    kind: Option<String>,
}

#[derive(Deserialize)]
struct MetadataTarget {
    kind: Vec<String>,
    src_path: PathBuf,
}

impl Graph {
    /// Asks Cargo about the workspace at `root`.
    pub fn read(root: &Path) -> Result<Self> {
        let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
        let output = Command::new(cargo)
            .args(["metadata", "--format-version", "1", "--no-deps", "--offline"])
            .current_dir(root)
            .output()
            .context("starting cargo metadata")?;
        if !output.status.success() {
            bail!("cargo metadata: {}", String::from_utf8_lossy(&output.stderr));
        }
        let metadata: Metadata = serde_json::from_slice(&output.stdout).context("cargo metadata")?;
        let packages = metadata
            .packages
            .into_iter()
            .map(|package| Ok((package.name.clone(), package.read(root)?)))
            .collect::<Result<_>>()?;
        Ok(Self { packages })
    }

    /// The package of this name.
    pub fn package(&self, name: &str) -> Result<&Package> {
        self.packages
            .get(name)
            .with_context(|| format!("there is no package `{name}` in the workspace"))
    }

    /// How `start` reaches each package that it is built with, the shortest way: the packages in
    /// between, `start` first, the reached one last. What packages of others depend on does not
    /// count, nor do ways through a package for which `ends` holds.
    pub fn ways_from(
        &self,
        start: &str,
        ends: impl Fn(&str) -> bool,
    ) -> Result<BTreeMap<String, Vec<String>>> {
        self.package(start)?;
        let mut ways: BTreeMap<String, Vec<String>> = BTreeMap::new();
        let mut pending = VecDeque::from([vec![start.to_owned()]]);
        while let Some(way) = pending.pop_front() {
            let Some(package) = way.last().and_then(|name| self.packages.get(name)) else {
                continue;
            };
            for next in &package.dependencies {
                if !ways.contains_key(next) {
                    let longer: Vec<String> = way.iter().chain([next]).cloned().collect();
                    ways.insert(next.clone(), longer.clone());
                    if !ends(next) {
                        pending.push_back(longer);
                    }
                }
            }
        }
        Ok(ways)
    }
}

impl MetadataPackage {
    fn read(self, root: &Path) -> Result<Package> {
        let root = root.canonicalize()?;
        let folder = self
            .manifest_path
            .parent()
            .unwrap_or(Path::new(""))
            .canonicalize()?;
        let folder = folder.strip_prefix(&root)?.to_string_lossy().into_owned();
        let names = |is_wanted: fn(Option<&str>) -> bool| {
            let wanted = self
                .dependencies
                .iter()
                .filter(|dependency| is_wanted(dependency.kind.as_deref()));
            wanted.map(|dependency| dependency.name.clone()).collect()
        };
        let targets = |kinds: &[&str]| {
            let of_kind =
                |target: &&MetadataTarget| target.kind.iter().any(|kind| kinds.contains(&kind.as_str()));
            let found: Vec<_> = self
                .targets
                .iter()
                .filter(of_kind)
                .map(|target| target.src_path.clone())
                .collect();
            found
        };
        Ok(Package {
            folder,
            lib_file: targets(&["lib", "rlib", "proc-macro"]).into_iter().next(),
            programs: targets(&["bin", "cdylib"]),
            dependencies: names(|kind| kind != Some("dev")),
            dev_dependencies: names(|kind| kind == Some("dev")),
            description: self.description,
        })
    }
}
