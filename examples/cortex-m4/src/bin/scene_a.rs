//! Scene A alone.
#![no_std]
#![no_main]

fingertip_scenes::alone!(fingertip_scenes::SceneA, 6);
