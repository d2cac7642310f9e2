//! Lighting models: how interpolated fields become reflected light at a pixel.

use crate::{
    features::{COLOURED, PERSPECTIVE, TEXTURES, TRANSPARENCY, VERTEX_COLOURS},
    format::{COSINE, MAX_LIGHTS},
    interpolate::{Constant, Patch, Walker, field::Field, perspective::PerspectivePatch},
    lighting::{
        albedo::{Albedo, IfColoured},
        lights::{SHAPES, Source, cosine},
        reflectance::{Factors, LitMaterial, Reflection},
    },
    math::{
        highlight_lut::{CosineLookup, HighlightLut},
        vector::{map, zip},
    },
    method::{
        Shading, TriangleSetup,
        node::{Node, map_six},
        products::{QuadraticNodes, fitted, quadratic, signed},
        texture::{PlacePatch, Placed},
        weakening::{Change, Way},
    },
    raster::canvas::{CHUNK, Canvas, SpanShader, SpanTarget, covered},
};

/// Computes the light at a pixel from interpolated fields: `V` for each light, `D` for a light without a highlight, and `K` once for all lights.
pub trait LightingModel<K, V, D = ()>: Copy {
    /// The result that is computed once for all lights.
    type Common: Copy + Default;

    /// Computes what is needed once for all lights.
    fn common(&self, common: K) -> Self::Common;

    /// Computes the diffuse light and the highlight of light number `light`.
    fn reflect(&self, light: usize, common: &Self::Common, fields: V, lut: CosineLookup<'_>) -> Reflection;

    /// Computes the diffuse part of [`Self::reflect`], for a light without a highlight. Only methods that tell such lights apart implement it.
    fn reflect_diffuse(&self, _: &Self::Common, _: D) -> i32 {
        0
    }
}

/// What one light adds to a triangle, with the fields that the method interpolates for it.
#[derive(Clone, Copy, Debug)]
pub enum Lit<V, D> {
    /// The light adds nothing anywhere on the triangle.
    Nowhere,
    /// The light adds diffuse light, and no highlight that can be seen.
    Diffuse(D),
    /// The light adds diffuse light and a highlight.
    Fully(V),
}

/// The colour of a surface over a triangle.
struct ColouredSurface<'a, C> {
    painter: Painter<'a, C>,
    /// Where the sums of all highlights begin.
    dark: [i32; 3],
    /// For a run of pixels, the sums of all highlights.
    highlights: &'a mut [[i32; 3]; CHUNK],
}

/// What has the colours of the pixels of a triangle.
enum Painter<'a, C> {
    /// Its corners: the shares of red and green, then that of blue and nothing, Q2.30.
    Corners([C; 2]),
    /// A texture.
    Texture(Placed<'a, PlacePatch>),
}

impl<C: Patch<Walker: Walker<Value = [u32; 2]>>> ColouredSurface<'_, C> {
    /// Multiplies the sums of ambient and diffuse light of the `visible` ones of `run` pixels by the colour, and adds highlights. The runs lie `rows` rows
    /// below the current one, left of the column `x`.
    fn paint(&mut self, levels: &mut [[i32; 3]; CHUNK], run: usize, visible: u32, [rows, x]: [i32; 2]) {
        let light = levels.iter_mut().zip(&*self.highlights).take(run).rev();
        let reflect = |sums: &mut [i32; 3], highlights: &[i32; 3], shares: [i64; 3]| {
            let reflected = zip(*sums, shares, |level, share| ((i64::from(level) * share) >> 16) as i32);
            *sums = zip(reflected, *highlights, i32::wrapping_add);
        };
        match &self.painter {
            Painter::Corners(shares) => {
                let mut walkers = shares.each_ref().map(|share| enter(share, rows, x));
                for (sums, highlights) in light {
                    walkers.iter_mut().for_each(Walker::step);
                    let [[red, green], [blue, _]] = walkers.each_ref().map(Walker::value);
                    reflect(sums, highlights, map([red, green, blue], share));
                }
            }
            Painter::Texture(place) if TEXTURES => {
                let (mut walker, sampler) = (enter(place, rows, x), place.sampler);
                let mut bit = 1 << run;
                for (sums, highlights) in light {
                    walker.step();
                    bit >>= 1;
                    if visible & bit != 0 {
                        reflect(sums, highlights, map(sampler.albedo(walker.value()).shares(), i64::from));
                    }
                }
            }
            Painter::Texture(..) => {}
        }
    }
}

