//! Columns: the numbers of one sample after the other.

use core::ptr;

use fingertip_c::{
    ft_resolution, ft_sense_all, ft_sense_wrench, ft_status, ft_touch, ft_touch_columns, ft_wrench,
    ft_wrench_columns,
};

use crate::{BALL, HEAD, Tip, pushes, written};

const STEP: f64 = 1e-3;

fn columns_of(wrenches: &[ft_wrench]) -> [Vec<f64>; 6] {
    core::array::from_fn(|axis| {
        wrenches.iter().map(|wrench| [wrench.force, wrench.torque].as_flattened()[axis]).collect()
    })
}

fn from(columns: &[Vec<f64>; 6]) -> ft_wrench_columns {
    let [fx, fy, fz, tx, ty, tz] = columns.each_ref().map(Vec::as_ptr);
    ft_wrench_columns { fx, fy, fz, tx, ty, tz }
}

fn to(columns: &mut [Vec<f64>; 9], slip: &mut [u8]) -> ft_touch_columns {
    let columns = columns.each_mut().map(Vec::as_mut_ptr);
    let [
        point_x,
        point_y,
        point_z,
        normal_force,
        tangential_x,
        tangential_y,
        tangential_z,
        margin,
        utilisation,
    ] = columns;
    ft_touch_columns {
        point_x,
        point_y,
        point_z,
        normal_force,
        tangential_x,
        tangential_y,
        tangential_z,
        margin,
        utilisation,
        slip: slip.as_mut_ptr(),
    }
}

fn numbers(touch: &ft_touch) -> [f64; 9] {
    let ([x, y, z], [sx, sy, sz]) = (touch.point, touch.tangential_force);
    [x, y, z, touch.normal_force, sx, sy, sz, touch.margin, touch.utilisation]
}

#[test]
fn columns_are_samples_one_after_the_other() {
    // One that runs in vectors, the same for the reaction, and one that follows slips from sample to sample.
    let friction = "[friction]\nstatic_coefficient = 0.5\n[slip]\nnoise_N = 0.01\ndetector = ";
    let reaction = HEAD.replace("on_fingertip", "reaction");
    for text in [
        format!("{HEAD}{BALL}{friction}\"threshold\"\n"),
        format!("{reaction}{BALL}{friction}\"threshold\"\n"),
        format!("{HEAD}{BALL}{friction}\"drop\"\n"),
    ] {
        for count in [0, 1, 127, 128, 129, 700] {
            let wrenches = pushes(9, count);
            let (single, many) = (Tip::new(&text), Tip::new(&text));
            let input = columns_of(&wrenches);
            let mut output: [Vec<f64>; 9] = core::array::from_fn(|_| vec![7.0; count + 1]);
            let mut slip = vec![9; count + 1];
            let status =
                unsafe { ft_sense_all(many.0, &from(&input), count, STEP, &to(&mut output, &mut slip)) };
            assert_eq!(status, ft_status::FT_OK);
            let mut contacts = 0;
            for (index, wrench) in wrenches.iter().enumerate() {
                let touch: ft_touch =
                    written(|to| unsafe { ft_sense_wrench(single.0, wrench, STEP, to) }).unwrap();
                for (column, expected) in output.iter().zip(numbers(&touch)) {
                    let off = (column[index] - expected).abs();
                    assert!(off <= 1e-12 * expected.abs().max(1e-3), "{index}: {} {expected}", column[index]);
                }
                assert_eq!(u32::from(slip[index]), touch.slip as u32, "{index}");
                contacts += usize::from(touch.resolution == ft_resolution::FT_CONTACT);
            }
            assert!(contacts >= count / 2, "{contacts} of {count}");
            // Behind the end nothing is written.
            assert!(output.iter().all(|column| column[count] == 7.0) && slip[count] == 9);
        }
    }
}

#[test]
fn columns_that_are_left_out_and_columns_in_place() {
    let tip = Tip::new(&format!("{HEAD}{BALL}"));
    let wrenches = pushes(3, 300);
    let mut input = columns_of(&wrenches);
    let mut output: [Vec<f64>; 9] = core::array::from_fn(|_| vec![0.0; 300]);
    let mut slip = vec![0; 300];
    let whole = to(&mut output, &mut slip);
    assert_eq!(unsafe { ft_sense_all(tip.0, &from(&input), 300, STEP, &whole) }, ft_status::FT_OK);
    let expected = output.clone();

    let mut only = vec![0.0; 300];
    let none = ptr::null_mut();
    let parts = ft_touch_columns {
        point_x: input[0].as_mut_ptr(),
        point_y: none,
        point_z: none,
        normal_force: only.as_mut_ptr(),
        tangential_x: none,
        tangential_y: none,
        tangential_z: none,
        margin: none,
        utilisation: none,
        slip: ptr::null_mut(),
    };
    assert_eq!(unsafe { ft_sense_all(tip.0, &from(&input), 300, STEP, &parts) }, ft_status::FT_OK);
    assert_eq!((&only, &input[0]), (&expected[3], &expected[0]));
}

#[test]
fn columns_that_overlap_or_are_not_there_are_refused() {
    let tip = Tip::new(&format!("{HEAD}{BALL}"));
    let input = columns_of(&pushes(3, 100));
    let mut output: [Vec<f64>; 9] = core::array::from_fn(|_| vec![5.0; 100]);
    let mut slip = vec![5; 800];
    let good = to(&mut output, &mut slip);
    let refused =
        |from: &ft_wrench_columns, to: &ft_touch_columns, count: usize, expected: ft_status, says: &str| {
            assert_eq!(unsafe { ft_sense_all(tip.0, from, count, STEP, to) }, expected);
            let said = unsafe { core::ffi::CStr::from_ptr(fingertip_c::ft_tip_message(tip.0)) };
            assert!(said.to_str().unwrap().contains(says), "{said:?}");
        };
    let overlap = ft_status::FT_OVERLAP;
    let shifted = ft_touch_columns { margin: good.utilisation.wrapping_add(99), ..good };
    refused(&from(&input), &shifted, 100, overlap, "`margin` and `utilisation`");
    let shifted = ft_touch_columns { point_z: input[4].as_ptr().cast_mut().wrapping_add(1), ..good };
    refused(&from(&input), &shifted, 99, overlap, "`point_z` and `ty`");
    let bytes = ft_touch_columns { slip: good.point_x.cast::<u8>().wrapping_add(8), ..good };
    refused(&from(&input), &bytes, 100, overlap, "`point_x` and `slip`");
    let missing = ft_wrench_columns { tz: ptr::null(), ..from(&input) };
    refused(&missing, &good, 100, ft_status::FT_NULL, "`tz`");
    refused(&from(&input), &good, usize::MAX, ft_status::FT_BAD_NUMBER, "`count`");
    // No samples overlap with nothing.
    assert_eq!(unsafe { ft_sense_all(tip.0, &from(&input), 0, STEP, &shifted) }, ft_status::FT_OK);
    assert!(output.iter().flatten().all(|x| *x == 5.0) && slip.iter().all(|x| *x == 5));
}
