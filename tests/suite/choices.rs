//! The choices of the method `auto`, as `render --show methods`, `compare` and `bench` show them.

use embedded_graphics::geometry::Size;
use microphong::{
    format::ErrorBudget,
    method::{
        auto::costs::{COSTS, Cost},
        cosines::sqrt6::Sqrt6,
    },
    stream::record::Triangle,
};
use microphong_sim::{
    bench::{Bench, Processor},
    choices::{self, Choices, Told, Way},
    legend,
    look::{Look, Surface},
    oracle::{self, Frame},
    quantise::quantise,
    render::{Format, Settings},
    scene::{self, Scene},
    shader::Shader,
    shapes,
    stress::{
        budget::{self, Found},
        case::Case,
    },
    vector::{add, unit},
    view::{Up, View},
};
use microphong_tests::{run, succeeds};
use rayon::prelude::*;
use serde_json::Value;
use std::{
    collections::{BTreeSet, HashMap},
    fs::File,
    io::BufReader,
};

#[track_caller]
fn object(line: &str) -> Value {
    serde_json::from_str(line).expect("an object")
}

/// The names of ways in JSON.
const KEYS: [&str; 5] = ["one_colour", "linear", "quadratic", "cosines", "phong"];

/// The sum over all ways of a field of `choices`.
#[track_caller]
fn sum(object: &Value, field: &str) -> u64 {
    KEYS.iter().map(|key| object["choices"][key][field].as_u64().expect("a count")).sum()
}

/// All pixels are counted, and all triangles that have any; a larger budget takes triangles from Phong shading.
#[test]
fn counts_add_up() {
    let directory = tempfile::tempdir().expect("scratch directory");
    for scene in ["torus", "sphere-40", "triangle"] {
        let phong = ["0.5", "16"].map(|budget| {
            let line = succeeds(directory.path(), &["render", scene, "--show", "methods", "--budget", budget, "--json"]);
            let object = object(&line);
            assert_eq!((&object["shader"], &object["budget"]), (&"auto".into(), &budget.parse::<f64>().expect("a number").into()));
            let (triangles, drawn) = (sum(&object, "triangles"), object["drawn"].as_u64().expect("a count"));
            assert!((drawn - drawn / 100..=drawn).contains(&triangles), "{triangles} triangles: {object}");
            assert_eq!(Some(sum(&object, "pixels")), object["pixels"].as_u64());
            object["choices"]["phong"]["triangles"].as_u64().expect("a count")
        });
        assert!(phong[1] < phong[0] || scene != "torus", "{scene}: {phong:?}");
    }
}

/// Shares are of triangles, and of pixels.
fn shares_are_100_percent(choices: &Choices) {
    let sums = Way::ALL.iter().map(|&way| choices.percent(way)).fold([0.0; 2], |sum, percent| [sum[0] + percent[0], sum[1] + percent[1]]);
    assert!(sums.iter().all(|sum| f64::abs(sum - 100.0) < 1e-9), "{sums:?}");
}

/// Whether `pixel` is this colour, darkened to three quarters at most.
fn is_shade_of(pixel: [u8; 3], colour: [u8; 3]) -> bool {
    let shade = |brightness: u32| colour.map(|channel| (u32::from(channel) * (3 * 255 + brightness) / (4 * 255)) as u8);
    (0..=255).any(|brightness| shade(brightness) == pixel)
}

/// Every pixel is background or has the colour of a way; each way that is counted is seen, and no other; whatever the format.
#[test]
fn painted_pictures_have_the_colours_of_ways() {
    let scene = scene::load("torus").expect("a built-in scene");
    let stream = scene.stream.parse().expect("a stream");
    for format in [Format::Rgb888, Format::Gray8] {
        let size = Size::new(160, 160);
        let settings = Settings { size, style: Shader::AUTO.into(), band_rows: 1, format };
        let (picture, Told { choices, .. }) = choices::painted(stream, &settings, 0).expect("a picture");
        shares_are_100_percent(&choices);
        let (mut seen, mut others) = ([false; Way::ALL.len()], BTreeSet::new());
        for &pixel in picture.rgb.as_chunks::<3>().0 {
            match Way::ALL.iter().position(|way| is_shade_of(pixel, way.colour())) {
                Some(way) => seen[way] = true,
                None => _ = others.insert(pixel),
            }
        }
        assert_eq!(others.len(), 1, "the background alone, not {others:?}");
        assert_eq!(seen, Way::ALL.map(|way| choices.count(way).pixels > 0));
    }
}

