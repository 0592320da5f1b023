#include "hires/ros/remote_imagination.h"

#include <actionlib/client/simple_action_client.h>
#include <fmt/format.h>
#include <hires/ImagineAction.h>
#include <ros/ros.h>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/ros/conversions.h"
#include "hires/ros/topic_names.h"

namespace hires_ros {
namespace {

using Client = actionlib::SimpleActionClient<hires::ImagineAction>;

constexpr double kClientWait = 10.0;  // [s] to find the imagination client

hires::Atom MakeAtom(const std::string& predicate, const std::vector<std::string>& arguments) {
  hires::Atom atom;
  atom.predicate = predicate;
  atom.arguments = arguments;
  return atom;
}

hires::ImagineGoal GoalOf(const hires::evaluation::ImagineQuery& query) {
  hires::ImagineGoal goal;
  goal.action = ToMsg(query.action);
  goal.updated_fluents.push_back(MakeAtom("RobotAt", {query.from}));
  for (const std::string& object : query.objects) {
    goal.updated_fluents.push_back(MakeAtom("On", {object, "trayArea1"}));
  }
  goal.deadline = ros::Duration(query.scheduler.deadline);
  goal.rollouts = query.scheduler.rollouts;
  goal.seed = query.seed;
  goal.ranking = hires::imagination::ToString(query.scheduler.rule);
  goal.play_all = !query.scheduler.early_stop;
  goal.request_id = "hires_imagine";
  if (query.own_uncertainty) {
    goal.uncertainty = query.setup.uncertainty == "none"
                           ? "none"
                           : hires::base::ReadTextFile(query.setup.uncertainty, 1u << 20);
  }
  return goal;
}

void RequireMaster() {
  if (ros::master::check()) return;
  throw hires::base::ConfigError(fmt::format(
      "no ROS master answers at {}; start one (roslaunch hires imagination.launch), set "
      "ROS_MASTER_URI, or add --local",
      ros::master::getURI()));
}

}  // namespace

hires::imagination::Report ImagineRemotely(const hires::evaluation::ImagineQuery& query,
                                           const hires::imagination::OnInterim& on_interim,
                                           const std::function<bool()>& cancelled) {
  if (query.own_scene) {
    throw hires::base::ConfigError(
        "another world, robot, catalogue or object file is named, but the running workers have "
        "their own; add --local, or start imagination.launch with these files");
  }
  int no_arguments = 0;
  ros::init(no_arguments, nullptr, "hires_imagine",
            ros::init_options::AnonymousName | ros::init_options::NoSigintHandler);
  RequireMaster();
  Client client(kImagineAction, true);
  for (double waited = 0.0; !client.waitForServer(ros::Duration(0.1)); waited += 0.1) {
    if (cancelled() || waited > kClientWait) {
      throw hires::base::ConfigError(fmt::format(
          "no imagination client serves the action '{}' at {}; start imagination.launch, or add "
          "--local",
          kImagineAction, ros::master::getURI()));
    }
  }
  client.sendGoal(GoalOf(query), {}, {}, [&](const hires::ImagineFeedbackConstPtr& feedback) {
    if (on_interim) on_interim(FromMsg(*feedback));
  });
  bool asked_to_stop = false;
  while (!client.waitForResult(ros::Duration(0.1))) {
    if (!ros::ok() || !client.isServerConnected()) {
      throw hires::base::ConfigError(
          "the imagination client went away during the request; see its log, then ask again");
    }
    if (cancelled() && !asked_to_stop) client.cancelGoal();
    asked_to_stop = asked_to_stop || cancelled();
  }
  return FromMsg(*client.getResult());
}

}  // namespace hires_ros
