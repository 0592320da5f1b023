#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "hires/relay/master_api.h"

namespace hires::relay {

/// Which nodes still live, told from pings. A master never notices that a node was killed: its
/// registrations stay until they are withdrawn.
class Liveness {
 public:
  /// Silent pings in a row after which a node counts as gone; a stopped or busy one gets this long.
  static constexpr int kMaxSilent = 3;

  /// @param period  [s] between two pings of one node, > 0.
  explicit Liveness(double period);

  /// Forgets all nodes but `uris` and returns those of them to ping now: new ones at once, others
  /// every period. @param now [s] on a clock that never jumps.
  std::vector<std::string> Due(const std::set<std::string>& uris, double now);

  void Record(const std::string& uri, const PingReply& reply);

  /// True from the first answer until a refusal, kMaxSilent silences in a row, or an answer by
  /// another process (the port was taken over; the next answer starts a new life).
  bool IsAlive(const std::string& uri) const;

 private:
  struct Node {
    double next_ping{0.0};  // [s]
    int pid{0};             // 0: none known
    int num_silent{0};
    bool is_alive{false};
  };
  static void RecordAnswer(int pid, Node* node);

  double period_;
  std::map<std::string, Node> nodes_;
};

}  // namespace hires::relay
