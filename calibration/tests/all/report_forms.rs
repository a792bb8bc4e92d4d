//! A report in its three forms, word by word.

use fingertip_calibration::Axis;
use fingertip_calibration::file::Verdict;
use fingertip_calibration::report::{
    AxisReport, ContactReport, Exclusion, LineReport, Mistake, Outlier, Report, SampleReport, Suspicion,
};

fn axis(axis: Axis, full_scale: f64, some: Option<f64>) -> AxisReport {
    AxisReport {
        axis,
        full_scale,
        rms: 0.01 * full_scale,
        rms_percent: 1.0,
        greatest_percent: 2.5,
        greatest_at: "b".to_owned(),
        left_out_percent: some,
        left_out_greatest_percent: some.map(|x| 2.0 * x),
        deviation_percent: Some(0.125),
        linearity_percent: None,
        hysteresis_percent: some.map(|x| 3.0 * x),
        repeatability_percent: None,
        zero_return_percent: None,
        creep_percent: Some(0.0625),
    }
}

fn sample(name: &str, applied: [f64; 2], errors: [f64; 2], left_out: Option<[f64; 2]>) -> SampleReport {
    let measured = vec![applied[0] + errors[0], applied[1] + errors[1]];
    let left_out = left_out.map(|errors| vec![applied[0] + errors[0], applied[1] + errors[1]]);
    SampleReport { name: name.to_owned(), applied: applied.to_vec(), measured, left_out }
}

/// Two axes; three samples of errors of −5, 0 and 2.5 % of the first.
pub(crate) fn report() -> Report {
    Report {
        method: "a & b".to_owned(),
        verdict: Verdict::Suspect,
        reasons: vec!["one <reason>".to_owned(), "another".to_owned()],
        notes: vec!["mind".to_owned()],
        samples: 3,
        cases: 2,
        coefficients: 4,
        condition_number: Some(3.456),
        axes: vec![axis(Axis::Fx, 8.0, Some(1.5)), axis(Axis::Tz, 0.012_345, None)],
        cross_talk_percent: vec![vec![None, Some(0.5)], vec![Some(1.0), None]],
        matrix: Some(vec![vec![1.234_56, -0.5], vec![0.0, 123.4]]),
        matrix_deviations: Some(vec![vec![0.012_3, 0.5], vec![1.5e-5, 12.0]]),
        creep: None,
        curve: None,
        lines: Some(LineReport { lines: 5, median_mm: 0.25, greatest_mm: 1.5, expected_mm: Some(0.375) }),
        contacts: Some(ContactReport {
            surface: "a \"ball\"".to_owned(),
            touches: 7,
            force: 2.0,
            calibration_mm: 0.5,
            reading_mm: 0.25,
            together_mm: 0.75,
            worst_mm: 1.25,
        }),
        excluded: vec![Exclusion { sample: "d<".to_owned(), reason: "saturated".to_owned() }],
        outliers: vec![Outlier {
            index: 1,
            sample: "b".to_owned(),
            response: "gauge 1".to_owned(),
            deviations: 7.25,
            chance: 1e-4,
        }],
        outlier_influence_percent: Some(0.5),
        needed_cases: vec!["c".to_owned()],
        suspicions: vec![],
        details: [
            sample("a", [-4.0, 0.0], [0.2, 0.0], Some([0.4, 0.0])),
            sample("b", [8.0, 0.0], [-0.4, 0.0], Some([-0.2, 0.0])),
            sample("c", [2.0, 0.012], [0.0, 0.0], None),
        ]
        .into_iter()
        .collect(),
    }
}

