//! The page of the playground in a browser without a window: it draws the bits of the native command, and a person can use it.

use crate::golden::root;
use embedded_graphics::geometry::Size;
use microphong_sim::{
    render::{self, Format, Settings, Style},
    scene::{self, Scene},
    shader::Shader,
};
use microphong_tests::{browser::Browser, succeeds};
use serde_json::{Value, json};
use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
    sync::LazyLock,
    time::{Duration, Instant},
};

/// The page, built by its command.
static PAGE: LazyLock<PathBuf> = LazyLock::new(|| {
    let begin = Instant::now();
    let mut cargo = Command::new(env!("CARGO"));
    // tests/run means it for programs of boards, and the module would be compiled anew for it.
    cargo.args(["run", "--quiet", "-p", "microphong-web"]).current_dir(root()).env_remove("RUSTC_WORKSPACE_WRAPPER");
    let output = cargo.output().expect("cargo");
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    println!("built in {:.1} s: {said}", begin.elapsed().as_secs_f64());
    PathBuf::from(said.split(".html").next().expect("a path").to_owned() + ".html")
});

/// Opens the page, and waits for its first picture.
fn open(width: u32, downloads: &Path) -> Browser {
    let browser = Browser::open(&PAGE, width, downloads);
    browser.wait("document.documentElement.dataset.first");
    quiet(&browser);
    browser
}

/// Waits until the picture shows what the controls say.
#[track_caller]
fn quiet(browser: &Browser) {
    browser.wait("document.getElementById('screen').getAttribute('aria-busy') === 'false'");
}

/// The checksum of `microphong render` with smooth outlines.
fn checksum(scene: &Scene, shader: Shader, size: Size) -> String {
    let smooth = scene.smooth().expect("a stream");
    let usual = Settings::usual(shader, size, Format::Rgb565);
    let settings = Settings { style: Style { antialias: smooth.is_some(), ..usual.style }, ..usual };
    let stream = smooth.as_ref().unwrap_or(&scene.stream).parse().expect("a stream");
    format!("{:08x}", render::picture(stream, &settings, 0).expect("a picture").crc)
}

#[test]
fn it_draws_the_bits_of_the_native_command() {
    let place = tempfile::tempdir().expect("a folder");
    let browser = open(1600, place.path());
    println!("first picture after {} ms", browser.run("return Math.round(document.documentElement.dataset.first)"));
    let size = Size::new(160, 128);
    let panel = browser.run("return 1 + catalogue.panels.findIndex(({ size }) => size.join() === '160,128')").to_string();
    browser.choose("panel", &panel);
    quiet(&browser);
    let (mut count, mut different) = (0, Vec::new());
    for name in scene::all() {
        let scene = scene::load(name).expect("a built-in scene");
        browser.choose("scene", name);
        browser.wait(&format!("opened.name === '{name}'"));
        for shader in Shader::CORE {
            browser.choose("method", shader.name());
            quiet(&browser);
            if browser.text("crc") != checksum(&scene, shader, size) {
                different.push(format!("{name} by {}", shader.name()));
            }
            count += 1;
        }
    }
    assert_eq!(different, [""; 0]);
    browser.choose("scene", "torus");
    browser.wait("opened.name === 'torus'");
    browser.choose("method", "auto");
    let formats = browser.run("return catalogue.formats.map(({ name }) => name)");
    let formats: Vec<String> = serde_json::from_value(formats).expect("names");
    assert!(formats.len() >= 5, "{formats:?}");
    for format in &formats {
        browser.choose("format", format);
        quiet(&browser);
        let command = browser.text("command");
        let words: Vec<_> = command.split_whitespace().skip_while(|word| *word != "render").chain(["--json"]).collect();
        let native: Value = serde_json::from_str(&succeeds(place.path(), &words)).expect("JSON");
        assert_eq!(native["crc"], browser.text("crc"), "{command}");
    }
    println!("{count} checksums of scenes and methods, and {} of formats", formats.len());
    assert_eq!(browser.console(), [""; 0]);
}

/// Drops files with these names and texts on the page.
fn drop_files(browser: &Browser, files: &[(&str, &str)]) {
    let files = json!(files);
    let _ = browser.run(&format!(
        "const data = new DataTransfer();
         for (const [name, text] of {files}) data.items.add(new File([text], name));
         for (const kind of ['dragover', 'drop']) {{
           document.body.dispatchEvent(new DragEvent(kind, {{ bubbles: true, cancelable: true, dataTransfer: data }}));
         }}"
    ));
}

/// The file that a click on a button downloads.
fn download(browser: &Browser, selector: &str, file: &Path) -> Vec<u8> {
    browser.click(selector);
    let begin = Instant::now();
    while !file.exists() {
        assert!(begin.elapsed() < Duration::from_secs(60), "{} is not downloaded", file.display());
        std::thread::sleep(Duration::from_millis(20));
    }
    fs::read(file).expect("a file")
}

