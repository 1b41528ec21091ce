//! Smaller copies of pictures.

use leafless::render::{Light, Picture, Tones};
use std::borrow::Cow;

/// A picture without depths: red, green, blue (sRGB) and opacity of each pixel, row by row from the upper
/// left corner. Colours are not multiplied by the opacity.
pub struct Image<'a> {
    pub width: usize,
    pub height: usize,
    pub pixels: Cow<'a, [[u8; 4]]>,
}

impl<'a> From<&'a Picture> for Image<'a> {
    fn from(picture: &'a Picture) -> Image<'a> {
        let [width, height] = [picture.width(), picture.height()].map(|side| side as usize);
        Image { width, height, pixels: Cow::Borrowed(picture.colours()) }
    }
}

/// Returns the largest size of the same shape, up to rounding, that fits into the area. A size that fits is
/// returned as it is.
pub fn fitted(size: [usize; 2], area: [usize; 2]) -> [usize; 2] {
    if size[0] <= area[0] && size[1] <= area[1] {
        return size;
    }
    let scale = (area[0] as f64 / size[0] as f64).min(area[1] as f64 / size[1] as f64);
    [0, 1].map(|axis| ((size[axis] as f64 * scale).round() as usize).clamp(1, area[axis].max(1)))
}

impl Image<'_> {
    /// Returns the image in a size that is nowhere larger. Each pixel is the mean of the pixels that it
    /// covers, in linear light, weighted by area and opacity.
    pub fn shrunk(self, [width, height]: [usize; 2]) -> Self {
        if [width, height] == [self.width, self.height] {
            return self;
        }
        let tones = Tones::new();
        let mut pixels = Vec::with_capacity(width * height);
        let mut sums = vec![Light::NONE; width];
        for y in 0..height {
            sums.fill(Light::NONE);
            for (row, part) in covered(y, height, self.height) {
                let row = &self.pixels[row * self.width..][..self.width];
                for (x, sum) in sums.iter_mut().enumerate() {
                    for (column, share) in covered(x, width, self.width) {
                        *sum = *sum + Light::of(row[column]) * (part * share);
                    }
                }
            }
            // A pixel that is almost transparent has no colour.
            let pixel = |sum: &Light| Some(tones.rgba(*sum)).filter(|rgba| rgba[3] > 0).unwrap_or([0; 4]);
            pixels.extend(sums.iter().map(pixel));
        }
        Image { width, height, pixels: Cow::Owned(pixels) }
    }
}

/// Returns the pixels, of `from` pixels, that pixel `i` of `to` pixels covers, with their shares in it.
fn covered(i: usize, to: usize, from: usize) -> impl Iterator<Item = (usize, f32)> {
    // In units of 1/to of a pixel, whole numbers.
    let (start, end) = (i * from, (i + 1) * from);
    (start / to..end.div_ceil(to)).map(move |pixel| {
        let overlap = end.min((pixel + 1) * to) - start.max(pixel * to);
        (pixel, overlap as f32 / from as f32)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_fit_and_keep_their_shape() {
        for (size, area, expected) in [
            ([40, 30], [80, 42], [40, 30]),
            ([1024, 768], [80, 42], [56, 42]),
            ([1000, 10], [80, 42], [80, 1]),
            ([1, 16384], [80, 42], [1, 42]),
            ([3, 3], [0, 0], [1, 1]),
        ] {
            assert_eq!(fitted(size, area), expected);
        }
    }

    #[test]
    fn pixels_are_means_of_light() {
        // Half of the light of white is the sRGB value 188; a transparent pixel has no part in the colour.
        let (white, black, none) = ([255; 4], [0, 0, 0, 255], [9, 8, 7, 0]);
        let of = |pixels: Vec<[u8; 4]>, width, size| {
            let height = pixels.len() / width;
            Image { width, height, pixels: Cow::Owned(pixels) }.shrunk(size).pixels.into_owned()
        };
        assert_eq!(of(vec![white, black, black, white], 2, [1, 1]), [[188, 188, 188, 255]]);
        assert_eq!(of(vec![white, none, none, none], 2, [1, 2]), [[255, 255, 255, 128], [0; 4]]);
        // Three pixels on two: the middle one is shared.
        let thirds = of(vec![white, black, black], 3, [2, 1]);
        // 255 (1.055 (2/3)^(1/2.4) − 0.055) = 213.2
        assert_eq!(thirds, [[213, 213, 213, 255], [0, 0, 0, 255]]);
    }
}
