//! The services `tare` and `reset`, with answers in JSON.

use core::time::Duration;

use foxglove::Schema;
use foxglove::websocket::service::{Request, Service, ServiceSchema};

use crate::{Command, Hub, NoZero};

/// How long a zero may take: a second of rest, and what a sensor needs to begin.
const PATIENCE: Duration = Duration::from_secs(5);

const NOTHING: &str = r#"{"type": "object", "properties": {}}"#;
const ANSWER: &str = r#"{"type": "object", "properties": {"success": {"type": "boolean"}, "message": {"type": "string"}, "zero": {"type": "array", "items": {"type": "number"}}}}"#;

pub(super) fn services(hub: &Hub) -> [Service; 2] {
    let schema = |name: &str| {
        ServiceSchema::new(name)
            .with_request("json", Schema::new(format!("{name}_request"), "jsonschema", NOTHING.as_bytes()))
            .with_response("json", Schema::new(format!("{name}_response"), "jsonschema", ANSWER.as_bytes()))
    };
    let (taring, resetting) = (hub.clone(), hub.clone());
    [
        Service::builder("/fingertip/tare", schema("tare"))
            .blocking_handler_fn(move |_: Request| answer(taring.tare(PATIENCE))),
        Service::builder("/fingertip/reset", schema("reset")).handler_fn(move |_: Request| {
            resetting.ask(Command::Reset);
            Ok::<_, NoZero>(
                br#"{"success":true,"message":"the last contact and what detectors saw are forgotten"}"#
                    .to_vec(),
            )
        }),
    ]
}

fn answer(zero: Result<[f64; 6], NoZero>) -> Result<Vec<u8>, NoZero> {
    let zero = zero?;
    let numbers: Vec<String> = zero.iter().map(|number| format!("{number:?}")).collect();
    let message = "the zero is the mean over one second, in N and N m";
    Ok(format!(r#"{{"success":true,"message":"{message}","zero":[{}]}}"#, numbers.join(",")).into_bytes())
}
