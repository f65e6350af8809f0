//! Random problems of every class, each determined by its seed alone.

mod surfaces;

use ridgeform_core::block_rows::BlockRows;
use ridgeform_core::linear::Columns;
use ridgeform_core::mesh::{triangle, Mesh};
use ridgeform_core::operators::{voronoi_mass, Dual, HessianPattern};
use ridgeform_core::shapes::Random;
use ridgeform_core::solve::{Coupling, Problem};
use ridgeform_core::tools::sharpened_weights;
use sprs::{CsMat, TriMat};

use surfaces::{parts, surface};

/// What kind of problem it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Class {
    /// Ten to a thousand known values.
    SparsePoints,
    /// Everything known but a patch.
    Hole,
    /// Noise from a thousandth to three times the function, whatever the fidelity.
    Denoising,
    /// Weights `v²` down to 1e-6: near ridges, or anywhere.
    WeightedFaces,
    /// A mean, differences, and random sparse rows.
    LinearConstraints,
    /// Two to five columns, jointly or separately.
    Coordinates,
    /// Weights of a reweighted round.
    Sharpened,
}

impl Class {
    /// All of them.
    pub(crate) const ALL: [Self; 7] = [
        Self::SparsePoints,
        Self::Hole,
        Self::Denoising,
        Self::WeightedFaces,
        Self::LinearConstraints,
        Self::Coordinates,
        Self::Sharpened,
    ];
}

/// A problem that owns its operator.
#[derive(Debug, Clone)]
pub(crate) struct Case {
    /// Seed, class, surface and what else was drawn.
    pub name: String,
    operator: BlockRows,
    weights: Vec<f64>,
    fidelity: Vec<f64>,
    target: Columns,
    fixed: Vec<bool>,
    linear_constraints: Option<(CsMat<f64>, Columns)>,
    coupling: Coupling,
}

impl Case {
    /// The problem of a seed, on a surface of roughly `n` vertices.
    pub(crate) fn new(seed: u64, n: usize) -> Self {
        let random = &mut Random::new(seed);
        let class = Class::ALL[(seed % Class::ALL.len() as u64) as usize];
        let (kind, shape) = surface(random, n);
        let mesh = shape.mesh().unwrap();
        let connectivity = mesh.connectivity();
        let operator = HessianPattern::new(connectivity)
            .unwrap()
            .assemble(connectivity, mesh.edge_lengths(), Dual::Barycentric)
            .unwrap();
        let n = operator.n_columns;
        let columns = if class == Class::Coordinates { 2 + pick(random, 4) } else { 1 };
        // No unit is special: values of any size, and a fidelity that means the same for all sizes and
        // scales.
        let amplitude = 10f64.powf(2.0 * random.symmetric());
        let noise = 10f64.powf(-3.0 + 3.5 * random.uniform());
        let data = Data { clean: ridges(&mesh, columns, amplitude, random), noise: noise * amplitude };
        let alpha = 10f64.powf(1.0 + 4.0 * random.uniform()) / (amplitude * size(&mesh).powi(2));
        let mut case = Self {
            name: format!("seed {seed}, {class:?} on {kind} with {n} vertices"),
            weights: vec![1.0; operator.n_blocks()],
            operator,
            fidelity: vec![0.0; n],
            target: data.clean.clone(),
            fixed: vec![false; n],
            linear_constraints: None,
            coupling: Coupling::Joint,
        };
        let interpolates = match class {
            Class::SparsePoints | Class::Hole => true,
            Class::Denoising => false,
            _ => random.uniform() < 0.4,
        };
        if !interpolates {
            case.fidelity =
                voronoi_mass(connectivity, mesh.edge_lengths()).unwrap().iter().map(|m| alpha * m).collect();
            data.add_noise(&mut case.target, random);
            case.name +=
                &format!(", noise {noise:.1e}, fidelity {:.1e}", alpha * amplitude * size(&mesh).powi(2));
        } else if class == Class::Hole {
            case.fix_around_a_patch(&mesh, random);
        } else {
            case.fix_points(&mesh, random);
        }
        match class {
            Class::WeightedFaces => case.weights = weights(&case.operator, &data.clean, random),
            Class::LinearConstraints => case.constrain(&mesh, &data.clean, random),
            Class::Coordinates if random.uniform() < 0.5 => case.coupling = Coupling::Separate,
            Class::Sharpened => {
                let areas: Vec<f64> = mesh.edge_lengths().iter().map(|&l| triangle::area(l)).collect();
                let norms = norms(&case.operator, &case.target);
                case.weights =
                    sharpened_weights(&norms, &areas, &case.weights, 0.2 + 0.8 * random.uniform()).unwrap();
            }
            _ => {}
        }
        case
    }

