//! Scene B alone.
#![no_std]
#![no_main]

fingertip_scenes::alone!(fingertip_scenes::SceneB, 6);
