//! Every choice of the registry, exported.

pub mod filter_low_pass {
    // scene: a fingertip as a type, in f64.
    //
    // Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
    //
    //   input        convention = "on_fingertip", sample_rate_Hz = 1000.0
    //   filter       low_pass, noise above a frequency is taken off the wrench, by a Butterworth filter of second
    //                order; cutoff_Hz = 50.0; what changes slowly comes 4.5 ms late
    //   surface      sphere, a sphere, or a part of it around a pole; radius_m = 0.013
    //
    // It needs neither heap nor standard library, and in Cargo.toml:
    //
    //   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision"] }
    //
    // With a standard library, "std" in the place of "libm".
    //
    // Once, and then for each sample, `time_step` seconds after the one before:
    //
    //     let (mut tip, mut last) = (tip()?, None);
    //
    //     let step = fingertip::Step::of(time_step).with_last(last);
    //     let touch = tip.sense_wrench(filter.follow(load(force, torque)), step);
    //     last = touch.point();
    //
    // `let mut filter = Filter::default()` is the filter; after a pause, `filter.start_anew()`.

    use fingertip::nalgebra::{Vector3, Vector6};
    use fingertip::{Absent, Fingertip};
    use fingertip::{contact, surfaces, wrench};

    /// The pipeline.
    pub type Tip = Fingertip<
        Absent,
        surfaces::Sphere<f64>,
        contact::PointContact<f64>,
        Absent,
        Absent,
    >;

    /// Makes the pipeline.
    ///
    /// # Errors
    /// Never for the numbers below.
    #[allow(clippy::approx_constant)]
    pub fn tip() -> Result<Tip, BadTip> {
        let surface = surfaces::Sphere::new(Vector3::zeros(), 0.013)?;
        let model = contact::PointContact::new(0.0)?;
        Ok(Fingertip::builder()
            .contact(surface, model)
            .build())
    }

    /// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.
    pub fn load(force: Vector3<f64>, torque: Vector3<f64>) -> wrench::Wrench<f64> {
        wrench::Wrench::on_fingertip(force, torque)
    }

    /// A filter of second order on each component of the wrench: what changes slowly comes 0.004464496510753556 s late.
    #[derive(Clone, Copy, Debug, Default, PartialEq)]
    pub struct Filter {
        /// The first wrench, from which all are counted, and what is held of those before.
        state: Option<[Vector6<f64>; 3]>,
    }

    impl Filter {
        /// The next wrench, filtered. One that is not finite is given back as it is and forgotten.
        pub fn follow(&mut self, wrench: wrench::Wrench<f64>) -> wrench::Wrench<f64> {
            if !wrench.is_finite() {
                return wrench;
            }
            let components = wrench.components();
            let fresh = [components, Vector6::zeros(), Vector6::zeros()];
            let [first, one, two] = self.state.get_or_insert(fresh);
            let entering = components - *first;
            let leaving = *one + entering * 0.020083365564211256;
            *one = *two + entering * 0.04016673112842251 - leaving * -1.561018075800718;
            *two = entering * 0.020083365564211256 - leaving * 0.641351538057563;
            let filtered = wrench::Wrench::from_components(&(leaving + *first));
            if filtered.is_finite() {
                return filtered;
            }
            // Differences of huge wrenches overflow.
            self.state = None;
            wrench
        }

        /// As after a pause: the next wrench is the first.
        pub fn start_anew(&mut self) {
            self.state = None;
        }
    }

    /// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
    pub type BadTip = surfaces::BadShape;
}

pub mod filter_notch {
    // scene: a fingertip as a type, in f64.
    //
    // Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
    //
    //   input        convention = "on_fingertip", sample_rate_Hz = 1000.0
    //   filter       notch, a hum of one frequency is taken off the wrench; frequency_Hz = 50.0, width_Hz = 10.0;
    //                what changes slowly comes 0.6 ms late
    //   surface      sphere, a sphere, or a part of it around a pole; radius_m = 0.013
    //
    // It needs neither heap nor standard library, and in Cargo.toml:
    //
    //   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision"] }
    //
    // With a standard library, "std" in the place of "libm".
    //
    // Once, and then for each sample, `time_step` seconds after the one before:
    //
    //     let (mut tip, mut last) = (tip()?, None);
    //
    //     let step = fingertip::Step::of(time_step).with_last(last);
    //     let touch = tip.sense_wrench(filter.follow(load(force, torque)), step);
    //     last = touch.point();
    //
    // `let mut filter = Filter::default()` is the filter; after a pause, `filter.start_anew()`.

    use fingertip::nalgebra::{Vector3, Vector6};
    use fingertip::{Absent, Fingertip};
    use fingertip::{contact, surfaces, wrench};

    /// The pipeline.
    pub type Tip = Fingertip<
        Absent,
        surfaces::Sphere<f64>,
        contact::PointContact<f64>,
        Absent,
        Absent,
    >;

    /// Makes the pipeline.
    ///
    /// # Errors
    /// Never for the numbers below.
    #[allow(clippy::approx_constant)]
    pub fn tip() -> Result<Tip, BadTip> {
        let surface = surfaces::Sphere::new(Vector3::zeros(), 0.013)?;
        let model = contact::PointContact::new(0.0)?;
        Ok(Fingertip::builder()
            .contact(surface, model)
            .build())
    }

    /// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.
    pub fn load(force: Vector3<f64>, torque: Vector3<f64>) -> wrench::Wrench<f64> {
        wrench::Wrench::on_fingertip(force, torque)
    }

    /// A filter of second order on each component of the wrench: what changes slowly comes 0.0006313751514675032 s late.
    #[derive(Clone, Copy, Debug, Default, PartialEq)]
    pub struct Filter {
        /// The first wrench, from which all are counted, and what is held of those before.
        state: Option<[Vector6<f64>; 3]>,
    }

    impl Filter {
        /// The next wrench, filtered. One that is not finite is given back as it is and forgotten.
        pub fn follow(&mut self, wrench: wrench::Wrench<f64>) -> wrench::Wrench<f64> {
            if !wrench.is_finite() {
                return wrench;
            }
            let components = wrench.components();
            let fresh = [components, Vector6::zeros(), Vector6::zeros()];
            let [first, one, two] = self.state.get_or_insert(fresh);
            let entering = components - *first;
            let leaving = *one + entering * 0.9700245916226969;
            *one = *two + entering * -1.8450964176586222 - leaving * -1.8450964176586222;
            *two = entering * 0.9700245916226969 - leaving * 0.9400491832453938;
            let filtered = wrench::Wrench::from_components(&(leaving + *first));
            if filtered.is_finite() {
                return filtered;
            }
            // Differences of huge wrenches overflow.
            self.state = None;
            wrench
        }

        /// As after a pause: the next wrench is the first.
        pub fn start_anew(&mut self) {
            self.state = None;
        }
    }

    /// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
    pub type BadTip = surfaces::BadShape;
}

pub mod surface_plane {
    // scene: a fingertip as a type, in f64.
    //
    // Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
    //
    //   input        convention = "on_fingertip", sample_rate_Hz = 1000.0
    //   surface      plane, a plane; normal = [0.0, 0.0, 1.0], point_m = [0.0, 0.0, 0.01]
    //
    // It needs neither heap nor standard library, and in Cargo.toml:
    //
    //   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision"] }
    //
    // With a standard library, "std" in the place of "libm".
    //
    // Once, and then for each sample, `time_step` seconds after the one before:
    //
    //     let (mut tip, mut last) = (tip()?, None);
    //
    //     let step = fingertip::Step::of(time_step).with_last(last);
    //     let touch = tip.sense_wrench(load(force, torque), step);
    //     last = touch.point();

    use fingertip::nalgebra::Vector3;
    use fingertip::{Absent, Fingertip};
    use fingertip::{contact, surfaces, wrench};

    /// The pipeline.
    pub type Tip = Fingertip<
        Absent,
        surfaces::Plane<f64>,
        contact::PointContact<f64>,
        Absent,
        Absent,
    >;

    /// Makes the pipeline.
    ///
    /// # Errors
    /// Never for the numbers below.
    #[allow(clippy::approx_constant)]
    pub fn tip() -> Result<Tip, BadTip> {
        let surface = surfaces::Plane::new(Vector3::new(0.0, 0.0, 0.01), Vector3::z())?;
        let model = contact::PointContact::new(0.0)?;
        Ok(Fingertip::builder()
            .contact(surface, model)
            .build())
    }

    /// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.
    pub fn load(force: Vector3<f64>, torque: Vector3<f64>) -> wrench::Wrench<f64> {
        wrench::Wrench::on_fingertip(force, torque)
    }

    /// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
    pub type BadTip = surfaces::BadShape;
}

pub mod surface_disk {
    // scene: a fingertip as a type, in f64.
    //
    // Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
    //
    //   input        convention = "on_fingertip", sample_rate_Hz = 1000.0
    //   surface      disk, a round plate; radius_m = 0.01
    //
    // It needs neither heap nor standard library, and in Cargo.toml:
    //
    //   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision"] }
    //
    // With a standard library, "std" in the place of "libm".
    //
    // Once, and then for each sample, `time_step` seconds after the one before:
    //
    //     let (mut tip, mut last) = (tip()?, None);
    //
    //     let step = fingertip::Step::of(time_step).with_last(last);
    //     let touch = tip.sense_wrench(load(force, torque), step);
    //     last = touch.point();

    use fingertip::nalgebra::Vector3;
    use fingertip::{Absent, Fingertip};
    use fingertip::{contact, surfaces, wrench};

    /// The pipeline.
    pub type Tip = Fingertip<
        Absent,
        surfaces::Disk<f64>,
        contact::PointContact<f64>,
        Absent,
        Absent,
    >;

    /// Makes the pipeline.
    ///
    /// # Errors
    /// Never for the numbers below.
    #[allow(clippy::approx_constant)]
    pub fn tip() -> Result<Tip, BadTip> {
        let surface = surfaces::Disk::new(Vector3::zeros(), Vector3::z(), 0.01)?;
        let model = contact::PointContact::new(0.0)?;
        Ok(Fingertip::builder()
            .contact(surface, model)
            .build())
    }

    /// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.
    pub fn load(force: Vector3<f64>, torque: Vector3<f64>) -> wrench::Wrench<f64> {
        wrench::Wrench::on_fingertip(force, torque)
    }

    /// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
    pub type BadTip = surfaces::BadShape;
}

pub mod surface_rectangle {
    // scene: a fingertip as a type, in f64.
    //
    // Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
    //
    //   input        convention = "on_fingertip", sample_rate_Hz = 1000.0
    //   surface      rectangle, a rectangular plate; first_half_edge_m = [0.01, 0.0, 0.0], second_half_edge_m =
    //                [0.0, 0.02, 0.0]
    //
    // It needs neither heap nor standard library, and in Cargo.toml:
    //
    //   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision"] }
    //
    // With a standard library, "std" in the place of "libm".
    //
    // Once, and then for each sample, `time_step` seconds after the one before:
    //
    //     let (mut tip, mut last) = (tip()?, None);
    //
    //     let step = fingertip::Step::of(time_step).with_last(last);
    //     let touch = tip.sense_wrench(load(force, torque), step);
    //     last = touch.point();

    use fingertip::nalgebra::Vector3;
    use fingertip::{Absent, Fingertip};
    use fingertip::{contact, surfaces, wrench};

    /// The pipeline.
    pub type Tip = Fingertip<
        Absent,
        surfaces::Rectangle<f64>,
        contact::PointContact<f64>,
        Absent,
        Absent,
    >;

    /// Makes the pipeline.
    ///
    /// # Errors
    /// Never for the numbers below.
    #[allow(clippy::approx_constant)]
    pub fn tip() -> Result<Tip, BadTip> {
        let surface = surfaces::Rectangle::new(
            Vector3::zeros(),
            Vector3::new(0.01, 0.0, 0.0),
            Vector3::new(0.0, 0.02, 0.0),
        )?;
        let model = contact::PointContact::new(0.0)?;
        Ok(Fingertip::builder()
            .contact(surface, model)
            .build())
    }

    /// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.
    pub fn load(force: Vector3<f64>, torque: Vector3<f64>) -> wrench::Wrench<f64> {
        wrench::Wrench::on_fingertip(force, torque)
    }

    /// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
    pub type BadTip = surfaces::BadShape;
}

pub mod surface_sphere {
    // scene: a fingertip as a type, in f64.
    //
    // Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
    //
    //   input        convention = "on_fingertip", sample_rate_Hz = 1000.0
    //   surface      sphere, a sphere, or a part of it around a pole; radius_m = 0.013
    //
    // It needs neither heap nor standard library, and in Cargo.toml:
    //
    //   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision"] }
    //
    // With a standard library, "std" in the place of "libm".
    //
    // Once, and then for each sample, `time_step` seconds after the one before:
    //
    //     let (mut tip, mut last) = (tip()?, None);
    //
    //     let step = fingertip::Step::of(time_step).with_last(last);
    //     let touch = tip.sense_wrench(load(force, torque), step);
    //     last = touch.point();

    use fingertip::nalgebra::Vector3;
    use fingertip::{Absent, Fingertip};
    use fingertip::{contact, surfaces, wrench};

