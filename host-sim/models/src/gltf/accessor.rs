//! Numbers of a glTF file: floating point and whole numbers of every size, sparse or not.

use super::compressed;
use crate::files::{Folder, LARGEST_FILE};
use anyhow::{Context, Result, anyhow, bail, ensure};
use gltf::{
    Accessor, Document,
    accessor::{DataType, Dimensions},
    buffer::Source,
};

/// The types of numbers for which a quantised mesh has smaller ones.
const FLOAT: [DataType; 1] = [DataType::F32];
const QUANTISED: [DataType; 5] = [DataType::I8, DataType::U8, DataType::I16, DataType::U16, DataType::F32];
/// The types of weights and colours.
const SHARES: [DataType; 3] = [DataType::U8, DataType::U16, DataType::F32];
/// The types of indices.
const WHOLE: [DataType; 3] = [DataType::U8, DataType::U16, DataType::U32];

/// What kind of numbers an accessor must have.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// Coordinates and normals.
    Coordinates,
    /// From 0 to 1.
    Shares,
    /// Coordinates on textures: from 0 to 1, or of any size if the file has a texture transform.
    Places,
    /// Indices.
    Whole,
}

/// The bytes of a file.
pub(super) struct Bytes {
    buffers: Vec<Vec<u8>>,
    /// For each view, its bytes if they were compressed, or what is wrong with them. That matters only where they are needed.
    unpacked: Vec<Option<Result<Vec<u8>, String>>>,
    is_quantised: bool,
}

