//! Whole programs take no more flash, RAM and stack than recorded, and what chips have room for is what the guide says.

use crate::golden::root;
use embedded_graphics::geometry::Size;
use microphong::Layout;
use microphong_sim::{
    bench::size::{baseline, picture},
    chip::{Chip, Core},
    program::{self, Entry, FORMATS, Features, Program, SHADERS},
    render::{self, Format},
    shader::Shader,
};
use std::{fs, process::Command};

/// Each processor and method once; `microphong size --check` measures all programs.
const MEASURED: [(Core, Features, Format, Shader); 5] = [
    (Core::CortexM0Plus, Features::None, Format::Binary, Shader::GOURAUD),
    (Core::CortexM3, Features::None, Format::Rgb565, Shader::PHONG),
    (Core::CortexM4F, Features::Default, Format::Rgb565, Shader::AUTO),
    (Core::CortexM33, Features::Default, Format::Rgb565, Shader::GOURAUD),
    (Core::RiscV, Features::None, Format::Rgb565, Shader::AUTO_LINEAR),
];
/// Flash of half a vertex and a triangle: a closed mesh has half as many vertices as triangles.
const FLASH: u64 = 12 / 2 + 30;

fn recorded() -> Vec<Entry> {
    baseline::read(&root().join("baselines/sizes.csv")).expect("sizes")
}

fn of(recorded: &[Entry], core: Core, features: Features, format: Format, shader: Shader) -> Entry {
    let program = Program { core, features, shader, format };
    *recorded.iter().find(|entry| entry.program == program).unwrap_or_else(|| panic!("no line of {program:?}"))
}

#[test]
fn sizes_have_not_grown() {
    let all = recorded();
    assert_eq!(all.iter().map(|entry| entry.program).collect::<Vec<_>>(), Program::all(&Core::ALL, &Features::ALL, &SHADERS, &FORMATS));
    let recorded = MEASURED.map(|(core, features, format, shader)| of(&all, core, features, format, shader));
    let measured = baseline::again(&recorded, &|| ()).unwrap();
    let changes: Vec<_> = measured.iter().zip(&recorded).flat_map(|(is, was)| baseline::changes(is, was)).collect();
    changes.iter().for_each(|(text, _)| println!("{text}"));
    let grown: Vec<_> = changes.iter().filter(|(_, grown)| *grown).collect();
    let renew = "cargo run --release --features boards -- size --renew tests/baselines/sizes.csv --reason \"...\"";
    assert!(grown.is_empty(), "{grown:#?}\nif this is intended, renew the file: {renew}");
    assert!(all.iter().all(|entry| entry.flash > 30_000 && entry.ram > 10_000 && entry.stack > 3_000));
}

/// Kilobytes of each method and format on each processor, and the deepest stack.
fn programs(recorded: &[Entry], features: Features) -> Vec<String> {
    let rows = SHADERS.into_iter().flat_map(|shader| FORMATS.map(|format| (shader, format)));
    let row = |(shader, format): (Shader, Format)| {
        let entries = Core::ALL.map(|core| of(recorded, core, features, format, shader));
        let flash = entries.map(|entry| (entry.flash as f64 / 1000.0).round().to_string()).join(" | ");
        let stack = entries.iter().map(|entry| entry.stack).max().unwrap_or(0) as f64 / 1000.0;
        let name = if format == Format::Binary { "BinaryColor" } else { "Rgb565" };
        format!("| `{}` | `{name}` | {flash} | {stack:.1} |", shader.name())
    };
    rows.map(row).collect()
}

/// Triangles, in hundreds, for which chips have flash and RAM. The number that cross the border of a band grows with the square root of all.
fn chips(recorded: &[Entry]) -> Vec<String> {
    let teapot = microphong_sim::scene::load(baseline::SCENE).expect("a scene");
    let stream = teapot.stream.parse().expect("a stream");
    let row = |chip: &Chip| {
        let columns = [(Format::Binary, Shader::GOURAUD), (Format::Rgb565, Shader::GOURAUD), (Format::Rgb565, Shader::AUTO_LINEAR)];
        let columns = columns.into_iter().chain([(Format::Rgb565, Shader::PHONG), (Format::Rgb565, Shader::AUTO)]);
        let cells: Vec<_> = columns
            .map(|(format, shader)| {
                let entry = of(recorded, chip.core, Features::None, format, shader);
                let (width, height, rows) = picture(format);
                let layout = render::program_layout(&stream, shader, Size::new(width, height), rows as u32).expect("a layout");
                let bytes = |layout: &Layout| format.bytes(layout)[0] as u64;
                let fits = |&hundreds: &u64| {
                    let triangles = hundreds as usize * 100;
                    let active = layout.active_triangles as f64 * (triangles as f64 / layout.triangles as f64).sqrt();
                    let room = layout.vertices(triangles / 2).triangles(triangles).active_triangles(active as usize);
                    let ram = entry.ram - bytes(&layout) + bytes(&room) + entry.stack;
                    chip.load(entry.flash + FLASH * hundreds * 100, ram) <= 1.0
                };
                (1..).take_while(fits).last().map_or("no".to_owned(), |hundreds| (hundreds * 100).to_string())
            })
            .collect();
        let [flash, ram] = [chip.flash_bytes, chip.ram_bytes].map(|bytes| bytes >> 10);
        format!("| `{}` | {} | {flash}, {ram} | {} |", chip.name, chip.core.title(), cells.join(" | "))
    };
    Chip::ALL.iter().map(row).collect()
}

