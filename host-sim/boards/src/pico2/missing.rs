//! Instructions of a Cortex-M33 that the crate `rp2350-emu` lacks or executes wrongly, executed here in its place.
//!
//! Numbers of sections are those of the Armv8-M Architecture Reference Manual (DDI 0553).

use anyhow::{Result, bail, ensure};
use rp2350_emu::core::{CoreBus, CortexM33};

/// An instruction. Registers have their numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Missing {
    /// `LDA`, `LDAB`, `LDAH` (C2.4.60 on), which the crate takes for `LDRD`: loads that later ones do not overtake.
    Load { width: u32, to: usize, address: usize },
    /// `STL`, `STLB`, `STLH`, which the crate takes for `STRD`.
    Store { width: u32, from: usize, address: usize },
    /// `LDAEX` and `STLEX`, which need the exclusive monitor of the crate.
    Exclusive,
    /// `PKHBT`, `PKHTB`: a half of one register and a half of another.
    Pack { to: usize, first: usize, second: usize, shift: u32, bottom_first: bool },
    /// `VSEL`: one of two registers, by the flags. The crate reads condition and destination from wrong bits.
    Select { condition: u8, to: usize, first: usize, second: usize },
    /// `VMAXNM`, `VMINNM`: the larger or the smaller number. The crate reads the destination from a wrong bit.
    Extreme { is_maximum: bool, to: usize, first: usize, second: usize },
    /// `VPUSH`, `VPOP` of double registers, each of which is a pair of single ones.
    Transfer { is_push: bool, first: usize, count: usize },
}

/// The conditions of `VSEL` by their codes: EQ, VS, GE, GT.
const CONDITIONS: [u8; 4] = [0x0, 0x6, 0xA, 0xC];

impl Missing {
    fn decode([first, second]: [u16; 2]) -> Option<Self> {
        let field = |half: u16, shift: u32| usize::from(half >> shift & 0xF);
        // A single register has its lowest bit elsewhere.
        let single = |upper: usize, half: u16, bit: u32| upper << 1 | usize::from(half >> bit & 1);
        let [to, n, m] = [single(field(second, 12), first, 6), single(field(first, 0), second, 7), single(field(second, 0), second, 5)];
        match first {
            0xE8C0..=0xE8DF if second & 0xF80 == 0xF80 && second & 0x30 != 0x30 => {
                let (width, register, address) = (1 << (second >> 4 & 3), field(second, 12), field(first, 0));
                Some(match (second & 0x40 != 0, first & 0x10 != 0) {
                    (true, _) => Self::Exclusive,
                    (false, true) => Self::Load { width, to: register, address },
                    (false, false) => Self::Store { width, from: register, address },
                })
            }
            0xEAC0..=0xEACF if second & 0x8010 == 0 => Some(Self::Pack {
                to: field(second, 8),
                first: field(first, 0),
                second: field(second, 0),
                shift: u32::from(second >> 10 & 0x1C | second >> 6 & 3),
                bottom_first: second & 0x20 == 0,
            }),
            _ if first & 0xFF80 == 0xFE00 && second & 0xF50 == 0xA00 => {
                Some(Self::Select { condition: CONDITIONS[usize::from(first >> 4 & 3)], to, first: n, second: m })
            }
            _ if first & 0xFFB0 == 0xFE80 && second & 0xF10 == 0xA00 => {
                Some(Self::Extreme { is_maximum: second & 0x40 == 0, to, first: n, second: m })
            }
            0xED2D | 0xECBD if second & 0xF01 == 0xB00 => {
                let (first_single, count) = (2 * field(second, 12), usize::from(second & 0xFF));
                (count > 0 && first_single + count <= 32).then_some(Self::Transfer { is_push: first == 0xED2D, first: first_single, count })
            }
            _ => None,
        }
    }
}

/// Whether the instruction is `LDREX`, `STREX` or one of their narrow forms. The monitor of the crate does not see what the other processor writes.
pub(super) fn is_exclusive([first, second]: [u16; 2]) -> bool {
    match first & 0xFFF0 {
        0xE850 => true,
        // With this register it is `TT`.
        0xE840 => second >> 12 != 0xF,
        0xE8C0 | 0xE8D0 => matches!(second & 0xFF0, 0xF40 | 0xF50),
        _ => false,
    }
}

