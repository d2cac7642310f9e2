//! A profile by stages.

use super::{
    super::{
        nest::Nest,
        stage::{Part, Stages, part},
    },
    profile::Profile,
};
use anyhow::{Result, ensure};
use std::collections::HashMap;

/// Instructions by stage, and rows of triangles.
pub(super) fn stages(profile: &Profile) -> Result<(Stages, u64)> {
    let helpers = Helpers::of(profile);
    let mut stages = Stages::default();
    let mut spans = 0;
    for function in &profile.functions {
        let part = part(&function.name);
        let nest = match (part, function.executions.first_key_value()) {
            (Part::Row, Some((&entry, _))) => {
                Nest::new(entry, function.ways(), |address| function.executions.get(&address).copied().unwrap_or(0))
            }
            _ => Nest::default(),
        };
        spans += nest.rows;
        let own = function.executions.iter().map(|(&address, &count)| (address, count));
        let calls = function.calls.iter().map(|call| (call.from, helpers.own_cost(&call.to, call.cost)));
        for (address, cost) in own.chain(calls) {
            match part {
                Part::Frame => stages.frame += cost,
                Part::Vertex => stages.vertex += cost,
                Part::Cull => stages.cull += cost,
                Part::Setup => stages.setup += cost,
                Part::Row if nest.inner.contains(&address) => stages.pixel += cost,
                Part::Row => stages.span += cost,
                Part::Clear => stages.clear += cost,
                Part::Edges => stages.edges += cost,
                Part::Output => stages.output += cost,
                Part::Transfer | Part::Idle | Part::Outside | Part::Unwatched | Part::Callers => {}
            }
        }
    }
    ensure!(spans > 0, "no function that fills a row is known by its name, or nothing was drawn");
    Ok((stages, spans))
}

/// Functions that work for their callers.
struct Helpers<'p> {
    profile: &'p Profile,
    /// Entries of each function, and instructions until it returned.
    entered: HashMap<&'p str, (u64, u64)>,
}

impl<'p> Helpers<'p> {
    fn of(profile: &'p Profile) -> Self {
        let mut entered: HashMap<&str, (u64, u64)> = HashMap::new();
        for call in profile.functions.iter().flat_map(|function| &function.calls) {
            let (count, cost) = entered.entry(&call.to).or_default();
            *count += call.count;
            *cost += call.cost;
        }
        Self { profile, entered }
    }

    /// The part of `cost`, the instructions spent in calls of the function `symbol`, that belongs to its caller. It is nothing if the function has a
    /// stage of its own. A helper's calls of such functions are left out; all else of it is shared out among its callers.
    fn own_cost(&self, symbol: &str, cost: u64) -> u64 {
        self.share(symbol, cost, &mut Vec::new())
    }

    /// `path` is what has called the function.
    fn share<'a>(&'a self, symbol: &'a str, cost: u64, path: &mut Vec<&'a str>) -> u64 {
        let Some(function) = self.profile.function(symbol).filter(|_| !path.contains(&symbol)) else { return cost };
        if part(&function.name) != Part::Callers {
            return 0;
        }
        path.push(symbol);
        let elsewhere: u64 = function.calls.iter().map(|call| call.cost - self.share(&call.to, call.cost, path)).sum();
        path.pop();
        let all = self.entered.get(symbol).map_or(0, |(_, cost)| *cost).max(1);
        (u128::from(cost) * u128::from(all.saturating_sub(elsewhere)) / u128::from(all)) as u64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A frame that draws two triangles of three rows and 45 pixels; `memcpy` works for whoever calls it.
    const TEXT: &str = "\
fn=microphong::mesh::vertices::VertexStage::transform
0x1 50
cfn=memcpy
calls=1 0x90
0x2 5
fn=microphong::frame::part::FrameRows::draw
0x3 20
cfn=microphong::raster::band::Band<C>::clear
calls=1 0x80
0x4 1000
cfn=helper
calls=2 0x70
0x5 656
fn=helper
0x6 6
cfn=microphong::raster::triangle::fill_rows
calls=2 0x60
0x7 650
fn=microphong::raster::triangle::fill_rows
0x60 2
0x61 6
cfn=memcpy
calls=6 0x90
0x61 14
0x62 45
cfn=memcpy
calls=45 0x90
0x62 88
0x63 45
cfn=microphong::method::cosines::quotient::tone
calls=45 0xa0
0x63 444
jcnd=39/45 0x62
0x63
0x64 6
jcnd=4/6 0x61
0x64
fn=microphong::method::cosines::quotient::tone
0xa0 444
fn=microphong::raster::band::Band<C>::clear
0x80 1000
fn=memcpy
0x90 107
totals: 1731
";

    #[test]
    fn each_instruction_goes_to_one_stage() {
        let profile = Profile::parse(TEXT).expect("a profile");
        let (stages, spans) = stages(&profile).expect("stages");
        let expected = Stages { vertex: 55, cull: 0, setup: 26, span: 28, pixel: 622, clear: 1000, ..Stages::default() };
        assert_eq!(stages, expected);
        assert_eq!(spans, 6);
        assert_eq!(stages.drawing() + stages.clear, profile.total);
    }

    #[test]
    fn a_frame_without_rows_is_an_error() {
        let profile = Profile::parse("fn=microphong::frame::part::FrameRows::draw\n0x3 20\n").expect("a profile");
        assert!(stages(&profile).is_err());
    }
}
