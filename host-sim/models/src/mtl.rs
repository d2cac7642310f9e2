//! Reader for MTL, the materials of Wavefront OBJ.
//!
//! It is our own, as the reader for OBJ is, because an error should name the line of a bad number.

use crate::{
    fields::quoted,
    look::Surface,
    text::{logical_lines, plain, rest, without_comments},
    vector::{V3, add, scale},
};
use anyhow::{Context, Result, bail};
use std::collections::BTreeSet;

/// The contents of an MTL file.
#[derive(Clone, Debug, Default)]
pub struct Mtl {
    /// Materials, in the order of the file.
    pub materials: Vec<Material>,
    /// Contents that are left out, in words.
    pub ignored: BTreeSet<&'static str>,
}

/// A material. Colours are shares of light, 1 is all of it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Material {
    /// The name.
    pub name: String,
    /// `Ka`.
    pub ambient: Option<V3>,
    /// `Kd`.
    pub diffuse: Option<V3>,
    /// `Ks`.
    pub specular: Option<V3>,
    /// `Ns`.
    pub exponent: Option<f64>,
    /// `Ke`: the light that the surface sends out, in whatever light it stands.
    pub emission: V3,
    /// `map_Ke`: the file of the texture by which this light is multiplied.
    pub emission_texture: Option<String>,
    /// `map_Kd`: the file of the texture.
    pub texture: Option<String>,
    /// `map_d`: the file of the texture's opacity.
    pub mask: Option<String>,
    /// 1 less `d`, or else `Tr`: the share of the light from behind that the surface lets through.
    pub transparency: f64,
    /// Whether triangles are seen from behind as well.
    pub two_sided: bool,
}

/// Diffuse colour of a material without `Kd`.
const DIFFUSE: V3 = [0.6; 3];
/// Exponent of a material without `Ns`.
const EXPONENT: f64 = 30.0;
/// The largest exponent of a stream.
pub(crate) const SHARPEST: f64 = 1024.0;

impl Material {
    /// A white material without a highlight.
    pub(crate) fn white() -> Self {
        Self::matt("white".to_owned(), [1.0; 3])
    }

    /// A material of one colour without a highlight.
    pub(crate) fn matt(name: String, colour: V3) -> Self {
        Self { name, diffuse: Some(colour), specular: Some([0.0; 3]), ..Self::default() }
    }

    /// The material of a surface whose colour is multiplied by those of a texture or of vertices.
    pub(crate) fn under_colours(&self) -> Self {
        // A texture has all of the colour where the file does not say what is multiplied by it.
        let diffuse = Some(self.diffuse.unwrap_or(if self.texture.is_some() { [1.0; 3] } else { DIFFUSE }));
        Self { diffuse, ..self.clone() }
    }

    /// Converts the material to one of a stream, under ambient light from 0 to 1.
    #[must_use]
    pub fn surface(&self, ambient_light: f64) -> Surface {
        let diffuse = self.diffuse.unwrap_or(DIFFUSE);
        Surface {
            ambient: add(scale(self.ambient.unwrap_or(diffuse), ambient_light), self.emission),
            diffuse,
            specular: self.specular.unwrap_or_default(),
            exponent: self.exponent.unwrap_or(EXPONENT).round().clamp(1.0, SHARPEST) as u16,
            transparency: self.transparency,
        }
    }
}

