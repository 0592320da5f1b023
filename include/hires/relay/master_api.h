#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace hires::relay {

/// Who publishes and who provides what at one master, by node name.
struct Graph {
  std::map<std::string, std::set<std::string>> publishers;  ///< topic -> nodes
  std::map<std::string, std::set<std::string>> services;    ///< service -> nodes (at most one)
};

enum class CallResult {
  kDone,
  kRejected,  ///< the master answered, and does not want it
  kNoAnswer,  ///< connection refused, too late or malformed
};

/// The calls of one master that a relay needs. Every call returns within a bounded time; no answer
/// is a value (nothing, or kNoAnswer), never an exception.
class MasterApi {
 public:
  virtual ~MasterApi() = default;

  virtual const std::string& uri() const = 0;

  virtual std::optional<Graph> GetGraph() = 0;
  virtual std::optional<std::map<std::string, std::string>> GetTopicTypes() = 0;

  /// URI of a node or a service; empty text if the master does not know it.
  virtual std::optional<std::string> LookupNode(const std::string& node) = 0;
  virtual std::optional<std::string> LookupService(const std::string& service) = 0;

  /// `node` is the caller id under which the registration stands, `node_uri` the node's XML-RPC
  /// address.
  virtual CallResult RegisterPublisher(const std::string& node, const std::string& topic,
                                       const std::string& type, const std::string& node_uri) = 0;
  virtual CallResult UnregisterPublisher(const std::string& node, const std::string& topic,
                                         const std::string& node_uri) = 0;
  virtual CallResult RegisterService(const std::string& node, const std::string& service,
                                     const std::string& service_uri,
                                     const std::string& node_uri) = 0;
  virtual CallResult UnregisterService(const std::string& node, const std::string& service,
                                       const std::string& service_uri) = 0;
};

/// What a node says when asked for its process id.
struct PingReply {
  enum class Kind {
    kAnswered,
    kRefused,  ///< nothing listens there, or not a node
    kSilent,   ///< no answer in time: stopped, overloaded or cut off
    kUnknown,  ///< its host name cannot be looked up here, or not in time
  };
  Kind kind{Kind::kSilent};
  int pid{0};  ///< only with kAnswered
};

class NodePinger {
 public:
  virtual ~NodePinger() = default;

  /// Asks all at once, so that silent nodes cost the bounded time once and not one by one.
  /// @return One reply for each of `uris`, in their order.
  virtual std::vector<PingReply> Ping(const std::vector<std::string>& uris) = 0;
};

}  // namespace hires::relay
