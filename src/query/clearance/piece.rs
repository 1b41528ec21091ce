//! The part of a solid in a cell, and the distance of two such parts.
//!
//! Lengths are in finest cells. A piece lies in the convex bodies that the outer ends of its slabs cut off
//! the cell, and contains the bodies of the inner ends. Plain doubles find the nearest points of two bodies.
//! The direction between these points then proves a lower bound (weak duality): for any direction n, the
//! distance is at least the minimum of n · x over one piece minus the maximum over the other, divided by the
//! length of n. An angular error of the direction affects the bound only by its square. The nearest points of
//! the inner bodies, if they are proven to lie there, give an upper bound.
//!
//! A piece may also lie on one side of a ball or a cylinder. For two such pieces the bound is exact where the
//! surfaces run alongside each other, as a shaft and its bore do, whatever the size of the cells.

use super::simplex::{Near, dot, minus, nearest, plus};
use crate::cut::reach;
use crate::lattice::Each;
use crate::lattice::exact::{floor, sqrt};
use crate::lattice::{Interval, axes};
use crate::solid::{Enclosure, Round, Slab, SlabJoin};

/// A point whose coordinates are bounded by intervals: in finest cells, from the universe's lower corner.
pub(super) type Place = [Interval; 3];

/// One side of a ball or a cylinder that contains a piece.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ring {
    pub(super) round: Round,
    /// Whether it is the side of the core.
    pub(super) is_near: bool,
}

/// The knowledge about the solid in a cell.
#[derive(Debug, Clone, Copy)]
pub(super) enum Content<'n> {
    Full,
    Slabs(&'n Enclosure),
    Unknown,
}

/// The part of a solid in a cell.
#[derive(Debug, Clone, Copy)]
pub(super) struct Piece<'n> {
    pub(super) centre: [f64; 3],
    pub(super) half: f64,
    pub(super) content: Content<'n>,
    pub(super) rings: [Option<&'n Ring>; 2],
}

/// The maximal number of corners of a body. (Nine planes make fourteen corners; more occur only if rounding
/// separates equal corners.)
const MOST: usize = 32;

/// The maximal distance of a body's corners outside of the body, as a share of the cell.
const SLACK: f64 = 1e-12;

/// The inward shift of inner ends, as a share of the normal's range.
const MARGIN: f64 = 1.0 / (1u64 << 44) as f64;

/// A convex body in a cell: in the cell's coordinates, from its centre in half edges.
pub(super) struct Body {
    /// One to three slabs, whose intersection is the body; `None` for the whole cell.
    slabs: Option<Enclosure>,
    corners: [[f64; 3]; MOST],
    count: usize,
}

/// The bodies whose union contains a piece, or that a piece contains.
pub(super) struct Bodies {
    all: [Option<Body>; 3],
}

impl Bodies {
    pub(super) fn outer(piece: &Piece<'_>) -> Bodies {
        match piece.content {
            Content::Slabs(known) => Bodies::of(known, true),
            Content::Full | Content::Unknown => Bodies::whole(),
        }
    }

    fn inner(piece: &Piece<'_>) -> Bodies {
        match piece.content {
            Content::Full => Bodies::whole(),
            Content::Slabs(known) => Bodies::of(known, false),
            Content::Unknown => Bodies { all: [None, None, None] },
        }
    }

    fn whole() -> Bodies {
        Bodies { all: [Some(Body::new(None, true)), None, None] }
    }

    fn of(known: &Enclosure, outer: bool) -> Bodies {
        let is_slab = |slab: &&Slab| slab.normal != [0.0; 3];
        let count = known.slabs.iter().filter(is_slab).count();
        if count == 0 {
            // Without slabs nothing is known.
            return if outer { Bodies::whole() } else { Bodies { all: [None, None, None] } };
        }
        if known.join == SlabJoin::All || count == 1 {
            return Bodies {
                all: [Some(Body::new(Some(Enclosure { join: SlabJoin::All, ..*known }), outer)), None, None],
            };
        }
        let mut all = [None, None, None];
        for (place, slab) in all.iter_mut().zip(known.slabs.iter().filter(is_slab)) {
            let slabs = [*slab, Slab::NONE, Slab::NONE];
            *place = Some(Body::new(Some(Enclosure { slabs, join: SlabJoin::All, cone: known.cone }), outer));
        }
        Bodies { all }
    }

