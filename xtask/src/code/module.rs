//! A module: what it defines, what it imports, what it mentions.

use std::collections::{BTreeMap, BTreeSet};

use proc_macro2::{Span, TokenStream};
use quote::ToTokens;
use syn::visit::{self, Visit};

use super::file::{Mention, identifiers, paths_in};

/// A module's name from the crate's root; the root's is empty.
pub type ModulePath = Vec<String>;

/// A module outside tests.
#[derive(Debug, Default)]
pub struct Module {
    /// The file that it stands in, as an index of the crate's files.
    pub file: usize,
    /// It can be reached by whoever reaches the module around it.
    pub is_public: bool,
    /// What it defines, by name.
    pub items: BTreeMap<String, Item>,
    /// Names that it imports, with the path that each stands for, and whether it is public.
    pub imports: BTreeMap<String, (Vec<String>, bool)>,
    /// Modules all of whose names it imports, and whether they are public.
    pub globs: Vec<(Vec<String>, bool)>,
    /// Public methods and constants of types: the type, the name, the signature's line and tokens.
    pub methods: Vec<(String, Item)>,
}

/// Something that a module defines.
#[derive(Clone, Debug)]
pub struct Item {
    /// Its name.
    pub name: String,
    /// The line of its name.
    pub line: usize,
    /// `pub`, and nothing less.
    pub is_public: bool,
    /// Identifiers in what of it others see: signatures, public fields, variants.
    pub signature: BTreeSet<String>,
}

/// What one module holds, before it is known where its files are.
#[derive(Default)]
pub(super) struct Contents {
    pub(super) module: Module,
    pub(super) mentions: Vec<Mention>,
    /// Its modules: name, public or not, and the items of one that stands in the same file.
    pub(super) children: Vec<(String, bool, Option<Vec<syn::Item>>)>,
}

/// Reads a module's items.
pub(super) fn read(path: &[String], items: &[syn::Item]) -> Contents {
    let mut reader = Reader {
        path: path.to_vec(),
        contents: Contents::default(),
        inside: 0,
    };
    for item in items {
        reader.visit_item(item);
    }
    reader.contents
}

struct Reader {
    path: ModulePath,
    contents: Contents,
    /// How many items deep: only what stands directly in the module is its own.
    inside: usize,
}

impl Reader {
    fn mention(&mut self, segments: Vec<String>, span: Span, is_reexport: bool) {
        self.contents.mentions.push(Mention {
            segments,
            line: span.start().line,
            module: self.path.clone(),
            is_reexport,
        });
    }

    fn import(&mut self, tree: &syn::UseTree, before: &[String], visibility: &syn::Visibility) {
        let is_reexport = !matches!(visibility, syn::Visibility::Inherited);
        let is_public = matches!(visibility, syn::Visibility::Public(_));
        let joined = |ident: &syn::Ident| {
            let mut path = before.to_vec();
            if ident != "self" || before.is_empty() {
                path.push(ident.to_string());
            }
            path
        };
        match tree {
            syn::UseTree::Path(path) => self.import(&path.tree, &joined(&path.ident), visibility),
            syn::UseTree::Name(name) => {
                let path = joined(&name.ident);
                let bound = path.last().cloned().unwrap_or_default();
                self.mention(path.clone(), name.ident.span(), is_reexport);
                self.contents.module.imports.insert(bound, (path, is_public));
            }
            syn::UseTree::Rename(rename) => {
                let path = joined(&rename.ident);
                self.mention(path.clone(), rename.ident.span(), is_reexport);
                let bound = rename.rename.to_string();
                self.contents.module.imports.insert(bound, (path, is_public));
            }
            syn::UseTree::Glob(glob) => {
                self.mention(before.to_vec(), glob.star_token.spans[0], is_reexport);
                self.contents.module.globs.push((before.to_vec(), is_public));
            }
            syn::UseTree::Group(group) => {
                for tree in &group.items {
                    self.import(tree, before, visibility);
                }
            }
        }
    }

    fn define(&mut self, item: &syn::Item) {
        let Some((ident, visibility, signature)) = definition(item) else {
            return;
        };
        let item = Item {
            name: ident.to_string(),
            line: ident.span().start().line,
            is_public: matches!(visibility, syn::Visibility::Public(_)),
            signature: identifiers(signature),
        };
        self.contents.module.items.insert(item.name.clone(), item);
    }

