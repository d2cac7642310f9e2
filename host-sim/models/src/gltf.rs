//! Reads glTF 2.0, as JSON and as GLB: the triangles of the default scene where its nodes and skins put them, with their materials; tells what else
//! there is. The library `gltf` reads the document.

mod accessor;
mod compressed;
mod document;
mod pose;

use crate::{
    contents::{Colours, Contents},
    faults::{UNUSED_NORMAL, UNUSED_POSITION},
    files::Folder,
    mesh::{Corner, Face, Smoothing, Submesh},
    mtl::Material,
    obj::LARGEST,
    paint::Emission,
    pbr,
    texture::{Images, Texture},
    transform::Transform,
    vector::{V3, add, apply, scale, unit},
};
use accessor::{Bytes, Kind};
use anyhow::{Context, Result, bail};
use compressed::Draco;
pub(crate) use document::is_gltf;
use gltf::{Document, Node, Primitive, Semantic, material::AlphaMode, mesh::Mode, texture::Info};
use pose::Skin;
use std::collections::{BTreeSet, HashSet};

/// Reads the default scene of a file, or its first scene if there is no default. Buffers may be in the file or in its folder.
///
/// # Errors
/// The error names the buffer, mesh or node, and its fault.
pub(crate) fn parse(bytes: &[u8], folder: &Folder, colours: Colours) -> Result<Contents> {
    let (document, blob) = document::open(bytes)?;
    let scene = document.default_scene().or_else(|| document.scenes().next()).context("glTF: it has no scene; export it with one")?;
    let bytes = Bytes::read(&document, blob, folder)?;
    let mut reader = Reader {
        document: &document,
        bytes,
        scene: Contents { ignored: besides(&document), ..Contents::default() },
        numbers: Vec::new(),
        folder,
        images: Images::default(),
        colours,
    };
    let places = pose::of_nodes(&document);
    let mut seen = HashSet::new();
    let mut open: Vec<Node<'_>> = scene.nodes().collect();
    // In the order of the file.
    open.reverse();
    while let Some(node) = open.pop() {
        if !seen.insert(node.index()) {
            bail!("glTF, node {}: the scene reaches it twice; nodes must form a tree", node.index());
        }
        if let Some(mesh) = node.mesh() {
            let name = node.name().filter(|name| !name.is_empty()).or(mesh.name()).unwrap_or_default();
            reader.scene.objects.push(name.to_owned());
            let skin = node.skin().map(|skin| {
                let number = skin.index();
                Skin::read(&skin, &reader.bytes, &places).with_context(|| format!("glTF, skin {number}"))
            });
            let shape = Shape {
                transform: places.get(node.index()).copied().unwrap_or(Transform::NONE),
                skin: skin.transpose()?,
                weights: node.weights().or(mesh.weights()).unwrap_or_default(),
            };
            for primitive in mesh.primitives() {
                let place = format!("glTF, mesh {}, primitive {}", mesh.index(), primitive.index());
                reader.primitive(&primitive, &shape, &place).context(place.clone())?;
            }
        }
        let first = open.len();
        open.extend(node.children());
        open[first..].reverse();
    }
    Ok(reader.scene)
}

/// Extensions of materials that are read, or that change only how light bends and fades within a transparent body.
const OF_MATERIALS: [&str; 5] = [
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_emissive_strength",
    "KHR_materials_transmission",
    "KHR_materials_ior",
    "KHR_materials_volume",
];

/// Contents of a document that are left out, without the contents of its meshes.
fn besides(document: &Document) -> BTreeSet<&'static str> {
    let mut ignored = BTreeSet::new();
    let mut note = |is_there: bool, what| {
        if is_there {
            ignored.insert(what);
        }
    };
    note(document.animations().next().is_some(), "animations");
    note(document.cameras().next().is_some(), "cameras");
    note(document.extensions_used().any(|name| name == "KHR_lights_punctual"), "lights");
    note(document.extensions_used().any(|name| name == "EXT_mesh_gpu_instancing"), "instances of meshes");
    let of_materials = |name: &str| name.starts_with("KHR_materials_") && !OF_MATERIALS.contains(&name);
    note(document.extensions_used().any(of_materials), "extensions of materials");
    ignored
}

