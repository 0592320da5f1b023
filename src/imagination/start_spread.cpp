#include "hires/imagination/start_spread.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/geometry/angles.h"

namespace hires::imagination {
namespace {

constexpr double kSamePlace = 0.25;    // [m]
constexpr double kSameHeading = 0.55;  // [rad]
constexpr double kLost = 1.0;          // [m]
constexpr double kLostYaw = 3.2;       // [rad]

YAML::Node Normal(double sd, const char* unit) {
  YAML::Node node;
  node["distribution"] = "normal";
  node["mean"] = "0";
  node["sd"] = fmt::format("{}", sd);
  node["unit"] = unit;
  node["source"] = "covariance of the localisation where the robot stands";
  return node;
}

double DeviationOf(double variance, double most, const char* what, const std::string& where) {
  const double sd = std::sqrt(variance);
  if (sd <= most) return sd;  // false for what is no number, too
  throw base::ConfigError(
      fmt::format("{}: variance of {} is {:g}, wanted 0 to {:g}; the robot is lost, tell its "
                  "localisation where it is",
                  where, what, variance, most * most));
}

/// Of a covariance that is one; else none, so that what is drawn is at least as wide.
PoseCorrelation CorrelationOf(const Eigen::Matrix3d& covariance) {
  constexpr double kRounding = 1e-9;
  const Eigen::Vector3d sd = covariance.diagonal().cwiseSqrt();
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < row; ++column) {
      if (sd[row] <= 0.0 || sd[column] <= 0.0) continue;
      matrix(row, column) = matrix(column, row) =
          0.5 * (covariance(row, column) + covariance(column, row)) / (sd[row] * sd[column]);
    }
  }
  if (!matrix.allFinite()) return {};
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(matrix);
  if (solver.eigenvalues().minCoeff() < -kRounding) return {};
  return {matrix(0, 1), matrix(0, 2), matrix(1, 2)};
}

}  // namespace

StartSpread SpreadOf(const BelievedPose& believed, const std::string& where) {
  Eigen::Matrix3d R_BM = Eigen::Matrix3d::Identity();
  R_BM.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(-believed.X_MB.yaw).toRotationMatrix();
  const Eigen::Matrix3d covariance_B = R_BM * believed.covariance * R_BM.transpose();
  StartSpread spread{DeviationOf(covariance_B(0, 0), kLost, "x", where),
                     DeviationOf(covariance_B(1, 1), kLost, "y", where),
                     DeviationOf(covariance_B(2, 2), kLostYaw, "yaw", where),
                     {}};
  spread.correlation = CorrelationOf(covariance_B);
  return spread;
}

bool BeginsHere(const geometry::Pose2& X_MStart, const BelievedPose& believed) {
  return (X_MStart.position() - believed.X_MB.position()).norm() <= kSamePlace &&
         std::abs(geometry::WrapToPi(X_MStart.yaw - believed.X_MB.yaw)) <= kSameHeading;
}

Uncertainty WithStartSpread(const Uncertainty& uncertainty, const StartSpread& spread) {
  const std::array<std::pair<const char*, YAML::Node>, 6> replaced{{
      {"start_x", Normal(spread.x, "m")},
      {"start_y", Normal(spread.y, "m")},
      {"start_yaw", Normal(spread.yaw, "rad")},
      {"docked_x", Normal(std::min(spread.x, 0.4), "m")},  // what makes sense at all at furniture
      {"docked_y", Normal(std::min(spread.y, 0.4), "m")},
      {"docked_yaw", Normal(std::min(spread.yaw, 1.0), "rad")},
  }};
  if (uncertainty.yaml == "none") return uncertainty;
  YAML::Node yaml = YAML::Load(uncertainty.yaml);
  bool is_changed = false;
  for (const auto& [name, distribution] : replaced) {
    if (uncertainty.quantities.count(name) == 0) continue;
    yaml[name] = distribution;
    is_changed = true;
  }
  if (is_changed) yaml.remove("start_correlation");
  if (is_changed && !spread.correlation.is_none()) {
    const auto told = [](double value) {
      return fmt::format("{}", std::min(1.0, std::max(-1.0, value)));
    };
    YAML::Node correlation;
    correlation["x_y"] = told(spread.correlation.x_y);
    correlation["x_yaw"] = told(spread.correlation.x_yaw);
    correlation["y_yaw"] = told(spread.correlation.y_yaw);
    yaml["start_correlation"] = correlation;
  }
  if (!is_changed) return uncertainty;
  return ParseUncertainty(YAML::Dump(yaml), "uncertainty with the robot's start pose");
}

std::shared_ptr<const Uncertainty> UncertaintyFrom(std::shared_ptr<const Uncertainty> uncertainty,
                                                   const geometry::Pose2& X_MStart,
                                                   const std::optional<BelievedPose>& believed,
                                                   const std::string& where) {
  if (!believed || believed->covariance.isZero(0.0) || !BeginsHere(X_MStart, *believed))
    return uncertainty;
  const StartSpread spread = SpreadOf(*believed, where);
  base::Log(base::LogLevel::kInfo,
            fmt::format("start=here spread_x={:.3f} spread_y={:.3f} spread_yaw={:.3f}", spread.x,
                        spread.y, spread.yaw));
  return std::make_shared<const Uncertainty>(WithStartSpread(*uncertainty, spread));
}

}  // namespace hires::imagination
