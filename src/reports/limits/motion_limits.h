#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "hires/base/rng.h"
#include "hires/imagination/imagination_setup.h"
#include "reports/limits/given_limits.h"
#include "reports/limits/load_drive.h"
#include "reports/limits/payload_support.h"

// How fast, how suddenly and how sharply a robot may drive so that what stands on its tray stays
// there. docs/notes_limits.md says how it is found and what it was compared with.
namespace hires::reports {

/// A new sample that is played at a limit: all of its drives must keep the payload.
struct CheckSample {
  std::string motion;
  std::vector<LoadDrive> drives;
  base::Rng rng;  ///< of PlayDrive
};

/// What is looked for.
struct LimitsRequest {
  /// Together on the tray (as imagination::StartOnTray): instances of the catalogue, or models.
  std::vector<std::string> objects;
  bool is_controller_assumed{false};  ///< no file says what the base can do
  double max_fall{0.01};              ///< share of drives that may lose it, in (0, 1)
  double command_period{0.1};         ///< [s] between two velocities that a local planner commands
  std::uint64_t seed{1};
  int check_truths{0};  ///< new ones to play at each limit, and 10 % above
  /// Called with each new sample at a limit, to play it elsewhere; may be empty.
  std::function<void(const CheckSample&)> on_check{};
};

/// How often new truths lose the load.
struct LimitCheck {
  int falls_at{0};                 ///< at the limit
  std::optional<int> falls_above;  ///< at 1.1 times the limit, where the base can do that
};

/// What is known of a motion before anything is played.
struct MotionBounds {
  std::string motion;       ///< speed, acceleration, deceleration, turning, together
  std::string unit;         ///< "m/s"; of `together` none: it is a share of the others
  double robots_own{0.0};   ///< limit of the base's controller; nothing above is looked at
  double closed_form{0.0};  ///< for the model as it is, on an even floor; infinite: no limit
  std::string stated;       ///< what the closed form speaks of: "tips", "slides", ...
};

/// Closed forms of hazards that the simulated limits do not cover.
struct HazardLimits {
  std::vector<MotionBounds> bounds;   ///< "robot tips, acceleration", "liquid reaches rim", ...
  std::vector<std::string> left_out;  ///< hazards that nothing is known of
  double MostAcceleration() const;    ///< [m/s^2] the least of them; infinite: none
};

/// Closed forms of speed, acceleration, deceleration and turning, in this order.
struct ClosedForms {
  std::vector<PayloadSupport> payloads;
  std::vector<std::vector<MotionBounds>> of_each;  ///< of the payloads, in their order
  std::vector<MotionBounds> weakest;               ///< of each motion the least of them
};

/// One motion, as far as it may go.
struct MotionLimit : MotionBounds {
  double value{0.0};  ///< largest on a scale of steps of 3 % at which nothing fell
  double slide{0.0};  ///< [m] the largest of all truths at that value, in one step of a drive
  std::optional<LimitCheck> check;
};

/// A speed found with a smaller slide as failure.
struct CarefulSpeed {
  double slide{0.02};           ///< [m]
  std::optional<double> value;  ///< [m/s]; none down to a 30th of the limit
};

/// What was found.
struct LimitsReport {
  LimitsRequest request;
  std::vector<std::string> models;  ///< of the objects
  std::string robot;
  std::string uncertainty;          ///< "none", or hash of what was drawn from
  int num_truths{0};                ///< at none of them it falls below the limits
  std::vector<MotionLimit> limits;  ///< the last one is `together`
  std::uint64_t world_hash{0}, robot_hash{0}, physics_hash{0};
  bool is_omnidirectional{false};
  int num_directions{2};  ///< of driving, evenly around; each truth drives into one of them
  double max_slide{0.1};  ///< [m] on the tray; more counts as a failure
  std::optional<CarefulSpeed> careful;   ///< where max_slide is larger than its slide
  double min_turning_radius{0.0};        ///< [m] of a car-like base; 0: it turns on the spot
  double own_angular_acceleration{0.0};  ///< [rad/s^2] at which the base begins and ends to turn
  std::vector<std::string> assumed{};    ///< of the robot, as Robot::assumed
  std::vector<PayloadSupport> payloads{};
  HazardLimits hazards{};  ///< of the robot's own tipping and the object's liquid
  double simulated_seconds{0.0};
  double wall_seconds{0.0};  ///< set by who asked; 0: unknown

