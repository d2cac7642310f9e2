//! Products of two words.
//!
//! Most machines multiply 32 by 32 bits into 64 in one instruction. On Armv6-M a 64-bit product is a call of 40 instructions, and four
//! products of half words take less than half of that. Both ways give the same bits.
//!
//! All of these functions are exact: tests::halves_where_they_carry and the property tests compare them with 64-bit integers.

/// Whether 64-bit products are made of half words: on Armv6-M, which is recognised by its lack of atomic instructions.
pub(crate) const HALVES: bool = cfg!(all(target_arch = "arm", not(target_has_atomic = "32")));

/// Product `a b` in 64 bits, in the product of the formats. Domain: every `i32`. Exact.
#[inline]
pub(crate) fn product(a: i32, b: i32) -> i64 {
    if HALVES { whole_by_halves(a, b) } else { i64::from(a) * i64::from(b) }
}

/// Unsigned product `a b` in 64 bits, in the product of the formats. Domain: every `u32`. Exact.
#[inline]
pub(crate) fn unsigned_product(a: u32, b: u32) -> u64 {
    if HALVES { unsigned_by_halves(a, b) } else { u64::from(a) * u64::from(b) }
}

/// Upper half of a product: `a b / 2^32`, rounded down. Domain: every `i32`. Exact.
///
/// Source: Knuth, The Art of Computer Programming 4.3.1, Algorithm M; Warren, Hacker's Delight 8-2.
#[inline]
pub fn upper(a: i32, b: i32) -> i32 {
    if HALVES { upper_by_halves(a, b) } else { ((i64::from(a) * i64::from(b)) >> 32) as i32 }
}

/// Upper half of a product, for the pixel loop: `a b / 2^32`, rounded down. Domain: `b` is a multiple of 2^16. Exact.
#[inline]
pub(crate) fn upper_by_half_word(a: i32, b: i32) -> i32 {
    if HALVES { by_half_word(a, b >> 16) } else { ((i64::from(a) * i64::from(b)) >> 32) as i32 }
}

/// Product with a fraction: `a b / 2^16`, rounded down, in the format of `a`. Domain: `b` is unsigned Q0.16. Exact.
#[inline]
pub(crate) fn by_fraction(a: i32, b: u16) -> i32 {
    if HALVES { by_half_word(a, b.into()) } else { ((i64::from(a) * i64::from(b)) >> 16) as i32 }
}

/// Product of an unsigned number with a fraction: `a b / 2^16`, rounded down, in the format of `a`. Domain: `b` is unsigned Q0.16. Exact.
#[inline]
pub(crate) fn unsigned_by_fraction(a: u32, b: u16) -> u32 {
    if HALVES { unsigned_by_half_word(a, b.into()) } else { ((u64::from(a) * (u64::from(b) << 16)) >> 32) as u32 }
}

/// Upper half of a dot product: `(a x + b y) / 2^32`, rounded down.
///
/// Domain: `a` and `b` within ±2^30, `x` and `y` multiples of 2^16, so that the sum fits 63 bits. Exact (tests::dots_make_the_same).
#[inline]
pub(crate) fn upper_dot([a, b]: [i32; 2], [x, y]: [i32; 2]) -> i32 {
    if HALVES { dot_by_halves([a, b], [x >> 16, y >> 16]) } else { ((product(a, x) + product(b, y)) >> 32) as i32 }
}

/// `product / 2^(32 - left)`, rounded to nearest, halves up, modulo 2^32.
///
/// Domain: `left` is less than 32. Exact (tests::shifts_make_the_same).
#[inline]
pub(crate) fn rounded(product: i64, left: u32) -> i32 {
    let product = product.wrapping_add(((1u32 << 31) >> left).into());
    let (upper, lower) = ((product >> 32) as u32, product as u32);
    (upper.wrapping_shl(left) | (lower >> 1).wrapping_shr(31 - left)) as i32
}

/// `product / 2^(32 - left)`, rounded down, modulo 2^32.
///
/// Domain: `left` is 1 to 31. Exact (tests::shifts_make_the_same).
#[inline]
pub(crate) fn shifted(product: i64, left: u32) -> i32 {
    let (upper, lower) = ((product >> 32) as u32, product as u32);
    (upper.wrapping_shl(left) | lower.wrapping_shr(32 - left)) as i32
}

/// `(lower, upper)` half of a word; the lower one is unsigned.
#[inline]
fn split(a: i32) -> (i32, i32) {
    (a & 0xFFFF, a >> 16)
}

/// Upper half of a product (Knuth; Warren, Hacker's Delight 8-2): no sum of half words overflows.
#[inline]
fn upper_by_halves(a: i32, b: i32) -> i32 {
    let ((al, ah), (bl, bh)) = (split(a), split(b));
    let (low, high) = split(ah.wrapping_mul(bl).wrapping_add((al.wrapping_mul(bl) as u32 >> 16) as i32));
    ah.wrapping_mul(bh).wrapping_add(high).wrapping_add(al.wrapping_mul(bh).wrapping_add(low) >> 16)
}

