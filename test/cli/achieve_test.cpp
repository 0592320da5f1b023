#include <gmock/gmock.h>
#include <yaml-cpp/yaml.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>

#include "cli/command_line.h"
#include "cli/command_run.h"
#include "cli/verbs/achieve/achieve_command.h"
#include "cli/verbs/achieve/achieve_display.h"
#include "hires/base/error.h"
#include "hires/base/text.h"
#include "support/messages.h"
#include "support/temporary_folder.h"

namespace hires::cli::achieve_test {
namespace {

using execution::StepPhase;
using hires::test_support::ConfigErrorOf;
using hires::test_support::Ended;
using hires::test_support::RunHires;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::MatchesRegex;
using ::testing::Not;

execution::StepStatus Step(int index, const std::string& name, StepPhase phase) {
  execution::StepStatus step;
  step.index = index;
  step.action = {name, {"area1"}};
  step.phase = phase;
  return step;
}

/// A drive that runs since 102 s, a grasp that waits for it.
loop::AchieveStatus Running() {
  loop::AchieveStatus status;
  status.now = 105.0;
  status.steps = {Step(0, "move_base", StepPhase::kRunning),
                  Step(1, "pick_up", StepPhase::kWaiting)};
  status.steps[0].started = 102.0;
  status.steps[0].expected_finish = 112.5;
  return status;
}

TEST(ImaginedOutcomeTest, EachHasAWordAndComesBackFromIt) {
  for (int i = 0; i <= static_cast<int>(loop::ImaginedOutcome::kCancelled); ++i) {
    const auto outcome = static_cast<loop::ImaginedOutcome>(i);
    EXPECT_EQ(loop::ParseImaginedOutcome(ToString(outcome)), outcome);
  }
  EXPECT_EQ(loop::ParseImaginedOutcome(""), loop::ImaginedOutcome::kRunning);
  EXPECT_THAT(ConfigErrorOf([] { loop::ParseImaginedOutcome("dreamt"); }),
              AllOf(HasSubstr("'dreamt'"), HasSubstr("no_worker")));
}

TEST(BeginOfTest, IsTheFirstMomentOfAnything) {
  loop::AchieveStatus status = Running();
  EXPECT_EQ(loop::BeginOf(status), 102.0);
  status.imaginations.emplace_back();
  status.imaginations[0].requested = 101.5;
  EXPECT_EQ(loop::BeginOf(status), 101.5);
  EXPECT_EQ(loop::BeginOf(loop::AchieveStatus{}), 0.0);
}

TEST(StepTableTest, TellsStateSinceAndExpectedEndInSecondsOfTheTask) {
  const std::string table = StepTable(Running(), 100.0);
  EXPECT_THAT(table, HasSubstr("running"));
  EXPECT_THAT(table, HasSubstr("2.0"));   // since
  EXPECT_THAT(table, HasSubstr("12.5"));  // expected end
  EXPECT_THAT(table, HasSubstr("pick_up(area1)"));
}

TEST(StepTableTest, WhatWasGivenUpBeforeItBeganIsLeftOut) {
  loop::AchieveStatus status = Running();
  status.steps[1].phase = StepPhase::kSkipped;
  EXPECT_THAT(StepTable(status, 100.0), Not(HasSubstr("pick_up")));
  status.steps[1].started = 103.0;
  EXPECT_THAT(StepTable(status, 100.0), HasSubstr("pick_up"));
}

TEST(DryRunTableTest, ShowsTheLastPlanWithWhatIsExpectedOfIt) {
  loop::AchieveStatus status;
  status.steps = {Step(0, "given_up", StepPhase::kSkipped), Step(0, "imagine", StepPhase::kDone),
                  Step(1, "move_base", StepPhase::kWaiting),
                  Step(2, "pick_up", StepPhase::kWaiting)};
  for (std::size_t i = 1; i < 4; ++i) status.steps[i].plan = 1;
  status.steps[2].expected_start = 1000.0;
  status.steps[2].expected_finish = 1012.5;
  status.steps[2].note = "imagined: slow succeeds in 0.98";
  status.steps[3].expected_start = 1012.5;
  status.steps[3].expected_finish = 1020.0;
  const std::string table = DryRunTable(status);
  EXPECT_THAT(table, AllOf(HasSubstr("move_base(area1)"), HasSubstr("imagined: slow"),
                           HasSubstr("12.5"), HasSubstr("pick_up(area1)")));
  EXPECT_THAT(table, AllOf(Not(HasSubstr("given_up")), Not(HasSubstr("imagine(area1)")),
                           Not(HasSubstr("1000"))));
}

TEST(ChangeLinesTest, TellWhatIsNewAndNothingElse) {
  loop::AchieveStatus before = Running();
  EXPECT_THAT(ChangeLines({}, before, 100.0),
              ElementsAre(HasSubstr("2.0 s  running   move_base(area1)")));
  EXPECT_THAT(ChangeLines(before, before, 100.0), IsEmpty());
  loop::AchieveStatus after = before;
  after.now = 115.0;
  after.steps[0].phase = StepPhase::kFailed;
  after.steps[0].finished = 114.0;
  after.steps[0].note = "no_path";
  EXPECT_THAT(ChangeLines(before, after, 100.0),
              ElementsAre(HasSubstr("14.0 s  failed    move_base(area1): no_path")));
}

TEST(ChangeLinesTest, WarningsAndImaginationsAreTold) {
  loop::AchieveStatus before = Running();
  loop::AchieveStatus after = before;
  after.warnings = {"the planner went away"};
  after.imaginations.emplace_back();
  after.imaginations[0].action = {"move_base_param", {{"area1"}, {"slow", "fast"}}};
  after.imaginations[0].requested = 103.0;
  EXPECT_THAT(ChangeLines(before, after, 100.0),
              ElementsAre(HasSubstr("warning   the planner went away"),
                          HasSubstr("3.0 s  imagines  move_base_param(area1, slow|fast)")));
  before = after;
  after.imaginations[0].outcome = loop::ImaginedOutcome::kRanked;
  after.imaginations[0].answered = 108.0;
  after.imaginations[0].why = "slow is best";
  EXPECT_THAT(ChangeLines(before, after, 100.0),
              ElementsAre(HasSubstr("8.0 s  imagined  move_base_param(area1, slow|fast): ranked: "
                                    "slow is best")));
}

TEST(AchieveDisplayTest, DrawsOverItselfOnATerminalWithinItsWidth) {
  AchieveDisplay display(40);
  const std::string first = display.Show(Running());
  EXPECT_THAT(first, Not(HasSubstr("A\r")));
  const std::string second = display.Show(Running());
  EXPECT_EQ(second.rfind("\033[4A\r", 0), 0u) << second;  // head, line, two steps
  for (std::string line : base::Split(second.substr(5), '\n')) {
    if (const auto end = line.find("\033["); end != std::string::npos) line.resize(end);
    EXPECT_LE(line.size(), 40u) << line;
  }
}

TEST(AchieveDisplayTest, SaysOnceWhatChangesElsewhere) {
  AchieveDisplay display(0);
  EXPECT_THAT(display.Show(Running()), HasSubstr("running   move_base(area1)\n"));
  EXPECT_EQ(display.Show(Running()), "");
}

TEST(AchieveDisplayTest, SaysEachWarningOnce) {
  loop::AchieveStatus status = Running();
  status.warnings = {"the planner went away"};
  for (const int width : {0, 80}) {
    AchieveDisplay display(width);
    EXPECT_THAT(display.Show(status), HasSubstr("the planner went away")) << width;
    EXPECT_THAT(display.Show(status), Not(HasSubstr("went away"))) << width;
  }
}

/// `hires achieve` against an execution monitor made of one function.
class AchieveVerbTest : public ::testing::Test {
 protected:
  Ended Run(const std::vector<std::string>& words) {
    Backends backends;
    backends.achieve_remotely = [this](const loop::AchieveQuery& query,
                                       const loop::OnAchieveStatus& on_status,
                                       const std::function<bool()>&) {
      query_ = query;
      on_status(Running());
      report_.task = query.task;
      return report_;
    };
    return RunHires({"achieve"}, words, backends);
  }