#[test]
fn terminal_says_all_of_it() {
    let expected = "\
Calibration: SUSPECT
  because one <reason>
  because another
  note: mind
a & b: 3 samples in 2 load cases, 4 coefficients each; condition number N_c = 3.46

Errors, % of full scale (– where these loads do not tell):
                     Fx       Tz
    full scale   8.0000   0.0123   N, N·m
           RMS    1.000    1.000
      greatest    2.500    2.500
  left out RMS    1.500        –
  left out max    3.000        –
   one reading    0.125    0.125
    hysteresis    4.500        –
         creep    0.062    0.062

Cross-talk, % of full scale: false reading (row) under a load (column) alone:
            Fx        –    0.500
            Tz    1.000        –

Lines of action (5 pure forces): off by 0.250 mm in the median, 1.500 mm at most; 0.375 mm expected of the covariance

Contact points on a \"ball\" under 2.000 N, expected of the covariance (7 touches):
  off by 0.500 mm because of the matrix, 0.250 mm because of the noise of one reading,
  0.750 mm in all (root mean square), 1.250 mm where it is worst
left out: d<: saturated
";
    assert_eq!(report().to_string(), expected);
}

/// What is not known is not said.
#[test]
fn terminal_leaves_out_what_there_is_not() {
    let expected = "\
Calibration: GOOD
a & b: 3 samples in 2 load cases; singular

Errors, % of full scale (– where these loads do not tell):
                     Tz
    full scale   0.0123   N, N·m
           RMS    1.000
      greatest    2.500
   one reading    0.125
         creep    0.062

Lines of action (5 pure forces): off by 0.250 mm in the median, 1.500 mm at most
";
    let lines = report().lines.map(|lines| LineReport { expected_mm: None, ..lines });
    let short = Report {
        verdict: Verdict::Good,
        reasons: vec![],
        notes: vec![],
        coefficients: 0,
        condition_number: None,
        axes: report().axes.split_off(1),
        cross_talk_percent: vec![vec![None]],
        lines,
        contacts: None,
        excluded: vec![],
        ..report()
    };
    assert_eq!(short.to_string(), expected);
    for (verdict, word) in [(Verdict::Bad, "BAD"), (Verdict::Unchecked, "unchecked")] {
        let text = Report { verdict, ..report() }.to_string();
        assert!(text.starts_with(&format!("Calibration: {word}\n")), "{text}");
    }
}

#[test]
fn json_has_every_field() {
    let json: serde_json::Value = serde_json::from_str(&report().to_json().unwrap()).unwrap();
    assert_eq!(json["verdict"], "suspect");
    assert_eq!(json["axes"][1]["full_scale"], 0.012_345);
    assert_eq!(json["axes"][1]["left_out_percent"], serde_json::Value::Null);
    assert_eq!(json["cross_talk_percent"][1][0], 1.0);
    assert_eq!(json["lines"]["greatest_mm"], 1.5);
    assert_eq!(json["contacts"]["touches"], 7);
    assert_eq!(json["outliers"][0]["deviations"], 7.25);
    assert_eq!(json["details"][0]["left_out"][0], -3.6);
    assert_eq!(json["excluded"][0]["reason"], "saturated");
}

/// The page without its plots.
fn page(report: &Report) -> String {
    let html = report.to_html("Tip <7> & \"co\"", &[]);
    let (body, rest) = html.split_once("<main>").unwrap().1.split_once("</main>").unwrap();
    // The script reads points, where there are plots.
    assert_eq!(rest.matches("<script>").count(), 1, "{rest}");
    // A plot has another one within, which is what is cut at its frame.
    let mut plots = body.split("<svg viewBox");
    let first = plots.next().unwrap().to_owned();
    plots.fold(first, |text, plot| text + plot.rsplit_once("</svg>").unwrap().1)
}

