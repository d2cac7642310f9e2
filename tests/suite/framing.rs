//! Whole turns on displays of every shape.

use microphong_sim::{
    bytes::StreamBytes,
    scene::{self, NAMES, SCRIPTED, VARIANTS},
    stress::watertight::covered,
};
use microphong_tests::succeeds;
use rayon::prelude::*;
use std::{fs, path::Path};

const DISPLAYS: [[u32; 2]; 5] = [[240, 240], [320, 240], [128, 64], [135, 240], [80, 160]];
/// Share of the narrower side that a mesh fills at least, in the frame that shows most of it.
const FILLED: f64 = 0.7;

/// Columns and rows between the outermost covered pixels of a frame, these included; `None` if there are none. Panics if one is on the border.
fn extent(counts: &[u8], [width, height]: [u32; 2], place: &str) -> Option<[u32; 2]> {
    let covered = || counts.iter().zip(0u32..).filter(|&(&count, _)| count > 0).map(|(_, pixel)| [pixel % width, pixel / width]);
    let range = |k: usize, side: u32| {
        let (least, most) = (covered().map(|pixel| pixel[k]).min()?, covered().map(|pixel| pixel[k]).max()?);
        assert!(least > 0 && most + 1 < side, "{place}: {least} to {most} of {side} touches the border");
        Some(most - least + 1)
    };
    Some([range(0, width)?, range(1, height)?])
}

/// The least share that a stream fills of any display, in the best frame of its turn.
fn filled(name: &str, bytes: &StreamBytes) -> f64 {
    let stream = bytes.parse().unwrap();
    let shares = DISPLAYS.par_iter().map(|&size| {
        let extents = (0..u32::from(stream.header.frames)).into_par_iter().filter_map(|number| {
            let counts = covered(&stream, size, number).expect("nothing of a mesh that is framed is clipped");
            extent(&counts, size, &format!("{name}, frame {number}, {size:?}"))
        });
        let longest = extents.map(|[columns, rows]| columns.max(rows)).max().unwrap_or(0);
        f64::from(longest) / f64::from(size[0].min(size[1]))
    });
    shares.reduce(|| f64::MAX, f64::min)
}

/// A box of these sides, as a modeller writes it.
fn cuboid([x, y, z]: [f64; 3]) -> String {
    let corners = (0..8).map(|k| [(0, x), (1, y), (2, z)].map(|(bit, side)| if k >> bit & 1 == 1 { side } else { -side }));
    let vertices: String = corners.map(|[x, y, z]| format!("v {x} {y} {z}\n")).collect();
    vertices + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n"
}

#[test]
fn turns_are_seen_whole_on_every_display() {
    let directory = tempfile::tempdir().unwrap();
    let meshes = Path::new(env!("CARGO_MANIFEST_DIR")).join("meshes");
    for name in ["teapot.obj", "bunny.obj"] {
        fs::copy(meshes.join(name), directory.path().join(name)).unwrap();
    }
    for (name, sides) in [
        ("plate.obj", [1.0, 0.03, 0.6]),
        ("upright.obj", [0.6, 1.0, 0.03]),
        ("rod.obj", [0.04, 2.0, 0.04]),
        ("lying.obj", [2.0, 0.04, 0.04]),
    ] {
        fs::write(directory.path().join(name), cuboid(sides)).unwrap();
    }
    let mut streams = Vec::new();
    for name in ["teapot.obj", "bunny.obj", "plate.obj", "upright.obj", "rod.obj", "lying.obj"] {
        for options in [&[][..], &["--projection", "parallel"], &["--elevation", "70"]] {
            let _ = succeeds(directory.path(), &[&["convert", name, "-o", "mesh.tri"], options].concat());
            streams.push((format!("{name} {}", options.join(" ")), StreamBytes::read(&directory.path().join("mesh.tri")).unwrap()));
        }
    }
    // The camera of the peers' sphere is theirs.
    for name in NAMES.into_iter().chain(VARIANTS).filter(|name| !SCRIPTED.contains(name) && !name.starts_with("peer")) {
        streams.push((name.to_owned(), scene::load(name).unwrap().stream));
    }
    for (name, stream) in &streams {
        let share = filled(name, stream);
        println!("{name} fills {:.0} %", 100.0 * share);
        assert!(share >= FILLED, "{name} fills {share}");
    }
}

#[test]
fn a_mesh_that_no_frame_shows_is_said() {
    let directory = tempfile::tempdir().unwrap();
    // A triangle of the horizon, seen from below.
    fs::write(directory.path().join("floor.obj"), "v -1 0 -1\nv 1 0 -1\nv 0 0 1\nf 1 3 2\n").unwrap();
    let text = |options: &[&str]| succeeds(directory.path(), &[&["convert", "floor.obj"], options].concat());
    assert!(!text(&[]).contains("no frame shows a pixel"), "{}", text(&[]));
    assert!(text(&["--flip"]).contains("no frame shows a pixel of the mesh: its faces point away"), "{}", text(&["--flip"]));
}
