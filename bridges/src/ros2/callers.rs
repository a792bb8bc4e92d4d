//! Who calls a service and can hear the answer.
//!
//! DDS makes the two ends of a connection known to each other one after the other. A caller may know this node's writer of answers
//! before that writer knows the caller's reader, and an answer written in between reaches nobody. An answer therefore waits until
//! its writer knows the reader, for [`WAIT`] at most.

use alloc::collections::{BTreeMap, BTreeSet, VecDeque};
use core::cell::RefCell;
use core::time::Duration;
use std::time::Instant;

use ros2_client::{Message, RmwRequestId, Server};
use rustdds::{DomainParticipantStatusEvent, DomainParticipantStatusListener, GUID, StatusEvented};

/// How long an answer waits for its reader. A caller that has none is answered then all the same: nobody hears it.
const WAIT: Duration = Duration::from_secs(1);
/// How many requests of a service wait at most; the oldest is answered when one more comes.
const HELD: usize = 64;
/// How many bytes of a caller's identity name its participant in all mappings of services.
const PARTICIPANT: usize = 8;

/// The readers of others that this participant's writers know.
pub(super) struct Callers {
    events: DomainParticipantStatusListener,
    topics: BTreeMap<GUID, String>,
    known: BTreeSet<GUID>,
}

impl Callers {
    pub(super) fn new(events: DomainParticipantStatusListener) -> Self {
        Self { events, topics: BTreeMap::new(), known: BTreeSet::new() }
    }

    /// Takes in what DDS has found since the last time.
    pub(super) fn update(&mut self) {
        while let Some(event) = self.events.try_recv_status() {
            match event {
                DomainParticipantStatusEvent::ReaderDetected { reader } => {
                    self.topics.insert(reader.guid, reader.topic_name);
                }
                DomainParticipantStatusEvent::RemoteReaderMatched { remote_reader, .. } => {
                    self.known.insert(remote_reader);
                }
                DomainParticipantStatusEvent::ReaderLost { guid, .. } => {
                    self.topics.remove(&guid);
                    self.known.remove(&guid);
                }
                DomainParticipantStatusEvent::ParticipantLost { id, .. } => {
                    self.topics.retain(|guid, _| guid.prefix != id);
                    self.known.retain(|guid| guid.prefix != id);
                }
                _ => {}
            }
        }
    }

    /// Whether the one who made a request has a reader of the answers that this participant's writer knows.
    fn can_hear(&self, request: &RmwRequestId, answers: &str) -> bool {
        let caller = request.writer_gid.to_bytes16();
        self.known.iter().any(|guid| {
            guid.to_bytes().get(..PARTICIPANT) == caller.get(..PARTICIPANT)
                && self.topics.get(guid).is_some_and(|topic| topic == answers)
        })
    }
}

/// A service with the requests that wait for their caller's reader.
pub(super) struct Service<Q: Message, R: Message> {
    server: Server<Q, R>,
    /// The topic of the answers, as DDS calls it.
    answers: String,
    held: RefCell<VecDeque<(Instant, RmwRequestId, Q)>>,
}

impl<Q: Message + 'static, R: Message + 'static> Service<Q, R> {
    pub(super) fn new(server: Server<Q, R>, answers: String) -> Self {
        Self { server, answers, held: RefCell::new(VecDeque::new()) }
    }

    /// Answers the requests whose callers can hear it, or have waited long enough; what is no request is passed over. Returns how
    /// many answers DDS did not take.
    pub(super) fn answer(&self, callers: &Callers, work: impl Fn(&Q) -> R) -> u64 {
        let mut held = self.held.borrow_mut();
        while let Ok(Some((id, request))) = self.server.receive_request() {
            held.push_back((Instant::now(), id, request));
        }
        let mut refused = 0;
        for _ in 0..held.len() {
            let Some((since, id, request)) = held.pop_front() else { break };
            let is_full = held.len() >= HELD;
            if is_full || since.elapsed() >= WAIT || callers.can_hear(&id, &self.answers) {
                refused += u64::from(self.server.send_response(id, work(&request)).is_err());
            } else {
                held.push_back((since, id, request));
            }
        }
        refused
    }
}