#[test]
fn page_says_all_of_it() {
    let expected = "\
<h1>Tip &lt;7&gt; &amp; &quot;co&quot;</h1><p class=\"lead\">This calibration is <b class=\"suspect\">suspect</b>.</p>
<h2>Why</h2><ul><li>one &lt;reason&gt;</li><li>another</li></ul>
<h2>Mind</h2><ul><li>mind</li></ul>
<p>Method: a &amp; b; 3 samples in 2 load cases, 4 coefficients each; condition number N<sub>c</sub> = 3.46.</p>
<h2 id=\"Errorsoffullscale\">Errors, % of full scale</h2>
<section><table><thead><tr><th scope=\"col\"></th><th scope=\"col\">Fx</th><th scope=\"col\">Tz</th></tr></thead><tbody>\
<tr><th scope=\"row\">full scale</th><td>8.000\u{a0}N</td><td>0.01235 N·m</td></tr>\
<tr><th scope=\"row\">RMS</th><td>1.000</td><td>1.000</td></tr>\
<tr><th scope=\"row\">greatest</th><td>2.500</td><td>2.500</td></tr>\
<tr><th scope=\"row\">left out, RMS</th><td>1.500</td><td>–</td></tr>\
<tr><th scope=\"row\">left out, greatest</th><td>3.000</td><td>–</td></tr>\
<tr><th scope=\"row\">one reading</th><td>0.125</td><td>0.125</td></tr>\
<tr><th scope=\"row\">hysteresis</th><td>4.500</td><td>–</td></tr>\
<tr><th scope=\"row\">creep</th><td>0.062</td><td>0.062</td></tr></tbody></table></section>
<p class=\"small\"><b>RMS</b>: root mean square of the error on these loads. \
<b>greatest</b>: greatest error on these loads. \
<b>left out, RMS</b>: each load case predicted by a fit without it. \
<b>left out, greatest</b>: the same, greatest. \
<b>one reading</b>: standard deviation of one reading, from what the fit leaves. \
<b>hysteresis</b>: greatest difference between rising and falling load. \
<b>creep</b>: greatest change of the reading while a load is held. \
A dash: these loads do not tell.</p>
<h2 id=\"Crosstalkoffullscale\">Cross-talk, % of full scale</h2>
<p class=\"small\">Greatest false reading of an axis (row) under loads of another one alone (column).</p>
<section><table><thead><tr><th scope=\"col\"></th><th scope=\"col\">Fx</th><th scope=\"col\">Tz</th></tr></thead><tbody>\
<tr><th scope=\"row\">Fx</th><td style=\"background:color-mix(in srgb, var(--alarm) 0%, transparent)\">–</td>\
<td style=\"background:color-mix(in srgb, var(--alarm) 18%, transparent)\">0.500</td></tr>\
<tr><th scope=\"row\">Tz</th><td style=\"background:color-mix(in srgb, var(--alarm) 35%, transparent)\">1.000</td>\
<td style=\"background:color-mix(in srgb, var(--alarm) 0%, transparent)\">–</td></tr></tbody></table></section>
<h2 id=\"Wheretouchesarefound\">Where touches are found</h2>
<p>Lines of action of the 5 pure forces of these loads: off by <b>0.250\u{a0}mm</b> in the median \
(0.375\u{a0}mm expected of the covariance), 1.500\u{a0}mm at most.</p>
<p>Contact points on a &quot;ball&quot; under 2.000\u{a0}N, expected of the covariance (7 touches all over it): off by \
<b>0.750\u{a0}mm</b> (root mean square), 1.250\u{a0}mm where it is worst. Of that, 0.500\u{a0}mm come of the matrix, \
which no averaging mends, and 0.250\u{a0}mm of the noise of one reading.</p>
<h2 id=\"Thematrix\">The matrix</h2>
<p class=\"small\">Signal of each gauge (row) under the full scale of each axis (column), and its standard deviation.</p>
<section><table><thead><tr><th scope=\"col\"></th><th scope=\"col\">Fx</th><th scope=\"col\">Tz</th></tr></thead><tbody>\
<tr><th scope=\"row\">gauge\u{a0}1</th><td>1.235 ±\u{a0}0.012</td><td>-0.50 ±\u{a0}0.50</td></tr>\
<tr><th scope=\"row\">gauge\u{a0}2</th><td>0.000000 ±\u{a0}0.000015</td><td>123 ±\u{a0}12</td></tr></tbody></table></section>
<h2 id=\"Samplesleftout\">Samples left out</h2>
<section><table><thead><tr><th scope=\"col\">sample</th><th scope=\"col\">why</th></tr></thead><tbody>\
<tr><th scope=\"row\">d&lt;</th><td class=\"word\">saturated</td></tr></tbody></table></section>
<h2 id=\"Plots\">Plots</h2>
<div class=\"columns\">\
<figure><h2>Fx: error over load</h2>KEYS</figure>\
<figure><h2>Fx: error, sample after sample</h2>KEYS</figure>\
<figure><h2>Tz: error over load</h2>KEYS</figure>\
<figure><h2>Tz: error, sample after sample</h2>KEYS</figure></div>
";
    let keys = "<p class=\"keys\"><span><i class=\"a spot\"></i>loads of the fit</span>\
        <span><i class=\"d square\"></i>the same loads, left out of the fit</span></p>";
    assert_eq!(page(&report()), expected.replace("KEYS", keys));
}

