//! The chained borders between regions, and what fitted colors make of them.

use super::chains::{sided, CurveEdge};
use super::fit::CopyColors;
use super::redraw::{copy_at, ColoredCurves};
use super::thinning::thin;
use crate::linear::Columns;
use crate::mesh::{Connectivity, CutMesh, EdgeTable};

/// The borders on a cut mesh.
pub(super) struct Borders<'a> {
    pub connectivity: &'a Connectivity,
    pub table: &'a EdgeTable,
    pub cut: &'a CutMesh,
    /// In the order of their curves.
    pub edges: &'a [CurveEdge],
    /// Where each curve starts, and their number.
    pub starts: &'a [usize],
}

impl Borders<'_> {
    /// The curves with the colors of `values` on their sides, one row a copy;
    /// a side without a face gets those of the other.
    pub(super) fn colored(&self, values: &Columns) -> ColoredCurves {
        let k = values.n_columns;
        let mut curves = ColoredCurves { n_channels: k, ..ColoredCurves::default() };
        for edge in self.edges {
            let [start, end] = edge.ends;
            let edge_sides = sided(self.connectivity, self.table, edge.ends);
            let on = |left: bool| edge_sides.clone().find(|&(_, is_left)| is_left == left).map(|(h, _)| h);
            let sides = [on(true).or_else(|| on(false)), on(false).or_else(|| on(true))];
            for (h, out) in sides.into_iter().zip([&mut curves.left, &mut curves.right]) {
                for (h, vertex) in h.into_iter().flat_map(|h| [(h, start), (h, end)]) {
                    let copy = copy_at(self.connectivity, self.cut, h, vertex);
                    out.extend((0..k).map(|c| values.column(c)[copy]));
                }
            }
            curves.edges.push(edge.ends);
        }
        curves
    }

    /// Thins the colors of every curve, [`thin`]; returns the number of knots of each.
    pub(super) fn thin(
        &self,
        curves: &mut ColoredCurves,
        lengths: &[[f64; 3]],
        tolerance: f64,
    ) -> Vec<usize> {
        let k = curves.n_channels;
        let length = |e: usize| {
            let [start, end] = curves.edges[e];
            self.table.between(start, end).next().map_or(0.0, |h| lengths[h / 3][h % 3])
        };
        let all: Vec<f64> = (0..curves.edges.len()).map(length).collect();
        let mut counts = Vec::with_capacity(self.starts.len());
        for bounds in self.starts.windows(2) {
            let edges = bounds[0]..bounds[1];
            // A row for each point of the curve: left colors, then right ones.
            let mut rows = Vec::with_capacity((edges.len() + 1) * 2 * k);
            for point in 0..=edges.len() {
                let row = if point < edges.len() { 2 * (bounds[0] + point) } else { 2 * bounds[1] - 1 };
                rows.extend_from_slice(&curves.left[row * k..(row + 1) * k]);
                rows.extend_from_slice(&curves.right[row * k..(row + 1) * k]);
            }
            counts.push(thin(&mut rows, 2 * k, &all[edges.clone()], tolerance));
            for (i, e) in edges.enumerate() {
                for end in 0..2 {
                    let (to, from) = ((2 * e + end) * k, (i + end) * 2 * k);
                    curves.left[to..to + k].copy_from_slice(&rows[from..from + k]);
                    curves.right[to..to + k].copy_from_slice(&rows[from + k..from + 2 * k]);
                }
            }
        }
        counts
    }

    /// How many numbers the curves are; `knots` counts them where colors were thinned.
    pub(super) fn n_numbers(&self, curves: &ColoredCurves, knots: Option<&[usize]>) -> usize {
        let k = curves.n_channels;
        let mut count = curves.points.len() * (1 + k);
        for (i, bounds) in self.starts.windows(2).enumerate() {
            let edges = &self.edges[bounds[0]..bounds[1]];
            let closed = edges.first().map(|edge| edge.ends[0]) == edges.last().map(|edge| edge.ends[1]);
            let points = edges.len() + usize::from(!closed);
            let n_sides = edges.first().map_or(0, |edge| edge.regions.iter().flatten().count());
            count += 2 * points;
            count += knots.map_or(points * n_sides * k, |knots| knots[i] * (n_sides * k + 1));
        }
        count
    }

    /// A face for each vertex that has the copy which the vertex takes its color from.
    pub(super) fn sides(&self, fit: &CopyColors) -> Vec<Option<u32>> {
        let mut sides = vec![None; fit.owners.len()];
        for (f, face) in (0..).zip(&self.cut.faces) {
            for &copy in face {
                let v = self.cut.vertices[copy as usize] as usize;
                if sides[v].is_none() && fit.owners[v] == Some(copy) {
                    sides[v] = Some(f);
                }
            }
        }
        sides
    }
}
