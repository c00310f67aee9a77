//! The imports between files: names are followed through `pub use` to the file that defines them.

use super::source::{Import, Source, sources};
use std::collections::{BTreeMap, BTreeSet};

type Module = Vec<String>;

/// The files of a crate and their imports.
pub struct Graph {
    /// Files by module path.
    pub files: BTreeMap<Module, Source>,
    imports: BTreeMap<Module, Vec<Import>>,
}

impl Graph {
    /// Reads a crate.
    pub fn of(krate: &str) -> Graph {
        let files = sources(krate);
        let imports = files.iter().map(|(module, source)| (module.clone(), source.imports())).collect();
        Graph { files, imports }
    }

    /// Returns a path written in a module as a path from the root of the crate.
    fn absolute(module: &[String], path: &[String]) -> Module {
        let mut base = if path[0] == "crate" { Vec::new() } else { module.to_vec() };
        let mut rest = path;
        while let [first, more @ ..] = rest {
            match first.as_str() {
                "super" => drop(base.pop()),
                "crate" | "self" => {}
                _ => break,
            }
            rest = more;
        }
        base.extend_from_slice(rest);
        base
    }

    /// Returns the file that defines the item of a path from the root of the crate.
    fn target(&self, path: &[String], seen: &mut BTreeSet<(Module, String)>) -> Option<Module> {
        let length = (0..=path.len()).rev().find(|&k| self.files.contains_key(&path[..k]))?;
        let module = path[..length].to_vec();
        let Some(name) = path.get(length) else { return Some(module) };
        if self.files[&module].defines(name) || !seen.insert((module.clone(), name.clone())) {
            return Some(module);
        }
        for import in &self.imports[&module] {
            let all_of = import.name.as_deref() == Some("*");
            if all_of || import.name.as_ref() == Some(name) {
                let mut onward = Self::absolute(&module, &import.path);
                if all_of {
                    onward.pop();
                    onward.push(name.clone());
                }
                onward.extend_from_slice(&path[length + 1..]);
                let found = self.target(&onward, seen).filter(|found| *found != module);
                if found.as_ref().is_some_and(|found| !all_of || self.files[found].defines(name)) {
                    return found;
                }
            }
        }
        Some(module)
    }

    /// Returns the file that defines the type of a path in a module; `None` if the type is not part of this crate.
    pub fn definition(&self, module: &Module, path: &[String]) -> Option<Module> {
        let name = path.last()?;
        let inside = [vec!["self".to_string()], path.to_vec()].concat();
        let path = if ["crate", "super", "self"].contains(&path[0].as_str()) { path } else { &inside };
        let found = self.target(&Self::absolute(module, path), &mut BTreeSet::new())?;
        self.files[&found].defines(name).then_some(found)
    }

    /// Returns the files that each file imports.
    pub fn edges(&self) -> BTreeMap<Module, BTreeSet<Module>> {
        let mut edges = BTreeMap::new();
        for (module, imports) in &self.imports {
            let targets = imports.iter().filter_map(|import| {
                let mut path = Self::absolute(module, &import.path);
                if import.name.as_deref() == Some("*") {
                    path.pop();
                }
                self.target(&path, &mut BTreeSet::new())
            });
            // The root only declares and re-exports; it defines no items.
            let targets = targets.filter(|target| target != module && !target.is_empty()).collect();
            edges.insert(module.clone(), targets);
        }
        edges
    }

    /// Returns the sets of files that import each other, directly or in a circle.
    pub fn circles(&self) -> Vec<Vec<String>> {
        circles_of(&self.edges())
    }

    /// Returns the sets of folders and files directly below `src` that import each other, directly or in a circle.
    pub fn folder_circles(&self) -> Vec<Vec<String>> {
        let mut edges: BTreeMap<Module, BTreeSet<Module>> = BTreeMap::new();
        for (module, targets) in self.edges() {
            let folder = |module: &Module| module[..module.len().min(1)].to_vec();
            let own = folder(&module);
            let others = targets.iter().map(folder).filter(|other| *other != own);
            edges.entry(own.clone()).or_default().extend(others);
        }
        // The root declares the folders.
        edges.remove(&Module::new());
        circles_of(&edges)
    }
}

/// Returns the sets of nodes that reach each other.
fn circles_of(edges: &BTreeMap<Module, BTreeSet<Module>>) -> Vec<Vec<String>> {
    let reached: BTreeMap<&Module, BTreeSet<&Module>> =
        edges.keys().map(|module| (module, reachable(edges, module))).collect();
    let mut circles = Vec::new();
    let mut seen = BTreeSet::new();
    for module in edges.keys() {
        let circle: Vec<&Module> =
            reached[module].iter().copied().filter(|other| reached[other].contains(module)).collect();
        if circle.len() > 1 && seen.insert(circle.clone()) {
            circles.push(circle.iter().map(|module| module.join("/")).collect());
        }
    }
    circles
}

/// Returns all files that a file imports, directly or through other files.
fn reachable<'a>(edges: &'a BTreeMap<Module, BTreeSet<Module>>, from: &'a Module) -> BTreeSet<&'a Module> {
    let mut found = BTreeSet::new();
    let mut open = vec![from];
    while let Some(module) = open.pop() {
        for target in &edges[module] {
            if found.insert(target) {
                open.push(target);
            }
        }
    }
    found
}
