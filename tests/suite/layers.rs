//! Modules of the core use those above them in the table of `shared/src/lib.rs` and no others, and no files of one folder import in a
//! circle. The crate of the literature uses number formats, mathematics, and what methods are made of.
//!
//! The test reads `use` declarations, and paths that start at `crate`, `self` or `super`, or at a child of the module, but no code that is compiled
//! for tests only. A `pub use` of a child, in the file that declares it, names the child's items and uses none of them.

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::Path,
};

/// A module's names from the root on; the root itself has none.
type Module = Vec<String>;

/// Faults, one sentence each.
type Faults = Vec<String>;

/// One file: its place below `src`, such as `math/mod.rs`, and its text.
type Source = (String, String);

/// The text without comments, strings and characters.
fn bare(text: &str) -> String {
    let chars: Vec<char> = text.chars().collect();
    let at = |i: usize| chars.get(i).copied().unwrap_or('\n');
    let (mut bare, mut i) = (String::new(), 0);
    while i < chars.len() {
        match (at(i), at(i + 1)) {
            ('/', '/') => {
                while i < chars.len() && at(i) != '\n' {
                    i += 1;
                }
            }
            ('/', '*') => {
                let mut depth = 0;
                loop {
                    match (at(i), at(i + 1)) {
                        ('/', '*') => (depth, i) = (depth + 1, i + 2),
                        ('*', '/') => (depth, i) = (depth - 1, i + 2),
                        _ => i += 1,
                    }
                    if depth == 0 || i >= chars.len() {
                        break;
                    }
                }
            }
            ('r', '"' | '#') if !bare.ends_with(|c: char| c.is_alphanumeric() && c != 'b' || c == '_') => {
                let hashes = chars[i + 1..].iter().take_while(|&&c| c == '#').count();
                if at(i + 1 + hashes) == '"' {
                    i += hashes + 2;
                    while i < chars.len() && !(at(i) == '"' && (1..=hashes).all(|k| at(i + k) == '#')) {
                        i += 1;
                    }
                    i += hashes + 1;
                } else {
                    // A raw identifier.
                    i += 2;
                }
            }
            ('"', _) => {
                i += 1;
                while i < chars.len() && at(i) != '"' {
                    i += if at(i) == '\\' { 2 } else { 1 };
                }
                i += 1;
            }
            // A character and not a lifetime.
            ('\'', next) if next == '\\' || at(i + 2) == '\'' => {
                i += if next == '\\' { 3 } else { 2 };
                while i < chars.len() && at(i) != '\'' {
                    i += 1;
                }
                i += 1;
            }
            (c, _) => {
                bare.push(c);
                i += 1;
            }
        }
    }
    bare
}

/// Names, `::`, and all other characters one by one.
fn tokens(text: &str) -> Vec<String> {
    let mut tokens = Vec::<String>::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let is_name = |c: char| c.is_alphanumeric() || c == '_';
        let length = match first {
            ':' if rest.starts_with("::") => 2,
            c if is_name(c) => rest.find(|c| !is_name(c)).unwrap_or(rest.len()),
            c => c.len_utf8(),
        };
        let (token, behind) = rest.split_at(length);
        if !first.is_whitespace() {
            tokens.push(token.to_owned());
        }
        rest = behind;
    }
    tokens
}

/// Number of `tokens` in the item at the front, attributes included: up to its block's end, or its semicolon.
fn item(tokens: &[String]) -> usize {
    let (mut depth, mut inner) = (0, 0);
    for (i, token) in tokens.iter().enumerate() {
        match token.as_str() {
            "{" => depth += 1,
            "(" | "[" => inner += 1,
            ")" | "]" => inner -= 1,
            "}" => depth -= 1,
            _ => {}
        }
        if token == "}" && depth == 0 || token == ";" && depth == 0 && inner == 0 {
            return i + 1;
        }
    }
    tokens.len()
}

/// Removes code that is compiled for tests only.
fn without_tests(tokens: &[String]) -> Vec<String> {
    let (mut kept, mut i) = (Vec::new(), 0);
    while i < tokens.len() {
        if tokens[i..].starts_with(&["#", "[", "cfg", "(", "test", ")", "]"].map(str::to_owned)) {
            i += 7;
            i += item(&tokens[i..]);
        } else {
            kept.push(tokens[i].clone());
            i += 1;
        }
    }
    kept
}

