//! How long edges should be where.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use crate::memory;
use crate::mesh::vector::distance;
use crate::ordered::Ordered;
use crate::remesh::curves::Curves;
use crate::remesh::EditableMesh;
use crate::Result;

/// Sweeps that spread the sizes of the rim over the patch, in every update: they start from the last ones.
const SWEEPS: usize = 20;

/// Edges grow by at most this for every unit of distance from the rim: faster,
/// and the triangles lose their shape.
const STEEPEST_GROWTH: f64 = 0.5;

/// The area of an equilateral triangle of edge length 1.
pub(crate) const EQUILATERAL: f64 = 0.433;

/// How long the edges of a patch should be that has about `max_faces` faces at most: at its rim, and by how
/// much longer for every unit of distance from there. The patch has this area, and its rim this length, in
/// edges of length `rim_edge`; `length` is asked for, or else that of the rim.
///
/// With growth g, a rim of length P, and edges of length L there some `P / (0.433 g L)` faces are made,
/// however large the hole. Edges shorter than the rim's cannot begin there, since nothing cuts the rim: what
/// is asked for beyond the faces that there may be is then shared out evenly.
pub(crate) fn length_and_growth(
    area: f64,
    rim: f64,
    rim_edge: f64,
    length: Option<f64>,
    max_faces: usize,
) -> (f64, f64) {
    let most = max_faces.max(1) as f64;
    let even = (area / (EQUILATERAL * most)).sqrt();
    match length {
        Some(length) if length < rim_edge && even <= rim_edge => (length.max(even), 0.0),
        _ => {
            let length = length.map_or(rim_edge, |length| length.max(rim_edge));
            let growth =
                if even > length { (rim / (EQUILATERAL * length * most)).min(STEEPEST_GROWTH) } else { 0.0 };
            (length, growth)
        }
    }
}

/// The target edge length at every vertex.
#[derive(Debug, Clone)]
pub(crate) struct Sizing {
    sizes: Vec<f64>,
    /// The target at the vertices of locked edges, which nothing changes.
    anchors: Vec<Option<f64>>,
    /// The target elsewhere; without it, that of the anchors spreads.
    uniform: Option<f64>,
    /// By how much targets grow with the distance from the anchors.
    growth: f64,
}

impl Sizing {
    /// The same length everywhere, but where a locked edge is longer: next to it, edges shorter than half of
    /// it could only make slivers. `growth` is added for every unit of distance from the locked edges.
    pub(crate) fn uniform(length: f64, growth: f64, mesh: &EditableMesh, curves: &Curves) -> Result<Self> {
        let mut anchors = memory::repeated(None, mesh.n_vertices())?;
        for [a, b] in curves.locked_edges()? {
            let locked = distance(mesh.position(a), mesh.position(b));
            for v in [a, b] {
                let anchor: &mut Option<f64> = &mut anchors[v as usize];
                *anchor = Some(anchor.unwrap_or(length).max(locked));
            }
        }
        let sizes = memory::gathered(anchors.iter().map(|anchor| anchor.unwrap_or(length)))?;
        Ok(Self { sizes, anchors, uniform: Some(length), growth })
    }

    /// The lengths of the locked edges, their mean at each vertex, spread smoothly, and `growth` for every
    /// unit of distance from them. `sizes` are the first targets; those at locked edges are not used.
    pub(crate) fn graded(
        mut sizes: Vec<f64>,
        growth: f64,
        mesh: &EditableMesh,
        curves: &Curves,
    ) -> Result<Self> {
        let mut sums = memory::repeated((0.0, 0.0), mesh.n_vertices())?;
        for [a, b] in curves.locked_edges()? {
            for v in [a, b] {
                sums[v as usize].0 += distance(mesh.position(a), mesh.position(b));
                sums[v as usize].1 += 1.0;
            }
        }
        let mean = |&(sum, count): &(f64, f64)| (count > 0.0).then(|| sum / count);
        let anchors = memory::gathered(sums.iter().map(mean))?;
        sizes.iter_mut().zip(&anchors).for_each(|(size, anchor)| *size = anchor.unwrap_or(*size));
        Ok(Self { sizes, anchors, uniform: None, growth })
    }

    /// [`Sizing::graded`] with first targets that grow from `length` at the locked edges.
    pub(crate) fn grown(length: f64, growth: f64, mesh: &EditableMesh, curves: &Curves) -> Result<Self> {
        let sizes = memory::repeated(length, mesh.n_vertices())?;
        let mut sizing = Self::graded(sizes, growth, mesh, curves)?;
        let far = sizing.distances(mesh, &neighbors(mesh)?)?;
        sizing.sizes.iter_mut().zip(far).for_each(|(size, far)| *size += growth * far);
        Ok(sizing)
    }

