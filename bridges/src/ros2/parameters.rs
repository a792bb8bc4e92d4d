//! The parameters of the node: what the scene says, to be read. They are asked for by the services of `rcl_interfaces`, as
//! `ros2 param` does. To set one is refused: a scene is what the command was started with.

use alloc::collections::BTreeSet;

use ros2_client::ParameterValue;
use ros2_client::parameters::raw::{ParameterDescriptor, ParameterType, SetParametersResult};
use ros2_client::rcl_interfaces::{
    DescribeParametersRequest, DescribeParametersResponse, GetParameterTypesRequest,
    GetParameterTypesResponse, GetParametersRequest, GetParametersResponse, ListParametersRequest,
    ListParametersResponse, ListParametersResult, SetParametersAtomicallyResponse, SetParametersRequest,
    SetParametersResponse,
};

use super::callers::{Callers, Service};
use super::node::Participant;
use super::{NodeError, Options};
use crate::{Parameter, Value};

/// The services of the parameters.
pub(super) struct Parameters {
    known: Vec<Parameter>,
    get: Service<GetParametersRequest, GetParametersResponse>,
    types: Service<GetParameterTypesRequest, GetParameterTypesResponse>,
    list: Service<ListParametersRequest, ListParametersResponse>,
    describe: Service<DescribeParametersRequest, DescribeParametersResponse>,
    set: Service<SetParametersRequest, SetParametersResponse>,
    set_at_once: Service<SetParametersRequest, SetParametersAtomicallyResponse>,
}

impl Parameters {
    pub(super) fn new(
        participant: &mut Participant,
        options: &Options,
        known: &[Parameter],
    ) -> Result<Self, NodeError> {
        Ok(Self {
            known: known.to_vec(),
            get: participant.parameter_server(options, "get_parameters", "GetParameters")?,
            types: participant.parameter_server(options, "get_parameter_types", "GetParameterTypes")?,
            list: participant.parameter_server(options, "list_parameters", "ListParameters")?,
            describe: participant.parameter_server(options, "describe_parameters", "DescribeParameters")?,
            set: participant.parameter_server(options, "set_parameters", "SetParameters")?,
            set_at_once: participant.parameter_server(
                options,
                "set_parameters_atomically",
                "SetParametersAtomically",
            )?,
        })
    }

    /// Answers what was asked since the last time. Returns how many answers DDS did not take.
    pub(super) fn answer(&self, callers: &Callers) -> u64 {
        let known = &self.known;
        let unsent = [
            self.get.answer(callers, |request| GetParametersResponse {
                values: request.names.iter().map(|name| value(known, name).into()).collect(),
            }),
            self.types.answer(callers, |request| GetParameterTypesResponse {
                values: request.names.iter().map(|name| kind(&value(known, name))).collect(),
            }),
            self.list.answer(callers, |request| ListParametersResponse { result: list(known, request) }),
            self.describe.answer(callers, |request| DescribeParametersResponse {
                values: request.names.iter().map(|name| describe(known, name)).collect(),
            }),
            self.set.answer(callers, |request| SetParametersResponse {
                results: request.parameter.iter().map(|asked| refusal(known, &asked.name)).collect(),
            }),
            self.set_at_once.answer(callers, |request| {
                let first = request.parameter.first().map(|asked| refusal(known, &asked.name));
                let nothing = SetParametersResult { successful: true, reason: String::new() };
                SetParametersAtomicallyResponse { result: first.unwrap_or(nothing) }
            }),
        ];
        unsent.into_iter().sum()
    }
}

fn find<'a>(known: &'a [Parameter], name: &str) -> Option<&'a Value> {
    known.iter().find(|parameter| parameter.name == name).map(|parameter| &parameter.value)
}

/// The value of a parameter; none is not set.
fn value(known: &[Parameter], name: &str) -> ParameterValue {
    match find(known, name) {
        None => ParameterValue::NotSet,
        Some(Value::Flag(flag)) => ParameterValue::Boolean(*flag),
        Some(Value::Count(count)) => ParameterValue::Integer(*count),
        Some(Value::Number(number)) => ParameterValue::Double(*number),
        Some(Value::Text(text)) => ParameterValue::String(text.clone()),
        Some(Value::Numbers(numbers)) => ParameterValue::DoubleArray(numbers.clone()),
        Some(Value::Texts(texts)) => ParameterValue::StringArray(texts.clone()),
    }
}

/// The number of its type.
fn kind(value: &ParameterValue) -> u8 {
    ParameterValue::to_parameter_type_raw(value)
}