    fn iter(&self) -> impl Iterator<Item = &Body> {
        self.all.iter().flatten()
    }
}

impl Body {
    fn new(slabs: Option<Enclosure>, outer: bool) -> Body {
        let mut body = Body { slabs, corners: [[0.0; 3]; MOST], count: 0 };
        let mut planes = [([0.0; 3], 0.0); 3];
        let mut count = 0;
        for slab in body.slabs.iter().flat_map(|known| known.slabs).filter(|slab| slab.normal != [0.0; 3]) {
            let range = slab.normal.iter().map(|c| c.abs()).sum::<f64>();
            let offset = if outer { slab.outer / range } else { slab.inner / range - MARGIN };
            // (A comparison with NaN is false.)
            if offset < 1.0 {
                planes[count] = (slab.normal.each(|c| c / range), offset);
                count += 1;
            } else if offset.is_nan() {
                return body;
            }
        }
        body.add_corners(&planes[..count]);
        body
    }

    fn add_corners(&mut self, planes: &[([f64; 3], f64)]) {
        let sign = |bits: usize, k: usize| if bits >> k & 1 == 0 { -1.0 } else { 1.0 };
        for k in 0..8 {
            self.add(planes, axes(|axis| sign(k, axis)));
        }
        for (i, (n, offset)) in planes.iter().enumerate() {
            for free in 0..3 {
                let (u, v) = ((free + 1) % 3, (free + 2) % 3);
                for k in 0..4 {
                    let mut point = [0.0; 3];
                    (point[u], point[v]) = (sign(k, 0), sign(k, 1));
                    point[free] = (offset - n[u] * point[u] - n[v] * point[v]) / n[free];
                    self.add(planes, point);
                }
            }
            for (m, other) in &planes[i + 1..] {
                for fixed in 0..3 {
                    let (u, v) = ((fixed + 1) % 3, (fixed + 2) % 3);
                    let determinant = n[u] * m[v] - n[v] * m[u];
                    for k in 0..2 {
                        let at = sign(k, 0);
                        let (p, q) = (offset - n[fixed] * at, other - m[fixed] * at);
                        let mut point = [at; 3];
                        point[u] = (p * m[v] - q * n[v]) / determinant;
                        point[v] = (q * n[u] - p * m[u]) / determinant;
                        self.add(planes, point);
                    }
                }
            }
        }
        if let [(a, p), (b, q), (c, r)] = planes {
            let cross = super::simplex::cross;
            let (bc, ca, ab) = (cross(*b, *c), cross(*c, *a), cross(*a, *b));
            let determinant = dot(*a, bc);
            self.add(planes, axes(|k| (p * bc[k] + q * ca[k] + r * ab[k]) / determinant));
        }
    }

    /// Adds a point if it lies in the cell and behind all planes.
    fn add(&mut self, planes: &[([f64; 3], f64)], point: [f64; 3]) {
        // NaN lies nowhere.
        let lies_within = point.iter().all(|c| c.abs() <= 1.0 + SLACK)
            && planes.iter().all(|(normal, offset)| dot(*normal, point) <= offset + SLACK);
        let point = point.each(|c| c.clamp(-1.0, 1.0));
        if lies_within && self.count < MOST && !self.corners[..self.count].contains(&point) {
            self.corners[self.count] = point;
            self.count += 1;
        }
    }

    /// The corners in finest cells, relative to `origin`.
    fn seen(&self, piece: &Piece<'_>, origin: [f64; 3]) -> [[f64; 3]; MOST] {
        let from = minus(piece.centre, origin);
        self.corners.map(|corner| plus(from, piece.half, corner))
    }

    /// A proven upper bound of the body's reach along a direction, from the centre of the cell in half edges.
    fn reach(&self, direction: [f64; 3]) -> Interval {
        match &self.slabs {
            Some(known) => {
                let reach = reach::upper(known, direction);
                if reach.is_nan() { Interval::ALL } else { Interval::exactly(reach) }
            }
            None => {
                let of = |c: f64| Interval::exactly(c.abs());
                of(direction[0]).plus(of(direction[1])).plus(of(direction[2]))
            }
        }
    }