/// What a node does to its mesh.
struct Shape<'a> {
    transform: Transform,
    /// If there is a skin, the transform has no effect.
    skin: Option<Skin>,
    /// Shares of the morph targets.
    weights: &'a [f32],
}

/// The reader and what it has read so far.
struct Reader<'a> {
    document: &'a Document,
    bytes: Bytes,
    scene: Contents,
    /// The number in the file of each material of the scene.
    numbers: Vec<Option<usize>>,
    folder: &'a Folder,
    /// Images by their numbers in the file.
    images: Images,
    /// What becomes of colours: images are read only if they are needed.
    colours: Colours,
}

impl Reader<'_> {
    fn primitive(&mut self, primitive: &Primitive<'_>, shape: &Shape<'_>, place: &str) -> Result<()> {
        let of_triangles = matches!(primitive.mode(), Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan);
        if !of_triangles {
            self.scene.ignored.insert("lines and points");
            return Ok(());
        }
        for (semantic, _) in primitive.attributes() {
            if matches!(semantic, Semantic::Colors(1..)) {
                self.scene.ignored.insert("further colours of vertices");
            }
        }
        if primitive.morph_targets().next().is_some() {
            self.scene.ignored.insert("morph targets, but for their default weights");
        }
        let draco = Draco::of(self.document, primitive, |view| self.bytes.view(view))?;
        let attributes = Attributes { bytes: &self.bytes, primitive, draco: draco.as_ref() };
        let Some(mut positions) = attributes.get::<3>(&Semantic::Positions, Kind::Coordinates)? else {
            bail!("no positions; export it with them")
        };
        let mut normals = attributes.get::<3>(&Semantic::Normals, Kind::Coordinates)?;
        if normals.as_ref().is_some_and(|normals| normals.len() != positions.len()) {
            bail!("it has not as many normals as positions");
        }
        let indices: Vec<usize> = match (&draco, primitive.indices()) {
            (Some(draco), _) => draco.indices(),
            (None, None) => (0..positions.len()).collect(),
            (None, Some(accessor)) => {
                let indices = self.bytes.numbers::<1>(&accessor, Kind::Whole).context("indices")?;
                indices.into_iter().map(|[index]| index as usize).collect()
            }
        };
        if let Some(index) = indices.iter().find(|&&index| index >= positions.len()) {
            bail!("vertex {index} is out of range; they count from 0, and there are {}", positions.len());
        }
        let triangles = if draco.is_some() { triangles(&indices, Mode::Triangles)? } else { triangles(&indices, primitive.mode())? };
        attributes.morph(shape.weights, &mut positions, normals.as_deref_mut())?;
        let skinned = shape.skin.as_ref().map(|skin| skin.transforms(positions.len(), |set| attributes.weights(set))).transpose()?;
        let transform = |vertex: usize| skinned.as_ref().and_then(|skinned| skinned.get(vertex)).unwrap_or(&shape.transform);
        let mut used = vec![false; positions.len()];
        triangles.iter().flatten().for_each(|&vertex| used[vertex] = true);
        let count = positions.len();
        // A mesh is of use without its colours.
        let remarks = &mut self.scene.remarks;
        let mut left_out = |error: anyhow::Error| remarks.push(format!("{place}: what gives it colours is left out: {error:#}"));
        let colours = attributes.colours().map_err(&mut left_out).ok().flatten().filter(|colours| colours.len() == count);
        let places = placed_texture(&primitive.material()).and_then(|info| {
            let places = attributes.get::<2>(&Semantic::TexCoords(places_of(&info)), Kind::Places);
            places.map_err(&mut left_out).ok().flatten().filter(|places| places.len() == count)
        });
        let submesh = Submesh { object: self.scene.objects.len() - 1, material: self.material(primitive), is_back: false };
        let Contents { soup, faults, .. } = &mut self.scene;
        let (first, first_normal) = (soup.positions.len(), soup.normals.len());
        let (first_colour, first_place) = (soup.colours.len(), soup.places.len());
        soup.colours.extend(
            colours.iter().flatten().map(|&colour| pbr::encoded(colour.map(|c| if c.is_finite() { c.clamp(0.0, 1.0) } else { 1.0 }))),
        );
        soup.places.extend(places.iter().flatten().map(|place| place.map(|c| if c.is_finite() { c } else { 0.0 })));
        for (number, position) in positions.into_iter().enumerate() {
            let position = transform(number).point(position);
            let is_wrong = position.iter().any(|c| !c.is_finite() || c.abs() > LARGEST);
            if is_wrong && used[number] {
                bail!("vertex {number}: coordinates must be finite and below {LARGEST:e}");
            }
            if is_wrong {
                faults.add(UNUSED_POSITION, || format!("{place}, vertex {number}"));
            }
            soup.positions.push(if is_wrong { [0.0; 3] } else { position });
        }
        for (number, normal) in normals.iter().flatten().copied().enumerate() {
            if normal.iter().any(|c| !c.is_finite()) {
                if !used[number] {
                    faults.add(UNUSED_NORMAL, || format!("{place}, vertex {number}"));
                }
                // One without a direction, for which another is computed.
                soup.normals.push([0.0; 3]);
                continue;
            }
            // As it is where nothing turns it: then it is rounded as that of another format.
            let transform = transform(number);
            let turned = if transform.turns() { apply(&transform.of_normals(), normal) } else { normal };
            soup.normals.push(unit(turned).map_or(normal, |_| turned));
        }
        let corner = |index| Corner {
            position: first + index,
            normal: normals.is_some().then_some(first_normal + index),
            colour: colours.is_some().then_some(first_colour + index),
            place: places.is_some().then_some(first_place + index),
        };
        soup.faces.extend(triangles.into_iter().map(|[a, b, c]| {
            let [a, b, c] = if transform(a).mirrors() { [a, c, b] } else { [a, b, c] };
            Face { corners: vec![corner(a), corner(b), corner(c)], submesh, smoothing: Smoothing::ByAngle }
        }));
        Ok(())
    }

    /// A texture of the file, or nothing if it is not wanted or cannot be read, which is said.
    fn texture(&mut self, info: &Info<'_>) -> Option<Texture> {
        if self.colours == Colours::None {
            self.scene.ignored.insert("textures");
            return None;
        }
        let Some(source) = info.texture().source() else {
            self.scene.remarks.push(format!(
                "the texture {} is left out: its image is neither PNG nor JPEG; save it as one of them",
                info.texture().index()
            ));
            return None;
        };
        let Self { images, bytes, document, folder, scene, .. } = self;
        let number = source.index();
        let left_out = |error| scene.remarks.push(format!("the image {number} is left out: {error:#}"));
        let image = images.read(&number.to_string(), || bytes.image(document, number, folder), left_out)?;
        Some(Texture { image, transform: transform_of(info) })
    }

    /// Where a material sends out its light. A corner has one place, which is that on the texture of colour if there is one. Of a texture of light that
    /// has others, the mean counts.
    fn emission(&mut self, material: &gltf::Material<'_>) -> Emission {
        let Some(info) = light_texture(material) else { return Emission::Even };
        let has_own_places = placed_texture(material).is_some_and(|placed| places_of(&placed) == places_of(&info));
        match self.texture(&info) {
            Some(texture) => Emission::By(if has_own_places { texture } else { texture.even() }),
            None => Emission::Unread,
        }
    }

    /// The share of the light from behind that passes through a transmissive material. A texture counts by its mean. If it is not read, nothing passes,
    /// because it may say that only the windows of a car are glass.
    fn transmitted(&mut self, material: &gltf::Material<'_>, colours: Option<&Texture>) -> f64 {
        let Some(transmission) = material.transmission().filter(|transmission| transmission.transmission_factor() > 0.0) else {
            return 0.0;
        };
        let mean =
            transmission.transmission_texture().map_or(1.0, |info| self.texture(&info).map_or(0.0, |texture| texture.image.mean()[0]));
        let colour = colours.map_or([1.0; 3], |texture| texture.image.mean());
        pbr::transmitted(base_colour(material), colour, f64::from(transmission.transmission_factor()) * mean)
    }

    /// The number of a primitive's material in the scene; notes what of it is left out.
    fn material(&mut self, primitive: &Primitive<'_>) -> usize {
        let material = primitive.material();
        let known = self.numbers.iter().position(|&number| number == material.index());
        known.unwrap_or_else(|| {
            self.numbers.push(material.index());
            let pbr = material.pbr_metallic_roughness();
            let name = || material.name().map_or_else(|| format!("material {}", self.numbers.len()), str::to_owned);
            let gloss = material.pbr_specular_glossiness();
            let texture = colour_texture(&material);
            self.scene.materials.push(material.index().map(|_| {
                let alike = match &gloss {
                    Some(gloss) => pbr::of_gloss(name(), gloss.diffuse_factor(), gloss.specular_factor(), gloss.glossiness_factor()),
                    None => pbr::material(name(), pbr.base_color_factor(), pbr.metallic_factor(), pbr.roughness_factor()),
                };
                let emission = pbr::emission(material.emissive_factor(), material.emissive_strength());
                Material { emission, two_sided: material.double_sided(), ..alike }
            }));
            let texture = texture.and_then(|info| self.texture(&info));
            let transmitted = self.transmitted(&material, texture.as_ref());
            let (texture, transparency) = seen_through(&material, texture);
            if let Some(Some(material)) = self.scene.materials.last_mut() {
                material.transparency = transparency.max(transmitted);
            }
            self.scene.textures.push(texture);
            let emission = self.emission(&material);
            self.scene.emissions.push(emission);
            let has_texture = gloss.is_some_and(|gloss| gloss.specular_glossiness_texture().is_some())
                || pbr.metallic_roughness_texture().is_some()
                || material.normal_texture().is_some()
                || material.occlusion_texture().is_some();
            self.scene.ignored.extend(has_texture.then_some("textures other than those of colour"));
            self.numbers.len() - 1
        })
    }
}

