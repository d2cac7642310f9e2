//! Random cases of every family, and checks that each family notices faults.

use embedded_graphics::pixelcolor::{Rgb565, RgbColor};
use microphong::{
    format::NormalLength,
    geometry::model_view::ModelView,
    interpolate::{Patch, plane::Plane},
    setup::gradients::Gradients,
    stream::{
        record::{Material, POINT, VIEWER_LOCAL},
        seal,
    },
};
use microphong_sim::{
    bench::callgrind::Counters,
    bytes::StreamBytes,
    families,
    oracle::Frame,
    render::{self, Style},
    shader::Shader,
    stress::{
        self, Family, Summary, Verdict, arithmetic, budget,
        case::Case,
        changes,
        cost::{self, Bound, Cost, Count},
        coverage, drift, fuzz,
        random::Random,
        sameness, scenes, texts, walks, watertight,
    },
};
use microphong_tests::{cases, seed, thick};
use rayon::prelude::*;
use std::{
    fs,
    path::Path,
    time::{Duration, Instant},
};
use zerocopy::IntoBytes;

/// Seconds that all families together run, times `MICROPHONG_CASES` if it is set.
const SECONDS: u64 = 60;
/// Seeds that are tried beside the usual one. With each of the first seven a version of the core broke a promise.
const SEEDS: [u64; 8] = [31, 111, 222, 333, 777, 4242, 498_050_517, 918_273];

