//! The stages of a frame, told apart by the functions that are executed.

use super::nest::Nest;
use anyhow::{Context, Result, ensure};
use microphong_boards::{
    Executed,
    elf::{Elf, short_name},
};
use serde::Serialize;
use std::{
    iter::Sum,
    ops::{Add, Range},
};

/// Instructions, or cycles, of one frame by stage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Stages {
    /// Vertices: transformation and light.
    pub vertex: u64,
    /// Triangles that face away or lie off screen told apart, the others binned.
    pub cull: u64,
    /// Per drawn triangle and band: nodes, fits, edges. Per label and band: all of it.
    pub setup: u64,
    /// Per row of a triangle: stepping, slices, the start of the walkers.
    pub span: u64,
    /// The inner loop.
    pub pixel: u64,
    /// Outlines: found, followed and mixed. It is 0 in plain frames.
    pub edges: u64,
    /// Pixels of the display made from light. It is 0 where pixels are drawn as the display takes them.
    pub output: u64,
    /// Pixels on their way to the display. Not part of [`Self::drawing`].
    pub transfer: u64,
    /// Background and depth of the band cleared. Not part of [`Self::drawing`].
    pub clear: u64,
    /// Once a frame: camera, lights, views.
    pub frame: u64,
}

impl Stages {
    /// Instructions that draw: all but clearing and transfer.
    #[must_use]
    pub fn drawing(&self) -> u64 {
        self.vertex + self.cull + self.setup + self.span + self.pixel + self.edges + self.output + self.frame
    }
}

/// The stage of a function, or the stage of its caller.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Part {
    Frame,
    Vertex,
    Cull,
    Setup,
    /// Span and inner loop.
    Row,
    Clear,
    Edges,
    Output,
    Transfer,
    /// The processor has nothing to do until the transfer has ended.
    Idle,
    /// Not part of a frame, but it may call functions that are.
    Outside,
    /// Not part of a frame: a loop that would take long to watch.
    Unwatched,
    Callers,
}

/// Parts of functions by what their names contain; the first that fits counts. Names as the compiler writes them, so that this
/// is the one place to follow when functions move.
const TABLE: [(&str, Part); 39] = [
    ("microphong_kernels::processor::", Part::Row),
    ("microphong_kernels::lit::", Part::Row),
    ("microphong::raster::triangle::fill_rows", Part::Row),
    ("as microphong::raster::canvas::SpanShader::span", Part::Row),
    ("microphong::raster::band::Band::clear", Part::Clear),
    ("microphong::raster::band::fill_pixels", Part::Clear),
    ("microphong::raster::gradient::fill", Part::Clear),
    ("microphong::pixel::light::Output::convert", Part::Output),
    ("microphong::pixel::light::Output::pack", Part::Output),
    ("microphong::text::draw", Part::Setup),
    ("microphong::renderer::Renderer::frame", Part::Frame),
    ("microphong::renderer::Renderer::draw", Part::Frame),
    ("microphong::renderer::Renderer::place", Part::Frame),
    ("microphong::renderer::Renderer::prepare", Part::Frame),
    ("microphong::frame::preparation::Prepared::", Part::Frame),
    ("microphong::frame::preparation::Halves::", Part::Frame),
    ("microphong::mesh::vertices::VertexStage::transform", Part::Vertex),
    ("microphong::frame::preparation::PreparationPart", Part::Cull),
    ("microphong::geometry::bin::Bins", Part::Cull),
    ("microphong::frame::part::FrameRows::draw", Part::Setup),
    ("microphong::frame::smoother::Smoother::", Part::Edges),
    ("microphong::frame::part::FrameRows::find_edges", Part::Edges),
    ("microphong::frame::colours::Colours::drawing", Part::Setup),
    ("microphong::frame::context::Context::pass", Part::Setup),
    ("microphong::mesh::Drawing", Part::Setup),
    ("microphong::mesh::pass::MeshPass", Part::Setup),
    // Of the host's program, which has no display.
    ("frame::counted_frame", Part::Frame),
    ("Framebuffer::blit", Part::Transfer),
    ("as microphong_firmware::Display::send", Part::Transfer),
    ("microphong_firmware::st7789::wait", Part::Idle),
    ("microphong_firmware::second_core::wait", Part::Idle),
    // The other processor has the display.
    ("embassy_rp::critical_section_impl", Part::Idle),
    ("microphong_firmware::check", Part::Unwatched),
    ("microphong_firmware::stack", Part::Unwatched),
    ("microphong_firmware::processor::paint", Part::Unwatched),
    ("microphong::stream", Part::Unwatched),
    ("Reset", Part::Unwatched),
    ("microphong_firmware::animate", Part::Outside),
    ("microphong::renderer::Renderer::fill_tables", Part::Outside),
];

