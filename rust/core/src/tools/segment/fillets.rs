//! Segments by the surfaces that faces lie on ([`mod@crate::labelling`]), fillets apart from the sides beside
//! them or joined to these ([`super::blends`]). Both are in one hierarchy: fillets are what is joined first.

use std::collections::BTreeMap;

use super::blends::Blends;
use super::constants::{BEND, LEAST_FREE, LEAST_SIGMA};
use super::hierarchy::Hierarchy;
use super::merge::{rename, within_order, Merge};
use super::options::{Fillets, SegmentOptions};
use super::segmentation::{boundary_edges, Segmentation};
use super::surface::{pieces, Surface};
use super::tangent;
use crate::labelling::{labelling, Domain, Labelling};
use crate::mesh::partition::{contiguous, Partition};
use crate::mesh::vector::{add, scale, sub, Point};
use crate::mesh::{Mesh, FILE_ROUNDING};
use crate::progress::{Progress, Report};
use crate::solve::Status;
use crate::{memory, Result};

/// The segments of `mesh`, which is `surface` in its unit, by the surfaces that its faces lie on, where bends
/// tell those that were `found`. What is `tessellated` is in its surfaces already.
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
    let (leaves, points) = if tessellated {
        (memory::gathered(found.labels.iter().map(|label| label.cast_unsigned()))?, None)
    } else {
        let noise = options.noise.unwrap_or(found.noise);
        let (labels, points) = on_surfaces(mesh, surface, &found.labels, noise, options, progress)?;
        (labels, Some(points))
    };
    let (leaves, n_leaves) = contiguous(&leaves)?;
    let points = points.as_deref().unwrap_or(&surface.positions);
    let joined = Blends::new(surface, &leaves, points, tessellated)?.found(BEND * options.length_weight)?;
    let joined: Vec<Merge> =
        memory::gathered(joined.into_iter().map(|[gone, kept]| Merge { kept, gone, strength: 0.0 }))?;
    let mut merges = within_order(&leaves, n_leaves, &joined)?;
    let default = match options.fillets {
        Fillets::Joined => n_leaves - merges.len(),
        Fillets::Apart | Fillets::Automatic => n_leaves,
    };
    let mut current = memory::twin(&leaves)?;
    rename(&mut current, &merges);
    let outer = tangent::merged(surface, &mut current)?;
    memory::extend(&mut merges, outer.len())?;
    merges.extend(outer);
    let merges = merges.iter().map(|m| ([m.kept, m.gone], m.strength));
    let hierarchy = Hierarchy::new(leaves, n_leaves, merges).ascending();
    let labels = hierarchy.labels_at(options.n_segments.unwrap_or(default))?;
    Ok(Segmentation {
        n_segments: labels.iter().max().map_or(0, |most| *most as usize + 1),
        boundary_edges: boundary_edges(mesh, &labels)?,
        labels,
        hierarchy,
        status: if progress.is_finishing() { Status::Stopped } else { found.status },
        ..found
    })
}

/// Segments by surfaces, begun as `start`, and the vertices on these, in the unit of `surface`.
fn on_surfaces(
    mesh: &Mesh,
    surface: &Surface<'_>,
    start: &[i32],
    noise: f64,
    options: &SegmentOptions,
    progress: &Progress,
) -> Result<(Vec<u32>, Vec<Point>)> {
    let unit = options.unit_of(mesh);
    let least = (LEAST_SIGMA * surface.mean_edge).max(FILE_ROUNDING);
    let domain = Domain::new(mesh.connectivity(), &surface.positions, (noise / unit).max(least))?;
    let found = labelling(&domain, start, progress)?;
    let labels = connected(surface, &found, start, options, noise / unit)?;
    Ok((labels, placed(&domain, &found)?))
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
    let names: Vec<u32> = memory::gathered(found.labels.iter().zip(start).map(|(&label, &segment)| {
        if is_free(label) {
            count + segment.cast_unsigned()
        } else {
            label
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
    let least = options.least_faces(noise / surface.mean_edge);
    // Fewer faces than a surface is sought with do not say that they are on none.
    let least_free = options.min_faces.unwrap_or(LEAST_FREE);
    let is_speck = |piece: &u32| {
        let (size, name) = (sizes[*piece as usize], name[*piece as usize]);
        let is_whole = name < count && largest[&name].1 == *piece;
        let least = if name < count { least } else { least_free };
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
