//! Scenes that change between frames: objects with poses, materials, lights, camera, and the tracks of scripted scenes.

use embedded_graphics::{
    pixelcolor::{Rgb565, Rgb888},
    prelude::*,
    primitives::Rectangle,
};
use microphong::{
    Layout, Object, Pose, Renderer, Scene, SceneError, Shader, Stream,
    fixed::types::{I2F30, I18F14, U0F32, U16F16},
    format::MAX_LIGHTS,
    pixel::Pixel,
    scene::{Background, MAX_POSITION},
    stream::record::{Camera, EYE_SPACE, Light, Material, ORTHOGRAPHIC, POINT, VIEWER_LOCAL},
};
use microphong_sim::{
    bytes::StreamBytes,
    look::{Lamp, Look, Surface},
    mesh::Mesh,
    quantise::quantise,
    render,
    scene::{self, SCRIPTED},
    script, shapes,
    vector::{V3, add, rotation, scale, unit},
    view::{Projection, View},
};
use std::collections::BTreeSet;

const SIZE: Size = Size::new(120, 90);

/// A camera at (0, 0, 4) that looks at the origin.
fn view(projection: Projection) -> View {
    View {
        rotation: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]],
        translation: [0.0, 0.0, 4.0],
        axis: [0.0, 1.0, 0.0],
        period: 0,
        projection,
        focal: if projection == Projection::Perspective { 2.0 } else { 0.5 },
        near: 1.5,
        far: 7.0,
    }
}

/// Three meshes, each with a material of its own.
fn look(lamps: Vec<Lamp>, local_viewer: bool, projection: Projection) -> Look {
    let colours = [[0.9, 0.3, 0.2], [0.3, 0.8, 0.4], [0.4, 0.5, 0.95]];
    let surfaces: Vec<_> = colours.into_iter().map(|colour| Surface::plastic(colour, [0.1, 0.7, 0.3], 20)).collect();
    Look {
        surfaces,
        lamps,
        local_viewer,
        shader: microphong_sim::shader::Shader::PHONG,
        ..Look::new(Surface::metal([1.0; 3], [0.1, 0.5, 0.4], 20), view(projection))
    }
}

fn meshes() -> [Mesh; 3] {
    [shapes::sphere(20, 14, 0.0), shapes::torus(28, 12), shapes::cuboid()].map(|mesh| shapes::stretched(mesh, [0.5; 3]))
}

fn stream(look: &Look, meshes: &[Mesh]) -> StreamBytes {
    let parts = meshes.iter().enumerate().flat_map(|(material, mesh)| {
        let mut parts = quantise(mesh).0;
        parts.iter_mut().for_each(|part| (part.material, part.closed_convex) = (material as u16, false));
        parts
    });
    look.stream(&parts.collect::<Vec<_>>()).expect("a stream")
}

/// Draws what `change` makes of the scene of a stream, in bands of `rows` rows.
fn drawn(stream: Stream<'_>, layout: Layout, change: impl FnOnce(&mut Scene<'_>)) -> Vec<Rgb888> {
    drawn_by(Shader::PHONG, stream, layout, change)
}

fn drawn_by(shader: Shader<Rgb888>, stream: Stream<'_>, layout: Layout, change: impl FnOnce(&mut Scene<'_>)) -> Vec<Rgb888> {
    let mut memory = vec![0xA5A5_A5A5_A5A5_A5A5; layout.words::<Rgb888>()];
    let mut renderer = Renderer::with_shader(stream, SIZE, &layout, &mut memory, shader).expect("a renderer");
    change(renderer.scene());
    pixels(&mut renderer)
}

fn pixels<C: Pixel + RgbColor>(renderer: &mut Renderer<'_, C>) -> Vec<C> {
    let mut band = vec![C::BLACK; (SIZE.width * SIZE.height) as usize];
    let (mut frame, mut pixels) = (renderer.draw(), Vec::new());
    while let Some(area) = frame.next_band(&mut band).expect("a row") {
        pixels.extend_from_slice(&band[..(area.size.width * area.size.height) as usize]);
    }
    pixels
}

fn room(stream: &Stream<'_>) -> Layout {
    // Memory for more objects and materials than there are makes no difference.
    let layout = Layout::new(SIZE.width as usize, SIZE.height as usize).with_room_for(stream);
    layout.objects(7).vertices(3 * layout.vertices).triangles(3 * layout.triangles).materials(layout.materials + 2)
}

/// A place and a rotation in floating point.
#[derive(Clone, Copy)]
struct Placed {
    axis: V3,
    degrees: f64,
    at: V3,
    scale: f64,
}

