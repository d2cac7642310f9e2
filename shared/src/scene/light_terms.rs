//! The terms of light on a material: what each light adds at most. They tell whether the material has one channel or three.

use crate::{
    arch::product::unsigned_product,
    format::MAX_LIGHTS,
    math::vector::zip,
    pixel::Channels,
    stream::record::{Light, Material},
};

/// A colour as products of gains, Q4.28.
pub(crate) type Colour = [u32; 3];

/// The colours of all terms of light on a material in a pixel format.
pub(crate) struct LightTerms {
    /// Diffuse and specular light of each light, then ambient light.
    pub(crate) colours: heapless::Vec<Colour, { 2 * MAX_LIGHTS + 1 }>,
    /// The brightest term.
    pub(crate) base: Colour,
    /// Whether all terms are multiples of one colour, so that one level describes all light. In pixel formats whose table of colours would show steps,
    /// this colour is grey.
    pub(crate) are_one_channel: bool,
}

impl LightTerms {
    /// The terms of `material` under `lights`.
    pub(crate) fn new(&Channels { is_gray, is_coarse, .. }: &Channels, ambient: [u16; 3], material: &Material, lights: &[Light]) -> Self {
        let mut colours = heapless::Vec::new();
        let lit = lights
            .iter()
            .flat_map(|light| [(light.colour, material.diffuse), (light.colour, if light.is_sky() { [0; 3] } else { material.specular })]);
        for (light, reflectance) in lit.chain([(ambient, material.ambient)]) {
            let colour = product(light, reflectance);
            // There is room for the terms of as many lights as a stream has.
            let _ = colours.push(if is_gray { luma(colour) } else { colour });
        }
        let base = colours.iter().fold([0; 3], |base, &term| if largest(term) >= largest(base) { term } else { base });
        // A level of the table of colours is rounded before its colour is: pixel formats that would show it have greys alone in one channel.
        let direction = if is_coarse { base } else { [largest(base); 3] };
        let are_one_channel = colours.iter().all(|&term| along(term, direction));
        Self { colours, base, are_one_channel }
    }
}

#[inline(never)]
fn product(a: [u16; 3], b: [u16; 3]) -> Colour {
    zip(a, b, |a, b| u32::from(a) * u32::from(b))
}

/// Rec. 601 luma in all three channels.
fn luma([r, g, b]: Colour) -> Colour {
    [(r >> 8) * 77 + (g >> 8) * 150 + (b >> 8) * 29; 3]
}

/// The largest channel.
pub(crate) fn largest(colour: Colour) -> u32 {
    colour.into_iter().fold(0, u32::max)
}

/// Whether `colour` is a multiple of `base`, to 1/1024 of its largest channel.
#[inline(never)]
fn along(colour: Colour, base: Colour) -> bool {
    let (a, b) = (largest(colour), largest(base));
    let most = unsigned_product(a, b) >> 10;
    zip(colour, base, |c, d| unsigned_product(c, b).abs_diff(unsigned_product(d, a)) <= most) == [true; 3]
}
