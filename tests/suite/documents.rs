//! Links in the documents lead to files and headings that are there, the index names each page, and the README is short. Costs of methods agree
//! with the recorded ones, sizes in the guide agree with the layout, and doc comments begin with a subject.

use crate::golden::{bless, root};
use embedded_graphics::pixelcolor::{Gray8, Rgb565};
use microphong::{Layout, pixel::Pixel};
use microphong_sim::board::Board;
use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
};

const DOCUMENTS: [&str; 9] = [
    "README.md",
    "CHANGELOG.md",
    "CONTRIBUTING.md",
    "docs/README.md",
    "docs/design.md",
    "docs/proofs.md",
    "examples/README.md",
    "tests/meshes/README.md",
    "tests/scenes/README.md",
];

/// Bytes that a first look may take.
const README: usize = 15_000;

fn repository() -> PathBuf {
    root().join("..")
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// All pages of the guide.
fn pages() -> Vec<String> {
    let files = fs::read_dir(repository().join("docs/guide")).expect("the guide");
    files.map(|file| format!("docs/guide/{}", file.expect("a file").file_name().to_string_lossy())).collect()
}

/// The targets of its links.
fn links(text: &str) -> impl Iterator<Item = &str> {
    text.split("](").skip(1).filter_map(|rest| rest.split_once(')')).map(|(target, _)| target)
}

/// The names by which links know the headings of a document.
fn anchors(text: &str) -> Vec<String> {
    let mut fenced = false;
    let headings = text.lines().filter(|line| {
        fenced ^= line.trim_start().starts_with("```");
        !fenced && line.starts_with('#')
    });
    let kept = |c: char| c.is_alphanumeric() || "-_ ".contains(c);
    headings.map(|line| line.trim_start_matches('#').trim().to_lowercase().replace(|c: char| !kept(c), "").replace(' ', "-")).collect()
}

#[test]
fn links_lead_to_files_and_headings() {
    let (mut count, mut broken) = (0, Vec::new());
    for document in DOCUMENTS.map(String::from).into_iter().chain(pages()) {
        let path = repository().join(&document);
        let text = read(&path);
        for target in links(&text).filter(|target| !target.contains("://")) {
            count += 1;
            let (file, heading) = target.split_once('#').unwrap_or((target, ""));
            let file = if file.is_empty() { path.clone() } else { path.parent().expect("a folder").join(file) };
            if !file.exists() || !heading.is_empty() && !anchors(&read(&file)).iter().any(|anchor| anchor == heading) {
                broken.push(format!("{document}: {target}"));
            }
        }
    }
    assert!(count > 100, "{count} links");
    assert!(broken.is_empty(), "{broken:#?}");
}

#[test]
fn the_index_names_each_page() {
    let index = read(&repository().join("docs/README.md"));
    let missing: Vec<_> = pages().into_iter().filter(|page| !links(&index).any(|target| page.ends_with(target))).collect();
    assert!(missing.is_empty(), "{missing:?}");
}

#[test]
fn the_readme_is_short() {
    let length = read(&repository().join("README.md")).len();
    assert!(length <= README, "{length} bytes; move something to the guide");
}

/// Beginnings of doc comments that cannot be understood without another comment.
const DANGLING: [&str; 7] = ["That ", "Those ", "The same ", "Of ", "As ", "It ", "They "];

/// The Rust sources below a folder.
fn sources(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let paths = entries.map(|entry| entry.expect("an entry").path()).filter(|path| !path.ends_with("target"));
    paths
        .flat_map(|path| if path.is_dir() { sources(&path) } else { vec![path] })
        .filter(|path| path.extension() == Some("rs".as_ref()))
        .collect()
}

/// The first lines of all doc comments, with their numbers.
fn first_lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    fn is_comment(line: &str) -> bool {
        ["///", "//!"].iter().any(|start| line.trim_start().starts_with(start))
    }
    let mut before = false;
    let first = (1..).zip(text.lines()).filter(move |(_, line)| !std::mem::replace(&mut before, is_comment(line)) && is_comment(line));
    first.map(|(number, line)| (number, line.trim_start()[3..].trim_start()))
}