/// Parses the text of an MTL file.
///
/// # Errors
/// The error names the line and its fault.
pub fn parse(text: &str) -> Result<Mtl> {
    let mut mtl = Mtl::default();
    // Of the material that is read.
    let mut has_opacity = false;
    for (number, line) in logical_lines(&plain(text)) {
        let mut words = line.split_whitespace();
        let Some(written) = words.next() else { continue };
        let keyword = written.to_ascii_lowercase();
        if keyword == "newmtl" {
            let name = rest(&line);
            if name.is_empty() {
                bail!("line {number}: newmtl: a name is missing");
            }
            mtl.materials.push(Material { name, ..Material::default() });
            has_opacity = false;
            continue;
        }
        let ignored = match keyword.as_str() {
            "tf" => Some("colours of light that surfaces let through"),
            "ka" | "kd" | "ke" | "ks" if words.clone().next().is_some_and(|word| OTHER_COLOURS.contains(&word)) => {
                Some("colours that are spectra, or in XYZ")
            }
            "map_kd" | "map_d" | "map_ke" => None,
            _ if keyword.starts_with("map_") || ["bump", "disp", "decal", "norm", "refl"].contains(&keyword.as_str()) => {
                Some("textures other than those of colour")
            }
            _ => None,
        };
        mtl.ignored.extend(ignored);
        let Some(material) = mtl.materials.last_mut() else { continue };
        let place = || format!("line {number}: {written} of material {:?}", quoted(&material.name));
        match keyword.as_str() {
            "ka" => material.ambient = colour(words).with_context(place)?.or(material.ambient),
            "kd" => material.diffuse = colour(words).with_context(place)?.or(material.diffuse),
            "ke" => material.emission = colour(words).with_context(place)?.unwrap_or_default(),
            "map_ke" => material.emission_texture = Some(file_of(&rest(&line))).filter(|name| !name.is_empty()),
            "ks" => material.specular = colour(words).with_context(place)?.or(material.specular),
            "ns" => material.exponent = Some(share(words.next().unwrap_or_default()).with_context(place)?),
            // Illumination models without a highlight.
            "illum" if ["0", "1"].contains(&words.next().unwrap_or_default()) => material.specular = Some([0.0; 3]),
            // `-halo` comes before a number that holds for the middle of a sphere.
            "d" => {
                let opacity = share(words.find(|word| *word != "-halo").unwrap_or_default()).with_context(place)?;
                (material.transparency, has_opacity) = (1.0 - opacity.min(1.0), true);
            }
            // Some programs write that all is let through, and beside it the opacity of a wall.
            "tr" if !has_opacity => material.transparency = share(words.next().unwrap_or_default()).with_context(place)?.min(1.0),
            "map_d" => material.mask = Some(file_of(&rest(&line))).filter(|name| !name.is_empty()),
            "map_kd" => material.texture = Some(file_of(&rest(&line))).filter(|name| !name.is_empty()),
            _ => {}
        }
    }
    let whole: Vec<&str> = mtl.materials.iter().map(|material| material.name.as_str()).collect();
    let names = without_comments(&whole);
    for (material, name) in mtl.materials.iter_mut().zip(names) {
        material.name = name;
        // Some programs write black where the texture has all of the light, and Maya where it has the colour.
        if material.emission_texture.is_some() && material.emission == [0.0; 3] {
            material.emission = [1.0; 3];
        }
        if material.texture.is_some() && material.diffuse == Some([0.0; 3]) {
            material.diffuse = None;
            material.ambient = material.ambient.filter(|&ambient| ambient != [0.0; 3]);
        }
    }
    Ok(mtl)
}

/// Options of textures behind which is a word.
const WITH_A_WORD: [&str; 3] = ["-colorspace", "-imfchan", "-type"];

/// The file of a texture, behind its options, such as `-s 1 1 1`.
fn file_of(statement: &str) -> String {
    let mut words = statement.split_whitespace().peekable();
    while let Some(option) = words.next_if(|word| word.starts_with('-')) {
        if WITH_A_WORD.contains(&option) {
            words.next();
        }
        while words.next_if(|word| word.parse::<f64>().is_ok() || ["on", "off"].contains(word)).is_some() {}
    }
    words.collect::<Vec<_>>().join(" ").trim_matches('"').to_owned()
}

/// Words before colours that are not red, green and blue.
const OTHER_COLOURS: [&str; 2] = ["spectral", "xyz"];

/// Three numbers, or one for all channels; `None` where the colour is another.
fn colour<'a>(mut words: impl Iterator<Item = &'a str>) -> Result<Option<V3>> {
    let red = words.next().context("a number is missing")?;
    if OTHER_COLOURS.contains(&red) {
        return Ok(None);
    }
    let red = share(red)?;
    Ok(Some(match (words.next(), words.next()) {
        (None, _) => [red; 3],
        (Some(green), Some(blue)) => [red, share(green)?, share(blue)?],
        (Some(_), None) => bail!("blue is missing; one or three numbers are needed"),
    }))
}

