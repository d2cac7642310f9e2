//! The counts of `bench` are exact, repeat, and have not grown since they were recorded.

use microphong_sim::{
    bench::{
        Bench, Processor,
        baseline::{self, Entry},
        board_styles::{BoardStyle, PLAIN, Program, STYLES},
        callgrind::Counters,
        renewal::Growth,
        stage::Meter,
        styles,
        styles::RedrawCost,
    },
    board::{Blocks, Board, elf::Elf, trace},
    scene,
    shader::Shader,
    verify,
};
use microphong_tests::{named, program};
use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
    process::Command,
};

/// QEMU logs blocks of instructions; one by one it executes the same, address by address. Each of its programs has a log of its own kind.
#[test]
fn blocks_are_the_instructions_in_them() {
    for processor in [Processor::CortexM3, Processor::RiscV] {
        compare_blocks(processor.board().unwrap());
    }
}

fn compare_blocks(board: Board) {
    let scene = scene::load("sphere-168").unwrap();
    let elf = Elf::read(&verify::build(board, false).unwrap()).unwrap();
    let elf = elf.with_stream(&verify::prepare(scene.stream.as_bytes(), named("duff"), 1).unwrap()).unwrap();
    let ranges = Meter::new(&elf).unwrap().ranges();
    let executed = [Blocks::Whole, Blocks::Single].map(|blocks| {
        let mut counts = BTreeMap::<u32, u64>::new();
        let mut sequence = 0_u64;
        let mut visit = |address| {
            *counts.entry(address).or_default() += 1;
            // The order matters as well.
            sequence = sequence.rotate_left(5).wrapping_mul(0x517C_C1B7_2722_0A95) ^ u64::from(address);
        };
        trace(board, &elf, &ranges, blocks, &mut visit).unwrap();
        (counts, sequence)
    });
    let [(blocks, _), _] = &executed;
    println!("{board}: {} instructions at {} addresses", blocks.values().sum::<u64>(), blocks.len());
    assert!(blocks.values().sum::<u64>() > 1_000_000);
    assert!(executed[0] == executed[1], "{board}: blocks and single instructions differ");
}

/// Each style is counted as itself, in the order of their names. Flat shading costs the same in perspective, but for the question. Smooth outlines take
/// less than three plain frames, and linear light in perspective, on triangles as large as these, takes more. What cannot be drawn has no count.
#[test]
fn styles_are_told_apart() {
    let shaders = [Shader::FLAT, Shader::GOURAUD, named("gouraud4")];
    let costs = styles::measure(&Counters::default(), &scene::load("dodecahedron").unwrap(), &shaders, styles::styles, &|| ()).unwrap();
    let [flat, gouraud, split]: [[Option<u64>; 4]; 3] = [0, 1, 2].map(|k: usize| costs[k].instructions.as_slice().try_into().unwrap());
    println!("{:?}: {flat:?}, {gouraud:?}, {split:?}", costs[0].styles);
    let [plain, smooth, lines, perspective] = gouraud;
    assert!(flat[0].unwrap().abs_diff(flat[3].unwrap()) < 100);
    assert!(flat[1] > flat[0] && smooth > plain, "antialiasing");
    assert!(lines > plain && lines != smooth && lines < plain.map(|plain| 3 * plain), "outlines");
    assert!(perspective > smooth && smooth < plain.map(|plain| 3 * plain) && split[3].is_none());
}

/// A ball stands still, and a small box beside it moves.
const BALL_AND_BOX: &str = "
frames = 3

[camera]
at = [0, 0, 4]
looks-at = [0, 0, 0]
view = 45
near = 2

[[light]]
towards = [0, 0, 1]

[[mesh]]
name = 'ball'
shape = 'sphere'

[[mesh]]
name = 'box'
shape = 'box'

[[object]]
mesh = 'ball'

[[object]]
mesh = 'box'
keys = [{ frame = 0, at = [-1.3, 1, 0], scale = 0.1 }, { frame = 2, at = [-1.2, 1, 0], scale = 0.1 }]
";

/// In scenes where little moves, little is drawn again. A scene that does not move is refused.
#[test]
fn what_has_changed_is_counted_alone() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    let load = |text: &str| {
        fs::write(&path, text).unwrap();
        scene::load(path.to_str().unwrap()).unwrap()
    };
    let redraw = |scene| styles::redraw(&Counters::default(), &scene, &[Shader::GOURAUD], &|| ());
    let costs = redraw(load(BALL_AND_BOX)).unwrap();
    println!("{costs:?}");
    let [RedrawCost { frames: 2, whole, with_hidden_objects, redrawn, .. }] = costs[..] else { panic!("{costs:?}") };
    assert!(redrawn * 5 < whole && redrawn > 10_000 && with_hidden_objects.abs_diff(whole) * 50 < whole);
    let still =
        redraw(load(&BALL_AND_BOX.replace("frames = 3", "frames = 1").replace(", { frame = 2, at = [-1.2, 1, 0], scale = 0.1 }", "")));
    assert!(still.unwrap_err().to_string().contains("one frame"));
}