/// Executes `instruction`, the next one of the processor, if the crate must not, and returns its cycles.
///
/// # Errors
/// When the instruction would do something that is not modelled.
pub(super) fn execute<B: CoreBus>(core: &mut CortexM33, bus: &mut B, instruction: [u16; 2]) -> Result<Option<u64>> {
    // All of them begin so, which few others do.
    if !matches!(instruction[0] >> 8, 0xE8 | 0xEA | 0xEC..=0xED | 0xFE) {
        return Ok(None);
    }
    let Some(missing) = Missing::decode(instruction) else {
        return Ok(None);
    };
    let pc = core.regs.pc();
    let state = core.it_state();
    if state & 0xF != 0 {
        // The crate skips an instruction without looking at it. It alone can go on to the next one of the block.
        if !core.regs.condition_passed(state >> 4) {
            return Ok(None);
        }
        bail!("{missing:?} at {pc:#010x} is executed in an IT block, which is not modelled");
    }
    let cycles = missing.execute(core, bus)?;
    core.regs.set_pc(pc.wrapping_add(4));
    Ok(Some(cycles))
}

impl Missing {
    fn execute<B: CoreBus>(self, core: &mut CortexM33, bus: &mut B) -> Result<u64> {
        let number = core.id();
        match self {
            Self::Exclusive => bail!("an exclusive access at {:#010x} that also orders others is not modelled", core.regs.pc()),
            Self::Load { width, to, address } => {
                let address = aligned(core.regs.r[address], width)?;
                core.regs.r[to] = match width {
                    1 => bus.read8(address, number).into(),
                    2 => bus.read16(address, number).into(),
                    _ => bus.read32(address, number),
                };
                Ok(2)
            }
            Self::Store { width, from, address } => {
                let (address, value) = (aligned(core.regs.r[address], width)?, core.regs.r[from]);
                match width {
                    1 => bus.write8(address, value as u8, number),
                    2 => bus.write16(address, value as u16, number),
                    _ => bus.write32(address, value, number),
                }
                Ok(2)
            }
            Self::Pack { to, first, second, shift, bottom_first } => {
                let (first, second) = (core.regs.r[first], core.regs.r[second]);
                core.regs.r[to] = if bottom_first {
                    second << shift & 0xFFFF_0000 | first & 0xFFFF
                } else {
                    // A shift by 32 is written as 0; it leaves the same as one by 31.
                    let shift = if shift == 0 { 31 } else { shift };
                    first & 0xFFFF_0000 | (second as i32 >> shift) as u32 & 0xFFFF
                };
                Ok(1)
            }
            Self::Select { condition, to, first, second } => {
                use_float(core)?;
                core.regs.s[to] = core.regs.s[if core.regs.condition_passed(condition) { first } else { second }];
                Ok(1)
            }
            Self::Extreme { is_maximum, to, first, second } => {
                use_float(core)?;
                core.regs.s[to] = extreme(is_maximum, core.regs.s[first], core.regs.s[second])?;
                Ok(1)
            }
            Self::Transfer { is_push, first, count } => {
                use_float(core)?;
                let (stack, bytes) = (core.regs.r[13], 4 * count as u32);
                let start = if is_push { stack.wrapping_sub(bytes) } else { stack };
                for (register, address) in (first..first + count).zip((start..).step_by(4)) {
                    if is_push {
                        bus.write32(address, core.regs.s[register].to_bits(), number);
                    } else {
                        core.regs.s[register] = f32::from_bits(bus.read32(address, number));
                    }
                }
                core.regs.r[13] = if is_push { start } else { stack.wrapping_add(bytes) };
                Ok(1 + count as u64)
            }
        }
    }
}

/// The address, if an access of this width is allowed there.
fn aligned(address: u32, width: u32) -> Result<u32> {
    ensure!(
        address.is_multiple_of(width),
        "an ordered access of {width} bytes at {address:#010x} is not aligned: the chip would refuse it"
    );
    Ok(address)
}

