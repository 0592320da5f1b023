#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "hires/relay/liveness.h"
#include "hires/relay/master_api.h"
#include "hires/relay/mirror.h"
#include "hires/relay/relay_params.h"
#include "hires/relay/uri.h"

namespace hires::relay {

/// What a relay has to say about itself.
struct RelayStatus {
  bool local_answers{false};
  bool foreign_answers{false};
  std::vector<Registration> at_local;    ///< foreign things, seen at the main master
  std::vector<Registration> at_foreign;  ///< local things, seen at the foreign master
  std::set<Refusal> refused;
};

/// Makes listed publishers and services of two masters visible at each other, by registering at
/// one master, under an alias, the address of the node that is known to the other. Data then flows
/// between the nodes themselves and never through the relay. Subscribers need no mirroring: their
/// own master tells them of the mirrored publisher.
class Relay {
 public:
  /// All pointers must outlive the relay.
  /// @param this_host  Names of the computer the relay runs on, to tell whether a loopback
  ///                   address means the same at both masters.
  Relay(const RelayParams& params, const HostNames& this_host, MasterApi* local, MasterApi* foreign,
        NodePinger* pinger);

  /// One look at both masters and what follows from it. A master that does not answer keeps what
  /// it has; the other one still loses what points to dead nodes.
  /// @param now  [s] on a clock that never jumps.
  void Tick(double now);

  /// Withdraws everything this relay registered, at both masters as far as they answer.
  void WithdrawAll();

  RelayStatus status() const;

 private:
  struct Side {
    MasterApi* api;
    const char* name;            // in log lines
    std::optional<Graph> graph;  // nothing: did not answer in this tick
    bool was_answering{true};
  };
  struct Direction {
    Side* source;
    Side* target;
    Route route;
    std::vector<Offer> offers;                   // as last seen
    std::map<std::string, std::string> aliases;  // own aliases at the target and their addresses
    std::vector<Registration> registered;
    std::set<Refusal> refused;
    std::set<Registration> rejected;  // the target's master answered no; not asked again
  };

  void Observe(Side* side);
  void CollectOffers(Direction* direction);
  void CollectAliases(Direction* direction);
  void PingDue(double now);
  void Serve(Direction* direction);
  MirrorPlan PlanFor(const Direction& direction) const;
  std::vector<Offer> AliveOffers(const Direction& direction) const;
  void AddUnknownHosts(const Direction& direction, MirrorPlan* plan) const;
  std::vector<Registration> RegistrationsOfDead(const Direction& direction) const;
  void Withdraw(const Registration& registration, Direction* direction);
  void Announce(const std::vector<Announcement>& announcements, Direction* direction);
  CallResult AnnounceTopic(const Announcement& announcement, const std::string& type,
                           const Direction& direction) const;
  CallResult AnnounceService(const Announcement& announcement, const Direction& direction) const;
  void OnAnnounced(const Announcement& announcement, CallResult result, Direction* direction);
  void NoteRefusals(const std::vector<Refusal>& refused, Direction* direction);

  AliasNames names_;
  std::string tag_;
  bool is_same_host_;
  NodePinger* pinger_;
  Liveness liveness_;
  std::set<std::string> unknown_hosts_;  // addresses of nodes whose host is unknown here
  Side local_;
  Side foreign_;
  Direction to_foreign_;
  Direction to_local_;
};

}  // namespace hires::relay