#[test]
fn no_family_finds_a_failure() {
    let (families, seeds) = (families(None), [&[seed()], &SEEDS[..]].concat());
    let share = Duration::from_secs(cases(SECONDS)) / (families.len() * seeds.len()) as u32;
    let mut failures = Vec::new();
    for family in families {
        // What the first case compiles is not the family's time.
        let _ = stress::judge(&*family, seeds[0], 0);
        let (mut judged, mut most) = (0, None::<f64>);
        for &seed in &seeds {
            let begin = Instant::now();
            let Summary { family: name, cases, worst, breaks, .. } = stress::run(&*family, seed, 0, &|_| begin.elapsed() < share);
            judged += cases;
            most = worst.map(|worst| most.unwrap_or(0.0).max(worst));
            for failure in breaks {
                let again = format!("microphong stress --only {name} --seed {seed} --first {} --cases 1", failure.number);
                failures.push(format!("{name}: {}\n  {again}", failure.what));
            }
        }
        println!("{:11} {judged:>10} cases of {} seeds, worst {most:?} of {:?}", family.name(), seeds.len(), family.limit());
        assert!(judged > 0, "{} judged nothing", family.name());
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// Scenes that once broke a promise, each with its method, size, frame, and whether it was drawn in perspective. The folder is `tests/broken`.
const BROKEN: [(&str, &str, [u32; 2], u32, bool); 13] = [
    // Quadratics were set up in words on triangles 15 to 93 times as long as high, under exponents of 328 to 1024.
    ("sqrt6-thin", "sqrt6", [48, 48], 0, false),
    ("renq-thin", "renq", [90, 135], 3_157_191_938, true),
    ("phong-rv-thin", "phong-rv", [132, 240], 0, false),
    ("taylor-thin", "taylor", [77, 205], 4_004_620_158, true),
    ("auto-thin", "auto", [192, 96], 0, false),
    // Quadratics were walked over hundreds of pixels from one anchor.
    ("taylor-finite-large", "taylor-finite", [99, 97], 2_708_577_789, false),
    ("taylor-finite-near", "taylor-finite", [121, 127], 0, false),
    ("sqrt6-large", "sqrt6", [115, 100], 3_773_892_824, false),
    // Each product of an expansion was rounded down to 24 bits, under an exponent of 847.
    ("taylor-sharp", "taylor", [120, 60], 0, true),
    // Rows whose normals are 2^-12 apart have no plane that 30 bits tell.
    ("angular-short", "angular-original", [97, 67], 0, false),
    // The method in floating point took a cosine above 1 for one, where the core counts it as 1.
    ("sqrt6-above-one", "sqrt6", [80, 132], 0, true),
    // The method in floating point took corners' normals for unit vectors.
    ("duff-corners", "duff", [135, 63], 977_128_035, false),
    // A material of one hue was judged by a channel that overshoots before its brightest one.
    ("cubic-one-hue", "cubic", [110, 150], 0, false),
];

/// Random cases that once broke a promise: family, seed and number.
const CASES: [(&str, u64, u64); 11] = [
    // Under three lights, each run of a transparent row stepped the walks of all lights.
    ("changes", 20_261_128_602, 1_425),
    // Under skies alone a glossy material has one hue. The oracle judged it in three channels.
    ("arithmetic", 777_031, 3_079),
    // Highlights at the corners of a texture were brighter than white under two lights, and were limited to it.
    ("arithmetic", 202_611_284_110, 41_096),
    // A spotlight is 100 times closer to a pixel than to the farthest corner, and the distance is walked with the bits of that.
    ("arithmetic", 992_300_001, 19_081),
    // A guard of the table of colours, far beyond white, overflowed.
    ("changes", 992_400_004, 9_540),
    // Highlights that cannot be seen were too steep for loops unless they were left out.
    ("sameness", 992_400_003, 2_496),
    // Highlights of more than 512 of 255 at a corner.
    ("arithmetic", 99_001, 4_506),
    // Levels at six nodes of a texture were rounded to an eighth, and a light that is far beyond white magnified that.
    ("arithmetic", 32_001, 10_634),
    // Under the sky alone one colour of `auto` follows from levels. The oracle took it from cosines.
    ("arithmetic", 64_002, 12_912),
    // The coordinates of a point that is seen far away have more bits than the fast fit of a plane.
    ("arithmetic", 64_008, 595),
    // The sum of two cosines of 1, of which one colour takes the mean, overflowed.
    ("budget", 64_011, 1_529),
];

#[test]
fn cases_that_once_broke_hold() {
    for (name, seed, number) in CASES {
        let family = families(None).into_iter().find(|family| family.name() == name).unwrap();
        let verdict = stress::judge(&*family, seed, number);
        assert!(!verdict.skipped && verdict.failure.is_none(), "{name}, case {number} of seed {seed}: {:?}", verdict.failure);
    }
}

#[test]
fn what_once_broke_holds() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("broken");
    for (name, method, size, frame, perspective_correct) in BROKEN {
        let stream = StreamBytes::from(&fs::read(folder.join(name).with_extension("tri")).unwrap()[..]);
        let shader = Shader::ALL.into_iter().find(|shader| shader.name() == method).unwrap();
        let case = Case { size, frame, style: Style { perspective_correct, ..shader.into() }, ..Case::new(stream) };
        let (figure, limit) = match method {
            "auto" => (budget::judge(&case).unwrap().share, 1.0),
            _ => (arithmetic::judge(&case).unwrap().error, arithmetic::LIMIT),
        };
        println!("{name:20} {figure:.3} of {limit}");
        assert!(figure <= limit, "{name}: {figure}, at most {limit} is right");
    }
}

/// More than half of the scenes of the family are hard, each in one or several ways.
#[test]
fn arithmetic_looks_where_it_is_hard() {
    let [mut cases, mut hard, mut steep, mut normals, mut local, mut near] = [0; 6];
    for number in 0..600 {
        let Some(case) = arithmetic::case(&mut Random::new(9, number)) else { continue };
        let stream = case.stream.parse().unwrap();
        let lengths: Vec<f32> =
            stream.triangles.iter().map(|triangle| NormalLength::from_bits(triangle.min_normal_length).to_num()).collect();
        let extreme = lengths.iter().filter(|&&length| !(1.0 / 64.0..0.999).contains(&length)).count();
        let features = [
            stream.materials[0].exponent > 256,
            2 * extreme > lengths.len(),
            stream.header.camera.viewer == VIEWER_LOCAL,
            stream.lights.iter().any(|light| light.kind == POINT),
        ];
        for (count, feature) in [&mut steep, &mut normals, &mut local, &mut near].into_iter().zip(features) {
            *count += u32::from(feature);
        }
        cases += 1;
        hard += u32::from(features.contains(&true));
    }
    println!("{cases} cases, {hard} hard: {steep} steep, {normals} with normals, {local} local, {near} near");
    assert!(cases > 590 && hard > cases / 2 && steep.min(normals).min(local).min(near) > cases / 4);
}

/// Cases are the same in every run and on every machine.
#[test]
fn a_case_is_known_by_its_seed_and_number() {
    for (number, expected) in [(0, 0x23D7_43BB_u32), (1, 0)] {
        let mut random = Random::new(7, number);
        let drawn = random.bits() as u32;
        let mut again = Random::new(7, number);
        assert_eq!(drawn, again.bits() as u32);
        // The first number of case 0 is written down: another generator would make other cases of all seeds.
        assert!(number != 0 || drawn == expected, "{drawn:#X}");
    }
}

/// A renderer that loses a triangle: the smallest stream that shows it has that triangle alone.
#[test]
fn failures_are_made_small() {
    struct Lost;
    impl Family for Lost {
        fn name(&self) -> &'static str {
            "lost"
        }
        fn about(&self) -> &'static str {
            "a scene has fewer than 5 triangles"
        }
        fn check(&self, random: &mut Random) -> Verdict {
            let wishes = scenes::Wishes { closed: true, unclipped: true, triangles: 300, hard: scenes::Hard::default() };
            let Some(case) = scenes::case(random, wishes) else { return Verdict::skipped() };
            let failure = self.fails(&case).then(|| "too many".to_owned());
            Verdict { failure, case: Some(case), ..Verdict::default() }
        }
        fn fails(&self, case: &Case) -> bool {
            case.stream.parse().is_ok_and(|stream| stream.triangles.len() >= 5)
        }
    }
    let summary = stress::run(&Lost, 1, 0, &|count| count < 1_000);
    let case = summary.breaks[0].case.clone().unwrap();
    let stream = case.stream.parse().unwrap();
    assert_eq!((stream.triangles.len(), stream.lights.len(), case.size, case.frame), (5, 0, [1, 1], 0));
}