impl Placed {
    fn pose(&self) -> Pose {
        let length = self.axis.iter().map(|c| c * c).sum::<f64>().sqrt();
        let axis = self.axis.map(|c| I2F30::from_num(c / length).to_bits());
        let pose = Pose::about(axis, U0F32::wrapping_from_num(self.degrees / 360.0)).expect("an axis");
        pose.at(self.at.map(I18F14::from_num)).expect("a place").scaled(U16F16::from_num(self.scale)).expect("a scale")
    }

    /// The mesh as it lies in the world.
    fn bake(&self, mesh: &Mesh) -> Mesh {
        let rows = rotation(unit(self.axis).expect("an axis"), self.degrees.to_radians());
        let mut mesh = shapes::turned(mesh.clone(), &rows);
        mesh.positions.iter_mut().for_each(|p| *p = add(scale(*p, self.scale), self.at));
        mesh
    }
}

const CASTS: [[Placed; 3]; 4] = [
    [
        Placed { axis: [0.3, 1.0, 0.2], degrees: 40.0, at: [-0.9, 0.2, 0.1], scale: 1.0 },
        Placed { axis: [1.0, 0.2, -0.5], degrees: 115.0, at: [0.7, -0.3, 0.4], scale: 1.3 },
        Placed { axis: [0.1, -0.7, 0.6], degrees: 200.0, at: [0.1, 0.4, -0.6], scale: 0.6 },
    ],
    // Small and large.
    [
        Placed { axis: [1.0, 0.0, 0.0], degrees: 20.0, at: [0.0, 0.0, 0.9], scale: 0.25 },
        Placed { axis: [0.0, 1.0, 1.0], degrees: 70.0, at: [0.0, 0.1, -0.4], scale: 2.4 },
        Placed { axis: [1.0, 1.0, 0.0], degrees: 310.0, at: [0.5, 0.5, 0.7], scale: 0.0625 },
    ],
    // Partly and wholly out of sight.
    [
        Placed { axis: [0.0, 0.0, 1.0], degrees: 45.0, at: [1.6, 0.0, 0.2], scale: 0.7 },
        Placed { axis: [0.0, 1.0, 0.0], degrees: 90.0, at: [-1.7, 0.9, 0.0], scale: 0.4 },
        Placed { axis: [1.0, 2.0, 3.0], degrees: 10.0, at: [0.0, -1.3, 0.0], scale: 1.0 },
    ],
    // In one another, and before the near plane.
    [
        Placed { axis: [0.0, 1.0, 0.0], degrees: 0.0, at: [0.0, 0.0, 0.0], scale: 1.0 },
        Placed { axis: [1.0, 0.0, 0.0], degrees: 90.0, at: [0.0, 0.1, 0.1], scale: 1.4 },
        Placed { axis: [0.5, 0.3, 0.0], degrees: 30.0, at: [0.2, 0.0, 1.6], scale: 0.5 },
    ],
];

/// Objects with poses are drawn as meshes that lie so: by lights and a viewer that are far or near.
#[test]
fn posed_objects_are_drawn_as_meshes_that_lie_so() {
    let far = vec![Lamp::fixed([-0.4, 0.6, 0.7], [1.0; 3])];
    let two = vec![Lamp::distant([-0.4, 0.6, -0.7], [1.0, 0.9, 0.8]), Lamp::fixed([0.8, 0.1, 0.5], [0.2, 0.3, 0.5])];
    let near = vec![Lamp::fixed_near([-1.0, 1.2, 2.0], [1.0; 3]), Lamp::near([0.8, 0.9, 2.5], [0.3, 0.2, 0.2])];
    let looks = [
        look(far.clone(), false, Projection::Perspective),
        look(two, false, Projection::Perspective),
        look(near, true, Projection::Perspective),
        look(far, false, Projection::Orthographic),
    ];
    for (i, look) in looks.iter().enumerate() {
        for (k, cast) in CASTS.iter().enumerate() {
            let meshes = meshes();
            let (bytes, baked) = (stream(look, &meshes), stream(look, &[0, 1, 2].map(|m| cast[m].bake(&meshes[m]))));
            let (posed, baked) = (bytes.parse().unwrap(), baked.parse().unwrap());
            let posed = drawn(posed, room(&posed), |scene| {
                scene.clear();
                for (mesh, placed) in (0..).zip(cast) {
                    scene.add(mesh..mesh + 1, placed.pose()).expect("room");
                }
            });
            let baked = drawn(baked, room(&baked), |_| ());
            let differences: Vec<_> = posed
                .iter()
                .zip(&baked)
                .map(|(a, b)| a.r().abs_diff(b.r()).max(a.g().abs_diff(b.g())).max(a.b().abs_diff(b.b())))
                .collect();
            // Outlines are rounded otherwise, and so is light where normals of 14 bits have been rotated.
            let outlines = differences.iter().filter(|&&difference| difference > 6).count();
            let covered = baked.iter().filter(|&&pixel| pixel != baked[0]).count();
            assert!(covered > 200 && outlines < covered / 60 + 4, "{i} {k}: {outlines} of {covered} pixels differ");
        }
    }
}

