// Limits of the simulator and of MuJoCo for boxes that are moved obliquely, and for other bodies
// that slide and tip: no planar oracle covers a box that tips over a corner.
//
//   physics_friction_peers [--all]
//
// A table in Markdown: both limits and their difference, for each body, friction, heading and
// motion. Ends with 1 where they differ by more than 5 %.
#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <iostream>

#include "mujoco_scene.h"
#include "physics/friction_grid.h"

namespace {

using namespace hires;                // NOLINT
using namespace hires::test_support;  // NOLINT

constexpr double kHeight = 0.1;  // [m] of the center of mass
constexpr double kGoal = 0.05;

bool StaysInMujoco(const GridBody& body, double friction, const PlateMotion& motion, double yaw) {
  constexpr double kSettle = 0.2, kPeriod = 1e-3, kLongest = 4.0;  // [s]
  const auto pose = [&](double time) {
    const PlatePose plate = motion.pose(time);
    geometry::Pose3 X_WP;
    X_WP.translation = {plate.x, 0.0, plate.z};
    X_WP.rotation = Eigen::AngleAxisd(plate.pitch, Eigen::Vector3d::UnitY());
    return X_WP;
  };
  geometry::Pose3 X_PB;
  X_PB.rotation = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ());
  benchmark_support::MujocoScene scene(body.mass, body.shapes, friction, 0.0, pose(-kSettle),
                                       pose(-kSettle) * X_PB, {motion.start_speed, 0.0, 0.0});
  const double balance =
      std::atan2(body.planar.b * (yaw == 0.0 ? 1.0 : std::sqrt(2.0)), body.planar.c);
  Eigen::Vector3d start = Eigen::Vector3d::Zero();
  for (long i = -std::lround(kSettle / kPeriod); i * kPeriod < motion.end + kLongest; ++i) {
    if (i == 0) start = (pose(0.0).Inverse() * scene.X_WB()).translation;
    scene.Move(pose(i * kPeriod), pose((i + 1) * kPeriod), kPeriod);
    if (i < 0) continue;
    const geometry::Pose3 now = pose((i + 1) * kPeriod).Inverse() * scene.X_WB();
    if (geometry::TiltOf(now.rotation) > balance + 0.25) return false;
    if ((now.translation - start).head<2>().norm() > kMostSlide) return false;
  }
  return true;
}

/// The first value at which it does not stay, from 0.4 times a guess on; 0: it stays up to 8 times.
double Limit(double guess, const std::function<bool(double)>& stays) {
  double upper = 0.4 * guess;
  while (upper < 8.0 * guess && stays(upper)) upper *= 1.1;
  if (upper >= 8.0 * guess) return 0.0;
  double lower = upper / 1.1;
  while (upper / lower > 1.004) {
    const double middle = std::sqrt(lower * upper);
    (stays(middle) ? lower : upper) = middle;
  }
  return upper;
}

}  // namespace

int main(int argc, char** argv) {
  const bool all = argc > 1 && std::strcmp(argv[1], "--all") == 0;
  double largest = 0.0;
  std::cout
      << "| body | b/c | friction | heading [deg] | motion | simulator | MuJoCo | difference |\n"
         "|---|---|---|---|---|---|---|---|\n";
  for (const double ratio :
       all ? std::vector<double>{0.1, 0.2, 0.33, 0.5, 0.9} : std::vector<double>{0.33}) {
    for (const double friction :
         all ? std::vector<double>{0.1, 0.4, 0.6, 0.9, 3.0} : std::vector<double>{0.4, 0.9}) {
      const GridBody body = MakeGridBody("box", ratio, kHeight, friction);
      for (const int degrees : all ? std::vector<int>{0, 15, 30, 45} : std::vector<int>{20, 45}) {
        const double yaw = degrees * geometry::kPi / 180.0;
        for (const GridMotion& motion : GridMotions()) {
          const auto planar = FindOracleLimit(body.planar, friction, motion);
          if (!planar.value) continue;
          const double ours = Limit(*planar.value, [&](double value) {
            return GridScene(body, friction, motion.at(value), 0.0, yaw).Play() ==
                   PlanarVerdict::kStays;
          });
          const double mujoco = Limit(*planar.value, [&](double value) {
            return StaysInMujoco(body, friction, motion.at(value), yaw);
          });
          const bool both = ours > 0.0 && mujoco > 0.0;
          const double difference = both ? ours / mujoco - 1.0 : 0.0;
          largest = std::max(largest, both ? std::abs(difference) : ours == mujoco ? 0.0 : 1.0);
          std::cout << fmt::format("| box | {} | {} | {} | {} | {:.4g} | {:.4g} {} | {:+.1f} % |\n",
                                   ratio, friction, degrees, motion.name, ours, mujoco, motion.unit,
                                   100.0 * difference)
                    << std::flush;
        }
      }
    }
  }
  std::cout << fmt::format("\nlargest difference: {:.1f} %\n", 100.0 * largest);
  return largest > kGoal ? 1 : 0;
}
