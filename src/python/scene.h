#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hires/imagination/imagination.h"
#include "python/answer.h"

namespace hires::python {

/// What a scene is made of; what is empty is as the configuration says.
struct SceneFiles {
  std::string config;  ///< as config/imagination_client.yaml
  std::string world, map, robot, catalogue, uncertainty;
  std::vector<std::string> objects;                    ///< files of models beside the catalogue's
  std::map<std::string, std::array<double, 3>> areas;  ///< x, y [m], yaw [rad]
  std::vector<std::string> area_files;                 ///< YAML of goals or waypoints
  std::vector<std::string> actions;                    ///< shared libraries
};

/// Where an action begins. Objects are named as on the command line: an instance, a model, or a
/// file
/// (.sdf, .urdf, .yaml), which is loaded when it is named first.
struct StartOfAction {
  std::string robot_at;                              ///< area
  std::vector<std::string> on_tray;                  ///< objects
  std::vector<std::string> facts;                    ///< "Holding(rightArm1, mug1)"
  std::map<std::string, std::array<double, 4>> put;  ///< x, y, z [m], yaw [rad] in the map
};

/// How it is imagined; zeros stand for what the configuration says.
struct Request {
  int rollouts{0};
  std::uint64_t seed{1};
  int threads{0};  ///< 0: one per core
  double deadline{0.0};
  std::string ranking;
  double min_success{0.0};
  bool early_stop{true};
  double max_regret{0.0};  ///< [s]
};

/// World, robot and objects, loaded once for many requests, from any number of threads.
class Scene {
 public:
  using Cancelled = std::function<bool()>;

  /// @throws base::ConfigError naming file, element and remedy.
  explicit Scene(const SceneFiles& files);

  std::vector<std::string> Areas() const;
  std::vector<std::string> Objects() const;
  /// Speed [m/s] and acceleration [m/s^2] by name.
  std::map<std::string, std::pair<double, double>> MotionSets() const;

  /// One more way to drive [m/s], [m/s^2], [rad/s], [rad/s^2], for requests that come after.
  /// @throws base::ConfigError for a name that is taken, and for what the base's controller would
  /// clip.
  void AddMotionSet(const std::string& name, double speed, double acceleration, double turn_speed,
                    double turn_acceleration);

  /// @throws base::ConfigError saying what cannot be played, and why.
  Answer Imagine(const StartOfAction& start, const base::ActionTemplate& action,
                 const Request& request, const Cancelled& cancelled) const;

  /// Nothing if it was cancelled.  @throws base::ConfigError as Imagine.
  std::optional<imagination::RolloutRecording> Record(const StartOfAction& start,
                                                      const base::ActionCall& action, int rollout,
                                                      std::uint64_t seed,
                                                      const Cancelled& cancelled) const;

 private:
  imagination::RolloutSetup SetupOf(const StartOfAction& start, std::uint64_t seed) const;
  /// What requests call an object that may be given by its file, which is loaded then.
  std::string NameOf(const std::string& object) const;
  StartOfAction Named(StartOfAction start) const;
  /// The files of objects among an action's arguments, by their names.
  base::ActionTemplate OfOwnObjects(base::ActionTemplate action) const;
  void Load() const;  ///< @pre mutex_ is locked, or nobody else knows this

  imagination::ClientConfig config_;
  // Requests read in other threads what add_motion_set and own objects change. Held by pointer, so
  // that a scene moves.
  std::unique_ptr<std::mutex> mutex_{std::make_unique<std::mutex>()};
  mutable SceneFiles files_;
  mutable std::map<std::string, std::string> own_names_;  // of objects, by file as given
  std::map<std::string, robot::MotionSet> own_sets_;      // by name in lower case
  mutable imagination::ImaginationSetup setup_;
};

}  // namespace hires::python
