//! What all rows of a frame have in common. It does not change while they are drawn, so two processors can read it at the same time.

use crate::{
    Stream,
    format::{GeometricError, RAMP},
    frame::skips::Skips,
    geometry::{
        cull::Facing,
        depth_elision::DepthElision,
        projection::{ScreenVertex, View},
        viewport::Viewport,
    },
    lighting::{lights::Lighting, material_tables::MaterialTables, reflectance::Reflectance},
    mesh::{MeshPass, vertices::VertexStage},
    method::{ErrorBounds, Shading, Style},
    pixel::Pixel,
    shader::{Shader, TriangleLoops},
    stream::record::{CLOSED_CONVEX, Mesh},
};
use embedded_graphics_core::geometry::Size;

/// What is drawn, and how, from frame to frame.
#[derive(Debug)]
pub(crate) struct Settings<'a, C: Pixel> {
    pub(crate) stream: Stream<'a>,
    pub(crate) size: Size,
    /// Processors that draw at the same time.
    pub(crate) processors: u32,
    pub(crate) shader: Shader<C>,
    pub(crate) dither: bool,
    pub(crate) perspective_correct: bool,
    pub(crate) antialias: bool,
    /// How far a pixel may be off by a method that keeps to a budget, in 1/255, Q9.7.
    pub(crate) budget: u32,
    pub(crate) background: C,
    #[cfg(feature = "skips")]
    pub(crate) skips: Skips,
    /// Coarser levels of meshes may lie so far from them.
    pub(crate) tolerance: GeometricError,
    /// Triangles of the levels that are drawn.
    pub(crate) triangles: u32,
    /// They are those of one closed convex mesh.
    pub(crate) closed_convex: bool,
    /// Triangles that the meshes as they are have more.
    pub(crate) simplified: u32,
}

impl<'a, C: Pixel> Settings<'a, C> {
    /// Chooses the level of each mesh.
    pub(crate) fn set_tolerance(&mut self, tolerance: GeometricError) {
        let (mut meshes, mut triangles, mut flags) = (0u32, 0u32, CLOSED_CONVEX);
        for mesh in self.stream.meshes_within(tolerance) {
            (meshes, triangles, flags) = (meshes.wrapping_add(1), triangles.wrapping_add(mesh.triangles), flags & mesh.flags);
        }
        let as_they_are = self.stream.meshes.iter().filter(|mesh| mesh.error == 0).fold(0u32, |sum, mesh| sum.wrapping_add(mesh.triangles));
        (self.tolerance, self.triangles, self.closed_convex) = (tolerance, triangles, meshes == 1 && flags != 0);
        self.simplified = as_they_are.saturating_sub(triangles);
    }

    /// The meshes, each at the level that is drawn.
    pub(crate) fn meshes(&self) -> impl DoubleEndedIterator<Item = &'a Mesh> + use<'a, C> {
        self.stream.meshes_within(self.tolerance)
    }

    #[inline(always)]
    pub(crate) fn antialiased(&self) -> bool {
        cfg!(feature = "antialias") && self.antialias
    }

    /// What is left out.
    #[inline(always)]
    pub(crate) fn skips(&self) -> Skips {
        #[cfg(feature = "skips")]
        return self.skips;
        #[cfg(not(feature = "skips"))]
        Skips::ALL
    }

    /// Rows of a band for which there is room for depth, and for samples.
    pub(crate) fn band_rows(&self, depth: usize, samples: usize) -> u32 {
        let pixels = if self.antialiased() { depth.min(samples) } else { depth };
        (pixels as u32).checked_div(self.size.width).unwrap_or(0).min(self.size.height)
    }

    pub(crate) fn viewport(&self) -> Viewport {
        Viewport {
            width: self.size.width as i32,
            height: self.size.height as i32,
            antialiased: self.antialiased(),
            all_touched: self.antialiased() || !self.skips().between_centres,
        }
    }
}

/// One frame of a stream, its vertices on the screen.
#[derive(Debug)]
pub(crate) struct Scene<'r, C: Pixel> {
    pub(crate) settings: &'r Settings<'r, C>,
    pub(crate) view: View,
    pub(crate) facing: Facing,
    pub(crate) lighting: Lighting,
    /// See [`Lighting::constant`].
    pub(crate) constant: Option<[[i32; 3]; 2]>,
    /// Where triangles may overlap; `None` if they may do so everywhere.
    pub(crate) depth_elision: Option<DepthElision>,
    pub(crate) vertices: &'r [ScreenVertex],
    /// One for each material, as in `ramps`, the tables of colours.
    pub(crate) reflectances: &'r [Reflectance],
    pub(crate) ramps: &'r [[C::Stored; RAMP]],
    /// What a method that keeps to a budget knows of each material.
    pub(crate) error_bounds: &'r [ErrorBounds],
}

impl<C: Pixel> Scene<'_, C> {
    /// The stage that transforms and lights the vertices of `mesh`.
    pub(super) fn stage(&self, mesh: &Mesh) -> Option<VertexStage<'_>> {
        let Self { settings, view, lighting, constant, .. } = self;
        let light = settings.shader.facts().vertex_light;
        let reflectance = self.reflectances.get(usize::from(mesh.material))?;
        Some(VertexStage { view, lighting, constant: constant.as_ref(), reflectance, light })
    }

    /// The mesh of triangle `id`.
    pub(crate) fn mesh(&self, id: u32) -> Option<&Mesh> {
        // Meshes follow one another without a gap, so this is the last one that does not start behind the triangle. A stream may have
        // 65,535 meshes: they are searched by halves.
        let meshes = self.settings.stream.meshes;
        meshes.get(meshes.partition_point(|mesh| mesh.first_triangle <= id).wrapping_sub(1))
    }

    /// What the triangles of `mesh` have in common, and the loops that draw them.
    #[inline(never)]
    pub(crate) fn drawing(&self, mesh: &Mesh) -> Option<(MeshPass<'_, C>, TriangleLoops<C>)> {
        let Settings { stream, shader, dither, .. } = self.settings;
        let material = usize::from(mesh.material);
        let (reflectance, ramp) = (self.reflectances.get(material)?, self.ramps.get(material)?);
        let perspective = self.settings.perspective_correct && stream.is_perspective();
        let style = Style {
            three_channels: reflectance.three_channels(),
            lights: if self.lighting.is_constant() { reflectance.lights() } else { 0 },
            local_viewer: self.lighting.is_directional() && !self.lighting.is_constant() && reflectance.lights() == 1,
            dithered_or_antialiased: *dither || self.settings.antialiased(),
            perspective,
        };
        let exponent = stream.materials.get(material)?.exponent;
        let error_bounds = self.error_bounds.get(material)?;
        let drawing = MeshPass {
            method: shader.method(),
            shading: Shading {
                reflectance,
                lighting: &self.lighting,
                exponent,
                constant: self.constant,
                error_bounds,
                budget: self.settings.budget,
            },
            tables: MaterialTables { ramp, reflectance },
            dither: *dither,
            stage: self.stage(mesh)?,
            depth_elision: self.depth_elision.as_ref(),
            vertices: stream.vertices_of(mesh)?,
            cached: self.vertices.get(mesh.first_vertex as usize..).unwrap_or_default(),
            viewport: self.settings.viewport(),
            perspective,
        };
        Some((drawing, shader.loops(style)))
    }
}
