//! Times one thing on one mesh and prints a line of JSON: the measuring hand of `benchmarks/`.
//!
//! `measure KIND FOLDER [KEY=VALUE ...]`, where FOLDER holds the problem as raw little-endian numbers
//! ([`input`]). Kinds: `flow`, `interpolate`, `denoise`, `yardstick`, `assembly`. One process measures one
//! thing, so that its peak of memory is that thing's.
#![allow(missing_docs)]

mod clock;
mod input;
mod yardstick;

use clock::{peak_memory, Samples};
use input::{Arguments, Problem};
use ridgeform_core::mesh::Mesh;
use ridgeform_core::operators::{hessian, Dual, HessianPattern};
use ridgeform_core::progress::Progress;
use ridgeform_core::solve::{Solution, Solver, Status};
use ridgeform_core::tools::{
    denoise, interpolate, stylize, DenoiseOptions, EnergyOptions, FlowStatus, ScalarOptions, SolveOptions,
    StylizeOptions,
};

type Outcome = Result<Vec<(&'static str, String)>, Box<dyn std::error::Error>>;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments = Arguments::parse(std::env::args().skip(1))?;
    let threads = arguments.number("threads", 1.0)? as usize;
    rayon::ThreadPoolBuilder::new().num_threads(threads).build_global()?;
    let problem = Problem::read(&arguments.folder)?;
    let before = peak_memory();
    let mut fields = match arguments.kind.as_str() {
        "flow" => flow(&problem, &arguments),
        "interpolate" => interpolation(&problem, &arguments),
        "denoise" => denoising(&problem, &arguments),
        "yardstick" => yardstick::measure(&problem, &arguments),
        "assembly" => assembly(&problem, &arguments),
        kind => Err(format!("no kind of measurement is called {kind}").into()),
    }?;
    fields.push(("peak_bytes", (peak_memory().saturating_sub(before)).to_string()));
    let fields: Vec<String> = fields.iter().map(|(name, value)| format!("\"{name}\": {value}")).collect();
    println!("{{{}}}", fields.join(", "));
    Ok(())
}

fn solve_options(arguments: &Arguments) -> Result<SolveOptions, Box<dyn std::error::Error>> {
    let solver = match arguments.word("solver", "fast") {
        "fast" => Solver::Fast,
        "qdldl" => Solver::ClarabelQdldl,
        "faer" => Solver::ClarabelFaer,
        other => return Err(format!("no solver is called {other}").into()),
    };
    let tolerance = match arguments.word("tolerance", "1e-3") {
        "residuals" => None,
        number => Some(number.parse()?),
    };
    let max_iterations = match arguments.number("max_iterations", 0.0)? as usize {
        0 => None,
        bound => Some(bound),
    };
    Ok(SolveOptions { solver, tolerance, max_iterations, ..SolveOptions::default() })
}

/// The weights and constraints of the folder; several columns share one norm.
fn scalar_options(
    problem: &Problem,
    arguments: &Arguments,
) -> Result<ScalarOptions, Box<dyn std::error::Error>> {
    Ok(ScalarOptions {
        energy: EnergyOptions { face_weights: problem.face_weights()?, ..EnergyOptions::default() },
        linear_constraints: problem.linear_constraints()?,
        solve: solve_options(arguments)?,
        ..ScalarOptions::default()
    })
}

/// `steps` steps of the flow from the mesh as it is, in one call.
fn flow(problem: &Problem, arguments: &Arguments) -> Outcome {
    let mesh = problem.mesh()?;
    let options = StylizeOptions {
        iterations: arguments.number("steps", 1.0)? as usize,
        fidelity: arguments.number("fidelity", 500.0)?,
        sharpness: arguments.number("sharpness", 0.5)?,
        solve: solve_options(arguments)?,
        ..StylizeOptions::default()
    };
    let mut samples = Samples::new(arguments)?;
    let result = samples.take(|| stylize(&mesh, &options, &Progress::new()))?;
    let mut fields = samples.fields();
    fields.extend([
        ("gaps", list(&result.gap)),
        ("iterations", format!("{:?}", result.solver_iterations)),
        ("factorisations", result.factorisations.to_string()),
        ("energy", list(&result.energy)),
        ("complete", (result.status == FlowStatus::Finished).to_string()),
    ]);
    Ok(fields)
}

fn interpolation(problem: &Problem, arguments: &Arguments) -> Outcome {
    let mesh = problem.mesh()?;
    let (indices, values) = problem.known()?;
    let options = scalar_options(problem, arguments)?;
    let mut samples = Samples::new(arguments)?;
    let solution = samples.take(|| interpolate(&mesh, &indices, &values, &options, &Progress::new()))?;
    Ok(solved(&samples, &solution))
}

fn denoising(problem: &Problem, arguments: &Arguments) -> Outcome {
    let mesh = problem.mesh()?;
    let values = problem.values()?;
    let options = DenoiseOptions {
        fidelity: arguments.number("fidelity", 1e3)?,
        scalar: scalar_options(problem, arguments)?,
        ..DenoiseOptions::default()
    };
    let mut samples = Samples::new(arguments)?;
    let solution = samples.take(|| denoise(&mesh, &values, &options, &Progress::new()))?;
    Ok(solved(&samples, &solution))
}

fn solved(samples: &Samples, solution: &Solution) -> Vec<(&'static str, String)> {
    let mut fields = samples.fields();
    fields.extend([
        ("gap", format!("{:e}", solution.gap)),
        ("objective", format!("{:e}", solution.objective)),
        ("iterations", solution.iterations.to_string()),
        ("factorisations", solution.factorisations.to_string()),
        ("complete", (solution.status == Status::Solved).to_string()),
    ]);
    fields
}

/// Positions and faces to the matrix `H` of eq. (30), and new values on a pattern that is known.
fn assembly(problem: &Problem, arguments: &Arguments) -> Outcome {
    let mesh = problem.mesh()?;
    let pattern = HessianPattern::new(mesh.connectivity())?;
    let (connectivity, lengths) = (mesh.connectivity(), mesh.edge_lengths());
    let mut rows = pattern.assemble(connectivity, lengths, Dual::Barycentric)?;
    let mut cold = Samples::new(arguments)?;
    let matrix = cold.take(|| {
        let mesh = Mesh::new(problem.vertices.clone(), problem.faces.clone())?;
        hessian(&mesh, Dual::Barycentric)
    })?;
    let mut again = Samples::new(arguments)?;
    again.take(|| pattern.assemble_into(connectivity, lengths, Dual::Barycentric, &mut rows))?;
    let mut fields = cold.fields();
    let norm = matrix.data().iter().map(|x| x * x).sum::<f64>().sqrt();
    fields.extend([
        ("entries", matrix.nnz().to_string()),
        ("frobenius", format!("{norm:e}")),
        ("again_wall_s", list(&again.wall)),
        ("again_cpu_s", list(&again.cpu)),
    ]);
    Ok(fields)
}

/// Numbers as a JSON list.
fn list(values: &[f64]) -> String {
    let numbers: Vec<String> = values.iter().map(|x| format!("{x:e}")).collect();
    format!("[{}]", numbers.join(", "))
}
