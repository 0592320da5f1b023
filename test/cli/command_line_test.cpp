#include "cli/command_line.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/command_run.h"
#include "hires/base/text.h"
#include "reports/report_examples.h"
#include "support/temporary_folder.h"

namespace hires::cli::command_line_test {
namespace {

using hires::test_support::Ended;
using hires::test_support::RunHires;
using hires::test_support::TemporaryFolder;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

/// A small scene that loads and plays quickly: the cart in a hall.
class SmallScene {
 public:
  SmallScene() {
    const std::string root = HIRES_SOURCE_DIR;
    folder_.Write("hall.world", R"(<?xml version="1.0"?><sdf version="1.7"><world name="hall">
      <frame name="Door" attached_to="world"><pose>0 0 0 0 0 0</pose></frame>
      <frame name="Window" attached_to="world"><pose>1.5 0 0 0 0 0</pose></frame>
      <frame name="Inside" attached_to="world"><pose>4 0 0 0 0 0</pose></frame>
      <model name="pillar"><static>true</static><pose>4 0 0.5 0 0 0</pose><link name="l">
        <collision name="c"><geometry><box><size>0.5 0.5 1</size></box></geometry></collision>
      </link></model></world></sdf>)");
    YAML::Node scene = YAML::LoadFile(root + "/config/scene.yaml");
    scene["world"] = "hall.world";
    scene["robot"] = root + "/config/robots/cart.yaml";
    scene["objects"] = root + "/worlds/objects.yaml";
    scene["uncertainty"] = "none";
    scene["detector"] = "none";
    scene["obstacle_layer"] = root + "/config/obstacle_layer.yaml";
    path_ = folder_.Write("scene.yaml", YAML::Dump(scene));
  }

  /// `hires imagine --local` in this scene, with more arguments behind.
  Ended Imagine(const std::vector<std::string>& more) const {
    std::vector<std::string> words{"imagine", "--local", "--quiet", "--scene", path_};
    words.insert(words.end(), more.begin(), more.end());
    return RunHires(words);
  }

  const std::filesystem::path& folder() const { return folder_.path(); }

