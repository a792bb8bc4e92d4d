//! Which bridges `fingertip live` opens, with their options.

use clap::Args;
use fingertip_bridges::Hub;
use fingertip_scene::Scene;

use crate::error::CliError;

/// The bridges that were asked for; which there are is a matter of how the command was built.
#[derive(Debug, Args)]
#[command(next_help_heading = "Bridges to other tools, as the command was built")]
pub(crate) struct BridgeArguments {
    /// Serve a page for browsers, with the fingertip in 3-D; its address has a token and is printed. Another address than
    /// loopback lets other computers watch
    #[cfg(feature = "web")]
    #[arg(long, value_name = "IP:PORT", num_args = 0..=1, require_equals = true, default_missing_value = "127.0.0.1:8137")]
    web: Option<core::net::SocketAddr>,
    /// Keep the tokens of --web in a file, which is made if it is not there, so that its addresses stay the same
    #[cfg(feature = "web")]
    #[arg(long, value_name = "FILE", requires = "web")]
    web_tokens: Option<std::path::PathBuf>,
    /// Serve Foxglove: wrench, contact, touch (with margin and slip), the fingertip in 3-D, and on loopback the services
    /// tare and reset. There is no secret: another address lets everybody watch who reaches it
    #[cfg(feature = "foxglove")]
    #[arg(long, value_name = "IP:PORT", num_args = 0..=1, require_equals = true, default_missing_value = "127.0.0.1:8765")]
    foxglove: Option<core::net::SocketAddr>,
    /// Let other computers take zeros and reset, too, where --web or --foxglove have an address that they reach; without
    /// it they watch only
    #[cfg(any(feature = "web", feature = "foxglove"))]
    #[arg(long)]
    remote_commands: bool,
    /// Publish to ROS 2 below a namespace: wrench, touch, contact, point, markers, tf, and the services tare and reset; no
    /// ROS installation is needed
    #[cfg(feature = "ros2")]
    #[arg(long, value_name = "NAMESPACE", num_args = 0..=1, require_equals = true, default_missing_value = "/fingertip")]
    ros2: Option<String>,
    /// The domain of --ros2 [default: ROS_DOMAIN_ID, or 0]
    #[cfg(feature = "ros2")]
    #[arg(long, value_name = "N", requires = "ros2")]
    ros_domain: Option<u16>,
    /// The address of the network interface that --ros2 uses
    #[cfg(feature = "ros2")]
    #[arg(long, value_name = "IP", requires = "ros2", default_value = "127.0.0.1")]
    ros_interface: core::net::IpAddr,
    /// Send samples again until they arrive, instead of best effort, as sensors do
    #[cfg(feature = "ros2")]
    #[arg(long, requires = "ros2")]
    ros_reliable: bool,
}

impl BridgeArguments {
    /// Whether any is asked for.
    pub(crate) const fn any(&self) -> bool {
        let any = false;
        #[cfg(feature = "web")]
        let any = any || self.web.is_some();
        #[cfg(feature = "foxglove")]
        let any = any || self.foxglove.is_some();
        #[cfg(feature = "ros2")]
        let any = any || self.ros2.is_some();
        any
    }
}

#[cfg(any(feature = "web", feature = "foxglove"))]
impl BridgeArguments {
    /// Whether clients of a server at an address may command: on this computer, or where it is said that others may.
    const fn commands_from(&self, listen: &core::net::SocketAddr) -> bool {
        self.remote_commands || listen.ip().is_loopback()
    }
}

/// The bridges that run.
#[derive(Debug, Default)]
pub(super) struct Bridges {
    addresses: Vec<String>,
    #[cfg(feature = "web")]
    web: Option<fingertip_bridges::web::Server>,
    #[cfg(feature = "foxglove")]
    foxglove: Option<fingertip_bridges::foxglove::Server>,
    #[cfg(feature = "ros2")]
    ros2: Option<fingertip_bridges::ros2::Node>,
}

impl Bridges {
    /// Opens those that are asked for.
    pub(super) fn start(
        arguments: &BridgeArguments,
        hub: &Hub,
        scene: Option<&Scene>,
    ) -> Result<Self, CliError> {
        let mut bridges = Self::default();
        #[cfg(feature = "web")]
        bridges.start_web(arguments, hub, scene)?;
        #[cfg(feature = "foxglove")]
        bridges.start_foxglove(arguments, hub)?;
        #[cfg(feature = "ros2")]
        bridges.start_ros2(arguments, hub)?;
        let _ = (arguments, hub, scene, &mut bridges);
        Ok(bridges)
    }

