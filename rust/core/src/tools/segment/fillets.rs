//! Segments by the surfaces that faces lie on ([`mod@crate::labelling`]), fillets apart from the sides beside
//! them or joined to these ([`super::blends`]). Both are in one hierarchy ([`super::nesting`]).

use std::collections::BTreeMap;

use super::blends::Blends;
use super::constants::{BEND, LEAST_FREE, LEAST_SIGMA};
use super::nesting::nested;
use super::options::{Fillets, SegmentOptions};
use super::segmentation::{boundary_edges, Segmentation};
use super::surface::{pieces, Surface};
use crate::labelling::{free_patches, labelling, Domain, Labelling, Piece};
use crate::mesh::partition::{contiguous, Partition};
use crate::mesh::vector::{add, distance, scale, sub, Point};
use crate::mesh::{Mesh, FILE_ROUNDING};
use crate::progress::{Progress, Report};
use crate::solve::Status;
use crate::surfaces::Surface as Named;
use crate::{memory, Result};

/// The segments of `mesh`, which is `surface` in its unit, by the surfaces that its faces lie on, where bends
/// tell those that were `found`, without a number asked for. What is `tessellated` is in its surfaces
/// already.
///
/// # Errors
/// [`crate::Error::Cancelled`].
pub(super) fn by_surfaces(
    mesh: &Mesh,
    surface: &Surface<'_>,
    found: Segmentation,
    tessellated: bool,
    options: &SegmentOptions,
    progress: &Progress,
) -> Result<Segmentation> {
    progress.report(Report { fraction: 0.98, stage: "surfaces".into(), ..Report::default() });
    let bent = || memory::gathered(found.labels.iter().map(|label| label.cast_unsigned()));
    let told = if tessellated { None } else { on_surfaces(mesh, surface, &found, options, progress)? };
    let (labels, points) = match told {
        Some((labels, points)) => (labels, Some(points)),
        // Nothing is told by surfaces.
        None if options.fillets == Fillets::Automatic => return with_count(mesh, found, options, progress),
        None => (bent()?, None),
    };
    let (labels, n_labels) = contiguous(&labels)?;
    let points = points.as_deref().unwrap_or(&surface.positions);
    let blends = Blends::new(surface, &labels, points, tessellated)?.found(BEND * options.length_weight)?;
    let hierarchy = nested(surface, &found.hierarchy, found.n_segments, &labels, &blends, tessellated)?;
    let n_segments = match options.fillets {
        Fillets::Joined => joined_count(n_labels, &blends)?,
        _ => n_labels,
    };
    with_count(mesh, Segmentation { hierarchy, n_segments, ..found }, options, progress)
}

/// How many of so many segments are left once all pairs are one.
fn joined_count(n: usize, pairs: &[[u32; 2]]) -> Result<usize> {
    let mut partition = Partition::new(n)?;
    pairs.iter().for_each(|&[a, b]| partition.unite(a, b));
    Ok((0..n as u32).filter(|&label| partition.root(label) == label).count())
}

/// The segments that are wanted of the hierarchy: as many as asked for, or as were found.
fn with_count(
    mesh: &Mesh,
    found: Segmentation,
    options: &SegmentOptions,
    progress: &Progress,
) -> Result<Segmentation> {
    let labels = found.hierarchy.labels_at(options.n_segments.unwrap_or(found.n_segments))?;
    Ok(Segmentation {
        n_segments: labels.iter().max().map_or(0, |most| *most as usize + 1),
        boundary_edges: boundary_edges(mesh, &labels)?,
        labels,
        status: if progress.is_finishing() { Status::Stopped } else { found.status },
        ..found
    })
}

/// Segments by surfaces, begun as those that bends tell, and the vertices on these, in the unit of `surface`;
/// nothing where there are none.
fn on_surfaces(
    mesh: &Mesh,
    surface: &Surface<'_>,
    bent: &Segmentation,
    options: &SegmentOptions,
    progress: &Progress,
) -> Result<Option<(Vec<u32>, Vec<Point>)>> {
    let (start, noise) = (&bent.labels, options.noise.unwrap_or(bent.noise));
    let unit = options.unit_of(mesh);
    let least = (LEAST_SIGMA * surface.mean_edge).max(FILE_ROUNDING);
    let domain = Domain::new(mesh.connectivity(), &surface.positions, (noise / unit).max(least))?;
    let mut found = labelling(&domain, start, progress)?;
    if options.fillets != Fillets::Apart {
        free_patches(&domain, &mut found, BEND * options.length_weight, progress)?;
    }
    if found.pieces.iter().all(|piece| piece.surface.is_none()) {
        return Ok(None);
    }
    let labels = connected(surface, &found, start, options, noise / unit)?;
    Ok(Some((labels, placed(&domain, &found)?)))
}