/// A panic is a failure, and the others go on.
#[test]
fn panics_are_failures() {
    struct Panics;
    impl Family for Panics {
        fn name(&self) -> &'static str {
            "panics"
        }
        fn about(&self) -> &'static str {
            "case 3 is right"
        }
        fn check(&self, random: &mut Random) -> Verdict {
            assert!(random.pick(0..4) != 3, "as it should");
            Verdict::default()
        }
    }
    let summary = stress::run(&Panics, 1, 0, &|count| count < 1_000);
    assert!(summary.breaks.iter().any(|failure| failure.what.contains("as it should")) && summary.failures > 200);
}

/// Inputs that a fuzzer has found worth keeping break nothing.
#[test]
fn the_corpus_breaks_nothing() {
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fuzz/corpus");
    for (name, target) in fuzz::TARGETS {
        let mut files = 0;
        for entry in fs::read_dir(corpus.join(name)).unwrap() {
            let path = entry.unwrap().path();
            let bytes = fs::read(&path).unwrap();
            stress::guarded(|| target(&bytes)).unwrap_or_else(|what| panic!("{}: {what}", path.display()));
            files += 1;
        }
        println!("{name}: {files} files");
        assert!(files > 0, "no file for {name}");
    }
}

/// Seeds of the corpus are drawn, not refused: else the fuzzer would begin with nothing.
#[test]
fn seeds_are_drawn() {
    let mut drawn = 0;
    for number in 0..50 {
        let wishes = scenes::Wishes { closed: false, unclipped: false, triangles: 6, hard: scenes::Hard::default() };
        let moved = changes::case(&mut Random::new(3, number), 6).expect("poses in their range");
        for case in scenes::case(&mut Random::new(3, number), wishes).into_iter().chain(moved) {
            let bytes = fuzz::seed(&case);
            assert_eq!(fuzz::case(&bytes).map(|case| case.stream), Some(case.stream));
            drawn += 1;
        }
    }
    assert!(drawn > 80, "{drawn}");
}

