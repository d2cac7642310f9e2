//! How much flash a method takes, from the program's call graph.
//!
//! Methods share code, with one another and with the frame loop, so there are two answers. *Alone*: what a program with just this method
//! has more than one with none, everything that its entry reaches and the frame loop without methods does not. *Own*: what no other
//! method reaches either, and a program with all the others would be spared. The streams' bytes are in neither.
//!
//! Edges of the graph are what the linker put into code and constants: calls, branches and addresses. Constants without a symbol are not
//! seen.

use anyhow::{Context, Result};
use microphong::Shader;
use microphong_boards::elf::Elf;
use std::collections::BTreeSet;

/// Bytes of code and constants.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Flash {
    /// That the method needs and the frame loop does not.
    pub alone: u64,
    /// That no other method needs either.
    pub own: u64,
}

/// Functions and constants of a program, and which of them needs which.
#[derive(Clone, Debug)]
pub struct Graph {
    sizes: Vec<u64>,
    needs: Vec<BTreeSet<usize>>,
    /// Nobody needs them: the program starts there.
    roots: Vec<usize>,
    /// Entries of the methods.
    methods: Vec<(Shader, usize)>,
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
        let method = |&shader: &Shader| {
            let module = shader.name().trim_end_matches("-original").replace('-', "_");
            let name = format!("microphong::shade::{module}::draw");
            Some((shader, functions.iter().position(|(other, _)| *other == name)?))
        };
        let methods = Shader::ALL.iter().filter_map(method).collect();
        Ok(Self { sizes: nodes.iter().map(|range| range.len() as u64).collect(), needs, roots, methods })
    }

    /// What `shader` takes.
    ///
    /// # Errors
    /// When its entry is no function of its own.
    pub fn flash(&self, shader: Shader) -> Result<Flash> {
        let entry = self.methods.iter().find(|(other, _)| *other == shader);
        let (_, entry) = entry.with_context(|| format!("the firmware has no function shade::...::draw for {}", shader.name()))?;
        let entries: BTreeSet<usize> = self.methods.iter().map(|&(_, entry)| entry).collect();
        let mut taken = self.reached(self.roots.iter().copied(), &entries);
        let alone = &self.reached([*entry], &taken) - &taken;
        taken.extend(self.reached(entries.iter().copied().filter(|other| other != entry), &taken));
        let own = &alone - &taken;
        let size = |nodes: &BTreeSet<usize>| nodes.iter().filter_map(|&node| self.sizes.get(node)).sum();
        Ok(Flash { alone: size(&alone), own: size(&own) })
    }

    /// All that `from` needs, without going through `but`.
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