/// Stages that every frame has. If one is missing, the table of functions is out of date.
const NEEDED: [Part; 6] = [Part::Row, Part::Clear, Part::Frame, Part::Vertex, Part::Cull, Part::Setup];

/// The part of the function with this name.
pub(super) fn part(name: &str) -> Part {
    let name = short_name(name);
    TABLE.iter().find(|(text, _)| name.contains(text)).map_or(Part::Callers, |&(_, part)| part)
}

#[derive(Clone, Debug)]
struct Function {
    range: Range<u32>,
    part: Part,
}

/// Instructions and cycles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Cost {
    instructions: u64,
    cycles: u64,
}

impl Add for Cost {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { instructions: self.instructions + other.instructions, cycles: self.cycles + other.cycles }
    }
}

impl Sum for Cost {
    fn sum<I: Iterator<Item = Self>>(costs: I) -> Self {
        costs.fold(Self::default(), Add::add)
    }
}

/// Counts at an address of a function that draws rows: executions, cost including calls, and the addresses that followed.
#[derive(Clone, Debug, Default)]
struct Site {
    count: u64,
    cost: Cost,
    next: Vec<usize>,
}

/// Follows a program instruction by instruction and books each to a stage.
#[derive(Clone, Debug)]
pub struct Meter {
    /// Functions in the order of their addresses.
    functions: Vec<Function>,
    /// The function of each half-word from `base` on, and one more than all for none.
    owners: Vec<u16>,
    base: u32,
    /// State of each processor.
    cores: [Core; 2],
    /// Cost of each [`Part`].
    costs: [Cost; Part::Callers as usize + 1],
    /// Like `owners`.
    sites: Vec<Site>,
}

/// State of a processor.
#[derive(Clone, Debug, Default)]
struct Core {
    /// Functions that have been entered and not left, and the part that each plays.
    calls: Vec<(u16, Part)>,
    /// The last instruction in a row's own function, as an index of `sites`.
    site: usize,
}

/// A frame as it was followed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Instructions.
    pub instructions: Stages,
    /// Cycles.
    pub cycles: Stages,
    /// Cycles in which nothing was to be done.
    pub idle: u64,
    /// Rows of triangles.
    pub spans: u64,
}

impl Meter {
    /// A meter for this program.
    ///
    /// # Errors
    /// When it is stripped, or its functions have other names than the table has.
    pub fn new(elf: &Elf) -> Result<Self> {
        let mut functions: Vec<_> = elf.functions()?.into_iter().map(|(name, range)| Function { part: part(&name), range }).collect();
        functions.sort_by_key(|function| (function.range.start, function.range.end));
        functions.dedup_by_key(|function| function.range.start);
        for part in NEEDED {
            let found = functions.iter().any(|function| function.part == part);
            ensure!(found, "the firmware has no function for the stage {part:?}: the table in {} has fallen behind", file!());
        }
        let base = functions.first().context("the firmware has no functions")?.range.start;
        let end = functions.iter().map(|function| function.range.end).max().unwrap_or(base);
        let mut owners = vec![u16::MAX; (end - base).div_ceil(2) as usize];
        for (index, function) in (0..).zip(&functions) {
            let range = (function.range.start - base) as usize / 2..(function.range.end - base) as usize / 2;
            owners.get_mut(range).context("functions overlap")?.fill(index);
        }
        let sites = vec![Site::default(); owners.len()];
        Ok(Self { functions, owners, base, cores: Default::default(), costs: Default::default(), sites })
    }