/// Adds the paths of the tree at the front, such as `a::{b, c::d}`, behind `path`. Returns the number of its tokens.
fn tree(tokens: &[String], path: &[String], paths: &mut Vec<Module>) -> usize {
    let mut path = path.to_vec();
    let mut i = 0;
    while let Some(token) = tokens.get(i) {
        if token == "{" {
            i += 1;
            while tokens.get(i).is_some_and(|token| token != "}") {
                i += tree(&tokens[i..], &path, paths);
                i += usize::from(tokens.get(i).is_some_and(|token| token == ","));
            }
            return i + 1;
        }
        path.push(token.clone());
        i += 1;
        if tokens.get(i).is_none_or(|token| token != "::") {
            break;
        }
        i += 1;
    }
    // What it is called here does not matter.
    if tokens.get(i).is_some_and(|token| token == "as") {
        i += 2;
    }
    if path.len() > 1 && path.last().is_some_and(|last| last == "self") {
        path.pop();
    }
    paths.push(path);
    i
}

/// Paths of one file as they stand there, and whether others find them here, too.
fn paths(tokens: &[String], children: &BTreeSet<&str>) -> Vec<(Module, bool)> {
    let (mut all, mut i) = (Vec::new(), 0);
    while i < tokens.len() {
        let before = |k: usize| i.checked_sub(k).map(|at| tokens[at].as_str());
        let mut found = Vec::new();
        let mut is_public = false;
        if tokens[i] == "use" {
            // `pub use`, `pub(crate) use`.
            is_public = before(1) == Some("pub") || before(1) == Some(")") && before(4) == Some("pub");
            i += 1 + tree(&tokens[i + 1..], &[], &mut found);
        } else if tokens.get(i + 1).is_some_and(|next| next == "::")
            && before(1) != Some("::")
            && (["crate", "self", "super"].contains(&tokens[i].as_str()) || children.contains(tokens[i].as_str()))
        {
            let mut path = vec![tokens[i].clone()];
            i += 1;
            while tokens.get(i).is_some_and(|token| token == "::") && tokens.get(i + 1).is_some_and(|name| name != "<" && name != "{") {
                path.push(tokens[i + 1].clone());
                i += 2;
            }
            found.push(path);
        } else {
            i += 1;
        }
        all.extend(found.into_iter().map(|path| (path, is_public)));
    }
    all
}

/// A crate, as far as this is about it.
struct Core {
    /// Modules in the order of the table.
    table: Vec<String>,
    /// The file of each module.
    files: BTreeMap<Module, String>,
    /// The names that each module uses.
    paths: BTreeMap<Module, Vec<(Module, bool)>>,
    /// The items that public names of modules stand for.
    public: BTreeMap<Module, Module>,
}

/// The module that a file is.
fn module(file: &str) -> Module {
    let file = file.strip_suffix(".rs").unwrap_or(file);
    let file = if file == "lib" { "" } else { file.strip_suffix("/mod").unwrap_or(file) };
    file.split('/').filter(|name| !name.is_empty()).map(str::to_owned).collect()
}

/// The name in the first column of the table: `` `name` ``, `` [`name`] `` or `` [`name`](elsewhere) ``.
fn entry(line: &str) -> Option<String> {
    let row = line.strip_prefix("//! | ")?.trim_start_matches('[').strip_prefix('`')?;
    Some(row.split_once('`')?.0.to_owned())
}

impl Core {
    fn new(sources: &[Source]) -> Self {
        let files: BTreeMap<_, _> = sources.iter().map(|(file, _)| (module(file), file.clone())).collect();
        let table = sources.iter().filter(|(file, _)| file == "lib.rs").flat_map(|(_, text)| text.lines().filter_map(entry)).collect();
        let mut core = Self { table, files, paths: BTreeMap::new(), public: BTreeMap::new() };
        for (file, text) in sources {
            let own = module(file);
            let children = core.files.keys().filter(|other| other.split_last().is_some_and(|(_, parent)| *parent == own));
            let children = children.filter_map(|child| child.last()).map(String::as_str).collect();
            let paths = paths(&without_tests(&tokens(&bare(text))), &children);
            let absolute = |mut path: Module| {
                let first = path.remove(0);
                let parent = || own[..own.len().saturating_sub(1)].to_vec();
                let start = match first.as_str() {
                    "crate" => Vec::new(),
                    "self" => own.clone(),
                    "super" => parent(),
                    child if children.contains(child) => [own.clone(), vec![first]].concat(),
                    // Another crate, or what has been imported.
                    _ => return None,
                };
                Some([start, path].concat())
            };
            let paths = paths.into_iter().filter_map(|(path, is_public)| Some((absolute(path)?, is_public))).collect::<Vec<_>>();
            for (path, _) in paths.iter().filter(|(_, is_public)| *is_public) {
                let name = [own.clone(), path.last().cloned().into_iter().collect()].concat();
                core.public.insert(name, path.clone());
            }
            core.paths.insert(own, paths);
        }
        core
    }

