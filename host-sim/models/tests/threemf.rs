//! 3MF: objects stand where components and items put them, with their colours; what is wrong is an error with a place and a remedy.

use microphong_models::{
    coat::Coat,
    contents::Contents,
    import::{self, Colours, Imported, Rules},
    mesh::Weld,
    threemf,
};
use proptest::prelude::*;
use rawzip::{CompressionMethod, ZipArchiveWriter};
use std::{fmt::Write as _, fs, io::Write as _};

const NAMESPACES: &str = r#"xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02" xmlns:m="http://schemas.microsoft.com/3dmanufacturing/material/2015/02" xmlns:p="http://schemas.microsoft.com/3dmanufacturing/production/2015/06""#;

/// How a part is packed.
#[derive(Clone, Copy)]
struct How {
    method: CompressionMethod,
    encrypted: bool,
}

const DEFLATED: How = How { method: CompressionMethod::DEFLATE, encrypted: false };

/// An archive of these parts.
fn packed_by(parts: &[(&str, &[u8])], how: How) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut archive = ZipArchiveWriter::new(&mut bytes);
    for (name, part) in parts {
        let file = archive.new_file(*name).compression_method(how.method).encrypted(how.encrypted);
        let (mut entry, config) = file.start().unwrap();
        let descriptor = if how.method == CompressionMethod::DEFLATE {
            let mut writer = config.wrap(flate2::write::DeflateEncoder::new(&mut entry, flate2::Compression::fast()));
            writer.write_all(part).unwrap();
            let (encoder, descriptor) = writer.finish().unwrap();
            encoder.finish().unwrap();
            descriptor
        } else {
            let mut writer = config.wrap(&mut entry);
            writer.write_all(part).unwrap();
            writer.finish().unwrap().1
        };
        entry.finish(descriptor).unwrap();
    }
    archive.finish().unwrap();
    bytes
}

fn packed(parts: &[(&str, &[u8])]) -> Vec<u8> {
    packed_by(parts, DEFLATED)
}

/// A file of one model under its usual name.
fn of_model(model: &str) -> Vec<u8> {
    packed(&[("3D/3dmodel.model", model.as_bytes())])
}

fn model(resources: &str, build: &str) -> String {
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"millimeter\" {NAMESPACES}>\n<resources>\n{resources}</resources>\n<build>{build}</build>\n</model>\n"
    )
}

