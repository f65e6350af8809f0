//! The colors of a surface along its curves: the screened Poisson fit of the paper, then least squares.

use super::constants::{FIT, MOST_FITS};
use super::membrane::{Harmonic, Membrane, Screened};
use crate::linear::bounded;
use crate::linear::Columns;
use crate::mesh::partition::Partition;
use crate::mesh::CutMesh;
use crate::progress::Progress;
use crate::{memory, Result};

/// What is fitted to.
pub(super) struct Task<'a> {
    pub cut: &'a CutMesh,
    pub membrane: &'a Membrane,
    /// The colors at the vertices, one row each.
    pub colors: &'a Columns,
    /// `α` of (27), per area.
    pub fidelity: f64,
}

/// Colors of the copies, and which of its copies each vertex takes its color from.
pub(super) struct CopyColors {
    pub values: Columns,
    /// The copy whose side a vertex is on; nothing for one that is a blend of its sides and for vertices
    /// without faces.
    pub owners: Vec<Option<u32>>,
    /// How much each copy's datum counts: its area, or nothing.
    weights: Vec<f64>,
}

impl Task<'_> {
    /// Solves (27) on every piece of the cut surface.
    ///
    /// A vertex on a curve has one color, which belongs to one of its sides or is a blend of them. A first
    /// fit leaves such vertices out and tells, by the nearest color, which it is; the next uses it on its
    /// side and nowhere else.
    pub(super) fn screened(&self, progress: &Progress) -> Result<CopyColors> {
        let copies = self.copies()?;
        let mut roots = pieces(self.cut)?;
        let single = |copy: usize| copies[self.cut.vertices[copy] as usize].len() == 1;
        let target = self.target()?;
        let mut weights = self.weights(&mut roots, single)?;
        let mut system = Screened::new(self.membrane);
        let mut values = self.solve(&mut system, &weights, &target, progress)?;
        let mut owners = Vec::new();
        for _ in 0..MOST_FITS {
            owners = memory::gathered(copies.iter().map(|copies| owner(copies, &values, &target)))?;
            let owned = |copy: usize| owners[self.cut.vertices[copy] as usize] == Some(copy as u32);
            let next = self.weights(&mut roots, owned)?;
            if next == weights || progress.is_finishing() {
                break;
            }
            weights = next;
            values = self.solve(&mut system, &weights, &target, progress)?;
        }
        Ok(CopyColors { values, owners, weights })
    }

    fn solve(
        &self,
        system: &mut Screened<'_>,
        weights: &[f64],
        target: &Columns,
        progress: &Progress,
    ) -> Result<Columns> {
        let scaled: Vec<f64> = memory::gathered(weights.iter().map(|w| self.fidelity * w))?;
        let mut values = system.screened(&scaled, target, progress)?;
        // The maximum principle, to the last bit.
        for c in 0..values.n_columns {
            let [least, most] = range(target.column(c));
            values.column_mut(c).iter_mut().for_each(|x| *x = x.clamp(least, most));
        }
        Ok(values)
    }

    /// Least squares over the colors of the fixed copies: `min Σ_v m_v (c_v − t_v)²` for the colors `c` that
    /// the vertices take from the harmonic function through them, each channel within the range of the data.
    /// The start is (27), and an early stop keeps of it what the data do not determine.
    pub(super) fn refined(
        &self,
        fit: &mut CopyColors,
        harmonic: &mut Harmonic<'_>,
        progress: &Progress,
    ) -> Result<()> {
        let reading = Reading::new(self, &fit.owners)?;
        let mut rebuilt = fit.values.copied()?;
        harmonic.extend(&mut rebuilt, progress)?;
        let taken = reading.taken(&rebuilt)?;
        let data = memory::gathered(self.colors.data.iter().zip(&taken.data).map(|(t, u)| t - u))?;
        let mut descent = reading.given_back(Columns { data, ..taken })?;
        harmonic.transposed(&mut descent, progress)?;
        let bounds: Vec<[f64; 2]> = (0..taken.n_columns).map(|c| self.range(c)).collect();
        let is_enough = || progress.is_finishing();
        bounded::minimize(&mut fit.values, &descent, &bounds, FIT, is_enough, |columns| {
            harmonic.extend(columns, progress)?;
            *columns = reading.given_back(reading.taken(columns)?)?;
            harmonic.transposed(columns, progress)
        })
    }

    /// The range of a channel of the data on the surface; vertices without faces do not count.
    fn range(&self, c: usize) -> [f64; 2] {
        let data = self.colors.column(c);
        range(self.cut.vertices.iter().map(|&v| &data[v as usize]))
    }

    /// The mean of the data of every piece, in the row of its root.
    ///
    /// # Errors
    /// [`crate::Error::Solve`] where memory is missing, here and below.
    pub(super) fn means(&self, fit: &CopyColors, roots: &mut Partition) -> Result<Columns> {
        let n = self.cut.n_copies();
        let root: Vec<usize> = memory::gathered((0..n).map(|i| roots.root(i as u32) as usize))?;
        let mut totals = memory::repeated(0.0, n)?;
        root.iter().zip(&fit.weights).for_each(|(&r, w)| totals[r] += w);
        let mut means = Columns::try_zeros(n, self.colors.n_columns)?;
        for c in 0..self.colors.n_columns {
            let data = self.colors.column(c);
            let [least, most] = self.range(c);
            let sums = means.column_mut(c);
            for (i, &r) in root.iter().enumerate() {
                sums[r] += fit.weights[i] * data[self.cut.vertices[i] as usize];
            }
            sums.iter_mut().zip(&totals).for_each(|(x, total)| *x = (*x / total).clamp(least, most));
        }
        Ok(means)
    }

    /// The area of every copy that counts; all of a piece where none of it would.
    fn weights(&self, roots: &mut Partition, counts: impl Fn(usize) -> bool) -> Result<Vec<f64>> {
        let mass = &self.membrane.mass;
        let counted = (0..mass.len()).map(|i| if counts(i) { mass[i] } else { 0.0 });
        let mut weights: Vec<f64> = memory::gathered(counted)?;
        for fallback in [|area: f64| area, |_| 1.0] {
            let mut sums = memory::repeated(0.0, mass.len())?;
            (0..mass.len()).for_each(|i| sums[roots.root(i as u32) as usize] += weights[i]);
            let empty = |i: usize, roots: &mut Partition| sums[roots.root(i as u32) as usize] <= 0.0;
            (0..mass.len()).filter(|&i| empty(i, roots)).for_each(|i| weights[i] = fallback(mass[i]));
        }
        Ok(weights)
    }

    fn target(&self) -> Result<Columns> {
        let vertices = &self.cut.vertices;
        let mut data = memory::room(vertices.len() * self.colors.n_columns)?;
        for c in 0..self.colors.n_columns {
            data.extend(vertices.iter().map(|&v| self.colors.column(c)[v as usize]));
        }
        Ok(Columns { n_rows: vertices.len(), n_columns: self.colors.n_columns, data })
    }

    /// The copies of every vertex.
    pub(super) fn copies(&self) -> Result<Vec<Vec<u32>>> {
        let mut copies = memory::repeated(Vec::new(), self.colors.n_rows)?;
        (0..).zip(&self.cut.vertices).for_each(|(copy, &v)| copies[v as usize].push(copy));
        Ok(copies)
    }
}

