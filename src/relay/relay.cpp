#include "hires/relay/relay.h"

#include <fmt/format.h>

#include <algorithm>

#include "hires/base/check.h"
#include "hires/base/log.h"

namespace hires::relay {
namespace {

bool AreOnOneHost(const MasterApi& a, const MasterApi& b, const HostNames& this_host) {
  const auto at_a = ParseUri(a.uri());
  const auto at_b = ParseUri(b.uri());
  HIRES_CHECK(at_a && at_b, "master addresses are checked where they are read");
  return IsSamePlace(at_a->host, at_b->host, this_host);
}

void LogLine(base::LogLevel level, const std::string& tag, const std::string& text) {
  base::Log(level, fmt::format("relay={} {}", tag, text));
}

}  // namespace

Relay::Relay(const RelayParams& params, const HostNames& this_host, MasterApi* local,
             MasterApi* foreign, NodePinger* pinger)
    : names_(params.alias_prefix, TagOf(params.name_space)),
      tag_(TagOf(params.name_space)),
      is_same_host_(AreOnOneHost(*local, *foreign, this_host)),
      pinger_(pinger),
      liveness_(params.ping_period),
      local_{local, "main", {}},
      foreign_{foreign, "foreign", {}},
      to_foreign_{&local_, &foreign_, params.local, {}, {}, {}, {}, {}},
      to_local_{&foreign_, &local_, params.foreign, {}, {}, {}, {}, {}} {}

void Relay::Tick(double now) {
  Observe(&local_);
  Observe(&foreign_);
  for (Direction* direction : {&to_foreign_, &to_local_}) {
    CollectOffers(direction);
    CollectAliases(direction);
  }
  PingDue(now);
  Serve(&to_foreign_);
  Serve(&to_local_);
}

void Relay::Observe(Side* side) {
  side->graph = side->api->GetGraph();
  const bool is_answering = side->graph.has_value();
  if (is_answering == side->was_answering) return;
  side->was_answering = is_answering;
  LogLine(is_answering ? base::LogLevel::kInfo : base::LogLevel::kWarn, tag_,
          fmt::format("master={} uri={} state={}", side->name, side->api->uri(),
                      is_answering ? "answering" : "silent"));
}

void Relay::CollectOffers(Direction* direction) {
  Side* source = direction->source;
  if (!source->graph) return;
  std::vector<Offer> offers = ListedOffers(*source->graph, direction->route, names_);
  std::map<std::string, std::string> uris;
  for (Offer& offer : offers) {
    const auto [it, is_new] = uris.try_emplace(offer.node);
    if (is_new) {
      const auto uri = source->api->LookupNode(offer.node);
      if (!uri) {  // what was seen before stays until the master answers again
        source->graph.reset();
        return;
      }
      it->second = *uri;
    }
    offer.node_uri = it->second;
  }
  // A node can leave between the two questions.
  offers.erase(std::remove_if(offers.begin(), offers.end(),
                              [](const Offer& offer) { return offer.node_uri.empty(); }),
               offers.end());
  direction->offers = std::move(offers);
}

void Relay::CollectAliases(Direction* direction) {
  Side* target = direction->target;
  if (!target->graph) return;
  direction->registered = OwnRegistrations(*target->graph, names_);
  std::map<std::string, std::string> aliases;
  for (const Registration& registration : direction->registered) {
    if (aliases.count(registration.alias) > 0) continue;
    const auto known = direction->aliases.find(registration.alias);
    const auto uri = known != direction->aliases.end()
                         ? std::optional<std::string>(known->second)
                         : target->api->LookupNode(registration.alias);
    if (!uri) {
      target->graph.reset();
      return;
    }
    aliases[registration.alias] = *uri;
  }
  direction->aliases = std::move(aliases);
}

void Relay::PingDue(double now) {
  std::set<std::string> uris;
  for (const Direction* direction : {&to_foreign_, &to_local_}) {
    for (const Offer& offer : direction->offers) uris.insert(offer.node_uri);
    for (const auto& [alias, uri] : direction->aliases) uris.insert(uri);
  }
  const std::vector<std::string> due = liveness_.Due(uris, now);
  if (due.empty()) return;
  const std::vector<PingReply> replies = pinger_->Ping(due);
  HIRES_CHECK(replies.size() == due.size(), "one reply for each ping");
  for (auto it = unknown_hosts_.begin(); it != unknown_hosts_.end();) {
    it = uris.count(*it) > 0 ? std::next(it) : unknown_hosts_.erase(it);
  }
  for (std::size_t i = 0; i < due.size(); ++i) {
    liveness_.Record(due[i], replies[i]);
    if (replies[i].kind == PingReply::Kind::kUnknown) {
      unknown_hosts_.insert(due[i]);
    } else {
      unknown_hosts_.erase(due[i]);
    }
  }
}

std::vector<Offer> Relay::AliveOffers(const Direction& direction) const {
  std::vector<Offer> alive;
  for (const Offer& offer : direction.offers) {
    if (liveness_.IsAlive(offer.node_uri)) alive.push_back(offer);
  }
  return alive;
}

void Relay::AddUnknownHosts(const Direction& direction, MirrorPlan* plan) const {
  for (const Offer& offer : direction.offers) {
    if (unknown_hosts_.count(offer.node_uri) == 0 || liveness_.IsAlive(offer.node_uri)) continue;
    const std::string host = ParseUri(offer.node_uri)->host;
    plan->refused.push_back(
        {offer.kind, offer.name, offer.node,
         fmt::format("the host name in its address {} cannot be looked up on this computer; add a "
                     "line 'ADDRESS {}' to /etc/hosts here, or start it with ROS_IP=ADDRESS",
                     offer.node_uri, host)});
  }
}

std::vector<Registration> Relay::RegistrationsOfDead(const Direction& direction) const {
  std::vector<Registration> dead;
  for (const Registration& registration : direction.registered) {
    const auto it = direction.aliases.find(registration.alias);
    if (it != direction.aliases.end() && !liveness_.IsAlive(it->second)) {
      dead.push_back(registration);
    }
  }
  return dead;
}

MirrorPlan Relay::PlanFor(const Direction& direction) const {
  if (direction.source->graph) {
    MirrorPlan plan =
        PlanMirror(AliveOffers(direction), *direction.target->graph, names_, is_same_host_);
    AddUnknownHosts(direction, &plan);
    return plan;
  }
  MirrorPlan plan;
  plan.withdraw = RegistrationsOfDead(direction);
  plan.refused.assign(direction.refused.begin(), direction.refused.end());
  return plan;
}

void Relay::Serve(Direction* direction) {
  if (!direction->target->graph) return;
  const MirrorPlan plan = PlanFor(*direction);
  NoteRefusals(plan.refused, direction);
  for (const Registration& registration : plan.withdraw) Withdraw(registration, direction);
  Announce(plan.announce, direction);
}

void Relay::Withdraw(const Registration& registration, Direction* direction) {
  Side* target = direction->target;
  if (!target->graph) return;
  CallResult result = CallResult::kNoAnswer;
  if (registration.kind == Kind::kTopic) {
    result = target->api->UnregisterPublisher(registration.alias, registration.name,
                                              direction->aliases[registration.alias]);
  } else if (const auto uri = target->api->LookupService(registration.name)) {
    result = target->api->UnregisterService(registration.alias, registration.name, *uri);
  }
  if (result == CallResult::kNoAnswer) target->graph.reset();
  if (result != CallResult::kDone) return;
  auto& registered = direction->registered;
  registered.erase(std::remove(registered.begin(), registered.end(), registration),
                   registered.end());
  LogLine(base::LogLevel::kInfo, tag_,
          fmt::format("withdrawn {}={} alias={} master={}", NameOf(registration.kind),
                      registration.name, registration.alias, target->name));
}

void Relay::Announce(const std::vector<Announcement>& announcements, Direction* direction) {
  std::set<Registration> rejected;
  std::swap(rejected, direction->rejected);
  std::optional<std::map<std::string, std::string>> types;  // asked for when needed: it is long
  for (const Announcement& announcement : announcements) {
    const Offer& offer = announcement.offer;
    const Registration registration{offer.kind, offer.name, announcement.alias};
    if (!direction->target->graph) return;
    if (rejected.count(registration) > 0) {
      direction->rejected.insert(registration);
      continue;
    }
    if (offer.kind == Kind::kTopic && !types) types = direction->source->api->GetTopicTypes();
    if (offer.kind == Kind::kTopic && !types) return;
    OnAnnounced(announcement,
                offer.kind == Kind::kTopic
                    ? AnnounceTopic(announcement, (*types)[offer.name], *direction)
                    : AnnounceService(announcement, *direction),
                direction);
  }
}

void Relay::OnAnnounced(const Announcement& announcement, CallResult result, Direction* direction) {
  const Offer& offer = announcement.offer;
  const Registration registration{offer.kind, offer.name, announcement.alias};
  const std::string text =
      fmt::format("{}={} node={} uri={} master={}", NameOf(offer.kind), offer.name, offer.node,
                  offer.node_uri, direction->target->name);
  switch (result) {
    case CallResult::kDone:
      direction->registered.push_back(registration);
      direction->aliases[announcement.alias] = offer.node_uri;
      LogLine(base::LogLevel::kInfo, tag_, "mirrored " + text);
      break;
    case CallResult::kRejected:
      direction->rejected.insert(registration);
      LogLine(base::LogLevel::kWarn, tag_, "rejected by the master: " + text);
      break;
    case CallResult::kNoAnswer:  // the next tick tries again
      break;
  }
}

CallResult Relay::AnnounceTopic(const Announcement& announcement, const std::string& type,
                                const Direction& direction) const {
  // A master knows "*" as long as only subscribers that take any type have come.
  if (type.empty() || type == "*") return CallResult::kNoAnswer;
  const CallResult result = direction.target->api->RegisterPublisher(
      announcement.alias, announcement.offer.name, type, announcement.offer.node_uri);
  if (result == CallResult::kNoAnswer) direction.target->graph.reset();
  return result;
}

CallResult Relay::AnnounceService(const Announcement& announcement,
                                  const Direction& direction) const {
  const auto uri = direction.source->api->LookupService(announcement.offer.name);
  if (!uri) return CallResult::kNoAnswer;
  const auto endpoint = ParseUri(*uri);
  if (!endpoint) return CallResult::kNoAnswer;  // it left in between
  if (IsLoopback(endpoint->host) && !is_same_host_) return CallResult::kRejected;
  const CallResult result = direction.target->api->RegisterService(
      announcement.alias, announcement.offer.name, *uri, announcement.offer.node_uri);
  if (result == CallResult::kNoAnswer) direction.target->graph.reset();
  return result;
}

void Relay::NoteRefusals(const std::vector<Refusal>& refused, Direction* direction) {
  std::set<Refusal> now(refused.begin(), refused.end());
  for (const Refusal& refusal : now) {
    if (direction->refused.count(refusal) > 0) continue;
    LogLine(base::LogLevel::kWarn, tag_,
            fmt::format("refused {}={} node={} master={}: {}", NameOf(refusal.kind), refusal.name,
                        refusal.node, direction->target->name, refusal.reason));
  }
  direction->refused = std::move(now);
}

void Relay::WithdrawAll() {
  for (Direction* direction : {&to_foreign_, &to_local_}) {
    Observe(direction->target);
    CollectAliases(direction);
    const std::vector<Registration> all = direction->registered;
    for (const Registration& registration : all) Withdraw(registration, direction);
  }
}

RelayStatus Relay::status() const {
  RelayStatus status;
  status.local_answers = local_.graph.has_value();
  status.foreign_answers = foreign_.graph.has_value();
  status.at_local = to_local_.registered;
  status.at_foreign = to_foreign_.registered;
  status.refused = to_local_.refused;
  status.refused.insert(to_foreign_.refused.begin(), to_foreign_.refused.end());
  return status;
}

}  // namespace hires::relay
