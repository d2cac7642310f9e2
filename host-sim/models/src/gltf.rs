//! Reads glTF 2.0, as JSON and as GLB, by the library `gltf`: the triangles of the default scene where its nodes put them, with their
//! materials; tells what else there is.

use crate::{
    mesh::{Corner, Face, Smoothing, Soup, Submesh},
    mtl::Material,
    obj::LARGEST,
    pbr,
    vector::{V3, add, apply, cross, dot, product, scale, unit},
};
use anyhow::{Context, Result, anyhow, bail};
use gltf::{
    Accessor, Document, Gltf, Node, Primitive, Semantic,
    accessor::{DataType, Dimensions},
    buffer::Source,
    json::validation::Checked,
    material::AlphaMode,
    mesh::Mode,
};
use std::{
    collections::{BTreeSet, HashSet},
    fs,
    path::Path,
};

/// The contents of a glTF file.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// The triangles of its default scene.
    pub soup: Soup,
    /// The names of objects by which [`Submesh::object`] counts: of the nodes that have meshes, or else of their meshes. A name is empty where
    /// the file gives none.
    pub objects: Vec<String>,
    /// Materials by which [`Submesh::material`] counts; `None` where a primitive has none.
    pub materials: Vec<Option<Material>>,
    /// Contents that are left out, in words.
    pub ignored: BTreeSet<&'static str>,
}

/// The first bytes of GLB.
const MAGIC: &[u8] = b"glTF";
/// Bytes of GLB before its first chunk.
const HEAD: usize = 12;

/// Whether a file is glTF. No other format that is read is JSON.
pub(crate) fn is_gltf(bytes: &[u8]) -> bool {
    bytes.starts_with(MAGIC) || text(bytes).starts_with(b"{")
}

/// JSON without what may stand before it.
fn text(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes).trim_ascii_start()
}

/// Reads the default scene of a file, or its first scene if there is no default. Buffers may be in the file or beside `path`.
///
/// # Errors
/// The error names the buffer, mesh or node, and its fault.
pub fn parse(bytes: &[u8], path: &Path) -> Result<Scene> {
    let Gltf { document, blob } = open(bytes)?;
    let buffers = buffers(&document, blob, path)?;
    let scene = document.default_scene().or_else(|| document.scenes().next()).context("glTF: it has no scene; export it with one")?;
    let mut reader = Reader { buffers, scene: Scene { ignored: besides(&document), ..Scene::default() }, numbers: Vec::new() };
    let mut seen = HashSet::new();
    let mut open: Vec<(Node<'_>, Transform)> = scene.nodes().map(|node| (node, Transform::NONE)).collect();
    // In the order of the file.
    open.reverse();
    while let Some((node, above)) = open.pop() {
        if !seen.insert(node.index()) {
            bail!("glTF, node {}: the scene reaches it twice; nodes must form a tree", node.index());
        }
        let transform = above.then(&Transform::of(&node));
        if let Some(mesh) = node.mesh() {
            let name = node.name().filter(|name| !name.is_empty()).or(mesh.name()).unwrap_or_default();
            reader.scene.objects.push(name.to_owned());
            for primitive in mesh.primitives() {
                let place = || format!("glTF, mesh {}, primitive {}", mesh.index(), primitive.index());
                reader.primitive(&primitive, &transform).with_context(place)?;
            }
        }
        let first = open.len();
        open.extend(node.children().map(|child| (child, transform)));
        open[first..].reverse();
    }
    Ok(reader.scene)
}

fn open(bytes: &[u8]) -> Result<Gltf> {
    let is_binary = bytes.starts_with(MAGIC);
    // The library subtracts the head from this length without a look.
    let length = bytes.get(8..).and_then(|rest| rest.first_chunk()).map(|&length| u32::from_le_bytes(length) as usize);
    if is_binary && length.is_none_or(|length| length < HEAD || length > bytes.len()) {
        bail!("GLB: the file is shorter than its head says; it was cut off");
    }
    let wrong = |error: gltf::Error| {
        let unsupported = |(path, _): &(gltf::json::Path, _)| path.as_str().starts_with("extensionsRequired");
        let required = matches!(&error, gltf::Error::Validation(faults) if faults.iter().any(unsupported));
        let remedy = if required { " export it without compression and extensions" } else { "" };
        anyhow!("glTF: {}{remedy}", error.to_string().replace('\n', " "))
    };
    let Gltf { document, blob } = Gltf::from_slice_without_validation(if is_binary { bytes } else { text(bytes) }).map_err(wrong)?;
    let json = document.into_json();
    // The library's check of a document looks positions up before it has checked their number.
    let primitives = json.meshes.iter().flat_map(|mesh| &mesh.primitives);
    let positions = primitives.filter_map(|primitive| primitive.attributes.get(&Checked::Valid(Semantic::Positions)));
    if let Some(index) = positions.map(|index| index.value()).find(|&index| index >= json.accessors.len()) {
        bail!("glTF: positions of a mesh are accessor {index}, but there are {}; the file is damaged", json.accessors.len());
    }
    Ok(Gltf { document: Document::from_json(json).map_err(wrong)?, blob })
}

/// The bytes of all buffers.
fn buffers(document: &Document, mut blob: Option<Vec<u8>>, path: &Path) -> Result<Vec<Vec<u8>>> {
    let mut read = |buffer: gltf::Buffer<'_>| {
        let bytes = match buffer.source() {
            Source::Bin => blob.take().context("it is the binary chunk of a GLB file, which is missing")?,
            Source::Uri(uri) if uri.starts_with("data:") => {
                let url = data_url::DataUrl::process(uri).map_err(|error| anyhow!("its data URI is not valid: {error}"))?;
                url.decode_to_vec().map_err(|error| anyhow!("its data URI: {error}"))?.0
            }
            Source::Uri(uri) => {
                let name = percent_encoding::percent_decode_str(uri).decode_utf8().context("its name is not UTF-8")?;
                let file = path.with_file_name(&*name);
                fs::read(&file).with_context(|| format!("cannot read {}; put it beside the mesh", file.display()))?
            }
        };
        if bytes.len() < buffer.length() {
            bail!("it has {} bytes instead of {}; the file was cut off", bytes.len(), buffer.length());
        }
        Ok(bytes)
    };
    document
        .buffers()
        .map(|buffer| {
            let number = buffer.index();
            read(buffer).with_context(|| format!("glTF, buffer {number}"))
        })
        .collect()
}