    /// The addresses that must be watched, in few pieces.
    #[must_use]
    pub fn ranges(&self) -> Vec<Range<u32>> {
        let mut pieces: Vec<Range<u32>> = Vec::new();
        let mut after_unwatched = true;
        for function in &self.functions {
            let unwatched = function.part == Part::Unwatched;
            match pieces.last_mut() {
                _ if unwatched => {}
                Some(last) if !after_unwatched => last.end = last.end.max(function.range.end),
                _ => pieces.push(function.range.clone()),
            }
            after_unwatched = unwatched;
        }
        pieces
    }

    /// An instruction has been executed.
    #[inline]
    pub fn step(&mut self, Executed { core, address, cycles }: Executed) {
        let Self { functions, owners, base, cores, costs, sites } = self;
        let index = (address.wrapping_sub(*base) / 2) as usize;
        let (Some(&owner), Some(Core { calls, site })) = (owners.get(index), cores.get_mut(core)) else { return };
        if calls.last().is_none_or(|&(function, _)| function != owner) {
            enter(functions, calls, owner, address);
        }
        let Some(&(function, part)) = calls.last() else { return };
        let cost = Cost { instructions: 1, cycles };
        if part == Part::Row {
            if let Some(Function { range, part: Part::Row }) = functions.get(usize::from(function)) {
                if address != range.start && !sites[*site].next.contains(&index) {
                    sites[*site].next.push(index);
                }
                *site = index;
                sites[index].count += 1;
            }
            let site = &mut sites[*site];
            site.cost = site.cost + cost;
        } else {
            let sum = &mut costs[part as usize];
            *sum = *sum + cost;
        }
    }

    /// The counts so far.
    #[must_use]
    pub fn tally(&self) -> Tally {
        let (mut span, mut pixel, mut spans) = (Cost::default(), Cost::default(), 0);
        for function in self.functions.iter().filter(|function| function.part == Part::Row) {
            let place = |address: u32| (address - self.base) as usize / 2;
            let (start, end) = (place(function.range.start), place(function.range.end));
            let sites = || self.sites[start..end].iter().zip(start as u64..);
            let ways = sites().flat_map(|(site, index)| site.next.iter().map(move |&next| (index, next as u64)));
            let nest = Nest::new(start as u64, ways, |index| self.sites[index as usize].count);
            for (site, index) in sites() {
                let sum = if nest.inner.contains(&index) { &mut pixel } else { &mut span };
                *sum = *sum + site.cost;
            }
            spans += nest.rows;
        }
        let stages = |of: fn(Cost) -> u64| {
            let part = |part: Part| of(self.costs[part as usize]);
            Stages {
                vertex: part(Part::Vertex),
                cull: part(Part::Cull),
                setup: part(Part::Setup),
                span: of(span),
                pixel: of(pixel),
                edges: part(Part::Edges),
                output: part(Part::Output),
                transfer: part(Part::Transfer),
                clear: part(Part::Clear),
                frame: part(Part::Frame),
            }
        };
        Tally {
            instructions: stages(|cost| cost.instructions),
            cycles: stages(|cost| cost.cycles),
            idle: self.costs[Part::Idle as usize].cycles,
            spans,
        }
    }
}

/// Another function goes on: called if at its start, else returned to.
fn enter(functions: &[Function], calls: &mut Vec<(u16, Part)>, owner: u16, address: u32) {
    let Some(function) = functions.get(usize::from(owner)) else { return };
    if address != function.range.start
        && let Some(depth) = calls.iter().rposition(|&(caller, _)| caller == owner)
    {
        calls.truncate(depth + 1);
        return;
    }
    let caller = calls.last().map_or(Part::Outside, |&(_, part)| part);
    calls.push((owner, if function.part == Part::Callers { caller } else { function.part }));
}
