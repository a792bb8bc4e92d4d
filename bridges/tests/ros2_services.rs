//! Services as callers of the default middleware of ROS 2 map them (`Enhanced`). The clients of others that can be had from PyPI
//! cannot set the header in which that mapping names a request, so the client here is of the same library as the server:
//! a disagreement of both with others would not show. The mapping of Cyclone is tried with a client of others
//! (`tests/clients/test_ros2.py`).

#![allow(clippy::unwrap_used, reason = "helpers of tests, which may fail so")]

use core::net::Ipv4Addr;
use core::time::Duration;
use std::time::Instant;

use fingertip_bridges::ros2::{Node, Options, Services};
use fingertip_bridges::{About, Command, Hub, Parameter, Value};
use ros2_client::qos::History;
use ros2_client::rcl_interfaces::{GetParametersRequest, GetParametersResponse};
use ros2_client::{
    Client, Context, Message, Name, NodeName, NodeOptions, QosProfile, ServiceMapping, ServiceTypeName,
};
use rustdds::DomainParticipantBuilder;
use serde::{Deserialize, Serialize};

#[derive(Clone, Debug, Serialize, Deserialize)]
struct Trigger {
    structure_needs_at_least_one_member: u8,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
struct Triggered {
    success: bool,
    message: String,
}

impl Message for Trigger {}
impl Message for Triggered {}

/// Asks again until an answer comes: the first requests are sent before both sides know of each other.
fn call<Q: Message + Clone + 'static, R: Message + 'static>(client: &Client<Q, R>, request: &Q) -> R {
    let begun = Instant::now();
    loop {
        let sent = client.send_request(request.clone()).unwrap();
        for _ in 0..50 {
            std::thread::sleep(Duration::from_millis(20));
            if let Some((id, answer)) = client.receive_response().unwrap() {
                assert!(id.sequence_number <= sent.sequence_number, "an answer to no request");
                return answer;
            }
        }
        assert!(begun.elapsed() < Duration::from_secs(40), "no answer");
    }
}

#[test]
fn callers_of_the_default_middleware_are_answered() {
    let radius = Parameter { name: "surface.radius_m".to_owned(), value: Value::Number(0.013) };
    let hub = Hub::new(About { parameters: vec![radius], ..About::default() });
    let domain = 200 + u16::try_from(std::process::id() % 32).unwrap();
    let options = Options { domain, ..Options::default() };
    assert_eq!(options.services, Services::Enhanced);
    let node = Node::start(&hub, &options).unwrap();

    let participant = DomainParticipantBuilder::new(domain)
        .with_only_networks([Ipv4Addr::LOCALHOST])
        .same_host_loopback(true)
        .build()
        .unwrap();
    let context = Context::from_domain_participant(participant).unwrap();
    let options = NodeOptions::new().enable_rosout(false).start_parameter_services(false);
    let mut caller = context.new_node(NodeName::new("/", "caller").unwrap(), options).unwrap();
    let (mapping, qos) =
        (ServiceMapping::Enhanced, QosProfile::publisher_default().history(History::KeepLast { depth: 10 }));
    let trigger = ServiceTypeName::new("std_srvs", "Trigger");
    let reset = caller
        .create_client::<Trigger, Triggered>(
            mapping,
            &Name::new("/fingertip", "reset").unwrap(),
            &trigger,
            qos.clone(),
            qos.clone(),
        )
        .unwrap();
    let kind = ServiceTypeName::new("rcl_interfaces", "GetParameters");
    let get = caller
        .create_client::<GetParametersRequest, GetParametersResponse>(
            mapping,
            &Name::new("/fingertip/live", "get_parameters").unwrap(),
            &kind,
            qos.clone(),
            qos,
        )
        .unwrap();

    let answer = call(&reset, &Trigger { structure_needs_at_least_one_member: 0 });
    assert!(answer.success && answer.message.contains("forgotten"), "{answer:?}");
    assert_eq!(hub.asked(), Some(Command::Reset));
    let names = vec!["surface.radius_m".to_owned(), "none".to_owned()];
    let answer = call(&get, &GetParametersRequest { names });
    let told: Vec<(u8, f64)> = answer.values.iter().map(|value| (value.ptype, value.double_value)).collect();
    assert_eq!(told, [(3, 0.013), (0, 0.0)]);
    drop(node);
}
