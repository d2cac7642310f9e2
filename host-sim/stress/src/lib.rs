//! What looks for failures: random cases, exact oracles, and the smallest case that still fails.
//!
//! A [`Family`] makes cases of one kind and judges them by means that share no code with what they judge. The same families serve the
//! command `microphong stress`, the tests and the fuzz targets. Case `n` of a seed is the same whatever was run before it, so that a
//! failure is found again by its seed and number.

pub mod arithmetic;
pub mod budget;
pub mod case;
pub mod change;
pub mod changes;
pub mod cost;
pub mod coverage;
pub mod drift;
pub mod fuzz;
pub mod hostile;
pub mod random;
pub mod sameness;
pub mod scenes;
pub mod shrink;
pub mod tiles;
pub mod walks;
pub mod watertight;

use case::Case;
use microphong::format::ErrorBudget;
use random::Random;
use serde::{Serialize, Serializer};
use std::{
    any::Any,
    cell::Cell,
    panic::{self, AssertUnwindSafe},
    sync::{
        Once,
        atomic::{AtomicBool, AtomicU64, Ordering},
    },
    thread,
};

/// Cases of one kind, and how they are judged.
pub trait Family: Sync {
    /// The name on the command line.
    fn name(&self) -> &'static str;

    /// What is asserted, in a sentence.
    fn about(&self) -> &'static str;

    /// What [`Verdict::worst`] is a figure of, and the largest that is right; `None` if cases are right or wrong.
    fn limit(&self) -> Option<(f64, &'static str)> {
        None
    }

    /// What [`Verdict::counts`] are numbers of.
    fn counts(&self) -> &'static [&'static str] {
        &[]
    }

    /// Makes a case and judges it.
    fn check(&self, random: &mut Random) -> Verdict;

    /// Whether a case is wrong; for those whose failures can be made smaller.
    fn fails(&self, _case: &Case) -> bool {
        false
    }
}

/// What came of one case.
#[derive(Clone, Debug, Default)]
pub struct Verdict {
    /// The figure that [`Family::limit`] limits.
    pub worst: f64,
    /// How many of each of [`Family::counts`] were judged in this case.
    pub counts: Vec<u64>,
    /// The random numbers made no case that can be judged.
    pub skipped: bool,
    /// What is wrong, if anything is.
    pub failure: Option<String>,
    /// The scene, if there is one.
    pub case: Option<Case>,
}

impl Verdict {
    /// No case.
    #[must_use]
    pub fn skipped() -> Self {
        Self { skipped: true, ..Self::default() }
    }

    /// Judges a figure.
    #[must_use]
    pub fn of(worst: f64, limit: f64, case: Option<Case>) -> Self {
        let failure = (worst > limit || worst.is_nan()).then(|| format!("{worst:.4}, at most {limit} is right"));
        Self { worst, failure, case, ..Self::default() }
    }
}

/// Every family; with a `budget`, that of the same name keeps to it in all cases.
#[must_use]
pub fn families(budget: Option<ErrorBudget>) -> Vec<Box<dyn Family>> {
    vec![
        Box::new(coverage::Coverage),
        Box::new(watertight::Watertight),
        Box::new(arithmetic::Arithmetic),
        Box::new(budget::Budget(budget)),
        Box::new(walks::Walks),
        Box::new(drift::Drift),
        Box::new(sameness::Sameness),
        Box::new(changes::Changes),
        Box::new(hostile::Hostile),
    ]
}

/// What a family came to.
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    /// The family.
    pub family: &'static str,
    /// The seed of its cases.
    pub seed: u64,
    /// Cases that were judged.
    pub cases: u64,
    /// Random numbers that made no case.
    pub skipped: u64,
    /// What was judged in these cases, if the family counts it: names and numbers.
    #[serde(serialize_with = "as_map")]
    pub counts: Vec<(&'static str, u64)>,
    /// The worst figure, and its limit.
    pub worst: Option<f64>,
    /// The largest figure that is right.
    pub limit: Option<f64>,
    /// What the figure is of.
    pub unit: &'static str,
    /// Cases that are wrong.
    pub failures: u64,
    /// The first of them.
    #[serde(skip)]
    pub first: Option<Failure>,
}

