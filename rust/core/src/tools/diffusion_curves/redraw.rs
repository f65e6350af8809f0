//! Colors from curves: Laplace's equation between them (Rowe et al. 2024, eq. (26)).

use super::chains::sided;
use super::fit::pieces;
use super::membrane::{Harmonic, Membrane};
use crate::linear::Columns;
use crate::memory::Tool;
use crate::mesh::{Connectivity, CutMesh, EdgeTable, Mesh};
use crate::progress::{Progress, Report};
use crate::unit::Unit;
use crate::{memory, Error, Result};

/// Colors on both sides of edges of a mesh, and at single vertices.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ColoredCurves {
    /// Start and end vertex of every edge.
    pub edges: Vec<[u32; 2]>,
    /// Numbers of a color.
    pub n_channels: usize,
    /// The colors at the start and at the end of every edge on its left, where faces run from start to end:
    /// `edges × 2 × channels`. Where no face is on that side they are not used.
    pub left: Vec<f64>,
    /// The same on the right.
    pub right: Vec<f64>,
    /// Vertices with a color of their own, away from curves.
    pub points: Vec<u32>,
    /// Their colors, `points × channels`.
    pub point_colors: Vec<f64>,
}

/// The colors of a surface between curves.
#[derive(Debug, Clone, PartialEq)]
pub struct Redrawn {
    /// One color a vertex. A vertex on a curve takes the color of the side that was asked for, else the mean
    /// of its sides; vertices without faces get 0.
    pub colors: Columns,
    /// The colors at the three corners of every face, `faces × 3 × channels`: across a curve they jump.
    pub corners: Vec<f64>,
}

/// Diffuses the colors of curves over a mesh: `Δu = 0` between the curves and `u` as given on each of their
/// sides, for the cotangent Laplacian on the intrinsic Delaunay triangulation of the mesh cut open along the
/// curves.
///
/// Every color lies within the range of the given ones, channel by channel. Where curves meet, the colors
/// that they give to the same side are averaged. `sides` names for each vertex a face whose side it takes.
///
/// Source: Rowe et al. 2024, eq. (26); Orzan et al. 2008.
///
/// # Errors
/// [`Error::Argument`] for arrays of the wrong size, vertices that no edge joins, numbers that are not
/// finite, and a piece of surface without a curve or point; [`Error::Cancelled`].
pub fn redraw(
    mesh: &Mesh,
    curves: &ColoredCurves,
    sides: Option<&[Option<u32>]>,
    progress: &Progress,
) -> Result<Redrawn> {
    let connectivity = mesh.connectivity();
    curves.check(connectivity)?;
    check_sides(connectivity, sides)?;
    mesh.demand(Tool::Redraw).admit(None)?;
    let unit = Unit::of(curves.colors().copied());
    if !unit.is_one() {
        let mut measured = curves.clone();
        measured.restore(unit.power(-1));
        let mut redrawn = redraw(mesh, &measured, sides, progress)?;
        redrawn.restore(unit);
        return Ok(redrawn);
    }
    let mesh = mesh.measured(mesh.unit())?;
    progress.report(Report { stage: "diffusing".into(), ..Report::default() });
    let table = EdgeTable::new(connectivity)?;
    let cut = CutMesh::new(connectivity, &table, &curves.cuts(connectivity, &table)?)?;
    let membrane = Membrane::new(&cut, mesh.edge_lengths())?;
    let conditions = Conditions::new(connectivity, &table, &cut, curves)?;
    conditions.check(&cut)?;
    progress.check()?;
    let mut harmonic = Harmonic::new(&membrane, &conditions.fixed, progress)?;
    conditions.solve(connectivity, &cut, &mut harmonic, sides, progress)
}

impl Redrawn {
    /// The colors back in the unit that they came in.
    pub(super) fn restore(&mut self, unit: Unit) {
        unit.restore_all(self.colors.data.iter_mut().chain(&mut self.corners));
    }
}

impl ColoredCurves {
    fn colors(&self) -> impl Iterator<Item = &f64> {
        self.left.iter().chain(&self.right).chain(&self.point_colors)
    }

