//! The cheapest cut of one part: level sets of its lowest eigenfunctions, drawn tight.

use std::cmp::Ordering;

use super::constants::{
    AREA_POWER, BAND, FUNCTIONS, FUNCTION_ACCURACY, LEAST_FACES, LEAST_PART, LEAST_PATCHES, LEVELS,
    LEVELS_APART, SAME_CUT, STEP, TIGHTENED, TIGHTENINGS,
};
use super::graph::Graph;
use super::tighten::moved;
use crate::block_rows::BlockRows;
use crate::progress::Progress;
use crate::solve::eigen::Pencil;
use crate::{memory, Result};

/// A part in two: which nodes are on the side that goes, and what the cut costs.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Cut {
    pub cost: f64,
    pub side: Vec<bool>,
}

/// One side of a cut: its area, the integral of the logarithm of the thickness over it, and its faces.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Side {
    pub(super) area: f64,
    thickness: f64,
    faces: u32,
}

impl Side {
    fn add(&mut self, graph: &Graph, i: usize) {
        self.area += graph.areas[i];
        self.thickness += graph.areas[i] * graph.thickness(i);
        self.faces += graph.faces(i);
    }

    /// The side of all nodes in `inside`.
    pub(super) fn of(graph: &Graph, inside: impl Fn(usize) -> bool) -> Self {
        let mut side = Self::default();
        (0..graph.n_nodes()).filter(|&i| inside(i)).for_each(|i| side.add(graph, i));
        side
    }

    fn rest_of(self, whole: Self) -> Self {
        Self {
            area: whole.area - self.area,
            thickness: whole.thickness - self.thickness,
            faces: whole.faces - self.faces,
        }
    }

    /// Whether it is no less than a part.
    pub(super) fn is_part(self) -> bool {
        self.area >= LEAST_PART && self.faces >= LEAST_FACES
    }

    /// Both sides as one.
    pub(super) fn with(self, other: Self) -> Self {
        Self {
            area: self.area + other.area,
            thickness: self.thickness + other.thickness,
            faces: self.faces + other.faces,
        }
    }

    /// What a cut with this border between this side and `other` costs.
    pub(super) fn price(self, other: Self, border: f64) -> f64 {
        self.thinner(other) * self.plain_price(other, border)
    }

    /// The same without a unit: what parts of one shape cost alike, whatever their size.
    pub(super) fn price_by_shape(self, other: Self, border: f64) -> f64 {
        self.thinner(other) * border / self.least(other).sqrt()
    }

    /// The same for borders that follow nothing: the smaller a part, the more (Cheeger 1970), so that what is
    /// round falls into pieces of about one size.
    pub(super) fn price_by_size(self, other: Self, border: f64) -> f64 {
        self.thinner(other) * border / self.least(other)
    }

    /// What a border costs less since the smaller side is thinner.
    fn thinner(self, other: Self) -> f64 {
        let mean = |side: Self| side.thickness / side.area.max(f64::MIN_POSITIVE);
        let (small, large) = if self.area < other.area { (self, other) } else { (other, self) };
        let step = (mean(large) - mean(small)).max(0.0);
        (-step / STEP).exp()
    }

    fn least(self, other: Self) -> f64 {
        self.area.min(other.area).max(f64::MIN_POSITIVE)
    }

    /// The same where both sides are equally thick.
    pub(super) fn plain_price(self, other: Self, border: f64) -> f64 {
        border / self.least(other).powf(AREA_POWER)
    }
}

/// The cost of the cut between `side` and the rest.
pub(super) fn cost(graph: &Graph, side: &[bool]) -> f64 {
    let parted = |ends: [u32; 2]| side[ends[0] as usize] != side[ends[1] as usize];
    let border = graph.edges.iter().filter(|e| parted(e.ends)).map(|e| e.cost).sum();
    Side::of(graph, |i| side[i]).price(Side::of(graph, |i| !side[i]), border)
}

/// Whether neither side is less than a part.
pub(super) fn are_parts(graph: &Graph, side: &[bool]) -> bool {
    Side::of(graph, |i| side[i]).is_part() && Side::of(graph, |i| !side[i]).is_part()
}

/// The area of one side.
pub(super) fn area_of(graph: &Graph, side: &[bool]) -> f64 {
    side.iter().zip(&graph.areas).filter(|(side, _)| **side).map(|(_, area)| area).sum()
}

/// The cheapest cut of a connected part that leaves both sides connected and not too small, if there is
/// one.
///
/// # Errors
/// Those of the eigenproblem, and [`crate::Error::Cancelled`].
pub(super) fn cheapest(graph: &Graph, progress: &Progress) -> Result<Option<Cut>> {
    progress.check()?;
    let whole = graph.area();
    if graph.n_nodes() < LEAST_PATCHES || whole < 2.0 * LEAST_PART {
        return Ok(None);
    }
    let mut found: Vec<Cut> = Vec::new();
    for function in eigenfunctions(graph, progress)? {
        sweep(graph, &function, &mut found)?;
    }
    found.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    let mut looked_at: Vec<Vec<bool>> = Vec::new();
    let mut best: Option<Cut> = None;
    for Cut { side, .. } in found {
        if looked_at.len() == TIGHTENED {
            break;
        }
        if !is_whole(graph, &side)?
            || looked_at.iter().any(|other| differ(graph, &side, other) < SAME_CUT * whole)
        {
            continue;
        }
        looked_at.push(memory::twin(&side)?);
        let side = tightened(graph, side)?;
        let cost = cost(graph, &side);
        if best.as_ref().is_none_or(|best| cost < best.cost) {
            best = Some(Cut { cost, side });
        }
    }
    Ok(best)
}

