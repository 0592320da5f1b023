#pragma once

#include <xmlrpcpp/XmlRpcClient.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hires/relay/master_api.h"
#include "hires/relay/uri.h"

namespace hires_ros {

/// Drops what libxmlrpcpp would print on standard error for each refused connection, and ignores
/// SIGPIPE. Process-wide; call once from main().
void QuietXmlRpc();

/// Names and addresses of this computer, for relay::Relay.
hires::relay::HostNames NamesOfThisHost();

/// One XML-RPC server, called with a time limit that holds whatever the server does: refuse, hang,
/// trickle or send without end (replies beyond 16 MB are dropped). Host names are looked up within
/// the same limit. Not for use from two threads at once.
class BoundedXmlRpcClient {
 public:
  /// @param timeout  [s] for one call, everything included.
  BoundedXmlRpcClient(const hires::relay::Endpoint& server, double timeout);
  ~BoundedXmlRpcClient();

  /// The server's value, or nothing when it refused, failed or was late.
  std::optional<XmlRpc::XmlRpcValue> Call(const std::string& method,
                                          const XmlRpc::XmlRpcValue& params);

 private:
  bool EnsureClient();

  hires::relay::Endpoint server_;
  double timeout_;
  std::unique_ptr<XmlRpc::XmlRpcClient> client_;  // nothing until the host name is known
};

/// What a ROS master or node answers: code, message, value.
struct RosReply {
  int code{0};  ///< 1: success
  XmlRpc::XmlRpcValue value;
};

/// Asks for `method`(caller_id, arguments...). Nothing if there was no well-formed answer.
std::optional<RosReply> CallRos(BoundedXmlRpcClient* client, const std::string& method,
                                const std::string& caller_id,
                                const std::vector<std::string>& arguments);

/// Process id of the program that serves ROS's XML-RPC at `server`, or nothing.
std::optional<int> AskPid(const hires::relay::Endpoint& server, const std::string& caller_id,
                          double timeout);

/// A ROS master as the relay sees it.
class XmlRpcMasterApi : public hires::relay::MasterApi {
 public:
  /// @param uri        "http://host:port/".
  /// @param caller_id  Under which questions are asked; registrations carry their own.
  /// @throws hires::base::ConfigError if `uri` is not a URI.
  XmlRpcMasterApi(const std::string& uri, std::string caller_id, double timeout);

  const std::string& uri() const override { return uri_; }
  std::optional<hires::relay::Graph> GetGraph() override;
  std::optional<std::map<std::string, std::string>> GetTopicTypes() override;
  std::optional<std::string> LookupNode(const std::string& node) override;
  std::optional<std::string> LookupService(const std::string& service) override;
  hires::relay::CallResult RegisterPublisher(const std::string& node, const std::string& topic,
                                             const std::string& type,
                                             const std::string& node_uri) override;
  hires::relay::CallResult UnregisterPublisher(const std::string& node, const std::string& topic,
                                               const std::string& node_uri) override;
  hires::relay::CallResult RegisterService(const std::string& node, const std::string& service,
                                           const std::string& service_uri,
                                           const std::string& node_uri) override;
  hires::relay::CallResult UnregisterService(const std::string& node, const std::string& service,
                                             const std::string& service_uri) override;

 private:
  std::optional<std::string> Lookup(const std::string& method, const std::string& name);
  hires::relay::CallResult Change(const std::string& method, const std::string& node,
                                  const std::vector<std::string>& arguments);

  std::string uri_;
  std::string caller_id_;
  BoundedXmlRpcClient client_;
};

/// Pings nodes over XML-RPC, all at once.
class XmlRpcPinger : public hires::relay::NodePinger {
 public:
  XmlRpcPinger(std::string caller_id, double timeout);

  std::vector<hires::relay::PingReply> Ping(const std::vector<std::string>& uris) override;

 private:
  std::string caller_id_;
  double timeout_;  // [s]
};

}  // namespace hires_ros
