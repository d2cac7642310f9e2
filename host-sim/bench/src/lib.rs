//! Instructions of a frame, by stage, and its errors. Counts are exact, because an emulated board executes the firmware itself, and callgrind the
//! same code on the host.

pub mod baseline;
pub mod board_styles;
pub mod break_even;
pub mod callgrind;
pub mod family;
pub mod flash;
pub mod growth;
pub mod measurement;
mod nest;
pub mod page;
pub mod pareto;
pub mod peers;
pub mod processor;
pub mod renewal;
pub mod size;
pub mod stage;
pub mod styles;

use anyhow::{Context, Result, ensure};
use board_styles::Program;
use embedded_graphics_core::{geometry::Size, pixelcolor::Rgb565};
use flash::Graph;
pub use measurement::{Measurement, Timing};
use microphong::{pixel::Pixel as _, renderer::check};
use microphong_boards::{self as boards, Board, elf::Elf};
use microphong_compare::Reference;
use microphong_models::scene::Scene;
use microphong_render::{choices, shader::Shader};
pub use processor::Processor;
use rayon::prelude::*;
use stage::Meter;
pub use stage::Stages;
use std::path::PathBuf;

/// A board's firmware, ready to be measured with any scene and method.
#[derive(Debug)]
struct Firmware {
    board: Board,
    elf: Elf,
    meter: Meter,
    graph: Graph,
}

/// Processors, ready to measure frames.
#[derive(Debug)]
pub struct Bench {
    firmware: Vec<(Processor, Firmware)>,
    /// The program that draws on the host.
    host: Option<PathBuf>,
    /// Whether streams get neighbours, so that boards draw smooth outlines.
    antialias: bool,
}

impl Bench {
    /// Builds what the processors execute.
    ///
    /// # Errors
    /// When a firmware does not compile.
    pub fn new(processors: &[Processor]) -> Result<Self> {
        Self::of_program(processors, Program::PLAIN)
    }

    /// Builds the firmware of boards that draws smooth outlines.
    ///
    /// # Errors
    /// When a board has no memory for them, a processor is no board, or a firmware does not compile.
    pub fn antialiased(processors: &[Processor]) -> Result<Self> {
        ensure!(!processors.contains(&Processor::X86_64), "smooth outlines on this computer are counted by --styles");
        Ok(Self { antialias: true, ..Self::of_program(processors, Program::ANTIALIAS)? })
    }

    /// Builds a program of boards.
    ///
    /// # Errors
    /// When a board has no memory for it, or it does not compile.
    pub fn of_program(processors: &[Processor], program: Program) -> Result<Self> {
        let boards = processors.iter().filter(|processor| processor.board().is_some());
        let built = boards.map(|&processor| Ok((processor, Firmware::build(processor, program)?)));
        let host = processors.contains(&Processor::X86_64).then(callgrind::build).transpose()?;
        Ok(Self { firmware: built.collect::<Result<_>>()?, host, antialias: false })
    }

    /// Measures frame 0 of `scene` by each of the `wanted` methods on each of the processors, with its error and what `auto`
    /// chooses unless there are several objects, several at a time, and calls `tick` after each.
    ///
    /// # Errors
    /// When a method cannot shade the scene, or a board fails.
    pub fn measure(&self, scene: &Scene, wanted: &[(Processor, Shader)], tick: &(dyn Fn() + Sync)) -> Result<Vec<Measurement>> {
        let mut measured = self.count(scene, wanted, tick)?;
        // Lines would hide errors of shading.
        let shaded = scene.stream.clone().without_outlines().or_budget(Rgb565::BUDGET);
        let stream = shaded.parse()?;
        // No reference draws several objects.
        if !stream.instances.is_empty() {
            return Ok(measured);
        }
        let mut sizes: Vec<_> = wanted.iter().map(|(processor, _)| processor.size()).collect();
        sizes.sort_unstable();
        sizes.dedup();
        let references = sizes.into_par_iter().map(|size| Ok((size, Reference::new(stream, size, 0)?)));
        let references: Vec<_> = references.collect::<Result<_>>()?;
        let mut frames: Vec<_> = wanted.iter().map(|(processor, shader)| (processor.size(), shader.name(), *shader)).collect();
        frames.sort_unstable_by_key(|&(size, name, _)| (size, name));
        frames.dedup_by_key(|&mut (size, name, _)| (size, name));
        let errors = frames.into_par_iter().map(|(size, name, shader)| {
            let reference = references.iter().find(|(of, _)| *of == size);
            let (_, reference) = reference.context("a size without a reference")?;
            let told = choices::by::<Rgb565>(shader, stream, Size::new(size.0, size.1), false, 0)?;
            Ok((size, name, reference.total(shader)?, told.map(|told| (told.budget, told.choices)).unzip()))
        });
        let errors: Vec<_> = errors.collect::<Result<_>>()?;
        for (measurement, (processor, shader)) in measured.iter_mut().zip(wanted) {
            let error = errors.iter().find(|(size, name, ..)| *size == processor.size() && *name == shader.name());
            if let Some(&(.., error, (budget, choices))) = error {
                measurement.max_lsb = Some(rounded(error.max, 1e4));
                measurement.rmse_lsb = Some(rounded(error.rmse, 1e4));
                (measurement.budget, measurement.choices) = (budget, choices);
            }
        }
        Ok(measured)
    }