    /// The target at the edge.
    pub(crate) fn target(&self, a: u32, b: u32) -> f64 {
        0.5 * (self.sizes[a as usize] + self.sizes[b as usize])
    }

    /// The target at the vertex.
    pub(crate) fn at(&self, v: u32) -> f64 {
        self.sizes[v as usize]
    }

    /// A new vertex between two.
    pub(crate) fn push_between(&mut self, a: u32, b: u32) -> Result<()> {
        let target = self.target(a, b);
        memory::push(&mut self.sizes, target)?;
        Ok(memory::push(&mut self.anchors, None)?)
    }

    /// Spreads the sizes over the mesh as it is now.
    pub(crate) fn update(&mut self, mesh: &EditableMesh) -> Result<()> {
        let neighbors = if self.uniform.is_none() || self.growth > 0.0 {
            neighbors(mesh)?
        } else {
            memory::repeated(Vec::new(), mesh.n_vertices())?
        };
        let far = self.distances(mesh, &neighbors)?;
        let mut base = match self.uniform {
            Some(length) => memory::repeated(length, far.len())?,
            None => {
                // Without their growth sizes are means of the anchors';
                // distances along edges can be too long for that.
                let [least, most] = self.range_of_anchors();
                let base = |(size, d): (&f64, &f64)| {
                    let base = size - self.growth * d;
                    if self.growth > 0.0 && least <= most {
                        base.clamp(least, most)
                    } else {
                        base
                    }
                };
                memory::gathered(self.sizes.iter().zip(&far).map(base))?
            }
        };
        for (size, anchor) in base.iter_mut().zip(&self.anchors) {
            *size = anchor.unwrap_or(*size);
        }
        if self.uniform.is_none() {
            self.spread(&mut base, &neighbors);
        }
        self.sizes = memory::gathered(base.iter().zip(&far).map(|(size, d)| size + self.growth * d))?;
        Ok(())
    }

    /// The least and the largest length at anchors; the other way round if there are none.
    fn range_of_anchors(&self) -> [f64; 2] {
        let anchors = self.anchors.iter().flatten();
        anchors.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], &x| [least.min(x), most.max(x)])
    }

    /// Moves the sizes at vertices that are no anchors toward the mean of their neighbors'.
    fn spread(&self, sizes: &mut [f64], neighbors: &[Vec<u32>]) {
        for _ in 0..SWEEPS {
            for v in (0..sizes.len()).filter(|&v| self.anchors[v].is_none() && !neighbors[v].is_empty()) {
                sizes[v] =
                    neighbors[v].iter().map(|&w| sizes[w as usize]).sum::<f64>() / neighbors[v].len() as f64;
            }
        }
    }

    /// The distance along edges from the nearest anchor (Dijkstra 1959); 0 everywhere if nothing grows.
    fn distances(&self, mesh: &EditableMesh, neighbors: &[Vec<u32>]) -> Result<Vec<f64>> {
        let mut far = memory::repeated(0.0, neighbors.len())?;
        if self.growth == 0.0 {
            return Ok(far);
        }
        let mut heap = BinaryHeap::from(memory::room(neighbors.len())?);
        for v in 0..far.len() {
            if self.anchors[v].is_some() {
                heap.push(Reverse((Ordered(0.0), v as u32)));
            } else if !neighbors[v].is_empty() {
                far[v] = f64::INFINITY;
            }
        }
        while let Some(Reverse((Ordered(d), v))) = heap.pop() {
            if d > far[v as usize] {
                continue;
            }
            for &w in &neighbors[v as usize] {
                let through = d + distance(mesh.position(v), mesh.position(w));
                if through < far[w as usize] {
                    far[w as usize] = through;
                    memory::extend_heap(&mut heap, 1)?;
                    heap.push(Reverse((Ordered(through), w)));
                }
            }
        }
        far.iter_mut().filter(|d| !d.is_finite()).for_each(|d| *d = 0.0);
        Ok(far)
    }
}

/// The neighbors of every vertex.
fn neighbors(mesh: &EditableMesh) -> Result<Vec<Vec<u32>>> {
    let mut all = memory::room(mesh.n_vertices())?;
    all.extend((0..mesh.n_vertices() as u32).map(|v| mesh.neighbors(v)));
    Ok(all)
}
