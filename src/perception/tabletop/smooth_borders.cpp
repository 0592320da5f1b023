#include "perception/tabletop/smooth_borders.h"

#include <algorithm>
#include <map>
#include <utility>

#include "base/averages.h"

namespace hires::perception {
namespace {

/// Part numbers, of which some mean the same; the lowest of them stands for all.
class Joined {
 public:
  explicit Joined(int count) : lowest_(count) { std::iota(lowest_.begin(), lowest_.end(), 0); }
  int Lowest(int part) const {
    while (lowest_[part] != part) part = lowest_[part];
    return part;
  }
  void Join(int a, int b) {
    const int of_a = Lowest(a), of_b = Lowest(b);
    lowest_[std::max(of_a, of_b)] = std::min(of_a, of_b);
  }

 private:
  std::vector<int> lowest_;
};

// Sine by which two surfaces turn towards each other between two of their elements; negative: away.
double Concavity(const Surfel& a, const Surfel& b) {
  return 0.5 * (b.normal - a.normal).dot((a.p_C - b.p_C).normalized());
}

double Quantile(std::vector<double> values, double share) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace

std::vector<int> JoinAcrossSmoothBorders(const SurfelCloud& surfels, std::vector<int> part,
                                         const SmoothBorderParams& params) {
  std::map<std::pair<int, int>, std::vector<double>> borders;  // a part with itself: within it
  for (std::size_t i = 0; i < part.size(); ++i) {
    if (part[i] < 0) continue;
    for (const int j : surfels.neighbours[i]) {
      if (part[j] > part[i] || (part[j] == part[i] && j > static_cast<int>(i)))
        borders[{part[i], part[j]}].push_back(Concavity(surfels.surfels[i], surfels.surfels[j]));
    }
  }
  const auto bends = [&](int one) {
    const auto within = borders.find({one, one});
    return within != borders.end() && base::Mean(within->second) > params.min_bend;
  };
  Joined joined(part.empty() ? 0 : *std::max_element(part.begin(), part.end()) + 1);
  for (const auto& [parts, concavities] : borders) {
    const auto [a, b] = parts;
    if (a == b || static_cast<int>(concavities.size()) < params.min_pairs) continue;
    const double most = bends(a) && bends(b) ? params.max_concavity : 0.0;
    if (Quantile(concavities, params.share) < most) joined.Join(a, b);
  }
  for (int& one : part)
    if (one >= 0) one = joined.Lowest(one);
  return part;
}

}  // namespace hires::perception