const TETRAHEDRON: &str = "<vertices><vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"1\" y=\"0\" z=\"0\"/><vertex x=\"0\" y=\"1\" z=\"0\"/><vertex x=\"0\" y=\"0\" z=\"1\"/></vertices>";
const FACES: [&str; 4] = [r#"v1="0" v2="2" v3="1""#, r#"v1="0" v2="1" v3="3""#, r#"v1="0" v2="3" v3="2""#, r#"v1="1" v2="2" v3="3""#];

/// A tetrahedron of which each face has these attributes, too.
fn object(attributes: &str, paints: [&str; 4]) -> String {
    let faces: String = FACES.iter().zip(paints).map(|(face, paint)| format!("<triangle {face} {paint}/>\n")).collect();
    format!("<object {attributes}><mesh>\n{TETRAHEDRON}\n<triangles>\n{faces}</triangles></mesh></object>\n")
}

#[track_caller]
fn parsed(bytes: &[u8]) -> Contents {
    threemf::parse(bytes, Colours::Corners).unwrap()
}

#[track_caller]
fn refused(bytes: &[u8]) -> String {
    format!("{:#}", threemf::parse(bytes, Colours::Corners).unwrap_err())
}

/// The corners of each face, where they stand.
fn corners(scene: &Contents) -> Vec<Vec<[f64; 3]>> {
    let soup = &scene.soup;
    soup.faces.iter().map(|face| face.corners.iter().map(|corner| soup.positions[corner.position]).collect()).collect()
}

#[test]
fn one_object_is_where_its_numbers_say() {
    let text = model(&object(r#"id="1" name="a &amp; b""#, [""; 4]), r#"<item objectid="1"/>"#);
    for bytes in [
        of_model(&text),
        packed_by(&[("3D/3dmodel.model", text.as_bytes())], How { method: CompressionMethod::STORE, ..DEFLATED }),
        of_model(&format!("\u{FEFF}{}", text.replace('\n', "\r\n"))),
        // Prefixes of names are those of the file, and names of parts may be in any capitals.
        packed(&[("3d/3DModel.model", text.replace("<vertex ", "<c:vertex ").as_bytes())]),
    ] {
        let scene = parsed(&bytes);
        assert_eq!(scene.objects, ["a & b"]);
        assert_eq!(corners(&scene)[3], [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
        assert_eq!((scene.soup.faces.len(), &scene.materials[..]), (4, &[None][..]));
        assert!(scene.ignored.is_empty() && scene.remarks.is_empty() && scene.faults.sentences().next().is_none());
    }
}

/// A relation says which part is the main model.
#[test]
fn the_main_model_has_any_name() {
    let text = model(&object(r#"id="1""#, [""; 4]), r#"<item objectid="1"/>"#);
    let relations = |target: &str| {
        format!(
            r#"<?xml version="1.0"?><Relationships><Relationship Target="/a.png" Id="1" Type="http://schemas.openxmlformats.org/package/2006/relationships/metadata/thumbnail"/><Relationship Target="{target}" Id="0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>"#
        )
    };
    let bytes = packed(&[("_rels/.rels", relations("/3D/Other Model.model").as_bytes()), ("3D/Other Model.model", text.as_bytes())]);
    assert_eq!(parsed(&bytes).soup.faces.len(), 4);
    // A relation that leads nowhere, and one that is no XML, are as none.
    for wrong in [relations("/../../etc/passwd"), relations("3D/none.model"), "<<".to_owned(), String::new()] {
        let bytes = packed(&[("_rels/.rels", wrong.as_bytes()), ("3D/3dmodel.model", text.as_bytes())]);
        assert_eq!(parsed(&bytes).soup.faces.len(), 4, "{wrong}");
    }
    let error = refused(&packed(&[("a.obj", b"v 0 0 0")]));
    assert_eq!(
        error,
        "3MF: the archive has no model, which is a part such as 3D/3dmodel.model; if another model is in it, unpack it, or else export it again"
    );
}

/// First the transform of the component, then that of the item; a mirrored object keeps its outside.
#[test]
fn components_stand_where_transforms_put_them() {
    let inner = object(r#"id="1" name="part""#, [""; 4]);
    let outer = r#"<object id="2" name="whole"><components><component objectid="1" transform="0 1 0 -1 0 0 0 0 1 10 0 0"/><component objectid="1"/></components></object>"#;
    let build = r#"<item objectid="2" transform="2 0 0 0 2 0 0 0 2 0 0 5"/><item objectid="1" transform="-1 0 0 0 1 0 0 0 1 0 0 0"/>"#;
    let scene = parsed(&of_model(&model(&(inner + outer), build)));
    assert_eq!(scene.objects, ["part"; 3]);
    let corners = corners(&scene);
    // (1, 0, 0) turns to (0, 1, 0), moves to (10, 1, 0), doubles and rises.
    assert_eq!(corners[3], [[20.0, 2.0, 5.0], [18.0, 0.0, 5.0], [20.0, 0.0, 7.0]]);
    assert_eq!(corners[7], [[2.0, 0.0, 5.0], [0.0, 2.0, 5.0], [0.0, 0.0, 7.0]]);
    assert_eq!(corners[11], [[-1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]]);
    // A component without a name has the name of the object that it is in.
    let inner = object(r#"id="1""#, [""; 4]);
    assert_eq!(parsed(&of_model(&model(&(inner + outer), build))).objects, ["whole", "whole", ""]);
}

/// A file as slicers write it: components in other parts of the archive, each of which counts its objects anew.
#[test]
fn components_may_be_in_other_parts() {
    let inner = model(&object(r#"id="1""#, [""; 4]), "");
    let outer = r#"<object id="1" name="plate" type="model"><components><component p:path="/3D/Objects/object_1.model" objectid="1" transform="1 0 0 0 1 0 0 0 1 7 0 0"/></components></object>"#;
    let outer = model(outer, r#"<item objectid="1" printable="1"/>"#)
        .replace("<resources>", "<metadata name=\"Application\">x</metadata>\n<resources>");
    let parts = [("3D/3dmodel.model", outer.as_bytes()), ("3D/Objects/object_1.model", inner.as_bytes())];
    let scene = parsed(&packed(&parts));
    assert_eq!((&scene.objects[..], corners(&scene)[3][0]), (&["plate".to_owned()][..], [8.0, 0.0, 0.0]));
    assert_eq!(refused(&packed(&parts[..1])), "3MF: the part 3D/Objects/object_1.model is missing in the archive; export the model again");
    let inches = inner.replace("millimeter", "inch");
    let error = refused(&packed(&[parts[0], (parts[1].0, inches.as_bytes())]));
    assert_eq!(error, "3MF: 3D/Objects/object_1.model: its unit is inch, and 3D/3dmodel.model has millimeter; export all in one unit");
}

#[test]
fn triangles_have_base_materials() {
    let bases = r##"<basematerials id="5"><base name="red" displaycolor="#FF0000"/><base name="half blue" displaycolor="#0000FF80"/></basematerials>"##;
    let faces = [r#"pid="5" p1="1""#, r#"p1="1""#, "", r#"pid="9" p1="0""#];
    let text = model(&format!("{bases}{}", object(r#"id="1" pid="5" pindex="0""#, faces)), r#"<item objectid="1"/>"#);
    let scene = parsed(&of_model(&text));
    let names: Vec<_> = scene.materials.iter().map(|material| material.as_ref().map(|material| &material.name[..])).collect();
    assert_eq!(names, [Some("half blue"), Some("red"), None]);
    assert_eq!(scene.soup.faces.iter().map(|face| face.submesh.material).collect::<Vec<_>>(), [0, 0, 1, 2]);
    let colours: Vec<_> = scene.materials.iter().flatten().filter_map(|material| material.diffuse).collect();
    assert_eq!(colours, [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]);
    let transparency: Vec<_> = scene.materials.iter().flatten().map(|material| (255.0 * material.transparency).round()).collect();
    assert!(transparency == [127.0, 0.0] && scene.ignored.is_empty(), "{transparency:?} {:?}", scene.ignored);
    assert_eq!(
        scene.faults.sentences().collect::<Vec<_>>(),
        ["1 triangle has a material or a colour that the file does not have, and is drawn without it: object 1, triangle 4"]
    );
    // The two last digits of a colour are its opacity, as in other formats.
    let place = tempfile::tempdir().unwrap();
    let file = place.path().join("a.3mf");
    fs::write(&file, of_model(&text.replace("0000FF80", "0000FF00"))).unwrap();
    let of = |opaque: bool| {
        let Imported { materials, remarks, .. } = import::file_by(&file, Weld::default(), Rules { opaque, ..Rules::default() }).unwrap();
        let is_told =
            remarks.iter().any(|remark| remark.starts_with("the file makes these materials invisible") && remark.contains("blue"));
        (materials[0].as_ref().map(|material| material.transparency), is_told)
    };
    assert_eq!([of(false), of(true)], [(Some(1.0), true), (Some(0.0), false)]);
}

/// Corners have colours of their own, which are opaque. A face without colours has the material of the command line.
#[test]
fn triangles_have_colours_of_groups() {
    let colours =
        r##"<m:colorgroup id="7"><m:color color="#00FF00"/><m:color color="#FF0000FF"/><m:color color="#0000FF40"/></m:colorgroup>"##;
    let faces = [r#"pid="7" p1="1" p2="2" p3="0""#, r#"pid="7" p1="1""#, "", r#"pid="7" p1="1" p2="3" p3="0""#];
    let bytes = of_model(&model(&format!("{colours}{}", object(r#"id="1" pid="7" pindex="2""#, faces)), r#"<item objectid="1"/>"#));
    let scene = parsed(&bytes);
    let of_face =
        |face: usize| scene.soup.faces[face].corners.iter().map(|corner| Some(scene.soup.colours[corner.colour?])).collect::<Vec<_>>();
    let [green, red, blue] = [[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]].map(Some);
    assert_eq!([of_face(0), of_face(1), of_face(2), of_face(3)], [vec![red, blue, green], vec![red; 3], vec![blue; 3], vec![None; 3]]);
    assert_eq!(scene.faults.sentences().count(), 1);
    assert_eq!(scene.ignored.iter().collect::<Vec<_>>(), [&"opacity of groups of colours"]);
    let place = tempfile::tempdir().unwrap();
    let file = place.path().join("a.3mf");
    fs::write(&file, bytes).unwrap();
    let Imported { mesh, materials, remarks, painted, .. } = import::file(&file, Weld::default()).unwrap();
    let names: Vec<_> = materials.iter().map(|material| material.as_ref().map(|material| &material.name[..])).collect();
    assert_eq!((names, painted.triangles, painted.of_one_colour), (vec![None, Some("white")], 3, 2));
    assert_eq!(mesh.coats, [Coat::Palette(vec![[0, 0, 255], [255, 0, 0], [0, 255, 0]])]);
    assert!(remarks.iter().any(|remark| remark.starts_with("3 triangles have 3 colours")), "{remarks:?}");
    let error = import::file_by(&file, Weld::default(), Rules { strict: true, ..Rules::default() }).unwrap_err();
    assert!(format!("{error:#}").contains("triangle 4; --strict refuses it"), "{error:#}");
}

/// A texture is a part of the archive. Without it the mesh is drawn all the same.
#[test]
fn triangles_have_textures() {
    let mut image = Vec::new();
    let mut encoder = png::Encoder::new(&mut image, 1, 2);
    encoder.set_color(png::ColorType::Rgb);
    encoder.write_header().unwrap().write_image_data(&[255, 0, 0, 0, 0, 255]).unwrap();
    let resources = r#"<m:texture2d id="3" path="/3D/Textures/a.png" contenttype="image/png"/><m:texture2dgroup id="4" texid="3"><m:tex2coord u="0.5" v="0.2"/><m:tex2coord u="0.5" v="0.8"/></m:texture2dgroup>"#;
    let faces = [r#"pid="4" p1="0""#, r#"pid="4" p1="1""#, r#"pid="4" p1="0""#, r#"pid="4" p1="0""#];
    let text = model(&format!("{resources}{}", object(r#"id="1""#, faces)), r#"<item objectid="1"/>"#);
    let place = tempfile::tempdir().unwrap();
    let file = place.path().join("a");
    fs::write(&file, packed(&[("3D/3dmodel.model", text.as_bytes()), ("3D/Textures/a.png", &image)])).unwrap();
    let Imported { mesh, materials, .. } = import::file(&file, Weld::default()).unwrap();
    let names: Vec<_> = materials.iter().flatten().map(|material| &material.name[..]).collect();
    // The lower row is blue, and most faces are there.
    assert_eq!((names, &mesh.coats[..]), (vec!["white"], &[Coat::Palette(vec![[0, 0, 255], [255, 0, 0]])][..]));
    fs::write(&file, packed(&[("3D/3dmodel.model", text.as_bytes())])).unwrap();
    let Imported { remarks, .. } = import::file(&file, Weld::default()).unwrap();
    let without = Rules { colours: Colours::None, ..Rules::default() };
    assert_eq!(import::file_by(&file, Weld::default(), without).unwrap().remarks, ["left out: texture coordinates, textures"]);
    let said = "the texture /3D/Textures/a.png is left out: the part /3D/Textures/a.png is missing in the archive; export the model again";
    assert!(remarks.iter().any(|remark| remark == said), "{remarks:?}");
}

/// What is left out is said.
#[test]
fn other_contents_are_left_out() {
    let mixture = r#"<m:multiproperties id="8" pids="5 7"><m:multi pindices="0 1"/></m:multiproperties><s:slicestack id="9"><s:slice><s:vertices><s:vertex x="a"/></s:vertices></s:slice></s:slicestack>"#;
    let help = object(r#"id="2" type="support""#, [""; 4]);
    let lattice = object(r#"id="3""#, [r#"pid="8" p1="0""#, r#"paint_color="4""#, "", ""])
        .replace("</mesh>", "<b:beamlattice><vertices><vertex/></vertices></b:beamlattice></mesh>");
    let text = model(&format!("{mixture}{help}{lattice}"), r#"<item objectid="2"/><item objectid="3"/>"#);
    let text = text.replace(
        "<model ",
        "<model requiredextensions=\"b s m x\" xmlns:b=\"http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02\" ",
    );
    let scene = parsed(&of_model(&text));
    assert_eq!(scene.soup.faces.len(), 4);
    assert_eq!(
        scene.ignored.into_iter().collect::<Vec<_>>(),
        ["colours painted in a slicer", "lattices of beams", "mixtures of materials", "slices", "supports for printing"]
    );
    let error = refused(&of_model(&model(&help, r#"<item objectid="2"/>"#)));
    let wrong =
        "nothing that is to be built has triangles (left out: supports for printing); export the model again as a mesh of triangles";
    assert_eq!(error, format!("3MF: 3D/3dmodel.model: {wrong}"));
    assert_eq!(scene.remarks, ["the file needs extensions of 3MF that are not read, and parts of it may be missing: b, s, x"]);
}

/// Errors name the part, the line and the element.
#[test]
fn errors_name_the_place() {
    let good = model(&object(r#"id="1""#, [""; 4]), r#"<item objectid="1"/>"#);
    let main = "3MF: 3D/3dmodel.model";
    for (from, to, wrong) in [
        ("</vertices>", "</vertice>", ": line 5: </vertice> is there where </vertices> is needed; export the model again"),
        ("</model>\n", "", ": the text ends before its last element does; it was cut off: get the file again"),
        ("</build>\n</model>\n", "</bui", ": line 13: the text ends within an element or a comment; it was cut off: get the file again"),
        ("v1=\"1\"", "v1=\"4\"", ": line 10: object 1, triangle 4: v1: vertex 4 is out of range; they count from 0, and the object has 4"),
        ("v3=\"3\"", "v3=\"-3\"", ": line 8: object 1, triangle 2: v3 is \"-3\", not a whole number from 0 on"),
        (" v3=\"3\"", "", ": line 8: object 1, triangle 2: v3 is missing"),
        ("x=\"1\"", "x=\"one\"", ": line 5: object 1, vertex 1: x is \"one\", not a number"),
        ("x=\"1\"", "x=\"NaN\"", ": line 5: object 1, vertex 1: x is NaN; coordinates must be finite and below 1e100"),
        (
            "x=\"1\"",
            "x=1",
            ": line 5: object 1, vertex 1: an attribute of <vertex> is not written as name=\"value\"; export the model again",
        ),
        ("id=\"1\"", "", ": line 4: <object>: id is missing"),
        (
            "<item objectid=\"1\"/>",
            "<item objectid=\"2\"/>",
            ": it names object 2, which is missing in 3D/3dmodel.model; export the model again",
        ),
        ("<item objectid=\"1\"/>", "<item/>", ": line 13: item 1: objectid is missing"),
        ("<item objectid=\"1\"/>", "", ": nothing is to be built; put objects on the plate, and export them again"),
        (
            "<item objectid=\"1\"",
            "<item objectid=\"1\" transform=\"1 0 0\"",
            ": line 13: item 1: transform is \"1 0 0\", not 12 numbers with blanks between them",
        ),
        (
            "<item objectid=\"1\"",
            "<item objectid=\"1\" transform=\"1e99 0 0 0 1 0 0 0 1 1e100 0 0\"",
            ", object 1: vertex 1: where it is placed, coordinates must be finite and below 1e100",
        ),
        (
            "millimeter",
            "parsec",
            ": line 2: unit is \"parsec\"; 3MF has micron, millimeter, centimeter, inch, foot, meter: export the model in one of them",
        ),
        ("<model ", "<html ", ": line 2: the part begins with <html> and not with <model>; export the model again as 3MF"),
        (
            "<resources>",
            "<resources><basematerials id=\"2\"><base displaycolor=\"red\"/></basematerials>",
            ": line 3: property group 2, <base>: displaycolor is \"red\", not a colour, which is # and 6 or 8 hexadecimal digits",
        ),
        ("<resources>", "<resources><object id=\"1\"/>", ": line 4: <object>: there are two objects with the id 1; export the model again"),
    ] {
        assert!(good.contains(from), "{from}");
        assert_eq!(refused(&of_model(&good.replacen(from, to, 1))), format!("{main}{wrong}"), "{from} -> {to}");
    }
    assert_eq!(refused(&of_model("")), format!("{main}: there is no element <model>; export the model again as 3MF"));
    let circle = r#"<object id="1"><components><component objectid="2"/></components></object><object id="2"><components><component objectid="1"/><component objectid="1"/></components></object>"#;
    let error = refused(&of_model(&model(circle, r#"<item objectid="1"/>"#)));
    assert_eq!(error, format!("{main}, object 1: the object is a component of itself; export the model again"));
}

/// A small file can place very much: each object has the one before it ten times.
#[test]
fn components_of_components_are_limited() {
    let nested = |innermost: String, depth: usize| {
        let mut resources = innermost;
        for id in 2..2 + depth {
            let components = format!("<component objectid=\"{}\"/>", id - 1).repeat(10);
            write!(resources, "<object id=\"{id}\"><components>{components}</components></object>").unwrap();
        }
        of_model(&model(&resources, &format!("<item objectid=\"{}\"/>", 1 + depth)))
    };
    assert_eq!(parsed(&nested(object(r#"id="1""#, [""; 4]), 3)).soup.faces.len(), 4000);
    for innermost in [object(r#"id="1""#, [""; 4]), "<object id=\"1\"/>".to_owned()] {
        let error = refused(&nested(innermost, 20));
        assert!(error.ends_with("more than 65,536 components are to be built; simplify the model"), "{error}");
    }
    let many =
        object(r#"id="1""#, [""; 4]).replace("</triangles>", &format!("{}</triangles>", format!("<triangle {}/>", FACES[0]).repeat(3000)));
    let error = refused(&nested(many, 4));
    assert!(
        error.ends_with("3dmodel.model: more than 16,777,216 triangles or vertices are to be built; simplify the model in another program"),
        "{error}"
    );
}

/// Archives that other programs write, and such as no program should.
#[test]
fn archives_are_unpacked_as_3mf_allows() {
    let text = model(&object(r#"id="1""#, [""; 4]), r#"<item objectid="1"/>"#);
    let parts = [("3D/3dmodel.model", text.as_bytes())];
    let by = |how| refused(&packed_by(&parts, how));
    assert_eq!(
        by(How { method: CompressionMethod::LZMA, ..DEFLATED }),
        "3MF: the part 3D/3dmodel.model is compressed by LZMA; 3MF has parts that are compressed by Deflate or not at all: export the model again"
    );
    assert_eq!(by(How { encrypted: true, ..DEFLATED }), "3MF: the part 3D/3dmodel.model is encrypted; save the model without a password");
    let good = packed(&parts);
    let cut = "3MF: the archive is damaged or cut off; get the file again";
    assert_eq!(refused(&good[..good.len() - 30]), cut);
    assert_eq!(refused(&good[..good.len() / 2]), cut);
    let mut damaged = good.clone();
    damaged[60] ^= 0x55;
    assert_eq!(refused(&damaged), "3MF: the part 3D/3dmodel.model is damaged; get the file again");
    assert_eq!(refused(b"v 0 0 0"), "3MF: the file is no zip archive, as 3MF is; give it the ending of its format, or export it again");
    // XML may be in UTF-16.
    let wide: Vec<u8> = "\u{FEFF}".encode_utf16().chain(text.encode_utf16()).flat_map(u16::to_le_bytes).collect();
    assert_eq!(corners(&parsed(&packed(&[("3D/3dmodel.model", &wide)]))), corners(&parsed(&good)));
    // The size that the directory says, and that a bomb does not hide.
    let directory = good.windows(4).position(|word| word == b"PK\x01\x02").unwrap();
    let mut huge = good.clone();
    huge[directory + 24..directory + 28].copy_from_slice(&0x7FFF_FFFFu32.to_le_bytes());
    assert_eq!(
        refused(&huge),
        "3MF: the part 3D/3dmodel.model makes the model larger than 1,073,741,824 bytes when it is unpacked; simplify it in another program"
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    /// Whatever is cut off or damaged, there is no panic.
    #[test]
    fn damaged_files_are_errors(cut in any::<prop::sample::Index>(), bytes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..4)) {
        let colours = r##"<m:colorgroup id="7"><m:color color="#00FF00"/></m:colorgroup>"##;
        let text = model(&format!("{colours}{}", object(r#"id="1" pid="7""#, [""; 4])), r#"<item objectid="1"/>"#);
        let mut damaged = text.clone().into_bytes();
        for (index, byte) in &bytes {
            let place = index.index(damaged.len());
            damaged[place] = *byte;
        }
        let _ = threemf::parse(&packed(&[("3D/3dmodel.model", &damaged)]), Colours::Corners);
        let mut whole = packed_by(&[("3D/3dmodel.model", text.as_bytes())], How { method: CompressionMethod::STORE, ..DEFLATED });
        let _ = threemf::parse(&whole[..cut.index(whole.len())], Colours::Corners);
        for (index, byte) in bytes {
            let place = index.index(whole.len());
            whole[place] = byte;
        }
        let _ = threemf::parse(&whole, Colours::Corners);
    }
}
