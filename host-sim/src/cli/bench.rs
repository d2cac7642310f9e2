//! `microphong bench`.

use super::{
    Outcome, Usage, growth,
    mesh_options::MeshOptions,
    parse::{self, Several},
    report, scenes,
};
use anyhow::Result;
use microphong::{format::ErrorBudget, renderer::check};
use microphong_sim::{
    bench::{
        Bench, Measurement, Processor, Timing, baseline, board_styles,
        callgrind::Counters,
        growth::{SHADERS, Sweep},
        page::Page,
        peers::{
            self, Program,
            table::{Table, short},
        },
        renewal::{self, Growth},
        styles::{self, Named, RedrawCost, StyleCosts},
    },
    board::Board,
    scene::{self, Scene},
    shader::Shader,
};
use std::path::{Path, PathBuf};

/// Count the instructions that a processor needs for one frame, by stage, and measure the error of the frame
///
/// The counts are exact: an emulated board runs its firmware, or callgrind runs the code on this computer, and every instruction is counted.
/// Instructions are not cycles. Cycles and times of the Pico and the Pico 2 are approximate.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Arguments {
    /// .tri, .obj, .stl, .ply, .gltf, .glb, .3mf and .toml files, names of built-in scenes, or `all` for every built-in scene. By default nine scenes of
    /// common kinds: large and small triangles, in one hue, in blue with a white highlight, under two coloured lights, a building of ten materials, a figure
    /// and a mechanical part.
    #[arg(value_name = "SCENE", default_values = scene::PORTFOLIO)]
    scenes: Vec<String>,
    /// Shading methods, separated by commas, or `all` for every method that can draw the scene.
    #[arg(long, value_name = "S,...", default_value = "flat,gouraud,six-point,sqrt6,phong", value_parser = parse::SeveralShaders)]
    shader: Several<Shader>,
    /// Error budgets of auto and auto-linear, separated by commas: the largest difference of a pixel from Phong shading, in 1/255, from 0.5 to 16. The
    /// default is the budget of the scene. If it has none, the budget is 4, as on all RGB565 displays.
    #[arg(long, value_name = "LSB,...", value_delimiter = ',', value_parser = parse::budget)]
    budget: Vec<ErrorBudget>,
    #[arg(long, value_name = "B,...", value_parser = processors, help = boards_help())]
    board: Option<Several<Processor>>,
    #[arg(long, conflicts_with_all = ["report", "peers"], help = antialias_help())]
    antialias: bool,
    /// Print one JSON object per frame, or per animation.
    #[arg(long)]
    json: bool,
    /// Write DIR/index.html and DIR/chart.svg: a page with run time against error, the growth of costs, and break-even points.
    #[arg(long, value_name = "DIR")]
    report: Option<PathBuf>,
    /// Also measure other renderers on these scenes, on the boards mps2-an385, mps2-an386 and x86-64, and print their figures beside those of microphong.
    #[arg(long)]
    peers: bool,
    /// Count frames in several styles. On this computer: with antialiasing, with lines along outlines, and with interpolation in perspective. On
    /// boards also: under near lights with a range or a cone, under 2 to 8 lights and the light of the sky, with colours at corners, textures, holes and
    /// glass, with gamma, and in each pixel format. Styles that a board, a scene or a method cannot have are left out, with the reason.
    #[arg(long, conflicts_with_all = ["antialias", "report", "peers"])]
    styles: bool,
    /// Count how many instructions are saved by skipping invisible work, for each kind of work, on this computer.
    #[arg(long, conflicts_with_all = ["antialias", "board", "report", "peers", "styles"])]
    skips: bool,
    /// Count the frames of an animation after the first, in bands of 16 rows, on this computer: whole pictures with and without hidden objects, and
    /// partial redraw.
    #[arg(long, conflicts_with_all = ["antialias", "board", "report", "peers", "styles", "skips"])]
    redraw: bool,
    /// Measure the frames that FILE lists. Fail if a frame needs over 0.2 % more instructions or flash than FILE records.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["scenes", "MeshOptions", "shader", "antialias", "board", "json", "report", "peers", "styles", "skips", "redraw"])]
    check: Option<PathBuf>,
    /// Measure the frames that FILE lists, and record their costs there. Needs --reason.
    #[arg(
        long,
        value_name = "FILE",
        requires = "reason",
        conflicts_with_all = ["scenes", "MeshOptions", "shader", "antialias", "board", "json", "report", "peers", "styles", "skips", "redraw", "check"]
    )]
    renew: Option<PathBuf>,
    /// The reason for the changed costs, in a sentence. With --renew costs.csv it is added to costs-reasons.md.
    #[arg(long, value_name = "TEXT", requires = "renew", value_parser = parse::reason)]
    reason: Option<String>,
    #[command(flatten)]
    options: Option<MeshOptions>,
}