/// Two runs, each side by side with others, give the same to the instruction and cycle.
#[test]
fn counts_repeat() {
    let processors = Processor::ALL;
    let bench = Bench::new(&processors).unwrap();
    let scene = scene::load("sphere-168").unwrap();
    let wanted: Vec<_> =
        processors.iter().flat_map(|&processor| [Shader::GOURAUD, Shader::RENQ].map(|shader| (processor, shader))).collect();
    let [first, second] = [(); 2].map(|()| bench.measure(&scene, &wanted, &|| ()).unwrap());
    assert_eq!(first, second);
    for found in first {
        let line = serde_json::to_string(&found).unwrap();
        println!("{line}");
        let stages = found.by_stage;
        // The host has no display.
        let sends = found.board != Processor::X86_64;
        assert!(found.instructions == stages.drawing() && stages.clear > 0 && (stages.transfer > 0) == sends);
        assert!(found.max_lsb > Some(0.0) && found.rmse_lsb < found.max_lsb && found.flash_own_bytes <= found.flash_bytes);
        assert_eq!(found.cycles.is_some(), found.board.clock().is_some());
        // Bytes go over the wire in every frame, at 62.5 million bits in a second: all that is drawn, but not rows that are background and were so
        // before.
        let sent = |pixels: u64| (found.board.clock().unwrap_or_default() / 62.5e6 * 16.0 * pixels as f64) as u64;
        let sent = sent(found.pixels)..sent(240 * 240);
        assert!(found.timing.is_none_or(|time| sent.contains(&time.wire_cycles) && time.frame_cycles > time.wire_cycles));
    }
}

/// Smooth outlines on a Cortex-M3 take no more instructions over the plain frame than the guide says.
#[test]
fn smooth_outlines_cost_what_the_guide_says() {
    let guide = include_str!("../../docs/guide/costs.md");
    let processor = Processor::CortexM3;
    let (plain, smooth) = (Bench::new(&[processor]).unwrap(), Bench::antialiased(&[processor]).unwrap());
    for name in ["teapot", "torus", "bunny"] {
        let scene = scene::load(name).unwrap();
        let [before, after] =
            [&plain, &smooth].map(|bench| bench.count(&scene, &[(processor, Shader::GOURAUD)], &|| ()).unwrap()[0].instructions);
        let more = (after - before) as f64 / 1e3;
        println!("{name}: {before} + {more:.0} k, {:.3} times", after as f64 / before as f64);
        let row = guide.lines().find(|line| line.starts_with(&format!("| `{name}` | + "))).expect("a row");
        let stated: f64 = row.split(['+', 'k']).nth(1).and_then(|figure| figure.trim().parse().ok()).expect("a figure");
        assert!((more - stated).abs() <= 0.01 * stated, "{name}: {more:.1} thousand, and the guide says {stated}");
    }
    assert!(Bench::antialiased(&[Processor::X86_64]).unwrap_err().to_string().contains("--styles"));
}

/// Frames a second of the Pico are those of the guide, and both of its processors draw the largest meshes that it has room for.
#[test]
fn frames_of_the_pico_are_those_of_the_guide() {
    let guide = include_str!("../../docs/guide/costs.md");
    let processor = Processor::CortexM0Plus;
    let bench = Bench::new(&[processor]).unwrap();
    for name in ["teapot", "torus", "bunny"] {
        let scene = scene::load(name).unwrap();
        let timing = bench.count(&scene, &[(processor, Shader::GOURAUD)], &|| ()).unwrap()[0].timing.expect("a time");
        println!("{name}: {timing:?}");
        let row = guide.lines().find(|line| line.starts_with(&format!("| `{name}`, ")) && line.contains(" triangles |")).expect("a row");
        let stated: f64 = row.split('|').nth(3).and_then(|cell| cell.trim().parse().ok()).expect("a figure");
        assert!((timing.frames_per_second / stated - 1.0).abs() < 0.04, "{name}: {timing:?}, and the guide says {stated}");
        assert!(timing.frame_cycles * 10 < timing.render_cycles * 7, "{name} is drawn by one processor: {timing:?}");
    }
}

/// A file of recorded costs.
fn recorded(file: &str) -> (PathBuf, Vec<Entry>) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("baselines").join(file);
    let entries = baseline::read(&path).unwrap();
    (path, entries)
}

/// Measures the `recorded` frames of `file` again. None may cost more, but for the tolerance.
fn measured_again(file: &str, recorded: &[Entry]) -> Vec<Entry> {
    let measured = baseline::measure(recorded, &|| ()).unwrap();
    let changes = baseline::changes(recorded, &measured);
    let (grown, shrunk): (Vec<_>, Vec<_>) = changes.iter().partition(|change| change.percent() > 0.0);
    let renew = format!("renew the file: cargo run --release --features boards -- bench --renew tests/baselines/{file} --reason \"...\"");
    for change in shrunk.iter().chain(&grown) {
        println!("{change}");
    }
    if !shrunk.is_empty() {
        println!("{} costs have shrunk, which would hide later growth: {renew}", shrunk.len());
    }
    let list: Vec<_> = grown.iter().map(|change| change.to_string()).collect();
    assert!(grown.is_empty(), "{} costs have grown:\n{}\nif this is intended, {renew}", grown.len(), list.join("\n"));
    measured
}

