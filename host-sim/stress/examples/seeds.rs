//! Writes seeds for the fuzz targets: `cargo run -p microphong-stress --example seeds -- fuzz/corpus`.

#[path = "seeds/models.rs"]
mod models;

use anyhow::{Context, Result};
use microphong_stress::{
    changes, fuzz,
    random::Random,
    scenes::{self, Wishes},
    texts,
};
use std::{fs, path::PathBuf};

/// Streams of one object.
const SEEDS: u64 = 24;
/// Streams of several objects that move, and texts of such.
const SCENES: u64 = 8;
/// Larger ones slow the fuzzer down.
const LARGEST: usize = 1_200;

/// Statements that an OBJ file may have.
const TEXTS: [&str; 6] = [
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n",
    "v 0 0 0 1\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1\n",
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf -3/1 -2/1 -1/1\r\n",
    "# text\no name\nv 1e-3 .5 +2\nv 1 0 0\nv 0 \\\n1 0\nusemtl a\nf 1 2 3\n",
    "v 0 0 0\nv 2 0 0\nv 1 .2 0\nv 1 2 0\nf 1 2 3 4\n",
];

fn main() -> Result<()> {
    let folder = PathBuf::from(std::env::args().nth(1).context("name the folder of the corpus")?);
    for (target, _) in fuzz::TARGETS {
        fs::create_dir_all(folder.join(target))?;
    }
    for (k, (target, bytes)) in models::seeds().into_iter().enumerate() {
        fs::write(folder.join(format!("{target}/seed-{k:02}")), bytes)?;
    }
    let mut number = 0;
    let mut case = || loop {
        number += 1;
        let wishes = Wishes { closed: false, unclipped: false, triangles: 6, hard: scenes::Hard::default() };
        if let Some(case) = scenes::case(&mut Random::new(1, number), wishes)
            && case.stream.as_bytes().len() <= LARGEST
        {
            return case;
        }
    };
    let mut number = 0;
    let mut scene = || loop {
        number += 1;
        let case = changes::case(&mut Random::new(2, number), 6);
        if let Some(case) = case.ok().flatten()
            && case.stream.as_bytes().len() <= LARGEST
            && case.stream.parse().is_ok_and(|stream| !stream.tracks.is_empty())
        {
            return case;
        }
    };
    for k in 0..SEEDS + SCENES {
        let mut next = || if k < SEEDS { case() } else { scene() };
        fs::write(folder.join(format!("structured/seed-{k:02}")), fuzz::seed(&next()))?;
        if k % 4 == 0 {
            fs::write(folder.join(format!("raw/seed-{k:02}")), next().stream.as_bytes())?;
        }
    }
    for (k, text) in TEXTS.iter().enumerate() {
        fs::write(folder.join(format!("obj/seed-{k:02}")), text)?;
    }
    for k in 0..SCENES {
        fs::write(folder.join(format!("scene/seed-{k:02}")), texts::text(&mut Random::new(4, k)))?;
    }
    Ok(())
}