const EXAMPLES: &str = "\
Examples:
  microphong bench                                       ordinary scenes on a Cortex-M3
  microphong bench peer-sphere-convex                    a convex mesh, drawn without depth test
  microphong bench teapot --board pico --shader sqrt6    frame time and frames per second of the Pico
  microphong bench all --shader all --board all --json   all scenes, methods and boards
  microphong bench peer-sphere --shader all --board all --report bench    a page with the chart
  microphong bench --peers --board mps2-an385,mps2-an386,x86-64    compared with other renderers
  microphong bench teapot --antialias --shader gouraud   with smooth outlines
  microphong bench --styles                              the cost of antialiasing, outlines and perspective
  microphong bench teapot --styles --board mps2-an385    the cost of lights and pixel formats as well
  microphong bench all --skips                           the saving by skipping invisible work
  microphong bench board --redraw --shader auto          the saving by partial redraw
  microphong bench --check tests/baselines/costs.csv     check that no cost has grown
  microphong bench --check tests/baselines/styles.csv    the same for styles
  microphong bench --renew tests/baselines/costs.csv --reason \"Thin triangles no longer flicker.\"
                                                         record the new costs and the reason

Stages:
  frame     once per frame: camera, lights
  vertex    transformation and lighting of vertices
  cull      removing triangles that face away or are off screen, and sorting the others into bands
  set-up    once per triangle and band: polynomials of light and depth, edges
  span      once per row of a triangle: work before the inner loop
  pixel     the inner loop
  edges     smooth outlines: finding and following edges, mixing pixels
  output    making pixels of the display from light
  clear     filling the band with the background and the farthest depth; not part of the sum
  transfer  sending pixels to the display, without waiting; not part of the sum

  flash     flash that the method adds to a firmware without methods; in brackets the part
            that no other method shares
  error     difference from per-pixel Phong shading in 64-bit floating point; 255 is full intensity

Exit codes: 0 success; 1 failure, or a cost has grown; 2 wrong usage.";

/// The boards of `--board`, or this one.
fn boards(arguments: &Arguments, default: Processor) -> Several<Processor> {
    arguments.board.clone().unwrap_or(Several { values: vec![default], all: false })
}

/// Explains `--board`.
fn boards_help() -> String {
    let names = Processor::ALL.map(|processor| match processor.board() {
        Some(board) => format!("{board} ({})", processor.name()),
        None => format!("{} (this computer)", processor.name()),
    });
    format!("Boards, separated by commas: {}; or all. The default is mps2-an385, or x86-64 with --styles", names.join(", "))
}

/// Explains `--antialias`.
fn antialias_help() -> String {
    let smooth = Board::names(Processor::ALL.into_iter().filter_map(Processor::board).filter(|board| board.smooths()));
    format!("Draw smooth outlines. Only some boards have the memory for them: {smooth}; name them with --board")
}