/// Meshes that are objects of their own, where they are, are the whole stream, bit for bit.
#[test]
fn objects_at_rest_are_the_stream() {
    let look = look(vec![Lamp::distant([-0.4, 0.6, -0.7], [1.0; 3])], false, Projection::Perspective);
    let bytes = stream(&look, &meshes());
    let stream = bytes.parse().unwrap();
    let whole = drawn(stream, room(&stream), |_| ());
    for first in 0..3 {
        let split = drawn(stream, room(&stream), |scene| {
            scene.clear();
            for meshes in [0..first, first..3].into_iter().filter(|meshes| !meshes.is_empty()) {
                scene.add(meshes, Pose::IDENTITY).expect("room");
            }
        });
        assert!(split == whole, "divided before mesh {first}");
    }
    // Turned there and back, hidden and shown again.
    let back = drawn(stream, room(&stream), |scene| {
        scene.set_visible(0, false).unwrap();
        scene.set_pose(0, Pose::about([0, 1, 0], U0F32::from_num(0.3)).unwrap()).unwrap();
        scene.set_pose(0, Pose::IDENTITY).unwrap();
        scene.set_visible(0, true).unwrap();
    });
    assert!(back == whole);
    let hidden = drawn(stream, room(&stream), |scene| scene.set_visible(0, false).unwrap());
    assert_eq!(hidden.iter().map(|pixel| [pixel.r(), pixel.g(), pixel.b()]).collect::<BTreeSet<_>>().len(), 1);
}

/// The picture of a scripted scene depends neither on the height of bands nor on how much there is room for, nor on who prepares it.
#[test]
fn scripted_scenes_are_the_same_in_bands() {
    for name in SCRIPTED {
        let scene = scene::load(name).unwrap();
        let stream = scene.stream.parse().unwrap();
        let full = Layout::new(SIZE.width as usize, 16).with_room_for(&stream);
        let full = full.active_triangles(full.triangles).processors(2);
        let cramped = full.vertices(full.vertices / 3).triangles(20).active_triangles(5);
        for layout in [full, cramped] {
            // One renderer for all frames, which places what has moved alone.
            let mut memory = vec![0; layout.words::<Rgb888>()];
            let mut renderer = Renderer::with_shader(stream, SIZE, &layout, &mut memory, Shader::PHONG).unwrap();
            // A frame of one processor before those of two, too.
            let _ = renderer.frame(3);
            for (number, share) in [(0, 0), (17, 20_000), (18, 50_000), (40, 50_000), (40, 0)] {
                let whole = render::frame::<Rgb888>(stream, SIZE, microphong_sim::shader::Shader::PHONG, SIZE.height, number).unwrap().0;
                let mut band = vec![Rgb888::BLACK; layout.band()];
                let (mut frame, mut pixels) = (renderer.prepare(number, share).frame(), Vec::new());
                while let Some(area) = frame.next_band(&mut band).unwrap() {
                    pixels.extend_from_slice(&band[..(area.size.width * area.size.height) as usize]);
                }
                assert!(pixels == whole, "{name}, frame {number}, share {share}");
            }
        }
    }
}

/// Drawing the changed areas of a frame over the frame before gives the whole frame, and saves pixels, also between areas that lie above one another.
#[test]
fn changed_areas_are_all_that_changes() {
    let (mut saved, mut between) = (0, 0);
    for name in SCRIPTED {
        let scene = scene::load(name).unwrap();
        let stream = scene.stream.parse().unwrap();
        let layout = Layout::new(SIZE.width as usize, 13).with_room_for(&stream).active_triangles(40);
        // With room for all vertices or for few, for all triangles or for few; levels of vertices are computed late.
        for (shader, processors, vertices, triangles) in [
            (Shader::PHONG, 1, layout.vertices, layout.triangles),
            (Shader::PHONG, 2, layout.vertices, layout.triangles),
            (Shader::GOURAUD, 1, layout.vertices / 3, layout.triangles),
            (Shader::GOURAUD, 1, layout.vertices, 100),
            (Shader::GOURAUD, 2, layout.vertices, layout.triangles),
        ] {
            let layout = layout.processors(processors).vertices(vertices).triangles(triangles);
            let mut memory = vec![0; layout.words::<Rgb888>()];
            let mut renderer = Renderer::with_shader(stream, SIZE, &layout, &mut memory, shader).unwrap();
            renderer.set_partial_redraw(true);
            let mut shown = vec![Rgb888::BLACK; (SIZE.width * SIZE.height) as usize];
            for number in (0..70).step_by(3) {
                if number == 33 {
                    // What is not a place of an object changes all of the picture.
                    renderer.scene().set_background([9, 40, 70]);
                }
                let mut band = vec![Rgb888::BLACK; layout.band()];
                let frame = if processors == 1 { renderer.frame(number) } else { renderer.prepare(number, 20_000).frame() };
                let area = frame.area();
                saved += SIZE.width * SIZE.height - area.size.width * area.size.height;
                let mut sent = 0;
                let mut frame = frame.in_two(area.top_left.y as u32 + area.size.height / 3);
                for mut part in frame.parts() {
                    while let Some(area) = part.next_band(&mut band).unwrap() {
                        for (point, pixel) in area.points().zip(&band) {
                            shown[point.y as usize * SIZE.width as usize + point.x as usize] = *pixel;
                        }
                        sent += area.size.width * area.size.height;
                    }
                }
                let all = area.size.width * area.size.height;
                assert!(sent <= all, "{name}, frame {number}");
                between += all - sent;
                let whole = drawn_by(shader, stream, room(&stream).objects(12), |scene| {
                    scene.play(number);
                    if number >= 33 {
                        scene.set_background([9, 40, 70]);
                    }
                });
                assert!(shown == whole, "{name}, frame {number}");
            }
        }
    }
    println!("{saved} pixels, and {between} between areas");
    assert!(saved > 1_250_000 && between > 100_000, "{saved} pixels, and {between} between areas");
}