/// How vertices take their colors from copies: from one of them, or the mean of theirs; weighted by area.
struct Reading<'a> {
    vertices: &'a [u32],
    /// What part of its vertex's color a copy is.
    parts: Vec<f64>,
    /// The area of each vertex.
    mass: Vec<f64>,
}

impl<'a> Reading<'a> {
    fn new(task: &Task<'a>, owners: &[Option<u32>]) -> Result<Self> {
        let vertices = &task.cut.vertices;
        let (mut mass, mut counts) =
            (memory::repeated(0.0, owners.len())?, memory::repeated(0.0, owners.len())?);
        for (&v, m) in vertices.iter().zip(&task.membrane.mass) {
            mass[v as usize] += m;
            counts[v as usize] += 1.0;
        }
        let part = |(copy, &v): (u32, &u32)| match owners[v as usize] {
            Some(owner) => f64::from(u8::from(owner == copy)),
            None => 1.0 / counts[v as usize],
        };
        let parts = memory::gathered((0..vertices.len() as u32).zip(vertices).map(part))?;
        Ok(Self { vertices, parts, mass })
    }

    /// The colors of the vertices.
    fn taken(&self, values: &Columns) -> Result<Columns> {
        let mut taken = Columns::try_zeros(self.mass.len(), values.n_columns)?;
        for c in 0..values.n_columns {
            let out = taken.column_mut(c);
            let copies = self.vertices.iter().zip(&self.parts).zip(values.column(c));
            copies.for_each(|((&v, part), x)| out[v as usize] += part * x);
        }
        Ok(taken)
    }

    /// The transpose of [`Reading::taken`] times the areas.
    fn given_back(&self, values: Columns) -> Result<Columns> {
        let copy = |c: usize| {
            let column = values.column(c);
            self.vertices
                .iter()
                .zip(&self.parts)
                .map(|(&v, part)| part * self.mass[v as usize] * column[v as usize])
        };
        let mut data = memory::room(self.vertices.len() * values.n_columns)?;
        (0..values.n_columns).for_each(|c| data.extend(copy(c)));
        Ok(Columns { n_rows: self.vertices.len(), n_columns: values.n_columns, data })
    }
}

/// Which of its `copies` has the color of a vertex; none if the mean of theirs is nearer to it.
fn owner(copies: &[u32], values: &Columns, target: &Columns) -> Option<u32> {
    let first = *copies.first()? as usize;
    let distance = |color: &dyn Fn(&[f64]) -> f64| {
        let term = |c: usize| color(values.column(c)) - target.column(c)[first];
        (0..values.n_columns).map(|c| term(c).powi(2)).sum::<f64>()
    };
    let sides = copies.iter().map(|&copy| (copy, distance(&|column| column[copy as usize])));
    let (nearest, off) = sides.min_by(|a, b| a.1.total_cmp(&b.1))?;
    let count = copies.len() as f64;
    let blend = distance(&|column| copies.iter().map(|&copy| column[copy as usize]).sum::<f64>() / count);
    (off <= blend).then_some(nearest)
}

/// The pieces of a cut surface: copies that faces connect.
///
/// # Errors
/// [`crate::Error::Solve`] where memory is missing.
pub(super) fn pieces(cut: &CutMesh) -> Result<Partition> {
    let mut roots = Partition::new(cut.n_copies())?;
    for &[a, b, c] in &cut.faces {
        roots.unite(a, b);
        roots.unite(b, c);
    }
    Ok(roots)
}

fn range<'x>(column: impl IntoIterator<Item = &'x f64>) -> [f64; 2] {
    column
        .into_iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], &x| [least.min(x), most.max(x)])
}
