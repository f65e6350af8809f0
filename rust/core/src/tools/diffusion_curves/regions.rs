//! The regions of a painted surface: segments of its colours, whose borders then follow the paint vertex by vertex.

use std::collections::BTreeMap;

use super::chains::border_edges;
use super::fit::Task;
use super::membrane::Membrane;
use super::{check_fidelity, check_labels};
use crate::mesh::partition::Partition;
use crate::mesh::{triangle, Connectivity, CutMesh, EdgeTable, Mesh};
use crate::progress::Progress;
use crate::solve::Columns;
use crate::tools::{segment, SegmentOptions};
use crate::{Error, Result};

/// Rounds of moving borders at most: a row of faces takes two each way, and segments are rarely off by more than one or two.
const MOST_ROUNDS: usize = 16;

/// The other side must explain a vertex, or a face, better by this factor: a gentle change of colour is no reason to move.
const NEARER: f64 = 2.0;

/// Smaller islands are what moving leaves over, not paint.
const LEAST_ISLAND: usize = 5;

/// The largest fidelity of the fit that tells where vertices belong: broad, so that vertices on the wrong side cannot hide behind
/// each other. It smooths over a fifth of a surface.
const BROAD: f64 = 30.0;

/// The region of each face by the colours at the vertices (n × c): what [`segment`] finds, its borders moved by [`follow_colors`].
///
/// Faces with the same number in `groups`, the triangles of a polygon, come into one region: that of most of them.
///
/// # Errors
/// Groups of the wrong length, and the errors of [`segment`] and [`super::diffusion_curves`].
pub fn color_regions(
    mesh: &Mesh,
    colors: &Columns,
    options: &SegmentOptions,
    groups: Option<&[u32]>,
    fidelity: f64,
    progress: &Progress,
) -> Result<Vec<i32>> {
    let connectivity = mesh.connectivity();
    colors.check("colors", connectivity.n_vertices())?;
    check_fidelity(fidelity)?;
    let groups = Groups::new(groups, connectivity.n_faces())?;
    let mut labels = segment(mesh, Some(colors), options, progress)?.labels;
    for group in &groups.members {
        let label = majority(group.iter().map(|&f| labels[f as usize]).collect());
        group.iter().for_each(|&f| labels[f as usize] = label);
    }
    follow(mesh, colors, labels, &groups, fidelity, progress)
}

/// Moves the borders of regions until they follow the colours: a face beside a border goes over to the other side if one of its
/// vertices that no border touches has the colour of that side, or all of its vertices have, with all faces of its group.
///
/// Such vertices would have to be painted by a region that they do not belong to.
///
/// # Errors
/// Those of [`super::diffusion_curves`], and groups of the wrong length.
pub fn follow_colors(
    mesh: &Mesh,
    colors: &Columns,
    labels: &[i32],
    groups: Option<&[u32]>,
    fidelity: f64,
    progress: &Progress,
) -> Result<Vec<i32>> {
    let connectivity = mesh.connectivity();
    colors.check("colors", connectivity.n_vertices())?;
    check_fidelity(fidelity)?;
    check_labels(labels, connectivity.n_faces())?;
    let groups = Groups::new(groups, connectivity.n_faces())?;
    follow(mesh, colors, labels.to_vec(), &groups, fidelity, progress)
}

fn follow(
    mesh: &Mesh,
    colors: &Columns,
    mut labels: Vec<i32>,
    groups: &Groups,
    fidelity: f64,
    progress: &Progress,
) -> Result<Vec<i32>> {
    let area: f64 = mesh.edge_lengths().iter().map(|&l| triangle::area(l)).sum();
    let mut idle = 0;
    for round in 0..MOST_ROUNDS {
        progress.check()?;
        let mut moves = wrong_sides(mesh, colors, &labels, fidelity.min(BROAD) / area, progress)?;
        // In turns to lower and to higher labels, so that two faces do not change places.
        moves.retain(|&(face, label)| (label < labels[face]) == (round % 2 == 0));
        idle = if moves.is_empty() { idle + 1 } else { 0 };
        if idle == 2 || progress.is_finishing() {
            break;
        }
        for (face, label) in moves {
            groups.members[groups.of[face] as usize].iter().for_each(|&f| labels[f as usize] = label);
        }
    }
    absorb_islands(mesh.connectivity(), &mut labels, groups);
    Ok(labels)
}