/// No frame costs more than recorded, but for the tolerance.
#[test]
fn costs_have_not_grown() {
    let (path, recorded) = recorded("costs.csv");
    let measured = measured_again("costs.csv", &recorded);
    let growth = Growth::of(&path, &measured).unwrap().expect("the costs of a release lie beside the recorded ones");
    assert!(growth.frames > 50, "only {} frames of the release are still measured", growth.frames);
    println!("{growth}");
}

/// No style costs more than recorded. These are the styles of programs that other tests need as well: most on one board, and some on the others.
/// `bench --check` measures all.
#[test]
fn styles_have_not_grown() {
    let (_, all) = recorded("styles.csv");
    let chosen = |entry: &&Entry| {
        entry.scene == "teapot"
            && [Shader::GOURAUD, Shader::PHONG].contains(&entry.shader)
            && match entry.processor {
                Processor::CortexM3 => [Program::PLAIN, Program::ANTIALIAS].contains(&entry.style.program),
                _ => entry.style.program == Program::PLAIN && entry.shader == Shader::PHONG,
            }
    };
    let few: Vec<_> = all.iter().filter(chosen).cloned().collect();
    let count = |processor| few.iter().filter(|entry| entry.processor == processor).count();
    assert_eq!([Processor::CortexM3, Processor::CortexM4F].map(count), [22, 4]);
    measured_again("styles.csv", &few);
    // Every style is recorded, and each takes other instructions than the plain one, but for formats whose kernels differ only in numbers that assembler has.
    for style in &STYLES {
        let of = |style: &BoardStyle| {
            let of_scene = |entry: &&Entry| (entry.processor, entry.scene.as_str()) == (Processor::CortexM3, "peer-sphere-plastic");
            let frame = |entry: &&Entry| of_scene(entry) && entry.shader == Shader::PHONG && entry.style == style;
            all.iter().find(frame).unwrap_or_else(|| panic!("no costs of {}", style.name)).instructions
        };
        let is_alike = ["plain", "bgr565", "rgb666"].contains(&style.name);
        assert!((of(style).abs_diff(of(PLAIN)) < of(PLAIN) / 10_000) == is_alike, "{}: {}", style.name, of(style));
    }
}

/// A table for each scene has a row for each style, and JSON names the board.
#[test]
fn styles_are_a_table() {
    let run = |arguments: &[&str]| {
        let output =
            Command::new(program()).args(["bench", "triangle", "--styles", "--shader", "flat,gouraud4"]).args(arguments).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    };
    let table = run(&[]);
    let lines: Vec<_> = table.lines().collect();
    assert_eq!(lines.len(), 7, "{table}");
    assert!(lines[0].starts_with("x86-64, triangle: instructions per pixel") && lines[1].trim() == "flat         gouraud4", "{table}");
    assert!(lines[2].starts_with("  plain ") && lines[2].ends_with(" 1.00") && lines[5].starts_with("  perspective-correct "), "{table}");
    assert!(lines[5].ends_with(" -") && lines[6].starts_with("  left out: perspective-correct, gouraud4: "), "{table}");
    let json = run(&["--board", "x86-64", "--json"]);
    assert!(
        json.lines().count() == 2 && json.lines().all(|line| line.starts_with("{\"board\":\"x86-64\",\"scene\":\"triangle\"")),
        "{json}"
    );
}

/// Renewed costs are the measured ones, with the reason beside them. Unchanged costs need no reason.
#[test]
fn renewal_keeps_the_reason() {
    let directory = tempfile::tempdir().unwrap();
    let [costs, release, reasons] = ["costs.csv", "costs-0.1.0.csv", "costs-reasons.md"].map(|name| directory.path().join(name));
    fs::write(&costs, "mps2-an385,triangle,flat,1000,0\n").unwrap();
    fs::copy(&costs, &release).unwrap();
    let run = |arguments: &[&str]| {
        let output = Command::new(program()).arg("bench").args(arguments).current_dir(directory.path()).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    };
    let renewed = run(&["--renew", "costs.csv", "--reason", "Triangles are flat."]);
    assert!(renewed.contains("since 0.1.0, mean of 1 frames: instructions +"), "{renewed}");
    let text = fs::read_to_string(&reasons).unwrap();
    assert!(text.ends_with(" | +0.00 | Triangles are flat. |\n"), "{text}");
    let [recorded] = &baseline::read(&costs).unwrap()[..] else { panic!("one frame") };
    assert!(recorded.instructions > 1000 && recorded.flash_bytes > 1000, "{recorded}");

    assert!(run(&["--renew", "costs.csv", "--reason", "None."]).contains("nothing to renew"));
    assert_eq!(fs::read_to_string(&reasons).unwrap(), text);
    assert!(run(&["--check", "costs.csv"]).starts_with("the costs of 1 frames are as recorded\nsince 0.1.0"));
}
