//! Samples: what C gets is what the pipeline says.

use core::ptr;

use fingertip::contact::{Continuity, Happened, Impact, Tracked};
use fingertip::wrench::{Motion, Wrench};
use fingertip_c::{
    ft_beside, ft_beside_last, ft_continuity, ft_motion, ft_reading_of, ft_resolution, ft_sense,
    ft_sense_reading, ft_sense_wrench, ft_sense_wrench_moving, ft_slip, ft_status, ft_tip_gauges,
    ft_tip_reset, ft_tip_start_anew, ft_touch, ft_wrench,
};
use fingertip_scene::{Felt, GaugeReading, Pipeline};
use nalgebra::{Matrix2, Vector3};

use crate::{BALL, HEAD, Tip, bits, pushes, scene, written};

const STEP: f64 = 1e-3;

/// Every field of a touch against what the pipeline says.
fn agrees(touch: &ft_touch, felt: &Felt<f64>) {
    let told = &felt.touch;
    assert_eq!(touch.wrench.force, <[f64; 3]>::from(told.wrench.force()));
    assert_eq!(touch.wrench.torque, <[f64; 3]>::from(told.wrench.torque()));
    assert_eq!(touch.slip as u32, told.slip.map_or(0, |slip| slip as u32), "{told:?}");
    let Some(contact) = felt.contact() else {
        assert_ne!(touch.resolution, ft_resolution::FT_CONTACT);
        assert_eq!((touch.has_margin, touch.alternatives, touch.normal_force), (0, 0, 0.0));
        assert_eq!([touch.point, touch.normal, touch.tangential_force], [[0.0; 3]; 3]);
        return;
    };
    assert_eq!(touch.resolution, ft_resolution::FT_CONTACT);
    assert_eq!(touch.point, <[f64; 3]>::from(contact.point));
    assert_eq!(touch.normal, <[f64; 3]>::from(contact.normal));
    assert_eq!((touch.gap, touch.alternatives), (contact.gap, u32::from(contact.alternatives)));
    assert_eq!((touch.searched, touch.reserved), (u32::from(contact.searched), 0));
    let force = felt.force().unwrap();
    assert_eq!(touch.normal_force, force.normal);
    assert_eq!(touch.tangential_force, <[f64; 3]>::from(force.tangential.vector()));
    assert_eq!(touch.spin_torque, force.spin);
    let margin = felt.margin().map(|margin| (margin.newtons, margin.utilisation));
    assert_eq!((touch.has_margin == 1).then_some((touch.margin, touch.utilisation)), margin);
}

fn sense(tip: &Tip, wrench: &ft_wrench, step: f64) -> ft_touch {
    written(|touch| unsafe { ft_sense_wrench(tip.0, wrench, step, touch) }).unwrap()
}

fn loaded(wrench: &ft_wrench, sign: f64) -> Wrench<f64> {
    let [force, torque] = [wrench.force, wrench.torque].map(|vector| Vector3::from(vector) * sign);
    Wrench::on_fingertip(force, torque)
}

const RICH: &str = "[contact]\nmodel = \"soft_finger\"\n[uncertainty]\nforce_noise_N = 0.01\ntorque_noise_Nm = 0.0001\n\
    [tracking]\nspeed_m_per_s = 0.05\nturns_within_s = 0.1\nleast_touch_N = 0.05\n\
    [friction]\nlimit = \"uncertain\"\nstatic_coefficient = 0.6\ndeviation = 0.05\n\
    [slip]\ndetector = \"drop\"\nnoise_N = 0.01\n[estimate]\nnoise_N = 0.01\n\
    [grip]\nleast_N = 0.3\ngreatest_N = 15.0\nrise_N_per_s = 200.0\nfall_N_per_s = 2.0\n";

/// Of a surface that tells nothing of itself contacts are searched for, and that is said.
#[test]
fn a_search_is_said_to_be_one() {
    for (topology, searched) in [("convex = true\n", 0), ("", 1)] {
        let tip = Tip::new(&format!(
            "{HEAD}[surface]\nshape = \"formula\"\nreach_m = 0.018\n{topology}\
             outside = \"(x/0.01)^2 + (y/0.012)^2 + (z/0.014)^2 - 1\"\n[contact]\nmodel = \"soft_finger\"\n"
        ));
        let wrench = ft_wrench { force: [0.1, 0.0, -1.0], torque: [0.0, 0.0014, 1e-4] };
        let touch = sense(&tip, &wrench, STEP);
        assert_eq!((touch.resolution, touch.searched), (ft_resolution::FT_CONTACT, searched), "{touch:?}");
    }
}

