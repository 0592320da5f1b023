#include "nodes/episode_recorder/episode_recorder_node.h"

#include <fmt/format.h>
#include <ros/package.h>
#include <ros/time.h>

#include <boost/function.hpp>
#include <boost/make_shared.hpp>
#include <filesystem>
#include <system_error>

#include "hires/base/error.h"
#include "hires/base/local_time.h"
#include "hires/base/log.h"
#include "hires/ros/node/private_params.h"

namespace hires_ros {
namespace {

namespace fs = std::filesystem;
using hires::base::ConfigError;
using hires::base::LogLevel;

constexpr std::uint32_t kQueue = 6000;  // a minute of what comes at 100 Hz

bool IsLatched(const ros::M_string& header) {
  const auto latching = header.find("latching");
  return latching != header.end() && latching->second == "1";
}

}  // namespace

EpisodeRecorderParams LoadEpisodeRecorderParams() {
  RejectUnknownPrivate({"config", "names", "folder"});
  const std::string own = ros::package::getPath("hires") + "/config/episode.yaml";
  const std::string config = PrivateText("config").value_or("");
  EpisodeRecorderParams params;
  params.episode = hires::reports::ReadEpisodeConfig(config.empty() ? own : config,
                                                     PrivateText("names").value_or(""));
  params.folder = PrivateText("folder").value_or("");
  if (params.folder.empty()) {
    throw ConfigError("~folder is missing; wanted the folder that the bags shall lie in");
  }
  std::error_code error;
  fs::create_directories(params.folder, error);
  if (!fs::is_directory(params.folder)) {
    throw ConfigError(fmt::format("~folder is {}, which is no folder and cannot be made ({})",
                                  params.folder, error.message()));
  }
  return params;
}

EpisodeRecorderNode::EpisodeRecorderNode(const EpisodeRecorderParams& params, ros::NodeHandle* nh)
    : rotation_(params.folder, hires::base::LocalTime(), params.episode.bags),
      chunk_(static_cast<std::uint32_t>(params.episode.bags.chunk)) {
  for (const hires::reports::EpisodeTopic& topic : params.episode.topics) {
    const boost::function<void(const Event&)> take =
        [this, name = topic.topic](const Event& event) { OnMessage(name, event); };
    ros::SubscribeOptions options;
    options.initByFullCallbackType<const Event&>(topic.topic, kQueue, take);
    subscribers_.push_back(nh->subscribe(options));
  }
}

EpisodeRecorderNode::~EpisodeRecorderNode() { FinishBag(); }

void EpisodeRecorderNode::OnMessage(const std::string& topic, const Event& event) {
  if (IsLatched(event.getConnectionHeader())) {
    latched_[{topic, event.getPublisherName()}] = event;
  }
  const ros::Time now = ros::Time::now();
  if (now < ros::TIME_MIN) return;  // simulated time has not begun
  if (!rotation_.has_begun() || rotation_.IsFull(bag_.getSize(), now.toSec())) {
    FinishBag();
    BeginBag(now);
    if (IsLatched(event.getConnectionHeader())) return;  // it stands there already
  }
  bag_.write(topic, now, *event.getMessage(), event.getConnectionHeaderPtr());
  if (connections_.insert({topic, event.getPublisherName()}).second) EndChunk();
}

/// rosbag ends the chunk at hand where its threshold is set. So it is on disk, and no chunk that a
/// kill may cut short describes a connection: of such a bag `rosbag reindex` finds nothing at all.
void EpisodeRecorderNode::EndChunk() { bag_.setChunkThreshold(chunk_); }

void EpisodeRecorderNode::BeginBag(const ros::Time& now) {
  const std::string path = rotation_.Next(now.toSec());
  bag_.open(path, rosbag::bagmode::Write);
  bag_.setChunkThreshold(chunk_);
  connections_.clear();
  for (const auto& [key, event] : latched_) {
    bag_.write(key.first, now, *event.getMessage(), event.getConnectionHeaderPtr());
    connections_.insert(key);
  }
  EndChunk();
  hires::base::Log(LogLevel::kInfo, fmt::format("records bag={}", path));
}

void EpisodeRecorderNode::FinishBag() {
  if (!rotation_.has_begun()) return;
  bag_.close();
  std::error_code error;
  fs::rename(rotation_.active_path(), rotation_.final_path(), error);
  if (error) {
    hires::base::Log(LogLevel::kError, fmt::format("bag={} keeps its name: {}",
                                                   rotation_.active_path(), error.message()));
  }
}

}  // namespace hires_ros
