//! The quadratic problem on the same mesh, with the same Cholesky factorization:
//! what every solver is compared with.
//!
//! `min_u Σ_f w_f A_f ‖H_f u‖²` with the values at `indices.u32` known (`fidelity=0`), or plus
//! `α ‖u − u₀‖²_M`: one factorization, one solve of all columns. Linear constraints are left out. Its parts
//! are timed as well, in the order in which they run.

use ridgeform_core::error::SolveError;

use ridgeform_core::block_rows::{BlockRows, BLOCK};
use ridgeform_core::linear::cholesky::Cholesky;
use ridgeform_core::mesh::{triangle, Mesh};
use ridgeform_core::operators::{voronoi_mass, Dual, HessianPattern};
use ridgeform_core::solve::cones::Block;
use ridgeform_core::solve::normal_matrix::NormalMatrix;
use ridgeform_core::Progress;

use crate::clock::Samples;
use crate::input::{Arguments, Problem};
use crate::{list, Outcome};

/// The whole solution, from the mesh on, and its parts.
pub(crate) fn measure(problem: &Problem, arguments: &Arguments) -> Outcome {
    match problem.values()?.n_columns {
        1 => of_columns::<1>(problem, arguments),
        3 => of_columns::<3>(problem, arguments),
        n => Err(format!("the yardstick takes one or three columns, not {n}").into()),
    }
}

fn of_columns<const K: usize>(problem: &Problem, arguments: &Arguments) -> Outcome {
    let mesh = problem.mesh()?;
    let fidelity = arguments.number("fidelity", 0.0)?;
    let known = if fidelity > 0.0 { Vec::new() } else { problem.known()?.0 };
    let columns = problem.values()?;
    let values: Vec<[f64; K]> =
        (0..columns.n_rows).map(|i| std::array::from_fn(|c| columns.column(c)[i])).collect();
    let weights = problem.face_weights()?;
    let set_up = || Quadratic::new(&mesh, &values, &known, fidelity, weights.as_deref());
    let mut whole = Samples::new(arguments)?;
    whole.take(|| set_up()?.solve())?;

    let mut quadratic = set_up()?;
    let mut symbolic = Samples::new(arguments)?;
    quadratic.cholesky =
        symbolic.take(|| Cholesky::analyze(quadratic.normal.pattern(), None, &Progress::new()))?;
    let mut numeric = Samples::new(arguments)?;
    numeric.take(|| quadratic.cholesky.factorize(&quadratic.entries, &Progress::new()))?;
    let mut solve = Samples::new(arguments)?;
    solve.take(|| quadratic.back_substitute(&quadratic.right.clone()))?;
    let mut fields = whole.fields();
    fields.push(("factor_entries", quadratic.cholesky.factor_len().to_string()));
    fields.extend([
        ("symbolic_wall_s", list(&symbolic.wall)),
        ("symbolic_cpu_s", list(&symbolic.cpu)),
        ("numeric_wall_s", list(&numeric.wall)),
        ("numeric_cpu_s", list(&numeric.cpu)),
        ("solve_wall_s", list(&solve.wall)),
        ("solve_cpu_s", list(&solve.cpu)),
    ]);
    Ok(fields)
}

/// The normal equations, ready to be factored.
struct Quadratic<const K: usize> {
    right: Vec<[f64; K]>,
    normal: NormalMatrix,
    cholesky: Cholesky,
    entries: Vec<f64>,
}

impl<const K: usize> Quadratic<K> {
    fn new(
        mesh: &Mesh,
        values: &[[f64; K]],
        known: &[usize],
        fidelity: f64,
        weights: Option<&[f64]>,
    ) -> Result<Self, Box<dyn std::error::Error>> {
        let (connectivity, lengths) = (mesh.connectivity(), mesh.edge_lengths());
        let whole = HessianPattern::new(connectivity)?.assemble(connectivity, lengths, Dual::Barycentric)?;
        let areas = lengths.iter().map(|&l| triangle::area(l));
        let mut per_face: Vec<f64> = areas.map(|a| if a > 0.0 { 1.0 / a } else { 0.0 }).collect();
        per_face.iter_mut().zip(weights.unwrap_or(&[])).for_each(|(x, w)| *x *= w);
        let mass = voronoi_mass(connectivity, lengths)?;
        let mut is_known = vec![false; values.len()];
        known.iter().for_each(|&i| is_known[i] = true);
        let (operator, constant) = without_columns(&whole, values, &is_known);
        let free: Vec<usize> = (0..values.len()).filter(|&i| !is_known[i]).collect();
        let mut right: Vec<[f64; K]> =
            free.iter().map(|&i| values[i].map(|x| fidelity * mass[i] * x)).collect();
        for (b, constant) in constant.iter().enumerate() {
            let (columns, entries) = operator.block(b);
            for (&column, entry) in columns.iter().zip(entries) {
                for (sum, c) in right[column as usize].iter_mut().zip(0..K) {
                    let product: f64 = entry.iter().zip(constant).map(|(x, row)| x * row[c]).sum();
                    *sum -= per_face[b] * product;
                }
            }
        }
        let diagonal: Vec<f64> = free.iter().map(|&i| fidelity * mass[i]).collect();
        let normal = NormalMatrix::new(&operator)?;
        let cholesky = Cholesky::analyze(normal.pattern(), None, &Progress::new())?;
        let mut entries = Vec::new();
        normal.assemble(&operator, &per_face, &diagonal, &mut entries);
        Ok(Self { right, normal, cholesky, entries })
    }

    fn back_substitute(&mut self, right: &[[f64; K]]) -> Result<Vec<[f64; K]>, SolveError> {
        let mut solution = right.to_vec();
        self.cholesky.solve(&mut solution)?;
        Ok(solution)
    }

    fn solve(mut self) -> Result<Vec<[f64; K]>, Box<dyn std::error::Error>> {
        self.cholesky.factorize(&self.entries, &Progress::new())?;
        self.cholesky.solve(&mut self.right)?;
        Ok(self.right)
    }
}

/// The operator on the unknown vertices, and what the known ones contribute to each block.
fn without_columns<const K: usize>(
    whole: &BlockRows,
    values: &[[f64; K]],
    is_known: &[bool],
) -> (BlockRows, Vec<Block<K>>) {
    let mut place = vec![0u32; is_known.len()];
    let mut n_free = 0;
    for (place, _) in place.iter_mut().zip(is_known).filter(|(_, known)| !**known) {
        *place = n_free;
        n_free += 1;
    }
    let mut kept = BlockRows { n_columns: n_free as usize, starts: vec![0], columns: vec![], values: vec![] };
    let mut constant = vec![[[0.0; K]; BLOCK]; whole.n_blocks()];
    for (b, constant) in constant.iter_mut().enumerate() {
        let (columns, entries) = whole.block(b);
        for (&column, entry) in columns.iter().zip(entries) {
            if is_known[column as usize] {
                for (sum, v) in constant.iter_mut().zip(entry) {
                    sum.iter_mut().zip(&values[column as usize]).for_each(|(s, x)| *s += v * x);
                }
            } else {
                kept.columns.push(place[column as usize]);
                kept.values.push(*entry);
            }
        }
        kept.starts.push(kept.columns.len());
    }
    (kept, constant)
}
