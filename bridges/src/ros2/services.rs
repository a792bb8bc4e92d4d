//! The services `tare` and `reset`: `std_srvs/srv/Trigger`.

use alloc::sync::Arc;
use core::sync::atomic::Ordering;
use core::time::Duration;

use ros2_client::{Message, Server};
use serde::{Deserialize, Serialize};

use super::node::Participant;
use super::parameters::Parameters;
use super::{NodeError, Options, Shared};
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
    parameters: Parameters,
}

/// Answers the requests that a service has got; what is no request is passed over.
pub(super) fn answer<Q: Message + 'static, R: Message + 'static>(
    server: &Server<Q, R>,
    shared: &Shared,
    work: impl Fn(&Q) -> R,
) {
    while let Ok(Some((id, request))) = server.receive_request() {
        let unsent = server.send_response(id, work(&request)).is_err();
        shared.refused.fetch_add(u64::from(unsent), Ordering::Relaxed);
    }
}

impl Serving {
    pub(super) fn new(
        participant: &mut Participant,
        options: &Options,
        hub: &Hub,
    ) -> Result<Self, NodeError> {
        let (kind, Options { namespace, services, .. }) = (["std_srvs", "Trigger"], options);
        Ok(Self {
            hub: hub.clone(),
            tare: participant.server(*services, [namespace, "tare"], kind)?,
            reset: participant.server(*services, [namespace, "reset"], kind)?,
            parameters: Parameters::new(participant, options, &hub.about().parameters)?,
        })
    }

    /// Answers calls. The participant is kept as long as that.
    pub(super) fn run(self, shared: &Arc<Shared>, participant: Participant) {
        while !shared.ends.load(Ordering::Relaxed) {
            answer(&self.tare, shared, |_| match self.hub.tare(PATIENCE) {
                Ok([fx, fy, fz, tx, ty, tz]) => Response {
                    success: true,
                    message: format!("zero taken off: {fx:?} {fy:?} {fz:?} N, {tx:?} {ty:?} {tz:?} N m"),
                },
                Err(why) => Response { success: false, message: why.to_string() },
            });
            answer(&self.reset, shared, |_| {
                self.hub.ask(Command::Reset);
                let message = "the last contact and what detectors saw are forgotten".to_owned();
                Response { success: true, message }
            });
            self.parameters.answer(shared);
            std::thread::sleep(NAP);
        }
        drop(participant);
    }
}
