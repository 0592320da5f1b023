#include "reports/limits/motion_limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "base/parallel.h"
#include "hires/base/check.h"
#include "hires/base/error.h"
#include "hires/base/hash.h"
#include "hires/base/rng.h"
#include "hires/base/text.h"
#include "hires/geometry/angles.h"
#include "reports/limits/load_drive.h"

namespace hires::reports {
namespace {

using geometry::Twist2;

constexpr double kConfidence = 0.95;
constexpr double kStep = 0.97;        // of the scale of values
constexpr int kLastStep = 112;        // a 30th of the robot's own limit
constexpr double kAbove = 1.1;        // times a limit, where it is checked
constexpr int kFewTruths = 32;        // tell about where the limit lies
constexpr double kGently = 0.5;       // [m/s^2] nothing shakes
constexpr double kCruise = 0.5;       // [s]
constexpr double kTurningTime = 1.0;  // [s] at full rate

const DriveStep kSilence{{}, 0.0, 0.0, 0.0, true};

double ValueAt(double top, int step) { return top * std::pow(kStep, step); }

/// Which of the truths lose the load at a value; empty optional: cancelled.
using FallenAt =
    std::function<std::optional<std::vector<int>>(double value, const std::vector<int>& truths)>;

/// The search along the scale: a truth that bears a value bears every smaller one.
class Search {
 public:
  Search(double top, int num_truths, FallenAt fallen_at)
      : top_(top), all_(num_truths), fallen_at_(std::move(fallen_at)) {
    std::iota(all_.begin(), all_.end(), 0);
  }

  /// The first step at which no truth loses the load; kLastStep + 1: there is none.
  /// @return nothing when cancelled.
  std::optional<int> Run() {
    const std::vector<int> few(all_.begin(),
                               all_.begin() + std::min<std::size_t>(kFewTruths, all_.size()));
    const auto first = FirstBorneBy(few, 0);
    if (!first || *first > kLastStep) return first;
    auto step = FirstBorneBy(all_, *first);
    // Should a truth have lost at less what it kept at more, the scale is gone down further.
    while (step && *step <= kLastStep && *step > *first) {
      const auto fallen = fallen_at_(ValueAt(top_, *step), all_);
      if (!fallen) return std::nullopt;
      if (fallen->empty()) break;
      ++*step;
    }
    return step;
  }

 private:
  /// By halving, with the truths that have fallen so far alone.
  std::optional<int> FirstBorneBy(const std::vector<int>& truths, int first) const {
    auto fallen = fallen_at_(ValueAt(top_, first), truths);
    if (!fallen || fallen->empty()) return fallen ? std::optional<int>(first) : std::nullopt;
    int falls = first, bears = kLastStep + 1;
    while (bears - falls > 1) {
      const int middle = (falls + bears) / 2;
      auto still = fallen_at_(ValueAt(top_, middle), *fallen);
      if (!still) return std::nullopt;
      if (still->empty()) {
        bears = middle;
      } else {
        falls = middle;
        fallen = std::move(still);
      }
    }
    return bears;
  }

  const double top_;
  std::vector<int> all_;
  FallenAt fallen_at_;
};

/// How drives with a value look. The load has to bear each of them.
using Drives = std::function<std::vector<LoadDrive>(double value, double direction)>;

/// A motion to look at.
struct Motion : MotionBounds {
  Drives drives;
};

Twist2 Along(double direction, double speed, double turning = 0.0) {
  return {speed * std::cos(direction), speed * std::sin(direction), turning};
}

class LimitFinder {
 public:
  LimitFinder(const LimitsRequest& request, const imagination::ImaginationSetup& setup,
              const base::Crew& crew)
      : request_(request),
        setup_(setup),
        crew_(crew),
        controller_(setup.scene->robot.profile.base_controller),
        forms_(ClosedFormLimits(request.objects, setup)),
        stage_(MakeDriveStage(setup, request.objects, request.command_period)) {}

