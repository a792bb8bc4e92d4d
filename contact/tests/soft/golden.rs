//! Reference solutions computed with 40 to 50 digits.

use fingertip_contact::{ContactModel, Hertz, SoftFinger, SoftFingerSurface};
use fingertip_surfaces::{Ellipsoid, SmoothSurface, Sphere};
use fingertip_test_support::Worst;
use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;

use crate::shapes::conditioning;
use crate::wrenches::Case;

/// Semi-axes, force, torque, contact and `K`, where the spin torque is `K |∇S|/2` for
/// `S = Σ (x_i/a_i)² − 1`.
struct Golden {
    axes: [f64; 3],
    force: [f64; 3],
    torque: [f64; 3],
    contact: [f64; 3],
    k: f64,
}

const SPHERES: [Golden; 12] = [
    Golden {
        axes: [1.0, 1.0, 1.0],
        force: [-0.232388584725757, 0.8457943500814411, 0.480236882235707],
        torque: [0.0, 0.0, 0.0],
        contact: [0.232388584725757, -0.8457943500814411, -0.480236882235707],
        k: 0.0,
    },
    Golden {
        axes: [0.013, 0.013, 0.013],
        force: [-2.7471276139525904e-07, -5.960774770476802e-08, 9.59676932691495e-07],
        torque: [3.571369295714937e-21, 7.744871298557076e-22, -1.2475800124989432e-20],
        contact: [0.003571265898138368, 0.0007749007201619843, -0.012475800124989434],
        k: 1.6900004876881293e-22,
    },
    Golden {
        axes: [1e-06, 1e-06, 1e-06],
        force: [380244.42424791027, -905881.1714887974, 186530.1074101964],
        torque: [-0.0003802444242479103, 0.0009058811714887974, -0.00018653010741019637],
        contact: [-3.802444242479102e-07, 9.058811714887973e-07, -1.8653010741019636e-07],
        k: 1e-09,
    },
    Golden {
        axes: [1000.0, 1000.0, 1000.0],
        force: [-0.0005669856369859152, -0.00013350224191704835, 0.000812837276984021],
        torque: [0.5669856369859152, 0.1335022419170483, -0.812837276984021],
        contact: [566.9856369859152, 133.5022419170483, -812.837276984021],
        k: 1000.0000000000001,
    },
    Golden {
        axes: [1.0, 1.0, 1.0],
        force: [-0.18753480811841255, -0.9837877196368984, -0.29494477183978346],
        torque: [0.27956811067438836, -0.021299128438861448, -0.10671465982562012],
        contact: [0.2626030398002756, 0.8085484896940753, 0.5265823613653277],
        k: -7.459989484945482e-19,
    },
    Golden {
        axes: [0.013, 0.013, 0.013],
        force: [-5.192617959448686e-07, 2.523147256602942e-07, -8.698876171592974e-07],
        torque: [1.0871039640625943e-09, -3.3733955230662012e-09, -1.6273928893405896e-09],
        contact: [0.0031241405170394886, -0.004652103362309253, 0.011730203763625897],
        k: 1.7644044943572413e-22,
    },
    Golden {
        axes: [1e-06, 1e-06, 1e-06],
        force: [305216.6662922384, 667034.0470230769, 742905.3551627342],
        torque: [0.2719098545957976, 0.014286248478889874, -0.12594452778144713],
        contact: [-3.665642230104401e-07, -3.9135325610897944e-07, -8.440813345535203e-07],
        k: 1.0440306508910143e-09,
    },
    Golden {
        axes: [1000.0, 1000.0, 1000.0],
        force: [0.0004492246940557574, 0.000856261556063095, -0.0003937173121148203],
        torque: [-0.5751817447100425, -0.593330723892489, 0.705070643721271],
        contact: [-311.7485122224511, -718.3454823994788, 621.9265495565761],
        k: 1044.0306508910555,
    },
    Golden {
        axes: [1.0, 1.0, 1.0],
        force: [-1.3345894932942037, -0.36649204479691777, 0.2907825054732398],
        torque: [0.2869326277045293, -0.9505449316624078, 0.11888650070332807],
        contact: [0.7837101866731876, 0.30429585395801834, 0.5414816493369261],
        k: 5.3702075096189463e-17,
    },
    Golden {
        axes: [0.013, 0.013, 0.013],
        force: [-4.879896122241908e-07, -6.217182710923518e-07, -1.172745722546546e-06],
        torque: [-2.7799847131367274e-09, -1.0704986494820183e-08, 6.831906698751345e-09],
        contact: [-0.005228941691910155, 0.007338226102968422, 0.009370624656036365],
        k: 2.3899136790407926e-22,
    },
    Golden {
        axes: [1e-06, 1e-06, 1e-06],
        force: [626814.9593677117, 268893.1809869127, -1238870.23692217],
        torque: [0.0111210149443006, 0.9757623578727254, 0.21855467047232818],
        contact: [3.2040546567594384e-07, -2.0914182882684746e-07, 9.239047748550405e-07],
        k: 1.4142135623731114e-09,
    },
    Golden {
        axes: [1000.0, 1000.0, 1000.0],
        force: [0.000811352512081313, -0.0009926694719984597, -0.0005969207824340195],
        torque: [0.09849853228598118, 1.6989530861187916, -0.32226766872421575],
        contact: [165.4977825476822, 899.5072074611276, 404.3479537444008],
        k: 1414.2135623730949,
    },
];

