//! Writes what `cobra_agreement::vectors` reads.

/// A `.points` file of a camera's K, poses' R and t, and correspondences' pixel, point and weight.
#[must_use]
pub fn points_file(camera: &[f32; 9], poses: &[[f32; 12]], rows: &[[f32; 6]]) -> Vec<u8> {
    let count = |n: usize| (n as u32).to_le_bytes().to_vec();
    let numbers = |all: &[f32]| {
        let bytes = all.iter().flat_map(|x| x.to_le_bytes());
        bytes.collect::<Vec<u8>>()
    };
    [
        numbers(camera),
        count(poses.len()),
        numbers(poses.as_flattened()),
        count(rows.len()),
        numbers(rows.as_flattened()),
    ]
    .concat()
}