    /// The module that an item is in, wherever its path leads.
    fn home(&self, path: &Module) -> Module {
        let mut path = path.clone();
        // No chain of names is longer than there are names.
        for _ in 0..self.public.len() {
            let known = (1..=path.len()).rev().find_map(|length| Some((length, self.public.get(&path[..length])?)));
            match known {
                Some((length, real)) if !self.files.contains_key(&path[..length]) => path = [real, &path[length..]].concat(),
                _ => break,
            }
        }
        (0..=path.len()).rev().map(|length| path[..length].to_vec()).find(|module| self.files.contains_key(module)).unwrap_or_default()
    }

    /// The place of a module in the table.
    fn place(&self, name: &str) -> Option<usize> {
        self.table.iter().position(|module| module == name)
    }

    /// The table has every module, and each uses those above it.
    fn layers(&self) -> Faults {
        let mut faults = Faults::new();
        let modules: BTreeSet<_> = self.files.keys().filter_map(|module| module.first()).collect();
        faults.extend(self.table.iter().filter(|name| !modules.contains(name)).map(|name| format!("{name} has no file")));
        faults.extend(modules.iter().filter(|name| self.place(name).is_none()).map(|name| format!("{name} is not in the table")));
        for (own, paths) in &self.paths {
            // The root names everything.
            let Some(upper) = own.first() else { continue };
            for (path, _) in paths {
                let shown = format!("{} names {}", self.files[own], path.join("::"));
                match self.home(path).first() {
                    None => faults.push(format!("{shown}, which is in no module")),
                    Some(home) if home != upper && self.place(home) > self.place(upper) => {
                        faults.push(format!("{shown}: {home} stands below {upper}"));
                    }
                    // The path as it is written must not lead below either.
                    Some(_) => match path.first().and_then(|first| Some((first, self.place(first)?))) {
                        Some((first, place)) if first != upper && Some(place) > self.place(upper) => {
                            faults.push(format!("{shown}: {first} stands below {upper}"));
                        }
                        _ => {}
                    },
                }
            }
        }
        faults
    }

    /// Files of the same folder that each file imports from.
    fn imports(&self, own: &Module) -> BTreeSet<Module> {
        let names = self.paths.get(own).into_iter().flatten();
        let used = names.filter_map(|(path, is_public)| {
            let home = self.home(path);
            let is_child = home.len() > own.len() && home.starts_with(own);
            (home != *own && home.first() == own.first() && !(*is_public && is_child)).then_some(home)
        });
        used.collect()
    }

    /// No files of a folder import in a circle.
    fn circles(&self) -> Faults {
        let mut faults = BTreeSet::new();
        for start in self.files.keys().filter(|module| !module.is_empty()) {
            // The shortest way back.
            let mut ways = vec![vec![start.clone()]];
            let mut seen = BTreeSet::new();
            while let Some(way) = (!ways.is_empty()).then(|| ways.remove(0)) {
                let imports = way.last().map(|last| self.imports(last)).unwrap_or_default();
                if imports.contains(start) {
                    // Told once, from the first file of the circle.
                    let least = (0..way.len()).min_by_key(|&k| &way[k]).unwrap_or(0);
                    let mut circle: Vec<_> = (0..=way.len()).map(|k| way[(least + k) % way.len()].join("::")).collect();
                    circle.dedup();
                    faults.insert(circle.join(" -> "));
                    break;
                }
                ways.extend(imports.into_iter().filter(|next| seen.insert(next.clone())).map(|next| [&way[..], &[next]].concat()));
            }
        }
        faults.into_iter().collect()
    }
}

/// What the crate of the literature uses of microphong: number formats, mathematics, and what methods are made of.
const OF_METHODS: [&str; 3] = ["format", "math", "method"];