/// Many texts of scenes are converted, and many are refused: a family that does one alone finds nothing.
#[test]
fn texts_are_converted_and_refused() {
    let texts = (0..300).map(|number| texts::text(&mut Random::new(3, number)));
    let converted = texts.filter(|text| texts::converted(text).unwrap().is_some()).count();
    println!("{converted} of 300 texts are converted");
    assert!((60..240).contains(&converted), "{converted}");
}

/// An error without a line, behind the last one, or of a whole page is a failure.
#[test]
fn errors_without_a_line_are_seen() {
    assert!(texts::is_placed("line 3: frames: 0 is not possible", 3));
    let page = format!("line 3: {}", "y".repeat(1_000));
    for said in ["frames: 0 is not possible", "line 4: frames: 0", "line 0: frames", &page] {
        assert!(!texts::is_placed(said, 3), "{said}");
    }
}

/// Random scenes cover their pictures: a family that draws nothing finds nothing.
#[test]
fn random_scenes_cover_pixels() {
    let wishes = scenes::Wishes { closed: false, unclipped: true, triangles: 200, hard: scenes::Hard::default() };
    let shares = (0..300).filter_map(|number| {
        let case = scenes::case(&mut Random::new(3, number), wishes)?;
        let counts = watertight::covered(&case.stream.parse().ok()?, case.size, case.frame)?;
        Some(counts.iter().filter(|&&count| count > 0).count() as f64 / counts.len() as f64)
    });
    let mut shares: Vec<f64> = shares.collect();
    shares.sort_by(f64::total_cmp);
    let quartiles = [1, 2, 3].map(|k| shares[shares.len() * k / 4]);
    let empty = shares.iter().filter(|&&share| share == 0.0).count();
    println!("{} scenes, {empty} of them empty, cover {quartiles:.3?} of their pictures", shares.len());
    assert!(shares.len() > 250 && empty < shares.len() / 20 && quartiles[1] > 0.1);
}

/// Most pixels are well-conditioned: elsewhere a wrong pixel may pass.
#[test]
fn arithmetic_judges_nearly_all_pixels_strictly() {
    let counts = (0..300).into_par_iter().map(|number| stress::judge(&arithmetic::Arithmetic, 3, number).counts);
    let [pixels, leniently, not_judged] = counts
        .filter_map(|counts| counts.try_into().ok())
        .reduce(|| [0; 3], |a: [u64; 3], b: [u64; 3]| std::array::from_fn(|k| a[k] + b[k]));
    println!("{pixels} pixels judged, {leniently} of them leniently, {not_judged} not");
    assert!(pixels > 200_000 && 10 * (pixels - leniently) > 9 * (pixels + not_judged));
}

/// A sphere under one light, with a highlight.
fn sphere() -> Case {
    let stream = microphong_sim::scene::load("sphere-168").unwrap().stream;
    Case { size: [80, 60], frame: 3, style: Shader::PHONG.into(), ..Case::new(stream) }
}

/// One pixel more or less, one count more: coverage is wrong.
#[test]
fn coverage_sees_a_wrong_pixel() {
    let (corners, rows) = ([[100, 90], [900, 400], [150, 1000]], 16);
    let mut counts = vec![0; coverage::WIDTH * coverage::HEIGHT];
    let drawn = coverage::draw(corners, rows, &mut counts);
    assert_eq!(coverage::judge(corners, rows, &counts, drawn), None);
    assert!(coverage::judge(corners, rows, &counts, drawn + 1).is_some());
    for pixel in [30 * coverage::WIDTH + 15, 0] {
        counts[pixel] ^= 1;
        assert!(coverage::judge(corners, rows, &counts, drawn).is_some(), "pixel {pixel}");
        counts[pixel] ^= 1;
    }
}

/// Triangles that are said to be thick lose what rounding turns to the front.
#[test]
fn watertight_sees_holes() {
    let bunny = microphong_sim::scene::load("bunny").unwrap().stream;
    let stream = watertight::on_background(&bunny);
    let case = |stream: &StreamBytes, frame| Case { size: [480; 2], frame, style: Shader::FLAT.into(), ..Case::new(stream.clone()) };
    let thick = thick(&stream);
    let frame = (0..120).find(|&frame| watertight::Watertight.fails(&case(&thick, frame))).expect("a hole");
    let found = watertight::judge(&case(&stream, frame)).unwrap();
    assert!(found.covered > 10_000 && (found.missing, found.extra) == (0, 0), "{found:?}");
}

