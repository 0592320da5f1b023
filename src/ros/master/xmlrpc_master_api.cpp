#include "hires/ros/master/xmlrpc_master_api.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <netdb.h>
#include <netinet/in.h>
#include <unistd.h>
#include <xmlrpcpp/XmlRpcDispatch.h>
#include <xmlrpcpp/XmlRpcException.h>
#include <xmlrpcpp/XmlRpcUtil.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>

#include "hires/base/text.h"

namespace hires_ros {
namespace {

using hires::relay::CallResult;
using hires::relay::Endpoint;
using hires::relay::Graph;
using hires::relay::HostNames;
using hires::relay::PingReply;
using SteadyClock = std::chrono::steady_clock;
using XmlRpc::XmlRpcDispatch;
using XmlRpc::XmlRpcValue;

constexpr int kLongestReply = 16 << 20;  // [bytes]
constexpr double kSlice = 0.02;          // [s] longest wait before limits are looked at again

double SecondsUntil(SteadyClock::time_point end) {
  return std::chrono::duration<double>(end - SteadyClock::now()).count();
}

SteadyClock::time_point EndOf(double timeout) {
  return SteadyClock::now() +
         std::chrono::duration_cast<SteadyClock::duration>(std::chrono::duration<double>(timeout));
}

/// Shows what libxmlrpcpp keeps to itself: whether the exchange is complete, and how long it got.
class Client : public XmlRpc::XmlRpcClient {
 public:
  using XmlRpc::XmlRpcClient::XmlRpcClient;
  bool IsTooLong() const { return _contentLength > kLongestReply || TextLength() > kLongestReply; }
  bool IsIdle() const { return _connectionState == IDLE; }

