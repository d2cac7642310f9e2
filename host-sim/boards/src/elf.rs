//! The firmware's ELF file: its use of a board's memory, and replacing its stream.

use anyhow::{Context, Result, bail, ensure};
use goblin::elf::{
    Elf as Parsed,
    program_header::PT_LOAD,
    reloc::{R_ARM_ABS32, R_ARM_THM_MOVT_ABS, R_ARM_THM_MOVW_ABS_NC},
    sym::{STT_FUNC, STT_OBJECT, STT_SECTION},
};
use std::{fs, ops::Range, path::Path};

/// A program for a board.
#[derive(Clone, Debug)]
pub struct Elf {
    bytes: Vec<u8>,
}

/// A piece of flash or RAM to be filled before the start.
#[derive(Clone, Copy, Debug)]
pub struct Segment<'a> {
    /// Address at which the bytes are loaded.
    pub address: u32,
    /// Bytes that are loaded.
    pub bytes: &'a [u8],
}

/// Fields of the header that tell where sections are, and how many.
const SECTIONS: [Range<usize>; 2] = [0x20..0x24, 0x30..0x34];
/// Size of an ELF32 program header and offsets of its fields.
const HEADER: usize = 32;
const OFFSET: usize = 4;
const FILE_SIZE: usize = 16;
const MEMORY_SIZE: usize = 20;

/// The name of a function without its type parameters: `<a::B<C>>::d::<E>` becomes `a::B::d`.
#[must_use]
pub fn short_name(name: &str) -> String {
    // `<type>` and `<type as trait>` at the start, or after a space or another of these, are part of the name; other brackets are not.
    let (mut short, mut kept, mut dropped) = (String::new(), 0u32, 0u32);
    let mut before = ' ';
    for c in name.chars() {
        match c {
            '<' if dropped == 0 && matches!(before, ' ' | '<') => kept += 1,
            '<' => dropped += 1,
            '>' if before == '-' && dropped > 0 => {}
            '>' if dropped > 0 => dropped -= 1,
            '>' if kept > 0 => kept -= 1,
            c if dropped == 0 => short.push(c),
            _ => {}
        }
        before = c;
    }
    // Arguments of a function leave nothing behind their colons.
    short.replace("::::", "::").trim_end_matches("::").to_owned()
}

impl Elf {
    /// Reads the file at `path`.
    ///
    /// # Errors
    /// When it cannot be read or is no ELF.
    pub fn read(path: &Path) -> Result<Self> {
        let elf = Self { bytes: fs::read(path).with_context(|| format!("cannot read the firmware {}", path.display()))? };
        elf.parsed().with_context(|| format!("{} is not an ELF file", path.display()))?;
        Ok(elf)
    }

    /// The file's content.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// The file without names of functions. Emulators that log names then log less.
    ///
    /// # Errors
    /// When the file is shorter than its header.
    pub fn without_symbols(&self) -> Result<Vec<u8>> {
        let mut bytes = self.bytes.clone();
        for field in SECTIONS {
            bytes.get_mut(field).context("the ELF is shorter than its header")?.fill(0);
        }
        Ok(bytes)
    }

