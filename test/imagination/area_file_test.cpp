#include "imagination/area_file.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "hires/base/error.h"
#include "hires/base/rng.h"
#include "support/log_catcher.h"
#include "support/rounds.h"
#include "support/temporary_folder.h"

namespace hires::imagination::area_file_test {
namespace {

using test_support::LogCatcher;
using test_support::Rounds;
using test_support::TemporaryFolder;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class AreaFileTest : public testing::Test {
 protected:
  std::vector<NamedArea> Read(const std::string& yaml) {
    return ReadAreaFile(folder_.Write("goals.yaml", yaml));
  }
  std::string ErrorOf(const std::string& yaml) {
    try {
      Read(yaml);
    } catch (const base::ConfigError& error) {
      return error.what();
    }
    return "";
  }
  TemporaryFolder folder_;
};

void ExpectArea(const NamedArea& area, const std::string& name, double x, double y, double yaw) {
  EXPECT_EQ(area.name, name);
  EXPECT_NEAR(area.X_MA.x, x, 1e-9) << name;
  EXPECT_NEAR(area.X_MA.y, y, 1e-9) << name;
  EXPECT_NEAR(area.X_MA.yaw, yaw, 1e-6) << name;
}

TEST_F(AreaFileTest, NamesWithNumbersAreTheSimplestForm) {
  const auto areas = Read("kitchen: [3.2, 1.0, 1.57]\ndock: {x: 0, y: -1, theta: 0.5}\n");
  ASSERT_EQ(areas.size(), 2u);
  ExpectArea(areas[0], "kitchen", 3.2, 1.0, 1.57);
  ExpectArea(areas[1], "dock", 0.0, -1.0, 0.5);
}

TEST_F(AreaFileTest, ListsAreReadWithNamesOrWithout) {
  const auto areas = Read(
      "waypoints:\n- [1, 2, 0.5]\n- {name: bench, x: 3, y: 4, yaw_deg: 90}\n"
      "- shelf: [5, 6, -1]\n- [7, 8, 0]\n");
  ASSERT_EQ(areas.size(), 4u);
  ExpectArea(areas[0], "goal1", 1, 2, 0.5);
  ExpectArea(areas[1], "bench", 3, 4, M_PI / 2.0);
  ExpectArea(areas[2], "shelf", 5, 6, -1);
  ExpectArea(areas[3], "goal2", 7, 8, 0);
}

TEST_F(AreaFileTest, PosesOfGeometryMsgsAreReadUnderAnyWrapper) {
  const std::string pose =
      "position: {x: 1.0, y: 2.0, z: 0.0}, orientation: {x: 0, y: 0, z: 0.7071068, w: 0.7071068}";
  for (const std::string& yaml :
       {"a: {" + pose + "}\n", "goals:\n- name: a\n  pose: {" + pose + "}\n",
        "- name: a\n  target_pose:\n    header: {seq: 3, frame_id: map}\n    pose: {" + pose +
            "}\n",
        "a: {header: {frame_id: /map}, pose: {pose: {" + pose + "}, covariance: [0, 0, 0]}}\n",
        "- meta: {node: x}\n  node:\n    name: a\n    verts: [{x: 9, y: 9}]\n    pose: {" + pose +
            "}\n"}) {
    const auto areas = Read(yaml);
    ASSERT_EQ(areas.size(), 1u) << yaml;
    ExpectArea(areas[0], "a", 1.0, 2.0, M_PI / 2.0);
  }
}

TEST_F(AreaFileTest, WaypointsOfNav2sPanelHaveWFirst) {
  const auto areas = Read(
      "waypoints:\n  waypoint0:\n    pose: [1.0, 2.0, 0.0]\n    orientation: [0.8775826, 0, 0, "
      "0.4794255]\n");
  ASSERT_EQ(areas.size(), 1u);
  ExpectArea(areas[0], "waypoint0", 1.0, 2.0, 1.0);
}

/// Goals as Nav2's panel has them, of these yaws, with w first or last.
std::string OfPanel(const std::vector<double>& yaws, bool is_w_first) {
  std::string yaml;
  for (std::size_t i = 0; i < yaws.size(); ++i) {
    const double z = std::sin(yaws[i] / 2), w = std::cos(yaws[i] / 2);
    yaml += fmt::format("p{}: {{pose: [{}, 2.0, 0.0], orientation: ", i, i);
    yaml += is_w_first ? fmt::format("[{}, 0, 0, {}]}}\n", w, z)
                       : fmt::format("[0, 0, {}, {}]}}\n", z, w);
  }
  return yaml;
}

TEST_F(AreaFileTest, TheOrderOfPanelsNumbersIsTheOneThatTurnsAboutZ) {
  for (int seed = 0; seed < Rounds(60); ++seed) {
    base::Rng rng = base::Rng(13).Fork(seed);
    std::vector<double> yaws;
    for (int i = 1 + rng.Index(4); i > 0; --i) {
      yaws.push_back(rng.Index(3) == 0 ? rng.Uniform(-0.05, 0.05) : rng.Uniform(-3.1, 3.1));
    }
    if (seed % 4 == 0) yaws = {0.0, 0.0};  // x, y, z, w of which say no more
    for (const bool is_w_first : {true, false}) {
      const LogCatcher log(base::LogLevel::kWarn);
      const std::string yaml = OfPanel(yaws, is_w_first);
      const auto areas = Read(yaml);
      ASSERT_EQ(areas.size(), yaws.size()) << yaml;
      for (std::size_t i = 0; i < yaws.size(); ++i)
        ExpectArea(areas[i], fmt::format("p{}", i), static_cast<double>(i), 2, yaws[i]);
      if (is_w_first) {
        EXPECT_THAT(log.lines, IsEmpty()) << yaml;
      } else {
        EXPECT_THAT(log.lines, ElementsAre(HasSubstr("in the order x, y, z, w"))) << yaml;
      }
    }
  }
}

TEST_F(AreaFileTest, PanelsNumbersInNoOneOrderAreRefusedAsWritten) {
  EXPECT_THAT(ErrorOf("a: {pose: [1, 2, 0], orientation: [0.7071, 0, 0, 0.7071]}\n"
                      "b: {pose: [1, 3, 0], orientation: [0, 0, 0.6, 0.8]}\n"),
              AllOf(HasSubstr("goals.yaml:2: orientation [0, 0, 0.6, 0.8]"),
                    HasSubstr("w, x, y, z, which is wanted")));
  EXPECT_THAT(ErrorOf("a: {pose: [1, 2, 0], orientation: [0.1, 0.9, 0.3, 0.2]}\n"),
              HasSubstr("orientation [0.1, 0.9, 0.3, 0.2]"));
}

TEST_F(AreaFileTest, WhatIsBesideAListUnderPoseIsItsTurn) {
  for (const char* turn : {"yaw: 0.5", "rpy: [0, 0, 0.5]", "euler: {roll: 0, pitch: 0, yaw: 0.5}",
                           "yaw_degrees: 28.64788975654116"}) {
    ExpectArea(Read(fmt::format("a: {{pose: [1, 2, 0], {}}}\n", turn)).at(0), "a", 1, 2, 0.5);
  }
}

TEST_F(AreaFileTest, SeveralDocumentsAreWhatRostopicEchoPrints) {
  const std::string one =
      "header:\n  seq: 1\n  frame_id: \"map\"\npose:\n  position: {x: 1, y: 2, z: 0}\n"
      "  orientation: {x: 0.0, y: 0.0, z: 0.0, w: 1.0}\n---\n";
  const auto areas = Read(one + one);
  ASSERT_EQ(areas.size(), 2u);
  ExpectArea(areas[1], "goal2", 1, 2, 0);
}

TEST_F(AreaFileTest, WhatIsAssumedOrLeftOutIsSaidOnceForEachKind) {
  const LogCatcher log(base::LogLevel::kWarn);
  Read("a: [1, 2]\nb: [3, 4]\nc: {position: {x: 1, y: 1, z: 0.4}, orientation: {w: 1.0}}\n");
  EXPECT_THAT(log.lines, ElementsAre(AllOf(HasSubstr("goals.yaml:1:"),
                                           HasSubstr("have a yaw of 0 (2 in all)")),
                                     AllOf(HasSubstr("goals.yaml:3:"), HasSubstr("heights"))));
}

TEST_F(AreaFileTest, HeightsAreKeptInAllForms) {
  const auto areas = Read(
      "a: [1, 2, 3.5, 0, 0, 0, 1]\nb: {x: 1, y: 2, z: 3.5, yaw: 0}\nc: [1, 2, 0]\n"
      "d: {position: {x: 1, y: 2, z: 3.5}, orientation: {w: 1.0}}\n"
      "e: {pose: [1, 2, 3.5], orientation: [1, 0, 0, 0]}\n"
      "f: {position: {x: 1, y: 2, z: 0.0}, orientation: {w: 1.0}}\n");
  ASSERT_EQ(areas.size(), 6u);
  for (const NamedArea& area : areas) {
    ExpectArea(area, area.name, 1, 2, 0);
    EXPECT_EQ(area.z.has_value(), area.name != "c" && area.name != "f") << area.name;
    EXPECT_EQ(area.z.value_or(3.5), 3.5) << area.name;
  }
}

TEST_F(AreaFileTest, AllThatIsWrongIsToldWithItsLine) {
  EXPECT_THAT(ErrorOf("a: [1, 2, 90]\nb: [1, 2, 3, 4]\nA: [0, 0, 0]\nc: {x: one, y: 2}\n"),
              AllOf(HasSubstr("4 things are wrong"), HasSubstr("goals.yaml:1: its yaw is"),
                    HasSubstr("goals.yaml:2: a list of 4"), HasSubstr("goals.yaml:3: 'A' is there"),
                    HasSubstr("goals.yaml:4: has no position")));
  EXPECT_THAT(ErrorOf("a: {header: {frame_id: odom}, pose: {position: {x: 1, y: 2}}}\n"),
              HasSubstr("wanted map"));
  EXPECT_THAT(ErrorOf("\"a,b\": [1, 2, 0]\n"), HasSubstr("rename it"));
  EXPECT_THAT(ErrorOf("image: m.pgm\nresolution: 0.05\norigin: [0, 0, 0]\n"), HasSubstr("--map"));
  EXPECT_THAT(ErrorOf("rate: 10\n"), HasSubstr("has no goal"));
  EXPECT_THAT(ErrorOf(""), HasSubstr("has no goal"));
  EXPECT_THAT(ErrorOf("a: [\n"), HasSubstr("no valid YAML"));
}

TEST_F(AreaFileTest, EveryFormSaysTheSamePlaces) {
  for (int seed = 0; seed < Rounds(60); ++seed) {
    base::Rng rng = base::Rng(7).Fork(seed);
    std::vector<geometry::Pose2> poses;
    std::string by_name, in_a_list, as_poses, by_panel;
    for (int i = 1 + rng.Index(5); i > 0; --i) {
      const geometry::Pose2 X{rng.Uniform(-50, 50), rng.Uniform(-50, 50), rng.Uniform(-3.1, 3.1)};
      const std::string name = fmt::format("p{}", poses.size());
      const double z = std::sin(X.yaw / 2), w = std::cos(X.yaw / 2);
      by_name += fmt::format("{}: [{}, {}, {}]\n", name, X.x, X.y, X.yaw);
      in_a_list += fmt::format("- {{name: {}, x: {}, y: {}, yaw: {}}}\n", name, X.x, X.y, X.yaw);
      as_poses += fmt::format(
          "- name: {}\n  pose:\n    position: {{x: {}, y: {}, z: 0.0}}\n"
          "    orientation: {{x: 0.0, y: 0.0, z: {}, w: {}}}\n",
          name, X.x, X.y, z, w);
      by_panel += fmt::format("  {}:\n    pose: [{}, {}, 0.0]\n    orientation: [{}, 0, 0, {}]\n",
                              name, X.x, X.y, w, z);
      poses.push_back(X);
    }
    for (const std::string& yaml :
         {by_name, in_a_list, as_poses, "waypoints:\n" + by_panel, "goals:\n" + in_a_list}) {
      const auto areas = Read(yaml);
      ASSERT_EQ(areas.size(), poses.size()) << yaml;
      for (std::size_t i = 0; i < poses.size(); ++i) {
        ExpectArea(areas[i], fmt::format("p{}", i), poses[i].x, poses[i].y, poses[i].yaw);
      }
    }
  }
}

/// A goal written in many ways.
std::vector<std::string> WaysToWrite(const std::string& name, const geometry::Pose2& X) {
  const auto n = [](double value) { return fmt::format("{}", value); };
  const double z = std::sin(X.yaw / 2), w = std::cos(X.yaw / 2);
  const std::string list = fmt::format("[{}, {}]", n(X.x), n(X.y));
  const std::string xy = fmt::format("x: {}, y: {}", n(X.x), n(X.y));
  const std::string zw = fmt::format("{{z: {}, w: {}}}", n(z), n(w));
  const std::string four = fmt::format("[0, 0, {}, {}]", n(z), n(w));
  const std::string yaw = "yaw: " + n(X.yaw);
  std::vector<std::string> ways;
  for (const char* key : {"position", "location", "coords", "coordinates", "pos", "point",
                          "translation", "Location", "xy"}) {
    for (const std::string& where :
         {list, "{" + xy + "}", "{X: " + n(X.x) + ", Y: " + n(X.y) + "}"}) {
      for (const std::string& turn :
           {yaw, "orientation: " + zw, "rotation: " + four, "Yaw: " + n(X.yaw),
            "heading_deg: " + n(X.yaw * 180.0 / M_PI)}) {
        ways.push_back(fmt::format("- {{name: {}, {}: {}, {}}}\n", name, key, where, turn));
        ways.push_back(fmt::format("{}: {{{}: {}, {}}}\n", name, key, where, turn));
      }
    }
    ways.push_back(fmt::format("- {{room: {}, {}: {{{}, {}}}}}\n", name, key, xy, yaw));
  }
  for (const char* flat :
       {"x: {0}, y: {1}, qz: {2}, qw: {3}", "X: {0}, Y: {1}, qx: 0, qy: 0, qz: {2}, qw: {3}",
        "x: {0}, y: {1}, z: {2}, w: {3}", "px: {0}, py: {1}, oz: {2}, ow: {3}",
        "position_x: {0}, position_y: {1}, orientation_z: {2}, orientation_w: {3}",
        "pos_x: {0}, pos_y: {1}, yaw: {4}"}) {
    ways.push_back(fmt::format("{}: {{", name) +
                   fmt::format(fmt::runtime(flat), X.x, X.y, z, w, X.yaw) + "}\n");
  }
  return ways;
}

TEST_F(AreaFileTest, OneGoalIsOneWhateverItsKeysAreCalled) {
  for (int seed = 0; seed < Rounds(5); ++seed) {
    base::Rng rng = base::Rng(11).Fork(seed);
    const geometry::Pose2 X{rng.Uniform(-50, 50), rng.Uniform(-50, 50), rng.Uniform(-3.1, 3.1)};
    for (const std::string& yaml : WaysToWrite("dock", X)) {
      const LogCatcher log(base::LogLevel::kWarn);
      const auto areas = Read(yaml);
      ASSERT_EQ(areas.size(), 1u) << yaml;
      ExpectArea(areas[0], "dock", X.x, X.y, X.yaw);
      EXPECT_THAT(log.lines, IsEmpty()) << yaml;
    }
  }
}

TEST_F(AreaFileTest, FramesThatDriftOrMoveAreRefusedAtEveryDepth) {
  for (const char* frame : {"odom", "/odom", "tb3_0/odom", "/a/b/odom_combined", "odom_combined",
                            "base_link", "r1/base_footprint"}) {
    const std::string id = fmt::format("frame_id: {}", frame);
    const std::string pose = "pose: {position: {x: 1, y: 2}, orientation: {w: 1}}";
    for (const std::string& yaml :
         {"- {name: a, pose: {header: {" + id + "}, " + pose + "}}\n",
          "- {name: a, header: {" + id + "}, " + pose + "}\n",
          "- {name: a, target_pose: {header: {" + id + "}, " + pose + "}}\n",
          "a: {pose: {x: 1, y: 2, yaw: 0, " + id + "}}\n", id + "\na: [1, 2, 0]\n",
          "- {name: a, yaw: 0, location: {x: 1, y: 2, " + id + "}}\n",
          "p: {" + id + ", a: [1, 2, 0]}\n"}) {
      EXPECT_THAT(ErrorOf(yaml), AllOf(HasSubstr("wanted map"), HasSubstr("goals.yaml:1:")))
          << yaml;
    }
  }
  EXPECT_EQ(Read("a: {pose: {x: 1, y: 2, yaw: 0, frame_id: /map}}\n").size(), 1u);
}

TEST_F(AreaFileTest, WhatIsPlainlyNoGoalIsPassedOverAndNamedOnce) {
  const LogCatcher log(base::LogLevel::kWarn);
  const auto areas = Read(
      "marker: {color: [1, 0, 0, 1], scale: {x: 0.2, y: 0.2, z: 0.2}}\n"
      "xy_tolerance: [0.25, 0.25]\nspeed_limits: [0.2, 0.5]\nsize: [1, 2, 3]\nsize_xy: [1, 2]\n"
      "zone: {polygon: [[0, 0], [1, 0], [1, 1]]}\n"
      "goals: {kitchen: [1, 0.5, 1.57], speed_bump: [1, 2, 0]}\n");
  ASSERT_EQ(areas.size(), 2u);
  ExpectArea(areas[0], "kitchen", 1, 0.5, 1.57);
  ExpectArea(areas[1], "speed_bump", 1, 2, 0);
  EXPECT_THAT(
      log.lines,
      ElementsAre(AllOf(HasSubstr("goals.yaml:1: passes over 'color', 'scale', 'xy_tolerance', "
                                  "'speed_limits', 'size', 'size_xy', 'polygon'"),
                        HasSubstr("no goals"))));
}

TEST_F(AreaFileTest, KeysOfAGoalThatSayNothingAreNamed) {
  const LogCatcher log(base::LogLevel::kWarn);
  ExpectArea(
      Read("- {name: a, x: 1, y: 2, direction: 90, type: dock}\n- {x: 1, y: 3, yaw: 1, turn: 3}\n")
          [0],
      "a", 1, 2, 0);
  EXPECT_THAT(log.lines,
              ElementsAre(HasSubstr("have a yaw of 0"),
                          AllOf(HasSubstr("goals.yaml:1: passes over 'direction', 'turn'"),
                                HasSubstr("yaw [rad]"))));
}

TEST_F(AreaFileTest, NumbersOfWhichNoGoalComesAreNamed) {
  const struct {
    const char *part, *told;
  } kinds[] = {{"lab: [1.0, 2.0, pi/2]\n", "'lab (line 2)'"},
               {"lab: [1.0, 2.0, 1.57rad]\n", "'lab (line 2)'"},
               {"lab: [1.0, 2.0, ~]\n", "'lab (line 2)'"},
               {"lab: [3.0, 2.0, .nan]\n", "'lab (line 2)'"},
               {"lab: [{x: 1.0}, {y: 2.0}, {yaw: 1.57}]\n", "'lab (line 2)'"},
               {"lab: {x: 1.0, yy: 2.0, yaw: 0.0}\n", "'lab (line 2)'"},
               {"lab: 3.0 1.0\n", "'lab (line 2)'"},
               {"lab:\n  more: {deep: [1, 2, pi]}\n", "'lab (line 2)'"},
               {"lab:\n- [9, 9, 0]\n- [1, 2, pi]\n", "'an item (line 4)'"}};
  for (const auto& kind : kinds) {
    const LogCatcher log(base::LogLevel::kWarn);
    const auto areas = Read(std::string("ok: [4, 2, 0]\n") + kind.part);
    ASSERT_GE(areas.size(), 1u);
    ExpectArea(areas[0], "ok", 4, 2, 0);
    EXPECT_THAT(log.lines,
                ElementsAre(AllOf(HasSubstr(kind.told), HasSubstr("no goal could be made"))))
        << kind.part;
  }
  const LogCatcher log(base::LogLevel::kWarn);
  Read("ok: [4, 2, 0]\nrate: 10\nspeed: 0.5 0.6\nnames: [a, b]\nwho: {age: 3}\n");
  EXPECT_THAT(log.lines, IsEmpty()) << "one number is no goal that was missed";
}

TEST_F(AreaFileTest, ListsWithNamesAndTextsAreGoals) {
  const auto areas = Read(
      "stations:\n- [dock, 1, 2, 0.5]\n- [shelf, [3, 4, 1.5]]\n- [bench, {x: 5, y: 6, yaw: 1}]\n"
      "lab: \"7.0 8.0 0.25\"\nhall: 9, 10, -1\nbar: [11, 12, 0, 0, 0, 0, 1]\n"
      "den: {name: Den, pose: 13 14 0.5}\n");
  ASSERT_EQ(areas.size(), 7u);
  ExpectArea(areas[0], "dock", 1, 2, 0.5);
  ExpectArea(areas[1], "shelf", 3, 4, 1.5);
  ExpectArea(areas[2], "bench", 5, 6, 1);
  ExpectArea(areas[3], "lab", 7, 8, 0.25);
  ExpectArea(areas[4], "hall", 9, 10, -1);
  ExpectArea(areas[5], "bar", 11, 12, 0);
  ExpectArea(areas[6], "Den", 13, 14, 0.5);
}

TEST_F(AreaFileTest, WhatAGoalIsWrappedInIsNoName) {
  for (const char* wrapper : {"goal", "waypoint", "target", "goal_pose", "target_pose", "node"}) {
    for (const char* pose : {"[1, 2, 0.5]", "{x: 1, y: 2, theta: 0.5}", "1 2 0.5"}) {
      const std::string yaml = fmt::format(
          "rooms:\n- {{name: kitchen, {0}: {1}}}\n- {{{0}: {1}}}\n- {{{0}: {1}}}\n", wrapper, pose);
      const auto areas = Read(yaml);
      ASSERT_EQ(areas.size(), 3u) << yaml;
      ExpectArea(areas[0], "kitchen", 1, 2, 0.5);
      ExpectArea(areas[1], "goal1", 1, 2, 0.5);
      ExpectArea(areas[2], "goal2", 1, 2, 0.5);
    }
  }
  for (const char* key : {"point", "position", "location", "coords", "xy", "translation"}) {
    const auto areas =
        Read(fmt::format("goals:\n- {0}: {{x: 1, y: 2}}\n- {0}: {{x: 3, y: 4}}\n"
                         "hall: {{{0}: {{x: 5, y: 6}}}}\n",
                         key));
    ASSERT_EQ(areas.size(), 3u) << key;
    ExpectArea(areas[1], "goal2", 3, 4, 0);
    ExpectArea(areas[2], "hall", 5, 6, 0);
  }
  const auto areas = Read("goal: {x: 1, y: 2, yaw: 0}\nhome: {x: 3, y: 4, yaw: 0}\n");
  ASSERT_EQ(areas.size(), 2u) << "beside others, it is a name";
  ExpectArea(areas[0], "goal", 1, 2, 0);
  ExpectArea(areas[1], "home", 3, 4, 0);
}

TEST_F(AreaFileTest, ACornerOfARoomIsAPlace) {
  const LogCatcher log(base::LogLevel::kWarn);
  const auto areas = Read("corner: [9, 1, -1.57]\nkitchen_corner: [1, 2, 0]\n");
  ASSERT_EQ(areas.size(), 2u);
  ExpectArea(areas[0], "corner", 9, 1, -1.57);
  ExpectArea(areas[1], "kitchen_corner", 1, 2, 0);
  EXPECT_THAT(log.lines, ElementsAre());
}

TEST_F(AreaFileTest, WhatStandsBesideTheOnePlaceOfAGoalIsNamed) {
  const LogCatcher log(base::LogLevel::kWarn);
  const auto areas =
      Read("rooms:\n- {name: kitchen, goal: [1, 2, 0], corners: [[0, 0], [4, 0]], door: [4, 2]}\n");
  ASSERT_EQ(areas.size(), 1u);
  ExpectArea(areas[0], "kitchen", 1, 2, 0);
  EXPECT_THAT(log.lines, ElementsAre(AllOf(HasSubstr("'corners'"), HasSubstr("no goals")),
                                     AllOf(HasSubstr("'door'"), HasSubstr("one place"))));
}

TEST_F(AreaFileTest, SettingsOfRobotsAreNoGoals) {
  const LogCatcher log(base::LogLevel::kWarn);
  const auto areas = Read(
      "robot: {max_vel: [0.5, 1], cmd_vel: [0, 1], wheel_offsets: [0.1, 0.2], max_turn: [1, 2],\n"
      "  vel_range_x: [0, 1], corners: [[1, 1]], transform: [0, 0, 1], offset: {x: 1, y: 2}}\n"
      "transformation: {translation: {x: 0, y: 0, z: 0}, rotation: {w: 1}}\n"
      "kitchen: [1, 2, 0.5]\nMax Room: [3, 4, 0.5]\n");
  ASSERT_EQ(areas.size(), 2u);
  ExpectArea(areas[0], "kitchen", 1, 2, 0.5);
  ExpectArea(areas[1], "Max Room", 3, 4, 0.5);
  EXPECT_THAT(log.lines, ElementsAre(HasSubstr("no goals")));
}

TEST_F(AreaFileTest, APositionAndItsTurnAreOneGoal) {
  const double z = std::sin(0.25), w = std::cos(0.25);
  for (const std::string& yaml :
       {std::string("kitchen: [[1, 2, 0], [0, 0, 0.5]]\n"),
        fmt::format("kitchen:\n- [1, 2, 0]\n- [0, 0, {}, {}]\n", z, w),
        fmt::format("kitchen:\n- {{x: 1, y: 2, z: 0}}\n- {{x: 0, y: 0, z: {}, w: {}}}\n", z, w),
        fmt::format("kitchen: {{pose: [[1, 2, 0], [0, 0, {}, {}]]}}\n", z, w)}) {
    const LogCatcher log(base::LogLevel::kWarn);
    const auto areas = Read(yaml);
    ASSERT_EQ(areas.size(), 1u) << yaml;
    ExpectArea(areas[0], "kitchen", 1, 2, 0.5);
    EXPECT_THAT(log.lines, ElementsAre(HasSubstr("of one goal"))) << yaml;
  }
  EXPECT_EQ(Read("goals: [[1, 2, 0], [0, 0, 0.5]]\n").size(), 2u);
  EXPECT_EQ(Read("kitchen: [[1, 2, 0], [0, 1, 0.5]]\n").size(), 2u);
}

TEST_F(AreaFileTest, AnglesAreReadInTheUnitThatTheirKeyOrTheFileSays) {
  for (const char* turn :
       {"yaw: {0}", "rz: {0}", "phi: {0}", "theta: {0}", "yaw_rad: {0}", "rpy: [0, 0, {0}]",
        "euler: {{roll: 0, pitch: 0, yaw: {0}}}", "euler_angles: [0, 0, {0}]", "yaw_deg: {1}",
        "yaw_degrees: {1}", "theta_degrees: {1}", "rz_deg: {1}", "rpy_deg: [0, 0, {1}]",
        "euler_degrees: {{roll: 0, pitch: 0, yaw: {1}}}", "orientation: {{yaw: {0}}}"}) {
    for (const double yaw : {-3.0, -0.5, 0.1, 1.5}) {
      const std::string text = fmt::format(fmt::runtime(turn), yaw, yaw * 180.0 / M_PI);
      for (const std::string& goal :
           {"{x: 1, y: 2, " + text + "}", "{position: [1, 2, 0], " + text + "}"}) {
        ExpectArea(Read("a: " + goal + "\n").at(0), "a", 1, 2, yaw);
        const bool says_none =
            text.find("_deg") == std::string::npos && text.find("_rad") == std::string::npos;
        if (!says_none)
          ExpectArea(Read("angle_unit: deg\na: " + goal + "\n").at(0), "a", 1, 2, yaw);
      }
    }
  }
  for (const char* unit : {"angle_unit: degrees", "angle_unit: deg", "yaw_unit: Degrees",
                           "units: deg", "units: {angle: deg, length: m}", "in_degrees: true"}) {
    for (const char* goal : {"{x: 1, y: 2, yaw: 90}", "[1, 2, 90]", "{position: [1, 2], yaw: 90}",
                             "{x: 1, y: 2, rpy: [0, 0, 90]}", "{x: 1, y: 2, yaw_deg: 90}"}) {
      const auto areas = Read(fmt::format("{0}\ngoals: {{a: {1}}}\n", unit, goal));
      ASSERT_EQ(areas.size(), 1u) << unit << goal;
      ExpectArea(areas[0], "a", 1, 2, M_PI / 2.0);
    }
    const auto areas =
        Read(fmt::format("a: {{x: 1, y: 2, yaw: 5, {}}}\nb: {{x: 1, y: 2, yaw: 5}}\n", unit));
    ASSERT_EQ(areas.size(), 2u) << unit;
    ExpectArea(areas[0], "a", 1, 2, 5.0 * M_PI / 180.0);
    ExpectArea(areas[1], "b", 1, 2, 5.0);
  }
  ExpectArea(Read("units: m\na: [1, 2, 0.5]\n").at(0), "a", 1, 2, 0.5);
  EXPECT_THAT(ErrorOf("angle_unit: gon\na: [1, 2, 0.5]\n"), HasSubstr("'gon' is no unit"));
  EXPECT_THAT(ErrorOf("about: {angle_unit: deg}\na: [1, 2, 0.5]\n"),
              AllOf(HasSubstr("goals.yaml:1:"), HasSubstr("degrees where no goal is")));
  const LogCatcher log(base::LogLevel::kWarn);
  ExpectArea(Read("lidar: {fov: 270, units: deg}\na: [1, 2, 0.5]\n").at(0), "a", 1, 2, 0.5);
  EXPECT_THAT(log.lines, ElementsAre(HasSubstr("degrees where no goal is")));
  EXPECT_THAT(ErrorOf("a: {x: 1, y: 2, rpy: [3.14, 0, 0]}\n"), HasSubstr("turn the robot over"));
}

TEST_F(AreaFileTest, ARoundMayComeBackToItsGoals) {
  const LogCatcher log(base::LogLevel::kWarn);
  const auto areas = Read(
      "- {name: home, x: 0, y: 0, yaw: 0}\n- {name: shelf, x: 2, y: 1, yaw: 1.57}\n"
      "- {name: Home, x: 0, y: 0, yaw: 0}\n- {name: home, x: 0, y: 0, yaw: 0}\n");
  ASSERT_EQ(areas.size(), 2u);
  ExpectArea(areas[0], "home", 0, 0, 0);
  ExpectArea(areas[1], "shelf", 2, 1, 1.57);
  EXPECT_THAT(log.lines, ElementsAre(AllOf(HasSubstr("goals.yaml:3:"), HasSubstr("kept once (2"))));
  for (const char* other :
       {"x: 0.1, y: 0, yaw: 0", "x: 0, y: 0, yaw: 0.1", "x: 0, y: 0, z: 3, yaw: 0"}) {
    EXPECT_THAT(
        ErrorOf(fmt::format("- {{name: home, x: 0, y: 0, yaw: 0}}\n- {{name: home, {}}}\n", other)),
        HasSubstr("'home' is there twice"))
        << other;
  }
}

TEST_F(AreaFileTest, ListsSideBySideAreGoals) {
  for (int seed = 0; seed < Rounds(20); ++seed) {
    base::Rng rng = base::Rng(5).Fork(seed);
    std::vector<std::string> x, y, yaw;
    std::vector<geometry::Pose2> poses;
    for (int i = 1 + rng.Index(5); i > 0; --i) {
      poses.push_back({rng.Uniform(-9, 9), rng.Uniform(-9, 9), rng.Uniform(-3, 3)});
      x.push_back(fmt::format("{}", poses.back().x));
      y.push_back(fmt::format("{}", poses.back().y));
      yaw.push_back(fmt::format("{}", poses.back().yaw));
    }
    for (const std::string stem : {"", "goals_", "Patrol_"}) {
      for (const char* turn : {"yaw", "theta"}) {
        const auto areas =
            Read(fmt::format("patrol:\n  {0}x: [{1}]\n  {0}y: [{2}]\n  {0}{3}: [{4}]\n", stem,
                             fmt::join(x, ", "), fmt::join(y, ", "), turn, fmt::join(yaw, ", ")));
        ASSERT_EQ(areas.size(), poses.size());
        for (std::size_t i = 0; i < poses.size(); ++i) {
          ExpectArea(areas[i], fmt::format("goal{}", i + 1), poses[i].x, poses[i].y, poses[i].yaw);
        }
      }
    }
  }
  EXPECT_EQ(Read("goals_x: [1, 2]\ngoals_y: [3, 4]\n").size(), 2u);
  EXPECT_THAT(ErrorOf("goals_x: [1, 2]\ngoals_y: [3, 4, 5]\n"),
              AllOf(HasSubstr("goals.yaml:1: 'goals_x'"), HasSubstr("2, 3 and 2 numbers")));
}

TEST_F(AreaFileTest, PointsOfGeoJsonAreGoals) {
  const std::string head =
      "{\n\"type\": \"FeatureCollection\", \"name\": \"graph\", \"crs\": {\"type\": \"name\", "
      "\"properties\": {\"name\": \"urn:ogc:def:crs:EPSG::3857\"}},\n\"features\": [\n";
  const auto feature = [](const std::string& properties, const std::string& kind,
                          const std::string& coordinates) {
    return fmt::format(
        "{{\"type\": \"Feature\", \"properties\": {}, \"geometry\": {{\"type\": \"{}\", "
        "\"coordinates\": {}}}}}",
        properties, kind, coordinates);
  };
  const LogCatcher log(base::LogLevel::kWarn);
  const auto areas = Read(head + feature("{\"id\": 1}", "Point", "[-0.6, -1.6]") + ",\n" +
                          feature("{\"name\": \"dock\", \"id\": 2}", "Point", "[0.6, -1.6, 0.0]") +
                          ",\n" + feature("null", "Point", "[3, 4]") + ",\n" +
                          feature("{\"id\": 21, \"startid\": 1, \"endid\": 2}", "MultiLineString",
                                  "[[[-0.6, -1.6], [0.6, -1.6]]]") +
                          "]}\n");
  ASSERT_EQ(areas.size(), 3u);
  ExpectArea(areas[0], "1", -0.6, -1.6, 0.0);
  ExpectArea(areas[1], "dock", 0.6, -1.6, 0.0);
  ExpectArea(areas[2], "goal1", 3.0, 4.0, 0.0);
  EXPECT_THAT(log.lines, testing::UnorderedElementsAre(
                             AllOf(HasSubstr("goals.yaml:4:"), HasSubstr("taken for metres"),
                                   HasSubstr("3 in all")),
                             AllOf(HasSubstr("yaw of 0"), HasSubstr("3 in all")),
                             AllOf(HasSubstr("goals.yaml:7:"), HasSubstr("'MultiLineString'"))));
  EXPECT_THAT(ErrorOf(head + feature("{\"id\": 1}", "Point", "[1, \"b\"]") + "]}\n"),
              AllOf(HasSubstr("goals.yaml:4:"), HasSubstr("wanted [x, y] [m]")));
  EXPECT_THAT(ErrorOf(head + "]}\n"), HasSubstr("has no goal"));
  EXPECT_THAT(
      ErrorOf(head +
              "[1, 2], 3, null, {}, {\"geometry\": [1]}, {\"geometry\": {\"type\": [1]}}]}\n"),
      HasSubstr("has no goal"));
}

TEST_F(AreaFileTest, WhatIsNoTurnOnTheFloorIsRefused) {
  for (const char* yaml : {"a: [1.0, 0.5, 0.0, 2.0, -0.5, 1.57, 0.0]\n",
                           "a: [1, 2, 0, 0, 0, 0, 0]\n", "a: {x: 1, y: 2, z: 0.1, w: 0.7}\n"}) {
    EXPECT_THAT(ErrorOf(yaml), AllOf(HasSubstr("goals.yaml:1:"), HasSubstr("no quaternion")))
        << yaml;
  }
  for (const char* yaml : {"a: {position: [1, 2], orientation: [0.7071, 0, 0, 0.7071]}\n",
                           "a: [1, 2, 0, 1, 0, 0, 0]\n"}) {
    EXPECT_THAT(ErrorOf(yaml), HasSubstr("turns the robot over")) << yaml;
  }
  EXPECT_THAT(ErrorOf("- {name: a, coords: [1, 2, 1.5]}\n"), HasSubstr("a yaw or a height"));
  EXPECT_THAT(ErrorOf("a: {x: 1, y: 2, yaw: 90deg}\n"), HasSubstr("wanted a yaw [rad]"));
}

TEST_F(AreaFileTest, BombsAreRefusedAndBounded) {
  std::string deep = "a: ";
  for (int i = 0; i < 100; ++i) deep += "{b: ";
  deep += "[1, 2, 0]" + std::string(100, '}') + "\n";
  EXPECT_THAT(ErrorOf(deep), HasSubstr("too deep"));
  std::string laughs = "a0: &a0 [{c: [1, 2, 0]}]\n";
  for (int i = 1; i < 20; ++i) {
    laughs += fmt::format("a{0}: &a{0} [*a{1}, *a{1}, *a{1}, *a{1}]\n", i, i - 1);
  }
  EXPECT_THAT(ErrorOf(laughs), HasSubstr("too deep or too long"));
}

}  // namespace
}  // namespace hires::imagination::area_file_test
