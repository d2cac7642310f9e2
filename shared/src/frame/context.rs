//! What all rows of a frame have in common. It does not change while they are drawn, so two processors can read it at the same time.

use crate::{
    edges::{FeatureEdge, find::Outlined},
    features::{ANTIALIAS, COLOURED, OBJECTS, REDRAW, TRANSPARENCY},
    format::{ErrorBudget, LEVEL},
    frame::skips::Skips,
    geometry::{
        depth_elision::DepthElision,
        pixel_rect::PixelRect,
        projection::{ScreenVertex, View},
        region::Region,
        viewport::{Bounds, Viewport},
    },
    lighting::reflectance::{LitMaterial, Reflectance},
    math::highlight_lut::HighlightLut,
    mesh::{MeshPass, Painting, vertices::VertexStage},
    method::{ErrorBounds, Method, Shading, VertexLight},
    placement::{Placement, Placements},
    scene::{Object, Outlines, Scene},
    stream::record::{CLOSED_CONVEX, Cut, Mesh},
};
use embedded_graphics_core::geometry::Size;

/// How scenes are drawn, from frame to frame.
#[derive(Debug)]
pub(crate) struct Settings {
    pub(crate) size: Size,
    /// Rows of a band that there is room for, of all processors.
    pub(crate) rows: u32,
    /// Processors that draw at the same time.
    pub(crate) processors: u32,
    pub(crate) method: &'static dyn Method,
    pub(crate) perspective_correct: bool,
    pub(crate) antialias: bool,
    /// Lines that are drawn along edges, as the scene has them in this frame.
    pub(crate) outlines: Option<Outlines>,
    /// The number of tables of highlights that the materials need, if there are fewer; otherwise 0.
    pub(crate) lacking_tables: usize,
    /// How far a pixel may be off by a method that keeps to a budget, in 1/255.
    pub(crate) budget: ErrorBudget,
    #[cfg(feature = "skips")]
    pub(crate) skips: Skips,
    /// Whether coarser levels of meshes are drawn.
    pub(crate) levels_of_detail: bool,
    /// Whether only what has changed is drawn.
    pub(crate) partial_redraw: bool,
}

impl Settings {
    /// Whether the edges of surfaces are found, to be smoothed or to be drawn as lines.
    #[inline]
    pub(crate) fn has_edges(&self) -> bool {
        ANTIALIAS && (self.antialias || self.outlines.is_some())
    }

    /// What is left out.
    #[inline]
    pub(crate) fn skips(&self) -> Skips {
        #[cfg(feature = "skips")]
        return self.skips;
        #[cfg(not(feature = "skips"))]
        Skips::ALL
    }

    /// Rows of a band, of all processors.
    pub(crate) fn band_rows(&self) -> u32 {
        self.rows.min(self.size.height)
    }

    /// The pixels in which an object that reaches into `area` changes the picture: where edges are found those around it, too.
    #[inline]
    pub(crate) fn touched(&self, area: &PixelRect) -> PixelRect {
        if self.has_edges() { area.grown(1, self.size) } else { *area }
    }

    pub(crate) fn viewport(&self) -> Viewport {
        Viewport { width: self.size.width as i32, height: self.size.height as i32, all_touched: !self.skips().between_centres }
    }
}

/// One frame of a scene, its vertices on the screen.
#[derive(Debug)]
pub(crate) struct Context<'r> {
    pub(crate) settings: &'r Settings,
    pub(crate) scene: &'r Scene<'r>,
    pub(crate) placements: Placements<'r>,
    /// The pixels that the frame has.
    pub(crate) region: &'r Region,
    /// Where triangles may overlap; `None` if they may do so everywhere.
    pub(crate) depth_elision: Option<DepthElision>,
    pub(crate) vertices: &'r [ScreenVertex],
    /// One for each material.
    pub(crate) reflectances: &'r [Reflectance],
    /// Tables of highlights, which materials share, or none if the method needs none.
    pub(crate) tables: &'r [HighlightLut],
    /// What a method that keeps to a budget knows of each material.
    pub(crate) error_bounds: &'r [ErrorBounds],
}