    /// True if a point of the closed cell is proven to be a limit of points inside of all slabs.
    fn holds(&self, point: [f64; 3]) -> bool {
        let slabs = self.slabs.iter().flat_map(|known| &known.slabs).filter(|slab| slab.normal != [0.0; 3]);
        point.iter().all(|c| c.abs() <= 1.0)
            && slabs.clone().all(|slab| {
                let terms =
                    axes(|axis| Interval::exactly(slab.normal[axis]).times(Interval::exactly(point[axis])));
                terms[0].plus(terms[1]).plus(terms[2]).upper < slab.inner
            })
    }
}

fn exact(vector: [f64; 3]) -> Place {
    vector.each(Interval::exactly)
}

fn dot_of(a: &Place, b: &Place) -> Interval {
    let [x, y, z] = axes(|axis| a[axis].times(b[axis]));
    x.plus(y).plus(z)
}

fn less(a: &Place, b: &Place) -> Place {
    axes(|axis| a[axis].minus(b[axis]))
}

fn length(vector: &Place) -> Interval {
    let [x, y, z] = vector.each(Interval::square);
    x.plus(y).plus(z).root()
}

/// The distance of two points.
pub(super) fn between(a: &Place, b: &Place) -> Interval {
    length(&less(a, b))
}

impl Round {
    /// The distance of a point from the core.
    fn away(&self, point: &Place) -> Interval {
        let from = less(point, &exact(self.core));
        match self.axis {
            None => length(&from),
            Some(axis) => {
                let along = exact(axis);
                let product: Place = axes(|i| {
                    let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                    from[j].times(along[k]).minus(from[k].times(along[j]))
                });
                length(&product).over(length(&along))
            }
        }
    }

    /// The distance of a point from the core, up to rounding.
    fn about(&self, point: [f64; 3]) -> f64 {
        let from = minus(point, self.nearest(point));
        sqrt(dot(from, from))
    }

    /// The ends of the cell's projection onto the core: twice the centre for a ball.
    fn ends(&self, piece: &Piece<'_>) -> [Place; 2] {
        let core = exact(self.core);
        let Some(axis) = self.axis else { return [core; 2] };
        let along = exact(axis);
        let square = dot_of(&along, &along);
        let middle = dot_of(&less(&exact(piece.centre), &core), &along);
        let range = axis.iter().fold(Interval::exactly(0.0), |sum, c| sum.plus(Interval::exactly(c.abs())));
        let range = range.times(Interval::exactly(piece.half));
        [middle.minus(range).over(square).lower, middle.plus(range).over(square).upper]
            .each(|t| axes(|i| core[i].plus(along[i].times(Interval::exactly(t)))))
    }

    /// The point of the core that is nearest to a point, up to rounding.
    fn nearest(&self, point: [f64; 3]) -> [f64; 3] {
        match self.axis {
            None => self.core,
            Some(axis) => plus(self.core, dot(minus(point, self.core), axis) / dot(axis, axis), axis),
        }
    }

    /// A lower bound of the distance from the core to points of the far side.
    fn least(&self) -> Interval {
        Interval::exactly(self.square.lower).root()
    }

    /// An upper bound of the distance from the core to points of the near side.
    fn most(&self) -> Interval {
        Interval::exactly(self.square.upper).root()
    }
}

