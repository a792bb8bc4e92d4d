//! The functions for C around the module of a scene.

use super::CLibrary;

const HEAD: &str = r#"//! A scene for C: what NAME.h declares.
#![no_std]
#![allow(missing_docs, non_upper_case_globals)]

#[allow(dead_code)]
mod scene;

use core::mem::MaybeUninit;

use fingertip::contact::Resolution;
use fingertip::nalgebra::Vector3;

#[repr(C)]
pub struct Touch {
    resolution: u32,
    slip: u32,
    has_margin: u32,
    alternatives: u32,
    force: [REAL; 3],
    torque: [REAL; 3],
    point: [REAL; 3],
    normal: [REAL; 3],
    normal_force: REAL,
    tangential_force: [REAL; 3],
    spin_torque: REAL,
    gap: REAL,
    margin: REAL,
    utilisation: REAL,
GRIP_FIELD}

pub struct State {
    tip: scene::Tip,
    last: Option<Vector3<REAL>>,
GRIP_STATE}

const fn layout() -> [u8; 64] {
    let mark = *b"MARK";
    let mut text = [b' '; 64];
    let mut at = 0;
    while at < mark.len() {
        text[at] = mark[at];
        at += 1;
    }
    let (mut rest, mut digits) = (size_of::<State>(), 1);
    while rest >= 10 {
        rest /= 10;
        digits += 1;
    }
    rest = size_of::<State>();
    let mut left = digits;
    while left > 0 {
        left -= 1;
        text[at + left] = b'0' + (rest % 10) as u8;
        rest /= 10;
    }
    text
}

/// Not linked unless it is asked for.
#[unsafe(no_mangle)]
pub static NAME_state_layout: [u8; 64] = layout();
const _: () = assert!(align_of::<State>() <= 8);

#[panic_handler]
fn on_panic(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {}
}

impl State {
    fn start_anew(&mut self) {
        self.last = None;
RESET    }
}

/// # Safety
/// As the header says of its pointers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn NAME_init(state: *mut MaybeUninit<State>ZERO_PARAMETER) -> u32 {
    // SAFETY: NULL, or memory of the size of a state.
    let Some(state) = (unsafe { state.as_mut() }) else { return NULL };
    let Ok(MUT_TIPtip) = scene::tip() else { return 1 };
ZERO_SET    state.write(State { tip, last: NoneGRIP_MAKE });
    0
}

/// # Safety
/// As the header says of its pointers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn NAME_start_anew(state: *mut State) -> u32 {
    // SAFETY: NULL, or a state that was begun.
    let Some(state) = (unsafe { state.as_mut() }) else { return NULL };
    state.start_anew();
    0
}

const SATURATED: u32 = 100;
const INCOMPLETE: u32 = 101;
const NULL: u32 = 102;

/// # Safety
/// As the header says of its pointers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn NAME_sense(
    state: *mut State,
    input: *const [REAL; INPUTS],
CELSIUS_PARAMETER    time_step: REAL,
    touch: *mut Touch,
) -> u32 {
    if touch.is_null() {
        return NULL;
    }
    // SAFETY: NULL, or a state that was begun.
    let Some(state) = (unsafe { state.as_mut() }) else { return NULL };
    // SAFETY: NULL, or as many numbers.
    let Some(&input) = (unsafe { input.as_ref() }) else { return NULL };
CHECK    let time_step = if time_step > 0.0 { time_step } else { 0.0 };
    if time_step > 0.5 {
        state.start_anew();
    }
    let step = fingertip::Step::of(time_step).with_last(state.last);
SENSE    state.last = felt.point();
GRIP_COMMAND    let (contact, why) = match &felt.resolution {
        Resolution::Contact(contact) => (Some(contact), 0),
        Resolution::NoContact(why) => (None, why.number()),
    };
    let force = felt.force.as_ref();
    let margin: Option<(REAL, REAL)> = MARGIN;
    let told = Touch {
        resolution: why,
        slip: SLIP,
        has_margin: u32::from(margin.is_some()),
        alternatives: contact.map_or(0, |contact| u32::from(contact.alternatives)),
        force: felt.wrench.force().into(),
        torque: felt.wrench.torque().into(),
        point: contact.map_or([0.0; 3], |contact| contact.point.into()),
        normal: contact.map_or([0.0; 3], |contact| contact.normal.into()),
        normal_force: force.map_or(0.0, |force| force.normal),
        tangential_force: force.map_or([0.0; 3], |force| force.tangential.vector().into()),
        spin_torque: force.map_or(0.0, |force| force.spin),
        gap: contact.map_or(0.0, |contact| contact.gap),
        margin: margin.map_or(0.0, |(margin, _)| margin),
        utilisation: margin.map_or(0.0, |(_, used)| used),
GRIP_TOLD    };
    // SAFETY: not NULL, so a touch of the caller, which is never read.
    unsafe { touch.write(told) };
    why
}
"#;

const HEAP: &str = r#"
/// C's own heap.
struct Heap;

unsafe extern "C" {
    fn malloc(bytes: usize) -> *mut u8;
    fn free(memory: *mut u8);
}

