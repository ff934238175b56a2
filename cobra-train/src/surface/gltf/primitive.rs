//! The triangles that a glTF primitive's indices stand for.
//!
//! Owns the three ways of listing triangles.

use gltf::mesh::Mode;

/// What a primitive is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shape {
    Points,
    Triangles,
    Strip,
    Fan,
}

impl Shape {
    /// None for lines.
    pub(super) fn of(mode: Mode) -> Option<Self> {
        match mode {
            Mode::Points => Some(Self::Points),
            Mode::Triangles => Some(Self::Triangles),
            Mode::TriangleStrip => Some(Self::Strip),
            Mode::TriangleFan => Some(Self::Fan),
            Mode::Lines | Mode::LineLoop | Mode::LineStrip => None,
        }
    }

    /// The triangles of `corners`, all turned the same way; what is left over is no triangle.
    pub(super) fn triangles(self, corners: &[u32], triangles: &mut Vec<[u32; 3]>) {
        match self {
            Self::Points => {}
            Self::Triangles => {
                triangles.extend(corners.chunks_exact(3).map(|t| [t[0], t[1], t[2]]));
            }
            Self::Strip => {
                let turned = corners.windows(3).enumerate().map(|(i, t)| match i % 2 {
                    0 => [t[0], t[1], t[2]],
                    _ => [t[1], t[0], t[2]],
                });
                triangles.extend(turned);
            }
            Self::Fan => {
                if let [first, rest @ ..] = corners {
                    triangles.extend(rest.windows(2).map(|edge| [*first, edge[0], edge[1]]));
                }
            }
        }
    }
}