    /// The colors back in the unit that they came in.
    pub(super) fn restore(&mut self, unit: Unit) {
        unit.restore_all(self.left.iter_mut().chain(&mut self.right).chain(&mut self.point_colors));
    }

    fn check(&self, connectivity: &Connectivity) -> Result<()> {
        if self.n_channels == 0 {
            return Err(Error::argument("left", "has no channels; pass at least one number a color"));
        }
        let sized = [
            ("left", &self.left, 2 * self.edges.len(), "two rows an edge"),
            ("right", &self.right, 2 * self.edges.len(), "two rows an edge"),
            ("point_colors", &self.point_colors, self.points.len(), "a row a point"),
        ];
        for (name, values, rows, what) in sized {
            if values.len() != rows * self.n_channels {
                let problem =
                    format!("has {} numbers, expected {what}: {}", values.len(), rows * self.n_channels);
                return Err(Error::argument(name, problem));
            }
            if let Some(i) = values.iter().position(|x| !x.is_finite()) {
                let problem = format!("row {} is not finite; every number must be", i / self.n_channels);
                return Err(Error::argument(name, problem));
            }
        }
        let n = connectivity.n_vertices();
        match self.points.iter().find(|&&v| v as usize >= n) {
            Some(v) => Err(Error::argument("points", format!("vertex {v} does not exist: there are {n}"))),
            None => Ok(()),
        }
    }

    /// The halfedges of the curves.
    fn cuts(&self, connectivity: &Connectivity, table: &EdgeTable) -> Result<Vec<bool>> {
        let mut cut = memory::repeated(false, connectivity.n_halfedges())?;
        for (row, &[a, b]) in self.edges.iter().enumerate() {
            let mut found = table.between(a, b).peekable();
            if found.peek().is_none() {
                let problem = format!("row {row}: no edge of the mesh joins vertices {a} and {b}");
                return Err(Error::argument("edges", problem));
            }
            found.for_each(|h| cut[h] = true);
        }
        Ok(cut)
    }
}

fn check_sides(connectivity: &Connectivity, sides: Option<&[Option<u32>]>) -> Result<()> {
    let Some(sides) = sides else { return Ok(()) };
    if sides.len() != connectivity.n_vertices() {
        let problem =
            format!("has {} entries, expected one per vertex: {}", sides.len(), connectivity.n_vertices());
        return Err(Error::argument("sides", problem));
    }
    let wrong = |(v, side): (usize, &Option<u32>)| {
        let face = connectivity.faces().get((*side)? as usize);
        (!face.is_some_and(|face| face.contains(&(v as u32)))).then_some((v, side.unwrap_or_default()))
    };
    match sides.iter().enumerate().find_map(wrong) {
        Some((v, f)) => {
            Err(Error::argument("sides", format!("entry {v} names face {f}, which has no such vertex")))
        }
        None => Ok(()),
    }
}

/// The given values on the copies of a cut mesh.
pub(super) struct Conditions {
    pub fixed: Vec<bool>,
    pub values: Columns,
}

impl Conditions {
    /// Gives each copy the mean of the colors that curves give it,
    /// and those of points to the copies that no curve reaches.
    pub(super) fn new(
        connectivity: &Connectivity,
        table: &EdgeTable,
        cut: &CutMesh,
        curves: &ColoredCurves,
    ) -> Result<Self> {
        let (n, k) = (cut.n_copies(), curves.n_channels);
        let mut counts = memory::repeated(0_u32, n)?;
        let mut values = Columns::try_zeros(n, k)?;
        for (e, &[start, end]) in curves.edges.iter().enumerate() {
            for (h, is_left) in sided(connectivity, table, [start, end]) {
                let side = if is_left { &curves.left } else { &curves.right };
                for (vertex, row) in [(start, 2 * e), (end, 2 * e + 1)] {
                    let copy = copy_at(connectivity, cut, h, vertex);
                    counts[copy] += 1;
                    (0..k).for_each(|c| values.column_mut(c)[copy] += side[row * k + c]);
                }
            }
        }
        let mut point = memory::repeated(None, connectivity.n_vertices())?;
        (0..).zip(&curves.points).for_each(|(row, &v)| point[v as usize] = Some(row));
        for copy in 0..n {
            if counts[copy] > 1 {
                (0..k).for_each(|c| values.column_mut(c)[copy] /= f64::from(counts[copy]));
            } else if let (0, Some(row)) = (counts[copy], point[cut.vertices[copy] as usize]) {
                let row: usize = row;
                counts[copy] = 1;
                (0..k).for_each(|c| values.column_mut(c)[copy] = curves.point_colors[row * k + c]);
            }
        }
        Ok(Self { fixed: memory::gathered(counts.iter().map(|&count| count > 0))?, values })
    }