// SAFETY: memory of `malloc` lies as the layouts of numbers need it, and others get none.
unsafe impl core::alloc::GlobalAlloc for Heap {
    unsafe fn alloc(&self, layout: core::alloc::Layout) -> *mut u8 {
        // SAFETY: any size may be asked for.
        if layout.align() <= 8 { unsafe { malloc(layout.size()) } } else { core::ptr::null_mut() }
    }
    unsafe fn dealloc(&self, memory: *mut u8, _: core::alloc::Layout) {
        // SAFETY: it came from `malloc`.
        unsafe { free(memory) };
    }
}

#[global_allocator]
static HEAP: Heap = Heap;
"#;

/// `lib.rs` of the package.
pub(super) fn text(library: &CLibrary) -> String {
    let real = library.scalar_in_rust();
    let when = |is: bool, text: &str| if is { text.to_owned() } else { String::new() };
    let with_zero = library.takes_gauges() && !library.is_warm;
    let slip = if library.has_detector { "felt.slip" } else { "fingertip::friction::SlipVerdict::Holding" };
    // Before what stands within them.
    let parts = [
        ("GRIP_FIELD", when(library.has_grip, "    grip_force: REAL,\n")),
        ("GRIP_STATE", when(library.has_grip, "    grip: fingertip::friction::GripController<REAL>,\n")),
        ("GRIP_MAKE", when(library.has_grip, ", grip")),
        ("GRIP_TOLD", when(library.has_grip, "        grip_force,\n")),
        (
            "GRIP_COMMAND",
            when(
                library.has_grip,
                &format!(
                    "    let grip_force = match &felt.force {{\n        Some(force) => \
                     state.grip.command(&state.tip.friction().0, force, {slip}, time_step),\n        \
                     None => state.grip.present(),\n    }};\n"
                ),
            ),
        ),
        (
            "RESET",
            when(
                library.has_detector,
                "        fingertip::friction::SlipDetector::<REAL>::reset(&mut self.tip.detector_mut().0);\n",
            ),
        ),
        ("ZERO_PARAMETER", when(with_zero, ", zero: *const [REAL; INPUTS]")),
        ("MUT_TIP", when(with_zero, "mut ")),
        (
            "ZERO_SET",
            when(
                with_zero,
                "    // SAFETY: NULL, or as many numbers as there are gauges.\n    \
                 if let Some(&zero) = unsafe { zero.as_ref() } {\n        \
                     if !zero.iter().all(|gauge| gauge.is_finite()) {\n            return INCOMPLETE;\n        }\n        \
                     tip.set_zero(fingertip::wrench::Tare::new(zero.into()));\n    }\n",
            ) + &when(library.has_grip, "    let Ok(grip) = scene::grip() else { return 1 };\n"),
        ),
        ("CELSIUS_PARAMETER", when(library.is_warm, "    celsius: REAL,\n")),
        ("CHECK", check(library)),
        ("SENSE", sense(library)),
        (
            "MARGIN",
            if library.has_limit {
                "felt.grip.map(|margin| (margin.newtons, margin.utilisation))".to_owned()
            } else {
                "None".to_owned()
            },
        ),
        ("SLIP", if library.has_detector { "felt.slip as u32".to_owned() } else { "0".to_owned() }),
        ("INPUTS", library.inputs().to_string()),
        ("MARK", CLibrary::MARK.to_owned()),
        ("NAME", library.name.clone()),
        ("REAL", real.to_owned()),
    ];
    let text = parts.iter().fold(HEAD.to_owned(), |text, (place, part)| text.replace(place, part));
    text + &when(library.needs_heap(), HEAP)
}

/// What readings are left out.
fn check(library: &CLibrary) -> String {
    if !library.takes_gauges() {
        return String::new();
    }
    let celsius = if library.is_warm { " || !celsius.is_finite()" } else { "" };
    let mut text = format!(
        "    if !input.iter().all(|gauge| gauge.is_finite()){celsius} {{\n        return INCOMPLETE;\n    }}\n"
    );
    if let Some([low, high]) = library.range {
        text.push_str(&format!(
            "    if !input.iter().all(|gauge| *gauge > {low:?} && *gauge < {high:?}) {{\n        return SATURATED;\n    }}\n"
        ));
    }
    text
}

fn sense(library: &CLibrary) -> String {
    match (library.takes_gauges(), library.is_warm) {
        (false, _) => "    let [fx, fy, fz, tx, ty, tz] = input;\n    \
                       let load = scene::load(Vector3::new(fx, fy, fz), Vector3::new(tx, ty, tz));\n    \
                       let felt = state.tip.sense_wrench(load, step);\n"
            .to_owned(),
        (true, false) => "    let felt = state.tip.sense(&input.into(), step);\n".to_owned(),
        (true, true) => {
            "    let reading = fingertip::wrench::GaugesAndTemperature { gauges: input.into(), temperature: \
                         celsius };\n    let felt = state.tip.sense(&reading, step);\n"
                .to_owned()
        }
    }
}
