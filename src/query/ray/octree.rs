//! Rays on stored octrees: the cells along a ray in lattice coordinates, two levels a step.

use super::line::Line;
use super::search::{Cells, First, Met, Stays};
use super::{Obstacle, Ray, RayHit, RaySpans};
use crate::dispatch::{Hot, with_popcount};
use crate::error::Error;
use crate::lattice::{Cell, Frame, morton};
use crate::octree::links::Step;
use crate::octree::view::{MAX_ELEMENT_LEVELS, OctreeRef, starts_half_way};
use crate::octree::{Octree, Planes, Tag};
use crate::solid::{Enclosure, OCTANTS, Verdict};

impl OctreeRef<'_> {
    /// Where a ray first meets the octree's cells, whatever they prove of the solid that the tree was made from;
    /// `None` if nothing stops it. What lies outside of the universe does not count. At most 3 · 2^depth cells are
    /// looked at, about a dozen as a rule, whatever the bytes.
    pub fn cast_ray(&self, ray: &Ray, on: Obstacle) -> Option<RayHit> {
        with_popcount(Cast { tree: self, ray, on })
    }

    /// Casts many rays, `hits[i]` for `rays[i]`; the same answers as [`cast_ray`](Self::cast_ray), faster. One thread.
    ///
    /// # Errors
    /// [`Error::Argument`] if the slices differ in length.
    ///
    /// ```
    /// use leafless::{Control, Csg, Frame, Obstacle, Ray, Rule, build};
    /// let frame = Frame::new([-2.0; 3], 4.0, 8)?;
    /// let ball = build(&Csg::ball([0.0; 3], 1.0)?, &frame, Rule::Certified, &Control::default())?;
    /// let rays = [Ray::new([-2.0, 0.1, 0.1], [1.0, 0.0, 0.0])?; 3];
    /// let mut hits = [None; 3];
    /// ball.view().cast_rays(&rays, Obstacle::Upper, &mut hits)?;
    /// let hit = hits[0].expect("the ball is hit");
    /// assert!(hit.t.contains(2.0 - 0.98f64.sqrt()) && hit.normal == [-1.0, 0.0, 0.0]);
    /// # Ok::<(), leafless::Error>(())
    /// ```
    pub fn cast_rays(&self, rays: &[Ray], on: Obstacle, hits: &mut [Option<RayHit>]) -> Result<(), Error> {
        if rays.len() != hits.len() {
            return Err(Error::Argument { name: "hits", problem: "must be as long as rays" });
        }
        with_popcount(CastAll { tree: self, rays, on, hits });
        Ok(())
    }

    /// Where a ray is in the octree's cells, whatever they prove of the solid that the tree was made from. What
    /// lies outside of the universe does not count. O(cells along the ray · depth).
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub fn ray_spans(&self, ray: &Ray) -> Result<RaySpans, Error> {
        Stays::search(&mut Stored(self), &Line::new(&self.frame, *ray))
    }

    /// The slow way, for rays on which rounding errors tell.
    #[cold]
    fn cast_exactly(&self, ray: &Ray, on: Obstacle) -> Option<RayHit> {
        // A stored tree's cells are split without fail.
        First::search(&mut Stored(self), &Line::new(&self.frame, *ray)).ok()?.hit(on)
    }
}

struct Cast<'t, 'a> {
    tree: &'t OctreeRef<'a>,
    ray: &'t Ray,
    on: Obstacle,
}

impl Hot for Cast<'_, '_> {
    type Output = Option<RayHit>;

    #[inline(always)]
    fn run(self) -> Option<RayHit> {
        cast(self.tree, self.ray, self.on)
    }
}

struct CastAll<'t, 'a> {
    tree: &'t OctreeRef<'a>,
    rays: &'t [Ray],
    on: Obstacle,
    hits: &'t mut [Option<RayHit>],
}

impl Hot for CastAll<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        for (ray, hit) in self.rays.iter().zip(self.hits) {
            *hit = cast(self.tree, ray, self.on);
        }
    }
}

#[inline(always)]
fn cast(tree: &OctreeRef<'_>, ray: &Ray, on: Obstacle) -> Option<RayHit> {
    match March::run(tree, ray) {
        Some(March { outer: None, .. }) => None,
        Some(march) => march.hit(tree, ray, on),
        None => tree.cast_exactly(ray, on),
    }
}

