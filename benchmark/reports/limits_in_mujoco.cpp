// Finds limits as `hires limits` does and plays new samples at each of them in MuJoCo: the base
// moves as the simulator moved it, friction, radius, center of mass and place are those drawn.
//
//   reports_limits_in_mujoco ROBOT.yaml OBJECT SAMPLES SEED THREADS OUT.json
//
// The answer has the fields of `hires limits --json --check SAMPLES`; limits[] also have
// `mujoco_falls`, of `check_truths` samples. scripts/check_limits makes a table of it.
#include <algorithm>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "hires/imagination/client_config.h"
#include "hires/robot/load_robot.h"
#include "hires/world/standing.h"
#include "physics/mujoco_scene.h"
#include "reports/limits/load_drive.h"
#include "reports/limits/motion_limits.h"
#include "reports/text/report_json.h"
#include "simulation/varied.h"

namespace {

using namespace hires;  // NOLINT
using geometry::Pose3;

constexpr double kAfter = 1.0;  // [s] that the base goes on as at the end of the recorded drive

imagination::SetupConfig ConfigOf(const std::string& robot) {
  const std::string config = HIRES_SOURCE_DIR "/config/imagination_client.yaml";
  imagination::SetupConfig setup =
      imagination::ReadSetupConfig(imagination::ReadClientConfig(config).scene);
  imagination::OverridePaths({}, robot, {}, {}, &setup);
  return setup;
}

/// What a drive looked like in the simulator.
struct Recording {
  std::vector<Pose3> X_MB;  // after each step
  Pose3 X_MO;               // after the first step
  bool fell{false};
};

Recording Record(const reports::DriveStage& stage, const reports::LoadDrive& drive,
                 const base::Rng& rng) {
  Recording recording;
  reports::DriveStage own = stage;
  own.on_step = [&](const simulation::RobotSimulator& simulator) {
    if (recording.X_MB.empty()) recording.X_MO = simulator.PoseOf(0);
    recording.X_MB.push_back(simulator.X_MB());
  };
  recording.fell = reports::PlayDrive(own, drive, rng).AnyFell();
  return recording;
}

/// Friction of the robot's shape on which the object stands.
double FrictionBelow(const simulation::Scene& scene, const Pose3& X_BO, double foot) {
  double nearest = HUGE_VAL, friction = 1.0;
  for (const geometry::Collision& shape : scene.robot_shapes_B) {
    const geometry::Aabb bounds = geometry::BoundsOf(shape.shape, shape.X_BS);
    const Eigen::Vector3d& p = X_BO.translation;
    const bool is_below = p.x() > bounds.lower.x() && p.x() < bounds.upper.x() &&
                          p.y() > bounds.lower.y() && p.y() < bounds.upper.y();
    const double distance = std::abs(bounds.upper.z() - foot);
    if (!is_below || distance >= nearest) continue;
    nearest = distance;
    friction = shape.friction;
  }
  return friction;
}

bool FallsInMujoco(const reports::DriveStage& stage, const reports::CheckSample& sample,
                   const world::ObjectModel& model) {
  const simulation::Variation variation = reports::VariationOfDrive(stage, sample.rng);
  const geometry::MassProperties mass = simulation::Varied(model.mass_properties, variation);
  const auto shapes = simulation::Varied(model.collisions, variation);
  for (const reports::LoadDrive& drive : sample.drives) {
    const Recording recording = Record(stage, drive, sample.rng);
    if (recording.fell) return true;  // what the base did afterwards was not recorded
    const Pose3 X_BO = recording.X_MB.front().Inverse() * recording.X_MO;
    double foot = HUGE_VAL, friction = HUGE_VAL;
    for (const geometry::Collision& shape : shapes) {
      foot = std::min(foot, geometry::BoundsOf(shape.shape, X_BO * shape.X_BS).lower.z());
      friction = std::min(friction, shape.friction);
    }
    friction = std::min(friction, FrictionBelow(*stage.scene, X_BO, foot));
    benchmark_support::MujocoScene scene(mass, shapes, friction, foot, recording.X_MB.front(),
                                         recording.X_MO, Eigen::Vector3d::Zero());
    world::FallDetector detector(stage.setup->standing);
    const double step = stage.setup->physics.time_step;
    std::vector<Pose3> X_MB = recording.X_MB;
    const Pose3 on = X_MB.at(X_MB.size() - 2).Inverse() * X_MB.back();
    for (double time = 0.0; time < kAfter; time += step) X_MB.push_back(X_MB.back() * on);
    for (std::size_t i = 1; i < X_MB.size(); ++i) {
      scene.Move(X_MB[i - 1], X_MB[i], step);
      if (i % 5 == 0) detector.Update(scene.X_WB(), false, i * step, X_MB[i]);
      if (detector.falls() > 0) return true;
    }
  }
  return false;
}

int Run(char** argv) {
  const imagination::SetupConfig config = ConfigOf(argv[1]);
  const imagination::ImaginationSetup setup = imagination::LoadImaginationSetup(config);
  reports::LimitsRequest request;
  request.objects = {argv[2]};
  request.check_truths = std::atoi(argv[3]);
  request.seed = std::strtoull(argv[4], nullptr, 10);
  request.is_controller_assumed = robot::IsMotionAssumed(config.robot);
  std::vector<reports::CheckSample> samples;
  request.on_check = [&](const reports::CheckSample& sample) { samples.push_back(sample); };
  base::Crew crew;
  crew.threads = std::atoi(argv[5]);
  const auto report = reports::FindLimits(request, setup, crew);
  const reports::DriveStage stage =
      reports::MakeDriveStage(setup, request.objects, request.command_period);
  const auto model = setup.scene->world.RequireModel(setup.ModelOf(request.objects.front()));
  std::vector<char> fell(samples.size());
  const int num_tasks = static_cast<int>(samples.size());
  base::DoInParallel(num_tasks, num_tasks, crew, [&](int task, const base::Advance& advance) {
    fell[task] = FallsInMujoco(stage, samples[task], *model) ? 1 : 0;
    advance(1.0);
  });
  std::map<std::string, int> falls;
  for (int i = 0; i < num_tasks; ++i) falls[samples[i].motion] += fell[i];
  nlohmann::ordered_json json = reports::ToJson(*report);
  for (auto& limit : json["limits"]) limit["mujoco_falls"] = falls[limit["motion"]];
  reports::WriteJson(json, argv[6]);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 7) {
    std::cerr
        << "usage: reports_limits_in_mujoco ROBOT.yaml OBJECT SAMPLES SEED THREADS OUT.json\n";
    return 2;
  }
  try {
    return Run(argv);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
}