#[test]
fn a_touch_is_what_the_pipeline_says() {
    let reaction = HEAD.replace("on_fingertip", "reaction");
    for (text, sign) in [
        (format!("{HEAD}{BALL}"), 1.0),
        (format!("{reaction}{BALL}[friction]\nstatic_coefficient = 0.4\n"), -1.0),
        (format!("{HEAD}{BALL}{RICH}"), 1.0),
        (format!("{HEAD}[surface]\nshape = \"torus\"\nring_radius_m = 0.007\ntube_radius_m = 0.006\n"), 1.0),
        (format!("{HEAD}[filter]\nkind = \"low_pass\"\ncutoff_Hz = 50.0\n{BALL}"), 1.0),
    ] {
        let (tip, mut pipeline) = (Tip::new(&text), scene(&text).pipeline());
        let mut contacts = 0;
        for (index, wrench) in pushes(3, 500).iter().enumerate() {
            // The last ones behind a pause, and with a time that is none.
            let step =
                if index % 100 == 99 { 0.6 } else { [STEP, -1.0, f64::NAN][usize::from(index % 50 == 7)] };
            let reported =
                ft_wrench { force: wrench.force.map(|x| x * sign), torque: wrench.torque.map(|x| x * sign) };
            let touch = sense(&tip, &reported, step);
            agrees(&touch, pipeline.sense(loaded(wrench, 1.0), step));
            contacts += usize::from(touch.resolution == ft_resolution::FT_CONTACT);
        }
        assert!(contacts > 100, "{contacts} contacts of {text}");
    }
}

#[test]
fn what_stands_beside_is_what_the_pipeline_says() {
    let text = format!("{HEAD}{BALL}{RICH}");
    let (tip, mut pipeline) = (Tip::new(&text), scene(&text).pipeline());
    let beside = || -> ft_beside { written(|to| unsafe { ft_beside_last(tip.0, to) }).unwrap() };
    assert_eq!(beside(), ft_beside::default());
    let mut seen = [0_u32; 9];
    // A press that grows, slips now and then, and ends; each begins with a blow.
    for k in 0..3000 {
        let slide = if k % 400 > 380 { 0.3 } else { 0.55 };
        let press = match k % 1200 {
            0..50 => 0.0,
            50..60 => 6.0,
            _ => 2.0,
        };
        let force = Vector3::new(slide * f64::from(k % 400) / 400.0, 0.0, -1.0) * press;
        let at = Vector3::z() * 0.013;
        let wrench = ft_wrench { force: force.into(), torque: at.cross(&force).into() };
        sense(&tip, &wrench, STEP);
        let felt = pipeline.sense(loaded(&wrench, 1.0), STEP);
        let told = beside();
        let spread =
            felt.spread.map(|spread| (spread.ellipse.semi_axes, spread.normal_force, spread.spin_torque));
        let found = (told.ellipse_semi_axes, told.normal_force_deviation, told.spin_torque_deviation);
        assert_eq!((told.has_spread == 1).then_some(found), spread);
        assert_eq!((told.has_tracked == 1).then_some(track_of(&told)), felt.tracked);
        assert_eq!((told.has_touching == 1).then_some(happened_of(&told)), felt.happened);
        assert_eq!((told.has_slip_probability == 1).then_some(told.slip_probability), felt.slip_probability);
        let learnt = felt.friction.unwrap();
        let at_rest = learnt.at_rest.map(|it| (it.coefficient, it.deviation));
        let found = (told.static_friction, told.static_friction_deviation);
        assert_eq!((told.has_static_friction == 1).then_some(found), at_rest);
        let sliding = learnt.sliding.map(|it| (it.coefficient, it.deviation));
        let found = (told.kinetic_friction, told.kinetic_friction_deviation);
        assert_eq!((told.has_kinetic_friction == 1).then_some(found), sliding);
        assert_eq!((told.has_grip_force == 1).then_some(told.grip_force), felt.grip_force);
        let flags = [
            told.has_spread,
            told.has_tracked,
            told.touching,
            told.has_touch,
            told.has_release,
            told.has_impact,
            told.has_slip_probability,
            told.has_static_friction,
            told.has_kinetic_friction,
        ];
        seen.iter_mut().zip(flags).for_each(|(seen, flag)| *seen += flag);
    }
    assert!(seen.iter().all(|count| *count > 0), "{seen:?}");
}

