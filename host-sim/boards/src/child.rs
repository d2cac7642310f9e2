//! Processes that this program starts, and the files that it hands to them. On Linux nothing of them is left, whatever ends it.

use anyhow::{Context, Result};
use rustix::io::{FdFlags, fcntl_setfd};
#[cfg(target_os = "linux")]
use rustix::process::{Pid, Signal, getppid, set_parent_process_death_signal};
use std::{
    fs,
    io::{self, Write},
    os::{
        fd::{AsRawFd, OwnedFd},
        unix::process::CommandExt,
    },
    path::PathBuf,
    process::Command,
};

/// A file that other processes open by its path. On Linux it has no name in any folder, and is gone when nobody has it open.
#[derive(Debug)]
pub struct Scratch {
    #[cfg(target_os = "linux")]
    file: fs::File,
    #[cfg(not(target_os = "linux"))]
    file: tempfile::NamedTempFile,
}

impl Scratch {
    /// A file with this content.
    ///
    /// # Errors
    /// When there is no room for it, or no folder for temporary files.
    pub fn new(content: &[u8]) -> Result<Self> {
        #[cfg(target_os = "linux")]
        let file = tempfile::tempfile();
        #[cfg(not(target_os = "linux"))]
        let file = tempfile::NamedTempFile::new();
        let mut file = file.context("cannot create a temporary file")?;
        file.write_all(content).context("cannot write a temporary file")?;
        Ok(Self { file })
    }

    /// The path at which the file can be opened while this value exists.
    #[must_use]
    pub fn path(&self) -> PathBuf {
        #[cfg(target_os = "linux")]
        return PathBuf::from(format!("/proc/{}/fd/{}", std::process::id(), self.file.as_raw_fd()));
        #[cfg(not(target_os = "linux"))]
        return self.file.path().to_owned();
    }

    /// The current contents of the file.
    ///
    /// # Errors
    /// When the file cannot be read.
    pub fn read(&self) -> Result<Vec<u8>> {
        fs::read(self.path()).context("cannot read a temporary file")
    }
}

/// Has the process of `command` end no later than the thread that starts it; on Linux, where the kernel sees to it.
pub fn bound(command: &mut Command) -> &mut Command {
    #[cfg(target_os = "linux")]
    {
        let parent = Pid::from_raw(std::process::id() as i32);
        // SAFETY: between fork and exec there are two system calls, and nothing that allocates or locks.
        unsafe {
            command.pre_exec(move || {
                set_parent_process_death_signal(Some(Signal::KILL))?;
                // It may have ended before.
                if getppid() == parent { Ok(()) } else { Err(io::ErrorKind::Interrupted.into()) }
            });
        }
    }
    command
}

/// Has the process of `command` inherit `descriptor`, under the number that is returned.
pub(crate) fn inherited(command: &mut Command, descriptor: OwnedFd) -> i32 {
    let number = descriptor.as_raw_fd();
    // SAFETY: between fork and exec there is one system call, and nothing that allocates or locks.
    unsafe {
        command.pre_exec(move || Ok(fcntl_setfd(&descriptor, FdFlags::empty())?));
    }
    number
}
