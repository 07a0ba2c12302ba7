//! The floating-point mode that results are promised for: rounding to nearest, denormal numbers kept.
//!
//! Other libraries of the process may have told the processor to flush them to zero, and a new thread starts in the mode
//! of the one that made it; the bits of a result must not depend on that.

// Only here: the control register is out of the reach of safe code.
#![allow(unsafe_code)]

/// Restores the caller's mode when it goes.
#[derive(Debug)]
pub struct Standard {
    before: u64,
}

impl Standard {
    /// Sets the mode of this thread.
    pub fn set() -> Self {
        let before = register::read();
        register::write(register::STANDARD | (before & register::OTHERS));
        Standard { before }
    }
}

impl Drop for Standard {
    fn drop(&mut self) {
        register::write(self.before);
    }
}

#[cfg(target_arch = "x86_64")]
mod register {
    use std::arch::asm;

    /// Every exception masked, to nearest, no flushing.
    pub const STANDARD: u64 = 0x1F80;

    /// Bits to be left as they are: none.
    pub const OTHERS: u64 = 0;

    pub fn read() -> u64 {
        let mut mode = 0u32;
        // SAFETY: stores the 32 bits of MXCSR where the pointer points.
        unsafe { asm!("stmxcsr [{}]", in(reg) &mut mode, options(nostack, preserves_flags)) };
        u64::from(mode)
    }

    pub fn write(mode: u64) {
        let mode = mode as u32;
        // SAFETY: the value is the standard one, in which compiled code expects to run, or was read from the register.
        unsafe { asm!("ldmxcsr [{}]", in(reg) &mode, options(nostack, preserves_flags, readonly)) };
    }
}

#[cfg(target_arch = "aarch64")]
mod register {
    use std::arch::asm;

    /// To nearest, no flushing, default NaN off.
    pub const STANDARD: u64 = 0;

    /// All but AHP, DN, FZ, the rounding mode, and FZ16.
    pub const OTHERS: u64 = !0x07C8_0000;

    pub fn read() -> u64 {
        let mode: u64;
        // SAFETY: reads a register.
        unsafe { asm!("mrs {}, fpcr", out(reg) mode, options(nomem, nostack, preserves_flags)) };
        mode
    }

    pub fn write(mode: u64) {
        // SAFETY: the value is the standard one, in which compiled code expects to run, or was read from the register.
        unsafe { asm!("msr fpcr, {}", in(reg) mode, options(nomem, nostack, preserves_flags)) };
    }
}

#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
mod register {
    pub const STANDARD: u64 = 0;
    pub const OTHERS: u64 = 0;

    pub fn read() -> u64 {
        0
    }

    pub fn write(_mode: u64) {}
}