/// What is seen through a material: its texture with holes, and the share of the light from behind that it lets through. Where a texture is blended, it has
/// holes where it is less than half opaque, and the rest has one opacity, which is the mean.
fn seen_through(material: &gltf::Material<'_>, texture: Option<Texture>) -> (Option<Texture>, f64) {
    let [.., opacity] = base_colour(material);
    let opacity = f64::from(opacity).clamp(0.0, 1.0);
    match material.alpha_mode() {
        AlphaMode::Opaque => (texture, 0.0),
        AlphaMode::Mask => {
            // The factor and the texture are multiplied, and compared with the cutoff.
            let cutoff = f64::from(material.alpha_cutoff().unwrap_or(0.5)) / opacity.max(1e-6);
            (texture.map(|texture| texture.cut(cutoff)), 0.0)
        }
        AlphaMode::Blend => {
            let texture = texture.map(|texture| texture.cut(0.5));
            let mean = texture.as_ref().map_or(1.0, |texture| texture.image.mean_opacity());
            (texture, 1.0 - opacity * mean)
        }
    }
}

/// The colour of a material, linear, and its opacity, by which its texture is multiplied.
fn base_colour(material: &gltf::Material<'_>) -> [f32; 4] {
    match material.pbr_specular_glossiness() {
        Some(gloss) => gloss.diffuse_factor(),
        None => material.pbr_metallic_roughness().base_color_factor(),
    }
}

