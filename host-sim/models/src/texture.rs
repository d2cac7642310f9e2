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
        let data = decoder.decode().map_err(damaged)?;
        Self::of(width, &data, data.len() / (width * height).max(1))
    }

    /// An image of pixels of this number of channels: of greys, or of colours, and maybe of opacity.
    fn of(width: usize, data: &[u8], channels: usize) -> Result<Self> {
        ensure!(width > 0 && channels > 0 && data.len() >= width * channels, "the image is empty");
        let colour = |pixel: &[u8]| if channels < 3 { [pixel[0]; 3] } else { [pixel[0], pixel[1], pixel[2]] };
        Ok(Self { width, pixels: data.chunks_exact(channels).map(colour).collect() })
    }
}

impl Image {
    /// The colour of the pixel at a place, of which 1 is the whole width and height. The image repeats itself.
    pub(crate) fn at(&self, [x, y]: [f64; 2]) -> V3 {
        let [_, height] = self.size();
        let place = |coordinate: f64, size: usize| (((coordinate - coordinate.floor()) * size as f64) as usize).min(size - 1);
        let [r, g, b] = self.pixels[place(y, height) * self.width + place(x, self.width)];
        [f64::from(r) / 255.0, f64::from(g) / 255.0, f64::from(b) / 255.0]
    }

    /// Width and height.
    pub(crate) fn size(&self) -> [usize; 2] {
        [self.width, self.pixels.len() / self.width]
    }

    /// The image in another width and height: each pixel has the mean colour of the area that it covers.
    pub(crate) fn resampled(&self, [width, height]: [usize; 2]) -> Vec<Rgb> {
        let own = self.size();
        let [columns, rows] = [covered(own[0], width), covered(own[1], height)];
        let mean = |row: &Cover, column: &Cover| {
            let mut sum = [0.0; 3];
            for (y, down) in row.iter() {
                for (x, along) in column.iter() {
                    sum = add(sum, scale(self.pixels[y * own[0] + x].map(f64::from), down * along));
                }
            }
            sum.map(|c| c.round() as u8)
        };
        rows.iter().flat_map(|row| columns.iter().map(move |column| mean(row, column))).collect()
    }
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
    /// The place on the image at coordinates of the surface.
    pub(crate) fn place(&self, [u, v]: [f64; 2]) -> [f64; 2] {
        self.transform.map(|[a, b, c]| a * u + b * v + c)
    }
}
