//! Reads one part of a 3MF file that is a model: its objects, colours and items, as they are written. Where the objects stand is not its matter.
//!
//! The specifications are those of the 3MF Consortium: Core 1.3, the colours and textures of Materials 1.2, and the paths of Production 1.1.

use super::xml::{Attribute, attributes, needed};
use crate::{fields::quoted, mtl::Material, number::grouped, transform::Transform, vector::V3};
use anyhow::{Context, Result, bail, ensure};
use quick_xml::{
    Reader,
    events::{BytesStart, Event},
};
use std::{
    borrow::Cow,
    collections::{BTreeSet, HashMap},
    rc::Rc,
};

/// Most objects, property groups, textures, components and items of a part.
const MOST: usize = 1 << 16;
/// Most characters of a name that are kept. A stream keeps fewer.
const LONGEST: usize = 1000;
/// The lengths that a file may count in.
const UNITS: [&str; 6] = ["micron", "millimeter", "centimeter", "inch", "foot", "meter"];
/// Namespaces of extensions that are read, or that change neither shapes nor colours.
const KNOWN: [&str; 4] = [
    "http://schemas.microsoft.com/3dmanufacturing/core/2015/02",
    "http://schemas.microsoft.com/3dmanufacturing/material/2015/02",
    "http://schemas.microsoft.com/3dmanufacturing/production/2015/06",
    "http://schemas.microsoft.com/3dmanufacturing/trianglesets/2021/07",
];

/// The contents of a model.
#[derive(Debug, Default)]
pub(super) struct Model {
    /// The length that its numbers count.
    pub(super) unit: String,
    pub(super) objects: HashMap<u32, Object>,
    pub(super) groups: HashMap<u32, Group>,
    /// The parts of textures.
    pub(super) textures: HashMap<u32, String>,
    /// What is to be built.
    pub(super) items: Vec<Placed>,
    /// Contents that are left out, in words.
    pub(super) ignored: BTreeSet<&'static str>,
    /// Prefixes of extensions without which the model is not whole, and that are not read.
    pub(super) unread: BTreeSet<String>,
}

/// An object.
#[derive(Debug)]
pub(super) struct Object {
    pub(super) name: Rc<str>,
    /// Whether it is a part of the model, and no help for printing.
    pub(super) is_model: bool,
    /// What triangles have that say nothing themselves.
    paint: Option<Paint>,
    pub(super) vertices: Vec<V3>,
    pub(super) triangles: Vec<Triangle>,
    pub(super) components: Vec<Placed>,
}

/// An object in another object or on the plate.
#[derive(Debug)]
pub(super) struct Placed {
    pub(super) object: u32,
    /// The part in which the object is, if it is another one.
    pub(super) path: Option<String>,
    pub(super) transform: Transform,
}

/// A triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Triangle {
    /// Vertices of the object.
    pub(super) corners: [u32; 3],
    pub(super) paint: Option<Paint>,
}

/// Elements of a property group that the corners of a triangle have.
#[derive(Clone, Copy, Debug)]
pub(super) struct Paint {
    pub(super) group: u32,
    pub(super) elements: [u32; 3],
}

/// Properties that surfaces can have.
#[derive(Debug)]
pub(super) enum Group {
    Materials(Vec<Material>),
    Colours(Vec<V3>),
    /// Places on a texture.
    Places {
        texture: u32,
        places: Vec<[f64; 2]>,
    },
    /// Mixtures of other properties.
    Mixtures,
}

/// An element that is open.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Element {
    Document,
    Model,
    Resources,
    Object(u32),
    Mesh(u32),
    Vertices(u32),
    Triangles(u32),
    Components(u32),
    Group(u32),
    Build,
    /// One in which nothing is read.
    Other,
}

