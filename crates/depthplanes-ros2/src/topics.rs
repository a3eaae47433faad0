//! Topics of the node: their names, types and quality of service.

use crate::say::Error;
use ros2_client::qos::{History, WhenFull};
use ros2_client::{MessageTypeName, Name, Node, NodeName, Publisher, QosProfile, Subscription};
use serde::Serialize;

/// Messages of a sensor: the newest counts, and a lost one is not sent again (`rmw_qos_profile_sensor_data` of depth 1).
pub(crate) const SENSOR_DATA: QosProfile = QosProfile::subscription_default();

/// Results: lost ones are sent again, as long as they are among so many. A listener that does not keep up never holds the
/// node up.
pub(crate) fn reliable(depth: usize) -> QosProfile {
    QosProfile::publisher_default().reliability_reliable(WhenFull::Fail).history(History::KeepLast { depth })
}

/// The name of a topic as it was typed.
fn name(typed: &str) -> Result<Name, Error> {
    Name::parse(typed).map_err(|error| {
        let accepted = "letters, digits and underscores with / between, such as /camera/depth/image_rect_raw";
        Error::new(format!("`{typed}` is no name of a topic ({error}); accepted: {accepted}"))
    })
}

/// The node's name in its namespace.
pub(crate) fn node_name(namespace: &str, base: &str) -> Result<NodeName, Error> {
    let namespace = if namespace.starts_with('/') { namespace.into() } else { format!("/{namespace}") };
    NodeName::new(&namespace, base).map_err(|error| {
        let accepted = "a name such as depthplanes, in a namespace such as / or /robot1";
        Error::new(format!("`{base}` in `{namespace}` is no name of a node ({error}); accepted: {accepted}"))
    })
}

/// A subscription to a topic.
pub(crate) fn subscribe<M: 'static>(
    node: &mut Node,
    topic: &str,
    [package, kind]: [&str; 2],
) -> Result<Subscription<M>, Error> {
    let made = node.create_topic(&name(topic)?, MessageTypeName::new(package, kind), &SENSOR_DATA);
    let made = made.and_then(|made| node.create_subscription(&made, None));
    made.map_err(|error| Error::new(format!("the topic {topic} cannot be listened to: {error}")))
}

/// A publisher of a topic; `~/` in its name stands for the node's own.
pub(crate) fn publish<M: Serialize>(
    node: &mut Node,
    topic: &str,
    [package, kind]: [&str; 2],
    qos: &QosProfile,
) -> Result<Publisher<M>, Error> {
    let whole = match topic.strip_prefix('~') {
        Some(rest) => node.fully_qualified_name() + rest,
        None => topic.into(),
    };
    let made = node.create_topic(&name(&whole)?, MessageTypeName::new(package, kind), qos);
    let made = made.and_then(|made| node.create_publisher(&made, None));
    made.map_err(|error| Error::new(format!("the topic {whole} cannot be published: {error}")))
}
