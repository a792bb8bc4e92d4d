//! Plays a recorded session of each scene on a Cortex-M4F and prints, for every sample, a number
//! that stands for all bits of the answer; and what a sample costs: instructions and bytes of stack.
//!
//! Instructions are counted by SysTick in an emulator that lets a fixed time pass with each
//! (`-icount`); the ratio is measured first, on a loop of known length.
#![no_std]
#![no_main]

mod counter;
mod stack;

use core::hint::black_box;

use cortex_m_rt::entry;
use cortex_m_semihosting::{debug, hprintln};
use embedded_alloc::LlffHeap;
use fingertip_scenes::{
    GripLoad, GripOutcome, Grips, SAMPLES, Scene, SceneA, SceneB, SceneC, SceneD, SceneE, Volts, fold,
};

use crate::counter::Counter;

/// For the mesh of scene D.
#[global_allocator]
static HEAP: LlffHeap = LlffHeap::empty();
const HEAP_BYTES: usize = 48 * 1024;

#[panic_handler]
fn on_panic(_: &core::panic::PanicInfo<'_>) -> ! {
    debug::exit(debug::EXIT_FAILURE);
    loop {}
}

/// One sample of a scene. A function of its own, so that what is counted is what a caller pays.
#[inline(never)]
fn sense<S: Scene<N>, const N: usize>(scene: &mut S, volts: &Volts<N>, answer: &mut S::Answer) {
    *answer = scene.sense(volts);
}

/// The same call without its work.
#[inline(never)]
fn nothing<S: Scene<N>, const N: usize>(scene: &mut S, volts: &Volts<N>, answer: &mut S::Answer) {
    black_box((scene, volts, answer));
}

fn play<S: Scene<N>, const N: usize>(counter: &Counter)
where
    S::Answer: Default,
{
    let (Some(mut scene), Some(mut again)) = (S::new(), S::new()) else {
        hprintln!("scene {} cannot be built", S::NAME);
        return;
    };
    let mut answer = S::Answer::default();
    let first = S::volts(&S::session()[0]);
    let call = counter.instructions(|| nothing(black_box(&mut scene), black_box(&first), &mut answer));
    let mut counts = [0_u32; SAMPLES];
    for (index, (sums, count)) in S::session().iter().zip(&mut counts).enumerate() {
        let volts = S::volts(sums);
        *count = counter
            .instructions(|| sense(black_box(&mut scene), black_box(&volts), black_box(&mut answer)))
            .saturating_sub(call);
        hprintln!("bits {} {} {:08x}", S::NAME, index, fold(&answer));
    }
    let stack = stack::used(|| {
        for sums in S::session() {
            sense(black_box(&mut again), black_box(&S::volts(sums)), black_box(&mut answer));
        }
    });
    counts.sort_unstable();
    hprintln!("cost {} {} {} {}", S::NAME, counts[SAMPLES / 2], counts[SAMPLES - 1], stack);
}

/// The least grip from that of the sample before.
#[inline(never)]
fn grip(grips: &mut Grips<f32>, load: &GripLoad<f32>, outcome: &mut GripOutcome<f32>) {
    *outcome = grips.warm(load);
}

/// The least grip of five soft fingers: the first from nothing, all others from the one before.
fn play_grips(counter: &Counter) {
    let (Some(mut grips), Some(mut again)) = (Grips::<f32>::new(), Grips::<f32>::new()) else {
        hprintln!("the grasp cannot be built");
        return;
    };
    let load = grips.next_load();
    let mut outcome = grips.warm(&load);
    let cold = counter.instructions(|| outcome = again.warm(black_box(&load)));
    hprintln!("bits grip 0 {:08x}", fold(&outcome));
    let mut counts = [0_u32; SAMPLES];
    for (index, count) in counts.iter_mut().enumerate() {
        let load = grips.next_load();
        *count =
            counter.instructions(|| grip(black_box(&mut grips), black_box(&load), black_box(&mut outcome)));
        hprintln!("bits grip {} {:08x}", index + 1, fold(&outcome));
    }
    let stack = stack::used(|| grip(black_box(&mut again), black_box(&load), black_box(&mut outcome)));
    counts.sort_unstable();
    hprintln!("cost grip {} {} {} {}", counts[SAMPLES / 2], counts[SAMPLES - 1], stack, cold);
}

#[entry]
fn main() -> ! {
    let Some(peripherals) = cortex_m::Peripherals::take() else {
        debug::exit(debug::EXIT_FAILURE);
        loop {}
    };
    let room = core::ptr::addr_of_mut!(HEAP_ROOM);
    // SAFETY: called once, with memory that nothing else uses.
    unsafe { HEAP.init(room as usize, HEAP_BYTES) };
    let counter = Counter::new(peripherals.SYST);
    hprintln!("ticks {}", counter.ticks_per_thousand());
    play::<SceneA, 6>(&counter);
    play::<SceneB, 6>(&counter);
    play::<SceneC, 8>(&counter);
    play::<SceneD, 8>(&counter);
    play::<SceneE, 6>(&counter);
    play_grips(&counter);
    debug::exit(debug::EXIT_SUCCESS);
    loop {}
}

static mut HEAP_ROOM: [core::mem::MaybeUninit<u8>; HEAP_BYTES] =
    [core::mem::MaybeUninit::uninit(); HEAP_BYTES];
