//! Flash of a method, from the program's call graph.
//!
//! Methods share code with one another and with the frame loop, so there are two figures. *Alone* is what a program with only this method has more
//! than a program without methods: everything that its entry reaches and the frame loop does not. *Own* is what no other method reaches: a program
//! with all other methods would save it. Neither includes streams.
//!
//! Edges of the graph are calls, branches and addresses in code and constants. Constants without a symbol are not seen.

use anyhow::{Context, Result};
use microphong_boards::elf::Elf;
use microphong_render::shader::Shader;
use std::collections::BTreeSet;

/// Bytes of code and constants.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Flash {
    /// Bytes that the method needs and the frame loop does not.
    pub alone: u64,
    /// Bytes that only this method needs.
    pub own: u64,
}

/// Functions and constants of a program, and which of them needs which.
#[derive(Clone, Debug)]
pub struct Graph {
    sizes: Vec<u64>,
    needs: Vec<BTreeSet<usize>>,
    /// Nobody needs them: the program starts there.
    roots: Vec<usize>,
    /// The functions of each method by which it is entered.
    methods: Vec<(Shader, BTreeSet<usize>)>,
}

impl Graph {
    /// Reads the linker's notes.
    ///
    /// # Errors
    /// When the program is stripped of them.
    pub fn new(elf: &Elf) -> Result<Self> {
        let functions = elf.functions()?;
        let constants = elf.constants()?;
        let nodes: Vec<_> = functions.iter().chain(&constants).map(|(_, range)| range.clone()).collect();
        let mut places: Vec<_> = nodes.iter().cloned().zip(0..).collect();
        places.sort_by_key(|(range, _)| range.start);
        let at = |address: u32| {
            let (range, node) = places.get(places.partition_point(|(range, _)| range.start <= address).checked_sub(1)?)?;
            range.contains(&address).then_some(*node)
        };
        let mut needs = vec![BTreeSet::new(); nodes.len()];
        for (place, address) in elf.references()? {
            if let (Some(from), Some(to)) = (at(place), at(address))
                && from != to
                && let Some(needs) = needs.get_mut::<usize>(from)
            {
                needs.insert(to);
            }
        }
        let wanted: BTreeSet<usize> = needs.iter().flatten().copied().collect();
        let roots = (0..functions.len()).filter(|node| !wanted.contains(node)).collect();
        let entries = |&shader: &Shader| {
            let name = type_name(shader);
            let entries = functions.iter().zip(0..).filter(|((other, _), _)| names(other, &name)).map(|(_, node)| node).collect();
            (shader, entries)
        };
        let methods = Shader::ALL.iter().map(entries).collect();
        Ok(Self { sizes: nodes.iter().map(|range| range.len() as u64).collect(), needs, roots, methods })
    }

    /// Flash of the method `shader`.
    ///
    /// # Errors
    /// When the method's entry is not a function of its own.
    pub fn flash(&self, shader: Shader) -> Result<Flash> {
        let entries = self.methods.iter().find(|(other, _)| *other == shader).map(|(_, entries)| entries);
        let entries = entries.filter(|entries| !entries.is_empty());
        let entries = entries.with_context(|| format!("the firmware has no function that is compiled for {}", shader.name()))?;
        let all: BTreeSet<usize> = self.methods.iter().flat_map(|(_, entries)| entries).copied().collect();
        let mut taken = self.reached(self.roots.iter().copied(), &all);
        let alone = &self.reached(entries.iter().copied(), &taken) - &taken;
        taken.extend(self.reached(all.iter().copied().filter(|other| !entries.contains(other)), &taken));
        let own = &alone - &taken;
        let size = |nodes: &BTreeSet<usize>| nodes.iter().filter_map(|&node| self.sizes.get(node)).sum();
        Ok(Flash { alone: size(&alone), own: size(&own) })
    }

    /// All functions that `from` reaches without going through `but`.
    fn reached(&self, from: impl IntoIterator<Item = usize>, but: &BTreeSet<usize>) -> BTreeSet<usize> {
        let mut reached = BTreeSet::new();
        let mut open: Vec<usize> = from.into_iter().collect();
        while let Some(node) = open.pop() {
            if !but.contains(&node) && reached.insert(node) {
                open.extend(self.needs.get(node).into_iter().flatten());
            }
        }
        reached
    }
}

/// The end of the name of the type that is the method, as symbols name it.
fn type_name(shader: Shader) -> String {
    if shader.keeps_budget() {
        return format!("microphong::method::auto::Auto<{}>", shader == Shader::AUTO);
    }
    let word = |word: &str| word[..1].to_uppercase() + &word[1..];
    let name: String = shader.name().split('-').map(word).collect();
    let module = shader.name().trim_end_matches("-original").replace('-', "_");
    if Shader::CORE.contains(&shader) {
        // In the folder of what it interpolates.
        format!("::{module}::{name}")
    } else {
        format!("microphong_literature::{module}::{name}")
    }
}

/// Whether a symbol names a type, and not just one whose name begins with its name.
fn names(symbol: &str, name: &str) -> bool {
    symbol.match_indices(name).any(|(at, _)| !symbol[at + name.len()..].starts_with(|next: char| next.is_alphanumeric()))
}