  std::optional<LimitsReport> Find() {
    report_.request = request_;
    for (const std::string& object : request_.objects) {
      report_.models.push_back(setup_.scene->world.RequireModel(setup_.ModelOf(object))->name);
    }
    report_.robot = setup_.scene->robot.model.name;
    report_.uncertainty =
        setup_.uncertainty->quantities.empty() ? "none" : base::HexOf(setup_.uncertainty->hash);
    report_.num_truths = NumTruths(request_.max_fall);
    report_.world_hash = setup_.world_hash;
    report_.robot_hash = setup_.robot_hash;
    report_.assumed = setup_.scene->robot.assumed;
    report_.payloads = forms_.payloads;
    report_.hazards = FindHazardLimits(request_.objects, setup_);
    report_.physics_hash = setup_.physics_hash;
    SetDirections();
    report_.max_slide = setup_.standing.slide;
    report_.gravity = setup_.scene->world.gravity;
    report_.min_turning_radius = controller_.min_turning_radius;
    report_.own_angular_acceleration = controller_.limits.max_angular_acceleration;
    for (const Motion& motion : Motions()) {
      if (!Look(motion)) return std::nullopt;
    }
    return report_;
  }

  std::optional<GivenReport> CheckGiven(const GivenLimits& given) {
    stage_.ends_at_first_fall = false;
    GivenReport report{request_,
                       setup_.scene->robot.model.name,
                       NumTruths(request_.max_fall),
                       setup_.standing.slide,
                       std::numeric_limits<double>::infinity(),
                       {}};
    for (const PayloadSupport& payload : forms_.payloads) {
      const double slides = payload.SlidingAcceleration(setup_.scene->world.gravity);
      report.sliding_acceleration = std::min(report.sliding_acceleration, slides);
    }
    if (given.values.count("angular_acceleration") > 0) {
      sudden_ = std::min(sudden_, given.values.at("angular_acceleration"));
    }
    SetDirections();
    std::vector<int> truths(report.num_truths);
    std::iota(truths.begin(), truths.end(), 0);
    for (const Motion& motion : Motions()) {
      const bool is_together = motion.motion == "together";
      const auto limit = given.values.find(motion.motion);
      const bool is_given =
          is_together || (limit != given.values.end() && limit->second <= motion.robots_own);
      const double value = is_given && !is_together ? limit->second : motion.robots_own;
      const auto outcomes = PlayTruths(motion, value, truths);
      if (!outcomes) return std::nullopt;
      values_[motion.motion] = value;
      AddVerdicts(motion, value, is_given ? "given" : "robot's own", *outcomes, &report);
    }
    return report;
  }

 private:
  void AddVerdicts(const Motion& motion, double value, const std::string& source,
                   const std::vector<DriveOutcome>& outcomes, GivenReport* report) const {
    for (std::size_t i = 0; i < forms_.payloads.size(); ++i) {
      GivenVerdict verdict{forms_.payloads[i].name, motion, value, source};
      for (const MotionBounds& bounds : forms_.of_each[i]) {
        if (bounds.motion == motion.motion) verdict.bounds = bounds;
      }
      for (const DriveOutcome& outcome : outcomes) {
        verdict.falls += outcome.fell[i] ? 1 : 0;
        verdict.slide = std::max(verdict.slide, outcome.slide[i]);
      }
      report->verdicts.push_back(std::move(verdict));
    }
  }

  void SetDirections() {
    report_.is_omnidirectional = controller_.drive == robot::Drive::kOmnidirectional;
    report_.num_directions = report_.is_omnidirectional ? kDirections : 2;
  }

  std::vector<Motion> Motions() const {
    MotionBounds together{"together", "of each", 1.0, std::numeric_limits<double>::infinity(), {}};
    return {{forms_.weakest.at(0), SpeedDrives()},
            {forms_.weakest.at(1), AccelerationDrives()},
            {forms_.weakest.at(2), DecelerationDrives()},
            {forms_.weakest.at(3), TurningDrives()},
            {std::move(together), TogetherDrives()}};
  }

  /// @return false when cancelled.
  bool Look(const Motion& motion) {
    const auto fallen_at = [&](double value, const std::vector<int>& truths) {
      return FallenAmong(motion, value, truths);
    };
    const auto step = Search(motion.robots_own, report_.num_truths, fallen_at).Run();
    if (!step) return false;
    const double least = ValueAt(motion.robots_own, kLastStep);
    if (*step > kLastStep) {
      throw base::ConfigError(fmt::format(
          "object '{}' falls from the tray of '{}' at {} of {:.3g} {} already, wanted one that "
          "can "
          "be carried; put it elsewhere (object_on_tray: in the profile) or allow more with "
          "--max-fall",
          base::Join(request_.objects, ", "), setup_.scene->robot.model.name, motion.motion, least,
          motion.unit));
    }
    const double value = ValueAt(motion.robots_own, *step);
    MotionLimit limit{motion, value, last_slide_, std::nullopt};
    if (request_.check_truths > 0) {
      limit.check = Check(motion, value);
      if (!limit.check) return false;
    }
    if (motion.motion == "speed" && !FindCarefulSpeed(motion, limit)) return false;
    values_[motion.motion] = value;
    report_.limits.push_back(std::move(limit));
    return true;
  }

