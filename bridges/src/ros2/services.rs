//! The services `tare` and `reset`: `std_srvs/srv/Trigger`.

use alloc::sync::Arc;
use core::sync::atomic::Ordering;
use core::time::Duration;

use ros2_client::Message;
use serde::{Deserialize, Serialize};

use super::callers::Service;
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
    tare: Service<Request, Response>,
    reset: Service<Request, Response>,
    parameters: Parameters,
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
    pub(super) fn run(self, shared: &Arc<Shared>, mut participant: Participant) {
        while !shared.ends.load(Ordering::Relaxed) {
            participant.callers.update();
            let callers = &participant.callers;
            let mut unsent = self.tare.answer(callers, |_| match self.hub.tare(PATIENCE) {
                Ok([fx, fy, fz, tx, ty, tz]) => Response {
                    success: true,
                    message: format!("zero taken off: {fx:?} {fy:?} {fz:?} N, {tx:?} {ty:?} {tz:?} N m"),
                },
                Err(why) => Response { success: false, message: why.to_string() },
            });
            unsent += self.reset.answer(callers, |_| {
                self.hub.ask(Command::Reset);
                let message = "the last contact and what detectors saw are forgotten".to_owned();
                Response { success: true, message }
            });
            unsent += self.parameters.answer(callers);
            shared.refused.fetch_add(unsent, Ordering::Relaxed);
            std::thread::sleep(NAP);
        }
        drop(participant);
    }
}