/// The whole product from half words. It is never inlined: products at set-up are few, and flash is worth more there than time.
#[inline(never)]
fn whole_by_halves(a: i32, b: i32) -> i64 {
    i64::from(upper_by_halves(a, b)) << 32 | i64::from(a.wrapping_mul(b) as u32)
}

/// The unsigned product from the signed one, in which each factor is too small by 2^32 where its first bit is set.
///
/// Products of unsigned half words would be shorter, but the compiler recognises the pattern and calls its own 64-bit product.
#[inline(never)]
fn unsigned_by_halves(a: u32, b: u32) -> u64 {
    let (signed_a, signed_b) = (a as i32, b as i32);
    let correction = ((signed_a >> 31) & signed_b).wrapping_add((signed_b >> 31) & signed_a);
    let upper = upper_by_halves(signed_a, signed_b).wrapping_add(correction) as u32;
    u64::from(upper) << 32 | u64::from(a.wrapping_mul(b))
}

/// `a b / 2^16`, rounded down; `b` is at most 16 bits, without a sign.
#[inline]
fn by_half_word(a: i32, b: i32) -> i32 {
    let (low, high) = split(a);
    high.wrapping_mul(b).wrapping_add((low.wrapping_mul(b) as u32 >> 16) as i32)
}

/// `a b / 2^16`, rounded down, of an unsigned `a`; `b` is at most 16 bits, without a sign.
#[inline]
fn unsigned_by_half_word(a: u32, b: u32) -> u32 {
    (a >> 16).wrapping_mul(b).wrapping_add((a & 0xFFFF).wrapping_mul(b) >> 16)
}

/// `(a x + b y) / 2^16`, rounded down; `x` and `y` are half words.
#[inline]
fn dot_by_halves([a, b]: [i32; 2], [x, y]: [i32; 2]) -> i32 {
    let ((al, ah), (bl, bh)) = (split(a), split(b));
    // Products of the lower halves are split again: the sum of two of them would not fit.
    let ((l, h), (m, i)) = (split(al.wrapping_mul(x)), split(bl.wrapping_mul(y)));
    let carried = h.wrapping_add(i).wrapping_add((l + m) >> 16);
    ah.wrapping_mul(x).wrapping_add(bh.wrapping_mul(y)).wrapping_add(carried)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn check(a: i32, b: i32) {
        let whole = i64::from(a) * i64::from(b);
        assert_eq!(whole_by_halves(a, b), whole, "{a} {b}");
        assert_eq!(upper_by_halves(a, b), (whole >> 32) as i32, "{a} {b}");
        assert_eq!(unsigned_by_halves(a as u32, b as u32), u64::from(a as u32) * u64::from(b as u32), "{a} {b}");
        let fraction = b as u16;
        assert_eq!(i64::from(by_half_word(a, fraction.into())), (i64::from(a) * i64::from(fraction)) >> 16, "{a} {fraction}");
        assert_eq!(by_fraction(a, fraction), by_half_word(a, fraction.into()));
        let whole = (u64::from(a as u32) * u64::from(fraction)) >> 16;
        assert_eq!(u64::from(unsigned_by_half_word(a as u32, fraction.into())), whole, "{a} {fraction}");
        assert_eq!(u64::from(unsigned_by_fraction(a as u32, fraction)), whole);
        let (factor, product) = (b & 0x7FFF, i64::from(a) * i64::from(b & 0x7FFF));
        assert_eq!(i64::from(upper_by_half_word(a, factor << 16)), product >> 16, "{a} {factor}");
    }

    #[test]
    fn halves_where_they_carry() {
        let edges = [0, 1, 0x7FFF, 0x8000, 0xFFFF, 0x1_0000, 0x7FFF_0000, 0x7FFF_8000, 0x7FFF_FFFF];
        let edges = || edges.into_iter().flat_map(|c: i32| [c, -c, !c, c ^ i32::MIN]);
        for (a, b) in edges().flat_map(|a| edges().map(move |b| (a, b))) {
            check(a, b);
        }
    }

    proptest! {
        #[test]
        fn halves_make_the_same(a: i32, b: i32) {
            check(a, b);
        }

        #[test]
        fn dots_make_the_same(a in -(1 << 30)..1 << 30, b in -(1 << 30)..1 << 30, x: i16, y: i16) {
            let (x, y) = (i32::from(x), i32::from(y));
            let whole = (i64::from(a) * i64::from(x) + i64::from(b) * i64::from(y)) >> 16;
            prop_assert_eq!(dot_by_halves([a, b], [x, y]), whole as i32);
            prop_assert_eq!(upper_dot([a, b], [x << 16, y << 16]), whole as i32);
        }

        #[test]
        fn shifts_make_the_same(product: i64, left in 1..32u32) {
            prop_assert_eq!(shifted(product, left), (product >> (32 - left)) as i32);
            let half = 1i128 << (31 - left);
            prop_assert_eq!(rounded(product, left), ((i128::from(product) + half) >> (32 - left)) as i32);
        }
    }
}
