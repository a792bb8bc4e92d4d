//! What a fingertip feels, live to the tools that people use: the browser, Foxglove and ROS 2.
//!
//! A [`Publisher`] gives every sample to a [`Hub`], without ever waiting. Each bridge reads from it at its own pace
//! through [`Subscription`]s: who is too slow misses the oldest samples, which is counted and told to him, and costs
//! nobody else anything. What people ask of the sensor, a new zero or to forget, comes back through
//! the hub, too.
//!
//! | feature | bridge |
//! |---|---|
//! | `web` | one page with the fingertip in 3-D, over HTTP and WebSocket |
//! | `foxglove` | the WebSocket of Foxglove, with the messages of recordings |
//! | `ros2` | topics and services of ROS 2 over DDS, and wrenches of other drivers as a source |
//!
//! Units are SI; wrenches are loads on the fingertip, points and directions are in the sensor frame.
//!
//! ```
//! use core::time::Duration;
//! use fingertip::wrench::Wrench;
//! use fingertip_bridges::{About, Hub, Sample};
//!
//! let hub = Hub::new(About::default());
//! let mut reader = hub.subscribe();
//! let mut publisher = hub.publisher();
//! publisher.publish(Sample::new(0.001, Wrench::zero(), None));
//! let mut samples = Vec::new();
//! let news = reader.wait(&mut samples, Duration::from_secs(1));
//! assert_eq!((samples.len(), samples[0].time, news.missed), (1, 0.001, 0));
//! ```

extern crate alloc;

mod about;
#[cfg(any(feature = "foxglove", feature = "ros2"))]
mod drawn;
mod hub;
#[cfg(feature = "recordings")]
pub mod messages;
mod parameter;
mod publisher;
mod sample;
mod status;
mod subscription;

#[cfg(feature = "foxglove")]
pub mod foxglove;
#[cfg(feature = "ros2")]
pub mod ros2;
#[cfg(feature = "web")]
pub mod web;

pub use about::{About, Net};
pub use hub::{Command, Hub, NoZero};
pub use parameter::{Parameter, Value};
pub use publisher::Publisher;
pub use sample::{Felt, Pressed, Sample};
pub use status::{Health, Status, Zero};
pub use subscription::{News, Subscription};