 private:
  int TextLength() const { return static_cast<int>(std::max(_header.size(), _response.size())); }
};

/// Keeps quiet. It must not log: a log line can itself lead to an XML-RPC call that fails.
class SilentErrorHandler : public XmlRpc::XmlRpcErrorHandler {
 public:
  void error(const char*) override {}
};

std::string Numeric(const sockaddr* address, socklen_t size) {
  std::array<char, NI_MAXHOST> text{};
  if (getnameinfo(address, size, text.data(), text.size(), nullptr, 0, NI_NUMERICHOST) != 0) {
    return "";
  }
  return text.data();
}

bool IsNumeric(const std::string& host) {
  in6_addr address;
  return inet_pton(AF_INET, host.c_str(), &address) == 1 ||
         inet_pton(AF_INET6, host.c_str(), &address) == 1;
}

/// A look-up in flight. getaddrinfo() can block for many seconds when a name server is away, and
/// cannot be stopped; so the request lives on the heap and is left behind if it is late.
struct Resolution {
  explicit Resolution(std::string name) : host(std::move(name)) {
    hints.ai_family = AF_INET;  // as roscpp, which speaks IPv6 only when ROS_IPV6 says so
    hints.ai_socktype = SOCK_STREAM;
    request.ar_name = host.c_str();
    request.ar_request = &hints;
  }
  ~Resolution() {
    if (request.ar_result != nullptr) freeaddrinfo(request.ar_result);
  }
  std::string host;
  addrinfo hints{};
  gaicb request{};
};

void WaitFor(gaicb* request, SteadyClock::time_point end) {
  const gaicb* const list[] = {request};
  while (gai_error(request) == EAI_INPROGRESS) {
    const double left = SecondsUntil(end);
    if (left <= 0.0) return;
    timespec timeout{static_cast<time_t>(left), static_cast<long>((left - std::floor(left)) * 1e9)};
    gai_suspend(list, 1, &timeout);
  }
}

/// Address of `host` as digits; nothing if it is unknown or the look-up was late.
std::optional<std::string> Resolve(const std::string& host, SteadyClock::time_point end) {
  if (IsNumeric(host)) return host;
  auto resolution = std::make_unique<Resolution>(host);
  gaicb* list[] = {&resolution->request};
  if (getaddrinfo_a(GAI_NOWAIT, list, 1, nullptr) != 0) return std::nullopt;
  WaitFor(list[0], end);
  const int state = gai_error(list[0]);
  if (state == EAI_INPROGRESS && gai_cancel(list[0]) != EAI_CANCELED) {
    resolution.release();  // still written to by the resolver's thread
    return std::nullopt;
  }
  if (state != 0 || resolution->request.ar_result == nullptr) return std::nullopt;
  const addrinfo* found = resolution->request.ar_result;
  const std::string address = Numeric(found->ai_addr, found->ai_addrlen);
  if (address.empty()) return std::nullopt;
  return address;
}

/// Works until nothing is left to wait for, a reply gets too long, or time is up.
template <typename IsTooLong>
void WorkUntil(XmlRpcDispatch* dispatch, SteadyClock::time_point end,
               const IsTooLong& is_too_long) {
  while (!dispatch->_sources.empty()) {
    const double left = SecondsUntil(end);
    if (left <= 0.0 || is_too_long()) return;
    dispatch->work(std::min(left, kSlice));
  }
}

std::optional<RosReply> ReadRosReply(XmlRpcValue* value) {
  try {
    if (value->getType() != XmlRpcValue::TypeArray || value->size() != 3) return std::nullopt;
    return RosReply{static_cast<int>((*value)[0]), (*value)[2]};
  } catch (const XmlRpc::XmlRpcException&) {
    return std::nullopt;
  }
}

/// [[name, [node, ...]], ...]
std::map<std::string, std::set<std::string>> ReadProviders(XmlRpcValue* list) {
  std::map<std::string, std::set<std::string>> providers;
  for (int i = 0; i < list->size(); ++i) {
    XmlRpcValue& entry = (*list)[i];
    std::set<std::string>& nodes = providers[static_cast<std::string>(entry[0])];
    for (int k = 0; k < entry[1].size(); ++k) nodes.insert(static_cast<std::string>(entry[1][k]));
  }
  return providers;
}

bool IsList(XmlRpcValue* value) { return value->getType() == XmlRpcValue::TypeArray; }

/// One ping in flight.
struct PingCall {
  std::unique_ptr<Client> client;
  PingReply::Kind kind{PingReply::Kind::kRefused};
};

PingCall StartPing(const std::string& uri, const XmlRpcValue& params, SteadyClock::time_point end,
                   XmlRpcDispatch* dispatch) {
  PingCall call;
  const auto endpoint = hires::relay::ParseUri(uri);
  if (!endpoint) return call;
  const auto address = Resolve(endpoint->host, end);
  if (!address) {
    call.kind = PingReply::Kind::kUnknown;
    return call;
  }
  call.client = std::make_unique<Client>(address->c_str(), endpoint->port, "/");
  if (!call.client->executeNonBlock("getPid", params)) {
    call.client.reset();
    return call;
  }
  call.client->_disp.removeSource(call.client.get());
  dispatch->addSource(call.client.get(), XmlRpcDispatch::WritableEvent | XmlRpcDispatch::Exception);
  return call;
}

bool IsWaiting(const XmlRpcDispatch& dispatch, const Client* client) {
  for (const auto& source : dispatch._sources) {
    if (source.getSource() == client) return true;
  }
  return false;
}

PingReply FinishPing(PingCall* call, XmlRpcDispatch* dispatch) {
  if (!call->client) return {call->kind, 0};
  const bool is_waiting = IsWaiting(*dispatch, call->client.get());
  dispatch->removeSource(call->client.get());
  if (is_waiting) return {PingReply::Kind::kSilent, 0};
  XmlRpcValue value;
  if (!call->client->IsIdle() || !call->client->executeCheckDone(value)) {
    return {PingReply::Kind::kRefused, 0};
  }
  auto reply = ReadRosReply(&value);
  if (!reply || reply->code != 1 || reply->value.getType() != XmlRpcValue::TypeInt) {
    return {PingReply::Kind::kRefused, 0};
  }
  return {PingReply::Kind::kAnswered, static_cast<int>(reply->value)};
}

}  // namespace

void QuietXmlRpc() {
  static SilentErrorHandler handler;
  XmlRpc::XmlRpcErrorHandler::setErrorHandler(&handler);
  std::signal(SIGPIPE, SIG_IGN);  // a connection that breaks is an answer, not a reason to die
}

HostNames NamesOfThisHost() {
  HostNames names;
  std::array<char, 256> name{};
  if (gethostname(name.data(), name.size() - 1) == 0) {
    names.insert(hires::base::ToLower(name.data()));
  }
  ifaddrs* interfaces = nullptr;
  if (getifaddrs(&interfaces) != 0) return names;
  for (const ifaddrs* it = interfaces; it != nullptr; it = it->ifa_next) {
    if (it->ifa_addr == nullptr) continue;
    const int family = it->ifa_addr->sa_family;
    if (family == AF_INET) names.insert(Numeric(it->ifa_addr, sizeof(sockaddr_in)));
    if (family == AF_INET6) names.insert(Numeric(it->ifa_addr, sizeof(sockaddr_in6)));
  }
  freeifaddrs(interfaces);
  names.erase("");
  return names;
}

BoundedXmlRpcClient::BoundedXmlRpcClient(const Endpoint& server, double timeout)
    : server_(server), timeout_(timeout) {}

BoundedXmlRpcClient::~BoundedXmlRpcClient() = default;

bool BoundedXmlRpcClient::EnsureClient() {
  if (client_) return true;
  const auto address = Resolve(server_.host, EndOf(timeout_));
  if (!address) return false;
  client_ = std::make_unique<Client>(address->c_str(), server_.port, "/");
  return true;
}

std::optional<XmlRpcValue> BoundedXmlRpcClient::Call(const std::string& method,
                                                     const XmlRpcValue& params) {
  const auto end = EndOf(timeout_);
  if (!EnsureClient()) return std::nullopt;
  auto* client = static_cast<Client*>(client_.get());
  XmlRpcValue value;
  const bool is_started = client->executeNonBlock(method.c_str(), params);
  if (is_started) {
    WorkUntil(&client->_disp, end, [client] { return client->IsTooLong(); });
  }
  if (!is_started || !client->IsIdle() || !client->executeCheckDone(value) || client->isFault() ||
      !value.valid()) {
    client_.reset();  // the next call connects again and looks the name up again
    return std::nullopt;
  }
  return value;
}

std::optional<RosReply> CallRos(BoundedXmlRpcClient* client, const std::string& method,
                                const std::string& caller_id,
                                const std::vector<std::string>& arguments) {
  XmlRpcValue params;
  params[0] = caller_id;
  for (std::size_t i = 0; i < arguments.size(); ++i) params[static_cast<int>(i) + 1] = arguments[i];
  auto value = client->Call(method, params);
  if (!value) return std::nullopt;
  return ReadRosReply(&*value);
}

std::optional<int> AskPid(const Endpoint& server, const std::string& caller_id, double timeout) {
  BoundedXmlRpcClient client(server, timeout);
  auto reply = CallRos(&client, "getPid", caller_id, {});
  if (!reply || reply->code != 1 || reply->value.getType() != XmlRpcValue::TypeInt) {
    return std::nullopt;
  }
  return static_cast<int>(reply->value);
}

XmlRpcMasterApi::XmlRpcMasterApi(const std::string& uri, std::string caller_id, double timeout)
    : uri_(uri),
      caller_id_(std::move(caller_id)),
      client_(hires::relay::RequireMasterUri(uri, "the master's address"), timeout) {}

std::optional<Graph> XmlRpcMasterApi::GetGraph() {
  auto reply = CallRos(&client_, "getSystemState", caller_id_, {});
  if (!reply || reply->code != 1 || !IsList(&reply->value) || reply->value.size() != 3) {
    return std::nullopt;
  }
  try {
    return Graph{ReadProviders(&reply->value[0]), ReadProviders(&reply->value[2])};
  } catch (const XmlRpc::XmlRpcException&) {
    return std::nullopt;
  }
}

std::optional<std::map<std::string, std::string>> XmlRpcMasterApi::GetTopicTypes() {
  auto reply = CallRos(&client_, "getTopicTypes", caller_id_, {});
  if (!reply || reply->code != 1 || !IsList(&reply->value)) return std::nullopt;
  std::map<std::string, std::string> types;
  try {
    for (int i = 0; i < reply->value.size(); ++i) {
      XmlRpcValue& entry = reply->value[i];
      types[static_cast<std::string>(entry[0])] = static_cast<std::string>(entry[1]);
    }
  } catch (const XmlRpc::XmlRpcException&) {
    return std::nullopt;
  }
  return types;
}

std::optional<std::string> XmlRpcMasterApi::Lookup(const std::string& method,
                                                   const std::string& name) {
  auto reply = CallRos(&client_, method, caller_id_, {name});
  if (!reply) return std::nullopt;
  if (reply->code != 1 || reply->value.getType() != XmlRpcValue::TypeString) return "";
  return static_cast<std::string>(reply->value);
}

std::optional<std::string> XmlRpcMasterApi::LookupNode(const std::string& node) {
  return Lookup("lookupNode", node);
}

std::optional<std::string> XmlRpcMasterApi::LookupService(const std::string& service) {
  return Lookup("lookupService", service);
}

CallResult XmlRpcMasterApi::Change(const std::string& method, const std::string& node,
                                   const std::vector<std::string>& arguments) {
  const auto reply = CallRos(&client_, method, node, arguments);
  if (!reply) return CallResult::kNoAnswer;
  return reply->code == 1 ? CallResult::kDone : CallResult::kRejected;
}

CallResult XmlRpcMasterApi::RegisterPublisher(const std::string& node, const std::string& topic,
                                              const std::string& type,
                                              const std::string& node_uri) {
  return Change("registerPublisher", node, {topic, type, node_uri});
}

CallResult XmlRpcMasterApi::UnregisterPublisher(const std::string& node, const std::string& topic,
                                                const std::string& node_uri) {
  return Change("unregisterPublisher", node, {topic, node_uri});
}

CallResult XmlRpcMasterApi::RegisterService(const std::string& node, const std::string& service,
                                            const std::string& service_uri,
                                            const std::string& node_uri) {
  return Change("registerService", node, {service, service_uri, node_uri});
}

CallResult XmlRpcMasterApi::UnregisterService(const std::string& node, const std::string& service,
                                              const std::string& service_uri) {
  return Change("unregisterService", node, {service, service_uri});
}

XmlRpcPinger::XmlRpcPinger(std::string caller_id, double timeout)
    : caller_id_(std::move(caller_id)), timeout_(timeout) {}

std::vector<PingReply> XmlRpcPinger::Ping(const std::vector<std::string>& uris) {
  const auto end = EndOf(timeout_);
  XmlRpcValue params;
  params[0] = caller_id_;
  XmlRpcDispatch dispatch;
  std::vector<PingCall> calls;
  for (const std::string& uri : uris) calls.push_back(StartPing(uri, params, end, &dispatch));
  WorkUntil(&dispatch, end, [&calls] {
    return std::any_of(calls.begin(), calls.end(), [](const PingCall& call) {
      return call.client && call.client->IsTooLong();
    });
  });
  std::vector<PingReply> replies;
  for (PingCall& call : calls) replies.push_back(FinishPing(&call, &dispatch));
  return replies;
}

}  // namespace hires_ros
