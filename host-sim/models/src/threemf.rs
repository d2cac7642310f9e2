//! Reads 3MF, which slicers and CAD programs write: the triangles of the objects that are to be built, where components and items put them, with
//! their colours; tells what else there is.
//!
//! The libraries `rawzip` and `quick-xml` read the archive and its texts. Crates for 3MF itself are young, and read what is not needed here.

mod archive;
mod model;
mod xml;

use crate::{
    contents::{Colours, Contents},
    faults,
    fields::quoted,
    mesh::{Corner, Face, Smoothing, Submesh},
    number::grouped,
    obj::LARGEST,
    text,
    texture::{Images, Texture},
    transform::Transform,
};
use anyhow::{Context, Result, bail, ensure};
use archive::Archive;
use model::{Group, Model, Object, Paint, Placed};
use std::{
    collections::{BTreeSet, HashMap, hash_map::Entry},
    rc::Rc,
};

/// Most triangles, and most vertices, of all objects where they stand. Few components can place very many.
const MOST: usize = 1 << 24;
/// Most components and items, each counted where it stands.
const MOST_PLACED: usize = 1 << 16;

/// A triangle whose colours are missing.
const WITHOUT_COLOUR: faults::Kind = [
    "triangle has a material or a colour that the file does not have, and is drawn without it",
    "triangles have materials or colours that the file does not have, and are drawn without them",
];

/// Whether a file is 3MF, or an archive that is named so.
pub(crate) fn is_3mf(bytes: &[u8], named: bool) -> bool {
    archive::is_archive(bytes) && (named || archive::has_model(bytes))
}

/// Reads what a file says is to be built. Images are read only if their colours are wanted.
///
/// # Errors
/// The error names the part of the archive, the line or the object, and its fault.
pub fn parse(bytes: &[u8], colours: Colours) -> Result<Contents> {
    of_archive(Archive::open(bytes).context("3MF")?, colours).context("3MF")
}

/// Reads the main model and all models that it needs, then places their objects.
fn of_archive(mut archive: Archive<'_>, colours: Colours) -> Result<Contents> {
    let mut names = vec![archive.main_model()?];
    let mut models: Vec<Model> = Vec::new();
    let mut numbers = HashMap::from([(archive::key(&names[0]), 0)]);
    while let Some(name) = names.get(models.len()) {
        let place = quoted(name);
        let text = text::decoded(&archive.read(name)?);
        let text = text.strip_prefix('\u{FEFF}').unwrap_or(&text);
        let model = Model::read(text).context(place.clone())?;
        let unit = &models.first().unwrap_or(&model).unit;
        ensure!(model.unit == *unit, "{place}: its unit is {}, and {} has {unit}; export all in one unit", model.unit, quoted(&names[0]));
        let components = model.objects.values().flat_map(|object| &object.components);
        for path in model.items.iter().chain(components).filter_map(|placed| placed.path.as_ref()) {
            let number = numbers.len();
            if let Entry::Vacant(unknown) = numbers.entry(archive::key(path)) {
                unknown.insert(number);
                names.push(path.trim_start_matches('/').to_owned());
            }
        }
        models.push(model);
    }
    let mut builder = Builder {
        models: &models,
        names: &names,
        numbers: &numbers,
        archive,
        images: Images::default(),
        colours,
        known: HashMap::new(),
        firsts: HashMap::new(),
        scene: Contents::default(),
    };
    builder.build()?;
    let mut scene = builder.scene;
    scene.ignored.extend(models.iter().flat_map(|model| &model.ignored));
    let unread: BTreeSet<&str> = models.iter().flat_map(|model| &model.unread).map(String::as_str).collect();
    if !unread.is_empty() {
        let extensions = unread.into_iter().collect::<Vec<_>>().join(", ");
        scene.remarks.push(format!("the file needs extensions of 3MF that are not read, and parts of it may be missing: {extensions}"));
    }
    Ok(scene)
}

/// What gives triangles a material of their own: an element of a group of materials, or a texture.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum Look {
    None,
    Material { model: usize, group: u32, element: u32 },
    Texture { model: usize, texture: u32 },
}

/// What the corners of a triangle have.
#[derive(Default)]
struct Painted {
    material: usize,
    colours: Option<[usize; 3]>,
    places: Option<[usize; 3]>,
}