#[test]
fn a_person_can_open_turn_choose_and_take_away() {
    let place = tempfile::tempdir().expect("a folder");
    let browser = open(1600, place.path());
    let obj = fs::read_to_string(root().join("meshes/teapot.obj")).expect("a mesh");
    let obj = format!("mtllib pot.mtl\nusemtl blue\n{obj}");
    let mtl = "newmtl blue\nKd 0.2 0.4 0.9\nKs 0.5 0.5 0.5\nNs 40\n";

    // What cannot be read is said in place, and what was open stays.
    drop_files(&browser, &[("broken.obj", "v 1 2\nf 1 2 3\n")]);
    browser.wait("!document.getElementById('alert').hidden");
    let said = browser.text("alert");
    assert!(said.contains("broken.obj"), "{said}");
    assert_eq!(browser.run("return opened.name"), "teapot");

    drop_files(&browser, &[("Pot.MTL", mtl), ("my pot.obj", &obj)]);
    browser.wait("opened.name === 'my pot'");
    quiet(&browser);
    for (name, text) in [("my pot.obj", &obj[..]), ("pot.mtl", mtl)] {
        fs::write(place.path().join(name), text).expect("a folder");
    }
    let before = browser.text("crc");

    // The mesh file is that of the converter, and the command draws this picture.
    let downloaded = download(&browser, "#take-stream", &place.path().join("my pot.tri"));
    fs::rename(place.path().join("my pot.tri"), place.path().join("from page.tri")).expect("a file");
    assert_eq!(browser.text("convert"), "cargo run --release -- convert 'my pot.obj' --antialias -o 'my pot.tri'");
    let _ = microphong_tests::run(place.path(), &["convert", "my pot.obj", "--antialias", "-o", "my pot.tri"]);
    assert!(fs::read(place.path().join("my pot.tri")).expect("a stream") == downloaded, "the mesh files differ");
    fs::remove_file(place.path().join("my pot.tri")).expect("a file");

    // The mouse turns the mesh, and so do keys, and Home turns it back.
    let middle = browser.run(
        "document.getElementById('screen').scrollIntoView({ block: 'center' });
         const { x, y, width, height } = document.getElementById('screen').getBoundingClientRect();
         return [Math.round(x + width / 2), Math.round(y + height / 2)]",
    );
    let (x, y) = (middle[0].as_i64().expect("a place"), middle[1].as_i64().expect("a place"));
    browser.drag(&[(x, y), (x + 20, y + 5), (x + 60, y + 10)]);
    browser.wait("turn[0] !== 0");
    quiet(&browser);
    let dragged = browser.text("crc");
    assert_ne!(dragged, before);
    let turned = download(&browser, "#take-stream", &place.path().join("my pot.tri"));
    assert_ne!(turned, downloaded);
    let native = succeeds(place.path(), &["render", "my pot.tri", "--size", "640x480", "--format", "rgb565", "--json"]);
    let native: Value = serde_json::from_str(&native).expect("JSON");
    assert_eq!(native["crc"], dragged, "the file shows what was turned");
    browser.press('\u{e014}');
    quiet(&browser);
    assert_ne!(browser.text("crc"), dragged);
    browser.press('\u{e011}');
    quiet(&browser);
    assert_eq!(browser.text("crc"), before);

    // A display of one bit, and the program for it.
    let panel = browser.run("return 1 + catalogue.panels.findIndex(({ name }) => name.startsWith('SSD1306'))").to_string();
    browser.choose("panel", &panel);
    quiet(&browser);
    assert_eq!(browser.run("return document.getElementById('screen').className"), "oled");
    let colours = browser.run(
        "const { data } = canvas.getContext('2d').getImageData(0, 0, 128, 64);
         return [...new Set(new Uint32Array(data.buffer))].length",
    );
    assert_eq!(colours, 2);
    let program = String::from_utf8(download(&browser, "#take-program", &place.path().join("main.rs"))).expect("a text");
    assert!(program.contains("BinaryColor") && program.contains("include_stream!(\"../my pot.tri\")"), "{program}");

    // Other views, light and material.
    let pictures = ["ways", "errors", "picture"].map(|view| {
        browser.click(&format!("label:has(input[value={view}]) span"));
        quiet(&browser);
        browser.run("return canvas.toDataURL()")
    });
    assert!(pictures[0] != pictures[1] && pictures[1] != pictures[2]);
    let crcs: Vec<_> = [("surface", "plastic"), ("lights", "near"), ("exponent", "5")]
        .map(|(control, value)| {
            browser.choose(control, value);
            quiet(&browser);
            browser.text("crc")
        })
        .into();
    assert!(crcs[0] != crcs[1] && crcs[1] != crcs[2], "{crcs:?}");
    let measured = browser.run("return Number(document.documentElement.dataset.measured ?? 0)");
    browser.wait(&format!("document.documentElement.dataset.measured > {measured}"));
    assert!(browser.text("boards").contains("rp2040"), "{}", browser.text("boards"));
    assert!(browser.text("layout").starts_with("Layout::new(128, 16)"), "{}", browser.text("layout"));
    assert_eq!(browser.console(), [""; 0]);
}