    /// The pipeline.
    pub type Tip = Fingertip<
        Absent,
        surfaces::Sphere<f64>,
        contact::PointContact<f64>,
        Absent,
        Absent,
    >;

    /// Makes the pipeline.
    ///
    /// # Errors
    /// Never for the numbers below.
    #[allow(clippy::approx_constant)]
    pub fn tip() -> Result<Tip, BadTip> {
        let surface = surfaces::Sphere::new(Vector3::zeros(), 0.013)?;
        let model = contact::PointContact::new(0.0)?;
        Ok(Fingertip::builder()
            .contact(surface, model)
            .build())
    }

    /// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.
    pub fn load(force: Vector3<f64>, torque: Vector3<f64>) -> wrench::Wrench<f64> {
        wrench::Wrench::on_fingertip(force, torque)
    }

    /// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
    pub type BadTip = surfaces::BadShape;
}

pub mod surface_ellipsoid {
    // scene: a fingertip as a type, in f64.
    //
    // Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
    //
    //   input        convention = "on_fingertip", sample_rate_Hz = 1000.0
    //   surface      ellipsoid, an ellipsoid; semi_axes_m = [0.008, 0.01, 0.013]
    //
    // It needs neither heap nor standard library, and in Cargo.toml:
    //
    //   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision"] }
    //
    // With a standard library, "std" in the place of "libm".
    //
    // Once, and then for each sample, `time_step` seconds after the one before:
    //
    //     let (mut tip, mut last) = (tip()?, None);
    //
    //     let step = fingertip::Step::of(time_step).with_last(last);
    //     let touch = tip.sense_wrench(load(force, torque), step);
    //     last = touch.point();

    use fingertip::nalgebra::Vector3;
    use fingertip::{Absent, Fingertip};
    use fingertip::{contact, surfaces, wrench};

    /// The pipeline.
    pub type Tip = Fingertip<
        Absent,
        surfaces::Ellipsoid<f64>,
        contact::PointContact<f64>,
        Absent,
        Absent,
    >;

    /// Makes the pipeline.
    ///
    /// # Errors
    /// Never for the numbers below.
    #[allow(clippy::approx_constant)]
    pub fn tip() -> Result<Tip, BadTip> {
        let surface = surfaces::Ellipsoid::new(Vector3::new(0.008, 0.01, 0.013))?;
        let model = contact::PointContact::new(0.0)?;
        Ok(Fingertip::builder()
            .contact(surface, model)
            .build())
    }

    /// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.
    pub fn load(force: Vector3<f64>, torque: Vector3<f64>) -> wrench::Wrench<f64> {
        wrench::Wrench::on_fingertip(force, torque)
    }

    /// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
    pub type BadTip = surfaces::BadShape;
}

pub mod surface_cylinder {
    // scene: a fingertip as a type, in f64.
    //
    // Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
    //
    //   input        convention = "on_fingertip", sample_rate_Hz = 1000.0
    //   surface      cylinder, the side of a round cylinder; axis = [1.0, 0.0, 0.0], radius_m = 0.01
    //
    // It needs neither heap nor standard library, and in Cargo.toml:
    //
    //   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision"] }
    //
    // With a standard library, "std" in the place of "libm".
    //
    // Once, and then for each sample, `time_step` seconds after the one before:
    //
    //     let (mut tip, mut last) = (tip()?, None);
    //
    //     let step = fingertip::Step::of(time_step).with_last(last);
    //     let touch = tip.sense_wrench(load(force, torque), step);
    //     last = touch.point();

    use fingertip::nalgebra::Vector3;
    use fingertip::{Absent, Fingertip};
    use fingertip::{contact, surfaces, wrench};

    /// The pipeline.
    pub type Tip = Fingertip<
        Absent,
        surfaces::Cylinder<f64>,
        contact::PointContact<f64>,
        Absent,
        Absent,
    >;

    /// Makes the pipeline.
    ///
    /// # Errors
    /// Never for the numbers below.
    #[allow(clippy::approx_constant)]
    pub fn tip() -> Result<Tip, BadTip> {
        let surface = surfaces::Cylinder::new(Vector3::zeros(), Vector3::x(), 0.01)?;
        let model = contact::PointContact::new(0.0)?;
        Ok(Fingertip::builder()
            .contact(surface, model)
            .build())
    }

    /// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.
    pub fn load(force: Vector3<f64>, torque: Vector3<f64>) -> wrench::Wrench<f64> {
        wrench::Wrench::on_fingertip(force, torque)
    }

    /// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
    pub type BadTip = surfaces::BadShape;
}

pub mod surface_capped_cylinder {
    // scene: a fingertip as a type, in f64.
    //
    // Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
    //
    //   input        convention = "on_fingertip", sample_rate_Hz = 1000.0
    //   surface      capped_cylinder, a round cylinder with flat ends; half_length_m = 0.02, radius_m = 0.01
    //
    // It needs neither heap nor standard library, and in Cargo.toml:
    //
    //   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision"] }
    //
    // With a standard library, "std" in the place of "libm".
    //
    // Once, and then for each sample, `time_step` seconds after the one before:
    //
    //     let (mut tip, mut last) = (tip()?, None);
    //
    //     let step = fingertip::Step::of(time_step).with_last(last);
    //     let touch = tip.sense_wrench(load(force, torque), step);
    //     last = touch.point();

    use fingertip::nalgebra::Vector3;
    use fingertip::{Absent, Fingertip};
    use fingertip::{contact, surfaces, wrench};

    /// The pipeline.
    pub type Tip = Fingertip<
        Absent,
        surfaces::CappedCylinder<f64>,
        contact::PointContact<f64>,
        Absent,
        Absent,
    >;

    /// Makes the pipeline.
    ///
    /// # Errors
    /// Never for the numbers below.
    #[allow(clippy::approx_constant)]
    pub fn tip() -> Result<Tip, BadTip> {
        let surface = surfaces::CappedCylinder::new(Vector3::zeros(), Vector3::z(), 0.01, 0.02)?;
        let model = contact::PointContact::new(0.0)?;
        Ok(Fingertip::builder()
            .contact(surface, model)
            .build())
    }

    /// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.
    pub fn load(force: Vector3<f64>, torque: Vector3<f64>) -> wrench::Wrench<f64> {
        wrench::Wrench::on_fingertip(force, torque)
    }

    /// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
    pub type BadTip = surfaces::BadShape;
}

pub mod surface_elliptic_cylinder {
    // scene: a fingertip as a type, in f64.
    //
    // Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
    //
    //   input        convention = "on_fingertip", sample_rate_Hz = 1000.0
    //   surface      elliptic_cylinder, an elliptic cylinder, without ends, open or capped; ends_m = { capped =
    //                0.01 }, semi_axes_m = [0.008, 0.012]
    //
    // It needs neither heap nor standard library, and in Cargo.toml:
    //
    //   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision"] }
    //
    // With a standard library, "std" in the place of "libm".
    //
    // Once, and then for each sample, `time_step` seconds after the one before:
    //
    //     let (mut tip, mut last) = (tip()?, None);
    //
    //     let step = fingertip::Step::of(time_step).with_last(last);
    //     let touch = tip.sense_wrench(load(force, torque), step);
    //     last = touch.point();

    use fingertip::nalgebra::Vector3;
    use fingertip::{Absent, Fingertip};
    use fingertip::{contact, surfaces, wrench};

    /// The pipeline.
    pub type Tip = Fingertip<
        Absent,
        surfaces::EllipticCylinder<f64>,
        contact::PointContact<f64>,
        Absent,
        Absent,
    >;

    /// Makes the pipeline.
    ///
    /// # Errors
    /// Never for the numbers below.
    #[allow(clippy::approx_constant)]
    pub fn tip() -> Result<Tip, BadTip> {
        let surface = surfaces::EllipticCylinder::new([0.008, 0.012], surfaces::CylinderEnds::Capped(0.01))?;
        let model = contact::PointContact::new(0.0)?;
        Ok(Fingertip::builder()
            .contact(surface, model)
            .build())
    }

    /// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.
    pub fn load(force: Vector3<f64>, torque: Vector3<f64>) -> wrench::Wrench<f64> {
        wrench::Wrench::on_fingertip(force, torque)
    }

    /// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
    pub type BadTip = surfaces::BadShape;
}

pub mod surface_capsule {
    // scene: a fingertip as a type, in f64.
    //
    // Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
    //
    //   input        convention = "on_fingertip", sample_rate_Hz = 1000.0
    //   surface      capsule, a cylinder with round ends; half_length_m = 0.01, radius_m = 0.008
    //
    // It needs neither heap nor standard library, and in Cargo.toml:
    //
    //   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision"] }
    //
    // With a standard library, "std" in the place of "libm".
    //
    // Once, and then for each sample, `time_step` seconds after the one before:
    //
    //     let (mut tip, mut last) = (tip()?, None);
    //
    //     let step = fingertip::Step::of(time_step).with_last(last);
    //     let touch = tip.sense_wrench(load(force, torque), step);
    //     last = touch.point();

    use fingertip::nalgebra::Vector3;
    use fingertip::{Absent, Fingertip};
    use fingertip::{contact, surfaces, wrench};

    /// The pipeline.
    pub type Tip = Fingertip<
        Absent,
        surfaces::Capsule<f64>,
        contact::PointContact<f64>,
        Absent,
        Absent,
    >;

    /// Makes the pipeline.
    ///
    /// # Errors
    /// Never for the numbers below.
    #[allow(clippy::approx_constant)]
    pub fn tip() -> Result<Tip, BadTip> {
        let surface = surfaces::Capsule::new(Vector3::zeros(), Vector3::z(), 0.008, 0.01)?;
        let model = contact::PointContact::new(0.0)?;
        Ok(Fingertip::builder()
            .contact(surface, model)
            .build())
    }

    /// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.
    pub fn load(force: Vector3<f64>, torque: Vector3<f64>) -> wrench::Wrench<f64> {
        wrench::Wrench::on_fingertip(force, torque)
    }

    /// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
    pub type BadTip = surfaces::BadShape;
}

pub mod surface_cone {
    // scene: a fingertip as a type, in f64.
    //
    // Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
    //
    //   input        convention = "on_fingertip", sample_rate_Hz = 1000.0
    //   surface      cone, a cone with its tip; axis = [0.0, 0.0, -1.0], depth_m = 0.02, half_angle_deg = 30.0
    //
    // It needs neither heap nor standard library, and in Cargo.toml:
    //
    //   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision"] }
    //
    // With a standard library, "std" in the place of "libm".
    //
    // Once, and then for each sample, `time_step` seconds after the one before:
    //
    //     let (mut tip, mut last) = (tip()?, None);
    //
    //     let step = fingertip::Step::of(time_step).with_last(last);
    //     let touch = tip.sense_wrench(load(force, torque), step);
    //     last = touch.point();

    use fingertip::nalgebra::Vector3;
    use fingertip::{Absent, Fingertip};
    use fingertip::{contact, surfaces, wrench};

    /// The pipeline.
    pub type Tip = Fingertip<
        Absent,
        surfaces::Cone<f64>,
        contact::PointContact<f64>,
        Absent,
        Absent,
    >;

    /// Makes the pipeline.
    ///
    /// # Errors
    /// Never for the numbers below.
    #[allow(clippy::approx_constant)]
    pub fn tip() -> Result<Tip, BadTip> {
        let surface = surfaces::Cone::new(
            Vector3::zeros(),
            Vector3::new(0.0, 0.0, -1.0),
            0.5235987755982988,
        )?.with_depth(0.02)?;
        let model = contact::PointContact::new(0.0)?;
        Ok(Fingertip::builder()
            .contact(surface, model)
            .build())
    }

    /// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.
    pub fn load(force: Vector3<f64>, torque: Vector3<f64>) -> wrench::Wrench<f64> {
        wrench::Wrench::on_fingertip(force, torque)
    }

    /// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
    pub type BadTip = surfaces::BadShape;
}

pub mod surface_frustum {
    // scene: a fingertip as a type, in f64.
    //
    // Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
    //
    //   input        convention = "on_fingertip", sample_rate_Hz = 1000.0
    //   surface      frustum, a cone that is cut off; base_radius_m = 0.012, height_m = 0.02, top_radius_m =
    //                0.006
    //
    // It needs neither heap nor standard library, and in Cargo.toml:
    //
    //   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision"] }
    //
    // With a standard library, "std" in the place of "libm".
    //
    // Once, and then for each sample, `time_step` seconds after the one before:
    //
    //     let (mut tip, mut last) = (tip()?, None);
    //
    //     let step = fingertip::Step::of(time_step).with_last(last);
    //     let touch = tip.sense_wrench(load(force, torque), step);
    //     last = touch.point();

    use fingertip::nalgebra::Vector3;
    use fingertip::{Absent, Fingertip};
    use fingertip::{contact, surfaces, wrench};

    /// The pipeline.
    pub type Tip = Fingertip<
        Absent,
        surfaces::Frustum<f64>,
        contact::PointContact<f64>,
        Absent,
        Absent,
    >;

    /// Makes the pipeline.
    ///
    /// # Errors
    /// Never for the numbers below.
    #[allow(clippy::approx_constant)]
    pub fn tip() -> Result<Tip, BadTip> {
        let surface = surfaces::Frustum::new(Vector3::zeros(), Vector3::z(), 0.012, 0.006, 0.02)?;
        let model = contact::PointContact::new(0.0)?;
        Ok(Fingertip::builder()
            .contact(surface, model)
            .build())
    }