/// Places objects, and what it has placed so far.
struct Builder<'a> {
    models: &'a [Model],
    /// The parts of the models.
    names: &'a [String],
    /// The models of the parts.
    numbers: &'a HashMap<String, usize>,
    archive: Archive<'a>,
    images: Images,
    /// What becomes of colours.
    colours: Colours,
    /// Materials of the scene.
    known: HashMap<Look, usize>,
    /// Where the colours or places of a property group begin in those of the scene.
    firsts: HashMap<(usize, u32), usize>,
    scene: Contents,
}

/// An object that is to be placed.
struct Open<'a> {
    placed: &'a Placed,
    /// The model that names it, and how its errors call it.
    model: usize,
    parent: Option<u32>,
    /// What its parents do to it.
    transform: Transform,
    /// The name of the nearest parent that has one.
    name: Rc<str>,
    depth: usize,
}

impl<'a> Builder<'a> {
    fn build(&mut self) -> Result<()> {
        let objects: usize = self.models.iter().map(|model| model.objects.len()).sum();
        let items = &self.models[0].items;
        let main = quoted(&self.names[0]);
        ensure!(!items.is_empty(), "{main}: nothing is to be built; put objects on the plate, and export them again");
        let item = |placed| Open { placed, model: 0, parent: None, transform: Transform::NONE, name: Rc::from(""), depth: 0 };
        // In the order of the file.
        let mut open: Vec<Open<'a>> = items.iter().rev().map(item).collect();
        let (mut count, mut vertices, mut triangles) = (0, 0, 0);
        let mut standing = Vec::new();
        while let Some(Open { placed, model, parent, transform, name, depth }) = open.pop() {
            count += 1;
            let place = || match parent {
                Some(parent) => format!("{}, object {parent}", quoted(&self.names[model])),
                None => main.clone(),
            };
            ensure!(count <= MOST_PLACED, "{}: more than {} components are to be built; simplify the model", place(), grouped(MOST_PLACED));
            ensure!(depth <= objects, "{}: the object is a component of itself; export the model again", place());
            let model = placed.path.as_ref().and_then(|path| self.numbers.get(&archive::key(path))).copied().unwrap_or(model);
            let id = placed.object;
            let Some(object) = self.models.get(model).and_then(|model| model.objects.get(&id)) else {
                bail!("{}: it names object {id}, which is missing in {}; export the model again", place(), quoted(&self.names[model]))
            };
            let transform = transform.then(&placed.transform);
            let name = if object.name.is_empty() { name } else { object.name.clone() };
            for placed in object.components.iter().rev() {
                open.push(Open { placed, model, parent: Some(id), transform, name: name.clone(), depth: depth + 1 });
            }
            if object.is_model && !object.triangles.is_empty() {
                vertices += object.vertices.len();
                triangles += object.triangles.len();
                ensure!(
                    vertices.max(triangles) <= MOST,
                    "{main}: more than {} triangles or vertices are to be built; simplify the model in another program",
                    grouped(MOST)
                );
                standing.push((model, id, object, transform, name));
            }
        }
        if standing.is_empty() {
            let others: BTreeSet<&str> = self.models.iter().flat_map(|model| &model.ignored).copied().collect();
            let others = others.into_iter().collect::<Vec<_>>().join(", ");
            let found = if others.is_empty() { others } else { format!(" (left out: {others})") };
            bail!("{main}: nothing that is to be built has triangles{found}; export the model again as a mesh of triangles");
        }
        // Only now, so that too much takes neither time nor memory.
        for (model, id, object, transform, name) in standing {
            self.place(model, id, object, &transform).with_context(|| format!("{}, object {id}", quoted(&self.names[model])))?;
            self.scene.objects.push(name.to_string());
        }
        Ok(())
    }