 private:
  TemporaryFolder folder_;
  std::string path_;
};

const SmallScene& Small() {
  static const SmallScene scene;
  return scene;
}

const std::vector<std::string> kDrive{"--action", "move_base", "--from",      "Door",       "--arg",
                                      "Window",   "--object",  "peppermill1", "--rollouts", "2"};

std::vector<std::string> operator+(std::vector<std::string> a, const std::vector<std::string>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

void ExpectRefused(const Ended& ended, const std::vector<std::string>& words) {
  EXPECT_EQ(ended.code, kExitBadInput);
  EXPECT_EQ(ended.out, "");
  for (const std::string& word : words) EXPECT_THAT(ended.err, HasSubstr(word));
}

// -------------------------------------------------------------------------------- good input

TEST(CommandLineTest, ImaginesAndWritesWhatItFound) {
  const TemporaryFolder folder;
  const std::string json = (folder.path() / "answer.json").string();
  const Ended ended =
      Small().Imagine(kDrive + std::vector<std::string>{"--json", json, "--min-success", "0.15"});
  EXPECT_EQ(ended.code, kExitRecommended) << ended.err;
  EXPECT_THAT(ended.out, AllOf(HasSubstr("> "), HasSubstr("move_base(window)"),
                               HasSubstr("ranked: "), HasSubstr("times as fast as real time")));
  const auto answer = nlohmann::json::parse(base::ReadTextFile(json));
  EXPECT_EQ(answer.at("outcome"), "ranked");
  EXPECT_TRUE(answer.at("by_cost").is_object()) << "the default is cost";
  EXPECT_TRUE(answer.at("ranking").at(0).at("expected_cost").is_object());
  EXPECT_EQ(answer.at("ranking").at(0).at("rollouts"), 2);
  EXPECT_EQ(answer.at("seed"), 1);
  const auto& first = answer.at("ranking").at(0);
  EXPECT_EQ(first.at("duration").at("values").size(), 2u);
  EXPECT_EQ(first.at("max_tilt").at("values").size(), 2u);
  EXPECT_EQ(first.at("median_rollout").is_number(), true);
  const auto& head = answer.at("report");
  EXPECT_EQ(head.at("verb"), "imagine");
  EXPECT_EQ(head.at("local"), true);
  EXPECT_THAT(head.at("command"), AllOf(StartsWith("hires imagine --local --quiet --scene "),
                                        EndsWith(" --min-success 0.15")));
  EXPECT_EQ(head.at("inputs").size(), 5u) << "settings, scene, world, robot, objects";
  EXPECT_EQ(head.at("hashes").size(), 4u);
}

TEST(CommandLineTest, APageIsWrittenWithoutJsonBesideIt) {
  const TemporaryFolder folder;
  const std::string page = (folder.path() / "page.html").string();
  const Ended ended =
      Small().Imagine(kDrive + std::vector<std::string>{"--html", page, "--min-success", "0.15"});
  EXPECT_EQ(ended.code, kExitRecommended) << ended.err;
  EXPECT_THAT(base::ReadTextFile(page), AllOf(HasSubstr("move_base(window)"), HasSubstr("<img")));
}

/// A map of 6 m by 3 m with a wall across that has a gap of 0.4 m, too narrow for the cart, or
/// none.
std::string HallMap(const TemporaryFolder& folder, bool has_wall) {
  std::string pixels;
  for (int row = 0; row < 30; ++row) {
    for (int column = 0; column < 60; ++column) {
      const bool is_rim = row == 0 || row == 29 || column == 0 || column == 59;
      const bool is_wall = has_wall && column == 30 && (row < 13 || row > 16);
      pixels += is_rim || is_wall ? "0 " : "254 ";
    }
  }
  folder.Write("hall.pgm", "P2 60 30 255 " + pixels);
  return folder.Write("hall.yaml",
                      "{image: hall.pgm, resolution: 0.1, origin: [-1, -1.5, 0], "
                      "negate: 0, occupied_thresh: 0.65, free_thresh: 0.196}");
}

TEST(CommandLineTest, AMapIsAWorldToDriveIn) {
  const TemporaryFolder folder;
  const std::vector<std::string> drive{
      "--action",   "move_base",   "--from", "dock",       "--arg",           "bench",
      "--object",   "peppermill1", "--area", "dock:0,0,0", "--area",          "bench:3.8,0,1.57",
      "--rollouts", "4",           "--seed", "3",          "--no-early-stop", "--map"};
  const Ended open = Small().Imagine(drive + std::vector<std::string>{HallMap(folder, false)});
  EXPECT_THAT(open.out, HasSubstr("succeeded in 4 of 4")) << open.err;
  const Ended shut = Small().Imagine(drive + std::vector<std::string>{HallMap(folder, true)});
  EXPECT_THAT(shut.out, HasSubstr("no_path 4")) << shut.err;
}

TEST(CommandLineTest, EqualSeedsGiveEqualAnswers) {
  const TemporaryFolder folder;
  const auto answer = [&](const std::string& threads) {
    const std::string path = (folder.path() / "answer.json").string();
    const Ended ended = Small().Imagine(std::vector<std::string>{
        "--action",      "move_base_param",
        "--from",        "Door",
        "--arg",         "Window",
        "--arg",         "fast,slow",
        "--object",      "peppermill1",
        "--rollouts",    "2",
        "--seed",        "7",
        "--json",        path,
        "--threads",     threads,
        "--uncertainty", std::string(HIRES_SOURCE_DIR) + "/config/uncertainty.yaml"});
    EXPECT_NE(ended.code, kExitBadInput) << ended.err;
    auto json = nlohmann::json::parse(base::ReadTextFile(path));
    json.erase("wall_seconds");
    json.erase("real_time_factor");
    json["report"].erase("command");  // says how many threads
    return json.dump();
  };
  EXPECT_EQ(answer("1"), answer("2"));
}

TEST(CommandLineTest, AllFailingHasItsOwnCode) {
  const Ended ended = Small().Imagine({"--action", "move_base", "--from", "Door", "--arg", "Inside",
                                       "--rollouts", "2", "--min-success", "0.85"});
  EXPECT_EQ(ended.code, kExitAllFailed) << ended.err;
  EXPECT_THAT(ended.out, AllOf(HasSubstr("all_failed"), HasSubstr("goal_blocked 2"),
                               HasSubstr("goal_blocked: move_base(inside): the goal at x ")));
}

TEST(CommandLineTest, TwoRolloutsDecideNothing) {
  const Ended ended = Small().Imagine(kDrive);
  EXPECT_EQ(ended.code, kExitUndecided) << ended.err;
  EXPECT_THAT(ended.out, AllOf(HasSubstr("undecided: nothing is recommended yet"),
                               HasSubstr("rollouts decide"), HasSubstr("Clopper-Pearson")));
}

TEST(CommandLineTest, AModelThatWasTakenFromKinIsSaid) {
  const std::vector<std::string> drive{"--action", "move_base",  "--from", "Door",    "--arg",
                                       "Window",   "--rollouts", "2",      "--object"};
  EXPECT_THAT(Small().Imagine(drive + std::vector<std::string>{"peppermill7"}).out,
              HasSubstr("object 'peppermill7' is not in the catalogue; as its like there, it is a "
                        "'peppermill_thesis'"));
  EXPECT_THAT(Small().Imagine(drive + std::vector<std::string>{"Peppermill1"}).out,
              Not(HasSubstr("not in the catalogue")));
}

TEST(CommandLineTest, WhatWasNotValidatedIsSaid) {
  const Ended ended = Small().Imagine(
      {"--action", "move_base", "--from", "Door", "--arg", "Window", "--rollouts", "2", "--object",
       std::string(HIRES_SOURCE_DIR) + "/worlds/models/vase/model.sdf"});
  EXPECT_THAT(ended.out, HasSubstr("caveat: how vase (model vase) stands and falls was not "));
}

TEST(CommandLineTest, ExitCodesTellOutcomesApart) {
  imagination::Report report;
  const auto code = [&](imagination::ImaginationOutcome outcome) {
    report.outcome = outcome;
    return ExitCodeOf(report);
  };
  EXPECT_EQ(code(imagination::ImaginationOutcome::kRanked), 0);
  EXPECT_EQ(code(imagination::ImaginationOutcome::kClose), 0);
  EXPECT_EQ(code(imagination::ImaginationOutcome::kAllFailed), 2);
  EXPECT_EQ(code(imagination::ImaginationOutcome::kNoWorker), 3);
  EXPECT_EQ(code(imagination::ImaginationOutcome::kNothingFinished), 4);
  EXPECT_EQ(code(imagination::ImaginationOutcome::kUndecided), 5);
  EXPECT_EQ(code(imagination::ImaginationOutcome::kCancelled), 130);
}

TEST(CommandLineTest, HelpIsNoError) {
  const Ended ended = RunHires({"--help"});
  EXPECT_EQ(ended.code, 0);
  EXPECT_THAT(ended.out, AllOf(HasSubstr("imagine"), HasSubstr("doctor")));
  EXPECT_THAT(RunHires({"imagine", "--help"}).out, HasSubstr("--rollouts"));
}

TEST(CommandLineTest, TheVersionIsThatOfThePackage) {
  const Ended ended = RunHires({"--version"});
  EXPECT_EQ(ended.code, 0);
  const std::string package = base::ReadTextFile(std::string(HIRES_SOURCE_DIR) + "/package.xml");
  ASSERT_THAT(ended.out, AllOf(StartsWith("hires "), EndsWith("\n")));
  EXPECT_THAT(package,
              HasSubstr("<version>" + ended.out.substr(6, ended.out.size() - 7) + "</version>"));
}

TEST(CommandLineTest, ADoctorForRobotsIsAskedWithItsOptions) {
  std::optional<RobotDoctorOptions> seen;
  Backends backends;
  backends.examine_robot = [&](const RobotDoctorOptions& options) {
    seen = options;
    return 7;
  };
  const Ended ended = RunHires({"doctor", "--robot", "--names", "n.yaml", "--seconds", "0.5",
                                "--navigation", "own", "--json", "r.json"},
                               {}, backends);
  EXPECT_EQ(ended.code, 7) << ended.err;
  ASSERT_TRUE(seen);
  EXPECT_EQ(seen->names, "n.yaml");
  EXPECT_EQ(seen->seconds, 0.5);
  EXPECT_EQ(seen->navigation, "own");
  EXPECT_EQ(seen->report.json, "r.json");
  EXPECT_EQ(RunHires({"doctor", "--robot", "--navigation", "teleport"}, {}, backends).code, 1);
  EXPECT_EQ(RunHires({"doctor", "--robot", "--seconds", "0"}, {}, backends).code, 1);
  EXPECT_EQ(RunHires({"doctor", "--names", "n.yaml"}, {}, backends).code, 1) << "it needs --robot";
  EXPECT_THAT(RunHires({"doctor", "--robot"}).err, HasSubstr("this build has no ROS"));
}

TEST(CommandLineTest, RemoteQueriesCarryWhatWasAsked) {
  ImagineQuery seen;
  Backends backends;
  backends.imagine_remotely = [&](const ImagineQuery& query, const imagination::OnInterim&,
                                  const std::function<bool()>&) {
    seen = query;
    return hires::test_support::TwoAlternatives();
  };
  const Ended ended = RunHires({"imagine",
                                "--action",
                                "move_base_param",
                                "--from",
                                "home",
                                "--arg",
                                "a,b",
                                "--arg",
                                "slow",
                                "--object",
                                "peppermill1",
                                "--object",
                                "mug1",
                                "--rollouts",
                                "9",
                                "--seed",
                                "5",
                                "--deadline",
                                "3.5",
                                "--ranking",
                                "thesis",
                                "--min-success",
                                "0.75",
                                "--max-regret",
                                "0.5",
                                "--no-early-stop",
                                "--threads",
                                "2"},
                               {}, backends);
  EXPECT_EQ(ended.code, kExitRecommended) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("ranked: slow: it says so"));
  EXPECT_EQ(seen.action.name, "move_base_param");
  EXPECT_THAT(seen.action.alternatives, ElementsAre(ElementsAre("a", "b"), ElementsAre("slow")));
  EXPECT_EQ(seen.start.from, "home");
  EXPECT_THAT(seen.start.on_tray, ElementsAre("peppermill1", "mug1"));
  EXPECT_EQ(seen.scheduler.rollouts, 9);
  EXPECT_EQ(seen.scheduler.deadline, 3.5);
  EXPECT_EQ(seen.scheduler.criteria.rule, imagination::RankingRule::kThesis);
  EXPECT_EQ(seen.scheduler.criteria.min_success, 0.75);
  EXPECT_EQ(seen.scheduler.criteria.max_regret, 0.5);
  EXPECT_FALSE(seen.scheduler.early_stop);
  EXPECT_EQ(seen.seed, 5u);
  EXPECT_EQ(seen.threads, 2);
  EXPECT_FALSE(seen.own_scene);
  EXPECT_FALSE(seen.own_uncertainty);
}

TEST(CommandLineTest, FilesOfOnesOwnAreSaid) {
  ImagineQuery seen;
  Backends backends;
  backends.imagine_remotely = [&](const ImagineQuery& query, const imagination::OnInterim&,
                                  const std::function<bool()>&) {
    seen = query;
    return imagination::Report();
  };
  const std::string root = HIRES_SOURCE_DIR;
  const std::vector<std::string> start{"imagine", "--action", "move_base", "--from", "home"};
  EXPECT_EQ(RunHires(start, {"--world", root + "/worlds/restaurant.world"}, backends).code,
            kExitDeadline);
  EXPECT_TRUE(seen.own_scene);
  EXPECT_FALSE(seen.own_uncertainty);
  RunHires(start, {"--area", "bench:1,2,0.5"}, backends);
  EXPECT_TRUE(seen.own_scene);
  RunHires(start, {"--uncertainty", "none"}, backends);
  EXPECT_FALSE(seen.own_scene);
  EXPECT_TRUE(seen.own_uncertainty);
  EXPECT_EQ(seen.setup.uncertainty, "none");
  const std::string file = root + "/worlds/models/vase/model.sdf";
  RunHires(start, {"--object", file}, backends);
  EXPECT_TRUE(seen.own_scene);
  EXPECT_THAT(seen.setup.extra_objects, ElementsAre(file));
  EXPECT_THAT(seen.start.on_tray, ElementsAre("vase"));
  RunHires(
      start,
      {"--put", file + ":1,1,0", "--put", file + ":bench", "--object-in-hand", file + ":rightArm1"},
      backends);
  EXPECT_THAT(seen.setup.extra_objects, ElementsAre(file)) << "loaded once";
  ASSERT_EQ(seen.start.put.size(), 1u);
  EXPECT_EQ(seen.start.put[0].object, "vase");
  std::vector<std::string> atoms;
  for (const base::Atom& atom : seen.start.AllAtoms()) atoms.push_back(ToString(atom));
  EXPECT_THAT(atoms, testing::Contains(ToString(base::Atom{"On", {"vase", "bench"}})));
  EXPECT_THAT(atoms, testing::Contains(ToString(base::Atom{"Holding", {"rightArm1", "vase"}})));
}

TEST(CommandLineTest, MoreVerbsGetTheirOwnArguments) {
  std::vector<std::string> seen;
  Backends backends;
  backends.more_verbs.push_back({"dance", "does so", [&](const std::vector<std::string>& words) {
                                   seen = words;
                                   return 7;
                                 }});
  EXPECT_EQ(RunHires({"dance", "--long", "waltz"}, {}, backends).code, 7);
  EXPECT_THAT(seen, ElementsAre("--long", "waltz"));
  EXPECT_THAT(RunHires({"--help"}, {}, backends).out, HasSubstr("does so"));
}

// --------------------------------------------------------------------------------- bad input

TEST(CommandLineTest, RefusesUnknownVerbsAndOptions) {
  ExpectRefused(RunHires({}), {"imagine", "achieve", "doctor", "--help"});
  ExpectRefused(RunHires({"imagin"}), {"verb 'imagin' is unknown", "'imagine'"});
  ExpectRefused(RunHires({"imagine", "--actoin", "move_base"}),
                {"option '--actoin' is unknown; did you mean '--action'"});
  ExpectRefused(Small().Imagine(kDrive + std::vector<std::string>{"--rolouts=3"}),
                {"option '--rolouts' is unknown; did you mean '--rollouts'?"});
  ExpectRefused(Small().Imagine(kDrive + std::vector<std::string>{"--wrld", "a.world"}),
                {"option '--wrld' is unknown; did you mean '--world'?"});
  ExpectRefused(RunHires({"imagine", "--action", "move_base"}), {"--from", "required"});
}

TEST(CommandLineTest, RefusesUnknownVerbsBelowVerbs) {
  for (const std::vector<std::string>& words : {std::vector<std::string>{"qery", "--store", "s"},
                                                {"--store", "s", "qery"},
                                                {"--store=s", "qery"}}) {
    ExpectRefused(RunHires({"blackboard"}, words),
                  {"verb 'qery' is unknown; did you mean 'query'?"});
  }
}

TEST(CommandLineTest, VerbsThatWentToTheLabSayWhereTheyAre) {
  ExpectRefused(RunHires({"experiment", "legs_world"}),
                {"'hires experiment'", "'hires_lab experiment'"});
  for (const char* verb : {"experiences", "reproduce", "scenarios"}) {
    ExpectRefused(RunHires({verb, "--quiet"}), {std::string("'hires_lab ") + verb + "'"});
  }
}

TEST(CommandLineTest, RefusesNumbersOutOfRange) {
  const auto with = [](const std::string& option, const std::string& value) {
    return Small().Imagine(
        {"--action", "move_base", "--from", "Door", "--arg", "Window", option, value});
  };
  for (const char* rollouts : {"0", "-3", "1000000", "many", "2.5"}) {
    ExpectRefused(with("--rollouts", rollouts), {"--rollouts", rollouts});
  }
  ExpectRefused(with("--rollouts", "many"),
                {"'many' is not a number; wanted a whole number from 1 to"});
  ExpectRefused(with("--rollouts", "0"),
                {"'0' is out of range; wanted a whole number from 1 to 100000"});
  ExpectRefused(with("--rollouts", "2.5"), {"'2.5' is not a whole number; wanted a whole number"});
  ExpectRefused(with("--deadline", "-1"), {"--deadline"});
  ExpectRefused(with("--threads", "0"), {"--threads"});
  for (const char* seed : {"-1", "1.5", "1e3", "99999999999999999999"}) {
    ExpectRefused(with("--seed", seed),
                  {"hires: --seed", "no whole number", "hires imagine --help"});
  }
  ExpectRefused(with("--ranking", "luck"), {"luck", "cost", "risk", "thesis"});
  ExpectRefused(with("--ranking", "best"), {"did you mean one of 'cost', 'risk', 'thesis'?"});
}

TEST(CommandLineTest, NamesAllThatNothingHasAtOnceAndEachOnce) {
  ExpectRefused(
      Small().Imagine({"--action", "move_base", "--from", "Dor", "--arg", "Windw,Door,Pilar",
                       "--object", "pepermill1"}),
      {"the question: 4 things are wrong:", "area 'Dor' is unknown",
       "object 'pepermill1' is unknown", "area 'windw' is unknown", "area 'pilar' is unknown"});
}

TEST(CommandLineTest, RefusesWhatTheWorldDoesNotKnow) {
  ExpectRefused(Small().Imagine({"--action", "move_base", "--from", "Dor", "--arg", "Window"}),
                {"area 'Dor' is unknown", "'Door'"});
  ExpectRefused(Small().Imagine({"--action", "move_base", "--from", "Door", "--arg", "Windw"}),
                {"area 'windw' is unknown", "'window'"});
  ExpectRefused(Small().Imagine({"--action", "move_bas", "--from", "Door", "--arg", "Window"}),
                {"action 'move_bas' is unknown", "'move_base'"});
  ExpectRefused(Small().Imagine({"--action", "move_base", "--from", "Door"}),
                {"0 arguments, wanted 1 (area)"});
  ExpectRefused(Small().Imagine({"--action", "move_base", "--from", "Door", "--arg", "Window",
                                 "--object", "pepermill1"}),
                {"object 'pepermill1' is unknown", "'peppermill1'"});
  const auto with_object = [](const std::string& object) {
    return Small().Imagine(
        {"--action", "move_base", "--from", "Door", "--arg", "Window", "--object", object});
  };
  ExpectRefused(with_object("peppermil1"), {"did you mean 'peppermill1'?"});
  ExpectRefused(with_object("peper1"), {"did you mean 'peppermill1'?"});
  ExpectRefused(with_object("zebra"),
                {"worlds/objects.yaml: object 'zebra' is unknown; `hires list "
                 "objects` lists what there is"});
  ExpectRefused(Small().Imagine({"--action", "move_base", "--from", "Inside", "--arg", "Window"}),
                {"robot starts in collision", "'pillar'"});
}

TEST(CommandLineTest, AGoalOffTheMapIsSaidBeforeAnythingIsPlayed) {
  const TemporaryFolder folder;
  ExpectRefused(Small().Imagine({"--action", "move_base", "--from", "dock", "--arg", "bench,barn",
                                 "--area", "dock:0,0,0", "--area", "bench:3.8,0,0", "--area",
                                 "barn:40,2,0", "--map", HallMap(folder, false)}),
                {"area 'barn' lies at 40, 2 m, off the map", "from -1 to 5 m in x",
                 "from -1.5 to 1.5 m in y"});
}

TEST(CommandLineTest, ARolloutThatNoAnswerHasIsRefusedBeforeAnythingIsPlayed) {
  const auto with = [](const std::string& which, const std::vector<std::string>& more = {}) {
    return Small().Imagine(
        kDrive + std::vector<std::string>{"--save-rollout", which, "--gif", "w.gif"} + more);
  };
  ExpectRefused(with("worst@9"), {"--save-rollout worst@9: rank 9 of 1 alternatives"});
  ExpectRefused(with("2"), {"--save-rollout 2: there is no rollout 2: at most 2", "--rollouts"});
  ExpectRefused(with("worst", {"--beside", "median@2"}), {"--beside median@2: rank 2 of 1"});
}

TEST(CommandLineTest, APictureWhoseFileEndsLikeAnotherFormatIsRefusedWithTheEndingWanted) {
  const auto with = [](const std::string& option, const std::string& file) {
    return Small().Imagine(kDrive +
                           std::vector<std::string>{"--save-rollout", "worst", option, file});
  };
  for (const auto& [option, ending] : {std::pair("--gif", ".gif"), std::pair("--strip", ".png")}) {
    for (const std::string other : {".jpg", ".gif", ".PNG", ".mp4", ".txt"}) {
      if (base::ToLower(other) == ending) continue;
      ExpectRefused(with(option, "w" + other),
                    {std::string(option) + " w" + other, std::string("wanted ") + ending,
                     std::string("give it w") + ending});
    }
  }
}

TEST(CommandLineTest, RefusesAreasThatAreNone) {
  const auto with = [](const std::vector<std::string>& more) {
    return Small().Imagine(kDrive + more);
  };
  for (const char* area : {"bench", "bench:1,2", "bench:1,2,x", "bench:1,2,nan", ":1,2,3"}) {
    ExpectRefused(with({"--area", area}), {std::string("--area '") + area, "kitchen:3.2,1.0,1.57"});
  }
  ExpectRefused(with({"--area", "door:1,2,3"}), {"area 'door' is there already"});
  ExpectRefused(with({"--area", "bench:1,2,3", "--area", "Bench:1,2,3"}), {"there already"});
  ExpectRefused(with({"--map", "/nowhere/map.yaml"}), {"/nowhere/map.yaml"});
  ExpectRefused(with({"--map", "map.yaml", "--world", "a.world"}), {"--map"});
}

TEST(CommandLineTest, RefusesEmptyAlternatives) {
  const auto with = [](const std::vector<std::string>& arg) {
    return Small().Imagine(std::vector<std::string>{"--action", "move_base", "--from", "Door"} +
                           arg);
  };
  ExpectRefused(with({"--arg", "Window,,Door"}), {"empty", "Window,,Door"});
  ExpectRefused(with({"--arg", "Window,"}), {"empty"});
  ExpectRefused(with({"--arg", ""}), {"empty"});
  ExpectRefused(with({"--arg="}), {"--arg"});
  ExpectRefused(with({"--arg", "Window, ,Door"}), {"empty"});
}

TEST(CommandLineTest, BlanksRoundAlternativesAreNoneOfTheirNames) {
  for (const char* alternatives : {"Window, Inside", " Window ,Inside ", "Window\t,\tInside"}) {
    const Ended ended = Small().Imagine(
        {"--action", "move_base", "--from", "Door", "--arg", alternatives, "--rollouts", "1"});
    EXPECT_THAT(ended.out, AllOf(HasSubstr("move_base(window)"), HasSubstr("move_base(inside)")))
        << alternatives << ended.err;
  }
}

TEST(CommandLineTest, AnEmptyValueIsNotTakenForTheDefault) {
  for (const char* option : {"--world", "--map", "--robot", "--objects", "--object",
                             "--uncertainty", "--config", "--ranking", "--json", "--html"}) {
    for (const char* empty : {"", " "}) {
      ExpectRefused(Small().Imagine(kDrive + std::vector<std::string>{option, empty}),
                    {option, "an empty text came"});
    }
  }
  ExpectRefused(
      RunHires({"imagine"}, kDrive + std::vector<std::string>{"--json", "", "--robot", ""}),
      {"--robot", "--json"});
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{"limits", "--object", "peppermill1", "--robot", ""},
                                             {"doctor", "--world", ""},
                                             {"list", "areas", "--world", ""},
                                             {"new", "robot", ""},
                                             {"new", "robot", "cart.urdf", "--output", ""},
                                             {"blackboard", "stats", "--store", ""}}) {
    ExpectRefused(RunHires(words), {"an empty text came"});
  }
}

