//! What is checked of a pointer before it is used, and the handles that live in the caller's memory.
//!
//! That a pointer is not NULL, is aligned, and does not wrap around the address space can be
//! checked. That memory really lies behind it cannot: this is what every function of the interface
//! asks of its caller, and what the safety comments mean by "the caller's promise".
#![allow(unsafe_code, reason = "raw pointers come from C")]

use crate::status::CobraStatus;
use cobra_infer::depth::Cell;
use core::ffi::c_void;
use core::ptr;

/// A structure in memory of the caller's. Its seal tells it from memory that holds anything else,
/// zeros for instance.
pub(crate) trait Handle: Sized {
    /// What it holds besides its seal.
    type Content;
    /// What the seal of a made handle is.
    const SEAL: u32;
    /// Where the seal, a `u32`, lies in it.
    const SEAL_OFFSET: usize;
    /// Where the content lies in it.
    const CONTENT_OFFSET: usize;
}

/// A range of addresses.
#[derive(Clone, Copy)]
pub(crate) struct Region {
    start: usize,
    end: usize,
}

impl Region {
    pub(crate) fn new<T>(start: *const T, bytes: usize) -> Result<Self, CobraStatus> {
        let start = start.addr();
        // No object is larger than isize::MAX, and Rust relies on it.
        if bytes > isize::MAX.unsigned_abs() {
            return Err(CobraStatus::LengthTooLarge);
        }
        let end = start.checked_add(bytes);
        let end = end.ok_or(CobraStatus::LengthTooLarge)?;
        Ok(Self { start, end })
    }

    /// Of a slice.
    pub(crate) fn of<T>(slice: &[T]) -> Result<Self, CobraStatus> {
        Self::new(slice.as_ptr(), size_of_val(slice))
    }

    fn overlaps(self, other: Self) -> bool {
        self.start < other.end && other.start < self.end
    }
}

/// Not NULL, and aligned.
fn usable<T>(pointer: *const T) -> Result<(), CobraStatus> {
    if pointer.is_null() {
        Err(CobraStatus::NullPointer)
    } else if pointer.is_aligned() {
        Ok(())
    } else {
        Err(CobraStatus::Misaligned)
    }
}

/// Reads a structure of which every bit pattern is a value.
///
/// # Safety
/// `pointer` is NULL, misaligned, or points to a `T` of which every bit pattern is valid.
pub(crate) unsafe fn read<T: Copy>(pointer: *const T) -> Result<T, CobraStatus> {
    usable(pointer)?;
    // SAFETY: not NULL, aligned, and the caller's promise.
    Ok(unsafe { pointer.read() })
}

/// Writes through a pointer; what was there before is not looked at.
///
/// # Safety
/// `pointer` is NULL, misaligned, or points to memory for a `T` that may be written.
pub(crate) unsafe fn write<T: Copy>(pointer: *mut T, value: T) -> Result<(), CobraStatus> {
    usable(pointer)?;
    // SAFETY: not NULL, aligned, and the caller's promise.
    unsafe { pointer.write(value) };
    Ok(())
}

/// Like [`write`], but NULL says that the value is not wanted.
///
/// # Safety
/// As [`write`].
pub(crate) unsafe fn write_optional<T: Copy>(pointer: *mut T, value: T) -> Result<(), CobraStatus> {
    if pointer.is_null() {
        return Ok(());
    }
    // SAFETY: as this function's.
    unsafe { write(pointer, value) }
}

/// An array.
///
/// # Safety
/// `pointer` is NULL, misaligned, or points to `count` values of which every bit pattern is valid
/// and that nobody changes for as long as the slice is used.
pub(crate) unsafe fn slice<'a, T: Copy>(
    pointer: *const T,
    count: usize,
) -> Result<&'a [T], CobraStatus> {
    usable(pointer)?;
    let bytes = count.checked_mul(size_of::<T>());
    Region::new(pointer, bytes.ok_or(CobraStatus::LengthTooLarge)?)?;
    // SAFETY: not NULL, aligned, no larger than an object may be, and the caller's promise.
    Ok(unsafe { core::slice::from_raw_parts(pointer, count) })
}

fn seal<H: Handle>(handle: *const H) -> *mut u32 {
    handle
        .wrapping_byte_add(H::SEAL_OFFSET)
        .cast::<u32>()
        .cast_mut()
}

/// # Safety
/// `handle` is NULL, misaligned, or points to initialised memory of a handle's size.
unsafe fn sealed<H: Handle>(handle: *const H) -> Result<(), CobraStatus> {
    usable(handle)?;
    // SAFETY: inside that memory, at a place aligned for a `u32`.
    if unsafe { seal(handle).read() } == H::SEAL {
        Ok(())
    } else {
        Err(CobraStatus::NotReady)
    }
}