/// If nothing moves, a frame draws only what is invalidated, and the next one nothing.
#[test]
fn invalidated_areas_are_drawn_once_more() {
    let bytes = stream(&look(vec![Lamp::distant([-0.4, 0.6, -0.7], [1.0; 3])], false, Projection::Perspective), &meshes());
    let stream = bytes.parse().unwrap();
    let layout = room(&stream);
    let mut memory = vec![0; layout.words::<Rgb888>()];
    let mut renderer: Renderer<'_, Rgb888> = Renderer::with_shader(stream, SIZE, &layout, &mut memory, Shader::PHONG).unwrap();
    renderer.set_partial_redraw(true);
    let whole = Rectangle::new(Point::zero(), SIZE);
    assert_eq!(renderer.draw().area(), whole);
    assert!(renderer.is_latest(0) && renderer.draw().area().is_zero_sized());
    let area = |left, top, width, height| Rectangle::new(Point::new(left, top), Size::new(width, height));
    for (asked, drawn) in [
        (area(10, 20, 30, 5), area(10, 20, 30, 5)),
        (area(-10, -10, 20, 20), area(0, 0, 10, 10)),
        (area(100, 85, u32::MAX, u32::MAX), area(100, 85, 20, 5)),
        (area(i32::MIN, i32::MIN, u32::MAX, u32::MAX), whole),
    ] {
        renderer.invalidate(asked);
        assert!(!renderer.is_latest(0));
        assert_eq!(renderer.draw().area(), drawn, "{asked:?}");
        assert!(renderer.is_latest(0) && renderer.draw().area().is_zero_sized(), "{asked:?}");
    }
    for nothing in [area(-10, 5, 10, 10), area(SIZE.width as i32, 0, 5, 5), area(5, 5, 0, 9)] {
        renderer.invalidate(nothing);
        assert!(renderer.is_latest(0), "{nothing:?}");
    }
    renderer.invalidate(area(3, 4, 5, 6));
    renderer.invalidate(area(50, 70, 8, 9));
    assert_eq!(renderer.draw().area(), area(3, 4, 55, 75));
}

/// Changes by a program are drawn as if the stream had them.
#[test]
fn changes_are_drawn_as_if_the_stream_had_them() {
    let first = look(vec![Lamp::fixed([-0.4, 0.6, 0.7], [1.0; 3])], false, Projection::Perspective);
    let mut second = look(
        vec![Lamp::distant([0.4, 0.6, -0.7], [0.5, 0.8, 1.0]), Lamp::fixed_near([1.0, 1.0, 2.0], [0.6; 3])],
        true,
        Projection::Perspective,
    );
    second.ambient = [0.5, 0.7, 0.9];
    let background = Background::Gradient { top: [10, 200, 60], bottom: [250, 0, 61] };
    second.background = background;
    second.surfaces.swap(0, 2);
    second.view.translation = [0.3, -0.2, 3.5];
    let (first, second) = (stream(&first, &meshes()), stream(&second, &meshes()));
    let (from, to) = (first.parse().unwrap(), second.parse().unwrap());
    let layout = room(&from);
    let mut memory = vec![0; layout.words::<Rgb888>()];
    let mut renderer = Renderer::<Rgb888>::with_shader(from, SIZE, &layout, &mut memory, Shader::PHONG).unwrap();
    let before = pixels(&mut renderer);
    let scene = renderer.scene();
    scene.set_lights(to.lights).unwrap();
    scene.set_ambient(to.header.ambient()).unwrap();
    scene.set_background(background);
    assert_eq!(scene.background(), background);
    scene.set_camera(to.header.camera).unwrap();
    for (index, material) in to.materials.iter().enumerate() {
        scene.set_material(index, *material).unwrap();
    }
    assert!(!scene.is_unchanged());
    let after = pixels(&mut renderer);
    assert!(renderer.scene().is_unchanged() && renderer.is_latest(0));
    assert!(before != after && after == drawn(to, room(&to), |_| ()));
    // One material for all of an object, and back.
    let scene = renderer.scene();
    scene.set_object_material(0, Some(1)).unwrap();
    let one = pixels(&mut renderer);
    renderer.scene().set_object_material(0, None).unwrap();
    assert!(one != after && pixels(&mut renderer) == after);
}