    /// Refuses a piece of surface that nothing colors.
    fn check(&self, cut: &CutMesh) -> Result<()> {
        let mut roots = pieces(cut)?;
        let mut reached = memory::repeated(false, cut.n_copies())?;
        (0..)
            .zip(&self.fixed)
            .filter(|(_, fixed)| **fixed)
            .for_each(|(i, _)| reached[roots.root(i) as usize] = true);
        match cut.faces.iter().position(|face| !reached[roots.root(face[0]) as usize]) {
            Some(face) => {
                let problem =
                    format!("none of them reaches the piece of surface of face {face}; color it by a point");
                Err(Error::argument("edges", problem))
            }
            None => Ok(()),
        }
    }

    /// Solves for the other copies and gives vertices and corners their colors.
    pub(super) fn solve(
        &self,
        connectivity: &Connectivity,
        cut: &CutMesh,
        harmonic: &mut Harmonic<'_>,
        sides: Option<&[Option<u32>]>,
        progress: &Progress,
    ) -> Result<Redrawn> {
        let mut values = self.values.copied()?;
        harmonic.extend(&mut values, progress)?;
        self.clamp(&mut values);
        let (n, k) = (connectivity.n_vertices(), values.n_columns);
        let mut counts = memory::repeated(0.0_f64, n)?;
        cut.vertices.iter().for_each(|&v| counts[v as usize] += 1.0);
        let mut colors = Columns::try_zeros(n, k)?;
        for c in 0..k {
            let out = colors.column_mut(c);
            cut.vertices.iter().zip(values.column(c)).for_each(|(&v, x)| out[v as usize] += x);
            out.iter_mut().zip(&counts).filter(|(_, &count)| count > 1.0).for_each(|(x, count)| *x /= count);
        }
        for (v, side) in sides.into_iter().flatten().enumerate() {
            let corner =
                side.and_then(|f| (0..3).find(|&i| connectivity.faces()[f as usize][i] as usize == v));
            if let (Some(f), Some(i)) = (side, corner) {
                let copy = cut.faces[*f as usize][i] as usize;
                (0..k).for_each(|c| colors.column_mut(c)[v] = values.column(c)[copy]);
            }
        }
        let corner_colors = |&copy: &u32| (0..k).map(move |c| (c, copy as usize));
        let mut corners = memory::room(3 * cut.faces.len() * k)?;
        let at_corners = cut.faces.iter().flatten().flat_map(corner_colors);
        corners.extend(at_corners.map(|(c, copy)| values.column(c)[copy]));
        Ok(Redrawn { colors, corners })
    }

    /// Takes out of the solution what rounding lets leave the range of the given values.
    fn clamp(&self, values: &mut Columns) {
        for c in 0..values.n_columns {
            let given =
                self.values.column(c).iter().zip(&self.fixed).filter(|(_, fixed)| **fixed).map(|(x, _)| *x);
            let (least, most) = given
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), x| (least.min(x), most.max(x)));
            if least <= most {
                values.column_mut(c).iter_mut().for_each(|x| *x = x.clamp(least, most));
            }
        }
    }
}

/// The copy at the corner of the face of `h` that is at `vertex`, an end of `h`.
pub(super) fn copy_at(connectivity: &Connectivity, cut: &CutMesh, h: usize, vertex: u32) -> usize {
    let corner = if connectivity.tail(h) == vertex { (h + 1) % 3 } else { (h + 2) % 3 };
    // Corner `i + 1` of the halfedge `3 f + i`, modulo 3: `3 f` is a multiple of 3.
    cut.faces[h / 3][corner] as usize
}
