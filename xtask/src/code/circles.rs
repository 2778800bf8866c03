//! Files that import each other in a circle.
//!
//! A file imports another if it names something that the other defines, outside its tests: in a
//! `use`, or by a path in its code. What counts is the file that defines the thing, not the one
//! that a re-export passes it on through: `crate::linear::Solver` is an import of the file of
//! `Solver`, and a `mod.rs` that does no more than `pub use` its files' names imports none of them.
//! A module that is named only to reach something in it is no import either.
//!
//! Between files of different folders no circle is allowed. Files of one folder may form one where
//! the comment `// circle: why` stands at the end of the line that closes it, or on the line above:
//! that file's imports of the other one do not count then.

use std::collections::{BTreeMap, BTreeSet};

use super::tree::{Crate, Target};

/// Imports of files, by index: the line of the first one.
type Imports = BTreeMap<(usize, usize), usize>;

/// The circles of a library or program, one text each.
pub fn circles(sources: &Crate) -> Vec<String> {
    let imports = imports(sources);
    let circles = knots(sources.files.len(), &imports);
    circles
        .iter()
        .map(|knot| describe(sources, &imports, knot))
        .collect()
}

fn imports(sources: &Crate) -> Imports {
    let mut imports = Imports::new();
    let mut explained = BTreeSet::new();
    for (from, file) in sources.files.iter().enumerate() {
        for mention in &file.mentions {
            let Some(Target::Item(module, _)) = sources.resolve(&mention.module, &mention.segments) else {
                continue;
            };
            let to = sources.modules[&module].file;
            if to == from || mention.is_reexport {
                continue;
            }
            let same_folder = folder(&file.path) == folder(&sources.files[to].path);
            if same_folder && says_why(&file.lines, mention.line) {
                explained.insert((from, to));
            }
            let first = imports.entry((from, to)).or_insert(mention.line);
            *first = mention.line.min(*first);
        }
    }
    imports.retain(|pair, _| !explained.contains(pair));
    imports
}

fn folder(path: &str) -> &str {
    path.rsplit_once('/').map_or("", |(folder, _)| folder)
}

/// `line` counts from 1.
fn says_why(lines: &[String], line: usize) -> bool {
    let reason = |line: Option<&String>| {
        let reason = line.and_then(|line| line.split_once("// circle: "));
        reason.is_some_and(|(_, reason)| !reason.trim().is_empty())
    };
    reason(lines.get(line - 1)) || line >= 2 && reason(lines.get(line - 2))
}

/// Sets of files each of which reaches each other one.
fn knots(files: usize, imports: &Imports) -> Vec<BTreeSet<usize>> {
    let reached: Vec<BTreeSet<usize>> = (0..files)
        .map(|start| {
            let mut reached = BTreeSet::new();
            let mut pending = vec![start];
            while let Some(from) = pending.pop() {
                for &(_, to) in imports.range((from, 0)..(from + 1, 0)).map(|(pair, _)| pair) {
                    if reached.insert(to) {
                        pending.push(to);
                    }
                }
            }
            reached
        })
        .collect();
    let mut knots: Vec<BTreeSet<usize>> = (0..files)
        .filter(|file| reached[*file].contains(file))
        .map(|file| {
            let back = reached[file]
                .iter()
                .filter(|other| reached[**other].contains(&file));
            back.copied().collect()
        })
        .collect();
    knots.sort();
    knots.dedup();
    knots
}

fn describe(sources: &Crate, imports: &Imports, knot: &BTreeSet<usize>) -> String {
    let folders: BTreeSet<&str> = knot
        .iter()
        .map(|file| folder(&sources.files[*file].path))
        .collect();
    let mut text = if folders.len() > 1 {
        "files of different folders import each other in a circle:".to_owned()
    } else {
        "files import each other in a circle, and none says why:".to_owned()
    };
    for (&(from, to), line) in imports {
        if knot.contains(&from) && knot.contains(&to) {
            text += &format!(
                "\n  {}:{line} imports {}",
                sources.files[from].path, sources.files[to].path
            );
        }
    }
    text
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)] // a test that cannot set itself up has failed

    use std::fs;

    use super::*;

    /// What is found in a library of these files.
    fn circles_of(files: &[(&str, &str)]) -> Vec<String> {
        let folder = tempfile::tempdir().unwrap();
        for (name, text) in files {
            let path = folder.path().join("src").join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        }
        let library = folder.path().join("src/lib.rs");
        circles(&Crate::read(folder.path(), "invented", &library, true).unwrap())
    }

    const ONE: &str = "pub struct One(crate::two::Two);";

    #[test]
    fn files_of_two_folders_may_not_import_each_other_and_no_comment_helps() {
        let two = "// circle: because\nuse crate::one::One;\npub struct Two(Box<One>);";
        let found = circles_of(&[
            ("lib.rs", "mod one;\nmod two;"),
            ("one.rs", ONE),
            ("two/mod.rs", two),
        ]);
        assert_eq!(found.len(), 1);
        assert!(
            found[0].contains("src/one.rs:1 imports src/two/mod.rs"),
            "{found:?}"
        );
        assert!(
            found[0].contains("src/two/mod.rs:2 imports src/one.rs"),
            "{found:?}"
        );
    }

    #[test]
    fn files_of_one_folder_may_where_it_says_why() {
        let two = "use crate::one::One;\npub struct Two(Box<One>);";
        let files =
            |two: &str| circles_of(&[("lib.rs", "mod one;\nmod two;"), ("one.rs", ONE), ("two.rs", two)]);
        assert_eq!(files(two).len(), 1);
        assert_eq!(files(&format!("// circle: \n{two}")).len(), 1);
        assert!(files(&format!("// circle: a One holds a Two, which holds a One\n{two}")).is_empty());
    }

    #[test]
    fn what_is_passed_on_counts_for_the_file_that_defines_it() {
        let library = "mod one;\nmod two;\npub use one::One;\npub use two::*;";
        let found = circles_of(&[
            ("lib.rs", library),
            ("one.rs", "pub struct One;"),
            ("two/mod.rs", "mod three;\npub use three::Three;"),
            ("two/three.rs", "pub struct Three(crate::One);"),
        ]);
        assert_eq!(found, Vec::<String>::new());
    }

    #[test]
    fn paths_in_code_and_in_macros_are_imports_and_tests_are_not() {
        let macros = "pub fn two() { println!(\"{}\", crate::one::one()); }";
        let files = |two: &str| {
            let one = "pub fn one() -> usize { super::two::two(); 1 }";
            circles_of(&[("lib.rs", "mod one;\nmod two;"), ("one.rs", one), ("two.rs", two)])
        };
        assert_eq!(files(macros).len(), 1);
        assert!(
            files(&format!(
                "#[cfg(test)]\nmod tests {{ {macros} }}\npub fn two() {{}}"
            ))
            .is_empty()
        );
    }
}