/// Processors, by their boards.
fn processors(text: &str) -> Result<Several<Processor>, String> {
    parse::several(text, &Processor::ALL, |text| parse::among(text, &Processor::ALL, Processor::board_name))
}

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome> {
    if let Some(path) = &arguments.check {
        return compare(path);
    }
    if let (Some(path), Some(reason)) = (&arguments.renew, &arguments.reason) {
        return renew(path, reason);
    }
    if (arguments.styles || arguments.skips || arguments.redraw) && arguments.budget.len() > 1 {
        return Err(Usage("--styles, --skips and --redraw take only one --budget; give one value".to_owned()).into());
    }
    let scenes = scenes::load_all(&arguments.scenes, arguments.options.as_ref(), arguments.budget.first().copied())?;
    let Several { values: shaders, all } = &arguments.shader;
    let wanted = |scene: &Scene| {
        let possible = |shader: Shader| scene.stream.parse().is_ok_and(|stream| check(&stream, shader.facts(), false).is_ok());
        shaders.iter().copied().filter(|&shader| !all || possible(shader)).collect::<Vec<_>>()
    };
    if arguments.redraw {
        return redraws(&scenes, wanted, arguments.json);
    }
    if arguments.skips {
        return in_styles(&scenes, &wanted, styles::skips, arguments.json);
    }
    if arguments.styles {
        // Lines are one of the styles.
        let scenes: Vec<_> = scenes.into_iter().map(|scene| Scene { stream: scene.stream.without_outlines(), ..scene }).collect();
        return on_boards(&boards(arguments, Processor::X86_64), &scenes, &wanted, arguments.json);
    }
    let boards = boards(arguments, Processor::CortexM3);
    let wanted = |scene: &Scene| {
        let shaders = wanted(scene);
        boards.values.iter().flat_map(|&board| shaders.iter().map(move |&shader| (board, shader)).collect::<Vec<_>>()).collect()
    };
    let scenes: Vec<(Scene, Vec<_>)> = scenes.into_iter().map(|scene| (wanted(&scene), scene)).map(|(w, s)| (s, w)).collect();
    let page = arguments.report.as_deref().map(Page::create).transpose()?;
    let common = if arguments.peers { drawable(&scenes)? } else { Vec::new() };
    let with_peers: Vec<_> = boards.values.iter().copied().filter(|&board| !common.is_empty() && peers::possible(board)).collect();
    // What depends on the budget is measured once more for each that is left.
    let others = arguments.budget.get(1..).unwrap_or_default();
    let again = |wanted: &[(Processor, Shader)]| wanted.iter().copied().filter(|&(_, shader)| shader.keeps_budget()).collect::<Vec<_>>();
    let steps = scenes.iter().map(|(_, wanted)| wanted.len() + others.len() * again(wanted).len()).sum::<usize>();
    let steps = steps + 1 + common.len() * with_peers.len();
    let bar = report::progress(steps as u64, "counting instructions");
    let bench = if arguments.antialias {
        Bench::antialiased(&boards.values)?
    } else {
        let needed = |program: board_styles::Program, (scene, _): &(Scene, _)| {
            anyhow::Ok(program.and(board_styles::Program::needed_by(&scene.stream.parse()?)))
        };
        Bench::of_program(&boards.values, scenes.iter().try_fold(board_styles::Program::PLAIN, needed)?)?
    };
    bar.inc(1);
    let mut all = Vec::new();
    for (scene, wanted) in &scenes {
        let mut measured = bench.measure(scene, wanted, &|| bar.inc(1))?;
        for &budget in others {
            measured.extend(bench.measure(&scenes::with_budget(scene.clone(), Some(budget)), &again(wanted), &|| bar.inc(1))?);
        }
        bar.suspend(|| measured.iter().try_for_each(|m| if arguments.json { report::json(m) } else { text(m) }))?;
        all.extend(measured);
    }
    let programs = with_peers.into_iter().map(Program::build).collect::<Result<Vec<_>>>()?;
    let mut tables = Vec::new();
    for scene in common {
        let mut theirs = Vec::new();
        for program in &programs {
            theirs.extend(program.measure(scene)?);
            bar.inc(1);
        }
        let table = Table::new(&scene.name, &all, &theirs, &boards.values)?;
        bar.suspend(|| if arguments.json { theirs.iter().try_for_each(report::json) } else { beside(&table) })?;
        tables.push(table);
    }
    bar.finish_and_clear();
    if let Some(page) = page {
        let path = page.finish(&all, &tables, &growth::count(&Sweep::ALL, &SHADERS)?)?;
        if !arguments.json {
            report::line(&format!("report: {}", path.display()))?;
        }
    }
    Ok(Outcome::Done)
}