  /// @return false when cancelled.
  bool FindCarefulSpeed(const Motion& speed, const MotionLimit& limit) {
    CarefulSpeed careful;
    if (report_.max_slide <= careful.slide) return true;
    careful.value = limit.value;
    if (limit.slide > careful.slide) {
      const auto slides_at = [&](double value, const std::vector<int>& truths) {
        return FallenAmong(speed, value, truths, careful.slide);
      };
      const auto step = Search(limit.value, report_.num_truths, slides_at).Run();
      if (!step) return false;
      careful.value = ValueAt(limit.value, *step);
      if (*step > kLastStep) careful.value.reset();
    }
    report_.careful = careful;
    return true;
  }

  /// With truths that the search has not seen.
  std::optional<LimitCheck> Check(const Motion& motion, double value) {
    std::vector<int> truths(request_.check_truths);
    std::iota(truths.begin(), truths.end(), report_.num_truths);
    const auto at = FallenAmong(motion, value, truths);
    if (!at) return std::nullopt;
    if (request_.on_check) {
      for (const int truth : truths) request_.on_check(SampleOf(motion, value, truth));
    }
    LimitCheck check{static_cast<int>(at->size()), std::nullopt};
    if (kAbove * value > motion.robots_own) return check;
    const auto above = FallenAmong(motion, kAbove * value, truths);
    if (!above) return std::nullopt;
    check.falls_above = static_cast<int>(above->size());
    return check;
  }

  /// @param max_slide  [m] that counts as a fall, where it is smaller than standing.slide.
  std::optional<std::vector<int>> FallenAmong(
      const Motion& motion, double value, const std::vector<int>& truths,
      double max_slide = std::numeric_limits<double>::infinity()) {
    const auto outcomes = PlayTruths(motion, value, truths);
    if (!outcomes) return std::nullopt;
    std::vector<int> fallen;
    last_slide_ = 0.0;
    for (std::size_t i = 0; i < truths.size(); ++i) {
      const DriveOutcome& outcome = (*outcomes)[i];
      last_slide_ = std::max(last_slide_, outcome.MaxSlide());
      if (outcome.AnyFell() || outcome.MaxSlide() > max_slide) fallen.push_back(truths[i]);
    }
    return fallen;
  }

  /// @return nothing when cancelled.
  std::optional<std::vector<DriveOutcome>> PlayTruths(const Motion& motion, double value,
                                                      const std::vector<int>& truths) {
    std::vector<DriveOutcome> outcomes(truths.size());
    const int num_tasks = static_cast<int>(truths.size());
    const auto work = [&](int task, const base::Advance& advance) {
      const CheckSample sample = SampleOf(motion, value, truths[task]);
      outcomes[task] = PlayAll(sample.drives, sample.rng);
      advance(1.0);
    };
    base::Crew crew = crew_;
    crew.on_progress = nullptr;
    if (!base::DoInParallel(num_tasks, num_tasks, crew, work)) return std::nullopt;
    for (const DriveOutcome& outcome : outcomes) report_.simulated_seconds += outcome.simulated;
    if (crew_.on_progress) {
      crew_.on_progress(static_cast<double>(values_.size()) / kNumMotions, 0.0);
    }
    return outcomes;
  }

  CheckSample SampleOf(const Motion& motion, double value, int truth) const {
    const double direction =
        2.0 * geometry::kPi * (truth % report_.num_directions) / report_.num_directions;
    return {motion.motion, motion.drives(value, direction),
            base::Rng(request_.seed)
                .Fork(static_cast<std::uint64_t>(values_.size()))
                .Fork(static_cast<std::uint64_t>(truth))};
  }

