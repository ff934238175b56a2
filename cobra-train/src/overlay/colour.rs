//! What colour a residual has.
//!
//! Owns the diverging map: ColorBrewer's RdBu of nine classes (C. Brewer, colorbrewer2.org), blue to white to
//! red, which is told apart with every common kind of colour blindness.

/// From −1, the camera's side, to 1.
const STOPS: [[f32; 3]; 9] = [
    [33.0, 102.0, 172.0],
    [67.0, 147.0, 195.0],
    [146.0, 197.0, 222.0],
    [209.0, 229.0, 240.0],
    [247.0, 247.0, 247.0],
    [253.0, 219.0, 199.0],
    [244.0, 165.0, 130.0],
    [214.0, 96.0, 77.0],
    [178.0, 24.0, 43.0],
];

/// The colour of a share of the limit: blue below 0, in front; red above, behind; the ends' beyond ±1.
pub(super) fn diverging(share: f32) -> [u8; 3] {
    let steps = (STOPS.len() - 1) as f32;
    let at = 0.5 * (share.clamp(-1.0, 1.0) + 1.0) * steps;
    let below = (at.floor() as usize).min(STOPS.len() - 2);
    let part = at - below as f32;
    std::array::from_fn(|i| {
        let (low, high) = (STOPS[below][i], STOPS[below + 1][i]);
        (low + (high - low) * part).round() as u8
    })
}

/// `over` with this opacity over `under`.
pub(super) fn blend(under: [u8; 3], over: [u8; 3], opacity: f32) -> [u8; 3] {
    std::array::from_fn(|i| {
        let (low, high) = (f32::from(under[i]), f32::from(over[i]));
        (low + (high - low) * opacity).round() as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn in_front_is_blue_behind_is_red_and_nothing_is_nearly_white() {
        let [red, _, blue] = diverging(-1.0);
        assert!(blue > red + 100);
        let [red, _, blue] = diverging(1.0);
        assert!(red > blue + 100);
        assert_eq!(diverging(0.0), [247; 3]);
        assert_eq!(diverging(-7.0), diverging(-1.0));
        assert_eq!(diverging(f32::INFINITY), diverging(1.0));
    }

    #[test]
    fn equal_residuals_of_either_sign_are_about_equally_strong() {
        let strength = |colour: [u8; 3]| {
            let [red, green, blue] = colour.map(f32::from);
            0.2126 * red + 0.7152 * green + 0.0722 * blue
        };
        for share in [0.25, 0.5, 0.75, 1.0] {
            let (front, behind) = (strength(diverging(-share)), strength(diverging(share)));
            assert!((front - behind).abs() < 45.0, "{share}: {front} {behind}");
        }
    }
}