/// Names and numbers as a map.
fn as_map<S: Serializer>(counts: &[(&'static str, u64)], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(counts.iter().copied())
}

/// A case that is wrong.
#[derive(Clone, Debug)]
pub struct Failure {
    /// Its number.
    pub number: u64,
    /// What is wrong.
    pub what: String,
    /// Its scene.
    pub case: Option<Case>,
}

/// Runs cases of `family` from number `first` on, on all processors, as long as none fails and `goes_on` after so many, which is asked before
/// each.
#[must_use]
pub fn run(family: &dyn Family, seed: u64, first: u64, goes_on: &(dyn Fn(u64) -> bool + Sync)) -> Summary {
    quiet();
    let (next, stop) = (AtomicU64::new(0), AtomicBool::new(false));
    let work = || {
        let (mut cases, mut skipped, mut worst, mut failures) = (0, 0, 0f64, Vec::new());
        let mut counts = vec![0; family.counts().len()];
        while !stop.load(Ordering::Relaxed) {
            let count = next.fetch_add(1, Ordering::Relaxed);
            if !goes_on(count) {
                break;
            }
            let number = first.wrapping_add(count);
            let verdict = judge(family, seed, number);
            cases += u64::from(!verdict.skipped);
            skipped += u64::from(verdict.skipped);
            worst = worst.max(verdict.worst);
            counts.iter_mut().zip(&verdict.counts).for_each(|(sum, count)| *sum += count);
            if let Some(what) = verdict.failure {
                stop.store(true, Ordering::Relaxed);
                failures.push(Failure { number, what, case: verdict.case });
            }
        }
        (cases, skipped, counts, worst, failures)
    };
    let parts: Vec<_> = thread::scope(|scope| {
        let threads: Vec<_> = (0..thread::available_parallelism().map_or(1, usize::from)).map(|_| scope.spawn(work)).collect();
        threads.into_iter().map(|thread| thread.join().expect("cases are judged behind a guard")).collect()
    });
    let mut summary = Summary {
        family: family.name(),
        seed,
        cases: 0,
        skipped: 0,
        counts: family.counts().iter().map(|&name| (name, 0)).collect(),
        worst: None,
        limit: family.limit().map(|(limit, _)| limit),
        unit: family.limit().map_or("", |(_, unit)| unit),
        failures: 0,
        first: None,
    };
    let mut failures = Vec::new();
    for (cases, skipped, counts, worst, failed) in parts {
        summary.cases += cases;
        summary.skipped += skipped;
        summary.counts.iter_mut().zip(counts).for_each(|((_, sum), count)| *sum += count);
        if summary.limit.is_some() {
            summary.worst = Some(summary.worst.unwrap_or(0.0).max(worst));
        }
        failures.extend(failed);
    }
    summary.failures = failures.len() as u64;
    summary.first = failures.into_iter().min_by_key(|failure| failure.number).map(|failure| shrunk(family, failure));
    summary
}

/// Judges one case of a seed; a panic is a failure.
#[must_use]
pub fn judge(family: &dyn Family, seed: u64, number: u64) -> Verdict {
    let mut random = Random::new(seed, number);
    guarded(|| family.check(&mut random)).unwrap_or_else(|what| Verdict { failure: Some(what), ..Verdict::default() })
}

/// A failure whose scene is as small as can be.
fn shrunk(family: &dyn Family, failure: Failure) -> Failure {
    let fails = |case: &Case| guarded(|| family.fails(case)).unwrap_or(true);
    let case = failure.case.map(|case| if fails(&case) { shrink::smallest(case, &fails) } else { case });
    Failure { case, ..failure }
}

thread_local! {
    static GUARDED: Cell<bool> = const { Cell::new(false) };
}

/// `f`, or what it panicked with.
///
/// # Errors
/// What it panicked with.
pub fn guarded<T>(f: impl FnOnce() -> T) -> Result<T, String> {
    let before = GUARDED.replace(true);
    let result = panic::catch_unwind(AssertUnwindSafe(f)).map_err(|payload| format!("panicked: {}", message(&*payload)));
    GUARDED.set(before);
    result
}

fn message(payload: &(dyn Any + Send)) -> String {
    let text = payload.downcast_ref::<&str>().map(|text| (*text).to_owned());
    text.or_else(|| payload.downcast_ref::<String>().cloned()).unwrap_or_default()
}

/// Panics of guarded threads are reported as failures, and are not printed as well.
fn quiet() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let hook = panic::take_hook();
        panic::set_hook(Box::new(move |info| {
            if !GUARDED.get() {
                hook(info);
            }
        }));
    });
}