TEST(CommandLineTest, NamesMissingFiles) {
  for (const char* option : {"--world", "--robot", "--objects", "--uncertainty"}) {
    ExpectRefused(Small().Imagine(kDrive + std::vector<std::string>{option, "/nowhere/file.yaml"}),
                  {"/nowhere/file.yaml"});
  }
  ExpectRefused(RunHires({"imagine", "--local", "--action", "move_base", "--from", "home",
                          "--config", "/nowhere/client.yaml"}),
                {"/nowhere/client.yaml: no such file"});
  ExpectRefused(RunHires({"imagine", "--local", "--action", "move_base", "--from", "home",
                          "--scene", "/nowhere/scene.yaml"}),
                {"/nowhere/scene.yaml: no such file"});
  ExpectRefused(Small().Imagine({"--action", "move_base", "--from", "Door", "--arg", "Window",
                                 "--object", "/nowhere/mill.sdf"}),
                {"/nowhere/mill.sdf"});
}

TEST(CommandLineTest, FilesOfAnotherKindAreToldWhatIsWanted) {
  const TemporaryFolder folder;
  const std::string root = HIRES_SOURCE_DIR;
  const auto with = [](const std::string& option, const std::string& file) {
    return Small().Imagine(kDrive + std::vector<std::string>{option, file});
  };
  const std::string objects = folder.Write("none.yaml", ""), world = folder.Write("none.world", "");
  ExpectRefused(with("--objects", objects),
                {objects + ": object 'peppermill1' is unknown; none is defined"});
  ExpectRefused(with("--world", world), {world + ": is empty"});
  ExpectRefused(with("--world", root + "/urdf/cart.urdf"),
                {"cart.urdf: this is a robot (URDF)", "give it with --robot"});
  ExpectRefused(with("--robot", root + "/worlds/workshop.world"),
                {"wanted a profile (.yaml), a URDF"});
  ExpectRefused(with("--robot", root + "/worlds/objects.yaml"), {"is no robot's profile"});
}