/// Lights that become near ones or distant ones, in their old colours, are drawn as if they had always been: distant lights are summed, and near ones
/// are not.
#[test]
fn lights_may_become_of_another_kind() {
    let of = |second: Lamp| {
        let mut look = look(vec![Lamp::fixed([-0.4, 0.6, 0.7], [0.6; 3]), second], false, Projection::Perspective);
        // Of one hue, which has one channel where lights are not summed.
        look.surfaces = vec![Surface::metal([0.9, 0.5, 0.3], [0.1, 0.5, 0.4], 30); look.surfaces.len()];
        stream(&look, &meshes())
    };
    let [distant, near] = [Lamp::fixed([0.9, 0.1, 0.4], [0.6; 3]), Lamp::fixed_near([1.5, 1.0, 2.0], [0.6; 3])].map(of);
    for (from, to) in [(&distant, &near), (&near, &distant)] {
        let (from, to) = (from.parse().unwrap(), to.parse().unwrap());
        let layout = room(&from);
        let mut memory = [(); 2].map(|()| vec![0; layout.words::<Rgb565>()]);
        let [one, other] = &mut memory;
        let mut changed = Renderer::with_shader(from, SIZE, &layout, one, Shader::<Rgb565>::PHONG).unwrap();
        let mut new = Renderer::with_shader(to, SIZE, &layout, other, Shader::<Rgb565>::PHONG).unwrap();
        let before = pixels(&mut changed);
        changed.scene().set_lights(to.lights).unwrap();
        let after = pixels(&mut changed);
        assert!(before != after && after == pixels(&mut new));
    }
}

/// A camera that is moved sees what one at that place in the stream sees.
#[test]
fn the_camera_looks_where_it_is_told() {
    let look = look(vec![Lamp::fixed([-0.4, 0.6, 0.7], [1.0; 3])], false, Projection::Perspective);
    let bytes = stream(&look, &meshes());
    let stream = bytes.parse().unwrap();
    let [zero, one, four] = [0, 1, 4].map(I18F14::from_num);
    // Where it is already.
    let whole = drawn(stream, room(&stream), |_| ());
    let told = drawn(stream, room(&stream), |scene| scene.look_at([zero, zero, four], [zero; 3], [zero, one, zero]).unwrap());
    assert!(told == whole);
    // From the right, the world turned to the left instead.
    let from_right = drawn(stream, room(&stream), |scene| scene.look_at([four, zero, zero], [zero; 3], [zero, one, zero]).unwrap());
    let lights = [Light::directional([-0.7, 0.6, -0.4], [1; 3]).unwrap()];
    let turned = drawn(stream, room(&stream), |scene| {
        scene.set_pose(0, Pose::about([0, 1, 0], U0F32::from_num(0.75)).unwrap()).unwrap();
        scene.set_lights(&lights).unwrap();
    });
    let far = from_right.iter().zip(&turned).filter(|(a, b)| a.r().abs_diff(b.r()) > 6).count();
    assert!(far < 60, "{far} pixels differ");
}

