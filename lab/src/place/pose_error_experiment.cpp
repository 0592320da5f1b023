#include <fmt/format.h>

#include "lab/src/experiment/kinds.h"
#include "hires/base/error.h"
#include "lab/src/place/pose_error_fit.h"

namespace hires::lab {
namespace {

constexpr std::uint64_t kPlayed = 77;  // stream of the held-out seeds

/// Experiments one after the other, whose progress is told as that of one.
class Parts {
 public:
  Parts(const base::Crew& crew, int count) : crew_(crew), count_(count) {}

  /// Of the next one; lives no longer than this.
  base::Crew Next() {
    const int index = num_begun_++;
    before_ += last_;
    last_ = 0.0;
    base::Crew part = crew_;
    if (!crew_.on_progress) return part;
    part.on_progress = [this, index](double fraction, double elapsed) {
      last_ = elapsed;
      crew_.on_progress((index + fraction) / count_, before_ + elapsed);
    };
    return part;
  }

 private:
  const base::Crew& crew_;
  const int count_;
  int num_begun_{0};
  double before_{0.0}, last_{0.0};  // [s]
};

void RequireFilter(const ExperimentConfig& drives) {
  if (std::get_if<LegsConfig>(&drives.kind) == nullptr) {
    throw base::ConfigError(
        fmt::format("experiment '{}': kind is {}, wanted legs", drives.name, KindName(drives)));
  }
  if (drives.self_localisation == "none") {
    throw base::ConfigError(fmt::format(
        "experiment '{}': self_localisation is none, so its robot is told where it is; wanted a "
        "file like config/self_localisation.yaml",
        drives.name));
  }
}

/// The trails of all legs of the series from `first` to `last`, each of one seed more.
std::optional<std::vector<PlaceTrail>> Trails(const PoseErrorOrder& order, int first, int last,
                                              const std::shared_ptr<const Stage>& stage,
                                              Parts* parts) {
  std::vector<PlaceTrail> trails;
  for (int i = first; i < last; ++i) {
    ExperimentConfig series = order.drives;
    series.seed += static_cast<std::uint64_t>(i);
    auto chains = PlayLegs(std::get<LegsConfig>(series.kind), series, stage, parts->Next());
    if (!chains) return std::nullopt;
    for (std::vector<Leg>& chain : *chains)
      for (Leg& leg : chain) trails.push_back(std::move(leg.places));
  }
  return trails;
}

}  // namespace

std::optional<PoseErrorReport> FitPoseError(const PoseErrorOrder& order, const base::Crew& crew) {
  RequireFilter(order.drives);
  const auto stage = std::make_shared<const Stage>(MakeStage(order.drives));
  const simulation::SelfLocalisationParams params =
      simulation::LoadSelfLocalisation(order.drives.self_localisation);
  Parts parts(crew, order.series + order.held_out);
  const auto trails = Trails(order, 0, order.series, stage, &parts);
  if (!trails) return std::nullopt;
  const auto held_out = Trails(order, order.series, order.series + order.held_out, stage, &parts);
  if (!held_out) return std::nullopt;
  PoseErrorReport report;
  report.drives = order.drives.name;
  report.seed = order.drives.seed;
  report.series = order.series;
  report.held_out = order.held_out;
  report.num_legs = static_cast<int>(trails->size());
  report.num_corrections = NumCorrections(*trails);
  report.fit.params = FitPoseError(*trails, params.filter.update_min_d, params.filter.update_min_a);
  report.fit.hash = simulation::PlaceHash(order.drives.self_localisation, stage->setup.scene->world,
                                          *stage->setup.scene->laser_height);
  report.found = FiguresOf(*held_out);
  report.played = FiguresOf(
      PlayPoseError(report.fit.params, *held_out, base::Rng(order.drives.seed).Fork(kPlayed)));
  return report;
}

}  // namespace hires::lab