/// The track as C sees it, put together again.
fn track_of(told: &ft_beside) -> Tracked<f64> {
    let [row, other] = told.tracked_position_covariance;
    let [fast, faster] = told.tracked_velocity_covariance;
    Tracked {
        point: told.tracked_point.into(),
        normal: told.tracked_normal.into(),
        tangents: told.tracked_tangents.map(Vector3::from),
        velocity: told.tracked_velocity.into(),
        position_covariance: Matrix2::new(row[0], row[1], other[0], other[1]),
        velocity_covariance: Matrix2::new(fast[0], fast[1], faster[0], faster[1]),
        innovation: told.tracked_innovation.into(),
        surprise: told.tracked_surprise,
        continuity: match told.continuity {
            ft_continuity::FT_TRACK_NEW => Continuity::New,
            ft_continuity::FT_TRACK_FOLLOWED => Continuity::Followed,
            ft_continuity::FT_TRACK_DOUBTED => Continuity::Doubted,
            ft_continuity::FT_TRACK_BRIDGED => Continuity::Bridged,
        },
    }
}

/// What happened as C sees it.
fn happened_of(told: &ft_beside) -> Happened<f64> {
    Happened {
        touching: told.touching == 1,
        touch: (told.has_touch == 1).then_some(told.touch_age),
        release: (told.has_release == 1).then_some(told.release_age),
        impact: (told.has_impact == 1).then(|| Impact {
            peak: told.impact_peak,
            impulse: told.impact_impulse.into(),
            duration: told.impact_duration,
        }),
    }
}

const SENSOR: &str = "[sensor]\nsignal_unit = \"V\"\nload_per_signal_N_Nm = [\n\
    [5.0, 0.1, 0.0, 0.0, 0.0, 0.0],\n[0.0, 5.0, 0.0, 0.2, 0.0, 0.0],\n[0.0, 0.0, 5.0, 0.0, 0.0, 0.0],\n\
    [0.0, 0.0, 0.0, 0.05, 0.0, 0.0],\n[0.0, 0.0, 0.001, 0.0, 0.05, 0.0],\n[0.0, 0.0, 0.0, 0.0, 0.0, 0.05],\n]\n\
    range = [-2.0, 2.0]\n";

fn motion() -> (ft_motion, Motion<f64>) {
    let told = ft_motion {
        gravity: [1.0, 2.0, -9.0],
        angular_velocity: [0.1, -0.2, 0.3],
        angular_acceleration: [1.0, 0.5, -0.5],
    };
    let [gravity, angular_velocity, angular_acceleration] =
        [told.gravity, told.angular_velocity, told.angular_acceleration].map(Vector3::from);
    (told, Motion { gravity, angular_velocity, angular_acceleration })
}

fn volts(wrench: &ft_wrench) -> [f64; 6] {
    let [fx, fy, fz] = wrench.force.map(|x| x / 5.0);
    let [tx, ty, tz] = wrench.torque.map(|x| x / 0.05);
    [fx, fy, fz, tx, ty, tz]
}

#[test]
fn a_reading_is_sensed_as_the_pipeline_senses_it() {
    let text = format!("{HEAD}{SENSOR}{BALL}");
    let (tip, mut pipeline) = (Tip::new(&text), scene(&text).pipeline());
    assert_eq!(unsafe { ft_tip_gauges(tip.0) }, 6);
    for wrench in pushes(5, 300) {
        let signals = volts(&wrench);
        let felt = *pipeline.sense_reading(&GaugeReading::of(&signals), None, STEP).unwrap();
        agrees(&written(|to| unsafe { ft_sense(tip.0, signals.as_ptr(), 6, STEP, to) }).unwrap(), &felt);
    }
    let mut signals = [0.0; 6];
    for (number, status) in [
        (2.0, ft_status::FT_SATURATED),
        (-3.0, ft_status::FT_SATURATED),
        (f64::NAN, ft_status::FT_INCOMPLETE),
        (f64::INFINITY, ft_status::FT_INCOMPLETE),
    ] {
        signals[2] = number;
        let sensed = written::<ft_touch>(|to| unsafe { ft_sense(tip.0, signals.as_ptr(), 6, STEP, to) });
        assert_eq!(sensed.unwrap_err(), status);
    }
}