/// Whether both sides are connected.
fn is_whole(graph: &Graph, side: &[bool]) -> Result<bool> {
    Ok(graph.pieces(|e| side[e.ends[0] as usize] == side[e.ends[1] as usize])?.1 == 2)
}

/// The cut moved to where it costs least within its band, as long as that makes it cheaper and both sides
/// stay connected.
fn tightened(graph: &Graph, mut side: Vec<bool>) -> Result<Vec<bool>> {
    let area = area_of(graph, &side);
    let width = BAND * area.min(graph.area() - area).max(0.0).sqrt();
    for _ in 0..TIGHTENINGS {
        let Some(better) = moved(graph, &side, width)? else { break };
        if !(is_whole(graph, &better)?
            && are_parts(graph, &better)
            && cost(graph, &better) < cost(graph, &side))
        {
            break;
        }
        side = better;
    }
    Ok(side)
}

/// The area in which two cuts differ, whichever side is called which.
fn differ(graph: &Graph, a: &[bool], b: &[bool]) -> f64 {
    let other: Vec<bool> = a.iter().zip(b).map(|(a, b)| a != b).collect();
    let area = area_of(graph, &other);
    area.min(graph.area() - area)
}

/// The lowest eigenfunctions of the graph's Laplacian but the constant, where edges carry border cost over
/// distance.
fn eigenfunctions(graph: &Graph, progress: &Progress) -> Result<Vec<Vec<f64>>> {
    let n_edges = graph.edges.len();
    let mut differences = BlockRows::with_room(graph.n_nodes(), n_edges, 2 * n_edges)?;
    for edge in &graph.edges {
        differences.push_block([(edge.ends[0], [1.0, 0.0, 0.0]), (edge.ends[1], [-1.0, 0.0, 0.0])]);
    }
    let weights = memory::gathered(graph.edges.iter().map(|e| e.cost / e.distance))?;
    let pencil = Pencil {
        operator: &differences,
        weights: &weights,
        mass: &graph.areas,
        // Hollows make the lowest eigenvalues smaller than the area alone says.
        scale: 1.0 / graph.area(),
        accuracy: FUNCTION_ACCURACY,
        memory_limit: None,
    };
    let count = FUNCTIONS.min(graph.n_nodes() - 2);
    let found = pencil.smallest(count + 1, progress)?;
    Ok((1..=count).map(|j| found.vectors.column(j).to_vec()).collect())
}

/// Adds the cheapest cuts along level sets of `function`, each connected piece of a level set's sides for
/// itself.
fn sweep(graph: &Graph, function: &[f64], found: &mut Vec<Cut>) -> Result<()> {
    let n = graph.n_nodes();
    let by_value = |a: &u32, b: &u32| function[*a as usize].total_cmp(&function[*b as usize]).then(a.cmp(b));
    let mut order = memory::sifted(0..n as u32)?;
    order.sort_by(|a, b| -> Ordering { by_value(a, b) });
    let mut rank = memory::repeated(0_u32, n)?;
    (0..).zip(&order).for_each(|(i, &node)| rank[node as usize] = i);
    let mut rise = memory::repeated(0.0, n)?;
    for edge in &graph.edges {
        let [a, b] = edge.ends.map(|end| rank[end as usize] as usize);
        rise[a.min(b)] += edge.cost;
        rise[a.max(b)] -= edge.cost;
    }
    let (all, mut below) = (Side::of(graph, |_| true), Side::default());
    let (whole, mut border) = (all.area, 0.0_f64);
    let mut levels: Vec<(f64, f64)> = memory::room(n - 1)?;
    for (&node, rise) in order.iter().zip(&rise).take(n - 1) {
        border += rise;
        below.add(graph, node as usize);
        let above = below.rest_of(all);
        let allowed = below.is_part() && above.is_part();
        levels.push((if allowed { below.price(above, border.max(0.0)) } else { f64::INFINITY }, below.area));
    }
    for _ in 0..LEVELS {
        let cheapest = (0..levels.len()).min_by(|&i, &j| levels[i].0.total_cmp(&levels[j].0));
        let Some(level) = cheapest.filter(|&i| levels[i].0.is_finite()) else { break };
        let at = levels[level].1;
        let apart = LEVELS_APART * at.min(whole - at) + 0.01 * whole;
        levels
            .iter_mut()
            .filter(|(_, area)| (area - at).abs() < apart)
            .for_each(|(price, _)| *price = f64::INFINITY);
        let below = |end: u32| rank[end as usize] as usize <= level;
        let (pieces, count) = graph.pieces(|e| below(e.ends[0]) == below(e.ends[1]))?;
        // With two pieces each is the other's rest.
        for piece in 0..if count == 2 { 1 } else { count as u32 } {
            let side = memory::gathered(pieces.iter().map(|p| *p == piece))?;
            if are_parts(graph, &side) {
                found.push(Cut { cost: cost(graph, &side), side });
            }
        }
    }
    Ok(())
}