/// The legend lies below the picture, white and the colours of all ways on black, in each frame.
#[test]
fn the_legend_is_below() {
    let directory = tempfile::tempdir().expect("scratch directory");
    let text = succeeds(directory.path(), &["render", "torus", "--show", "methods", "--size", "240x64", "--frames", "2", "-o", "f/"]);
    assert!(text.contains("    budget 4 LSB; triangles: one colour "), "{text}");
    let pictures = ["f/0000.png", "f/0001.png"].map(|name| {
        let file = BufReader::new(File::open(directory.path().join(name)).expect("a picture"));
        let mut reader = png::Decoder::new(file).read_info().expect("a picture");
        assert_eq!((reader.info().width, reader.info().height), (240, 64 + legend::HEIGHT));
        let mut rgb = vec![0; reader.output_buffer_size().expect("a size")];
        reader.next_frame(&mut rgb).expect("a picture");
        rgb
    });
    let colours: Vec<_> = [[0; 3], [255; 3]].into_iter().chain(Way::ALL.map(Way::colour)).collect();
    for rgb in &pictures {
        let below = &rgb.as_chunks::<3>().0[240 * 64..];
        assert!(below.iter().all(|pixel| colours.contains(pixel)), "a colour that the legend does not have");
        assert!(colours.iter().all(|colour| below.contains(colour)), "a colour that is missing");
    }
    assert_ne!(pictures[0], pictures[1]);
}

#[test]
fn what_chooses_nothing_cannot_be_shown() {
    let directory = tempfile::tempdir().expect("scratch directory");
    let cases: [(&[&str], &[&str]); 5] = [
        (&["--show", "methods", "--shader", "phong"], &["--show methods", "auto", "phong"]),
        (&["--show", "methods", "--outlines", "000000"], &["--show", "--outlines"]),
        (&["--show", "methods", "--dither"], &["--show", "--dither"]),
        (&["--show", "methods", "--band-rows", "4"], &["--show", "--band-rows"]),
        (&["--show", "edges"], &["--show", "methods"]),
    ];
    for (arguments, words) in cases {
        let output = run(directory.path(), &[&["render", "triangle"], arguments].concat());
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {stderr}");
        assert!(words.iter().all(|word| stderr.contains(word)) && output.stdout.is_empty(), "{arguments:?}: {stderr}");
    }
    assert_eq!(directory.path().read_dir().expect("scratch directory").count(), 0);
    // What auto is asked for by name changes nothing, and other pictures say nothing of choices.
    let show = |more: &[&str]| succeeds(directory.path(), &[&["render", "triangle", "--json"], more].concat());
    assert_eq!(show(&["--show", "methods"]), show(&["--show", "methods", "--shader", "auto"]));
    assert_eq!(object(&show(&["--shader", "auto"])).get("choices"), None);
}

/// `compare` tells what `render` tells, and of other methods nothing.
#[test]
fn compare_tells_choices() {
    let directory = tempfile::tempdir().expect("scratch directory");
    let arguments = ["compare", "torus", "--size", "80x80", "--budget", "2", "--shader", "gouraud,auto"];
    let text = succeeds(directory.path(), &arguments);
    let lines: Vec<_> = text.lines().map(|line| line.trim_start().split(' ').next()).collect();
    assert_eq!(lines[2..], [Some("gouraud"), Some("auto"), Some("budget")], "{text}");
    let objects: Vec<_> = succeeds(directory.path(), &[&arguments[..], &["--json"]].concat()).lines().map(object).collect();
    let [gouraud, auto] = &objects[..] else { panic!("an object per method") };
    assert!(gouraud["budget"].is_null() && gouraud["choices"].is_null(), "{gouraud}");
    let shown = succeeds(
        directory.path(),
        &["render", "torus", "--size", "80x80", "--budget", "2", "--format", "rgb888", "--show", "methods", "--json"],
    );
    let shown = object(&shown);
    assert_eq!((&auto["budget"], &auto["choices"]), (&shown["budget"], &shown["choices"]));
}

/// Frames of each scene's orbit.
const FRAMES: u32 = 36;

/// A torus of which some normals lean by up to 60 degrees, and some point the other way: creases, and normals between opposite ones that
/// vanish.
fn creased() -> Scene {
    let mut mesh = shapes::torus(24, 12);
    for (k, normal) in mesh.normals.iter_mut().enumerate() {
        let aside = [[1.7, 0.0, 0.0], [0.0, 1.7, 0.0], [0.0, 0.0, 1.7]][k % 3];
        *normal = match k % 7 {
            0 => normal.map(|c| -c),
            1 | 2 => unit(add(*normal, aside)).unwrap_or(*normal),
            _ => *normal,
        };
    }
    let view = View::orbit(Up::Y, 0.5, 0.35, 4.0, 120).fit(&mesh.positions, (256, 256), 0.06);
    let look = Look::new(Surface::plastic([0.25, 0.5, 0.95], [0.1, 0.5, 0.4], 50), view);
    Scene { name: "creased torus".to_owned(), stream: look.stream(&quantise(&mesh).0).expect("a stream"), size: (256, 256) }
}

