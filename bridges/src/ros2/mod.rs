//! ROS 2 over DDS, without a ROS installation: topics, services and frames of a node, and wrenches of other drivers.
//!
//! | below the namespace | type | when |
//! |---|---|---|
//! | `wrench` | `geometry_msgs/msg/WrenchStamped` | every sample, as the sensor reports it, less its zero |
//! | `touch` | `fingertip_msgs/msg/Touch` | every sample, with a scene |
//! | `contact` | `tactile_msgs/msg/TactileContact` | every contact |
//! | `point` | `geometry_msgs/msg/PointStamped` | every contact |
//! | `markers` | `visualization_msgs/msg/MarkerArray` | 30 a second, the surface once a second |
//! | `tare`, `reset` | `std_srvs/srv/Trigger` | services |
//! | `live/get_parameters` and the other five | `rcl_interfaces` | services: what the scene says, to be read |
//! | `/tf`, `/tf_static` | `tf2_msgs/msg/TFMessage` | the frames of contact and surface |
//!
//! Topics of samples have the QoS of sensors, best effort, unless they are asked to be reliable. The node stays on
//! one network interface, loopback unless told otherwise: that is what it announces and where it looks
//! for others. The library's sockets are open to datagrams from elsewhere all the same; where that matters, a firewall
//! or a network namespace keeps them out.

mod callers;
mod frames;
mod markers;
mod node;
mod parameters;
mod publishing;
mod raw;
mod services;
mod source;

use alloc::sync::Arc;
use core::net::{IpAddr, Ipv4Addr};
use core::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread::{self, JoinHandle};

use thiserror::Error;

use crate::Hub;
use node::Participant;
pub use source::{WrenchSource, WrenchSourceError};

/// Where a node is.
///
/// ```
/// use fingertip_bridges::ros2::Options;
///
/// let options = Options { namespace: "/left/thumb".to_owned(), domain: 7, ..Options::default() };
/// // Nothing leaves this computer unless another interface is named.
/// assert!(options.interface.is_loopback());
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Options {
    /// The names of topics begin so, such as `/fingertip`.
    pub namespace: String,
    /// The domain, from 0 to 232.
    pub domain: u16,
    /// The address of the network interface that is used.
    pub interface: IpAddr,
    /// Whether samples are sent again until they arrive, rather than as sensors send them.
    pub reliable: bool,
    /// How services are mapped to DDS: as the middleware of those who call does it.
    pub services: Services,
}

/// How services are mapped to DDS: each middleware of ROS 2 has its own way.
///
/// ```
/// use fingertip_bridges::ros2::Services;
///
/// assert_eq!(Services::of("rmw_cyclonedds_cpp"), Services::Cyclone);
/// assert_eq!(Services::of("rmw_fastrtps_cpp"), Services::Enhanced);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Services {
    /// As `rmw_fastrtps_cpp`, the default of ROS 2, and `rmw_connextdds` do.
    #[default]
    Enhanced,
    /// As `rmw_cyclonedds_cpp` does.
    Cyclone,
}

impl Services {
    /// That of a middleware, as `RMW_IMPLEMENTATION` names it.
    #[must_use]
    pub fn of(middleware: &str) -> Self {
        if middleware.contains("cyclonedds") { Self::Cyclone } else { Self::Enhanced }
    }
}

impl Default for Options {
    fn default() -> Self {
        Self {
            namespace: "/fingertip".to_owned(),
            domain: 0,
            interface: Ipv4Addr::LOCALHOST.into(),
            reliable: false,
            services: Services::Enhanced,
        }
    }
}

