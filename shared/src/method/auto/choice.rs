//! The choice of the cheapest way to draw a triangle within an error budget, by the bounds of [`crate::method::ErrorBounds`].

use super::{
    costs::SAVINGS,
    near,
    way::{Choice, is_clamped, linear_raise},
};
use crate::{
    features::PERSPECTIVE,
    format::FULL,
    geometry::projection::ScreenVertex,
    lighting::{
        albedo::{Albedo, Parts, SHARE},
        lights::vertex_cosine,
        summed::Sides,
    },
    math::vector::wide,
    method::{
        CornerCosines, Shading, TriangleSetup,
        auto::error_bound::{Curvature, Interval, LinearBound, MOST_LIGHT, of_product},
        largest, largest_range,
        levels::gouraud,
    },
    setup::edge::COLUMNS,
    stream::record::Vertex,
};

/// Chooses how to draw a triangle.
pub fn choose<const QUADRATICS: bool>(setup: &TriangleSetup<'_>, shading: &Shading<'_>) -> Choice {
    choose_lit::<QUADRATICS>(setup, shading, uniform_parts(setup, shading).as_ref())
}

/// Chooses how to draw a triangle whose [`uniform_parts`] are known.
#[inline]
pub(super) fn choose_lit<const QUADRATICS: bool>(setup: &TriangleSetup<'_>, shading: &Shading<'_>, uniform: Option<&Parts>) -> Choice {
    // Decision: choice of auto.
    // In functions of their own: together they would need more registers than there are.
    if shading.vertices_have_cosines() {
        under_one_light::<QUADRATICS>(setup, shading)
    } else if !shading.lighting.is_constant() {
        near::choose(setup, shading).unwrap_or(Choice::Phong)
    } else if shading.reflectance.has_two_lights() {
        under_two_lights::<QUADRATICS>(setup, shading)
    } else if shading.reflectance.sums_lights() {
        let choice = match uniform {
            Some(parts) => uniformly_lit(setup, parts, shading.budget),
            None => under_summed_lights(setup, shading),
        };
        choice.unwrap_or(Choice::Phong)
    } else {
        Choice::Phong
    }
}

#[inline(never)]
fn under_one_light<const QUADRATICS: bool>(setup: &TriangleSetup<'_>, shading: &Shading<'_>) -> Choice {
    let Some(curvature) = Curvature::of(setup.triangle) else { return Choice::Phong };
    let cosines = setup.corner_lights();
    let linear = shading.error_bounds.linear(shading.budget, curvature, [cosines]);
    let choice = linear.and_then(|linear| one_light(setup, shading, &cosines, linear));
    choice.unwrap_or_else(|| curved::<QUADRATICS>(setup, shading, curvature))
}

#[inline(never)]
fn under_two_lights<const QUADRATICS: bool>(setup: &TriangleSetup<'_>, shading: &Shading<'_>) -> Choice {
    let Some(curvature) = Curvature::of(setup.triangle) else { return Choice::Phong };
    let cosines = setup.corners_of_two_lights();
    let linear = shading.error_bounds.linear(shading.budget, curvature, cosines);
    let choice = linear.and_then(|linear| two_lights(setup, shading, &cosines, linear));
    choice.unwrap_or_else(|| curved::<QUADRATICS>(setup, shading, curvature))
}

/// The cheapest way to draw a triangle that linear interpolation does not keep within the budget.
#[inline(never)]
fn curved<const QUADRATICS: bool>(setup: &TriangleSetup<'_>, shading: &Shading<'_>, curvature: Curvature) -> Choice {
    let two_lights = !shading.vertices_have_cosines();
    // Of these methods Phong shading alone is exact in perspective, and has loops for textures.
    if PERSPECTIVE && setup.inv_depth().is_some() || setup.has_texture() {
        return Choice::Phong;
    }
    let style = if two_lights { 2 } else { usize::from(shading.reflectance.three_channels()) };
    let Some([quadratic, cosines]) = SAVINGS.get(style).filter(|_| QUADRATICS) else { return Choice::Phong };
    let extent = extent(setup);
    let (quadratic, cosines) = (quadratic.of(extent), cosines.of(extent));
    if quadratic.max(cosines) <= 0 {
        return Choice::Phong;
    }
    let both = setup.corners_of_two_lights();
    let [one, _] = &both;
    let corners = if two_lights { both.as_slice() } else { core::slice::from_ref(one) };
    let keeps_quadratic = || is_quadratic(setup, shading, curvature, corners);
    match () {
        () if quadratic >= cosines && keeps_quadratic() => Choice::Quadratic,
        () if cosines > 0
            && setup.albedos().is_none()
            && shading.error_bounds.cosines(setup.triangle, curvature, corners) <= shading.budget =>
        {
            Choice::Cosines
        }
        () if (1..cosines).contains(&quadratic) && keeps_quadratic() => Choice::Quadratic,
        () => Choice::Phong,
    }
}

