#include "hires/relay/mirror.h"

#include <set>

#include "hires/base/hash.h"
#include "hires/relay/uri.h"

namespace hires::relay {
namespace {

using Providers = std::map<std::string, std::set<std::string>>;

const Providers& ProvidersOf(Kind kind, const Graph& graph) {
  return kind == Kind::kTopic ? graph.publishers : graph.services;
}

const NameFilter& FilterOf(Kind kind, const Route& route) {
  return kind == Kind::kTopic ? route.topics : route.services;
}

void AppendOwn(Kind kind, const Graph& graph, const AliasNames& names,
               std::vector<Registration>* own) {
  for (const auto& [name, nodes] : ProvidersOf(kind, graph)) {
    for (const std::string& node : nodes) {
      if (names.IsOwn(node)) own->push_back({kind, name, node});
    }
  }
}

void AppendListed(Kind kind, const Graph& graph, const Route& route, const AliasNames& names,
                  std::vector<Offer>* offers) {
  for (const auto& [name, nodes] : ProvidersOf(kind, graph)) {
    if (!FilterOf(kind, route).Matches(name)) continue;
    for (const std::string& node : nodes) {
      if (!names.IsAnyAlias(node)) offers->push_back({kind, name, node, ""});
    }
  }
}

/// Who else provides the service at the target; empty if no node does.
std::string OtherProvider(const Offer& offer, const Graph& target, const AliasNames& names) {
  const auto it = target.services.find(offer.name);
  if (offer.kind != Kind::kService || it == target.services.end()) return "";
  for (const std::string& node : it->second) {
    if (!names.IsOwn(node)) return node;
  }
  return "";
}

/// Empty text if nothing speaks against it.
std::string ReasonToRefuse(const Offer& offer, const Graph& target, const AliasNames& names,
                           bool is_same_host) {
  const auto endpoint = ParseUri(offer.node_uri);
  if (!endpoint) return "its address '" + offer.node_uri + "' is no http://host:port";
  if (IsLoopback(endpoint->host) && !is_same_host) {
    return "its address " + offer.node_uri +
           " means another computer at the other master; start it with ROS_IP set to an address "
           "that others can reach";
  }
  const std::string other = OtherProvider(offer, target, names);
  if (!other.empty()) return "the other master has this service already, from " + other;
  return "";
}

}  // namespace

const char* NameOf(Kind kind) { return kind == Kind::kTopic ? "topic" : "service"; }

AliasNames::AliasNames(std::string prefix, const std::string& tag)
    : any_(std::move(prefix) + "/"), own_(any_ + tag + "/") {}

std::string AliasNames::AliasOf(const std::string& node, const std::string& node_uri) const {
  base::Hasher hasher;
  hasher.Add(node_uri);
  const std::string plain = node.rfind('/', 0) == 0 ? node.substr(1) : node;
  return own_ + plain + "_" + base::HexOf(hasher.value()).substr(0, 8);
}

bool AliasNames::IsOwn(const std::string& node) const { return node.rfind(own_, 0) == 0; }
bool AliasNames::IsAnyAlias(const std::string& node) const { return node.rfind(any_, 0) == 0; }

std::vector<Registration> OwnRegistrations(const Graph& graph, const AliasNames& names) {
  std::vector<Registration> own;
  AppendOwn(Kind::kTopic, graph, names, &own);
  AppendOwn(Kind::kService, graph, names, &own);
  return own;
}

std::vector<Offer> ListedOffers(const Graph& graph, const Route& route, const AliasNames& names) {
  std::vector<Offer> offers;
  AppendListed(Kind::kTopic, graph, route, names, &offers);
  AppendListed(Kind::kService, graph, route, names, &offers);
  return offers;
}

MirrorPlan PlanMirror(const std::vector<Offer>& offers, const Graph& target,
                      const AliasNames& names, bool is_same_host) {
  MirrorPlan plan;
  const std::vector<Registration> own = OwnRegistrations(target, names);
  const std::set<Registration> standing(own.begin(), own.end());
  std::set<Registration> wanted;
  for (const Offer& offer : offers) {
    const std::string reason = ReasonToRefuse(offer, target, names, is_same_host);
    if (!reason.empty()) {
      plan.refused.push_back({offer.kind, offer.name, offer.node, reason});
      continue;
    }
    const Registration registration{offer.kind, offer.name,
                                    names.AliasOf(offer.node, offer.node_uri)};
    wanted.insert(registration);
    if (standing.count(registration) == 0) plan.announce.push_back({offer, registration.alias});
  }
  for (const Registration& registration : own) {
    if (wanted.count(registration) == 0) plan.withdraw.push_back(registration);
  }
  return plan;
}

}  // namespace hires::relay