/// Frames of all scenes, seen from all around, stay within 1 of 255 plus the error of arithmetic.
#[test]
fn all_frames_of_all_scenes_keep_the_budget() {
    let scenes = scene::NAMES.iter().chain(&scene::VARIANTS).map(|name| scene::load(name).expect("a built-in scene"));
    let scenes: Vec<_> = scenes.chain([creased()]).collect();
    let opposite = |triangle: &Triangle| triangle.min_normal_length == 0;
    let last = scenes.last().and_then(|scene| scene.stream.parse().ok()).expect("a stream");
    assert!(last.triangles.iter().any(opposite), "normals that are opposite");
    let worst: Vec<_> = scenes
        .par_iter()
        .map(|scene| {
            let header = scene.stream.parse().expect("a stream").header;
            assert_eq!(header.budget(), None, "the display decides: 1 of 255 for eight bits a channel");
            let found: Vec<_> = (0..FRAMES)
                .into_par_iter()
                .map(|k| {
                    let frame = k * u32::from(header.camera.period) / FRAMES;
                    let case = Case { size: scene.size.into(), frame, style: Shader::AUTO.into(), ..Case::new(scene.stream.clone()) };
                    budget::judge(&case).expect("a frame")
                })
                .collect();
            let largest = |of: fn(&Found) -> f64| found.iter().map(of).fold(0.0, f64::max);
            let [triangles, cheaper] = [|f: &Found| f.triangles, |f: &Found| f.cheaper].map(|of| found.iter().map(of).sum::<u64>());
            (&scene.name, largest(|f| f.error), largest(|f| f.share), triangles, cheaper)
        })
        .collect();
    for (name, error, share, triangles, cheaper) in &worst {
        println!("{name:20} {error:.3} LSB at most, of {triangles} triangles {cheaper} not by phong");
        assert!(*error <= 1.5 && *share <= 1.0, "{name}: {error} LSB");
    }
}

/// `bench` prints choices as well.
#[test]
fn bench_tells_choices() {
    let scene = scene::load("torus").expect("a built-in scene");
    let bench = Bench::new(&[Processor::X86_64]).expect("a program");
    let wanted = [Shader::GOURAUD, Shader::AUTO].map(|shader| (Processor::X86_64, shader));
    let measured = bench.measure(&scene, &wanted, &|| ()).expect("measurements");
    let [gouraud, auto] = [0, 1].map(|k: usize| object(&serde_json::to_string(&measured[k]).expect("JSON")));
    assert!(gouraud["budget"].is_null() && gouraud["choices"].is_null(), "{gouraud}");
    assert_eq!(auto["budget"], 4.0, "that of RGB565");
    assert_eq!(Some(sum(&auto, "pixels")), auto["pixels"].as_u64(), "{auto}");
}

/// The table by which methods are chosen still is what they cost: the means of three processors, and of two scenes, one of large and one of small triangles.
#[test]
fn the_table_of_costs_is_true() {
    /// Processors, and what an instruction of them counts.
    const PROCESSORS: [(Processor, f64); 3] = [(Processor::CortexM3, 1.0), (Processor::RiscV, 0.72), (Processor::CortexM0Plus, 0.49)];
    const METHODS: [Shader; 2] = [Shader::SIX_POINT, Shader::PHONG];
    let bench = Bench::new(&PROCESSORS.map(|(processor, _)| processor)).expect("programs of three boards");
    let wanted = PROCESSORS.map(|(processor, _)| METHODS.map(|shader| (processor, shader)));
    // Instructions for each triangle, row and pixel, of each processor and method.
    let cost = |scene: &&str| {
        let scene = scene::load(scene).expect("a built-in scene");
        let measured = bench.count(&scene, wanted.as_flattened(), &|| ()).expect("measurements");
        let costs = measured.iter().map(|of| {
            let stages = of.by_stage;
            [(stages.setup, of.triangles), (stages.span, of.spans), (stages.pixel, of.pixels)].map(|(sum, of)| sum as f64 / of as f64)
        });
        costs.collect::<Vec<_>>()
    };
    let styles = [["peer-sphere", "teapot"], ["peer-sphere-plastic", "torus"], ["peer-sphere-lights", "bunny"]];
    let found = styles.map(|scenes| scenes.each_ref().map(cost));
    for ((scenes, found), table) in styles.iter().zip(found).zip(COSTS) {
        for (k, Cost { triangle, row, pixel }) in [table.quadratic, table.phong].into_iter().enumerate() {
            let means = [0, 1, 2].map(|part| {
                let shares = PROCESSORS.iter().enumerate().map(|(processor, (_, share))| {
                    let of = |costs: &[[f64; 3]]| costs[METHODS.len() * processor + k][part];
                    share * f64::midpoint(of(&found[0]), of(&found[1]))
                });
                shares.sum::<f64>() / PROCESSORS.iter().map(|(_, share)| share).sum::<f64>()
            });
            let told = [triangle, row, pixel].map(f64::from);
            println!("{scenes:?}, {}: {means:.1?}, the table has {told:?}", METHODS[k].name());
            assert!((0..3).all(|part| (means[part] - told[part]).abs() <= 0.5 + 0.05 * told[part]));
        }
    }
}

