//! What a frame of a stream takes on boards, which `convert` ends with where that is asked for: counted under emulation, as `bench` does.

#[cfg(not(feature = "boards"))]
use super::absent::refuse;
use super::report;
use anyhow::Result;
use microphong_sim::scene::Scene;
use serde::Serialize;

/// A frame on one board.
#[derive(Serialize)]
pub(super) struct Cost {
    board: &'static str,
    cpu: &'static str,
    width: u32,
    height: u32,
    instructions: u64,
    /// Where time is modelled.
    frames_per_second: Option<f64>,
}

/// The boards to count on: all of them, or the one that has this name.
#[cfg(feature = "boards")]
pub(super) fn prepare(board: Option<&str>) -> Result<Counter> {
    use super::Usage;
    use microphong_bench::processor::Processor;

    let is_wanted = |processor: &&Processor| board.is_none_or(|board| processor.board_name() == board);
    let boards = Processor::ALL.iter().filter(|processor| processor.board().is_some()).filter(is_wanted);
    let boards: Vec<_> = boards.copied().collect();
    if boards.is_empty() {
        let board = board.unwrap_or_default();
        return Err(Usage(format!("--count cannot count frames of {board}; use mps2-an385, which has the same processor")).into());
    }
    Ok(Counter { boards })
}

/// Says how to get a build that can count.
#[cfg(not(feature = "boards"))]
pub(super) fn prepare(_: Option<&str>) -> Result<Counter> {
    let arguments: Vec<_> = std::env::args_os().skip(2).collect();
    refuse("boards to count on", "convert", &arguments).map(|_| Counter)
}

/// Boards to count on.
#[cfg(feature = "boards")]
pub(super) struct Counter {
    boards: Vec<microphong_bench::processor::Processor>,
}

/// Nothing: no boards are in this build.
#[cfg(not(feature = "boards"))]
pub(super) struct Counter;

impl Counter {
    /// What frames of a scene take by the method that it asks for, by the least program that draws it. Of several boards, one that cannot have this program
    /// is left out.
    #[cfg(feature = "boards")]
    pub(super) fn count(&self, scene: &Scene) -> Result<Vec<Cost>> {
        use microphong_bench::{Bench, board_styles::Program};
        use microphong_sim::shader::Shader;

        let stream = scene.stream.parse()?;
        let (shader, program) = (Shader::of(&stream)?, Program::needed_by(&stream));
        let mut boards = self.boards.clone();
        if boards.len() > 1 {
            boards.retain(|processor| processor.board().is_some_and(|board| program.check(board).is_ok()));
        }
        let bench = Bench::of_program(&boards, program)?;
        let wanted: Vec<_> = boards.iter().map(|&board| (board, shader)).collect();
        let bar = report::progress(wanted.len() as u64, "counting instructions");
        let measured = bench.count(scene, &wanted, &|| bar.inc(1))?;
        bar.finish_and_clear();
        let cost = |m: microphong_bench::Measurement| {
            let (width, height) = m.board.size();
            let frames_per_second = m.timing.map(|timing| timing.frames_per_second);
            Cost { board: m.board.board_name(), cpu: m.cpu, width, height, instructions: m.instructions, frames_per_second }
        };
        Ok(measured.into_iter().map(cost).collect())
    }

    /// No boards are in this build.
    #[cfg(not(feature = "boards"))]
    #[expect(clippy::unused_self, clippy::unnecessary_wraps, reason = "the other build needs both")]
    pub(super) fn count(&self, _: &Scene) -> Result<Vec<Cost>> {
        Ok(Vec::new())
    }
}

/// Prints what has been counted, or how it can be.
pub(super) fn text(costs: Option<&[Cost]>) -> Result<()> {
    let Some(costs) = costs else {
        return report::line("  --count prints the instructions of a frame on emulated boards (needs a build with `--features boards`)");
    };
    for Cost { board, cpu, width, height, instructions, frames_per_second } in costs {
        let rate = frames_per_second.map_or(String::new(), |rate| format!(", {rate} frames/s"));
        let instructions = report::grouped(*instructions);
        report::line(&format!("  a frame on {board} ({cpu}, emulated), {width}x{height}: {instructions} instructions{rate}"))?;
    }
    Ok(())
}
