use super::*;
use crate::depth::MeshSurface;
use crate::depth_image::DepthImage;
use crate::input::ImageSize;
use crate::surface::Mesh;
use cobra_infer::depth::{DepthSettings, Thresholds};
use cobra_infer::{Camera, Pose, Unit};
use nalgebra::Point3;

const SIZE: ImageSize = ImageSize {
    width: 64,
    height: 48,
};

/// A square card of 40 mm, at z = 0.
fn card() -> MeshSurface {
    let corners = [[-20., -20.], [20., -20.], [20., 20.], [-20., 20.]];
    let corners = corners.map(|[x, y]| Point3::new(x, y, 0.0)).to_vec();
    let mesh = Mesh::new(corners, vec![[0, 1, 2], [0, 2, 3]]).unwrap();
    MeshSurface::new(&mesh, 4.0, 0)
}

/// The card put 200 mm in front of the camera, where the image is `depth` millimetres away everywhere.
fn at(depth: f32) -> OverlayEstimate {
    let camera = Camera::new(160.0, 160.0, 31.5, 23.5).unwrap();
    let identity = [1., 0., 0., 0., 1., 0., 0., 0., 1.];
    let pose = Pose::from_row_major(identity, [0.0, 0.0, 200.0]).unwrap();
    let pixels = (SIZE.width * SIZE.height) as usize;
    let image = DepthImage::new(SIZE, vec![depth; pixels]);
    let settings = DepthSettings {
        thresholds: Some(Thresholds {
            accept: 0.6,
            reject: 0.3,
        }),
        ..DepthSettings::DEFAULT
    };
    let evidence = Evidence {
        camera: &camera,
        depth: &image,
        pixels: None,
        most: 500,
    };
    let name = "card".to_owned();
    let unit = Unit::Millimetre;
    OverlayEstimate::of(name, &card(), unit, &pose, &settings, &evidence).unwrap()
}

fn picture(estimates: &[OverlayEstimate]) -> RgbImage {
    let photo = RgbImage::filled(SIZE.width, SIZE.height, [120; 3]);
    draw(&Overlay {
        photo: &photo,
        estimates,
        subtitle: "a card",
        limit: None,
    })
    .unwrap()
}

/// How many pixels of a picture are clearly blue, and clearly red.
fn coloured(image: &RgbImage) -> [usize; 2] {
    let pixels = image.pixels.as_chunks::<3>().0;
    let blue = |p: &&[u8; 3]| p[2] > p[0].saturating_add(60);
    let red = |p: &&[u8; 3]| p[0] > p[2].saturating_add(60);
    [
        pixels.iter().filter(blue).count(),
        pixels.iter().filter(red).count(),
    ]
}

#[test]
fn what_is_seen_in_front_is_blue_behind_is_red_and_where_it_must_be_is_neither() {
    let right = coloured(&picture(&[at(200.0)]));
    let front = coloured(&picture(&[at(193.0)]));
    let behind = coloured(&picture(&[at(207.0)]));
    assert!(front[0] > right[0] + 50_000, "{right:?} {front:?}");
    assert!(behind[1] > right[1] + 50_000, "{right:?} {behind:?}");
}

#[test]
fn the_same_estimates_draw_the_same_bytes_and_several_have_a_page_of_their_own() {
    let one = [at(200.0)];
    let single = picture(&one);
    assert_eq!((single.width, single.height), (1600, 784));
    assert_eq!(single, picture(&one));
    let several = picture(&[at(200.0), at(230.0), at(150.0)]);
    assert_eq!(several.width, 1600);
    assert_ne!(several.height, single.height);
    let nothing = draw(&Overlay {
        photo: &single,
        estimates: &[],
        subtitle: "",
        limit: None,
    });
    assert!(matches!(nothing, Err(PictureError::NoPoses)));
}

#[test]
fn the_residuals_are_millimetres_behind_or_in_front_and_silence_is_told() {
    let map = at(203.0).residuals;
    assert!(map.surface.len() > 200, "{}", map.surface.len());
    assert!(map.pixels.len() > 200, "{}", map.pixels.len());
    for (pixel, residual) in &map.pixels {
        assert_eq!(pixel.depth, 203.0);
        let distance = residual.unwrap().distance;
        assert!((2.9..5.0).contains(&distance), "{distance}");
    }
    let csv = map.csv();
    let lines: Vec<&str> = csv.lines().collect();
    assert_eq!(lines[0], "kind,column,row,depth,seen,residual");
    assert_eq!(lines.len(), 1 + map.surface.len() + map.pixels.len());
    assert!(lines.iter().any(|line| line.starts_with("surface,")));
    assert!(lines[1].starts_with("pixel,") && lines[1].contains(",203.000,surface,"));
    let hidden = at(150.0).residuals.csv();
    assert!(
        hidden
            .lines()
            .skip(1)
            .all(|line| line.contains(",hidden,-"))
    );
    let through = at(f32::INFINITY).residuals;
    assert!(through.csv().contains(",through,inf"));
    assert!(
        through
            .pixels
            .iter()
            .all(|(_, residual)| residual.is_none())
    );
}
