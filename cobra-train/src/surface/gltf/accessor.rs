//! The numbers that a glTF accessor describes.
//!
//! Owns every step from a count, offsets and a stride to bytes, none of which are to be trusted.

use gltf::Accessor;
use gltf::accessor::sparse::IndexType;
use gltf::accessor::{DataType, Dimensions};
use gltf::buffer::View;

use super::super::content::{BadContent, Place};
use super::buffers::Buffers;

/// Reads accessors for a primitive, whose place errors name.
pub(super) struct AccessorReader<'a> {
    pub(super) buffers: &'a Buffers<'a>,
    pub(super) place: Place,
}

impl AccessorReader<'_> {
    /// The vectors of an accessor of positions; integers are read too, as KHR_mesh_quantization
    /// has them.
    pub(super) fn positions(&self, accessor: &Accessor<'_>) -> Result<Vec<[f64; 3]>, BadContent> {
        if accessor.dimensions() != Dimensions::Vec3 || accessor.data_type() == DataType::U32 {
            let found = format!("{:?} of {:?}", accessor.dimensions(), accessor.data_type());
            return Err(self.bad("positions as vectors of 3", found));
        }
        let number = DataType::size(&accessor.data_type());
        self.elements(accessor, |bytes| {
            let mut position = [0.0; 3];
            for (c, bytes) in position.iter_mut().zip(bytes.chunks_exact(number)) {
                *c = component(accessor.data_type(), accessor.normalized(), bytes);
            }
            position
        })
    }

    /// The vertex indices of an accessor of indices.
    pub(super) fn indices(&self, accessor: &Accessor<'_>) -> Result<Vec<u32>, BadContent> {
        let unsigned = matches!(
            accessor.data_type(),
            DataType::U8 | DataType::U16 | DataType::U32
        );
        if accessor.dimensions() != Dimensions::Scalar || !unsigned {
            let found = format!("{:?} of {:?}", accessor.dimensions(), accessor.data_type());
            return Err(self.bad("indices as unsigned integers", found));
        }
        self.elements(accessor, little_endian)
    }

    fn elements<T: Clone + Default>(
        &self,
        accessor: &Accessor<'_>,
        read: impl Fn(&[u8]) -> T,
    ) -> Result<Vec<T>, BadContent> {
        let (count, size) = (accessor.count(), accessor.size());
        let sparse = accessor.sparse();
        let mut elements = match accessor.view() {
            Some(view) => self
                .strided(&view, accessor.offset(), count, size)?
                .map(&read)
                .collect(),
            None if sparse.is_some() => vec![T::default(); count],
            None => {
                let expected = format!("data for accessor {}", accessor.index());
                return Err(self.bad(&expected, "none; compressed geometry is not read"));
            }
        };
        let Some(sparse) = sparse else {
            return Ok(elements);
        };
        let indices = sparse.indices();
        let width = match indices.index_type() {
            IndexType::U8 => 1,
            IndexType::U16 => 2,
            IndexType::U32 => 4,
        };
        let places = self.strided(&indices.view(), indices.offset(), sparse.count(), width)?;
        let values = sparse.values();
        let values = self.strided(&values.view(), values.offset(), sparse.count(), size)?;
        for (place, value) in places.map(little_endian).zip(values.map(&read)) {
            let element = elements.get_mut(place as usize).ok_or_else(|| {
                let expected = format!("sparse indices below {count}");
                self.bad(&expected, place.to_string())
            })?;
            *element = value;
        }
        Ok(elements)
    }

    /// `count` elements of `size` bytes in a view.
    fn strided<'s>(
        &'s self,
        view: &View<'_>,
        offset: usize,
        count: usize,
        size: usize,
    ) -> Result<impl Iterator<Item = &'s [u8]> + use<'s>, BadContent> {
        let stride = view.stride().unwrap_or(size);
        let bytes = (|| {
            let end = match count {
                0 => offset,
                _ => (count - 1)
                    .checked_mul(stride)?
                    .checked_add(size)?
                    .checked_add(offset)?,
            };
            let whole = self
                .buffers
                .slice(view.buffer().index(), view.offset(), view.length())?;
            whole.get(offset..end)
        })();
        let bytes = bytes.ok_or_else(|| {
            let expected = format!(
                "{count} elements of {size} bytes in buffer view {}",
                view.index()
            );
            self.bad(
                &expected,
                format!("a view of {} bytes, or a shorter buffer", view.length()),
            )
        })?;
        Ok((0..count).map(move |i| &bytes[i * stride..i * stride + size]))
    }

    fn bad(&self, expected: &str, found: impl std::fmt::Display) -> BadContent {
        BadContent::new(Some(self.place), expected, found)
    }
}

/// An unsigned integer of up to four bytes.
fn little_endian(bytes: &[u8]) -> u32 {
    bytes
        .iter()
        .rev()
        .fold(0, |number, &byte| number << 8 | u32::from(byte))
}

fn component(data_type: DataType, normalized: bool, bytes: &[u8]) -> f64 {
    let unsigned = little_endian(bytes);
    let (value, most) = match data_type {
        DataType::I8 => (f64::from(unsigned as u8 as i8), f64::from(i8::MAX)),
        DataType::U8 => (f64::from(unsigned), f64::from(u8::MAX)),
        DataType::I16 => (f64::from(unsigned as u16 as i16), f64::from(i16::MAX)),
        DataType::U16 => (f64::from(unsigned), f64::from(u16::MAX)),
        DataType::U32 => (f64::from(unsigned), f64::from(u32::MAX)),
        DataType::F32 => return f64::from(f32::from_bits(unsigned)),
    };
    if normalized {
        (value / most).max(-1.0)
    } else {
        value
    }
}
