#include "nodes/hires/watch.h"

#include <fmt/format.h>
#include <nav_msgs/Odometry.h>
#include <poll.h>
#include <ros/ros.h>
#include <rosbag/view.h>
#include <rosgraph_msgs/Clock.h>
#include <std_msgs/String.h>
#include <termios.h>
#include <topic_tools/shape_shifter.h>
#include <unistd.h>
#include <yaml-cpp/yaml.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fstream>
#include <iostream>
#include <map>
#include <optional>
#include <set>

#include "cli/exit_code.h"
#include "cli/verbs/imagine/playback.h"
#include "hires/base/error.h"
#include "hires/base/process.h"
#include "hires/base/run_processes.h"
#include "hires/base/text.h"
#include "nodes/hires/bag_file.h"

namespace hires_ros {
namespace {

using hires::base::ConfigError;
using topic_tools::ShapeShifter;

constexpr double kTick = 0.02;            // [s]
constexpr double kMasterPatience = 20.0;  // [s]
constexpr int kSliderWidth = 40;
constexpr char kOdometry[] = "/base_odometry/odom";
constexpr char kBaseInConfiguration[] = "base_footprint";

struct WatchOptions {
  std::string bag, configuration;
  bool no_rviz{false}, paused{false};
};

/// One message of the bag.
struct Recorded {
  double time{0.0};  // [s]
  std::string topic;
  ShapeShifter::ConstPtr message;
};

struct Recording {
  std::vector<Recorded> messages;  // by time
  std::string base_link;           // that the odometry is of; or empty
};

/// Values of keys that name topics in a configuration of RViz.
void CollectTopics(const YAML::Node& node, std::set<std::string>* topics) {
  if (node.IsSequence()) {
    for (const YAML::Node& item : node) CollectTopics(item, topics);
  }
  if (!node.IsMap()) return;
  for (const auto& entry : node) {
    const auto key = entry.first.as<std::string>();
    const bool is_topic = key == "Topic" || key == "Marker Topic";
    if (is_topic && entry.second.IsScalar()) topics->insert(entry.second.as<std::string>());
    CollectTopics(entry.second, topics);
  }
}

std::set<std::string> TopicsOfConfiguration(const std::string& path) {
  std::set<std::string> topics;
  try {
    CollectTopics(YAML::LoadFile(path), &topics);
  } catch (const YAML::Exception& error) {
    throw ConfigError(fmt::format("{}: no configuration of RViz ({}); name one that RViz saved",
                                  path, error.what()));
  }
  return topics;
}

/// What RViz would show nothing of.
void RequireTopics(const WatchOptions& options, const std::vector<BagTopic>& topics) {
  std::vector<std::string> missing;
  for (const std::string& wanted : TopicsOfConfiguration(options.configuration)) {
    const bool is_there = std::any_of(topics.begin(), topics.end(), [&](const BagTopic& t) {
      return t.name == wanted && t.num_messages > 0;
    });
    if (!is_there) missing.push_back(wanted);
  }
  if (missing.empty()) return;
  throw ConfigError(fmt::format(
      "{}: has no {}, which {} shows; name a bag that `hires imagine --save-rollout WHICH --bag "
      "FILE` wrote, or another configuration by --configuration; {}",
      options.bag, hires::base::Join(missing, ", "), options.configuration, ListOfTopics(topics)));
}

Recording ReadRecording(const WatchOptions& options) {
  Recording recording;
  ReadBag(options.bag, [&] {
    rosbag::Bag bag;
    OpenBag(options.bag, &bag);
    RequireTopics(options, TopicsOfBag(bag));
    rosbag::View view(bag);
    for (const rosbag::MessageInstance& instance : view) {
      if (instance.getTopic() == "/clock") continue;  // there is a clock here
      if (instance.getTopic() == kOdometry && recording.base_link.empty()) {
        const auto odometry = instance.instantiate<nav_msgs::Odometry>();
        if (odometry) recording.base_link = odometry->child_frame_id;
      }
      recording.messages.push_back(
          {instance.getTime().toSec(), instance.getTopic(), instance.instantiate<ShapeShifter>()});
    }
  });
  return recording;
}

/// Publishes what was recorded, as the position moves on or jumps.
class Player {
 public:
  explicit Player(const Recording& recording)
      : messages_(recording.messages), clock_(nh_.advertise<rosgraph_msgs::Clock>("/clock", 10)) {
    for (const Recorded& recorded : messages_) {
      if (publishers_.count(recorded.topic) > 0) continue;
      // All are latched: what looks later sees how things are.
      publishers_[recorded.topic] = recorded.message->advertise(nh_, recorded.topic, 100, true);
    }
  }