/// Gives islands of fewer than [`LEAST_ISLAND`] groups, cut off from the rest of their region, to the region around them.
fn absorb_islands(connectivity: &Connectivity, labels: &mut [i32], groups: &Groups) {
    let mut pieces = Partition::new(groups.members.len());
    let mates = |h: usize| connectivity.mate(h).map(|mate| (h / 3, mate / 3));
    for (f, g) in (0..connectivity.n_halfedges()).filter_map(mates).filter(|&(f, g)| labels[f] == labels[g]) {
        pieces.unite(groups.of[f], groups.of[g]);
    }
    let label_of = |piece: u32| labels[groups.members[piece as usize][0] as usize];
    let mut sizes = vec![0; groups.members.len()];
    (0..sizes.len()).for_each(|g| sizes[pieces.root(g as u32) as usize] += 1);
    let mut largest = BTreeMap::new();
    for (piece, &size) in (0..).zip(&sizes) {
        let most = largest.entry(label_of(piece)).or_insert(0);
        *most = size.max(*most);
    }
    let island = |piece: u32| {
        let size = sizes[piece as usize];
        size < LEAST_ISLAND && largest.get(&label_of(piece)).is_some_and(|&most| size < most)
    };
    // The labels beyond each edge of each island.
    let mut around: BTreeMap<u32, Vec<i32>> = BTreeMap::new();
    for (f, g) in (0..connectivity.n_halfedges()).filter_map(mates).filter(|&(f, g)| labels[f] != labels[g]) {
        let piece = pieces.root(groups.of[f]);
        if island(piece) && !island(pieces.root(groups.of[g])) {
            around.entry(piece).or_default().push(labels[g]);
        }
    }
    let taken: BTreeMap<u32, i32> = around.into_iter().map(|(piece, labels)| (piece, majority(labels))).collect();
    for (g, members) in (0..).zip(&groups.members) {
        if let Some(&label) = taken.get(&pieces.root(g)) {
            members.iter().for_each(|&f| labels[f as usize] = label);
        }
    }
}

/// Faces that stay together.
struct Groups {
    /// The faces of every group.
    members: Vec<Vec<u32>>,
    /// The group of every face.
    of: Vec<u32>,
}

impl Groups {
    /// Groups by number; each face by itself where there are none.
    fn new(numbers: Option<&[u32]>, n_faces: usize) -> Result<Self> {
        let mut order: Vec<u32> = (0..n_faces as u32).collect();
        let members: Vec<Vec<u32>> = match numbers {
            None => order.iter().map(|&f| vec![f]).collect(),
            Some(numbers) if numbers.len() != n_faces => {
                let problem = format!("has {} entries, expected one per face: {n_faces}", numbers.len());
                return Err(Error::argument("face_groups", problem));
            }
            Some(numbers) => {
                order.sort_by_key(|&f| numbers[f as usize]);
                order.chunk_by(|&a, &b| numbers[a as usize] == numbers[b as usize]).map(<[u32]>::to_vec).collect()
            }
        };
        let mut of = vec![0; n_faces];
        for (g, group) in (0..).zip(&members) {
            group.iter().for_each(|&f| of[f as usize] = g);
        }
        Ok(Self { members, of })
    }
}

/// The faces beside borders that belong to the other side, and its label.
fn wrong_sides(
    mesh: &Mesh,
    colors: &Columns,
    labels: &[i32],
    fidelity: f64,
    progress: &Progress,
) -> Result<Vec<(usize, i32)>> {
    let connectivity = mesh.connectivity();
    let table = EdgeTable::new(connectivity);
    let mut flags = vec![false; connectivity.n_halfedges()];
    let edges = border_edges(connectivity, &table, labels, false);
    edges.iter().flat_map(|edge| table.between(edge.ends[0], edge.ends[1])).for_each(|h| flags[h] = true);
    let cut = CutMesh::new(connectivity, &table, &flags);
    let membrane = Membrane::new(&cut, mesh.edge_lengths())?;
    let task = Task { cut: &cut, membrane: &membrane, colors, fidelity };
    let values = task.screened(progress)?.values;
    let mut label_of = vec![0; cut.n_copies()];
    cut.faces.iter().zip(labels).for_each(|(face, &label)| face.iter().for_each(|&i| label_of[i as usize] = label));
    let copies = task.copies();
    let off = |v: u32, copy: u32| {
        let term = |c: usize| values.column(c)[copy as usize] - colors.column(c)[v as usize];
        (0..colors.n_columns).map(|c| term(c).powi(2)).sum::<f64>().sqrt()
    };
    let mut moves = Vec::new();
    for h in (0..connectivity.n_halfedges()).filter(|&h| flags[h]) {
        let Some(mate) = connectivity.mate(h) else { continue };
        let label = labels[mate / 3];
        let ends = [(mate + 1) % 3, (mate + 2) % 3].map(|corner| cut.faces[mate / 3][corner]);
        // How far each vertex is from the colours here and there, and whether a border touches it.
        let vertices = [0, 1, 2].map(|i| {
            let v = connectivity.faces()[h / 3][i];
            let all = &copies[v as usize];
            let across = all.iter().filter(|&&copy| label_of[copy as usize] == label).map(|&copy| off(v, copy));
            let beside = 0.5 * (off(v, ends[0]) + off(v, ends[1]));
            (off(v, cut.faces[h / 3][i]), across.reduce(f64::min).unwrap_or(beside), all.len() > 1)
        });
        let alone = vertices.iter().any(|(here, there, touched)| !touched && NEARER * there < *here);
        let sums = vertices.iter().fold([0.0, 0.0], |[a, b], (here, there, _)| [a + here, b + there]);
        let together = vertices.iter().all(|(here, there, _)| there <= here) && NEARER * sums[1] < sums[0];
        if alone || together {
            moves.push((h / 3, label));
        }
    }
    Ok(moves)
}

/// The label that occurs most often, the least of equals.
fn majority(mut labels: Vec<i32>) -> i32 {
    labels.sort_unstable();
    let runs = labels.chunk_by(i32::eq).map(|run| (run.len(), run[0]));
    runs.reduce(|best, run| if run.0 > best.0 { run } else { best }).map_or(0, |(_, label)| label)
}
