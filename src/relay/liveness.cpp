#include "hires/relay/liveness.h"

#include "hires/base/check.h"

namespace hires::relay {

Liveness::Liveness(double period) : period_(period) {
  HIRES_CHECK(period > 0.0, "a ping period is above 0 s");
}

std::vector<std::string> Liveness::Due(const std::set<std::string>& uris, double now) {
  for (auto it = nodes_.begin(); it != nodes_.end();) {
    it = uris.count(it->first) > 0 ? std::next(it) : nodes_.erase(it);
  }
  std::vector<std::string> due;
  for (const std::string& uri : uris) {
    Node& node = nodes_.try_emplace(uri, Node{now}).first->second;
    if (now < node.next_ping) continue;
    node.next_ping = now + period_;
    due.push_back(uri);
  }
  return due;
}

void Liveness::RecordAnswer(int pid, Node* node) {
  node->num_silent = 0;
  const bool is_other_process = node->pid != 0 && node->pid != pid;
  node->is_alive = !is_other_process;
  node->pid = pid;
  if (is_other_process) node->next_ping = 0.0;
}

void Liveness::Record(const std::string& uri, const PingReply& reply) {
  const auto it = nodes_.find(uri);
  HIRES_CHECK(it != nodes_.end(), "only nodes that Due() named are recorded");
  Node& node = it->second;
  switch (reply.kind) {
    case PingReply::Kind::kAnswered:
      RecordAnswer(reply.pid, &node);
      break;
    case PingReply::Kind::kRefused:
      node.is_alive = false;
      node.pid = 0;
      break;
    case PingReply::Kind::kSilent:
    case PingReply::Kind::kUnknown:  // a name server may be away for a while
      if (++node.num_silent >= kMaxSilent) node.is_alive = false;
      break;
  }
}

bool Liveness::IsAlive(const std::string& uri) const {
  const auto it = nodes_.find(uri);
  return it != nodes_.end() && it->second.is_alive;
}

}  // namespace hires::relay
