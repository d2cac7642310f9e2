//! Verdicts on the papers' claims, compared with the design notes.

use microphong_sim::papers::{
    Claim, Topic, Value,
    Verdict::{self, Close, Confirmed, NotReproducible, Refuted},
    claims,
};
use std::collections::HashSet;

/// The figure that we expect.
#[derive(Clone, Copy, Debug)]
enum Ours {
    /// The figure of the design notes, up to a tolerance.
    Near(f64, f64),
    /// A figure from a lowest to a largest value, where the notes give a range or only an order of magnitude.
    Within(f64, f64),
    /// The difference of two things that are the same.
    Same,
    /// A text.
    Text(&'static str),
    /// A random example's: the verdict already says that the corrected formula gives what direct evaluation gives.
    Example,
}
use Ours::{Example, Near, Same, Text, Within};

/// All claims in their order.
#[rustfmt::skip]
const EXPECTED: &[(&str, Verdict, Ours)] = &[
    // Vlasic 2002, table 6.1, triangle.
    ("colour correctness of Gouraud (G)", Close, Near(0.653, 0.001)),
    ("colour correctness of quadratic (Q)", Close, Near(0.844, 0.001)),
    ("colour correctness of cubic (C)", Close, Near(0.858, 0.001)),
    ("colour correctness of environment map (E)", Close, Near(0.474, 0.001)),
    ("colour correctness of Blinn map (B)", Close, Near(0.873, 0.001)),
    ("colour correctness of quadratic Blinn map (QB)", Close, Near(0.949, 0.001)),
    ("order, best first", Close, Text("QB>B>C>Q>G>E")),
    ("pairs out of order, best n of 3 to 64", Close, Near(1.0, 0.0)),
    // Vlasic 2002, table 6.1, teapot.
    ("colour correctness of Gouraud (G)", Close, Within(0.98, 1.0)),
    ("colour correctness of quadratic (Q)", NotReproducible, Within(0.98, 1.0)),
    ("colour correctness of cubic (C)", NotReproducible, Within(0.98, 1.0)),
    ("colour correctness of environment map (E)", NotReproducible, Within(0.98, 1.0)),
    ("colour correctness of Blinn map (B)", NotReproducible, Within(0.98, 1.0)),
    ("colour correctness of quadratic Blinn map (QB)", NotReproducible, Within(0.98, 1.0)),
    ("order, best first", Close, Text("QB>C>Q>B>E>G")),
    // Vlasic 2002, 4.2, 4.3, appendix A.
    ("quadratic through six values, in s and t", Confirmed, Same),
    ("cubic through ten values, in s and t", Confirmed, Same),
    // Vlasic 2002, forward differencing.
    ("in s and t: relative error over 256 pixels", Refuted, Within(0.0, 1e-07)),
    // Vlasic 2002, 5, texture maps.
    ("quadratic Blinn, arc of 10 degrees: (u,v) off by", Refuted, Near(4.25e-05, 2.13e-06)),
    ("quadratic Blinn, arc of 30 degrees: (u,v) off by", Refuted, Near(0.0011484, 5.742e-05)),
    ("quadratic Blinn, arc of 60 degrees: (u,v) off by", Refuted, Near(0.009187, 0.00045935)),
    ("quadratic Blinn, arc of 90 degrees: (u,v) off by", Refuted, Near(0.0310063, 0.00155031)),
    ("environment maps cannot hold Blinn's highlight", Refuted, Within(0.0, 1e-12)),
    // Vlasic 2002, appendix B.
    ("(N·H)² from u and v, u not normalised", Refuted, Example),
    // Szirmay-Kalos et al. 2000, figures, spheres.
    ("168 triangles, n = 5: Gouraud is wrong by", Confirmed, Near(26.0, 0.5)),
    ("168 triangles, n = 5: quadratic is wrong by", Close, Near(6.8, 0.05)),
    ("168 triangles, n = 5: better than Gouraud by", Confirmed, Near(8.488372093023255, 0.1)),
    ("168 triangles, n = 50: Gouraud is wrong by", Confirmed, Near(85.0, 0.5)),
    ("168 triangles, n = 50: quadratic is wrong by", Refuted, Near(33.0, 0.5)),
    ("168 triangles, n = 50: better than Gouraud by", Confirmed, Near(2.944444444444444, 0.05)),
    ("374 triangles, n = 5: Gouraud is wrong by", Confirmed, Within(10.2, 26.0)),
    ("374 triangles, n = 5: quadratic is wrong by", Close, Within(2.55, 6.8)),
    ("374 triangles, n = 5: better than Gouraud by", Confirmed, Within(8.0, 11.0)),
    ("374 triangles, n = 50: Gouraud is wrong by", Confirmed, Near(63.0, 0.5)),
    ("374 triangles, n = 50: quadratic is wrong by", Refuted, Near(20.0, 0.5)),
    ("374 triangles, n = 50: better than Gouraud by", Confirmed, Near(4.5, 0.2)),
    ("690 triangles, n = 5: Gouraud is wrong by", Close, Within(5.0, 15.0)),
    ("690 triangles, n = 5: quadratic is wrong by", Close, Within(1.0, 4.0)),
    ("690 triangles, n = 5: better than Gouraud by", Confirmed, Within(9.0, 12.0)),
    ("690 triangles, n = 50: Gouraud is wrong by", Confirmed, Near(34.0, 0.5)),
    ("690 triangles, n = 50: quadratic is wrong by", Close, Near(9.3, 0.05)),
    ("690 triangles, n = 50: better than Gouraud by", Confirmed, Near(5.25, 0.2)),
    // Szirmay-Kalos et al. 2000, adaptive subdivision.
    ("test at the centre, n = 5: left whole, wrongly", Refuted, Near(85.0, 5.0)),
    ("test at the centre, n = 20: left whole, wrongly", Refuted, Within(30.0, 85.0)),
    ("test at the centre, n = 50: left whole, wrongly", Refuted, Within(30.0, 85.0)),
    ("test at the centre, n = 100: left whole, wrongly", Refuted, Near(29.0, 2.0)),
    ("test at the centre: largest error overlooked", Refuted, Near(162.0, 20.0)),
    ("edge of 20 degrees split on one side, n = 20", Refuted, Near(5.0, 0.5)),
    ("edge of 20 degrees split on one side, n = 50", Refuted, Within(5.0, 102.0)),
    ("edge of 30 degrees split on one side, n = 20", Refuted, Within(5.0, 102.0)),
    ("edge of 30 degrees split on one side, n = 50", Refuted, Within(5.0, 102.0)),
    ("edge of 60 degrees split on one side, n = 50", Refuted, Near(102.0, 0.5)),
    // Szirmay-Kalos et al. 2000, hardware, word length.
    ("b_I > log2 M: error of 320 pixels with 9 bits", Refuted, Near(49.7, 0.3)),
    ("fraction bits for M = 320 pixels", Refuted, Near(17.0, 0.0)),
    ("fraction bits for M = 4096 pixels", Refuted, Near(25.0, 0.0)),
    // Szirmay-Kalos et al. 2000, forward differences.
    ("sampling at X_start + k, 168 triangles, n = 50", Refuted, Near(31.0, 1.0)),
    ("sampling at X_start + k: root mean square", Close, Near(0.7, 0.05)),
    ("recurrences along rows and edges", Confirmed, Same),
    // Szirmay-Kalos et al. 2000, six-point solution.
    ("T1 to T5 as printed, in f64", Confirmed, Within(0.0, 0.001)),
    ("T1 to T5 as printed, in f32", Refuted, Within(50.0, 5000.0)),
    ("the same quadratic by affine coordinates, in f32", Confirmed, Within(0.0, 0.3)),
    ("T3 where Y2 = 0", Refuted, Within(0.00190624, 0.00190626)),
    // Bishop & Weimer 1986, table of powers.
    ("1k table within 1 % up to n, nearest entry", Confirmed, Near(20.0, 0.0)),
    ("1k table within 1 % up to n, index truncated", Refuted, Near(10.0, 0.0)),
    ("1k table, n = 20, entries of 8 bits: error", Close, Near(1.1, 0.05)),
    ("8k table within 1 % up to n, nearest entry", Confirmed, Near(164.0, 0.0)),
    ("8k table within 1 % up to n, index truncated", Refuted, Near(82.0, 0.0)),
    ("8k table, n = 164, entries of 8 bits: error", Close, Near(1.1, 0.05)),
    // Bishop & Weimer 1986, range of normals.
    ("normals 15 degrees apart, diffuse: error", Confirmed, Within(0.0, 0.5)),
    ("normals 15 degrees apart, n = 50: error", Confirmed, Near(1.5, 0.2)),
    ("normals 20 degrees apart, diffuse: error", Confirmed, Near(0.5, 0.1)),
    ("normals 20 degrees apart, n = 50: error", Close, Near(3.9, 0.5)),
    ("normals 30 degrees apart, diffuse: error", Confirmed, Near(2.0, 0.3)),
    ("normals 30 degrees apart, n = 50: error", Refuted, Near(15.0, 2.0)),
    ("normals 45 degrees apart, diffuse: error", Close, Within(2.0, 24.0)),
    ("normals 45 degrees apart, n = 50: error", Refuted, Within(15.0, 194.0)),
    ("normals 60 degrees apart, diffuse: error", Refuted, Near(24.0, 2.0)),
    ("normals 60 degrees apart, n = 50: error", Refuted, Near(194.0, 20.0)),
    // Bishop & Weimer 1986, equation of I_diff.
    ("I_diff at a point, |L| = 1.7", Refuted, Example),
    // Bishop & Weimer 1986, T0 to T5, infinite eye.
    ("T0 to T4", Confirmed, Same),
    ("T5 with 3ig²", Refuted, Example),
    // Bishop & Weimer 1986, T0 to T5, finite eye.
    ("T0 to T3", Confirmed, Same),
    ("T5 with m = E·E", Refuted, Example),
    ("T3 with o = 2D·E", Refuted, Example),
    ("T5 with - 4ajlr²", Refuted, Example),
    ("T5 with + 2fjlp", Refuted, Example),
    ("T4 with - fjlr", Refuted, Example),
    ("T4 with - 2f²nr", Refuted, Example),
    // Disselkoen 1991, 3, after Kuijk & Blake 1989.
    ("cos^s by three parabolas: worst at s = 1", Confirmed, Near(0.0523, 0.0001)),
    ("cos^s by three parabolas: worst at s = 2", Confirmed, Near(0.041, 0.0005)),
    ("cos^s by three parabolas: worst at s = 4", Confirmed, Near(0.017, 0.0041)),
    ("cos^s by three parabolas: worst at s = 8", Confirmed, Near(0.017, 0.0041)),
    ("cos^s by three parabolas: worst at s = 16", Confirmed, Near(0.017, 0.0041)),
    ("cos^s by three parabolas: worst at s = 32", Confirmed, Near(0.017, 0.0041)),
    ("cos^s by three parabolas: worst at s = 64", Confirmed, Near(0.017, 0.0041)),
    ("cos^s by three parabolas: worst at s = 100", Confirmed, Near(0.036, 0.0005)),
    ("cos^s by three parabolas: worst at s = 128", Close, Near(0.058, 0.0005)),
    ("cos^s by three parabolas: worst at s = 512", Refuted, Near(0.26, 0.005)),
    ("average error over s = 1 to 128, signed", Confirmed, Near(0.00061, 1e-05)),
    ("average error over s = 1 to 128, absolute", Refuted, Near(0.0032, 5e-05)),
    ("cos^5 at 20 degrees, s = 30", Refuted, Within(0.15472, 0.15474)),
    ("the three parabolas join smoothly", Confirmed, Same),
    // Disselkoen 1991, 3, our a(s) and b(s).
    ("largest error at s = 1", Confirmed, Near(0.024, 0.0005)),
    ("largest error at s = 2", Confirmed, Near(0.021, 0.0005)),
    ("largest error for s = 8 to 512", Confirmed, Near(0.0143, 5e-05)),
    // Disselkoen 1991, 2.
    ("ddp = (2(t+1)+1) - (2t+1), t = 3", Confirmed, Near(2.0, 0.0)),
    // Disselkoen 1991, 4.
    ("plane through three values, at the first corner", Refuted, Example),
    // Disselkoen 1991, 4.2.
    ("L·N = ax + bx + c at a point", Refuted, Example),
    ("cosine of L and N, L in the denominator's N", Refuted, Example),
    // Disselkoen 1991, 4.3, quoting Bishop & Weimer.
    ("T4 with 4bgi", Refuted, Example),
    ("T1 with 3bi", Refuted, Example),
    // Disselkoen 1991, 6.
    ("Γ² from the five products", Confirmed, Same),
    ("α by (ll)(rv)/(lv) - (rr)", Refuted, Example),
    ("α by (ll)(rv) - (rr)(lv)", Refuted, Example),
    // Disselkoen 1991, 12, code.
    ("τ by cos τ = lr/sqrt(ll + rr)", Refuted, Example),
    ("all corrected: largest error", Confirmed, Within(0.0, 1e-08)),
    ("dtdx *= dtdx Γ: largest error", Refuted, Within(0.01, 1.0)),
    ("centres of 1st and 3rd part: largest error", Refuted, Within(0.01, 10000.0)),
    ("first = s/2: largest error", Refuted, Within(0.01, 10000.0)),
    ("max(xl, xbl) in all three parts: largest error", Refuted, Within(0.01, 10000.0)),
    ("C not moved to the first row: largest error", Refuted, Within(0.01, 1.0)),
    ("linearshade: sgn·|cos|^s, cos = -0.3, s = 1", Refuted, Near(0.0, 0.0)),
    // Disselkoen 1991, 12, list of symbols.
    ("ll0 to ll2, rr0 to rr2", Confirmed, Same),
    ("lr0 with ac(xl0 + xl0)", Refuted, Example),
    ("lr1 with aa(dxl xl0 + dxl xr0)", Refuted, Example),
    ("lr2", Confirmed, Same),
    // Disselkoen 1991, 9, anti-aliasing.
    ("linear parts of a row, at most", Refuted, Near(4.0, 0.0)),
    ("pixels with a break in them", Refuted, Near(51.0, 1.0)),
    // Goldman, lecture, slide of dD.
    ("dD, first line (t = 0.3, dt = 1/16, 60 degrees)", Refuted, Within(-0.0210938, -0.0210937)),
    ("dD = 2dt(1 + dt + (1-2t+dt)c)", Refuted, Within(-0.0210938, -0.0210937)),
    ("dD = E - F, F = 2tc", Refuted, Within(-0.0210938, -0.0210937)),
    ("D after 16 steps of 16", Refuted, Near(1.0, 1e-12)),
    // Goldman, lecture, slide of N + dN.
    ("N + dN renormalised, ends 20 degrees apart", Close, Near(0.2, 0.02)),
    ("N + dN renormalised, ends 40 degrees apart", Refuted, Near(1.6, 0.05)),
    ("N + dN renormalised, ends 60 degrees apart", Refuted, Near(5.0, 0.1)),
    // Goldman, lecture, slide of Newton's root.
    ("one step per pixel, 60 degrees in 8 pixels", Confirmed, Near(0.0017, 5e-05)),
    ("one step per pixel, 60 degrees in 32 pixels", Confirmed, Near(0.0001, 5e-05)),
    // Goldman, lecture, slides of slerp.
    ("slerp by adding angles over 64 steps", Confirmed, Same),
    // Goldman, lecture, other slides.
    ("R·V = 2(L·N)(V·N)/D - L·V", Confirmed, Same),
    ("Gouraud along edges and rows is affine", Confirmed, Same),
    ("t and t* in perspective, I/m over 1/m", Confirmed, Same),
    ("Newell's normal is twice the area long", Confirmed, Same),
];

fn all() -> Vec<Claim> {
    Topic::ALL.into_iter().flat_map(|topic| claims(topic).unwrap()).collect()
}

#[test]
fn verdicts_and_figures_are_those_of_the_notes() {
    let found = all();
    let mut wrong = Vec::new();
    for (claim, &(what, verdict, ours)) in found.iter().zip(EXPECTED) {
        let right = match (ours, &claim.ours) {
            (Near(value, tolerance), Value::Number(number)) => (number - value).abs() <= tolerance,
            (Within(low, high), Value::Number(number)) => (low..=high).contains(number),
            (Same, Value::Number(number)) => (0.0..=1e-7).contains(number),
            (Example, Value::Number(number)) => number.is_finite() && claim.paper != claim.ours,
            (Text(text), Value::Text(found)) => text == found,
            _ => false,
        };
        if claim.what != what || claim.verdict != verdict || !right {
            wrong.push(format!("{claim:?}, not {what:?} {verdict:?} {ours:?}"));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    assert_eq!(found.len(), EXPECTED.len());
}

/// Whoever reads one object or one line must be able to tell which claim it is and why it ends so.
#[test]
fn claims_can_be_told_apart_and_say_why() {
    let found = all();
    let mut seen = HashSet::new();
    for claim in &found {
        assert!(seen.insert((claim.source.clone(), claim.what.clone())), "twice: {claim:?}");
        assert!(claim.source.starts_with(claim.topic.author()), "{claim:?}");
        assert!(claim.note.ends_with('.') && claim.note.len() > 15, "{claim:?}");
        // As wide as the table's column.
        assert!(claim.what.chars().count() <= 48, "{claim:?}");
        if claim.verdict == NotReproducible {
            assert!(claim.note.contains("not printed"), "{claim:?}");
        }
    }
}

/// A seed makes the same examples every time.
#[test]
fn figures_are_the_same_every_time() {
    assert_eq!(claims(Topic::Disselkoen).unwrap(), claims(Topic::Disselkoen).unwrap());
    assert_eq!(claims(Topic::BishopWeimer).unwrap(), claims(Topic::BishopWeimer).unwrap());
}

#[test]
fn figures_show_four_digits_that_count() {
    for (number, text) in
        [(0.0, "0"), (20.0, "20"), (-0.25, "-0.2500"), (33.1149, "33.11"), (0.00190625, "0.001906"), (1.66e-9, "1.7e-9"), (49.661, "49.66")]
    {
        assert_eq!(Value::Number(number).to_string(), text);
    }
    assert_eq!(format!("{:>6}|{:>6}", Value::Number(1.5), Value::from("exact")), " 1.500| exact");
}
