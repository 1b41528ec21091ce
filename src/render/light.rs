//! Linear colours, premultiplied by their opacity.

use crate::lattice::Each;
use core::ops::{Add, Mul};
use glam::{DVec3, Vec4};

/// Red, green, blue and opacity, 0 to 1. The colours are linear, and premultiplied by the opacity.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Light(pub(super) Vec4);

impl Light {
    /// No light.
    pub const NONE: Light = Light(Vec4::ZERO);

    /// The light of an sRGB colour and an opacity, 0 to 255.
    pub fn of(rgba: [u8; 4]) -> Light {
        let [r, g, b] = [rgba[0], rgba[1], rgba[2]].each(linear);
        let a = f32::from(rgba[3]) / 255.0;
        Light(Vec4::new(r * a, g * a, b * a, a))
    }

    /// This light in front of another one.
    pub fn over(self, behind: Light) -> Light {
        Light(self.0 + behind.0 * (1.0 - self.0.w))
    }

    /// The colour times a brightness, with the same opacity.
    pub fn lit(self, brightness: f32) -> Light {
        Light((self.0.truncate() * brightness).extend(self.0.w))
    }
}

/// A table that converts light to bytes.
pub struct Tones {
    /// For each byte, the least light that becomes at least this byte.
    from: [f32; 256],
}

impl Tones {
    /// The tones of sRGB (IEC 61966-2-1).
    #[allow(clippy::new_without_default)]
    pub fn new() -> Tones {
        let mut from = [0.0; 256];
        for (byte, from) in from.iter_mut().enumerate().skip(1) {
            *from = linear_of((byte as f32 - 0.5) / 255.0);
        }
        Tones { from }
    }

    /// Converts light to sRGB and opacity, 0 to 255.
    pub fn rgba(&self, light: Light) -> [u8; 4] {
        let a = light.0.w;
        if a <= 0.0 {
            return [0; 4];
        }
        let byte = |x: f32| (self.from.partition_point(|&from| from <= x).max(1) - 1) as u8;
        let [r, g, b] = [light.0.x, light.0.y, light.0.z].each(|x| byte(x / a));
        [r, g, b, (a.clamp(0.0, 1.0) * 255.0 + 0.5) as u8]
    }
}

impl Add for Light {
    type Output = Light;

    fn add(self, other: Light) -> Light {
        Light(self.0 + other.0)
    }
}

impl Mul<f32> for Light {
    type Output = Light;

    fn mul(self, by: f32) -> Light {
        Light(self.0 * by)
    }
}

/// The light of each byte.
const LINEAR: [f32; 256] = {
    let mut light = [0.0; 256];
    let mut byte = 0;
    while byte < 256 {
        let x = byte as f64 / 255.0;
        light[byte] = if x <= 0.04045 { x / 12.92 } else { power_2_4((x + 0.055) / 1.055) } as f32;
        byte += 1;
    }
    light
};

/// x^2.4 for x from 0.01 to 1: the fifth root of x^12, by Newton's iteration from above.
const fn power_2_4(x: f64) -> f64 {
    let (square, mut root) = (x * x, x * x);
    let mut step = 0;
    while step < 20 {
        let fourth = root * root * root * root;
        root -= (root - square * square * square * square * square * square / fourth) / 5.0;
        step += 1;
    }
    root
}

fn linear(byte: u8) -> f32 {
    LINEAR[byte as usize]
}

/// The light of an sRGB value, 0 to 1 (IEC 61966-2-1).
fn linear_of(x: f32) -> f32 {
    if x <= 0.04045 { x / 12.92 } else { libm::powf((x + 0.055) / 1.055, 2.4) }
}

/// The lights of a picture: a lamp on the upper left behind the camera, a weaker lamp on the right, and some
/// ambient light, so that no side is black.
#[derive(Debug, Clone, Copy)]
pub struct Lamps {
    /// The unit directions to the lamps.
    key: DVec3,
    fill: DVec3,
    up: DVec3,
}

impl Lamps {
    /// The lamps of a camera with these directions.
    pub fn new(right: DVec3, up: DVec3, forward: DVec3) -> Lamps {
        let lamp = |x: f64, y: f64, z: f64| (right * x + up * y - forward * z).normalize();
        Lamps { key: lamp(-0.5, 0.7, 0.75), fill: lamp(0.8, 0.1, 0.6), up }
    }

    /// The brightness of a matt surface with an outward normal, of any length, that is seen in a direction. A
    /// surface that is seen from behind is lit as if it faced the camera.
    pub fn brightness(&self, normal: DVec3, along: DVec3) -> f32 {
        let normal = normal.normalize_or_zero();
        let normal = if normal.dot(along) > 0.0 { -normal } else { normal };
        let (key, fill) = (self.key.dot(normal).max(0.0), self.fill.dot(normal).max(0.0));
        // An upward-facing surface gets more of the ambient light.
        let sky = 0.5 + 0.5 * self.up.dot(normal);
        (0.05 + 0.09 * sky + 0.8 * key + 0.16 * fill) as f32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_are_as_light_as_the_formula_says() {
        for byte in 0..=255u8 {
            let expected = linear_of(f32::from(byte) / 255.0);
            assert!((linear(byte) - expected).abs() <= 1e-6 * expected, "{byte}");
        }
    }

    #[test]
    fn colours_come_back() {
        let tones = Tones::new();
        for byte in 0..=255u8 {
            let colour = [byte, 255 - byte, byte / 2, 255];
            assert_eq!(tones.rgba(Light::of(colour)), colour);
        }
        assert_eq!(tones.rgba(Light::of([9, 9, 9, 0])), [0; 4]);
        let half = tones.rgba(Light::of([200, 100, 50, 128]));
        assert_eq!(half, [200, 100, 50, 128]);
    }

    #[test]
    fn what_is_opaque_hides() {
        let (red, blue) = (Light::of([255, 0, 0, 255]), Light::of([0, 0, 255, 255]));
        assert_eq!(red.over(blue), red);
        assert_eq!(Light::NONE.over(blue), blue);
        assert_eq!((red * 0.5).over(Light::NONE), red * 0.5);
    }
}
