//! Search for failures: random cases, exact oracles, and the smallest case that still fails.
//!
//! A [`Family`] makes cases of one kind and judges them by code that it does not share with the renderer. The command `microphong stress`, the tests
//! and the fuzz targets use the families. Case `n` of a seed does not depend on the cases before it, so seed and number find a failure again.

pub mod arithmetic;
pub mod budget;
pub mod case;
pub mod change;
pub mod changes;
mod colours;
pub mod cost;
pub mod coverage;
pub mod drift;
pub mod fuzz;
pub mod hostile;
pub mod random;
pub mod readers;
pub mod records;
pub mod sameness;
pub mod scenes;
pub mod shrink;
pub mod texts;
mod textures;
pub mod tiles;
mod transparency;
pub mod walks;
pub mod watertight;

use case::Case;
use microphong::format::ErrorBudget;
use random::Random;
use serde::{Serialize, Serializer};
use std::{
    any::Any,
    cell::Cell,
    collections::BTreeMap,
    panic::{self, AssertUnwindSafe},
    sync::{
        Once,
        atomic::{AtomicU64, Ordering},
    },
    thread,
};

/// Cases of one kind, and how they are judged.
pub trait Family: Sync {
    /// The name on the command line.
    fn name(&self) -> &'static str;

    /// The assertion of the family, in a sentence.
    fn about(&self) -> &'static str;

    /// The largest allowed value of [`Verdict::worst`], and its unit; `None` if cases are just right or wrong.
    fn limit(&self) -> Option<(f64, &'static str)> {
        None
    }

    /// Names of the numbers in [`Verdict::counts`].
    fn counts(&self) -> &'static [&'static str] {
        &[]
    }

    /// Makes a case and judges it.
    fn check(&self, random: &mut Random) -> Verdict;

    /// Whether a case is wrong. Families implement it whose failures can be made smaller.
    fn fails(&self, _case: &Case) -> bool {
        false
    }
}

/// The result of a case.
#[derive(Clone, Debug, Default)]
pub struct Verdict {
    /// The figure that [`Family::limit`] limits.
    pub worst: f64,
    /// For each of [`Family::counts`], how many were judged in this case.
    pub counts: Vec<u64>,
    /// The kind of the case, such as the method that drew it, in families that distinguish kinds.
    pub kind: &'static str,
    /// The random numbers made no case that can be judged.
    pub skipped: bool,
    /// The fault, if there is any.
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

/// All families. With a `budget`, the family of this name keeps to it in all cases.
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
        Box::new(texts::Texts),
    ]
}

/// The results of a family.
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
    /// Names and numbers of what was judged in these cases, if the family counts it.
    #[serde(serialize_with = "as_map")]
    pub counts: Vec<(&'static str, u64)>,
    /// The worst figure, and its limit.
    pub worst: Option<f64>,
    /// The largest figure that is right.
    pub limit: Option<f64>,
    /// Unit of the figure.
    pub unit: &'static str,
    /// Number of cases that are wrong.
    pub failures: u64,
    /// The results of each kind of case, by name.
    pub kinds: Vec<Kind>,
    /// The worst failure of each kind.
    #[serde(skip)]
    pub breaks: Vec<Failure>,
}

/// The results of the cases of one kind.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Kind {
    /// Name of the kind, such as the method's.
    pub name: &'static str,
    /// Cases that were judged.
    pub cases: u64,
    /// The worst figure.
    pub worst: f64,
    /// The number of its case.
    pub number: u64,
    /// Cases that are wrong.
    pub failures: u64,
    /// The worst of them; the first if it has no figure.
    #[serde(skip)]
    failure: Option<Failure>,
}

impl Kind {
    /// Adds the verdict of case `number`.
    fn add(&mut self, number: u64, verdict: Verdict) {
        let Verdict { worst, failure, case, .. } = verdict;
        self.join(Self {
            name: self.name,
            cases: 1,
            worst,
            number,
            failures: failure.is_some().into(),
            failure: failure.map(|what| Failure { number, worst, what, case }),
        });
    }

