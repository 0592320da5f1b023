#include "lab/src/experience/experience_pictures.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

namespace hires::lab {
namespace {

using knowledge::ToppleEpisodePart;
using knowledge::ToppleState;
using nlohmann::ordered_json;

constexpr std::size_t kHistogramBins = 60;
constexpr std::size_t kPoints = 3000;  // of a cloud of points
constexpr std::size_t kAround = 100;   // [parts] before and after what an example shows: 5 s

struct Quantity {
  const char* name;
  double lower, upper;
  double (*of)(const ToppleEpisodePart&);
};
const Quantity kQuantities[] = {
    {"linear_velocity", 0.0, 0.7, [](const auto& p) { return p.base.v; }},
    {"linear_acceleration", -5.0, 5.0, [](const auto& p) { return p.base.a; }},
    {"linear_jerk", -60.0, 60.0, [](const auto& p) { return p.base.j; }},
    {"angular_velocity", 0.0, 1.2, [](const auto& p) { return p.base.angular_v; }},
    {"angular_acceleration", -6.0, 6.0, [](const auto& p) { return p.base.angular_a; }},
};

/// "fast/3" -> "fast".
std::string KindOf(const ExperienceRun& run) { return run.name.substr(0, run.name.find('/')); }

std::map<std::string, std::vector<const Stretch*>> ByKind(const std::vector<ExperienceRun>& runs) {
  std::map<std::string, std::vector<const Stretch*>> kinds;
  for (const ExperienceRun& run : runs) {
    for (const Stretch& stretch : run.stretches) kinds[KindOf(run)].push_back(&stretch);
  }
  return kinds;
}

/// What lies beyond the edges counts in the outermost bins.
ordered_json HistogramOf(const std::vector<const Stretch*>& stretches, const Quantity& quantity) {
  std::vector<double> edges(kHistogramBins + 1), counts(kHistogramBins, 0.0);
  const double width = (quantity.upper - quantity.lower) / kHistogramBins;
  for (std::size_t i = 0; i <= kHistogramBins; ++i)
    edges[i] = quantity.lower + width * static_cast<double>(i);
  double all = 0.0;
  for (const Stretch* stretch : stretches) {
    for (const ToppleEpisodePart& part : *stretch) {
      const double place = std::floor((quantity.of(part) - quantity.lower) / width);
      counts[static_cast<std::size_t>(std::clamp(place, 0.0, kHistogramBins - 1.0))] += 1.0;
      all += 1.0;
    }
  }
  for (double& count : counts) count /= std::max(all * width, 1e-12);  // a density
  return {{"edges", edges}, {"density", counts}};
}

ordered_json Distributions(const std::vector<ExperienceRun>& runs) {
  ordered_json distributions = ordered_json::object();
  for (const auto& [kind, stretches] : ByKind(runs)) {
    for (const Quantity& quantity : kQuantities) {
      distributions[quantity.name][kind] = HistogramOf(stretches, quantity);
    }
  }
  return distributions;
}

/// Evenly chosen of all.
ordered_json Points(const std::vector<ExperienceRun>& runs) {
  std::vector<const ToppleEpisodePart*> all;
  for (const ExperienceRun& run : runs) {
    for (const Stretch& stretch : run.stretches) {
      for (const ToppleEpisodePart& part : stretch) all.push_back(&part);
    }
  }
  ordered_json points{{"alpha", {}}, {"deviation", {}}, {"v", {}},        {"a", {}},
                      {"j", {}},     {"angular_v", {}}, {"angular_a", {}}};
  for (std::size_t i = 0; i < std::min(all.size(), kPoints); ++i) {
    const ToppleEpisodePart& part = *all[i * all.size() / std::min(all.size(), kPoints)];
    points["alpha"].push_back(part.alpha);
    points["deviation"].push_back(part.deviation);
    points["v"].push_back(part.base.v);
    points["a"].push_back(part.base.a);
    points["j"].push_back(part.base.j);
    points["angular_v"].push_back(part.base.angular_v);
    points["angular_a"].push_back(part.base.angular_a);
  }
  return points;
}

ordered_json SeriesOf(const Stretch& stretch, std::size_t from, std::size_t to,
                      const std::string& run, const std::string& action) {
  ordered_json series{{"run", run}, {"action", action}};
  const auto take = [&](const char* name, auto of) {
    std::vector<double> values;
    for (std::size_t i = from; i < to; ++i) values.push_back(of(stretch[i]));
    series[name] = values;
  };
  const double start = stretch[from].time;
  take("time", [start](const auto& p) { return p.time - start; });
  take("alpha", [](const auto& p) { return p.alpha; });
  take("deviation", [](const auto& p) { return p.deviation; });
  take("object_v", [](const auto& p) { return p.object.v; });
  take("object_a", [](const auto& p) { return p.object.a; });
  take("v", [](const auto& p) { return p.base.v; });
  take("a", [](const auto& p) { return p.base.a; });
  take("j", [](const auto& p) { return p.base.j; });
  take("angular_v", [](const auto& p) { return p.base.angular_v; });
  take("angular_a", [](const auto& p) { return p.base.angular_a; });
  take("x", [](const auto& p) { return p.x; });
  take("y", [](const auto& p) { return p.y; });
  return series;
}

ordered_json Around(const ExperienceRun& run, std::size_t s, std::size_t at) {
  const Stretch& stretch = run.stretches[s];
  return SeriesOf(stretch, at < kAround ? 0 : at - kAround, std::min(stretch.size(), at + kAround),
                  run.name, run.actions[s]);
}

/// Around the first fall; null without one.
ordered_json FirstFall(const std::vector<ExperienceRun>& runs) {
  for (const ExperienceRun& run : runs) {
    for (std::size_t s = 0; s < run.stretches.size(); ++s) {
      const std::vector<std::size_t> onsets = OnsetsOf(run.stretches[s]);
      if (!onsets.empty()) return Around(run, s, onsets.front());
    }
  }
  return nullptr;
}

/// Around the moment in which a load leaned most that did not fall in that stretch.
ordered_json LargestShaking(const std::vector<ExperienceRun>& runs) {
  ordered_json found;
  double largest = 0.0;
  for (const ExperienceRun& run : runs) {
    for (std::size_t s = 0; s < run.stretches.size(); ++s) {
      const Stretch& stretch = run.stretches[s];
      if (!OnsetsOf(stretch).empty()) continue;
      const auto most =
          std::max_element(stretch.begin(), stretch.end(),
                           [](const auto& a, const auto& b) { return a.alpha < b.alpha; });
      if (most->state != ToppleState::kShaking || most->alpha <= largest) continue;
      largest = most->alpha;
      found = Around(run, s, static_cast<std::size_t>(most - stretch.begin()));
    }
  }
  return found;
}

/// A whole drive of each kind of run: its longest.
ordered_json LongestDrives(const std::vector<ExperienceRun>& runs) {
  std::map<std::string, std::pair<const ExperienceRun*, std::size_t>> longest;
  for (const ExperienceRun& run : runs) {
    for (std::size_t s = 0; s < run.stretches.size(); ++s) {
      auto& [best, index] = longest[KindOf(run)];
      const bool is_longer =
          best == nullptr || run.stretches[s].size() > best->stretches[index].size();
      if (is_longer) {
        best = &run;
        index = s;
      }
    }
  }
  ordered_json drives = ordered_json::object();
  for (const auto& [kind, found] : longest) {
    const Stretch& stretch = found.first->stretches[found.second];
    drives[kind] =
        SeriesOf(stretch, 0, stretch.size(), found.first->name, found.first->actions[found.second]);
  }
  return drives;
}

ordered_json PlacesOfFalls(const std::vector<ExperienceRun>& runs) {
  ordered_json places{{"x", ordered_json::array()}, {"y", ordered_json::array()}};
  for (const ExperienceRun& run : runs) {
    for (const Stretch& stretch : run.stretches) {
      for (const std::size_t at : OnsetsOf(stretch)) {
        places["x"].push_back(stretch[at].x);
        places["y"].push_back(stretch[at].y);
      }
    }
  }
  return places;
}

}  // namespace

ordered_json PicturesOf(const std::vector<ExperienceRun>& runs) {
  return {{"distributions", Distributions(runs)},
          {"points", Points(runs)},
          {"fall", FirstFall(runs)},
          {"shaking", LargestShaking(runs)},
          {"drives", LongestDrives(runs)},
          {"falls", PlacesOfFalls(runs)}};
}

}  // namespace hires::lab