/// Names of microphong in the sources of another crate, its tests apart, that are not of these modules.
fn uses_beyond(modules: &[&str], sources: &[Source]) -> Faults {
    let mut faults = Faults::new();
    for (file, text) in sources {
        for (path, _) in paths(&without_tests(&tokens(&bare(text))), &BTreeSet::from(["microphong"])) {
            if let [first, module, ..] = &path[..]
                && first == "microphong"
                && !modules.contains(&module.as_str())
            {
                faults.push(format!("{file} names {module}"));
            }
        }
    }
    faults
}

/// The files of a crate.
fn core(directory: &Path) -> Vec<Source> {
    fn collect(directory: &Path, place: &str, sources: &mut Vec<Source>) {
        for entry in fs::read_dir(directory).expect("the core's sources") {
            let entry = entry.expect("the core's sources");
            let name = format!("{place}{}", entry.file_name().to_string_lossy());
            if entry.path().is_dir() {
                collect(&entry.path(), &format!("{name}/"), sources);
            } else if name.ends_with(".rs") {
                sources.push((name, fs::read_to_string(entry.path()).expect("text")));
            }
        }
    }
    let mut sources = Vec::new();
    collect(directory, "", &mut sources);
    sources
}

#[test]
fn modules_use_those_above_them() {
    let core = Core::new(&core(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/src")));
    assert!(core.table.len() > 15 && core.files.len() > 50, "{:?}", core.table);
    // What everything uses is found, and the highest user of it, too.
    assert!(core.paths.values().flatten().filter(|(path, _)| path.first().is_some_and(|name| name == "format")).count() > 50);
    assert!(core.paths[&module("renderer.rs")].iter().any(|(path, _)| path.first().is_some_and(|name| name == "frame")));
    let faults = core.layers();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn the_literature_uses_what_methods_are_made_of() {
    let literature = core(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/literature/src"));
    assert!(literature.len() > 20, "{}", literature.len());
    let faults = uses_beyond(&OF_METHODS, &literature);
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    // In any way to write it.
    for text in
        ["use microphong::raster::canvas::Shaded;", "use microphong::{\n method, raster };", "fn f(_: microphong::raster::band::Band) {}"]
    {
        assert_eq!(uses_beyond(&OF_METHODS, &[("a.rs".to_owned(), text.to_owned())]), ["a.rs names raster"], "{text}");
    }
    let right = "use microphong::method::Canvas;\n#[cfg(test)]\nuse microphong::raster;";
    assert_eq!(uses_beyond(&OF_METHODS, &[("a.rs".to_owned(), right.to_owned())]), Faults::new());
}

#[test]
fn files_do_not_import_in_a_circle() {
    let core = Core::new(&core(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/src")));
    let edges: usize = core.files.keys().map(|module| core.imports(module).len()).sum();
    assert!(edges > 50, "{edges}");
    let faults = core.circles();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// A made-up crate: three modules, one above the other, the middle one a folder of three files.
fn made_up(changes: &[(&str, &str)]) -> Core {
    let root = "//! | module | what |\n//! |---|---|\n//! | [`low`] | a |\n//! | [`mid`](mod@mid) | b |\n//! | [`high`] | [`low`] |\n\
                pub mod high;\npub mod low;\npub mod mid;\npub use low::Ground;\npub use high::Roof;\n";
    let mut files = BTreeMap::from([
        ("lib.rs", root),
        ("low.rs", "pub struct Ground;\n"),
        ("mid/mod.rs", "pub mod a;\npub mod b;\npub use a::Wall;\nuse crate::low::Ground;\npub struct Floor;\n"),
        ("mid/a.rs", "use crate::Ground;\npub struct Wall;\n"),
        ("mid/b.rs", "use crate::{low::{self, Ground}, mid::{Floor, Wall, a}};\n"),
        ("high.rs", "use crate::mid::{Floor, b::*};\nuse core::fmt;\npub struct Roof;\n"),
    ]);
    files.extend(changes.iter().copied());
    Core::new(&files.into_iter().map(|(file, text)| (file.to_owned(), text.to_owned())).collect::<Vec<_>>())
}

#[test]
fn what_is_right_is_let_pass() {
    let silent = "//! crate::high\n/// [`crate::high::Roof`]\nconst A: &str = \"crate::high \\\" crate::high\"; /* crate::high /* */ crate::high */\n\
                  const B: (char, &str) = ('\"', r#\"\" crate::high\"#); // crate::high\nfn c<'a>(_: &'a str) -> char { '\\'' }\n\
                  #[cfg(test)]\nmod tests { use super::*; use crate::high::Roof; fn d() { let _ = [0; 3]; } }\n\
                  #[cfg(test)]\nuse crate::high::Roof;\n";
    for changes in [&[][..], &[("low.rs", silent)]] {
        let core = made_up(changes);
        assert_eq!(core.table, ["low", "mid", "high"]);
        assert_eq!((core.layers(), core.circles()), (Faults::new(), Faults::new()), "{changes:?}");
    }
}

#[test]
fn what_is_below_is_found() {
    let below = [
        ("low.rs", "use crate::high::Roof;", "low.rs names high::Roof: high stands below low"),
        ("low.rs", "use crate::{\n    high,\n    low,\n};", "low.rs names high: high stands below low"),
        ("low.rs", "pub use crate::{mid::{a::Wall as Low}};", "low.rs names mid::a::Wall: mid stands below low"),
        ("low.rs", "fn f(_: &'static crate::mid::Floor) {}", "low.rs names mid::Floor: mid stands below low"),
        ("low.rs", "macro_rules! m { () => { $crate::mid::Floor } }", "low.rs names mid::Floor: mid stands below low"),
        ("low.rs", "use super::mid;", "low.rs names mid: mid stands below low"),
        ("low.rs", "#[cfg(test)]\nmod tests {}\nuse crate::high;", "low.rs names high: high stands below low"),
        // A public name of the root is no way around.
        ("mid/a.rs", "use crate::Roof;", "mid/a.rs names Roof: high stands below mid"),
        ("mid/a.rs", "fn f() -> crate::Roof { super::super::low::f() }", "mid/a.rs names Roof: high stands below mid"),
        // Nor is that of another module.
        ("mid/b.rs", "use crate::high::Ground;", "mid/b.rs names high::Ground: high stands below mid"),
        ("mid/b.rs", "use crate::nothing;", "mid/b.rs names nothing, which is in no module"),
    ];
    for (file, text, fault) in below {
        let found = made_up(&[(file, text), ("high.rs", "pub use crate::low::Ground;\npub struct Roof;\n")]).layers();
        assert!(found.contains(&fault.to_owned()), "{text}: {found:?}");
    }
    assert_eq!(made_up(&[("beside.rs", "")]).layers(), ["beside is not in the table"]);
    let without = "//! | [`low`] | a |\n//! | [`gone`] | b |\n//! | [`mid`] | c |\n";
    assert_eq!(made_up(&[("lib.rs", without), ("high.rs", "")]).layers()[..2], ["gone has no file", "high is not in the table"]);
}

#[test]
fn circles_are_found() {
    let circles = [
        // Siblings.
        ([("mid/a.rs", "use crate::mid::b;"), ("mid/b.rs", "use super::a::Wall;")], "mid::a -> mid::b -> mid::a"),
        // By a public name of the parent.
        ([("mid/a.rs", "use crate::mid::b;"), ("mid/b.rs", "use crate::mid::Wall;")], "mid::a -> mid::b -> mid::a"),
        // The parent and a child that use each other.
        ([("mid/a.rs", "use crate::mid::Floor;"), ("mid/mod.rs", "pub mod a;\npub mod b;\nuse a::Wall;\n")], "mid -> mid::a -> mid"),
        ([("mid/a.rs", "use super::Floor;"), ("mid/mod.rs", "pub mod a;\npub mod b;\nfn f() { a::g(); }\n")], "mid -> mid::a -> mid"),
        // By way of a third file.
        (
            [("mid/a.rs", "use crate::mid::b;"), ("mid/mod.rs", "pub mod a;\npub mod b;\nuse crate::mid::a::Wall;\n")],
            "mid -> mid::a -> mid::b -> mid",
        ),
    ];
    for (changes, circle) in circles {
        let found = made_up(&changes).circles();
        assert!(found.contains(&circle.to_owned()), "{changes:?}: {found:?}");
    }
    // A child may use its parent while the parent does not use it.
    let changes = [("mid/a.rs", "use crate::mid::Floor;"), ("mid/mod.rs", "pub mod a;\npub mod b;\npub use a::Wall;\npub struct Floor;\n")];
    assert_eq!(made_up(&changes).circles(), Faults::new());
}