    /// Counts as [`Self::measure`] does, without errors and choices.
    ///
    /// # Errors
    /// When a method cannot shade the scene, or a board fails.
    pub fn count(&self, scene: &Scene, wanted: &[(Processor, Shader)], tick: &(dyn Fn() + Sync)) -> Result<Vec<Measurement>> {
        let stream = scene.stream.parse()?;
        for (_, shader) in wanted {
            check(&stream, shader.facts(), false)?;
        }
        let drawn = self.count_on_host(scene, wanted, tick)?;
        let stream = if self.antialias { scene.stream.with_neighbours()? } else { scene.stream.clone() };
        let scene = Scene { name: scene.name.clone(), stream, size: scene.size };
        let measured = wanted.par_iter().map(|&(processor, shader)| {
            if let Some(measurement) = drawn.iter().find(|m| processor == Processor::X86_64 && m.shader == shader.name()) {
                return Ok(measurement.clone());
            }
            let firmware = self.firmware.iter().find(|(of, _)| *of == processor);
            let (_, firmware) = firmware.with_context(|| format!("no firmware for {}", processor.name()))?;
            let measured = firmware.measure(processor, &scene, shader);
            tick();
            measured.with_context(|| format!("{}, {}, {}", processor.board_name(), scene.name, shader.name()))
        });
        measured.collect()
    }

    /// Counts the `wanted` frames that the host draws. One process draws many of them, because its start takes long.
    fn count_on_host(&self, scene: &Scene, wanted: &[(Processor, Shader)], tick: &(dyn Fn() + Sync)) -> Result<Vec<Measurement>> {
        let Some(program) = &self.host else { return Ok(Vec::new()) };
        let (size, band_rows) = (Processor::X86_64.size(), Processor::X86_64.size().1);
        let wanted = wanted.iter().filter(|(processor, _)| *processor == Processor::X86_64);
        let frames: Vec<_> = wanted.map(|&(_, shader)| callgrind::Frame { size, band_rows, shader }).collect();
        let share = frames.len().div_ceil(rayon::current_num_threads()).max(1);
        let counted = frames.par_chunks(share).map(|frames| {
            let counts = callgrind::count(program, scene.stream.as_bytes(), frames).with_context(|| format!("x86-64, {}", scene.name))?;
            frames.iter().for_each(|_| tick());
            Ok(frames.iter().zip(counts).map(|(frame, count)| count.measurement(&scene.name, frame.shader)).collect::<Vec<_>>())
        });
        Ok(counted.collect::<Result<Vec<_>>>()?.concat())
    }
}

impl Firmware {
    fn build(processor: Processor, program: Program) -> Result<Self> {
        let board = processor.board().with_context(|| format!("{} has no firmware", processor.name()))?;
        let elf = Elf::read(&program.build(board)?)?;
        Ok(Self { board, meter: Meter::new(&elf)?, graph: Graph::new(&elf)?, elf })
    }

    fn measure(&self, processor: Processor, scene: &Scene, shader: Shader) -> Result<Measurement> {
        let elf = self.elf.with_stream(&boards::watchable(self.board, scene.stream.as_bytes(), shader)?)?;
        let mut meter = self.meter.clone();
        let ranges = meter.ranges();
        let watched = boards::watch(self.board, &elf, &ranges, &mut |executed| meter.step(executed))?;
        let tally = meter.tally();
        let log = &watched.recording;
        let (instructions, pixels) = (tally.instructions.drawing(), log.figure("pixels")?);
        let flash = self.graph.flash(shader)?;
        let timing = watched.time.zip(processor.clock()).map(|(time, clock)| Timing {
            frame_cycles: time.all,
            render_cycles: tally.cycles.drawing() + tally.cycles.clear,
            wire_cycles: time.wire,
            idle_cycles: tally.idle,
            frames_per_second: rounded(clock / time.all.max(1) as f64, 10.0),
        });
        Ok(Measurement {
            board: processor,
            cpu: processor.name(),
            scene: scene.name.clone(),
            shader: shader.name(),
            instructions,
            cycles: watched.time.map(|_| tally.cycles.drawing()),
            pixels,
            triangles: log.figure("drawn")?,
            spans: tally.spans,
            instr_per_pixel: rounded(instructions as f64 / pixels.max(1) as f64, 100.0),
            by_stage: tally.instructions,
            ram_bytes: Some(elf.ram_bytes()? + log.stack_bytes().context("the firmware has not logged its use of the stack")?),
            flash_bytes: Some(flash.alone),
            max_lsb: None,
            rmse_lsb: None,
            budget: None,
            choices: None,
            flash_own_bytes: Some(flash.own),
            firmware_bytes: Some(elf.flash_bytes()?.saturating_sub(u64::from(scene.stream.parse()?.header.length))),
            timing,
        })
    }
}

/// Rounds `value` to 1 over `parts`.
fn rounded(value: f64, parts: f64) -> f64 {
    (value * parts).round() / parts
}
