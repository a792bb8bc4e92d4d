//! Scene C alone.
#![no_std]
#![no_main]

fingertip_scenes::alone!(fingertip_scenes::SceneC, 8);