    /// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.
    pub fn load(force: Vector3<f64>, torque: Vector3<f64>) -> wrench::Wrench<f64> {
        wrench::Wrench::on_fingertip(force, torque)
    }

    /// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
    pub type BadTip = surfaces::BadShape;
}

pub mod surface_torus {
    // scene: a fingertip as a type, in f64.
    //
    // Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
    //
    //   input        convention = "on_fingertip", sample_rate_Hz = 1000.0
    //   surface      torus, a ring; ring_radius_m = 0.007, tube_radius_m = 0.004
    //
    // It needs neither heap nor standard library, and in Cargo.toml:
    //
    //   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision"] }
    //
    // With a standard library, "std" in the place of "libm".
    //
    // Once, and then for each sample, `time_step` seconds after the one before:
    //
    //     let (mut tip, mut last) = (tip()?, None);
    //
    //     let step = fingertip::Step::of(time_step).with_last(last);
    //     let touch = tip.sense_wrench(load(force, torque), step);
    //     last = touch.point();

    use fingertip::nalgebra::Vector3;
    use fingertip::{Absent, Fingertip};
    use fingertip::{contact, surfaces, wrench};

    /// The pipeline.
    pub type Tip = Fingertip<
        Absent,
        surfaces::Torus<f64>,
        contact::PointContact<f64>,
        Absent,
        Absent,
    >;

    /// Makes the pipeline.
    ///
    /// # Errors
    /// Never for the numbers below.
    #[allow(clippy::approx_constant)]
    pub fn tip() -> Result<Tip, BadTip> {
        let surface = surfaces::Torus::new(0.007, 0.004)?;
        let model = contact::PointContact::new(0.0)?;
        Ok(Fingertip::builder()
            .contact(surface, model)
            .build())
    }

    /// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.
    pub fn load(force: Vector3<f64>, torque: Vector3<f64>) -> wrench::Wrench<f64> {
        wrench::Wrench::on_fingertip(force, torque)
    }

    /// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
    pub type BadTip = surfaces::BadShape;
}

pub mod surface_superquadric {
    // scene: a fingertip as a type, in f64.
    //
    // Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
    //
    //   input        convention = "on_fingertip", sample_rate_Hz = 1000.0
    //   surface      superquadric, between a box, an ellipsoid and an octahedron; exponents = [0.7, 0.8],
    //                semi_axes_m = [0.008, 0.01, 0.013]
    //
    // It needs neither heap nor standard library, and in Cargo.toml:
    //
    //   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision"] }
    //
    // With a standard library, "std" in the place of "libm".
    //
    // Once, and then for each sample, `time_step` seconds after the one before:
    //
    //     let (mut tip, mut last) = (tip()?, None);
    //
    //     let step = fingertip::Step::of(time_step).with_last(last);
    //     let touch = tip.sense_wrench(load(force, torque), step);
    //     last = touch.point();

    use fingertip::nalgebra::Vector3;
    use fingertip::{Absent, Fingertip};
    use fingertip::{contact, surfaces, wrench};

    /// The pipeline.
    pub type Tip = Fingertip<
        Absent,
        surfaces::Superquadric<f64>,
        contact::PointContact<f64>,
        Absent,
        Absent,
    >;

    /// Makes the pipeline.
    ///
    /// # Errors
    /// Never for the numbers below.
    #[allow(clippy::approx_constant)]
    pub fn tip() -> Result<Tip, BadTip> {
        let surface = surfaces::Superquadric::new(Vector3::new(0.008, 0.01, 0.013), [0.7, 0.8])?;
        let model = contact::PointContact::new(0.0)?;
        Ok(Fingertip::builder()
            .contact(surface, model)
            .build())
    }

    /// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.
    pub fn load(force: Vector3<f64>, torque: Vector3<f64>) -> wrench::Wrench<f64> {
        wrench::Wrench::on_fingertip(force, torque)
    }

    /// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
    pub type BadTip = surfaces::BadShape;
}

pub mod surface_rounded_box {
    // scene: a fingertip as a type, in f64.
    //
    // Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
    //
    //   input        convention = "on_fingertip", sample_rate_Hz = 1000.0
    //   surface      rounded_box, a box with round edges; half_extents_m = [0.008, 0.01, 0.013], rounding_m =
    //                0.003
    //
    // It needs neither heap nor standard library, and in Cargo.toml:
    //
    //   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision"] }
    //
    // With a standard library, "std" in the place of "libm".
    //
    // Once, and then for each sample, `time_step` seconds after the one before:
    //
    //     let (mut tip, mut last) = (tip()?, None);
    //
    //     let step = fingertip::Step::of(time_step).with_last(last);
    //     let touch = tip.sense_wrench(load(force, torque), step);
    //     last = touch.point();

    use fingertip::nalgebra::Vector3;
    use fingertip::{Absent, Fingertip};
    use fingertip::{contact, surfaces, wrench};

    /// The pipeline.
    pub type Tip = Fingertip<
        Absent,
        surfaces::RoundedBox<f64>,
        contact::PointContact<f64>,
        Absent,
        Absent,
    >;

    /// Makes the pipeline.
    ///
    /// # Errors
    /// Never for the numbers below.
    #[allow(clippy::approx_constant)]
    pub fn tip() -> Result<Tip, BadTip> {
        let surface = surfaces::RoundedBox::new(Vector3::new(0.008, 0.01, 0.013), 0.003)?;
        let model = contact::PointContact::new(0.0)?;
        Ok(Fingertip::builder()
            .contact(surface, model)
            .build())
    }

    /// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.
    pub fn load(force: Vector3<f64>, torque: Vector3<f64>) -> wrench::Wrench<f64> {
        wrench::Wrench::on_fingertip(force, torque)
    }

    /// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
    pub type BadTip = surfaces::BadShape;
}

pub mod surface_paraboloid {
    // scene: a fingertip as a type, in f64.
    //
    // Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
    //
    //   input        convention = "on_fingertip", sample_rate_Hz = 1000.0
    //   surface      paraboloid, a bowl with two radii of curvature at its apex; depth_m = 0.01, radii_m = [0.01,
    //                0.015]
    //
    // It needs neither heap nor standard library, and in Cargo.toml:
    //
    //   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision"] }
    //
    // With a standard library, "std" in the place of "libm".
    //
    // Once, and then for each sample, `time_step` seconds after the one before:
    //
    //     let (mut tip, mut last) = (tip()?, None);
    //
    //     let step = fingertip::Step::of(time_step).with_last(last);
    //     let touch = tip.sense_wrench(load(force, torque), step);
    //     last = touch.point();

    use fingertip::nalgebra::Vector3;
    use fingertip::{Absent, Fingertip};
    use fingertip::{contact, surfaces, wrench};

    /// The pipeline.
    pub type Tip = Fingertip<
        Absent,
        surfaces::Paraboloid<f64>,
        contact::PointContact<f64>,
        Absent,
        Absent,
    >;

    /// Makes the pipeline.
    ///
    /// # Errors
    /// Never for the numbers below.
    #[allow(clippy::approx_constant)]
    pub fn tip() -> Result<Tip, BadTip> {
        let surface = surfaces::Paraboloid::new([0.01, 0.015])?.with_depth(0.01)?;
        let model = contact::PointContact::new(0.0)?;
        Ok(Fingertip::builder()
            .contact(surface, model)
            .build())
    }

    /// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.
    pub fn load(force: Vector3<f64>, torque: Vector3<f64>) -> wrench::Wrench<f64> {
        wrench::Wrench::on_fingertip(force, torque)
    }

    /// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
    pub type BadTip = surfaces::BadShape;
}

pub mod surface_revolution {
    // scene: a fingertip as a type, in f64.
    //
    // Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
    //
    //   input        convention = "on_fingertip", sample_rate_Hz = 1000.0
    //   surface      revolution, a profile turned about an axis; profile_m = [[-0.01, 0.0], [-0.006, 0.006],
    //                [0.0, 0.008], [0.006, 0.006] …
    //
    // It needs neither heap nor standard library, and in Cargo.toml:
    //
    //   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision"] }
    //
    // With a standard library, "std" in the place of "libm".
    //
    // Once, and then for each sample, `time_step` seconds after the one before:
    //
    //     let (mut tip, mut last) = (tip()?, None);
    //
    //     let step = fingertip::Step::of(time_step).with_last(last);
    //     let touch = tip.sense_wrench(load(force, torque), step);
    //     last = touch.point();

    use fingertip::nalgebra::Vector3;
    use fingertip::{Absent, Fingertip};
    use fingertip::{contact, surfaces, wrench};

    /// The pipeline.
    pub type Tip = Fingertip<
        Absent,
        surfaces::Revolution<f64, [surfaces::Knot<f64>; 5]>,
        contact::PointContact<f64>,
        Absent,
        Absent,
    >;

    /// Makes the pipeline.
    ///
    /// # Errors
    /// Never for the numbers below.
    #[allow(clippy::approx_constant)]
    pub fn tip() -> Result<Tip, BadTip> {
        let surface = surfaces::Revolution::from_profile(
            [[-0.01, 0.0], [-0.006, 0.006], [0.0, 0.008], [0.006, 0.006], [0.01, 0.0]],
        )?;
        let model = contact::PointContact::new(0.0)?;
        Ok(Fingertip::builder()
            .contact(surface, model)
            .build())
    }

    /// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.
    pub fn load(force: Vector3<f64>, torque: Vector3<f64>) -> wrench::Wrench<f64> {
        wrench::Wrench::on_fingertip(force, torque)
    }

    /// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
    pub type BadTip = surfaces::BadShape;
}

pub mod surface_heightfield {
    // scene: a fingertip as a type, in f64.
    //
    // Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
    //
    //   input        convention = "on_fingertip", sample_rate_Hz = 1000.0
    //   surface      heightfield, heights over a grid; columns = 2, corner_m = [-0.01, -0.01], heights_m = [0.01,
    //                0.01, 0.01, 0.011], spacing_m = [0.02, 0.02]
    //
    // It needs a heap, but no standard library, and in Cargo.toml:
    //
    //   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision", "alloc"] }
    //
    // With a standard library, "std" in the place of "libm".
    //
    // Once, and then for each sample, `time_step` seconds after the one before:
    //
    //     let (mut tip, mut last) = (tip()?, None);
    //
    //     let step = fingertip::Step::of(time_step).with_last(last);
    //     let touch = tip.sense_wrench(load(force, torque), step);
    //     last = touch.point();

    extern crate alloc;

    use fingertip::nalgebra::Vector3;
    use fingertip::{Absent, Fingertip};
    use fingertip::{contact, surfaces, wrench};

    static HEIGHTS_M_0: [f64; 4] = [
        0.01,
        0.01,
        0.01,
        0.011,
    ];

    /// The pipeline.
    pub type Tip = Fingertip<
        Absent,
        surfaces::Heightfield<f64>,
        contact::PointContact<f64>,
        Absent,
        Absent,
    >;

    /// Makes the pipeline.
    ///
    /// # Errors
    /// Never for the numbers below.
    #[allow(clippy::approx_constant)]
    pub fn tip() -> Result<Tip, BadTip> {
        let surface = surfaces::Heightfield::new([-0.01, -0.01], [0.02, 0.02], 2, HEIGHTS_M_0.to_vec())?;
        let model = contact::PointContact::new(0.0)?;
        Ok(Fingertip::builder()
            .contact(surface, model)
            .build())
    }

    /// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.
    pub fn load(force: Vector3<f64>, torque: Vector3<f64>) -> wrench::Wrench<f64> {
        wrench::Wrench::on_fingertip(force, torque)
    }

    /// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
    pub type BadTip = surfaces::BadShape;
}

pub mod surface_mesh {
    // scene: a fingertip as a type, in f64.
    //
    // Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
    //
    //   input        convention = "on_fingertip", sample_rate_Hz = 1000.0
    //   surface      mesh, a closed triangle mesh; or `file` (.stl, .obj) and `metres_per_unit`; triangles = [[0,
    //                2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]], vertices_m = [[0.01, 0.0, 0.0], [-0.01, 0.01, 0.0],
    //                [-0.01, -0.01, 0.0],  …
    //
    // It needs a heap, but no standard library, and in Cargo.toml:
    //
    //   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision", "alloc"] }
    //
    // With a standard library, "std" in the place of "libm".
    //
    // Once, and then for each sample, `time_step` seconds after the one before:
    //
    //     let (mut tip, mut last) = (tip()?, None);
    //
    //     let step = fingertip::Step::of(time_step).with_last(last);
    //     let touch = tip.sense_wrench(load(force, torque), step);
    //     last = touch.point();

    use fingertip::nalgebra::Vector3;
    use fingertip::{Absent, Fingertip};
    use fingertip::{contact, surfaces, wrench};

    static VERTICES_M_0: [Vector3<f64>; 4] = [
        Vector3::new(0.01, 0.0, 0.0),
        Vector3::new(-0.01, 0.01, 0.0),
        Vector3::new(-0.01, -0.01, 0.0),
        Vector3::new(0.0, 0.0, 0.01),
    ];

    static TRIANGLES_1: [[u32; 3]; 4] = [
        [0, 2, 1],
        [0, 1, 3],
        [1, 2, 3],
        [2, 0, 3],
    ];