/// The texture of a material's colour.
fn colour_texture<'a>(material: &gltf::Material<'a>) -> Option<Info<'a>> {
    match material.pbr_specular_glossiness() {
        Some(gloss) => gloss.diffuse_texture(),
        None => material.pbr_metallic_roughness().base_color_texture(),
    }
}

/// The texture of the light that a material sends out.
fn light_texture<'a>(material: &gltf::Material<'a>) -> Option<Info<'a>> {
    material.emissive_texture().filter(|_| material.emissive_factor() != [0.0; 3])
}

/// The texture on which the corners of a primitive have their places.
fn placed_texture<'a>(material: &gltf::Material<'a>) -> Option<Info<'a>> {
    colour_texture(material).or_else(|| light_texture(material))
}

/// The set of coordinates on a texture.
fn places_of(info: &Info<'_>) -> u32 {
    info.texture_transform().and_then(|transform| transform.tex_coord()).unwrap_or_else(|| info.tex_coord())
}

/// How coordinates become those of the image (KHR_texture_transform): they are scaled, turned and moved.
fn transform_of(info: &Info<'_>) -> [[f64; 3]; 2] {
    let Some(transform) = info.texture_transform() else { return [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]] };
    let ([x, y], [width, height]) = (transform.offset().map(f64::from), transform.scale().map(f64::from));
    let (sin, cos) = libm::sincos(f64::from(transform.rotation()));
    [[cos * width, sin * height, x], [-sin * width, cos * height, y]]
}

