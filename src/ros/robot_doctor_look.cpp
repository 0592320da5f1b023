#include <dynamic_reconfigure/Config.h>
#include <fmt/format.h>
#include <ros/callback_queue.h>
#include <ros/network.h>
#include <ros/ros.h>
#include <ros/topic_manager.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/Bool.h>
#include <tf2_msgs/TFMessage.h>
#include <topic_tools/shape_shifter.h>

#include <algorithm>
#include <cstring>
#include <future>
#include <limits>

#include "hires/base/error.h"
#include "hires/ros/process.h"
#include "hires/ros/robot_doctor.h"
#include "hires/ros/xmlrpc_master_api.h"

namespace hires_ros {
namespace {

using hires::base::ConfigError;
using hires::relay::Endpoint;
using topic_tools::ShapeShifter;
using Event = ros::MessageEvent<ShapeShifter const>;

constexpr double kMasterTimeout = 2.0;  // [s] for one question to the master
constexpr double kProbeTimeout = 1.0;   // [s] for one port of a node
constexpr double kClockTimeout = 1.5;   // [s] until the second of another computer changes
constexpr double kClockWidth = 0.02;    // [s] of bounds that are good enough
constexpr double kSlice = 0.01;         // [s] of waiting for messages
constexpr char kName[] = "/hires_doctor";
constexpr std::size_t kStampOffset = 4;  // [bytes] of a header's stamp, behind its number

// ---------------------------------------------------------------- the master

class MasterQuestions {
 public:
  explicit MasterQuestions(const std::string& uri)
      : uri_(uri),
        endpoint_(hires::relay::RequireMasterUri(uri, "ROS_MASTER_URI")),
        client_(endpoint_, kMasterTimeout) {}

  XmlRpc::XmlRpcValue Ask(const std::string& method, const std::vector<std::string>& arguments) {
    auto reply = CallRos(&client_, method, kName, arguments);
    if (!reply) {
      throw ConfigError(fmt::format(
          "no ROS master answers at {} within {} s; start the robot, and set ROS_MASTER_URI to "
          "its master, e.g. http://pr2:11311 (can this computer look up that name?)",
          uri_, kMasterTimeout));
    }
    return reply->code == 1 ? reply->value : XmlRpc::XmlRpcValue();
  }
  const Endpoint& endpoint() const { return endpoint_; }