    /// As the solvers take it.
    pub(crate) fn problem(&self) -> Problem<'_> {
        Problem {
            operator: &self.operator,
            weights: self.weights.clone(),
            fidelity: self.fidelity.clone(),
            target: self.target.clone(),
            fixed: self.fixed.clone(),
            linear_constraints: self.linear_constraints.clone(),
            coupling: self.coupling,
        }
    }

    /// A neighbor of the problem, as the next step of a flow or the next frame would be:
    /// a hundredth more noise.
    pub(crate) fn neighbor(&self, seed: u64) -> Problem<'_> {
        let mut problem = self.problem();
        let size = problem.target.data.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
        let mut random = Random::new(seed);
        problem.target.data.iter_mut().for_each(|x| *x += 0.01 * size * random.symmetric());
        problem
    }

    /// Keeps ten to a thousand points, at least one of each part, and forgets the others.
    fn fix_points(&mut self, mesh: &Mesh, random: &mut Random) {
        let n = self.fixed.len();
        let count = (10f64.powf(1.0 + 2.0 * random.uniform()) as usize).min(2 * n / 3).max(1);
        let order = random.permutation(n);
        order[..count].iter().for_each(|&i| self.fixed[i] = true);
        let part = parts(mesh.connectivity().faces(), n);
        for &i in &order[count..] {
            if !(0..n).any(|k| part[k] == part[i] && self.fixed[k]) {
                self.fixed[i] = true;
            }
        }
        self.name += &format!(", {} known", self.fixed.iter().filter(|x| **x).count());
        self.forget();
    }

    /// Frees the vertices within a ball around one of them, up to a third of the surface's size.
    fn fix_around_a_patch(&mut self, mesh: &Mesh, random: &mut Random) {
        let points = mesh.positions().unwrap();
        let center = points[pick(random, points.len())];
        let radius = (0.1 + 0.25 * random.uniform()) * size(mesh);
        let distance = |p: &[f64; 3]| (0..3).map(|k| (p[k] - center[k]).powi(2)).sum::<f64>().sqrt();
        self.fixed = points.iter().map(|p| distance(p) > radius).collect();
        if self.fixed.iter().all(|x| !x) {
            self.fixed[0] = true;
        }
        self.forget();
    }

    /// The free rows start from the mean of the known values.
    fn forget(&mut self) {
        let known = self.fixed.iter().filter(|x| **x).count() as f64;
        for c in 0..self.target.n_columns {
            let column = self.target.column_mut(c);
            let sum: f64 = column.iter().zip(&self.fixed).filter(|(_, fixed)| **fixed).map(|(x, _)| x).sum();
            column
                .iter_mut()
                .zip(&self.fixed)
                .filter(|(_, fixed)| !**fixed)
                .for_each(|(x, _)| *x = sum / known);
        }
    }

    /// One to four rows on free vertices that a function near `clean` fulfils: the mean,
    /// or a random combination.
    fn constrain(&mut self, mesh: &Mesh, clean: &Columns, random: &mut Random) {
        let free: Vec<usize> = (0..self.fixed.len()).filter(|&i| !self.fixed[i]).collect();
        let count = (1 + pick(random, 4)).min(free.len() / 2);
        if count == 0 {
            return;
        }
        let mass = voronoi_mass(mesh.connectivity(), mesh.edge_lengths()).unwrap();
        let total: f64 = mass.iter().sum();
        let mut rows = TriMat::new((count, self.fixed.len()));
        let mut right = vec![0.0; count];
        let order = random.permutation(free.len());
        for (row, right) in right.iter_mut().enumerate() {
            let entries: Vec<(usize, f64)> = if row == 0 && random.uniform() < 0.5 {
                mass.iter().enumerate().map(|(i, m)| (i, m / total)).collect()
            } else {
                // A vertex that no other row speaks of keeps the rows independent.
                let mut entries = vec![(free[order[row]], 1.0 + random.uniform())];
                for _ in 0..pick(random, 4) {
                    entries.push((free[pick(random, free.len())], 0.3 * random.symmetric()));
                }
                entries
            };
            for (i, value) in entries {
                rows.add_triplet(row, i, value);
                *right += value * clean.data[i];
            }
            *right *= 1.0 + 0.1 * random.symmetric();
        }
        self.linear_constraints = Some((rows.to_csr(), Columns::from_column(right)));
    }
}

