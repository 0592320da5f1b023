#pragma once

#include <Eigen/Core>
#include <array>
#include <map>
#include <string>

#include "hires/base/rng.h"
#include "hires/perception/line_of_sight.h"

namespace hires::perception {

/// What tells how well a recogniser does with a thing.
struct ThingInView {
  VisiblePart part{};                                   ///< that the camera sees
  double distance{1.5};                                 ///< [m] from the camera to the thing's foot
  double elevation{0.6};                                ///< [rad] of the camera above the thing
  Eigen::Vector3d box{Eigen::Vector3d::Constant(0.1)};  ///< [m] of the thing, along its own axes
  double gap{1.0};  ///< [m] to the nearest other thing in sight, from above
};

/// The thing at `index` of `objects`; the others are its neighbours.
/// @param part  what is seen of it.  @pre sight knows all objects.
ThingInView LookAtThing(const LineOfSight& sight, const CameraView& view,
                        const std::vector<world::ObjectState>& objects, std::size_t index,
                        const VisiblePart& part);

/// Columns: away from the camera and level, level across, up; in the frame of p_C and up_C.
/// @param p_C   where something is, seen from the camera.  @param up_C  of length 1.
Eigen::Matrix3d SightFrame(const Eigen::Vector3d& p_C, const Eigen::Vector3d& up_C);

/// What a regression stands on, all about 0 for a thing of 400 points, 1.5 m away, seen from 0.6
/// rad above it, 0.1 m high, alone and not hidden.
inline constexpr std::array<const char*, 7> kRegressorNames{
    "constant",   // 1
    "size",       // log10 of what is seen of it, in 0.0012 sr (400 pixels of 640 x 480)
    "hidden",     // share of its surface towards the camera that is not seen
    "distance",   // log2 of the distance, in 1.5 m
    "elevation",  // [rad] above 0.6
    "height",     // log10 of its height, in 0.1 m
    "crowding"};  // 0 where the next thing is 0.05 m away or more, 1 where it touches
using Regressors = Eigen::Matrix<double, 7, 1>;
Regressors RegressorsOf(const ThingInView& view);

struct Regression {
  Regressors weight{Regressors::Zero()};
  Regressors error{Regressors::Zero()};  ///< standard errors of the weights
  /// Share of looks in which chance falls as it always does for a thing, so that one who looks
  /// again errs again.
  double repeats{0.0};

  double At(const ThingInView& view) const { return weight.dot(RegressorsOf(view)); }
};

/// How far off poses are: the length's logarithm is normal.
struct LengthRegression {
  Regression log;      ///< of [m] or [rad]
  double spread{0.0};  ///< sd of the logarithm
};

/// How a recogniser errs, as it was found by trying it (`hires_lab experiment detector`).
struct DetectorErrors {
  Regression found;  ///< log odds
  Regression named;  ///< log odds that what is found is called rightly
  /// What kinds were called instead, how often; a kind that is not here becomes unknown.
  std::map<std::string, std::map<std::string, int>> called;
  double confidence{1.0};  ///< mean, in a wrong name
  double doubt{0.0};       ///< ... and in what it really is
  LengthRegression position;
  /// Along SightFrame's columns: variances, with the sum 1, of the normal vector that has the
  /// error's direction.
  Eigen::Vector3d direction{Eigen::Vector3d::Constant(1.0 / 3.0)};
  LengthRegression turn;  ///< about the thing's z axis
};

/// How one look errs with one thing.
struct Misjudgement {
  bool is_missed{false};
  std::string called{};                             ///< empty: what it is
  Eigen::Vector3d offset{Eigen::Vector3d::Zero()};  ///< [m] along SightFrame's columns
  double turn{0.0};                                 ///< [rad]
};

/// @param model    of the thing, a key of `called`.
/// @param factor   of the shares of mistakes and of lengths: 0 never errs, 1 as it was found.
/// @param look     chance of this look.  @param thing  the same at every look at this thing.
Misjudgement Misjudge(const DetectorErrors& errors, const std::string& model,
                      const ThingInView& view, double factor, base::Rng look, base::Rng thing);

/// Reads a file like config/detector.yaml.  @throws base::ConfigError naming file, key and line.
DetectorErrors ReadDetectorErrors(const std::string& path);

/// As that file has it, but for its head.
std::string ToYaml(const DetectorErrors& errors);

}  // namespace hires::perception