/// Whether the quadratic is within the budget.
#[inline(never)]
fn is_quadratic(setup: &TriangleSetup<'_>, shading: &Shading<'_>, curvature: Curvature, cosines: &[CornerCosines]) -> bool {
    let Shading { error_bounds: bounds, budget, reflectance, .. } = *shading;
    let of_colours = setup.albedos().map_or(0, |albedos| bounds.of_cubic(Albedo::range(albedos), curvature, cosines));
    bounds.quadratic(setup.triangle, curvature, cosines) + of_colours <= budget
        && !(bounds.may_saturate() && bounds.saturates(curvature, cosines, reflectance))
}

/// Approximate numbers of rows and pixels that the triangle covers.
#[inline]
fn extent(setup: &TriangleSetup<'_>) -> [i32; 2] {
    let [a, b, c] = setup.corners;
    // A coarse grid, so that words hold the area.
    let (x1, y1, x2, y2) = ((b.x - a.x) >> 2, (b.y - a.y) >> 2, (c.x - a.x) >> 2, (c.y - a.y) >> 2);
    let pixels = x1.wrapping_mul(y2).wrapping_sub(x2.wrapping_mul(y1)).unsigned_abs() >> 5;
    // Corners may lie far outside of the picture.
    [(y1.max(y2) >> 2).min(COLUMNS as i32), pixels.min(COLUMNS * COLUMNS) as i32]
}

/// The smallest and the largest of three values.
#[inline]
pub(super) fn extremes([a, b, c]: [i32; 3]) -> [i32; 2] {
    [a.min(b).min(c), a.max(b).max(c)]
}

/// Largest difference of a cosine between the corners, where negative cosines count as 0.
#[inline]
fn lit_range(cosines: &[i32; 3]) -> i32 {
    let [dark, bright] = extremes(*cosines);
    bright.max(0) - dark.max(0)
}

/// Whether the light of all vertices is the same.
#[inline]
pub(super) fn is_uniform(setup: &TriangleSetup<'_>) -> bool {
    let [a, b, c] = setup.corners.map(|corner| corner.light);
    // Number by number: whole arrays are compared by a call.
    let same = |[p, q, r, s]: [i32; 4], other: [i32; 4]| p == other[0] && q == other[1] && r == other[2] && s == other[3];
    same(a, b) && same(a, c)
}

/// One colour or linear interpolation under one constant light, where linear interpolation has these bounds; `None` if levels of the corners may have
/// been clamped at 255.
#[inline(always)]
fn one_light(setup: &TriangleSetup<'_>, shading: &Shading<'_>, [towards, _]: &CornerCosines, bounds: LinearBound) -> Option<Choice> {
    let ([a, b, c], LinearBound { mut interval, brightest, has_highlight }) = (setup.corners, bounds);
    let Shading { error_bounds: limits, budget, reflectance, .. } = *shading;
    let three = reflectance.three_channels();
    // The levels in one channel, the highlights in three.
    let reflected = || extremes([a.light[2], b.light[2], c.light[2]]);
    if brightest as i32 >= FULL {
        let is_clamped = if setup.albedos().is_some() {
            // Colours darken what the material alone would reflect.
            brightest > MOST_LIGHT || is_clamped(&gouraud::reflected(setup, &reflectance))
        } else {
            let [_, most] = reflected();
            let most = if three { limits.brightest(largest(towards).max(0), most) } else { most };
            most >= FULL
        };
        if is_clamped {
            return None;
        }
    }
    let mut diffuse = limits.diffuse_level(0, lit_range(towards));
    if setup.has_texture() {
        // Dark texels leave little of a raise, which may be for a highlight.
        interval = interval.centred();
        if interval.half() > budget {
            return None;
        }
    }
    if let Some(albedos) = setup.albedos() {
        let range = Albedo::range(albedos);
        interval = interval.widened(of_product(range, diffuse));
        if interval.half() > budget {
            return None;
        }
        // The range of the product.
        diffuse += ((range * brightest) >> SHARE) + 1;
    }
    let range = || {
        let [least, most] = reflected();
        match (has_highlight, three) {
            (false, _) => diffuse,
            (true, false) => (most - least) as u32,
            (true, true) => diffuse + limits.highlight_level(most - least),
        }
    };
    if interval.half() + (diffuse >> 1) < budget && interval.half() + (range() >> 1) < budget {
        return Some(Choice::Solid(interval.middle()));
    }
    let raise = linear_raise(setup, interval, budget, range)?;
    // Without a highlight at the corners a table of colours is interpolated, which raises each channel by its share of diffuse light: too
    // little for a highlight that is nowhere but in between.
    let is_hidden = raise > 0 && has_highlight && three && a.light[2] | b.light[2] | c.light[2] == 0;
    (!is_hidden).then_some(Choice::Linear(raise))
}