    /// Adds the triangles of an object.
    fn place(&mut self, model: usize, id: u32, object: &Object, transform: &Transform) -> Result<()> {
        let number = self.scene.objects.len();
        let soup = &mut self.scene.soup;
        let first = soup.positions.len();
        for (vertex, &position) in object.vertices.iter().enumerate() {
            let position = transform.point(position);
            let is_right = position.iter().all(|c| c.is_finite() && c.abs() <= LARGEST);
            ensure!(is_right, "vertex {vertex}: where it is placed, coordinates must be finite and below {LARGEST:e}");
            soup.positions.push(position);
        }
        let order = if transform.mirrors() { [0, 2, 1] } else { [0, 1, 2] };
        for (triangle, count) in object.triangles.iter().zip(1..) {
            let painted = self.painted(model, triangle.paint, || format!("object {id}, triangle {count}"));
            let corner = |k: usize| Corner {
                position: first + triangle.corners[k] as usize,
                normal: None,
                colour: painted.colours.map(|colours| colours[k]),
                place: painted.places.map(|places| places[k]),
            };
            self.scene.soup.faces.push(Face {
                corners: order.map(corner).to_vec(),
                submesh: Submesh { object: number, material: painted.material, is_back: false },
                smoothing: Smoothing::ByAngle,
            });
        }
        Ok(())
    }

    /// What the corners of a triangle have. A mesh is of use without its colours.
    fn painted(&mut self, model: usize, paint: Option<Paint>, place: impl FnOnce() -> String) -> Painted {
        let plain = |builder: &mut Self| Painted { material: builder.material(Look::None), ..Painted::default() };
        let Some(Paint { group, elements }) = paint else { return plain(self) };
        let models = self.models;
        let known = models[model].groups.get(&group);
        let has = |count: usize| elements.iter().all(|&element| (element as usize) < count);
        let from = |first: usize| Some(elements.map(|element| first + element as usize));
        match known {
            // Materials are not mixed within a triangle: its first corner decides.
            Some(Group::Materials(materials)) if (elements[0] as usize) < materials.len() => {
                Painted { material: self.material(Look::Material { model, group, element: elements[0] }), ..Painted::default() }
            }
            Some(Group::Colours(colours)) if has(colours.len()) => {
                let all = &mut self.scene.soup.colours;
                let first = *self.firsts.entry((model, group)).or_insert(all.len());
                if first == all.len() {
                    all.extend(colours);
                }
                Painted { colours: from(first), ..plain(self) }
            }
            Some(Group::Places { texture, places }) if has(places.len()) => {
                let all = &mut self.scene.soup.places;
                let first = *self.firsts.entry((model, group)).or_insert(all.len());
                if first == all.len() {
                    all.extend(places);
                }
                Painted { material: self.material(Look::Texture { model, texture: *texture }), places: from(first), ..Painted::default() }
            }
            Some(Group::Mixtures) => {
                self.scene.ignored.insert("mixtures of materials");
                plain(self)
            }
            _ => {
                self.scene.faults.add(WITHOUT_COLOUR, place);
                plain(self)
            }
        }
    }

    /// The number of a material in the scene.
    fn material(&mut self, look: Look) -> usize {
        if let Some(&known) = self.known.get(&look) {
            return known;
        }
        let (material, texture) = match look {
            Look::None => (None, None),
            Look::Material { model, group, element } => match self.models[model].groups.get(&group) {
                Some(Group::Materials(materials)) => (materials.get(element as usize).cloned(), None),
                _ => (None, None),
            },
            Look::Texture { model, texture } => (None, self.texture(model, texture)),
        };
        let number = self.scene.materials.len();
        self.scene.materials.push(material);
        self.scene.textures.push(texture);
        self.known.insert(look, number);
        number
    }

    /// A texture of a model, or nothing if it cannot be read, which is said.
    fn texture(&mut self, model: usize, texture: u32) -> Option<Texture> {
        let Self { models, images, archive, scene, .. } = self;
        if self.colours == Colours::None {
            scene.ignored.insert("textures");
            return None;
        }
        let Some(path) = models[model].textures.get(&texture) else {
            scene.remarks.push(format!("the texture {texture} is left out: the file does not have it"));
            return None;
        };
        let left_out = |error| scene.remarks.push(format!("the texture {} is left out: {error:#}", quoted(path)));
        let image = images.read(&archive::key(path), || archive.read(path), left_out)?;
        // Rows of an image count from the top, and places from the bottom.
        Some(Texture { image, transform: [[1.0, 0.0, 0.0], [0.0, -1.0, 1.0]] })
    }
}
