//! Cross-checks of whole programs; see the files in `suite/`.

pub mod browser;
pub mod message;
pub mod phong;

use microphong::stream::{
    record::{CLOSED_CONVEX, Header, Mesh, Triangle},
    seal,
};
use microphong_sim::{bytes::StreamBytes, shader::Shader};
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use serde_json::Value;
use std::{
    mem::{offset_of, size_of},
    path::{Path, PathBuf},
    process::{Command, Output},
    sync::LazyLock,
};
use zerocopy::FromBytes;

/// The command `microphong`; built here, because a package's tests build only the package's own programs.
///
/// # Panics
/// When it does not compile.
#[must_use]
pub fn program() -> &'static Path {
    static PROGRAM: LazyLock<PathBuf> = LazyLock::new(|| {
        let cargo = Command::new(env!("CARGO"))
            // As `cargo test --workspace` compiles it, so that nothing is compiled twice.
            .args(["build", "--quiet", "--workspace", "--tests", "--bin", "microphong", "--message-format", "json"])
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            // tests/run means it for programs of boards, and this one would be compiled anew for it.
            .env_remove("RUSTC_WORKSPACE_WRAPPER")
            .output()
            .expect("cargo");
        assert!(cargo.status.success(), "{}", String::from_utf8_lossy(&cargo.stderr));
        String::from_utf8_lossy(&cargo.stdout)
            .lines()
            .filter_map(|line| serde_json::from_str::<Value>(line).ok())
            .filter(|message| message["target"]["kind"][0] == "bin" && message["profile"]["test"] == false)
            .find_map(|message| message["executable"].as_str().map(PathBuf::from))
            .expect("the program's path")
    });
    &PROGRAM
}

/// The method in CONTRIBUTING.md, and the light in the guide, compile as they stand there.
#[cfg(doctest)]
#[doc = include_str!("../../CONTRIBUTING.md")]
#[doc = include_str!("../../docs/guide/coordinates.md")]
struct Documents;

/// The methods that all others are compared with.
pub const BASIC: [Shader; 4] = [Shader::FLAT, Shader::GOURAUD, Shader::SIX_POINT, Shader::PHONG];

/// The method with this name.
///
/// # Panics
/// When there is none.
#[must_use]
pub fn named(name: &str) -> Shader {
    Shader::ALL.into_iter().find(|shader| shader.name() == name).unwrap_or_else(|| panic!("no method is named {name}"))
}

/// Whether a command has said nothing on stderr but what takes long.
#[must_use]
pub fn only_announces(stderr: &str) -> bool {
    stderr.lines().all(|line| line.ends_with(" ..."))
}

/// Runs the command in a folder.
///
/// # Panics
/// When it does not start.
#[must_use]
pub fn run(directory: &Path, arguments: &[&str]) -> Output {
    Command::new(program()).args(arguments).current_dir(directory).output().expect("the program")
}

/// Runs the command in a folder, where it must succeed and announce no more than long work on stderr, and returns its stdout.
///
/// # Panics
/// When it does not.
#[track_caller]
#[must_use]
pub fn succeeds(directory: &Path, arguments: &[&str]) -> String {
    let output = run(directory, arguments);
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && only_announces(&stderr), "{arguments:?}: {stderr}");
    String::from_utf8(output.stdout).expect("text")
}

/// Copies a stream without the mark that its first mesh is closed and convex, so that all of it is drawn with depth.
#[must_use]
pub fn unmarked(stream: &StreamBytes) -> StreamBytes {
    let mut bytes = stream.as_bytes().to_vec();
    bytes[size_of::<Header>() + offset_of!(Mesh, flags)] &= !CLOSED_CONVEX;
    seal(&mut bytes);
    StreamBytes::from(bytes.as_slice())
}

/// Copies a stream and marks its triangles as so thick that rounding their corners turns none of them.
#[must_use]
pub fn thick(stream: &StreamBytes) -> StreamBytes {
    let mut bytes = stream.as_bytes().to_vec();
    let triangles = bytes.len() - stream.parse().map_or(0, |stream| size_of_val(stream.triangles));
    for record in bytes[triangles..].chunks_mut(size_of::<Triangle>()) {
        if let Ok(triangle) = Triangle::mut_from_bytes(record) {
            triangle.inverse_altitude = 1;
        }
    }
    seal(&mut bytes);
    StreamBytes::from(&bytes[..])
}

/// The seed of random cases: `MICROPHONG_SEED`, else 1; printed, so that a failure can be found again.
#[must_use]
pub fn seed() -> u64 {
    let seed = variable("MICROPHONG_SEED").unwrap_or(1);
    println!("MICROPHONG_SEED={seed}");
    seed
}

/// Number of random cases: `count`, times `MICROPHONG_CASES` if it is set.
#[must_use]
pub fn cases(count: u64) -> u64 {
    let count = count * variable("MICROPHONG_CASES").unwrap_or(1).max(1);
    println!("{count} cases");
    count
}

/// Makes random cases by the strategies of proptest, with a fixed [`seed`] and [`cases`] of `count`.
#[must_use]
pub fn runner(count: u64) -> TestRunner {
    let mut bytes = [0; 32];
    bytes[..8].copy_from_slice(&seed().to_le_bytes());
    let config = Config { cases: cases(count) as u32, failure_persistence: None, ..Config::default() };
    TestRunner::new_with_rng(config, TestRng::from_seed(RngAlgorithm::ChaCha, &bytes))
}

fn variable(name: &str) -> Option<u64> {
    let text = std::env::var(name).ok()?;
    Some(text.parse().unwrap_or_else(|_| panic!("{name}={text} is no whole number")))
}
