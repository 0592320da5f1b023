#include "reports/episode/episode_topics.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "hires/base/check.h"
#include "hires/base/param_reader.h"
#include "hires/base/text.h"
#include "hires/imagination/imagination_setup.h"

namespace hires::reports {
namespace {

using base::Between;
using base::ParamReader;

/// Roles that `hires replay` reads.
constexpr std::array<const char*, 6> kReadTopics{
    "transforms", "static_transforms", "odometry", "joint_states", "detections", "known_objects"};
constexpr char kReadAction[] = "execute_action";

/// A part of an action whose messages are worth keeping.
struct Part {
  const char* name;
  const char* end;  // of its type
  bool is_read;
};
constexpr Part kParts[] = {{"goal", "ActionGoal", true},
                           {"result", "ActionResult", true},
                           {"feedback", "ActionFeedback", false},
                           {"cancel", "", false}};

TopicNeed NeedOf(const std::string& word) {
  return word == "needed"  ? TopicNeed::kNeeded
         : word == "helps" ? TopicNeed::kHelps
                           : TopicNeed::kKept;
}

std::vector<std::string> ValuesOf(const std::map<std::string, std::string>& by_group) {
  std::vector<std::string> values;
  for (const auto& [group, topic] : by_group) values.push_back(topic);
  return values;
}

/// What the names file says under a key that stands in braces; several for those of groups, none
/// for what the robot has not.
std::vector<std::string> Named(const control::RobotNames& names, const std::string& key,
                               const std::string& text, const ParamReader& in) {
  if (text.empty() || text.front() != '{') return {text};
  const std::map<std::string, std::vector<std::string>> known{
      {"{odometry}", {names.odometry}},
      {"{joint_states}", {names.joint_states}},
      {"{base_command}", {names.base_command}},
      {"{localisation}", {names.localisation}},
      {"{base_scan}", {names.base_scan}},
      {"{map}", {names.map}},
      {"{motors_halted}", {names.motors_halted}},
      {"{move_base}", {names.move_base.action}},
      {"{trajectories}", ValuesOf(names.trajectories)},
      {"{grippers}", ValuesOf(names.grippers)}};
  const auto found = known.find(text);
  if (found != known.end()) return found->second;
  std::vector<std::string> words;
  for (const auto& entry : known) words.push_back(entry.first);
  in.Fail(key, "but " + base::UnknownName("name", text, words));
}

std::string FromRoot(const std::string& name) { return name.front() == '/' ? name : '/' + name; }

void AddTopic(const control::RobotNames& names, ParamReader in, std::vector<EpisodeTopic>* out) {
  const std::string role = in.GetString("role"), type = in.GetString("type");
  const TopicNeed need = NeedOf(in.Get("need", base::OneOf({"needed", "helps", "kept"})));
  const bool is_action = in.Has("action");
  const char* key = is_action ? "action" : "topic";
  for (const std::string& name : Named(names, key, in.GetString(key), in)) {
    if (name.empty()) continue;  // the robot has none
    if (!is_action) out->push_back({role, FromRoot(name), type, need});
    for (const auto& [part, end, is_read] : kParts) {
      if (!is_action) break;
      const std::string part_type = *end == '\0' ? "actionlib_msgs/GoalID" : type + end;
      out->push_back({role + '/' + part, FromRoot(name) + '/' + part, part_type,
                      is_read ? need : TopicNeed::kKept});
    }
  }
}

std::vector<EpisodeTopic> ReadTopics(const control::RobotNames& names, ParamReader* in) {
  std::vector<EpisodeTopic> topics;
  for (ParamReader& row : in->SubList("topics")) AddTopic(names, row, &topics);
  std::set<std::string> roles;
  for (const EpisodeTopic& topic : topics) roles.insert(topic.role);
  std::vector<std::string> wanted(kReadTopics.begin(), kReadTopics.end());
  wanted.push_back(std::string(kReadAction) + "/goal");
  for (const std::string& role : wanted) {
    if (roles.count(role) > 0) continue;
    in->Fail("topics", fmt::format("wanted a row of role '{}', which `hires replay` reads; add it",
                                   base::Split(role, '/').front()));
  }
  return topics;
}

MotionParams ReadMotions(ParamReader in) {
  MotionParams p;
  p.still_speed = in.Get("still_speed", Between(0.001, 1.0));
  p.still_turning = in.Get("still_turning", Between(0.001, 1.0));
  p.still_joint = in.Get("still_joint", Between(0.001, 1.0));
  p.still_torso = in.Get("still_torso", Between(0.0001, 0.1));
  p.pause = in.Get("pause", Between(0.0, 60.0));
  p.least_drive = in.Get("least_drive", Between(0.0, 10.0));
  p.least_turn = in.Get("least_turn", Between(0.0, 7.0));
  p.least_reach = in.Get("least_reach", Between(0.0, 7.0));
  p.least_lift = in.Get("least_lift", Between(0.0, 1.0));
  p.blind_distance = in.Get("blind_distance", Between(0.0, 10.0));
  p.straightness = in.Get("straightness", Between(0.0, 1.0));
  p.speed_slack = in.Get("speed_slack", Between(0.0, 1.0));
  return p;
}

BagLimits ReadBags(ParamReader in) {
  BagLimits limits;
  limits.max_size = static_cast<std::uint64_t>(in.Get("max_size", Between(1, 1 << 20))) << 20;
  limits.max_duration = in.Get("max_duration", Between(1.0, 1e6));
  limits.chunk = static_cast<std::uint64_t>(in.Get("chunk", Between(1, 1 << 16))) << 10;
  return limits;
}

std::string ListOf(const std::vector<EpisodeTopic>& topics, TopicNeed need) {
  std::string text;
  for (const EpisodeTopic& topic : topics) {
    if (topic.need == need) text += fmt::format("\n  {} ({})", topic.topic, topic.type);
  }
  return text;
}

/// Topics of the types that are missing, under names that the file of topics does not have.
std::vector<std::string> Elsewhere(const EpisodeConfig& config,
                                   const std::vector<EpisodeTopic>& missing,
                                   const std::vector<BagTopic>& bag) {
  std::vector<std::string> found;
  for (const BagTopic& candidate : bag) {
    const auto is_known = [&](const EpisodeTopic& topic) { return topic.topic == candidate.name; };
    const auto may_be = [&](const EpisodeTopic& topic) {
      return topic.need != TopicNeed::kKept && topic.type == candidate.type;
    };
    if (candidate.num_messages == 0) continue;
    if (std::any_of(config.topics.begin(), config.topics.end(), is_known)) continue;
    if (std::none_of(missing.begin(), missing.end(), may_be)) continue;
    found.push_back(fmt::format("{} ({})", candidate.name, candidate.type));
  }
  return found;
}

std::string CommandFor(const std::vector<EpisodeTopic>& topics) {
  std::string text = "rosbag record";
  for (const EpisodeTopic& topic : topics) {
    if (topic.need != TopicNeed::kKept) text += ' ' + topic.topic;
  }
  return text;
}

}  // namespace

const EpisodeTopic& EpisodeConfig::Of(const std::string& role) const {
  const auto found = std::find_if(topics.begin(), topics.end(),
                                  [&](const EpisodeTopic& topic) { return topic.role == role; });
  HIRES_CHECK(found != topics.end(), "no topic of an episode has the role '" + role + "'");
  return *found;
}

EpisodeConfig ReadEpisodeConfig(const std::string& path, const std::string& names) {
  ParamReader in = ParamReader::FromFile(path);
  EpisodeConfig config;
  const std::string own_names = imagination::ResolvePath(in.GetString("names"), path);
  config.names = control::ReadRobotNames(names.empty() ? own_names : names);
  config.topics = ReadTopics(config.names, &in);
  config.sample_period = in.Get("sample_period", Between(0.01, 1.0));
  config.max_gap = in.Get("max_gap", Between(0.1, 60.0));
  config.motions = ReadMotions(in.Sub("motions"));
  config.surprise = in.Get("surprise", Between(0.0001, 0.5));
  config.bags = ReadBags(in.Sub("bags"));
  in.RejectUnknownKeys();
  return config;
}

bool TopicCheck::Has(const std::string& role) const {
  return std::any_of(there.begin(), there.end(),
                     [&](const EpisodeTopic& topic) { return topic.role == role; });
}

bool TopicCheck::is_usable() const {
  return std::none_of(missing.begin(), missing.end(),
                      [](const EpisodeTopic& topic) { return topic.need == TopicNeed::kNeeded; });
}

std::string TopicCheck::Advice() const {
  std::string text = base::Join(wrong, "\n");
  if (!wrong.empty()) text += '\n';
  const std::string needed = ListOf(missing, TopicNeed::kNeeded);
  const std::string helpful = ListOf(missing, TopicNeed::kHelps);
  if (!needed.empty()) text += "no message came on what is needed:" + needed + '\n';
  if (!helpful.empty()) text += "no message came on what helps:" + helpful + '\n';
  if (needed.empty() && helpful.empty()) return text;
  if (!elsewhere.empty()) {
    text += "of these types there are\n  " + base::Join(elsewhere, "\n  ") +
            "\nif they are what is missing, name them in a names file (--names, like "
            "config/robots/pr2_names.yaml) or a file of topics (--episode, like "
            "config/episode.yaml)\n";
  }
  std::vector<EpisodeTopic> all = there;
  all.insert(all.end(), missing.begin(), missing.end());
  return text +
         "record with `roslaunch hires episode_recorder.launch record:=FOLDER`, or with\n  " +
         CommandFor(all) + '\n';
}

TopicCheck CheckTopics(const EpisodeConfig& config, const std::vector<BagTopic>& bag) {
  TopicCheck check;
  for (const EpisodeTopic& topic : config.topics) {
    bool is_there = false;
    for (const BagTopic& candidate : bag) {
      if (candidate.name != topic.topic || candidate.num_messages == 0) continue;
      is_there = is_there || candidate.type == topic.type;
      if (candidate.type == topic.type || topic.need == TopicNeed::kKept) continue;
      check.wrong.push_back(fmt::format("topic {} has messages of type {}, wanted {}: left out",
                                        candidate.name, candidate.type, topic.type));
    }
    (is_there ? check.there : check.missing).push_back(topic);
  }
  check.elsewhere = Elsewhere(config, check.missing, bag);
  return check;
}

}  // namespace hires::reports