    /// The pipeline.
    pub type Tip = Fingertip<
        Absent,
        surfaces::Mesh<f64>,
        contact::PointContact<f64>,
        Absent,
        Absent,
    >;

    /// Makes the pipeline.
    ///
    /// # Errors
    /// Never for the numbers below.
    #[allow(clippy::approx_constant)]
    pub fn tip() -> Result<Tip, BadTip> {
        let surface = surfaces::Mesh::new(&VERTICES_M_0, &TRIANGLES_1)?;
        let model = contact::PointContact::new(0.0)?;
        Ok(Fingertip::builder()
            .contact(surface, model)
            .build())
    }

    /// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.
    pub fn load(force: Vector3<f64>, torque: Vector3<f64>) -> wrench::Wrench<f64> {
        wrench::Wrench::on_fingertip(force, torque)
    }

    /// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
    #[derive(Clone, Debug, PartialEq)]
    pub enum BadTip {
        /// A shape, a contact model or an uncertainty.
        Shape(surfaces::BadShape),
        /// A mesh.
        Mesh(surfaces::MeshError),
    }

    impl core::fmt::Display for BadTip {
        fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
            match self {
                Self::Shape(bad) => bad.fmt(f),
                Self::Mesh(bad) => bad.fmt(f),
            }
        }
    }

    impl core::error::Error for BadTip {}

    impl From<surfaces::BadShape> for BadTip {
        fn from(bad: surfaces::BadShape) -> Self {
            Self::Shape(bad)
        }
    }

    impl From<surfaces::MeshError> for BadTip {
        fn from(bad: surfaces::MeshError) -> Self {
            Self::Mesh(bad)
        }
    }
}

pub mod surface_formula {
    // scene: a fingertip as a type, in f64.
    //
    // Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
    //
    //   input        convention = "on_fingertip", sample_rate_Hz = 1000.0
    //   surface      formula, a shape of your own: where a formula of x, y and z is zero, within a ball; convex =
    //                true, outside = "(x/a)^4 + (y/a)^4 + (z/b)^2 - 1", parameters = { a = 0.01, b = 0.013 },
    //                reach_m = 0.018
    //
    // It needs neither heap nor standard library, and in Cargo.toml:
    //
    //   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision"] }
    //
    // With a standard library, "std" in the place of "libm".
    //
    // Once, and then for each sample, `time_step` seconds after the one before:
    //
    //     let (mut tip, mut last) = (tip()?, None);
    //
    //     let step = fingertip::Step::of(time_step).with_last(last);
    //     let touch = tip.sense_wrench(load(force, torque), step);
    //     last = touch.point();

    use fingertip::nalgebra::{ComplexField, Vector3};
    use fingertip::{Absent, Fingertip};
    use fingertip::{contact, surfaces, wrench};

    /// The shape: zero on the surface, negative inside.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Shape;

    #[allow(clippy::approx_constant)]
    impl surfaces::ImplicitSurface<f64> for Shape {
        fn formula(&self, [x, y, z]: [surfaces::Term<f64>; 3]) -> surfaces::Term<f64> {
            let number = surfaces::Term::constant;
            ((x / number(0.01)).powi(4) + (y / number(0.01)).powi(4)) + ((z / number(0.013)).powi(2) - number(1.0))
        }

        fn ball(&self) -> (Vector3<f64>, f64) {
            (Vector3::zeros(), 0.018)
        }

        fn value(&self, point: &Vector3<f64>) -> f64 {
            let [x, y, z]: [f64; 3] = (*point).into();
            (ComplexField::powi(x / 0.01, 4) + ComplexField::powi(y / 0.01, 4)) + (ComplexField::powi(z / 0.013, 2) - 1.0)
        }

        fn topology(&self) -> surfaces::Topology {
            surfaces::Topology::Convex
        }
    }

    /// The pipeline.
    pub type Tip = Fingertip<
        Absent,
        surfaces::Implicit<f64, Shape>,
        contact::PointContact<f64>,
        Absent,
        Absent,
    >;

    /// Makes the pipeline.
    ///
    /// # Errors
    /// Never for the numbers below.
    #[allow(clippy::approx_constant)]
    pub fn tip() -> Result<Tip, BadTip> {
        let surface = surfaces::Implicit::new(Shape)?;
        let model = contact::PointContact::new(0.0)?;
        Ok(Fingertip::builder()
            .contact(surface, model)
            .build())
    }

    /// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.
    pub fn load(force: Vector3<f64>, torque: Vector3<f64>) -> wrench::Wrench<f64> {
        wrench::Wrench::on_fingertip(force, torque)
    }

    /// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
    pub type BadTip = surfaces::BadShape;
}

pub mod surface_posed {
    // scene: a fingertip as a type, in f64.
    //
    // Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
    //
    //   input        convention = "on_fingertip", sample_rate_Hz = 1000.0
    //   surface      posed, another shape, turned and moved; rotation_deg = [0.0, 90.0, 0.0], surface = {
    //                half_length_m = 0.01, radius_m = 0.008, shape = "capsule"  …, translation_m = [0.0, 0.0,
    //                0.01]
    //
    // It needs neither heap nor standard library, and in Cargo.toml:
    //
    //   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision"] }
    //
    // With a standard library, "std" in the place of "libm".
    //
    // Once, and then for each sample, `time_step` seconds after the one before:
    //
    //     let (mut tip, mut last) = (tip()?, None);
    //
    //     let step = fingertip::Step::of(time_step).with_last(last);
    //     let touch = tip.sense_wrench(load(force, torque), step);
    //     last = touch.point();

    use fingertip::nalgebra::{Matrix3, Vector3};
    use fingertip::{Absent, Fingertip};
    use fingertip::{contact, surfaces, wrench};

    /// The pipeline.
    pub type Tip = Fingertip<
        Absent,
        surfaces::Posed<f64, surfaces::Capsule<f64>>,
        contact::PointContact<f64>,
        Absent,
        Absent,
    >;

    /// Makes the pipeline.
    ///
    /// # Errors
    /// Never for the numbers below.
    #[allow(clippy::approx_constant)]
    pub fn tip() -> Result<Tip, BadTip> {
        let surface = surfaces::Posed::new(
            surfaces::Capsule::new(Vector3::zeros(), Vector3::z(), 0.008, 0.01)?,
            wrench::RigidTransform::from_matrix(
                Matrix3::new(6.123233995736766e-17, 0.0, 1.0, 0.0, 1.0, 0.0, -1.0, 0.0, 6.123233995736766e-17),
                Vector3::new(0.0, 0.0, 0.01),
            )?,
        );
        let model = contact::PointContact::new(0.0)?;
        Ok(Fingertip::builder()
            .contact(surface, model)
            .build())
    }

    /// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.
    pub fn load(force: Vector3<f64>, torque: Vector3<f64>) -> wrench::Wrench<f64> {
        wrench::Wrench::on_fingertip(force, torque)
    }

    /// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
    #[derive(Clone, Debug, PartialEq)]
    pub enum BadTip {
        /// A shape, a contact model or an uncertainty.
        Shape(surfaces::BadShape),
        /// A pose.
        Pose(wrench::TransformError),
    }

    impl core::fmt::Display for BadTip {
        fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
            match self {
                Self::Shape(bad) => bad.fmt(f),
                Self::Pose(bad) => bad.fmt(f),
            }
        }
    }

    impl core::error::Error for BadTip {}

    impl From<surfaces::BadShape> for BadTip {
        fn from(bad: surfaces::BadShape) -> Self {
            Self::Shape(bad)
        }
    }

    impl From<wrench::TransformError> for BadTip {
        fn from(bad: wrench::TransformError) -> Self {
            Self::Pose(bad)
        }
    }
}

pub mod surface_trimmed {
    // scene: a fingertip as a type, in f64.
    //
    // Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
    //
    //   input        convention = "on_fingertip", sample_rate_Hz = 1000.0
    //   surface      trimmed, the part of another shape on one side of a plane; region = { inward = [0.0, 0.0,
    //                1.0], point_m = [0.0, 0.0, 0.0] }, surface = { radius_m = 0.013, shape = "sphere" }
    //
    // It needs neither heap nor standard library, and in Cargo.toml:
    //
    //   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision"] }
    //
    // With a standard library, "std" in the place of "libm".
    //
    // Once, and then for each sample, `time_step` seconds after the one before:
    //
    //     let (mut tip, mut last) = (tip()?, None);
    //
    //     let step = fingertip::Step::of(time_step).with_last(last);
    //     let touch = tip.sense_wrench(load(force, torque), step);
    //     last = touch.point();

    use fingertip::nalgebra::Vector3;
    use fingertip::{Absent, Fingertip};
    use fingertip::{contact, surfaces, wrench};

    /// The pipeline.
    pub type Tip = Fingertip<
        Absent,
        surfaces::Trimmed<surfaces::Sphere<f64>, surfaces::HalfSpace<f64>>,
        contact::PointContact<f64>,
        Absent,
        Absent,
    >;

    /// Makes the pipeline.
    ///
    /// # Errors
    /// Never for the numbers below.
    #[allow(clippy::approx_constant)]
    pub fn tip() -> Result<Tip, BadTip> {
        let surface = surfaces::Trimmed::new(
            surfaces::Sphere::new(Vector3::zeros(), 0.013)?,
            surfaces::HalfSpace::new(Vector3::zeros(), Vector3::z())?,
        );
        let model = contact::PointContact::new(0.0)?;
        Ok(Fingertip::builder()
            .contact(surface, model)
            .build())
    }

    /// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.
    pub fn load(force: Vector3<f64>, torque: Vector3<f64>) -> wrench::Wrench<f64> {
        wrench::Wrench::on_fingertip(force, torque)
    }

    /// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
    pub type BadTip = surfaces::BadShape;
}

pub mod surface_compound {
    // scene: a fingertip as a type, in f64.
    //
    // Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
    //
    //   input        convention = "on_fingertip", sample_rate_Hz = 1000.0
    //   surface      compound, the union of several shapes; parts = [{ radius_m = 0.01, shape = "sphere" }, {
    //                half_length_m = 0. …
    //
    // It needs neither heap nor standard library, and in Cargo.toml:
    //
    //   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision"] }
    //
    // With a standard library, "std" in the place of "libm".
    //
    // Once, and then for each sample, `time_step` seconds after the one before:
    //
    //     let (mut tip, mut last) = (tip()?, None);
    //
    //     let step = fingertip::Step::of(time_step).with_last(last);
    //     let touch = tip.sense_wrench(load(force, torque), step);
    //     last = touch.point();

    use fingertip::nalgebra::Vector3;
    use fingertip::{Absent, Fingertip};
    use fingertip::{contact, surfaces, wrench};

    /// The pipeline.
    pub type Tip = Fingertip<
        Absent,
        surfaces::Compound<surfaces::Sphere<f64>, surfaces::Capsule<f64>>,
        contact::PointContact<f64>,
        Absent,
        Absent,
    >;

    /// Makes the pipeline.
    ///
    /// # Errors
    /// Never for the numbers below.
    #[allow(clippy::approx_constant)]
    pub fn tip() -> Result<Tip, BadTip> {
        let surface = surfaces::Compound::new(
            surfaces::Sphere::new(Vector3::zeros(), 0.01)?,
            surfaces::Capsule::new(Vector3::zeros(), Vector3::z(), 0.006, 0.012)?,
        );
        let model = contact::PointContact::new(0.0)?;
        Ok(Fingertip::builder()
            .contact(surface, model)
            .build())
    }

    /// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.
    pub fn load(force: Vector3<f64>, torque: Vector3<f64>) -> wrench::Wrench<f64> {
        wrench::Wrench::on_fingertip(force, torque)
    }

    /// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
    pub type BadTip = surfaces::BadShape;
}

pub mod contact_point {
    // scene: a fingertip as a type, in f64.
    //
    // Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
    //
    //   input        convention = "on_fingertip", sample_rate_Hz = 1000.0
    //   surface      sphere, a sphere, or a part of it around a pole; radius_m = 0.013
    //   contact      point, a contact transmits a force and no torque of its own; least_force_N = 0.1
    //   uncertainty  force_noise_N = 0.01, torque_noise_Nm = 0.0001
    //
    // It needs neither heap nor standard library, and in Cargo.toml:
    //
    //   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision"] }
    //
    // With a standard library, "std" in the place of "libm".
    //
    // Once, and then for each sample, `time_step` seconds after the one before:
    //
    //     let (mut tip, mut last) = (tip()?, None);
    //
    //     let step = fingertip::Step::of(time_step).with_last(last);
    //     let touch = tip.sense_wrench(load(force, torque), step);
    //     last = touch.point();
    //
    // With `let noise = wrench_noise()?`, the covariance of the contact is
    //     covariance(&tip, &touch, &noise)
    // whose `ellipse(0.95)` is that of the scene.

    use fingertip::nalgebra::{Vector3, Vector6};
    use fingertip::{Absent, Fingertip};
    use fingertip::{contact, surfaces, wrench};

    /// The pipeline.
    pub type Tip = Fingertip<
        Absent,
        surfaces::Sphere<f64>,
        contact::PointContact<f64>,
        Absent,
        Absent,
    >;