/// The first cells that stop a ray.
struct March {
    outer: Option<Met>,
    inner: Option<Met>,
}

/// A ray in lattice coordinates, mirrored so that none falls, in doubles with bounds of their errors.
struct Course {
    /// Where the ray starts.
    from: [f64; 3],
    /// Cells a unit of t.
    speed: [f64; 3],
    /// Units of t a cell.
    slowness: [f64; 3],
    /// Bound of the error of a coordinate at an exact t.
    place_error: [f64; 3],
    /// Bound of the error of the t at which a plane of the universe is passed.
    time_error: [f64; 3],
    /// Exclusive or with this mirrors the coordinate of a cell.
    mirror: [u32; 3],
}

/// `AHEAD[axis][falls][k]`: the cells of an element whose coordinate along an axis is k or comes after it.
const AHEAD: [[[u64; 4]; 2]; 3] = {
    let mut ahead = [[[0; 4]; 2]; 3];
    let mut axis = 0;
    while axis < 3 {
        let slab = morton::SLAB[axis];
        let mut k = 0;
        while k < 4 {
            let (mut from, mut to) = (k, k);
            while from < 4 {
                ahead[axis][0][k] |= slab[from];
                from += 1;
            }
            ahead[axis][1][k] |= slab[0];
            while to > 0 {
                ahead[axis][1][k] |= slab[to];
                to -= 1;
            }
            k += 1;
        }
        axis += 1;
    }
    ahead
};

/// A bound of all relative rounding errors of a coordinate together, of which each is 2^-53 and none counts more
/// than twice. They are relative to the universe and the ray's start.
const ERROR: f64 = 1.0 / (1u64 << 48) as f64;

impl Course {
    #[inline(always)]
    fn new(frame: &Frame, ray: &Ray) -> Course {
        let cells = frame.cells() as f64;
        let mut course = Course {
            from: [0.0; 3],
            speed: [0.0; 3],
            slowness: [0.0; 3],
            place_error: [0.0; 3],
            time_error: [0.0; 3],
            mirror: [0; 3],
        };
        for axis in 0..3 {
            let direction = ray.direction[axis][0];
            let from = frame.scaled(axis, ray.from[axis]);
            let falls = direction < 0.0;
            course.from[axis] = if falls { cells - from } else { from };
            course.mirror[axis] = if falls { frame.cells() - 1 } else { 0 };
            course.speed[axis] = frame.scaled_length(direction.abs());
            course.place_error[axis] = (from.abs() + cells) * ERROR;
            let still = direction == 0.0;
            // A ray that does not move along an axis passes its planes in the far past and the far future.
            course.slowness[axis] = if still { NEVER } else { 1.0 / course.speed[axis] };
            course.time_error[axis] =
                if still { 0.0 } else { course.place_error[axis] * course.slowness[axis] };
        }
        course
    }

    /// The cells of an element that a ray may still meet which is in one of them; they have an edge of 2^shift.
    #[inline(always)]
    fn ahead(&self, place: [u32; 3], shift: u32) -> u64 {
        let [x, y, z] = [0, 1, 2]
            .map(|axis| AHEAD[axis][(self.mirror[axis] != 0) as usize][(place[axis] >> shift & 3) as usize]);
        x & y & z
    }

    /// When the ray passes a plane of an axis.
    #[inline(always)]
    fn time(&self, axis: usize, plane: u32) -> f64 {
        (plane as f64 - self.from[axis]) * self.slowness[axis]
    }

    /// The coordinate of the cell in which the ray is at a time with this error, and whether rounding errors cannot
    /// have changed it.
    #[inline(always)]
    fn cell(&self, axis: usize, t: f64, time_error: f64) -> (u64, bool) {
        // Adding this leaves the nearest integer in the low bits.
        const SHIFT: f64 = (3u64 << 51) as f64;
        let error = self.speed[axis] * time_error + self.place_error[axis];
        let place = self.from[axis] + t * self.speed[axis] - 0.5;
        let shifted = place + SHIFT;
        let cell = shifted.to_bits().wrapping_sub(SHIFT.to_bits());
        (cell, (place - (shifted - SHIFT)).abs() < 0.5 - error)
    }
}

/// Units of t a cell that is never left.
const NEVER: f64 = f64::from_bits((1023 + 900) << 52);

