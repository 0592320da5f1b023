#include "localisation/particles.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "hires/base/check.h"
#include "hires/geometry/angles.h"

namespace hires::localisation {
namespace {

constexpr double kBinEdge = 0.5;  // [m]
constexpr int kBinTurns = 36;
constexpr double kBinTurn = 2.0 * geometry::kPi / kBinTurns;  // [rad]
constexpr std::int64_t kOffset = 1 << 20;  // bins on either side of the map's origin: 500 km

std::int64_t KeyOf(std::int64_t column, std::int64_t row, int turn) {
  return ((row + kOffset) * 2 * kOffset + column + kOffset) * kBinTurns + turn;
}

std::int64_t KeyAt(const Particles& particles, std::size_t i) {
  const auto column = static_cast<std::int64_t>(std::floor(particles.x[i] / kBinEdge));
  const auto row = static_cast<std::int64_t>(std::floor(particles.y[i] / kBinEdge));
  const int turn = static_cast<int>(std::floor(particles.yaw[i] / kBinTurn)) + kBinTurns;
  return KeyOf(column, row, turn % kBinTurns);
}

/// Sets that grow together.
class Groups {
 public:
  explicit Groups(std::size_t size) : parent_(size) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  int Of(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void Join(int i, int k) { parent_[std::max(Of(i), Of(k))] = std::min(Of(i), Of(k)); }

 private:
  std::vector<int> parent_;
};

void JoinNeighbours(const std::vector<std::int64_t>& keys, Groups* groups) {
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const std::int64_t cell = keys[i] / kBinTurns;
    const int turn = static_cast<int>(keys[i] % kBinTurns);
    for (int neighbour = 0; neighbour < 27; ++neighbour) {
      const std::int64_t beside = cell + (neighbour / 9 - 1) * 2 * kOffset + neighbour / 3 % 3 - 1;
      const int turned = (turn + neighbour % 3 - 1 + kBinTurns) % kBinTurns;
      const std::int64_t key = beside * kBinTurns + turned;
      const auto found = std::lower_bound(keys.begin(), keys.begin() + i, key);
      if (found != keys.begin() + i && *found == key) {
        groups->Join(static_cast<int>(found - keys.begin()), static_cast<int>(i));
      }
    }
  }
}

/// Which particles `count` equally spaced fingers point to, the first one at `offset` of a space.
void Point(const std::vector<double>& weight, int count, double offset, std::vector<int>* chosen) {
  chosen->clear();
  double reached = weight[0];
  int i = 0;
  const int last = static_cast<int>(weight.size()) - 1;
  for (int k = 0; k < count; ++k) {
    const double finger = (k + offset) / count;
    while (finger >= reached && i < last) reached += weight[++i];
    chosen->push_back(i);
  }
}

int CountBins(const Bins& bins, const std::vector<int>& chosen) {
  std::vector<char> is_hit(bins.keys.size());
  int count = 0;
  for (int i : chosen) {
    char& hit = is_hit[bins.bin_of[i]];
    count += hit == 0;
    hit = 1;
  }
  return count;
}

}  // namespace

void Particles::Add(const geometry::Pose2& X_MB, double weight_) {
  x.push_back(X_MB.x);
  y.push_back(X_MB.y);
  yaw.push_back(geometry::WrapToPi(X_MB.yaw));
  weight.push_back(weight_);
}

double EffectiveSize(const Particles& particles) {
  double squares = 0.0;
  for (double w : particles.weight) squares += w * w;
  return squares > 0.0 ? 1.0 / squares : 0.0;
}

void SumOverBeams(const Particles& particles, const Beams& beams, const LikelihoodField& field,
                  const std::vector<float>& table, std::vector<float>* sums) {
  const std::size_t count = beams.size();
  sums->resize(particles.size());
  std::vector<std::int32_t> cells(count);
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const float column = field.Column(particles.x[i]), row = field.Row(particles.y[i]);
    const float c = field.PerMetre() * static_cast<float>(std::cos(particles.yaw[i]));
    const float s = field.PerMetre() * static_cast<float>(std::sin(particles.yaw[i]));
    for (std::size_t k = 0; k < count; ++k) {  // without a branch: the compiler makes vectors of it
      cells[k] = field.Index(column + c * beams.x[k] - s * beams.y[k],
                             row + s * beams.x[k] + c * beams.y[k]);
    }
    float sum = 0.0f;
    for (std::size_t k = 0; k < count; ++k) sum += table[field.SquaredCells(cells[k])];
    (*sums)[i] = sum;
  }
}

Bins BinsOf(const Particles& particles) {
  Bins bins;
  std::vector<std::int64_t> keys(particles.size());
  for (std::size_t i = 0; i < keys.size(); ++i) keys[i] = KeyAt(particles, i);
  bins.keys = keys;
  std::sort(bins.keys.begin(), bins.keys.end());
  bins.keys.erase(std::unique(bins.keys.begin(), bins.keys.end()), bins.keys.end());
  for (std::int64_t key : keys) {
    const auto found = std::lower_bound(bins.keys.begin(), bins.keys.end(), key);
    bins.bin_of.push_back(static_cast<int>(found - bins.keys.begin()));
  }
  return bins;
}

Clusters ClustersOf(const Particles& particles) {
  const Bins bins = BinsOf(particles);
  Groups groups(bins.keys.size());
  JoinNeighbours(bins.keys, &groups);
  std::vector<double> weight_of_group(bins.keys.size());
  std::vector<int> order;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    weight_of_group[groups.Of(bins.bin_of[i])] += particles.weight[i];
  }
  for (int group = 0; group < static_cast<int>(bins.keys.size()); ++group) {
    if (groups.Of(group) == group) order.push_back(group);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return weight_of_group[a] > weight_of_group[b]; });
  Clusters clusters;
  std::vector<int> rank(bins.keys.size());
  for (int group : order) {
    rank[group] = static_cast<int>(clusters.weights.size());
    clusters.weights.push_back(weight_of_group[group]);
  }
  for (int bin : bins.bin_of) clusters.cluster_of.push_back(rank[groups.Of(bin)]);
  return clusters;
}

int KldSize(int num_bins, double error, double z, int most) {
  HIRES_CHECK(num_bins >= 0 && error > 0.0 && most >= 1, "a belief has bins and an error");
  if (num_bins <= 1) return 1;
  const double k = num_bins - 1;
  const double a = 2.0 / (9.0 * k);
  const double root = 1.0 - a + std::sqrt(a) * z;
  const double size = std::ceil(k / (2.0 * error) * root * root * root);
  return static_cast<int>(std::clamp(size, 1.0, static_cast<double>(most)));
}

Particles Resample(const Particles& particles, const KldParams& params, base::Rng* rng) {
  HIRES_CHECK(particles.size() > 0, "there are particles to draw from");
  const Bins bins = BinsOf(particles);
  const double offset = rng->Uniform(0.0, 1.0);
  std::vector<int> chosen;
  // Fox stops as soon as there are enough for the bins that were hit; drawn all at once, that is
  // the number that a set of this size demands for itself.
  for (int size = params.least;;) {
    Point(particles.weight, size, offset, &chosen);
    const int wanted = KldSize(CountBins(bins, chosen), params.error, params.z, params.most);
    if (wanted <= size) break;
    size = wanted;
  }
  Particles drawn;
  for (int i : chosen) drawn.Add(particles.pose(i), 1.0 / static_cast<double>(chosen.size()));
  return drawn;
}

}  // namespace hires::localisation