 private:
  std::string uri_;
  Endpoint endpoint_;
  BoundedXmlRpcClient client_;
};

/// [[name, [node, ...]], ...]; this program itself is left out.
template <typename Take>
void ForEachEntry(XmlRpc::XmlRpcValue* list, const Take& take) {
  for (int i = 0; i < list->size(); ++i) {
    XmlRpc::XmlRpcValue& entry = (*list)[i];
    for (int k = 0; k < entry[1].size(); ++k) {
      const std::string node = entry[1][k];
      if (node != ros::this_node::getName()) take(static_cast<std::string>(entry[0]), node);
    }
  }
}

void ReadGraph(MasterQuestions* master, RobotView* view) {
  XmlRpc::XmlRpcValue state = master->Ask("getSystemState", {});
  ForEachEntry(&state[0], [&](const std::string& topic, const std::string& node) {
    view->topics[topic].publishers.insert(node);
    view->nodes[node];
  });
  ForEachEntry(&state[1], [&](const std::string& topic, const std::string& node) {
    view->topics[topic].subscribers.insert(node);
    view->nodes[node];
  });
  ForEachEntry(&state[2], [&](const std::string& service, const std::string& node) {
    view->services.insert(service);
    view->nodes[node];
  });
}

void ReadTypes(MasterQuestions* master, RobotView* view) {
  XmlRpc::XmlRpcValue types = master->Ask("getTopicTypes", {});
  if (types.getType() != XmlRpc::XmlRpcValue::TypeArray) return;
  for (int i = 0; i < types.size(); ++i) {
    const auto topic = view->topics.find(static_cast<std::string>(types[i][0]));
    if (topic != view->topics.end()) topic->second.type = static_cast<std::string>(types[i][1]);
  }
}

void ReadNodes(MasterQuestions* master, RobotView* view) {
  for (auto& [name, node] : view->nodes) {
    XmlRpc::XmlRpcValue uri = master->Ask("lookupNode", {name});
    if (uri.getType() == XmlRpc::XmlRpcValue::TypeString) {
      node.uri = static_cast<std::string>(uri);
    }
  }
}

bool HasParam(MasterQuestions* master, const std::string& name) {
  XmlRpc::XmlRpcValue value = master->Ask("hasParam", {name});
  return value.getType() == XmlRpc::XmlRpcValue::TypeBoolean && static_cast<bool>(value);
}

bool ReadSimTime(MasterQuestions* master) {
  if (!HasParam(master, "/use_sim_time")) return false;
  XmlRpc::XmlRpcValue value = master->Ask("getParam", {"/use_sim_time"});
  return value.getType() == XmlRpc::XmlRpcValue::TypeBoolean && static_cast<bool>(value);
}

// ---------------------------------------------------------------- questions to nodes

/// What one node answers. Each is asked on a thread of its own: silent ones take their time.
struct NodeAnswers {
  Reach reach{Reach::kAnswers};
  std::map<std::string, std::pair<Endpoint, Reach>> data;  // by topic
};

NodeAnswers AskNode(const std::string& uri, const std::vector<std::string>& topics) {
  NodeAnswers answers;
  const auto node = hires::relay::ParseUri(uri);
  answers.reach = node ? ProbePort(*node, kProbeTimeout) : Reach::kBadUri;
  if (answers.reach != Reach::kAnswers) return answers;
  for (const std::string& topic : topics) {
    const auto port = AskDataPort(*node, topic, kName, kProbeTimeout);
    if (port) answers.data[topic] = {*port, ProbePort(*port, kProbeTimeout)};
  }
  return answers;
}

/// What all nodes answer, and what follows from it.
struct NetworkAnswers {
  std::map<std::string, NodeAnswers> nodes;
  std::map<std::string, std::vector<std::string>> addresses;
  std::map<std::string, ClockBounds> clocks;
};

/// Wanted topics by the nodes that publish them.
std::map<std::string, std::vector<std::string>> WantedByNode(const std::vector<WantedTopic>& wanted,
                                                             const RobotView& view) {
  std::map<std::string, std::vector<std::string>> topics;
  for (const WantedTopic& one : wanted) {
    const SeenTopic* topic = view.FindTopic(one.name);
    if (topic == nullptr) continue;
    for (const std::string& node : topic->publishers) topics[node].push_back(one.name);
  }
  return topics;
}

std::optional<ClockBounds> CompareWithAny(const std::vector<Endpoint>& servers) {
  for (const Endpoint& server : servers) {
    if (auto bounds = CompareClocks(server, kClockWidth, kClockTimeout)) return bounds;
  }
  return std::nullopt;
}

/// Only programs that answered: each silent one would take the whole time limit.
std::map<std::string, std::vector<Endpoint>> ClockServers(const Endpoint& master,
                                                          const RobotView& view,
                                                          const NetworkAnswers& answers) {
  std::map<std::string, std::vector<Endpoint>> servers;
  if (!view.IsHere(master.host)) servers[master.host].push_back(master);
  for (const auto& [name, node] : answers.nodes) {
    const auto endpoint = hires::relay::ParseUri(view.nodes.at(name).uri);
    if (node.reach != Reach::kAnswers || view.IsHere(endpoint->host)) continue;
    servers[endpoint->host].push_back(*endpoint);
  }
  return servers;
}

void CompareAllClocks(const Endpoint& master, const RobotView& view, NetworkAnswers* answers) {
  std::map<std::string, std::future<std::optional<ClockBounds>>> running;
  for (const auto& [host, servers] : ClockServers(master, view, *answers)) {
    running[host] = std::async(std::launch::async, CompareWithAny, servers);
  }
  for (auto& [host, future] : running) {
    if (const auto bounds = future.get()) answers->clocks[host] = *bounds;
  }
}

/// @param view  what the master said, and who this computer is.
NetworkAnswers AskNetwork(const Endpoint& master, RobotView view,
                          const std::vector<WantedTopic>& wanted) {
  NetworkAnswers answers;
  std::map<std::string, std::future<std::vector<std::string>>> lookups;
  std::map<std::string, std::future<NodeAnswers>> running;
  auto topics = WantedByNode(wanted, view);
  const bool is_master_here = view.IsHere(master.host);
  for (const auto& [name, node] : view.nodes) {
    const std::string host = node.host();
    if (!host.empty() && lookups.count(host) == 0) {
      lookups[host] = std::async(std::launch::async, AddressesOf, host);
    }
    // A loopback address of another computer would lead to a program of this one.
    if (!is_master_here && hires::relay::IsLoopback(host)) continue;
    running[name] = std::async(std::launch::async, AskNode, node.uri, topics[name]);
  }
  for (auto& [host, future] : lookups) answers.addresses[host] = future.get();
  for (auto& [name, future] : running) answers.nodes[name] = future.get();
  view.addresses = answers.addresses;
  CompareAllClocks(master, view, &answers);
  return answers;
}

void TakeAnswers(const NetworkAnswers& answers, RobotView* view) {
  view->addresses = answers.addresses;
  view->clocks = answers.clocks;
  for (const auto& [name, node] : answers.nodes) {
    view->nodes[name].reach = node.reach;
    for (const auto& [topic, data] : node.data) {
      view->topics[topic].data_at[name] = data.first;
      view->topics[topic].data_ports[name] = data.second;
    }
  }
}

// ---------------------------------------------------------------- messages

/// The stamp of a message that begins with a header; nothing if it has none or it is 0.
std::optional<ros::Time> StampOf(const ShapeShifter& message) {
  std::vector<std::uint8_t> bytes(message.size());
  if (bytes.size() < kStampOffset + 2 * sizeof(std::uint32_t)) return std::nullopt;
  ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  message.write(stream);
  std::uint32_t seconds = 0, nanoseconds = 0;
  std::memcpy(&seconds, bytes.data() + kStampOffset, sizeof(seconds));
  std::memcpy(&nanoseconds, bytes.data() + kStampOffset + sizeof(seconds), sizeof(nanoseconds));
  if (seconds == 0 && nanoseconds == 0) return std::nullopt;
  return ros::Time(seconds, nanoseconds % 1000000000u);
}

/// Listens to what is wanted, and to frames. All callbacks run in ros::spinOnce().
class Ears {
 public:
  Ears(const RobotNames& names, const std::vector<WantedTopic>& wanted, RobotView* view)
      : view_(view) {
    for (const WantedTopic& topic : wanted) Listen(topic);
    On<sensor_msgs::JointState>(names.joint_states, [this](const auto& joints) {
      view_->joints.insert(joints.name.begin(), joints.name.end());
    });
    if (!names.motors_halted.empty()) {
      On<std_msgs::Bool>(names.motors_halted,
                         [this](const auto& halted) { view_->motors_halted = halted.data; });
    }
    if (!names.move_base.planner.empty()) {
      On<dynamic_reconfigure::Config>(names.move_base.planner + "/parameter_updates",
                                      [this](const auto& config) { OnParameters(config); });
    }
    ListenToFrames("/tf", false);
    ListenToFrames("/tf_static", true);
  }