/// The connected pieces of surfaces, and of the segments that `start` has where there are none. Specks, that
/// is small pieces of what is elsewhere as well or of no surface, go to the neighbor that they touch most.
fn connected(
    surface: &Surface<'_>,
    found: &Labelling,
    start: &[i32],
    options: &SegmentOptions,
    noise: f64,
) -> Result<Vec<u32>> {
    let is_free = |label: u32| found.pieces.get(label as usize).is_none_or(|piece| piece.surface.is_none());
    let count = found.pieces.len() as u32;
    let side = sides(surface, found, BEND * options.length_weight)?;
    let names: Vec<u32> = memory::gathered(found.labels.iter().zip(start).map(|(&label, &segment)| {
        if is_free(label) {
            count + segment.cast_unsigned()
        } else {
            side[label as usize]
        }
    }))?;
    let (labels, n) = pieces(surface, &names)?;
    let mut sizes = memory::repeated(0_usize, n)?;
    let mut name = memory::repeated(0, n)?;
    let mut borders: Vec<BTreeMap<u32, f64>> = memory::repeated(BTreeMap::new(), n)?;
    for (f, &own) in labels.iter().enumerate() {
        sizes[own as usize] += 1;
        name[own as usize] = names[f];
        for (h, g) in surface.around(f).filter(|&(_, g)| labels[g] != own) {
            *borders[own as usize].entry(labels[g]).or_default() += surface.lengths[h / 3][h % 3];
        }
    }
    let mut largest: BTreeMap<u32, (usize, u32)> = BTreeMap::new();
    for piece in 0..n {
        let held = largest.entry(name[piece]).or_default();
        *held = (*held).max((sizes[piece], piece as u32));
    }
    let mut given: BTreeMap<u32, usize> = BTreeMap::new();
    start.iter().for_each(|segment| *given.entry(count + segment.cast_unsigned()).or_default() += 1);
    let least = options.least_faces(noise / surface.mean_edge);
    let is_speck = |piece: &u32| {
        let (size, name) = (sizes[*piece as usize], name[*piece as usize]);
        let is_whole = largest[&name].1 == *piece && given.get(&name).is_none_or(|all| 2 * size >= *all);
        // What is left of a segment is none of its own where a surface would not have been sought in it.
        let least = if name < count { least } else { options.min_faces.unwrap_or(LEAST_FREE) };
        size < least && (options.min_faces.is_some() || !is_whole)
    };
    let mut specks: Vec<u32> = memory::sifted((0..n as u32).filter(is_speck))?;
    specks.sort_by_key(|piece| sizes[*piece as usize]);
    let mut partition = Partition::new(n)?;
    for piece in specks {
        let gone = partition.root(piece);
        let mut lengths: BTreeMap<u32, f64> = BTreeMap::new();
        for (&other, length) in &borders[piece as usize] {
            *lengths.entry(partition.root(other)).or_default() += length;
        }
        let others = lengths.into_iter().filter(|(other, _)| *other != gone);
        if let Some((kept, _)) = others.max_by(|a, b| a.1.total_cmp(&b.1)) {
            partition.attach(gone, kept);
        }
    }
    Ok(memory::gathered(labels.iter().map(|&label| partition.root(label)))?)
}

/// A name for each piece, the same for planes that meet in no edge that counts: one where their unit normals
/// differ by `bend` and more, where borders cost their length.
fn sides(surface: &Surface<'_>, found: &Labelling, bend: f64) -> Result<Vec<u32>> {
    let normal = |label: u32| match found.pieces.get(label as usize)? {
        Piece { surface: Some(Named::Plane { normal, .. }), side, .. } => Some(scale(*normal, *side)),
        _ => None,
    };
    // Of each two planes the length of their border, what that costs, and how far their normals differ.
    let mut borders: BTreeMap<[u32; 2], [f64; 3]> = BTreeMap::new();
    for (f, &own) in found.labels.iter().enumerate() {
        for (h, g) in surface.around(f).filter(|&(_, g)| found.labels[g] > own) {
            let other = found.labels[g];
            if let (Some(m), Some(n)) = (normal(own), normal(other)) {
                let length = surface.lengths[h / 3][h % 3];
                let border = borders.entry([own, other]).or_default();
                *border =
                    [border[0] + length, border[1] + length * surface.costs[h / 3][h % 3], distance(m, n)];
            }
        }
    }
    let mut partition = Partition::new(found.pieces.len())?;
    for ([a, b], [length, cost, apart]) in borders {
        if apart * length < bend * cost {
            partition.unite(a, b);
        }
    }
    Ok(memory::gathered((0..found.pieces.len() as u32).map(|label| partition.root(label)))?)
}

/// The vertices on the surfaces of their faces, in the mean of those places by area; others as they are.
fn placed(domain: &Domain<'_>, found: &Labelling) -> Result<Vec<Point>> {
    let place = |v: usize| {
        let p = domain.positions[v];
        let on = |&f: &u32| {
            let surface = found.pieces.get(found.labels[f as usize] as usize)?.surface?;
            let (distance, normal) = surface.distance(p);
            Some((domain.share(f as usize, v as u32), sub(p, scale(normal, distance))))
        };
        let places = domain.faces_at(v as u32).iter().filter_map(on);
        let (share, sum) = places
            .fold((0.0, [0.0; 3]), |(share, sum), (own, place)| (share + own, add(sum, scale(place, own))));
        if share > 0.0 {
            scale(sum, 1.0 / share)
        } else {
            p
        }
    };
    Ok(memory::gathered((0..domain.positions.len()).map(place))?)
}