struct Data {
    clean: Columns,
    noise: f64,
}

impl Data {
    fn add_noise(&self, target: &mut Columns, random: &mut Random) {
        target.data.iter_mut().for_each(|x| *x += self.noise * random.symmetric());
    }
}

/// A number below `n`, which is not zero.
fn pick(random: &mut Random, n: usize) -> usize {
    (random.bits() % n as u64) as usize
}

/// The longest side of the bounding box.
fn size(mesh: &Mesh) -> f64 {
    let points = mesh.positions().unwrap();
    let side = |k: usize| {
        let along = points.iter().map(|p| p[k]);
        along.clone().fold(f64::MIN, f64::max) - along.fold(f64::MAX, f64::min)
    };
    side(0).max(side(1)).max(side(2))
}

/// In every column a ridge in a random direction, a slope, and now and then something smooth.
fn ridges(mesh: &Mesh, n_columns: usize, amplitude: f64, random: &mut Random) -> Columns {
    let points = mesh.positions().unwrap();
    let unit = 1.0 / size(mesh);
    let mut columns = Columns::zeros(points.len(), n_columns);
    for c in 0..n_columns {
        let [along, slope]: [[f64; 3]; 2] =
            std::array::from_fn(|_| std::array::from_fn(|_| random.symmetric()));
        let (offset, smooth) = (random.symmetric(), if random.uniform() < 0.3 { 0.5 } else { 0.0 });
        let middle = points[pick(random, points.len())];
        for (x, p) in columns.column_mut(c).iter_mut().zip(points) {
            let [a, b] =
                [along, slope].map(|d| (0..3).map(|k| unit * d[k] * (p[k] - middle[k])).sum::<f64>());
            *x = amplitude * (2.0 * a.abs() + b + offset + smooth * (6.0 * b).sin());
        }
    }
    columns
}

/// `‖(H u)_b‖`, joint over the columns.
fn norms(operator: &BlockRows, u: &Columns) -> Vec<f64> {
    let squares = |b| (0..u.n_columns).flat_map(move |c| operator.block_times(b, u.column(c))).map(|x| x * x);
    (0..operator.n_blocks()).map(|b| squares(b).sum::<f64>().sqrt()).collect()
}

/// Half of the time `v²` as a segmentation has it, 1 away from the ridges of `u` and down to 1e-6 on them;
/// else log-uniform, with a few zeros.
fn weights(operator: &BlockRows, u: &Columns, random: &mut Random) -> Vec<f64> {
    if random.uniform() < 0.5 {
        let mut draw = || if random.uniform() < 0.02 { 0.0 } else { 10f64.powf(-6.0 * random.uniform()) };
        return (0..operator.n_blocks()).map(|_| draw()).collect();
    }
    let norms = norms(operator, u);
    let longest = norms.iter().fold(f64::MIN_POSITIVE, |a: f64, x| a.max(*x));
    norms.iter().map(|x| (1.0 - 1.2 * x / longest).max(1e-3).powi(2)).collect()
}