    /// Adds the results of other cases of this kind.
    fn join(&mut self, other: Self) {
        self.cases += other.cases;
        self.failures += other.failures;
        if self.cases == other.cases || (other.worst, self.number) > (self.worst, other.number) {
            (self.worst, self.number) = (other.worst, other.number);
        }
        if let Some(theirs) = other.failure {
            let is_worse = |ours: &Failure| (theirs.worst, ours.number) > (ours.worst, theirs.number);
            if self.failure.as_ref().is_none_or(is_worse) {
                self.failure = Some(theirs);
            }
        }
    }
}

/// Names and numbers as a map.
fn as_map<S: Serializer>(counts: &[(&'static str, u64)], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(counts.iter().copied())
}

/// A case that is wrong.
#[derive(Clone, Debug)]
pub struct Failure {
    /// Number of the case.
    pub number: u64,
    /// The figure of the case, if the family has one.
    worst: f64,
    /// The fault.
    pub what: String,
    /// The scene of the case.
    pub case: Option<Case>,
}

/// Runs cases of `family` from number `first` on, on all processors, as long as `goes_on` returns true; it is called with the number of cases before
/// each. A failure does not end the run, so that one kind of failure does not hide another.
#[must_use]
pub fn run(family: &dyn Family, seed: u64, first: u64, goes_on: &(dyn Fn(u64) -> bool + Sync)) -> Summary {
    quiet();
    let next = AtomicU64::new(0);
    let work = || {
        let (mut skipped, mut kinds) = (0, BTreeMap::new());
        let mut counts = vec![0; family.counts().len()];
        loop {
            let count = next.fetch_add(1, Ordering::Relaxed);
            if !goes_on(count) {
                return (skipped, counts, kinds);
            }
            let number = first.wrapping_add(count);
            let verdict = judge(family, seed, number);
            if verdict.skipped {
                skipped += 1;
                continue;
            }
            counts.iter_mut().zip(&verdict.counts).for_each(|(sum, count)| *sum += count);
            let name = verdict.kind;
            kinds.entry(name).or_insert_with(|| Kind { name, ..Kind::default() }).add(number, verdict);
        }
    };
    let parts: Vec<_> = thread::scope(|scope| {
        let threads: Vec<_> = (0..thread::available_parallelism().map_or(1, usize::from)).map(|_| scope.spawn(work)).collect();
        threads.into_iter().map(|thread| thread.join().expect("cases are judged behind a guard")).collect()
    });
    let mut kinds = BTreeMap::new();
    let mut counts: Vec<_> = family.counts().iter().map(|&name| (name, 0)).collect();
    let mut skipped = 0;
    for (none, some, part) in parts {
        skipped += none;
        counts.iter_mut().zip(some).for_each(|((_, sum), count)| *sum += count);
        for (name, kind) in part {
            kinds.entry(name).or_insert_with(|| Kind { name, ..Kind::default() }).join(kind);
        }
    }
    let mut kinds: Vec<Kind> = kinds.into_values().collect();
    Summary {
        family: family.name(),
        seed,
        cases: kinds.iter().map(|kind| kind.cases).sum(),
        skipped,
        counts,
        worst: family.limit().map(|_| kinds.iter().map(|kind| kind.worst).fold(0.0, f64::max)),
        limit: family.limit().map(|(limit, _)| limit),
        unit: family.limit().map_or("", |(_, unit)| unit),
        failures: kinds.iter().map(|kind| kind.failures).sum(),
        breaks: kinds.iter_mut().filter_map(|kind| kind.failure.take()).map(|failure| shrunk(family, failure)).collect(),
        kinds,
    }
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

/// Calls `f` and catches a panic.
///
/// # Errors
/// The message of the panic.
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
