//! The mass of the beam, lumped at stations.

use super::cubics::{COINCIDENT, MAX_STATIONS};
use super::distribution::Distribution;
use super::support::on_the_bridge;
use crate::error::Error;

/// A lumped mass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Station {
    /// Position from the left end [m].
    pub at: f64,
    /// Mass [kg].
    pub mass: f64,
}

/// Where the distributed mass is lumped.
#[derive(Debug, Clone, PartialEq)]
pub enum Stations {
    /// This many equal shares of every span, each mass in the middle of its share.
    PerSpan(Vec<usize>),
    /// Positions chosen by the user [m]; each takes the mass up to half-way to its neighbours, within its span.
    At(Vec<f64>),
}

/// Refuses more of something than there may be stations.
pub fn too_many(key: &str, count: usize) -> Error {
    Error::input(key, format!("{count} stations"), format!("at most {MAX_STATIONS} mass stations in all"))
}

/// n equal shares of every span, the mass of each in its middle. No share reaches across a hinge: between the hinges of a
/// span the shares are as nearly equal as their number allows, one at least.
pub fn equal_shares(
    bounds: &[f64],
    hinges: &[f64],
    mass: &Distribution,
    counts: &[usize],
) -> Result<Vec<Station>, Error> {
    let spans = bounds.len() - 1;
    if counts.len() != 1 && counts.len() != spans {
        return Err(Error::input(
            "stations_per_span",
            format!("{} values", counts.len()),
            format!("give one whole number, or one for each of the {spans} spans (overhangs count as spans)"),
        ));
    }
    let count_of = |span: usize| if counts.len() == 1 { counts[0] } else { counts[span] };
    let total = (0..spans).fold(0_usize, |sum, span| sum.saturating_add(count_of(span)));
    if total > MAX_STATIONS {
        return Err(too_many("stations_per_span", total));
    }
    let mut stations = Vec::with_capacity(total);
    for span in 0..spans {
        let count = count_of(span);
        if count == 0 && mass.integral(bounds[span], bounds[span + 1]) > 0.0 {
            return Err(Error::input("stations_per_span", 0, "must be 1 or more in a span that has mass"));
        }
        if count == 0 {
            continue;
        }
        let (start, end) = (bounds[span], bounds[span + 1]);
        let mut cuts = vec![start];
        cuts.extend(hinges.iter().filter(|&&x| x > start && x < end));
        cuts.push(end);
        let pieces = cuts.len() - 1;
        let (mut begun, count) = (0, count.max(pieces));
        for (k, piece) in cuts.windows(2).enumerate() {
            let wanted = ((piece[1] - start) / (end - start) * count as f64).round() as usize;
            let ended = wanted.clamp(begun + 1, count + k + 1 - pieces);
            let shares = ended - begun;
            let share = (piece[1] - piece[0]) / shares as f64;
            stations.extend((0..shares).map(|i| {
                let from = piece[0] + share * i as f64;
                Station { at: piece[0] + share * (i as f64 + 0.5), mass: mass.integral(from, from + share) }
            }));
            begun = ended;
        }
    }
    Ok(stations)
}

/// Each station takes the mass up to half-way to its neighbours; no share reaches across a support.
pub fn tributary_shares(
    bounds: &[f64],
    mass: &Distribution,
    positions: &[f64],
    held: &dyn Fn(f64) -> bool,
) -> Result<Vec<Station>, Error> {
    let length = bounds[bounds.len() - 1];
    let near = COINCIDENT * length;
    if positions.len() > MAX_STATIONS {
        return Err(too_many("stations", positions.len()));
    }
    for (i, &at) in positions.iter().enumerate() {
        on_the_bridge(&format!("stations[{i}]"), at, length)?;
        if i > 0 && at - positions[i - 1] <= near {
            return Err(Error::input(
                format!("stations[{i}]"),
                format!("{at} m"),
                format!("must be greater than the station before it, {} m", positions[i - 1]),
            ));
        }
    }
    let mut stations: Vec<Station> = positions.iter().map(|&at| Station { at, mass: 0.0 }).collect();
    for bound in bounds.windows(2) {
        let first = positions.partition_point(|&x| x < bound[0] - near);
        let last = positions.partition_point(|&x| x <= bound[1] + near);
        if positions[first..last].iter().all(|&x| held(x)) && mass.integral(bound[0], bound[1]) > 0.0 {
            return Err(Error::input(
                "stations",
                format!("none from {} m to {} m", bound[0], bound[1]),
                "every span that has mass needs at least one station off its supports",
            ));
        }
        for i in first..last {
            let from = if i == first { bound[0] } else { 0.5 * (positions[i - 1] + positions[i]) };
            let to = if i + 1 == last { bound[1] } else { 0.5 * (positions[i] + positions[i + 1]) };
            stations[i].mass += mass.integral(from, to);
        }
    }
    Ok(stations)
}
