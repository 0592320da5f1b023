#include "cli/verbs/doctor/robot_doctor.h"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/command_line.h"
#include "cli/exit_code.h"
#include "cli/verbs/doctor/robot_doctor_hosts.h"
#include "cli/verbs/doctor/robot_doctor_judge.h"
#include "cli/verbs/doctor/robot_doctor_network.h"

namespace hires::cli::robot_doctor_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string kRobots = std::string(HIRES_SOURCE_DIR) + "/config/robots/";

RobotMessageTypes Types() {
  RobotMessageTypes types;
  types.odometry = {"nav_msgs/Odometry", "od0", true};
  types.joint_states = {"sensor_msgs/JointState", "js1", true};
  types.scan = {"sensor_msgs/LaserScan", "ls2", true};
  types.localisation = {"geometry_msgs/PoseWithCovarianceStamped", "pc3", true};
  types.motors_halted = {"std_msgs/Bool", "bo4", false};
  types.map = {"nav_msgs/OccupancyGrid", "og5", true};
  types.base_command = {"geometry_msgs/Twist", "tw6", false};
  types.trajectory = {"trajectory_msgs/JointTrajectory", "jt7", true};
  types.gripper = {"pr2_controllers_msgs/Pr2GripperCommand", "gc8", false};
  return types;
}

const RobotNeeds& Needs() {
  static const RobotNeeds needs =
      NeedsOf(hires::control::ReadRobotNames(kRobots + "pr2_names.yaml"), Types(), {});
  return needs;
}

const hires::robot::RobotProfile& Profile() {
  static const auto robot = hires::robot::LoadRobot(kRobots + "pr2.yaml");
  return robot.profile;
}

SeenMessages Stream(const WantedTopic& wanted, double rate, double age) {
  SeenMessages seen;
  seen.type = wanted.type;
  seen.md5 = wanted.md5;
  seen.count = 101;
  seen.first = 5.0;
  seen.last = 5.0 + 100.0 / rate;
  seen.ages.assign(101, age);
  return seen;
}

/// A robot of one computer, on which this program runs as well, as it should be.
RobotView HealthyView() {
  RobotView view;
  view.master_uri = "http://pr2:11311";
  view.seconds = 3.0;
  view.this_host = {"base", "127.0.0.1", "10.0.0.2"};
  view.own_host = "10.0.0.2";
  view.own_address = "10.0.0.2";
  view.addresses = {{"pr2", {"10.0.0.1"}}};
  view.nodes["/pr2"] = {"http://pr2:40001/", Reach::kAnswers};
  view.has_robot_description = true;
  for (const WantedTopic& wanted : Needs().all_topics()) {
    SeenTopic& topic = view.topics[wanted.name];
    topic.type = wanted.type;
    topic.publishers = {"/pr2"};
    topic.messages["/pr2"] = Stream(wanted, 30.0, 0.004);
  }
  for (const WantedListener& wanted : Needs().listeners) {
    view.topics[wanted.name].type = wanted.type;
    view.topics[wanted.name].subscribers = {"/pr2"};
  }
  view.frames["odom_combined"] = {{"map"}, -0.05, false};
  view.frames["base_footprint"] = {{"odom_combined"}, 0.02, false};
  for (const std::string& link : LinksOf(Profile())) view.frames[link] = {{"x"}, 9.0, true};
  for (const JointChoice& choice : JointsOf(Profile())) view.joints.insert(choice.front());
  view.motors_halted = false;
  view.topics["/move_base/goal"] = {"move_base_msgs/MoveBaseActionGoal", {}, {"/mb"}, {}, {}, {}};
  view.topics["/move_base/status"] = {"", {"/mb"}, {}, {}, {}, {}};
  view.nodes["/mb"] = {"http://pr2:40002/", Reach::kAnswers};
  view.services = {"/move_base_node/DWAPlannerROS/set_parameters"};
  view.planner_parameters = {"max_vel_x",     "max_vel_trans", "max_vel_theta",
                             "acc_lim_theta", "acc_lim_x",     "acc_lim_y"};
  return view;
}

