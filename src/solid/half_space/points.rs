//! The 27-point test.

use super::bounds::Octants;
use crate::error::Error;
use crate::lattice::axes;

/// The points that are vertices of the eight children of a cell, by their place on each axis (0 lower end, 1
/// middle, 2 upper end). The points of most children come first: the centre, centres of faces, middles of
/// edges, corners.
const POINTS: [[u8; 3]; 27] = {
    let mut points = [[1; 3]; 27];
    let mut found = 0;
    let mut outer = 0;
    while outer <= 3 {
        let mut code = 0;
        while code < 27 {
            let point = [code % 3, code / 3 % 3, code / 9];
            let ends = (point[0] != 1) as u8 + (point[1] != 1) as u8 + (point[2] != 1) as u8;
            if ends == outer {
                points[found] = point;
                found += 1;
            }
            code += 1;
        }
        outer += 1;
    }
    points
};

/// Returns the children that have a vertex at a point.
const fn owners(point: [u8; 3]) -> u8 {
    // The bits of the children in the lower and in the upper half of each axis.
    let lower = [0x55, 0x33, 0x0F];
    let mut mask = 0xFF;
    let mut axis = 0;
    while axis < 3 {
        mask &= match point[axis] {
            0 => lower[axis],
            1 => 0xFF,
            _ => !lower[axis],
        };
        axis += 1;
    }
    mask
}

/// Evaluates `inside` at the vertices of the children `wanted` in the published order, each at most once,
/// until each child has an inner and an outer vertex. Returns the children with an inner vertex, and those
/// with an outer vertex. A vertex with the answer `None` is neither.
///
/// # Errors
/// The first error of `inside`.
pub(crate) fn vertices(
    at: &Octants,
    wanted: u8,
    mut inside: impl FnMut([f64; 3]) -> Result<Option<bool>, Error>,
) -> Result<(u8, u8), Error> {
    let (mut inner, mut outer) = (0, 0);
    for point in POINTS {
        let owners = owners(point) & wanted;
        if owners & !(inner & outer) == 0 {
            continue;
        }
        match inside(axes(|axis| at.low[axis] + point[axis] as f64 * at.half))? {
            Some(true) => inner |= owners,
            Some(false) => outer |= owners,
            None => {}
        }
    }
    Ok((inner, outer))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lattice::Cell;

    #[test]
    fn points_in_the_published_order() {
        let counts = POINTS.map(|point| owners(point).count_ones());
        assert_eq!(counts[0], 8);
        assert!(counts[1..7].iter().all(|&c| c == 4));
        assert!(counts[7..19].iter().all(|&c| c == 2));
        assert!(counts[19..].iter().all(|&c| c == 1));
        for k in 0..8 {
            assert_eq!(POINTS.iter().filter(|&&p| owners(p) >> k & 1 != 0).count(), 8);
        }
    }

    #[test]
    fn stops_early() {
        let at = Octants::of(Cell::ROOT);
        let mut asked = 0;
        // With the centre outside and two opposite faces inside, three points decide eight children.
        let sides = vertices(&at, 0xFF, |[_, _, z]| {
            asked += 1;
            Ok(Some(z != 0.5))
        })
        .unwrap();
        assert_eq!(sides, (0xFF, 0xFF));
        assert!(asked <= 7, "{asked}");
        asked = 0;
        assert_eq!(
            vertices(&at, 0xFF, |_| {
                asked += 1;
                Ok(Some(true))
            })
            .unwrap(),
            (0xFF, 0)
        );
        assert_eq!(asked, 27);
    }
}
