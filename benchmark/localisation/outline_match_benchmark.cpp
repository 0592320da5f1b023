// What one scan costs that corrects a believed place by known outlines, for lasers of rollouts and
// of robots (PR2: 640 beams at 20 Hz).
#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "hires/base/rng.h"
#include "hires/localisation/outline_match.h"
#include "hires/robot/echoes.h"
#include "support/planar_scan.h"

namespace hires::localisation_benchmarks {
namespace {

using geometry::Polygon;
using geometry::Pose2;

constexpr double kView = 4.54;  // [rad]
const Pose2 X_BL{0.275, 0.0, 0.0};

Polygon Leg(const Eigen::Vector2d& middle) {
  Polygon leg;
  for (int i = 0; i < 8; ++i) {
    const double angle = i * M_PI / 4.0;
    leg.emplace_back(middle + 0.02 * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  return leg;
}

/// A dining room: walls, and tables and chairs of four round legs each.
std::vector<Polygon> DiningRoom() {
  std::vector<Polygon> outlines{{{-4, -4.1}, {4, -4.1}, {4, -4}, {-4, -4}},
                                {{-4, 4}, {4, 4}, {4, 4.1}, {-4, 4.1}},
                                {{-4.1, -4}, {-4, -4}, {-4, 4}, {-4.1, 4}},
                                {{4, -4}, {4.1, -4}, {4.1, 4}, {4, 4}}};
  for (const double x : {-3.0, -1.0, 1.2, 3.0}) {
    for (const double y : {-2.5, -1.0, 0.0, 1.5, 3.0}) {
      for (const double dx : {0.0, 0.5})
        for (const double dy : {0.0, 0.5}) outlines.push_back(Leg({x + dx, y + dy}));
    }
  }
  return outlines;
}

void BM_OutlineMatch(benchmark::State& state) {
  const int num_beams = static_cast<int>(state.range(0));
  const std::vector<Polygon> outlines = DiningRoom();
  const localisation::OutlineMatch match(outlines, {});
  base::Rng rng(4);
  const double increment = kView / (num_beams - 1);
  const test_support::Beams beams{-0.5 * kView, increment, num_beams, 0.08, 10.0, &rng, 0.01};
  const auto scan = test_support::ScanOf(outlines, {0.3, 0.2, 0.1}, {}, X_BL, beams);
  const Polygon body{{0.33, -0.33}, {0.33, 0.33}, {-0.33, 0.33}, {-0.33, -0.33}};
  const localisation::PlaceBelief told{{0.33, 0.18, 0.11},
                                       Eigen::Vector3d(0.0009, 0.0009, 0.0004).asDiagonal()};
  for (auto _ : state) {
    benchmark::DoNotOptimize(match.Correct(told, robot::EchoesOf(scan, body), X_BL.position(),
                                           scan.reading.angle_increment));
  }
}
BENCHMARK(BM_OutlineMatch)->Arg(120)->Arg(640)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace hires::localisation_benchmarks
