//! Which chart each sample belongs to.
//!
//! Owns the one rule: charts that see most samples well take what they see well, the largest first;
//! what is left goes to the chart that sees it best, first among those in use.

/// A chart's samples and how well it sees each, from 0 to 1; both of one length.
pub(super) struct Sighted<'a> {
    pub(super) members: &'a [u32],
    pub(super) incidence: &'a [f32],
}

/// With at least this |u·n| a sample is seen well.
const WELL: f32 = 0.6;

/// A chart that sees fewer samples well, of those not taken, takes none of them for that.
const FEWEST: usize = 15;

/// The chart of each of `samples` samples, if any sees it.
pub(super) fn owners(charts: &[Sighted<'_>], samples: usize) -> Vec<Option<u32>> {
    let mut owner = vec![None; samples];
    let mut used = vec![false; charts.len()];
    loop {
        let best = charts
            .iter()
            .enumerate()
            .filter(|(chart, _)| !used[*chart])
            .map(|(chart, sighted)| {
                (
                    chart,
                    sighted.well().filter(|i| owner[*i].is_none()).count(),
                )
            })
            .reduce(|best, next| if next.1 > best.1 { next } else { best });
        let Some((chart, count)) = best.filter(|(_, count)| *count >= FEWEST) else {
            break;
        };
        debug_assert!(count > 0);
        used[chart] = true;
        for index in charts[chart].well() {
            owner[index].get_or_insert(chart as u32);
        }
    }
    for in_use in [true, false] {
        let mut best = vec![0.0_f32; samples];
        let mut found = vec![None; samples];
        for (chart, sighted) in charts.iter().enumerate() {
            if used[chart] != in_use {
                continue;
            }
            for (&index, &incidence) in sighted.members.iter().zip(sighted.incidence) {
                let index = index as usize;
                if incidence > best[index] {
                    best[index] = incidence;
                    found[index] = Some(chart as u32);
                }
            }
        }
        for (owner, found) in owner.iter_mut().zip(found) {
            *owner = owner.or(found);
        }
    }
    owner
}

impl Sighted<'_> {
    fn well(&self) -> impl Iterator<Item = usize> {
        let seen = self.members.iter().zip(self.incidence);
        seen.filter(|(_, incidence)| **incidence > WELL)
            .map(|(index, _)| *index as usize)
    }
}
