//! No source file knows one that, by whatever way round, knows it.
//!
//! A file knows another if it names one of its items by a path, in a `use` or elsewhere. Saying `mod name;` is not knowing.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use syn::visit::{self, Visit};

/// The place of a module in its crate: `[noise, scales]`.
type Module = Vec<String>;

/// The files of a crate by module.
fn files(root: &Path) -> BTreeMap<Module, PathBuf> {
    fn collect(folder: &Path, above: &Module, files: &mut BTreeMap<Module, PathBuf>) {
        for entry in folder.read_dir().unwrap().map(|entry| entry.unwrap().path()) {
            let stem = entry.file_stem().unwrap().to_str().unwrap().to_string();
            let mut module = above.clone();
            if entry.is_dir() {
                module.push(stem);
                collect(&entry, &module, files);
            } else if entry.extension().is_some_and(|extension| extension == "rs") && stem != "tests" {
                module.extend((!["mod", "lib", "main"].contains(&stem.as_str())).then_some(stem));
                files.insert(module, entry);
            }
        }
    }
    let mut all = BTreeMap::new();
    collect(root, &Module::new(), &mut all);
    all
}

/// Collects the paths that a file names, outside of its tests.
#[derive(Default)]
struct Paths {
    /// Modules within the file, from the outside in.
    inner: Vec<String>,
    /// Each path, with the modules within the file that it stands in.
    found: Vec<(Vec<String>, Vec<String>)>,
    /// What `use` gives a name: module or item.
    names: BTreeMap<String, Vec<String>>,
}

impl Paths {
    fn use_tree(&mut self, tree: &syn::UseTree, mut before: Vec<String>) {
        match tree {
            syn::UseTree::Path(path) => {
                before.push(path.ident.to_string());
                self.use_tree(&path.tree, before);
            }
            syn::UseTree::Group(group) => group.items.iter().for_each(|tree| self.use_tree(tree, before.clone())),
            syn::UseTree::Name(name) => self.name(name.ident.to_string(), name.ident.to_string(), before),
            syn::UseTree::Rename(name) => self.name(name.rename.to_string(), name.ident.to_string(), before),
            syn::UseTree::Glob(_) => self.found.push((self.inner.clone(), before)),
        }
    }

    fn name(&mut self, name: String, ident: String, mut path: Vec<String>) {
        let (name, is_self) = match (ident == "self", path.last()) {
            (true, Some(last)) => (last.clone(), true),
            _ => (name, false),
        };
        path.extend((!is_self).then_some(ident));
        self.names.insert(name, path.clone());
        self.found.push((self.inner.clone(), path));
    }
}

fn is_test(attributes: &[syn::Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        attribute.path().is_ident("cfg")
            && attribute.parse_args::<syn::Path>().is_ok_and(|path| path.is_ident("test") || path.is_ident("doctest"))
    })
}

impl<'ast> Visit<'ast> for Paths {
    fn visit_item(&mut self, item: &'ast syn::Item) {
        match item {
            syn::Item::Mod(module) if !is_test(&module.attrs) => {
                self.inner.push(module.ident.to_string());
                visit::visit_item_mod(self, module);
                self.inner.pop();
            }
            syn::Item::Use(uses) if !is_test(&uses.attrs) => self.use_tree(&uses.tree, Vec::new()),
            syn::Item::Fn(function) if is_test(&function.attrs) => (),
            syn::Item::Mod(_) | syn::Item::Use(_) => (),
            other => visit::visit_item(self, other),
        }
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        let names = path.segments.iter().map(|segment| segment.ident.to_string()).collect();
        self.found.push((self.inner.clone(), names));
        visit::visit_path(self, path);
    }
}