const ELLIPSOIDS: [Golden; 12] = [
    Golden {
        axes: [0.01573773620209012, 0.3214740444687981, 0.241461330337791],
        force: [-0.6156959757784071, 12.7148538508494, -15.458117932560564],
        torque: [-5.466918427090344, -0.159236726338782, 0.08676916415275734],
        contact: [-0.003226978358982146, 0.20756952683586338, 0.17760992210735568],
        k: 1.491043840691199e-18,
    },
    Golden {
        axes: [0.16567763025264187, 0.034046477509290095, 0.025389861121212786],
        force: [6.123500722020899e-06, 1.595195667340067e-05, 1.0442117467130764e-05],
        torque: [-1.2550913877121377e-07, 1.7123679408846756e-06, -2.542306575614947e-06],
        contact: [-0.16098059411856339, -0.004188598676559086, 0.005126098386564416],
        k: 3.1556758815734443e-19,
    },
    Golden {
        axes: [0.10101219598123026, 0.5130321953834095, 0.14224211299287276],
        force: [5285121.057019735, -13012751.775290469, 14273604.542907912],
        torque: [-256091.30454750077, 1602993.3684706853, 1555497.4091568692],
        contact: [-0.09353267500108049, -0.06351216496717511, 0.050747318223076925],
        k: 1080.6475169015569,
    },
    Golden {
        axes: [0.002751900050184257, 0.618369251495426, 0.01030354644156779],
        force: [0.005370451064191949, 0.008360969582994102, -0.017385408910904773],
        torque: [-0.018104889403397797, -9.042828617973952e-06, -0.004884797084874531],
        contact: [-0.0016573882973442424, 0.35278328260259156, -0.005753340837158147],
        k: 5.4920575607681496e-05,
    },
    Golden {
        axes: [0.012837792518193955, 0.41291269747904785, 0.11366783694902548],
        force: [-0.9871710444949024, 0.05431459400778176, -0.1501441100696704],
        torque: [0.04158608088058152, -0.061183198050383275, -0.29555415421188386],
        contact: [0.005265077498055017, -0.2996847673039076, 0.06277910881947127],
        k: -1.5992878690178492e-19,
    },
    Golden {
        axes: [0.0034845697418389885, 0.004012711002348356, 0.0013043184626706744],
        force: [1.2845654918896313e-07, 4.360083402476179e-07, -8.907275914694576e-07],
        torque: [2.6044523574166395e-09, -5.563376407065309e-10, 1.0327636855991379e-10],
        contact: [-0.0007263578135792521, -0.0032693890341326548, 0.0007056806811487631],
        k: 8.616584690256045e-24,
    },
    Golden {
        axes: [0.04690495540746323, 0.028426477680530332, 0.0026122966258697897],
        force: [-20241.887586357334, -82613.4374895366, 996376.0765559878],
        torque: [18160.071556813946, -12175.374759027041, -687.6523895767104],
        contact: [0.01226157935491619, 0.01838039085220146, -0.0018720878298073664],
        k: 0.17035731154994962,
    },
    Golden {
        axes: [0.6794607283615831, 0.10242838576906242, 0.0023792464787975366],
        force: [3.7388368933930826e-06, 1.2386508990448715e-05, 0.0009999162942435301],
        torque: [-3.7598794960383344e-05, 0.00045748828824200745, -0.0006850441775362686],
        contact: [-0.4659491501320021, -0.035080264798192554, -0.001527973421060983],
        k: 2.517045559704559e-06,
    },
    Golden {
        axes: [0.13239014822399253, 0.06225073128070337, 0.9766045318128109],
        force: [-0.6930269073887285, 0.7601397425063307, 0.1786092872658746],
        torque: [0.2756563072309255, 0.23300569809154809, 0.07793741840482656],
        contact: [0.11758248007849957, -0.016509745297496877, -0.3665182669608046],
        k: -1.8351615440172336e-18,
    },
    Golden {
        axes: [0.16973697970601487, 0.009263288881334054, 0.012721937057426082],
        force: [-1.840289695689281e-07, 7.343126183909304e-07, 7.189703170724466e-07],
        torque: [1.2777714542968946e-09, 1.0107319569105843e-07, -1.0290296310756235e-07],
        contact: [-0.13922457104219124, -0.003633144296112744, -0.005297327409928935],
        k: 3.297833668240455e-21,
    },
    Golden {
        axes: [0.0022489493977020185, 0.0029841351434313733, 0.12798744548221477],
        force: [-851832.8210936101, -549446.6076811204, -249978.53950971595],
        torque: [-22574.883242776355, 35144.4559842446, 214.6071231926576],
        contact: [0.0018367296846430387, 0.0014376371033987755, -0.040654729950867476],
        k: 0.33622108342709445,
    },
    Golden {
        axes: [0.04082668556041531, 0.16874279097778, 0.037607800621787174],
        force: [0.0010187529293821038, 0.00011231327455363134, -0.00019881699433001938],
        torque: [-0.00015795304674827502, -3.24687355207161e-05, 5.83996697578625e-05],
        contact: [-0.035992840072343844, -0.07844629890802454, -0.0030691780926722367],
        k: 8.052991895333677e-06,
    },
];

