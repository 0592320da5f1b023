#include "lab/src/experiment/places.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hires/geometry/angles.h"
#include "hires/geometry/covariance.h"
#include "hires/imagination/evidence.h"

namespace hires::lab {
namespace {

constexpr double kRate = 20.0;     // [Hz] of moments
constexpr double kInside = 5.991;  // 95 % of chi squared with two degrees of freedom

/// What all moments have in common.
struct Summary {
  explicit Summary(const PlaceTrail& moments) {
    if (moments.empty()) return;
    std::vector<double> distances, yaws;
    double squares = 0.0;
    int num_inside = 0;
    for (const PlaceMoment& moment : moments) {
      distances.push_back(moment.off().norm());
      yaws.push_back(std::abs(geometry::WrapToPi(moment.X_MBelieved.yaw - moment.X_MB.yaw)));
      squares += distances.back() * distances.back();
      num_inside += moment.is_inside;
    }
    const double n = static_cast<double>(moments.size());
    inside = num_inside / n;
    rms = std::sqrt(squares / n);
    std::sort(distances.begin(), distances.end());
    std::sort(yaws.begin(), yaws.end());
    distance = {imagination::Quantile(distances, 50), imagination::Quantile(distances, 95),
                distances.back()};
    yaw = {imagination::Quantile(yaws, 50), imagination::Quantile(yaws, 95), yaws.back()};
  }

  struct Spread {
    double median{NAN}, most{NAN}, largest{NAN};  // `most`: 95 %
  };
  Spread distance, yaw;
  double rms{NAN}, inside{NAN};
};

}  // namespace

PlaceMoment MomentOf(const simulation::SelfLocaliser& localiser, const skills::LostParams& lost) {
  const localisation::PoseEstimate estimate = localiser.Estimate();
  const geometry::Pose2& X_MB = localiser.X_MBtrue();
  const Eigen::Vector2d off = estimate.X_MB.position() - X_MB.position();
  const Eigen::LDLT<Eigen::Matrix2d> covariance(estimate.covariance.topLeftCorner<2, 2>());
  const double squared = off.dot(covariance.solve(off));
  const bool is_inside = covariance.isPositive() && covariance.rcond() > 0.0 && squared <= kInside;
  const Eigen::Matrix3d& P = estimate.covariance;
  const bool is_sure = geometry::LargestSd(P(0, 0), P(0, 1), P(1, 1)) <= lost.max_position_sd;
  return {X_MB, estimate.X_MB, localiser.X_OB(), is_inside, !is_sure};
}

TextTable PlaceTable(const PlaceTrail& moments) {
  const Summary all(moments);
  const auto spread = [](const Summary::Spread& of, const char* unit) {
    return std::vector<std::string>{fmt::format("{:.3f} {}", of.median, unit),
                                    fmt::format("{:.3f} {}", of.most, unit),
                                    fmt::format("{:.3f} {}", of.largest, unit)};
  };
  std::vector<std::string> position = spread(all.distance, "m"), yaw = spread(all.yaw, "rad");
  position.insert(position.begin(), "position");
  yaw.insert(yaw.begin(), "heading");
  position.push_back(fmt::format("{:.3f} m", all.rms));
  yaw.emplace_back("");
  position.push_back(fmt::format("{:.1f} %", 100.0 * all.inside));
  yaw.emplace_back("");
  return {fmt::format("How far off the robot took itself to be, {} moments", moments.size()),
          {{"", "median", "95 %", "largest", "rms", "in the 95 % ellipse"}, position, yaw}};
}

std::vector<Measure> PlaceMeasures(const PlaceTrail& moments) {
  const Summary all(moments);
  return {{"place_median", all.distance.median},   {"place_95", all.distance.most},
          {"place_largest", all.distance.largest}, {"place_rms", all.rms},
          {"place_yaw_largest", all.yaw.largest},  {"place_inside", all.inside}};
}

void LostTally::Add(const PlaceTrail& drive) {
  ++num_drives_;
  num_moments_ += static_cast<long>(drive.size());
  std::optional<std::size_t> first_wrong, last_wrong;
  bool is_noticed = false;
  for (std::size_t i = 0; i < drive.size(); ++i) {
    const PlaceMoment& moment = drive[i];
    const bool is_wrong = moment.off().norm() > kElsewhere;
    num_lost_ += moment.is_lost;
    num_wrong_and_sure_ += is_wrong && !moment.is_lost;
    if (is_wrong && !first_wrong) first_wrong = i;
    if (is_wrong) last_wrong = i;
    is_noticed = is_noticed || (first_wrong && moment.is_lost);
  }
  if (!first_wrong) return;
  ++num_astray_;
  num_noticed_ += is_noticed;
  const bool is_right = *last_wrong + 1 < drive.size();
  if (is_right) until_found_.push_back(static_cast<double>(*last_wrong + 1 - *first_wrong) / kRate);
  num_found_ += is_right && !drive.back().is_lost;
  num_deceived_ += !is_right && !drive.back().is_lost;
}

TextTable LostTally::Table() const {
  const auto share = [&](long count) {
    return fmt::format("{:.1f} %", num_moments_ > 0 ? 100.0 * count / num_moments_ : NAN);
  };
  std::vector<double> sorted = until_found_;
  std::sort(sorted.begin(), sorted.end());
  const std::string times =
      sorted.empty()
          ? ""
          : fmt::format("{:.1f} / {:.1f} s", imagination::Quantile(sorted, 50), sorted.back());
  return {
      fmt::format("Drives on which the robot took itself to be elsewhere, {:g} m or more off; "
                  "lost: it stood or looked around",
                  kElsewhere),
      {{"drives", "astray", "noticed", "found", "deceived", "until found, median / longest", "lost",
        "wrong and sure"},
       {fmt::format("{}", num_drives_), fmt::format("{}", num_astray_),
        fmt::format("{}", num_noticed_), fmt::format("{}", num_found_),
        fmt::format("{}", num_deceived_), times, share(num_lost_), share(num_wrong_and_sure_)}}};
}

std::vector<Measure> LostTally::Measures() const {
  const double moments = static_cast<double>(num_moments_);
  return {{"astray", static_cast<double>(num_astray_)},
          {"noticed", static_cast<double>(num_noticed_)},
          {"found", static_cast<double>(num_found_)},
          {"deceived", static_cast<double>(num_deceived_)},
          {"lost_share", static_cast<double>(num_lost_) / moments},
          {"wrong_and_sure_share", static_cast<double>(num_wrong_and_sure_) / moments}};
}

}  // namespace hires::lab
