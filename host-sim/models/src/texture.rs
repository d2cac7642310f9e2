//! Textures of materials, of which colours of faces are read.

use crate::{
    mesh::Rgb,
    vector::{V3, add, scale},
};
use anyhow::{Context, Result, bail, ensure};
use std::{collections::HashMap, io::Cursor, sync::Arc};

/// Largest number of pixels of all images of a model.
const LARGEST: usize = 1 << 26;
/// The error for images that would take too much memory.
const TOO_MANY: &str = "the images of the model have more than 67,108,864 pixels; make them smaller";

/// An image as colours of sRGB.
#[derive(Debug)]
pub(crate) struct Image {
    width: usize,
    /// Red, green and blue, row by row from the top.
    pixels: Vec<Rgb>,
    /// The opacity of each pixel, or nothing if all are opaque.
    opacity: Vec<u8>,
    /// Whether each pixel is a hole, or nothing if none is.
    holes: Vec<bool>,
}

/// An image on a surface.
#[derive(Clone, Debug)]
pub(crate) struct Texture {
    pub(crate) image: Arc<Image>,
    /// How coordinates of a surface become coordinates of the image: (u, v, 1) is multiplied by these rows.
    pub(crate) transform: [[f64; 3]; 2],
}

/// The images of a model, each of which is read once.
pub(crate) struct Images {
    known: HashMap<String, Option<Arc<Image>>>,
    /// Number of pixels that may still be read.
    room: usize,
}

impl Default for Images {
    fn default() -> Self {
        Self { known: HashMap::new(), room: LARGEST }
    }
}

impl Images {
    /// The image of this name, whose file is read by `bytes`; `None` if it cannot be read, which is said once.
    pub(crate) fn read(
        &mut self,
        name: &str,
        bytes: impl FnOnce() -> Result<Vec<u8>>,
        say: impl FnOnce(anyhow::Error),
    ) -> Option<Arc<Image>> {
        if let Some(known) = self.known.get(name) {
            return known.clone();
        }
        let image = bytes().and_then(|bytes| Image::read(&bytes, self.room)).map(Arc::new).map_err(say).ok();
        self.room -= image.as_ref().map_or(0, |image| image.pixels.len());
        self.known.insert(name.to_owned(), image.clone());
        image
    }
}

impl Image {
    /// Reads a PNG or JPEG file of at most `most` pixels.
    fn read(bytes: &[u8], most: usize) -> Result<Self> {
        if bytes.starts_with(b"\x89PNG") {
            return Self::png(bytes, most);
        }
        if bytes.starts_with(&[0xFF, 0xD8]) {
            return Self::jpeg(bytes, most);
        }
        bail!("the image is neither PNG nor JPEG; save it as one of them, and name that one in the model")
    }

    fn png(bytes: &[u8], most: usize) -> Result<Self> {
        let damaged = "the image is damaged";
        let mut decoder = png::Decoder::new(Cursor::new(bytes));
        decoder.set_transformations(png::Transformations::normalize_to_color8());
        let mut reader = decoder.read_info().context(damaged)?;
        let size = reader.output_buffer_size().filter(|&size| size <= 4 * most).context(TOO_MANY)?;
        let mut data = vec![0; size];
        let info = reader.next_frame(&mut data).context(damaged)?;
        Self::of(info.width as usize, &data[..info.buffer_size()], info.color_type.samples())
    }

    fn jpeg(bytes: &[u8], most: usize) -> Result<Self> {
        let mut decoder = zune_jpeg::JpegDecoder::new(Cursor::new(bytes));
        let damaged = |_| anyhow::anyhow!("the image is damaged, or a kind of JPEG that is not read; save it as PNG");
        decoder.decode_headers().map_err(damaged)?;
        let (width, height) = decoder.dimensions().context("the image is damaged")?;
        ensure!(width * height <= most, TOO_MANY);
        // The decoder expects it, and would panic.
        ensure!(has_finest_luma(bytes), "the image is damaged: its brightness is coarser than its colours");
        let data = decoder.decode().map_err(damaged)?;
        Self::of(width, &data, data.len() / (width * height).max(1))
    }