impl Piece<'_> {
    fn near_rounds(&self) -> impl Iterator<Item = &Round> {
        self.rings.iter().flatten().filter(|ring| ring.is_near).map(|ring| &ring.round)
    }

    fn far_rounds(&self) -> impl Iterator<Item = &Round> {
        self.rings.iter().flatten().filter(|ring| !ring.is_near).map(|ring| &ring.round)
    }

    /// True if more is known of the piece than its cell.
    pub(super) fn says_more(&self) -> bool {
        matches!(self.content, Content::Slabs(_)) || self.rings.iter().any(Option::is_some)
    }

    /// A proven upper bound of the piece's reach along a direction, from the centre of the cell in finest
    /// cells. −∞ if the piece has no point.
    fn reach(&self, body: &Body, direction: [f64; 3]) -> f64 {
        let own = body.reach(direction).times(Interval::exactly(self.half)).upper;
        let towards = exact(direction);
        self.near_rounds().fold(own, |least, round| {
            let ends = round.ends(self).each(|end| dot_of(&less(&end, &exact(self.centre)), &towards));
            let core = ends[0].upper.max(ends[1].upper);
            least.min(Interval::exactly(core).plus(round.most().times(length(&towards))).upper)
        })
    }

    /// A proven upper bound of the distance between the piece's points and the core of a ball or a cylinder.
    fn furthest_from(&self, round: &Round) -> f64 {
        if let Some(own) = self.near_rounds().next() {
            let [from, to] = own.ends(self).each(|end| round.away(&end).upper);
            return Interval::exactly(from.max(to)).plus(own.most()).upper;
        }
        let corners: [[f64; 3]; 8] = core::array::from_fn(|k| {
            axes(|axis| self.centre[axis] + if k >> axis & 1 == 0 { -self.half } else { self.half })
        });
        let about = corners.each(|corner| round.about(corner));
        let most = about.iter().fold(0.0, |most: f64, &away| most.max(away));
        // Rounding cannot compensate a larger difference.
        let size = corners.iter().chain([&round.core]).flatten().fold(most, |most: f64, c| most.max(c.abs()));
        let near = most - 1e-9 * size;
        let furthest = corners.iter().zip(about).filter(|(_, away)| away.is_nan() || *away >= near);
        furthest.fold(0.0, |most: f64, (corner, _)| most.max(round.away(&exact(*corner)).upper))
    }
}

/// A proven lower bound of the distance of two pieces, from the round surface that has one of them on its far
/// side around the other.
pub(super) fn lower_around(a: &Piece<'_>, b: &Piece<'_>) -> f64 {
    let around = |inner: &Piece<'_>, outer: &Piece<'_>| {
        outer.far_rounds().fold(0.0, |most: f64, round| {
            most.max(round.least().minus(Interval::exactly(inner.furthest_from(round))).lower)
        })
    };
    around(a, b).max(around(b, a))
}

/// A proven lower bound of the distance of two pieces; ∞ if one of the pieces is empty. A bound that does not
/// exceed `known` is not proven.
pub(super) fn lower(a: (&Piece<'_>, &Bodies), b: (&Piece<'_>, &Bodies), known: f64) -> f64 {
    let mut least = f64::INFINITY;
    for own in a.1.iter() {
        for other in b.1.iter() {
            if least > known {
                least = least.min(lower_of([a.0, b.0], [own, other], known));
            }
        }
    }
    least
}

fn lower_of([a, b]: [&Piece<'_>; 2], [own, other]: [&Body; 2], known: f64) -> f64 {
    let apart = minus(b.centre, a.centre);
    if own.count == 0 || other.count == 0 {
        // The corners in doubles may be wrong.
        let is_empty =
            |body: &Body| body.count == 0 && body.reach([1.0, 0.0, 0.0]).upper == f64::NEG_INFINITY;
        return if is_empty(own) || is_empty(other) { f64::INFINITY } else { 0.0 };
    }
    let prove = |direction: [f64; 3]| -> f64 {
        let is_usable = direction != [0.0; 3] && direction.iter().all(|c| c.is_finite());
        if !is_usable {
            return 0.0;
        }
        // (The direction may have any length. A length of about 1 keeps squares in range.)
        let size = direction.iter().fold(0.0, |most: f64, c| most.max(c.abs()));
        let direction = direction.each(|c| c / size);
        let (far, near) = (a.reach(own, direction), b.reach(other, direction.each(|c| -c)));
        if far == f64::NEG_INFINITY || near == f64::NEG_INFINITY {
            return f64::INFINITY;
        }
        let towards = exact(direction);
        let gap =
            dot_of(&towards, &exact(apart)).minus(Interval::exactly(far)).minus(Interval::exactly(near));
        gap.over(length(&towards)).lower
    };
    let (from, to) = (own.seen(a, a.centre), other.seen(b, a.centre));
    let way = nearest(&from[..own.count], &to[..other.count], apart).way;
    let about = sqrt(dot(way, way));
    let is_round = a.near_rounds().next().is_some() || b.near_rounds().next().is_some();
    if about <= known && !is_round {
        return 0.0;
    }
    let mut best = if about <= known { 0.0 } else { prove(way).max(0.0) };
    if is_round {
        // The direction from core to core, or to the nearest point of the other body.
        let core = |piece: &Piece<'_>, corners: [[f64; 3]; MOST], count: usize| {
            let Some(round) = piece.near_rounds().next() else { return (corners, count) };
            let mut own = corners;
            for (place, end) in own.iter_mut().zip(round.ends(piece)) {
                *place = axes(|k| 0.5 * (end[k].lower + end[k].upper) - a.centre[k]);
            }
            (own, if round.axis.is_some() { 2 } else { 1 })
        };
        let ((from, of_from), (to, of_to)) = (core(a, from, own.count), core(b, to, other.count));
        let way = nearest(&from[..of_from], &to[..of_to], apart).way;
        let radii = [a, b].into_iter().filter_map(|piece| piece.near_rounds().next());
        let radii = radii.map(|round| sqrt(round.square.upper));
        if sqrt(dot(way, way)) - radii.sum::<f64>() > best.max(known) {
            best = best.max(prove(way));
        }
    }
    // Where bodies nearly touch, rounding spoils the direction between their nearest points.
    if about > known && best < about * (1.0 - 1e-9) {
        let normals = |body: &Body, sign: f64| {
            let slabs = body.slabs.map(|known| known.slabs);
            slabs
                .into_iter()
                .flatten()
                .filter(|slab| slab.outer.is_finite())
                .map(move |slab| slab.normal.each(|c| sign * c))
        };
        for direction in normals(own, 1.0).chain(normals(other, -1.0)) {
            best = best.max(prove(direction));
        }
    }
    best
}

