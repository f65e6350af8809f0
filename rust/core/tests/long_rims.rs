//! Round rims of thousands of edges: as many faces as asked for, without needles on the way.
#![allow(clippy::unwrap_used)]

mod hole_checks;

use hole_checks::patches_of;
use ridgeform_core::hole_filling::FillOptions;
use ridgeform_core::shapes::ring;

#[test]
fn a_long_round_rim_is_refined_without_needles_before_it_is_remeshed() {
    for n in [1500, 4000] {
        let (shape, hole) = ring(n);
        let options = FillOptions { remesh_iterations: 0, ..FillOptions::default() };
        let patch = &patches_of(&shape.mesh().unwrap(), &[hole], &options).unwrap()[0];
        assert!((20_000..60_000).contains(&patch.faces.len()), "{n}: {} faces", patch.faces.len());
        let mut valences = vec![0_u32; 2 * n + patch.vertices.len()];
        patch.faces.iter().flatten().for_each(|&v| valences[v as usize] += 1);
        // With sizes that were means of the corners' a vertex had more than a thousand faces.
        assert!(*valences.iter().max().unwrap() < 200, "{n}: {:?}", valences.iter().max());
    }
}

#[test]
fn a_round_rim_of_twenty_thousand_edges_is_filled() {
    let (shape, hole) = ring(20_000);
    let options = FillOptions { remesh_iterations: 1, ..FillOptions::default() };
    let patch = &patches_of(&shape.mesh().unwrap(), &[hole], &options).unwrap()[0];
    // Five for each edge of the rim.
    assert!((50_000..120_000).contains(&patch.faces.len()), "{} faces", patch.faces.len());
}
