//! Kernels that compute light at each pixel, and the loop that they replace.

use crate::{
    BGR565, GUARD, LIGHT332, LIGHT565, PIXELS, Padded, RGB565, RGB666, RGB888, Random, SWAPPED, as_halfwords, bytes, for_format, line,
    packed, plane, say, within,
};
use cortex_m_semihosting::debug;
use microphong_kernels::{
    Colours, Entries, Fields, Highlights, Lit, Lookup, MAX_HEIGHT, Plane, Quadric, Roots, Rows, Shares, Sides, Sums, Texels, Turn,
};

/// Cases for each kernel.
const CASES: u32 = 10_000;

/// Any numbers, as a table.
const fn scattered(i: usize) -> u32 {
    (i as u32).wrapping_mul(2_654_435_761) ^ (i as u32) << 7
}

static ROOTS: Roots = {
    let mut table = [0; 2048];
    let mut i = 0;
    while i < table.len() {
        table[i] = scattered(i);
        i += 1;
    }
    table
};

static HIGHLIGHTS: Highlights = {
    let mut table = [0; 4097];
    let mut i = 0;
    while i < table.len() {
        table[i] = (scattered(i) >> 9) as u16;
        i += 1;
    }
    table
};

static RAMPS: [[u16; 512]; 2] = {
    let mut tables = [[0; 512]; 2];
    let mut i = 0;
    while i < 1024 {
        tables[i % 2][i / 2] = (scattered(i) >> 11) as u16;
        i += 1;
    }
    tables
};

static WORD_RAMPS: [[u32; 512]; 2] = {
    let mut tables = [[0; 512]; 2];
    let mut i = 0;
    while i < 1024 {
        tables[i % 2][i / 2] = scattered(i);
        i += 1;
    }
    tables
};

static TEXELS: [u8; 256] = {
    let mut texels = [0; 256];
    let mut i = 0;
    while i < texels.len() {
        texels[i] = (scattered(i) >> 24) as u8;
        i += 1;
    }
    texels
};

static PALETTE: [[u8; 4]; 256] = {
    let mut palette = [[0; 4]; 256];
    let mut i = 0;
    while i < palette.len() {
        let [red, green, blue, last] = scattered(i).to_le_bytes();
        // One colour in eight is a hole.
        palette[i] = [red, green, blue, if last < 224 { 0 } else { last }];
        i += 1;
    }
    palette
};

/// What colours are made of, see [`Colours`].
#[derive(Clone, Copy, Debug, PartialEq)]
enum Light {
    Table,
    Lights(usize),
    Summed,
    Painted,
    PaintedSums,
    Texels,
    NeutralTexels,
}

/// A kernel: the format of channels, the light, and the number of highlights.
type Kernel = (u32, Light, usize);

const KERNELS: [Kernel; 36] = [
    (RGB565, Light::Table, 0),
    (RGB565, Light::Table, 1),
    (RGB565, Light::Lights(1), 0),
    (RGB565, Light::Lights(1), 1),
    (SWAPPED, Light::Lights(1), 1),
    (RGB565, Light::Lights(2), 0),
    (RGB565, Light::Lights(2), 1),
    (RGB565, Light::Lights(2), 2),
    (BGR565, Light::Lights(2), 2),
    (RGB565, Light::Summed, 0),
    (RGB565, Light::Summed, 1),
    (BGR565, Light::Summed, 2),
    (RGB565, Light::Painted, 0),
    (SWAPPED, Light::Painted, 1),
    (RGB565, Light::PaintedSums, 0),
    (SWAPPED, Light::PaintedSums, 1),
    (RGB565, Light::PaintedSums, 2),
    (RGB565, Light::Texels, 0),
    (BGR565, Light::Texels, 1),
    (RGB565, Light::NeutralTexels, 0),
    (BGR565, Light::NeutralTexels, 0),
    (SWAPPED, Light::NeutralTexels, 0),
    (RGB565, Light::NeutralTexels, 1),
    (SWAPPED, Light::NeutralTexels, 1),
    (RGB888, Light::Table, 0),
    (LIGHT565, Light::Table, 1),
    (RGB666, Light::Lights(1), 0),
    (RGB888, Light::Lights(1), 1),
    (LIGHT332, Light::Lights(2), 1),
    (LIGHT565, Light::Lights(2), 2),
    (LIGHT565, Light::Summed, 1),
    (RGB666, Light::Painted, 1),
    (RGB888, Light::PaintedSums, 2),
    (LIGHT565, Light::Texels, 1),
    (RGB888, Light::NeutralTexels, 0),
    (LIGHT565, Light::NeutralTexels, 1),
];

