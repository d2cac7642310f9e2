//! Conversion of metallic-roughness materials to materials of Blinn and Phong.
//!
//! The mirrored colour follows the glTF 2.0 specification, appendix B: 0.04, mixed with the base colour by the metallic factor. The exponent is the
//! one of the closest Blinn-Phong distribution: 2 / alpha² - 2, where alpha is the square of the roughness (Walter et al. 2007; Karis 2013, "Specular
//! BRDF Reference"). There are two differences from the specification. A picture has no surroundings that a metal could mirror: metals, which have no
//! diffuse reflection there, keep half of their colour for it, and more where their highlights fade. Peaks of highlights have one brightness here, while
//! physical ones are fainter the wider they are. So highlights of an exponent below 8 fade here, and at the exponent 1, where they would be as wide as
//! diffuse light, there are none.
//!
//! Colours of glTF are linear. Colours of a stream are added as a display takes them, so they are encoded as sRGB (IEC 61966-2-1).

use crate::{
    mtl::{Material, SHARPEST},
    vector::{V3, add, dot, scale},
};

/// Part of light that dielectrics mirror if it falls straight on them.
const DIELECTRIC: f64 = 0.04;
/// Share of the evenly reflected light that metals keep.
const KEPT: f64 = 0.5;
/// The exponent below which highlights fade.
const FADING: f64 = 8.0;

/// The material nearest to one of specular and glossiness (KHR_materials_pbrSpecularGlossiness): a diffuse colour and a mirrored one, both linear. Such
/// materials have no metallic factor. How far one is a metal follows from the two colours, as the specification's own conversion to metallic and
/// roughness computes it.
pub(crate) fn of_gloss(name: String, [red, green, blue, _]: [f32; 4], specular: [f32; 3], glossiness: f32) -> Material {
    let limited = |colour: [f32; 3]| colour.map(|c| f64::from(c).clamp(0.0, 1.0));
    let (diffuse, specular) = (limited([red, green, blue]), limited(specular));
    let exponent = exponent(1.0 - f64::from(glossiness));
    let strength = strength(exponent);
    let metallic = metallic(diffuse, specular).powi(2);
    // As for a metal of metallic and roughness: it keeps more of its colour where its highlight fades.
    let kept = scale(encoded(specular), metallic * (1.0 - (1.0 - KEPT) * strength));
    Material {
        name,
        ambient: None,
        diffuse: Some(add(scale(encoded(diffuse), 1.0 - metallic), kept)),
        specular: Some(encoded(scale(specular, strength))),
        exponent: Some(exponent),
        ..Material::default()
    }
}

/// The light that a material sends out, of a linear colour and how strong it is (KHR_materials_emissive_strength). It may be more than 1, because a
/// texture can make it weaker.
pub(crate) fn emission(colour: [f32; 3], strength: Option<f32>) -> V3 {
    let strength = f64::from(strength.unwrap_or(1.0)).clamp(0.0, f64::MAX);
    encoded(colour.map(|c| strength * f64::from(c).clamp(0.0, 1.0)))
}

/// The share of the light from behind that passes through a surface of a base colour, linear, and of a texture in sRGB, where this share of what is
/// not mirrored passes through white glass (KHR_materials_transmission). Coloured glass lets less through. A stream lets as much through of each
/// channel, which is the mean here, and the glass shows its colour by the rest.
pub(crate) fn transmitted([red, green, blue, _]: [f32; 4], texture: V3, share: f64) -> f64 {
    let base = encoded([red, green, blue].map(|c| f64::from(c).clamp(0.0, 1.0)));
    (1.0 - DIELECTRIC) * share.clamp(0.0, 1.0) * dot(base, texture) / 3.0
}

/// How far a material is a metal, from 0 to 1: the solution of the quadratic equation by which the two colours follow from a base colour.
fn metallic(diffuse: V3, specular: V3) -> f64 {
    let brightness = |[r, g, b]: V3| (0.299 * r * r + 0.587 * g * g + 0.114 * b * b).sqrt();
    let (bright, mirrored) = (brightness(diffuse), brightness(specular));
    if mirrored < DIELECTRIC {
        return 0.0;
    }
    let strongest = specular.into_iter().fold(0.0, f64::max);
    let b = bright * (1.0 - strongest) / (1.0 - DIELECTRIC) + mirrored - 2.0 * DIELECTRIC;
    let c = DIELECTRIC - mirrored;
    let root = (b * b - 4.0 * DIELECTRIC * c).max(0.0).sqrt();
    ((root - b) / (2.0 * DIELECTRIC)).clamp(0.0, 1.0)
}

/// How bright a highlight of this exponent is.
fn strength(exponent: f64) -> f64 {
    if exponent > 1.0 { (exponent / FADING).min(1.0) } else { 0.0 }
}

