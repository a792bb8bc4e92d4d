//! The services `tare` and `reset`: `std_srvs/srv/Trigger`.

use alloc::sync::Arc;
use core::sync::atomic::Ordering;
use core::time::Duration;

use ros2_client::{Message, QosProfile, Server, ServiceMapping, ServiceTypeName};
use serde::{Deserialize, Serialize};

use super::node::{Participant, name, refused};
use super::{NodeError, Options, Services, Shared};
use crate::{Command, Hub};

/// How often it looks for calls.
const NAP: Duration = Duration::from_millis(20);
/// How long a zero may take.
const PATIENCE: Duration = Duration::from_secs(5);

/// Nothing, as ROS 2 writes it.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Request {
    structure_needs_at_least_one_member: u8,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
struct Response {
    success: bool,
    message: String,
}

impl Message for Request {}
impl Message for Response {}

/// The services of a node.
pub(super) struct Serving {
    hub: Hub,
    tare: Server<Request, Response>,
    reset: Server<Request, Response>,
}

impl Serving {
    pub(super) fn new(
        participant: &mut Participant,
        options: &Options,
        hub: &Hub,
    ) -> Result<Self, NodeError> {
        let mapping = match options.services {
            Services::Enhanced => ServiceMapping::Enhanced,
            Services::Cyclone => ServiceMapping::Cyclone,
        };
        let qos = QosProfile::publisher_default().history(ros2_client::qos::History::KeepLast { depth: 10 });
        let mut server = |base: &str| {
            let kind = ServiceTypeName::new("std_srvs", "Trigger");
            let name = name(&options.namespace, base)?;
            let server = participant.node.create_server(mapping, &name, &kind, qos.clone(), qos.clone());
            server.map_err(|why| refused("serve")(&why))
        };
        let (tare, reset) = (server("tare")?, server("reset")?);
        Ok(Self { hub: hub.clone(), tare, reset })
    }

    /// Answers calls. The participant is kept as long as that.
    pub(super) fn run(self, shared: &Arc<Shared>, participant: Participant) {
        while !shared.ends.load(Ordering::Relaxed) {
            let answer = |server: &Server<Request, Response>, work: &dyn Fn() -> Response| {
                // What is no request is passed over.
                while let Ok(Some((id, _))) = server.receive_request() {
                    let unsent = server.send_response(id, work()).is_err();
                    shared.refused.fetch_add(u64::from(unsent), Ordering::Relaxed);
                }
            };
            answer(&self.tare, &|| match self.hub.tare(PATIENCE) {
                Ok([fx, fy, fz, tx, ty, tz]) => Response {
                    success: true,
                    message: format!("zero taken off: {fx:?} {fy:?} {fz:?} N, {tx:?} {ty:?} {tz:?} N m"),
                },
                Err(why) => Response { success: false, message: why.to_string() },
            });
            answer(&self.reset, &|| {
                self.hub.ask(Command::Reset);
                let message = "the last contact and what detectors saw are forgotten".to_owned();
                Response { success: true, message }
            });
            std::thread::sleep(NAP);
        }
        drop(participant);
    }
}