/// Converts a walked share to Q0.16.
fn share(walked: u32) -> i64 {
    i64::from(signed(walked).max(0) >> (COSINE - 16))
}

/// The shares of red and green, and of blue, over a triangle, whose colours are these at the six nodes of a quadratic.
fn shares(colours: &[Albedo; 6]) -> [QuadraticNodes<2>; 2] {
    let [a, b, c, ab, bc, ca] = map_six(*colours, |albedo| map(albedo.shares(), |share| share << (COSINE - 16)));
    let channel = |k: usize| [a[k], b[k], c[k], ab[k], bc[k], ca[k]];
    [quadratic([channel(0), channel(1)]), quadratic([channel(2), [0; 6]])]
}

/// How a light changes over a triangle: nothing in a program without the feature.
type Changes<'s, W> = [Change<'s, W>; SHAPES];

/// Walkers of what changes.
#[inline(always)]
fn entered<'s, P: Patch>(changes: &Changes<'s, P>, enter: impl Fn(&P) -> P::Walker) -> Changes<'s, P::Walker> {
    changes.each_ref().map(|change| change.enter(&enter))
}

/// The light at a pixel where it changes so.
#[inline(always)]
fn changed<W: Walker<Value = [u32; 2]>>(changes: &Changes<'_, W>, reflection: Reflection, floor: u32) -> Reflection {
    changes.iter().fold(reflection, |reflection, change| change.applied(reflection, floor))
}

/// Shades a triangle under any lights on any material. Lights take turns over a run of pixels, so that each loop knows one light.
struct ManyLights<'a, 's, K, P, D, W, C, F, S> {
    reflectance: LitMaterial<'a>,
    model: F,
    /// The field that all lights share.
    common: K,
    /// The number and the field of each light that adds a highlight, what it adds, and how it changes over the triangle.
    lights: &'a mut [(usize, P, Factors, Changes<'s, W>)],
    /// The field of each light that adds no highlight, what it adds, and how it changes.
    diffuse: &'a mut [(D, Factors, Changes<'s, W>)],
    lut: CosineLookup<'a>,
    /// Where the sums of all lights begin.
    ambient: [i32; 3],
    /// The colour of the surface, if the corners have colours.
    colour: IfColoured<Option<ColouredSurface<'a, C>>>,
    /// For a run of pixels, what all lights share, and `levels`, the sums of all lights. Both are written before they are read, and so
    /// cleared once a triangle and not once a span.
    shared: &'a mut [S; CHUNK],
    levels: &'a mut [[i32; 3]; CHUNK],
}

/// A walker that stands on column `x`, `rows` rows below `patch`.
#[inline(always)]
fn enter<P: Patch>(patch: &P, rows: i32, x: i32) -> P::Walker {
    if rows == 0 {
        return patch.enter(x);
    }
    let mut patch = *patch;
    patch.jump(rows);
    patch.enter(x)
}