/// A mesh of an object in one frame.
pub(crate) struct PlacedMesh<'r> {
    pub(crate) mesh: &'r Mesh,
    pub(crate) placement: &'r Placement,
    /// Index of its material.
    pub(crate) material: usize,
    /// Number of its first triangle in the frame.
    pub(crate) first_triangle: u32,
    /// Vertices of the frame before its own.
    pub(crate) first_vertex: usize,
}

impl<'r> PlacedMesh<'r> {
    /// Whether it has this triangle of the frame.
    pub(crate) fn has(&self, triangle: u32) -> bool {
        triangle.wrapping_sub(self.first_triangle) < self.mesh.triangles
    }

    /// `mesh` of `object`, whose first mesh in the stream is `first`.
    fn new(placement: &'r Placement, object: &Object, first: &Mesh, mesh: &'r Mesh) -> Self {
        let of_object = placement.first_number(object, TRANSPARENCY && mesh.is_transparent());
        Self {
            mesh,
            placement,
            material: object.material_of(mesh),
            first_triangle: of_object.wrapping_add(mesh.first_triangle.wrapping_sub(first.first_triangle)),
            first_vertex: placement.first_vertex.wrapping_add(mesh.first_vertex.wrapping_sub(first.first_vertex)) as usize,
        }
    }
}

/// The meshes of all objects of a scene, each at the level that is drawn, in the order of drawing: transparent ones after all others, the farthest
/// object first.
pub(crate) fn meshes<'r>(scene: &'r Scene<'_>, placements: Placements<'r>) -> impl DoubleEndedIterator<Item = PlacedMesh<'r>> {
    let of_object = move |(placement, object): (&'r Placement, &'r Object)| {
        let first = scene.stream.meshes.get(usize::from(object.meshes().start));
        let placed = move |mesh| Some(PlacedMesh::new(placement, object, first?, mesh));
        placement.meshes(scene, object).filter_map(placed)
    };
    let all = placements.objects(scene).flat_map(of_object);
    // Not decided by a constant: adapters that do nothing are 2.4 KB of code.
    #[cfg(feature = "transparency")]
    let all = {
        let behind = placements.objects(scene).rev().flat_map(of_object).filter(|placed| placed.mesh.is_transparent());
        all.filter(|placed| !placed.mesh.is_transparent()).chain(behind)
    };
    all
}

impl<'r> Context<'r> {
    /// The meshes of all objects, each at the level that is drawn.
    pub(crate) fn meshes(&self) -> impl DoubleEndedIterator<Item = PlacedMesh<'r>> + use<'r> {
        meshes(self.scene, self.placements)
    }