/// Contents of a document that are left out, without the contents of its meshes.
fn besides(document: &Document) -> BTreeSet<&'static str> {
    let mut ignored = BTreeSet::new();
    let mut note = |is_there: bool, what| {
        if is_there {
            ignored.insert(what);
        }
    };
    note(document.animations().next().is_some(), "animations");
    note(document.skins().next().is_some(), "skins");
    note(document.cameras().next().is_some(), "cameras");
    note(document.extensions_used().any(|name| name == "KHR_lights_punctual"), "lights");
    note(document.extensions_used().any(|name| name == "EXT_mesh_gpu_instancing"), "instances of meshes");
    note(document.extensions_used().any(|name| name.starts_with("KHR_materials_")), "extensions of materials");
    ignored
}

/// A linear map and a translation.
#[derive(Clone, Copy)]
struct Transform {
    rows: [V3; 3],
    to: V3,
}

impl Transform {
    const NONE: Self = Self { rows: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], to: [0.0; 3] };

    fn of(node: &Node<'_>) -> Self {
        let columns = node.transform().matrix().map(|column| column.map(f64::from));
        Self { rows: [0, 1, 2].map(|row| [0, 1, 2].map(|column| columns[column][row])), to: [0, 1, 2].map(|row| columns[3][row]) }
    }

    /// First `inner`, then this.
    fn then(&self, inner: &Self) -> Self {
        Self { rows: product(&self.rows, &inner.rows), to: self.point(inner.to) }
    }

    fn point(&self, point: V3) -> V3 {
        add(apply(&self.rows, point), self.to)
    }

    /// Turns normals: the inverse transpose, but for a factor that is not negative.
    fn of_normals(&self) -> [V3; 3] {
        let [a, b, c] = self.rows;
        let sign = if self.mirrors() { -1.0 } else { 1.0 };
        [cross(b, c), cross(c, a), cross(a, b)].map(|row| scale(row, sign))
    }

    fn mirrors(&self) -> bool {
        let [a, b, c] = self.rows;
        dot(a, cross(b, c)) < 0.0
    }
}

/// The reader and what it has read so far.
struct Reader {
    buffers: Vec<Vec<u8>>,
    scene: Scene,
    /// The number in the file of each material of the scene.
    numbers: Vec<Option<usize>>,
}