 private:
  void Keep(const ros::Subscriber& subscriber) { subscribers_.push_back(subscriber); }

  void Listen(const WantedTopic& wanted) {
    Keep(nh_.subscribe<ShapeShifter>(
        wanted.name, 2000, boost::function<void(const Event&)>([this, wanted](const Event& event) {
          OnMessage(wanted, event);
        })));
  }

  void OnMessage(const WantedTopic& wanted, const Event& event) {
    const ShapeShifter& message = *event.getConstMessage();
    SeenMessages& seen = view_->topics[wanted.name].messages[event.getPublisherName()];
    seen.type = message.getDataType();
    seen.md5 = message.getMD5Sum();
    seen.last = SteadyNow();
    if (seen.count++ == 0) seen.first = seen.last;
    if (!wanted.is_stamped || seen.md5 != wanted.md5) return;
    if (const auto stamp = StampOf(message)) {
      seen.ages.push_back((event.getReceiptTime() - *stamp).toSec());
    }
  }

  /// Messages of that type; others on that topic are another finding.
  template <typename Message, typename Take>
  void On(const std::string& topic, Take take) {
    Keep(nh_.subscribe<ShapeShifter>(
        Absolute(topic), 100, boost::function<void(const Event&)>([take](const Event& event) {
          const ShapeShifter& message = *event.getConstMessage();
          if (message.getMD5Sum() == ros::message_traits::md5sum<Message>()) {
            take(*message.instantiate<Message>());
          }
        })));
  }