TEST(CommandLineTest, AMissingFolderForTheAnswerIsSaidBeforeAnythingIsPlayed) {
  const TemporaryFolder folder;
  const std::string json = (folder.path() / "missing" / "answer.json").string();
  ExpectRefused(Small().Imagine(kDrive + std::vector<std::string>{"--json", json}),
                {json, "cannot be written"});
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "missing"));
}

TEST(CommandLineTest, ARefusedRequestLeavesAnEarlierAnswerAlone) {
  const TemporaryFolder folder;
  const std::string json = folder.Write("answer.json", "{\"earlier\": true}\n");
  ExpectRefused(Small().Imagine(
                    {"--action", "move_base", "--from", "Dor", "--arg", "Window", "--json", json}),
                {"'Dor'"});
  EXPECT_EQ(base::ReadTextFile(json), "{\"earlier\": true}\n");
}

TEST(CommandLineTest, LibrariesOfActionsAreLoadedHereAndNowhereElse) {
  const std::vector<std::string> words{"--action", "turn_towards", "--from",
                                       "Door",     "--actions",    "/nowhere/lib.so"};
  const Ended local = Small().Imagine(words);
  EXPECT_EQ(local.code, kExitBadInput);
  EXPECT_THAT(local.err,
              AllOf(HasSubstr("library of actions '/nowhere/lib.so'"), HasSubstr("no such file")));
  std::vector<std::string> remote{"imagine"};
  remote.insert(remote.end(), words.begin(), words.end());
  const Ended refused = RunHires(remote);
  EXPECT_EQ(refused.code, kExitBadInput);
  EXPECT_THAT(refused.err, AllOf(HasSubstr("--local"), HasSubstr("~action_libraries")));
}

TEST(CommandLineTest, WithoutNodesToAskItSaysSo) {
  ExpectRefused(RunHires({"imagine", "--action", "move_base", "--from", "home"}), {"--local"});
}

TEST(CommandLineTest, NothingEscapes) {
  Backends backends;
  backends.imagine_remotely = [](const ImagineQuery&, const imagination::OnInterim&,
                                 const std::function<bool()>&) -> imagination::Report {
    throw std::runtime_error("the wire is cut");
  };
  ExpectRefused(RunHires({"imagine", "--action", "move_base", "--from", "home"}, {}, backends),
                {"hires: the wire is cut"});
}

}  // namespace
}  // namespace hires::cli::command_line_test
