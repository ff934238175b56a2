//! Directions on a grid, and weights with a scale: five bytes a term instead of sixteen.
//!
//! Owns what the numbers of such a term mean; the sum over them is that of all terms. They are used
//! as they lie in the file: the query is multiplied by [`GRID`] once, and the component's length scale
//! and whatever else its kernel compares with distances or products are in grid steps, so that a term
//! costs no operation more.

/// Grid steps in a unit: a direction's coordinates are whole numbers of 1/127, from −127 to 127.
pub const GRID: f32 = 127.0;

/// Least squared length of a direction in grid steps; rounding each coordinate of a unit vector moves
/// it by less than one step.
const LEAST_SQUARED_NORM: i32 = 126 * 126;

/// Largest squared length of a direction in grid steps.
const LARGEST_SQUARED_NORM: i32 = 128 * 128;

/// Bytes of a term: three coordinates and a weight.
pub(crate) const TERM_LENGTH: usize = 5;

/// The squared length in grid steps.
pub(crate) fn squared_norm(direction: [i8; 3]) -> i32 {
    let [x, y, z] = direction.map(i32::from);
    x * x + y * y + z * z
}

/// Whether it is a unit vector on the grid.
pub(crate) fn is_unit(direction: [i8; 3]) -> bool {
    let norm = squared_norm(direction);
    (LEAST_SQUARED_NORM..=LARGEST_SQUARED_NORM).contains(&norm) && !direction.contains(&i8::MIN)
}