/// Where two surfaces are a thousandth of the range from near to far apart, the nearer is seen everywhere, at the far end as well.
#[test]
fn surfaces_a_thousandth_of_the_range_apart_do_not_fight() {
    let mut look = look(vec![Lamp::distant([0.0, 0.0, -1.0], [1.0; 3])], false, Projection::Perspective);
    look.surfaces = vec![Surface::metal([1.0, 0.0, 0.0], [0.5, 0.5, 0.0], 1), Surface::metal([0.0, 1.0, 0.0], [0.5, 0.5, 0.0], 1)];
    (look.view.near, look.view.translation) = (0.5, [0.0; 3]);
    let square = shapes::stretched(shapes::cushion(1), [1.5, 1.5, 1.0]);
    let bytes = stream(&look, &[square.clone(), square]);
    let stream = bytes.parse().unwrap();
    // From 0.5 to 15, which is 30 times as far.
    let (far, apart) = (15.0, 14.5 / 1000.0);
    for tilt in [0.0, 0.05, 0.12] {
        for k in 0..20 {
            let depth = far - 0.7 * f64::from(k);
            let place = |mesh: u16, depth: f64| {
                let pose = Pose::about([1, 0, 0], U0F32::from_num(tilt)).unwrap();
                (mesh, pose.at([0.0, 0.0, -depth].map(I18F14::from_num)).unwrap().scaled(U16F16::from_num(1)).unwrap())
            };
            let pixels = drawn(stream, room(&stream), |scene| {
                scene.clear();
                // The one behind is drawn first, so that it would win where depth cannot tell.
                for (mesh, pose) in [place(0, depth), place(1, depth - apart / (std::f64::consts::TAU * tilt).cos())] {
                    scene.add(mesh..mesh + 1, pose).unwrap();
                }
            });
            let red = pixels.iter().filter(|pixel| pixel.r() > 100).count();
            let green = pixels.iter().filter(|pixel| pixel.g() > 100).count();
            // The outline of the one behind may show a row.
            assert!(green > 30 && red <= 12, "tilt {tilt}, depth {depth}: {red} red, {green} green");
        }
    }
}

/// A change that cannot be drawn is refused, and the message says why.
#[test]
fn what_cannot_be_drawn_is_refused() {
    let first = look(vec![Lamp::fixed([-0.4, 0.6, 0.7], [1.0; 3])], false, Projection::Perspective);
    let bytes = stream(&first, &meshes());
    let stream = bytes.parse().unwrap();
    let layout = Layout::new(SIZE.width as usize, SIZE.height as usize).with_room_for(&stream).objects(2);
    let mut memory = vec![0; layout.words::<Rgb888>()];
    let named = |name| microphong_sim::shader::Shader::ALL.into_iter().find(|shader| shader.name() == name).unwrap();
    let [goldman, hybrid] = ["goldman", "hybrid-original"].map(named);
    let mut renderer = Renderer::<Rgb888>::with_shader(stream, SIZE, &layout, &mut memory, Shader::PHONG).unwrap();
    let scene = renderer.scene();
    let errors = [
        (scene.add(1..9, Pose::IDENTITY).err(), SceneError::Meshes, "no such meshes"),
        (scene.add(1..1, Pose::IDENTITY).err(), SceneError::Meshes, "no such meshes"),
        (
            scene.add(0..1, Pose::IDENTITY).and_then(|_| scene.add(0..1, Pose::IDENTITY)).err(),
            SceneError::Objects { room: 2 },
            "Layout::objects",
        ),
        (scene.set_pose(2, Pose::IDENTITY).err(), SceneError::Object { index: 2 }, "no object number 2"),
        (scene.set_visible(9, true).err(), SceneError::Object { index: 9 }, "no object number 9"),
        (scene.set_object_material(0, Some(3)).err(), SceneError::Material { index: 3 }, "no material number 3"),
        (scene.set_material(3, stream.materials[0]).err(), SceneError::Material { index: 3 }, "no material number 3"),
        (
            scene.set_material(0, Material { exponent: 0, ..stream.materials[0] }).err(),
            SceneError::Range { name: "material exponent" },
            "material exponent is out",
        ),
        (
            scene.set_lights(&[Light { colour: [40_000; 3], ..stream.lights[0] }]).err(),
            SceneError::Range { name: "light colour" },
            "light colour is out",
        ),
        (
            scene.set_lights(&[stream.lights[0]; MAX_LIGHTS + 1]).err(),
            SceneError::Range { name: "number of lights" },
            "number of lights is out",
        ),
        (
            scene.set_ambient([4.0 - 0.001; 3].map(microphong::format::Gain::from_num)).err(),
            SceneError::Range { name: "ambient light" },
            "ambient light is out",
        ),
        (
            scene.set_camera(Camera { near: 0, ..stream.header.camera }).err(),
            SceneError::Range { name: "camera near" },
            "camera near is out",
        ),
        (
            scene.look_at([I18F14::ONE; 3], [I18F14::ONE; 3], [I18F14::ZERO, I18F14::ONE, I18F14::ZERO]).err(),
            SceneError::Rotation,
            "not a rotation",
        ),
        (Pose::from_quaternion([I2F30::ZERO; 4]).err(), SceneError::Rotation, "quaternion"),
        (Pose::about([0; 3], U0F32::ZERO).err(), SceneError::Rotation, "axis"),
        (Pose::from_matrix([[I2F30::ONE; 3]; 3]).err(), SceneError::Rotation, "orthonormal"),
        (Pose::from_f32([f32::NAN, 0.0, 0.0, 1.0], [0.0; 3], 1.0).err(), SceneError::Rotation, "a rotation"),
        (Pose::from_f32([1.0, 0.0, 0.0, 0.0], [f32::INFINITY, 0.0, 0.0], 1.0).err(), SceneError::Position, "16 units"),
        (Pose::IDENTITY.at([MAX_POSITION + I18F14::DELTA, I18F14::ZERO, I18F14::ZERO]).err(), SceneError::Position, "16 units"),
        (Pose::IDENTITY.scaled(U16F16::from_num(9)).err(), SceneError::Scale, "1/16 to 8"),
        (Pose::from_f32([1.0, 0.0, 0.0, 0.0], [0.0; 3], -1.0).err(), SceneError::Scale, "1/16 to 8"),
        (Pose::from_f32([1.0, 0.0, 0.0, 0.0], [0.0; 3], f32::NAN).err(), SceneError::Scale, "1/16 to 8"),
    ];
    for (i, (found, expected, words)) in errors.into_iter().enumerate() {
        assert_eq!(found, Some(expected), "{i}");
        assert!(expected.to_string().contains(words), "{expected}");
    }
    // What a method cannot draw is refused while it is in use.
    renderer.set_shader(goldman.on()).unwrap();
    let near = Light { kind: POINT, space: EYE_SPACE, ..stream.lights[0] };
    let scene = renderer.scene();
    assert_eq!(scene.set_lights(&[near]), Err(SceneError::Light));
    assert_eq!(scene.set_camera(Camera { viewer: VIEWER_LOCAL, ..stream.header.camera }), Err(SceneError::Light));
    assert_eq!(scene.set_material(0, Material { exponent: 2, ..stream.materials[0] }), Err(SceneError::Exponent { least: 4 }));
    // So is a perspective camera where the method would have to interpolate in perspective, and cannot.
    renderer.set_shader(hybrid.on()).unwrap();
    let parallel = Camera { projection: ORTHOGRAPHIC, far: stream.header.camera.near + (10 << 14), ..stream.header.camera };
    renderer.scene().set_camera(parallel).unwrap();
    renderer.set_perspective_correct(true).unwrap();
    let refused = renderer.scene().set_camera(stream.header.camera);
    assert_eq!(refused, Err(SceneError::Perspective));
    assert!(SceneError::Perspective.to_string().contains("set_perspective_correct"));
    renderer.set_perspective_correct(false).unwrap();
    renderer.scene().set_camera(stream.header.camera).unwrap();
    renderer.set_shader(Shader::PHONG).unwrap();
    renderer.scene().set_lights(&[near]).unwrap();
    assert!(renderer.set_shader(goldman.on()).is_err());
}

