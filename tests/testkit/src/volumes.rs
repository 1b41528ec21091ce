//! Items shared by the tests of volumes: samples of all kinds, and the same samples as dense arrays.

use super::Random;
use leafless::solid::{Band, Samples, VoxelGrid};

/// Samples of one kind as doubles.
#[derive(Clone)]
pub struct Sampled {
    pub extents: [u32; 3],
    pub kind: usize,
    pub values: Vec<f64>,
}

/// The number of kinds: bits, `u8`, `u16`, `i16` and `f32`.
pub const KINDS: usize = 5;

impl Sampled {
    /// Generates blobs, so that some blocks are uniform, with noise, and in single precision with NaN,
    /// infinities and −0.
    pub fn random(random: &mut Random, extents: [u32; 3], kind: usize) -> Sampled {
        let blobs: Vec<([f64; 3], f64)> = (0..1 + random.below(3))
            .map(|_| (extents.map(|extent| random.between(0.0, extent.into())), random.between(2.0, 30.0)))
            .collect();
        let noise = [0.0, 0.0, 1.0, 50.0][random.below(4) as usize];
        let odd = kind == 4 && random.below(2) == 0;
        let mut values = Vec::new();
        for z in 0..extents[2] {
            for y in 0..extents[1] {
                for x in 0..extents[0] {
                    let field = blobs.iter().map(|(middle, radius)| {
                        let square =
                            [x, y, z].into_iter().zip(middle).map(|(c, m)| (f64::from(c) - m).powi(2));
                        radius - square.sum::<f64>().sqrt()
                    });
                    let value = 128.0 + 8.0 * field.fold(f64::NEG_INFINITY, f64::max);
                    let value = value + random.between(-noise, noise);
                    values.push(match kind {
                        0 => f64::from(u8::from(value >= 128.0)),
                        1 => value.round().clamp(0.0, 255.0),
                        2 => (100.0 * value).round().clamp(0.0, 65535.0),
                        3 => (100.0 * value - 10_000.0).round().clamp(-32768.0, 32767.0),
                        _ if odd && random.below(40) == 0 => {
                            [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -0.0][random.below(4) as usize]
                        }
                        _ => f64::from((value / 128.0) as f32),
                    });
                }
            }
        }
        Sampled { extents, kind, values }
    }

    /// Returns the samples in the form that a volume takes.
    pub fn samples(&self) -> Samples<'static> {
        let values = self.values.iter();
        match self.kind {
            0 => Samples::Bits(self.bits(|value| value == 1.0).into()),
            1 => values.map(|&value| value as u8).collect::<Vec<_>>().into(),
            2 => values.map(|&value| value as u16).collect::<Vec<_>>().into(),
            3 => values.map(|&value| value as i16).collect::<Vec<_>>().into(),
            _ => values.map(|&value| value as f32).collect::<Vec<_>>().into(),
        }
    }

    /// Returns one bit for each sample, in rows of words. Unused bits are set.
    pub fn bits(&self, is_set: impl Fn(f64) -> bool) -> Vec<u64> {
        let rows = self.values.chunks(self.extents[0] as usize);
        rows.flat_map(|row| {
            row.chunks(64).map(|few| {
                let word = few.iter().enumerate().fold(0, |word, (i, &v)| word | u64::from(is_set(v)) << i);
                if few.len() < 64 { word | !0 << few.len() } else { word }
            })
        })
        .collect()
    }

    /// Returns a random band of values.
    pub fn band(&self, random: &mut Random) -> Band {
        let (middle, width) = match self.kind {
            0 => (0.5, 0.5),
            1 => (128.0, 40.0),
            2 => (12_800.0, 4000.0),
            3 => (2800.0, 4000.0),
            _ => (1.0, 0.3),
        };
        match random.below(5) {
            0 => Band::at_most(middle),
            1 => Band::between(middle - random.between(0.0, width), middle + random.between(0.0, width)),
            2 => Band::between(middle + 0.25, middle + 0.25),
            3 => Band::at_least(f64::NEG_INFINITY),
            _ => Band::at_least(middle),
        }
        .unwrap()
    }

    pub fn at(&self, at: [u32; 3]) -> Option<f64> {
        let [x, y, z] = at.map(|a| a as usize);
        let [nx, ny, nz] = self.extents.map(|extent| extent as usize);
        (x < nx && y < ny && z < nz).then(|| self.values[(z * ny + y) * nx + x])
    }

    /// Returns whether a voxel is inside. Voxels beyond the grid are outside.
    pub fn contains(&self, band: &Band, at: [u32; 3]) -> bool {
        self.at(at).is_some_and(|value| band.low() <= value && value <= band.high())
    }

    pub fn count(&self, band: &Band) -> u64 {
        self.values.iter().filter(|&&value| band.low() <= value && value <= band.high()).count() as u64
    }
}

/// Returns random extents up to `most`, or of 16. Some are very small, and some are a whole block.
pub fn extents(random: &mut Random, most: u64) -> [u32; 3] {
    [0; 3].map(|_| match random.below(6) {
        0 => 1 + random.below(3) as u32,
        1 => 16,
        _ => 1 + random.below(most) as u32,
    })
}

/// Returns a random grid. Its voxels are cubes if `cubes` is set.
pub fn grid(random: &mut Random, extents: [u32; 3], cubes: bool) -> VoxelGrid {
    let corner = [0; 3].map(|_| random.between(-20.0, 20.0));
    let spacing = [0; 3].map(|_| random.between(0.3, 2.0));
    VoxelGrid::new(extents, corner, if cubes { [spacing[0]; 3] } else { spacing }).unwrap()
}