#[test]
fn doc_comments_begin_with_a_subject() {
    let (mut count, mut dangling) = (0, Vec::new());
    for path in
        ["shared", "firmware", "host-sim", "tests", "examples", "fuzz", "web"].iter().flat_map(|folder| sources(&repository().join(folder)))
    {
        for (number, line) in first_lines(&read(&path)) {
            count += 1;
            if DANGLING.iter().any(|beginning| line.starts_with(beginning)) {
                dangling.push(format!("{}:{number}: {line}", path.display()));
            }
        }
    }
    assert!(count > 3000, "{count} comments");
    assert!(dangling.is_empty(), "{dangling:#?}");
}

/// The table of docs/guide/size.md.
#[test]
fn memory_is_what_the_guide_says() {
    let guide = read(&repository().join("docs/guide/size.md"));
    let told = |part: &str| {
        let row = guide.lines().find_map(|line| line.strip_prefix(&format!("| {part}"))).unwrap_or_else(|| panic!("no row of {part}"));
        let figure = row.trim_end_matches([' ', '|']).rsplit('|').next().unwrap_or_default();
        figure.trim().replace(',', "").parse::<usize>().unwrap_or_else(|error| panic!("{part}: {figure}: {error}"))
    };
    let layout = Layout::new(320, 16).vertices(800).triangles(992).materials(2).objects(3).active_triangles(48);
    let common = 800 * told("vertex")
        + 992 * told("triangle |")
        + 48 * told("triangle across")
        + 3 * told("object")
        + 320 * 16 * told("pixel of a band");
    // Each part begins at a multiple of a word.
    fn has<C: Pixel>(layout: &Layout, told: usize) {
        let bytes = layout.bytes::<C>();
        assert!(bytes.abs_diff(told) < 64, "{bytes} bytes, the guide says {told}");
    }
    has::<Rgb565>(&layout, common + 2 * told("material in `Rgb565`"));
    has::<Gray8>(&layout, common + 2 * told("material in `Gray8`"));
}

/// Instructions and flash of each method in the README and the guide, as `tests/baselines/costs.csv` has them. The README tells whole
/// programs: what the method adds to the program without one, which is the recorded program by `gouraud` without that method.
#[test]
fn costs_are_those_that_are_recorded() {
    /// Pixels of the scene, at 320x240 on the MPS2 and at 240x240 on the Pico. The sphere is equally large in both.
    const PIXELS: f64 = 43_813.0;
    let recorded = read(&root().join("baselines/costs.csv"));
    let cost = |board: &str, method: &str| {
        let start = format!("{board},peer-sphere-plastic,{method},");
        let row = recorded.lines().find_map(|line| line.strip_prefix(&start)).unwrap_or_else(|| panic!("no costs {start}"));
        let (instructions, flash) = row.split_once(',').expect("two figures");
        [instructions, flash].map(|figure| figure.parse::<f64>().expect("a figure"))
    };
    let sizes = read(&root().join("baselines/sizes.csv"));
    let gouraud = sizes.lines().find_map(|line| line.strip_prefix("cortex-m3,default,rgb565,gouraud,")).expect("its size");
    let whole = gouraud.split(',').next().expect("flash").parse::<f64>().expect("a figure");
    let base = (whole - cost("mps2-an385", "gouraud")[1]) / 1000.0;
    for (document, before, base, methods) in [("README.md", 4, base, 7), ("docs/guide/methods.md", 5, 0.0, 7)] {
        let text = read(&repository().join(document));
        let mut found = 0;
        for method in ["flat", "gouraud", "six-point", "sqrt6", "phong", "auto", "auto-linear"] {
            let Some(row) = text.lines().find(|line| line.starts_with(&format!("| `{method}` |"))) else { continue };
            found += 1;
            let cells: Vec<_> =
                row.split('|').skip(before).flat_map(|cell| cell.split(',')).map(|cell| cell.trim().trim_end_matches(" KB")).collect();
            let [m3, m0, flash] = [0, 1, 2].map(|index| cells[index].parse::<f64>().expect("a figure"));
            let ([on_m3, bytes], [on_m0, _]) = (cost("mps2-an385", method), cost("pico", method));
            let close = |told: f64, instructions: f64| (told * PIXELS / instructions - 1.0).abs() < 0.01;
            assert!(close(m3, on_m3) && close(m0, on_m0), "{document}: {method}: {:.1}, {:.1}", on_m3 / PIXELS, on_m0 / PIXELS);
            let expected = base + bytes / 1000.0;
            assert!((flash - expected).abs() < if base > 0.0 { 1.0 } else { 0.6 }, "{document}: {method}: {expected:.1} KB of flash");
        }
        assert_eq!(found, methods, "{document}: methods");
    }
}