  const MotionLimit& Of(const std::string& motion) const;
  double gravity{9.81};  ///< [m/s^2]
  /// [m/s^2] mu g of the most slippery payload.
  double SlidingAcceleration() const;
};

/// How many truths of which none may lose the load: the smallest n with (1 - max_fall)^n <= 0.05.
/// The largest value that all n bear is then, with 95 % confidence, borne by at least 1 - max_fall
/// of all truths (of the mix of directions that is played), whatever they are distributed like
/// [Wilks 1941, Ann. Math. Stat. 12:91-96]. Each motion has truths of its own.
int NumTruths(double max_fall);

/// Nothing is simulated. A base tips its payload in the directions in which it drives: forward and
/// backward, or any (the weakest counts); turning acts as the payload's place on the tray says. A
/// sudden stop lets it topple, or slide for `setup.standing.slide`: v = sqrt(2 s mu g).
/// @throws base::ConfigError as SupportsOnTray(), and for a controller that moves nothing.
ClosedForms ClosedFormLimits(const std::vector<std::string>& objects,
                             const imagination::ImaginationSetup& setup);

/// Where the robot with the object on its tray begins to tip: acceleration, deceleration, and
/// turning at the controller's own speed (simulation::RobotBalance); and the acceleration that
/// brings the object's liquid to its rim (imagination::SpillingAcceleration).
/// @throws base::ConfigError: no such object.
HazardLimits FindHazardLimits(const std::vector<std::string>& objects,
                              const imagination::ImaginationSetup& setup);

/// Looks for limits of all motions. The same bits for any number of threads.
/// @param setup  whose world only lends its gravity: the floor is empty.
/// @return nothing when it was cancelled.
/// @throws base::ConfigError as ClosedFormLimits(), and for an object that falls while the robot
/// stands still or drives at a 30th of what its controller allows.
std::optional<LimitsReport> FindLimits(const LimitsRequest& request,
                                       const imagination::ImaginationSetup& setup,
                                       const base::Crew& crew);

/// How one payload bears one given limit.
struct GivenVerdict {
  std::string object;
  MotionBounds bounds;  ///< closed form of this payload; of `together` none
  double value{0.0};    ///< what was played; of `together` 1
  std::string source;   ///< "given", or "robot's own" where that is smaller or the file has none
  int falls{0};         ///< of num_truths
  double slide{0.0};    ///< [m] the largest
  bool survives() const { return falls == 0; }
};
struct GivenReport {
  LimitsRequest request;
  std::string robot;
  int num_truths{0};
  double max_slide{0.1};               ///< [m]
  double sliding_acceleration{0.0};    ///< [m/s^2] mu g of the most slippery payload
  std::vector<GivenVerdict> verdicts;  ///< motion by motion, the payloads in their order
};

/// Plays the drives of FindLimits() at given limits instead of looking for some, until all payloads
/// fell or all is quiet.
/// @return nothing when it was cancelled.  @throws base::ConfigError as ClosedFormLimits().
std::optional<GivenReport> CheckGivenLimits(const LimitsRequest& request,
                                            const imagination::ImaginationSetup& setup,
                                            const GivenLimits& given, const base::Crew& crew);

/// For people: a table, and which keys of the file it rests on.
std::string GivenText(const GivenReport& report, const GivenLimits& given);
/// One row for each verdict; a head first.
std::string GivenCsv(const GivenReport& report);

/// For people: the closed forms beside what the base's controller allows, and overhangs.
/// @param is_assumed  no file says what that controller allows.
std::string ClosedFormText(const ClosedForms& forms, bool is_assumed);
/// For people: a table, and what it rests on.
std::string LimitsText(const LimitsReport& report);
/// To be pasted: the parameters of move_base's DWAPlannerROS, or for a car-like base
/// TebLocalPlannerROS, which plans with a turning radius; all motions together.
std::string LimitsYaml(const LimitsReport& report);
nlohmann::ordered_json ToJson(const LimitsReport& report);

}  // namespace hires::reports
