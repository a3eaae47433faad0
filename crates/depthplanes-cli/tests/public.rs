//! The public items of the libraries are those of their lists, `crates/*/api.txt`, so that a change of them is seen.
//! `make golden` writes the lists anew.

use quote::ToTokens;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use syn::{Attribute, Fields, ImplItem, Item, TraitItem, Type, UseTree, Visibility};

type Module = Vec<String>;

/// A crate's sources by module.
struct Sources {
    files: BTreeMap<Module, syn::File>,
}

impl Sources {
    fn of(root: &Path) -> Self {
        let mut files = BTreeMap::new();
        Self::collect(root, &Module::new(), &mut files);
        Sources { files }
    }

    fn collect(folder: &Path, above: &Module, files: &mut BTreeMap<Module, syn::File>) {
        for path in folder.read_dir().unwrap().map(|entry| entry.unwrap().path()) {
            let stem = path.file_stem().unwrap().to_str().unwrap().to_string();
            let mut module = above.clone();
            if path.is_dir() {
                module.push(stem);
                Self::collect(&path, &module, files);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                module.extend((!["mod", "lib"].contains(&stem.as_str())).then_some(stem));
                files.insert(module, syn::parse_file(&std::fs::read_to_string(&path).unwrap()).unwrap());
            }
        }
    }

    /// The item of that name in a module, or where a `use` there takes it from.
    fn find(&self, module: &Module, name: &str) -> Option<&Item> {
        let items = &self.files.get(module)?.items;
        let own = items.iter().find(|item| ident(item).is_some_and(|ident| ident == name));
        own.or_else(|| {
            let uses = items.iter().filter_map(|item| if let Item::Use(uses) = item { Some(&uses.tree) } else { None });
            let paths = uses.flat_map(paths).find(|path| path.last().is_some_and(|last| last == name))?;
            let (from, name) = self.resolve(module, &paths)?;
            self.find(&from, &name)
        })
    }

    /// The module and the name of what a path means in a module.
    fn resolve(&self, module: &Module, path: &[String]) -> Option<(Module, String)> {
        let (name, parts) = path.split_last()?;
        let mut at = module.clone();
        for part in parts {
            match part.as_str() {
                "crate" => at.clear(),
                "super" => drop(at.pop()),
                "self" => (),
                part => at.push(part.to_string()),
            }
        }
        self.files.contains_key(&at).then(|| (at, name.clone()))
    }

    /// What the macro `setters!` gives a struct of parameters.
    fn setters(&self, of: &str) -> Vec<String> {
        let items = self.files.values().flat_map(|file| &file.items);
        let macros = items.filter_map(|item| if let Item::Macro(item) = item { Some(&item.mac) } else { None });
        let lists = macros.filter(|of| of.path.is_ident("setters")).map(|list| list.tokens.to_string());
        let own =
            lists.filter_map(|list| Some(list.split_once(':').filter(|(name, _)| name.trim() == of)?.1.to_string()));
        let fields =
            own.flat_map(|list| list.split(',').map(|field| field.trim().replace(" :", ":")).collect::<Vec<_>>());
        fields.filter_map(|field| Some(format!("fn {}(self, {field}) -> Self", field.split_once(':')?.0))).collect()
    }

    /// Every `impl` of the crate.
    fn impls(&self) -> impl Iterator<Item = &syn::ItemImpl> {
        let items = self.files.values().flat_map(|file| &file.items);
        items.filter_map(|item| if let Item::Impl(block) = item { Some(block) } else { None })
    }
}

fn ident(item: &Item) -> Option<&syn::Ident> {
    match item {
        Item::Struct(item) => Some(&item.ident),
        Item::Enum(item) => Some(&item.ident),
        Item::Trait(item) => Some(&item.ident),
        Item::Fn(item) => Some(&item.sig.ident),
        Item::Const(item) => Some(&item.ident),
        Item::Static(item) => Some(&item.ident),
        Item::Type(item) => Some(&item.ident),
        _ => None,
    }
}

fn attributes(item: &Item) -> &[Attribute] {
    match item {
        Item::Struct(item) => &item.attrs,
        Item::Enum(item) => &item.attrs,
        _ => &[],
    }
}

/// The traits that a `derive` names.
fn derived(attribute: &Attribute) -> Vec<String> {
    let text = attribute.meta.require_list().expect("traits in parentheses").tokens.to_string();
    text.split(',').map(|name| name.trim().to_string()).filter(|name| !name.is_empty()).collect()
}