/// An exponent of 51 is no exponent of 50.
#[test]
fn arithmetic_sees_another_exponent() {
    let case = sphere();
    let mut bytes = case.stream.as_bytes().to_vec();
    let stream = case.stream.parse().unwrap();
    let at = stream.materials.as_ptr() as usize - case.stream.as_bytes().as_ptr() as usize;
    let [material] = stream.materials else { panic!("one material") };
    let sharper = Material { exponent: material.exponent + 1, ..*material };
    bytes[at..][..size_of::<Material>()].copy_from_slice(sharper.as_bytes());
    seal(&mut bytes);
    let other = StreamBytes::from(&bytes[..]);
    for (stream, right) in [(&case.stream, true), (&other, false)] {
        let frame = Frame::new(stream.parse().unwrap(), (80, 60), case.frame);
        let error = arithmetic::of(&case, &frame, &frame.visible()).unwrap();
        assert_eq!(error <= arithmetic::LIMIT, right, "{error}");
    }
}

/// Gouraud shading keeps to no budget.
#[test]
fn budget_sees_another_method() {
    for (shader, right) in [(Shader::AUTO, true), (Shader::AUTO_LINEAR, true), (Shader::PHONG, true), (Shader::GOURAUD, false)] {
        let found = budget::judge(&Case { style: shader.into(), ..sphere() }).unwrap();
        assert_eq!(found.share <= 1.0, right, "{} {found:?}", shader.name());
    }
}

/// Under near lights, where `auto` has to be Phong shading, any difference is one too many.
#[test]
fn budget_sees_what_is_not_phong_under_near_lights() {
    let stream = microphong_sim::scene::load("dodecahedron").unwrap().stream;
    for (shader, right) in [(Shader::AUTO, true), (Shader::RENQ, false)] {
        let found = budget::judge(&Case { style: shader.into(), ..Case::new(stream.clone()) }).unwrap();
        assert_eq!(found.share <= 1.0, right, "{} {found:?}", shader.name());
    }
}

/// Whatever may be difficult for `auto` is among its cases, and it has something to choose.
#[test]
fn budget_has_scenes_of_all_kinds() {
    let (mut lights, mut exponents) = ([0; 9], [0; 11]);
    let (mut near, mut local, mut opposite, mut creased, mut triangles) = (0, 0, 0, 0, 0);
    let mut judged = [0; 2];
    for number in 0..300 {
        let case = budget::case(&mut Random::new(5, number)).unwrap();
        let stream = case.stream.parse().unwrap();
        lights[stream.lights.len()] += 1;
        exponents[stream.materials[0].exponent.ilog2() as usize] += 1;
        near += usize::from(stream.lights.iter().any(|light| light.kind == POINT));
        local += usize::from(stream.header.camera.viewer == VIEWER_LOCAL);
        triangles += stream.triangles.len();
        for length in stream.triangles.iter().map(|triangle| f64::from(NormalLength::from_bits(triangle.min_normal_length))) {
            opposite += usize::from(length < 1.0 / 64.0);
            creased += usize::from((1.0 / 64.0..0.7).contains(&length));
        }
        let found = budget::judge(&case).unwrap();
        judged = [judged[0] + found.triangles, judged[1] + found.cheaper];
    }
    println!("lights {lights:?}, exponents {exponents:?}, near {near}, local {local}");
    println!("{triangles} triangles, {opposite} opposite, {creased} creased, judged {judged:?}");
    assert!(lights[1..5].iter().chain(&exponents).all(|&scenes| scenes > 0) && near.min(local) > 20);
    assert!(opposite > triangles / 100 && creased > triangles / 20);
    // Pixels of half of them, and a seventh of these by a cheaper method.
    assert!(judged[0] > triangles as u64 / 2 && judged[1] > judged[0] / 7);
}

