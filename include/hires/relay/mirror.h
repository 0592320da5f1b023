#pragma once

#include <string>
#include <tuple>
#include <vector>

#include "hires/relay/master_api.h"
#include "hires/relay/relay_params.h"

namespace hires::relay {

enum class Kind { kTopic, kService };
const char* NameOf(Kind kind);  ///< "topic", "service"

/// A publisher or a service of one master that may be seen at the other.
struct Offer {
  Kind kind{Kind::kTopic};
  std::string name;      ///< of the topic or service
  std::string node;      ///< its name at home
  std::string node_uri;  ///< its XML-RPC address
};

/// One of the relay's own registrations at a master.
struct Registration {
  Kind kind{Kind::kTopic};
  std::string name;
  std::string alias;

  bool operator<(const Registration& other) const {
    return std::tie(kind, name, alias) < std::tie(other.kind, other.name, other.alias);
  }
  bool operator==(const Registration& other) const {
    return std::tie(kind, name, alias) == std::tie(other.kind, other.name, other.alias);
  }
};

/// Why something listed does not cross.
struct Refusal {
  Kind kind{Kind::kTopic};
  std::string name;
  std::string node;
  std::string reason;

  bool operator<(const Refusal& other) const {
    return std::tie(kind, name, node, reason) <
           std::tie(other.kind, other.name, other.node, other.reason);
  }
};

/// Names under which a relay registers at a master what lives at the other:
/// `<prefix>/<tag>/<node>_<digits>`. A master that hears a node's own name twice shuts that node
/// down, hence aliases. The digits stand for the address: a node that comes back elsewhere gets
/// another alias, so an alias never changes its address, which would make the master send a
/// shutdown to the process at the old one.
class AliasNames {
 public:
  AliasNames(std::string prefix, const std::string& tag);

  std::string AliasOf(const std::string& node, const std::string& node_uri) const;
  bool IsOwn(const std::string& node) const;  ///< registered by this relay, or an earlier run of it
  bool IsAnyAlias(const std::string& node) const;  ///< by this or another relay

 private:
  std::string any_;  // "/mirrored/"
  std::string own_;  // "/mirrored/worker_1/"
};

/// Registrations at a master that this relay made, in order.
std::vector<Registration> OwnRegistrations(const Graph& graph, const AliasNames& names);

/// Listed publishers and services of a master (never aliases), by (kind, name, node); addresses
/// are left empty.
std::vector<Offer> ListedOffers(const Graph& graph, const Route& route, const AliasNames& names);

struct Announcement {
  Offer offer;
  std::string alias;
};

/// What to do at one master; withdrawals first, so that a service can change its provider.
struct MirrorPlan {
  std::vector<Registration> withdraw;
  std::vector<Announcement> announce;
  std::vector<Refusal> refused;
};

/// Compares what should be registered at a master with what is. It needs no memory: a restarted
/// master lacks the registrations and gets them again; what an earlier run of this relay left is
/// kept where it is right and withdrawn where not.
/// @param offers        Living publishers and services of the other master, addresses known.
/// @param target        What stands at the master now.
/// @param is_same_host  Both masters run on one computer, so that a loopback address means the
///                      same node at both.
MirrorPlan PlanMirror(const std::vector<Offer>& offers, const Graph& target,
                      const AliasNames& names, bool is_same_host);

}  // namespace hires::relay