/// The material nearest to a base colour, linear, with these shares.
pub(crate) fn material(name: String, [red, green, blue, _]: [f32; 4], metallic: f32, roughness: f32) -> Material {
    let base = [red, green, blue].map(|c| f64::from(c).clamp(0.0, 1.0));
    let metallic = f64::from(metallic).clamp(0.0, 1.0);
    let exponent = exponent(roughness.into());
    let strength = strength(exponent);
    let mirrored = scale(add(scale([DIELECTRIC; 3], 1.0 - metallic), scale(base, metallic)), strength);
    Material {
        name,
        ambient: None,
        diffuse: Some(scale(encoded(base), 1.0 - (1.0 - KEPT) * metallic * strength)),
        specular: Some(encoded(mirrored)),
        exponent: Some(exponent),
        ..Material::default()
    }
}

/// The exponent of the highlight of a surface of this roughness, from 0 to 1.
fn exponent(roughness: f64) -> f64 {
    let alpha = roughness.clamp(0.0, 1.0).powi(2);
    (2.0 / (alpha * alpha).max(f64::MIN_POSITIVE) - 2.0).clamp(1.0, SHARPEST)
}

/// Linear light as sRGB has it.
pub(crate) fn encoded(linear: V3) -> V3 {
    linear.map(|c| if c <= 0.003_130_8 { 12.92 * c } else { 1.055 * libm::pow(c, 1.0 / 2.4) - 0.055 })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(a: Option<V3>, b: V3) -> bool {
        a.is_some_and(|a| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-3))
    }

    #[test]
    fn exponents_follow_the_roughness() {
        for (roughness, expected) in [(1.0, 1.0), (0.5, 30.0), (0.25, 510.0), (0.1, 1024.0), (0.0, 1024.0)] {
            assert_eq!(exponent(roughness), expected);
        }
    }

    #[test]
    fn rough_surfaces_have_no_highlight() {
        let red = |metallic, roughness| material(String::new(), [1.0, 0.0, 0.0, 1.0], metallic, roughness);
        for metallic in [0.0, 1.0] {
            let rough = red(metallic, 1.0);
            assert!(near(rough.diffuse, [1.0, 0.0, 0.0]) && rough.specular == Some([0.0; 3]), "{rough:?}");
        }
        let strength = |roughness| red(0.0, roughness).specular.map_or(0.0, |[r, ..]| r);
        assert!([0.9, 0.85, 0.8, 0.75, 0.7].map(strength).is_sorted_by(|a, b| a < b));
        assert!((strength(0.6) - strength(0.3)).abs() < 1e-9, "{} {}", strength(0.6), strength(0.3));
    }

    /// White glass mirrors a little, red glass holds two channels back, and black glass all.
    #[test]
    fn glass_lets_through_what_its_colour_does() {
        let through = |colour: [f32; 4], texture, share| (1e3 * transmitted(colour, texture, share)).round();
        assert_eq!(through([1.0; 4], [1.0; 3], 1.0), 960.0);
        assert_eq!(through([1.0; 4], [0.5; 3], 0.5), 240.0);
        assert_eq!(through([1.0, 0.0, 0.0, 1.0], [1.0; 3], 1.0), 320.0);
        assert_eq!(through([0.0, 0.0, 0.0, 1.0], [1.0; 3], 1.0), 0.0);
    }

    #[test]
    fn specular_and_glossiness_keep_their_colours() {
        let orange = of_gloss(String::new(), [1.0, 0.214_041, 0.0, 1.0], [0.04; 3], 0.5);
        assert!(near(orange.diffuse, [1.0, 0.5, 0.0]) && near(orange.specular, [0.221; 3]) && orange.exponent == Some(30.0), "{orange:?}");
        // With more of a highlight it stays orange.
        let shiny = of_gloss(String::new(), [1.0, 0.3, 0.0, 1.0], [0.2; 3], 0.5).diffuse.unwrap_or_default();
        assert!(shiny[0] > 0.9 && (0.5..0.6).contains(&shiny[1]) && shiny[2] < 0.1, "{shiny:?}");
        // A metal is the same by either description.
        for gloss in [0.0, 0.2, 0.5, 0.9] {
            let gold = of_gloss(String::new(), [0.0, 0.0, 0.0, 1.0], [1.0, 0.5, 0.1], gloss);
            let same = material(String::new(), [1.0, 0.5, 0.1, 1.0], 1.0, 1.0 - gloss);
            assert!(
                near(gold.diffuse, same.diffuse.unwrap_or_default()) && near(gold.specular, same.specular.unwrap_or_default()),
                "{gold:?}, {same:?}"
            );
        }
    }

    #[test]
    fn metals_have_coloured_highlights_and_others_white_ones() {
        let copper = material(String::new(), [1.0, 0.214_041, 0.0, 1.0], 1.0, 0.5);
        assert!(near(copper.diffuse, [0.5, 0.25, 0.0]) && near(copper.specular, [1.0, 0.5, 0.0]), "{copper:?}");
        let paint = material(String::new(), [1.0, 0.214_041, 0.0, 1.0], 0.0, 0.5);
        assert!(near(paint.diffuse, [1.0, 0.5, 0.0]) && near(paint.specular, [0.221; 3]), "{paint:?}");
    }
}