/// The paths that a `use` names, each with the name that it gives.
fn named(tree: &UseTree) -> Vec<(Vec<String>, String)> {
    let within = |first: &syn::Ident, rest: Vec<(Vec<String>, String)>| {
        rest.into_iter().map(|(path, shown)| ([vec![first.to_string()], path].concat(), shown)).collect()
    };
    match tree {
        UseTree::Path(path) => within(&path.ident, named(&path.tree)),
        UseTree::Group(group) => group.items.iter().flat_map(named).collect(),
        UseTree::Name(name) => vec![(vec![name.ident.to_string()], name.ident.to_string())],
        UseTree::Rename(name) => vec![(vec![name.ident.to_string()], name.rename.to_string())],
        UseTree::Glob(_) => panic!("a public `use` names what it takes"),
    }
}

/// The paths that a `use` names.
fn paths(tree: &UseTree) -> Vec<Vec<String>> {
    named(tree).into_iter().map(|(path, _)| path).collect()
}

fn is_public(visibility: &Visibility) -> bool {
    matches!(visibility, Visibility::Public(_))
}

fn is_hidden(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| attribute.to_token_stream().to_string().contains("hidden"))
}

/// Rust as text, on one line.
fn text(tokens: &impl ToTokens) -> String {
    let text = tokens.to_token_stream().to_string();
    let closer =
        [(" :: ", "::"), ("& ", "&"), (" < ", "<"), ("< ", "<"), (" <", "<"), (" >", ">"), (" ,", ","), (" ;", ";")];
    let text = closer.iter().fold(text, |text, (from, to)| text.replace(from, to));
    [(" (", "("), ("( ", "("), (" )", ")"), ("[ ", "["), (" ]", "]"), (" : ", ": "), ("->", " -> "), ("  ", " ")]
        .iter()
        .fold(text, |text, (from, to)| text.replace(from, to))
}

/// Lists an item, under the name that it is shown by, and what is public of it.
fn list(sources: &Sources, place: &str, shown: &str, item: &Item, lines: &mut BTreeSet<String>) {
    let name = ident(item).expect("it was found by its name").to_string();
    let whole = format!("{place}::{shown}");
    for name in attributes(item).iter().filter(|attribute| attribute.path().is_ident("derive")).flat_map(derived) {
        lines.insert(format!("{whole} is {name}"));
    }
    let grows = |attributes: &[Attribute]| {
        let may = attributes.iter().any(|attribute| attribute.path().is_ident("non_exhaustive"));
        if may { ", non-exhaustive" } else { "" }
    };
    match item {
        Item::Struct(item) => {
            let fields = if let Fields::Named(fields) = &item.fields { Some(&fields.named) } else { None };
            lines.insert(format!("{whole} struct{}", grows(&item.attrs)));
            for field in fields.into_iter().flatten().filter(|field| is_public(&field.vis)) {
                lines.insert(format!("{whole}.{}: {}", field.ident.as_ref().unwrap(), text(&field.ty)));
            }
        }
        Item::Enum(item) => {
            lines.insert(format!("{whole} enum{}", grows(&item.attrs)));
            for variant in &item.variants {
                let fields = variant.fields.iter().map(|field| {
                    field.ident.as_ref().map_or_else(|| text(&field.ty), |name| format!("{name}: {}", text(&field.ty)))
                });
                let fields: Vec<String> = fields.collect();
                lines.insert(format!("{whole}::{} {}", variant.ident, fields.join(", ")).trim_end().to_string());
            }
        }
        Item::Trait(item) => {
            lines.insert(format!("{whole} trait: {}", text(&item.supertraits)));
            for item in &item.items {
                match item {
                    TraitItem::Fn(function) => drop(lines.insert(format!("{whole}::{}", text(&function.sig)))),
                    TraitItem::Const(item) => {
                        lines.insert(format!("{whole}::{}: {}", item.ident, text(&item.ty)));
                    }
                    _ => (),
                }
            }
        }
        Item::Fn(item) => {
            let signature = text(&item.sig).replacen(&format!("fn {name}"), &format!("fn {shown}"), 1);
            lines.insert(format!("{place}::{signature}"));
        }
        Item::Const(item) => drop(lines.insert(format!("{whole} const: {}", text(&item.ty)))),
        Item::Static(item) => drop(lines.insert(format!("{whole} static: {}", text(&item.ty)))),
        Item::Type(item) => drop(lines.insert(format!("{whole} = {}", text(&item.ty)))),
        _ => (),
    }
    list_methods(sources, &whole, &name, lines);
}