impl Bytes {
    /// The bytes of all buffers, which are in the file or in its folder.
    pub(super) fn read(document: &Document, blob: Option<&[u8]>, folder: &Folder) -> Result<Self> {
        let buffers = document.buffers().map(|buffer| {
            let number = buffer.index();
            buffer_of(&buffer, blob, folder).with_context(|| format!("glTF, buffer {number}"))
        });
        let mut bytes = Self {
            buffers: buffers.collect::<Result<_>>()?,
            unpacked: Vec::new(),
            is_quantised: document.extensions_used().any(|name| name == "KHR_mesh_quantization"),
        };
        for view in document.views() {
            let unpack = |packed: compressed::Packed<'_>| {
                packed.unpack(&bytes.buffers).map_err(|error| format!("view {} of a buffer: {error:#}", view.index()))
            };
            bytes.unpacked.push(compressed::meshopt(document, &view).map(unpack));
        }
        Ok(bytes)
    }

    /// The bytes of a view; none if it does not lie in its buffer.
    ///
    /// # Errors
    /// When its bytes are compressed, and cannot be unpacked.
    pub(super) fn view(&self, view: &gltf::buffer::View<'_>) -> Result<Option<&[u8]>> {
        if let Some(Some(unpacked)) = self.unpacked.get(view.index()) {
            return unpacked.as_ref().map(|bytes| Some(&bytes[..])).map_err(|error| anyhow!(error.clone()));
        }
        let end = view.offset().checked_add(view.length());
        Ok(end.and_then(|end| self.buffers.get(view.buffer().index())?.get(view.offset()..end)))
    }

    /// The bytes of an image. What kind it is follows from them, and not from what the file says.
    pub(super) fn image(&self, document: &Document, number: usize, folder: &Folder) -> Result<Vec<u8>> {
        let image = document.as_json().images.get(number).context("there is no such image; the file is damaged")?;
        let view = image.buffer_view.and_then(|view| document.views().nth(view.value()));
        match (view, &image.uri) {
            (Some(view), _) => Ok(self.view(&view)?.context("it does not lie in its buffer; the file is damaged")?.to_vec()),
            (None, Some(uri)) => of_uri(uri, folder),
            (None, None) => bail!("it has no bytes; export it with them"),
        }
    }

    /// The elements of an accessor, each of `N` numbers.
    pub(super) fn numbers<const N: usize>(&self, accessor: &Accessor<'_>, kind: Kind) -> Result<Vec<[f64; N]>> {
        let number = accessor.index();
        let types = match kind {
            Kind::Coordinates if self.is_quantised => &QUANTISED[..],
            Kind::Coordinates => &FLOAT,
            Kind::Places if self.is_quantised => &QUANTISED[..],
            Kind::Shares | Kind::Places => &SHARES,
            Kind::Whole => &WHOLE,
        };
        let dimensions = [Dimensions::Scalar, Dimensions::Vec2, Dimensions::Vec3, Dimensions::Vec4, Dimensions::Mat4];
        let dimensions = dimensions.into_iter().find(|dimensions| dimensions.multiplicity() == N).context("no such dimensions")?;
        if !types.contains(&accessor.data_type()) || accessor.dimensions() != dimensions {
            let (has, kind) = (accessor.dimensions(), accessor.data_type());
            bail!("accessor {number} has the type {has:?} of {kind:?}, but {dimensions:?} of {types:?} is needed");
        }
        ensure!(accessor.count() > 0, "accessor {number} is empty");
        let damaged = || anyhow!("accessor {number} does not lie in its buffer; the file is damaged");
        let reader = Numbers {
            data: accessor.data_type(),
            is_share: accessor.normalized() || kind == Kind::Shares || kind == Kind::Places && !self.is_quantised,
        };
        let mut numbers = match accessor.view() {
            Some(view) => {
                let bytes = self.view(&view)?.and_then(|bytes| bytes.get(accessor.offset()..)).ok_or_else(damaged)?;
                reader.read(bytes, accessor.count(), view.stride()).ok_or_else(damaged)?
            }
            None if accessor.sparse().is_none() => bail!("accessor {number} has no bytes; export it with them"),
            // All that it does not say is zero.
            None => {
                ensure!(accessor.count() as u64 <= LARGEST_FILE / size_of::<[f64; N]>() as u64, damaged());
                vec![[0.0; N]; accessor.count()]
            }
        };
        if let Some(sparse) = accessor.sparse() {
            let (indices, values) = (sparse.indices(), sparse.values());
            let place = || anyhow!("accessor {number}: its sparse elements do not lie in their buffer; the file is damaged");
            let data = match indices.index_type() {
                gltf::accessor::sparse::IndexType::U8 => DataType::U8,
                gltf::accessor::sparse::IndexType::U16 => DataType::U16,
                gltf::accessor::sparse::IndexType::U32 => DataType::U32,
            };
            let bytes = |view: &gltf::buffer::View<'_>, offset| self.view(view)?.and_then(|bytes| bytes.get(offset..)).ok_or_else(place);
            let places: Vec<[f64; 1]> = Numbers { data, is_share: false }
                .read(bytes(&indices.view(), indices.offset())?, sparse.count(), None)
                .ok_or_else(place)?;
            let values: Vec<[f64; N]> = reader.read(bytes(&values.view(), values.offset())?, sparse.count(), None).ok_or_else(place)?;
            for ([at], value) in places.into_iter().zip(values) {
                let count = numbers.len();
                let element = numbers.get_mut(at as usize);
                *element.with_context(|| format!("accessor {number}: its sparse element {at} is out of range; there are {count}"))? = value;
            }
        }
        Ok(numbers)
    }
}

/// The bytes of a buffer.
fn buffer_of(buffer: &gltf::Buffer<'_>, blob: Option<&[u8]>, folder: &Folder) -> Result<Vec<u8>> {
    let bytes = match buffer.source() {
        // What is compressed is in another buffer.
        Source::Bin if compressed::is_fallback(buffer) => return Ok(Vec::new()),
        Source::Bin => blob.context("it is the binary chunk of a GLB file, which is missing")?.to_vec(),
        Source::Uri(uri) => of_uri(uri, folder)?,
    };
    if bytes.len() < buffer.length() {
        bail!("it has {} bytes instead of {}; the file was cut off", bytes.len(), buffer.length());
    }
    Ok(bytes)
}