    /// An image of pixels of this number of channels: of greys, or of colours, and maybe of opacity.
    fn of(width: usize, data: &[u8], channels: usize) -> Result<Self> {
        ensure!(width > 0 && channels > 0 && data.len() >= width * channels, "the image is empty");
        let colour = |pixel: &[u8]| if channels < 3 { [pixel[0]; 3] } else { [pixel[0], pixel[1], pixel[2]] };
        let all = data.chunks_exact(channels);
        let opacity: Vec<u8> =
            if channels.is_multiple_of(2) { all.clone().filter_map(|pixel| pixel.last().copied()).collect() } else { Vec::new() };
        let opacity = if opacity.iter().all(|&opacity| opacity == u8::MAX) { Vec::new() } else { opacity };
        Ok(Self { width, pixels: all.map(colour).collect(), opacity, holes: Vec::new() })
    }

    /// Whether it says of a pixel that it is not opaque.
    pub(crate) fn has_opacity(&self) -> bool {
        !self.opacity.is_empty()
    }

    /// The image with holes where its opacity is less than this share.
    pub(crate) fn cut(&self, share: f64) -> Self {
        let is_hole = |&opacity: &u8| f64::from(opacity) < 255.0 * share;
        let holes: Vec<bool> = self.opacity.iter().map(is_hole).collect();
        let holes = if holes.contains(&true) { holes } else { Vec::new() };
        Self { width: self.width, pixels: self.pixels.clone(), opacity: self.opacity.clone(), holes }
    }

    /// The mean opacity of what is no hole, from 0 to 1.
    pub(crate) fn mean_opacity(&self) -> f64 {
        let is_there = |&(number, _): &(usize, &u8)| !self.is_hole(number);
        let (sum, count) = self
            .opacity
            .iter()
            .enumerate()
            .filter(is_there)
            .fold((0.0, 0), |(sum, count), (_, &opacity)| (sum + f64::from(opacity) / 255.0, count + 1));
        if count > 0 { sum / f64::from(count) } else { 1.0 }
    }

    /// The image with the opacity of another one: that image's own, or else its brightness. It has the size of the larger one.
    pub(crate) fn with_opacity(&self, mask: &Self) -> Self {
        let size @ [width, height] = [0, 1].map(|axis| self.size()[axis].max(mask.size()[axis]));
        let scaled = |own: [usize; 2], x: usize, y: usize| y * own[1] / height * own[0] + x * own[0] / width;
        let all = |own: [usize; 2]| (0..size[1]).flat_map(move |y| (0..size[0]).map(move |x| scaled(own, x, y)));
        let brightness = |[r, g, b]: Rgb| ((299 * u32::from(r) + 587 * u32::from(g) + 114 * u32::from(b)) / 1000) as u8;
        let opacity = |number: usize| if mask.has_opacity() { mask.opacity[number] } else { brightness(mask.pixels[number]) };
        Self {
            width,
            pixels: all(self.size()).map(|number| self.pixels[number]).collect(),
            opacity: all(mask.size()).map(opacity).collect(),
            holes: Vec::new(),
        }
    }

    /// The mean colour of all pixels.
    pub(crate) fn mean(&self) -> V3 {
        let sum = self.pixels.iter().fold([0.0; 3], |sum, pixel| add(sum, pixel.map(f64::from)));
        scale(sum, 1.0 / (255.0 * self.pixels.len() as f64))
    }

    /// An image of one pixel.
    pub(crate) fn of_colour(colour: V3) -> Self {
        let pixel = colour.map(|c| (255.0 * c).round() as u8);
        Self { width: 1, pixels: vec![pixel], opacity: Vec::new(), holes: Vec::new() }
    }

    fn is_hole(&self, number: usize) -> bool {
        self.holes.get(number) == Some(&true)
    }
}

impl Image {
    /// The colour of the pixel at a place, of which 1 is the whole width and height. The image repeats itself.
    pub(crate) fn at(&self, place: [f64; 2]) -> V3 {
        let [r, g, b] = self.pixels[self.number_at(place)];
        [f64::from(r) / 255.0, f64::from(g) / 255.0, f64::from(b) / 255.0]
    }

    /// Whether there is a hole at a place.
    pub(crate) fn is_hole_at(&self, place: [f64; 2]) -> bool {
        !self.holes.is_empty() && self.is_hole(self.number_at(place))
    }

    /// The number of the pixel at a place.
    fn number_at(&self, [x, y]: [f64; 2]) -> usize {
        let [_, height] = self.size();
        let place = |coordinate: f64, size: usize| (((coordinate - coordinate.floor()) * size as f64) as usize).min(size - 1);
        place(y, height) * self.width + place(x, self.width)
    }