/// Why there is no node.
///
/// ```
/// use fingertip_bridges::ros2::{Node, Options};
/// use fingertip_bridges::{About, Hub};
///
/// let hub = Hub::new(About::default());
/// let told = |options| Node::start(&hub, &options).unwrap_err().to_string();
/// let domain = told(Options { domain: 233, ..Options::default() });
/// assert_eq!(domain, "domain 233 is none; give one from 0 to 232");
/// let name = told(Options { namespace: "left thumb".to_owned(), ..Options::default() });
/// assert!(name.starts_with("“left thumb” is no name of ROS 2: it begins with a slash"), "{name}");
/// ```
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum NodeError {
    /// The domain is none.
    #[error("domain {0} is none; give one from 0 to 232")]
    Domain(u16),
    /// No network interface of this computer has the address.
    #[error("no network interface here has the address {0}; give one that `ip address` shows, or 127.0.0.1")]
    Interface(IpAddr),
    /// A name is none.
    #[error(
        "“{name}” is no name of ROS 2: it begins with a slash, has letters, digits and _ between slashes, and does not end \
         with one; give one such as {example}"
    )]
    Name {
        /// The name.
        name: String,
        /// One that is.
        example: &'static str,
    },
    /// DDS refuses.
    #[error("DDS cannot {what}: {why}")]
    Dds {
        /// What was wanted.
        what: &'static str,
        /// What it says.
        why: String,
    },
    /// The system gives no thread.
    #[error("no thread for ROS 2: {0}")]
    Thread(std::io::Error),
}

/// What has happened so far.
///
/// ```
/// use fingertip_bridges::ros2::Counts;
///
/// let counts = Counts { missed: 12, ..Counts::default() };
/// assert_eq!((counts.missed, counts.refused), (12, 0));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Samples that were not sent, since sending was too slow for them.
    pub missed: u64,
    /// Messages that DDS did not take.
    pub refused: u64,
}

/// What the threads of a node share.
#[derive(Debug, Default)]
struct Shared {
    ends: AtomicBool,
    missed: AtomicU64,
    refused: AtomicU64,
}

/// A node with its topics and services; it ends when it is dropped.
///
/// ```
/// use fingertip::wrench::Wrench;
/// use fingertip_bridges::ros2::{Counts, Node, Options};
/// use fingertip_bridges::{About, Hub, Sample};
///
/// let hub = Hub::new(About::default());
/// let node = Node::start(&hub, &Options { domain: 199, ..Options::default() })?;
/// // What is published is on /fingertip/wrench.
/// hub.publisher().publish(Sample::new(0.001, Wrench::zero(), None));
/// assert_eq!(node.counts(), Counts::default());
/// # Ok::<(), fingertip_bridges::ros2::NodeError>(())
/// ```
#[derive(Debug)]
pub struct Node {
    shared: Arc<Shared>,
    threads: Vec<JoinHandle<()>>,
}

impl Node {
    /// Publishes what a hub has.
    ///
    /// # Errors
    /// [`NodeError`].
    pub fn start(hub: &Hub, options: &Options) -> Result<Self, NodeError> {
        let mut participant = Participant::new(options, node::NODE)?;
        let publishing = publishing::Publishing::new(&mut participant, options, hub)?;
        let services = services::Serving::new(&mut participant, options, hub)?;
        let shared = Arc::new(Shared::default());
        let mut node = Self { shared: Arc::clone(&shared), threads: Vec::new() };
        let (one, other) = (Arc::clone(&shared), shared);
        let spawn = |name: &str, work: Box<dyn FnOnce() + Send>| {
            thread::Builder::new().name(name.to_owned()).spawn(work).map_err(NodeError::Thread)
        };
        node.threads.push(spawn("ros2 topics", Box::new(move || publishing.run(&one)))?);
        node.threads.push(spawn("ros2 services", Box::new(move || services.run(&other, participant)))?);
        Ok(node)
    }

    /// What has happened so far.
    #[must_use]
    pub fn counts(&self) -> Counts {
        let Shared { missed, refused, .. } = &*self.shared;
        Counts { missed: missed.load(Ordering::Relaxed), refused: refused.load(Ordering::Relaxed) }
    }
}

impl Drop for Node {
    fn drop(&mut self) {
        self.shared.ends.store(true, Ordering::Relaxed);
        for thread in self.threads.drain(..) {
            let _ = thread.join();
        }
    }
}