/// The number of numerators.
fn numerators((_, light, highlights): Kernel) -> usize {
    highlights
        + match light {
            Light::Table | Light::NeutralTexels => 1,
            Light::Texels => 3 + 2 * highlights,
            Light::Lights(lights) => lights,
            Light::Summed => 3,
            Light::Painted => 4,
            Light::PaintedSums => 6,
        }
}

/// The number of quadratics.
fn quadratics((_, light, _): Kernel) -> usize {
    1 + usize::from(has_texture(light))
}

fn has_texture(light: Light) -> bool {
    matches!(light, Light::Texels | Light::NeutralTexels)
}

/// Depth of pixels, with guards around it.
type PaddedDepth = [u16; PIXELS + 2 * GUARD];

/// What a kernel changes.
#[derive(Clone, PartialEq)]
struct State {
    pixels: Padded,
    depth: PaddedDepth,
    sides: Sides,
    plane: Plane,
    planes: [Plane; 8],
    quadratics: [Quadric; 2],
}

/// What a kernel reads and does not change.
#[derive(Clone)]
struct Case {
    kernel: Kernel,
    width: usize,
    first: u32,
    height: u32,
    turn: Turn,
    top: i32,
    sums: [[Sums; 2]; 2],
    shares: [Shares; 2],
    /// Binary logarithms of the sides of a texture, and its number of colours.
    size: [u8; 2],
    colours: usize,
    /// What is added to levels on a texture.
    roundings: [[i32; 3]; 2],
    /// Whether the colours of the second row come first.
    from_second_row: bool,
}

impl Case {
    fn by_kernel(&self, state: &mut State) -> Option<u32> {
        let State { pixels, depth, sides, plane, planes, quadratics: squares } = state;
        let mut fields = Fields::default();
        planes.iter_mut().take(numerators(self.kernel)).for_each(|plane| fields.add_numerator(plane));
        squares.iter_mut().take(quadratics(self.kernel)).for_each(|square| fields.add_quadratic(square));
        self.by_kernel_of((pixels, depth, sides, plane), &mut fields, Some(&HIGHLIGHTS))
    }

    /// Draws with these fields and this table of highlights.
    fn by_kernel_of(
        &self,
        (pixels, depth, sides, plane): (&mut Padded, &mut PaddedDepth, &mut Sides, &mut Plane),
        fields: &mut Fields<'_>,
        highlights_table: Option<&Highlights>,
    ) -> Option<u32> {
        let &Self { width, first, height, turn, top, kernel: (format, light, highlights), .. } = self;
        let depth = within(depth);
        let lookup = if has_texture(light) { Lookup::default() } else { Lookup { roots: Some(&ROOTS), highlights: highlights_table, top } };
        let texels = self.roundings.map(|rounding| Texels::new(&PALETTE[..self.colours], self.texels(), self.size, rounding).unwrap());
        let colours = match light {
            Light::Table if bytes(format) == 4 => Colours::Table(WORD_RAMPS.each_ref().map(Entries::Words)),
            Light::Table => Colours::Table(RAMPS.each_ref().map(Entries::Halfwords)),
            Light::Lights(1) => Colours::Light(self.sums.each_ref().map(|[first, _]| first)),
            Light::Lights(_) => Colours::TwoLights(self.sums.each_ref()),
            Light::Summed => Colours::Summed(self.shares.each_ref()),
            Light::Painted => Colours::PaintedLight(self.shares.each_ref()),
            Light::PaintedSums => Colours::PaintedSum(self.shares.each_ref()),
            Light::Texels => Colours::Texels(texels.each_ref()),
            Light::NeutralTexels => Colours::NeutralTexels(texels.each_ref()),
        };
        let lit = for_format!(format, Lit::new::<FORMAT>(colours, highlights, lookup))?;
        let lit = if self.from_second_row { lit.from_second_row() } else { lit };
        let rows = Rows { depth, width, first, height, sides, turn };
        Some(if bytes(format) == 2 {
            as_halfwords(pixels, |pixels| lit.fill(pixels, rows, plane, fields))
        } else {
            lit.fill(within(pixels), rows, plane, fields)
        })
    }

