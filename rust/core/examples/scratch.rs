use ridgeform_core::mesh::Mesh;
use ridgeform_core::solve::*;
use ridgeform_core::tools::*;
use ridgeform_core::Progress;
use std::time::Instant;
fn load(p: &str) -> Mesh {
    let mut v = vec![];
    let mut f = vec![];
    for l in std::fs::read_to_string(p).unwrap().lines() {
        let mut t = l.split_whitespace();
        match t.next() {
            Some("v") => {
                let c: Vec<f64> = t.map(|x| x.parse().unwrap()).collect();
                v.push([c[0], c[1], c[2]]);
            }
            Some("f") => {
                let c: Vec<u32> = t.map(|x| x.split('/').next().unwrap().parse::<u32>().unwrap() - 1).collect();
                for i in 1..c.len() - 1 {
                    f.push([c[0], c[i], c[i + 1]]);
                }
            }
            _ => {}
        }
    }
    Mesh::new(v, f).unwrap()
}
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let mesh = load(&a[1]);
    let n = mesh.connectivity().n_vertices();
    println!("{} n={}", a[1], n);
    let p = Progress::new();
    match a[2].as_str() {
        "flow" => {
            let eta: f64 = a[3][1..].parse().unwrap();
            let sc = match &a[3][..1] {
                "b" => Scale::BoundingBox,
                "a" => Scale::Area,
                _ => Scale::MaxEdge,
            };
            let steps: usize = a[4].parse().unwrap();
            let sh: f64 = a[5].parse().unwrap();
            let tol = a.get(6).and_then(|x| x.parse::<f64>().ok()).filter(|x| *x > 0.);
            let mut o = StylizeOptions {
                iterations: steps,
                fidelity: eta.abs(),
                sharpness: sh,
                scale: sc,
                ..Default::default()
            };
            o.solve.tolerance = tol;
            let t = Instant::now();
            let r = stylize(&mesh, &o, &p).unwrap();
            let s = t.elapsed().as_secs_f64();
            println!(
                "{:?} {:.3}s/step, fact {} its {:?}\n gap {:?}\n E {:.4} -> {:.4}",
                r.status,
                s / steps as f64,
                r.factorisations,
                r.solver_iterations,
                r.gap.iter().map(|g| (g * 1e5).round() / 1e5).collect::<Vec<_>>(),
                r.energy[0],
                r.energy.last().unwrap()
            );
            if let Some(o) = a.get(7) {
                let mut s = String::new();
                for v in &r.vertices {
                    s += &format!("v {} {} {}\n", v[0], v[1], v[2]);
                }
                for f in mesh.connectivity().faces() {
                    s += &format!("f {} {} {}\n", f[0] + 1, f[1] + 1, f[2] + 1);
                }
                std::fs::write(o, s).unwrap();
            }
        }
        "denoise" | "interp" => {
            let tol: f64 = a[4].parse().unwrap();
            let pts = mesh.positions().unwrap();
            let mut seed = 12345u64;
            let mut rnd = || {
                seed ^= seed << 13;
                seed ^= seed >> 7;
                seed ^= seed << 17;
                (seed >> 11) as f64 / (1u64 << 53) as f64
            };
            let (lo, hi) = pts.iter().fold(([1e30; 3], [-1e30; 3]), |(mut l, mut h), q| {
                for c in 0..3 {
                    l[c] = f64::min(l[c], q[c]);
                    h[c] = f64::max(h[c], q[c]);
                }
                (l, h)
            });
            let side = (0..3).map(|c| hi[c] - lo[c]).fold(0., f64::max);
            let pts: Vec<[f64; 3]> = pts.iter().map(|q| std::array::from_fn(|c| (q[c] - lo[c]) / side)).collect();
            let mesh = Mesh::new(pts.clone(), mesh.connectivity().faces().to_vec()).unwrap();
            let truth: Vec<f64> = pts.iter().map(|q| (q[0] - 0.5).abs() + 0.3 * q[1]).collect();
            let so = |s| SolveOptions { solver: s, tolerance: Some(tol), ..Default::default() };
            let mut runs = vec![Solver::Fast];
            if a.get(6).is_some() {
                runs.push(Solver::Clarabel)
            }
            for s in runs {
                let t = Instant::now();
                let r = if a[2] == "denoise" {
                    let noise: f64 = a[3].parse().unwrap();
                    let alpha: f64 = a[5].parse().unwrap();
                    let val = Columns::from_column(
                        truth.iter().map(|x| x + noise * (rnd() + rnd() + rnd() - 1.5) * 2.).collect(),
                    );
                    denoise(&mesh, &val, &DenoiseOptions { fidelity: alpha, solve: so(s), ..Default::default() }, &p)
                        .unwrap()
                } else {
                    let k: usize = a[3].parse().unwrap();
                    let idx: Vec<usize> = (0..k).map(|i| i * n / k).collect();
                    let val = Columns::from_column(idx.iter().map(|&i| truth[i]).collect());
                    interpolate(&mesh, &idx, &val, &InterpolateOptions { solve: so(s), ..Default::default() }, &p)
                        .unwrap()
                };
                println!(
                    "{:?} {:.3}s obj {:.9} dual {:.9} gap {:.2e} its {} fact {} {:?}",
                    r.solver,
                    t.elapsed().as_secs_f64(),
                    r.objective,
                    r.dual_objective,
                    r.gap,
                    r.iterations,
                    r.factorisations,
                    r.status
                );
            }
        }
        _ => {}
    }
}
