//! The participant of DDS, and names in it.

use core::fmt::Display;
use std::net::UdpSocket;

use ros2_client::qos::History;
use ros2_client::{
    Context, Message, MessageTypeName, Name, NodeName, NodeOptions, Publisher, QosProfile, ServiceMapping,
    ServiceTypeName,
};
use rustdds::{DomainParticipantBuilder, Topic};

use super::callers::{Callers, Service};
use super::raw::Raw;
use super::{NodeError, Options, Services};

/// What the node that publishes is called below the namespace.
pub(super) const NODE: &str = "live";

/// A node of ROS 2.
pub(super) struct Participant {
    pub(super) node: ros2_client::Node,
    name: NodeName,
    pub(super) callers: Callers,
}

/// What DDS does not do, and why.
pub(super) fn refused(what: &'static str) -> impl Fn(&dyn Display) -> NodeError {
    move |why| NodeError::Dds { what, why: why.to_string() }
}

/// A name of a topic or service.
pub(super) fn name(namespace: &str, base: &str) -> Result<Name, NodeError> {
    Name::new(namespace, base)
        .map_err(|_| NodeError::Name { name: format!("{namespace}/{base}"), example: "/fingertip" })
}

impl Participant {
    /// Joins the domain. `base` is what the node is called below the namespace.
    pub(super) fn new(options: &Options, base: &str) -> Result<Self, NodeError> {
        let Options { namespace, domain, interface, .. } = options;
        if *domain > 232 {
            return Err(NodeError::Domain(*domain));
        }
        // The library would say nothing, and reach nobody.
        if UdpSocket::bind((*interface, 0)).is_err() {
            return Err(NodeError::Interface(*interface));
        }
        let node_name = NodeName::new(namespace, base)
            .map_err(|_| NodeError::Name { name: namespace.clone(), example: "/fingertip" })?;
        let participant = DomainParticipantBuilder::new(*domain)
            .with_only_networks([*interface])
            .same_host_loopback(true)
            .build()
            .map_err(|why| refused("join the domain")(&why))?;
        let callers = Callers::new(participant.status_listener());
        let context = Context::from_domain_participant(participant);
        let context = context.map_err(|why| refused("make a context")(&why))?;
        // Nobody spins it: there is no log, and the library would map the services of parameters in one way alone.
        let node_options = NodeOptions::new().enable_rosout(false).start_parameter_services(false);
        let node = context.new_node(node_name.clone(), node_options);
        let node = node.map_err(|why| NodeError::Dds { what: "make a node", why: format!("{why:?}") })?;
        Ok(Self { node, name: node_name, callers })
    }

    /// A service of a type below a namespace, by the mapping that callers have.
    pub(super) fn server<Q: Message + Clone + 'static, R: Message + Clone + 'static>(
        &mut self,
        services: Services,
        [namespace, base]: [&str; 2],
        [package, kind]: [&str; 2],
    ) -> Result<Service<Q, R>, NodeError> {
        let mapping = match services {
            Services::Enhanced => ServiceMapping::Enhanced,
            Services::Cyclone => ServiceMapping::Cyclone,
        };
        let qos = QosProfile::publisher_default().history(History::KeepLast { depth: 10 });
        let (name, kind) = (name(namespace, base)?, ServiceTypeName::new(package, kind));
        let answers = name.to_dds_name("rr", &self.name, "Reply");
        let server = self.node.create_server(mapping, &name, &kind, qos.clone(), qos);
        Ok(Service::new(server.map_err(|why| refused("serve")(&why))?, answers))
    }

    /// A service of the node's parameters.
    pub(super) fn parameter_server<Q: Message + Clone + 'static, R: Message + Clone + 'static>(
        &mut self,
        options: &Options,
        base: &str,
        kind: &str,
    ) -> Result<Service<Q, R>, NodeError> {
        let below = format!("{}/{NODE}", options.namespace);
        self.server(options.services, [&below, base], ["rcl_interfaces", kind])
    }

    pub(super) fn topic(
        &self,
        name: &Name,
        [package, kind]: [&str; 2],
        qos: &QosProfile,
    ) -> Result<Topic, NodeError> {
        let topic = self.node.create_topic(name, MessageTypeName::new(package, kind), qos);
        topic.map_err(|why| refused("make a topic")(&why))
    }

    /// Of messages that are CDR already.
    pub(super) fn publisher(
        &mut self,
        name: &Name,
        kind: [&str; 2],
        qos: &QosProfile,
    ) -> Result<Publisher<Raw>, NodeError> {
        let topic = self.topic(name, kind, qos)?;
        let publisher = self.node.create_publisher(&topic, Some(qos.clone()));
        publisher.map_err(|why| refused("publish")(&why))
    }
}