  /// In one truth, until a drive loses the load.
  DriveOutcome PlayAll(const std::vector<LoadDrive>& drives, const base::Rng& rng) const {
    DriveOutcome all;
    for (const LoadDrive& drive : drives) {
      DriveOutcome one = PlayDrive(stage_, drive, rng);
      one.simulated += all.simulated;
      for (std::size_t i = 0; i < all.fell.size(); ++i) {
        one.fell[i] = one.fell[i] || all.fell[i];
        one.slide[i] = std::max(one.slide[i], all.slide[i]);
      }
      all = std::move(one);
      if (stage_.ends_at_first_fall && all.AnyFell()) break;
    }
    return all;
  }

  double gently() const { return std::min(kGently, controller_.limits.max_linear_acceleration); }
  double sudden() const { return sudden_; }

  /// Driven gently up to it; then commands cease, and the controller's time-out stops the base.
  Drives SpeedDrives() const {
    return [gently = gently()](double v, double direction) -> std::vector<LoadDrive> {
      return {{{Along(direction, v), gently, 0.0, kCruise}, kSilence}};
    };
  }

  Drives AccelerationDrives() const {
    return [this](double a, double direction) -> std::vector<LoadDrive> {
      return {{{Along(direction, Found("speed")), a, 0.0, kCruise}}};
    };
  }

  Drives DecelerationDrives() const {
    return [this, gently = gently()](double a, double direction) -> std::vector<LoadDrive> {
      return {{{Along(direction, Found("speed")), gently, 0.0, kCruise}, {{}, a, 0.0, 0.0}}};
    };
  }

  /// On the spot, to the left or right, or round the smallest circle of a car, as suddenly as the
  /// controller allows; then commands cease.
  Drives TurningDrives() const {
    return [sudden = sudden(), radius = controller_.min_turning_radius](
               double w, double direction) -> std::vector<LoadDrive> {
      const double sense = direction < geometry::kPi ? 1.0 : -1.0;
      const Twist2 turn{radius * w, 0.0, sense * w};
      return {{{turn, radius * sudden, sudden, kTurningTime}, kSilence}};
    };
  }

  /// All at once, on an arc: speeding up, and braking hard, or left without commands. A base that
  /// comes to each by itself need not come to both.
  Drives TogetherDrives() const {
    return [this, sudden = sudden()](double share, double direction) -> std::vector<LoadDrive> {
      DriveStep up{Along(direction, share * Found("speed"), share * Found("turning")),
                   share * Found("acceleration"), share * sudden, kCruise};
      up.may_fall_short = true;
      return {{up, {{}, share * Found("deceleration"), share * sudden, 0.0}}, {up, kSilence}};
    };
  }

  double Found(const std::string& motion) const { return values_.at(motion); }

  static constexpr int kDirections = 8;
  static constexpr int kNumMotions = 5;

  const LimitsRequest& request_;
  const imagination::ImaginationSetup& setup_;
  const base::Crew& crew_;
  const robot::BaseControllerParams& controller_;
  const ClosedForms forms_;
  DriveStage stage_;
  double sudden_{controller_.limits.max_angular_acceleration};  // [rad/s^2]
  LimitsReport report_;
  std::map<std::string, double> values_;  // of the motions that later ones build on
  double last_slide_{0.0};                // [m] of the truths that were played last
};

}  // namespace

const MotionLimit& LimitsReport::Of(const std::string& motion) const {
  const auto found = std::find_if(limits.begin(), limits.end(),
                                  [&](const MotionLimit& limit) { return limit.motion == motion; });
  HIRES_CHECK(found != limits.end(), "limits are looked for in order");
  return *found;
}

double LimitsReport::SlidingAcceleration() const {
  double least = std::numeric_limits<double>::infinity();
  for (const PayloadSupport& payload : payloads) {
    least = std::min(least, payload.SlidingAcceleration(gravity));
  }
  return least;
}

int NumTruths(double max_fall) {
  HIRES_CHECK(max_fall > 0.0 && max_fall < 1.0, "a share lies between 0 and 1");
  return static_cast<int>(std::ceil(std::log(1.0 - kConfidence) / std::log1p(-max_fall)));
}

std::optional<LimitsReport> FindLimits(const LimitsRequest& request,
                                       const imagination::ImaginationSetup& setup,
                                       const base::Crew& crew) {
  return LimitFinder(request, setup, crew).Find();
}

std::optional<GivenReport> CheckGivenLimits(const LimitsRequest& request,
                                            const imagination::ImaginationSetup& setup,
                                            const GivenLimits& given, const base::Crew& crew) {
  return LimitFinder(request, setup, crew).CheckGiven(given);
}

}  // namespace hires::reports
