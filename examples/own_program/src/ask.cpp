// Asks the imagination client of this master how to drive: roslaunch hires imagination.launch
//
//     own_program_ask FROM TO
#include <actionlib/client/simple_action_client.h>
#include <hires/ImagineAction.h>
#include <ros/ros.h>

#include <cstdlib>
#include <iostream>

hires::ImagineGoal GoalOf(const std::string& from, const std::string& to) {
  hires::ImagineGoal goal;
  goal.request_id = ros::this_node::getName();
  goal.rollouts = 16;
  goal.seed = 7;
  hires::ActionTemplate drive;
  drive.name = "move_base_param";
  drive.alternatives.resize(2);
  drive.alternatives[0].values = {to};
  drive.alternatives[1].values = {"slow", "fast"};
  goal.steps.push_back(drive);
  hires::Atom robot_at;
  robot_at.predicate = "RobotAt";
  robot_at.arguments = {from};
  goal.updated_fluents.push_back(robot_at);
  return goal;
}

int main(int argc, char** argv) {
  ros::init(argc, argv, "own_program_ask");
  if (argc != 3) {
    std::cerr << "usage: own_program_ask FROM TO\n";
    return EXIT_FAILURE;
  }
  actionlib::SimpleActionClient<hires::ImagineAction> client("imagine", true);
  if (!client.waitForServer(ros::Duration(20.0))) {
    std::cerr << "nobody imagines here; start it: roslaunch hires imagination.launch\n";
    return EXIT_FAILURE;
  }
  client.sendGoal(GoalOf(argv[1], argv[2]));
  client.waitForResult();
  const auto result = client.getResult();
  if (!result) {
    std::cerr << "the imagination client went away; see its log, then ask again\n";
    return EXIT_FAILURE;
  }
  for (const hires::Prediction& way : result->predictions) {
    std::cout << way.action.arguments.back() << ' ' << way.success_share << '\n';
  }
  std::cout << result->why << '\n';
  return result->recommended >= 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
