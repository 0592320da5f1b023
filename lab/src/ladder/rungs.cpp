#include "lab/src/ladder/rungs.h"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "lab/src/ladder/other_worlds.h"
#include "sim_robot/sim_robot_sensors.h"
#include "hires/simulation/self_localisation.h"

namespace hires::lab::ladder {
namespace {

using geometry::Twist2;
using imagination::ImaginationSetup;
using imagination::StartState;
using simulation::LevelOfDetail;
using simulation::Scene;

constexpr double kFine = 0.1;       // [m] edge of the triangles of walls and furniture
constexpr double kFinest = 0.01;    // [m] ... of things to hold
constexpr double kChairMass = 5.0;  // [kg] of the original's models

RungPlan Step(std::string id, std::string title, std::optional<double> before,
              std::optional<double> after, std::string published) {
  RungPlan plan;
  plan.rung.id = std::move(id);
  plan.rung.title = std::move(title);
  plan.rung.published_before = before;
  plan.rung.published_after = after;
  plan.rung.published = std::move(published);
  return plan;
}

/// A robot that is stepped, with what there is in its world, in numbers.
Way SteppingWay(const Places& places, Stepping stepping, std::string what) {
  int triangles_fixed = 0, triangles_loose = 0;
  const world::World& world = stepping.scene->world;
  for (const auto& body : world.statics) triangles_fixed += NumTriangles(body.collisions);
  for (const auto& object : stepping.start.world.objects)
    triangles_loose += NumTriangles(world.ModelOf(object)->collisions);
  const std::map<std::string, double> facts{
      {"static_bodies", static_cast<double>(world.statics.size())},
      {"loose_bodies", static_cast<double>(stepping.start.world.objects.size())},
      {"static_triangles", static_cast<double>(triangles_fixed)},
      {"loose_triangles", static_cast<double>(triangles_loose)}};
  return {std::move(what), facts,
          [stepping, physics = places.drawn().physics, seed = places.seed()] {
            return StepRobot(stepping, physics, seed);
          }};
}

RungPlan ChairsStatic(const Places& places) {
  RungPlan plan = Step("chairs_static", "step 1: chairs are static", 0.73, 0.85,
                       "the links of the chairs' model set to static");
  const ImaginationSetup& setup = places.drawn();
  const StartState start = LaidTable(setup);
  StartState loose = start;
  const auto scene = SceneIn(WithLoose(places.world(), "chair", kChairMass), *setup.scene);
  for (const world::ObjectState& chair : scene->world.initial.objects)
    if (scene->world.ModelOf(chair)->name.rfind("loose_", 0) == 0)
      loose.world.objects.push_back(chair);
  plan.before = SteppingWay(places, {scene, loose}, "idle robot; chairs of 5 kg that can move");
  plan.after = SteppingWay(places, {setup.scene, start}, "idle robot; static chairs");
  plan.on_all_cores = plan.is_one_motion = true;
  return plan;
}

/// The robot that stands in for a real one, looking at table 1; its pictures are drawn, or not.
class Watching {
 public:
  Watching(const Places& places, bool draws)
      : world_(places.drawn(), Start(places), places.seed()), draws_(draws) {
    const sim_robot::SimCameraParams params =
        sim_robot::ReadSimSensorParams(base::ParamReader::FromFile(places.File("sim_robot.yaml"))).cameras;
    cameras_ = std::make_unique<sim_robot::SimRobotCameras>(params, base::Rng(places.seed()), world_.scene());
  }

  /// A tenth of a second, three pictures.
  double Play() {
    for (const long milliseconds : {33, 33, 34}) {
      world_.Advance(milliseconds);
      if (draws_) cameras_->Colours(world_);
    }
    return 0.1;
  }
  world::WorldState State() const { return world_.simulator().GetWorldState(); }

 private:
  static StartState Start(const Places& places) {
    StartState start = sim_robot::StartOf(places.drawn(), places.Scenario("serve_coffee"), "");
    start.robot.X_MB = {7.73, 10.0, 1.5708};
    start.robot.joints["head_tilt_joint"] = 0.4;  // [rad]
    return start;
  }

