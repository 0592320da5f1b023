#include "nodes/hires/imagine_recording.h"

#include <fmt/format.h>
#include <hires/ImagineActionGoal.h>
#include <hires/ImagineActionResult.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sys/resource.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <new>
#include <set>
#include <stdexcept>
#include <utility>

#include "hires/base/error.h"
#include "hires/base/text.h"

namespace hires_ros {
namespace {

using hires::ImagineActionGoal;
using hires::ImagineActionResult;
using hires::base::ConfigError;

constexpr rlim_t kMostMemory = rlim_t{2} << 30;  // [bytes] for reading one bag
constexpr std::size_t kMostListed = 30;          // topics in a message

/// Lets this process grow by at most `bytes` while it lives. A few bytes of a broken message can
/// claim to be the length of a list of billions.
class ScopedMemoryLimit {
 public:
  explicit ScopedMemoryLimit(rlim_t bytes) {
    is_set_ = getrlimit(RLIMIT_AS, &before_) == 0;
    rlimit now = before_;
    const rlim_t wanted = UsedMemory() + bytes;
    if (wanted < before_.rlim_cur) now.rlim_cur = wanted;
    is_set_ = is_set_ && setrlimit(RLIMIT_AS, &now) == 0;
  }
  ~ScopedMemoryLimit() {
    if (is_set_) setrlimit(RLIMIT_AS, &before_);
  }
  ScopedMemoryLimit(const ScopedMemoryLimit&) = delete;
  ScopedMemoryLimit& operator=(const ScopedMemoryLimit&) = delete;

 private:
  static rlim_t UsedMemory() {
    rlim_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    return pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE));
  }

  rlimit before_{};
  bool is_set_{false};
};

struct Topic {
  std::string name, type, md5sum;
};

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

void RequireBagFile(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) {
    throw ConfigError(fmt::format(
        "{}: no such bag; name a file that `rosbag record` wrote, e.g. `rosbag record -O "
        "imagine.bag /imagine/goal /imagine/result`",
        path));
  }
  std::string begin(4, '\0');
  std::ifstream file(path, std::ios::binary);
  if (!std::filesystem::is_regular_file(path, error) || !file.read(begin.data(), 4) ||
      begin != "#ROS") {
    throw ConfigError(fmt::format(
        "{}: is no ROS bag, or cannot be read: wanted a file that begins with '#ROSBAG'; name one "
        "that `rosbag record` wrote",
        path));
  }
}

void Open(const std::string& path, rosbag::Bag* bag) {
  RequireBagFile(path);
  try {
    bag->open(path, rosbag::bagmode::Read);
  } catch (const rosbag::BagUnindexedException&) {
    throw ConfigError(
        fmt::format("{}: has no index, because its recording goes on or was cut off; end the "
                    "recording (Ctrl-C), or mend the bag with `rosbag reindex {}`",
                    path, path));
  }
}

std::vector<Topic> TopicsOf(const rosbag::Bag& bag) {
  std::map<std::string, Topic> topics;
  for (const rosbag::ConnectionInfo* info : rosbag::View(bag).getConnections()) {
    topics.emplace(info->topic + ' ' + info->datatype + ' ' + info->md5sum,
                   Topic{info->topic, info->datatype, info->md5sum});
  }
  std::vector<Topic> out;
  for (auto& [key, topic] : topics) out.push_back(std::move(topic));
  return out;
}

std::string ListOf(const std::vector<Topic>& topics) {
  if (topics.empty()) return "it is empty";
  std::vector<std::string> lines;
  for (const Topic& topic : topics) {
    if (lines.size() == kMostListed) break;
    lines.push_back(fmt::format("\n  {} ({})", topic.name, topic.type));
  }
  const std::size_t left = topics.size() - lines.size();
  if (left > 0) lines.push_back(fmt::format("\n  and {} more", left));
  return "in it are:" + hires::base::Join(lines, "");
}

/// Actions of which goals were recorded.
std::set<std::string> ActionsIn(const std::vector<Topic>& topics) {
  std::set<std::string> actions;
  for (const Topic& topic : topics) {
    if (topic.type == ros::message_traits::datatype<ImagineActionGoal>() &&
        EndsWith(topic.name, "/goal")) {
      actions.insert(WithoutEnd(topic.name, "/goal"));
    }
  }
  return actions;
}

std::set<std::string> ChooseActions(const std::string& path, const std::vector<Topic>& topics,
                                    const std::string& wanted) {
  const std::set<std::string> actions = ActionsIn(topics);
  if (actions.empty()) {
    throw ConfigError(
        fmt::format("{}: holds no goals of an `imagine` action (topic .../goal of type {}); record "
                    "/imagine/goal and /imagine/result; {}",
                    path, ros::message_traits::datatype<ImagineActionGoal>(), ListOf(topics)));
  }
  if (wanted.empty()) return actions;
  if (actions.count(wanted) > 0) return {wanted};
  throw ConfigError(
      fmt::format("{}: {}; --topic chooses one of the recorded actions; {}", path,
                  hires::base::UnknownName("action", wanted, {actions.begin(), actions.end()}),
                  ListOf(topics)));
}