std::vector<std::string> CodesOf(const RobotFindings& findings) {
  std::vector<std::string> codes;
  for (const RobotFinding& finding : findings) codes.push_back(finding.code);
  return codes;
}

std::vector<std::string> Codes(const RobotView& view) {
  return CodesOf(JudgeRobot({}, Needs(), Profile(), view));
}

TEST(RobotNeedsTest, TheRobotsOwnNamesAreWantedWithTheirTypes) {
  const std::vector<WantedTopic> topics = Needs().all_topics();
  ASSERT_EQ(topics.size(), Needs().topics.size() + 1);
  EXPECT_EQ(topics.back().name, "/map");
  EXPECT_EQ(topics.back().md5, "og5");
  EXPECT_EQ(topics.front().name, "/base_odometry/odom");
  EXPECT_EQ(topics.front().type, "nav_msgs/Odometry");
  EXPECT_TRUE(topics.front().is_stamped);
  EXPECT_EQ(Needs().listeners.front().type, "geometry_msgs/Twist");
}

TEST(RobotNeedsTest, ARobotThatDoesNotTellOfItsMotorsNeedNot) {
  hires::control::RobotNames names = Needs().names;
  names.motors_halted.clear();
  EXPECT_EQ(NeedsOf(names, Types(), {}).topics.size(), Needs().topics.size() - 1);
}

TEST(RobotNeedsTest, ALinkThatIsTwoThingsIsWantedOnce) {
  hires::robot::RobotProfile profile = Profile();
  profile.laser_link = profile.tray_link;
  for (auto& [name, arm] : profile.upper_body->arms) arm.tool_link = arm.palm_link;
  std::vector<std::string> links = LinksOf(profile);
  std::sort(links.begin(), links.end());
  EXPECT_EQ(std::adjacent_find(links.begin(), links.end()), links.end());
  EXPECT_EQ(links.size(), LinksOf(Profile()).size() - 1 - profile.upper_body->arms.size());
}

TEST(JudgeRobotTest, AHealthyRobotHasNoFindings) { EXPECT_THAT(Codes(HealthyView()), IsEmpty()); }

TEST(JudgeRobotTest, EachMissingPieceIsItsOwnFinding) {
  for (const WantedTopic& wanted : Needs().topics) {
    RobotView view = HealthyView();
    view.topics.erase(wanted.name);
    EXPECT_THAT(Codes(view), ElementsAre("topic_missing")) << wanted.name;
  }
  for (const WantedListener& wanted : Needs().listeners) {
    RobotView view = HealthyView();
    view.topics.erase(wanted.name);
    EXPECT_THAT(Codes(view), ElementsAre("listener_missing")) << wanted.name;
  }
  for (const JointChoice& choice : JointsOf(Profile())) {
    RobotView view = HealthyView();
    view.joints.erase(choice.front());
    EXPECT_THAT(Codes(view), ElementsAre("joint_missing")) << choice.front();
  }
  for (const std::string& link : LinksOf(Profile())) {
    RobotView view = HealthyView();
    view.frames.erase(link);
    EXPECT_THAT(Codes(view), ElementsAre("link_missing")) << link;
  }
}

TEST(JudgeRobotTest, OtherVersionsOfAMessageAreToldByTheirChecksum) {
  RobotView view = HealthyView();
  view.topics["/base_scan"].messages["/pr2"].md5 = "0123";
  const RobotFindings findings = JudgeTopics(Needs(), view);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].code, "topic_type");
  EXPECT_THAT(findings[0].remedy, HasSubstr("another version of that message"));
}

TEST(JudgeRobotTest, AMapMayComeByServiceInstead) {
  RobotView view = HealthyView();
  view.topics.erase("/map");
  EXPECT_THAT(Codes(view), ElementsAre("topic_missing"));
  view.services.insert("/static_map");
  EXPECT_THAT(Codes(view), IsEmpty());
}

