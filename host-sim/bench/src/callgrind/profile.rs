//! Profiles of callgrind: executions of each instruction, and costs of calls.

use anyhow::{Context, Result, bail};
use std::collections::{BTreeMap, HashMap};

/// Profile of one frame.
#[derive(Debug, Default, PartialEq, Eq)]
pub(crate) struct Profile {
    pub(super) functions: Vec<Function>,
    /// Number of all executed instructions.
    pub(crate) total: u64,
}

/// A function and everything that it did itself.
#[derive(Debug, Default, PartialEq, Eq)]
pub(super) struct Function {
    /// The function's name in the source.
    pub(super) name: String,
    /// The function's name in the symbol table. No other function has it.
    pub(super) symbol: String,
    /// Executions of each instruction, by address.
    pub(super) executions: BTreeMap<u64, u64>,
    pub(super) calls: Vec<Call>,
    pub(super) jumps: Vec<Jump>,
}

impl Function {
    /// Pairs of instructions that were executed one after the other.
    pub(super) fn ways(&self) -> impl Iterator<Item = (u64, u64)> {
        let taken: HashMap<u64, u64> = self.jumps.iter().map(|jump| (jump.from, jump.count)).collect();
        let following = self.executions.iter().zip(self.executions.keys().skip(1));
        // Unless it always jumps.
        let on = following.filter(move |((from, count), _)| taken.get(from).is_none_or(|&taken| taken < **count));
        let jumps = self.jumps.iter().filter(|jump| jump.count > 0);
        on.map(|((&from, _), &to)| (from, to)).chain(jumps.map(|jump| (jump.from, jump.to)))
    }
}

/// Jumps from one instruction to another within a function.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Jump {
    pub(super) from: u64,
    pub(super) to: u64,
    pub(super) count: u64,
}

/// Calls from one instruction to one function.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Call {
    /// Address of the instruction.
    pub(super) from: u64,
    /// Symbol of the called function.
    pub(super) to: String,
    pub(super) count: u64,
    /// Instructions until the function returned.
    pub(super) cost: u64,
}

impl Profile {
    /// Reads the format of callgrind 1, neither names nor positions compressed.
    pub(super) fn parse(text: &str) -> Result<Self> {
        let mut profile = Self::default();
        let (mut called, mut calls, mut jump) = (String::new(), None, None);
        let address = |text: &str| u64::from_str_radix(text.trim().trim_start_matches("0x"), 16);
        for (line, number) in text.lines().zip(1..) {
            let wrong = || format!("line {number} of callgrind's profile: {line}");
            if let Some(symbol) = line.strip_prefix("fn=") {
                // `'2` is the function called by itself.
                let mangled = symbol.split_once('\'').map_or(symbol, |(symbol, _)| symbol);
                let name = format!("{:#}", rustc_demangle::demangle(mangled));
                profile.functions.push(Function { name, symbol: symbol.to_owned(), ..Function::default() });
            } else if let Some(symbol) = line.strip_prefix("cfn=") {
                symbol.clone_into(&mut called);
            } else if let Some(count) = line.strip_prefix("calls=") {
                calls = Some(count.split(' ').next().unwrap_or_default().parse().with_context(wrong)?);
            } else if let Some(text) = line.strip_prefix("jump=").or_else(|| line.strip_prefix("jcnd=")) {
                // `count target`, or `count/executions target`.
                let (count, to) = text.split_once(' ').with_context(wrong)?;
                let count = count.split('/').next().unwrap_or_default().parse().with_context(wrong)?;
                jump = Some((count, address(to).with_context(wrong)?));
            } else if let Some(total) = line.strip_prefix("totals: ") {
                profile.total = total.trim().parse().with_context(wrong)?;
            } else if line.starts_with("0x") {
                let function = profile.functions.last_mut().with_context(wrong)?;
                if let Some((count, to)) = jump.take() {
                    function.jumps.push(Jump { from: address(line).with_context(wrong)?, to, count });
                    continue;
                }
                let (from, cost) = line.split_once(' ').with_context(wrong)?;
                let (from, cost) = (address(from).with_context(wrong)?, cost.trim().parse().with_context(wrong)?);
                match calls.take() {
                    Some(count) => function.calls.push(Call { from, to: called.clone(), count, cost }),
                    None => *function.executions.entry(from).or_default() += cost,
                }
            } else if line.starts_with(['+', '-', '*']) {
                bail!("compressed position in {}", wrong());
            }
        }
        profile.functions.sort_by(|a, b| a.symbol.cmp(&b.symbol));
        // A function that callgrind has met in several places has several parts.
        profile.functions.dedup_by(|part, function| {
            let same = part.symbol == function.symbol;
            if same {
                function.executions.append(&mut part.executions);
                function.calls.append(&mut part.calls);
                function.jumps.append(&mut part.jumps);
            }
            same
        });
        Ok(profile)
    }

    pub(super) fn function(&self, symbol: &str) -> Option<&Function> {
        let index = self.functions.binary_search_by(|function| function.symbol.as_str().cmp(symbol)).ok()?;
        self.functions.get(index)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "\
# callgrind format
version: 1
positions: instr
events: Ir
summary: 41

ob=/bin/frame
fl=???
fn=outer
0x10 1
cfn=_ZN4core3ptr4read17h0123456789abcdefE
calls=3 0x40
0x12 30
0x14 1

fn=_ZN4core3ptr4read17h0123456789abcdefE
0x40 3
0x42 27

fn=outer
0x20 9

totals: 41
";

    #[test]
    fn executions_and_calls_are_told_apart() {
        let profile = Profile::parse(TEXT).expect("a profile");
        assert_eq!(profile.total, 41);
        assert_eq!(profile.functions.iter().flat_map(|function| function.executions.values()).sum::<u64>(), 41);
        let outer = profile.function("outer").expect("the caller");
        assert_eq!(outer.executions.values().copied().collect::<Vec<_>>(), [1, 1, 9], "the cost of a call is not the caller's own");
        let called = &outer.calls[0];
        assert_eq!((called.count, called.cost), (3, 30));
        assert_eq!(profile.function(&called.to).expect("the function called").name, "core::ptr::read");
    }

    #[test]
    fn what_cannot_be_read_is_named() {
        for (line, text) in [(5, TEXT.replace("summary: 41", "+3 7")), (10, TEXT.replace("0x10 1", "0x10 one"))] {
            let error = format!("{:#}", Profile::parse(&text).expect_err("no profile"));
            assert!(error.contains(&format!("line {line} ")), "{error}");
        }
    }
}