/// Access to the floating-point registers, which later exceptions then have to save.
fn use_float(core: &mut CortexM33) -> Result<()> {
    /// Full access in the register CPACR.
    const ACCESS: u32 = 0xF << 20;
    /// Registers of an interrupted program are still to be saved, in FPCCR.
    const SAVING: u32 = 1;
    /// Denormal numbers are zero, or all NaN are the same, in FPSCR.
    const MODES: u32 = 0b11 << 24;
    /// The program uses floating point, in CONTROL.
    const USED: u32 = 1 << 2;
    let pc = core.regs.pc();
    ensure!(core.ppb.cpacr & ACCESS == ACCESS, "the instruction at {pc:#010x} uses floating point, which is not enabled");
    ensure!(core.ppb.fpccr & SAVING == 0 && core.regs.fpscr & MODES == 0, "floating point at {pc:#010x} in a state that is not modelled");
    core.regs.control |= USED;
    Ok(())
}

/// The larger or the smaller number. A quiet NaN is no number.
fn extreme(is_maximum: bool, first: f32, second: f32) -> Result<f32> {
    /// The bit of a NaN that makes it quiet.
    const QUIET: u32 = 1 << 22;
    let signals = |value: f32| value.is_nan() && value.to_bits() & QUIET == 0;
    ensure!(
        !(signals(first) || signals(second) || first.is_nan() && second.is_nan()),
        "the maximum or minimum of {first:?} and {second:?} is not modelled"
    );
    let takes_first = match first.partial_cmp(&second) {
        None => second.is_nan(),
        // Of two zeros the positive one is larger.
        Some(order) => order.is_eq() && first.is_sign_positive() == is_maximum || order.is_gt() == is_maximum && order.is_ne(),
    };
    Ok(if takes_first { first } else { second })
}

#[cfg(test)]
mod tests {
    use super::*;
    use rp2350_emu::{Bus, threaded::CoreAtomics};
    use std::sync::Arc;

    const RAM: u32 = 0x2000_0000;
    /// Full access to floating point.
    const ACCESS: u32 = 0xF << 20;

    fn machine() -> (CortexM33, Bus) {
        let atomics = Arc::new(CoreAtomics::default());
        let mut core = CortexM33::new(0, Arc::clone(&atomics));
        core.ppb.cpacr = ACCESS;
        core.regs.set_pc(RAM);
        (core, Bus::with_atomics(atomics))
    }

    /// Executes an instruction, which must be one of those above.
    fn executes(core: &mut CortexM33, bus: &mut Bus, instruction: [u16; 2]) {
        core.regs.set_pc(RAM);
        let cycles = execute(core, bus, instruction).expect("an instruction that is modelled");
        assert!(cycles.is_some(), "{instruction:04x?} is left to the crate");
        assert_eq!(core.regs.pc(), RAM + 4);
    }

    fn refusal(core: &mut CortexM33, bus: &mut Bus, instruction: [u16; 2]) -> String {
        let before = core.regs.r;
        let told = execute(core, bus, instruction).expect_err("a refusal").to_string();
        assert_eq!(core.regs.r, before);
        told
    }

    #[test]
    fn ordered_loads_and_stores() {
        let (mut core, mut bus) = machine();
        bus.write32(RAM + 0x100, 0x8899_AABB, 0);
        bus.write32(RAM + 0x104, 0x1234_5678, 0);
        core.regs.r[2] = RAM + 0x100;
        // lda r1, [r2]; ldab r1, [r2]; ldah r9, [r2]
        for (instruction, register, value) in
            [([0xE8D2, 0x1FAF], 1, 0x8899_AABB), ([0xE8D2, 0x1F8F], 1, 0xBB), ([0xE8D2, 0x9F9F], 9, 0xAABB)]
        {
            core.regs.r[3] = 0x55;
            executes(&mut core, &mut bus, instruction);
            assert_eq!((core.regs.r[register], core.regs.r[2], core.regs.r[3]), (value, RAM + 0x100, 0x55));
        }
        core.regs.r[1] = 0x0102_0304;
        core.regs.r[9] = 0x0506_0708;
        // stlb r1, [r2]; stlh r9, [r2]; stl r1, [r2]
        for (instruction, value) in [([0xE8C2, 0x1F8F], 0x8899_AA04), ([0xE8C2, 0x9F9F], 0x8899_0708), ([0xE8C2, 0x1FAF], 0x0102_0304)] {
            executes(&mut core, &mut bus, instruction);
            assert_eq!([0x100, 0x104].map(|offset| bus.read32(RAM + offset, 0)), [value, 0x1234_5678]);
        }
        core.regs.r[2] += 1;
        assert!(refusal(&mut core, &mut bus, [0xE8D2, 0x1FAF]).contains("not aligned"));
    }