/// Force, two relative radii, modulus; semi-axes, peak pressure and depth.
const HERTZ: [[f64; 8]; 4] = [
    [
        1.0,
        0.013,
        0.013,
        1000000.0,
        0.002136329340848959,
        0.002136329340848959,
        104617.6537441114,
        0.0003510694655824726,
    ],
    [
        10.0,
        0.05,
        0.01,
        2000000.0,
        0.007194654012470862,
        0.0024893437169867046,
        266591.68921132,
        0.0008274720706566892,
    ],
    [
        0.1,
        1.0,
        0.01,
        1000000000.0,
        0.0006800687594101139,
        3.7392912947488045e-05,
        1877583.5124065294,
        3.011582556977264e-07,
    ],
    [
        100.0,
        0.02,
        0.019999,
        500000.0,
        0.014422615893543062,
        0.014422135135673577,
        229544.97411585998,
        0.010400505787585635,
    ],
];

/// A case as this type can hold it, in f64 again.
fn rounded<T: Real>(v: &[f64; 3]) -> Vector3<f64> {
    Vector3::from(v.map(|x| T::literal(x).to_f64()))
}

/// The greatest error of the point over the cases, relative to the size of the surface, and of the
/// spin torque, relative to the largest that the wrench could hold; both over what is allowed: `least`,
/// or what a wrench that is wrong by a quarter of `ε` would bring about, if that is more. (One of
/// the ellipsoids, six times longer than thick and touched 1° from grazing, has a conditioning of
/// 55: rounding its wrench to `f32` alone moves the contact by 6e-7.)
fn greatest_error<T: Real, S: SoftFingerSurface<T> + SmoothSurface<T>>(
    cases: &[Golden],
    least: f64,
    shape: impl Fn(Vector3<T>) -> S,
) -> (f64, f64) {
    let vector = |v: &[f64; 3]| Vector3::from(v.map(T::literal));
    let mut worst = [Worst::new(); 2];
    for case in cases {
        let axes = Vector3::from(case.axes);
        let surface = shape(vector(&case.axes));
        let wrench = Wrench::on_fingertip(vector(&case.force), vector(&case.torque));
        let model = SoftFinger::new(T::zero()).unwrap().without_friction_limit();
        let contact = *model.resolve(&wrench, &surface).contact().expect("every case is a contact");
        let expected = Vector3::from(case.contact);
        let found = contact.point.map(Real::to_f64);
        let (force, torque) = (Vector3::from(case.force), Vector3::from(case.torque));
        let normal = expected.component_div(&axes.component_mul(&axes)).normalize();
        let spin = (torque - expected.cross(&force)).dot(&normal);
        let own = conditioning(&ellipsoid(axes), &Case::new(expected, normal, force, spin), axes.amax());
        let allowed = least.max(own * T::EPSILON.to_f64() / 4.0);
        for error in (found - expected).iter() {
            worst[0].see(error / axes.amax() / allowed);
        }
        let spin = case.k * expected.component_div(&axes.component_mul(&axes)).norm();
        let scale = Vector3::from(case.force).norm() * axes.amax() + Vector3::from(case.torque).norm();
        worst[1].see((contact.spin_torque.to_f64() - spin) / scale / allowed);
    }
    (worst[0].get(), worst[1].get())
}

