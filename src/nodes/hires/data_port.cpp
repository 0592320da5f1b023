#include "nodes/hires/data_port.h"

#include <xmlrpcpp/XmlRpcException.h>

#include "hires/ros/master/xmlrpc_master_api.h"

namespace hires_ros {

using hires::relay::Endpoint;

std::optional<Endpoint> AskDataPort(const Endpoint& node, const std::string& topic,
                                    const std::string& caller_id, double timeout) {
  BoundedXmlRpcClient client(node, timeout);
  XmlRpc::XmlRpcValue params;
  params[0] = caller_id;
  params[1] = topic;
  params[2][0][0] = std::string("TCPROS");
  auto value = client.Call("requestTopic", params);
  try {
    // [code, message, ["TCPROS", host, port]]
    if (!value || value->size() != 3 || (*value)[2].size() != 3) return std::nullopt;
    return Endpoint{static_cast<std::string>((*value)[2][1]), static_cast<int>((*value)[2][2])};
  } catch (const XmlRpc::XmlRpcException&) {
    return std::nullopt;
  }
}

}  // namespace hires_ros