  void OnParameters(const dynamic_reconfigure::Config& config) {
    std::set<std::string> names;
    for (const auto& parameter : config.doubles) names.insert(parameter.name);
    for (const auto& parameter : config.ints) names.insert(parameter.name);
    view_->planner_parameters = names;
  }

  void ListenToFrames(const std::string& topic, bool is_static) {
    On<tf2_msgs::TFMessage>(topic, [this, is_static](const auto& message) {
      for (const auto& transform : message.transforms) OnTransform(transform, is_static);
    });
  }

  void OnTransform(const geometry_msgs::TransformStamped& transform, bool is_static) {
    const auto bare = [](const std::string& name) {  // tf wrote names with a slash in front
      return !name.empty() && name.front() == '/' ? name.substr(1) : name;
    };
    const std::string child = bare(transform.child_frame_id);
    SeenFrame& frame = view_->frames[child];
    frame.parents.insert(bare(transform.header.frame_id));
    frame.is_static = is_static;
    ros::Time& newest = newest_[child];
    newest = std::max(newest, transform.header.stamp);
    frame.age = (ros::Time::now() - newest).toSec();
  }

 public:
  /// Frames get older while nothing comes.
  void Finish() {
    for (auto& [child, frame] : view_->frames) {
      frame.age = (ros::Time::now() - newest_[child]).toSec();
    }
  }

 private:
  RobotView* view_;
  ros::NodeHandle nh_;
  std::vector<ros::Subscriber> subscribers_;
  std::map<std::string, ros::Time> newest_;
};

/// Whether the log collector of another computer fetched this node's log; nothing if there is none.
std::optional<bool> IsHeard(const RobotView& view) {
  const SeenTopic* log = view.FindTopic("/rosout");
  if (log == nullptr) return std::nullopt;
  const bool has_remote =
      std::any_of(log->subscribers.begin(), log->subscribers.end(), [&](const auto& node) {
        const std::string host = view.nodes.at(node).host();
        return !host.empty() && !view.IsHere(host);
      });
  if (!has_remote) return std::nullopt;
  return ros::TopicManager::instance()->getNumSubscribers("/rosout") > 0;
}

std::vector<WantedTopic> AllWanted(const RobotNames& names) {
  std::vector<WantedTopic> wanted = TopicsOf(names);
  wanted.push_back(MapOf(names));
  return wanted;
}

void ReadMaster(const RobotNames& names, MasterQuestions* master, RobotView* view) {
  ReadGraph(master, view);
  ReadTypes(master, view);
  ReadNodes(master, view);
  view->uses_sim_time = ReadSimTime(master);
  view->has_robot_description = HasParam(master, Absolute(names.robot_description));
  view->this_host = NamesOfThisHost();
  view->own_host = ros::network::getHost();
  view->own_address = OwnAddressTowards(master->endpoint());
}

}  // namespace

RobotView LookAtRobot(const hires::evaluation::RobotDoctorOptions& options,
                      const RobotNames& names) {
  QuietXmlRpc();
  int no_arguments = 0;
  ros::init(no_arguments, nullptr, "hires_doctor",
            ros::init_options::AnonymousName | ros::init_options::NoSigintHandler);
  MasterQuestions master(ros::master::getURI());
  RobotView view;
  view.master_uri = ros::master::getURI();
  view.seconds = options.seconds;
  ReadMaster(names, &master, &view);
  const std::vector<WantedTopic> wanted = AllWanted(names);
  ros::start();
  auto network =
      std::async(std::launch::async, AskNetwork, master.endpoint(), view, std::cref(wanted));
  Ears ears(names, wanted, &view);
  const double end = SteadyNow() + options.seconds;
  while (SteadyNow() < end ||
         network.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(kSlice));
  }
  ears.Finish();
  TakeAnswers(network.get(), &view);
  view.is_heard = IsHeard(view);
  return view;
}

}  // namespace hires_ros