/// The names below the prefixes, or all, of at most so many parts below them; 0 is any depth.
fn list(known: &[Parameter], request: &ListParametersRequest) -> ListParametersResult {
    let depth = usize::try_from(request.depth).unwrap_or(usize::MAX);
    let is_within = |rest: &str| depth == 0 || rest.split('.').count() <= depth;
    let is_asked = |name: &str| {
        let below = |prefix: &String| {
            name == prefix
                || name
                    .strip_prefix(prefix.as_str())
                    .and_then(|rest| rest.strip_prefix('.'))
                    .is_some_and(is_within)
        };
        if request.prefixes.is_empty() { is_within(name) } else { request.prefixes.iter().any(below) }
    };
    let names = known.iter().map(|parameter| parameter.name.clone()).filter(|name| is_asked(name));
    let names: Vec<String> = names.collect();
    let above = names.iter().filter_map(|name| Some(name.rsplit_once('.')?.0.to_owned()));
    let prefixes = above.collect::<BTreeSet<_>>().into_iter().collect();
    ListParametersResult { names, prefixes }
}

fn describe(known: &[Parameter], name: &str) -> ParameterDescriptor {
    let r#type = kind(&value(known, name));
    let of_scene = r#type != ParameterType::NOT_SET;
    ParameterDescriptor {
        name: name.to_owned(),
        r#type,
        description: if of_scene { "of the scene".to_owned() } else { String::new() },
        additional_constraints: String::new(),
        read_only: of_scene,
        dynamic_typing: false,
        floating_point_range: Vec::new(),
        integer_range: Vec::new(),
    }
}

/// Why a parameter cannot be set.
fn refusal(known: &[Parameter], name: &str) -> SetParametersResult {
    let reason = if find(known, name).is_some() {
        format!("“{name}” is of the scene, which is read when `fingertip live` starts: change it there")
    } else {
        format!("there is no parameter “{name}”")
    };
    SetParametersResult { successful: false, reason }
}

#[cfg(test)]
mod tests {
    use ros2_client::ParameterValue;
    use ros2_client::rcl_interfaces::ListParametersRequest;

    use super::{describe, list, refusal, value};
    use crate::{Parameter, Value};

    fn known() -> Vec<Parameter> {
        let parameter = |name: &str, value: Value| Parameter { name: name.to_owned(), value };
        vec![
            parameter("version", Value::Count(2)),
            parameter("surface.shape", Value::Text("sphere".to_owned())),
            parameter("surface.radius_m", Value::Number(0.013)),
            parameter("contact.skin.moduli", Value::Numbers(vec![1.0, 2.0])),
            parameter("contact.adhesion", Value::Flag(false)),
            parameter("tracks", Value::Texts(vec!["a".to_owned()])),
        ]
    }

    #[test]
    fn values_have_the_types_of_ros() {
        let known = known();
        let all = known.iter().map(|parameter| value(&known, &parameter.name));
        assert_eq!(
            all.collect::<Vec<_>>(),
            [
                ParameterValue::Integer(2),
                ParameterValue::String("sphere".to_owned()),
                ParameterValue::Double(0.013),
                ParameterValue::DoubleArray(vec![1.0, 2.0]),
                ParameterValue::Boolean(false),
                ParameterValue::StringArray(vec!["a".to_owned()]),
            ]
        );
        assert_eq!(value(&known, "surface"), ParameterValue::NotSet);
        let types = known.iter().map(|parameter| describe(&known, &parameter.name).r#type);
        assert_eq!(types.collect::<Vec<_>>(), [2, 4, 3, 8, 1, 9]);
        assert!(describe(&known, "version").read_only && !describe(&known, "none").read_only);
    }

    #[test]
    fn names_are_listed_by_prefix_and_depth() {
        let listed = |prefixes: &[&str], depth: u64| {
            let prefixes = prefixes.iter().map(|&prefix| prefix.to_owned()).collect();
            let result = list(&known(), &ListParametersRequest { prefixes, depth });
            (result.names.join(" "), result.prefixes.join(" "))
        };
        let all =
            "version surface.shape surface.radius_m contact.skin.moduli contact.adhesion tracks".to_owned();
        assert_eq!(listed(&[], 0), (all.clone(), "contact contact.skin surface".to_owned()));
        assert_eq!(listed(&[], 3).0, all);
        assert_eq!(listed(&[], 1), ("version tracks".to_owned(), String::new()));
        assert_eq!(listed(&["contact"], 1), ("contact.adhesion".to_owned(), "contact".to_owned()));
        assert_eq!(listed(&["contact"], 2).0, "contact.skin.moduli contact.adhesion");
        assert_eq!(listed(&["contact.skin", "version"], 0).0, "version contact.skin.moduli");
        // The beginning of a word is no prefix.
        assert_eq!(listed(&["surf"], 0), (String::new(), String::new()));
    }

    #[test]
    fn nothing_can_be_set() {
        for (name, says) in [("surface.radius_m", "is of the scene"), ("none", "no parameter “none”")] {
            let result = refusal(&known(), name);
            assert!(!result.successful && result.reason.contains(says), "{result:?}");
        }
    }
}