    #[test]
    fn exclusive_ordered_accesses_are_refused() {
        let (mut core, mut bus) = machine();
        // ldaex, ldaexb, stlex, stlexh
        for instruction in [[0xE8D2, 0x1FEF], [0xE8D2, 0x1FCF], [0xE8C2, 0x1FE3], [0xE8C2, 0x1FD3]] {
            assert!(refusal(&mut core, &mut bus, instruction).contains("exclusive"));
        }
    }

    #[test]
    fn exclusive_accesses_are_known() {
        // ldrex r1, [r2]; strex r3, r1, [r2]; ldrexb r1, [r2]; ldrexh r1, [r2]; strexb r3, r1, [r2]; strexh r3, r1, [r2]
        for instruction in [[0xE852, 0x1F00], [0xE842, 0x1300], [0xE8D2, 0x1F4F], [0xE8D2, 0x1F5F], [0xE8C2, 0x1F43], [0xE8C2, 0x1F53]] {
            assert!(is_exclusive(instruction), "{instruction:04x?}");
        }
        // tt r1, [r2]; tbb [r1, r2]; tbh [r1, r2, lsl #1]; lda r1, [r2]; strd r1, r3, [r2]
        for instruction in [[0xE842, 0xF100], [0xE8D1, 0xF002], [0xE8D1, 0xF012], [0xE8D2, 0x1FAF], [0xE9C2, 0x1300]] {
            assert!(!is_exclusive(instruction), "{instruction:04x?}");
        }
    }

    #[test]
    fn halves_are_packed() {
        let (mut core, mut bus) = machine();
        (core.regs.r[1], core.regs.r[2]) = (0x1111_2222, 0x8765_4321);
        // pkhbt r3, r1, r2; the same with lsl #20; pkhtb r3, r1, r2, asr #4; asr #32
        for (instruction, value) in [
            ([0xEAC1, 0x0302], 0x8765_2222),
            ([0xEAC1, 0x5302], 0x3210_2222),
            ([0xEAC1, 0x1322], 0x1111_5432),
            ([0xEAC1, 0x0322], 0x1111_FFFF),
        ] {
            executes(&mut core, &mut bus, instruction);
            assert_eq!(core.regs.r[..4], [0, 0x1111_2222, 0x8765_4321, value]);
        }
    }

    #[test]
    fn registers_are_selected_by_the_flags() {
        let (n, z, v) = (1 << 31, 1 << 30, 1 << 28);
        // vseleq s3, s4, s5; vselvs s2, s5, s4; vselge s31, s0, s1; vselgt s0, s31, s30; and the flags with which they take the first.
        for (instruction, [to, first, second], takes_first) in [
            ([0xFE42, 0x1A22], [3, 4, 5], [z, z | n, z | v, z | n | v].as_slice()),
            ([0xFE12, 0x1A82], [2, 5, 4], &[v, v | n, v | z, n | z | v]),
            ([0xFE60, 0xFA20], [31, 0, 1], &[0, z, n | v, n | z | v]),
            ([0xFE3F, 0x0A8F], [0, 31, 30], &[0, n | v]),
        ] {
            for flags in (0..16).map(|flags| flags << 28) {
                let (mut core, mut bus) = machine();
                core.regs.s = std::array::from_fn(|k| k as f32);
                core.regs.xpsr |= flags;
                executes(&mut core, &mut bus, instruction);
                let mut expected: [f32; 32] = std::array::from_fn(|k| k as f32);
                // The carry does not count.
                let chosen = if takes_first.contains(&(flags & !(1 << 29))) { first } else { second };
                expected[to] = chosen as f32;
                assert_eq!(core.regs.s, expected, "{instruction:04x?} with flags {flags:08x}");
            }
        }
    }