/// `auto` costs little more than if each triangle were drawn by the cheapest method that the oracle finds within the budget, and nobody had to
/// find that out.
#[test]
fn auto_is_nearly_as_cheap_as_true_errors_allow() {
    const METHODS: [Shader; 4] = [Shader::GOURAUD, Shader::SIX_POINT, Shader::new(&Sqrt6), Shader::PHONG];
    /// Budgets, in 1/255: that of displays with eight bits a channel, and that of RGB565.
    const BUDGETS: [u8; 2] = [1, 4];
    /// Scenes, and how many times as much `auto` may cost with each budget.
    const SCENES: [(&str, [f64; 2]); 8] = [
        ("peer-sphere", [1.2, 1.15]),
        ("peer-sphere-plastic", [1.33, 1.18]),
        ("peer-sphere-lights", [1.44, 1.34]),
        ("teapot", [1.22, 1.29]),
        ("torus", [1.14, 1.15]),
        ("bunny", [1.26, 1.35]),
        ("sphere-40", [1.15, 1.26]),
        ("dodecahedron", [1.03, 1.03]),
    ];
    let bench = Bench::new(&[Processor::CortexM3]).expect("a firmware");
    let count = |scene: &Scene, shaders: &[Shader]| -> Vec<f64> {
        let wanted: Vec<_> = shaders.iter().map(|&shader| (Processor::CortexM3, shader)).collect();
        bench.count(scene, &wanted, &|| ()).expect("measurements").iter().map(|m| m.instr_per_pixel).collect()
    };
    for (name, most) in SCENES {
        let scene = scene::load(name).expect("a built-in scene");
        let stream = scene.stream.parse().expect("a stream");
        let costs = count(&scene, &METHODS);
        let mut cheapest_first = [0, 1, 2, 3];
        cheapest_first.sort_by(|&a: &usize, &b: &usize| costs[a].total_cmp(&costs[b]));
        let (width, height) = Processor::CortexM3.size();
        let frame = Frame::new(stream, (width, height), 0);
        let mut pixels: HashMap<u32, Vec<[f64; 2]>> = HashMap::new();
        for (k, sights) in (0..).zip(frame.visible()) {
            if let Some(&facet) = sights.iter().flatten().next() {
                pixels.entry(facet).or_default().push([k % width, k / width].map(|c| f64::from(c) + 0.5));
            }
        }
        let mut drawn = [[0; METHODS.len()]; BUDGETS.len()];
        for (&facet, points) in &pixels {
            let facet = &frame.facets[facet as usize];
            let exact: Vec<_> = points.iter().copied().map(oracle::phong(&frame, facet)).collect();
            let errors = METHODS.map(|method| {
                let shade = oracle::method(method.name(), &frame, facet).expect("a method of all scenes");
                let error =
                    |(&p, exact): (&[f64; 2], &[f64; 3])| shade(p).iter().zip(exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                points.iter().zip(&exact).map(error).fold(0.0, f64::max)
            });
            for (drawn, budget) in drawn.iter_mut().zip(BUDGETS) {
                let method = cheapest_first.into_iter().find(|&method| errors[method] <= f64::from(budget)).expect("Phong shading");
                drawn[method] += points.len();
            }
        }
        for ((drawn, budget), most) in drawn.into_iter().zip(BUDGETS).zip(most) {
            let all: usize = drawn.iter().sum();
            let cheapest: f64 = drawn.iter().zip(&costs).map(|(&pixels, cost)| pixels as f64 / all as f64 * cost).sum();
            let limited = Scene { stream: scene.stream.clone().with_budget(ErrorBudget::from_num(budget)), ..scene.clone() };
            let auto = count(&limited, &[Shader::AUTO])[0];
            let (ratio, over_gouraud) = (auto / cheapest, cheapest / costs[0]);
            println!("{name} within {budget}: pixels {drawn:?}, instructions a pixel {costs:.1?}, auto {auto:.1}");
            println!("  by true errors {cheapest:.1}: auto takes {ratio:.3} times as many, and they take {over_gouraud:.2} times gouraud");
            assert!(ratio <= most, "{name} within {budget}: {ratio:.3}");
        }
    }
}