TEST(JudgeRobotTest, AFingerTellsAsMuchAsTheGap) {
  RobotView view = HealthyView();
  view.joints.erase("l_gripper_joint");
  view.joints.insert("l_gripper_l_finger_joint");
  EXPECT_THAT(Codes(view), IsEmpty());
}

TEST(JudgeRobotTest, HowMuchAMissingMoveBaseMattersDependsOnWhoDrives) {
  RobotView view = HealthyView();
  view.topics.erase("/move_base/goal");
  RobotDoctorOptions options;
  const RobotFindings undecided = JudgeRobot(options, Needs(), Profile(), view);
  ASSERT_THAT(CodesOf(undecided), ElementsAre("move_base_missing"));
  EXPECT_EQ(undecided[0].level, FindingLevel::kWarning);
  options.navigation = "move_base";
  const RobotFindings needed = JudgeRobot(options, Needs(), Profile(), view);
  ASSERT_THAT(CodesOf(needed), ElementsAre("move_base_missing"));
  EXPECT_EQ(needed[0].level, FindingLevel::kFailed);
  options.navigation = "own";
  EXPECT_THAT(JudgeRobot(options, Needs(), Profile(), view), IsEmpty());
}

TEST(JudgeRobotTest, SilenceOfANodeThatCannotBeReachedPointsToItsComputer) {
  RobotView view = HealthyView();
  view.topics["/base_scan"].messages.clear();
  RobotFindings findings = JudgeTopics(Needs(), view);
  ASSERT_THAT(CodesOf(findings), ElementsAre("topic_silent"));
  EXPECT_THAT(findings[0].remedy, HasSubstr("start the robot"));
  view.nodes["/pr2"].reach = Reach::kUnresolvable;
  findings = JudgeTopics(Needs(), view);
  ASSERT_THAT(CodesOf(findings), ElementsAre("topic_silent"));
  EXPECT_THAT(findings[0].remedy, HasSubstr("what is said of host pr2"));
}

TEST(JudgeRobotTest, FramesMayLeadToEachOtherOverOthers) {
  RobotView view = HealthyView();
  view.frames["odom_combined"] = {{"world"}, 0.02, false};
  view.frames["map"] = {{"world"}, 9.0, true};
  view.frames["base_footprint"] = {{"sled"}, 9.0, true};
  view.frames["sled"] = {{"odom_combined"}, 0.02, false};
  EXPECT_THAT(Codes(view), IsEmpty());
  view.frames["sled"].age = 1.0;
  const RobotFindings stale = JudgeFrames(Needs(), Profile(), view);
  ASSERT_THAT(CodesOf(stale), ElementsAre("frame_stale"));
  EXPECT_EQ(stale[0].subject, "frame sled");
  EXPECT_THAT(stale[0].text, HasSubstr("odom_combined -> sled is 1.00 s old"));
}

/// A localisation that puts the odometry below the base.
TEST(JudgeRobotTest, OneStaleLinkOfBothWaysIsSaidOnce) {
  RobotView view = HealthyView();
  view.frames["base_footprint"] = {{"map"}, 1.0, false};
  view.frames["odom_combined"] = {{"base_footprint"}, 0.0, false};
  EXPECT_THAT(Codes(view), ElementsAre("frame_stale"));
}

TEST(JudgeRobotTest, FramesThatDoNotMeetAreNamedWithWhatIsAboveThem) {
  RobotView view = HealthyView();
  view.frames["odom_combined"] = {{"venue"}, 0.0, false};
  const RobotFindings findings = JudgeFrames(Needs(), Profile(), view);
  ASSERT_THAT(CodesOf(findings), ElementsAre("frame_missing"));
  EXPECT_EQ(findings[0].text,
            "hangs in odom_combined < venue, which does not lead to map (in map)");
}

