// Drives by move_base, as fast as imagination recommends.
//
//   ask_before_driving AREA X Y YAW FROM [OBJECT ...]
//
// AREA: where to, as the imagined world calls it; X Y YAW: the same [m, rad] in the map; FROM: the
// area where the robot stands; OBJECT: what stands on its tray. Beside it run the robot's
// navigation, whose local planner is ~planner, and imagination.launch. Exit code 2: imagination
// recommends nothing, and nothing was driven; 1: nobody answers, or move_base did not get there.
//
// In a package of your own: find_package(catkin REQUIRED COMPONENTS roscpp actionlib hires
// move_base_msgs dynamic_reconfigure), and depend on ${catkin_EXPORTED_TARGETS}.

#include <actionlib/client/simple_action_client.h>
#include <dynamic_reconfigure/Reconfigure.h>
#include <hires/ImagineAction.h>
#include <move_base_msgs/MoveBaseAction.h>
#include <ros/ros.h>

#include <cmath>
#include <iostream>
#include <map>
#include <string>
#include <vector>

namespace {

struct Limits {
  double max_vel_x;  // [m/s]
  double acc_lim_x;  // [m/s^2]
};
const std::map<std::string, Limits> kLimits{{"slow", {0.30, 1.4}}, {"fast", {0.55, 2.5}}};

hires::Atom MakeAtom(const std::string& predicate, const std::vector<std::string>& arguments) {
  hires::Atom atom;
  atom.predicate = predicate;
  atom.arguments = arguments;
  return atom;
}

hires::StringList Choice(const std::vector<std::string>& names) {
  hires::StringList choice;
  choice.values = names;
  return choice;
}

/// Every motion set is played 64 times, until the answer is decided.
hires::ImagineGoal Question(const std::string& area, const std::string& from,
                            const std::vector<std::string>& on_tray) {
  std::vector<std::string> motion_sets;
  for (const auto& [name, limits] : kLimits) motion_sets.push_back(name);
  hires::ImagineGoal goal;
  goal.steps.resize(1);
  goal.steps[0].name = "move_base_param";
  goal.steps[0].alternatives = {Choice({area}), Choice(motion_sets)};
  goal.updated_fluents = {MakeAtom("RobotAt", {from})};
  for (const std::string& object : on_tray) {
    goal.updated_fluents.push_back(MakeAtom("On", {object, "trayArea1"}));
  }
  goal.rollouts = 64;
  goal.seed = 1;
  return goal;
}

bool LimitSpeed(const std::string& planner, const Limits& limits) {
  dynamic_reconfigure::Reconfigure change;
  for (const auto& [name, value] : {std::pair<std::string, double>{"max_vel_x", limits.max_vel_x},
                                    {"acc_lim_x", limits.acc_lim_x}}) {
    dynamic_reconfigure::DoubleParameter parameter;
    parameter.name = name;
    parameter.value = value;
    change.request.config.doubles.push_back(parameter);
  }
  return ros::service::call(planner + "/set_parameters", change);
}

bool Drive(double x, double y, double yaw) {
  move_base_msgs::MoveBaseGoal goal;
  goal.target_pose.header.frame_id = "map";
  goal.target_pose.pose.position.x = x;
  goal.target_pose.pose.position.y = y;
  goal.target_pose.pose.orientation.z = std::sin(yaw / 2.0);
  goal.target_pose.pose.orientation.w = std::cos(yaw / 2.0);
  actionlib::SimpleActionClient<move_base_msgs::MoveBaseAction> move_base("move_base");
  move_base.waitForServer();
  return move_base.sendGoalAndWait(goal) == actionlib::SimpleClientGoalState::SUCCEEDED;
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "ask_before_driving", ros::init_options::AnonymousName);
  if (argc < 6) {
    std::cerr << "ask_before_driving AREA X Y YAW FROM [OBJECT ...]\n";
    return 1;
  }
  ros::NodeHandle nh;
  const std::string planner =
      ros::NodeHandle("~").param<std::string>("planner", "move_base/DWAPlannerROS");
  actionlib::SimpleActionClient<hires::ImagineAction> imagination("imagine");
  if (!imagination.waitForServer(ros::Duration(10.0))) {
    std::cerr << "nobody serves the action 'imagine'; start imagination.launch\n";
    return 1;
  }
  imagination.sendGoalAndWait(Question(argv[1], argv[5], {argv + 6, argv + argc}));
  const hires::ImagineResultConstPtr answer = imagination.getResult();
  if (!answer) return 1;
  std::cout << answer->why << std::endl;
  if (answer->recommended < 0) return 2;
  const std::string motion_set = answer->predictions[answer->recommended].action.arguments[1];
  if (!LimitSpeed(planner, kLimits.at(motion_set))) return 1;
  return Drive(std::stod(argv[2]), std::stod(argv[3]), std::stod(argv[4])) ? 0 : 1;
}