    #[test]
    fn extremes_are_numbers() {
        let nan = f32::NAN;
        // vmaxnm s3, s4, s5; vminnm s2, s5, s4
        for (first, second, larger, smaller) in [
            (1.0, 2.0, 2.0, 1.0),
            (-1.0, -2.0, -1.0, -2.0),
            (0.0, -0.0, 0.0, -0.0),
            (-0.0, 0.0, 0.0, -0.0),
            (nan, 3.0, 3.0, 3.0),
            (3.0, nan, 3.0, 3.0),
            (f32::INFINITY, f32::MIN, f32::INFINITY, f32::MIN),
            (5.0, 5.0, 5.0, 5.0),
        ] {
            let (mut core, mut bus) = machine();
            (core.regs.s[4], core.regs.s[5]) = (first, second);
            executes(&mut core, &mut bus, [0xFEC2, 0x1A22]);
            executes(&mut core, &mut bus, [0xFE82, 0x1AC2]);
            let bits = |values: &[f32]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
            assert_eq!(bits(&core.regs.s[2..4]), bits(&[smaller, larger]), "{first} and {second}");
        }
        let (mut core, mut bus) = machine();
        for (first, second) in [(nan, nan), (f32::from_bits(0x7F80_0001), 1.0)] {
            (core.regs.s[4], core.regs.s[5]) = (first, second);
            assert!(refusal(&mut core, &mut bus, [0xFEC2, 0x1A22]).contains("not modelled"));
        }
    }

    #[test]
    fn double_registers_go_to_the_stack_and_back() {
        let (mut core, mut bus) = machine();
        core.regs.r[13] = RAM + 0x200;
        core.regs.s = std::array::from_fn(|k| k as f32);
        // vpush {d8-d15}
        executes(&mut core, &mut bus, [0xED2D, 0x8B10]);
        assert_eq!(core.regs.r[13], RAM + 0x1C0);
        for (k, address) in (16..32_u8).zip((RAM + 0x1C0..).step_by(4)) {
            assert_eq!(bus.read32(address, 0), f32::from(k).to_bits());
        }
        assert_eq!([RAM + 0x1BC, RAM + 0x200].map(|address| bus.read32(address, 0)), [0, 0]);
        core.regs.s = [0.0; 32];
        // vpop {d8-d15}
        executes(&mut core, &mut bus, [0xECBD, 0x8B10]);
        assert_eq!(core.regs.r[13], RAM + 0x200);
        assert_eq!(core.regs.s, std::array::from_fn(|k| if k < 16 { 0.0 } else { k as f32 }));
        core.ppb.cpacr = 0;
        assert!(refusal(&mut core, &mut bus, [0xED2D, 0x8B10]).contains("not enabled"));
    }

    #[test]
    fn other_instructions_are_left_to_the_crate() {
        let (mut core, mut bus) = machine();
        for instruction in [
            [0xE852, 0x1F00], // ldrex r1, [r2]
            [0xE842, 0x1300], // strex r3, r1, [r2]
            [0xE8F2, 0x1302], // ldrd r1, r3, [r2], #8
            [0xE9D2, 0x1302], // ldrd r1, r3, [r2, #8]
            [0xE9E2, 0x1302], // strd r1, r3, [r2, #8]!
            [0xE8D1, 0xF002], // tbb [r1, r2]
            [0xED2D, 0x8A02], // vpush {s16-s17}
            [0xFEFC, 0x0AC1], // vcvta.s32.f32 s1, s2
            [0xFEF8, 0x0A41], // vrinta.f32 s1, s2
            [0x4770, 0x0000], // bx lr
        ] {
            assert_eq!(execute(&mut core, &mut bus, instruction).expect("left alone"), None, "{instruction:04x?}");
            assert_eq!(core.regs.pc(), RAM);
        }
    }

    /// In a block of `it eq`: refused where the condition holds, and skipped by the crate where it does not.
    #[test]
    fn blocks_of_conditions_are_refused_or_skipped() {
        for equal in [true, false] {
            let (mut core, mut bus) = machine();
            // it eq; pkhbteq r3, r1, r2
            for (offset, half) in [0xBF08, 0xEAC1, 0x0302].into_iter().enumerate() {
                bus.write16(RAM + 2 * offset as u32, half, 0);
            }
            core.regs.set_flag_z(equal);
            (core.regs.r[1], core.regs.r[2], core.regs.r[3]) = (1, 2, 3);
            core.step(&mut bus);
            let pack = [0xEAC1, 0x0302];
            if equal {
                assert!(refusal(&mut core, &mut bus, pack).contains("IT block"));
            } else {
                assert_eq!(execute(&mut core, &mut bus, pack).expect("left alone"), None);
                core.step(&mut bus);
                assert_eq!((core.regs.pc(), core.regs.r[3], core.it_state()), (RAM + 6, 3, 0));
            }
        }
    }
}