TEST(JudgeRobotTest, LinksInACircleLeadNowhere) {
  RobotView view = HealthyView();
  view.frames["odom_combined"] = {{"base_footprint"}, 0.0, false};
  const RobotFindings findings = JudgeFrames(Needs(), Profile(), view);
  ASSERT_THAT(CodesOf(findings), ElementsAre("frame_missing"));
  EXPECT_THAT(findings[0].text, HasSubstr("odom_combined < base_footprint, which does not lead"));
}

TEST(JudgeRobotTest, ABaseThatTheTreeHasInTheMapNeedsNoOdometryThere) {
  RobotView view = HealthyView();
  view.frames.erase("odom_combined");
  view.frames["base_footprint"] = {{"ceiling"}, 0.0, false};
  view.frames["ceiling"] = {{"map"}, 9.0, true};
  const RobotFindings findings = JudgeFrames(Needs(), Profile(), view);
  ASSERT_THAT(CodesOf(findings), ElementsAre("frame_missing"));
  EXPECT_EQ(findings[0].level, FindingLevel::kWarning);
  EXPECT_THAT(findings[0].text, HasSubstr("base_footprint < ceiling < map says alone"));
  view.frames["base_footprint"].age = 1.0;
  EXPECT_THAT(CodesOf(JudgeFrames(Needs(), Profile(), view)),
              ElementsAre("frame_stale", "frame_missing"));
}

TEST(JudgeRobotTest, WithoutAnyTransformThereIsOneFindingForAllFrames) {
  RobotView view = HealthyView();
  view.frames.clear();
  EXPECT_THAT(Codes(view), ElementsAre("frame_missing"));
}

TEST(JudgeRobotTest, WhatFollowsFromOnesOwnLoopbackIsNotSaidAsWell) {
  RobotView view = HealthyView();
  view.own_host = "127.0.0.1";
  view.is_heard = false;
  for (auto& [name, topic] : view.topics) topic.messages.clear();
  view.frames.clear();
  EXPECT_THAT(Codes(view), ElementsAre("own_loopback"));
}

TEST(JudgeRobotTest, WhatFailsComesFirst) {
  RobotView view = HealthyView();
  view.motors_halted = true;
  view.frames.erase(Profile().tray_link);
  view.uses_sim_time = true;
  EXPECT_THAT(Codes(view), ElementsAre("motors_halted", "sim_time", "link_missing"));
}

// ---------------------------------------------------------------- hosts

TEST(JudgeHostsTest, LoopbackAddressesMatterOnlyAmongSeveralComputers) {
  RobotView view = HealthyView();
  view.nodes["/mb"].uri = "http://localhost:40002/";
  const RobotFindings findings = JudgeHosts(view);
  ASSERT_THAT(CodesOf(findings), ElementsAre("loopback"));
  EXPECT_THAT(findings[0].text, HasSubstr("/mb"));
  view.master_uri = "http://localhost:11311";
  view.nodes["/pr2"].uri = "http://127.0.0.1:40001/";
  EXPECT_THAT(JudgeHosts(view), IsEmpty());
}

TEST(JudgeHostsTest, OwnLoopbackIsToldWithTheAddressToUse) {
  RobotView view = HealthyView();
  view.own_host = "localhost";
  const RobotFindings findings = JudgeHosts(view);
  ASSERT_THAT(CodesOf(findings), ElementsAre("own_loopback"));
  EXPECT_THAT(findings[0].remedy, HasSubstr("ROS_IP=10.0.0.2"));
}

TEST(JudgeHostsTest, AnotherComputersNameThatLeadsHereIsTold) {
  RobotView view = HealthyView();
  view.addresses["pr2"] = {"127.0.1.1"};
  EXPECT_THAT(CodesOf(JudgeHosts(view)), ElementsAre("loopback"));
}

