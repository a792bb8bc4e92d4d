//! The bridges, arm by arm.

use crate::design::{Bridge, Excitation, TubeLayout};
use crate::sheet::{Anchor, Pen, Sheet};

use super::Foil;

/// Where the wires of a bridge go.
///
/// ```
/// use fingertip_calibration::bench::BridgeNode;
/// use fingertip_calibration::design::Bridge;
///
/// // The gauge that a half bridge adds runs from the supply to the negative output.
/// let ends = Bridge::half(0, 1).arms().iter().position(|arm| *arm == Some(0)).map(|arm| BridgeNode::ARMS[arm]);
/// assert_eq!(ends, Some([BridgeNode::Supply, BridgeNode::Minus]));
/// // Each node joins two arms.
/// let joined = BridgeNode::ARMS.as_flattened().iter().filter(|node| **node == BridgeNode::Plus).count();
/// assert_eq!(joined, 2);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BridgeNode {
    /// The supply.
    Supply,
    /// Ground of the supply.
    Ground,
    /// The negative output.
    Minus,
    /// The positive output.
    Plus,
}

impl BridgeNode {
    /// The two ends of each arm, in the order of [`Bridge::arms`]: arms 0 and 1 divide the supply at the negative output,
    /// arms 3 and 2 at the positive one.
    pub const ARMS: [[Self; 2]; 4] = [
        [Self::Supply, Self::Minus],
        [Self::Minus, Self::Ground],
        [Self::Plus, Self::Ground],
        [Self::Supply, Self::Plus],
    ];

    /// Its place about the middle of the drawn bridge \[mm\].
    const fn place(self) -> [f64; 2] {
        match self {
            Self::Supply => [0.0, -24.0],
            Self::Ground => [0.0, 24.0],
            Self::Minus => [-24.0, 0.0],
            Self::Plus => [24.0, 0.0],
        }
    }
}

/// Bridges beside and below each other on a sheet.
const COLUMNS: usize = 2;
const ROWS: usize = 3;
/// Room for one \[mm\].
const CELL: [f64; 2] = [93.0, 76.0];
const MARGIN: f64 = 15.0;
/// Length and half the width of a resistor \[mm\].
const RESISTOR: [f64; 2] = [11.0, 1.8];

/// The bridges on sheets of A4, six to a sheet: which gauge is which arm, what is a fixed resistor, and where the wires go.
/// Outputs are positive where what the layout calls the bridge's strain is.
#[must_use]
pub fn wiring(layout: &TubeLayout, foil: &Foil, excitation: &Excitation) -> Vec<Sheet> {
    let quarters: Vec<Bridge> = (0..layout.gauges.len()).map(Bridge::quarter).collect();
    let bridges = if layout.bridges.is_empty() { &quarters } else { &layout.bridges };
    let current = excitation.supply / foil.resistance;
    let mut sheets = Vec::new();
    for (page, some) in bridges.chunks(COLUMNS * ROWS).enumerate() {
        let mut sheet =
            Sheet::a4(if page == 0 { "Wiring of the bridges" } else { "Wiring of the bridges, continued" });
        let lines = [
            format!(
                "Supply {} V. Each bridge of {} ohm takes {:.1} mA, all of them {:.0} mA. R is a fixed resistor of as many ohm,",
                excitation.supply,
                foil.resistance,
                current * 1e3,
                current * 1e3 * bridges.len() as f64
            ),
            "with little temperature coefficient. The output is positive where the gauges of arms 0 and 2 are stretched.".to_owned(),
            temperature(bridges),
        ];
        let top = sheet.heading(MARGIN, 12.0, &lines) + 2.0;
        for (place, bridge) in some.iter().enumerate() {
            let (row, column) = (place / COLUMNS, place % COLUMNS);
            let middle = [MARGIN + CELL[0] * (column as f64 + 0.5), top + CELL[1] * (row as f64 + 0.5)];
            drawn(&mut sheet, middle, page * COLUMNS * ROWS + place + 1, bridge);
        }
        sheets.push(sheet);
    }
    sheets
}

fn temperature(bridges: &[Bridge]) -> String {
    let feeling = bridges.iter().filter(|bridge| !bridge.compensates_temperature()).count();
    match feeling {
        0 => "Every bridge has as many gauges that subtract as that add: temperature cancels.".to_owned(),
        1 => "One bridge feels temperature: glue one gauge more to the same metal without load, and subtract it.".to_owned(),
        some => format!("{some} bridges feel temperature: glue one gauge more to the same metal without load, and subtract it."),
    }
}

/// One bridge about its middle.
fn drawn(sheet: &mut Sheet, [x, y]: [f64; 2], channel: usize, bridge: &Bridge) {
    let on = |node: BridgeNode| {
        let [across, down] = node.place();
        [x + across, y + down]
    };
    for (number, (arm, [from, to])) in bridge.arms().into_iter().zip(BridgeNode::ARMS).enumerate() {
        let (from, to) = (on(from), on(to));
        let [dx, dy] = [to[0] - from[0], to[1] - from[1]];
        let length = dx.hypot(dy);
        let along = [dx / length, dy / length];
        let at = |far: f64, side: f64| {
            [from[0] + far * along[0] - side * along[1], from[1] + far * along[1] + side * along[0]]
        };
        let [long, half] = RESISTOR;
        let (begin, end) = (0.5 * (length - long), 0.5 * (length + long));
        sheet.line(Pen::Thin, from, at(begin, 0.0));
        sheet.line(Pen::Thin, at(end, 0.0), to);
        let pen = if arm.is_some() { Pen::Thick } else { Pen::Thin };
        let corners = [at(begin, -half), at(end, -half), at(end, half), at(begin, half)];
        sheet.polygon(pen, &format!("channel-{channel}-arm-{number}"), corners);
        let label = arm.map_or_else(|| "R".to_owned(), |gauge| format!("gauge {}", gauge + 1));
        let middle = at(0.5 * length, 0.0);
        let outward = (middle[0] - x).signum();
        let anchor = if outward > 0.0 { Anchor::Start } else { Anchor::End };
        let lower = if middle[1] > y { 3.0 } else { -2.0 };
        sheet.text([middle[0] + outward * 3.0, middle[1] + lower], 2.8, anchor, &label);
        sheet.text(
            [middle[0] - outward * 4.5, middle[1] - lower + 0.8],
            2.0,
            Anchor::Middle,
            &number.to_string(),
        );
    }
    for node in [BridgeNode::Supply, BridgeNode::Ground, BridgeNode::Minus, BridgeNode::Plus] {
        sheet.circle(Pen::Thick, "", on(node), 0.5);
    }
    let [sx, sy] = on(BridgeNode::Supply);
    sheet.text([sx, sy - 1.8], 2.8, Anchor::Middle, "+ supply");
    let [gx, gy] = on(BridgeNode::Ground);
    sheet.text([gx, gy + 4.0], 2.8, Anchor::Middle, "ground");
    let [mx, my] = on(BridgeNode::Minus);
    sheet.text([mx - 1.5, my + 1.0], 2.8, Anchor::End, "out −");
    let [px, py] = on(BridgeNode::Plus);
    sheet.text([px + 1.5, py + 1.0], 2.8, Anchor::Start, "out +");
    sheet.text([x, y + 1.2], 3.5, Anchor::Middle, &format!("channel {channel}"));
}
