//! Texts of scenes: random ones, with numbers out of range, and with lines and bytes that nobody meant.

use crate::{Family, Verdict, case::Case, random::Random, scenes};
use microphong_models::{bytes::StreamBytes, script};
use microphong_render::shader::Shader;

/// Random texts of scenes.
pub struct Texts;

/// Values that are seldom right.
const ODD: [&str; 24] = [
    "nan",
    "inf",
    "-inf",
    "0",
    "-0.0",
    "-1",
    "1e-320",
    "1e308",
    "16",
    "16.0001",
    "-16",
    "170",
    "65535",
    "65536",
    "4294967296",
    "99999999999999999999",
    "0x1F",
    "0.999999",
    "true",
    "\"\"",
    "[]",
    "[[1]]",
    "{}",
    "1979-05-27",
];

/// The text of a random scene; it may be wrong, and hold bytes that are no text.
#[must_use]
pub fn text(random: &mut Random) -> Vec<u8> {
    let odd = random.among(&[0, 0, 50, 400]);
    let mut bytes = Writer { random, odd }.scene().into_bytes();
    if random.once_in(3) {
        for _ in 0..random.pick(1..4) {
            damage(random, &mut bytes);
        }
    }
    bytes
}

/// Writes the fields of a scene, one value of `odd` as it should not be; none if that is 0.
struct Writer<'a> {
    random: &'a mut Random,
    odd: i32,
}

impl Writer<'_> {
    fn is_odd(&mut self) -> bool {
        self.odd > 0 && self.random.once_in(self.odd)
    }

    fn number(&mut self, from: f64, to: f64) -> String {
        if self.is_odd() { self.random.among(&ODD).to_owned() } else { format!("{:.3}", self.random.between(from, to)) }
    }

    fn integer(&mut self, from: i32, to: i32) -> String {
        if self.is_odd() { self.random.among(&ODD).to_owned() } else { self.random.pick(from..to + 1).to_string() }
    }

    fn list(&mut self, count: usize, from: f64, to: f64) -> String {
        let count = if self.is_odd() { self.random.pick(0..6) as usize } else { count };
        format!("[{}]", (0..count).map(|_| self.number(from, to)).collect::<Vec<_>>().join(", "))
    }

    fn colour(&mut self) -> String {
        if self.is_odd() { "\"red\"".to_owned() } else { format!("\"{:06x}\"", self.random.bits() & 0xFF_FFFF) }
    }

    /// Fields that are always there, followed by some of the others.
    fn with(&mut self, fields: Vec<String>, others: Vec<String>) -> Vec<String> {
        let others: Vec<_> = others.into_iter().filter(|_| self.random.once_in(2)).collect();
        fields.into_iter().chain(others).collect()
    }

    fn scene(&mut self) -> String {
        let size = format!("[{}, {}]", self.integer(1, 400), self.integer(1, 400));
        let background =
            if self.random.once_in(2) { self.colour() } else { format!("{{ top = {}, bottom = {} }}", self.colour(), self.colour()) };
        let shader = self.random.among(&Shader::ALL).name();
        let optional = vec![
            format!("size = {size}"),
            format!("background = {background}"),
            format!("shader = \"{shader}\""),
            format!("budget = {}", self.number(0.5, 16.0)),
        ];
        let required = vec![format!("frames = {}", self.integer(1, 200))];
        let mut lines = self.with(required, optional);
        lines.push("[camera]".to_owned());
        lines.extend(self.camera());
        for _ in 0..self.random.pick(0..3) {
            lines.push("[[light]]".to_owned());
            lines.extend(self.light());
        }
        let meshes = self.random.pick(1..4);
        for number in 0..meshes {
            lines.push("[[mesh]]".to_owned());
            lines.extend(self.mesh(number));
        }
        for _ in 0..self.random.pick(1..5) {
            lines.push(format!("[[object]]\nmesh = \"m{}\"", self.random.pick(0..meshes)));
            let keys = self.keys(Self::pose);
            lines.extend(if self.random.once_in(2) { keys } else { self.pose() });
        }
        if self.random.once_in(8) {
            lines.push("[outlines]".to_owned());
            let optional = vec![format!("colour = {}", self.colour()), "alone = true".to_owned()];
            lines.extend(self.with(Vec::new(), optional));
        }
        for _ in 0..self.random.pick(0..3) {
            lines.push("[[label]]".to_owned());
            lines.extend(self.label());
        }
        lines.join("\n") + "\n"
    }

    fn camera(&mut self) -> Vec<String> {
        let eye = |writer: &mut Self| {
            let at = format!("at = [{}, {}, {}]", writer.number(-2.0, 2.0), writer.number(-2.0, 2.0), writer.number(2.0, 8.0));
            let target = format!("looks-at = {}", writer.list(3, -1.0, 1.0));
            writer.with(vec![at], vec![target])
        };
        let view = format!("view = {}", self.number(1.0, 169.0));
        let (near, up) = (format!("near = {}", self.number(0.02, 4.0)), format!("up = {}", self.list(3, -1.0, 1.0)));
        let mut fields = eye(self);
        if self.random.once_in(3) {
            fields.extend(self.keys(eye));
        }
        self.with(fields, vec![view, near, up])
    }

    fn light(&mut self) -> Vec<String> {
        let name = self.random.among(&["towards", "at"]);
        let vector = |writer: &mut Self| vec![format!("{name} = {}", writer.list(3, -4.0, 4.0))];
        let colour = format!("colour = {}", self.colour());
        let mut fields = vector(self);
        if self.random.once_in(3) {
            fields.extend(self.keys(vector));
        }
        self.with(fields, vec![colour])
    }

    fn mesh(&mut self, number: i32) -> Vec<String> {
        let shape = self.random.among(&["box", "cylinder", "sphere", "torus"]);
        let optional = vec![
            format!("size = {}", self.list(3, 0.01, 1.1)),
            format!("tube = {}", self.number(0.01, 0.99)),
            format!("centre = {}", self.list(3, -0.3, 0.3)),
            format!("colour = {}", self.colour()),
            "plastic = true".to_owned(),
            format!("exponent = {}", self.integer(1, 1024)),
            format!("crease = {}", self.number(0.0, 180.0)),
        ];
        self.with(vec![format!("name = \"m{number}\""), format!("shape = \"{shape}\"")], optional)
    }

    fn pose(&mut self) -> Vec<String> {
        let most = self.random.octaves(10.0, 4_000.0);
        let mut fields = match self.random.pick(0..4) {
            0 => vec![],
            1 => vec![format!("axis = {}", self.list(3, -1.0, 1.0)), format!("angle = {}", self.number(-most, most))],
            2 => vec![format!("euler = {}", self.list(3, -most, most))],
            _ => vec![format!("quaternion = {}", self.list(4, -1.0, 1.0))],
        };
        if self.random.once_in(20) {
            fields.push("hidden = true".to_owned());
        }
        let optional = vec![format!("at = {}", self.list(3, -2.0, 2.0)), format!("scale = {}", self.number(0.0625, 2.0))];
        self.with(fields, optional)
    }

    fn keys(&mut self, fields: impl Fn(&mut Self) -> Vec<String>) -> Vec<String> {
        let mut frame = self.random.pick(0..10);
        let mut keys = Vec::new();
        for _ in 0..self.random.pick(1..6) {
            let number = self.integer(frame, frame);
            keys.push(format!("    {{ frame = {number}, {} }},\n", fields(self).join(", ")));
            frame += if self.random.once_in(30) { self.random.pick(1..9_000) } else { self.random.pick(1..60) };
        }
        vec![format!("keys = [\n{}]", keys.concat())]
    }

    fn label(&mut self) -> Vec<String> {
        let align = self.random.among(&["left", "middle", "right"]);
        let text = self.random.among(&["a", "oil °C", "0123456789", "\\u0007", "Ω"]);
        let optional =
            vec![format!("align = \"{align}\""), format!("height = {}", self.number(6.0, 40.0)), format!("colour = {}", self.colour())];
        let required = vec![format!("text = \"{text}\""), format!("at = {}", self.list(2, -20.0, 400.0))];
        self.with(required, optional)
    }
}

