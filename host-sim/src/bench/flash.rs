//! How much flash a method takes, from the program's call graph.
//!
//! Methods share code, with one another and with the frame loop, so there are two answers. *Alone*: what a program with just this method
//! has more than one with none, everything that its entry reaches and the frame loop without methods does not. *Own*: what no other
//! method reaches either, and a program with all the others would be spared. The streams' bytes are in neither.
//!
//! Edges of the graph are branches and calls to the start of a function, and addresses of functions and constants, in literal pools or
//! put together from two halves. Constants without a symbol are not seen.

use crate::board::elf::Elf;
use anyhow::{Context, Result};
use microphong::Shader;
use std::{
    collections::{BTreeSet, HashMap},
    ops::Range,
};

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
    /// Reads the machine code.
    ///
    /// # Errors
    /// When the program is stripped.
    pub fn new(elf: &Elf) -> Result<Self> {
        let functions = elf.functions()?;
        let constants = elf.constants()?;
        let nodes: Vec<_> = functions.iter().chain(&constants).map(|(_, range)| range.clone()).collect();
        let starts: HashMap<u32, usize> = functions.iter().zip(0..).map(|((_, range), node)| (range.start, node)).collect();
        let mut places: Vec<_> = nodes.iter().cloned().zip(0..).skip(functions.len()).collect();
        places.sort_by_key(|(range, _)| range.start);
        let needed = |reference: Reference| match reference {
            Reference::Jump(to) => starts.get(&to).copied(),
            Reference::Address(of) if of & 1 == 1 && starts.contains_key(&(of & !1)) => starts.get(&(of & !1)).copied(),
            Reference::Address(of) => {
                let (range, node) = places.get(places.partition_point(|(range, _)| range.start <= of).checked_sub(1)?)?;
                range.contains(&of).then_some(*node)
            }
        };
        let segments = elf.segments()?;
        let bytes = |range: &Range<u32>| {
            let of = segments.iter().find_map(|segment| {
                let start = range.start.checked_sub(segment.address)? as usize;
                segment.bytes.get(start..start + range.len())
            });
            of.unwrap_or_default()
        };
        let needs: Vec<BTreeSet<usize>> = (0..)
            .zip(&nodes)
            .map(|(node, range)| {
                let found = if node < functions.len() { references(range.start, bytes(range)) } else { pointers(bytes(range)) };
                found.into_iter().filter_map(needed).filter(|&other| other != node).collect()
            })
            .collect();
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

/// What code names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Reference {
    /// A function.
    Jump(u32),
    /// A function, plus one, or a place in a constant.
    Address(u32),
}

/// All references in the code at address `start`. Every half-word is looked at as if an instruction began there: what is none
/// hardly ever names the start of a function.
fn references(start: u32, bytes: &[u8]) -> Vec<Reference> {
    let halves: Vec<u32> = bytes.as_chunks::<2>().0.iter().map(|&pair| u16::from_le_bytes(pair).into()).collect();
    let word = |address: u32| {
        let place = address.checked_sub(start)? as usize / 2;
        Some(halves.get(place)? | halves.get(place + 1)? << 16)
    };
    let mut found = Vec::new();
    // The lower halves of addresses, by register.
    let mut low = [0; 16];
    for (address, &[first, second]) in (start..).step_by(2).zip(halves.array_windows::<2>()) {
        let pool = (address + 4) & !3;
        // LDR from the literal pool, short and long.
        let literal = match first {
            0x4800..=0x4FFF => word(pool + (first & 0xFF) * 4),
            0xF8DF => word(pool + (second & 0xFFF)),
            _ => None,
        };
        found.extend(literal.map(Reference::Address));
        // BL and B.W.
        if first >> 11 == 0b11110 && matches!(second >> 12 & 0b1101, 0b1101 | 0b1001) {
            let sign = first >> 10 & 1;
            let [i1, i2] = [second >> 13 & 1, second >> 11 & 1].map(|bit| 1 ^ bit ^ sign);
            let offset = sign << 24 | i1 << 23 | i2 << 22 | (first & 0x3FF) << 12 | (second & 0x7FF) << 1;
            // Bit 24 is the sign.
            found.push(Reference::Jump((address + 4).wrapping_add_signed(((offset << 7) as i32) >> 7)));
        }
        // MOVW and MOVT.
        let half = (first & 0xF) << 12 | (first >> 10 & 1) << 11 | (second >> 12 & 7) << 8 | second & 0xFF;
        let register = &mut low[(second >> 8 & 0xF) as usize];
        match first & 0xFBF0 {
            0xF240 => *register = half,
            0xF2C0 => found.push(Reference::Address(half << 16 | *register)),
            _ => {}
        }
    }
    found
}

/// All references in a constant.
fn pointers(bytes: &[u8]) -> Vec<Reference> {
    bytes.as_chunks::<4>().0.iter().map(|&word| Reference::Address(u32::from_le_bytes(word))).collect()
}

#[cfg(test)]
mod tests {
    use super::{Reference, references};

    #[test]
    fn reads_what_assemblers_write() {
        // At 0x1000: bl 0x1064; b.w 0xffc; movw r3, #0x1234; movt r3, #0x2000.
        let halves: [u16; 8] = [0xF000, 0xF830, 0xF7FF, 0xBFFA, 0xF241, 0x2334, 0xF2C2, 0x0300];
        let bytes: Vec<u8> = halves.iter().flat_map(|half| half.to_le_bytes()).collect();
        let found = references(0x1000, &bytes);
        for wanted in [Reference::Jump(0x1064), Reference::Jump(0xFFC), Reference::Address(0x2000_1234)] {
            assert!(found.contains(&wanted), "{wanted:x?} in {found:x?}");
        }
    }
}