/// How a ray begins.
enum Start {
    /// It does not meet the universe.
    Beside,
    /// It begins in this cell, or enters the universe there along an axis.
    At([u32; 3], Option<usize>),
    /// Rounding errors tell.
    Unsure,
}

impl Course {
    #[inline(always)]
    fn start(&self, frame: &Frame, last: f64) -> Start {
        let cells = frame.cells() as f64;
        let mut entry = 0;
        let near = [0, 1, 2].map(|axis| self.time(axis, 0));
        for axis in 1..3 {
            if near[axis] > near[entry] {
                entry = axis;
            }
        }
        let inside = (0..3).all(|axis| near[axis] + self.time_error[axis] < 0.0);
        let (t, error) = if inside { (0.0, 0.0) } else { (near[entry], self.time_error[entry]) };
        let enters = t > error;
        if !(inside || enters) {
            return Start::Unsure;
        }
        let mut at = [0; 3];
        for axis in 0..3 {
            if !inside && axis == entry {
                continue;
            }
            let place = self.from[axis] + t * self.speed[axis];
            if place > cells + (self.speed[axis] * error + self.place_error[axis]) {
                return Start::Beside;
            }
            let (cell, sure) = self.cell(axis, t, error);
            if !(sure && cell < frame.cells() as u64) {
                return Start::Unsure;
            }
            at[axis] = cell as u32;
        }
        if t > last + error {
            Start::Beside
        } else if inside {
            Start::At(at, None)
        } else if t < last - error {
            Start::At(at, Some(entry))
        } else {
            Start::Unsure
        }
    }
}

impl March {
    /// `None` if rounding errors may change what is met.
    #[inline(always)]
    fn run(tree: &OctreeRef<'_>, ray: &Ray) -> Option<March> {
        let frame = &tree.frame;
        let mut march = March { outer: None, inner: None };
        let course = Course::new(frame, ray);
        let (mut at, mut by) = match course.start(frame, ray.last) {
            Start::Beside => return Some(march),
            Start::At(at, by) => (at, by),
            Start::Unsure => return None,
        };
        let levels = tree.levels();
        let mut path = [0; MAX_ELEMENT_LEVELS];
        let mut e = 0;
        let mut planes = tree.entry(0).unwrap_or(Planes::uniform(Tag::Partial));
        loop {
            let place = [0, 1, 2].map(|axis| at[axis] ^ course.mirror[axis]);
            // Down to the cell in which the ray is.
            let (tag, mut shift, c) = if tree.root != Tag::Branch {
                (tree.root, frame.depth() as u32, 0)
            } else {
                loop {
                    let shift = 2 * (levels - 1 - e) as u32;
                    let c = morton::index(place[0] >> shift, place[1] >> shift, place[2] >> shift);
                    match tree.step(e, path[e], planes, c) {
                        Step::Into(child) => {
                            e += 1;
                            path[e] = child;
                            planes = tree.entry(child).unwrap_or(Planes::uniform(Tag::Partial));
                        }
                        Step::Settled(tag) => break (tag, shift, c),
                    }
                }
            };
            if tag != Tag::Empty {
                let shift = shift + (tree.root == Tag::Branch && planes.octant(c >> 3) == tag) as u32;
                let cell = Cell { level: frame.depth() - shift as u8, at: place.map(|a| a >> shift) };
                let plane = |axis: usize| {
                    if course.mirror[axis] == 0 { at[axis] } else { frame.cells() - at[axis] }
                };
                let met = (cell, by.map(|axis| (axis, plane(axis))));
                march.outer.get_or_insert(met);
                if tag == Tag::Full {
                    march.inner = Some(met);
                    return Some(march);
                }
            }
            if tree.root == Tag::Branch {
                // Nothing on the ray's further way through the octant, or through all of the element, may stop it.
                let ahead = course.ahead(place, shift);
                let stops = if march.outer.is_none() { planes.lower | planes.upper } else { planes.lower };
                let octant = 0xFF << (c & !7);
                shift += (stops & ahead & octant == 0) as u32 + (stops & ahead == 0) as u32;
            }
            // Out of it by the plane that is passed first. Nothing is indexed by its axis, so that all stays in
            // registers.
            let far = at.map(|a| (a >> shift << shift) + (1 << shift));
            let [x, y, z] = [0, 1, 2].map(|axis| course.time(axis, far[axis]));
            let [least_of_two, error_of_two] =
                if x < y { [x, course.time_error[0]] } else { [y, course.time_error[1]] };
            let [t, error] =
                if z < least_of_two { [z, course.time_error[2]] } else { [least_of_two, error_of_two] };
            let goes_on = t < ray.last - error;
            if !goes_on {
                return (t > ray.last + error).then_some(march);
            }
            let passed = [x == t, y == t, z == t];
            let mut changed = 0;
            let mut all_sure = passed[0] as u32 + passed[1] as u32 + passed[2] as u32 == 1;
            for axis in 0..3 {
                let (cell, sure) = course.cell(axis, t, error);
                let next = if passed[axis] { far[axis] } else { cell as u32 };
                all_sure &= sure | passed[axis];
                changed |= next ^ at[axis];
                at[axis] = next;
            }
            if !all_sure {
                return None;
            }
            if changed >= frame.cells() {
                return Some(march);
            }
            by = Some(passed[1] as usize + 2 * passed[2] as usize);
            let shared = levels - 1 - (31 - (changed | 1).leading_zeros()) as usize / 2;
            if shared < e {
                e = shared;
                planes = tree.entry(path[e]).unwrap_or(Planes::uniform(Tag::Partial));
            }
        }
    }