impl Model {
    /// Reads the text of a part.
    ///
    /// # Errors
    /// The error names the line and its fault.
    pub(super) fn read(text: &str) -> Result<Self> {
        let mut model = Self::default();
        let mut reader = Reader::from_str(text);
        reader.config_mut().expand_empty_elements = true;
        let line = |position: u64| 1 + text.bytes().take(position as usize).filter(|&byte| byte == b'\n').count();
        let mut open = vec![Element::Document];
        loop {
            // White space in front of an element is an event of its own, so that this is the line of the element.
            let start = reader.buffer_position();
            match reader.read_event() {
                Ok(Event::Start(tag)) => {
                    let parent = open.last().copied().unwrap_or(Element::Other);
                    let element = model.element(parent, &tag).with_context(|| format!("line {}", line(start)))?;
                    open.push(element);
                }
                Ok(Event::End(_)) => drop(open.pop()),
                Ok(Event::Eof) => break,
                Ok(_) => {}
                Err(error) => bail!("line {}: {}", line(reader.error_position()), in_words(&error)),
            }
        }
        ensure!(open == [Element::Document], "the text ends before its last element does; it was cut off: get the file again");
        ensure!(!model.unit.is_empty(), "there is no element <model>; export the model again as 3MF");
        Ok(model)
    }

    /// Reads the beginning of an element.
    fn element(&mut self, parent: Element, tag: &BytesStart<'_>) -> Result<Element> {
        use Element::{Build, Components, Document, Mesh, Object, Other, Resources, Triangles, Vertices};
        let name = tag.local_name();
        let name = name.as_ref();
        let within = || format!("<{name}>");
        match (parent, name) {
            (Document, "model") => return self.root(tag).map(|()| Element::Model),
            (Document, _) => bail!("the part begins with <{}> and not with <model>; export the model again as 3MF", quoted(name)),
            (Element::Model, "resources") => return Ok(Resources),
            (Element::Model, "build") => return Ok(Build),
            (Build, "item") => {
                let item = placed(tag).with_context(|| format!("item {}", self.items.len() + 1))?;
                self.items.push(item);
                ensure!(self.items.len() <= MOST, too_many("items"));
            }
            (Resources, "object") => return self.object(tag).map(Object).with_context(within),
            (Resources, "basematerials" | "colorgroup" | "texture2dgroup" | "compositematerials" | "multiproperties") => {
                return self.group(name, tag).map(Element::Group).with_context(within);
            }
            (Resources, "texture2d") => self.texture(tag).with_context(within)?,
            (Resources, "slicestack") => drop(self.ignored.insert("slices")),
            (Resources, name) if name.ends_with("displayproperties") => drop(self.ignored.insert("highlights of materials")),
            (Resources, "implicitfunction" | "functionfromimage3d" | "volumedata" | "image3d") => drop(self.ignored.insert("volumes")),
            (Object(_), "levelset") => drop(self.ignored.insert("volumes")),
            (Object(_), "displacementmesh") => drop(self.ignored.insert("meshes with displaced surfaces")),
            (Object(_), "booleanshape") => drop(self.ignored.insert("objects that are cut out of one another")),
            (Object(id), "mesh") => return Ok(Mesh(id)),
            (Object(id), "components") => return Ok(Components(id)),
            (Mesh(id), "vertices") => return Ok(Vertices(id)),
            (Mesh(id), "triangles") => return Ok(Triangles(id)),
            (Mesh(_), "beamlattice") => drop(self.ignored.insert("lattices of beams")),
            (Components(id), "component") => {
                let number = |model: &Self| model.objects.get(&id).map_or(0, |object| object.components.len());
                let component = placed(tag).with_context(|| format!("object {id}, component {}", number(self) + 1))?;
                self.objects.entry(id).and_modify(|object| object.components.push(component));
                ensure!(number(self) <= MOST, too_many("components"));
            }
            (Vertices(id), "vertex") => self.vertex(id, tag)?,
            (Triangles(id), "triangle") => self.triangle(id, tag)?,
            (Element::Group(id), name) => {
                self.property(id, name, tag).with_context(|| format!("property group {id}, <{}>", quoted(name)))?
            }
            _ => {}
        }
        Ok(Other)
    }