#[test]
fn page_leaves_out_what_there_is_not() {
    let mut short = Report {
        verdict: Verdict::Good,
        reasons: vec![],
        notes: vec![],
        coefficients: 0,
        condition_number: None,
        cross_talk_percent: vec![vec![None; 2]; 2],
        matrix_deviations: None,
        lines: None,
        contacts: None,
        excluded: vec![],
        ..report()
    };
    short.details.left_out = None;
    let text = page(&short);
    assert!(
        text.contains("3 samples in 2 load cases; condition number N<sub>c</sub> = infinite (singular).</p>")
    );
    assert!(text.contains("</i>these loads</span></p>"));
    for absent in
        ["Why", "Mind", "Cross-talk", "Where touches", "The matrix", "Samples left out", "left out of"]
    {
        assert!(!text.contains(&format!(">{absent}")) && !text.contains("the same loads"), "{absent}");
    }
    let lines = report().lines.map(|lines| LineReport { expected_mm: None, ..lines });
    let text = page(&Report { lines, contacts: None, ..report() });
    assert!(text.contains("<b>0.250\u{a0}mm</b> in the median, 1.500\u{a0}mm at most."), "{text}");
    let text = page(&Report { lines: None, ..report() });
    assert!(text.contains("Where touches are found") && !text.contains("Lines of action"));
}

#[test]
fn outliers_and_suspicions_are_put_into_words() {
    let outlier = report().outliers.remove(0);
    assert_eq!(
        outlier.to_string(),
        "outlier: gauge 1 is off by 7.2 standard deviations of the others (chance 1e-4)"
    );
    let hidden = Outlier { chance: 0.01, ..outlier };
    assert_eq!(hidden.to_string(), "outlier: gauge 1 is off by 7.2 standard deviations of the others");
    let words = |mistake: Mistake, outliers_aside: bool| {
        Suspicion { mistake, before_percent: 12.345, after_percent: 0.5, outliers_aside }.to_string()
    };
    for (mistake, text) in [
        (Mistake::Transposed, "the matrix seems to be transposed"),
        (Mistake::Inverted, "the matrix seems to be the inverse of what is meant"),
        (Mistake::TransposedAndInverted, "the matrix seems to be transposed and inverted"),
        (
            Mistake::Axes { reads: vec![(Axis::Fy, true), (Axis::Fx, false)] },
            "axes or signs seem to be exchanged: the sensor gives −Fy, Fx",
        ),
        (Mistake::Gauges { first: 2, second: 5 }, "gauges 2 and 5 seem to be exchanged"),
        (
            Mistake::Unit { axes: vec![Axis::Tx, Axis::Ty], factor: 25.4, confusion: "inch and millimetre" },
            "Tx, Ty too large by a factor of 25.400000: inch and millimetre seem to be confused",
        ),
    ] {
        let figures = "(12.35 % of full scale as it is, 0.50 % if mended";
        assert_eq!(words(mistake.clone(), false), format!("{text} {figures})"));
        assert_eq!(words(mistake, true), format!("{text} {figures}, outliers aside)"));
    }
}