  void Show(double position, bool has_jumped) {
    rosgraph_msgs::Clock clock;
    clock.clock = ros::Time(position);
    clock_.publish(clock);
    if (has_jumped) {
      ShowLatest(position);
    } else {
      for (; next_ < messages_.size() && messages_[next_].time <= position; ++next_) {
        Publish(messages_[next_]);
      }
    }
  }

  /// What happened last up to now, or empty.
  std::string LastEvent() const { return event_; }

 private:
  /// How everything is at that position: of each topic the last message.
  void ShowLatest(double position) {
    std::map<std::string, const Recorded*> latest;
    event_.clear();
    for (next_ = 0; next_ < messages_.size() && messages_[next_].time <= position; ++next_) {
      latest[messages_[next_].topic] = &messages_[next_];
    }
    for (const auto& [topic, recorded] : latest) Publish(*recorded);
  }

  void Publish(const Recorded& recorded) {
    publishers_.at(recorded.topic).publish(recorded.message);
    if (recorded.topic != "/rollout/events") return;
    const auto text = recorded.message->instantiate<std_msgs::String>();
    if (text) event_ = fmt::format("{:.2f} s {}", recorded.time, text->data);
  }

  ros::NodeHandle nh_;
  const std::vector<Recorded>& messages_;
  std::size_t next_{0};
  std::map<std::string, ros::Publisher> publishers_;
  ros::Publisher clock_;
  std::string event_;
};

/// Keys as they are typed, without waiting for the end of a line; from a pipe as they come.
class Keyboard {
 public:
  Keyboard() {
    if (isatty(STDIN_FILENO) == 0 || tcgetattr(STDIN_FILENO, &before_) != 0) return;
    termios raw = before_;
    raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    is_raw_ = tcsetattr(STDIN_FILENO, TCSANOW, &raw) == 0;
  }
  ~Keyboard() {
    if (is_raw_) tcsetattr(STDIN_FILENO, TCSANOW, &before_);
  }
  Keyboard(const Keyboard&) = delete;
  Keyboard& operator=(const Keyboard&) = delete;

  std::string Read() {
    std::string keys;
    pollfd waiting{STDIN_FILENO, POLLIN, 0};
    while (!is_at_end_ && poll(&waiting, 1, 0) > 0) {
      char key = 0;
      is_at_end_ = read(STDIN_FILENO, &key, 1) != 1;
      if (!is_at_end_) keys += key;
    }
    return keys;
  }

 private:
  termios before_{};
  bool is_raw_{false}, is_at_end_{false};
};

/// A master that nobody else uses: simulated time and transforms of a rollout do not belong under a
/// robot's.
class OwnMaster {
 public:
  explicit OwnMaster(hires::base::StopSignals* signals)
      : uri_(fmt::format("http://localhost:{}", ports_.first())),
        process_({{"rosmaster", "--core", "-p", std::to_string(ports_.first())},
                  Quiet(),
                  0,
                  folder_.path() + "/master.log"}) {
    setenv("ROS_MASTER_URI", uri_.c_str(), 1);
    setenv("ROS_HOSTNAME", "localhost", 1);
    ros::M_string none;
    ros::init(none, "hires_watch", ros::init_options::NoSigintHandler);
    const double deadline = hires::base::SteadyNow() + kMasterPatience;
    while (!ros::master::check()) {
      const auto ended = process_.Ended();
      if (signals->Wait(kTick)) return;
      if (ended || hires::base::SteadyNow() > deadline) {
        throw ConfigError(fmt::format("hires watch: no master at {} ({}); is rosmaster installed?",
                                      uri_, ended.value_or("it does not answer")));
      }
    }
    ros::param::set("/use_sim_time", true);
  }

