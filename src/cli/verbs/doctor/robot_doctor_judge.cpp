#include "cli/verbs/doctor/robot_doctor_judge.h"

#include <fmt/format.h>

#include <algorithm>

#include "hires/base/text.h"

namespace hires::cli {
namespace {

using hires::base::Join;
using hires::robot::RobotProfile;

constexpr double kMostFuture = 0.05;  // [s] that clocks may differ by
constexpr char kGoalType[] = "move_base_msgs/MoveBaseActionGoal";

std::string Listed(const std::set<std::string>& names) {
  return Join({names.begin(), names.end()}, ", ");
}

// ---------------------------------------------------------------- topics

/// What one publisher sends is judged by its own connection; the master keeps one type per topic.
RobotFindings JudgePublisher(const WantedTopic& wanted, const std::string& node,
                             const SeenMessages& seen, bool is_here) {
  const std::string subject = "topic " + wanted.name;
  if (seen.type != wanted.type || seen.md5 != wanted.md5) {
    return {{FindingLevel::kFailed, "topic_type", subject,
             fmt::format("{} sends {} ({}), wanted is {} ({})", node, seen.type, seen.md5,
                         wanted.type, wanted.md5),
             seen.type == wanted.type
                 ? "its computer has another version of that message; install the same release of "
                   "ROS on both"
                 : "name the right topic in the names file, or end that node"}};
  }
  RobotFindings findings;
  if (wanted.min_rate > 0.0 && seen.rate() < wanted.min_rate) {
    findings.push_back({FindingLevel::kWarning, "topic_slow", subject,
                        fmt::format("comes from {} at {:.1f} Hz, wanted are {:.0f} Hz or more",
                                    node, seen.rate(), wanted.min_rate),
                        "look for load on that computer (top), on the network (ping), and for a "
                        "throttle between"});
  }
  const auto age = seen.age();
  if (wanted.max_age > 0.0 && age && *age > wanted.max_age) {
    findings.push_back(
        {FindingLevel::kFailed, "topic_stale", subject,
         fmt::format("messages of {} are {:.2f} s old when they come, wanted are {:.1f} s or less",
                     node, *age, wanted.max_age),
         "the base stops at older ones; look at that computer's clock and load"});
  }
  // Of another computer that is its clock's fault, and said of that.
  if (is_here && age && *age < -kMostFuture) {
    findings.push_back({FindingLevel::kFailed, "topic_future", subject,
                        fmt::format("messages of {} come {:.2f} s before their stamp", node, -*age),
                        "correct how that node stamps them"});
  }
  return findings;
}

bool IsHere(const std::string& node, const RobotView& view) {
  const auto known = view.nodes.find(node);
  return known != view.nodes.end() && view.IsHere(known->second.host());
}

bool HasNoPublisher(const SeenTopic* topic) {
  return topic == nullptr || topic->publishers.empty();
}

/// What to do where a topic is published and nothing comes: the cause may be its node's computer.
std::string RemedyForSilence(const WantedTopic& wanted, const SeenTopic& topic,
                             const RobotView& view) {
  for (const std::string& name : topic.publishers) {
    const auto node = view.nodes.find(name);
    if (node == view.nodes.end() || node->second.reach == Reach::kAnswers) continue;
    return fmt::format("{} cannot be reached: see first what is said of host {}", name,
                       node->second.host());
  }
  return wanted.remedy;
}

RobotFindings JudgeTopic(const WantedTopic& wanted, const RobotView& view) {
  const SeenTopic* topic = view.FindTopic(wanted.name);
  const std::string subject = "topic " + wanted.name;
  if (HasNoPublisher(topic)) {
    return {{FindingLevel::kFailed, "topic_missing", subject,
             fmt::format("no node publishes it ({}, {})", wanted.what, wanted.type),
             wanted.remedy}};
  }
  if (topic->messages.empty()) {
    if (!topic->type.empty() && topic->type != "*" && topic->type != wanted.type) {
      return JudgePublisher(wanted, Listed(topic->publishers),
                            {topic->type, "unknown", 0, 0.0, 0.0, {}}, false);
    }
    return {{FindingLevel::kFailed, "topic_silent", subject,
             fmt::format("{} publishes it, but nothing came within {:.1f} s",
                         Listed(topic->publishers), view.seconds),
             RemedyForSilence(wanted, *topic, view)}};
  }
  RobotFindings findings;
  for (const auto& [node, seen] : topic->messages) {
    for (RobotFinding& finding : JudgePublisher(wanted, node, seen, IsHere(node, view))) {
      findings.push_back(std::move(finding));
    }
  }
  return findings;
}

// ---------------------------------------------------------------- frames

/// A frame and those above it, up to `to` if that is among them.
std::vector<std::string> LineOf(const std::string& frame, const std::string& to,
                                const RobotView& view) {
  std::vector<std::string> line{frame};
  while (line.back() != to) {
    const auto found = view.frames.find(line.back());
    if (found == view.frames.end() || found->second.parents.empty()) break;
    const std::set<std::string>& parents = found->second.parents;
    const std::string above = parents.count(to) > 0 ? to : *parents.begin();
    if (std::find(line.begin(), line.end(), above) != line.end()) break;  // a circle
    line.push_back(above);
  }
  return line;
}

/// The links from a frame to another, each by its child, over the nearest frame that both hang
/// below; nothing if there is none.
std::optional<std::vector<std::string>> LinksBetween(const std::string& parent,
                                                     const std::string& child,
                                                     const RobotView& view) {
  const std::vector<std::string> up = LineOf(child, parent, view);
  const std::vector<std::string> down = LineOf(parent, child, view);
  const auto top = std::find_first_of(up.begin(), up.end(), down.begin(), down.end());
  if (top == up.end()) return std::nullopt;
  std::vector<std::string> links(up.begin(), top);
  links.insert(links.end(), down.begin(), std::find(down.begin(), down.end(), *top));
  return links;
}

bool IsKnown(const std::string& frame, const RobotView& view) {
  return view.frames.count(frame) > 0 ||
         std::any_of(view.frames.begin(), view.frames.end(),
                     [&](const auto& other) { return other.second.parents.count(frame) > 0; });
}

RobotFindings JudgeChain(const std::string& child, const std::string& parent, const char* remedy,
                         double max_age, const RobotView& view) {
  const std::string subject = "frame " + child;
  if (!IsKnown(child, view)) {
    return {{FindingLevel::kFailed, "frame_missing", subject,
             fmt::format("no transform {} -> {} came within {:.1f} s", parent, child, view.seconds),
             remedy}};
  }
  const auto links = LinksBetween(parent, child, view);
  if (!links) {
    return {
        {FindingLevel::kFailed, "frame_missing", subject,
         fmt::format("hangs in {}, which does not lead to {} (in {})",
                     Join(LineOf(child, parent, view), " < "), parent,
                     Join(LineOf(parent, child, view), " < ")),
         "publish the transform that is missing between, or say in the names file (frames) what "
         "this robot calls its frames"}};
  }
  RobotFindings findings;
  for (const std::string& link : *links) {
    const SeenFrame& seen = view.frames.at(link);
    if (seen.is_static || seen.age <= max_age) continue;
    findings.push_back({FindingLevel::kFailed, "frame_stale", "frame " + link,
                        fmt::format("the newest transform {} -> {} is {:.2f} s old, wanted are "
                                    "{:.1f} s or less",
                                    Listed(seen.parents), link, seen.age, max_age),
                        "look whether its node still runs, and at its computer's clock and load"});
  }
  return findings;
}

/// Whether tf puts the base into the map by itself, and knows nothing of the odometry's frame.
bool IsPlacedWithoutOdometry(const hires::control::RobotNames& names, const RobotView& view) {
  return !IsKnown(names.odometry_frame, view) && IsKnown(names.base_frame, view) &&
         LinksBetween(names.map_frame, names.base_frame, view);
}

RobotFindings JudgePlace(const hires::control::RobotNames& names, double max_age,
                         const RobotView& view) {
  if (IsPlacedWithoutOdometry(names, view)) {
    RobotFindings findings = JudgeChain(names.base_frame, names.map_frame, "", max_age, view);
    findings.push_back(
        {FindingLevel::kWarning, "frame_missing", "frame " + names.odometry_frame,
         fmt::format("no transform leads to it; where the robot is, {} says alone",
                     Join(LineOf(names.base_frame, names.map_frame, view), " < ")),
         "nothing, if odometry is not in tf; else say in the names file (frames) what "
         "this robot calls its frame"});
    return findings;
  }
  RobotFindings findings =
      JudgeChain(names.odometry_frame, names.map_frame,
                 "start amcl, and give the first pose (RViz: 2D Pose Estimate)", max_age, view);
  for (RobotFinding& finding :
       JudgeChain(names.base_frame, names.odometry_frame,
                  "start what fuses odometry (on a PR2: robot_pose_ekf), or name the frames in the "
                  "names file",
                  max_age, view)) {
    const auto is_same = [&](const RobotFinding& other) {
      return other.subject == finding.subject;
    };
    if (std::none_of(findings.begin(), findings.end(), is_same)) findings.push_back(finding);
  }
  return findings;
}

RobotFindings FramesWithTwoParents(const RobotView& view) {
  RobotFindings findings;
  for (const auto& [child, frame] : view.frames) {
    if (frame.parents.size() < 2) continue;
    findings.push_back({FindingLevel::kFailed, "frame_two_parents", "frame " + child,
                        "hangs below " + Listed(frame.parents) + " by turns",
                        "two nodes publish it; end one of them (rosrun tf2_tools view_frames.py "
                        "shows which)"});
  }
  return findings;
}

RobotFindings MissingLinks(const RobotProfile& profile, const RobotView& view) {
  RobotFindings findings;
  for (const std::string& link : LinksOf(profile)) {
    if (view.frames.count(link) > 0) continue;
    const bool is_tray = link == profile.tray_link;
    findings.push_back(
        {is_tray ? FindingLevel::kNote : FindingLevel::kFailed, "link_missing", "link " + link,
         "is in the profile, but no transform leads to it",
         is_tray ? "nothing, if the tray is really there: its place is taken from the profile"
                 : "start robot_state_publisher, and compare robot_description with the profile's "
                   "URDF"});
  }
  return findings;
}

// ---------------------------------------------------------------- move_base

std::set<std::string> ServersOf(const hires::control::RobotNames& names, const RobotView& view) {
  const SeenTopic* goals = view.FindTopic(Absolute(names.move_base.action) + "/goal");
  const SeenTopic* status = view.FindTopic(Absolute(names.move_base.action) + "/status");
  std::set<std::string> servers;
  if (goals == nullptr || status == nullptr || goals->type != kGoalType) return servers;
  std::set_intersection(goals->subscribers.begin(), goals->subscribers.end(),
                        status->publishers.begin(), status->publishers.end(),
                        std::inserter(servers, servers.end()));
  return servers;
}

RobotFindings JudgePlanner(const hires::control::RobotNames& names, const RobotView& view) {
  const std::string server = Absolute(names.move_base.planner);
  if (view.services.count(server + "/set_parameters") == 0) {
    return {{FindingLevel::kFailed, "planner_missing", "server " + server,
             "no dynamic_reconfigure server of that name, so the motion set cannot be applied",
             "say in the names file (move_base: planner) what `rosrun dynamic_reconfigure "
             "dynparam list` shows for the local planner"}};
  }
  if (!view.planner_parameters) {
    return {{FindingLevel::kFailed, "planner_silent", "server " + server,
             fmt::format("sent no parameters on {}/parameter_updates within {:.1f} s", server,
                         view.seconds),
             "restart move_base; see also what is said of that node's ports"}};
  }
  RobotFindings findings;
  for (const auto& [limit, choices] : names.move_base.parameters) {
    const bool is_there = std::any_of(choices.begin(), choices.end(), [&](const auto& name) {
      return view.planner_parameters->count(name) > 0;
    });
    if (is_there) continue;
    findings.push_back(
        {FindingLevel::kFailed, "planner_parameter_missing", "server " + server,
         fmt::format("has no parameter for {} ({})", limit, Join(choices, ", ")),
         "add this planner's name for it to the names file (move_base: parameters: " + limit +
             ")"});
  }
  return findings;
}

RobotFindings FindMoveBase(const hires::control::RobotNames& names, const RobotView& view) {
  if (names.move_base.action.empty()) {
    return {{FindingLevel::kFailed, "move_base_missing", "names file", "names no move_base action",
             "drive with navigation:=own (doctor --robot --navigation own)"}};
  }
  const std::string action = Absolute(names.move_base.action);
  const std::set<std::string> servers = ServersOf(names, view);
  if (servers.empty()) {
    const SeenTopic* goals = view.FindTopic(action + "/goal");
    const bool has_listener = goals != nullptr && !goals->subscribers.empty();
    return {{FindingLevel::kFailed, "move_base_missing", "action " + action,
             has_listener
                 ? fmt::format("{} serves it with goals of {}, wanted is {}",
                               Listed(goals->subscribers),
                               goals->type.empty() ? "unknown type" : goals->type, kGoalType)
                 : "no node serves it",
             "start move_base, or drive with navigation:=own (doctor --robot --navigation own)"}};
  }
  RobotFindings findings = JudgePlanner(names, view);
  const SeenTopic* base = view.FindTopic(Absolute(names.base_command));
  for (const std::string& server : servers) {
    if (base == nullptr || base->publishers.count(server) == 0) continue;
    findings.push_back({FindingLevel::kWarning, "move_base_unguarded", "node " + server,
                        fmt::format("publishes velocities on {} itself, past the base guard",
                                    Absolute(names.base_command)),
                        "in its launch file: <remap from=\"cmd_vel\" to=\"base_guard/cmd_vel\"/>; "
                        "until then the guard can only cancel its goal and overlay its own ramp"});
  }
  return findings;
}

}  // namespace

RobotFindings JudgeTopics(const RobotNeeds& needs, const RobotView& view) {
  RobotFindings findings;
  if (view.uses_sim_time) {
    findings.push_back({FindingLevel::kWarning, "sim_time", "parameter /use_sim_time",
                        "is true, so time is what /clock says and clocks cannot be compared",
                        "with a real robot: rosparam delete /use_sim_time, then start all nodes "
                        "again"});
  }
  for (const WantedTopic& wanted : needs.topics) Append(JudgeTopic(wanted, view), &findings);
  const WantedTopic& map = needs.map;
  const bool is_served =
      !needs.names.static_map.empty() && view.services.count(Absolute(needs.names.static_map)) > 0;
  if (!HasNoPublisher(view.FindTopic(map.name)) || !is_served) {
    Append(JudgeTopic(map, view), &findings);
  }
  return findings;
}

RobotFindings JudgeListeners(const RobotNeeds& needs, const RobotView& view) {
  RobotFindings findings;
  for (const WantedListener& wanted : needs.listeners) {
    const SeenTopic* topic = view.FindTopic(wanted.name);
    const std::string subject = "command " + wanted.name;
    if (topic == nullptr || topic->subscribers.empty()) {
      findings.push_back(
          {FindingLevel::kFailed, "listener_missing", subject,
           fmt::format("no node subscribes to it ({}, {})", wanted.what, wanted.type),
           wanted.remedy});
    } else if (!topic->type.empty() && topic->type != "*" && topic->type != wanted.type) {
      findings.push_back({FindingLevel::kFailed, "listener_type", subject,
                          fmt::format("{} takes {}, wanted is {}", Listed(topic->subscribers),
                                      topic->type, wanted.type),
                          "name the right topic in the names file, or start the right controller"});
    }
  }
  return findings;
}

RobotFindings JudgeFrames(const RobotNeeds& needs, const RobotProfile& profile,
                          const RobotView& view) {
  const hires::control::RobotNames& names = needs.names;
  if (view.frames.empty()) {
    return {{FindingLevel::kFailed, "frame_missing", "frames",
             fmt::format("no transform at all came on /tf within {:.1f} s", view.seconds),
             "mend first what is said above of hosts and topics; then start robot_state_publisher "
             "and amcl"}};
  }
  RobotFindings findings = JudgePlace(names, needs.max_frame_age, view);
  Append(FramesWithTwoParents(view), &findings);
  Append(MissingLinks(profile, view), &findings);
  return findings;
}

RobotFindings JudgeJoints(const RobotProfile& profile, const RobotView& view) {
  if (view.joints.empty()) return {};
  RobotFindings findings;
  for (const JointChoice& choice : JointsOf(profile)) {
    const bool is_there = std::any_of(choice.begin(), choice.end(), [&](const std::string& name) {
      return view.joints.count(name) > 0;
    });
    if (is_there) continue;
    findings.push_back({FindingLevel::kFailed, "joint_missing", "joint " + Join(choice, " or "),
                        "is in the profile, but not among the joint states",
                        "start what publishes it, or give the profile of this robot (--profile)"});
  }
  return findings;
}

RobotFindings JudgeReadiness(const hires::control::RobotNames& names, const RobotView& view) {
  RobotFindings findings;
  if (view.motors_halted.value_or(false)) {
    findings.push_back(
        {FindingLevel::kFailed, "motors_halted", "motors",
         Absolute(names.motors_halted) + " says that they are halted",
         "make sure that no person stands in the way, release both run-stops, then reset "
         "the motors (on a PR2: rosservice call /pr2_etherCAT/reset_motors)"});
  }
  if (!view.has_robot_description) {
    findings.push_back({FindingLevel::kFailed, "robot_description_missing",
                        "parameter " + Absolute(names.robot_description), "is not set",
                        "start the robot; if it calls the parameter otherwise, say so in the names "
                        "file"});
  }
  return findings;
}

RobotFindings JudgeMoveBase(const hires::control::RobotNames& names, const RobotView& view,
                            bool is_needed) {
  RobotFindings findings = FindMoveBase(names, view);
  if (is_needed) return findings;
  for (RobotFinding& finding : findings) {
    finding.level = std::min(finding.level, FindingLevel::kWarning);
    finding.text += "; matters only with navigation:=move_base";
  }
  return findings;
}

}  // namespace hires::cli
