//! The functions of MPI that are called, with the types and constants of its standard ABI (MPI 5.0, appendix A).

use crate::failure::Failure;
use libloading::Library;
use std::ffi::{c_char, c_int, c_void};
use std::mem::ManuallyDrop;
use std::ptr;

/// `MPI_Comm`, `MPI_Datatype`, `MPI_Request`: pointers to what only MPI knows, whose named values are small integers.
type Handle = *mut c_void;
/// `MPI_Count`.
type Count = i64;

const WORLD: usize = 0x101;
const BYTE: usize = 0x247;
/// `MPI_THREAD_SERIALIZED`: from any thread, one at a time.
const SERIALIZED: c_int = 2048;
/// `MPI_MAX_LIBRARY_VERSION_STRING`.
const VERSION_BYTES: usize = 8192;

fn handle(of: usize) -> Handle {
    ptr::without_provenance_mut(of)
}

/// `MPI_Status`: source, tag, error and five numbers that are MPI's own.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Status([c_int; 8]);

/// Something on its way.
#[repr(transparent)]
#[derive(Debug)]
pub(super) struct Request(Handle);

/// Declares the functions that are looked up.
macro_rules! functions {
    ($($name:ident: $symbol:literal ($($argument:ty),*);)*) => {
        /// Addresses in the library, which is never unloaded: what MPI registered to run at the end of the process is in it.
        pub(super) struct Abi {
            $($name: unsafe extern "C" fn($($argument),*) -> c_int,)*
            library: ManuallyDrop<Library>,
        }

        impl Abi {
            /// The functions of a library, whose path is a name or one that the loader looks for.
            pub(super) fn load(path: &str) -> Result<Abi, String> {
                // SAFETY: what runs when an MPI is loaded is trusted as the MPI is
                let library = unsafe { Library::new(path) }.map_err(|e| e.to_string())?;
                $(
                    // SAFETY: a symbol of this name has this type in the standard ABI
                    let $name = *unsafe { library.get(concat!("MPI_", $symbol).as_bytes()) }.map_err(|e| e.to_string())?;
                )*
                Ok(Abi { $($name,)* library: ManuallyDrop::new(library) })
            }
        }
    };
}

functions! {
    abi_version: "Abi_get_version" (*mut c_int, *mut c_int);
    init_thread: "Init_thread" (*mut c_int, *mut *mut *mut c_char, c_int, *mut c_int);
    finalize: "Finalize" ();
    abort: "Abort" (Handle, c_int);
    comm_rank: "Comm_rank" (Handle, *mut c_int);
    comm_size: "Comm_size" (Handle, *mut c_int);
    library_version: "Get_library_version" (*mut c_char, *mut c_int);
    isend: "Isend_c" (*const c_void, Count, Handle, c_int, c_int, Handle, *mut Handle);
    irecv: "Irecv_c" (*mut c_void, Count, Handle, c_int, c_int, Handle, *mut Handle);
    waitall: "Waitall" (c_int, *mut Handle, *mut Status);
    get_count: "Get_count_c" (*const Status, Handle, *mut Count);
}

// SAFETY: addresses of functions and a library; MPI is started for calls from any thread, one at a time
unsafe impl Send for Abi {}
// SAFETY: a handle of MPI's own, which is no address of this thread
unsafe impl Send for Request {}

impl std::fmt::Debug for Abi {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("Abi").field(&self.library).finish()
    }
}

/// What a function returned. (Most failures end all processes before they return: that is MPI's default, which stays.)
fn done(code: c_int, what: &str) -> Result<(), Failure> {
    match code {
        0 => Ok(()),
        _ => Err(Failure::Mpi(format!("{what} failed with code {code}"))),
    }
}

impl Abi {
    /// Is it this ABI? `MPI_Abi_get_version` may be called before MPI is started.
    pub(super) fn known(&self) -> Result<(), String> {
        let (mut major, mut minor) = (0, 0);
        // SAFETY: two numbers to write to
        let code = unsafe { (self.abi_version)(&mut major, &mut minor) };
        match (code, major) {
            (0, 1) => Ok(()),
            _ => Err(format!("its ABI has version {major}.{minor}, not 1")),
        }
    }