/// Counts `scenes` by the `wanted` methods in the styles of each board.
fn on_boards(boards: &Several<Processor>, scenes: &[Scene], wanted: &dyn Fn(&Scene) -> Vec<Shader>, json: bool) -> Result<Outcome> {
    for &board in &boards.values {
        if board == Processor::X86_64 {
            in_styles(scenes, wanted, styles::styles, json)?;
            continue;
        }
        let frames = scenes.iter().map(|scene| wanted(scene).len() * board_styles::STYLES.len()).sum::<usize>();
        let bar = report::progress(frames as u64, "counting instructions");
        let costs = board_styles::measure(board, scenes, wanted, &|| bar.inc(1))?;
        bar.finish_and_clear();
        styled(&costs, json)?;
    }
    Ok(Outcome::Done)
}

/// Counts `scenes` by the `wanted` methods in `styles`, on this computer.
fn in_styles(scenes: &[Scene], wanted: &dyn Fn(&Scene) -> Vec<Shader>, styles: fn(Shader) -> Vec<Named>, json: bool) -> Result<Outcome> {
    let bar = report::progress(scenes.iter().map(|scene| wanted(scene).len() as u64).sum(), "counting instructions");
    let counters = Counters::default();
    for scene in scenes {
        let costs = styles::measure(&counters, scene, &wanted(scene), styles, &|| bar.inc(1))?;
        bar.suspend(|| styled(&costs, json))?;
    }
    bar.finish_and_clear();
    Ok(Outcome::Done)
}

/// Counts the animations of `scenes` by the `wanted` methods.
fn redraws(scenes: &[Scene], wanted: impl Fn(&Scene) -> Vec<Shader>, json: bool) -> Result<Outcome> {
    let bar = report::progress(scenes.iter().map(|scene| wanted(scene).len() as u64).sum(), "counting instructions");
    let counters = Counters::default();
    for scene in scenes {
        match styles::redraw(&counters, scene, &wanted(scene), &|| bar.inc(1)) {
            Ok(costs) => bar.suspend(|| costs.iter().try_for_each(|cost| if json { report::json(cost) } else { redrawn(cost) }))?,
            // Others may move.
            Err(error) if scenes.len() > 1 => bar.suspend(|| report::error(&format!("{error:#}"))),
            Err(error) => return Err(error),
        }
    }
    bar.finish_and_clear();
    Ok(Outcome::Done)
}

fn redrawn(cost: &RedrawCost) -> Result<()> {
    let RedrawCost { scene, shader, frames, band_rows, whole, with_hidden_objects, redrawn } = cost;
    let (times, share) = (*with_hidden_objects as f64 / *whole as f64, 100.0 * *redrawn as f64 / *whole as f64);
    report::line(&format!(
        "x86-64, {scene}, {shader}: {} instructions per frame, mean of {frames} in bands of {band_rows} rows; with hidden-objects {times:.2} times; \
         partial redraw {}, {share:.1} %",
        report::grouped(*whole),
        report::grouped(*redrawn)
    ))
}

