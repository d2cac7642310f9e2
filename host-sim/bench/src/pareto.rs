//! The front of points that no other point beats.

/// Indices of the points that have no other with both coordinates at most theirs and one of them less, in order of the first
/// coordinate.
#[must_use]
pub fn front(points: &[(f64, f64)]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|&a, &b| points[a].0.total_cmp(&points[b].0).then(points[a].1.total_cmp(&points[b].1)));
    let mut front: Vec<usize> = Vec::new();
    for index in order {
        let better = front.last().is_none_or(|&last| points[index].1 < points[last].1 || points[index] == points[last]);
        if better {
            front.push(index);
        }
    }
    front
}

#[cfg(test)]
mod tests {
    use super::front;
    use proptest::prelude::*;

    #[test]
    fn cheap_and_wrong_to_dear_and_right() {
        let points = [(40.0, 0.3), (20.0, 8.0), (30.0, 1.0), (35.0, 1.0), (21.0, 9.0), (20.0, 8.0), (90.0, 0.3)];
        assert_eq!(front(&points), [1, 5, 2, 0]);
        assert_eq!(front(&[]), [0; 0]);
    }

    proptest! {
        #[test]
        fn nobody_beats_the_front_and_the_front_beats_all_others(points in prop::collection::vec((0u8..12, 0u8..12), 0..24)) {
            let points: Vec<(f64, f64)> = points.into_iter().map(|(x, y)| (x.into(), y.into())).collect();
            let front = front(&points);
            let beaten = |p: &(f64, f64)| points.iter().any(|q| q.0 <= p.0 && q.1 <= p.1 && q != p);
            for (index, point) in points.iter().enumerate() {
                prop_assert_eq!(front.contains(&index), !beaten(point));
            }
        }
    }
}
