//! Scene E alone.
#![no_std]
#![no_main]

fingertip_scenes::alone!(fingertip_scenes::SceneE, 6);