    /// The view of the only mesh that is drawn, if it is closed and convex, and no larger than its rounding allows for.
    pub(crate) fn convex(&self) -> Option<&'r View> {
        let mut meshes = self.meshes();
        let only = meshes.next().filter(|only| only.mesh.flags & CLOSED_CONVEX != 0)?;
        let view = &only.placement.view;
        (meshes.next().is_none() && view.scale <= 1 << 16).then_some(view)
    }

    /// The mesh of triangle `id` of the frame.
    pub(crate) fn mesh(&self, id: u32) -> Option<PlacedMesh<'r>> {
        let (placement, object, first_number) = self.placements.with_triangle(self.scene, id)?;
        // As objects, meshes in the stream follow one another without a gap. There may be 65,535 of them: they are searched by halves.
        let meshes = self.scene.stream.meshes;
        let first = meshes.get(usize::from(object.meshes().start))?;
        let id = id.wrapping_sub(first_number).wrapping_add(first.first_triangle);
        let mesh = meshes.get(meshes.partition_point(|mesh| mesh.first_triangle <= id).wrapping_sub(1))?;
        Some(PlacedMesh::new(placement, object, first, mesh))
    }

    /// Whether all pixels of an object in these `columns` of a band, if there are any, are nearer than the object is: none of its triangles can be
    /// seen there. The band has the rows from `first` up to `end`, and this `depth`.
    pub(crate) fn hides(&self, placement: &Placement, columns: [u16; 2], [first, end]: [i32; 2], depth: &[u16]) -> bool {
        if !OBJECTS || !self.settings.skips().hidden_objects {
            return false;
        }
        let PixelRect { columns: [left, right], rows: [top, bottom] } = placement.area.within(&PixelRect { columns, rows: [0, u16::MAX] });
        (i32::from(top).max(first)..i32::from(bottom).min(end)).all(|row| {
            let start = ((row - first) as usize).wrapping_mul(self.settings.size.width as usize);
            let pixels = depth.get(start.wrapping_add(left.into())..start.wrapping_add(right.into())).unwrap_or_default();
            pixels.iter().all(|&inv_depth| inv_depth >= placement.nearest)
        })
    }

    /// Whether vertices are lit once it is known which triangles reach into the area: where that is not the whole picture, most do not, and
    /// levels take longer than to find that out.
    pub(crate) fn lights_later(&self) -> bool {
        let light = self.settings.method.facts().vertex_light;
        let may_have_levels = matches!(light, VertexLight::CosinesOrLevels | VertexLight::ReflectionOrLevels | VertexLight::Levels);
        REDRAW && may_have_levels && !self.region.is_whole()
    }

    /// The stage that transforms and lights the vertices of `placed`.
    pub(super) fn stage<'s>(&'s self, placed: &PlacedMesh<'s>) -> Option<VertexStage<'s>> {
        let light = self.settings.method.facts().vertex_light;
        let reflectance = self.reflectances.get(placed.material)?;
        let reflectance = LitMaterial::new(reflectance, reflectance.table(self.tables));
        let Placement { view, lighting, .. } = placed.placement;
        let has_colours = [placed.mesh.is_coloured(); COLOURED];
        let mut stage = VertexStage { view, lighting, constant: lighting.constant(), reflectance, light, has_colours };
        if stage.holds_parts() {
            stage.constant = None;
        }
        Some(stage)
    }

    /// A mesh whose outlines are found.
    pub(crate) fn outlined<'s>(&'s self, placed: &PlacedMesh<'s>) -> Option<Outlined<'s>> {
        let (stream, mesh) = (&self.scene.stream, placed.mesh);
        let Placement { view, facing, .. } = placed.placement;
        Some(Outlined {
            view,
            facing: *facing,
            triangles: stream.triangles_of(mesh)?,
            neighbours: stream.neighbours_of(mesh),
            vertices: stream.vertices_of(mesh)?,
            cached: self.vertices.get(placed.first_vertex..).unwrap_or_default(),
            is_transparent: mesh.is_transparent(),
        })
    }

    /// Calls `put` with the edges of the area to be drawn at which triangles cut each other.
    #[inline(never)]
    pub(crate) fn each_cut(&self, put: &mut dyn FnMut(&FeatureEdge)) {
        let hull = self.settings.touched(&self.region.hull());
        // Most pairs belong to the meshes of the pair before them.
        let (mut meshes, mut other_meshes) = (None, None);
        for &Cut { triangles: [one, other], objects: [object, other_object] } in self.scene.stream.cuts {
            if let Some((one, first)) = self.with_triangle(&mut meshes, object, one)
                && let Some((other, other_first)) = self.with_triangle(&mut other_meshes, other_object, other)
                && let Some(one) = one.flat(first)
                && let Some(other) = other.flat(other_first)
                && let Some(edge) = one.edge(&other)
                && edge.rows_in(&hull).is_some()
            {
                put(&edge);
            }
        }
    }

    /// The mesh of an object that has a triangle of the stream which faces the viewer, and the number of the triangle in it. `known` is the mesh that
    /// was found last.
    #[inline(always)]
    fn with_triangle<'k, 's>(
        &'s self,
        known: &'k mut Option<(u16, u32, Outlined<'s>)>,
        object: u16,
        triangle: u32,
    ) -> Option<(&'k Outlined<'s>, usize)> {
        let is_right = |&(of, first, ref mesh): &(u16, u32, Outlined<'s>)| {
            of == object && ((triangle.wrapping_sub(first)) as usize) < mesh.triangles.len()
        };
        if !known.as_ref().is_some_and(is_right) {
            *known = self.mesh_of(object, triangle);
        }
        let (_, first, outlined) = known.as_ref()?;
        let index = triangle.wrapping_sub(*first) as usize;
        outlined.may_face(index).then_some((outlined, index))
    }

    /// The object, its mesh at the level that is drawn which has a triangle of the stream, and the mesh's first triangle.
    #[inline(never)]
    fn mesh_of(&self, object: u16, triangle: u32) -> Option<(u16, u32, Outlined<'_>)> {
        let (placement, of) = self.placements.object(self.scene, object.into())?;
        let first = self.scene.stream.meshes.get(usize::from(of.meshes().start))?;
        let has = |mesh: &&Mesh| triangle.wrapping_sub(mesh.first_triangle) < mesh.triangles;
        let mesh = placement.meshes(self.scene, of).find(has)?;
        Some((object, mesh.first_triangle, self.outlined(&PlacedMesh::new(placement, of, first, mesh))?))
    }

    /// Calls `put` with every edge of the frame's outlines, for frames that have no list of them.
    #[cold]
    #[inline(never)]
    pub(crate) fn each_edge(&self, put: &mut dyn FnMut(&FeatureEdge)) {
        let (viewport, hull) = (self.settings.viewport(), self.settings.touched(&self.region.hull()));
        for placed in self.meshes() {
            let Some(outlined) = self.outlined(&placed) else { continue };
            let area = Bounds::from(&self.settings.touched(&hull));
            let faces = |triangle| outlined.faces(triangle, viewport, area);
            for triangle in 0..outlined.triangles.len() {
                if faces(triangle as u16) {
                    outlined.edges(triangle, faces, &mut |edge| {
                        if edge.rows_in(&hull).is_some() {
                            put(edge);
                        }
                    });
                }
            }
        }
        self.each_cut(put);
    }

    /// What the triangles of `placed` have in common in a band of which these `columns` are wanted.
    #[inline(never)]
    pub(crate) fn pass<'s>(&'s self, placed: &PlacedMesh<'s>, columns: [u16; 2]) -> Option<MeshPass<'s>> {
        let method = self.settings.method;
        let (stream, material, stage) = (&self.scene.stream, placed.material, self.stage(placed)?);
        let reflectance = stage.reflectance;
        let perspective = self.settings.perspective_correct && stage.view.lens.is_perspective();
        let lighting = stage.lighting;
        // In perspective, light is interpolated between columns that depend on where a row begins: rows are drawn whole.
        let columns = if perspective { [0, self.settings.size.width as u16] } else { columns };
        let exponent = self.scene.material(material)?.exponent;
        let error_bounds = self.error_bounds.get(material)?;
        Some(MeshPass {
            method,
            steepness: method.facts().steepness(exponent),
            shading: Shading {
                reflectance,
                lighting,
                exponent,
                constant: stage.constant.copied(),
                error_bounds,
                budget: u32::from(self.settings.budget.to_bits()) << (LEVEL - ErrorBudget::FRAC_NBITS),
            },
            painting: Painting::of(stream, placed.mesh, self.scene.channels.is_gray, || stage.view.lens.is_perspective()),
            stage,
            depth_elision: self.depth_elision.as_ref(),
            first_triangle: placed.first_triangle,
            triangles: stream.triangles_of(placed.mesh)?,
            vertices: stream.vertices_of(placed.mesh)?,
            cached: self.vertices.get(placed.first_vertex..).unwrap_or_default(),
            viewport: self.settings.viewport(),
            columns: columns.map(i32::from),
            perspective,
        })
    }
}
