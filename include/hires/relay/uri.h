#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>

namespace hires::relay {

/// Where a master, a node or a service listens.
struct Endpoint {
  std::string host;  ///< name or address; IPv6 without brackets
  int port{0};       ///< 1 .. 65535

  bool operator==(const Endpoint& other) const { return host == other.host && port == other.port; }
};

/// Reads "http://host:port/" or "rosrpc://host:port"; nothing if it is neither. Masters hand out
/// whatever somebody registered, so a bad address is daily life and no exception.
std::optional<Endpoint> ParseUri(std::string_view uri);

/// @throws base::ConfigError naming `where` unless `uri` reads "http://host:port".
Endpoint RequireMasterUri(const std::string& uri, const std::string& where);

/// "localhost", 127.0.0.0/8 or ::1: an address that means another place on every computer.
bool IsLoopback(const std::string& host);

/// Names and addresses of one computer, in lower case.
using HostNames = std::set<std::string>;

/// Whether two hosts are the same computer as far as can be told from here: both are this one, or
/// both are written alike.
bool IsSamePlace(const std::string& a, const std::string& b, const HostNames& this_host);

}  // namespace hires::relay