    /// Makes the pipeline.
    ///
    /// # Errors
    /// Never for the numbers below.
    #[allow(clippy::approx_constant)]
    pub fn tip() -> Result<Tip, BadTip> {
        let surface = surfaces::Sphere::new(Vector3::zeros(), 0.013)?;
        let model = contact::PointContact::new(0.1)?;
        Ok(Fingertip::builder()
            .contact(surface, model)
            .build())
    }

    /// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.
    pub fn load(force: Vector3<f64>, torque: Vector3<f64>) -> wrench::Wrench<f64> {
        wrench::Wrench::on_fingertip(force, torque)
    }

    /// How sure a wrench is: standard deviations at rest, and relative ones under load.
    ///
    /// # Errors
    /// Never for the numbers below.
    pub fn wrench_noise() -> Result<contact::WrenchNoise<f64>, BadTip> {
        let noise = contact::WrenchNoise::new(Vector6::from([0.01, 0.01, 0.01, 0.0001, 0.0001, 0.0001]), 0.0)?;
        Ok(noise)
    }

    /// How sure the contact of a sample is; `None` without one, and where that cannot be said, as at grazing.
    pub fn covariance<Reading, Verdict>(
        tip: &Tip,
        touch: &fingertip::Touch<f64, Reading, Verdict>,
        noise: &contact::WrenchNoise<f64>,
    ) -> Option<contact::ContactCovariance<f64>> {
        let surface = tip.surface();
        let found = touch.resolution.contact()?;
        let jacobian = contact::ContactJacobian::of_point_contact(
            found,
            &touch.wrench,
            &surfaces::SmoothSurface::shape_operator(surface, &found.point),
        )?;
        let covariance = contact::ContactCovariance::new(&jacobian, &noise.covariance(&touch.wrench));
        Some(covariance)
    }

    /// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
    pub type BadTip = surfaces::BadShape;
}

pub mod contact_soft_finger {
    // scene: a fingertip as a type, in f64.
    //
    // Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
    //
    //   input        convention = "on_fingertip", sample_rate_Hz = 1000.0
    //   surface      sphere, a sphere, or a part of it around a pole; radius_m = 0.013
    //   contact      soft_finger, a contact transmits a force and a torque about the normal, as a soft tip does;
    //                least_force_N = 0.1
    //   uncertainty  force_noise_N = 0.01, torque_noise_Nm = 0.0001
    //
    // It needs neither heap nor standard library, and in Cargo.toml:
    //
    //   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision"] }
    //
    // With a standard library, "std" in the place of "libm".
    //
    // Once, and then for each sample, `time_step` seconds after the one before:
    //
    //     let (mut tip, mut last) = (tip()?, None);
    //
    //     let step = fingertip::Step::of(time_step).with_last(last);
    //     let touch = tip.sense_wrench(load(force, torque), step);
    //     last = touch.point();
    //
    // With `let noise = wrench_noise()?`, the covariance of the contact is
    //     covariance(&tip, &touch, &noise)
    // whose `ellipse(0.95)` is that of the scene.

    use fingertip::nalgebra::{Vector3, Vector6};
    use fingertip::{Absent, Fingertip};
    use fingertip::{contact, surfaces, wrench};

    /// The pipeline.
    pub type Tip = Fingertip<
        Absent,
        surfaces::Sphere<f64>,
        contact::SoftFinger<f64>,
        Absent,
        Absent,
    >;

    /// Makes the pipeline.
    ///
    /// # Errors
    /// Never for the numbers below.
    #[allow(clippy::approx_constant)]
    pub fn tip() -> Result<Tip, BadTip> {
        let surface = surfaces::Sphere::new(Vector3::zeros(), 0.013)?;
        let model = contact::SoftFinger::new(0.1)?;
        Ok(Fingertip::builder()
            .contact(surface, model)
            .build())
    }

    /// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.
    pub fn load(force: Vector3<f64>, torque: Vector3<f64>) -> wrench::Wrench<f64> {
        wrench::Wrench::on_fingertip(force, torque)
    }

    /// How sure a wrench is: standard deviations at rest, and relative ones under load.
    ///
    /// # Errors
    /// Never for the numbers below.
    pub fn wrench_noise() -> Result<contact::WrenchNoise<f64>, BadTip> {
        let noise = contact::WrenchNoise::new(Vector6::from([0.01, 0.01, 0.01, 0.0001, 0.0001, 0.0001]), 0.0)?;
        Ok(noise)
    }

    /// How sure the contact of a sample is; `None` without one, and where that cannot be said, as at grazing.
    pub fn covariance<Reading, Verdict>(
        tip: &Tip,
        touch: &fingertip::Touch<f64, Reading, Verdict>,
        noise: &contact::WrenchNoise<f64>,
    ) -> Option<contact::ContactCovariance<f64>> {
        let surface = tip.surface();
        let found = touch.resolution.contact()?;
        let jacobian = contact::ContactJacobian::of_soft_finger_on(found, surface)?;
        let covariance = contact::ContactCovariance::new(&jacobian, &noise.covariance(&touch.wrench));
        Some(covariance)
    }

    /// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
    pub type BadTip = surfaces::BadShape;
}

pub mod contact_auto {
    // scene: a fingertip as a type, in f64.
    //
    // Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
    //
    //   input        convention = "on_fingertip", sample_rate_Hz = 1000.0
    //   surface      sphere, a sphere, or a part of it around a pole; radius_m = 0.013
    //   contact      auto, point contact or soft finger, whichever the wrench speaks for, given the noise in
    //                [uncertainty]; greatest_pitch_m = 0.01, least_force_N = 0.1
    //   uncertainty  force_noise_N = 0.01, torque_noise_Nm = 0.0001
    //
    // It needs neither heap nor standard library, and in Cargo.toml:
    //
    //   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision"] }
    //
    // With a standard library, "std" in the place of "libm".
    //
    // Once, and then for each sample, `time_step` seconds after the one before:
    //
    //     let (mut tip, mut last) = (tip()?, None);
    //
    //     let step = fingertip::Step::of(time_step).with_last(last);
    //     let touch = tip.sense_wrench(load(force, torque), step);
    //     last = touch.point();
    //
    // With `let noise = wrench_noise()?`, the covariance of the contact is
    //     covariance(&tip, &touch, &noise)
    // whose `ellipse(0.95)` is that of the scene.

    use fingertip::nalgebra::{Matrix6, Vector3, Vector6};
    use fingertip::{Absent, Fingertip};
    use fingertip::{contact, surfaces, wrench};

    /// The pipeline.
    pub type Tip = Fingertip<
        Absent,
        surfaces::Sphere<f64>,
        contact::Auto<f64>,
        Absent,
        Absent,
    >;

    /// Makes the pipeline.
    ///
    /// # Errors
    /// Never for the numbers below.
    #[allow(clippy::approx_constant)]
    pub fn tip() -> Result<Tip, BadTip> {
        let surface = surfaces::Sphere::new(Vector3::zeros(), 0.013)?;
        let model = contact::Auto::new(
            contact::PointContact::new(0.1)?,
            contact::SoftFinger::new(0.1)?,
            Matrix6::from_diagonal(&Vector6::from([0.0001, 0.0001, 0.0001, 1e-8, 1e-8, 1e-8])),
        )?.with_greatest_pitch(0.01, 3.0)?;
        Ok(Fingertip::builder()
            .contact(surface, model)
            .build())
    }

    /// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.
    pub fn load(force: Vector3<f64>, torque: Vector3<f64>) -> wrench::Wrench<f64> {
        wrench::Wrench::on_fingertip(force, torque)
    }

    /// How sure a wrench is: standard deviations at rest, and relative ones under load.
    ///
    /// # Errors
    /// Never for the numbers below.
    pub fn wrench_noise() -> Result<contact::WrenchNoise<f64>, BadTip> {
        let noise = contact::WrenchNoise::new(Vector6::from([0.01, 0.01, 0.01, 0.0001, 0.0001, 0.0001]), 0.0)?;
        Ok(noise)
    }

    /// How sure the contact of a sample is; `None` without one, and where that cannot be said, as at grazing.
    pub fn covariance<Reading, Verdict>(
        tip: &Tip,
        touch: &fingertip::Touch<f64, Reading, Verdict>,
        noise: &contact::WrenchNoise<f64>,
    ) -> Option<contact::ContactCovariance<f64>> {
        let surface = tip.surface();
        let found = touch.resolution.contact()?;
        let jacobian = match tip.model().test(&touch.wrench)?.choice {
            contact::Choice::SoftFinger => contact::ContactJacobian::of_soft_finger_on(found, surface)?,
            _ => contact::ContactJacobian::of_point_contact(
                found,
                &touch.wrench,
                &surfaces::SmoothSurface::shape_operator(surface, &found.point),
            )?,
        };
        let covariance = contact::ContactCovariance::new(&jacobian, &noise.covariance(&touch.wrench));
        Some(covariance)
    }

    /// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
    pub type BadTip = surfaces::BadShape;
}

pub mod contact_skin_linear {
    // scene: a fingertip as a type, in f64.
    //
    // Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
    //
    //   input        convention = "on_fingertip", sample_rate_Hz = 1000.0
    //   surface      sphere, a sphere, or a part of it around a pole; radius_m = 0.013
    //   contact
    //   contact.skin linear, depth in proportion to the force; radius_m = 0.013, stiffness_N_per_m = 8000.0
    //
    // It needs neither heap nor standard library, and in Cargo.toml:
    //
    //   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision", "skin"] }
    //
    // With a standard library, "std" in the place of "libm".
    //
    // Once, and then for each sample, `time_step` seconds after the one before:
    //
    //     let (mut tip, mut last) = (tip()?, None);
    //
    //     let step = fingertip::Step::of(time_step).with_last(last);
    //     let touch = tip.sense_wrench(load(force, torque), step);
    //     last = touch.point();

    use fingertip::nalgebra::Vector3;
    use fingertip::{Absent, Fingertip};
    use fingertip::{contact, surfaces, wrench};

    /// The pipeline.
    pub type Tip = Fingertip<
        Absent,
        surfaces::Sphere<f64>,
        contact::Compliant<f64, contact::PointContact<f64>, contact::LinearStiffness<f64>>,
        Absent,
        Absent,
    >;

    /// Makes the pipeline.
    ///
    /// # Errors
    /// Never for the numbers below.
    #[allow(clippy::approx_constant)]
    pub fn tip() -> Result<Tip, BadTip> {
        let surface = surfaces::Sphere::new(Vector3::zeros(), 0.013)?;
        let model = contact::Compliant::new(
            contact::PointContact::new(0.0)?,
            contact::LinearStiffness::new(8000.0, 0.013)?,
        );
        Ok(Fingertip::builder()
            .contact(surface, model)
            .build())
    }

    /// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.
    pub fn load(force: Vector3<f64>, torque: Vector3<f64>) -> wrench::Wrench<f64> {
        wrench::Wrench::on_fingertip(force, torque)
    }

    /// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
    pub type BadTip = surfaces::BadShape;
}

pub mod contact_skin_power {
    // scene: a fingertip as a type, in f64.
    //
    // Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
    //
    //   input        convention = "on_fingertip", sample_rate_Hz = 1000.0
    //   surface      sphere, a sphere, or a part of it around a pole; radius_m = 0.013
    //   contact
    //   contact.skin power, depth and patch as powers of the force; depth_at_1_N_m = 0.0004, depth_exponent =
    //                0.67, patch_at_1_N_m = 0.002, patch_exponent = 0.33
    //
    // It needs neither heap nor standard library, and in Cargo.toml:
    //
    //   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision", "skin"] }
    //
    // With a standard library, "std" in the place of "libm".
    //
    // Once, and then for each sample, `time_step` seconds after the one before:
    //
    //     let (mut tip, mut last) = (tip()?, None);
    //
    //     let step = fingertip::Step::of(time_step).with_last(last);
    //     let touch = tip.sense_wrench(load(force, torque), step);
    //     last = touch.point();

    use fingertip::nalgebra::Vector3;
    use fingertip::{Absent, Fingertip};
    use fingertip::{contact, surfaces, wrench};

    /// The pipeline.
    pub type Tip = Fingertip<
        Absent,
        surfaces::Sphere<f64>,
        contact::Compliant<f64, contact::PointContact<f64>, contact::PowerLaw<f64>>,
        Absent,
        Absent,
    >;

    /// Makes the pipeline.
    ///
    /// # Errors
    /// Never for the numbers below.
    #[allow(clippy::approx_constant)]
    pub fn tip() -> Result<Tip, BadTip> {
        let surface = surfaces::Sphere::new(Vector3::zeros(), 0.013)?;
        let model = contact::Compliant::new(
            contact::PointContact::new(0.0)?,
            contact::PowerLaw::new([0.002, 0.33], [0.0004, 0.67])?,
        );
        Ok(Fingertip::builder()
            .contact(surface, model)
            .build())
    }

    /// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.
    pub fn load(force: Vector3<f64>, torque: Vector3<f64>) -> wrench::Wrench<f64> {
        wrench::Wrench::on_fingertip(force, torque)
    }

    /// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
    pub type BadTip = surfaces::BadShape;
}