    fn parsed(&self) -> Result<Parsed<'_>> {
        let elf = Parsed::parse(&self.bytes)?;
        ensure!(elf.little_endian && !elf.is_64, "not a little-endian 32-bit ELF");
        Ok(elf)
    }

    /// Address and size of a symbol.
    ///
    /// # Errors
    /// When there is no such symbol.
    pub fn symbol(&self, name: &str) -> Result<(u32, u32)> {
        let elf = self.parsed()?;
        let symbol = elf.syms.iter().find(|symbol| elf.strtab.get_at(symbol.st_name) == Some(name));
        let symbol = symbol.with_context(|| format!("the firmware has no symbol {name}: is it stripped?"))?;
        Ok((symbol.st_value as u32, symbol.st_size as u32))
    }

    /// Names, as in the source, and addresses of all functions.
    ///
    /// # Errors
    /// When the file is damaged.
    pub fn functions(&self) -> Result<Vec<(String, Range<u32>)>> {
        self.symbols(STT_FUNC)
    }

    /// Names and addresses of all constants that have a symbol.
    ///
    /// # Errors
    /// When the file is damaged.
    pub fn constants(&self) -> Result<Vec<(String, Range<u32>)>> {
        let elf = self.parsed()?;
        let section = elf.section_headers.iter().find(|section| elf.shdr_strtab.get_at(section.sh_name) == Some(".rodata"));
        let range = section.context("the firmware has no section .rodata")?.vm_range();
        let mut objects = self.objects()?;
        objects.retain(|(_, object)| range.contains(&(object.start as usize)));
        Ok(objects)
    }

    /// Names and addresses of all constants and variables that have a symbol.
    ///
    /// # Errors
    /// When the file is damaged.
    pub fn objects(&self) -> Result<Vec<(String, Range<u32>)>> {
        self.symbols(STT_OBJECT)
    }

    fn symbols(&self, kind: u8) -> Result<Vec<(String, Range<u32>)>> {
        let elf = self.parsed()?;
        let symbols = elf.syms.iter().filter(|symbol| symbol.st_type() == kind && symbol.st_size > 0);
        Ok(symbols
            .filter_map(|symbol| {
                let name = format!("{:#}", rustc_demangle::demangle(elf.strtab.get_at(symbol.st_name)?));
                // Bit 0 of a function says that the code is Thumb.
                let start = symbol.st_value as u32 & if kind == STT_FUNC { !1 } else { !0 };
                Some((name, start..start + symbol.st_size as u32))
            })
            .collect())
    }

    /// Places in flash and RAM into which the linker put an address, and that address, without the bit that says Thumb.
    ///
    /// # Errors
    /// When the file is damaged, or the linker did not keep its notes.
    pub fn references(&self) -> Result<Vec<(u32, u32)>> {
        let elf = self.parsed()?;
        let mut found = Vec::new();
        for (index, relocations) in &elf.shdr_relocs {
            let section = elf.section_headers.get(*index).and_then(|header| elf.section_headers.get(header.sh_info as usize));
            let Some(section) = section.filter(|section| section.is_alloc()) else { continue };
            // Lower halves of addresses whose upper halves follow, by register.
            let mut low = [0; 16];
            for relocation in relocations {
                let Some(symbol) = elf.syms.get(relocation.r_sym) else { continue };
                let place = relocation.r_offset as u32;
                // The notes of RISC-V say all. A note that has become void names no symbol.
                if let Some(addend) = relocation.r_addend {
                    found.push((place, (symbol.st_value as i64 + addend) as u32));
                    continue;
                }
                if symbol.st_type() != STT_SECTION {
                    found.push((place, symbol.st_value as u32 & !u32::from(symbol.is_function())));
                    continue;
                }
                // What lies within a section is told by the linked bytes alone.
                let offset = (section.sh_offset + relocation.r_offset - section.sh_addr) as usize;
                let bytes = self.bytes.get(offset..).and_then(|rest| rest.first_chunk()).context("an address lies outside the file")?;
                let word = u32::from_le_bytes(*bytes);
                let immediate = (word & 0xF) << 12 | (word >> 10 & 1) << 11 | (word >> 28 & 7) << 8 | word >> 16 & 0xFF;
                let low = &mut low[(word >> 24 & 0xF) as usize];
                match relocation.r_type {
                    R_ARM_ABS32 => found.push((place, word)),
                    R_ARM_THM_MOVW_ABS_NC => *low = immediate,
                    R_ARM_THM_MOVT_ABS => found.push((place, immediate << 16 | *low)),
                    _ => {}
                }
            }
        }
        ensure!(!found.is_empty(), "the firmware has no relocations: link it with --emit-relocs");
        Ok(found)
    }

    /// All segments that are loaded before the start.
    ///
    /// # Errors
    /// When the file is damaged.
    pub fn segments(&self) -> Result<Vec<Segment<'_>>> {
        let elf = self.parsed()?;
        let loaded = elf.program_headers.iter().filter(|header| header.p_type == PT_LOAD && header.p_filesz > 0);
        loaded
            .map(|header| {
                let bytes = self.bytes.get(header.file_range()).context("a segment lies outside the file")?;
                Ok(Segment { address: header.p_paddr as u32, bytes })
            })
            .collect()
    }

    /// Bytes of flash: code, constants, initial values and the stream.
    ///
    /// # Errors
    /// When the file is damaged.
    pub fn flash_bytes(&self) -> Result<u64> {
        Ok(self.segments()?.iter().map(|segment| segment.bytes.len() as u64).sum())
    }

    /// Bytes of RAM for variables; the stack comes on top.
    ///
    /// # Errors
    /// When the file is damaged.
    pub fn ram_bytes(&self) -> Result<u64> {
        let elf = self.parsed()?;
        let variables = [".data", ".bss", ".uninit"];
        let sections =
            elf.section_headers.iter().filter(|s| elf.shdr_strtab.get_at(s.sh_name).is_some_and(|name| variables.contains(&name)));
        Ok(sections.map(|section| section.sh_size).sum())
    }

    /// Addresses of the memory that the firmware takes its stream from.
    ///
    /// # Errors
    /// When the program has none.
    pub fn stream_memory(&self) -> Result<Range<u32>> {
        Ok(self.symbol("__stream_start")?.0..self.symbol("__stream_end")?.0)
    }

    /// Replaces the program's stream by `stream`. The new bytes go to the end of the file, and the segment points there.
    ///
    /// Section headers still describe the old stream; loaders look at segments only.
    ///
    /// # Errors
    /// When the stream does not fit the board, or the program has no place for one.
    pub fn with_stream(&self, stream: &[u8]) -> Result<Self> {
        let Range { start, end } = self.stream_memory()?;
        let room = (end - start) as usize;
        ensure!(
            stream.len() <= room,
            "the stream has {} bytes, but this board has room for {room}; choose a scene with fewer triangles or another board",
            stream.len()
        );
        let elf = self.parsed()?;
        let is_stream = |header: &goblin::elf::ProgramHeader| header.p_type == PT_LOAD && header.p_vaddr == u64::from(start);
        let Some(index) = elf.program_headers.iter().position(is_stream) else {
            bail!("the firmware has no segment at {start:#x} for the stream: link it with -Tstream.x");
        };
        let header = elf.header.e_phoff as usize + index * HEADER;

        let mut bytes = self.bytes.clone();
        bytes.resize(bytes.len().next_multiple_of(4), 0);
        let offset = bytes.len();
        bytes.extend_from_slice(stream);
        for (field, value) in [(OFFSET, offset), (FILE_SIZE, stream.len()), (MEMORY_SIZE, stream.len())] {
            bytes[header + field..][..4].copy_from_slice(&(value as u32).to_le_bytes());
        }
        Ok(Self { bytes })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_without_what_they_are_compiled_for() {
        for (name, short) in [
            ("a::b", "a::b"),
            ("<a::B<c::D>>::e", "a::B::e"),
            ("a::b::<c::D<3>, fn(u8) -> u8>", "a::b"),
            ("<a::B<C, D> as e::F<G>>::h::<I>", "a::B as e::F::h"),
            ("<a::B>::c::<D>::{closure#0}", "a::B::c::{closure#0}"),
        ] {
            assert_eq!(short_name(name), short);
        }
    }
}
