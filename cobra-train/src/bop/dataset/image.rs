//! PNG files of depth and masks.
//!
//! Owns which forms of PNG are read. Images are checked before they are decoded.

use super::DatasetError;
use crate::depth_image::DepthImage;
use crate::input::ImageSize;
use crate::pixel_mask::PixelMask;
use png::{BitDepth, ColorType};
use std::fs::File;
use std::io::BufReader;
use std::path::Path;

/// A depth image: 16-bit grey of the expected size, each value times `scale` in millimetres.
pub(super) fn read_depth(
    path: &Path,
    size: ImageSize,
    scale: f32,
) -> Result<DepthImage, DatasetError> {
    let bytes = read(path, size, BitDepth::Sixteen)?;
    let values = bytes.as_chunks::<2>().0.iter();
    let depths = values.map(|value| f32::from(u16::from_be_bytes(*value)) * scale);
    Ok(DepthImage::new(size, depths.collect()))
}

/// A mask: 8-bit grey of the expected size; what is not 0 is in.
pub(super) fn read_mask(path: &Path, size: ImageSize) -> Result<PixelMask, DatasetError> {
    let bytes = read(path, size, BitDepth::Eight)?;
    Ok(PixelMask::new(
        size,
        bytes.iter().map(|value| *value != 0).collect(),
    ))
}

/// The mask of an annotated object in a folder of masks: `SSSSSS/mask_visib/IIIIII_GGGGGG.png`, as below a
/// split of a data set, or `SSSSSS/IIIIII_GGGGGG.png`.
///
/// # Errors
/// [`DatasetError`]: no such file, another size than `size`, or no 8-bit grey PNG.
pub fn mask_in(
    folder: &Path,
    scene: u32,
    image: u32,
    annotation: usize,
    size: ImageSize,
) -> Result<PixelMask, DatasetError> {
    let scene = folder.join(format!("{scene:06}"));
    let name = format!("{image:06}_{annotation:06}.png");
    let path = scene.join("mask_visib").join(&name);
    let beside = scene.join(name);
    if beside.exists() {
        return read_mask(&beside, size);
    }
    read_mask(&path, size)
}

/// The size that an image's header states.
pub(super) fn size_of(path: &Path) -> Result<ImageSize, DatasetError> {
    let reader = open(path, || "a PNG image".to_owned())?;
    Ok(size(reader.info()))
}

fn read(path: &Path, expected: ImageSize, depth: BitDepth) -> Result<Vec<u8>, DatasetError> {
    let described = || describe(ColorType::Grayscale, depth, expected);
    let mut reader = open(path, described)?;
    let refused = |found| DatasetError::Image {
        path: path.to_owned(),
        expected: described(),
        found,
    };
    let info = reader.info();
    let found = (info.color_type, info.bit_depth, size(info));
    if found != (ColorType::Grayscale, depth, expected) {
        return Err(refused(describe(found.0, found.1, found.2)));
    }
    let count = reader.output_buffer_size();
    let mut bytes = vec![0; count.ok_or_else(|| refused("one too large for memory".to_owned()))?];
    let frame = reader
        .next_frame(&mut bytes)
        .map_err(|error| refused(error.to_string()))?;
    bytes.truncate(frame.buffer_size());
    Ok(bytes)
}

fn open(
    path: &Path,
    expected: impl Fn() -> String,
) -> Result<png::Reader<BufReader<File>>, DatasetError> {
    let file = File::open(path).map_err(|source| DatasetError::io(path, source))?;
    let decoder = png::Decoder::new(BufReader::new(file));
    decoder.read_info().map_err(|error| match error {
        png::DecodingError::IoError(source)
            if source.kind() != std::io::ErrorKind::UnexpectedEof =>
        {
            DatasetError::io(path, source)
        }
        error => DatasetError::Image {
            path: path.to_owned(),
            expected: expected(),
            found: error.to_string(),
        },
    })
}

fn size(info: &png::Info<'_>) -> ImageSize {
    ImageSize {
        width: info.width,
        height: info.height,
    }
}

fn describe(colour: ColorType, depth: BitDepth, size: ImageSize) -> String {
    let colour = match colour {
        ColorType::Grayscale => "grey",
        ColorType::GrayscaleAlpha => "grey with alpha",
        ColorType::Rgb => "RGB",
        ColorType::Rgba => "RGBA",
        ColorType::Indexed => "palette",
    };
    format!("{}-bit {colour} PNG of {size}", depth as u8)
}
