//! The rectangle of the data with its axes.

use super::super::font::{self, Weight};
use super::super::picture::image::{Align, Color, GREY, INK};
use super::axis::Scale;
use super::canvas::Drawing;

const GRID: Color = [228, 230, 234];
/// Sizes of text.
const TITLE: f64 = 17.0;
pub(super) const LABEL: f64 = 14.0;
pub(super) const TICK: f64 = 12.0;

/// The rectangle of the data.
pub(super) struct Frame {
    pub corner: [f64; 2],
    pub size: [f64; 2],
    pub scales: [Scale; 2],
    /// y grows downwards.
    pub down: bool,
}

impl Frame {
    pub fn place(&self, p: [f64; 2]) -> [f64; 2] {
        let [x, y] = [self.scales[0].part(p[0]), self.scales[1].part(p[1])];
        let y = if self.down { y } else { 1.0 - y };
        [
            self.corner[0] + x * self.size[0],
            self.corner[1] + y * self.size[1],
        ]
    }

    pub fn holds(&self, p: [f64; 2]) -> bool {
        (0..2).all(|a| p[a] >= self.corner[a] - 0.5 && p[a] <= self.corner[a] + self.size[a] + 0.5)
    }

    /// The pieces of a line that lie inside, without points that nobody could tell apart.
    pub fn clipped(&self, points: &[[f64; 2]]) -> Vec<Vec<[f64; 2]>> {
        let mut pieces: Vec<Vec<[f64; 2]>> = Vec::new();
        let mut open = false;
        for pair in points.windows(2) {
            let (from, to) = (self.place(pair[0]), self.place(pair[1]));
            let Some((a, b, whole)) = self.inside(from, to) else {
                open = false;
                continue;
            };
            match pieces.last_mut() {
                Some(piece) if open => {
                    let near = piece
                        .last()
                        .is_some_and(|p| libm::hypot(p[0] - b[0], p[1] - b[1]) < 0.3);
                    if !near || !whole {
                        piece.push(b);
                    }
                }
                _ => pieces.push(vec![a, b]),
            }
            open = whole;
        }
        pieces
    }

    /// Part of a segment inside, and whether its end is.
    fn inside(&self, from: [f64; 2], to: [f64; 2]) -> Option<([f64; 2], [f64; 2], bool)> {
        if !from.iter().chain(&to).all(|c| c.is_finite()) {
            return None;
        }
        let (mut start, mut end) = (0.0f64, 1.0f64);
        for a in 0..2 {
            let (low, high) = (self.corner[a], self.corner[a] + self.size[a]);
            let d = to[a] - from[a];
            if d == 0.0 {
                if from[a] < low - 1e-9 || from[a] > high + 1e-9 {
                    return None;
                }
                continue;
            }
            let (s, e) = ((low - from[a]) / d, (high - from[a]) / d);
            start = start.max(s.min(e));
            end = end.min(s.max(e));
        }
        let at = |t: f64| {
            [
                from[0] + t * (to[0] - from[0]),
                from[1] + t * (to[1] - from[1]),
            ]
        };
        (start <= end).then(|| (at(start), at(end), end >= 1.0))
    }
}

/// Room that the numbers of the y axis and its title take.
pub(super) fn beside(ticks: &[(f64, String)]) -> f64 {
    46.0 + ticks
        .iter()
        .map(|t| font::width(&t.1, TICK, Weight::Regular))
        .fold(0.0, f64::max)
}

/// Draws title, axes, grid and their texts; `right` is left free beside the data.
pub(super) fn axes(
    drawing: &mut Drawing,
    title: &str,
    labels: &[String; 2],
    scales: [Scale; 2],
    wanted: [usize; 2],
    down: bool,
    right: f64,
) -> Frame {
    let ticks = [scales[0].ticks(wanted[0]), scales[1].ticks(wanted[1])];
    let corner = [
        beside(&ticks[1]),
        if title.is_empty() { 20.0 } else { 48.0 },
    ];
    let size = [
        drawing.width - corner[0] - right,
        drawing.height - corner[1] - 56.0,
    ];
    let frame = Frame {
        corner,
        size,
        scales,
        down,
    };
    let (bottom, end) = (corner[1] + size[1], corner[0] + size[0]);
    for (value, text) in &ticks[0] {
        let [x, _] = frame.place([*value, scales[1].low]);
        drawing.segment([x, corner[1]], [x, bottom], 0.8, GRID);
        drawing.segment([x, bottom], [x, bottom + 5.0], 1.0, INK);
        drawing.text([x, bottom + 19.0], text, TICK, Align::Center, INK);
    }
    for (value, text) in &ticks[1] {
        let [_, y] = frame.place([scales[0].low, *value]);
        drawing.segment([corner[0], y], [end, y], 0.8, GRID);
        drawing.segment([corner[0] - 5.0, y], [corner[0], y], 1.0, INK);
        drawing.text([corner[0] - 9.0, y + 4.2], text, TICK, Align::Right, INK);
    }
    let middle = [corner[0] + 0.5 * size[0], corner[1] + 0.5 * size[1]];
    drawing.text(
        [middle[0], bottom + 43.0],
        &labels[0],
        LABEL,
        Align::Center,
        INK,
    );
    drawing.upright([21.0, middle[1]], &labels[1], LABEL, INK);
    drawing.text([corner[0], 29.0], title, TITLE, Align::Left, INK);
    if ticks.iter().any(Vec::is_empty) {
        drawing.text(
            [end, 29.0],
            "the range is too narrow for numbers",
            TICK,
            Align::Right,
            GREY,
        );
    }
    frame
}
