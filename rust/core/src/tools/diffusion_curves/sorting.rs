//! Which region the color of each vertex belongs to.

use super::chains::border_edges;
use super::constants::{BROAD, HUB, NEARER, UNSEEN};
use super::fit::Task;
use super::membrane::Membrane;
use crate::linear::Columns;
use crate::mesh::{triangle, CutMesh, EdgeTable, Mesh};
use crate::progress::Progress;
use crate::{memory, Result};

/// A painted surface whose regions are looked for.
#[derive(Clone, Copy)]
pub(super) struct Paint<'a> {
    pub mesh: &'a Mesh,
    pub colors: &'a Columns,
    /// `α` of (27) for a surface of area 1.
    pub fidelity: f64,
    pub progress: &'a Progress,
}

/// Vertices by regions.
pub(super) struct Sorted {
    /// The region that each vertex has the color of: of several with that color the one with most faces
    /// around it. Nothing where all that are near explain it about as well.
    pub regions: Vec<Option<i32>>,
    /// How far each color is from that of the region nearest to it.
    pub off: Vec<f64>,
}

impl Paint<'_> {
    /// The largest range of a channel.
    pub(super) fn scale(&self) -> f64 {
        let range = |c: usize| {
            let column = self.colors.column(c).iter();
            column.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], &x| [least.min(x), most.max(x)])
        };
        (0..self.colors.n_columns).map(range).map(|[least, most]| most - least).fold(0.0, f64::max)
    }

    /// How far the colors of two vertices are from each other.
    pub(super) fn distance(&self, a: usize, b: usize) -> f64 {
        let column = |c: usize| self.colors.column(c);
        (0..self.colors.n_columns).map(|c| (column(c)[a] - column(c)[b]).powi(2)).sum::<f64>().sqrt()
    }

    /// Compares every vertex on a border, or beside one, with the fits (27) of the regions there.
    ///
    /// A region that does not reach a vertex is compared by the mean of its colors at the vertices around it.
    pub(super) fn sort(&self, labels: &[i32]) -> Result<Sorted> {
        let connectivity = self.mesh.connectivity();
        let area: f64 = self.mesh.edge_lengths().iter().map(|&l| triangle::area(l)).sum();
        let table = EdgeTable::new(connectivity)?;
        let mut flags = memory::repeated(false, connectivity.n_halfedges())?;
        let edges = border_edges(connectivity, &table, labels, false)?;
        edges.iter().flat_map(|edge| table.between(edge.ends[0], edge.ends[1])).for_each(|h| flags[h] = true);
        let cut = CutMesh::new(connectivity, &table, &flags)?;
        let membrane = Membrane::new(&cut, self.mesh.edge_lengths())?;
        let fidelity = self.fidelity.min(BROAD) / area;
        let task = Task { cut: &cut, membrane: &membrane, colors: self.colors, fidelity };
        let values = task.screened(self.progress)?.values;
        let copies = task.copies()?;
        let mut label_of = memory::repeated(0, cut.n_copies())?;
        cut.faces
            .iter()
            .zip(labels)
            .for_each(|(face, &label)| face.iter().for_each(|&i| label_of[i as usize] = label));
        let around =
            neighbors(connectivity.faces(), connectivity.n_vertices(), |v| copies[v as usize].len() > 1)?;
        let mut corners = memory::repeated(Vec::new(), copies.len())?;
        for (face, &label) in connectivity.faces().iter().zip(labels) {
            face.iter().for_each(|&v| corners[v as usize].push(label));
        }
        let least = UNSEEN * self.scale();
        let mut sorted = Sorted { regions: memory::room(copies.len())?, off: memory::room(copies.len())? };
        for (v, own) in copies.iter().enumerate() {
            // Where regions meet by the thousands, those of others there are not near, and the vertex between
            // them is compared with its own.
            let is_plain = |at: &&Vec<u32>| at.len() <= HUB && own.len() <= HUB;
            let beside = around[v].iter().map(|&u| &copies[u as usize]).filter(is_plain).flatten();
            let mut fits = Misfits { labels: &label_of, values: &values, found: Vec::new() };
            own.iter().for_each(|&copy| fits.add(copy));
            let here = fits.found.len();
            beside.for_each(|&copy| fits.add_beside(copy, here));
            let offs = fits.offs(self.colors, v);
            let best = offs.iter().map(|&(_, off)| off).fold(f64::INFINITY, f64::min);
            let fitting = |off: f64| off <= NEARER * best || off - best <= least;
            let clear = offs.iter().any(|&(_, off)| !fitting(off));
            let faces_of = |label: i32| corners[v].iter().filter(|other| **other == label).count();
            let able = offs.iter().filter(|(_, off)| clear && fitting(*off));
            let order = |a: &&(i32, f64), b: &&(i32, f64)| {
                faces_of(b.0).cmp(&faces_of(a.0)).then(a.1.total_cmp(&b.1)).then(a.0.cmp(&b.0))
            };
            sorted.regions.push(able.min_by(order).map(|&(label, _)| label));
            sorted.off.push(if best.is_finite() { best } else { 0.0 });
        }
        Ok(sorted)
    }
}

/// The colors of regions at and around one vertex: label, their sum, and their number.
struct Misfits<'a> {
    labels: &'a [i32],
    values: &'a Columns,
    found: Vec<(i32, Vec<f64>, f64)>,
}

impl Misfits<'_> {
    fn color(&self, copy: u32) -> Vec<f64> {
        (0..self.values.n_columns).map(|c| self.values.column(c)[copy as usize]).collect()
    }

    /// A copy of the vertex itself.
    fn add(&mut self, copy: u32) {
        self.found.push((self.labels[copy as usize], self.color(copy), 1.0));
    }

    /// A copy of a neighbor; it counts if no copy of the vertex, the first `here`, is of its region.
    fn add_beside(&mut self, copy: u32, here: usize) {
        let label = self.labels[copy as usize];
        if self.found[..here].iter().any(|found| found.0 == label) {
            return;
        }
        let color = self.color(copy);
        match self.found[here..].iter_mut().find(|found| found.0 == label) {
            Some((_, sum, count)) => {
                sum.iter_mut().zip(color).for_each(|(s, x)| *s += x);
                *count += 1.0;
            }
            None => self.found.push((label, color, 1.0)),
        }
    }

    /// How far each is from the color of vertex `v`.
    fn offs(&self, colors: &Columns, v: usize) -> Vec<(i32, f64)> {
        let off = |sum: &[f64], count: f64| {
            let squares = sum.iter().enumerate().map(|(c, s)| (s / count - colors.column(c)[v]).powi(2));
            squares.sum::<f64>().sqrt()
        };
        self.found.iter().map(|(label, sum, count)| (*label, off(sum, *count))).collect()
    }
}

/// The neighbors of every vertex that `on_border` holds for or that has such a neighbor.
///
/// # Errors
/// [`crate::Error::Solve`] where memory is missing.
pub(super) fn neighbors(
    faces: &[[u32; 3]],
    n_vertices: usize,
    on_border: impl Fn(u32) -> bool,
) -> Result<Vec<Vec<u32>>> {
    let mut around = memory::repeated(Vec::new(), n_vertices)?;
    for face in faces.iter().filter(|face| face.iter().any(|&v| on_border(v))) {
        for i in 0..3 {
            around[face[i] as usize].extend([face[(i + 1) % 3], face[(i + 2) % 3]]);
        }
    }
    for list in &mut around {
        list.sort_unstable();
        list.dedup();
    }
    Ok(around)
}