/// A plane whose steps are one unit of the last place too large.
#[test]
fn walks_see_a_unit_of_the_last_place() {
    #[derive(Clone, Copy)]
    struct Steep(Plane<1>, i32);
    impl Patch for Steep {
        type Walker = <Plane<1> as Patch>::Walker;
        fn jump(&mut self, rows: i32) {
            self.0.jump(rows);
        }
        fn step_row(&mut self) {
            self.0.step_row();
            self.0.jump(self.1);
        }
        fn enter(&self, x: i32) -> Self::Walker {
            self.0.enter(x)
        }
    }
    let gradients = Gradients::new([[0, 0], [400, 100], [50, 700]], [0, 0, 96, 80]).unwrap();
    let plane = Plane::fit::<15>(&gradients, &[[1000, 20_000, 300]], 16, [0]);
    assert!(!walks::drifts(Steep(plane, 0), 7, 9));
    assert!(walks::drifts(Steep(plane, 1), 7, 9));
}

/// The pose of the frame after.
#[test]
fn drift_sees_the_next_frame() {
    let case = sphere();
    let camera = case.stream.parse().unwrap().header.camera;
    let rows = |number| ModelView::new(&camera, number).rotation.map(|row| row.map(|c| f64::from(c) / f64::from(1 << 30)));
    assert!(drift::error(&ModelView::new(&camera, 5), &rows(5)) <= drift::LIMIT);
    assert!(drift::error(&ModelView::new(&camera, 6), &rows(5)) > drift::LIMIT);
}

/// A pixel, or a count, of another picture.
#[test]
fn sameness_sees_a_pixel_and_a_count() {
    let case = sphere();
    let (mut pixels, mut stats) = render::frame::<Rgb565>(case.stream.parse().unwrap(), case.pixels(), case.style, 60, 3).unwrap();
    let whole = (pixels.clone(), stats);
    assert_eq!(sameness::unequal((&pixels, &stats), (&whole.0, &whole.1)), None);
    pixels[80 * 30 + 40] = Rgb565::RED;
    assert!(sameness::unequal((&pixels, &stats), (&whole.0, &whole.1)).is_some());
    stats.pixels += 1;
    assert!(sameness::unequal((&whole.0, &stats), (&whole.0, &whole.1)).is_some());
}

/// The last of the rows that have changed is left as it was.
#[test]
fn changes_see_a_row_that_is_not_redrawn() {
    let one_less: changes::Limit = |frame| {
        let area = frame.area();
        let (top, rows) = (area.top_left.y as u32, area.size.height);
        frame.limit(top..top + rows.saturating_sub(1));
    };
    let cases = (0..60).filter_map(|number| changes::case(&mut Random::new(3, number), 60).unwrap());
    let (mut found, mut counts) = (0, [0; 4]);
    for case in cases {
        let whole = changes::judge(&case, changes::all).unwrap();
        let whole: [u64; 4] = Vec::from(whole.unwrap_or_default()).try_into().unwrap();
        counts = std::array::from_fn(|k| counts[k] + whole[k]);
        found += usize::from(changes::judge(&case, one_less).is_err());
    }
    println!("{counts:?}, {found} cases show it");
    // Each kind is there: frames, those in part, changes, and those refused.
    assert!(found > 5 && counts.iter().all(|&count| count > 10), "{counts:?}, {found}");
}

/// A renderer that sets up everything again in each row.
#[test]
fn cost_sees_what_is_done_for_each_row() {
    struct EachRow(Counters);
    impl Count for EachRow {
        fn count(&self, case: &Case) -> anyhow::Result<Option<u64>> {
            Ok(self.0.count(case)?.map(|instructions| instructions * u64::from(case.size[1])))
        }
    }
    assert!(!Cost(Counters::default()).fails(&sphere()));
    assert!(Cost(EachRow(Counters::default())).fails(&sphere()));
}