  sim_robot::SimRobotWorld world_;
  std::unique_ptr<sim_robot::SimRobotCameras> cameras_;
  bool draws_;
};

Way WatchingWay(const Places& places, bool draws, std::string what) {
  return {
      std::move(what), {{"pictures_per_second", draws ? 30.0 : 0.0}}, [&places, draws] {
        const auto robot = std::make_shared<Watching>(places, draws);
        return Player{[robot](int) { return robot->Play(); }, [robot] { return robot->State(); }};
      }};
}

RungPlan NoDisplay(const Places& places) {
  RungPlan plan = Step("no_display", "step 2: nothing is drawn", std::nullopt, std::nullopt,
                       "without Gazebo's window about 7 % faster, elsewhere given as +0.10");
  plan.rung.note =
      "workers have no window; what can be drawn is what the head's camera sees, 30 pictures of "
      "640 x 480 a simulated second, by ray casting on the processor";
  plan.before = WatchingWay(places, true, "simulated robot, its camera's pictures drawn at 30 Hz");
  plan.after = WatchingWay(places, false, "simulated robot, nothing drawn");
  plan.is_one_motion = true;
  return plan;
}

RungPlan PrimitiveObjects(const Places& places) {
  RungPlan plan = Step("primitive_objects", "step 3: objects are primitive shapes", 0.55, 1.50,
                       "from about 0.55 to about 1.50; elsewhere up to +2.5");
  const ImaginationSetup& setup = places.drawn();
  const StartState start = LaidTable(setup);
  const auto meshes = SceneIn(WithMeshObjects(places.world(), kFinest), *setup.scene);
  plan.before = SteppingWay(places, {meshes, start},
                            "idle robot; mugs and mill of triangles with edges of 1 cm");
  plan.after = SteppingWay(places, {setup.scene, start}, "idle robot; mugs and mill are cylinders");
  plan.on_all_cores = plan.is_one_motion = true;
  return plan;
}

ImaginationSetup WithParticles(ImaginationSetup setup, int least, int most) {
  simulation::SelfLocalisationParams params = setup.scene->self_localisation->params();
  params.filter.min_particles = least;
  params.filter.max_particles = most;
  setup.scene = simulation::FindingItsPlace(*setup.scene, params, setup.scene->world);
  return setup;
}

Way ParticlesWay(const Places& places, const ImaginationSetup& told, int least, int most) {
  const ImaginationSetup setup = WithParticles(told, least, most);
  const localisation::MonteCarloParams& filter = setup.scene->self_localisation->params().filter;
  Way way = DriveWay(setup, places.seed(),
                     fmt::format("drives with the mill; filter of {} to {} particles",
                                 filter.min_particles, filter.max_particles));
  way.facts = {{"min_particles", static_cast<double>(filter.min_particles)},
               {"max_particles", static_cast<double>(filter.max_particles)},
               {"obstacle_layers", setup.scene->sight.scans ? 1.0 : 0.0}};
  return way;
}

RungPlan FewerParticles(const Places& places, bool has_layer) {
  RungPlan plan = has_layer
                      ? Step("fewer_particles_with_layer", "step 3b with an obstacle layer", {}, {},
                             "about +0.1")
                      : Step("fewer_particles", "step 3b: fewer particles", {}, {},
                             "about +0.1 by AMCL with 100 to 10 particles instead of 5000 to 500");
  const ImaginationSetup setup = places.Told("filter", has_layer);
  plan.before = ParticlesWay(places, setup, 500, 5000);
  plan.after = ParticlesWay(places, setup, 10, 100);
  return plan;
}

RungPlan PrimitiveWalls(const Places& places) {
  RungPlan plan = Step("primitive_walls", "step 4: walls and furniture are boxes", {}, {},
                       "more than +2.0; elsewhere +0.33 to +3.0");
  const ImaginationSetup& setup = places.drawn();
  const auto meshes = SceneIn(WithMeshStatics(places.world(), kFine), *setup.scene);
  const Twist2 turning{0.0, 0.0, 0.4};
  Stepping stepping{setup.scene, LaidTable(setup), LevelOfDetail::kPlanar, 0.2, turning};
  plan.after =
      SteppingWay(places, stepping, "robot turns at table 1; walls and furniture are boxes");
  stepping.scene = meshes;
  plan.before = SteppingWay(places, stepping,
                            "the same; walls and furniture of triangles with edges of 10 cm");
  plan.on_all_cores = plan.is_one_motion = true;
  return plan;
}

Way MappedWay(const Places& places, const ImaginationSetup& setup, const world::World& mapped,
              std::string what) {
  ImaginationSetup own = setup;
  own.scene =
      simulation::FindingItsPlace(*setup.scene, setup.scene->self_localisation->params(), mapped);
  Way way = DriveWay(own, places.seed(), std::move(what));
  way.facts = {{"mapped_bodies", static_cast<double>(mapped.statics.size())}};
  return way;
}

RungPlan OwnMap(const Places& places) {
  RungPlan plan = Step("own_map", "a map made in the simulated world itself", {}, {},
                       "about +0.10 by a very accurate localisation map");
  plan.rung.note =
      "with another map the filter believes, and the robot drives, otherwise: the ratio is of "
      "whole "
      "drives, not of a scan";
  constexpr double kRoomHigh = 1.5;  // [m]
  const ImaginationSetup setup = places.Told("filter", false);
  plan.before = MappedWay(places, setup, WithHighStaticsOnly(places.world(), kRoomHigh),
                          "drives with the mill; the filter's map is a plan of the building alone");
  plan.after = MappedWay(places, setup, places.world(), "the same; the map is of this very world");
  return plan;
}

/// The robot simulator of the scenario topple, nothing commanded.
Way BareWay(const Places& places) {
  return {"the robot simulator of the same scenario alone, nothing commanded", {}, [&places] {
            constexpr long kRound = 1000;  // [ms]
            const auto world = std::make_shared<sim_robot::SimRobotWorld>(
                places.drawn(), sim_robot::StartOf(places.drawn(), places.Scenario("topple"), ""),
                places.seed());
            return Player{[world](int) {
              world->Advance(kRound);
              return 0.001 * kRound;
            }};
          }};
}

RungPlan BareRobot(const Places& places,
                   const std::function<std::optional<double>(std::uint64_t)>& play_task) {
  RungPlan plan = Step("bare_robot", "the whole system against the robot simulator alone", 0.3, {},
                       "the whole system about 0.3 while it serves a coffee, at first about 0.1");
  plan.before = {
      "the scenario topple in one process on one thread: sensors, tracker, Blackboard, "
      "planner, monitor, skills, imagination",
      {},
      [play_task, seed = places.seed()] {
        return Player{[=](int) { return play_task(seed).value_or(0.0); }};
      }};
  plan.after = BareWay(places);
  plan.share = 10.0;
  return plan;
}

RungPlan IdleNavigation(const Places& places) {
  RungPlan plan =
      Step("no_navigation", "no navigation", {}, {}, "navigation and localisation cost about 0.5");
  const ImaginationSetup& setup = places.drawn();
  plan.before =
      DriveWay(setup, places.seed(), "drives with the mill: A*, dynamic window, commands");
  Stepping stepping{setup.scene, DriveStart(setup), LevelOfDetail::kTray};
  stepping.round = 1.0;
  plan.after = SteppingWay(places, stepping, "the same robot with the mill, idle");
  return plan;
}

}  // namespace

std::vector<RungPlan> DissertationRungs(
    const Places& places,
    const std::function<std::optional<double>(std::uint64_t seed)>& play_task) {
  std::vector<RungPlan> rungs{ChairsStatic(places),
                              NoDisplay(places),
                              PrimitiveObjects(places),
                              FewerParticles(places, false),
                              FewerParticles(places, true),
                              PrimitiveWalls(places),
                              OwnMap(places),
                              IdleNavigation(places)};
  if (play_task) rungs.push_back(BareRobot(places, play_task));
  return rungs;
}

}  // namespace hires::lab::ladder