/// One colour or linear interpolation under two constant lights. Where there is a highlight, one colour is chosen only if light is the same at all corners.
#[inline(always)]
fn two_lights(
    setup: &TriangleSetup<'_>,
    shading: &Shading<'_>,
    [[towards, _], [other, _]]: &[CornerCosines; 2],
    bounds: LinearBound,
) -> Option<Choice> {
    let LinearBound { interval, brightest, has_highlight } = bounds;
    let Shading { error_bounds: limits, budget, .. } = *shading;
    if brightest as i32 >= FULL && is_clamped(&corner_levels(setup, shading, None)) {
        return None;
    }
    if has_highlight {
        if is_uniform(setup) && interval.half() < budget {
            return Some(Choice::Solid(interval.middle()));
        }
    } else {
        let range = limits.diffuse_level(0, lit_range(towards)) + limits.diffuse_level(1, lit_range(other));
        if interval.half() + (range >> 1) < budget {
            return Some(Choice::Solid(interval.middle()));
        }
    }
    let range = || largest_range(corner_levels(setup, shading, None));
    linear_raise(setup, interval, budget, range).map(Choice::Linear)
}

/// One colour or linear interpolation where the light of several lights is summed; `None` if one of them ends on the triangle, so that there are no
/// bounds, or if levels of the corners may have been clamped at 255.
#[inline(never)]
fn under_summed_lights(setup: &TriangleSetup<'_>, shading: &Shading<'_>) -> Option<Choice> {
    let Shading { reflectance, lighting, error_bounds, budget, .. } = *shading;
    let curvature = Curvature::of(setup.triangle)?;
    let [a, b, c] = setup.corners.map(|corner| corner.light);
    let sides = Sides::of_triangle([a[3], b[3], c[3]], setup.triangle.min_normal_length);
    if setup.has_texture() || !sides.are_whole(lighting.sources().len()) {
        return None;
    }
    let [red, green, blue] = [extremes([a[0], b[0], c[0]]), extremes([a[1], b[1], c[1]]), extremes([a[2], b[2], c[2]])];
    let sums = [red[0].min(green[0]).min(blue[0]), red[1].max(green[1]).max(blue[1])].map(|sum| reflectance.summed_level(sum));
    // Bounds of brighter light would not fit a word.
    if sums[1].max(sums[0].wrapping_neg()) > 4 * FULL {
        return None;
    }
    let mut interval = Interval::of_sum(curvature, sums);
    let diffuse = reflectance.summed_level((red[1] - red[0]).max(green[1] - green[0]).max(blue[1] - blue[0])) as u32 + 1;
    if let Some(albedos) = setup.albedos() {
        if diffuse > MOST_LIGHT {
            return None;
        }
        interval = interval.widened(of_product(Albedo::range(albedos), diffuse));
    }
    if interval.half() > budget {
        return None;
    }
    let (mut bounds, mut varies) = (LinearBound { interval, brightest: sums[1].max(0) as u32, has_highlight: false }, false);
    for (light, source) in lighting.sources().iter().enumerate() {
        if let Some([_, half]) = source.directional()
            && !source.is_sky()
            && sides.may_have_highlight(light)
        {
            let half = setup.corner_cosines(*half);
            let [at_a, at_b, at_c] = half;
            // Asked here, too, so that the choice is the same if nothing is left out.
            if largest(&half) >= setup.highlight_threshold(&reflectance) {
                let [_, specular] = reflectance.largest_gains(light);
                error_bounds.add_linear_highlight(curvature, &half, specular, &mut bounds);
                varies |= at_a != at_b || at_a != at_c;
            }
        }
    }
    let LinearBound { interval, brightest, has_highlight } = bounds;
    if interval.half() > budget {
        return None;
    }
    let brightest = brightest + reflectance.summed_level(largest(&reflectance.pure_ambient())) as u32 + 1;
    if brightest as i32 >= FULL && (is_clamped(&corner_levels(setup, shading, None)) || setup.albedos().is_some() && brightest > MOST_LIGHT)
    {
        return None;
    }
    let range = || match has_highlight && varies {
        true => largest_range(corner_levels(setup, shading, None)),
        false => diffuse + setup.albedos().map_or(0, |albedos| ((Albedo::range(albedos) * brightest) >> SHARE) + 1),
    };
    if interval.half() + (diffuse >> 1) < budget && interval.half() + (range() >> 1) < budget {
        return Some(Choice::Solid(interval.middle()));
    }
    linear_raise(setup, interval, budget, range).map(Choice::Linear)
}

