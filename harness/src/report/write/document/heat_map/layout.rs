//! Where the panels, the titles and the colour bar of a heat map are.

use super::super::super::draw::{ColourBar, Labels, Point, Rect, X_TITLE, Y_TITLE};
use super::super::super::figure::{FOOT, LEFT, RIGHT, WIDTH};
use super::super::chart::TOP;

/// Heights of panels by how many there are in a row.
const HEIGHTS: [f64; 3] = [700.0, 460.0, 330.0];
/// Room for the heading of a panel.
const HEAD: f64 = 36.0;
/// Between panels side by side: the labels at the ends of their axes need this much; and between rows.
const GAP: f64 = 48.0;
const ROW_GAP: f64 = 30.0;
const BAR: f64 = 30.0;
const BEFORE_BAR: f64 = 32.0;

/// All that decides about it.
pub(super) struct Layout {
    pub(super) panels: usize,
    /// Whether a panel has a heading.
    pub(super) headed: bool,
    /// Whether there is a colour bar.
    pub(super) bar: bool,
    /// Height of the legend.
    pub(super) legend: f64,
}

impl Layout {
    /// Panels per row: as square as three allow.
    fn columns(&self) -> usize {
        match self.panels {
            0 | 1 => 1,
            2 | 4 => 2,
            _ => 3,
        }
    }

    fn rows(&self) -> usize {
        self.panels.div_ceil(self.columns()).max(1)
    }

    fn height(&self) -> f64 {
        HEIGHTS[self.columns() - 1]
    }

    fn head(&self) -> f64 {
        if self.headed { HEAD } else { 0.0 }
    }

    /// The rectangle around all panels.
    fn all(&self) -> Rect {
        let right = if self.bar { RIGHT - ColourBar::ROOM - BAR - BEFORE_BAR } else { RIGHT };
        let top = TOP + self.head();
        let rows = self.rows() as f64;
        let bottom = top + rows * self.height() + (rows - 1.0) * (ROW_GAP + self.head());
        Rect { left: LEFT, top, right, bottom }
    }

    /// A panel, and which of its axes have labels: those on the left and on the lower edge of the whole.
    pub(super) fn panel(&self, k: usize) -> (Rect, Labels) {
        let (all, columns) = (self.all(), self.columns());
        let width = (all.right - all.left - GAP * (columns - 1) as f64) / columns as f64;
        let left = all.left + (k % columns) as f64 * (width + GAP);
        let top = all.top + (k / columns) as f64 * (self.height() + ROW_GAP + self.head());
        let rect = Rect { left, top, right: left + width, bottom: top + self.height() };
        let labels = match (k + columns >= self.panels, k.is_multiple_of(columns)) {
            (true, true) => Labels::Both,
            (true, false) => Labels::XOnly,
            (false, true) => Labels::YOnly,
            (false, false) => Labels::Neither,
        };
        (rect, labels)
    }

    /// How many ticks an axis of a panel has, about.
    pub(super) fn ticks(&self) -> [usize; 2] {
        [[12, 6, 5], [12, 8, 6]].map(|counts| counts[self.columns() - 1])
    }

    /// Where the titles of the axes are: once for all panels.
    pub(super) fn titles(&self) -> [Point; 2] {
        let Rect { left, top, right, bottom } = self.all();
        [(f64::midpoint(left, right), bottom + X_TITLE), (left - Y_TITLE, f64::midpoint(top, bottom))]
    }

    /// The colour bar.
    pub(super) fn bar(&self) -> Option<Rect> {
        let all = self.all();
        let left = all.right + BEFORE_BAR;
        self.bar.then_some(Rect { left, right: left + BAR, ..all })
    }

    /// Where the legend begins.
    pub(super) fn foot(&self) -> f64 {
        self.all().bottom + FOOT
    }

    /// Width and height of the figure.
    pub(super) fn size(&self) -> [u32; 2] {
        [WIDTH, (self.foot() + self.legend + 16.0) as u32]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panels_keep_apart_and_every_column_has_labels_at_its_foot() {
        for panels in 1..=12 {
            let layout = Layout { panels, headed: true, bar: true, legend: 36.0 };
            let (rects, labels): (Vec<Rect>, Vec<Labels>) = (0..panels).map(|k| layout.panel(k)).unzip();
            let bar = layout.bar().unwrap();
            for (k, rect) in rects.iter().enumerate() {
                assert!(rect.right < bar.left && rect.bottom <= bar.bottom + 1e-9);
                assert!(rects[..k].iter().all(|other| !other.touches(rect)), "{panels}");
                let lowest = rects[k + 1..].iter().all(|other| other.left != rect.left);
                assert_eq!(lowest, matches!(labels[k], Labels::Both | Labels::XOnly), "{panels}, {k}");
            }
            assert!(bar.right + ColourBar::ROOM <= f64::from(layout.size()[0]));
        }
    }
}
