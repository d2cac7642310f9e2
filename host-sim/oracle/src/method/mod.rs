//! The methods by name.

pub(crate) mod angular;
mod auto;
mod blinn;
mod cubic;
mod duff;
mod environment;
mod flat;
mod goldman;
mod gouraud;
mod gouraud4;
mod highlight_test;
mod phong_rv;
mod pseudo_phong;
mod renq;
mod renq_newton;
mod six_point;
mod six_point_adaptive;
mod six_point_centre;
mod slerp;
mod sqrt6;
mod taylor;
mod taylor_finite;

use super::{
    Facet, Frame, Levels, Shade,
    light::phong,
    texture::{painted, painted_whole},
};
pub use auto::chosen;
use std::{cell::RefCell, fmt};

/// Whether a threshold is exceeded, given by how much.
type Decide<'f> = dyn Fn(f64) -> bool + 'f;

/// A method's way to shade one triangle, and to decide.
type Build = for<'f> fn(&'f Frame, &'f Facet, &'f Decide<'f>) -> Shade<'f>;

/// Properties of a method.
struct Method {
    name: &'static str,
    /// Only for lights and a viewer that are infinitely far.
    constant: bool,
    /// Whether the method compares something with a threshold.
    decides: bool,
    /// Whether the method interpolates along rows of the screen.
    rows: bool,
    /// Whether the method interpolates the sum of all light, so that a texture colours highlights as well.
    whole: bool,
    build: Build,
}

/// A method for every scene that decides nothing.
const fn any(name: &'static str, build: Build) -> Method {
    Method { name, constant: false, decides: false, rows: false, whole: false, build }
}

/// A method for lights and a viewer that are infinitely far.
const fn constant(name: &'static str, build: Build) -> Method {
    Method { constant: true, ..any(name, build) }
}

/// A method that takes decisions.
const fn deciding(name: &'static str, build: Build) -> Method {
    Method { decides: true, ..any(name, build) }
}

/// A method that interpolates the sum of all light.
const fn whole(method: Method) -> Method {
    Method { whole: true, ..method }
}

/// A method that knows rows of the screen, and nothing of perspective.
const fn by_rows(method: Method) -> Method {
    Method { rows: true, ..method }
}

const METHODS: [Method; 28] = [
    deciding("auto", auto::shade::<true>),
    deciding("auto-linear", auto::shade::<false>),
    any("flat", |frame, facet, _| flat::shade(frame, facet)),
    any("gouraud", |frame, facet, _| gouraud::shade(frame, facet)),
    whole(any("gouraud4", |frame, facet, _| gouraud4::shade(frame, facet))),
    whole(any("pseudo-phong", |frame, facet, _| pseudo_phong::shade(frame, facet))),
    deciding("highlight-test", highlight_test::shade),
    any("six-point", |frame, facet, _| six_point::shade(frame, facet)),
    whole(deciding("six-point-centre", six_point_centre::shade)),
    whole(deciding("six-point-adaptive", six_point_adaptive::shade)),
    whole(any("cubic", |frame, facet, _| cubic::shade(frame, facet))),
    any("sqrt6", |frame, facet, _| sqrt6::shade(frame, facet)),
    any("renq", |frame, facet, _| renq::shade(frame, facet)),
    any("renq-newton", |frame, facet, _| renq_newton::shade(frame, facet)),
    any("duff", |frame, facet, _| duff::shade(frame, facet)),
    constant("taylor", |frame, facet, _| taylor::shade(frame, facet)),
    any("taylor-finite", |frame, facet, _| taylor_finite::shade(frame, facet)),
    any("phong", |frame, facet, _| phong(frame, facet)),
    any("phong-rv", |frame, facet, _| phong_rv::shade(frame, facet)),
    any("environment", |frame, facet, _| environment::shade(frame, facet)),
    any("blinn", |frame, facet, _| blinn::linear(frame, facet)),
    any("quadratic-blinn", |frame, facet, _| blinn::quadratic(frame, facet)),
    by_rows(constant("goldman", |frame, facet, _| goldman::shade(frame, facet))),
    by_rows(constant("slerp", |frame, facet, _| slerp::shade(frame, facet))),
    by_rows(deciding("angular", |frame, facet, decide| angular::angular(frame, facet, angular::refitted, decide))),
    by_rows(deciding("hybrid", |frame, facet, decide| angular::hybrid(frame, facet, angular::refitted, decide))),
    by_rows(deciding("angular-original", |frame, facet, decide| angular::angular(frame, facet, angular::printed, decide))),
    by_rows(deciding("hybrid-original", |frame, facet, decide| angular::hybrid(frame, facet, angular::printed, decide))),
];