template <typename Message>
void RequireVersion(const std::string& path, const std::vector<Topic>& topics,
                    const std::string& name) {
  for (const Topic& topic : topics) {
    if (topic.name != name) continue;
    const std::string type = ros::message_traits::datatype<Message>();
    const std::string md5sum = ros::message_traits::md5sum<Message>();
    if (topic.type == type && topic.md5sum == md5sum) continue;
    throw ConfigError(fmt::format(
        "{}: topic {} has messages of type {} with md5sum {}, but this build reads {} with md5sum "
        "{}; replay it with the version of HIRES that recorded it (`rosbag check {}` shows how the "
        "messages differ)",
        path, name, topic.type, topic.md5sum, type, md5sum, path));
  }
}

bool Contains(const std::vector<Topic>& topics, const std::string& name) {
  for (const Topic& topic : topics) {
    if (topic.name == name) return true;
  }
  return false;
}

/// What the topics of one action hold; results by goal id, the first of equals counts.
struct RecordedAction {
  std::vector<std::pair<std::string, hires::ImagineGoal>> goals;
  std::map<std::string, hires::ImagineResult> results;
};

RecordedAction ReadAction(const std::string& path, const rosbag::Bag& bag,
                          const std::string& action) {
  RecordedAction out;
  std::set<std::string> seen;
  rosbag::View view(bag, rosbag::TopicQuery({action + "/goal", action + "/result"}));
  for (const rosbag::MessageInstance& message : view) {
    if (const auto goal = message.instantiate<ImagineActionGoal>()) {
      if (goal->goal_id.id.empty()) {
        throw ConfigError(fmt::format(
            "{}: a goal of {} has no goal id, so its result cannot be told from others; send goals "
            "through an action client, or fill in goal_id.id",
            path, action));
      }
      // An action server ignores a goal that comes once more, so it counts once here too.
      if (seen.insert(goal->goal_id.id).second) out.goals.push_back({goal->goal_id.id, goal->goal});
    } else if (const auto result = message.instantiate<ImagineActionResult>()) {
      hires::ImagineResult& kept = result->result;
      const bool is_cancelled = result->status.status == actionlib_msgs::GoalStatus::PREEMPTED;
      if (is_cancelled) kept.outcome = hires::ImagineResult::CANCELLED;  // whatever was found
      out.results.emplace(result->status.goal_id.id, std::move(kept));
    }
  }
  return out;
}

[[noreturn]] void FailWithoutResult(const std::string& path, const std::string& action,
                                    const std::string& id, const hires::ImagineGoal& goal,
                                    bool has_topic) {
  throw ConfigError(fmt::format(
      "{}: goal {} of {} (request '{}') has no result, because {}; record {}/goal and {}/result "
      "until all results have come",
      path, id, action, goal.request_id,
      has_topic ? "the recording ended before it" : fmt::format("{}/result is missing", action),
      action, action));
}

void Match(const std::string& path, const std::string& action, bool has_results,
           RecordedAction* recorded, ImagineRecording* out) {
  for (auto& [id, goal] : recorded->goals) {
    const auto result = recorded->results.find(id);
    if (result == recorded->results.end()) {
      FailWithoutResult(path, action, id, goal, has_results);
    }
    out->requests.push_back({action, id, std::move(goal), std::move(result->second)});
    recorded->results.erase(result);
  }
  out->results_without_goal += static_cast<int>(recorded->results.size());
}

ImagineRecording Read(const std::string& path, const std::string& wanted) {
  rosbag::Bag bag;
  Open(path, &bag);
  const std::vector<Topic> topics = TopicsOf(bag);
  ImagineRecording out;
  for (const std::string& action : ChooseActions(path, topics, wanted)) {
    RequireVersion<ImagineActionGoal>(path, topics, action + "/goal");
    RequireVersion<ImagineActionResult>(path, topics, action + "/result");
    RecordedAction recorded = ReadAction(path, bag, action);
    Match(path, action, Contains(topics, action + "/result"), &recorded, &out);
  }
  if (out.requests.empty()) {
    throw ConfigError(
        fmt::format("{}: holds no goal of an `imagine` action; {}", path, ListOf(topics)));
  }
  return out;
}

[[noreturn]] void FailBroken(const std::string& path, const std::string& what) {
  throw ConfigError(fmt::format(
      "{}: is broken ({}); try `rosbag reindex {}`, which keeps what can be read, or record again",
      path, what, path));
}

}  // namespace

ImagineRecording ReadImagineRecording(const std::string& path, const std::string& action) {
  const ScopedMemoryLimit limit(kMostMemory);
  try {
    return Read(path, ActionOf(action));
  } catch (const ConfigError&) {
    throw;
  } catch (const ros::Exception& error) {  // of rosbag, and of messages that end too early
    FailBroken(path, error.what());
  } catch (const std::bad_alloc&) {
    FailBroken(path, "something in it claims to be larger than 2 GB");
  } catch (const std::length_error&) {
    FailBroken(path, "something in it claims to be larger than any memory");
  }
}

}  // namespace hires_ros