/// The attributes of a primitive, compressed or not.
struct Attributes<'a> {
    bytes: &'a Bytes,
    primitive: &'a Primitive<'a>,
    draco: Option<&'a Draco>,
}

impl Attributes<'_> {
    /// The elements of an attribute, each of `N` numbers.
    fn get<const N: usize>(&self, semantic: &Semantic, kind: Kind) -> Result<Option<Vec<[f64; N]>>> {
        let name = match semantic {
            Semantic::Positions => "positions",
            Semantic::Normals => "normals",
            Semantic::Joints(_) => "joints",
            Semantic::Weights(_) => "weights",
            Semantic::Colors(_) => "colours",
            Semantic::TexCoords(_) => "texture coordinates",
            _ => "attributes",
        };
        if let Some(compressed) =
            self.draco.map(|draco| draco.attribute(&semantic.to_string(), kind == Kind::Shares)).transpose().context(name)?.flatten()
        {
            return Ok(Some(compressed));
        }
        let Some(accessor) = self.primitive.get(semantic) else { return Ok(None) };
        self.bytes.numbers(&accessor, kind).context(name).map(Some)
    }

    /// The colours of vertices, which may have an opacity.
    fn colours(&self) -> Result<Option<Vec<V3>>> {
        let semantic = Semantic::Colors(0);
        let has_opacity = self.primitive.get(&semantic).is_some_and(|accessor| accessor.dimensions() == gltf::accessor::Dimensions::Vec4);
        if !has_opacity {
            return self.get::<3>(&semantic, Kind::Shares);
        }
        Ok(self.get::<4>(&semantic, Kind::Shares)?.map(|colours| colours.into_iter().map(|[r, g, b, _]| [r, g, b]).collect()))
    }

    /// The joints of each vertex with their weights, of which there may be several sets.
    fn weights(&self, set: u32) -> Result<Option<pose::Weights>> {
        let joints = self.get(&Semantic::Joints(set), Kind::Whole)?;
        let weights = self.get(&Semantic::Weights(set), Kind::Shares)?;
        Ok(joints.zip(weights).map(|(joints, weights)| pose::Weights { joints, weights }))
    }

    /// Adds shares of the morph targets.
    fn morph(&self, shares: &[f32], positions: &mut [V3], mut normals: Option<&mut [V3]>) -> Result<()> {
        for ((number, target), &share) in self.primitive.morph_targets().enumerate().zip(shares) {
            if share == 0.0 {
                continue;
            }
            let place = || format!("morph target {number}");
            let all = [(target.positions(), Some(&mut *positions)), (target.normals(), normals.as_deref_mut())];
            for (accessor, vectors) in all {
                let (Some(accessor), Some(vectors)) = (accessor, vectors) else { continue };
                let offsets = self.bytes.numbers::<3>(&accessor, Kind::Coordinates).with_context(place)?;
                if offsets.len() != vectors.len() {
                    bail!("{}: it has {} vertices instead of {}", place(), offsets.len(), vectors.len());
                }
                vectors.iter_mut().zip(offsets).for_each(|(vector, offset)| *vector = add(*vector, scale(offset, share.into())));
            }
        }
        Ok(())
    }
}

/// The triangles of a primitive, all wound alike.
fn triangles(indices: &[usize], mode: Mode) -> Result<Vec<[usize; 3]>> {
    Ok(match mode {
        Mode::TriangleStrip => {
            let strip = indices.windows(3).enumerate();
            strip
                .map(
                    |(number, corners)| {
                        if number % 2 == 0 { [corners[0], corners[1], corners[2]] } else { [corners[0], corners[2], corners[1]] }
                    },
                )
                .collect()
        }
        Mode::TriangleFan => indices.windows(2).skip(1).map(|side| [indices[0], side[0], side[1]]).collect(),
        _ => {
            let (triangles, rest) = indices.as_chunks();
            if !rest.is_empty() {
                bail!("{} corners; a multiple of three is needed", indices.len());
            }
            triangles.to_vec()
        }
    })
}