/// The module whose item a path names, seen from a module of the crate; `None` for what is not of the crate, or a module
/// as a whole.
fn target(from: &Module, path: &[String], files: &BTreeMap<Module, PathBuf>) -> Option<Module> {
    let mut at = from.clone();
    let mut rest = path.iter().peekable();
    match path.first()?.as_str() {
        "crate" => {
            at.clear();
            rest.next();
        }
        "self" => drop(rest.next()),
        "super" => {
            while rest.next_if(|part| *part == "super").is_some() {
                at.pop()?;
            }
        }
        first => {
            let child: Module = at.iter().cloned().chain([first.to_string()]).collect();
            files.contains_key(&child).then_some(())?;
        }
    }
    while let Some(part) = rest.peek() {
        let child: Module = at.iter().cloned().chain([part.to_string()]).collect();
        if !files.contains_key(&child) {
            break;
        }
        (at, _) = (child, rest.next());
    }
    rest.peek().map(|_| at)
}

/// Which files each file knows.
fn arrows(root: &Path) -> BTreeMap<Module, BTreeSet<Module>> {
    let files = files(root);
    let mut arrows = BTreeMap::new();
    for (module, path) in &files {
        let mut paths = Paths::default();
        paths.visit_file(&syn::parse_file(&std::fs::read_to_string(path).unwrap()).unwrap());
        let mut known = BTreeSet::new();
        for (inner, path) in &paths.found {
            let from: Module = module.iter().chain(inner).cloned().collect();
            // A path may begin with a name that a `use` gave.
            let whole = match paths.names.get(&path[0]).filter(|_| path.len() > 1) {
                Some(start) => start.iter().chain(&path[1..]).cloned().collect(),
                None => path.clone(),
            };
            known.extend(target(&from, &whole, &files).filter(|to| to != module && files.contains_key(to)));
        }
        arrows.insert(module.clone(), known);
    }
    arrows
}

/// A way from a file round to itself, if there is one.
fn circle(arrows: &BTreeMap<Module, BTreeSet<Module>>) -> Option<Vec<Module>> {
    fn walk(
        at: &Module,
        arrows: &BTreeMap<Module, BTreeSet<Module>>,
        way: &mut Vec<Module>,
        done: &mut BTreeSet<Module>,
    ) -> bool {
        if let Some(first) = way.iter().position(|before| before == at) {
            way.drain(..first);
            return true;
        }
        if !done.contains(at) {
            way.push(at.clone());
            if arrows[at].iter().any(|next| walk(next, arrows, way, done)) {
                return true;
            }
            way.pop();
            done.insert(at.clone());
        }
        false
    }
    let (mut way, mut done) = (Vec::new(), BTreeSet::new());
    arrows.keys().any(|at| walk(at, arrows, &mut way, &mut done)).then_some(way)
}

#[test]
fn no_file_knows_one_that_knows_it() {
    let crates = [
        ("depthplanes", 110),
        ("depthplanes-io", 40),
        ("depthplanes-video", 10),
        ("depthplanes-serve", 10),
        ("depthplanes-cli", 50),
        ("depthplanes-ros2", 10),
        ("depthplanes-rerun", 5),
        ("../bindings/python", 10),
        ("../bindings/c", 7),
        ("../bindings/web", 5),
    ];
    for (name, least) in crates {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(name).join("src");
        let arrows = arrows(&root);
        let count: usize = arrows.values().map(BTreeSet::len).sum();
        assert!(arrows.len() > least && count > 2 * least, "{name}: {} files, {count} arrows", arrows.len());
        if let Some(way) = circle(&arrows) {
            let way: Vec<String> = way.iter().map(|module| module.join("::")).collect();
            panic!("{name}: a circle of files, each knows the next: {way:?}");
        }
    }
}

#[test]
fn a_circle_is_found() {
    let module = |name: &str| vec![name.to_string()];
    let arrows = |of_c: &[&str]| {
        let to = |names: &[&str]| names.iter().map(|name| module(name)).collect::<BTreeSet<_>>();
        BTreeMap::from([(module("a"), to(&["b"])), (module("b"), to(&["c"])), (module("c"), to(of_c))])
    };
    assert_eq!(circle(&arrows(&[])), None);
    assert_eq!(circle(&arrows(&["b"])), Some(vec![module("b"), module("c")]));
}