  Ended RunFor(loop::AchieveOutcome outcome) {
    report_.outcome = outcome;
    return Run({"serve guest1"});
  }

  const test_support::TemporaryFolder folder_;
  loop::AchieveQuery query_;
  loop::AchieveReport report_;
};

TEST_F(AchieveVerbTest, ATaskIsPlayedInThisProgramWithoutAnyNode) {
  const std::string json = (folder_.path() / "run.json").string();
  const Ended ended = Run({"--local", "carry_object_on_tray mug7 counter1 table1", "--json", json});
  EXPECT_EQ(ended.code, kExitNoWay) << ended.err << "nobody knows mug7";
  EXPECT_THAT(ended.out, HasSubstr("carry_object_on_tray mug7 counter1 table1: no_plan"));
  EXPECT_THAT(ended.out, HasSubstr("in truth (same: imagination's own model): fallen: nothing"));
  EXPECT_TRUE(query_.task.empty()) << "nobody else was asked";
  const auto end = nlohmann::json::parse(base::ReadTextFile(json)).at("in_truth");
  EXPECT_EQ(end.at("touched"), "");
  const auto mill = end.at("objects").at("peppermill1");  // of the scenario topple
  EXPECT_NEAR(mill.at("position").at(0).get<double>(), 5.47, 0.01);
  EXPECT_EQ(mill.at("falls"), 0);
  EXPECT_TRUE(mill.at("stands").get<bool>());
}

TEST_F(AchieveVerbTest, WhatCannotBePlayedIsNamed) {
  Ended ended = Run({"--local", "--scenario", "tipple"});
  EXPECT_EQ(ended.code, kExitNotAchieved);
  EXPECT_THAT(ended.err, HasSubstr("config/scenarios: scenario 'tipple' is unknown; did you mean "
                                   "'topple'?; or give a path"));
  EXPECT_THAT(Run({"--local", "--truth", "foregin"}).err, HasSubstr("'foreign'"));
  EXPECT_THAT(Run({"--local", "--config", "lop.yaml"}).err, HasSubstr("lop.yaml"));
  ended = Run({"--local", "sreve_coffee_to_guest", "guest1"});
  EXPECT_EQ(ended.code, kExitNotAchieved);
  EXPECT_THAT(ended.err, HasSubstr("serve_coffee_to_guest"));
  EXPECT_THAT(Run({}).err, HasSubstr("wanted a task"));
}

TEST_F(AchieveVerbTest, AnAreaThatNothingKnowsIsRefusedBeforeAnythingBegins) {
  ASSERT_EQ(setenv("ROS_PACKAGE_PATH", HIRES_SOURCE_DIR, 1), 0);  // of model://sun
  const std::string own = std::string(HIRES_SOURCE_DIR) + "/examples/own_robot/";
  const auto deliver = [&](const std::string& object, const std::string& area) {
    return Run({"--local", "--scenario", own + "scenario.yaml", "--world", own + "hall.world",
                "--robot", own + "courier.yaml", "--objects", own + "objects.yaml", "--domain",
                own + "delivery.lisp", "--dry-run", "--imagination", "off", "deliver", object,
                area});
  };
  const Ended ended = deliver("soup1", "atRundTable");
  EXPECT_EQ(ended.code, kExitNotAchieved);
  EXPECT_EQ(ended.out, "");
  EXPECT_THAT(ended.err, HasSubstr("task argument 'atRundTable' is unknown; did you mean "
                                   "'atRoundTable'?"));
  EXPECT_THAT(deliver("soup1", "atLongTable2").err, HasSubstr("'atLongTable2' stands in no file"))
      << "what a number tells apart may be another one";
  EXPECT_EQ(deliver("soup1", "ATROUNDTABLE").code, 0) << "lookups ignore case";
  EXPECT_EQ(deliver("soup1", "atLongTable").code, 0);
}

TEST_F(AchieveVerbTest, ADryRunWhoseStepMakesNoSenseHasFailed) {
  ASSERT_EQ(setenv("ROS_PACKAGE_PATH", HIRES_SOURCE_DIR, 1), 0);  // of model://sun
  const std::string own = std::string(HIRES_SOURCE_DIR) + "/examples/own_robot/";
  const auto deliver = [&](const std::string& area, const std::string& imagination) {
    return Run({"--local", "--scenario", own + "scenario.yaml", "--world", own + "hall.world",
                "--robot", own + "courier.yaml", "--objects", own + "objects.yaml", "--domain",
                own + "delivery.lisp", "--dry-run", "--imagination", imagination, "deliver",
                "soup1", area});
  };
  for (const std::string area : {"atSquareTable", "behindBar"}) {  // spelt like none
    for (const std::string imagination : {"off", "domain"}) {
      const Ended ended = deliver(area, imagination);
      EXPECT_EQ(ended.code, kExitNotAchieved) << area << ", imagination " << imagination;
      EXPECT_THAT(ended.out, AllOf(HasSubstr("would begin"), HasSubstr(": failed: "),
                                   HasSubstr("area '" + base::ToLower(area) + "' is unknown")))
          << imagination;
    }
  }
  EXPECT_EQ(deliver("atLongTable", "off").code, kExitAchieved);
}

TEST_F(AchieveVerbTest, AnEmptyWordIsNotTakenForNone) {
  for (const auto& words : std::vector<std::vector<std::string>>{
           {"--local", ""}, {"--local", "deliver", "", "atRoundTable"}, {"--local", " "}, {""}}) {
    const Ended ended = Run(words);
    EXPECT_EQ(ended.code, kExitNotAchieved);
    EXPECT_EQ(ended.out, "");
    EXPECT_THAT(ended.err, AllOf(HasSubstr("task"), HasSubstr("an empty text came")));
  }
}

double VirtualSecondsIn(const std::string& text) {
  std::smatch found;
  if (!std::regex_search(text, found, std::regex("([0-9.]+) s of virtual time"))) return -1.0;
  return std::stod(found[1]);
}

TEST_F(AchieveVerbTest, WhatIsOfVirtualTimeAloneIsRefusedWithoutIt) {
  for (const std::string option :
       {"--scenario", "--config", "--seed", "--truth", "--threads", "--world", "--robot",
        "--objects", "--domain", "--operators", "--map", "--area"}) {
    const Ended ended = Run({"serve guest1", option, "1"});
    EXPECT_EQ(ended.code, kExitNotAchieved) << option;
    EXPECT_THAT(ended.err, AllOf(HasSubstr(option), HasSubstr("--local")));
  }
}

TEST_F(AchieveVerbTest, ADryRunInThisProgramPrintsThePlanAndBeginsNothing) {
  const std::string store = (folder_.path() / "episode.db").string();
  const Ended ended = Run({"--local", "--dry-run", "--imagination", "off", "--store", store});
  const Ended again = Run({"--local", "--dry-run", "--imagination", "off", "--store", store});
  EXPECT_EQ(again.code, kExitNotAchieved);
  EXPECT_THAT(again.err, AllOf(HasSubstr("episode.db"), HasSubstr("name a new file")));
  EXPECT_EQ(ended.code, kExitAchieved) << ended.err;
  EXPECT_THAT(ended.out, AllOf(HasSubstr("would begin"), HasSubstr("nothing was begun"),
                               HasSubstr("move_base(premanipulationareaeastcounter1)")));
  EXPECT_LT(VirtualSecondsIn(ended.out), 10.0);
  const Ended refused = Run({"serve guest1", "--dry-run"});
  EXPECT_EQ(refused.code, kExitNotAchieved);
  EXPECT_THAT(refused.err, AllOf(HasSubstr("--dry-run"), HasSubstr("--local")));
}

TEST_F(AchieveVerbTest, AnotherVirtualTimeIsTakenFromAnotherFile) {
  const std::string config = HIRES_SOURCE_DIR "/config/";
  YAML::Node loop = YAML::LoadFile(config + "loop.yaml");
  for (auto entry : loop) {
    if (!entry.second.IsScalar() || entry.first.Scalar() == "planning_time") continue;
    entry.second = config + entry.second.Scalar();
  }
  loop["planning_time"] = 7.05;
  const std::string path = folder_.path() / "slow.yaml";
  std::ofstream(path) << loop;
  const std::string task = "carry_object_on_tray mug7 counter1 table1";
  const double usual = VirtualSecondsIn(Run({"--local", task}).out);
  EXPECT_NEAR(VirtualSecondsIn(Run({"--local", "--config", path, task}).out), usual + 7.0, 0.11);
}

TEST_F(AchieveVerbTest, ARobotWithoutCameraInAWorldOfItsOwnDoesATaskOfItsOwn) {
  ASSERT_EQ(setenv("ROS_PACKAGE_PATH", HIRES_SOURCE_DIR, 1), 0);  // of model://sun
  const std::string own = HIRES_SOURCE_DIR "/examples/own_robot/";
  const std::vector<std::string> files{"--local",
                                       "--imagination",
                                       "off",
                                       "--scenario",
                                       own + "scenario.yaml",
                                       "--world",
                                       own + "hall.world",
                                       "--robot",
                                       own + "courier.yaml",
                                       "--objects",
                                       own + "objects.yaml"};
  auto with_domain = files;
  with_domain.insert(with_domain.end(), {"--domain", own + "delivery.lisp"});
  const Ended ended = Run(with_domain);
  EXPECT_EQ(ended.code, kExitAchieved) << ended.err;
  EXPECT_THAT(ended.out, AllOf(HasSubstr("deliver soup1 atRoundTable: succeeded"),
                               HasSubstr("fallen: nothing")));
  EXPECT_THAT(Run(files).err, AllOf(HasSubstr("task 'deliver' is unknown"),
                                    HasSubstr("config/domains/restaurant.lisp")));
  with_domain.insert(with_domain.end(), {"--operators", own + "knowledge.yaml"});
  EXPECT_THAT(Run(with_domain).err, HasSubstr("knowledge.yaml"));
}

TEST_F(AchieveVerbTest, ATaskIsDoneInAMapWithGoalsAsAreas) {
  const std::string own = HIRES_SOURCE_DIR "/examples/own_robot/";
  const std::string map = HIRES_SOURCE_DIR "/examples/your_files/";
  const std::string store = (folder_.path() / "episode.db").string();
  const std::vector<std::string> words{"--local",
                                       "--imagination",
                                       "off",
                                       "--map",
                                       map + "depot.yaml",
                                       "--area",
                                       map + "goals.yaml",
                                       "--area",
                                       "kitchenDoor:0.8,0.8,0",
                                       "--scenario",
                                       own + "scenario.yaml",
                                       "--robot",
                                       own + "courier.yaml",
                                       "--objects",
                                       own + "objects.yaml",
                                       "--domain",
                                       own + "delivery.lisp"};
  auto there = words;
  there.insert(there.end(), {"--store", store, "deliver", "soup1", "rack_2_front"});
  const Ended ended = Run(there);
  EXPECT_EQ(ended.code, kExitAchieved) << ended.err;
  EXPECT_THAT(ended.out, AllOf(HasSubstr("deliver soup1 rack_2_front: succeeded"),
                               HasSubstr("fallen: nothing")));
  const Ended known = RunHires({"blackboard"}, {"query", "--class", "Area", "--store", store});
  EXPECT_THAT(known.out, AllOf(HasSubstr("rack_2_front"), HasSubstr("behind_partition")));
  EXPECT_THAT(known.out, HasSubstr("hasPose=poseKitchenDoor")) << "the knowledge file's";
  auto nowhere = words;
  nowhere.insert(nowhere.end(), {"deliver", "soup1", "rack_2_frnt"});
  EXPECT_THAT(Run(nowhere).err, HasSubstr("did you mean 'rack_2_front'"));
  auto both = words;
  both.insert(both.end(), {"--world", own + "hall.world"});
  EXPECT_THAT(Run(both).err, AllOf(HasSubstr("--map"), HasSubstr("--world")));
}

TEST_F(AchieveVerbTest, TheTaskMayBeOneWordOrSeveral) {
  report_.outcome = loop::AchieveOutcome::kSucceeded;
  Run({"serve", "guest1", "--imagination", "thesis"});
  EXPECT_EQ(query_.task, "serve guest1");
  EXPECT_EQ(query_.imagination, "thesis");
  EXPECT_EQ(Run({"(:unordered (a x) (b y))"}).code, 0);
  EXPECT_EQ(query_.task, "(:unordered (a x) (b y))");
}

TEST_F(AchieveVerbTest, ExitCodesTellTheOutcome) {
  EXPECT_EQ(RunFor(loop::AchieveOutcome::kSucceeded).code, kExitAchieved);
  EXPECT_EQ(RunFor(loop::AchieveOutcome::kFailed).code, kExitNotAchieved);
  EXPECT_EQ(RunFor(loop::AchieveOutcome::kInvalid).code, kExitNotAchieved);
  EXPECT_EQ(RunFor(loop::AchieveOutcome::kBusy).code, kExitNotAchieved);
  EXPECT_EQ(RunFor(loop::AchieveOutcome::kNoPlan).code, kExitNoWay);
  EXPECT_EQ(RunFor(loop::AchieveOutcome::kPreempted).code, kExitPreempted);
  EXPECT_EQ(RunFor(loop::AchieveOutcome::kDryRun).code, kExitAchieved);
}

TEST_F(AchieveVerbTest, ADryRunPrintsThePlan) {
  report_.outcome = loop::AchieveOutcome::kDryRun;
  report_.reason = "planned and imagined; nothing was begun";
  report_.status.steps = {Step(0, "pick_up", StepPhase::kWaiting)};
  const Ended ended = Run({"serve guest1"});
  EXPECT_THAT(ended.out, AllOf(HasSubstr("would begin"), HasSubstr("pick_up(area1)"),
                               HasSubstr("dry_run: planned and imagined; nothing was begun")));
}

TEST_F(AchieveVerbTest, SaysOutcomeReasonAndNumbers) {
  report_.outcome = loop::AchieveOutcome::kFailed;
  report_.reason = "unreachable";
  report_.status = Running();
  report_.status.replans = 2;
  report_.episode = 17;
  const Ended ended = Run({"serve", "guest1"});
  EXPECT_THAT(ended.out, HasSubstr("running   move_base(area1)"));
  EXPECT_THAT(ended.out, HasSubstr("serve guest1: failed: unreachable"));
  EXPECT_THAT(ended.out, HasSubstr("1 step, 0 imaginations, 2 repairs, episode 17"));
}

TEST_F(AchieveVerbTest, WritesTimelineAndJson) {
  report_.outcome = loop::AchieveOutcome::kSucceeded;
  report_.status = Running();
  const std::string csv = (folder_.path() / "run.csv").string();
  const std::string json = (folder_.path() / "run.json").string();
  EXPECT_EQ(Run({"serve", "--timeline", csv, "--json", json}).code, 0);
  EXPECT_THAT(base::ReadTextFile(csv), HasSubstr("step,0,0,move_base(area1),running"));
  EXPECT_THAT(base::ReadTextFile(json),
              AllOf(HasSubstr("\"outcome\": \"succeeded\""), HasSubstr("\"verb\": \"achieve\""),
                    HasSubstr("\"local\": false")));
}

TEST_F(AchieveVerbTest, BadInputIsRefusedBeforeTheRobotSetsOut) {
  for (const auto& [words, text] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{}, "task"},
           {{"serve", "--imagination", "sometimes"}, "sometimes"},
           {{"serve", "--json", "/no/such/folder/x.json"}, "/no/such/folder"},
           {{"serve", "--png", "/no/such/folder/x.png"}, "/no/such/folder"}}) {
    query_.task.clear();
    const Ended ended = Run(words);
    EXPECT_EQ(ended.code, kExitBadInput) << text;
    EXPECT_THAT(ended.err, HasSubstr(text));
    EXPECT_EQ(query_.task, "") << text;
  }
}

