//! Plays the five scenes and prints one number per sample that stands for all bits of the answer:
//! `bits a 17 9f1c03d2`. With `--answers`, the answers themselves.

use fingertip_scenes::{Scene, SceneA, SceneB, SceneC, SceneD, SceneE, fold};

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

fn main() {
    let verbose = std::env::args().any(|argument| argument == "--answers");
    play::<SceneA, 6>(verbose);
    play::<SceneB, 6>(verbose);
    play::<SceneC, 8>(verbose);
    play::<SceneD, 8>(verbose);
    play::<SceneE, 6>(verbose);
}
