#include "lab/src/ladder/measure.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "hires/base/check.h"

namespace hires::lab::ladder {
namespace {

/// One way with its players, one for each thread.
class Team {
 public:
  Team(const Way& way, int threads, const std::function<bool()>& cancelled) {
    for (int i = 0; i < threads; ++i) players_.push_back(way.make());
    crew_.threads = threads;
    crew_.cancelled = cancelled;
  }

  /// Rounds `first`, `first` + 1, ...  @return nothing when cancelled.
  std::optional<Stretch> Play(int first, int rounds, const LadderClocks& clocks) const {
    std::vector<double> amounts(players_.size(), 0.0);
    const double processor = clocks.processor(), wall = clocks.wall();
    const bool is_whole = players_.size() == 1 ? PlayOne(0, first, rounds, &amounts[0])
                                               : PlayAll(first, rounds, &amounts);
    Stretch stretch{0.0, clocks.wall() - wall, clocks.processor() - processor, rounds};
    if (!is_whole) return std::nullopt;
    for (const double amount : amounts) stretch.amount += amount;
    return stretch;
  }

  world::WorldState End() const {
    return players_.front().state ? players_.front().state() : world::WorldState();
  }

 private:
  bool PlayOne(std::size_t player, int first, int rounds, double* amount) const {
    for (int round = first; round < first + rounds; ++round) {
      if (crew_.cancelled && crew_.cancelled()) return false;
      *amount += players_[player].play(round);
    }
    return !(crew_.cancelled && crew_.cancelled());
  }
  bool PlayAll(int first, int rounds, std::vector<double>* amounts) const {
    return base::DoInParallel(
        static_cast<int>(players_.size()), 1.0, crew_, [&](int player, const base::Advance&) {
          PlayOne(static_cast<std::size_t>(player), first, rounds, &(*amounts)[player]);
        });
  }

  std::vector<Player> players_;
  base::Crew crew_;
};

struct Plan {
  int repeats, rounds;
};

/// @param once  [s] that one round of all ways takes.
Plan PlanFor(double once, const Effort& effort) {
  const auto fit = [&](double times, int least, int most) {
    const double room = effort.seconds / (times * std::max(once, 1e-9));
    return static_cast<int>(std::clamp(room, double(least), double(most)));
  };
  const int repeats = fit(1.0, std::min(2, effort.repeats), effort.repeats);
  return {repeats, fit(repeats, 1, effort.max_rounds)};
}

template <typename Value>
std::vector<double> ForEach(const std::vector<Stretch>& stretches, Value value) {
  std::vector<double> values;
  for (const Stretch& stretch : stretches) values.push_back(value(stretch));
  return values;
}

}  // namespace

std::vector<double> Measured::Rates() const {
  return ForEach(stretches, [](const Stretch& s) { return s.amount / s.wall; });
}

std::vector<double> Measured::SecondsEach() const {
  return ForEach(stretches, [](const Stretch& s) { return s.wall / s.amount; });
}

std::vector<double> Measured::ProcessorSecondsEach() const {
  return ForEach(stretches, [](const Stretch& s) { return s.processor / s.rounds; });
}

std::optional<std::vector<Measured>> MeasureByTurns(const std::vector<const Way*>& ways,
                                                    const std::vector<int>& threads,
                                                    const Effort& effort,
                                                    const LadderClocks& clocks,
                                                    const std::function<bool()>& cancelled) {
  HIRES_CHECK(ways.size() == threads.size(), "each way needs its number of threads");
  std::vector<Team> teams;
  std::vector<Measured> measured(ways.size());
  double once = 0.0;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    const Team& team = teams.emplace_back(*ways[i], threads[i], cancelled);
    const std::optional<Stretch> warm = team.Play(0, 1, clocks);
    if (!warm) return std::nullopt;
    once += warm->wall;
    measured[i].stretches.push_back(*warm);
  }
  const Plan plan = PlanFor(once, effort);
  const bool is_first_counted = plan.repeats == 2 && 2.0 * once >= effort.seconds;
  if (!is_first_counted)
    for (Measured& way : measured) way.stretches.clear();
  for (int repeat = is_first_counted ? 1 : 0; repeat < plan.repeats; ++repeat) {
    for (std::size_t turn = 0; turn < teams.size(); ++turn) {
      const std::size_t i = repeat % 2 == 0 ? turn : teams.size() - 1 - turn;
      const std::optional<Stretch> stretch =
          teams[i].Play(repeat * plan.rounds, plan.rounds, clocks);
      if (!stretch) return std::nullopt;
      measured[i].stretches.push_back(*stretch);
    }
  }
  for (std::size_t i = 0; i < teams.size(); ++i) measured[i].end = teams[i].End();
  return measured;
}

Interval RatioOf(const std::vector<double>& before, const std::vector<double>& after) {
  HIRES_CHECK(before.size() == after.size(), "ratios are those of pairs");
  std::vector<double> logarithms;
  for (std::size_t i = 0; i < before.size(); ++i) {
    HIRES_CHECK(before[i] > 0.0 && after[i] > 0.0, "a ratio needs positive numbers");
    logarithms.push_back(std::log(after[i] / before[i]));
  }
  const Interval of_log = MeanInterval(logarithms);
  return {std::exp(of_log.estimate), std::exp(of_log.lower), std::exp(of_log.upper)};
}

double Apart(const world::WorldState& a, const world::WorldState& b) {
  double apart = 0.0;
  for (const world::ObjectState& object : a.objects) {
    const world::ObjectState* other = b.Find(object.name);
    if (other == nullptr) continue;
    apart = std::max(apart, (object.X_MO.translation - other->X_MO.translation).norm());
  }
  return apart;
}

}  // namespace hires::lab::ladder
