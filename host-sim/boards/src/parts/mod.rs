//! Parts that emulated boards share: flash, DMA, buses with time, displays that check how they are driven, a watchdog, and the log buffer.

pub(crate) mod alias;
pub(crate) mod dma;
pub(crate) mod flash;
pub(crate) mod i2c;
pub(crate) mod machine;
pub(crate) mod oled;
pub(crate) mod panel;
pub(crate) mod peripherals;
pub(crate) mod rtt;
pub(crate) mod spi;
pub(crate) mod waiting;
pub(crate) mod watchdog;