pub mod contact_skin_hertz {
    // scene: a fingertip as a type, in f64.
    //
    // Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
    //
    //   input        convention = "on_fingertip", sample_rate_Hz = 1000.0
    //   surface      sphere, a sphere, or a part of it around a pole; radius_m = 0.013
    //   contact
    //   contact.skin hertz, an elastic body with the same curvature everywhere; poisson_ratios = [0.49, 0.3],
    //                radii_m = [0.013, 0.013], young_moduli_Pa = [2000000.0, inf]
    //
    // It needs neither heap nor standard library, and in Cargo.toml:
    //
    //   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision", "skin"] }
    //
    // With a standard library, "std" in the place of "libm".
    //
    // Once, and then for each sample, `time_step` seconds after the one before:
    //
    //     let (mut tip, mut last) = (tip()?, None);
    //
    //     let step = fingertip::Step::of(time_step).with_last(last);
    //     let touch = tip.sense_wrench(load(force, torque), step);
    //     last = touch.point();

    use fingertip::nalgebra::Vector3;
    use fingertip::{Absent, Fingertip};
    use fingertip::{contact, surfaces, wrench};

    /// The pipeline.
    pub type Tip = Fingertip<
        Absent,
        surfaces::Sphere<f64>,
        contact::Compliant<f64, contact::PointContact<f64>, contact::Hertz<f64>>,
        Absent,
        Absent,
    >;

    /// Makes the pipeline.
    ///
    /// # Errors
    /// Never for the numbers below.
    #[allow(clippy::approx_constant)]
    pub fn tip() -> Result<Tip, BadTip> {
        let surface = surfaces::Sphere::new(Vector3::zeros(), 0.013)?;
        let model = contact::Compliant::new(
            contact::PointContact::new(0.0)?,
            contact::Hertz::new(
                [0.013, 0.013],
                contact::contact_modulus([2000000.0, f64::INFINITY], [0.49, 0.3])?,
            )?,
        );
        Ok(Fingertip::builder()
            .contact(surface, model)
            .build())
    }

    /// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.
    pub fn load(force: Vector3<f64>, torque: Vector3<f64>) -> wrench::Wrench<f64> {
        wrench::Wrench::on_fingertip(force, torque)
    }

    /// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
    pub type BadTip = surfaces::BadShape;
}

pub mod contact_skin_local_hertz {
    // scene: a fingertip as a type, in f64.
    //
    // Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
    //
    //   input        convention = "on_fingertip", sample_rate_Hz = 1000.0
    //   surface      sphere, a sphere, or a part of it around a pole; radius_m = 0.013
    //   contact
    //   contact.skin local_hertz, an elastic body with the curvature that the surface has where it touches;
    //                largest_radius_m = 0.1, poisson_ratios = [0.49, 0.3], young_moduli_Pa = [2000000.0, inf]
    //
    // It needs neither heap nor standard library, and in Cargo.toml:
    //
    //   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision", "skin"] }
    //
    // With a standard library, "std" in the place of "libm".
    //
    // Once, and then for each sample, `time_step` seconds after the one before:
    //
    //     let (mut tip, mut last) = (tip()?, None);
    //
    //     let step = fingertip::Step::of(time_step).with_last(last);
    //     let touch = tip.sense_wrench(load(force, torque), step);
    //     last = touch.point();

    use fingertip::nalgebra::Vector3;
    use fingertip::{Absent, Fingertip};
    use fingertip::{contact, surfaces, wrench};

    /// The pipeline.
    pub type Tip = Fingertip<
        Absent,
        surfaces::Sphere<f64>,
        contact::Compliant<f64, contact::PointContact<f64>, contact::LocalHertz<f64>>,
        Absent,
        Absent,
    >;

    /// Makes the pipeline.
    ///
    /// # Errors
    /// Never for the numbers below.
    #[allow(clippy::approx_constant)]
    pub fn tip() -> Result<Tip, BadTip> {
        let surface = surfaces::Sphere::new(Vector3::zeros(), 0.013)?;
        let model = contact::Compliant::new(
            contact::PointContact::new(0.0)?,
            contact::LocalHertz::new(
                contact::contact_modulus([2000000.0, f64::INFINITY], [0.49, 0.3])?,
                0.0,
                0.1,
            )?,
        );
        Ok(Fingertip::builder()
            .contact(surface, model)
            .build())
    }

    /// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.
    pub fn load(force: Vector3<f64>, torque: Vector3<f64>) -> wrench::Wrench<f64> {
        wrench::Wrench::on_fingertip(force, torque)
    }

    /// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
    pub type BadTip = surfaces::BadShape;
}

pub mod contact_skin_table {
    // scene: a fingertip as a type, in f64.
    //
    // Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
    //
    //   input        convention = "on_fingertip", sample_rate_Hz = 1000.0
    //   surface      sphere, a sphere, or a part of it around a pole; radius_m = 0.013
    //   contact
    //   contact.skin table, measured points of force, depth and radius of the patch; force_depth_patch_N_m_m =
    //                [[0.5, 0.0002, 0.001], [2.0, 0.0005, 0.002], [5.0, 0.0009, 0 …
    //
    // It needs neither heap nor standard library, and in Cargo.toml:
    //
    //   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision", "skin"] }
    //
    // With a standard library, "std" in the place of "libm".
    //
    // Once, and then for each sample, `time_step` seconds after the one before:
    //
    //     let (mut tip, mut last) = (tip()?, None);
    //
    //     let step = fingertip::Step::of(time_step).with_last(last);
    //     let touch = tip.sense_wrench(load(force, torque), step);
    //     last = touch.point();

    use fingertip::nalgebra::Vector3;
    use fingertip::{Absent, Fingertip};
    use fingertip::{contact, surfaces, wrench};

    /// The pipeline.
    pub type Tip = Fingertip<
        Absent,
        surfaces::Sphere<f64>,
        contact::Compliant<f64, contact::PointContact<f64>, contact::Tabulated<f64, [[f64; 3]; 3]>>,
        Absent,
        Absent,
    >;

    /// Makes the pipeline.
    ///
    /// # Errors
    /// Never for the numbers below.
    #[allow(clippy::approx_constant)]
    pub fn tip() -> Result<Tip, BadTip> {
        let surface = surfaces::Sphere::new(Vector3::zeros(), 0.013)?;
        let model = contact::Compliant::new(
            contact::PointContact::new(0.0)?,
            contact::Tabulated::new([[0.5, 0.0002, 0.001], [2.0, 0.0005, 0.002], [5.0, 0.0009, 0.003]])?,
        );
        Ok(Fingertip::builder()
            .contact(surface, model)
            .build())
    }

    /// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.
    pub fn load(force: Vector3<f64>, torque: Vector3<f64>) -> wrench::Wrench<f64> {
        wrench::Wrench::on_fingertip(force, torque)
    }

    /// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
    pub type BadTip = surfaces::BadShape;
}

pub mod friction_coulomb {
    // scene: a fingertip as a type, in f64.
    //
    // Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
    //
    //   input        convention = "on_fingertip", sample_rate_Hz = 1000.0
    //   surface      sphere, a sphere, or a part of it around a pole; radius_m = 0.013
    //   friction     coulomb, one coefficient in all directions; static_coefficient = 0.5
    //
    // It needs neither heap nor standard library, and in Cargo.toml:
    //
    //   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision", "friction"] }
    //
    // With a standard library, "std" in the place of "libm".
    //
    // Once, and then for each sample, `time_step` seconds after the one before:
    //
    //     let (mut tip, mut last) = (tip()?, None);
    //
    //     let step = fingertip::Step::of(time_step).with_last(last);
    //     let touch = tip.sense_wrench(load(force, torque), step);
    //     last = touch.point();

    use fingertip::nalgebra::Vector3;
    use fingertip::{Absent, Fingertip, Present};
    use fingertip::{contact, friction, surfaces, wrench};

    /// The pipeline.
    pub type Tip = Fingertip<
        Absent,
        surfaces::Sphere<f64>,
        contact::PointContact<f64>,
        Present<friction::Coulomb<f64>>,
        Absent,
    >;

    /// Makes the pipeline.
    ///
    /// # Errors
    /// Never for the numbers below.
    #[allow(clippy::approx_constant)]
    pub fn tip() -> Result<Tip, BadTip> {
        let surface = surfaces::Sphere::new(Vector3::zeros(), 0.013)?;
        let model = contact::PointContact::new(0.0)?;
        Ok(Fingertip::builder()
            .contact(surface, model)
            .friction(friction::Coulomb::new(0.5)?)
            .build())
    }

    /// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.
    pub fn load(force: Vector3<f64>, torque: Vector3<f64>) -> wrench::Wrench<f64> {
        wrench::Wrench::on_fingertip(force, torque)
    }

    /// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
    #[derive(Clone, Debug, PartialEq)]
    pub enum BadTip {
        /// A shape, a contact model or an uncertainty.
        Shape(surfaces::BadShape),
        /// A friction, a detector or a grip.
        Friction(friction::BadParameter),
    }

    impl core::fmt::Display for BadTip {
        fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
            match self {
                Self::Shape(bad) => bad.fmt(f),
                Self::Friction(bad) => bad.fmt(f),
            }
        }
    }

    impl core::error::Error for BadTip {}

    impl From<surfaces::BadShape> for BadTip {
        fn from(bad: surfaces::BadShape) -> Self {
            Self::Shape(bad)
        }
    }

    impl From<friction::BadParameter> for BadTip {
        fn from(bad: friction::BadParameter) -> Self {
            Self::Friction(bad)
        }
    }
}

pub mod friction_anisotropic {
    // scene: a fingertip as a type, in f64.
    //
    // Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
    //
    //   input        convention = "on_fingertip", sample_rate_Hz = 1000.0
    //   surface      plane, a plane; point_m = [0.0, 0.0, 0.013]
    //   friction     anisotropic, one coefficient along the grain of a flat surface, another across it;
    //                coefficient_across = 0.6, coefficient_along = 0.4, grain = [1.0, 0.0, 0.0]
    //
    // It needs neither heap nor standard library, and in Cargo.toml:
    //
    //   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision", "friction"] }
    //
    // With a standard library, "std" in the place of "libm".
    //
    // Once, and then for each sample, `time_step` seconds after the one before:
    //
    //     let (mut tip, mut last) = (tip()?, None);
    //
    //     let step = fingertip::Step::of(time_step).with_last(last);
    //     let touch = tip.sense_wrench(load(force, torque), step);
    //     last = touch.point();

    use fingertip::nalgebra::Vector3;
    use fingertip::{Absent, Fingertip, Present};
    use fingertip::{contact, friction, surfaces, wrench};

    /// The pipeline.
    pub type Tip = Fingertip<
        Absent,
        surfaces::Plane<f64>,
        contact::PointContact<f64>,
        Present<friction::AnisotropicCoulomb<f64>>,
        Absent,
    >;

    /// Makes the pipeline.
    ///
    /// # Errors
    /// Never for the numbers below.
    #[allow(clippy::approx_constant)]
    pub fn tip() -> Result<Tip, BadTip> {
        let surface = surfaces::Plane::new(Vector3::new(0.0, 0.0, 0.013), Vector3::z())?;
        let model = contact::PointContact::new(0.0)?;
        Ok(Fingertip::builder()
            .contact(surface, model)
            .friction(friction::AnisotropicCoulomb::new([Vector3::x(), Vector3::y()], [0.4, 0.6])?)
            .build())
    }

    /// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.
    pub fn load(force: Vector3<f64>, torque: Vector3<f64>) -> wrench::Wrench<f64> {
        wrench::Wrench::on_fingertip(force, torque)
    }

    /// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
    #[derive(Clone, Debug, PartialEq)]
    pub enum BadTip {
        /// A shape, a contact model or an uncertainty.
        Shape(surfaces::BadShape),
        /// A friction, a detector or a grip.
        Friction(friction::BadParameter),
    }

    impl core::fmt::Display for BadTip {
        fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
            match self {
                Self::Shape(bad) => bad.fmt(f),
                Self::Friction(bad) => bad.fmt(f),
            }
        }
    }

    impl core::error::Error for BadTip {}

    impl From<surfaces::BadShape> for BadTip {
        fn from(bad: surfaces::BadShape) -> Self {
            Self::Shape(bad)
        }
    }

    impl From<friction::BadParameter> for BadTip {
        fn from(bad: friction::BadParameter) -> Self {
            Self::Friction(bad)
        }
    }
}

pub mod friction_soft_finger {
    // scene: a fingertip as a type, in f64.
    //
    // Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
    //
    //   input        convention = "on_fingertip", sample_rate_Hz = 1000.0
    //   surface      sphere, a sphere, or a part of it around a pole; radius_m = 0.013
    //   friction     soft_finger, tangential force and spin torque together; static_coefficient = 0.5,
    //                torque_arm_m = 0.003
    //
    // It needs neither heap nor standard library, and in Cargo.toml:
    //
    //   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision", "friction"] }
    //
    // With a standard library, "std" in the place of "libm".
    //
    // Once, and then for each sample, `time_step` seconds after the one before:
    //
    //     let (mut tip, mut last) = (tip()?, None);
    //
    //     let step = fingertip::Step::of(time_step).with_last(last);
    //     let touch = tip.sense_wrench(load(force, torque), step);
    //     last = touch.point();

    use fingertip::nalgebra::Vector3;
    use fingertip::{Absent, Fingertip, Present};
    use fingertip::{contact, friction, surfaces, wrench};