    fn root(&mut self, tag: &BytesStart<'_>) -> Result<()> {
        let [unit, required] = attributes(tag, ["unit", "requiredextensions"])?;
        let unit = unit.as_ref().map_or(Cow::Borrowed("millimeter"), Attribute::text);
        ensure!(UNITS.contains(&&*unit), "unit is \"{}\"; 3MF has {}: export the model in one of them", quoted(&unit), UNITS.join(", "));
        self.unit = unit.into_owned();
        for prefix in required.iter().flat_map(|required| required.value().split_whitespace()) {
            let declared = tag.attributes().with_checks(false).flatten().find(|attribute| {
                attribute.key.prefix().is_some_and(|xmlns| xmlns.as_ref() == "xmlns") && attribute.key.local_name().as_ref() == prefix
            });
            if !declared.is_some_and(|namespace| KNOWN.contains(&namespace.value.trim())) {
                self.unread.insert(quoted(prefix));
                ensure!(self.unread.len() <= MOST, too_many("extensions"));
            }
        }
        Ok(())
    }

    fn object(&mut self, tag: &BytesStart<'_>) -> Result<u32> {
        let [id, name, kind, group, element] = attributes(tag, ["id", "name", "type", "pid", "pindex"])?;
        let id = needed(id, "id")?.index()?;
        let is_model = match kind.as_ref().map(Attribute::text).as_deref() {
            Some("support" | "solidsupport") => {
                self.ignored.insert("supports for printing");
                false
            }
            Some("other") => {
                self.ignored.insert("objects of the type `other`");
                false
            }
            _ => true,
        };
        let paint = match (group, element) {
            (Some(group), element) => {
                let element = element.map_or(Ok(0), |element| element.index())?;
                Some(Paint { group: group.index()?, elements: [element; 3] })
            }
            (None, _) => None,
        };
        let name = name.as_ref().map(Attribute::text).unwrap_or_default();
        let object = Object {
            name: name.chars().take(LONGEST).collect::<String>().into(),
            is_model,
            paint,
            vertices: Vec::new(),
            triangles: Vec::new(),
            components: Vec::new(),
        };
        ensure!(self.objects.insert(id, object).is_none(), "there are two objects with the id {id}; export the model again");
        ensure!(self.objects.len() <= MOST, too_many("objects"));
        Ok(id)
    }

    fn vertex(&mut self, id: u32, tag: &BytesStart<'_>) -> Result<()> {
        let Some(object) = self.objects.get_mut(&id) else { return Ok(()) };
        let axes = ["x", "y", "z"];
        let place = || format!("object {id}, vertex {}", object.vertices.len());
        let [x, y, z] = attributes(tag, axes).with_context(place)?;
        let mut vertex = [0.0; 3];
        for ((component, axis), attribute) in vertex.iter_mut().zip(axes).zip([x, y, z]) {
            *component = needed(attribute, axis).and_then(|attribute| attribute.number()).with_context(place)?;
        }
        object.vertices.push(vertex);
        Ok(())
    }

    fn triangle(&mut self, id: u32, tag: &BytesStart<'_>) -> Result<()> {
        let Some(object) = self.objects.get_mut(&id) else { return Ok(()) };
        let names = ["v1", "v2", "v3"];
        let place = || format!("object {id}, triangle {}", object.triangles.len() + 1);
        let [v1, v2, v3, group, p1, p2, p3, orca, prusa] =
            attributes(tag, ["v1", "v2", "v3", "pid", "p1", "p2", "p3", "paint_color", "mmu_segmentation"]).with_context(place)?;
        let mut corners = [0; 3];
        for ((corner, name), attribute) in corners.iter_mut().zip(names).zip([v1, v2, v3]) {
            let index = needed(attribute, name).and_then(|attribute| attribute.index()).with_context(place)?;
            let count = object.vertices.len();
            ensure!(
                (index as usize) < count,
                "{}: {name}: vertex {index} is out of range; they count from 0, and the object has {}",
                place(),
                grouped(count)
            );
            *corner = index;
        }
        let index = |attribute: Option<Attribute<'_>>| attribute.map(|attribute| attribute.index()).transpose().with_context(place);
        let group = index(group)?.or(object.paint.map(|paint| paint.group));
        let paint = match (index(p1)?, index(p2)?, index(p3)?, group) {
            (Some(first), second, third, Some(group)) => {
                Some(Paint { group, elements: [first, second.unwrap_or(first), third.unwrap_or(first)] })
            }
            _ => object.paint,
        };
        object.triangles.push(Triangle { corners, paint });
        if orca.is_some() || prusa.is_some() {
            self.ignored.insert("colours painted in a slicer");
        }
        Ok(())
    }