TEST(JudgeHostsTest, NodesAreSummedUpByTheirComputer) {
  RobotView view = HealthyView();
  for (int i = 0; i < 6; ++i) {
    view.nodes["/n" + std::to_string(i)] = {"http://pr2:4100" + std::to_string(i), Reach::kSilent};
  }
  const RobotFindings findings = JudgeHosts(view);
  ASSERT_THAT(CodesOf(findings), ElementsAre("node_unreachable"));
  EXPECT_EQ(findings[0].subject, "host pr2");
  EXPECT_THAT(findings[0].text, HasSubstr("/n3 (port 41003) and 2 more"));
}

TEST(JudgeHostsTest, DataPortsAreToldApartFromNodes) {
  RobotView view = HealthyView();
  view.topics["/base_scan"].data_at["/pr2"] = {"pr2", 50000};
  view.topics["/base_scan"].data_ports["/pr2"] = Reach::kSilent;
  const RobotFindings findings = JudgeHosts(view);
  ASSERT_THAT(CodesOf(findings), ElementsAre("data_unreachable"));
  EXPECT_THAT(findings[0].text, HasSubstr("pr2 port 50000, which does not answer"));
}

TEST(JudgeHostsTest, ALogThatNobodyFetchesIsTold) {
  RobotView view = HealthyView();
  view.is_heard = true;
  EXPECT_THAT(JudgeHosts(view), IsEmpty());
  view.is_heard = false;
  EXPECT_THAT(CodesOf(JudgeHosts(view)), ElementsAre("not_heard"));
}

// ---------------------------------------------------------------- clocks

TEST(ClockBoundsTest, AnswersNarrowThem) {
  ClockBounds bounds;
  // Their clock is 0.2 s ahead: asked at 10.7 it says 10, at 10.85 it says 11.
  bounds.Add(10.700, 10.701, 10.0, 11.0);
  EXPECT_DOUBLE_EQ(bounds.lower, 10.0 - 10.701);
  EXPECT_DOUBLE_EQ(bounds.upper, 11.0 - 10.700);
  bounds.Add(10.798, 10.799, 10.0, 11.0);
  bounds.Add(10.801, 10.802, 11.0, 12.0);
  EXPECT_NEAR(bounds.lower, 0.198, 1e-9);
  EXPECT_NEAR(bounds.upper, 0.202, 1e-9);
  EXPECT_EQ(bounds.num_answers, 3);
}

TEST(ParseHttpDateTest, OnlyHttpDatesAreRead) {
  EXPECT_EQ(ParseHttpDate("Thu, 01 Jan 1970 00:00:10 GMT"), 10.0);
  EXPECT_EQ(ParseHttpDate("Fri, 20 Nov 2026 14:36:22 GMT"), 1795185382.0);
  for (const char* text : {"", "yesterday", "Fri, 20 Nov 2026 14:36:22 GMT+1", "14:36:22"}) {
    EXPECT_EQ(ParseHttpDate(text), std::nullopt) << text;
  }
}

RobotView ViewWithClock(double lower, double upper) {
  RobotView view = HealthyView();
  view.clocks["pr2"] = {lower, upper, 150};
  return view;
}

TEST(JudgeClocksTest, MoreThanFiftyMillisecondsForCertainAreASkew) {
  EXPECT_THAT(JudgeClocks(ViewWithClock(-0.01, 0.01)), IsEmpty());
  EXPECT_THAT(JudgeClocks(ViewWithClock(0.045, 0.055)), IsEmpty());
  const RobotFindings ahead = JudgeClocks(ViewWithClock(0.2, 0.21));
  ASSERT_THAT(CodesOf(ahead), ElementsAre("clock_skew"));
  EXPECT_THAT(ahead[0].text, HasSubstr("0.205 s ahead of"));
  EXPECT_THAT(ahead[0].text, HasSubstr("sure to 5 ms"));
  const RobotFindings behind = JudgeClocks(ViewWithClock(-0.21, -0.2));
  ASSERT_THAT(CodesOf(behind), ElementsAre("clock_skew"));
  EXPECT_THAT(behind[0].text, HasSubstr("0.205 s behind"));
  EXPECT_THAT(CodesOf(JudgeClocks(ViewWithClock(-0.2, 0.2))), ElementsAre("clock_unsure"));
}

