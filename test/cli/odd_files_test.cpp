// A world, a robot, a map and goals with one to three random defects among them, read by
// `hires doctor`: it ends with 0 and names all of them, or with 1 and names all of them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "cli/command_run.h"
#include "hires/base/rng.h"
#include "hires/base/text.h"
#include "support/rounds.h"
#include "support/temporary_folder.h"

namespace hires::cli::odd_files_test {
namespace {

using hires::test_support::Ended;
using hires::test_support::Rounds;
using hires::test_support::RunHires;

/// What is written into the files: lines that belong there, to be changed or added to.
struct Files {
  std::string world, links, joints;  ///< elements
  std::string image{"image: hall.pgm"}, resolution{"resolution: 0.1"};
  std::string origin{"origin: [0.0, 0.0, 0.0]"}, negate{"negate: 0"};
  std::string thresholds{"occupied_thresh: 0.65\nfree_thresh: 0.196"}, more;  ///< lines of the map
  std::string goals{"dock: [1.0, 1.0, 0.0]\n"};
};

/// A defect in one of them, by a name that nothing else has.
struct Defect {
  const char* kind;
  const char*
      part;  ///< of two in the same part one alone is drawn; "" for those that add something
  bool is_refused;
  std::function<void(const std::string& name, Files*)> make;
  const char* said;  ///< with %s for the name
};

constexpr char kBox[] =
    "<collision name='c'><geometry><box><size>1 1 1</size></box></geometry></collision>";

std::function<void(const std::string&, Files*)> InWorld(const std::string& format) {
  return [format](const std::string& name, Files* files) {
    files->world += fmt::format(fmt::runtime(format), name) + "\n";
  };
}

/// A link with `inside`, on a joint with `of_joint`.
std::function<void(const std::string&, Files*)> OnRobot(
    const std::string& inside, const std::string& type = "fixed",
    const std::string& of_joint = "<axis xyz='0 0 1'/>") {
  return [=](const std::string& name, Files* files) {
    files->links += fmt::format("<link name='{0}'>" + inside + "</link>\n", name);
    files->joints +=
        fmt::format("<joint name='{0}_j' type='" + type +
                        "'><parent link='base'/><child link='{0}'/>" + of_joint + "</joint>\n",
                    name);
  };
}

std::function<void(const std::string&, Files*)> InMap(std::string Files::*line,
                                                      const std::string& format) {
  return [=](const std::string& name, Files* files) {
    files->*line = fmt::format(fmt::runtime(format), name);
  };
}

std::string Shape(const std::string& shape) {
  return "<collision><geometry>" + shape + "</geometry></collision>";
}

std::vector<Defect> OfWorlds() {
  const std::string model = "<model name='{0}'><static>true</static><pose>5 5 0 0 0 0</pose>";
  const std::string bad_mass =
      "<inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>9</izz></inertia></inertial>";
  const auto with_shape = [&](const std::string& shape) {
    return InWorld(model + "<link name='l'><collision name='c'><geometry>" + shape +
                   "</geometry></collision></link></model>");
  };
  return {
      {"actor", "", false, InWorld("<actor name='{0}'/>"), "%s"},
      {"population", "", false, InWorld("<population name='{0}'/>"), "%s"},
      {"unknown element", "", false, InWorld("<modell name='{0}'/>"), "%s"},
      {"no mass", "", false,
       InWorld(std::string("<model name='{0}'><pose>5 5 0 0 0 0</pose><link name='l'>") + kBox +
               "</link></model>"),
       "%s"},
      {"hinge", "", false,
       InWorld(std::string("<model name='{0}'><pose>5 5 0 0 0 0</pose><link name='a'>") + kBox +
               "</link><link name='b'>" + kBox +
               "</link><joint name='j' type='revolute'><parent>a</parent><child>b</child></joint>"
               "</model>"),
       "%s"},
      {"missing model", "", true, InWorld("<include><uri>model://{0}</uri></include>"),
       "model://%s"},
      {"missing mesh", "", true, with_shape("<mesh><uri>{0}.stl</uri></mesh>"), "%s.stl"},
      {"heightmap", "height", true, with_shape("<heightmap><uri>{0}</uri></heightmap>"),
       "<heightmap>"},
      {"mass of what can move", "", true,
       InWorld("<model name='m_{0}'><link name='{0}'>" + bad_mass + kBox + "</link></model>"),
       "%s"},
      {"pose of nothing", "", true,
       InWorld("<frame name='f_{0}'><pose relative_to='{0}'/></frame>"), "%s"},
      {"restitution", "bounce", true,
       InWorld(model + "<link name='l'><collision name='c'><geometry><box><size>1 1 1</size></box>"
                       "</geometry><surface><bounce><restitution_coefficient>2</"
                       "restitution_coefficient></bounce></surface>"
                       "</collision></link></model>"),
       "<restitution_coefficient>"},
  };
}

std::vector<Defect> OfRobots() {
  const auto links = [](const std::string& format) {
    return [format](const std::string& name, Files* files) {
      files->links += fmt::format(fmt::runtime(format), name) + "\n";
    };
  };
  const auto joints = [](const std::string& format) {
    return [format](const std::string& name, Files* files) {
      files->joints += fmt::format(fmt::runtime(format), name) + "\n";
    };
  };
  return {
      {"mass of 0", "", false,
       OnRobot("<inertial><mass value='0'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' "
               "izz='1'/></inertial>"),
       "%s"},
      {"floating joint", "", false, OnRobot("", "floating"), "%s_j"},
      {"joint without limits", "", false, OnRobot("", "revolute"), "%s_j"},
      {"missing mesh", "", true, OnRobot(Shape("<mesh filename='{0}.stl'/>")), "%s.stl"},
      {"missing package", "", true, OnRobot(Shape("<mesh filename='package://{0}/a.stl'/>")),
       "'%s'"},
      {"unknown shape", "", true, OnRobot(Shape("<torus/>")), "'%s'"},
      {"flat box", "", true, OnRobot(Shape("<box size='1 1 0'/>")), "'%s'"},
      {"word for a number", "", true, OnRobot(Shape("<sphere radius='{0}_wide'/>")), "%s_wide"},
      {"capsule of no radius", "", true, OnRobot(Shape("<capsule length='1'/>")), "'%s'"},
      {"axis", "", false, OnRobot("", "continuous", "<axis xyz='0 0 0'/>"), "%s_j"},
      {"unknown kind of joint", "", true, OnRobot("", "hinge_{0}"), "hinge_%s"},
      {"limits turned round", "", false,
       OnRobot("", "revolute", "<limit lower='1' upper='-1' effort='1' velocity='1'/>"), "%s_j"},
      {"limits in words", "", false,
       OnRobot("", "revolute", "<limit lower='-pi' upper='pi' effort='1' velocity='1'/>"), "%s_j"},
      {"velocity below 0", "", false,
       OnRobot("", "revolute", "<limit lower='0' upper='1' effort='1' velocity='-1'/>"), "%s_j"},
      {"follows itself", "", false, OnRobot("", "continuous", "<mimic joint='{0}_j'/>"), "%s_j"},
      {"mimics nobody", "", true, OnRobot("", "continuous", "<mimic joint='{0}_k'/>"), "%s_k"},
      {"link that is there twice", "", true,
       [](const std::string& name, Files* files) {
         OnRobot("")(name, files);
         files->links += fmt::format("<link name='{}'/>\n", name);
       },
       "'%s' is there twice"},
      {"loose link", "loose", true, links("<link name='{0}'/>"), "'%s'"},
      {"joint to nowhere", "", true,
       joints("<joint name='{0}_x' type='fixed'><parent link='base'/><child link='{0}'/></joint>"),
       "child link '%s'"},
      {"joint without a parent", "", true,
       [](const std::string& name, Files* files) {
         files->links += fmt::format("<link name='{}'/>\n", name);
         files->joints +=
             fmt::format("<joint name='{0}_p' type='fixed'><child link='{0}'/></joint>\n", name);
       },
       "'%s_p' has no <parent>"},
  };
}

std::vector<Defect> OfMaps() {
  return {
      {"foreign key", "", false,
       [](const std::string& name, Files* files) { files->more += "\nfrom_" + name + ": 1"; },
       "from_%s"},
      {"no thresholds", "thresholds", false, InMap(&Files::thresholds, ""),
       "occupied_thresh: 0.65"},
      {"no negate", "negate", false, InMap(&Files::negate, ""), "negate: 0"},
      {"path of another computer", "image", false,
       InMap(&Files::image, "image: /home/{0}/hall.pgm"), "/home/%s/hall.pgm"},
      {"missing picture", "image", true, InMap(&Files::image, "image: {0}.pgm"), "%s.pgm"},
      {"mistyped key", "resolution", true, InMap(&Files::resolution, "reslution: 0.1"),
       "'reslution'"},
      {"resolution of 0", "resolution", true, InMap(&Files::resolution, "resolution: 0"),
       "resolution is '0'"},
      {"origin of two", "origin", true, InMap(&Files::origin, "origin: [0.0, 0.0]"), "origin is"},
      {"degrees", "origin", true, InMap(&Files::origin, "origin: [0.0, 0.0, 180.0]"), "the yaw"},
      {"percent", "thresholds", true,
       InMap(&Files::thresholds, "occupied_thresh: 65\nfree_thresh: 0.196"), "in percent"},
      {"mode", "mode", true,
       [](const std::string& name, Files* files) { files->more += "\nmode: m_" + name; }, "m_%s"},
  };
}

std::vector<Defect> OfGoals() {
  const auto add = [](const std::string& format) {
    return [format](const std::string& name, Files* files) {
      files->goals += fmt::format(fmt::runtime(format), name) + "\n";
    };
  };
  return {
      {"degrees", "", true, add("{0}: [2.0, 1.0, 90.0]"), "90 degrees"},
      {"odometry's frame", "", true,
       add("{0}: {{header: {{frame_id: odom}}, pose: {{position: {{x: 1, y: 2}}}}}}"),
       "frame_id is 'odom'"},
      {"five numbers", "", true, add("{0}: [1, 2, 3, 4, 5]"), "a list of 5 numbers"},
      {"foreign frame", "", false,
       add("{0}: {{frame_id: {0}_map, position: [2, 1], orientation: [0, 0, 0, 1]}}"), "%s_map"},
      {"height", "", false, add("{0}: {{position: [2, 1, 7], yaw: 0}}"), "heights"},
  };
}

std::vector<Defect> AllDefects() {
  std::vector<Defect> all;
  for (const auto& some : {OfWorlds(), OfRobots(), OfMaps(), OfGoals()})
    all.insert(all.end(), some.begin(), some.end());
  return all;
}

std::string Said(const Defect& defect, const std::string& name) {
  std::string said = defect.said;
  const std::size_t at = said.find("%s");
  return at == std::string::npos ? said : said.replace(at, 2, name);
}

class OddFilesTest : public testing::Test {
 protected:
  OddFilesTest() {
    std::string picture = "P5\n40 40\n255\n";
    for (int i = 0; i < 40 * 40; ++i) picture += i % 40 == 0 ? '\0' : '\xfe';
    folder_.Write("hall.pgm", picture);
  }

