#include "localisation/distance_transform.h"

#include <algorithm>
#include <limits>

#include "hires/base/check.h"

namespace hires::localisation {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// min over q of f(q) + (p - q)^2 for each p of a line.
class LineTransform {
 public:
  explicit LineTransform(int longest) : vertex_(longest), from_(longest + 1) {}

  /// Reads and writes every `stride`-th of `values`.
  void Apply(double* values, int count, int stride) {
    line_.resize(count);
    for (int q = 0; q < count; ++q) line_[q] = values[q * stride];
    const int parabolas = Envelope(count);
    if (parabolas == 0) return;
    for (int p = 0, k = 0; p < count; ++p) {
      while (k + 1 < parabolas && from_[k + 1] < p) ++k;
      const double step = p - vertex_[k];
      values[p * stride] = line_[vertex_[k]] + step * step;
    }
  }

 private:
  /// Vertices of the parabolas of which the lower envelope consists, and where each begins.
  int Envelope(int count) {
    int last = -1;
    for (int q = 0; q < count; ++q) {
      if (line_[q] == kInfinity) continue;
      double begin = -kInfinity;
      while (last >= 0 && (begin = Crossing(vertex_[last], q)) <= from_[last]) --last;
      ++last;
      vertex_[last] = q;
      from_[last] = last == 0 ? -kInfinity : begin;
    }
    return last + 1;
  }

  double Crossing(int left, int right) const {
    const double l = left, r = right;
    return ((line_[right] + r * r) - (line_[left] + l * l)) / (2.0 * (r - l));
  }

  std::vector<double> line_;
  std::vector<int> vertex_;
  std::vector<double> from_;
};

}  // namespace

std::vector<std::int32_t> SquaredDistances(const world::OccupancyGrid& grid, std::int32_t most) {
  const std::size_t size = static_cast<std::size_t>(std::max(grid.width, 0)) * grid.height;
  HIRES_CHECK(grid.width >= 1 && grid.height >= 1 && grid.cells.size() == size,
              "a grid has width times height cells");
  HIRES_CHECK(most >= 0, "a squared distance is not negative");
  std::vector<double> squared(size, kInfinity);
  for (std::size_t i = 0; i < size; ++i) {
    if (grid.cells[i] == world::Cell::kOccupied) squared[i] = 0.0;
  }
  LineTransform line(std::max(grid.width, grid.height));
  for (int x = 0; x < grid.width; ++x) line.Apply(&squared[x], grid.height, grid.width);
  for (int y = 0; y < grid.height; ++y) {
    line.Apply(&squared[static_cast<std::size_t>(y) * grid.width], grid.width, 1);
  }
  std::vector<std::int32_t> cut(size);
  std::transform(squared.begin(), squared.end(), cut.begin(), [&](double value) {
    return static_cast<std::int32_t>(std::min<double>(value, most));
  });
  return cut;
}

}  // namespace hires::localisation