impl<K, P, D, W, C, F> SpanShader for ManyLights<'_, '_, K, P, D, W, C, F, F::Common>
where
    K: Patch,
    P: Patch,
    D: Patch,
    W: Patch<Walker: Walker<Value = [u32; 2]>>,
    C: Patch<Walker: Walker<Value = [u32; 2]>>,
    F: LightingModel<<K::Walker as Walker>::Value, <P::Walker as Walker>::Value, <D::Walker as Walker>::Value>,
{
    fn span(&mut self, rows: i32, end: i32, count: usize, target: &mut dyn SpanTarget) {
        let Self { reflectance, model, common, lights, diffuse, lut, ambient, colour, shared, levels } = self;
        let mut colour = colour.first_mut().and_then(Option::as_mut);
        let mut common = enter(common, rows, end);
        let (intensity, floor) = (reflectance.intensities(), reflectance.highlights.floor());
        let mut first = count;
        while first > 0 {
            let run = first.min(CHUNK);
            // The column that the walkers of the run enter.
            let entry = end.wrapping_sub((count - first) as i32);
            first -= run;
            if TEXTURES
                && TRANSPARENCY
                && let Some(ColouredSurface { painter: Painter::Texture(place), .. }) = &colour
            {
                target.cover(covered(&enter(place, rows, entry), run));
            }
            let visible = target.visible(first, run);
            // Counted down, and the index cut off: no bounds are left to check.
            let mut k = run;
            while k > 0 {
                k -= 1;
                common.step();
                if visible & (1 << k) != 0 {
                    shared[k % CHUNK] = model.common(common.value());
                    let [r, g, b] = *ambient;
                    levels[k % CHUNK] = [r, g, b];
                    if let Some(colour) = &mut colour {
                        colour.highlights[k % CHUNK] = colour.dark;
                    }
                }
            }
            if visible == 0 {
                continue;
            }
            for (light, patch, factors, changes) in lights.iter() {
                let (mut walker, mut changes) = (enter(patch, rows, entry), entered(changes, |way| enter(way, rows, entry)));
                let mut k = run;
                while k > 0 {
                    k -= 1;
                    walker.step();
                    changes.iter_mut().for_each(Change::step);
                    if visible & (1 << k) != 0 {
                        let reflection = model.reflect(*light, &shared[k % CHUNK], walker.value(), *lut);
                        let reflection = changed(&changes, reflection, floor);
                        match &mut colour {
                            Some(colour) => {
                                factors.add_diffuse(&mut levels[k % CHUNK], reflection.diffuse);
                                factors.add_highlight(&mut colour.highlights[k % CHUNK], reflection.highlight);
                            }
                            None => factors.add(&mut levels[k % CHUNK], reflection),
                        }
                    }
                }
            }
            if size_of::<<D::Walker as Walker>::Value>() > 0 {
                for (patch, factors, changes) in diffuse.iter() {
                    let (mut walker, mut changes) = (enter(patch, rows, entry), entered(changes, |way| enter(way, rows, entry)));
                    let mut k = run;
                    while k > 0 {
                        k -= 1;
                        walker.step();
                        changes.iter_mut().for_each(Change::step);
                        if visible & (1 << k) != 0 {
                            let diffuse = model.reflect_diffuse(&shared[k % CHUNK], walker.value());
                            factors.add_diffuse(&mut levels[k % CHUNK], changed(&changes, Reflection { diffuse, highlight: 0 }, 0).diffuse);
                        }
                    }
                }
            }
            if let Some(colour) = &mut colour {
                colour.paint(levels, run, visible, [rows, entry]);
            }
            for sums in levels.iter_mut().take(run) {
                let [r, g, b] = intensity(*sums);
                *sums = [r, g, b];
            }
            target.put(first, visible, levels);
        }
    }

    fn jump(&mut self, rows: i32) {
        self.common.jump(rows);
        self.lights.iter_mut().for_each(|(_, patch, ..)| patch.jump(rows));
        self.diffuse.iter_mut().for_each(|(patch, ..)| patch.jump(rows));
        self.ways().for_each(|way| way.jump(rows));
        self.shares().for_each(|share| share.jump(rows));
        if let Some(place) = self.place() {
            place.jump(rows);
        }
    }

    fn step_row(&mut self) {
        self.common.step_row();
        self.lights.iter_mut().for_each(|(_, patch, ..)| patch.step_row());
        self.diffuse.iter_mut().for_each(|(patch, ..)| patch.step_row());
        self.ways().for_each(Patch::step_row);
        self.shares().for_each(Patch::step_row);
        if let Some(place) = self.place() {
            place.step_row();
        }
    }
}

impl<'a, 's, K, P, D, W, C, F, S> ManyLights<'a, 's, K, P, D, W, C, F, S> {
    /// What is walked of the lights that change.
    fn ways(&mut self) -> impl Iterator<Item = &mut W> + use<'_, 'a, 's, K, P, D, W, C, F, S> {
        let changes =
            self.lights.iter_mut().flat_map(|(.., changes)| changes).chain(self.diffuse.iter_mut().flat_map(|(.., changes)| changes));
        changes.filter_map(Change::way)
    }

    /// What is walked of the colours of the corners.
    fn shares(&mut self) -> impl Iterator<Item = &mut C> + use<'_, 'a, 's, K, P, D, W, C, F, S> {
        self.colour.iter_mut().flatten().flat_map(|colour| match &mut colour.painter {
            Painter::Corners(shares) => shares.as_mut_slice(),
            Painter::Texture(..) => &mut [],
        })
    }

    /// The place in a texture, if there is one.
    fn place(&mut self) -> Option<&mut Placed<'a, PlacePatch>> {
        match self.colour.first_mut()? {
            Some(ColouredSurface { painter: Painter::Texture(place), .. }) if TEXTURES => Some(place),
            _ => None,
        }
    }
}