    /// Width and height.
    pub(crate) fn size(&self) -> [usize; 2] {
        [self.width, self.pixels.len() / self.width]
    }

    /// The image in another width and height: each pixel has the mean colour of the area that it covers, without its holes. `None` is a hole: there holes are
    /// more than half of the area.
    pub(crate) fn resampled(&self, [width, height]: [usize; 2]) -> Vec<Option<Rgb>> {
        let own = self.size();
        let [columns, rows] = [covered(own[0], width), covered(own[1], height)];
        let mean = |row: &Cover, column: &Cover| {
            let (mut sum, mut seen, mut all) = ([0.0; 3], 0.0, 0.0);
            for (y, down) in row.iter() {
                for (x, along) in column.iter() {
                    let (number, share) = (y * own[0] + x, down * along);
                    all += share;
                    if !self.is_hole(number) {
                        sum = add(sum, scale(self.pixels[number].map(f64::from), share));
                        seen += share;
                    }
                }
            }
            // Without holes, the area is 1.
            let seen = if seen == all { 1.0 } else { seen };
            (2.0 * seen > all).then(|| sum.map(|c| (c / seen).round() as u8))
        };
        rows.iter().flat_map(|row| columns.iter().map(move |column| mean(row, column))).collect()
    }
}

/// Whether the first channel of a JPEG file, which is the brightness, has at least as many samples as the others, as all programs write it.
fn has_finest_luma(bytes: &[u8]) -> bool {
    let mut rest = bytes.get(2..).unwrap_or_default();
    // Segments begin with 0xFF, a marker and a length. 0xC0 to 0xC2 are frames, of which each channel has a byte with its two numbers of samples. The
    // decoder passes over all bytes between segments, and behind 0xDA is the image.
    let begins = |pair: &[u8]| pair[0] == 0xFF && ![0, 0xFF].contains(&pair[1]);
    while let Some(start) = rest.windows(2).position(begins) {
        rest = &rest[start..];
        let [_, marker, high, low, ..] = *rest else { break };
        if marker == 0xDA {
            break;
        }
        let length = usize::from(u16::from_be_bytes([high, low]));
        let segment = rest.get(4..2 + length).unwrap_or_default();
        if (0xC0..=0xC2).contains(&marker) {
            let samples: Vec<_> =
                segment.get(6..).unwrap_or_default().chunks_exact(3).map(|channel| [channel[1] >> 4, channel[1] & 15]).collect();
            let is_finest = |[x, y]: [u8; 2]| samples.iter().all(|other| other[0] <= x && other[1] <= y);
            if !samples.first().is_some_and(|&first| is_finest(first)) {
                return false;
            }
        }
        rest = rest.get(2 + length..).unwrap_or_default();
    }
    true
}

/// The pixels of a row that a new pixel covers.
struct Cover {
    first: usize,
    /// What each of them has of the new pixel.
    shares: Vec<f64>,
}

impl Cover {
    fn iter(&self) -> impl Iterator<Item = (usize, f64)> {
        (self.first..).zip(self.shares.iter().copied())
    }
}

/// What each of `new` pixels covers of a row of `own` pixels.
fn covered(own: usize, new: usize) -> Vec<Cover> {
    // Old pixels have the length `new`, and new ones the length `own`.
    let cover = |number: usize| {
        let (from, to) = (number * own, (number + 1) * own);
        let first = from / new;
        let share = |pixel: usize| (to.min((pixel + 1) * new) - from.max(pixel * new)) as f64 / own as f64;
        Cover { first, shares: (first..to.div_ceil(new)).map(share).collect() }
    };
    (0..new).map(cover).collect()
}

impl Texture {
    /// The texture with holes where its opacity is less than this share.
    pub(crate) fn cut(self, share: f64) -> Self {
        if self.image.has_opacity() { Self { image: Arc::new(self.image.cut(share)), ..self } } else { self }
    }

    /// The texture with its mean colour everywhere.
    pub(crate) fn even(self) -> Self {
        Self { image: Arc::new(Image::of_colour(self.image.mean())), ..self }
    }

    /// The place on the image at coordinates of the surface.
    pub(crate) fn place(&self, [u, v]: [f64; 2]) -> [f64; 2] {
        self.transform.map(|[a, b, c]| a * u + b * v + c)
    }
}