/// The README and the guide have a row for each board. Costs in it are those of `tests/baselines/costs.csv`: of the teapot in thousands of instructions,
/// and of `peer-sphere-plastic` in instructions per pixel.
#[test]
fn boards_are_those_that_there_are() {
    /// Pixels of `peer-sphere-plastic` on each board.
    const PIXELS: f64 = 43_813.0;
    let recorded = read(&root().join("baselines/costs.csv"));
    let cost = |board: Board, scene: &str, method: &str| {
        let start = format!("{board},{scene},{method},");
        let row = recorded.lines().find_map(|line| line.strip_prefix(&start))?;
        Some(row.split(',').next().expect("instructions").parse::<f64>().expect("a figure"))
    };
    let teapot: &[_] = &["gouraud", "auto", "phong"];
    let sphere: &[_] = &["flat", "gouraud", "six-point", "sqrt6", "phong"];
    // The cell with the figures, or the first of them; what they are of, and what they count.
    let tables = [
        ("README.md", "## Boards", 4, "teapot", teapot, 1000.0),
        ("docs/guide/boards.md", "# Boards", 0, "", &[], 1.0),
        ("docs/guide/boards.md", "## Costs", 3, "peer-sphere-plastic", sphere, PIXELS),
    ];
    for (document, heading, first, scene, methods, unit) in tables {
        let text = read(&repository().join(document));
        let section = text.lines().skip_while(|&line| line != heading).skip(1).take_while(|line| !line.starts_with("## "));
        let rows: Vec<_> = section.filter(|line| line.starts_with("| `")).collect();
        for board in Board::ALL {
            let recorded: Vec<_> = methods.iter().filter_map(|method| cost(board, scene, method)).collect();
            let is_its = |row: &&&str| row.split('|').nth(1).is_some_and(|names| names.contains(&format!("`{board}`")));
            let Some(row) = rows.iter().find(is_its) else {
                // A table of costs has the boards whose instructions are counted.
                assert!(!methods.is_empty() && recorded.is_empty(), "{document}, {heading}: no row of {board}");
                continue;
            };
            let cells = row.split('|').skip(first).flat_map(|cell| cell.split(','));
            let told: Vec<_> = cells.filter_map(|cell| cell.trim().parse::<f64>().ok()).take(methods.len()).collect();
            assert_eq!(told.len(), recorded.len(), "{document}, {heading}: {row}");
            for (told, recorded) in told.iter().zip(&recorded) {
                assert!(
                    (told * unit / recorded - 1.0).abs() < 0.01,
                    "{document}, {heading}: {board}: {:.2} and not {told}",
                    recorded / unit
                );
            }
        }
    }
}

/// Instructions of styles on boards in the guide, as `tests/baselines/styles.csv` has them: each figure of both is a figure of the other.
#[test]
fn styles_are_those_that_are_recorded() {
    /// Pixels of the scene, on each board.
    const PIXELS: f64 = 43_813.0;
    /// The cells of the head, and those of each row.
    type Table<'a> = (Vec<&'a str>, Vec<Vec<&'a str>>);
    fn cells(line: &str) -> Vec<&str> {
        line.split('|').map(str::trim).collect()
    }
    let (recorded, guide) = (read(&root().join("baselines/styles.csv")), read(&repository().join("docs/guide/costs.md")));
    let lines: Vec<_> = guide.lines().collect();
    // The heads of tables, and the rows below each.
    let tables: Vec<Table<'_>> = (0..lines.len())
        .filter(|&at| lines[at].starts_with("| style |"))
        .map(|at| {
            let rows = lines[at + 2..].iter().take_while(|line| line.starts_with('|'));
            (cells(lines[at]), rows.map(|row| cells(row)).collect())
        })
        .collect();
    let mut found = 0;
    for line in recorded.lines() {
        let [board, "peer-sphere-plastic", method, style, instructions, _] = line.split(',').collect::<Vec<_>>()[..] else { continue };
        let head = match board {
            "mps2-an385" => method.to_owned(),
            "mps2-an386" => format!("{method}, Cortex-M4F"),
            _ => format!("{method}, Cortex-M0+"),
        };
        let cell = |(heads, rows): &Table<'_>| {
            let column = heads.iter().position(|cell| *cell == head)?;
            let row = rows.iter().find(|row| row[1] == format!("`{style}`"))?;
            row[column].parse::<f64>().ok()
        };
        let told = tables.iter().find_map(cell).unwrap_or_else(|| panic!("the guide has no figure of {line}"));
        let expected = instructions.parse::<f64>().expect("a figure") / PIXELS;
        assert!((told / expected - 1.0).abs() < 0.01, "{style}, {head}: {expected:.1} and not {told}");
        found += 1;
    }
    let figures = tables.iter().flat_map(|(_, rows)| rows.iter().flatten()).filter(|cell| cell.parse::<f64>().is_ok()).count();
    assert_eq!((found, tables.len()), (figures, 2));
}