/// Prints costs of styles: as JSON, or a table for each scene, with a row for each style and a column for each method.
fn styled(costs: &[StyleCosts], json: bool) -> Result<()> {
    if json {
        return costs.iter().try_for_each(report::json);
    }
    for costs in costs.chunk_by(|one, next| one.scene == next.scene) {
        let Some(first) = costs.first() else { continue };
        report::line(&format!("{}, {}: instructions per pixel, and how many times the plain frame", first.board, first.scene))?;
        let cells = |cells: Vec<String>| cells.iter().map(|cell| format!("{cell:>17}")).collect::<String>();
        report::line(&format!("  {:20}{}", "", cells(costs.iter().map(|cost| cost.shader.to_owned()).collect())))?;
        for (number, style) in first.styles.iter().enumerate() {
            let figure = |cost: &StyleCosts| match (cost.instructions[0], cost.instructions[number]) {
                (Some(plain), Some(count)) => {
                    let (count, pixels) = (count as f64, f64::from(cost.pixels.max(1)));
                    format!("{:.1} {:6.2}", count / pixels, count / plain.max(1) as f64)
                }
                _ => "-".to_owned(),
            };
            report::line(&format!("  {style:20}{}", cells(costs.iter().map(figure).collect())))?;
        }
        for (number, style) in first.styles.iter().enumerate() {
            for same in costs.chunk_by(|one, next| one.obstacles[number] == next.obstacles[number]) {
                let methods: Vec<_> = same.iter().map(|cost| cost.shader).collect();
                if let Some(obstacle) = same.first().and_then(|cost| cost.obstacles[number].as_ref()) {
                    report::line(&format!("  left out: {style}, {}: {obstacle}", methods.join(", ")))?;
                }
            }
        }
    }
    Ok(())
}

/// The scenes that other renderers can draw; says why they cannot draw the others.
fn drawable<W>(scenes: &[(Scene, W)]) -> Result<Vec<&Scene>> {
    let mut drawable = Vec::new();
    for (scene, _) in scenes {
        match peers::obstacle(&scene.stream.parse()?)? {
            Some(obstacle) => report::error(&format!("other renderers cannot draw {}: {obstacle}", scene.name)),
            None => drawable.push(scene),
        }
    }
    Ok(drawable)
}

/// Ours beside theirs.
fn beside(table: &Table) -> Result<()> {
    report::line(&format!("{}, instructions per pixel", table.scene))?;
    let cells = |cells: Vec<String>| cells.iter().map(|cell| format!("{cell:>15}")).collect::<String>();
    report::line(&format!("  {:32}{}", "", cells(table.processors.iter().map(|cpu| cpu.name().to_owned()).collect())))?;
    for row in &table.rows {
        let figures = cells(row.figures.iter().map(|f| f.map_or("-".to_owned(), short)).collect());
        report::line(format!("  {:32}{figures}  {}", row.name, row.note).trim_end())?;
    }
    if let Some(note) = table.note() {
        report::line(&format!("  {note}"))?;
    }
    Ok(())
}

/// What a file lists, as recorded and as measured now.
fn again(path: &Path) -> Result<[Vec<baseline::Entry>; 2]> {
    let recorded = baseline::read(path)?;
    let bar = report::progress(recorded.len() as u64, "counting instructions");
    let measured = baseline::measure(&recorded, &|| bar.inc(1))?;
    bar.finish_and_clear();
    Ok([recorded, measured])
}

fn compare(path: &Path) -> Result<Outcome> {
    let [recorded, measured] = again(path)?;
    let changes = baseline::changes(&recorded, &measured);
    changes.iter().try_for_each(|change| report::line(&change.to_string()))?;
    let grown = changes.iter().filter(|change| change.percent() > 0.0).count();
    let shrunk = changes.len() - grown;
    let renew = format!("if this is intended, renew the file: microphong bench --renew {} --reason \"...\"", path.display());
    if grown > 0 {
        report::line(&format!("{grown} of {} costs have grown by more than {} %; {renew}", 2 * recorded.len(), baseline::TOLERANCE))?;
    } else if shrunk > 0 {
        report::line(&format!("{shrunk} costs have shrunk, which would hide later growth; {renew}"))?;
    } else {
        report::line(&format!("the costs of {} frames are as recorded", recorded.len()))?;
    }
    grown_since(path, &measured)?;
    Ok(if grown > 0 { Outcome::Differences } else { Outcome::Done })
}

