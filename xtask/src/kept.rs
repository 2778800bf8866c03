//! What each kept value is made from, read from the code: the fields of what makes it are its key.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use quote::ToTokens;
use syn::{Attribute, Expr, ImplItem, Item, ItemImpl, ItemStruct, Type};

use crate::code::{identifiers, rust_files};

/// The traits of `crates/base/store` whose implementors make a value from their fields.
const MAKERS: [&str; 2] = ["Stage", "Recipe"];

/// A structure, and the file that it stands in.
type Structure = (PathBuf, ItemStruct);

/// The table of docs/reference/crates.md: each stage and each kept value, with the fields that it
/// is made from.
pub fn table(root: &Path) -> Result<String> {
    let mut makers = Vec::new();
    let mut structures = Vec::new();
    for path in rust_files(root, &["crates/app"])? {
        let source = fs::read_to_string(&path).with_context(|| format!("reading {}", path.display()))?;
        let file = syn::parse_file(&source).with_context(|| path.display().to_string())?;
        for item in file.items {
            if let Some(maker) = maker(&item) {
                makers.push((path.clone(), maker));
            } else if let Item::Struct(structure) = item {
                structures.push((path.clone(), structure));
            }
        }
    }
    let mut text = "\n| kept | made from | in |\n|---|---|---|\n".to_owned();
    for (path, maker) in makers {
        let shown = path.strip_prefix(root).unwrap_or(&path).display();
        let name = type_name(&maker.self_ty);
        let kept = stage(&maker).map_or_else(|| format!("`{name}`"), |stage| format!("stage `{stage}`"));
        let fields = fields(&structures, &path, &name).with_context(|| shown.to_string())?;
        text += &format!("| {kept} | {} | `{shown}` |\n", fields.join(", "));
    }
    Ok(text + "\n")
}

/// An implementation of one of [`MAKERS`].
fn maker(item: &Item) -> Option<ItemImpl> {
    let Item::Impl(found) = item else { return None };
    let (_, of, _) = found.trait_.as_ref()?;
    let name = &of.segments.last()?.ident;
    MAKERS.iter().any(|maker| name == maker).then(|| found.clone())
}

/// The name of a stage, if it is one and says its name there.
fn stage(maker: &ItemImpl) -> Option<String> {
    maker.items.iter().find_map(|item| match item {
        ImplItem::Const(constant) if constant.ident == "NAME" => match &constant.expr {
            Expr::Lit(literal) => Some(literal.to_token_stream().to_string().trim_matches('"').to_owned()),
            _ => None,
        },
        _ => None,
    })
}

/// The name of a type, without what it borrows and what it is of.
fn type_name(of: &Type) -> String {
    match of {
        Type::Reference(reference) => type_name(&reference.elem),
        Type::Path(path) => path
            .path
            .segments
            .last()
            .map(|last| last.ident.to_string())
            .unwrap_or_default(),
        _ => String::new(),
    }
}

/// What is serialized of a structure, and so is in the key. One of its own file is meant before
/// others of that name.
fn fields(structures: &[Structure], path: &Path, name: &str) -> Result<Vec<String>> {
    let named = || structures.iter().filter(|(_, structure)| structure.ident == name);
    let (path, structure) = named()
        .find(|(own, _)| own == path)
        .or_else(|| named().next())
        .with_context(|| format!("there is no `{name}` in crates/app"))?;
    let mut all = Vec::new();
    for field in &structure.fields {
        let serde = |word: &str| field.attrs.iter().any(|attribute| says(attribute, word));
        if serde("skip") {
            continue;
        }
        match &field.ident {
            Some(_) if serde("flatten") => all.extend(fields(structures, path, &type_name(&field.ty))?),
            Some(ident) => all.push(ident.to_string().replace('_', " ")),
            None => all.push(type_name(&field.ty)),
        }
    }
    Ok(all)
}

fn says(attribute: &Attribute, word: &str) -> bool {
    let words = || identifiers(attribute.to_token_stream());
    attribute.path().is_ident("serde") && words().contains(word)
}