  const std::string& uri() const { return uri_; }
  const std::string& folder() const { return folder_.path(); }
  static std::vector<std::string> Quiet() { return {"ROS_IP", "ROS_HOSTNAME=localhost"}; }

 private:
  hires::base::PortClaim ports_{1};
  hires::base::RunFolder folder_{""};
  std::string uri_;
  hires::base::ChildProcess process_;
};

/// The configuration, looking at this robot's base.
std::string ConfigurationFor(const Recording& recording, const WatchOptions& options,
                             const std::string& folder) {
  std::ifstream in(options.configuration);
  std::string text((std::istreambuf_iterator<char>(in)), {});
  const std::string before = kBaseInConfiguration;
  for (std::size_t at = text.find(before); at != std::string::npos && !recording.base_link.empty();
       at = text.find(before, at + recording.base_link.size())) {
    text.replace(at, before.size(), recording.base_link);
  }
  const std::string path = folder + "/rollout.rviz";
  std::ofstream(path) << text;
  return path;
}

/// Until somebody quits, or closes RViz.
void Play(const Recording& recording, const WatchOptions& options,
          std::optional<hires::base::ChildProcess>* rviz, hires::base::StopSignals* signals) {
  Player player(recording);
  Keyboard keyboard;
  hires::cli::Playback playback(recording.messages.front().time, recording.messages.back().time);
  if (options.paused) playback.Type(" ");
  double last = hires::base::SteadyNow();
  bool is_first = true;
  while (!signals->Wait(kTick) && !playback.wants_to_quit()) {
    const double now = hires::base::SteadyNow();
    playback.Type(keyboard.Read());
    playback.Tick(now - last);
    last = now;
    player.Show(playback.position(), playback.TakeJump() || is_first);
    is_first = false;
    if (isatty(STDOUT_FILENO) != 0) {
      std::cout << '\r' << playback.Slider(kSliderWidth) << "  " << player.LastEvent() << "\033[K"
                << std::flush;
    }
    if (*rviz && (*rviz)->Ended()) break;
  }
  std::cout << std::endl;
}

int Watch(const WatchOptions& options) {
  hires::base::StopSignals signals;  // before any thread
  const Recording recording = ReadRecording(options);
  if (recording.messages.empty()) {
    throw hires::base::ConfigError(options.bag +
                                   ": has nothing to show; save a rollout with --bag");
  }
  const OwnMaster master(&signals);
  if (signals.Wait(0.0)) return hires::cli::kExitCancelled;
  std::cout << fmt::format("ROS_MASTER_URI={}\n{}\n", master.uri(), hires::cli::kPlaybackKeys)
            << std::flush;
  std::optional<hires::base::ChildProcess> rviz;
  if (!options.no_rviz) {
    const std::string configuration = ConfigurationFor(recording, options, master.folder());
    rviz.emplace(hires::base::ProcessOptions{
        {"rviz", "-d", configuration}, OwnMaster::Quiet(), 0, master.folder() + "/rviz.log"});
  }
  Play(recording, options, &rviz, &signals);
  ros::shutdown();
  return 0;
}

}  // namespace

int RunWatch(const std::vector<std::string>& arguments, const std::string& package_folder) {
  CLI::App app("look at a rollout that `hires imagine --save-rollout` saved as a bag",
               "hires watch");
  WatchOptions options;
  options.configuration = package_folder + "/config/rollout.rviz";
  app.add_option("BAG", options.bag, "that `hires imagine --save-rollout WHICH --bag FILE` wrote")
      ->required();
  app.add_option("--configuration", options.configuration, "of RViz; default: config/rollout.rviz");
  app.add_flag("--no-rviz", options.no_rviz, "only play, for other viewers under the master");
  app.add_flag("--paused", options.paused, "do not play at once");
  app.footer(fmt::format("keys: {}", hires::cli::kPlaybackKeys));
  try {
    // CLI11 takes its arguments from the back.
    app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : hires::cli::kExitBadInput;
  }
  return Watch(options);
}

}  // namespace hires_ros
