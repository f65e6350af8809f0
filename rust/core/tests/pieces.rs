//! Problems on several connected pieces: each as by itself, together as certain as was asked for.
#![allow(clippy::unwrap_used, missing_docs)]

use ridgeform_core::block_rows::BlockRows;
use ridgeform_core::linear::Columns;
use ridgeform_core::mesh::Mesh;
use ridgeform_core::operators::{voronoi_mass, Dual, HessianPattern};
use ridgeform_core::shapes::{self, Random, Shape};
use ridgeform_core::solve::{solve, Coupling, Problem, Session, Settings, Solution, Solver, Status};
use ridgeform_core::Progress;

fn operator(mesh: &Mesh) -> BlockRows {
    let c = mesh.connectivity();
    HessianPattern::new(c).unwrap().assemble(c, mesh.edge_lengths(), Dual::Barycentric).unwrap()
}

/// Noisy positions to be smoothed.
fn problem<'a>(mesh: &Mesh, operator: &'a BlockRows, noise: f64, seed: u64) -> Problem<'a> {
    let mut random = Random::new(seed);
    let points: Vec<[f64; 3]> =
        mesh.positions().unwrap().iter().map(|p| p.map(|x| x + noise * random.symmetric())).collect();
    let mass = voronoi_mass(mesh.connectivity(), mesh.edge_lengths()).unwrap();
    Problem {
        operator,
        weights: vec![1.0; operator.n_blocks()],
        fidelity: mass.iter().map(|m| 100.0 * m).collect(),
        target: Columns::from_points(&points).unwrap(),
        fixed: vec![false; operator.n_columns],
        linear_constraints: None,
        coupling: Coupling::Joint,
    }
}

fn solved(problem: &Problem<'_>, settings: &Settings) -> Solution {
    Session::new().solve(problem, settings, &Progress::new()).unwrap()
}

/// Rows `from..` of every column.
fn rows(columns: &Columns, from: usize, count: usize) -> Vec<f64> {
    (0..columns.n_columns).flat_map(|c| columns.column(c)[from..from + count].to_vec()).collect()
}

fn houses() -> [Shape; 3] {
    [
        shapes::cube(4),
        shapes::icosphere(2).map(|p| p.map(|x| 0.3 * x + 4.0)),
        shapes::grid(7, 5).map(|p| [p[0], p[1], p[2] - 9.0]),
    ]
}

#[test]
fn what_becomes_of_a_piece_does_not_depend_on_others() {
    let houses = houses();
    let city = houses[0].clone().and(&houses[1]).and(&houses[2]).mesh().unwrap();
    let h = operator(&city);
    let whole = problem(&city, &h, 0.05, 1);
    for tolerance in [Some(1e-3), Some(1e-5), None] {
        let settings = Settings { tolerance, ..Settings::default() };
        let found = solved(&whole, &settings);
        assert_eq!(found.status, Status::Solved);
        let (mut from, mut objective, mut bound) = (0, 0.0, 0.0);
        for house in &houses {
            let (mesh, count) = (house.mesh().unwrap(), house.vertices.len());
            let h = operator(&mesh);
            let target = Columns { n_rows: count, n_columns: 3, data: rows(&whole.target, from, count) };
            let alone = Problem {
                fidelity: whole.fidelity[from..from + count].to_vec(),
                target,
                ..problem(&mesh, &h, 0.0, 1)
            };
            let alone = solved(&alone, &settings);
            let apart = alone.values.data.iter().zip(rows(&found.values, from, count));
            assert!(apart.clone().all(|(x, y)| (x - y).abs() < 1e-9), "from row {from}");
            assert!(alone.iterations <= found.iterations);
            from += count;
            objective += alone.objective;
            bound += alone.dual_objective;
        }
        assert!((found.objective - objective).abs() < 1e-9 * objective);
        assert!((found.dual_objective - bound).abs() < 1e-9 * objective);
        assert!(tolerance.is_none_or(|tolerance| found.gap <= tolerance));
    }
}

#[test]
fn the_sum_of_the_bounds_is_one_of_the_whole() {
    let houses = houses();
    let city = houses[0].clone().and(&houses[1]).and(&houses[2]).mesh().unwrap();
    let h = operator(&city);
    let mut whole = problem(&city, &h, 0.05, 2);
    whole.fixed[3] = true;
    for coupling in [Coupling::Joint, Coupling::Separate] {
        whole.coupling = coupling;
        let settings = Settings { tolerance: Some(1e-4), ..Settings::default() };
        let found = solved(&whole, &settings);
        let settings = Settings { tolerance: Some(1e-7), ..Settings::default() };
        let exact = solve(&whole, Solver::Clarabel, &settings, &Progress::new()).unwrap();
        let slack = 1e-8 * exact.objective;
        assert!(found.gap <= 1e-4 && found.status == Status::Solved);
        assert!(found.dual_objective <= exact.objective + slack);
        assert!(exact.dual_objective <= found.objective + slack);
        assert!((whole.objective(&found.values, false) - found.objective).abs() <= slack);
        assert_eq!(found.values.column(0)[3].to_bits(), whole.target.column(0)[3].to_bits());
    }
}

#[test]
fn what_a_limit_of_memory_allows_is_shared() {
    let two = shapes::icosphere(3).and(&shapes::icosphere(3).map(|p| p.map(|x| x + 5.0))).mesh().unwrap();
    let h = operator(&two);
    let problem = problem(&two, &h, 0.05, 4);
    let run = |memory_limit| {
        let settings = Settings { memory_limit, ..Settings::default() };
        Session::new().solve(&problem, &settings, &Progress::new())
    };
    let enough = (1..).map(|k| k * 50_000).find(|&limit| run(Some(limit)).is_ok()).unwrap();
    assert!(run(Some(enough * 6 / 10)).is_err());
    assert_eq!(run(Some(enough)).unwrap(), run(None).unwrap());
}

#[test]
fn a_wish_to_finish_leaves_pieces_that_were_not_begun() {
    let houses = houses();
    let city = houses[0].clone().and(&houses[1]).mesh().unwrap();
    let h = operator(&city);
    let problem = problem(&city, &h, 0.05, 5);
    let progress = Progress::new();
    progress.finish();
    let found = Session::new().solve(&problem, &Settings::default(), &progress).unwrap();
    assert_eq!(found.status, Status::Stopped);
    let (first, second) = (houses[0].vertices.len(), houses[1].vertices.len());
    assert_ne!(rows(&found.values, 0, first), rows(&problem.target, 0, first));
    assert_eq!(rows(&found.values, first, second), rows(&problem.target, first, second));
    progress.cancel();
    assert!(Session::new().solve(&problem, &Settings::default(), &progress).is_err());
}