/// A handle to read from.
///
/// # Safety
/// `handle` is NULL, misaligned, or points to initialised memory of a handle's size; where that
/// holds a handle, nobody changes it meanwhile and what it borrows is still there.
pub(crate) unsafe fn open<'a, H: Handle>(handle: *const H) -> Result<&'a H, CobraStatus> {
    // SAFETY: the caller's promise.
    unsafe { sealed(handle) }?;
    // SAFETY: the seal says that `fill` put a handle there; the rest is the caller's promise.
    Ok(unsafe { &*handle })
}

/// A handle to change.
///
/// # Safety
/// As [`open`], and nobody reads the handle meanwhile.
pub(crate) unsafe fn open_mut<'a, H: Handle>(handle: *mut H) -> Result<&'a mut H, CobraStatus> {
    // SAFETY: the caller's promise.
    unsafe { sealed(handle.cast_const()) }?;
    // SAFETY: as in `open`.
    Ok(unsafe { &mut *handle })
}

/// Memory of the caller's that a handle is about to be put into, and where to tell of it.
pub(crate) struct Claimed<H> {
    place: *mut H,
    out: *mut *mut H,
}

/// Takes the caller's memory for a handle. Until [`fill`], it holds none, whatever it held before.
///
/// `argument` is what the handle will borrow, which the memory must not overlap.
///
/// # Safety
/// `memory` is NULL, misaligned, or points to `size` bytes that may be written, also when [`fill`]
/// is called; `out` as in [`write`], also then.
pub(crate) unsafe fn claim<H: Handle>(
    memory: *mut c_void,
    size: usize,
    out: *mut *mut H,
    argument: Region,
) -> Result<Claimed<H>, CobraStatus> {
    let place = memory.cast::<H>();
    usable(place.cast_const())?;
    if size < size_of::<H>() {
        return Err(CobraStatus::MemoryTooSmall);
    }
    let region = Region::new(place, size_of::<H>())?;
    if region.overlaps(argument) || region.overlaps(Region::new(out, size_of::<*mut H>())?) {
        return Err(CobraStatus::Overlap);
    }
    // SAFETY: inside the memory, which is aligned, large enough and, the caller's promise, writable.
    unsafe { seal(place).write(0) };
    Ok(Claimed { place, out })
}

/// Takes the caller's memory for `count` cells, which then hold nothing.
///
/// # Safety
/// `memory` is NULL, misaligned, or points to `size` bytes that may be written and that nobody else uses for
/// as long as the slice is used.
pub(crate) unsafe fn scratch<'a>(
    memory: *mut c_void,
    size: usize,
    count: usize,
    borrowed: &[Region],
) -> Result<&'a mut [Cell], CobraStatus> {
    let place = memory.cast::<Cell>();
    usable(place.cast_const())?;
    let bytes = count
        .checked_mul(size_of::<Cell>())
        .ok_or(CobraStatus::LengthTooLarge)?;
    if size < bytes {
        return Err(CobraStatus::MemoryTooSmall);
    }
    let region = Region::new(place, bytes)?;
    if borrowed.iter().any(|other| region.overlaps(*other)) {
        return Err(CobraStatus::Overlap);
    }
    for index in 0..count {
        // SAFETY: inside the memory, which is aligned and large enough, and the caller's promise.
        unsafe { place.add(index).write(Cell::EMPTY) };
    }
    // SAFETY: just initialised; the rest is the caller's promise.
    Ok(unsafe { core::slice::from_raw_parts_mut(place, count) })
}

/// Copies what was built into the claimed memory, seals the handle and tells its caller of it.
///
/// What was built is copied from inside its `Result`: moved out of it first, it would lie on the
/// stack once more.
///
/// # Safety
/// `claimed` is of [`claim`], whose promise still holds.
pub(crate) unsafe fn fill<H: Handle, E: Copy + Into<CobraStatus>>(
    claimed: Claimed<H>,
    built: Result<H::Content, E>,
) -> Result<(), CobraStatus> {
    let content = match &built {
        Ok(content) => ptr::from_ref(content),
        Err(error) => return Err((*error).into()),
    };
    let Claimed { place, out } = claimed;
    let to = place
        .wrapping_byte_add(H::CONTENT_OFFSET)
        .cast::<H::Content>();
    // By part, because a whole handle would first be put together on the stack.
    // SAFETY: inside the memory that was claimed, which overlaps no variable of this library's.
    unsafe { to.copy_from_nonoverlapping(content, 1) };
    // It lives on there.
    core::mem::forget(built);
    // SAFETY: as above.
    unsafe { seal(place).write(H::SEAL) };
    // SAFETY: the caller's promise.
    unsafe { write(out, place) }
}

/// Sets a handle's pointer to NULL before anything can fail.
///
/// # Safety
/// As [`write`].
pub(crate) unsafe fn clear<H: Handle>(out: *mut *mut H) -> Result<(), CobraStatus> {
    // SAFETY: as this function's.
    unsafe { write(out, ptr::null_mut()) }
}

/// What C gets.
pub(crate) fn status(outcome: Result<(), CobraStatus>) -> CobraStatus {
    match outcome {
        Ok(()) => CobraStatus::Ok,
        Err(status) => status,
    }
}
