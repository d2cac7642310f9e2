//! A Pico that draws for a long time: 10,000 frames on the emulated board, with neither stack nor memory used up and all pictures right.
//!
//! The emulator executes some 20 million instructions a second, and all is to take less than 40 s: so the scene is a torus of 24 triangles,
//! 6 pixels wide, lit at its corners, and a frame takes 54,000 instructions. It circles in 25 frames round a point where one band ends and
//! the next begins: it is tested for depth, reaches from band to band, and leaves rows that must become background again.

use microphong_sim::{
    board::{Board, Pico, elf::Elf},
    look::{Lamp, Look, Surface},
    quantise::quantise,
    shader::Shader,
    shapes,
    vector::{add, scale},
    verify,
    view::View,
};
use std::{collections::HashSet, error::Error, ops::Range};

type Result<T = ()> = std::result::Result<T, Box<dyn Error>>;

/// Frames of a revolution.
const TURN: usize = 25;
/// Frames after which memory is looked at, whole revolutions both.
const EARLY: usize = 100;
const LATE: usize = 10_000;

/// The word with which start-up code fills the first processor's stack. The second one's stack is all zeros.
const PAINT: u32 = 0xCCCC_CCCC;
/// First address of RAM.
const RAM: u32 = 0x2000_0000;

/// A small torus that circles round a point above the middle of the picture. A unit is 15 pixels.
fn stream() -> Result<Vec<u8>> {
    let mut mesh = shapes::torus(4, 3);
    for position in &mut mesh.positions {
        *position = add(scale(*position, 0.2), [0.3, 0.0, 0.0]);
    }
    let upright = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let mut view = View::facing(upright, 8.0, [0.0, 0.0, 1.0], TURN as u16);
    // Row 108, the end of the third band.
    view.translation[1] = 0.8;
    let mut look = Look::new(Surface::metal([1.0, 0.7, 0.3], [0.1, 0.5, 0.4], 30), view);
    look.shader = Shader::GOURAUD;
    look.lamps = vec![Lamp::distant([-0.4, 0.5, -0.77], [1.0; 3])];
    Ok(look.stream(&quantise(&mesh).0)?.as_bytes().to_vec())
}

/// Offsets in RAM of what lies at these addresses.
fn offsets(addresses: Range<u32>) -> Range<usize> {
    (addresses.start - RAM) as usize..(addresses.end - RAM) as usize
}

/// Bytes of stack that have lost their paint.
fn stack_used(stack: &[u8], paint: u32) -> usize {
    let clean = stack.chunks_exact(4).take_while(|word| **word == paint.to_le_bytes()).count();
    stack.len() - 4 * clean
}

#[test]
fn ten_thousand_frames_use_up_nothing() -> Result {
    let elf = Elf::read(&verify::build(Board::Pico, false)?)?.with_stream(&stream()?)?;
    let stack = offsets(elf.symbol("_stack_end")?.0..elf.symbol("_stack_start")?.0);
    // What the renderer and the frame loop are given to write: all else is to stay as it is.
    let given: Vec<_> = elf.objects()?.into_iter().filter(|(name, _)| name.ends_with("::MEMORY")).collect();
    assert_eq!(given.len(), 1, "the firmware's memory is not where this test looks for it: {given:?}");
    let second = elf.objects()?.into_iter().find(|(name, _)| name.ends_with("::SECOND_STACK")).map(|(_, addresses)| offsets(addresses));
    let second = second.ok_or("the second processor's stack is not where this test looks for it")?;
    let given: Vec<_> = given.into_iter().map(|(_, addresses)| offsets(addresses)).chain([stack.clone(), second.clone()]).collect();

    let mut pico = Pico::new(Board::Pico, &elf)?;
    let mut turn: Vec<Vec<u32>> = Vec::new();
    let mut early = Vec::new();
    for frame in 0..LATE {
        if frame == EARLY {
            early = pico.ram();
        }
        pico.next_picture()?;
        match turn.get(frame % TURN) {
            None => turn.push(pico.picture()),
            Some(first) => assert!(*first == pico.picture(), "frame {frame} is another picture than {TURN} frames before"),
        }
    }
    let late = pico.ram();
    assert_eq!(turn.iter().collect::<HashSet<_>>().len(), TURN, "the scene does not move");

    for (stack, paint) in [(stack, PAINT), (second, 0)] {
        let [before, after] = [&early, &late].map(|ram| stack_used(&ram[stack.clone()], paint));
        println!("stack: {before} bytes after {EARLY} frames, {after} after {LATE}; {:?}", pico.log().last());
        assert!(before > 1000 && before == after, "stack: {before} bytes after {EARLY} frames, {after} after {LATE}");
    }

    let changed: Vec<_> = (0..late.len()).filter(|&at| early[at] != late[at] && !given.iter().any(|range| range.contains(&at))).collect();
    let objects = elf.objects()?;
    let name = |at: usize| {
        let address = RAM + at as u32;
        objects.iter().find(|(_, addresses)| addresses.contains(&address)).map_or("nothing of a name", |(name, _)| name)
    };
    let places: Vec<_> = changed.iter().map(|&at| format!("{:#010x} of {}", RAM + at as u32, name(at))).collect();
    assert!(places.is_empty(), "memory changed that nobody may write: {places:?}");
    Ok(())
}