/// A byte, a value, a line or the end is not as it was.
fn damage(random: &mut Random, bytes: &mut Vec<u8>) {
    let at = random.pick(0..bytes.len().max(1) as i32) as usize;
    let mut lines: Vec<Vec<u8>> = bytes.split(|&byte| byte == b'\n').map(<[u8]>::to_vec).collect();
    let line = random.pick(0..lines.len() as i32) as usize;
    match random.pick(0..6) {
        0 => {
            if let Some(byte) = bytes.get_mut(at) {
                *byte ^= 1 << random.pick(0..8);
            }
            return;
        }
        1 => return bytes.truncate(at),
        2 => drop(lines.remove(line)),
        3 => lines.insert(line, lines[line].clone()),
        4 => {
            let other = random.pick(0..lines.len() as i32) as usize;
            lines.swap(line, other);
        }
        _ => {
            let end = lines[line].iter().position(|&byte| byte == b'=').map_or(0, |end| end + 1);
            lines[line].truncate(end);
            lines[line].extend_from_slice(random.among(&ODD).as_bytes());
        }
    }
    *bytes = lines.join(&b'\n');
}

/// The stream of a text; `None` if the text is refused.
///
/// # Errors
/// When the message of the refusal names no line, or is long.
pub fn converted(bytes: &[u8]) -> Result<Option<StreamBytes>, String> {
    match script::of_bytes(bytes, None, &|_| ()) {
        Ok((stream, _)) => Ok(Some(stream)),
        Err(error) => {
            let said = format!("{error:#}");
            let lines = 1 + bytes.iter().filter(|&&byte| byte == b'\n').count();
            if is_placed(&said, lines) { Ok(None) } else { Err(format!("an error names no line, or is long: {said}")) }
        }
    }
}

/// Whether an error begins with the number of one of `lines` lines, and is short.
#[must_use]
pub fn is_placed(said: &str, lines: usize) -> bool {
    let line = said.strip_prefix("line ").and_then(|rest| rest.split_once(':')).and_then(|(line, _)| line.parse().ok());
    line.is_some_and(|line: usize| (1..=lines).contains(&line)) && said.len() < 1_000
}

impl Family for Texts {
    fn name(&self) -> &'static str {
        "scenes"
    }

    fn about(&self) -> &'static str {
        "a scene text gives an error that names the line, or is drawn without a panic"
    }

    fn counts(&self) -> &'static [&'static str] {
        &["converted"]
    }

    fn check(&self, random: &mut Random) -> Verdict {
        match converted(&text(random)) {
            Err(what) => Verdict { failure: Some(what), counts: vec![0], ..Verdict::default() },
            Ok(None) => Verdict { counts: vec![0], ..Verdict::default() },
            Ok(Some(stream)) => {
                let width = random.between(1.0, 100.0);
                let size = scenes::size(random, width);
                let case = scenes::styled(random, stream, size);
                // Kept before it is drawn: a panic must not lose it.
                let failure = crate::guarded(|| drop(case.draw())).err();
                Verdict { failure, case: Some(case), counts: vec![1], ..Verdict::default() }
            }
        }
    }

    fn fails(&self, case: &Case) -> bool {
        crate::guarded(|| drop(case.draw())).is_err()
    }
}