/// The bytes that a URI has in itself, or those of the file that it names.
fn of_uri(uri: &str, folder: &Folder) -> Result<Vec<u8>> {
    if uri.get(..5).is_some_and(|scheme| scheme.eq_ignore_ascii_case("data:")) {
        let url = data_url::DataUrl::process(uri).map_err(|error| anyhow!("its data URI is not valid: {error}"))?;
        return Ok(url.decode_to_vec().map_err(|error| anyhow!("its data URI: {error}"))?.0);
    }
    let name = percent_encoding::percent_decode_str(uri).decode_utf8().context("its name is not UTF-8")?;
    // Some programs do not encode a percent sign that is part of the name.
    let name = if folder.find(uri).is_ok() { uri } else { &*name };
    Ok(folder.read(name)?.1)
}

/// Numbers of one type.
struct Numbers {
    data: DataType,
    /// Whole numbers stand for numbers from 0 or -1 to 1.
    is_share: bool,
}

impl Numbers {
    /// Elements that lie so many bytes apart; `None` if there are fewer.
    fn read<const N: usize>(&self, bytes: &[u8], count: usize, stride: Option<usize>) -> Option<Vec<[f64; N]>> {
        let size = self.data.size();
        // The columns of a matrix begin at multiples of four bytes, as those of floating point do.
        let element = size.checked_mul(N)?;
        let stride = stride.unwrap_or(element);
        let last = stride.checked_mul(count.checked_sub(1)?)?.checked_add(element)?;
        if stride < element || last > bytes.len() {
            return None;
        }
        let numbers = |at: usize| std::array::from_fn(|k| self.number(&bytes[at + k * size..]));
        Some((0..count).map(|k| numbers(k * stride)).collect())
    }

    /// The first number of these bytes, of which there are enough.
    fn number(&self, bytes: &[u8]) -> f64 {
        let pair = || [bytes[0], bytes[1]];
        let four = || [bytes[0], bytes[1], bytes[2], bytes[3]];
        let (number, largest) = match self.data {
            DataType::I8 => (f64::from(bytes[0] as i8), 127.0),
            DataType::U8 => (f64::from(bytes[0]), 255.0),
            DataType::I16 => (f64::from(i16::from_le_bytes(pair())), 32767.0),
            DataType::U16 => (f64::from(u16::from_le_bytes(pair())), 65535.0),
            DataType::U32 => (f64::from(u32::from_le_bytes(four())), f64::from(u32::MAX)),
            DataType::F32 => return f32::from_le_bytes(four()).into(),
        };
        if self.is_share { (number / largest).max(-1.0) } else { number }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_every_type_are_read() {
        let shares = |data, bytes: &[u8]| Numbers { data, is_share: true }.read::<1>(bytes, 2, None).map(|list| list.concat());
        assert_eq!(shares(DataType::I8, &[0x80, 127]), Some(vec![-1.0, 1.0]));
        assert_eq!(shares(DataType::U8, &[0, 255]), Some(vec![0.0, 1.0]));
        assert_eq!(shares(DataType::I16, &[0, 0x80, 0xFF, 0x7F]), Some(vec![-1.0, 1.0]));
        assert_eq!(shares(DataType::U16, &[0xFF, 0xFF, 0, 0]), Some(vec![1.0, 0.0]));
        assert_eq!(shares(DataType::F32, &[0, 0, 0x20, 0x40, 0, 0, 0x80, 0x3F]), Some(vec![2.5, 1.0]));
        let whole = Numbers { data: DataType::U16, is_share: false };
        // Elements lie apart, and the last one has no bytes behind it.
        assert_eq!(whole.read::<1>(&[1, 0, 9, 9, 2, 0], 2, Some(4)), Some(vec![[1.0], [2.0]]));
        assert_eq!(whole.read::<1>(&[1, 0, 9, 9, 2], 2, Some(4)), None);
        assert_eq!(whole.read::<2>(&[1, 0, 9, 9, 2, 0, 3, 0], 2, Some(2)), None);
        assert_eq!(whole.read::<1>(&[1, 0], usize::MAX, None), None);
    }
}