    /// The texels of a texture of this size.
    fn texels(&self) -> &'static [u8] {
        let [width, height] = self.size;
        &TEXELS[..1 << (width + height)]
    }

    /// The pixel of these fields, on an even row of the kernel or on an odd one; `None` if it is left out.
    fn pixel(&self, planes: &[Plane; 8], quadratics: &[Quadric; 2], column: i32, parity: usize) -> Option<u32> {
        let (format, light, highlights) = self.kernel;
        let [square, second] = quadratics.map(|[value, _, _, slope, _, bend]| {
            slope.wrapping_add(bend.wrapping_mul(column)).wrapping_mul(column).wrapping_add(value) as u32
        });
        let knot = ROOTS[(square >> 21) as usize];
        let half_reciprocal = knot.wrapping_sub((knot & 0x3FF).wrapping_mul(square >> 11 & 0x3FF)) as i32;
        let mut values = planes.iter().map(|plane| plane[0].wrapping_add(plane[1].wrapping_mul(column)));
        let mut value = || values.next().unwrap();
        let over_length = |value: i32| ((i64::from(value) * i64::from(half_reciprocal)) >> 32) as i32;
        let highlight = |value: i32| i32::from(HIGHLIGHTS[(self.top.wrapping_sub(over_length(value)) >> 8).clamp(0, 4095) as usize]);
        let cosine = |level: i32| (level >> 11).clamp(0, 0x7FFF);
        let painted = |level: i32, share: i32| (level >> 15).wrapping_mul(share >> 14);
        let mut channels = [0i32; 3];
        match light {
            Light::Table => {
                let level = over_length(value()).max(0) as u32;
                let more = if highlights > 0 { (highlight(value()) as u32) << 12 } else { self.top as u32 };
                let index = (level.wrapping_add(more) >> 19 & 511) as usize;
                return Some(if bytes(format) == 4 { WORD_RAMPS[parity][index] } else { RAMPS[parity][index].into() });
            }
            Light::Lights(lights) => {
                for light in 0..lights {
                    let level = cosine(over_length(value()));
                    let highlight = if light < highlights { highlight(value()) } else { 0 };
                    for (channel, [ambient, diffuse, specular]) in channels.iter_mut().zip(self.sums[parity][light]) {
                        let light_level = diffuse.wrapping_mul(level).wrapping_add(specular.wrapping_mul(highlight));
                        *channel = channel.wrapping_add(light_level).wrapping_add(if light == 0 { ambient } else { 0 });
                    }
                }
            }
            Light::Texels | Light::NeutralTexels => {
                let [width, height] = self.size.map(u32::from);
                let [x, y] = [(square, width), (second, height)].map(|(place, bits)| (u64::from(place) << bits >> 32) as usize);
                let [colour @ .., hole] = PALETTE[..self.colours].get(usize::from(self.texels()[(y << width) + x]))?;
                if *hole != 0 {
                    return None;
                }
                let [outer, green, blue] = self.roundings[parity];
                let is_neutral = light == Light::NeutralTexels;
                let mut levels = || if is_neutral { [value(); 3] } else { [value(), value(), value()] };
                let (light, lit) = (levels().map(|level| level >> 6), if highlights > 0 { levels() } else { [0; 3] });
                let rounding = if is_neutral { [outer, green, outer] } else { [outer, green, blue] };
                for (k, channel) in channels.iter_mut().enumerate() {
                    let less = |level: i32| if is_neutral && k != 1 && bytes(format) == 2 { level.wrapping_sub(level >> 6) } else { level };
                    let reflected = less(light[k]).wrapping_mul(colour[k].into());
                    *channel = reflected.wrapping_add(less(lit[k])).wrapping_add(rounding[k]);
                }
            }
            Light::Painted => {
                let level = cosine(over_length(value()));
                let highlight = if highlights > 0 { highlight(value()) } else { 0 };
                for (channel, [rounding, ambient, diffuse, specular]) in channels.iter_mut().zip(self.shares[parity]) {
                    let lit = painted(ambient.wrapping_add(diffuse.wrapping_mul(level)), value());
                    *channel = lit.wrapping_add(rounding).wrapping_add(specular.wrapping_mul(highlight));
                }
            }
            Light::Summed | Light::PaintedSums => {
                let sums = [over_length(value()), over_length(value()), over_length(value())];
                for ((channel, sum), [rounding, ambient, ..]) in channels.iter_mut().zip(sums).zip(self.shares[parity]) {
                    let level = ambient.wrapping_add(sum << 3);
                    *channel = if light == Light::Summed { level } else { painted(level, value()).wrapping_add(rounding) };
                }
                for number in 0..highlights {
                    let highlight = highlight(value());
                    for (channel, shares) in channels.iter_mut().zip(self.shares[parity]) {
                        *channel = channel.wrapping_add(shares[2 + number].wrapping_mul(highlight));
                    }
                }
            }
        }
        Some(packed(format, channels))
    }

    fn by_loop(&self, state: &mut State) -> u32 {
        let State { pixels, depth, sides, plane, planes, quadratics: squares } = state;
        let mut count = 0;
        for row in 0..self.height + self.turn.height {
            if row == self.height {
                let side = 2 * usize::from(self.turn.is_right);
                sides[side..side + 2].copy_from_slice(&self.turn.line);
            }
            let (left, right) = ((sides[0] >> 21) as usize, (sides[2] >> 21) as usize);
            let start = GUARD + (self.first + row) as usize * self.width;
            if left < right && right <= self.width {
                count += (right - left) as u32;
                for column in (left..right).rev() {
                    let inv_depth = (plane[0].wrapping_add(plane[1].wrapping_mul(column as i32)) as u32 >> 16) as u16;
                    let parity = (row as usize + usize::from(self.from_second_row)) % 2;
                    if inv_depth > depth[start + column]
                        && let Some(pixel) = self.pixel(planes, squares, column as i32, parity)
                    {
                        depth[start + column] = inv_depth;
                        pixels[start + column] = pixel;
                    }
                }
            }
            sides[0] = sides[0].wrapping_add(sides[1]);
            sides[2] = sides[2].wrapping_add(sides[3]);
            plane[0] = plane[0].wrapping_add(plane[2]);
            planes.iter_mut().take(numerators(self.kernel)).for_each(|[value, _, down]| *value = value.wrapping_add(*down));
            for square in squares.iter_mut().take(quadratics(self.kernel)) {
                for (to, from) in [(0, 1), (1, 2), (3, 4)] {
                    square[to] = square[to].wrapping_add(square[from]);
                }
            }
        }
        count
    }
}

