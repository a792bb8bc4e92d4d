//! What the grip controller commands, sample by sample, where it can be told beforehand.

use fingertip_friction::{Coulomb, GripController, GripSettings, SlipVerdict};
use fingertip_wrench::ContactForce;
use nalgebra::Vector3;

const SETTINGS: GripSettings<f64> =
    GripSettings { safety: 1.5, least: 0.5, greatest: 20.0, rise: 100.0, fall: 2.0, slip_boost: 1.25 };

struct Grip(GripController<f64>);

impl Grip {
    fn at(force: f64) -> Self {
        let mut grip = GripController::new(SETTINGS).unwrap();
        grip.start_at(force);
        Self(grip)
    }

    /// The command for a load on a friction of 0.5, of which 1.5 times as much is to be held: three times it.
    fn command(&mut self, load: f64, slip: SlipVerdict, step: f64) -> f64 {
        let force = ContactForce::new(1.0, Vector3::new(load, 0.0, 0.0), 0.0);
        let command = self.0.command(&Coulomb::new(0.5).unwrap(), &force, slip, step);
        assert_eq!(command, self.0.present());
        command
    }
}

fn close(a: f64, b: f64) {
    assert!((a - b).abs() < 1e-12, "{a} {b}");
}

#[test]
fn rates_bound_each_step() {
    let mut grip = Grip::at(6.0);
    // Wanted are 12 N, at 100 N/s.
    close(grip.command(4.0, SlipVerdict::Holding, 0.01), 7.0);
    close(grip.command(4.0, SlipVerdict::NotPressing, 0.02), 9.0);
    close(grip.command(4.0, SlipVerdict::Warning, 0.1), 12.0);
    // And 3 N, at 2 N/s.
    close(grip.command(1.0, SlipVerdict::Holding, 0.5), 11.0);
    close(grip.command(1.0, SlipVerdict::Holding, 4.0), 3.0);
    // Not below the least, nor above the greatest.
    close(grip.command(0.0, SlipVerdict::Holding, 10.0), 0.5);
    close(grip.command(100.0, SlipVerdict::Holding, 10.0), 20.0);
}

#[test]
fn a_slip_boosts_the_command_once() {
    let mut grip = Grip::at(8.0);
    close(grip.command(1.0, SlipVerdict::Slipping, 0.5), 10.0);
    // The boost decays at the falling rate, and so does the command.
    close(grip.command(1.0, SlipVerdict::Holding, 0.5), 9.0);
    close(grip.command(1.0, SlipVerdict::Holding, 0.5), 8.0);
    // The load wants more than what is left of it.
    close(grip.command(5.0, SlipVerdict::Holding, 0.5), 15.0);
    close(grip.command(1.0, SlipVerdict::Holding, 0.5), 14.0);
    // The rise bounds a boost: 17.5 wanted, 0.1 N more at once, the rest later though it decays.
    close(grip.command(1.0, SlipVerdict::Slipping, 1e-3), 14.1);
    close(grip.command(1.0, SlipVerdict::Holding, 0.1), 17.3);
    // No more than the greatest.
    let mut grip = Grip::at(18.0);
    close(grip.command(1.0, SlipVerdict::Slipping, 1.0), 20.0);
    close(grip.command(1.0, SlipVerdict::Holding, 0.5), 19.0);
    // A start forgets the boost.
    grip.0.start_at(5.0);
    close(grip.command(1.0, SlipVerdict::Holding, 10.0), 3.0);
    // A boost that has decayed to the least stays there.
    close(grip.command(0.0, SlipVerdict::Holding, 100.0), 0.5);
    close(grip.command(0.0, SlipVerdict::Slipping, 1e-3), 0.6);
}

#[test]
fn a_start_is_held_to_the_limits() {
    for (wanted, command) in [(0.1, 0.5), (30.0, 20.0), (7.0, 7.0), (-5.0, 0.5)] {
        assert_eq!(Grip::at(wanted).0.present(), command);
    }
    let new = GripController::new(SETTINGS).unwrap();
    assert_eq!(new.present(), 0.5);
    for bad in [f64::NAN, f64::INFINITY] {
        let mut grip = Grip::at(7.0);
        grip.0.start_at(bad);
        assert_eq!(grip.0.present(), 7.0);
    }
}

#[test]
fn faults_leave_the_command_and_the_boost() {
    let mut grip = Grip::at(8.0);
    let before = grip.0;
    for step in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(grip.command(4.0, SlipVerdict::Slipping, step), 8.0);
        assert_eq!(grip.0, before);
    }
    for bad in [f64::NAN, f64::INFINITY] {
        assert_eq!(grip.command(bad, SlipVerdict::Slipping, 1.0), 8.0);
        assert_eq!(grip.0, before);
    }
}

#[test]
fn each_setting_has_its_bounds() {
    let refused = |settings: GripSettings<f64>| GripController::new(settings).is_err();
    assert!(!refused(GripSettings { safety: 1.0, slip_boost: 1.0, least: 0.0, ..SETTINGS }));
    assert!(!refused(GripSettings { least: 20.0, ..SETTINGS }));
    for bad in [f64::NAN, f64::INFINITY, -1.0] {
        assert!(refused(GripSettings { safety: bad, ..SETTINGS }));
        assert!(refused(GripSettings { slip_boost: bad, ..SETTINGS }));
        assert!(refused(GripSettings { rise: bad, ..SETTINGS }));
        assert!(refused(GripSettings { fall: bad, ..SETTINGS }));
        assert!(refused(GripSettings { least: bad, ..SETTINGS }));
        assert!(refused(GripSettings { greatest: bad, ..SETTINGS }));
    }
    for bad in [0.0, 0.999] {
        assert!(refused(GripSettings { safety: bad, ..SETTINGS }));
        assert!(refused(GripSettings { slip_boost: bad, ..SETTINGS }));
    }
    assert!(
        refused(GripSettings { rise: 0.0, ..SETTINGS }) && refused(GripSettings { fall: 0.0, ..SETTINGS })
    );
    assert!(refused(GripSettings { least: 20.1, ..SETTINGS }));
}
