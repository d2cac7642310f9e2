//! Names beside points, so that none covers another.

/// A rectangle: left, top, right, bottom.
type Box = [f64; 4];

/// Size of a letter as browsers choose it, thin and bold.
const LETTER: [(f64, f64); 2] = [(6.1, 10.5), (6.9, 10.5)];
/// Radius of a point, with some air.
const POINT: f64 = 4.5;
/// Distances of labels from their points, in the order in which they are tried.
const DISTANCES: [f64; 12] = [6.0, 11.0, 17.0, 24.0, 32.0, 42.0, 54.0, 68.0, 84.0, 104.0, 128.0, 156.0];
/// Directions tried, right first.
const DIRECTIONS: usize = 16;

/// A label and its place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Label {
    /// The place where the text's base line starts, ends or has its middle, as `anchor` says. This is the side towards the point, so that a text of
    /// unexpected width does not cover it.
    pub(super) text: (f64, f64),
    /// The `text-anchor` of the text.
    pub(super) anchor: &'static str,
    /// The end of a line from the point to its label; `None` if the label is beside the point.
    pub(super) leader: Option<(f64, f64)>,
}

fn overlap(a: Box, b: Box) -> bool {
    a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]
}

/// A point that wants its name beside it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Named<'n> {
    pub(super) at: (f64, f64),
    pub(super) name: &'n str,
    pub(super) bold: bool,
}

impl Named<'_> {
    fn size(&self) -> (f64, f64) {
        let (width, height) = LETTER[usize::from(self.bold)];
        (self.name.chars().count() as f64 * width, height)
    }
}

/// The text's box `distance` away from `point` in a direction: its nearest side or corner is that far.
fn placed((x, y): (f64, f64), (width, height): (f64, f64), direction: usize, distance: f64) -> Box {
    let (s, c) = (std::f64::consts::TAU * direction as f64 / DIRECTIONS as f64).sin_cos();
    let middle = [x + c * (distance + width / 2.0), y + s * (distance + height / 2.0)];
    [middle[0] - width / 2.0, middle[1] - height / 2.0, middle[0] + width / 2.0, middle[1] + height / 2.0]
}

/// The point at which a line from `from` to the middle of `target` meets the box.
fn edge((x, y): (f64, f64), target: Box) -> (f64, f64) {
    (x.clamp(target[0], target[2]), y.clamp(target[1], target[3]))
}

/// Whether a line passes through a box.
fn crosses(from: (f64, f64), to: (f64, f64), area: Box) -> bool {
    (1..16).map(|i| f64::from(i) / 16.0).any(|t| {
        let (x, y) = (from.0 + (to.0 - from.0) * t, from.1 + (to.1 - from.1) * t);
        overlap([x, y, x, y], area)
    })
}

