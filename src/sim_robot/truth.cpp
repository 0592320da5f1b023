#include "sim_robot/truth.h"

#include <cmath>
#include <utility>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "imagination/uncertainty_layers.h"
#include "sim_robot/controller_changes.h"

namespace hires::sim_robot {
namespace {

using geometry::Pose2;
using imagination::Distribution;
using imagination::Uncertainty;
using simulation::Scene;

constexpr double kNearRobot = 1.0;  // [m]
constexpr double kLargestScore = 3.0;
constexpr const char* kOfSensors[] = {"detection_noise", "detection_noise_yaw",
                                      "recognition_errors", "scan_noise", "encoder_noise"};
constexpr const char* kOfLocalisation[] = {"localisation_x",         "localisation_y",
                                           "localisation_yaw",       "localisation_noise",
                                           "localisation_noise_yaw", "ghost_rate"};

bool ChangesWhatIsDrawn(const Truth& truth) {
  return truth.uncertainty || !truth.changes.empty() || truth.sensing == Sensing::kIdeal ||
         truth.localisation != Localisation::kFitted;
}

Uncertainty UncertaintyOf(const Truth& truth, const Uncertainty& imagined) {
  Uncertainty drawn =
      truth.uncertainty ? imagination::LaidOver(imagined, *truth.uncertainty) : imagined;
  for (const auto& [name, distribution] : truth.changes) drawn.quantities[name] = distribution;
  if (truth.sensing == Sensing::kIdeal) {
    for (const char* name : kOfSensors) drawn.quantities.erase(name);
  }
  if (truth.localisation != Localisation::kFitted) {
    for (const char* name : kOfLocalisation) drawn.quantities.erase(name);
  }
  return drawn;
}

bool ChangesTheScene(const Truth& truth) {
  return truth.stops_at_timeout || !truth.controller.empty() || !truth.floor.sills.empty() ||
         !truth.floor.patches.empty() || !truth.moved.empty() ||
         truth.localisation != Localisation::kFitted;
}

world::StaticBody* FindStatic(const Truth& truth, const std::string& name, world::World* world) {
  std::vector<std::string> names;
  for (world::StaticBody& body : world->statics) {
    if (body.name == name) return &body;
    names.push_back(body.name);
  }
  throw base::ConfigError("truth '" + truth.name +
                          "', events.moved: " + base::UnknownName("static body", name, names) +
                          "; a truth with furniture fits one world");
}

/// Nobody puts a chair onto a robot.
void MoveFurniture(const Truth& truth, const Pose2& X_MB, base::Rng rng, world::World* world) {
  for (const MovedBody& moved : truth.moved) {
    world::StaticBody* body = FindStatic(truth, moved.body, world);
    const bool is_moved = rng.Bernoulli(moved.probability);  // drawn whatever is near
    geometry::Pose3 X_MBody = body->X_MB;
    X_MBody.translation += Eigen::Vector3d(moved.by.x, moved.by.y, 0.0);
    X_MBody.rotation = geometry::RotationFromRpy(0.0, 0.0, moved.by.yaw) * X_MBody.rotation;
    const double away = (X_MBody.translation.head<2>() - X_MB.position()).norm();
    if (is_moved && away >= kNearRobot) body->X_MB = X_MBody;
  }
}

std::shared_ptr<const Scene> SceneOf(const Truth& truth, const Scene& imagined, const Pose2& X_MB,
                                     const base::Rng& rng) {
  world::World world = imagined.world;
  MoveFurniture(truth, X_MB, rng, &world);
  robot::Robot robot = imagined.robot;
  ChangeController(truth, &robot.profile.base_controller);
  auto scene = std::make_shared<Scene>(
      *simulation::MakeScene(std::move(world), std::move(robot), imagined.memory, imagined.sight));
  scene->floor = truth.floor;
  if (truth.localisation == Localisation::kFitted) {
    scene->self_localisation = imagined.self_localisation;
    scene->pose_error = imagined.pose_error;
  }
  if (truth.localisation != Localisation::kFilter) return scene;
  return simulation::FindingItsPlace(*scene, *truth.self_localisation, imagined.world);
}

double BoundedScore(base::Rng* rng) {
  for (;;) {
    const double score = rng->Normal(0.0, 1.0);
    if (std::abs(score) <= kLargestScore) return score;
  }
}

}  // namespace

Truth WithoutPlace(Truth truth, const std::string& path) {
  if (!truth.self_localisation) {
    truth.self_localisation = std::make_shared<const simulation::SelfLocalisationParams>(
        simulation::LoadSelfLocalisation(path));
  }
  truth.localisation = Localisation::kNothing;
  return truth;
}

std::string TruthNote(const std::string& name) {
  return name == Truth{}.name ? name + ": imagination's own model" : name;
}

imagination::ImaginationSetup SetupOf(const Truth& truth,
                                      const imagination::ImaginationSetup& imagined,
                                      const Pose2& X_MB, const base::Rng& rng) {
  imagination::ImaginationSetup setup = imagined;
  if (ChangesWhatIsDrawn(truth)) {
    setup.uncertainty =
        std::make_shared<const Uncertainty>(UncertaintyOf(truth, *imagined.uncertainty));
  }
  if (ChangesTheScene(truth)) setup.scene = SceneOf(truth, *imagined.scene, X_MB, rng);
  return setup;
}

simulation::Variation DrawVariation(const Truth& truth, const Uncertainty& uncertainty,
                                    const base::Rng& rng) {
  std::map<std::string, double> scores;
  for (const Correlation& pair : truth.correlations) {
    base::Hasher stream;
    stream.Add("scores of " + pair.first + " and " + pair.second);
    base::Rng own = rng.Fork(stream.value());
    const double common = BoundedScore(&own), alone = BoundedScore(&own);
    const double rest = std::sqrt(1.0 - pair.coefficient * pair.coefficient);
    scores[pair.first] = common;
    scores[pair.second] = pair.coefficient * common + rest * alone;
  }
  return imagination::SampleVariation(uncertainty, rng, imagination::Arrival::kDriven, scores);
}

}  // namespace hires::sim_robot
