//! Cost and error of one frame.

use super::{processor::Processor, stage::Stages};
use microphong_render::choices::Choices;
use serde::{Serialize, Serializer};

/// One frame of a scene, drawn by one method on one processor: a line of `bench --json`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Measurement {
    /// The board that drew; of the host its architecture.
    #[serde(serialize_with = "board")]
    pub board: Processor,
    /// Name of the processor.
    pub cpu: &'static str,
    /// The scene's name.
    pub scene: String,
    /// The method's name.
    pub shader: &'static str,
    /// Instructions of the frame, without clearing and transfer.
    pub instructions: u64,
    /// Cycles of these instructions, where they are modelled: approximately.
    pub cycles: Option<u64>,
    /// Pixels of all drawn triangles.
    pub pixels: u64,
    /// Triangles drawn.
    pub triangles: u64,
    /// Rows of triangles.
    pub spans: u64,
    /// Instructions per pixel, to a hundredth.
    pub instr_per_pixel: f64,
    /// Instructions of each stage.
    pub by_stage: Stages,
    /// Variables and stack, where the program is alone on its board.
    pub ram_bytes: Option<u64>,
    /// Flash that a program with this method alone has more than one with none, see [`super::flash`].
    pub flash_bytes: Option<u64>,
    /// Largest error of this frame against Phong shading in f64: 255 is full.
    pub max_lsb: Option<f64>,
    /// Root mean square of these errors.
    pub rmse_lsb: Option<f64>,
    /// Error budget of the method `auto`, in 1/255; null for others.
    pub budget: Option<f64>,
    /// The ways that `auto` chooses; null for others.
    pub choices: Option<Choices>,
    /// Flash that no other method needs.
    pub flash_own_bytes: Option<u64>,
    /// Flash of the whole program with all its methods, without the stream.
    pub firmware_bytes: Option<u64>,
    /// Times of the frame, where time is modelled.
    pub timing: Option<Timing>,
}

/// Cycles of a frame that follows another, all approximate.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Timing {
    /// Cycles from the beginning of the frame to the beginning of the next.
    pub frame_cycles: u64,
    /// Cycles in which the processor draws, clearing included.
    pub render_cycles: u64,
    /// Cycles in which bits are sent to the display.
    pub wire_cycles: u64,
    /// Cycles in which the processor waits for the wire.
    pub idle_cycles: u64,
    /// Frames per second at the board's clock.
    pub frames_per_second: f64,
}

fn board<S: Serializer>(processor: &Processor, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(processor.board_name())
}