/// A number that is not negative.
fn share(word: &str) -> Result<f64> {
    let share = word.parse().ok().filter(|share: &f64| share.is_finite() && *share >= 0.0);
    share.with_context(|| format!("{:?} is not a number from 0 on", quoted(word)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_exponents_and_what_is_left_out() {
        let mtl = parse("# from a modeller\nnewmtl red paint\nKa 1 1 1\nKd 0.8 0.1 0\nKs 0.5\nNs 96.1\nd 1\nillum 2\nnewmtl bare\nmap_Kd -s 1 1 1 -clamp on bare wood.png\nmap_Bump bare.png\nnewmtl matt\nKs 1 1 1\nillum 1\nTr 0.5\n").unwrap();
        let [red, bare, matt] = &mtl.materials[..] else { panic!("{mtl:?}") };
        assert_eq!(red.name, "red paint");
        let Surface { ambient, diffuse, specular, exponent, .. } = red.surface(0.125);
        assert_eq!((ambient, diffuse, specular, exponent), ([0.125; 3], [0.8, 0.1, 0.0], [0.5; 3], 96));
        let Surface { ambient, diffuse, specular, exponent, .. } = bare.surface(0.5);
        assert_eq!((ambient, diffuse, specular, exponent), (scale(DIFFUSE, 0.5), DIFFUSE, [0.0; 3], 30));
        assert_eq!(matt.surface(0.1).specular, [0.0; 3]);
        assert_eq!(bare.texture.as_deref(), Some("bare wood.png"));
        assert_eq!(mtl.ignored.into_iter().collect::<Vec<_>>(), ["textures other than those of colour"]);
        assert_eq!([red, bare, matt].map(|material| material.transparency), [0.0, 0.0, 0.5]);
    }

    #[test]
    fn files_of_textures_are_behind_options() {
        for (statement, file) in [
            ("a b.png", "a b.png"),
            ("-s 1 1 1 -clamp on a.png", "a.png"),
            ("-colorspace sRGB -o 0.1 a.png", "a.png"),
            ("-imfchan r -bm 0.5 on.png", "on.png"),
            ("-type sphere -mm 0 1 \"a b.png\"", "a b.png"),
            ("-type", ""),
        ] {
            assert_eq!(file_of(statement), file, "{statement}");
        }
    }

    #[test]
    fn colours_of_other_kinds_are_said_to_be_left_out() {
        for text in ["Kd spectral paint.rfl 1", "KA xyz 0.2 0.3 0.4", "Ks spectral a.rfl", "Ke xyz 1 1 1"] {
            let Mtl { materials, ignored } = parse(&format!("newmtl a\n{text}\n")).unwrap();
            assert_eq!(ignored.into_iter().collect::<Vec<_>>(), ["colours that are spectra, or in XYZ"], "{text}");
            assert_eq!((materials[0].diffuse, materials[0].emission), (None, [0.0; 3]), "{text}");
        }
    }

    #[test]
    fn statements_may_be_in_capitals_and_names_have_number_signs() {
        let mtl =
            parse("NEWMTL Material__#25\nKD 1 0 0\nNewMtl Material #112 # red\nkd 0 0 1\nks 1\nns 7\nKA 0.5\nMAP_KS a#b.png\n").unwrap();
        let [one, two] = &mtl.materials[..] else { panic!("{mtl:?}") };
        assert_eq!((&one.name[..], one.diffuse), ("Material__#25", Some([1.0, 0.0, 0.0])));
        assert_eq!((&two.name[..], two.diffuse, two.specular), ("Material #112", Some([0.0, 0.0, 1.0]), Some([1.0; 3])));
        assert_eq!(
            (two.exponent, two.ambient, mtl.ignored.contains("textures other than those of colour")),
            (Some(7.0), Some([0.5; 3]), true)
        );
    }

    #[test]
    fn light_that_is_sent_out_is_ambient() {
        for (text, emission, texture) in [
            ("Kd 0\nKe 1 0.5 0", [1.0, 0.5, 0.0], None),
            ("Ke 0.5", [0.5; 3], None),
            ("Ke 0 0 0\nmap_Kd a.png", [0.0; 3], None),
            ("Ke 1 1 1\nmap_Kd a.png", [1.0; 3], None),
            ("map_Ke a.png\nKe 0.5", [0.5; 3], Some("a.png")),
            ("map_Ke -mm 0 1 a b.png", [1.0; 3], Some("a b.png")),
            ("Ke 0 0 0\nmap_Ke a.png", [1.0; 3], Some("a.png")),
        ] {
            let mtl = parse(&format!("newmtl a\n{text}\nnewmtl after\nKd 1\n")).unwrap();
            let [material, _] = &mtl.materials[..] else { panic!("{mtl:?}") };
            assert_eq!(material.surface(0.5).ambient, add(scale(material.surface(0.0).diffuse, 0.5), emission), "{text}");
            assert!(material.emission_texture.as_deref() == texture && mtl.ignored.is_empty(), "{text}");
        }
    }

    /// `d` counts, whatever `Tr` beside it says.
    #[test]
    fn surfaces_let_light_through() {
        for (text, transparency) in
            [("d 0.25", 0.75), ("Tr 0.25", 0.25), ("d 1\nTr 1", 0.0), ("Tr 1\nd 1", 0.0), ("d -halo 0.5", 0.5), ("d 7", 0.0), ("Kd 1", 0.0)]
        {
            let mtl = parse(&format!("newmtl before\nd 0.5\nnewmtl a\n{text}\nnewmtl after\nd 0.5")).unwrap();
            assert_eq!(mtl.materials[1].transparency, transparency, "{text}");
        }
        assert_eq!(parse("newmtl a\nmap_d -mm 0 1 \"leaf mask.png\"").unwrap().materials[0].mask.as_deref(), Some("leaf mask.png"));
    }

    /// Black beside a texture is no colour, as Maya writes it; black alone is.
    #[test]
    fn black_beside_a_texture_is_grey() {
        for (text, diffuse) in [
            ("Kd 0.00 0.00 0.00\nKa 0 0 0\nmap_Kd a.png", DIFFUSE),
            ("map_Kd a.png\nKd 0", DIFFUSE),
            ("Kd 0 0 0", [0.0; 3]),
            ("Kd 0 0 0\nmap_Ks a.png", [0.0; 3]),
            ("Kd 0 0 0.1\nmap_Kd a.png", [0.0, 0.0, 0.1]),
        ] {
            let surface = parse(&format!("newmtl before\nKd 1\nnewmtl a\n{text}\nnewmtl after\nKd 1\n")).unwrap().materials[1].surface(0.5);
            assert_eq!((surface.diffuse, surface.ambient), (diffuse, scale(diffuse, 0.5)), "{text}");
        }
    }

    #[test]
    fn errors_name_the_line() {
        for (text, wrong) in [
            ("newmtl\n", "line 1: newmtl: a name is missing"),
            ("newmtl a\nKd 1 red 0", "line 2: Kd of material \"a\": \"red\" is not a number from 0 on"),
            ("newmtl a\n\nKs 1 1", "line 3: Ks of material \"a\": blue is missing; one or three numbers are needed"),
            ("newmtl a\nNs -3", "line 2: Ns of material \"a\": \"-3\" is not a number from 0 on"),
            ("newmtl a\nKa", "line 2: Ka of material \"a\": a number is missing"),
        ] {
            assert_eq!(format!("{:#}", parse(text).unwrap_err()), wrong);
        }
    }

    #[test]
    fn exponents_are_those_of_streams() {
        for (text, exponent) in [("0", 1), ("0.4", 1), ("17.6", 18), ("1e9", 1024)] {
            let mtl = parse(&format!("newmtl a\nNs {text}")).unwrap();
            assert_eq!(mtl.materials[0].surface(0.1).exponent, exponent);
        }
    }
}
