//! The header of a scene for C.

use super::CLibrary;

const HEADER: &str = r#"/*
 * TITLE: a fingertip for C.
 *
 * Written by `fingertip export --c` (fingertip-scene VERSION). Change the scene and export it again rather than this.
 *
 * Units are SI. Wrenches are loads on the fingertip, points are in the sensor frame, normals point out of the fingertip.
 * A state belongs to the caller, is begun by NAME_init, and holds all memory of a fingertip: two fingertips are two
 * states. One thread at a time may use a state. Nothing allocatesHEAP_NOTE, and no sample can panic.UNTOLD
 */
#ifndef NAME_H
#define NAME_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct NAME_state {
    uint64_t bytes[WORDS];
} NAME_state;

/* How many numbers a sample has. */
#define NAME_INPUTS INPUTS
WARM_DEFINED
/* What NAME_sense returns beside the resolutions: the sample is left out, and the touch stays as it was. */
#define NAME_SATURATED 100u  /* A gauge reads at or beyond the range of its calibration. */
#define NAME_INCOMPLETE 101u /* A number is not finite. */
#define NAME_NULL 102u       /* A pointer is NULL. */

typedef struct NAME_touch {
    /*
     * 0: a contact. Else why there is none, and all but wrench and verdict is zero: 1 the wrench is not finite, 2 the force
     * is below the threshold, 3 its line misses the surface, 4 it pulls, 5 it meets the surface at a flatter angle than
     * friction holds, 6 it presses outside the active region, 7 there is a torque without a force, 8 two contacts are
     * possible, 9 none was found within the bound of the search, 10 no single contact gives this, 11 another reason.
     */
    uint32_t resolution;
    /* What the slip detector says: 0 it does not press (or there is no detector), 1 it holds, 2 slip is near, 3 it slips. */
    uint32_t slip;
    uint32_t has_margin;      /* 1 if margin and utilisation are known. */
    uint32_t alternatives;    /* Other points that would explain the wrench as well. */
    REAL force[3];            /* On the fingertip, N. */
    REAL torque[3];           /* N.m */
    REAL point[3];            /* Where it touches, m. */
    REAL normal[3];           /* Outward unit normal there. */
    REAL normal_force;        /* N, positive when pressing. */
    REAL tangential_force[3]; /* N */
    REAL spin_torque;         /* About the normal, N.m. */
    REAL gap;                 /* From the line of the force to the point, m. */
    REAL margin;              /* Distance to the friction limit, N, positive while it holds. */
    REAL utilisation;         /* How much of the limit is used, 1 at slip. */
GRIP_FIELD} NAME_touch;

/* Begins a fingertip: 0, or NAME_NULL.ZERO_NOTE */
uint32_t NAME_init(NAME_state *stateZERO_PARAMETER);

/*
 * Takes INPUT_NOTE, `time_step` seconds
 * after the sample before; a time that is not positive counts as none, and behind half a second the sample is the first.
 * Returns the resolution of the touch, or one of the numbers above.
 */
uint32_t NAME_sense(NAME_state *state, const REAL input[INPUTS], CELSIUS_PARAMETERREAL time_step, NAME_touch *touch);

/* Forgets the last contact and what the slip detector saw, as after a gap: 0, or NAME_NULL. */
uint32_t NAME_start_anew(NAME_state *state);

#ifdef __cplusplus
}
#endif

#endif
"#;

/// The header for a state of so many bytes.
pub(super) fn text(library: &CLibrary, state_bytes: usize) -> String {
    let with_zero = library.takes_gauges() && !library.is_warm;
    let chosen = |is: bool, text: &'static str| if is { text } else { "" };
    let input = if library.takes_gauges() {
        "the signals of the gauges, in the unit of the calibration"
    } else {
        "a wrench as the sensor reports it, Fx, Fy, Fz in N and Tx, Ty, Tz in N.m"
    };
    let untold = match library.untold() {
        [] => String::new(),
        sections => format!("\n *\n * What the scene says of [{}] is not told here.", sections.join("], [")),
    };
    let upper = library.name.to_uppercase();
    let parts = [
        ("TITLE", library.title.replace("*/", "* /")),
        ("VERSION", env!("CARGO_PKG_VERSION").to_owned()),
        ("HEAP_NOTE", chosen(library.needs_heap(), " but NAME_init, which calls malloc for the shape").to_owned()),
        ("UNTOLD", untold),
        ("WORDS", state_bytes.div_ceil(8).max(1).to_string()),
        ("WARM_DEFINED", chosen(library.is_warm, "#define NAME_TAKES_CELSIUS 1\n").to_owned()),
        ("GRIP_FIELD", chosen(library.has_grip, "    REAL grip_force;          /* The normal force to command next, N. */\n").to_owned()),
        (
            "ZERO_NOTE",
            chosen(
                with_zero,
                " `zero` is what the gauges read without load, or NULL for that of the\n * calibration; NAME_INCOMPLETE if it is not finite.",
            )
            .to_owned(),
        ),
        ("ZERO_PARAMETER", chosen(with_zero, ", const REAL zero[INPUTS]").to_owned()),
        ("INPUT_NOTE", input.to_owned()),
        ("CELSIUS_PARAMETER", chosen(library.is_warm, "REAL celsius, ").to_owned()),
        ("NAME_H", format!("{upper}_H")),
        ("NAME_INPUTS INPUTS", format!("{upper}_INPUTS {}", library.inputs())),
        ("NAME_INPUTS", format!("{upper}_INPUTS")),
        ("NAME_SATURATED", format!("{upper}_SATURATED")),
        ("NAME_INCOMPLETE", format!("{upper}_INCOMPLETE")),
        ("NAME_NULL", format!("{upper}_NULL")),
        ("NAME_TAKES_CELSIUS", format!("{upper}_TAKES_CELSIUS")),
        ("[INPUTS]", format!("[{}]", library.inputs())),
        ("NAME", library.name.clone()),
        ("REAL", library.scalar_in_c().to_owned()),
    ];
    parts.iter().fold(HEADER.to_owned(), |text, (place, part)| text.replace(place, part))
}
