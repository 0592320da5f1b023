#pragma once

#include <string>
#include <vector>

#include "hires/base/param_reader.h"
#include "hires/relay/name_filter.h"

namespace hires::relay {

/// What one side offers the other.
struct Route {
  NameFilter topics;    ///< published here, to be seen there
  NameFilter services;  ///< provided here, to be called from there
};

/// What a relay does. "Local" is the main master, "foreign" the worker's.
struct RelayParams {
  std::string foreign_master;             ///< URI, "http://host:port/"
  std::string name_space;                 ///< what {ns} stands for: "/worker_1", or empty
  std::string alias_prefix{"/mirrored"};  ///< root of the names under which mirrors register
  double poll_period{0.05};               ///< [s] between two looks at both masters
  double ping_period{1.0};                ///< [s] between two pings of one mirrored node
  double call_timeout{0.5};               ///< [s] after which a call counts as not answered
  Route local;                            ///< from the main master to the foreign one
  Route foreign;                          ///< from the foreign master to the main one
};

/// What a node's own parameters put in the place of the file's values; empty means the file's.
struct RelayOverrides {
  std::string foreign_master;
  std::string name_space;
};

/// Reads config/relay.yaml; all keys but `actions` are required.
/// @throws base::ConfigError for a missing, unknown or unfit key, and when nothing would cross.
RelayParams ReadRelayParams(base::ParamReader in, const RelayOverrides& overrides = {});

/// Part of the alias names that tells this relay from others: "worker_1" for "/worker_1", "relay"
/// without a namespace.
std::string TagOf(const std::string& name_space);

}  // namespace hires::relay