/// The names of all methods.
pub const NAMES: [&str; METHODS.len()] = {
    let mut names = [""; METHODS.len()];
    let mut k = 0;
    while k < names.len() {
        names[k] = METHODS[k].name;
        k += 1;
    }
    names
};

/// Why a method cannot draw a scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Unsupported {
    /// No method has this name.
    Unknown(String),
    /// The method needs directions that are the same everywhere, and a light or the viewer is near.
    Near(&'static str),
    /// The method interpolates along rows of the screen, and the facet is to be seen in perspective.
    Perspective(&'static str),
}

impl fmt::Display for Unsupported {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unknown(name) => write!(f, "unknown method {name:?}; name one of: {}", NAMES.join(", ")),
            Self::Near(name) => write!(f, "{name} cannot draw point lights or a local viewer: its directions are constant"),
            Self::Perspective(name) => write!(f, "{name} cannot interpolate light in perspective"),
        }
    }
}

impl std::error::Error for Unsupported {}

fn find(name: &str) -> Option<&'static Method> {
    static TABLE: [Method; METHODS.len()] = METHODS;
    TABLE.iter().find(|method| method.name == name)
}

impl Method {
    /// The method of this name, if it can draw this facet of this frame.
    fn of(name: &str, frame: &Frame, facet: &Facet) -> Result<&'static Self, Unsupported> {
        let method = find(name).ok_or_else(|| Unsupported::Unknown(name.to_owned()))?;
        if method.constant && !frame.is_constant() {
            return Err(Unsupported::Near(method.name));
        }
        if method.rows && facet.shares != [1.0; 3] {
            return Err(Unsupported::Perspective(method.name));
        }
        Ok(method)
    }
}

impl Method {
    /// The shading of a facet, with a texture or without.
    fn shade<'f>(&'f self, frame: &'f Frame, facet: &'f Facet, decide: &'f Decide<'f>) -> Shade<'f> {
        let plain = |facet: &Facet, p| (self.build)(frame, facet, decide)(p);
        match &facet.texture {
            None => (self.build)(frame, facet, decide),
            Some(texture) if self.whole => painted_whole(frame, facet, texture, plain),
            Some(texture) => painted(facet, texture, plain),
        }
    }
}

/// The shading of `facet` by a method.
///
/// # Errors
/// When there is no such method, or when it cannot draw this frame.
pub fn method<'f>(name: &str, frame: &'f Frame, facet: &'f Facet) -> Result<Shade<'f>, Unsupported> {
    Ok(Method::of(name, frame, facet)?.shade(frame, facet, &|excess| excess > 0.0))
}

/// Largest number of results that [`outcomes`] returns. Eight close decisions have as many. More can occur on small parts of a triangle, where
/// light hardly differs between edges. Each close decision doubles the number.
pub const MOST_OUTCOMES: usize = 1 << 8;

/// All results that a method may have at a point of `facet` in an arithmetic with errors of up to `margin` levels where it decides, see
/// [`Frame::undecided`]: every combination of decisions that are this close, of which at most [`MOST_OUTCOMES`] are returned. The first is the exact
/// result.
///
/// # Errors
/// When there is no such method, or when it cannot draw this frame.
pub fn outcomes(name: &str, frame: &Frame, facet: &Facet, point: [f64; 2], margin: f64) -> Result<Vec<Levels>, Unsupported> {
    let method = Method::of(name, frame, facet)?;
    let mut outcomes = Vec::new();
    // The close decisions on the way to an outcome: as they were taken, and whether that was the second time.
    let mut close: Vec<(bool, bool)> = Vec::new();
    loop {
        let way = RefCell::new((std::mem::take(&mut close), 0));
        let decide = |excess: f64| {
            let exceeded = excess > 0.0;
            if excess.abs() > margin {
                return exceeded;
            }
            let (close, next) = &mut *way.borrow_mut();
            *next += 1;
            if let Some(&(taken, _)) = close.get(*next - 1) {
                return taken;
            }
            close.push((exceeded, false));
            exceeded
        };
        outcomes.push(method.shade(frame, facet, &decide)(point));
        (close, _) = way.into_inner();
        if outcomes.len() == MOST_OUTCOMES {
            return Ok(outcomes);
        }
        // The last one that was taken once is taken the other way.
        while close.pop_if(|(_, again)| *again).is_some() {}
        match close.last_mut() {
            Some(last) => *last = (!last.0, true),
            None => return Ok(outcomes),
        }
    }
}

/// Whether the method takes decisions by a threshold, so that it may have several [`outcomes`].
#[must_use]
pub fn decides(name: &str) -> bool {
    find(name).is_some_and(|method| method.decides)
}