fn renew(path: &Path, reason: &str) -> Result<Outcome> {
    let [recorded, measured] = again(path)?;
    if recorded == measured {
        report::line(&format!("the costs of {} frames are exactly as recorded: nothing to renew", recorded.len()))?;
    } else {
        baseline::changes(&recorded, &measured).iter().try_for_each(|change| report::line(&change.to_string()))?;
        let reasons = renewal::renew(path, [&recorded, &measured], reason)?;
        report::line(&format!("{} frames recorded in {}, the reason in {}", measured.len(), path.display(), reasons.display()))?;
        report::line(&format!("mean of all frames: {}", renewal::Total::between(&recorded, &measured)))?;
    }
    grown_since(path, &measured)?;
    Ok(Outcome::Done)
}

/// The tolerance lets small growth pass each time; this shows what it has come to.
fn grown_since(path: &Path, now: &[baseline::Entry]) -> Result<()> {
    Growth::of(path, now)?.iter().try_for_each(|growth| report::line(&growth.to_string()))
}

fn text(m: &Measurement) -> Result<()> {
    let per = |count: u64, of: u64| count as f64 / of.max(1) as f64;
    let [all, pixels, spans] = [m.instructions, m.pixels, m.spans].map(report::grouped);
    let error = m.max_lsb.zip(m.rmse_lsb).map_or(String::new(), |(max, rmse)| format!("; error {max:.2} at most, {rmse:.3} rms"));
    report::line(&format!("{} ({}), {}, {}: {all} instructions{error}", m.board.board_name(), m.cpu, m.scene, m.shader))?;
    m.budget.zip(m.choices).iter().try_for_each(report::choices)?;
    let s = m.by_stage;
    let stages = [s.frame, s.vertex, s.cull, s.setup, s.span, s.pixel, s.edges, s.output, s.clear, s.transfer].map(report::grouped);
    let [frame, vertex, cull, setup, span, pixel, edges, output, clear, transfer] = stages;
    let edges = if s.edges > 0 { format!(", edges {edges}") } else { String::new() };
    let output = if s.output > 0 { format!(", output {output}") } else { String::new() };
    report::line(&format!(
        "  frame {frame}, vertex {vertex}, cull {cull}, set-up {setup}, span {span}, pixel {pixel}{edges}{output}; clear {clear}, transfer {transfer}"
    ))?;
    let rates = format!(
        "{:.2} per pixel, {:.1} of them in the inner loop; set-up {:.0} per triangle, {:.1} per span",
        m.instr_per_pixel,
        per(s.pixel, m.pixels),
        per(s.setup, m.triangles),
        per(s.span, m.spans)
    );
    report::line(&format!("  {pixels} pixels, {} triangles, {spans} spans: {rates}", report::grouped(m.triangles)))?;
    if let (Some(ram), Some(flash), Some(own), Some(whole)) = (m.ram_bytes, m.flash_bytes, m.flash_own_bytes, m.firmware_bytes) {
        let [ram, flash, own, whole] = [ram, flash, own, whole].map(report::grouped);
        report::line(&format!("  {ram} bytes of RAM, {flash} ({own}) of flash, {whole} with all methods"))?;
    }
    if let (Some(cycles), Some(t), Some(clock)) = (m.cycles, m.timing, m.board.clock()) {
        let Timing { frame_cycles, render_cycles, wire_cycles, idle_cycles, frames_per_second } = t;
        let [frame, render, wire, idle] = [frame_cycles, render_cycles, wire_cycles, idle_cycles].map(|cycles| cycles as f64 / clock * 1e3);
        report::line(&format!(
            "  about {} cycles; frame {frame:.2} ms, render {render:.2}, wire {wire:.2}, idle {idle:.2}: {frames_per_second} frames/s",
            report::grouped(cycles)
        ))?;
    }
    Ok(())
}
