//! PNG files of depth and masks.
//!
//! Owns which forms of PNG are read. Images are checked before they are decoded.

use super::DatasetError;
use crate::demo::RgbImage;
use crate::depth_image::DepthImage;
use crate::input::ImageSize;
use crate::pixel_mask::PixelMask;
use png::{BitDepth, ColorType, Transformations};
use std::fs::File;
use std::io::BufReader;
use std::path::Path;

/// A depth image: 16-bit grey of the expected size, each value times `scale` in millimetres.
///
/// # Errors
/// [`DatasetError`]: no such file, another size than `size`, or no 16-bit grey PNG.
pub fn read_depth(path: &Path, size: ImageSize, scale: f32) -> Result<DepthImage, DatasetError> {
    let bytes = read(path, size, BitDepth::Sixteen)?;
    let values = bytes.as_chunks::<2>().0.iter();
    let depths = values.map(|value| f32::from(u16::from_be_bytes(*value)) * scale);
    Ok(DepthImage::new(size, depths.collect()))
}

/// A mask: 8-bit grey of the expected size; what is not 0 is in.
///
/// # Errors
/// [`DatasetError`]: no such file, another size than `size`, or no 8-bit grey PNG.
pub fn read_mask(path: &Path, size: ImageSize) -> Result<PixelMask, DatasetError> {
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
///
/// # Errors
/// [`DatasetError`]: no such file, or no PNG.
pub fn size_of(path: &Path) -> Result<ImageSize, DatasetError> {
    let reader = open(path, || "a PNG image".to_owned(), Transformations::IDENTITY)?;
    let found = size(reader.info());
    if !found.is_held() {
        return Err(DatasetError::Image {
            path: path.to_owned(),
            expected: format!(
                "an image of at most {} pixels a side",
                ImageSize::LARGEST_SIDE
            ),
            found: format!("one of {found}"),
        });
    }
    Ok(found)
}

/// A photograph of the expected size: a PNG of any kind, in 8 bits a channel; transparency does not count.
///
/// # Errors
/// [`DatasetError`]: no such file, another size than `expected`, or no PNG.
pub fn read_photo(path: &Path, expected: ImageSize) -> Result<RgbImage, DatasetError> {
    let described = || format!("PNG of {expected}");
    let transformations = Transformations::EXPAND | Transformations::STRIP_16;
    let mut reader = open(path, described, transformations)?;
    let found = size(reader.info());
    let refused = |found: String| DatasetError::Image {
        path: path.to_owned(),
        expected: described(),
        found,
    };
    if found != expected {
        return Err(refused(format!("PNG of {found}")));
    }
    let bytes = frame(&mut reader).map_err(refused)?;
    let channels = reader.output_color_type().0.samples();
    let pixels = bytes.chunks_exact(channels).flat_map(|pixel| match pixel {
        [red, green, blue] | [red, green, blue, _] => [*red, *green, *blue],
        [grey, ..] => [*grey; 3],
        [] => [0; 3],
    });
    Ok(RgbImage {
        width: expected.width,
        height: expected.height,
        pixels: pixels.collect(),
    })
}

fn read(path: &Path, expected: ImageSize, depth: BitDepth) -> Result<Vec<u8>, DatasetError> {
    let described = || describe(ColorType::Grayscale, depth, expected);
    let mut reader = open(path, described, Transformations::IDENTITY)?;
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
    frame(&mut reader).map_err(refused)
}

/// The decoded bytes, or what is wrong with them.
fn frame(reader: &mut png::Reader<BufReader<File>>) -> Result<Vec<u8>, String> {
    let count = reader.output_buffer_size();
    let mut bytes = vec![0; count.ok_or_else(|| "one too large for memory".to_owned())?];
    let frame = reader
        .next_frame(&mut bytes)
        .map_err(|error| error.to_string())?;
    bytes.truncate(frame.buffer_size());
    Ok(bytes)
}

fn open(
    path: &Path,
    expected: impl Fn() -> String,
    transformations: Transformations,
) -> Result<png::Reader<BufReader<File>>, DatasetError> {
    let file = File::open(path).map_err(|source| DatasetError::io(path, source))?;
    let mut decoder = png::Decoder::new(BufReader::new(file));
    decoder.set_transformations(transformations);
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
