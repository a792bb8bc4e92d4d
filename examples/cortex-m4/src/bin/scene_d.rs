//! Scene D alone.
#![no_std]
#![no_main]

fingertip_scenes::alone!(fingertip_scenes::SceneD, 8);
