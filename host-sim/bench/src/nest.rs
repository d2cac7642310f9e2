//! Loops within loops of a function, by the ways that were taken through it: what belongs to a pixel and what to a row.

use petgraph::{algo::tarjan_scc, graphmap::DiGraphMap};
use std::collections::HashSet;

/// A function that fills rows.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Nest {
    /// Instructions of the inner loop, of one pixel.
    pub(super) inner: HashSet<u64>,
    /// Rows: rounds of the loop around it. A function that is called for each row has none.
    pub(super) rows: u64,
}

impl Nest {
    /// The loops of a function that begins at `entry`. `ways` are its jumps from one instruction to another; `count` tells how often an instruction
    /// is executed.
    pub(super) fn new(entry: u64, ways: impl Iterator<Item = (u64, u64)>, count: impl Fn(u64) -> u64) -> Self {
        let graph: DiGraphMap<u64, ()> = ways.collect();
        let (mut nest, mut alone) = (Self::default(), HashSet::new());
        for around in loops(&graph) {
            let body: HashSet<u64> = around.iter().copied().collect();
            let is_head = |node: u64| node == entry || graph.neighbors_directed(node, petgraph::Incoming).any(|from| !body.contains(&from));
            // Without the ways back to its head what is left of a loop are the loops in it.
            let within = graph.all_edges().filter(|&(from, to, _)| body.contains(&from) && body.contains(&to) && !is_head(to));
            let inner = loops(&within.map(|(from, to, _)| (from, to)).collect());
            if inner.is_empty() {
                alone.extend(body);
            } else {
                nest.inner.extend(inner.into_iter().flatten());
                nest.rows += around.iter().filter(|&&node| is_head(node)).map(|&node| count(node)).max().unwrap_or(0);
            }
        }
        if nest.inner.is_empty() { Self { inner: alone, rows: count(entry) } } else { nest }
    }
}

/// The nodes of each loop.
fn loops(graph: &DiGraphMap<u64, ()>) -> Vec<Vec<u64>> {
    let mut found = tarjan_scc(graph);
    found.retain(|nodes| nodes.len() > 1 || nodes.iter().any(|&node| graph.contains_edge(node, node)));
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two rows, of three pixels and of none, two of them hidden: 0 enters, 1 to 5 are the row, 3 the pixel, 4 its colour.
    #[test]
    fn pixels_are_told_from_rows() {
        let counts = [1, 2, 1, 3, 1, 2, 1];
        let ways = [(0, 1), (1, 2), (1, 5), (2, 3), (3, 4), (3, 3), (4, 3), (3, 5), (5, 1), (5, 6)];
        let nest = Nest::new(0, ways.into_iter(), |node| counts[node as usize]);
        assert_eq!(nest, Nest { inner: HashSet::from([3, 4]), rows: 2 });
    }

    /// A function that is called once for each row counts as a row.
    #[test]
    fn a_call_may_be_a_row() {
        let counts = [2, 2, 1, 3, 1, 2];
        let ways = [(0, 1), (1, 2), (1, 5), (2, 3), (3, 4), (3, 3), (4, 3), (3, 5)];
        let nest = Nest::new(0, ways.into_iter(), |node| counts[node as usize]);
        assert_eq!(nest, Nest { inner: HashSet::from([3, 4]), rows: 2 });
    }
}