    /// The answer, with exact times.
    #[inline(never)]
    fn hit(&self, tree: &OctreeRef<'_>, ray: &Ray, on: Obstacle) -> Option<RayHit> {
        let line = Line::new(&tree.frame, *ray);
        First::of(&line, self.outer, self.inner).hit(on)
    }
}

/// A stored octree, whose cells are split as they are stored.
struct Stored<'t, 'a>(&'t OctreeRef<'a>);

/// Where a cut cell is described: element level, element, and the octant unless it is the element's own.
type Described = (usize, usize, Option<u8>);

impl Stored<'_, '_> {
    fn verdict(&self, e: usize, index: usize, planes: Planes, c: u32) -> Verdict<Described> {
        match self.0.step(e, index, planes, c) {
            Step::Into(child) => Verdict::Partial((e + 1, child, None)),
            Step::Settled(tag) => settled(tag),
        }
    }
}

fn settled<P>(tag: Tag) -> Verdict<P> {
    match tag {
        Tag::Empty => Verdict::Empty,
        Tag::Full => Verdict::Full,
        Tag::Partial | Tag::Branch => Verdict::Undecided,
    }
}

impl Cells for Stored<'_, '_> {
    type Part = Described;

    fn root(&mut self) -> Result<Verdict<Described>, Error> {
        let half = starts_half_way(self.0.frame.depth());
        Ok(match self.0.root {
            Tag::Branch => Verdict::Partial((0, 0, half.then_some(0))),
            tag => settled(tag),
        })
    }

    fn split(&mut self, _: Cell, part: &Described) -> Result<Option<[Verdict<Described>; 8]>, Error> {
        let (e, index, octant) = *part;
        let planes = self.0.entry(index).unwrap_or(Planes::uniform(Tag::Partial));
        Ok(Some(OCTANTS.map(|k| match octant {
            Some(octant) => self.verdict(e, index, planes, (8 * octant + k).into()),
            None => match planes.octant(k.into()) {
                Tag::Branch => Verdict::Partial((e, index, Some(k))),
                tag => settled(tag),
            },
        })))
    }

    fn enclosure(&mut self, _: Cell, _: &Described) -> Result<Option<Enclosure>, Error> {
        Ok(None)
    }

    fn mark(&self) -> usize {
        0
    }

    fn release(&mut self, _: usize) {}
}

impl Octree {
    /// As [`OctreeRef::cast_ray`].
    pub fn cast_ray(&self, ray: &Ray, on: Obstacle) -> Option<RayHit> {
        self.view().cast_ray(ray, on)
    }

    /// As [`OctreeRef::cast_rays`].
    ///
    /// # Errors
    /// [`Error::Argument`] if the slices differ in length.
    pub fn cast_rays(&self, rays: &[Ray], on: Obstacle, hits: &mut [Option<RayHit>]) -> Result<(), Error> {
        self.view().cast_rays(rays, on, hits)
    }

    /// As [`OctreeRef::ray_spans`].
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub fn ray_spans(&self, ray: &Ray) -> Result<RaySpans, Error> {
        self.view().ray_spans(ray)
    }
}