#[test]
fn a_payload_is_taken_off_with_the_motion() {
    let carried = "[payload]\nmass_kg = 0.12\ncentre_of_mass_m = [0.0, 0.001, 0.03]\n";
    let (told, moves) = motion();
    let text = format!("{HEAD}{SENSOR}{carried}{BALL}");
    let (tip, mut pipeline) = (Tip::new(&text), scene(&text).pipeline());
    for wrench in pushes(6, 200) {
        let felt = *pipeline.sense_moving(loaded(&wrench, 1.0), &moves, STEP);
        let sensed = written(|to| unsafe { ft_sense_wrench_moving(tip.0, &wrench, &told, STEP, to) });
        agrees(&sensed.unwrap(), &felt);
        let still = written::<ft_touch>(|to| unsafe { ft_sense_wrench(tip.0, &wrench, STEP, to) });
        assert_eq!(still.unwrap_err(), ft_status::FT_NO_MOTION);

        let signals = volts(&wrench);
        let felt = *pipeline.sense_reading(&GaugeReading::of(&signals), Some(&moves), STEP).unwrap();
        let mut reading = ft_reading_of(signals.as_ptr(), 6);
        reading.motion = &raw const told;
        agrees(&written(|to| unsafe { ft_sense_reading(tip.0, &reading, STEP, to) }).unwrap(), &felt);
        reading.motion = ptr::null();
        let still = written::<ft_touch>(|to| unsafe { ft_sense_reading(tip.0, &reading, STEP, to) });
        assert_eq!(still.unwrap_err(), ft_status::FT_NO_MOTION);
    }
}

/// A line through both sides of a ring: the last contact tells which entry is meant.
#[test]
fn what_was_felt_before_is_forgotten_as_is_said() {
    let text = format!(
        "{HEAD}[surface]\nshape = \"torus\"\nring_radius_m = 0.03\ntube_radius_m = 0.01\n[estimate]\nnoise_N = 0.01\n\
                 [friction]\nstatic_coefficient = 0.6\n[slip]\ndetector = \"drop\"\nnoise_N = 0.01\n"
    );
    let tip = Tip::new(&text);
    let push = |point: Vector3<f64>, force: Vector3<f64>| ft_wrench {
        force: force.into(),
        torque: point.cross(&force).into(),
    };
    let left = push(Vector3::new(0.0, 0.0, 0.012), Vector3::new(-1.0, 0.0, -0.7));
    let twice = push(Vector3::zeros(), -Vector3::x());
    let met = |wrench: &ft_wrench| sense(&tip, wrench, STEP).point[0];
    assert!((met(&twice) - 0.04).abs() < 1e-9);
    for forget in [ft_tip_reset, ft_tip_start_anew] {
        assert!(met(&left) < -0.02);
        assert!((met(&twice) + 0.02).abs() < 1e-9);
        assert_eq!(unsafe { forget(tip.0) }, ft_status::FT_OK);
        assert!((met(&twice) - 0.04).abs() < 1e-9);
    }
}

/// Two tips of one scene in two threads, and one that moves between them.
#[test]
fn handles_are_independent_and_may_move_between_threads() {
    struct Moves(Tip);
    // SAFETY: as the header says: a handle may be used by any thread, by one at a time.
    unsafe impl Send for Moves {}
    let text = format!("{HEAD}{BALL}{RICH}");
    let run = |tip: &Tip| -> Vec<Vec<u64>> {
        pushes(8, 300).iter().map(|wrench| bits(&sense(tip, wrench, STEP))).collect()
    };
    let alone = run(&Tip::new(&text));
    let tips = [(); 2].map(|()| Moves(Tip::new(&text)));
    let ran = tips.map(|tip| {
        std::thread::spawn(move || {
            let moved = tip;
            let ran = run(&moved.0);
            (moved, ran)
        })
    });
    for thread in ran {
        let (tip, ran) = thread.join().unwrap();
        assert_eq!(ran, alone);
        assert_eq!(unsafe { ft_tip_reset(tip.0.0) }, ft_status::FT_OK);
        assert_eq!(run(&tip.0).last(), alone.last());
    }
    // What is sent is as free of threads as the header says.
    const fn sends<T: Send + Sync>() {}
    sends::<Pipeline<f64>>();
    assert_eq!(ft_slip::FT_SLIPPING as u32, fingertip::friction::SlipVerdict::Slipping as u32);
}