RobotView ViewWithAges(double age) {
  RobotView view = HealthyView();
  for (auto& [name, topic] : view.topics) {
    for (auto& [node, messages] : topic.messages) messages.ages.assign(20, age);
  }
  return view;
}

TEST(JudgeClocksTest, StampsProveOnlyAClockThatIsAhead) {
  EXPECT_THAT(JudgeClocks(ViewWithAges(0.04)), IsEmpty());
  EXPECT_THAT(JudgeClocks(ViewWithAges(-0.04)), IsEmpty());
  const RobotFindings ahead = JudgeClocks(ViewWithAges(-0.3));
  ASSERT_THAT(CodesOf(ahead), ElementsAre("clock_skew"));
  EXPECT_THAT(ahead[0].text, HasSubstr("0.300 s or more ahead"));
  const RobotFindings late = JudgeClocks(ViewWithAges(0.2));
  ASSERT_THAT(CodesOf(late), ElementsAre("clock_unsure"));
  EXPECT_EQ(late[0].level, FindingLevel::kWarning);
}

TEST(JudgeClocksTest, OneQuickMessageClearsAComputer) {
  RobotView view = ViewWithAges(0.2);
  view.topics["/base_scan"].messages["/pr2"].ages[7] = 0.01;
  EXPECT_THAT(JudgeClocks(view), IsEmpty());
}

TEST(JudgeClocksTest, AnswersCountMoreThanStamps) {
  RobotView view = ViewWithAges(0.2);
  view.clocks["pr2"] = {-0.005, 0.005, 150};
  EXPECT_THAT(JudgeClocks(view), IsEmpty());
}

TEST(JudgeClocksTest, ThisComputersClockIsNotComparedWithItself) {
  RobotView view = ViewWithAges(0.2);
  view.addresses["pr2"] = {"10.0.0.2"};
  EXPECT_THAT(JudgeClocks(view), IsEmpty());
}

// ---------------------------------------------------------------- probes

void BindToLoopback(int server, hires::relay::Endpoint* port) {
  sockaddr_in where{};
  where.sin_family = AF_INET;
  inet_pton(AF_INET, "127.0.0.1", &where.sin_addr);
  socklen_t size = sizeof(where);
  ASSERT_EQ(bind(server, reinterpret_cast<sockaddr*>(&where), size), 0);
  ASSERT_EQ(getsockname(server, reinterpret_cast<sockaddr*>(&where), &size), 0);
  *port = {"127.0.0.1", ntohs(where.sin_port)};
}

TEST(ProbePortTest, PortsAnswerRefuseOrStaySilent) {
  const int server = socket(AF_INET, SOCK_STREAM, 0);
  hires::relay::Endpoint port;
  ASSERT_NO_FATAL_FAILURE(BindToLoopback(server, &port));
  EXPECT_EQ(ProbePort(port, 5.0), Reach::kRefused) << "bound, but nobody listens";
  ASSERT_EQ(listen(server, 5), 0);
  EXPECT_EQ(ProbePort(port, 5.0), Reach::kAnswers);
  close(server);
  EXPECT_EQ(ProbePort({"no-such-host.invalid", 80}, 0.1), Reach::kUnresolvable);
}

TEST(ProbePortTest, ADeafServerTellsNoTime) {
  const int server = socket(AF_INET, SOCK_STREAM, 0);
  hires::relay::Endpoint port;
  ASSERT_NO_FATAL_FAILURE(BindToLoopback(server, &port));
  ASSERT_EQ(listen(server, 5), 0);
  EXPECT_EQ(CompareClocks(port, 0.01, 0.1), std::nullopt);
  close(server);
}