    #[cfg(feature = "web")]
    fn start_web(
        &mut self,
        arguments: &BridgeArguments,
        hub: &Hub,
        scene: Option<&Scene>,
    ) -> Result<(), CliError> {
        use fingertip_bridges::web::{Options, Server, Tokens};

        let Some(listen) = arguments.web else { return Ok(()) };
        let fault = |message: String| CliError::Bridge { bridge: "--web", message };
        let tokens = match &arguments.web_tokens {
            Some(path) => Tokens::kept(path),
            None => Tokens::random(),
        };
        let tokens = tokens.map_err(|error| fault(error.to_string()))?;
        let view = scene.map(crate::report::live_view).unwrap_or_default();
        let commands = arguments.commands_from(&listen);
        let server = Server::start(hub, Options { listen, tokens, commands, view });
        let server = server.map_err(|error| fault(error.to_string()))?;
        self.addresses.push(format!("Watch:   {}", server.watching()));
        self.addresses.extend(server.commanding().map(|address| format!("Command: {address}")));
        self.web = Some(server);
        Ok(())
    }

    #[cfg(feature = "foxglove")]
    fn start_foxglove(&mut self, arguments: &BridgeArguments, hub: &Hub) -> Result<(), CliError> {
        use fingertip_bridges::foxglove::Server;

        let Some(listen) = arguments.foxglove else { return Ok(()) };
        let fault = |message: String| CliError::Bridge { bridge: "--foxglove", message };
        let server = Server::start(hub, listen, arguments.commands_from(&listen))
            .map_err(|error| fault(error.to_string()))?;
        self.addresses.push(format!("Foxglove: ws://{}", server.address()));
        self.foxglove = Some(server);
        Ok(())
    }

    #[cfg(feature = "ros2")]
    fn start_ros2(&mut self, arguments: &BridgeArguments, hub: &Hub) -> Result<(), CliError> {
        use fingertip_bridges::ros2::{Node, Options, Services};

        let Some(namespace) = &arguments.ros2 else { return Ok(()) };
        let fault = |message: String| CliError::Bridge { bridge: "--ros2", message };
        let domain = match arguments.ros_domain {
            Some(domain) => domain,
            None => crate::sensor::ros_domain().map_err(fault)?,
        };
        let options = Options {
            namespace: namespace.clone(),
            domain,
            interface: arguments.ros_interface,
            reliable: arguments.ros_reliable,
            services: Services::of(&std::env::var("RMW_IMPLEMENTATION").unwrap_or_default()),
        };
        let node = Node::start(hub, &options).map_err(|error| fault(error.to_string()))?;
        let Options { namespace, domain, interface, .. } = &options;
        self.addresses.push(format!("ROS 2:   {namespace}, domain {domain}, on {interface}"));
        self.ros2 = Some(node);
        Ok(())
    }

    /// Where they are, a line each.
    pub(super) fn addresses(&self) -> &[String] {
        &self.addresses
    }

    /// Ends them, and says what is worth it.
    pub(super) fn end(&mut self) -> Vec<String> {
        let said = Vec::new();
        #[cfg(feature = "web")]
        let said = self.end_web(said);
        #[cfg(feature = "foxglove")]
        let said = self.end_foxglove(said);
        #[cfg(feature = "ros2")]
        let said = self.end_ros2(said);
        said
    }

    #[cfg(feature = "web")]
    fn end_web(&mut self, mut said: Vec<String>) -> Vec<String> {
        use crate::table::count;

        let Some(server) = self.web.take() else { return said };
        let counts = server.counts();
        if counts.refused > 0 {
            said.push(format!("--web: {} requests were refused", count(counts.refused)));
        }
        if counts.missed > 0 || counts.given_up > 0 {
            said.push(format!(
                "--web: slow readers missed {} samples, and {} were given up",
                count(counts.missed),
                count(counts.given_up)
            ));
        }
        said
    }

    #[cfg(feature = "foxglove")]
    fn end_foxglove(&mut self, mut said: Vec<String>) -> Vec<String> {
        let missed = self.foxglove.take().map_or(0, |server| server.missed());
        if missed > 0 {
            said.push(format!("--foxglove: {} samples were missed by it", crate::table::count(missed)));
        }
        said
    }

    #[cfg(feature = "ros2")]
    fn end_ros2(&mut self, mut said: Vec<String>) -> Vec<String> {
        let Some(node) = self.ros2.take() else { return said };
        let counts = node.counts();
        if counts.missed > 0 || counts.refused > 0 {
            let [missed, refused] = [counts.missed, counts.refused].map(crate::table::count);
            said.push(format!(
                "--ros2: {missed} samples were missed by it, {refused} messages DDS did not take"
            ));
        }
        said
    }
}
