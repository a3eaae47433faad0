//! Who may ask: pages of this server alone, by a name that no other site can have.
//!
//! A page of another site that is open in the same browser may send requests here, but the browser names that site as
//! their origin. A site whose name its owner lets point at this machine (DNS rebinding) is named as the host.

use axum::http::header::{HOST, HeaderMap, ORIGIN};
use std::net::IpAddr;

/// What is accepted.
#[derive(Clone, Debug)]
pub(crate) struct Guard {
    /// Names beside `localhost`, in small letters.
    hosts: Vec<String>,
    /// Whether the socket can be reached from other machines, so that any address may be this one's.
    is_open: bool,
}

impl Guard {
    pub(crate) fn new(bound: IpAddr, hosts: &[String]) -> Self {
        let mut hosts: Vec<String> = hosts.iter().map(|host| host.to_ascii_lowercase()).collect();
        hosts.push("localhost".into());
        Guard { hosts, is_open: !bound.is_loopback() }
    }

    /// Why a request is refused, if it is.
    pub(crate) fn refusal(&self, headers: &HeaderMap) -> Option<String> {
        let mut hosts = headers.get_all(HOST).iter();
        let (Some(Ok(host)), None) = (hosts.next().map(|host| host.to_str()), hosts.next()) else {
            return Some("refused: a request names one host".into());
        };
        if !self.is_known(host) {
            let addresses =
                if self.is_open { "addresses" } else { "addresses of this machine alone (127.0.0.1, [::1])" };
            let accepted = format!("accepted: localhost and {addresses}; other names of this machine: --host NAME");
            return Some(format!("refused: the host {host:?} is not this server; {accepted}"));
        }
        let origin = headers.get(ORIGIN)?;
        let of_page = origin.to_str().ok().and_then(|origin| origin.split_once("://"));
        let is_own = of_page.is_some_and(|(scheme, name)| ["http", "https"].contains(&scheme) && name == host);
        (!is_own).then(|| format!("refused: a page of {origin:?} may not ask this server"))
    }

    /// Whether a host's name, with or without a port, is this server's. Ports are not looked at: tunnels change them.
    fn is_known(&self, host: &str) -> bool {
        let name = match host.strip_prefix('[').and_then(|rest| rest.split_once(']')) {
            Some((name, _)) => name,
            None => host.rsplit_once(':').map_or(host, |(name, _)| name),
        };
        match name.parse::<IpAddr>() {
            Ok(address) => address.is_loopback() || self.is_open,
            Err(_) => self.hosts.iter().any(|known| name.eq_ignore_ascii_case(known)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refusal(guard: &Guard, host: &str, origin: Option<&str>) -> Option<String> {
        let mut headers = HeaderMap::new();
        headers.insert(HOST, host.parse().unwrap());
        origin.map(|origin| headers.insert(ORIGIN, origin.parse().unwrap()));
        guard.refusal(&headers)
    }

    #[test]
    fn foreign_hosts_and_origins_are_refused() {
        let guard = Guard::new("127.0.0.1".parse().unwrap(), &["Robot.local".into()]);
        for host in ["localhost:7878", "127.0.0.1:7878", "[::1]:7878", "LOCALHOST", "robot.local:80", "127.0.0.1:9"] {
            assert_eq!(refusal(&guard, host, None), None, "{host}");
            assert_eq!(refusal(&guard, host, Some(&format!("http://{host}"))), None, "{host}");
        }
        for host in
            ["evil.example:7878", "localhost.evil.example", "192.168.1.4:7878", "", "[::1", "127.0.0.1.evil.example"]
        {
            assert!(refusal(&guard, host, None).is_some(), "{host}");
        }
        for origin in ["http://evil.example", "null", "http://localhost:7879", "file://localhost:7878", ""] {
            assert!(refusal(&guard, "localhost:7878", Some(origin)).is_some(), "{origin}");
        }
        let open = Guard::new("0.0.0.0".parse().unwrap(), &[]);
        assert_eq!(refusal(&open, "192.168.1.4:7878", Some("http://192.168.1.4:7878")), None);
        assert!(refusal(&open, "evil.example:7878", None).is_some());
        assert!(open.refusal(&HeaderMap::new()).is_some());
    }
}