    pub(super) fn init(&self) -> Result<(), Failure> {
        let mut provided = 0;
        // SAFETY: both lists of arguments may be null
        let code = unsafe {
            (self.init_thread)(ptr::null_mut(), ptr::null_mut(), SERIALIZED, &mut provided)
        };
        done(code, "MPI_Init_thread")?;
        if provided < SERIALIZED {
            self.finalize();
            let message = "it cannot be called from more than one thread (MPI_THREAD_SERIALIZED)";
            return Err(Failure::Mpi(message.into()));
        }
        Ok(())
    }

    /// The end of MPI; that of the process follows, so there is nobody to tell of a failure.
    pub(super) fn finalize(&self) {
        // SAFETY: MPI was started
        unsafe { (self.finalize)() };
    }

    pub(super) fn abort(&self, code: c_int) {
        // SAFETY: MPI was started
        unsafe { (self.abort)(handle(WORLD), code) };
    }

    pub(super) fn rank(&self) -> Result<usize, Failure> {
        let mut rank = 0;
        // SAFETY: MPI was started; a number to write to
        done(
            unsafe { (self.comm_rank)(handle(WORLD), &mut rank) },
            "MPI_Comm_rank",
        )?;
        Ok(rank as usize)
    }

    pub(super) fn ranks(&self) -> Result<usize, Failure> {
        let mut ranks = 0;
        // SAFETY: as above
        done(
            unsafe { (self.comm_size)(handle(WORLD), &mut ranks) },
            "MPI_Comm_size",
        )?;
        Ok(ranks as usize)
    }

    /// The first line of what the library says of itself.
    pub(super) fn version(&self) -> Result<String, Failure> {
        let mut text = vec![0u8; VERSION_BYTES];
        let mut bytes = 0;
        // SAFETY: as long as MPI says that it may become
        let code = unsafe { (self.library_version)(text.as_mut_ptr().cast(), &mut bytes) };
        done(code, "MPI_Get_library_version")?;
        text.truncate(bytes.max(0) as usize);
        let text = String::from_utf8_lossy(&text);
        let words = text.trim_end_matches('\0').lines().next().unwrap_or("");
        Ok(words.split_whitespace().collect::<Vec<_>>().join(" "))
    }

    /// # Safety
    /// The bytes stay, and nobody writes to them, until [`Abi::wait`] has returned.
    pub(super) unsafe fn send(
        &self,
        from: *const u8,
        bytes: usize,
        to: usize,
        tag: c_int,
    ) -> Result<Request, Failure> {
        let mut request = ptr::null_mut();
        // SAFETY: the caller's
        let code = unsafe {
            (self.isend)(
                from.cast(),
                bytes as Count,
                handle(BYTE),
                to as c_int,
                tag,
                handle(WORLD),
                &mut request,
            )
        };
        done(code, "MPI_Isend_c")?;
        Ok(Request(request))
    }

    /// # Safety
    /// The bytes stay, and nobody reads or writes them, until [`Abi::wait`] has returned.
    pub(super) unsafe fn receive(
        &self,
        into: *mut u8,
        bytes: usize,
        from: usize,
        tag: c_int,
    ) -> Result<Request, Failure> {
        let mut request = ptr::null_mut();
        // SAFETY: the caller's
        let code = unsafe {
            (self.irecv)(
                into.cast(),
                bytes as Count,
                handle(BYTE),
                from as c_int,
                tag,
                handle(WORLD),
                &mut request,
            )
        };
        done(code, "MPI_Irecv_c")?;
        Ok(Request(request))
    }

    /// Until all is done; a status for each request.
    pub(super) fn wait(
        &self,
        requests: &mut [Request],
        statuses: &mut [Status],
    ) -> Result<(), Failure> {
        assert_eq!(requests.len(), statuses.len());
        // SAFETY: a request is its handle; one status for each
        let code = unsafe {
            (self.waitall)(
                requests.len() as c_int,
                requests.as_mut_ptr().cast(),
                statuses.as_mut_ptr(),
            )
        };
        done(code, "MPI_Waitall")
    }

    /// Bytes that came.
    pub(super) fn count(&self, status: &Status) -> Result<usize, Failure> {
        let mut count = 0;
        // SAFETY: a status that MPI wrote
        done(
            unsafe { (self.get_count)(status, handle(BYTE), &mut count) },
            "MPI_Get_count_c",
        )?;
        Ok(count as usize)
    }
}
