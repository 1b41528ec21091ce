//! Exact arithmetic on doubles and lattice planes, and shapes by their definition. It is slow, and never
//! rounds.

use leafless::{Frame, Tag};
use num_bigint::{BigInt, Sign};

/// The number mantissa · 2^exponent. Every finite double is such a number, and so are sums, differences and
/// products of such numbers.
#[derive(Clone, Debug)]
pub struct Exact {
    mantissa: BigInt,
    exponent: i64,
}

impl From<f64> for Exact {
    fn from(x: f64) -> Exact {
        assert!(x.is_finite());
        let bits = x.to_bits();
        let (biased, fraction) = ((bits >> 52 & 0x7FF) as i64, bits & ((1 << 52) - 1));
        let (magnitude, exponent) =
            if biased == 0 { (fraction, -1074) } else { (fraction | 1 << 52, biased - 1075) };
        let mantissa = BigInt::from(magnitude);
        Exact { mantissa: if x < 0.0 { -mantissa } else { mantissa }, exponent }
    }
}

impl Exact {
    pub fn power_of_two(exponent: i64) -> Exact {
        Exact { mantissa: BigInt::from(1), exponent }
    }

    pub fn plus(&self, other: &Exact) -> Exact {
        let exponent = self.exponent.min(other.exponent);
        let at = |x: &Exact| &x.mantissa << (x.exponent - exponent) as usize;
        Exact { mantissa: at(self) + at(other), exponent }
    }

    pub fn minus(&self, other: &Exact) -> Exact {
        self.plus(&Exact { mantissa: -&other.mantissa, exponent: other.exponent })
    }

    pub fn times(&self, other: &Exact) -> Exact {
        Exact { mantissa: &self.mantissa * &other.mantissa, exponent: self.exponent + other.exponent }
    }

    pub fn sign(&self) -> i32 {
        match self.mantissa.sign() {
            Sign::Minus => -1,
            Sign::NoSign => 0,
            Sign::Plus => 1,
        }
    }

    pub fn max(self, other: Exact) -> Exact {
        if self.minus(&other).sign() >= 0 { self } else { other }
    }

    pub fn min(self, other: Exact) -> Exact {
        if self.minus(&other).sign() <= 0 { self } else { other }
    }

    /// Returns origin + k·edge/2^(depth+1) on an axis: a lattice plane for even k, a centre for odd k.
    pub fn half_plane(frame: &Frame, axis: usize, k: u32) -> Exact {
        let edge = Exact::from(frame.edge());
        let half = Exact { exponent: edge.exponent - frame.depth() as i64 - 1, ..edge };
        Exact::from(frame.origin()[axis]).plus(&Exact::from(k as f64).times(&half))
    }

    pub fn plane(frame: &Frame, axis: usize, i: u32) -> Exact {
        Exact::half_plane(frame, axis, 2 * i)
    }
}

/// A shape by its definition f(p) ≥ 0.
#[derive(Clone, Copy, Debug)]
pub enum Definition {
    Ball { centre: [f64; 3], radius: f64 },
    HalfSpace { normal: [f64; 3], offset: f64 },
    Box { min: [f64; 3], max: [f64; 3] },
}

impl Definition {
    /// Returns the best possible verdict on a finest cell.
    pub fn tag(&self, frame: &Frame, at: [u32; 3]) -> Tag {
        self.tag_between(frame, at, at.map(|i| i + 1))
    }