#[test]
fn the_guide_says_what_programs_take_and_what_fits() {
    let recorded = recorded();
    let guide = fs::read_to_string(root().join("../docs/guide/size.md")).expect("the guide");
    for rows in [programs(&recorded, Features::None), programs(&recorded, Features::Default), chips(&recorded)] {
        let rows = rows.join("\n");
        assert!(guide.contains(&rows), "docs/guide/size.md should have these rows:\n{rows}");
    }
}

/// Figures for a mesh are figures of the teapot's program, with the mesh's bytes and memory instead of the teapot's.
#[test]
fn the_mesh_counts() {
    let arguments = ["size", "sphere-40", "--chip", "stm32f103,samd21", "--shader", "gouraud", "--json"];
    let output = Command::new(microphong_tests::program()).args(arguments).output().expect("the program");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let lines: Vec<serde_json::Value> =
        String::from_utf8_lossy(&output.stdout).lines().map(|line| serde_json::from_str(line).expect("JSON")).collect();
    let [m3, m0] = [("stm32f103", Core::CortexM3), ("samd21", Core::CortexM0Plus)];
    // The smaller chip has too little flash for 16 bits.
    let expected = [(m3, Format::Rgb565, false), (m3, Format::Binary, true), (m0, Format::Rgb565, true), (m0, Format::Binary, true)];
    assert_eq!(lines.len(), expected.len());
    let recorded = recorded();
    for (line, ((chip, core), format, fits)) in lines.iter().zip(expected) {
        assert_eq!((line["chip"].as_str(), line["format"].as_str()), (Some(chip), Some(format.name())));
        let teapot = of(&recorded, core, Features::Default, format, Shader::GOURAUD);
        let figure = |name: &str| line[name].as_u64().expect("a figure");
        let stream = microphong_sim::scene::load("sphere-40").expect("a scene").stream;
        assert_eq!(figure("mesh_bytes"), stream.as_bytes().len() as u64);
        assert!(figure("flash_bytes").abs_diff(teapot.flash) * 500 <= teapot.flash, "{line}");
        assert!(figure("ram_bytes") < teapot.ram - 20_000 && figure("stack_bytes") > 1000, "{line}");
        assert_eq!(line["fits"].as_bool(), Some(fits), "{line}");
    }
    // Of the bunny, which has 3,674 triangles, the other chip has too little RAM.
    let arguments = ["size", "bunny", "--chip", "samd21", "--shader", "gouraud", "--json"];
    let output = Command::new(microphong_tests::program()).args(arguments).output().expect("the program");
    let said = String::from_utf8_lossy(&output.stdout);
    assert_eq!(said.matches("\"fits\":false").count(), 2, "{said}");
}

#[test]
fn damaged_lines_say_what_is_wrong() {
    for (line, message) in [
        ("", "it has no line"),
        ("cortex-m3,none,binary,gouraud,1", "5 words"),
        ("cortex-m3,none,binary,gouraud,1,x,1", "`x` is no number"),
        ("m3,none,binary,gouraud,1,1,1", "no processor m3"),
        ("cortex-m3,some,binary,gouraud,1,1,1", "no features some"),
        ("cortex-m3,none,gray4,gouraud,1,1,1", "no pixel format gray4"),
        ("cortex-m3,none,binary,flat,1,1,1", "no method flat"),
    ] {
        let error = format!("{:#}", Entry::all(line).unwrap_err());
        assert!(error.contains(message), "{error}");
    }
}

/// Larger programs and meshes have room on fewer chips, and a format or method without a program counts as a larger one.
#[test]
fn chips_take_what_they_have_room_for() {
    let fits = |features, shader, format, bytes| -> Vec<_> {
        program::loads(features, shader, format, bytes)
            .unwrap()
            .into_iter()
            .filter(|(_, load)| *load <= 1.0)
            .map(|(chip, _)| chip.name)
            .collect()
    };
    let names = |shader, format, bytes| fits(Features::Default, shader, format, bytes);
    assert_eq!(names(Shader::GOURAUD, Format::Binary, [1000, 20_000]).first(), Some(&"samd21"));
    assert_eq!(names(Shader::GOURAUD, Format::Binary, [210_000, 20_000]).first(), Some(&"stm32f411"));
    assert_eq!(names(Shader::GOURAUD, Format::Binary, [1000, 300_000]), ["rp2350", "esp32-c3"]);
    assert_eq!(names(Shader::GOURAUD, Format::Binary, [1000, 600_000]), [""; 0]);
    let first = |features| fits(features, Shader::GOURAUD, Format::Binary, [15_000, 12_000])[0];
    assert_eq!(Features::ALL.map(first), ["samd21", "stm32f103"], "features take flash");
    let [flash, ram] = [300_000, 20_000];
    assert_eq!(names(Shader::FLAT, Format::Gray4, [flash, ram]), names(Shader::AUTO, Format::Rgb565, [flash, ram]));
}
