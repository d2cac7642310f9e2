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

/// What cargo says of all that is compiled beside the tests: a package's tests build only the package's own programs.
static COMPILED: LazyLock<Vec<Value>> = LazyLock::new(|| {
    let cargo = Command::new(env!("CARGO"))
        // As `cargo test --workspace` compiles it, so that nothing is compiled twice.
        .args(["build", "--quiet", "--workspace", "--tests", "--bin", "microphong", "--message-format", "json"])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        // tests/run means it for programs of boards, and this one would be compiled anew for it.
        .env_remove("RUSTC_WORKSPACE_WRAPPER")
        .output()
        .expect("cargo");
    assert!(cargo.status.success(), "{}", String::from_utf8_lossy(&cargo.stderr));
    let messages =
        String::from_utf8_lossy(&cargo.stdout).lines().filter_map(|line| serde_json::from_str(line).ok()).collect::<Vec<Value>>();
    messages.into_iter().filter(|message| message["profile"]["test"] == false).collect()
});

/// The command `microphong`.
///
/// # Panics
/// When it does not compile.
#[must_use]
pub fn program() -> &'static Path {
    let mut programs = COMPILED.iter().filter(|message| message["target"]["kind"][0] == "bin");
    programs.find_map(|message| message["executable"].as_str()).map(Path::new).expect("the program's path")
}

/// Compiles a program of one file with these libraries of the tests, into a folder, and returns its path.
///
/// # Panics
/// When it does not compile.
#[must_use]
pub fn compiled(source: &Path, folder: &Path, libraries: &[&str]) -> PathBuf {
    let program = folder.join("program");
    let mut rustc = Command::new(std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into()));
    rustc.current_dir(env!("CARGO_MANIFEST_DIR")).args(["--edition", "2024", "-o"]).arg(&program).arg(source);
    let is_library = |message: &&Value, name: &str| {
        let target = &message["target"];
        target["kind"][0] == "lib" && target["name"].as_str().is_some_and(|target| target.replace('-', "_") == name)
    };
    for name in libraries {
        let mut files = COMPILED
            .iter()
            .filter(|message| is_library(message, name))
            .flat_map(|message| message["filenames"].as_array().into_iter().flatten())
            .filter_map(Value::as_str);
        let file = files.find(|file| file.ends_with(".rlib")).unwrap_or_else(|| panic!("the tests have no library {name}"));
        let folder = Path::new(file).parent().expect("a folder");
        rustc.arg("--extern").arg(format!("{name}={file}")).arg("-L").arg(format!("dependency={}", folder.display()));
    }
    let output = rustc.output().expect("rustc");
    assert!(output.status.success(), "{}: {}", source.display(), String::from_utf8_lossy(&output.stderr));
    program
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
