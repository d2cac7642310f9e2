//! Compressed parts of a glTF file: views that meshoptimizer has packed, and meshes of Draco.

use crate::files::LARGEST_FILE;
use anyhow::{Context, Result, anyhow, bail, ensure};
use draco_core::{DataType, DecoderBuffer, Mesh, MeshDecoder};
use gltf::{
    Document, Primitive,
    json::{Value, extensions},
};
use meshoptimizer_rs::{
    Workspace,
    codec::{
        decode_filter_color, decode_filter_exp, decode_filter_oct, decode_filter_quat, decode_index_buffer, decode_index_sequence,
        decode_vertex_buffer,
    },
};

/// Names of the extension for packed views. The second is newer, and has one filter more.
const MESHOPT: [&str; 2] = ["EXT_meshopt_compression", "KHR_meshopt_compression"];
const DRACO: &str = "KHR_draco_mesh_compression";

/// Whether a buffer has no bytes, because all its views are packed.
pub(super) fn is_fallback(buffer: &gltf::Buffer<'_>) -> bool {
    MESHOPT.iter().any(|name| buffer.extension_value(name).is_some())
}

/// A packed view of a buffer.
pub(super) struct Packed<'a> {
    values: &'a Value,
    /// Bytes of the view when it is unpacked.
    length: usize,
}

/// The packed form of a view, if it has one.
pub(super) fn meshopt<'a>(document: &'a Document, view: &gltf::buffer::View<'_>) -> Option<Packed<'a>> {
    let json = document.as_json().buffer_views.get(view.index())?;
    let extensions: &extensions::buffer::View = json.extensions.as_ref()?;
    let values = MESHOPT.iter().find_map(|name| extensions.others.get(*name))?;
    Some(Packed { values, length: view.length() })
}

impl Packed<'_> {
    fn number(&self, name: &str) -> Result<usize> {
        let number = self.values.get(name).and_then(Value::as_u64).and_then(|number| usize::try_from(number).ok());
        number.with_context(|| format!("its compression has no number {name:?}; the file is damaged"))
    }

    fn word(&self, name: &str) -> Option<&str> {
        self.values.get(name).and_then(Value::as_str)
    }

    /// The bytes of the view.
    pub(super) fn unpack(&self, buffers: &[Vec<u8>]) -> Result<Vec<u8>> {
        let [buffer, length, stride, count] = ["buffer", "byteLength", "byteStride", "count"].map(|name| self.number(name));
        let (buffer, length, stride, count) = (buffer?, length?, stride?, count?);
        let offset = if self.values.get("byteOffset").is_some() { self.number("byteOffset")? } else { 0 };
        let bytes = offset.checked_add(length).and_then(|end| buffers.get(buffer)?.get(offset..end));
        let bytes = bytes.context("its compressed bytes do not lie in their buffer; the file is damaged")?;
        ensure!(
            stride.checked_mul(count) == Some(self.length) && self.length as u64 <= LARGEST_FILE,
            "its compression has {count} elements of {stride} bytes, but the view has {} bytes; the file is damaged",
            self.length
        );
        let mut workspace = Workspace::default();
        let wrong = |_| anyhow!("its bytes, compressed by meshoptimizer, cannot be read; they are damaged, or {UNPACK}");
        let mut unpacked = match self.word("mode") {
            Some("ATTRIBUTES") => decode_vertex_buffer(count, stride, bytes, &mut workspace),
            Some("TRIANGLES") => decode_index_buffer(count, stride, bytes, &mut workspace),
            Some("INDICES") => decode_index_sequence(count, stride, bytes, &mut workspace),
            mode => bail!("its compression by meshoptimizer is {UNPACK} (the mode is {mode:?})"),
        }
        .map_err(wrong)?;
        match self.word("filter").unwrap_or("NONE") {
            "NONE" => Ok(()),
            "OCTAHEDRAL" => decode_filter_oct(&mut unpacked, count, stride, &mut workspace),
            "QUATERNION" => decode_filter_quat(&mut unpacked, count, stride, &mut workspace),
            "EXPONENTIAL" => decode_filter_exp(&mut unpacked, count, stride, &mut workspace),
            "COLOR" => decode_filter_color(&mut unpacked, count, stride, &mut workspace),
            filter => bail!("its compression by meshoptimizer is {UNPACK} (the filter is {filter:?})"),
        }
        .map_err(wrong)?;
        Ok(unpacked)
    }
}

/// What makes a file without compression of one that another library reads.
const UNPACK: &str = "of a kind that is not read: `npx @gltf-transform/cli copy IN.glb OUT.glb` removes the compression";

/// A mesh that Draco has compressed.
pub(super) struct Draco {
    mesh: Mesh,
    /// The number by which the mesh knows each attribute of the primitive.
    attributes: Vec<(String, u32)>,
}

impl Draco {
    /// The compressed mesh of a primitive, if it has one.
    pub(super) fn of<'a>(
        document: &Document,
        primitive: &Primitive<'_>,
        view: impl Fn(&gltf::buffer::View<'_>) -> Result<Option<&'a [u8]>>,
    ) -> Result<Option<Self>> {
        let Some(values) = primitive.extension_value(DRACO) else { return Ok(None) };
        let number = values.get("bufferView").and_then(Value::as_u64).and_then(|number| usize::try_from(number).ok());
        let found = number.and_then(|number| document.views().nth(number));
        let bytes = found.as_ref().map(view).transpose()?.flatten();
        let bytes = bytes.context("its bytes, compressed by Draco, do not lie in a buffer; the file is damaged")?;
        let mut mesh = Mesh::new();
        let decoded = MeshDecoder::new().decode(&mut DecoderBuffer::new(bytes), &mut mesh);
        // What the library says is of no help to a user.
        decoded.ok().with_context(|| format!("its mesh, compressed by Draco, cannot be read; it is damaged, or {UNPACK}"))?;
        let attributes = values.get("attributes").and_then(Value::as_object).into_iter().flatten();
        let attributes = attributes.filter_map(|(name, id)| Some((name.clone(), u32::try_from(id.as_u64()?).ok()?)));
        Ok(Some(Self { attributes: attributes.collect(), mesh }))
    }

    /// The corners of its triangles.
    pub(super) fn indices(&self) -> Vec<usize> {
        self.mesh.faces().iter().flatten().map(|corner| corner.0 as usize).collect()
    }

    /// An attribute by its name in the file, if it is among those that are compressed. Whole numbers may be shares.
    pub(super) fn attribute<const N: usize>(&self, name: &str, is_share: bool) -> Result<Option<Vec<[f64; N]>>> {
        let Some((_, id)) = self.attributes.iter().find(|(known, _)| known == name) else { return Ok(None) };
        let attribute = self.mesh.attribute_by_unique_id(*id);
        let attribute = attribute.with_context(|| format!("{name} is not in its mesh of Draco; the file is damaged"))?;
        ensure!(
            usize::from(attribute.num_components()) == N,
            "{name} of its mesh of Draco has {} numbers instead of {N}",
            attribute.num_components()
        );
        let numbers = attribute.read_f32s(self.mesh.num_points(), N);
        let full = match attribute.data_type() {
            DataType::Uint8 if is_share => 255.0,
            DataType::Uint16 if is_share => 65_535.0,
            _ => 1.0,
        };
        Ok(Some(numbers.as_chunks().0.iter().map(|element| element.map(|number| f64::from(number) / full)).collect()))
    }
}