fn sphere<T: Real>(axes: Vector3<T>) -> Sphere<T> {
    Sphere::centred(axes.x).unwrap()
}

fn ellipsoid<T: Real>(axes: Vector3<T>) -> Ellipsoid<T> {
    Ellipsoid::new(axes).unwrap()
}

#[test]
fn soft_fingers_in_double_precision() {
    let errors = [
        greatest_error::<f64, _>(&SPHERES, 1e-14, sphere),
        greatest_error::<f64, _>(&SPHERES, 1e-14, ellipsoid),
        greatest_error::<f64, _>(&ELLIPSOIDS, 1e-14, ellipsoid),
    ];
    println!("f64, in units of what is allowed: {errors:?}");
    assert!(errors.iter().all(|(point, spin)| *point <= 1.0 && *spin <= 1.0), "{errors:?}");
}

/// The printed solutions belong to inputs of 17 digits. So that the rounding of those to `f32` does not
/// count, the reference is the solution in `f64` (good to 1e-14, as above) of the rounded inputs; the
/// printed ones are compared with too.
#[test]
fn soft_fingers_in_single_precision() {
    fn case(golden: &Golden) -> Golden {
        let (axes, force, torque) =
            (rounded::<f32>(&golden.axes), rounded::<f32>(&golden.force), rounded::<f32>(&golden.torque));
        let wrench = Wrench::on_fingertip(force, torque);
        let found = SoftFinger::new(0.0).unwrap().without_friction_limit().resolve(&wrench, &ellipsoid(axes));
        let contact = found.contact().unwrap();
        let steepness = contact.point.component_div(&axes.component_mul(&axes)).norm();
        Golden {
            axes: axes.into(),
            force: force.into(),
            torque: torque.into(),
            contact: contact.point.into(),
            k: contact.spin_torque / steepness,
        }
    }
    let direct = greatest_error::<f32, _>(&ELLIPSOIDS, 4e-7, ellipsoid);
    let (spheres, ellipsoids) = (SPHERES.each_ref().map(case), ELLIPSOIDS.each_ref().map(case));
    let errors = [
        greatest_error::<f32, _>(&spheres, 4e-7, sphere),
        greatest_error::<f32, _>(&spheres, 4e-7, ellipsoid),
        greatest_error::<f32, _>(&ellipsoids, 4e-7, ellipsoid),
    ];
    println!("f32, in units of what is allowed: {errors:?}, with the rounding of the inputs {direct:?}");
    assert!(errors.iter().all(|(point, spin)| *point <= 1.0 && *spin <= 1.0), "{errors:?}");
    assert!(direct.0 <= 1.0 && direct.1 <= 1.0);
}

fn hertz_error<T: Real>() -> f64 {
    let mut worst = Worst::new();
    for [force, rx, ry, modulus, a, b, peak, depth] in HERTZ {
        let number = T::literal;
        let law = Hertz::new([number(ry), number(rx)], number(modulus)).unwrap();
        let found = law.indentation(number(force));
        let pressure = law.peak_pressure(number(force));
        for (got, expected) in
            [(found.patch[0], a), (found.patch[1], b), (pressure, peak), (found.depth, depth)]
        {
            worst.see(got.to_f64() / expected - 1.0);
        }
    }
    worst.get()
}

#[test]
fn hertz_in_both_precisions() {
    let (double, single) = (hertz_error::<f64>(), hertz_error::<f32>());
    println!("Hertz: f64 {double:e}, f32 {single:e}");
    assert!(double <= 1e-14 && single <= 4e-7, "{double:e} {single:e}");
}