/// Compares all kernels with the loop, in random cases and where rows do not fit. Returns how many cases there were, and pixels.
pub(crate) fn compare(random: &mut Random) -> (u32, u32) {
    let (mut cases, mut pixels) = (0, 0);
    for kernel in KERNELS {
        for number in 0..CASES {
            let width = random.below(40) as usize + 1;
            let rows = (PIXELS / width) as u32;
            let first = random.below(rows.min(8) + 1);
            let height = random.below((rows - first).min(9) + 1);
            let below = random.below((rows - first - height).min(9) + 1);
            let turn = Turn { height: below, is_right: random.below(2) == 1, line: line(random, width) };
            let mut sum = || [(random.next() >> 3) as i32, random.next() as i32 >> 17, random.next() as i32 >> 17];
            let mut sums = || [sum(), sum(), sum()];
            let sums = [[sums(), sums()], [sums(), sums()]];
            let mut shares = || {
                [0; 3].map(|_: i32| {
                    [(random.next() >> 8) as i32, (random.next() >> 3) as i32, random.next() as i32 >> 17, random.next() as i32 >> 17]
                })
            };
            let shares = [shares(), shares()];
            let case = Case {
                kernel,
                width,
                first,
                height,
                turn,
                top: random.next() as i32 >> 10,
                sums,
                shares,
                size: [random.below(5) as u8, random.below(5) as u8],
                // Few texels lack a colour in most cases.
                colours: 256 - random.below(257) as usize * usize::from(number % 4 == 0),
                roundings: [[0; 3]; 2].map(|rounding: [i32; 3]| rounding.map(|_| random.next() as i32 >> 8)),
                from_second_row: number % 2 == 1,
            };
            let [l, r] = [line(random, width), line(random, width)];
            // Quotients of small numerators often lie between the ends of tables.
            let shift = 5 * random.below(3);
            let planes = core::array::from_fn(|_| [0; 3].map(|_: i32| random.next() as i32 >> shift));
            let quadratics = [[0; 6]; 2].map(|square: Quadric| square.map(|_| random.next() as i32));
            let mut state = State {
                pixels: [0x5555; PIXELS + 2 * GUARD],
                depth: [0; PIXELS + 2 * GUARD],
                sides: [l[0], l[1], r[0], r[1]],
                plane: plane(random, crate::Kernel::Solid(2)),
                planes,
                quadratics,
            };
            let far = random.next() as u16;
            state.depth.iter_mut().step_by(3).for_each(|depth| *depth = far);
            let mut by_loop = state.clone();
            let (count, expected) = (case.by_kernel(&mut state), case.by_loop(&mut by_loop));
            if count != Some(expected) || state != by_loop {
                let same = [state.pixels == by_loop.pixels, state.depth == by_loop.depth, state.sides == by_loop.sides];
                say(format_args!("light by {kernel:?} differs in case {number}: count {count:?} {expected}, same {same:?}"));
                say(format_args!("{:x?} {:x?}", state.quadratics, by_loop.quadratics));
                debug::exit(debug::EXIT_FAILURE);
            }
            (cases, pixels) = (cases + 1, pixels + expected);
        }
        // Rows that do not fit change nothing, and neither does a kernel without all of its fields. Without its table there is no kernel.
        let fits = Case {
            kernel,
            width: 20,
            first: 10,
            height: 10,
            turn: Turn::default(),
            top: 0,
            sums: [[[[1; 3]; 3]; 2]; 2],
            shares: [[[1; 4]; 3]; 2],
            size: [2, 1],
            colours: 256,
            roundings: [[1; 3]; 2],
            from_second_row: false,
        };
        let before = State {
            pixels: [0x5555; PIXELS + 2 * GUARD],
            depth: [0; PIXELS + 2 * GUARD],
            sides: [1 << 21, 1 << 20, 12 << 21, 1 << 20],
            plane: [1 << 30, 0, 1],
            planes: [[1 << 29; 3]; 8],
            quadratics: [[1 << 29; 6]; 2],
        };
        for case in [Case { first: 21, ..fits.clone() }, Case { height: MAX_HEIGHT + 1, width: 0, ..fits.clone() }] {
            let mut state = before.clone();
            let count = case.by_kernel(&mut state);
            if count != Some(0) || state != before {
                say(format_args!("light by {kernel:?} draws rows that do not fit: count {count:?}"));
                debug::exit(debug::EXIT_FAILURE);
            }
        }
        let (all, squares) = (numerators(kernel), quadratics(kernel));
        for (numerators, quadratics) in [(all - 1, squares), (all, squares - 1)] {
            let mut state = before.clone();
            let State { pixels, depth, sides, plane, planes, quadratics: squares } = &mut state;
            let mut fields = Fields::default();
            planes.iter_mut().take(numerators).for_each(|plane| fields.add_numerator(plane));
            squares.iter_mut().take(quadratics).for_each(|square| fields.add_quadratic(square));
            let count = fits.by_kernel_of((pixels, depth, sides, plane), &mut fields, Some(&HIGHLIGHTS));
            if count != Some(0) || state != before {
                say(format_args!("light by {kernel:?} draws without all fields: count {count:?}"));
                debug::exit(debug::EXIT_FAILURE);
            }
        }
        let (mut state, (_, light, highlights)) = (before.clone(), kernel);
        let State { pixels, depth, sides, plane, .. } = &mut state;
        let count = fits.by_kernel_of((pixels, depth, sides, plane), &mut Fields::default(), None);
        if count.is_some() != (highlights == 0 || has_texture(light)) || state != before {
            say(format_args!("light by {kernel:?} needs no table of highlights: count {count:?}"));
            debug::exit(debug::EXIT_FAILURE);
        }
    }
    (cases, pixels)
}
