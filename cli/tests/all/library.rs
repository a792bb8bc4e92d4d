//! The analysis for programs that have the command within them.

use fingertip_cli::library::{Recorded, Sample, analyze};
use fingertip_scene::Scene;

use crate::common::Folder;

/// Every row is handed on in its order, with its time, those without a wrench by the word that the command writes.
#[test]
fn rows_without_a_wrench_are_handed_on_with_the_reason() {
    let folder = Folder::new();
    folder.write(
        "push.csv",
        "t_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm\n0,0,0,0,0,0,0\n0.5,0,0,-1,0,0,0\n0.75,0,0,,0,0,0\n1,0,0,-2,0,0,0\n",
    );
    let scene = Scene::from_text(
        "version = 2\n[input]\nconvention = \"on_fingertip\"\n[surface]\nshape = \"plane\"\n[contact]\nleast_force_N = 0.1\n",
    )
    .unwrap();
    let recorded = Recorded { path: folder.path("push.csv"), ..Recorded::default() };
    let mut rows = Vec::new();
    let mut pressed = Vec::new();
    analyze(&scene, "pad.toml".as_ref(), &recorded, &mut |time, sample| {
        rows.push((time, sample.status()));
        if let Sample::Felt(felt) = sample {
            pressed.extend(felt.force().map(|force| force.normal));
        }
    })
    .unwrap();
    let wanted = [(0.0, "below_threshold"), (0.5, "contact"), (0.75, "unusable_row"), (1.0, "contact")];
    assert_eq!((rows.as_slice(), pressed), (&wanted[..], vec![1.0, 2.0]));
}