impl Reader {
    fn primitive(&mut self, primitive: &Primitive<'_>, transform: &Transform) -> Result<()> {
        let of_triangles = matches!(primitive.mode(), Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan);
        if !of_triangles {
            self.scene.ignored.insert("lines and points");
            return Ok(());
        }
        for (semantic, _) in primitive.attributes() {
            match semantic {
                Semantic::Colors(_) => drop(self.scene.ignored.insert("colours of vertices")),
                Semantic::TexCoords(_) => drop(self.scene.ignored.insert("texture coordinates")),
                _ => {}
            }
        }
        if primitive.morph_targets().next().is_some() {
            self.scene.ignored.insert("morph targets");
        }
        let buffers = &self.buffers;
        let bytes = |buffer: gltf::Buffer<'_>| buffers.get(buffer.index()).map(Vec::as_slice);
        let check = |accessor: &Accessor<'_>, types: &[DataType], dimensions| check(accessor, types, dimensions, buffers);
        let reader = primitive.reader(bytes);
        let Some(accessor) = primitive.get(&Semantic::Positions) else { bail!("no positions; export it with them") };
        check(&accessor, &[DataType::F32], Dimensions::Vec3).context("positions")?;
        let positions: Vec<V3> = reader.read_positions().context("positions cannot be read")?.map(|p| p.map(f64::from)).collect();
        let normals: Option<Vec<V3>> = match primitive.get(&Semantic::Normals) {
            None => None,
            Some(accessor) => {
                check(&accessor, &[DataType::F32], Dimensions::Vec3).context("normals")?;
                Some(reader.read_normals().context("normals cannot be read")?.map(|n| n.map(f64::from)).collect())
            }
        };
        if normals.as_ref().is_some_and(|normals| normals.len() != positions.len()) {
            bail!("it has not as many normals as positions");
        }
        let indices: Vec<usize> = match primitive.indices() {
            None => (0..positions.len()).collect(),
            Some(accessor) => {
                check(&accessor, &[DataType::U8, DataType::U16, DataType::U32], Dimensions::Scalar).context("indices")?;
                reader.read_indices().context("indices cannot be read")?.into_u32().map(|index| index as usize).collect()
            }
        };
        if let Some(index) = indices.iter().find(|&&index| index >= positions.len()) {
            bail!("vertex {index} is out of range; they count from 0, and there are {}", positions.len());
        }
        let triangles = triangles(&indices, primitive.mode())?;
        let submesh = Submesh { object: self.scene.objects.len() - 1, material: self.material(primitive) };
        let soup = &mut self.scene.soup;
        let (first, first_normal) = (soup.positions.len(), soup.normals.len());
        for (number, &position) in positions.iter().enumerate() {
            let position = transform.point(position);
            if position.iter().any(|c| !c.is_finite() || c.abs() > LARGEST) {
                bail!("vertex {number}: coordinates must be finite and below {LARGEST:e}");
            }
            soup.positions.push(position);
        }
        let of_normals = transform.of_normals();
        for (number, &normal) in normals.iter().flatten().enumerate() {
            if normal.iter().any(|c| !c.is_finite()) {
                bail!("vertex {number}: its normal must be finite");
            }
            // As it is where nothing turns it: then it is rounded as that of another format.
            let turned = if transform.rows == Transform::NONE.rows { normal } else { apply(&of_normals, normal) };
            soup.normals.push(unit(turned).map_or(normal, |_| turned));
        }
        let corner = |index| Corner { position: first + index, normal: normals.is_some().then_some(first_normal + index) };
        soup.faces.extend(triangles.into_iter().map(|[a, b, c]| {
            let [a, b, c] = if transform.mirrors() { [a, c, b] } else { [a, b, c] };
            Face { corners: vec![corner(a), corner(b), corner(c)], submesh, smoothing: Smoothing::ByAngle }
        }));
        Ok(())
    }

    /// The number of a primitive's material in the scene; notes what of it is left out.
    fn material(&mut self, primitive: &Primitive<'_>) -> usize {
        let material = primitive.material();
        let known = self.numbers.iter().position(|&number| number == material.index());
        known.unwrap_or_else(|| {
            self.numbers.push(material.index());
            let pbr = material.pbr_metallic_roughness();
            let name = || material.name().map_or_else(|| format!("material {}", self.numbers.len()), str::to_owned);
            self.scene.materials.push(
                material.index().map(|_| pbr::material(name(), pbr.base_color_factor(), pbr.metallic_factor(), pbr.roughness_factor())),
            );
            let has_texture = pbr.base_color_texture().is_some()
                || pbr.metallic_roughness_texture().is_some()
                || material.normal_texture().is_some()
                || material.occlusion_texture().is_some()
                || material.emissive_texture().is_some();
            let mut note = |is_there: bool, what| {
                if is_there {
                    self.scene.ignored.insert(what);
                }
            };
            note(has_texture, "textures");
            note(material.alpha_mode() != AlphaMode::Opaque, "transparency");
            note(material.emissive_factor() != [0.0; 3], "materials that shine by themselves");
            note(material.double_sided(), "backs of double-sided materials");
            self.numbers.len() - 1
        })
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

/// Passes what the library reads without a panic.
fn check(accessor: &Accessor<'_>, types: &[DataType], dimensions: Dimensions, buffers: &[Vec<u8>]) -> Result<()> {
    let number = accessor.index();
    if accessor.sparse().is_some() {
        bail!("accessor {number} is sparse; export it without sparse accessors");
    }
    if !types.contains(&accessor.data_type()) || accessor.dimensions() != dimensions {
        let (has, kind) = (accessor.dimensions(), accessor.data_type());
        bail!("accessor {number} has the type {has:?} of {kind:?}, but {dimensions:?} of {types:?} is needed");
    }
    let view = accessor.view().with_context(|| format!("accessor {number} has no bytes; export it with them"))?;
    let size = accessor.size();
    let stride = view.stride().unwrap_or(size);
    let count = accessor.count().checked_sub(1).with_context(|| format!("accessor {number} is empty"))?;
    let last = stride.checked_mul(count).and_then(|last| last.checked_add(accessor.offset())?.checked_add(size));
    let end = view.offset().checked_add(view.length());
    let bytes = buffers.get(view.buffer().index()).map_or(0, Vec::len);
    if stride < size || last.is_none_or(|last| last > view.length()) || end.is_none_or(|end| end > bytes) {
        bail!("accessor {number} does not lie in its buffer; the file is damaged");
    }
    Ok(())
}
