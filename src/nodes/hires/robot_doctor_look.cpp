#include "nodes/hires/robot_doctor_look.h"

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

#include "cli/verbs/doctor/robot_doctor_network.h"
#include "hires/base/error.h"
#include "hires/base/process.h"
#include "hires/ros/master/xmlrpc_master_api.h"
#include "hires/sensing/frame_tree.h"
#include "nodes/hires/data_port.h"

namespace hires_ros {
namespace {

using hires::base::ConfigError;
using hires::cli::Absolute;
using hires::cli::RobotNeeds;
using hires::cli::RobotView;
using hires::cli::SeenFrame;
using hires::cli::SeenMessages;
using hires::cli::SeenTopic;
using hires::cli::WantedTopic;
using hires::relay::Endpoint;
using topic_tools::ShapeShifter;
using Event = ros::MessageEvent<ShapeShifter const>;

constexpr double kMasterTimeout = 2.0;  // [s] for one question to the master
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
class TopicListeners {
 public:
  TopicListeners(const hires::control::RobotNames& names, const std::vector<WantedTopic>& wanted,
                 RobotView* view)
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

  /// Frames get older while nothing comes.
  void Finish() {
    for (auto& [child, frame] : view_->frames) {
      frame.age = (ros::Time::now() - newest_[child]).toSec();
    }
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
    seen.last = hires::base::SteadyNow();
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
    const std::string child = hires::sensing::BareFrame(transform.child_frame_id);
    SeenFrame& frame = view_->frames[child];
    frame.parents.insert(hires::sensing::BareFrame(transform.header.frame_id));
    frame.is_static = is_static;
    ros::Time& newest = newest_[child];
    newest = std::max(newest, transform.header.stamp);
    frame.age = (ros::Time::now() - newest).toSec();
  }

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

void ReadMaster(const hires::control::RobotNames& names, MasterQuestions* master, RobotView* view) {
  ReadGraph(master, view);
  ReadTypes(master, view);
  ReadNodes(master, view);
  view->uses_sim_time = ReadSimTime(master);
  view->has_robot_description = HasParam(master, Absolute(names.robot_description));
  view->this_host = NamesOfThisHost();
  view->own_host = ros::network::getHost();
  const std::string& host = master->endpoint().host;
  view->addresses[host] = hires::cli::AddressesOf(host);
  view->own_address = hires::cli::OwnAddressTowards(master->endpoint());
}

}  // namespace

RobotView LookAtRobot(double seconds, const RobotNeeds& needs) {
  QuietXmlRpc();
  int no_arguments = 0;
  ros::init(no_arguments, nullptr, "hires_doctor",
            ros::init_options::AnonymousName | ros::init_options::NoSigintHandler);
  MasterQuestions master(ros::master::getURI());
  RobotView view;
  view.master_uri = ros::master::getURI();
  view.seconds = seconds;
  ReadMaster(needs.names, &master, &view);
  const std::vector<WantedTopic> wanted = needs.all_topics();
  ros::start();
  const auto ask_data_port = [](const Endpoint& node, const std::string& topic, double timeout) {
    return AskDataPort(node, topic, kName, timeout);
  };
  auto network = std::async(std::launch::async, hires::cli::AskNetwork, ask_data_port,
                            master.endpoint(), view, std::cref(wanted));
  TopicListeners listeners(needs.names, wanted, &view);
  const double end = hires::base::SteadyNow() + seconds;
  while (hires::base::SteadyNow() < end ||
         network.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(kSlice));
  }
  listeners.Finish();
  hires::cli::TakeAnswers(network.get(), &view);
  view.is_heard = IsHeard(view);
  return view;
}

}  // namespace hires_ros
