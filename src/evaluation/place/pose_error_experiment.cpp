#include <fmt/format.h>

#include "evaluation/experiment/kinds.h"
#include "hires/base/error.h"
#include "hires/evaluation/place/pose_error_fit.h"

namespace hires::evaluation {
namespace {

constexpr std::uint64_t kPlayed = 77;  // stream of the held-out seeds

/// As a whole: its share of the progress is one of `of`.
Crew Part(const Crew& crew, int index, int of) {
  Crew part = crew;
  if (!crew.on_progress) return part;
  part.on_progress = [=](double fraction, double elapsed) {
    crew.on_progress((index + fraction) / of, elapsed);
  };
  return part;
}

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
                                              const Crew& crew) {
  std::vector<PlaceTrail> trails;
  for (int i = first; i < last; ++i) {
    ExperimentConfig series = order.drives;
    series.seed += static_cast<std::uint64_t>(i);
    auto chains = PlayLegs(std::get<LegsConfig>(series.kind), series, stage,
                           Part(crew, i, order.series + order.held_out));
    if (!chains) return std::nullopt;
    for (std::vector<Leg>& chain : *chains)
      for (Leg& leg : chain) trails.push_back(std::move(leg.places));
  }
  return trails;
}

}  // namespace

std::optional<PoseErrorReport> FitPoseError(const PoseErrorOrder& order, const Crew& crew) {
  RequireFilter(order.drives);
  const auto stage = std::make_shared<const Stage>(MakeStage(order.drives));
  const simulation::SelfLocalisationParams params =
      simulation::LoadSelfLocalisation(order.drives.self_localisation);
  const auto trails = Trails(order, 0, order.series, stage, crew);
  if (!trails) return std::nullopt;
  const auto held_out = Trails(order, order.series, order.series + order.held_out, stage, crew);
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

}  // namespace hires::evaluation