/// The names that a user of the library sees are those of `docs/public-names.txt`. `MICROPHONG_BLESS=1` writes them there; CHANGELOG.md then has to
/// say what has changed.
#[test]
fn public_names_are_those_that_are_listed() {
    let mut cargo = Command::new(env!("CARGO"));
    // tests/run means it for programs of boards, and libraries would be checked anew for it.
    cargo.env_remove("RUSTC_WORKSPACE_WRAPPER");
    let cargo = cargo.args(["doc", "--quiet", "--no-deps", "-p", "microphong"]).current_dir(root()).output().expect("cargo");
    assert!(cargo.status.success(), "{}", String::from_utf8_lossy(&cargo.stderr));
    let all =
        fs::read_to_string(Path::new(env!("CARGO_TARGET_TMPDIR")).with_file_name("doc/microphong/all.html")).expect("an index of names");
    // A heading's link begins with "#".
    let items = all.split("<li><a href=\"").skip(1).filter(|item| !item.starts_with('#'));
    let names: String = items.filter_map(|item| Some(item.split_once('>')?.1.split_once('<')?.0.to_owned() + "\n")).collect();
    let file = root().join("../docs/public-names.txt");
    if bless() {
        fs::write(&file, &names).expect("a folder");
    }
    let listed = fs::read_to_string(&file).unwrap_or_default();
    let only =
        |some: &str, others: &str| some.lines().filter(|name| others.lines().all(|other| other != *name)).collect::<Vec<_>>().join(", ");
    assert!(listed == names, "new: {}; gone: {}", only(&names, &listed), only(&listed, &names));
    println!("{} public names", names.lines().count());
}

/// Decisions about a triangle are made where docs/design.md says, each in one place, and its drawing has them.
#[test]
fn decisions_are_made_where_the_design_says() {
    let repository = repository();
    let design = read(&repository.join("docs/design.md"));
    let (table, drawing): (Vec<&str>, Vec<&str>) = design.lines().partition(|line| line.starts_with('|'));
    // `(number) name` of a row of the table, and the row.
    let row = |line: &&'_ str| {
        let (name, _) = line.strip_prefix("| ")?.split_once(" |")?;
        let (number, _) = name.strip_prefix('(')?.split_once(')')?;
        number.parse::<u8>().ok().map(|_| (name.to_owned(), (*line).to_owned()))
    };
    let told: Vec<_> = table.iter().filter_map(row).collect();
    let mut made = Vec::new();
    for path in sources(&repository.join("shared/src")) {
        let marks = read(&path);
        let marks = marks.lines().filter_map(|line| line.trim().strip_prefix("// Decision: ")?.strip_suffix('.'));
        made.extend(marks.map(|name| (name.to_owned(), path.strip_prefix(&repository).expect("a file of the core").to_owned())));
    }
    for (name, row) in &told {
        let (_, bare) = name.split_once(") ").expect("a name behind the number");
        let places: Vec<_> = made.iter().filter(|(made, _)| made == bare).map(|(_, path)| path.to_string_lossy()).collect();
        let [place] = places.as_slice() else { panic!("{bare} is decided in {} places: {places:?}", places.len()) };
        assert!(row.contains(&format!("](../{place})")), "{bare} is decided in {place}, and the table says {row}");
        let drawn = drawing.iter().filter(|line| line.contains(name.as_str())).count();
        assert_eq!(drawn, 1, "{name} in the drawing");
    }
    assert_eq!(made.len(), told.len(), "marks in the code, and rows of the table: {made:?}");
}