/// One colour or linear interpolation where these parts of light are the same all over the triangle, so that its colours alone make a difference.
#[inline(never)]
fn uniformly_lit(setup: &TriangleSetup<'_>, &parts: &Parts, budget: u32) -> Option<Choice> {
    let Some(&[a, b, c]) = setup.albedos().filter(|albedos| Albedo::range(albedos) > 0) else { return Some(Choice::Solid(0)) };
    let levels = [a.lit(parts), b.lit(parts), c.lit(parts)];
    let range = largest_range(levels);
    match () {
        () if is_clamped(&levels) => None,
        () if (range >> 1) < budget => Some(Choice::Solid(0)),
        () => (setup.plane_error(range) <= budget).then_some(Choice::Linear(0)),
    }
}

/// The levels at the corners under near lights, under two constant lights, or where the diffuse light of several is summed. If light is `uniform`, it has these parts.
#[inline(never)]
pub(super) fn corner_levels(setup: &TriangleSetup<'_>, shading: &Shading<'_>, uniform: Option<&Parts>) -> [[i32; 3]; 3] {
    let ([a, b, c], reflectance) = (setup.corners, shading.reflectance);
    if !shading.lighting.is_constant() {
        return setup.levels();
    }
    if reflectance.sums_lights() {
        return summed_levels(setup, shading, uniform);
    }
    [reflectance.two_lights(a.light), reflectance.two_lights(b.light), reflectance.two_lights(c.light)]
}

/// [`corner_levels`] where the diffuse light of several lights is summed.
// A call, so that two lights do not pay for its memory.
#[inline(never)]
fn summed_levels(setup: &TriangleSetup<'_>, shading: &Shading<'_>, uniform: Option<&Parts>) -> [[i32; 3]; 3] {
    let ([a, b, c], reflectance) = (setup.corners, shading.reflectance);
    let [r, g, b] = match uniform {
        Some(&parts) => [parts; 3],
        None => {
            let ([x, y, z], ambient) = (setup.vertices(), reflectance.pure_ambient());
            [summed_parts(shading, a, x, ambient), summed_parts(shading, b, y, ambient), summed_parts(shading, c, z, ambient)]
        }
    };
    let &[x, y, z] = setup.albedos().unwrap_or(&[Albedo::WHITE; 3]);
    [x.lit(r), y.lit(g), z.lit(b)]
}

/// The parts of light where the light of several constant lights is summed, if they are the same all over the triangle and it has no texture.
#[inline]
pub(super) fn uniform_parts(setup: &TriangleSetup<'_>, shading: &Shading<'_>) -> Option<Parts> {
    // For a near viewer highlights differ where normals are the same.
    let is_summed = shading.reflectance.sums_lights() && shading.lighting.is_constant();
    if is_summed && !setup.has_texture() { uniform_sums(setup, shading) } else { None }
}

/// [`uniform_parts`] where light is summed.
#[inline(never)]
fn uniform_sums(setup: &TriangleSetup<'_>, shading: &Shading<'_>) -> Option<Parts> {
    let ([a, ..], [x, y, z]) = (setup.corners, setup.vertices());
    let same_normal = |[x, y, z]: [i16; 3], other: [i16; 3]| (x ^ other[0]) | (y ^ other[1]) | (z ^ other[2]) == 0;
    let is_uniform = is_uniform(setup) && same_normal(x.normal, y.normal) && same_normal(x.normal, z.normal);
    is_uniform.then(|| summed_parts(shading, a, x, shading.reflectance.pure_ambient()))
}

/// The parts of light at a vertex where the diffuse light of several lights is summed, and ambient light is this.
#[inline(never)]
fn summed_parts(shading: &Shading<'_>, screen: &ScreenVertex, vertex: &Vertex, [red, green, blue]: [i32; 3]) -> Parts {
    let (Shading { reflectance, lighting, .. }, [r, g, b, sides]) = (shading, screen.light);
    let level = |ambient: i32, sum: i32| reflectance.summed_level(ambient.wrapping_add(sum));
    let mut parts = Parts { diffuse: [level(red, r), level(green, g), level(blue, b)], specular: [0; 3] };
    let sides = Sides::of_vertex(sides);
    for (light, source) in lighting.sources().iter().enumerate() {
        if let Some([_, half]) = source.directional()
            && sides.may_have_highlight(light)
        {
            reflectance.add_highlight(&mut parts, light, vertex_cosine(wide(vertex.normal), *half));
        }
    }
    parts
}
