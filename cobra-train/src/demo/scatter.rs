//! The picture's plot: the true error of every pose against its confidence, and the threshold.

use plotters::prelude::*;
use plotters::style::FontTransform;
use plotters::style::text_anchor::{HPos, VPos};

use super::axis::ErrorAxis;
use super::picture::{ScoredPose, Verdict};
use super::style::{Drawn, HAIRLINE, INK, Page, QUIET, bold, letter, mark, px, text};

/// Draws the heading, the legend and the plot into the rectangle with this upper left corner.
/// `lettered` are the poses that panels show, in the panels' order.
pub(super) fn draw(
    page: &Page,
    (left, top): (i32, i32),
    (width, height): (i32, i32),
    poses: &[ScoredPose],
    lettered: &[usize],
) -> Drawn {
    page.draw(&Text::new(
        format!("Confidence against true error of all {} poses", poses.len()),
        (left, top + px(10)),
        bold(19, INK, HPos::Left, VPos::Center),
    ))?;
    legend(page, (left + width, top + px(10)), poses)?;

    let axis = ErrorAxis::spanning(poses.iter().map(|pose| pose.error_mm));
    let plot = page
        .clone()
        .shrink((left, top + px(34)), (width, height - px(34)));
    let mut chart = ChartBuilder::on(&plot)
        .x_label_area_size(px(58))
        .y_label_area_size(px(76))
        .build_cartesian_2d(axis, -0.04..1.04)?;
    chart
        .configure_mesh()
        .bold_line_style(HAIRLINE.stroke_width(px(1) as u32))
        .light_line_style(TRANSPARENT)
        .axis_style(QUIET.stroke_width(px(1) as u32))
        .set_all_tick_mark_size(px(6))
        .label_style(text(16, INK, HPos::Left, VPos::Top))
        .y_labels(6)
        .y_label_formatter(&|confidence| format!("{confidence:.1}"))
        .draw()?;
    page.draw(&Text::new(
        "ADD: mean distance between the model's points in the estimated and the true pose (mm)",
        (left + px(76) + (width - px(76)) / 2, top + height - px(12)),
        text(16, INK, HPos::Center, VPos::Center),
    ))?;
    page.draw(&Text::new(
        "confidence",
        (left + px(14), top + px(34) + (height - px(92)) / 2),
        text(16, INK, HPos::Center, VPos::Center).transform(FontTransform::Rotate270),
    ))?;

    let at =
        |pose: &ScoredPose| chart.backend_coord(&(pose.error_mm, pose.confidence.clamp(0.0, 1.0)));
    let mut thresholds: Vec<f64> = poses.iter().map(|pose| pose.threshold).collect();
    thresholds.sort_by(f64::total_cmp);
    if let (Some(&lowest), Some(&highest)) = (thresholds.first(), thresholds.last()) {
        let threshold = thresholds[thresholds.len() / 2];
        let height = |threshold: f64| chart.backend_coord(&(0.0, threshold)).1;
        let band = [
            (left + px(76), height(highest)),
            (left + width, height(lowest)),
        ];
        page.draw(&Rectangle::new(band, HAIRLINE.filled()))?;
        let y = height(threshold);
        dashed(page, (left + px(76), left + width), y)?;
        // Above the line, unless the line is so high that the label would leave the plot.
        let (label, up) = if threshold < 0.85 {
            (y - px(9), VPos::Bottom)
        } else {
            (y + px(9), VPos::Top)
        };
        page.draw(&Text::new(
            threshold_label(lowest, highest),
            (left + width - px(6), label),
            bold(16, INK, HPos::Right, up),
        ))?;
    }
    for pose in poses {
        mark(page, pose.verdict, at(pose))?;
    }
    let mut taken = Vec::new();
    for (letter_index, &index) in lettered.iter().enumerate() {
        let pose = &poses[index];
        let floor = chart.backend_coord(&(0.0, -0.04)).1;
        let spot = free_spot(at(pose), pose.verdict, (top + px(34), floor), &taken);
        let line = vec![at(pose), spot];
        page.draw(&PathElement::new(
            line,
            pose.verdict.colour().stroke_width(px(2) as u32),
        ))?;
        letter(page, pose.verdict, letter_index, spot)?;
        taken.push(spot);
    }
    Ok(())
}

/// Each pose has a threshold of its own where its points fall on components of different σ.
fn threshold_label(lowest: f64, highest: f64) -> String {
    let (lowest, highest) = (format!("{lowest:.2}"), format!("{highest:.2}"));
    if lowest == highest {
        format!("threshold {lowest}")
    } else {
        format!("threshold {lowest} to {highest}")
    }
}

/// Where a letter stands beside its point: between the plot's ceiling and floor, without covering
/// a letter that is already there, and rather on the point's side of the threshold.
fn free_spot(
    (x, y): (i32, i32),
    verdict: Verdict,
    (ceiling, floor): (i32, i32),
    taken: &[(i32, i32)],
) -> (i32, i32) {
    let away = match verdict {
        Verdict::Reject => -1,
        Verdict::Accept | Verdict::Undecided => 1,
    };
    let near = px(24) * away;
    let far = px(46) * away;
    let offsets = [
        (0, -near),
        (0, near),
        (near, -near),
        (-near, -near),
        (0, -far),
        (0, far),
    ];
    let free = |spot: &(i32, i32)| {
        spot.1 - px(14) >= ceiling
            && spot.1 + px(14) <= floor
            && taken.iter().all(|other| {
                let (dx, dy) = (spot.0 - other.0, spot.1 - other.1);
                dx * dx + dy * dy >= px(26) * px(26)
            })
    };
    let mut spots = offsets.iter().map(|(dx, dy)| (x + dx, y + dy));
    spots.find(free).unwrap_or((x, y + near))
}

/// The marks with their meaning and count, ending at the right.
fn legend(page: &Page, (right, middle): (i32, i32), poses: &[ScoredPose]) -> Drawn {
    let mut x = right;
    for decision in Verdict::ALL.into_iter().rev() {
        let count = poses.iter().filter(|pose| pose.verdict == decision).count();
        if count == 0 {
            continue;
        }
        let label = format!("{count} {}", decision.participle());
        let style = text(17, INK, HPos::Right, VPos::Center);
        let (width, _) = page.estimate_text_size(&label, &style)?;
        page.draw(&Text::new(label, (x, middle), style))?;
        x -= width as i32 + px(14);
        mark(page, decision, (x, middle))?;
        x -= px(34);
    }
    Ok(())
}

fn dashed(page: &Page, (from, to): (i32, i32), y: i32) -> Drawn {
    let (dash, gap) = (px(9), px(6));
    let mut x = from;
    while x < to {
        let corners = [(x, y - px(1)), ((x + dash).min(to) - 1, y + px(1) - 1)];
        page.draw(&Rectangle::new(corners, INK.filled()))?;
        x += dash + gap;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_of_close_points_do_not_cover_each_other() {
        let first = free_spot((500, 500), Verdict::Accept, (0, 1000), &[]);
        let second = free_spot((504, 500), Verdict::Accept, (0, 1000), &[first]);
        let apart = (f64::from(first.0 - second.0)).hypot(f64::from(first.1 - second.1));
        assert!(apart >= f64::from(px(26)));
    }

    #[test]
    fn letters_of_high_points_stay_in_the_plot() {
        let (_, y) = free_spot((500, 110), Verdict::Accept, (100, 1000), &[]);
        assert!(y > 110);
    }
}
