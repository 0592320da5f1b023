#pragma once

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "hires/relay/master_api.h"

namespace hires::relay::test_support {

/// A master in memory that behaves as rosmaster does where a relay can notice: a caller id keeps
/// one address, and a second address under the same id sends a shutdown to the first.
class FakeMaster : public MasterApi {
 public:
  explicit FakeMaster(std::string uri) : uri_(std::move(uri)) {}

  bool is_silent{false};               ///< hung: every call comes back without an answer
  std::set<std::string> rejects;       ///< topics it does not want
  std::vector<std::string> shutdowns;  ///< addresses to which a shutdown was sent
  int num_changes{0};                  ///< calls that changed something

  void AddPublisher(const std::string& node, const std::string& topic, const std::string& type,
                    const std::string& node_uri) {
    SetNode(node, node_uri);
    graph_.publishers[topic].insert(node);
    types_[topic] = type;
  }
  void AddService(const std::string& node, const std::string& service,
                  const std::string& service_uri, const std::string& node_uri) {
    SetNode(node, node_uri);
    graph_.services[service] = {node};
    service_uris_[service] = service_uri;
  }
  void RemovePublisher(const std::string& node, const std::string& topic) {
    graph_.publishers[topic].erase(node);
    if (graph_.publishers[topic].empty()) graph_.publishers.erase(topic);
  }
  void RemoveService(const std::string& service) {
    graph_.services.erase(service);
    service_uris_.erase(service);
  }
  /// As a new master process under the same address.
  void Restart() { *this = FakeMaster(uri_); }

  const Graph& graph() const { return graph_; }
  std::string NodeUri(const std::string& node) const {
    return nodes_.count(node) > 0 ? nodes_.at(node) : "";
  }
  std::string ServiceUri(const std::string& service) const {
    return service_uris_.count(service) > 0 ? service_uris_.at(service) : "";
  }

  const std::string& uri() const override { return uri_; }
  std::optional<Graph> GetGraph() override {
    if (is_silent) return std::nullopt;
    return graph_;
  }
  std::optional<std::map<std::string, std::string>> GetTopicTypes() override {
    if (is_silent) return std::nullopt;
    return types_;
  }
  std::optional<std::string> LookupNode(const std::string& node) override {
    if (is_silent) return std::nullopt;
    return NodeUri(node);
  }
  std::optional<std::string> LookupService(const std::string& service) override {
    if (is_silent) return std::nullopt;
    return ServiceUri(service);
  }
  CallResult RegisterPublisher(const std::string& node, const std::string& topic,
                               const std::string& type, const std::string& node_uri) override {
    if (is_silent) return CallResult::kNoAnswer;
    ++num_changes;
    if (rejects.count(topic) > 0) return CallResult::kRejected;
    AddPublisher(node, topic, type, node_uri);
    return CallResult::kDone;
  }
  CallResult UnregisterPublisher(const std::string& node, const std::string& topic,
                                 const std::string& node_uri) override {
    if (is_silent) return CallResult::kNoAnswer;
    ++num_changes;
    if (NodeUri(node) == node_uri) RemovePublisher(node, topic);
    return CallResult::kDone;
  }
  CallResult RegisterService(const std::string& node, const std::string& service,
                             const std::string& service_uri, const std::string& node_uri) override {
    if (is_silent) return CallResult::kNoAnswer;
    ++num_changes;
    AddService(node, service, service_uri, node_uri);
    return CallResult::kDone;
  }
  CallResult UnregisterService(const std::string& node, const std::string& service,
                               const std::string& service_uri) override {
    if (is_silent) return CallResult::kNoAnswer;
    ++num_changes;
    const auto it = graph_.services.find(service);
    const bool is_theirs = it != graph_.services.end() && it->second.count(node) > 0;
    if (is_theirs && ServiceUri(service) == service_uri) RemoveService(service);
    return CallResult::kDone;
  }

 private:
  void SetNode(const std::string& node, const std::string& node_uri) {
    std::string& known = nodes_[node];
    if (!known.empty() && known != node_uri) shutdowns.push_back(known);
    known = node_uri;
  }

  std::string uri_;
  Graph graph_;
  std::map<std::string, std::string> types_;
  std::map<std::string, std::string> nodes_;
  std::map<std::string, std::string> service_uris_;
};

/// Every address answers with process id 1 unless told otherwise.
class FakePinger : public NodePinger {
 public:
  std::map<std::string, PingReply> replies;
  std::vector<std::string> pinged;  ///< every address asked so far, in order

  void Kill(const std::string& uri) { replies[uri] = {PingReply::Kind::kRefused, 0}; }
  void Hang(const std::string& uri) { replies[uri] = {PingReply::Kind::kSilent, 0}; }
  void Forget(const std::string& uri) { replies[uri] = {PingReply::Kind::kUnknown, 0}; }
  void Answer(const std::string& uri, int pid) { replies[uri] = {PingReply::Kind::kAnswered, pid}; }

  std::vector<PingReply> Ping(const std::vector<std::string>& uris) override {
    std::vector<PingReply> answers;
    for (const std::string& uri : uris) {
      pinged.push_back(uri);
      const auto it = replies.find(uri);
      answers.push_back(it != replies.end() ? it->second
                                            : PingReply{PingReply::Kind::kAnswered, 1});
    }
    return answers;
  }
};

}  // namespace hires::relay::test_support