    /// The pipeline.
    pub type Tip = Fingertip<
        Absent,
        surfaces::Sphere<f64>,
        contact::PointContact<f64>,
        Present<friction::SoftFingerLimit<f64>>,
        Absent,
    >;

    /// Makes the pipeline.
    ///
    /// # Errors
    /// Never for the numbers below.
    #[allow(clippy::approx_constant)]
    pub fn tip() -> Result<Tip, BadTip> {
        let surface = surfaces::Sphere::new(Vector3::zeros(), 0.013)?;
        let model = contact::PointContact::new(0.0)?;
        Ok(Fingertip::builder()
            .contact(surface, model)
            .friction(friction::SoftFingerLimit::new(0.5, 0.003)?)
            .build())
    }

    /// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.
    pub fn load(force: Vector3<f64>, torque: Vector3<f64>) -> wrench::Wrench<f64> {
        wrench::Wrench::on_fingertip(force, torque)
    }

    /// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
    #[derive(Clone, Debug, PartialEq)]
    pub enum BadTip {
        /// A shape, a contact model or an uncertainty.
        Shape(surfaces::BadShape),
        /// A friction, a detector or a grip.
        Friction(friction::BadParameter),
    }

    impl core::fmt::Display for BadTip {
        fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
            match self {
                Self::Shape(bad) => bad.fmt(f),
                Self::Friction(bad) => bad.fmt(f),
            }
        }
    }

    impl core::error::Error for BadTip {}

    impl From<surfaces::BadShape> for BadTip {
        fn from(bad: surfaces::BadShape) -> Self {
            Self::Shape(bad)
        }
    }

    impl From<friction::BadParameter> for BadTip {
        fn from(bad: friction::BadParameter) -> Self {
            Self::Friction(bad)
        }
    }
}

pub mod friction_power {
    // scene: a fingertip as a type, in f64.
    //
    // Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
    //
    //   input        convention = "on_fingertip", sample_rate_Hz = 1000.0
    //   surface      sphere, a sphere, or a part of it around a pole; radius_m = 0.013
    //   friction     power, tangential force and spin torque on a patch whose pressure is known: "uniform",
    //                "hertz" or "winkler"; patch_radius_m = 0.004, pressure = "hertz", static_coefficient = 0.5
    //
    // It needs neither heap nor standard library, and in Cargo.toml:
    //
    //   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision", "friction"] }
    //
    // With a standard library, "std" in the place of "libm".
    //
    // Once, and then for each sample, `time_step` seconds after the one before:
    //
    //     let (mut tip, mut last) = (tip()?, None);
    //
    //     let step = fingertip::Step::of(time_step).with_last(last);
    //     let touch = tip.sense_wrench(load(force, torque), step);
    //     last = touch.point();

    use fingertip::nalgebra::Vector3;
    use fingertip::{Absent, Fingertip, Present};
    use fingertip::{contact, friction, surfaces, wrench};

    /// The pipeline.
    pub type Tip = Fingertip<
        Absent,
        surfaces::Sphere<f64>,
        contact::PointContact<f64>,
        Present<friction::PowerLimit<f64>>,
        Absent,
    >;

    /// Makes the pipeline.
    ///
    /// # Errors
    /// Never for the numbers below.
    #[allow(clippy::approx_constant)]
    pub fn tip() -> Result<Tip, BadTip> {
        let surface = surfaces::Sphere::new(Vector3::zeros(), 0.013)?;
        let model = contact::PointContact::new(0.0)?;
        Ok(Fingertip::builder()
            .contact(surface, model)
            .friction(friction::PowerLimit::for_patch(0.5, 0.004, friction::PressureDistribution::Hertz)?)
            .build())
    }

    /// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.
    pub fn load(force: Vector3<f64>, torque: Vector3<f64>) -> wrench::Wrench<f64> {
        wrench::Wrench::on_fingertip(force, torque)
    }

    /// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
    #[derive(Clone, Debug, PartialEq)]
    pub enum BadTip {
        /// A shape, a contact model or an uncertainty.
        Shape(surfaces::BadShape),
        /// A friction, a detector or a grip.
        Friction(friction::BadParameter),
    }

    impl core::fmt::Display for BadTip {
        fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
            match self {
                Self::Shape(bad) => bad.fmt(f),
                Self::Friction(bad) => bad.fmt(f),
            }
        }
    }

    impl core::error::Error for BadTip {}

    impl From<surfaces::BadShape> for BadTip {
        fn from(bad: surfaces::BadShape) -> Self {
            Self::Shape(bad)
        }
    }

    impl From<friction::BadParameter> for BadTip {
        fn from(bad: friction::BadParameter) -> Self {
            Self::Friction(bad)
        }
    }
}

pub mod friction_load_dependent {
    // scene: a fingertip as a type, in f64.
    //
    // Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
    //
    //   input        convention = "on_fingertip", sample_rate_Hz = 1000.0
    //   surface      sphere, a sphere, or a part of it around a pole; radius_m = 0.013
    //   friction     load_dependent, tangential force and spin torque on a patch that grows with the force;
    //                growth_exponent = 0.33, reference_force_N = 1.0, static_coefficient = 0.5, torque_arm_m =
    //                0.003
    //
    // It needs neither heap nor standard library, and in Cargo.toml:
    //
    //   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision", "friction"] }
    //
    // With a standard library, "std" in the place of "libm".
    //
    // Once, and then for each sample, `time_step` seconds after the one before:
    //
    //     let (mut tip, mut last) = (tip()?, None);
    //
    //     let step = fingertip::Step::of(time_step).with_last(last);
    //     let touch = tip.sense_wrench(load(force, torque), step);
    //     last = touch.point();

    use fingertip::nalgebra::Vector3;
    use fingertip::{Absent, Fingertip, Present};
    use fingertip::{contact, friction, surfaces, wrench};

    /// The pipeline.
    pub type Tip = Fingertip<
        Absent,
        surfaces::Sphere<f64>,
        contact::PointContact<f64>,
        Present<friction::LoadDependentLimit<f64>>,
        Absent,
    >;

    /// Makes the pipeline.
    ///
    /// # Errors
    /// Never for the numbers below.
    #[allow(clippy::approx_constant)]
    pub fn tip() -> Result<Tip, BadTip> {
        let surface = surfaces::Sphere::new(Vector3::zeros(), 0.013)?;
        let model = contact::PointContact::new(0.0)?;
        Ok(Fingertip::builder()
            .contact(surface, model)
            .friction(friction::LoadDependentLimit::new(0.5, 0.003, 1.0, 0.33)?)
            .build())
    }

    /// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.
    pub fn load(force: Vector3<f64>, torque: Vector3<f64>) -> wrench::Wrench<f64> {
        wrench::Wrench::on_fingertip(force, torque)
    }

    /// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
    #[derive(Clone, Debug, PartialEq)]
    pub enum BadTip {
        /// A shape, a contact model or an uncertainty.
        Shape(surfaces::BadShape),
        /// A friction, a detector or a grip.
        Friction(friction::BadParameter),
    }

    impl core::fmt::Display for BadTip {
        fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
            match self {
                Self::Shape(bad) => bad.fmt(f),
                Self::Friction(bad) => bad.fmt(f),
            }
        }
    }

    impl core::error::Error for BadTip {}

    impl From<surfaces::BadShape> for BadTip {
        fn from(bad: surfaces::BadShape) -> Self {
            Self::Shape(bad)
        }
    }

    impl From<friction::BadParameter> for BadTip {
        fn from(bad: friction::BadParameter) -> Self {
            Self::Friction(bad)
        }
    }
}

pub mod friction_uncertain {
    // scene: a fingertip as a type, in f64.
    //
    // Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
    //
    //   input        convention = "on_fingertip", sample_rate_Hz = 1000.0
    //   surface      sphere, a sphere, or a part of it around a pole; radius_m = 0.013
    //   friction     uncertain, a coefficient with a standard deviation; deviation = 0.05, noise_N = 0.01,
    //                static_coefficient = 0.5
    //
    // It needs neither heap nor standard library, and in Cargo.toml:
    //
    //   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision", "friction"] }
    //
    // With a standard library, "std" in the place of "libm".
    //
    // Once, and then for each sample, `time_step` seconds after the one before:
    //
    //     let (mut tip, mut last) = (tip()?, None);
    //
    //     let step = fingertip::Step::of(time_step).with_last(last);
    //     let touch = tip.sense_wrench(load(force, torque), step);
    //     last = touch.point();
    //
    // With `let model = friction_model()?`, the probability that the contact slips is
    //     model.slip_probability(&force)

    use fingertip::nalgebra::Vector3;
    use fingertip::{Absent, Fingertip, Present};
    use fingertip::{contact, friction, surfaces, wrench};

    /// The pipeline.
    pub type Tip = Fingertip<
        Absent,
        surfaces::Sphere<f64>,
        contact::PointContact<f64>,
        Present<friction::Coulomb<f64>>,
        Absent,
    >;

    /// Makes the pipeline.
    ///
    /// # Errors
    /// Never for the numbers below.
    #[allow(clippy::approx_constant)]
    pub fn tip() -> Result<Tip, BadTip> {
        let surface = surfaces::Sphere::new(Vector3::zeros(), 0.013)?;
        let model = contact::PointContact::new(0.0)?;
        Ok(Fingertip::builder()
            .contact(surface, model)
            .friction(friction::Coulomb::new(0.383682606297958)?)
            .build())
    }

    /// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.
    pub fn load(force: Vector3<f64>, torque: Vector3<f64>) -> wrench::Wrench<f64> {
        wrench::Wrench::on_fingertip(force, torque)
    }

    /// What is known of the friction: `slip_probability` of a contact's force.
    ///
    /// # Errors
    /// Never for the numbers below.
    pub fn friction_model() -> Result<friction::UncertainCoulomb<f64>, BadTip> {
        Ok(friction::UncertainCoulomb::new(0.5, 0.05, Some(friction::ForceNoise::isotropic(0.01)?))?)
    }

    /// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
    #[derive(Clone, Debug, PartialEq)]
    pub enum BadTip {
        /// A shape, a contact model or an uncertainty.
        Shape(surfaces::BadShape),
        /// A friction, a detector or a grip.
        Friction(friction::BadParameter),
    }

    impl core::fmt::Display for BadTip {
        fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
            match self {
                Self::Shape(bad) => bad.fmt(f),
                Self::Friction(bad) => bad.fmt(f),
            }
        }
    }

    impl core::error::Error for BadTip {}

    impl From<surfaces::BadShape> for BadTip {
        fn from(bad: surfaces::BadShape) -> Self {
            Self::Shape(bad)
        }
    }

    impl From<friction::BadParameter> for BadTip {
        fn from(bad: friction::BadParameter) -> Self {
            Self::Friction(bad)
        }
    }
}

pub mod slip_drop {
    // scene: a fingertip as a type, in f64.
    //
    // Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
    //
    //   input        convention = "on_fingertip", sample_rate_Hz = 1000.0
    //   surface      sphere, a sphere, or a part of it around a pole; radius_m = 0.013
    //   friction     coulomb, one coefficient in all directions; static_coefficient = 0.5
    //   slip         drop, the friction ratio falls suddenly; noise_N = 0.01
    //
    // It needs neither heap nor standard library, and in Cargo.toml:
    //
    //   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision", "friction"] }
    //
    // With a standard library, "std" in the place of "libm".
    //
    // Once, and then for each sample, `time_step` seconds after the one before:
    //
    //     let (mut tip, mut last) = (tip()?, None);
    //
    //     let step = fingertip::Step::of(time_step).with_last(last);
    //     let touch = tip.sense_wrench(load(force, torque), step);
    //     last = touch.point();
    //
    // After a pause, `last = None` and `friction::SlipDetector::<f64>::reset(&mut tip.detector_mut().0)`.

    use fingertip::nalgebra::Vector3;
    use fingertip::{Absent, Fingertip, Present};
    use fingertip::{contact, friction, surfaces, wrench};

    /// The pipeline.
    pub type Tip = Fingertip<
        Absent,
        surfaces::Sphere<f64>,
        contact::PointContact<f64>,
        Present<friction::Coulomb<f64>>,
        Present<friction::DropDetector<f64>>,
    >;

    /// Makes the pipeline.
    ///
    /// # Errors
    /// Never for the numbers below.
    #[allow(clippy::approx_constant)]
    pub fn tip() -> Result<Tip, BadTip> {
        let surface = surfaces::Sphere::new(Vector3::zeros(), 0.013)?;
        let model = contact::PointContact::new(0.0)?;
        Ok(Fingertip::builder()
            .contact(surface, model)
            .friction(friction::Coulomb::new(0.5)?)
            .slip_detector(friction::DropDetector::new(friction::ForceNoise::isotropic(0.01)?)?)
            .build())
    }

    /// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.
    pub fn load(force: Vector3<f64>, torque: Vector3<f64>) -> wrench::Wrench<f64> {
        wrench::Wrench::on_fingertip(force, torque)
    }

    /// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
    #[derive(Clone, Debug, PartialEq)]
    pub enum BadTip {
        /// A shape, a contact model or an uncertainty.
        Shape(surfaces::BadShape),
        /// A friction, a detector or a grip.
        Friction(friction::BadParameter),
    }

