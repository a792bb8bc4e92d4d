//! Plays the five scenes and the least grip of a hand, and prints one number per sample that stands for all bits of the answer:
//! `bits a 17 9f1c03d2`. With `--answers`, the answers themselves.

use fingertip_scenes::{Grips, SAMPLES, Scene, SceneA, SceneB, SceneC, SceneD, SceneE, fold};

fn play<S: Scene<N>, const N: usize>(verbose: bool)
where
    S::Answer: std::fmt::Debug,
{
    let Some(mut scene) = S::new() else {
        println!("scene {} cannot be built", S::NAME);
        return;
    };
    for (index, sums) in S::session().iter().enumerate() {
        let answer = scene.sense(&S::volts(sums));
        println!("bits {} {index} {:08x}", S::NAME, fold(&answer));
        if verbose {
            println!("{answer:?}");
        }
    }
}

fn play_grips(verbose: bool) {
    let Some(mut grips) = Grips::<f32>::new() else {
        println!("the grasp cannot be built");
        return;
    };
    for index in 0..=SAMPLES {
        let load = grips.next_load();
        let outcome = grips.warm(&load);
        println!("bits grip {index} {:08x}", fold(&outcome));
        if verbose {
            println!("{outcome:?}");
        }
    }
}

fn main() {
    let verbose = std::env::args().any(|argument| argument == "--answers");
    play::<SceneA, 6>(verbose);
    play::<SceneB, 6>(verbose);
    play::<SceneC, 8>(verbose);
    play::<SceneD, 8>(verbose);
    play::<SceneE, 6>(verbose);
    play_grips(verbose);
}