/// Returns points that are proven to be limits of points of the pieces, as near to each other as a search in
/// doubles finds them, and their distance.
pub(super) fn upper(a: &Piece<'_>, b: &Piece<'_>) -> Option<(Interval, [Place; 2])> {
    let (of_a, of_b) = (Bodies::inner(a), Bodies::inner(b));
    let mut best: Option<(Interval, [Place; 2])> = None;
    for own in of_a.iter().filter(|body| body.count > 0) {
        for other in of_b.iter().filter(|body| body.count > 0) {
            let (from, to) = (own.seen(a, a.centre), other.seen(b, a.centre));
            let apart = minus(b.centre, a.centre);
            let Near { points: [p, q], .. } = nearest(&from[..own.count], &to[..other.count], apart);
            let towards = minus(q, p);
            if let Some(place) = common([(a, own), (b, other)], plus(plus(p, 0.5, towards), 1.0, a.centre)) {
                return Some((Interval::exactly(0.0), [place; 2]));
            }
            let (Some(p), Some(q)) =
                (proven(own, a, p, towards), proven(other, b, minus(q, apart), towards.each(|c| -c)))
            else {
                continue;
            };
            let distance = between(&p, &q);
            if best.is_none_or(|(least, _)| distance.upper < least.upper) {
                best = Some((distance, [p, q]));
            }
        }
    }
    best
}

/// Returns a point next to a given one (in finest cells from the universe's corner) that is proven to lie in
/// two bodies.
fn common(bodies: [(&Piece<'_>, &Body); 2], point: [f64; 3]) -> Option<Place> {
    // So few digits that differences to centres are exact.
    const STEPS: f64 = (1u64 << 20) as f64;
    if !point.iter().all(|c| (0.0..STEPS * 2.0).contains(c)) {
        return None;
    }
    let point = point.each(|c| floor(c * STEPS + 0.5) as f64 / STEPS);
    let lies_in =
        |(piece, body): &(&Piece<'_>, &Body)| body.holds(minus(point, piece.centre).each(|c| c / piece.half));
    bodies.iter().all(lies_in).then(|| exact(point))
}

/// Returns a point near `point`, from the cell's centre in finest cells, that is proven to be a limit of
/// points of a body.
fn proven(body: &Body, piece: &Piece<'_>, point: [f64; 3], towards: [f64; 3]) -> Option<Place> {
    let own = point.each(|c| (c / piece.half).clamp(-1.0, 1.0));
    let own = match &body.slabs {
        _ if body.holds(own) => own,
        Some(known) => reach::witness(known, towards)?,
        None => return None,
    };
    // (Half edges are powers of two.)
    Some(axes(|axis| Interval::exactly(piece.centre[axis]).plus(Interval::exactly(piece.half * own[axis]))))
}