/// Counts scenes by every method, and prints [`cost::BOUNDS`] of them. Takes eight minutes on two processors.
#[test]
#[ignore = "it asserts nothing, and prints a table"]
fn costs_are_counted_anew() {
    let (counters, scenes, seed) = (Counters::default(), cases(250), seed());
    for shader in Shader::ALL {
        let [plain, antialiased] = [false, true].map(|antialias| {
            // Each scene as it is plainly, in perspective, and under near lights.
            let counted = (0..scenes).into_par_iter().filter_map(|number| {
                let case = cost::case(&mut Random::new(seed, number))?;
                let count = |near, perspective_correct| {
                    let style = Style { shader, antialias, perspective_correct, ..case.style };
                    let case = Case { stream: cost::lit(&case.stream, near)?, style, ..case };
                    Some((cost::Work::of(&case)?, counters.count(&case).unwrap()? as f64))
                };
                Some((count(false, false)?, count(true, false), [count(false, true), count(true, true)]))
            });
            let counted: Vec<_> = counted.collect();
            let plain = counted.iter().map(|((work, count), ..)| work.parts().map(|part| part * work.lights as f64 / count));
            let mut bound = Bound { parts: fitted(&plain.collect::<Vec<_>>()), perspective: 100, near: 0 };
            let share = |bound: Bound, (work, count): (cost::Work, f64)| MARGIN * count / work.instructions(bound);
            let mut most = 1;
            for (work, count) in counted.iter().filter_map(|&(_, near, _)| near).filter(|(work, _)| work.near > 0) {
                let more = (share(bound, (work, count)) - 1.0) * work.lights as f64 / work.near as f64;
                most = most.max(more.ceil() as u32);
            }
            bound.near = most;
            for scene in counted.iter().flat_map(|&(.., perspective)| perspective).flatten() {
                bound.perspective = bound.perspective.max((share(Bound { perspective: 100, ..bound }, scene) * 100.0).ceil() as u32);
            }
            bound
        });
        let [plain, antialiased] = [plain, antialiased].map(|b| format!("at_most({:?}, {}, {})", b.parts, b.perspective, b.near));
        println!("    ({:?}, {plain}, {antialiased}),", shader.name());
    }
}

/// Ratio of the bounds to the cost of the worst scene.
const MARGIN: f64 = 6.0;

/// A bound of [`MARGIN`] times what each scene takes, at least, and of as little as can be on the whole. `scenes` are the parts of each,
/// over its instructions. Rounded up to two digits.
fn fitted(scenes: &[[f64; cost::PARTS]]) -> [u32; cost::PARTS] {
    let share =
        |bound: &[f64; cost::PARTS], scene: &[f64; cost::PARTS]| bound.iter().zip(scene).map(|(bound, part)| bound * part).sum::<f64>();
    let mut bound = [1.0; cost::PARTS];
    // The least sum of s + s^-8 / 8 over all scenes, where s is the bound over the instructions: the second term grows fast where that is below
    // 1. Where the derivative by a number vanishes, its factor here is 1.
    for _ in 0..1_000 {
        let (mut pull, mut push) = ([0.0; cost::PARTS], [1e-12; cost::PARTS]);
        for scene in scenes {
            let weight = share(&bound, scene).powi(-9);
            for (k, part) in scene.iter().enumerate() {
                pull[k] += part * weight;
                push[k] += part;
            }
        }
        (0..cost::PARTS).for_each(|k| bound[k] *= (pull[k] / push[k]).powf(1.0 / 9.0));
    }
    let least = scenes.iter().map(|scene| share(&bound, scene)).fold(f64::MAX, f64::min);
    bound.map(|bound| {
        let bound = MARGIN * bound / least;
        let digit = 10f64.powf((bound.log10().floor() - 1.0).max(0.0));
        ((bound / digit).ceil() * digit) as u32
    })
}

/// A frame that is drawn in part with smooth outlines: two bands of which different columns are wanted, so that the row that one holds for the other
/// has to have the columns of both. It was wrong in this case of the family.
#[test]
fn rows_that_are_held_have_the_columns_of_the_next_band() {
    let case = changes::case(&mut Random::new(991_200_004, 5814), 60).unwrap().unwrap();
    let found = changes::judge(&case, changes::all).expect("the picture of a new renderer");
    assert!(found.is_some() && case.style.antialias);
}