/// Tracks put objects where their keys have them, half-way between two of them half-way, and hide them.
#[test]
fn tracks_lead_from_key_to_key() {
    let text = "
        frames = 40
        [camera]
        at = [0, 0, 5]
        [[mesh]]
        name = \"box\"
        shape = \"box\"
        [[object]]
        mesh = \"box\"
        keys = [
            { frame = 10, at = [1, 0, 0], axis = [0, 0, 1], angle = 0, scale = 1 },
            { frame = 20, at = [3, 2, 0], axis = [0, 0, 1], angle = 90, scale = 0.5 },
            { frame = 30, hidden = true },
        ]";
    let (bytes, _) = script::stream(text, None).unwrap();
    let stream = bytes.parse().unwrap();
    let layout = room(&stream);
    let mut memory = vec![0; layout.words::<Rgb888>()];
    let mut renderer = Renderer::<Rgb888>::with_shader(stream, SIZE, &layout, &mut memory, Shader::PHONG).unwrap();
    let mut at = |number| {
        renderer.scene().play(number);
        let [object] = renderer.scene().objects() else { panic!("one object") };
        let object: &Object = object;
        let pose = object.pose();
        let [w, _, _, z] = pose.quaternion().map(f64::from);
        (pose.position().map(f64::from), 2.0 * z.atan2(w).to_degrees(), f64::from(pose.scale()), object.is_visible())
    };
    let near = |(p, angle, scale, visible): ([f64; 3], f64, f64, bool), (q, other, size, shown): ([f64; 3], f64, f64, bool)| {
        p.iter().zip(q).all(|(a, b)| (a - b).abs() < 1e-3)
            && (angle - other).abs() < 0.01
            && (scale - size).abs() < 1e-3
            && visible == shown
    };
    for (frame, expected) in [
        (0, ([1.0, 0.0, 0.0], 0.0, 1.0, true)),
        (10, ([1.0, 0.0, 0.0], 0.0, 1.0, true)),
        (15, ([2.0, 1.0, 0.0], 45.0, 0.75, true)),
        (20, ([3.0, 2.0, 0.0], 90.0, 0.5, true)),
        (29, ([3.0, 2.0, 0.0], 90.0, 0.5, true)),
        (30, ([3.0, 2.0, 0.0], 90.0, 0.5, false)),
        // Frame 0 again.
        (40, ([1.0, 0.0, 0.0], 0.0, 1.0, true)),
    ] {
        assert!(near(at(frame), expected), "frame {frame}: {:?}", at(frame));
    }
}

