#include "localisation/odometry_units.h"

#include <fmt/format.h>

#include <cmath>

#include "base/averages.h"
#include "hires/geometry/angles.h"
#include "hires/geometry/pose.h"
#include "hires/robot/odometry_jump.h"

namespace hires::localisation {
namespace {

constexpr double kLeastMove = 1e-6;   // of any unit
constexpr double kSlackOfTurn = 0.1;  // [rad] for rounding and slip
constexpr double kOneCircle = 2.0 * geometry::kPi, kNearCircle = 1.0;  // [rad]
constexpr std::size_t kFew = 20;      // moves or turns that tell nothing
constexpr double kIndoorSpeed = 0.5;  // [m/s]

}  // namespace

void OdometryUnits::Take(double x, double y, double theta, double time) {
  const std::optional<Reading> last = last_;
  last_ = {x, y, theta, time};
  if (!last || time <= last->time) return;
  const double passed = time - last->time;
  const geometry::Pose2 move{x - last->x, y - last->y, 0.0};
  const double length = move.position().norm();
  if (length > kLeastMove) {
    speeds_.push_back(length / passed);
    num_too_fast_ += robot::IsOdometryJump(move, time_of_moves_.For(passed), robot::kFastestDrive,
                                           robot::kFastestTurn);
  }
  time_of_moves_.Take(passed, length / robot::kFastestDrive);
  // Not as a pose, which would wrap it; what looks like a leap by one turn is none.
  double turn = std::abs(theta - last->theta);
  if (std::abs(turn - kOneCircle) < kNearCircle) turn = std::abs(turn - kOneCircle);
  turned_ += turn;
  const bool is_slow = turn <= robot::kFastestTurn * time_of_turns_.For(passed) + kSlackOfTurn;
  time_of_turns_.Take(passed, turn / robot::kFastestTurn);
  if (is_slow) return;
  turned_too_fast_ += turn;
  ++num_too_fast_turns_;
}

std::string OdometryUnits::Doubt() const {
  if (speeds_.size() >= kFew && 2 * num_too_fast_ > static_cast<int>(speeds_.size())) {
    const double speed = base::Median(speeds_);
    const auto distance = [&](double unit) {
      return std::abs(std::log(speed / unit / kIndoorSpeed));
    };
    const bool is_centimetres = distance(100.0) < distance(1000.0);
    return fmt::format(
        "odometry moves at {:.0f} a second in the median, wanted metres: is it in {}? Divide x and "
        "y by {}",
        speed, is_centimetres ? "centimetres" : "millimetres", is_centimetres ? 100 : 1000);
  }
  if (num_too_fast_turns_ >= static_cast<int>(kFew) && 2.0 * turned_too_fast_ > turned_) {
    return fmt::format(
        "{} turns of the odometry, {:.0f} % of all its turning, are faster than {:g} rad/s, wanted "
        "radians: is theta in degrees? Multiply it by 0.0174533",
        num_too_fast_turns_, 100.0 * turned_too_fast_ / turned_, robot::kFastestTurn);
  }
  return "";
}

}  // namespace hires::localisation
