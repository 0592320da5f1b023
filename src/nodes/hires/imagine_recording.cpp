#include "nodes/hires/imagine_recording.h"

#include <fmt/format.h>
#include <hires/ImagineActionGoal.h>
#include <hires/ImagineActionResult.h>
#include <ros/serialization.h>
#include <rosbag/view.h>

#include <boost/make_shared.hpp>
#include <map>
#include <set>
#include <type_traits>
#include <utility>

#include "hires/base/error.h"
#include "hires/base/short_text.h"
#include "hires/base/text.h"

namespace hires_ros {
namespace {

using hires::ImagineActionGoal;
using hires::ImagineActionResult;
using hires::base::ConfigError;

bool EndsWith(const std::string& text, const std::string& end) {
  return text.size() > end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

std::string WithoutEnd(const std::string& text, const std::string& end) {
  return EndsWith(text, end) ? text.substr(0, text.size() - end.size()) : text;
}

/// "/imagine" from whatever part of it was typed.
std::string ActionOf(std::string name) {
  if (name.empty()) return name;
  if (name.front() != '/') name.insert(name.begin(), '/');
  for (const char* end : {"/goal", "/result", "/feedback", "/status", "/cancel"}) {
    name = WithoutEnd(name, end);
  }
  return name;
}

/// Actions of which goals were recorded.
std::set<std::string> ActionsIn(const std::vector<BagTopic>& topics) {
  std::set<std::string> actions;
  for (const BagTopic& topic : topics) {
    if (topic.type == ros::message_traits::datatype<ImagineActionGoal>() &&
        EndsWith(topic.name, "/goal")) {
      actions.insert(WithoutEnd(topic.name, "/goal"));
    }
  }
  return actions;
}

std::set<std::string> ChooseActions(const std::string& path, const std::vector<BagTopic>& topics,
                                    const std::string& wanted) {
  const std::set<std::string> actions = ActionsIn(topics);
  if (actions.empty()) {
    throw ConfigError(fmt::format(
        "{}: holds no goals of an `imagine` action (topic .../goal of type {}); record "
        "/imagine/goal and /imagine/result; {}",
        path, ros::message_traits::datatype<ImagineActionGoal>(), ListOfTopics(topics)));
  }
  if (wanted.empty()) return actions;
  if (actions.count(wanted) > 0) return {wanted};
  throw ConfigError(
      fmt::format("{}: {}; --topic chooses one of the recorded actions; {}", path,
                  hires::base::UnknownName("action", wanted, {actions.begin(), actions.end()}),
                  ListOfTopics(topics)));
}

/// Messages of HIRES 0.3.0 are a beginning of today's: fields were added at the end alone.
template <typename Message>
const char* FormerMd5() {
  return std::is_same_v<Message, ImagineActionGoal> ? "da7f143324b1dacb436c8755d3330410"
                                                    : "a92a9edf5b63fc454bc681bbf88ec706";
}

/// @return nullptr: of another type or version. Fields that 0.3.0 did not have are 0.
template <typename Message>
boost::shared_ptr<Message> ReadAs(const rosbag::MessageInstance& message) {
  constexpr std::size_t kMostMissing = 32;
  const bool is_former = message.getMD5Sum() == FormerMd5<Message>() &&
                         message.getDataType() == ros::message_traits::datatype<Message>();
  if (!is_former) return message.instantiate<Message>();
  std::vector<std::uint8_t> bytes(message.size() + kMostMissing, 0);
  ros::serialization::OStream out(bytes.data(), message.size());
  message.write(out);
  const auto former = boost::make_shared<Message>();
  ros::serialization::IStream in(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::deserialize(in, *former);
  return former;
}

template <typename Message>
void RequireVersion(const std::string& path, const std::vector<BagTopic>& topics,
                    const std::string& name) {
  for (const BagTopic& topic : topics) {
    if (topic.name != name) continue;
    const std::string type = ros::message_traits::datatype<Message>();
    const std::string md5sum = ros::message_traits::md5sum<Message>();
    const bool is_known = topic.md5sum == md5sum || topic.md5sum == FormerMd5<Message>();
    if (topic.type == type && is_known) continue;
    throw ConfigError(fmt::format(
        "{}: topic {} has messages of type {} with md5sum {}, but this build reads {} with md5sum "
        "{}; replay it with the version of HIRES that recorded it (`rosbag check {}` shows how the "
        "messages differ)",
        path, name, topic.type, topic.md5sum, type, md5sum, path));
  }
}

bool Contains(const std::vector<BagTopic>& topics, const std::string& name) {
  for (const BagTopic& topic : topics) {
    if (topic.name == name) return true;
  }
  return false;
}

/// What the topics of one action hold; results by goal id, the first of equals counts.
struct RecordedAction {
  std::vector<std::pair<std::string, hires::ImagineGoal>> goals;
  int goals_without_id{0};
  std::map<std::string, hires::ImagineResult> results;
};

RecordedAction ReadAction(const rosbag::Bag& bag, const std::string& action) {
  RecordedAction out;
  std::set<std::string> seen;
  rosbag::View view(bag, rosbag::TopicQuery({action + "/goal", action + "/result"}));
  for (const rosbag::MessageInstance& message : view) {
    if (const auto goal = ReadAs<ImagineActionGoal>(message)) {
      if (goal->goal_id.id.empty()) {
        ++out.goals_without_id;
        continue;
      }
      // An action server ignores a goal that comes once more, so it counts once here too.
      if (seen.insert(goal->goal_id.id).second) out.goals.push_back({goal->goal_id.id, goal->goal});
    } else if (const auto result = ReadAs<ImagineActionResult>(message)) {
      hires::ImagineResult& kept = result->result;
      const bool is_cancelled = result->status.status == actionlib_msgs::GoalStatus::PREEMPTED;
      if (is_cancelled) kept.outcome = hires::ImagineResult::CANCELLED;  // whatever was found
      out.results.emplace(result->status.goal_id.id, std::move(kept));
    }
  }
  return out;
}

std::string WithoutResult(const std::string& action, const std::string& id,
                          const hires::ImagineGoal& goal, bool has_topic) {
  return fmt::format(
      "goal {} of {} (request '{}') has no result, because {}; record {}/goal and {}/result until "
      "all results have come",
      id, action, hires::base::Shortened(goal.request_id),
      has_topic ? "the recording ended before it" : fmt::format("{}/result is missing", action),
      action, action);
}

void Match(const std::string& action, bool has_results, RecordedAction* recorded,
           ImagineRecording* out) {
  if (recorded->goals_without_id > 0) {
    out->left_out.push_back(fmt::format(
        "{} of {} no goal id, so that results cannot be told from others; send goals through an "
        "action client, or fill in goal_id.id",
        recorded->goals_without_id == 1 ? "a goal"
                                        : fmt::format("{} goals", recorded->goals_without_id),
        action + (recorded->goals_without_id == 1 ? " has" : " have")));
  }
  for (auto& [id, goal] : recorded->goals) {
    const auto result = recorded->results.find(id);
    if (result == recorded->results.end()) {
      out->left_out.push_back(WithoutResult(action, id, goal, has_results));
      continue;
    }
    out->requests.push_back({action, id, std::move(goal), std::move(result->second)});
    recorded->results.erase(result);
  }
  out->results_without_goal += static_cast<int>(recorded->results.size());
}

ImagineRecording Read(const std::string& path, const std::string& wanted) {
  rosbag::Bag bag;
  OpenBag(path, &bag);
  const std::vector<BagTopic> topics = TopicsOfBag(bag);
  ImagineRecording out;
  for (const std::string& action : ChooseActions(path, topics, wanted)) {
    RequireVersion<ImagineActionGoal>(path, topics, action + "/goal");
    RequireVersion<ImagineActionResult>(path, topics, action + "/result");
    RecordedAction recorded = ReadAction(bag, action);
    Match(action, Contains(topics, action + "/result"), &recorded, &out);
  }
  if (out.requests.empty() && !out.left_out.empty()) {
    throw ConfigError(fmt::format("{}: {}", path, hires::base::Join(out.left_out, "; ")));
  }
  if (out.requests.empty()) {
    throw ConfigError(
        fmt::format("{}: holds no goal of an `imagine` action; {}", path, ListOfTopics(topics)));
  }
  return out;
}

}  // namespace

bool HasImagineGoals(const std::vector<BagTopic>& topics) { return !ActionsIn(topics).empty(); }

ImagineRecording ReadImagineRecording(const std::string& path, const std::string& action) {
  ImagineRecording recording;
  ReadBag(path, [&] { recording = Read(path, ActionOf(action)); });
  return recording;
}

}  // namespace hires_ros