TEST(AskNetworkTest, NodesThatAnswerAreAskedForTheirDataAndAllAreTold) {
  const int server = socket(AF_INET, SOCK_STREAM, 0);
  hires::relay::Endpoint port;
  ASSERT_NO_FATAL_FAILURE(BindToLoopback(server, &port));
  ASSERT_EQ(listen(server, 5), 0);
  RobotView view;
  view.this_host = {"127.0.0.1"};
  view.nodes["/here"].uri = "http://127.0.0.1:" + std::to_string(port.port) + "/";
  view.nodes["/gone"].uri = "http://no-such-host.invalid:1/";
  view.nodes["/odd"].uri = "no uri";
  view.topics["/base_scan"].publishers = {"/here", "/gone"};
  WantedTopic wanted;
  wanted.name = "/base_scan";
  std::vector<std::string> asked;
  const AskDataPort ask = [&](const hires::relay::Endpoint&, const std::string& topic, double) {
    asked.push_back(topic);
    return port;
  };
  TakeAnswers(AskNetwork(ask, port, view, {wanted}), &view);
  EXPECT_THAT(asked, ElementsAre("/base_scan"));
  EXPECT_EQ(view.nodes["/here"].reach, Reach::kAnswers);
  EXPECT_EQ(view.nodes["/gone"].reach, Reach::kUnresolvable);
  EXPECT_EQ(view.nodes["/odd"].reach, Reach::kBadUri);
  EXPECT_EQ(view.topics["/base_scan"].data_at["/here"].port, port.port);
  EXPECT_EQ(view.topics["/base_scan"].data_ports["/here"], Reach::kAnswers);
  EXPECT_THAT(view.clocks, IsEmpty()) << "this computer's clock is not compared with itself";
  close(server);
}

TEST(OwnAddressTest, TowardsLoopbackItIsLoopback) {
  EXPECT_EQ(OwnAddressTowards({"127.0.0.1", 11311}), "127.0.0.1");
  EXPECT_EQ(OwnAddressTowards({"no-such-host.invalid", 11311}), std::nullopt);
}

// ---------------------------------------------------------------- reports

TEST(RobotReportTest, TextAndJsonSayTheSame) {
  RobotView view = HealthyView();
  view.motors_halted = true;
  view.clocks["pr2"] = {-0.004, 0.006, 150};
  const RobotFindings findings = JudgeRobot({}, Needs(), Profile(), view);
  const std::string text = RobotReport(Needs(), view, findings);
  EXPECT_THAT(text, HasSubstr("FAILED  motors /pr2_ethercat/motors_halted says that they are "));
  EXPECT_THAT(text, HasSubstr("something needs attention"));
  EXPECT_THAT(text, HasSubstr("30.0"));
  const auto json = RobotJson(Needs(), view, findings);
  EXPECT_EQ(json["ok"], false);
  EXPECT_EQ(json["findings"].size(), 1u);
  EXPECT_EQ(json["findings"][0]["level"], "failed");
  EXPECT_EQ(json["findings"][0]["code"], "motors_halted");
  EXPECT_EQ(json["topics"]["/base_scan"]["/pr2"]["messages"], 101);
  EXPECT_EQ(json["clocks"]["pr2"]["ahead_at_least"], -0.004);
}

TEST(RunRobotDoctorTest, TheRobotIsLookedAtAsLongAsWantedAndTheCodeSaysWhetherItIsWell) {
  RobotDoctorOptions options;
  options.seconds = 0.5;
  double seconds = 0.0;
  RobotView view = HealthyView();
  const LookAtRobot look = [&](double wanted, const RobotNeeds&) {
    seconds = wanted;
    return view;
  };
  testing::internal::CaptureStdout();
  EXPECT_EQ(RunRobotDoctor(options, HIRES_SOURCE_DIR, Types(), look), kExitRecommended);
  view.motors_halted = true;
  EXPECT_EQ(RunRobotDoctor(options, HIRES_SOURCE_DIR, Types(), look), kExitBadInput);
  EXPECT_THAT(testing::internal::GetCapturedStdout(), HasSubstr("all is well"));
  EXPECT_EQ(seconds, 0.5);
}

}  // namespace
}  // namespace hires::cli::robot_doctor_test
