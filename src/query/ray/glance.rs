//! Rays on any solid, as closely as a picture shows.

use super::line::Line;
use super::search::{Cells, First};
use super::{Obstacle, Ray, RayHit};
use crate::control::Job;
use crate::error::Error;
use crate::lattice::{Cell, Cube};
use crate::op::split_one;
use crate::solid::{Enclosure, Verdict, Worker};

/// How closely a ray looks: cells are not split that are smaller than `near + t · growth` (model units), nor those whose slab is
/// that thin and whose boundary turns by less than `cone` (radians).
#[derive(Debug, Clone, Copy)]
pub(crate) struct Glance {
    pub near: f64,
    pub growth: f64,
    pub cone: f64,
}

impl Glance {
    /// Where a ray first meets what may be solid. O(cells along the ray · depth).
    ///
    /// # Errors
    /// The solid's own, and [`Error::Cancelled`].
    pub(crate) fn first<W: Worker>(
        &self,
        worker: &mut W,
        ray: &Ray,
        job: &Job<'_>,
    ) -> Result<Option<RayHit>, Error> {
        let mark = worker.mark();
        let frame = *worker.frame();
        let line = Line::new(&frame, *ray);
        let mut asked = Asked { glance: self, worker, job, ray };
        let first = First::search(&mut asked, &line);
        worker.release(mark);
        Ok(first?.hit(Obstacle::Upper))
    }
}

struct Asked<'w, W> {
    glance: &'w Glance,
    worker: &'w mut W,
    job: &'w Job<'w>,
    ray: &'w Ray,
}

impl<W: Worker> Asked<'_, W> {
    /// Whether a cell is looked into.
    fn looks_into(&mut self, cell: Cell, part: &W::Part) -> Result<bool, Error> {
        let frame = self.worker.frame();
        let cube = Cube { frame, cell };
        let edge = 2.0 * cube.half_edge();
        let (min, max) = cube.bounds();
        let (mut ahead, mut square) = (0.0, 0.0);
        for axis in 0..3 {
            let [direction, _] = self.ray.direction[axis];
            ahead += (0.5 * min[axis] + 0.5 * max[axis] - self.ray.from[axis]) * direction;
            square += direction * direction;
        }
        let fine = self.glance.near + self.glance.growth * (ahead / square).max(0.0);
        if edge <= fine {
            return Ok(false);
        }
        // Slabs of larger cells are seldom thin enough to be worth a question.
        if edge > 64.0 * fine {
            return Ok(true);
        }
        let enclosure = self.worker.enclosure(cell, part)?;
        Ok(!enclosure.is_some_and(|enclosure| {
            let slab = &enclosure.slabs[0];
            let length = slab.normal.iter().map(|c| c * c).sum::<f64>();
            let thick = 0.5 * edge * (slab.outer - slab.inner);
            let lone = enclosure.slabs[1..].iter().all(|slab| slab.normal == [0.0; 3]);
            lone && enclosure.cone <= self.glance.cone && thick * thick <= fine * fine * length
        }))
    }
}

impl<W: Worker> Cells for Asked<'_, W> {
    type Part = W::Part;

    fn root(&mut self) -> Result<Verdict<W::Part>, Error> {
        self.worker.root()
    }

    fn split(&mut self, cell: Cell, part: &W::Part) -> Result<Option<[Verdict<W::Part>; 8]>, Error> {
        self.job.check()?;
        if !self.looks_into(cell, part)? {
            return Ok(None);
        }
        split_one(self.worker, cell, part, self.job.control()).map(Some)
    }

    fn enclosure(&mut self, cell: Cell, part: &W::Part) -> Result<Option<Enclosure>, Error> {
        self.worker.enclosure(cell, part)
    }

    fn mark(&self) -> usize {
        self.worker.mark()
    }

    fn release(&mut self, mark: usize) {
        self.worker.release(mark);
    }
}