/// Lists what is public of the `impl`s of a type of that name.
fn list_methods(sources: &Sources, whole: &str, name: &str, lines: &mut BTreeSet<String>) {
    for setter in sources.setters(name) {
        lines.insert(format!("{whole}::{setter}"));
    }
    for block in sources.impls() {
        let Type::Path(of) = &*block.self_ty else { continue };
        if of.path.segments.last().is_none_or(|last| last.ident != name) {
            continue;
        }
        match &block.trait_ {
            Some((_, path, _)) if path.segments.last().is_some_and(|last| last.ident != "Sealed") => {
                lines.insert(format!("{whole} is {}", text(path)));
            }
            Some(_) => (),
            None => {
                for item in &block.items {
                    match item {
                        ImplItem::Fn(function) if is_public(&function.vis) && !is_hidden(&function.attrs) => {
                            lines.insert(format!("{whole}::{}", text(&function.sig)));
                        }
                        ImplItem::Const(item) if is_public(&item.vis) => {
                            lines.insert(format!("{whole}::{}: {}", item.ident, text(&item.ty)));
                        }
                        _ => (),
                    }
                }
            }
        }
    }
}

/// Lists what is public in a module.
fn list_module(sources: &Sources, module: &Module, place: &str, lines: &mut BTreeSet<String>) {
    for item in &sources.files[module].items {
        match item {
            Item::Mod(inner) if is_public(&inner.vis) && !is_hidden(&inner.attrs) => {
                let name = inner.ident.to_string();
                let below: Module = module.iter().cloned().chain([name.clone()]).collect();
                lines.insert(format!("{place}::{name} module"));
                list_module(sources, &below, &format!("{place}::{name}"), lines);
            }
            Item::Use(uses) if is_public(&uses.vis) && !is_hidden(&uses.attrs) => {
                for (path, shown) in named(&uses.tree) {
                    let found = sources.resolve(module, &path).and_then(|(from, name)| sources.find(&from, &name));
                    list(sources, place, &shown, found.unwrap_or_else(|| panic!("{place}: {path:?}")), lines);
                }
            }
            Item::Macro(item) if item.attrs.iter().any(|attribute| attribute.path().is_ident("macro_export")) => {
                // Whatever module it stands in, it is named from the crate.
                let root = place.split("::").next().unwrap_or(place);
                lines.insert(format!("{root}::{} macro", item.ident.as_ref().unwrap()));
            }
            item => {
                let is_open = match item {
                    Item::Struct(item) => is_public(&item.vis) && !is_hidden(&item.attrs),
                    Item::Enum(item) => is_public(&item.vis),
                    Item::Trait(item) => is_public(&item.vis),
                    Item::Fn(item) => is_public(&item.vis),
                    Item::Const(item) => is_public(&item.vis),
                    Item::Static(item) => is_public(&item.vis),
                    Item::Type(item) => is_public(&item.vis),
                    _ => false,
                };
                if is_open {
                    list(sources, place, &ident(item).expect("it has a name").to_string(), item, lines);
                }
            }
        }
    }
}

#[test]
fn the_public_items_are_those_of_the_lists() {
    for (name, least) in [
        ("depthplanes", 100),
        ("depthplanes-io", 100),
        ("depthplanes-video", 20),
        ("depthplanes-serve", 20),
        ("depthplanes-ros2", 20),
        ("depthplanes-cli", 0),
    ] {
        let folder: PathBuf = [env!("CARGO_MANIFEST_DIR"), "..", name].iter().collect();
        let mut lines = BTreeSet::new();
        list_module(&Sources::of(&folder.join("src")), &Module::new(), &name.replace('-', "_"), &mut lines);
        let found: String = lines.into_iter().map(|line| line + "\n").collect();
        let file = folder.join("api.txt");
        if std::env::var_os("DEPTHPLANES_GOLDEN").is_some_and(|value| value == "update") {
            std::fs::write(&file, &found).unwrap();
        }
        let listed = std::fs::read_to_string(&file).unwrap_or_default();
        let differ = |from: &str, other: &str| {
            let known: BTreeSet<&str> = other.lines().collect();
            from.lines().filter(|line| !known.contains(line)).map(|line| format!("\n  {line}")).collect::<String>()
        };
        assert!(
            found == listed,
            "{name}: the public items have changed; if that is meant, run `make golden` and say it in CHANGELOG.md\nnew:{}\ngone:{}",
            differ(&found, &listed),
            differ(&listed, &found)
        );
        assert!(found.lines().count() > least, "{found}");
    }
}
