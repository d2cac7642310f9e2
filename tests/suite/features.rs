//! With fewer cargo features the core draws the same pictures, or names the feature that is missing.

use crate::{
    golden::root,
    lights::{lit, spotlight},
    vertex_colours::coloured,
};
use microphong::{
    Outlines,
    features::Feature,
    stream::record::{SKY, VIEWER_LOCAL},
};
use microphong_sim::{board::build, bytes::StreamBytes, program, render::Format, scene, stress::records::Records};
use std::{collections::BTreeSet, fs, process::Command};
use tempfile::TempDir;

/// Features of the core, each set compiled for this computer.
const SETS: [&str; 6] = [
    "",
    "colours",
    "antialias,colours,light-shapes,near-lights",
    "animation,colours,lights,objects",
    "colours,vertex-colours",
    "colours,textures,vertex-colours",
];
const ALL: &str = "animation,antialias,colours,light-shapes,lights,near-lights,objects,redraw,text,textures,vertex-colours";

const SCENES: [&str; 8] = ["teapot", "torus", "sphere-40", "peer-sphere-plastic", "peer-sphere-lights", "gauges", "board", "sensor"];

/// Streams of the scenes, one without lights, one that is seen by a local viewer, one in the light of a spotlight, one with lines along outlines,
/// one in the light of the sky, and one with colours at the corners of triangles.
fn streams() -> Vec<(String, StreamBytes)> {
    let mut streams: Vec<_> = SCENES.map(|name| (name.to_owned(), scene::load(name).unwrap().stream)).into();
    let teapot = scene::load("teapot").unwrap().stream;
    let changed = |change: fn(&mut Records)| {
        let mut parts = Records::of(&teapot.parse().unwrap());
        change(&mut parts);
        parts.written().unwrap()
    };
    streams.push(("no-lights".to_owned(), changed(|parts| parts.lights.clear())));
    streams.push(("local-viewer".to_owned(), changed(|parts| parts.header.camera.viewer = VIEWER_LOCAL)));
    streams.push(("spotlight".to_owned(), lit("teapot", &[spotlight()])));
    streams.push(("outlines".to_owned(), teapot.with_outlines(Outlines::new([255; 3])).unwrap()));
    streams.push(("sky".to_owned(), changed(|parts| parts.lights[0].kind = SKY)));
    streams.push((
        "coloured".to_owned(),
        coloured(Records::of(&teapot.parse().unwrap()), &[[200, 90, 30], [20, 220, 250]], |_, corner| (corner % 2) as u8),
    ));
    streams
}

/// The lines of the program with these features.
fn drawn(features: &str, files: &[String]) -> Vec<String> {
    let host = build::host().unwrap();
    let output = Command::new(env!("CARGO"))
        .current_dir(root().join("../firmware"))
        .args(["run", "--quiet", "-p", "features", "--no-default-features", "--features", features, "--target", &host])
        .args(["--target-dir", "../target/features", "--"])
        .args(files)
        // Nobody debugs it, and several units of code would take more of the processor's time than one.
        .envs([("CARGO_PROFILE_DEV_DEBUG", "false"), ("CARGO_PROFILE_DEV_CODEGEN_UNITS", "1"), ("CARGO_INCREMENTAL", "0")])
        .env_remove("RUSTFLAGS")
        .env_remove("CARGO_ENCODED_RUSTFLAGS")
        .output()
        .expect("cargo starts");
    assert!(output.status.success(), "{features}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8_lossy(&output.stdout).lines().map(str::to_owned).collect()
}

#[test]
fn fewer_features_draw_the_same_or_name_what_is_missing() {
    let place = TempDir::new().unwrap();
    let streams = streams();
    let files: Vec<_> = streams.iter().map(|(name, _)| place.path().join(name).display().to_string()).collect();
    files.iter().zip(&streams).for_each(|(file, (_, stream))| fs::write(file, stream.as_bytes()).unwrap());
    let expected = drawn(ALL, &files);
    // With all features there is a picture of each, and those of different scenes differ.
    let checksum = |line: &String| line.rsplit('\t').next().filter(|sum| u32::from_str_radix(sum, 16).is_ok()).map(str::to_owned);
    let sums: Option<BTreeSet<_>> = expected.iter().map(checksum).collect();
    assert!(sums.is_some_and(|sums| sums.len() * 2 > expected.len()), "{expected:#?}");
    for features in SETS {
        let has: BTreeSet<_> = features.split(',').collect();
        let (mut same, mut refused) = (0, BTreeSet::new());
        for (line, whole) in drawn(features, &files).iter().zip(&expected) {
            let [file, format, shader, result] = line.split('\t').collect::<Vec<_>>()[..] else { panic!("{line}") };
            let index = files.iter().position(|name| name == file).unwrap();
            let stream = streams[index].1.parse().unwrap();
            let format = if format == "rgb565" { Format::Rgb565 } else { Format::Binary };
            let missing: Vec<_> =
                program::needs(&stream, format).into_iter().map(Feature::name).filter(|name| !has.contains(name)).collect();
            if missing.is_empty() {
                assert_eq!(line, whole, "with the features {features}");
                same += 1;
            } else {
                let says = |name: &&str| result == format!("this program lacks the cargo feature {name}; enable it in Cargo.toml");
                assert!(missing.iter().any(says), "{shader}, with the features {features}: {line}, needs {missing:?}");
                refused.insert(streams[index].0.clone());
            }
        }
        println!("features {features}: {same} pictures are the same, refused: {refused:?}");
        assert!(same >= 24 && !refused.is_empty());
    }
}