/// Places a name at each point inside `frame`, off the `lines` if possible, which run across or down. Points come first in the
/// choice that come first in the list.
pub(super) fn place(points: &[Named<'_>], lines: &[[(f64, f64); 2]], frame: Box) -> Vec<Label> {
    let lines: Vec<Box> = lines.iter().map(|[a, b]| [a.0.min(b.0), a.1.min(b.1), a.0.max(b.0), a.1.max(b.1)]).collect();
    let dots: Vec<Box> = points.iter().map(|&Named { at: (x, y), .. }| [x - POINT, y - POINT, x + POINT, y + POINT]).collect();
    let mut taken: Vec<Box> = Vec::new();
    let mut leaders: Vec<[(f64, f64); 2]> = Vec::new();
    let mut labels = Vec::new();
    for named in points {
        let point = named.at;
        let candidates = DISTANCES.iter().flat_map(|&distance| (0..DIRECTIONS).map(move |direction| (direction, distance)));
        let penalty = |(direction, distance): (usize, f64)| {
            let area = placed(point, named.size(), direction, distance);
            let outside = area[0] < frame[0] || area[1] < frame[1] || area[2] > frame[2] || area[3] > frame[3];
            let end = edge(point, area);
            let covered = taken.iter().filter(|other| overlap(area, **other)).count();
            let hidden = lines.iter().filter(|line| overlap(area, **line)).count();
            let hidden = hidden + dots.iter().filter(|dot| overlap(area, **dot)).count();
            let struck = leaders.iter().filter(|[from, to]| crosses(*from, *to, area)).count()
                + if distance > DISTANCES[1] { taken.iter().filter(|other| crosses(point, end, **other)).count() } else { 0 };
            let worst = 1e6 * covered as f64 + 1e4 * hidden as f64 + 300.0 * struck as f64 + if outside { 1e7 } else { 0.0 };
            // Beside a point is better than above it.
            let turn = direction % (DIRECTIONS / 2);
            (worst + distance + 0.4 * turn.min(DIRECTIONS / 2 - turn) as f64, area, distance)
        };
        let best = candidates.map(penalty).min_by(|a, b| a.0.total_cmp(&b.0));
        let Some((_, area, distance)) = best else { continue };
        let end = edge(point, area);
        let leader = (distance > DISTANCES[1]).then_some(end);
        taken.push(area);
        leaders.extend(leader.map(|end| [point, end]));
        let (x, anchor) = if area[2] < point.0 {
            (area[2], "end")
        } else if area[0] > point.0 {
            (area[0], "start")
        } else {
            ((area[0] + area[2]) / 2.0, "middle")
        };
        labels.push(Label { text: (x, area[3] - 2.2), anchor, leader });
    }
    labels
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const FRAME: Box = [0.0, 0.0, 430.0, 330.0];
    const NAMES: [&str; 26] = [
        "flat",
        "gouraud",
        "six-point",
        "phong",
        "phong-rv",
        "gouraud4",
        "pseudo-phong",
        "highlight-test",
        "goldman",
        "slerp",
        "duff",
        "taylor",
        "taylor-finite",
        "six-point-adaptive",
        "six-point-centre",
        "cubic",
        "angular",
        "angular-original",
        "hybrid",
        "hybrid-original",
        "environment",
        "blinn",
        "quadratic-blinn",
        "sqrt6",
        "renq",
        "renq-newton",
    ];

    fn thin(at: (f64, f64), name: &'static str) -> Named<'static> {
        Named { at, name, bold: false }
    }

    fn boxes(points: &[Named<'_>]) -> Vec<Box> {
        let place = |(label, named): (Label, &Named<'_>)| {
            let (width, height) = named.size();
            let (x, y) = label.text;
            let left = match label.anchor {
                "start" => x,
                "middle" => x - width / 2.0,
                _ => x - width,
            };
            [left, y + 2.2 - height, left + width, y + 2.2]
        };
        super::place(points, &[], FRAME).into_iter().zip(points).map(place).collect()
    }

    #[test]
    fn a_lonely_point_has_its_name_at_its_right() {
        let [label] = place(&[thin((100.0, 100.0), "phong")], &[], FRAME)[..] else { panic!("one label") };
        assert!(label.text.0 > 104.0 && label.text.0 < 112.0 && label.leader.is_none(), "{label:?}");
    }

    #[test]
    fn a_name_does_not_lie_on_a_line() {
        let [label] = place(&[thin((100.0, 100.0), "phong")], &[[(100.0, 100.0), (300.0, 100.0)]], FRAME)[..] else { panic!("one label") };
        assert!((label.text.1 - 100.0).abs() > 2.2, "{label:?}");
    }

    proptest! {
        #[test]
        fn names_stay_inside_and_cover_no_other(places in prop::array::uniform26((10.0..420.0f64, 10.0..320.0f64)), crowded in 0usize..12) {
            let mut places = places;
            // Some of them nearly in the same place.
            for (i, place) in places.iter_mut().enumerate().take(crowded) {
                *place = (200.0 + i as f64 % 3.0, 150.0 + i as f64 / 2.0);
            }
            let points: Vec<_> = places.into_iter().zip(NAMES).map(|(at, name)| thin(at, name)).collect();
            let boxes = boxes(&points);
            for (i, a) in boxes.iter().enumerate() {
                prop_assert!(a[0] > FRAME[0] - 1e-6 && a[1] > FRAME[1] - 1e-6 && a[2] < FRAME[2] + 1e-6 && a[3] < FRAME[3] + 1e-6);
                for b in &boxes[i + 1..] {
                    let inner = [a[0] + 1e-6, a[1] + 1e-6, a[2] - 1e-6, a[3] - 1e-6];
                    prop_assert!(!overlap(inner, *b));
                }
            }
        }
    }
}