  Ended Doctor(const Files& f) const {
    const std::string world = folder_.Write(
        "odd.world",
        "<sdf version='1.7'><world name='odd'><model name='floor'><static>true</static><link "
        "name='l'><collision name='c'><geometry><plane><normal>0 0 1</normal></plane></geometry>"
        "</collision></link></model>\n" +
            f.world + "</world></sdf>");
    const std::string robot =
        folder_.Write("odd.urdf",
                      "<robot name='odd'>\n<link name='base'><collision><origin xyz='0 0 0.2'/>"
                      "<geometry><box size='0.4 0.3 0.3'/></geometry></collision></link>\n" +
                          f.links + f.joints + "</robot>");
    const std::string map = folder_.Write(
        "odd.yaml", base::Join({f.image, f.resolution, f.origin, f.negate, f.thresholds}, "\n") +
                        f.more + "\n");
    const std::string goals = folder_.Write("goals.yaml", f.goals);
    return RunHires({"doctor"},
                    {"--world", world, "--robot", robot, "--map", map, "--area", goals});
  }

  const hires::test_support::TemporaryFolder folder_;
};

TEST_F(OddFilesTest, WithoutDefectsNothingIsWarnedOf) {
  const Ended ended = Doctor({});
  EXPECT_EQ(ended.code, 0) << ended.out << ended.err;
  for (const std::string& line : base::Split(ended.out, '\n'))
    EXPECT_TRUE(line.rfind("warn", 0) != 0 || line.find("no two areas") != std::string::npos)
        << line;
}

TEST_F(OddFilesTest, EachAloneIsSaidAndRefusedOrNot) {
  for (const Defect& defect : AllDefects()) {
    Files files;
    defect.make("thing7", &files);
    const Ended ended = Doctor(files);
    EXPECT_EQ(ended.code, defect.is_refused ? 1 : 0) << defect.kind << ":\n" << ended.out;
    EXPECT_NE(ended.out.find(Said(defect, "thing7")), std::string::npos) << defect.kind << ":\n"
                                                                         << ended.out << ended.err;
  }
}

TEST_F(OddFilesTest, OfSeveralInAnyFilesEachIsSaid) {
  const std::vector<Defect> defects = AllDefects();
  for (int round = 0; round < Rounds(300); ++round) {
    base::Rng rng(static_cast<std::uint64_t>(round) + 57);
    std::vector<const Defect*> drawn;
    const std::size_t number = 1 + rng.Index(3);
    while (drawn.size() < number) {
      const Defect* defect = &defects[rng.Index(static_cast<int>(defects.size()))];
      const std::string part = defect->part;
      const bool is_taken = std::any_of(drawn.begin(), drawn.end(), [&](const Defect* other) {
        return other == defect || (!part.empty() && part == other->part);
      });
      if (!is_taken) drawn.push_back(defect);
    }
    Files files;
    bool is_refused = false;
    for (std::size_t i = 0; i < drawn.size(); ++i) {
      drawn[i]->make(fmt::format("thing{}", i + 1), &files);
      is_refused = is_refused || drawn[i]->is_refused;
    }
    const Ended ended = Doctor(files);
    EXPECT_EQ(ended.code, is_refused ? 1 : 0) << "round " << round << ":\n" << ended.out;
    for (std::size_t i = 0; i < drawn.size(); ++i) {
      EXPECT_NE(ended.out.find(Said(*drawn[i], fmt::format("thing{}", i + 1))), std::string::npos)
          << "round " << round << ": " << drawn[i]->kind << "\n"
          << ended.out << ended.err;
    }
  }
}

}  // namespace
}  // namespace hires::cli::odd_files_test