#[doc(hidden)]
impl Shading<'_> {
    /// Draws the triangle `setup` under any number of lights, by a lighting `model` that computes the light at each pixel from interpolated
    /// fields (quantities with values at the corners, or at more points). `of` returns the field of each light, and `common` is a field for
    /// all lights together. Returns the number of pixels drawn.
    pub fn draw_lit<K, V, F>(
        &self,
        setup: &TriangleSetup<'_>,
        of: impl Fn(&Source) -> V,
        common: K,
        model: F,
        canvas: &mut dyn Canvas,
    ) -> u32
    where
        K: Field,
        V: Field,
        F: LightingModel<K::Value, V::Value>,
    {
        self.draw_lit_in_part(setup, |source| Lit::<V, Constant>::Fully(of(source)), common, model, canvas)
    }

    /// Draws a triangle like [`Self::draw_lit`], but leaves out work for lights that do not reach it, or have no visible highlight on it.
    /// `of` tells this for each light, together with its field. Returns the number of pixels drawn.
    pub fn draw_lit_in_part<K, V, D, F>(
        &self,
        setup: &TriangleSetup<'_>,
        of: impl Fn(&Source) -> Lit<V, D>,
        common: K,
        model: F,
        canvas: &mut dyn Canvas,
    ) -> u32
    where
        K: Field,
        V: Field,
        D: Field,
        F: LightingModel<K::Value, V::Value, D::Value>,
    {
        let gradients = setup.gradients;
        if PERSPECTIVE && let Some(inv_depth) = setup.inv_depth() {
            let common = PerspectivePatch::new(gradients, inv_depth, common);
            let of = |source: &Source| match of(source) {
                Lit::Nowhere => Lit::Nowhere,
                Lit::Diffuse(field) => Lit::Diffuse(common.with(field)),
                Lit::Fully(field) => Lit::Fully(common.with(field)),
            };
            let walked = |way: Way| common.with(way);
            return self.draw_changing(setup, of, walked, |shares: QuadraticNodes<2>| common.with(shares), common, model, canvas);
        }
        let of = |source: &Source| match of(source) {
            Lit::Nowhere => Lit::Nowhere,
            Lit::Diffuse(field) => Lit::Diffuse(fitted(&field, gradients)),
            Lit::Fully(field) => Lit::Fully(fitted(&field, gradients)),
        };
        self.draw_patches(setup, of, fitted(&common, gradients), model, canvas)
    }

    /// Draws a triangle like [`Self::draw_lit_in_part`], by polynomials on the screen in place of fields.
    pub fn draw_patches<K, P, D, F>(
        &self,
        setup: &TriangleSetup<'_>,
        of: impl Fn(&Source) -> Lit<P, D>,
        common: K,
        model: F,
        canvas: &mut dyn Canvas,
    ) -> u32
    where
        K: Patch,
        P: Patch,
        D: Patch,
        F: LightingModel<<K::Walker as Walker>::Value, <P::Walker as Walker>::Value, <D::Walker as Walker>::Value>,
    {
        let painted = |shares: QuadraticNodes<2>| fitted(&shares, setup.gradients);
        self.draw_changing(setup, of, |way: Way| fitted(&way, setup.gradients), painted, common, model, canvas)
    }

    /// [`Self::draw_patches`], where `walked` makes polynomials of how range and cone weaken a light, and `painted` those of colours.
    #[expect(clippy::too_many_arguments, reason = "each is one part of the light of a triangle")]
    fn draw_changing<K, P, D, W, C, F>(
        &self,
        setup: &TriangleSetup<'_>,
        of: impl Fn(&Source) -> Lit<P, D>,
        walked: impl Fn(Way) -> W,
        painted: impl Fn(QuadraticNodes<2>) -> C,
        common: K,
        model: F,
        canvas: &mut dyn Canvas,
    ) -> u32
    where
        K: Patch,
        P: Patch,
        D: Patch,
        W: Patch<Walker: Walker<Value = [u32; 2]>>,
        C: Patch<Walker: Walker<Value = [u32; 2]>>,
        F: LightingModel<<K::Walker as Walker>::Value, <P::Walker as Walker>::Value, <D::Walker as Walker>::Value>,
    {
        let reflectance = self.reflectance;
        // Renderers refuse methods that look up highlights if there is no table.
        let Some(lut) = reflectance.table().map(HighlightLut::by_cosine) else { return 0 };
        // What a table entry without a highlight adds; the sums are less by this.
        let floor = reflectance.highlights.floor();
        let mut ambient = reflectance.ambient_sums;
        let mut pure = ambient;
        let (mut lights, mut diffuse) = (heapless::Vec::<_, MAX_LIGHTS>::new(), heapless::Vec::<_, MAX_LIGHTS>::new());
        let (mut without_highlight, mut without_light) = (0, 0);
        for (light, source) in self.lighting.sources().iter().enumerate() {
            let factors = reflectance.factors(light);
            if VERTEX_COLOURS {
                factors.add_highlight(&mut pure, floor);
            }
            let changes = [(); SHAPES].map(|()| Change::of(source, setup.vertices()));
            let is_dark = changes.iter().any(|change| matches!(change, Change::Dark));
            // There is room for as many lights as a frame has.
            match of(source) {
                Lit::Fully(patch) if !is_dark => {
                    let _ = lights.push((light, patch, factors, changes.map(|change| change.map(&walked))));
                    continue;
                }
                Lit::Diffuse(patch) if !is_dark => {
                    let _ = diffuse.push((patch, factors, changes.map(|change| change.map(&walked))));
                    without_highlight += 1;
                }
                _ => without_light += 1,
            }
            factors.add_highlight(&mut ambient, floor);
        }
        setup.count_on(canvas, |counts| &mut counts.without_highlight, without_highlight);
        setup.count_on(canvas, |counts| &mut counts.without_light, without_light);
        // Lent, since all of this would be copied if it were moved.
        let (shared, levels) = (&mut [F::Common::default(); CHUNK], &mut [[0; 3]; CHUNK]);
        let (lights, diffuse) = (&mut lights, &mut diffuse);
        let mut room = [[[0; 3]; CHUNK]; COLOURED];
        let dark = zip(ambient, pure, i32::wrapping_sub);
        let mut rooms = room.iter_mut();
        let colour = setup.albedos.map(|_| {
            let painter = match setup.texture_patch().first().copied().flatten() {
                Some(place) => Painter::Texture(place),
                None => Painter::Corners(shares(&setup.colours_at_nodes()?).map(&painted)),
            };
            Some(ColouredSurface { painter, dark, highlights: rooms.next()? })
        });
        let ambient = if setup.albedos().is_some() { pure } else { ambient };
        setup.draw_spans(&mut ManyLights { reflectance, model, common, lights, diffuse, lut, ambient, colour, shared, levels }, canvas)
    }

    /// N·L and N·H at the three corners, Q2.30, for the directional light `source` and an infinitely distant viewer. A point light gives zeros.
    pub fn constant_cosines(&self, setup: &TriangleSetup<'_>, source: &Source) -> [[i32; 3]; 2] {
        source.directional().map_or([[0; 3]; 2], |directions| directions.map(|direction| setup.corner_cosines(direction)))
    }

    /// N·L and N·H of a light as fields that are quadratic over the triangle. `nodes` are the three corners and then the midpoints of the edges 0-1,
    /// 1-2 and 2-0. `map` is applied to each pair of cosines first, for example to take square roots.
    pub fn six_products(&self, nodes: &[Node; 6], source: &Source, map: impl Fn([i32; 2]) -> [i32; 2]) -> QuadraticNodes<2> {
        let values = nodes.map(|node| map(self.lighting.directions(source, node.position).map(|direction| cosine(node.normal, direction))));
        quadratic([values.map(|[light, _]| light), values.map(|[_, half]| half)])
    }
}