TEST_F(AchieveVerbTest, TheTasksOfADomainAreListedWithTheirParameters) {
  const Ended ended = Run({"--list"});
  EXPECT_EQ(ended.code, kExitAchieved) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("serve_coffee_to_guest      ?guest"));
  const std::string domain = folder_.Write(
      "d.lisp", "(defdomain d ((:operator (!wave) () () ()) (:method (greet ?who) () ((!wave)))))");
  EXPECT_THAT(Run({"--list", "--domain", domain}).out, HasSubstr("greet  ?who"));
  EXPECT_THAT(Run({"--list", "--domain", "/nowhere.lisp"}).err, HasSubstr("/nowhere.lisp"));
  EXPECT_EQ(query_.task, "");
}

TEST_F(AchieveVerbTest, TheDomainOfTheRunningMonitorIsListed) {
  Backends backends;
  const std::string domain = folder_.Write(
      "d.lisp", "(defdomain d ((:operator (!wave) () () ()) (:method (greet ?who) () ((!wave)))))");
  backends.domain_of_monitor = [&] { return domain; };
  EXPECT_THAT(RunHires({"achieve"}, {"--list"}, backends).out, HasSubstr("greet  ?who"));
}

TEST(AchieveWithoutRosTest, SaysWhatIsMissing) {
  const Ended ended = RunHires({"achieve", "serve"});
  EXPECT_EQ(ended.code, kExitBadInput);
  EXPECT_THAT(ended.err, HasSubstr("no ROS nodes"));
}

}  // namespace
}  // namespace hires::cli::achieve_test