    /// Returns the best possible verdict on the cell between lattice planes.
    pub fn tag_between(&self, frame: &Frame, lower: [u32; 3], upper: [u32; 3]) -> Tag {
        let [low, high] =
            [lower, upper].map(|planes| [0, 1, 2].map(|axis| Exact::plane(frame, axis, planes[axis])));
        // The smallest and the greatest value of f over the closed cell.
        let (least, most) = match *self {
            Definition::Ball { centre, radius } => {
                let radius = Exact::from(radius);
                let mut least = radius.times(&radius);
                let mut most = least.clone();
                for axis in 0..3 {
                    let centre = Exact::from(centre[axis]);
                    let (a, b) = (low[axis].minus(&centre), high[axis].minus(&centre));
                    let (a2, b2) = (a.times(&a), b.times(&b));
                    if a.sign() * b.sign() > 0 {
                        most = most.minus(&a2.clone().min(b2.clone()));
                    }
                    least = least.minus(&a2.max(b2));
                }
                (least, most)
            }
            Definition::HalfSpace { normal, offset } => {
                let values = (0..8).map(|corner: usize| {
                    (0..3).fold(Exact::from(offset), |sum, axis| {
                        let x = if corner >> axis & 1 != 0 { &high[axis] } else { &low[axis] };
                        sum.plus(&Exact::from(normal[axis]).times(x))
                    })
                });
                let values: Vec<Exact> = values.collect();
                (
                    values.iter().cloned().reduce(Exact::min).unwrap(),
                    values.iter().cloned().reduce(Exact::max).unwrap(),
                )
            }
            Definition::Box { min, max } => {
                let mut inside = true;
                for axis in 0..3 {
                    let (min, max) = (Exact::from(min[axis]), Exact::from(max[axis]));
                    if max.minus(&low[axis]).sign() <= 0 || min.minus(&high[axis]).sign() >= 0 {
                        return Tag::Empty;
                    }
                    inside &= min.minus(&low[axis]).sign() <= 0 && max.minus(&high[axis]).sign() >= 0;
                }
                return if inside { Tag::Full } else { Tag::Partial };
            }
        };
        match (least.sign() >= 0, most.sign() <= 0) {
            (true, _) => Tag::Full,
            (_, true) => Tag::Empty,
            _ => Tag::Partial,
        }
    }

    /// Returns the sign of f at a point. For a box the sign is 1 inside, 0 on the boundary and −1 outside.
    fn sign(&self, point: &[Exact; 3]) -> i32 {
        match *self {
            Definition::Ball { centre, radius } => {
                let radius = Exact::from(radius);
                (0..3)
                    .fold(radius.times(&radius), |value, axis| {
                        let distance = point[axis].minus(&Exact::from(centre[axis]));
                        value.minus(&distance.times(&distance))
                    })
                    .sign()
            }
            Definition::HalfSpace { normal, offset } => (0..3)
                .fold(Exact::from(offset), |sum, axis| {
                    sum.plus(&Exact::from(normal[axis]).times(&point[axis]))
                })
                .sign(),
            Definition::Box { min, max } => (0..3)
                .flat_map(|axis| {
                    let above = point[axis].minus(&Exact::from(min[axis])).sign();
                    let below = Exact::from(max[axis]).minus(&point[axis]).sign();
                    [above, below]
                })
                .min()
                .unwrap(),
        }
    }

    /// Returns whether the centre of a finest cell lies inside. Centres on the boundary are shifted by an
    /// infinitesimal step in the direction (1, ε, ε²). Here the step is 2^-20000 long and ε is 2^-3000:
    /// smaller than any difference between doubles of moderate size, and so small that the square of the step
    /// is smaller still.
    pub fn sampled(&self, frame: &Frame, at: [u32; 3]) -> bool {
        let mut centre = [0, 1, 2].map(|axis| Exact::half_plane(frame, axis, 2 * at[axis] + 1));
        match self.sign(&centre) {
            0 => {
                for (axis, x) in centre.iter_mut().enumerate() {
                    *x = x.plus(&Exact::power_of_two(-20_000 - 3000 * axis as i64));
                }
                let sign = self.sign(&centre);
                assert_ne!(sign, 0);
                sign > 0
            }
            sign => sign > 0,
        }
    }

    /// Returns whether the shape ends inside of the universe.
    pub fn ends_inside(&self, frame: &Frame) -> bool {
        let bounds = |axis: usize| match *self {
            Definition::Ball { centre, radius } => {
                let (centre, radius) = (Exact::from(centre[axis]), Exact::from(radius));
                Some((centre.minus(&radius), centre.plus(&radius)))
            }
            Definition::Box { min, max } => Some((Exact::from(min[axis]), Exact::from(max[axis]))),
            Definition::HalfSpace { .. } => None,
        };
        (0..3).all(|axis| {
            bounds(axis).is_some_and(|(min, max)| {
                min.minus(&Exact::plane(frame, axis, 0)).sign() >= 0
                    && max.minus(&Exact::plane(frame, axis, frame.cells())).sign() <= 0
            })
        })
    }
}