/// An object with these keys, a line in each, from frame 0 to frame 60.
fn with_keys(keys: &[&str]) -> String {
    let scene = "frames = 61\n[camera]\nat = [0, 0, 5]\n[[mesh]]\nname = \"box\"\nshape = \"box\"\n[[object]]\nmesh = \"box\"\n";
    format!("{scene}keys = [\n{}\n]", keys.join(",\n"))
}

/// Rotations that are said by angles go the way that they say, at even speed, however far; quaternions go the shorter way.
#[test]
fn angles_say_a_way() {
    let about = |axis: V3, degrees: f64| Placed { axis, degrees, at: [0.0; 3], scale: 1.0 }.pose();
    let euler = |yaw, pitch, roll| {
        let [yaw, pitch, roll] = [yaw, pitch, roll].map(|degrees: f64| U0F32::wrapping_from_num(degrees / 360.0));
        Pose::from_euler(yaw, pitch, roll)
    };
    let (y, z) = ([0.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
    type Expected<'a> = &'a dyn Fn(f64) -> Pose;
    let cases: [(&[&str], Expected<'_>, f64); 8] = [
        (
            &["{ frame = 0, axis = [0, 0, 1], angle = 135 }", "{ frame = 60, axis = [0, 0, 1], angle = -135 }"],
            &|t| about(z, 135.0 - 270.0 * t),
            0.11,
        ),
        (&["{ frame = 0, axis = [0, 0, 1], angle = 0 }", "{ frame = 60, axis = [0, 0, 1], angle = 360 }"], &|t| about(z, 360.0 * t), 0.11),
        (&["{ frame = 0 }", "{ frame = 60, axis = [0, 2, 0], angle = -1800 }"], &|t| about(y, -1800.0 * t), 0.11),
        (
            &["{ frame = 0, axis = [0, 1, 0], angle = 10 }", "{ frame = 60, axis = [0, -1, 0], angle = 170 }"],
            &|t| about(y, 10.0 - 180.0 * t),
            0.11,
        ),
        (&["{ frame = 0, axis = [0, 1, 0], angle = 0 }", "{ frame = 60, axis = [0, 1, 0], angle = 80 }"], &|t| about(y, 80.0 * t), 1.0),
        (&["{ frame = 0 }", "{ frame = 60, euler = [0, 0, 360] }"], &|t| euler(0.0, 0.0, 360.0 * t), 0.11),
        (
            &["{ frame = 0, euler = [90, 20, 0] }", "{ frame = 60, euler = [-270, 20, 720] }"],
            &|t| euler(90.0 - 360.0 * t, 20.0, 720.0 * t),
            0.11,
        ),
        (
            &["{ frame = 0, quaternion = [1, 0, 0, 0] }", "{ frame = 60, quaternion = [-0.9238795, 0, 0, -0.3826834] }"],
            &|t| about(z, 45.0 * t),
            0.2,
        ),
    ];
    for (keys, expected, limit) in cases {
        let (bytes, _) = script::stream(&with_keys(keys), None).unwrap();
        let stream = bytes.parse().unwrap();
        let layout = room(&stream);
        let mut memory = vec![0; layout.words::<Rgb888>()];
        let mut renderer = Renderer::<Rgb888>::with_shader(stream, SIZE, &layout, &mut memory, Shader::PHONG).unwrap();
        for frame in 0..=60 {
            renderer.scene().play(frame);
            let [pose, expected] = [renderer.scene().objects()[0].pose(), expected(f64::from(frame) / 60.0)].map(|pose| pose.quaternion());
            let cosine: f64 = pose.iter().zip(expected).map(|(a, b)| f64::from(*a) * f64::from(b)).sum();
            let off = 2.0 * cosine.abs().min(1.0).acos().to_degrees();
            assert!(off < limit, "{keys:?}, frame {frame}: {off} degrees off");
        }
    }
    // What turns by less than a quarter takes no keys that the text does not have, nor does what is hidden.
    for keys in [
        ["{ frame = 0 }", "{ frame = 60, axis = [1, 2, 3], angle = 85 }"],
        ["{ frame = 0, hidden = true }", "{ frame = 60, euler = [300, 0, 0] }"],
    ] {
        let (bytes, _) = script::stream(&with_keys(&keys), None).unwrap();
        assert_eq!(bytes.parse().unwrap().keys.len(), 2, "{keys:?}");
    }
}