    impl core::fmt::Display for BadTip {
        fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
            match self {
                Self::Shape(bad) => bad.fmt(f),
                Self::Friction(bad) => bad.fmt(f),
            }
        }
    }

    impl core::error::Error for BadTip {}

    impl From<surfaces::BadShape> for BadTip {
        fn from(bad: surfaces::BadShape) -> Self {
            Self::Shape(bad)
        }
    }

    impl From<friction::BadParameter> for BadTip {
        fn from(bad: friction::BadParameter) -> Self {
            Self::Friction(bad)
        }
    }
}

pub mod slip_threshold {
    // scene: a fingertip as a type, in f64.
    //
    // Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
    //
    //   input        convention = "on_fingertip", sample_rate_Hz = 1000.0
    //   surface      sphere, a sphere, or a part of it around a pole; radius_m = 0.013
    //   friction     coulomb, one coefficient in all directions; static_coefficient = 0.5
    //   slip         threshold, the friction ratio passes the coefficient of [friction]; noise_N = 0.01,
    //                warning_share = 0.8
    //
    // It needs neither heap nor standard library, and in Cargo.toml:
    //
    //   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision", "friction"] }
    //
    // With a standard library, "std" in the place of "libm".
    //
    // Once, and then for each sample, `time_step` seconds after the one before:
    //
    //     let (mut tip, mut last) = (tip()?, None);
    //
    //     let step = fingertip::Step::of(time_step).with_last(last);
    //     let touch = tip.sense_wrench(load(force, torque), step);
    //     last = touch.point();
    //
    // After a pause, `last = None` and `friction::SlipDetector::<f64>::reset(&mut tip.detector_mut().0)`.

    use fingertip::nalgebra::Vector3;
    use fingertip::{Absent, Fingertip, Present};
    use fingertip::{contact, friction, surfaces, wrench};

    /// The pipeline.
    pub type Tip = Fingertip<
        Absent,
        surfaces::Sphere<f64>,
        contact::PointContact<f64>,
        Present<friction::Coulomb<f64>>,
        Present<friction::RatioThreshold<f64>>,
    >;

    /// Makes the pipeline.
    ///
    /// # Errors
    /// Never for the numbers below.
    #[allow(clippy::approx_constant)]
    pub fn tip() -> Result<Tip, BadTip> {
        let surface = surfaces::Sphere::new(Vector3::zeros(), 0.013)?;
        let model = contact::PointContact::new(0.0)?;
        Ok(Fingertip::builder()
            .contact(surface, model)
            .friction(friction::Coulomb::new(0.5)?)
            .slip_detector(
                friction::RatioThreshold::new(
                    friction::NormalForceGate::from_noise(&friction::ForceNoise::isotropic(0.01)?),
                    0.5,
                )?.with_warning_share(0.8)?,
            )
            .build())
    }

    /// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.
    pub fn load(force: Vector3<f64>, torque: Vector3<f64>) -> wrench::Wrench<f64> {
        wrench::Wrench::on_fingertip(force, torque)
    }

    /// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
    #[derive(Clone, Debug, PartialEq)]
    pub enum BadTip {
        /// A shape, a contact model or an uncertainty.
        Shape(surfaces::BadShape),
        /// A friction, a detector or a grip.
        Friction(friction::BadParameter),
    }

    impl core::fmt::Display for BadTip {
        fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
            match self {
                Self::Shape(bad) => bad.fmt(f),
                Self::Friction(bad) => bad.fmt(f),
            }
        }
    }

    impl core::error::Error for BadTip {}

    impl From<surfaces::BadShape> for BadTip {
        fn from(bad: surfaces::BadShape) -> Self {
            Self::Shape(bad)
        }
    }

    impl From<friction::BadParameter> for BadTip {
        fn from(bad: friction::BadParameter) -> Self {
            Self::Friction(bad)
        }
    }
}

pub mod slip_likelihood_ratio {
    // scene: a fingertip as a type, in f64.
    //
    // Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
    //
    //   input        convention = "on_fingertip", sample_rate_Hz = 1000.0
    //   surface      sphere, a sphere, or a part of it around a pole; radius_m = 0.013
    //   friction     coulomb, one coefficient in all directions; static_coefficient = 0.5
    //   slip         likelihood_ratio, the friction ratio falls, suddenly or not; false_alarms_per_minute = 1.0,
    //                noise_N = 0.01
    //
    // It needs neither heap nor standard library, and in Cargo.toml:
    //
    //   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision", "friction"] }
    //
    // With a standard library, "std" in the place of "libm".
    //
    // Once, and then for each sample, `time_step` seconds after the one before:
    //
    //     let (mut tip, mut last) = (tip()?, None);
    //
    //     let step = fingertip::Step::of(time_step).with_last(last);
    //     let touch = tip.sense_wrench(load(force, torque), step);
    //     last = touch.point();
    //
    // After a pause, `last = None` and `friction::SlipDetector::<f64>::reset(&mut tip.detector_mut().0)`.

    use fingertip::nalgebra::Vector3;
    use fingertip::{Absent, Fingertip, Present};
    use fingertip::{contact, friction, surfaces, wrench};

    /// The pipeline.
    pub type Tip = Fingertip<
        Absent,
        surfaces::Sphere<f64>,
        contact::PointContact<f64>,
        Present<friction::Coulomb<f64>>,
        Present<friction::LikelihoodRatioDetector<f64, 32>>,
    >;

    /// Makes the pipeline.
    ///
    /// # Errors
    /// Never for the numbers below.
    #[allow(clippy::approx_constant)]
    pub fn tip() -> Result<Tip, BadTip> {
        let surface = surfaces::Sphere::new(Vector3::zeros(), 0.013)?;
        let model = contact::PointContact::new(0.0)?;
        Ok(Fingertip::builder()
            .contact(surface, model)
            .friction(friction::Coulomb::new(0.5)?)
            .slip_detector(
                friction::LikelihoodRatioDetector::with_ratio(
                    friction::ForceNoise::isotropic(0.01)?,
                    friction::LikelihoodRatio::new(10.33952125775202)?,
                )?,
            )
            .build())
    }

    /// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.
    pub fn load(force: Vector3<f64>, torque: Vector3<f64>) -> wrench::Wrench<f64> {
        wrench::Wrench::on_fingertip(force, torque)
    }

    /// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
    #[derive(Clone, Debug, PartialEq)]
    pub enum BadTip {
        /// A shape, a contact model or an uncertainty.
        Shape(surfaces::BadShape),
        /// A friction, a detector or a grip.
        Friction(friction::BadParameter),
    }

    impl core::fmt::Display for BadTip {
        fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
            match self {
                Self::Shape(bad) => bad.fmt(f),
                Self::Friction(bad) => bad.fmt(f),
            }
        }
    }

    impl core::error::Error for BadTip {}

    impl From<surfaces::BadShape> for BadTip {
        fn from(bad: surfaces::BadShape) -> Self {
            Self::Shape(bad)
        }
    }

    impl From<friction::BadParameter> for BadTip {
        fn from(bad: friction::BadParameter) -> Self {
            Self::Friction(bad)
        }
    }
}

pub mod slip_stick_slip {
    // scene: a fingertip as a type, in f64.
    //
    // Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
    //
    //   input        convention = "on_fingertip", sample_rate_Hz = 1000.0
    //   surface      sphere, a sphere, or a part of it around a pole; radius_m = 0.013
    //   friction     coulomb, one coefficient in all directions; static_coefficient = 0.5
    //   slip         stick_slip, falls that come again and again; noise_N = 0.01
    //
    // It needs neither heap nor standard library, and in Cargo.toml:
    //
    //   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision", "friction"] }
    //
    // With a standard library, "std" in the place of "libm".
    //
    // Once, and then for each sample, `time_step` seconds after the one before:
    //
    //     let (mut tip, mut last) = (tip()?, None);
    //
    //     let step = fingertip::Step::of(time_step).with_last(last);
    //     let touch = tip.sense_wrench(load(force, torque), step);
    //     last = touch.point();
    //
    // After a pause, `last = None` and `friction::SlipDetector::<f64>::reset(&mut tip.detector_mut().0)`.

    use fingertip::nalgebra::Vector3;
    use fingertip::{Absent, Fingertip, Present};
    use fingertip::{contact, friction, surfaces, wrench};

    /// The pipeline.
    pub type Tip = Fingertip<
        Absent,
        surfaces::Sphere<f64>,
        contact::PointContact<f64>,
        Present<friction::Coulomb<f64>>,
        Present<friction::StickSlipDetector<f64>>,
    >;

    /// Makes the pipeline.
    ///
    /// # Errors
    /// Never for the numbers below.
    #[allow(clippy::approx_constant)]
    pub fn tip() -> Result<Tip, BadTip> {
        let surface = surfaces::Sphere::new(Vector3::zeros(), 0.013)?;
        let model = contact::PointContact::new(0.0)?;
        Ok(Fingertip::builder()
            .contact(surface, model)
            .friction(friction::Coulomb::new(0.5)?)
            .slip_detector(
                friction::StickSlipDetector::new(
                    friction::DropDetector::new(friction::ForceNoise::isotropic(0.01)?)?,
                ),
            )
            .build())
    }

    /// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.
    pub fn load(force: Vector3<f64>, torque: Vector3<f64>) -> wrench::Wrench<f64> {
        wrench::Wrench::on_fingertip(force, torque)
    }

    /// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
    #[derive(Clone, Debug, PartialEq)]
    pub enum BadTip {
        /// A shape, a contact model or an uncertainty.
        Shape(surfaces::BadShape),
        /// A friction, a detector or a grip.
        Friction(friction::BadParameter),
    }

    impl core::fmt::Display for BadTip {
        fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
            match self {
                Self::Shape(bad) => bad.fmt(f),
                Self::Friction(bad) => bad.fmt(f),
            }
        }
    }

    impl core::error::Error for BadTip {}

    impl From<surfaces::BadShape> for BadTip {
        fn from(bad: surfaces::BadShape) -> Self {
            Self::Shape(bad)
        }
    }

    impl From<friction::BadParameter> for BadTip {
        fn from(bad: friction::BadParameter) -> Self {
            Self::Friction(bad)
        }
    }
}

pub mod slip_adaptive_drop {
    // scene: a fingertip as a type, in f64.
    //
    // Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
    //
    //   input        convention = "on_fingertip", sample_rate_Hz = 1000.0
    //   surface      sphere, a sphere, or a part of it around a pole; radius_m = 0.013
    //   friction     coulomb, one coefficient in all directions; static_coefficient = 0.5
    //   slip         adaptive_drop, the friction ratio falls suddenly, in noise that is learnt: hum, vibration,
    //                steps of a converter; false_alarms_per_minute = 1.0, noise_N = 0.01
    //
    // It needs neither heap nor standard library, and in Cargo.toml:
    //
    //   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision", "friction"] }
    //
    // With a standard library, "std" in the place of "libm".
    //
    // Once, and then for each sample, `time_step` seconds after the one before:
    //
    //     let (mut tip, mut last) = (tip()?, None);
    //
    //     let step = fingertip::Step::of(time_step).with_last(last);
    //     let touch = tip.sense_wrench(load(force, torque), step);
    //     last = touch.point();
    //
    // After a pause, `last = None` and `friction::SlipDetector::<f64>::reset(&mut tip.detector_mut().0)`.

    use fingertip::nalgebra::Vector3;
    use fingertip::{Absent, Fingertip, Present};
    use fingertip::{contact, friction, surfaces, wrench};

    /// The pipeline.
    pub type Tip = Fingertip<
        Absent,
        surfaces::Sphere<f64>,
        contact::PointContact<f64>,
        Present<friction::Coulomb<f64>>,
        Present<friction::AdaptiveDropDetector<f64>>,
    >;

    /// Makes the pipeline.
    ///
    /// # Errors
    /// Never for the numbers below.
    #[allow(clippy::approx_constant)]
    pub fn tip() -> Result<Tip, BadTip> {
        let surface = surfaces::Sphere::new(Vector3::zeros(), 0.013)?;
        let model = contact::PointContact::new(0.0)?;
        Ok(Fingertip::builder()
            .contact(surface, model)
            .friction(friction::Coulomb::new(0.5)?)
            .slip_detector(
                friction::AdaptiveDropDetector::new(friction::ForceNoise::isotropic(0.01)?, 1.0, 1000.0)?,
            )
            .build())
    }

    /// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.
    pub fn load(force: Vector3<f64>, torque: Vector3<f64>) -> wrench::Wrench<f64> {
        wrench::Wrench::on_fingertip(force, torque)
    }

    /// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
    #[derive(Clone, Debug, PartialEq)]
    pub enum BadTip {
        /// A shape, a contact model or an uncertainty.
        Shape(surfaces::BadShape),
        /// A friction, a detector or a grip.
        Friction(friction::BadParameter),
    }

    impl core::fmt::Display for BadTip {
        fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
            match self {
                Self::Shape(bad) => bad.fmt(f),
                Self::Friction(bad) => bad.fmt(f),
            }
        }
    }

    impl core::error::Error for BadTip {}

    impl From<surfaces::BadShape> for BadTip {
        fn from(bad: surfaces::BadShape) -> Self {
            Self::Shape(bad)
        }
    }

    impl From<friction::BadParameter> for BadTip {
        fn from(bad: friction::BadParameter) -> Self {
            Self::Friction(bad)
        }
    }
}