    /// Public methods of `impl Type`, and what `impl Trait for Type` says of other types.
    fn define_methods(&mut self, item: &syn::ItemImpl) {
        let syn::Type::Path(of) = &*item.self_ty else {
            return;
        };
        let Some(of) = of.path.segments.last().map(|segment| segment.ident.to_string()) else {
            return;
        };
        for member in &item.items {
            let (ident, visibility, signature) = match member {
                syn::ImplItem::Fn(method) => (&method.sig.ident, &method.vis, method.sig.to_token_stream()),
                syn::ImplItem::Const(constant) => {
                    (&constant.ident, &constant.vis, constant.ty.to_token_stream())
                }
                syn::ImplItem::Type(alias) => (&alias.ident, &alias.vis, alias.ty.to_token_stream()),
                _ => continue,
            };
            let of_trait = item.trait_.is_some();
            if of_trait || matches!(visibility, syn::Visibility::Public(_)) {
                let item = Item {
                    name: ident.to_string(),
                    line: ident.span().start().line,
                    is_public: !of_trait,
                    signature: identifiers(signature),
                };
                self.contents.module.methods.push((of.clone(), item));
            }
        }
    }
}

impl<'ast> Visit<'ast> for Reader {
    fn visit_item(&mut self, item: &'ast syn::Item) {
        if attributes(item).iter().any(is_for_tests) {
            return;
        }
        if let syn::Item::Mod(module) = item {
            let is_public = matches!(module.vis, syn::Visibility::Public(_));
            let items = module.content.as_ref().map(|(_, items)| items.clone());
            self.contents
                .children
                .push((module.ident.to_string(), is_public, items));
            return;
        }
        if self.inside == 0 {
            self.define(item);
            if let syn::Item::Impl(item) = item {
                self.define_methods(item);
            }
        }
        self.inside += 1;
        visit::visit_item(self, item);
        self.inside -= 1;
    }

    fn visit_item_use(&mut self, item: &'ast syn::ItemUse) {
        self.import(&item.tree, &[], &item.vis);
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        let segments = path.segments.iter().map(|segment| segment.ident.to_string());
        if let Some(first) = path.segments.first() {
            self.mention(segments.collect(), first.ident.span(), false);
        }
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, call: &'ast syn::Macro) {
        visit::visit_macro(self, call);
        let mut found = Vec::new();
        paths_in(call.tokens.clone(), &mut found);
        for (segments, line) in found {
            self.contents.mentions.push(Mention {
                segments,
                line,
                module: self.path.clone(),
                is_reexport: false,
            });
        }
    }

    fn visit_attribute(&mut self, _: &'ast syn::Attribute) {}

    fn visit_visibility(&mut self, _: &'ast syn::Visibility) {}
}

/// `#[cfg(test)]`, alone or with other conditions.
fn is_for_tests(attribute: &syn::Attribute) -> bool {
    let tokens = attribute.meta.to_token_stream().to_string();
    attribute.path().is_ident("cfg") && tokens.contains("test") && !tokens.contains("not")
}

fn attributes(item: &syn::Item) -> &[syn::Attribute] {
    match item {
        syn::Item::Const(item) => &item.attrs,
        syn::Item::Enum(item) => &item.attrs,
        syn::Item::Fn(item) => &item.attrs,
        syn::Item::Impl(item) => &item.attrs,
        syn::Item::Macro(item) => &item.attrs,
        syn::Item::Mod(item) => &item.attrs,
        syn::Item::Static(item) => &item.attrs,
        syn::Item::Struct(item) => &item.attrs,
        syn::Item::Trait(item) => &item.attrs,
        syn::Item::Type(item) => &item.attrs,
        syn::Item::Use(item) => &item.attrs,
        _ => &[],
    }
}

/// Name, visibility, and what others see of it.
fn definition(item: &syn::Item) -> Option<(&syn::Ident, &syn::Visibility, TokenStream)> {
    const INHERITED: &syn::Visibility = &syn::Visibility::Inherited;
    Some(match item {
        syn::Item::Const(item) => (&item.ident, &item.vis, item.ty.to_token_stream()),
        syn::Item::Enum(item) => (
            &item.ident,
            &item.vis,
            item.variants
                .iter()
                .map(|variant| variant.fields.to_token_stream())
                .collect(),
        ),
        syn::Item::Fn(item) => (&item.sig.ident, &item.vis, item.sig.to_token_stream()),
        syn::Item::Macro(item) => (item.ident.as_ref()?, INHERITED, TokenStream::new()),
        syn::Item::Static(item) => (&item.ident, &item.vis, item.ty.to_token_stream()),
        syn::Item::Struct(item) => {
            let fields = item.fields.iter();
            let seen = fields.filter(|field| matches!(field.vis, syn::Visibility::Public(_)));
            let mut signature: TokenStream = seen.map(|field| field.ty.to_token_stream()).collect();
            signature.extend(item.generics.to_token_stream());
            (&item.ident, &item.vis, signature)
        }
        syn::Item::Trait(item) => {
            let mut signature = item.supertraits.to_token_stream();
            for member in &item.items {
                match member {
                    syn::TraitItem::Fn(method) => signature.extend(method.sig.to_token_stream()),
                    other => signature.extend(other.to_token_stream()),
                }
            }
            (&item.ident, &item.vis, signature)
        }
        syn::Item::Type(item) => (&item.ident, &item.vis, item.ty.to_token_stream()),
        _ => return None,
    })
}
