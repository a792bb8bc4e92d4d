//! What went missing on the way, in words.

use fingertip_drivers::devices::Losses;

use crate::table::count;

/// Losses as far as they are known.
pub(crate) fn said(losses: &Losses) -> String {
    let mut text = match losses.lost {
        Some(lost) => {
            let [lost, late, duplicates] = [lost, losses.late, losses.duplicates].map(count);
            format!("{lost} lost, {late} late, {duplicates} repeated")
        }
        // Whoever cannot tell what is lost cannot tell what comes late or twice, either.
        None => "lost: not told".to_owned(),
    };
    text += &format!(", {} damaged", count(losses.corrupt));
    if losses.skipped_bytes > 0 {
        text += &format!(", {} bytes skipped", count(losses.skipped_bytes));
    }
    if losses.restarts > 0 {
        text += &format!(", counted anew {} times", count(losses.restarts));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::{Losses, said};

    #[test]
    fn losses_are_said_as_far_as_they_are_known() {
        let all =
            Losses { lost: Some(1200), late: 2, duplicates: 3, corrupt: 4, skipped_bytes: 5, restarts: 6 };
        let expected =
            "1\u{202f}200 lost, 2 late, 3 repeated, 4 damaged, 5 bytes skipped, counted anew 6 times";
        assert_eq!(said(&all), expected);
        let untold = Losses { lost: None, corrupt: 1, ..Losses::default() };
        assert_eq!(said(&untold), "lost: not told, 1 damaged");
        assert_eq!(said(&Losses { lost: Some(0), ..untold }), "0 lost, 0 late, 0 repeated, 1 damaged");
    }
}
