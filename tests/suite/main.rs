//! Cross-checks of whole programs. They are one program themselves: it is linked once, and none of them leaves a processor idle while another
//! runs alone.

mod antialias;
mod arithmetic;
mod bands;
mod bench;
mod bounds;
mod callgrind;
mod choices;
mod cli;
mod clipping;
mod compare;
mod convex;
mod differences;
mod endurance;
mod faults;
mod golden;
mod hostile;
mod independent;
mod inner_loop;
mod layers;
mod levels;
mod numerics;
mod oracle;
mod oracle_methods;
mod panic_free;
mod papers;
mod peers;
mod perspective;
mod raster;
mod scanlines;
mod skips;
mod split;
mod still;
mod stress;
mod verify;
mod watertight;
