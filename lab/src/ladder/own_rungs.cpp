#include "lab/src/ladder/own_rungs.h"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <utility>

#include "hires/geometry/angles.h"
#include "hires/imagination/local_imagination.h"

namespace hires::lab::ladder {
namespace {

using imagination::ImaginationSetup;
using simulation::LevelOfDetail;

constexpr char kFactor[] = "real-time factor";

/// The engine alone: the mill on the tray of a robot that swings to and fro in the restaurant.
class Swing {
 public:
  explicit Swing(const ImaginationSetup& setup) : world_(setup.physics) {
    const world::World& room = setup.scene->world;
    world_.AddFloor(room.floor_friction);
    for (const world::StaticBody& body : room.statics) world_.AddStatic(body.collisions, body.X_MB);
    const imagination::StartState start = DriveStart(setup);
    const geometry::Pose3 X_MB = geometry::Lift(start.robot.X_MB);
    base_ = world_.AddDriven(setup.scene->robot_shapes_B, X_MB);
    const world::ObjectState& mill = start.world.objects.front();
    const auto model = room.ModelOf(mill);
    world_.AddLoose(model->mass_properties, model->collisions, {mill.X_MO, {}});
    constexpr int kSettling = 500;
    for (int i = 0; i < kSettling; ++i) world_.Step();
    settled_ = world_.Save();
  }

  /// Two seconds. @return steps.
  double Play() {
    constexpr int kSteps = 2000;
    world_.Restore(settled_);
    for (int step = 0; step < kSteps; ++step) {
      physics::BodyState motion = world_.GetState(base_);
      motion.V_WB.linear.x() = 0.3 * std::sin(2.0 * geometry::kPi * step / kSteps);
      world_.SetMotion(base_, motion);
      world_.Step();
    }
    return kSteps;
  }

 private:
  physics::PhysicsWorld world_;
  physics::BodyId base_{-1};
  physics::PhysicsState settled_;
};

OwnPlan OdeStep(const Places& places) {
  return {"ode_step",
          "steps of the engine: tray, pepper mill, restaurant",
          "steps/s",
          {"", {}, [&setup = places.drawn()] {
             const auto swing = std::make_shared<Swing>(setup);
             return Player{[swing](int) { return swing->Play(); }};
           }}};
}

OwnPlan Idle(const Places& places, LevelOfDetail level, std::string id, std::string title) {
  const ImaginationSetup& setup = places.drawn();
  Stepping stepping{setup.scene, DriveStart(setup), level};
  stepping.round = level == LevelOfDetail::kTray ? 1.0 : 0.2;
  return {std::move(id),
          std::move(title),
          kFactor,
          {"", {}, [stepping, physics = setup.physics, seed = places.seed()] {
             return StepRobot(stepping, physics, seed);
           }}};
}

OwnPlan DriveStep(const Places& places, const std::string& localisation, bool has_layer,
                  std::string id, std::string title) {
  return {std::move(id), std::move(title), kFactor,
          DriveWay(places.Told(localisation, has_layer), places.seed(), "")};
}

OwnPlan ArmStep(const Places& places, std::string id, std::string title, const std::string& area,
                const base::Atom& mug, const base::ActionCall& action) {
  const ImaginationSetup& setup = places.drawn();
  const std::vector<base::Atom> ready{{"RobotAt", {area}},
                                      {"HasTorsoPosture", {"TorsoUpPosture"}},
                                      {"HasArmPosture", {"leftArm1", "ArmToSidePosture"}},
                                      {"HasArmPosture", {"rightArm1", "ArmToSidePosture"}},
                                      mug};
  const imagination::RolloutSetup rollouts = imagination::MakeRolloutSetup(
      setup, imagination::MakeStartState(setup, ready), places.seed());
  return {std::move(id), std::move(title), kFactor, {"", {}, [rollouts, action] {
                                                       return PlayRollouts(rollouts, action);
                                                     }}};
}

}  // namespace

std::vector<OwnPlan> RolloutSteps(const Places& places) {
  return {
      OdeStep(places),
      Idle(places, LevelOfDetail::kTray, "idle_tray", "idle robot with the mill, level tray"),
      Idle(places, LevelOfDetail::kPlanar, "idle_planar", "idle robot with the mill, level planar"),
      DriveStep(places, "drawn", true, "drive_layer",
                "rollouts of a drive, with the laser's obstacle layer"),
      DriveStep(places, "fitted", false, "drive_fitted",
                "rollouts of a drive, place as the fit says"),
      DriveStep(places, "filter", false, "drive_filter",
                "rollouts of a drive, place found by the filter"),
      ArmStep(places, "pick", "rollouts of picking up a mug", "manipulationAreaEastCounter1",
              {"On", {"mug1", "placingAreaEastRightCounter1"}},
              {"pick_up_object", {"mug1", "rightArm1"}}),
      ArmStep(places, "place", "rollouts of placing a mug", "manipulationAreaSouthTable1",
              {"Holding", {"rightArm1", "mug1"}},
              {"place_object", {"mug1", "rightArm1", "placingAreaWestRightTable1"}})};
}

OwnPlan RankedAnswer(const Places& places, int num_rollouts, int threads,
                     const std::function<bool()>& cancelled) {
  const imagination::RolloutSetup rollouts = DriveSetup(places.drawn(), places.seed());
  imagination::SchedulerParams params;
  params.early_stop = false;
  params.rollouts = num_rollouts;
  OwnPlan plan{"ranked_answer",
               fmt::format("fast or slow, {} rollouts each, ranked, on all cores", num_rollouts),
               "s",
               {"", {}, [=] {
                  return Player{[=](int) {
                    imagination::ImagineLocally(rollouts, {Drive("fast"), Drive("slow")}, params,
                                                threads, {}, cancelled);
                    return 1.0;
                  }};
                }}};
  plan.counts_seconds = true;
  plan.share = 6.0;
  return plan;
}

}  // namespace hires::lab::ladder
