#include "lab/src/ladder/ladder.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "hires/geometry/angles.h"
#include "lab/src/ladder/measure.h"
#include "lab/src/ladder/other_worlds.h"
#include "lab/src/ladder/rungs.h"
#include "support/messages.h"

namespace hires::lab::ladder_test {
namespace {

using namespace ladder;  // NOLINT: the folder's words
using geometry::TriangleMesh;
using hires::test_support::ConfigErrorOf;
using testing::DoubleEq;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;

/// A clock that goes on when somebody works; processor time passes half as fast.
struct FakeTime {
  double now{100.0};
  LadderClocks clocks() {
    return {[this] { return now; }, [this] { return 0.5 * now; }};
  }
  /// Each round takes `seconds` and is worth `amount`; who played is noted.
  Way WayOf(char name, double seconds, double amount) {
    return {"", {}, [=] {
              return Player{[=](int round) {
                played += name + std::to_string(round);
                now += seconds;
                return amount;
              }};
            }};
  }
  std::string played{};
};

TEST(LadderMeasureTest, PlaysTheSameRoundsOfBothWaysByTurns) {
  FakeTime time;
  const Way slow = time.WayOf('s', 3.0, 6.0), quick = time.WayOf('q', 1.0, 6.0);
  const auto both = MeasureByTurns({&slow, &quick}, {1, 1}, {24.0, 3, 100}, time.clocks(), {});
  ASSERT_TRUE(both);
  EXPECT_EQ(time.played,
            "s0q0"
            "s0s1q0q1"
            "q2q3s2s3"
            "s4s5q4q5")
      << "a round that does not count, then 24 s for three repeats of 4 s each";
  EXPECT_THAT((*both)[0].Rates(), ElementsAre(2.0, 2.0, 2.0));
  EXPECT_THAT((*both)[1].Rates(), ElementsAre(6.0, 6.0, 6.0));
  EXPECT_THAT((*both)[0].SecondsEach(), Each(0.5));
  EXPECT_THAT((*both)[0].ProcessorSecondsEach(), Each(1.5));
}

TEST(LadderMeasureTest, RepeatsLessWhatTakesTooLongButTwice) {
  FakeTime time;
  const Way way = time.WayOf('w', 10.0, 1.0);
  const auto few = MeasureByTurns({&way}, {1}, {35.0, 5, 100}, time.clocks(), {});
  EXPECT_EQ(few->front().stretches.size(), 3u);
  const auto two = MeasureByTurns({&way}, {1}, {1.0, 5, 100}, time.clocks(), {});
  EXPECT_EQ(two->front().stretches.size(), 2u);
  EXPECT_EQ(two->front().stretches.front().rounds, 1);
  EXPECT_EQ(time.played, "w0w0w1w2w0w1") << "4 and 2: what takes so long needs no warming up";
}

TEST(LadderMeasureTest, SumsUpWhatThreadsPlayTogether) {
  double now = 0.0;  // one second between two looks at the clock
  const LadderClocks clocks{[&] { return now += 1.0; }, [&] { return now; }};
  const Way way{"", {}, [] { return Player{[](int) { return 7.0; }}; }};
  const auto measured = MeasureByTurns({&way}, {3}, {2.0, 2, 100}, clocks, {});
  EXPECT_THAT(measured->front().Rates(), Each(DoubleEq(21.0)));
}

TEST(LadderMeasureTest, StopsWhenCancelled) {
  FakeTime time;
  const Way way = time.WayOf('w', 1.0, 1.0);
  const auto cancelled = [&] { return time.played.size() >= 8; };  // in the fourth round
  EXPECT_FALSE(MeasureByTurns({&way}, {1}, {100.0, 5, 100}, time.clocks(), cancelled));
  EXPECT_EQ(time.played, "w0w0w1w2");
}

TEST(LadderMeasureTest, RatiosHaveTheIntervalOfTheirLogarithms) {
  const Interval ratio = RatioOf({1.0, 1.0, 1.0}, {1.0, 2.0, 4.0});
  constexpr double kT = 4.302652729911275;  // Student, 2 degrees of freedom, 97.5 %
  const double half = kT * std::log(2.0) / std::sqrt(3.0);
  EXPECT_NEAR(ratio.estimate, 2.0, 1e-12);
  EXPECT_NEAR(ratio.lower, 2.0 * std::exp(-half), 1e-9);
  EXPECT_NEAR(ratio.upper, 2.0 * std::exp(half), 1e-9);
  EXPECT_THROW(RatioOf({1.0}, {0.0}), std::logic_error);
  EXPECT_THROW(RatioOf({1.0}, {1.0, 2.0}), std::logic_error);
}

/// [m^3] enclosed, by the divergence theorem: negative where triangles are seen from inside.
double VolumeOf(const TriangleMesh& mesh) {
  double volume = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    volume += mesh.vertices[a].dot(mesh.vertices[b].cross(mesh.vertices[c])) / 6.0;
  }
  return volume;
}

/// Every edge is walked once each way.
bool IsClosed(const TriangleMesh& mesh) {
  std::map<std::pair<int, int>, int> walked;
  for (const auto& t : mesh.triangles)
    for (int i = 0; i < 3; ++i) ++walked[{t[i], t[(i + 1) % 3]}];
  for (const auto& [edge, times] : walked) {
    const auto back = walked.find({edge.second, edge.first});
    if (times != 1 || back == walked.end()) return false;
  }
  return true;
}

TEST(LadderWorldsTest, TrianglesEncloseTheShape) {
  const TriangleMesh box = Triangulated(geometry::Box{{0.5, 0.25, 0.1}}, 0.1);
  EXPECT_TRUE(IsClosed(box));
  EXPECT_NEAR(VolumeOf(box), 0.0125, 1e-12);
  EXPECT_EQ(box.triangles.size(), 2u * 2u * (5 * 3 + 3 * 1 + 1 * 5));

  const TriangleMesh mug = Triangulated(geometry::Cylinder{0.04, 0.1}, 0.005);
  EXPECT_TRUE(IsClosed(mug));
  const double volume = geometry::kPi * 0.04 * 0.04 * 0.1;
  EXPECT_LT(VolumeOf(mug), volume);
  EXPECT_GT(VolumeOf(mug), 0.99 * volume);

  const TriangleMesh ball = Triangulated(geometry::Sphere{0.1}, 0.01);
  EXPECT_TRUE(IsClosed(ball));
  EXPECT_NEAR(VolumeOf(ball), 4.0 / 3.0 * geometry::kPi * 1e-3, 1e-5 * 4.2);
}

TEST(LadderWorldsTest, LooseBodiesAreSolid) {
  world::World world;
  const geometry::Box box{{0.4, 0.4, 0.9}};
  world::StaticBody chair{"chair1", geometry::Lift({1.0, 2.0, 0.5}), {}};
  chair.collisions.resize(2);  // in two halves, one upon the other
  for (int half = 0; half < 2; ++half) {
    chair.collisions[half].shape = geometry::Box{{0.4, 0.4, 0.45}};
    chair.collisions[half].X_BS.translation.z() = 0.225 + 0.45 * half;
  }
  world.statics = {chair, {"table1", {}, {}}};
  const world::World loose = WithLoose(world, "chair", 5.0);
  ASSERT_EQ(loose.statics.size(), 1u);
  ASSERT_EQ(loose.initial.objects.size(), 1u);
  const geometry::MassProperties mass =
      loose.ModelOf(loose.initial.objects.front())->mass_properties;
  EXPECT_NEAR(mass.mass, 5.0, 1e-12);
  EXPECT_NEAR(mass.p_BBcm.z(), 0.45, 1e-12);
  EXPECT_TRUE(mass.I_BBcm.isApprox(geometry::SolidInertia(box, 5.0), 1e-12)) << mass.I_BBcm;
}

class LadderRungsTest : public testing::Test {
 protected:
  static const Places& Restaurant() {
    static const Places places(HIRES_SOURCE_DIR, 7);
    return places;
  }
  static const std::vector<RungPlan>& Rungs() {
    static const std::vector<RungPlan> rungs = DissertationRungs(Restaurant(), {});
    return rungs;
  }
  static const RungPlan& Find(const std::string& id) {
    for (const RungPlan& plan : Rungs())
      if (plan.rung.id == id) return plan;
    throw std::logic_error(id);
  }
};

TEST_F(LadderRungsTest, StandInAFixedOrder) {
  std::vector<std::string> ids;
  for (const RungPlan& plan : Rungs()) ids.push_back(plan.rung.id);
  EXPECT_THAT(ids, ElementsAre("chairs_static", "no_display", "primitive_objects",
                               "fewer_particles", "fewer_particles_with_layer", "primitive_walls",
                               "own_map", "no_navigation"));
}

TEST_F(LadderRungsTest, TheTwoWaysDifferInWhatIsSimulated) {
  const RungPlan& chairs = Find("chairs_static");
  const auto more = [&](const std::string& what) {
    return chairs.before.facts.at(what) - chairs.after.facts.at(what);
  };
  EXPECT_EQ(more("loose_bodies"), 4.0);
  EXPECT_EQ(more("static_bodies"), -4.0);

  const RungPlan& objects = Find("primitive_objects");
  EXPECT_GT(objects.before.facts.at("loose_triangles"), 1000.0);
  EXPECT_EQ(objects.after.facts.at("loose_triangles"), 0.0);
  EXPECT_EQ(objects.before.facts.at("static_triangles"), 0.0);

  const RungPlan& walls = Find("primitive_walls");
  EXPECT_GT(walls.before.facts.at("static_triangles"), 10000.0);
  EXPECT_EQ(walls.after.facts.at("static_triangles"), 0.0);
  EXPECT_EQ(walls.before.facts.at("loose_triangles"), 0.0);

  for (const char* id : {"fewer_particles", "fewer_particles_with_layer"}) {
    EXPECT_EQ(Find(id).before.facts.at("max_particles"), 5000.0);
    EXPECT_EQ(Find(id).after.facts.at("max_particles"), 100.0);
  }
  EXPECT_EQ(Find("fewer_particles").before.facts.at("obstacle_layers"), 0.0);
  EXPECT_EQ(Find("fewer_particles_with_layer").before.facts.at("obstacle_layers"), 1.0);
  const RungPlan& map = Find("own_map");
  EXPECT_LT(map.before.facts.at("mapped_bodies"), map.after.facts.at("mapped_bodies"));
  EXPECT_GT(map.before.facts.at("mapped_bodies"), 0.0);
}

TEST_F(LadderRungsTest, ParticlesAndMapsReachTheRobot) {
  for (const char* id : {"fewer_particles", "fewer_particles_with_layer", "own_map"}) {
    const Player before = Find(id).before.make(), after = Find(id).after.make();
    before.play(0), after.play(0);
    EXPECT_GT(Apart(before.state(), after.state()), 0.0)
        << id << ": it drives as well as it knows its place";
  }
}

TEST_F(LadderRungsTest, OneMotionEndsTheSame) {
  for (const RungPlan& plan : Rungs()) {
    if (!plan.is_one_motion) continue;
    const Player before = plan.before.make(), after = plan.after.make();
    EXPECT_EQ(before.play(0), after.play(0)) << plan.rung.id;
    EXPECT_FALSE(after.state().objects.empty()) << plan.rung.id;
    EXPECT_LT(Apart(before.state(), after.state()), 0.002) << plan.rung.id;
  }
}

TEST_F(LadderRungsTest, ChairsThatCanMoveStandStill) {
  const Player before = Find("chairs_static").before.make();
  before.play(0);
  int chairs = 0;
  for (const world::ObjectState& object : before.state().objects) {
    if (object.model.rfind("loose_", 0) != 0) continue;
    ++chairs;
    const auto& fixed = Restaurant().world().statics;
    const auto here = std::find_if(fixed.begin(), fixed.end(),
                                   [&](const auto& body) { return body.name == object.name; });
    EXPECT_LT((here->X_MB.translation - object.X_MO.translation).norm(), 0.003) << object.name;
  }
  EXPECT_EQ(chairs, 4);
}

TEST_F(LadderRungsTest, ARoundIsTheSameWheneverItIsPlayed) {
  const Player drive = Find("no_navigation").before.make();
  const double first = drive.play(0), second = drive.play(1);
  EXPECT_NE(first, second);
  EXPECT_EQ(drive.play(0), first);
}

TEST(LadderTest, PublishedNumbersStandBeside) {
  LadderReport report;
  LadderRung& rung = report.rungs.emplace_back();
  rung.id = "chairs_static";
  rung.published_before = 0.73;
  rung.published = "chairs";
  rung.one_core.before.values = {1.0, 2.0};
  rung.one_core.ratio = {2.0, 0.0, std::numeric_limits<double>::infinity()};
  const auto json = ToJson(report)["rungs"][0];
  EXPECT_EQ(json["published"]["before"], 0.73);
  EXPECT_TRUE(json["published"]["after"].is_null());
  EXPECT_EQ(json["before"]["mean"], 1.5);
  EXPECT_TRUE(json["ratio"]["upper"].is_null()) << "JSON knows no infinity";
  EXPECT_THAT(ReportText(report), HasSubstr("0.73 -> ?"));
}

TEST(LadderTest, RefusesBadNumbers) {
  LadderOrder order;
  order.package_folder = HIRES_SOURCE_DIR;
  order.repeats = 1;
  EXPECT_THAT(ConfigErrorOf([&] { ClimbLadder(order, {}); }),
              HasSubstr("repeats is 1, wanted 2 to 1000"));
  order.repeats = 2;
  order.seconds = std::nan("");
  EXPECT_THAT(ConfigErrorOf([&] { ClimbLadder(order, {}); }), HasSubstr("seconds is nan"));
}

}  // namespace
}  // namespace hires::lab::ladder_test
