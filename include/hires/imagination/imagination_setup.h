#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "hires/base/param_reader.h"
#include "hires/imagination/rollout.h"
#include "hires/imagination/start_state.h"
#include "hires/imagination/uncertainty.h"
#include "hires/physics/physics_world.h"
#include "hires/sensing/sensing_params.h"
#include "hires/simulation/scene.h"
#include "hires/skills/skill_factory.h"
#include "hires/translation/translator.h"
#include "hires/world/named_area.h"

namespace hires::imagination {

using world::NamedArea;

/// Which files and numbers a world to imagine in is made of: one YAML, config/scene.yaml. Relative
/// paths count from that file's folder.
struct SetupConfig {
  std::string world;             ///< SDF world
  std::string map;               ///< map_server YAML whose walls are the world instead; or empty
  std::vector<NamedArea> areas;  ///< beside those of the world
  std::string robot;             ///< robot profile (.yaml) or bare URDF (.urdf)
  std::string objects;           ///< catalogue of object instances (YAML)
  std::string uncertainty;       ///< YAML, or "none"
  /// YAML that lies over it, as far as it goes (see LaidOver); or empty.
  std::string uncertainty_over;
  std::string detector;    ///< how the camera's recogniser errs (YAML), or "none"
  std::string recogniser;  ///< that one itself (YAML), which then looks at pictures; or "none"
  /// What tells the robot of a rollout where it is: "drawn" (off as the uncertainty says), "fitted"
  /// (its error goes as `localisation_error` says), "filter" (itself, as `self_localisation` says).
  std::string localisation{"drawn"};
  std::string self_localisation, localisation_error;  ///< YAML; read where they are needed
  bool has_base_guard{false};              ///< late commands to the base end in the guard's ramp
  std::vector<std::string> extra_objects;  ///< object models (files) beside the catalogue's
  /// Shared libraries with more actions: never from a file, as they are code.
  std::vector<std::string> action_libraries;
  skills::MoveBaseParams driving;
  std::optional<simulation::ScanParams> scans;  ///< that drives go by, with an obstacle layer
  skills::MoveBaseBlindParams blind;
  skills::ManipulationParams manipulation;
  sensing::SensingParams sensing;
  physics::PhysicsParams physics;
  RolloutParams rollout;
  world::StandingCriterion standing;
  translation::ClassifyParams classify;
  std::uint64_t params_hash{0};  ///< of driving, blind, manipulation, sensing
  std::uint64_t layer_hash{0};   ///< of the obstacle layer's file; 0: there is none
};

/// @throws base::ConfigError naming file and key; also if the aftermath of a rollout ends before
/// the hold time of a fall does.
SetupConfig ReadSetupConfig(const std::string& path);

/// Has drives go by what the base's laser sees, as a file like config/obstacle_layer.yaml says;
/// "none": by the map alone.
/// @throws base::ConfigError naming file and key.
void SetObstacleLayer(const std::string& path, SetupConfig* config);

/// A path that stands in the file `config_path`: relative ones count from that file's folder.
std::string ResolvePath(const std::string& path, const std::string& config_path);

/// Puts other files in place of the configured ones; what is not given or empty stays. An
/// uncertainty lies over the configured one; "none" takes it away.
void OverridePaths(const std::optional<std::string>& world, const std::optional<std::string>& robot,
                   const std::optional<std::string>& objects,
                   const std::optional<std::string>& uncertainty, SetupConfig* config);

/// The uncertainty of these files, the one that lies over the other laid over it.
/// @throws base::ConfigError naming file, key and line.
Uncertainty LoadUncertaintyOf(const SetupConfig& config);

/// Everything constant that imagining needs, loaded once and shared by all requests.
struct ImaginationSetup {
  std::shared_ptr<const simulation::Scene> scene;
  std::shared_ptr<const skills::SkillSet> skills;
  std::shared_ptr<const Uncertainty> uncertainty;
  RolloutParams rollout;
  physics::PhysicsParams physics;
  sensing::SensingParams sensing;
  world::StandingCriterion standing;
  std::string catalogue;                             ///< file of objects, for messages
  std::map<std::string, std::string> object_models;  ///< instance (lower case) -> model
  translation::TranslatorContext translator;  ///< knows names of objects and areas; no fluents
  std::uint64_t world_hash{0};                ///< world, object models and all parameters of skills
  std::uint64_t robot_hash{0};
  std::uint64_t physics_hash{0};  ///< see PhysicsHash
  std::uint64_t actions_hash{0};  ///< of all actions, with the libraries that they came from

  /// The model of an instance of the catalogue (or of its kin, see
  /// translation::TranslatorContext::FindModel), or of an object model by its own name.
  /// @throws base::ConfigError with names like it.
  std::string ModelOf(const std::string& instance_or_model) const;
};

/// Whoever has no base laser drives by the map alone, whatever the obstacle layer says.
/// @throws base::ConfigError naming file, element and remedy.
ImaginationSetup LoadImaginationSetup(const SetupConfig& scene);

/// What the rollouts of a request share.
RolloutSetup MakeRolloutSetup(const ImaginationSetup& setup, const StartState& start,
                              std::uint64_t seed);

}  // namespace hires::imagination