#[test]
fn a_mesh_turns_smoothly() {
    let place = tempfile::tempdir().expect("a folder");
    let browser = open(1600, place.path());
    browser.choose("scene", "bunny");
    browser.wait("opened.name === 'bunny'");
    browser.choose("panel", "1");
    browser.click("#play");
    std::thread::sleep(Duration::from_secs(1));
    let count = || browser.run("return [Number(document.documentElement.dataset.pictures), performance.now()]");
    let numbers = |value: &Value| [0, 1].map(|k| value[k].as_f64().expect("a number"));
    let [first, begin] = numbers(&count());
    std::thread::sleep(Duration::from_secs(2));
    let [last, end] = numbers(&count());
    let rate = 1000.0 * (last - first) / (end - begin);
    println!("bunny at 320x240 by auto: {rate:.0} pictures a second, {} each", browser.text("time"));
    // Other tests keep the processors busy.
    assert!(rate > 5.0, "{rate}");
    assert_eq!(browser.console(), [""; 0]);
}

#[test]
fn it_fits_every_width_and_has_names_for_all_controls() {
    let place = tempfile::tempdir().expect("a folder");
    for width in [360, 1600] {
        let browser = open(width, place.path());
        browser.wait("document.documentElement.dataset.measured");
        let beyond = browser.run("return document.documentElement.scrollWidth - document.documentElement.clientWidth");
        assert_eq!(beyond, 0, "{width}: the page scrolls sideways");
        let nameless = browser.run(
            "return [...document.querySelectorAll('button, input, select, [tabindex=\"0\"]')].filter((control) => control.checkVisibility())
               .filter((control) => !(control.labels?.[0]?.innerText || control.getAttribute('aria-label') || control.innerText).trim())
               .map((control) => control.outerHTML)",
        );
        assert_eq!(nameless, json!([]), "controls without a name");
        // The tabulator reaches everything that can be used.
        let wanted = browser.run(
            "window.reached = new Set(); document.activeElement.blur(); scrollTo(0, 0);
             document.addEventListener('focusin', ({ target }) => reached.add(target));
             window.all = [...document.querySelectorAll('a, button, input, select, [tabindex=\"0\"]')]
               .filter((control) => control.checkVisibility() && !control.disabled && (control.type !== 'radio' || control.checked));
             return all.length",
        );
        for _ in 0..wanted.as_u64().expect("a number") + 12 {
            browser.press('\u{e004}');
        }
        let missed = browser.run("return all.filter((control) => !reached.has(control)).map((control) => control.outerHTML)");
        assert_eq!(missed, json!([]), "controls that the tabulator does not reach");
        println!("{width} pixels: {wanted} controls");
        assert_eq!(browser.console(), [""; 0]);
    }
}

/// The contrast of two colours, as WCAG 2 defines it.
fn contrast(colours: [&str; 2]) -> f64 {
    let luminance = |colour: &str| -> f64 {
        let channel = |k: usize| f64::from(u8::from_str_radix(&colour[1 + 2 * k..3 + 2 * k], 16).expect("a colour")) / 255.0;
        let linear = |c: f64| if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) };
        [0.2126, 0.7152, 0.0722].iter().enumerate().map(|(k, share)| share * linear(channel(k))).sum()
    };
    let [a, b] = colours.map(luminance);
    (a.max(b) + 0.05) / (a.min(b) + 0.05)
}

#[test]
fn texts_stand_out_in_light_and_in_dark() {
    let style = fs::read_to_string(root().join("../web/page/style.css")).expect("a style");
    for (scheme, text) in ["light", "dark"].into_iter().zip(style.split("--paper:").skip(1)) {
        let colour = |name: &str| {
            let text = format!("--paper:{text}");
            let at = text.find(&format!("--{name}: #")).unwrap_or_else(|| panic!("no colour {name}")) + name.len() + 4;
            text[at..at + 7].to_owned()
        };
        for (over, under) in [
            ("ink", "paper"),
            ("ink", "card"),
            ("ink", "stage"),
            ("soft", "paper"),
            ("soft", "card"),
            ("accent", "paper"),
            ("on-accent", "accent"),
            ("bad", "paper"),
            ("bad", "card"),
        ] {
            let contrast = contrast([&colour(over), &colour(under)]);
            assert!(contrast >= 4.5, "{scheme}: {over} on {under}: {contrast:.2}");
        }
    }
}