    fn group(&mut self, name: &str, tag: &BytesStart<'_>) -> Result<u32> {
        let [id, texture] = attributes(tag, ["id", "texid"])?;
        let id = needed(id, "id")?.index()?;
        let group = match name {
            "basematerials" => Group::Materials(Vec::new()),
            "colorgroup" => Group::Colours(Vec::new()),
            "texture2dgroup" => Group::Places { texture: needed(texture, "texid")?.index()?, places: Vec::new() },
            _ => Group::Mixtures,
        };
        ensure!(self.groups.insert(id, group).is_none(), "there are two property groups with the id {id}; export the model again");
        ensure!(self.groups.len() <= MOST, too_many("property groups"));
        Ok(id)
    }

    /// An element of a property group.
    fn property(&mut self, id: u32, element: &str, tag: &BytesStart<'_>) -> Result<()> {
        match (self.groups.get_mut(&id), element) {
            (Some(Group::Materials(materials)), "base") => {
                let [name, colour] = attributes(tag, ["name", "displaycolor"])?;
                let (colour, opacity) = needed(colour, "displaycolor")?.colour()?;
                let name = name.as_ref().map(Attribute::text).unwrap_or_default();
                let name = name.chars().take(LONGEST).collect();
                materials.push(Material { transparency: 1.0 - opacity, ..Material::matt(name, colour) });
            }
            (Some(Group::Colours(colours)), "color") => {
                let [colour] = attributes(tag, ["color"])?;
                let (colour, opacity) = needed(colour, "color")?.colour()?;
                colours.push(colour);
                // The specification has it that these colours are opaque unless they are mixed with others.
                self.ignored.extend((opacity < 1.0).then_some("opacity of groups of colours"));
            }
            (Some(Group::Places { places, .. }), "tex2coord") => {
                let [u, v] = attributes(tag, ["u", "v"])?;
                places.push([needed(u, "u")?.number()?, needed(v, "v")?.number()?]);
            }
            _ => {}
        }
        Ok(())
    }

    fn texture(&mut self, tag: &BytesStart<'_>) -> Result<()> {
        let [id, path] = attributes(tag, ["id", "path"])?;
        let (id, path) = (needed(id, "id")?.index()?, needed(path, "path")?);
        self.textures.insert(id, path.text().into_owned());
        ensure!(self.textures.len() <= MOST, too_many("textures"));
        Ok(())
    }
}

fn too_many(what: &str) -> String {
    format!("more than {} {what}, which are too many; simplify the model in another program", grouped(MOST))
}

/// The reference of a component or an item to an object, and its transform.
fn placed(tag: &BytesStart<'_>) -> Result<Placed> {
    let [object, transform, path] = attributes(tag, ["objectid", "transform", "path"])?;
    let transform = transform.map(|transform| transform.numbers::<12>()).transpose()?;
    Ok(Placed {
        object: needed(object, "objectid")?.index()?,
        path: path.map(|path| path.text().into_owned()),
        // Points are rows there, so that its rows are the columns here.
        transform: transform.map_or(Transform::NONE, |m| {
            let column = |k: usize| [m[3 * k], m[3 * k + 1], m[3 * k + 2], 0.0];
            Transform::of_columns(&[0, 1, 2, 3].map(column))
        }),
    })
}

/// What is wrong with a text in XML, and what helps.
fn in_words(error: &quick_xml::Error) -> String {
    use quick_xml::errors::{Error, IllFormedError, SyntaxError};
    let what = match error {
        Error::IllFormed(IllFormedError::MismatchedEndTag { expected, found }) => {
            format!("</{}> is there where </{}> is needed", quoted(found), quoted(expected))
        }
        Error::IllFormed(IllFormedError::UnmatchedEndTag(found)) => format!("</{}> ends no element", quoted(found)),
        Error::Syntax(SyntaxError::InvalidBangMarkup) => "`<!` begins nothing that XML has".to_owned(),
        Error::Syntax(_) => return "the text ends within an element or a comment; it was cut off: get the file again".to_owned(),
        _ => "the text is not XML".to_owned(),
    };
    format!("{what}; export the model again")
}
