//! What a frame costs, in instructions, stage by stage: exact, because an emulated board executes the firmware itself.

pub mod measurement;
pub mod processor;
pub mod stage;

use crate::board::{Blocks, elf::Elf, trace};
use anyhow::{Context, Result};
pub use measurement::Measurement;
use microphong::Shader;
pub use processor::Processor;
pub use stage::Stages;
use std::{collections::HashMap, ops::Range};

/// Part of a frame that a function belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Part {
    Vertex,
    Cull,
    Setup,
    Row,
    /// Not counted.
    Other,
    /// Whoever called it.
    Callers,
}

struct Function {
    range: Range<u32>,
    part: Part,
}

/// Sorts a function of the firmware into a part by its name.
fn part(name: &str) -> Part {
    let is = |words: &[&str]| words.iter().any(|word| name.contains(word));
    if is(&["raster::triangle::row"]) {
        Part::Row
    } else if is(&["Band", "Palette<C>::fill", "Power::fill", "Stream", "crc"]) {
        Part::Other
    } else if is(&["transform"]) {
        Part::Vertex
    } else if is(&["prepare", "::sort", "Bins"]) {
        Part::Cull
    } else if is(&["shade::", "Frame<C>::draw", "draw_facet", "draw_triangle", "draw_clipped"]) {
        Part::Setup
    } else if is(&["microphong::", "__aeabi", "compiler_builtins", "mem"]) && !is(&["microphong_firmware"]) {
        Part::Callers
    } else {
        Part::Other
    }
}

/// Traces one frame of `elf`, whose stream must have just one, and counts.
///
/// # Errors
/// When QEMU cannot be run, or the firmware is stripped.
pub fn measure(processor: Processor, elf: &Elf, scene: &str, shader: Shader, pixels: u64, triangles: u64) -> Result<Measurement> {
    let mut functions: Vec<Function> = elf.functions()?.into_iter().map(|(name, range)| Function { part: part(&name), range }).collect();
    functions.sort_by_key(|function| function.range.start);
    // Start-up paints the stack, which takes longer than a frame.
    let reset = elf.symbol("Reset").context("no start-up code")?.0 & !1;
    let ranges: Vec<_> = functions.iter().map(|f| f.range.clone()).filter(|range| !range.contains(&reset)).collect();

    let mut stages = Stages::default();
    let mut rows: HashMap<u32, u64> = HashMap::new();
    let mut current = Part::Other;
    let board = processor.board().context("no board to trace")?;
    trace(board, elf, &merged(ranges), Blocks::Whole, |address| {
        let index = functions.partition_point(|function| function.range.start <= address);
        let part = index.checked_sub(1).and_then(|i| functions.get(i)).map_or(Part::Other, |function| function.part);
        if part != Part::Callers {
            current = part;
        }
        match current {
            Part::Vertex => stages.vertex += 1,
            Part::Cull => stages.cull += 1,
            Part::Setup => stages.setup += 1,
            // What helpers do for the inner loop is counted at the helpers' addresses.
            Part::Row => *rows.entry(address).or_default() += 1,
            Part::Other | Part::Callers => {}
        }
    })?;
    // An address in `row` that is executed more often than the function is entered lies in the loop.
    let entries: u64 = functions.iter().filter(|f| f.part == Part::Row).map(|f| rows.get(&f.range.start).copied().unwrap_or(0)).sum();
    for count in rows.values() {
        if *count > entries { stages.pixel += count } else { stages.span += count }
    }
    let instructions = stages.drawing();
    let instr_per_pixel = instructions as f64 / pixels.max(1) as f64;
    Ok(Measurement {
        board: processor,
        cpu: processor.name(),
        scene: scene.to_owned(),
        shader: shader.name(),
        instructions,
        pixels,
        triangles,
        spans: entries,
        instr_per_pixel: (instr_per_pixel * 100.0).round() / 100.0,
        by_stage: stages,
        cycles: None,
        ram_bytes: None,
        flash_bytes: None,
        max_lsb: None,
        rmse_lsb: None,
    })
}

/// Adjacent ranges made one: QEMU looks through the list at every block.
fn merged(mut ranges: Vec<Range<u32>>) -> Vec<Range<u32>> {
    ranges.sort_by_key(|range| range.start);
    let mut out: Vec<Range<u32>> = Vec::new();
    for range in ranges {
        match out.last_mut() {
            Some(last) if range.start <= last.end + 64 => last.end = last.end.max(range.end),
            _ => out.push(range),
        }
    }
    out
}
