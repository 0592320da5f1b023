#include "localisation/other_places.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "hires/base/progress.h"
#include "hires/geometry/angles.h"
#include "localisation/distance_transform.h"
#include "localisation/likelihood_field.h"

namespace hires::localisation {
namespace {

using Eigen::Vector2d;
using geometry::Pose2;

constexpr double kCell = 0.1;                // [m] of the search
constexpr std::size_t kMostCells = 4000000;  // of the search; larger maps have larger ones
constexpr int kTopLevel = 6;                 // boxes of 64 x 64 cells come first
constexpr double kEchoGrid = 0.2;  // [m] of the echoes that lie in one such square, one counts
constexpr std::size_t kMostEchoes = 500;                  // that are compared
constexpr std::size_t kMostOfWay = 100;                   // places of the way
constexpr double kFewerEchoes = 0.06, kLessOfWay = 0.05;  // shares by which a rival may fit worse
constexpr double kElsewhere = 1.0;                        // [m]
constexpr double kTurnedAway = 0.5;                       // [rad]
constexpr std::size_t kMostFits = 200000;                 // kept at a time

/// Evenly picked, in an order in which each beginning is spread over all of them (golden section),
/// so that a place that does not fit is known by a few.
std::vector<Vector2d> Spread(const std::vector<Vector2d>& all, std::size_t most) {
  constexpr double kGolden = 0.6180339887498949;
  const std::size_t count = std::min(all.size(), most);
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < count; ++i)
    order.emplace_back(std::fmod(static_cast<double>(i) * kGolden, 1.0), i * all.size() / count);
  std::sort(order.begin(), order.end());
  std::vector<Vector2d> spread;
  for (const auto& [key, index] : order) spread.push_back(all[index]);
  return spread;
}

/// One echo of each square.
std::vector<Vector2d> Thinned(std::vector<Vector2d> echoes) {
  const auto square = [](const Vector2d& p) {
    return std::pair(std::floor(p.x() / kEchoGrid), std::floor(p.y() / kEchoGrid));
  };
  std::stable_sort(echoes.begin(), echoes.end(),
                   [&](const Vector2d& a, const Vector2d& b) { return square(a) < square(b); });
  const auto is_same = [&](const Vector2d& a, const Vector2d& b) { return square(a) == square(b); };
  echoes.erase(std::unique(echoes.begin(), echoes.end(), is_same), echoes.end());
  return echoes;
}

/// A map in coarse cells, and for each level k whether any of the 2^k x 2^k cells from one on is
/// near an obstacle, or free. Below and left of the map is room for a box of the top level.
class Pyramid {
 public:
  static constexpr std::uint8_t kNear = 1, kFree = 2;

  Pyramid(const world::OccupancyGrid& map, double explained_distance);

  double cell() const { return cell_; }  ///< [m]
  int columns() const { return columns_; }
  int rows() const { return rows_; }
  std::uint8_t At(int level, int column, int row) const {
    const int x = column + kPad, y = row + kPad;
    const bool is_within = x >= 0 && y >= 0 && x < width_ && y < height_;
    return is_within ? levels_[level][static_cast<std::size_t>(y) * width_ + x] : 0;
  }

 private:
  static constexpr int kPad = 1 << kTopLevel;

  void AddLevel(int shift);

  double cell_;
  int columns_, rows_, width_, height_;
  std::vector<std::vector<std::uint8_t>> levels_;
};

Pyramid::Pyramid(const world::OccupancyGrid& map, double explained_distance) {
  const double cells = static_cast<double>(map.cells.size());
  const double wanted = std::max(kCell / map.resolution, std::sqrt(cells / kMostCells));
  const int fine = std::max(1, static_cast<int>(std::lround(wanted)));  // in a coarse one, a side
  cell_ = fine * map.resolution;
  columns_ = (map.width + fine - 1) / fine;
  rows_ = (map.height + fine - 1) / fine;
  width_ = columns_ + kPad;
  height_ = rows_ + kPad;
  const double reach = explained_distance / map.resolution;
  const auto most = static_cast<std::int32_t>(reach * reach);
  const std::vector<std::int32_t> squared = SquaredDistances(FacesOf(map), most + 1);
  levels_.emplace_back(static_cast<std::size_t>(width_) * height_, std::uint8_t{0});
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column) {
      const std::size_t at = static_cast<std::size_t>(row) * map.width + column;
      const std::size_t to =
          static_cast<std::size_t>(row / fine + kPad) * width_ + column / fine + kPad;
      if (squared[at] <= most) levels_[0][to] |= kNear;
      if (map.cells[at] == world::Cell::kFree) levels_[0][to] |= kFree;
    }
  }
  for (int level = 1; level <= kTopLevel; ++level) AddLevel(1 << (level - 1));
}

void Pyramid::AddLevel(int shift) {
  const std::vector<std::uint8_t>& below = levels_.back();
  std::vector<std::uint8_t> level = below;
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      const std::size_t at = static_cast<std::size_t>(y) * width_ + x;
      const bool has_right = x + shift < width_, has_above = y + shift < height_;
      const std::size_t above = at + static_cast<std::size_t>(shift) * width_;
      if (has_right) level[at] |= below[at + shift];
      if (has_above) level[at] |= below[above];
      if (has_right && has_above) level[at] |= below[above + shift];
    }
  }
  levels_.push_back(std::move(level));
}

/// The sketch turned by one angle: cells from that of its middle.
struct TurnedSketch {
  struct Offset {
    int column, row;
  };
  std::vector<Offset> echoes, way;
};

struct Fit {
  double share;  // of the echoes
  double turn;   // [rad] about the middle
  Vector2d middle_M;
};

class PlaceSearch {
 public:
  PlaceSearch(const world::OccupancyGrid& map, const DriveSketch& sketch,
              double explained_distance);

  std::vector<Fit> Run(const std::string& task);
  const Vector2d& middle_M() const { return middle_M_; }

 private:
  struct Box {
    int level, column, row;
  };

  TurnedSketch Turned(double turn) const;
  static int Hits(const Pyramid& pyramid, const std::vector<TurnedSketch::Offset>& offsets,
                  const Box& box, std::uint8_t what, int least);
  bool MayFit(const TurnedSketch& turned, const Box& box, int* hits) const;
  void Search(double turn, std::vector<Fit>* fits) const;
  Box BoxOf(const Vector2d& p_M) const;

  Pyramid pyramid_;
  Vector2d origin_M_, middle_M_;
  std::vector<Vector2d> echoes_, way_;  // [m] from the middle
  double reach_{0.0};                   // [m] of the farthest
  int least_echoes_{0}, least_way_{0};
};

PlaceSearch::PlaceSearch(const world::OccupancyGrid& map, const DriveSketch& sketch,
                         double explained_distance)
    : pyramid_(map, explained_distance), origin_M_(map.origin), middle_M_(0.0, 0.0) {
  for (const Vector2d& p : sketch.way_M) middle_M_ += p / static_cast<double>(sketch.way_M.size());
  for (const Vector2d& p : Spread(Thinned(sketch.echoes_M), kMostEchoes))
    echoes_.push_back(p - middle_M_);
  for (const Vector2d& p : Spread(sketch.way_M, kMostOfWay)) way_.push_back(p - middle_M_);
  for (const Vector2d& p : echoes_) reach_ = std::max(reach_, p.norm());
  const TurnedSketch own = Turned(0.0);
  const Box here = BoxOf(middle_M_);
  const int explained = Hits(pyramid_, own.echoes, here, Pyramid::kNear, 0);
  const int free = Hits(pyramid_, own.way, here, Pyramid::kFree, 0);
  least_echoes_ =
      static_cast<int>(std::ceil(explained - kFewerEchoes * static_cast<double>(echoes_.size())));
  least_way_ = static_cast<int>(std::ceil(free - kLessOfWay * static_cast<double>(way_.size())));
}

PlaceSearch::Box PlaceSearch::BoxOf(const Vector2d& p_M) const {
  const Vector2d at = (p_M - origin_M_) / pyramid_.cell();
  return {0, static_cast<int>(std::floor(at.x())), static_cast<int>(std::floor(at.y()))};
}

TurnedSketch PlaceSearch::Turned(double turn) const {
  const Pose2 X{0.0, 0.0, turn};
  const auto offset = [&](const Vector2d& p) {
    const Vector2d at = X * p / pyramid_.cell();
    return TurnedSketch::Offset{static_cast<int>(std::lround(at.x())),
                                static_cast<int>(std::lround(at.y()))};
  };
  TurnedSketch turned;
  for (const Vector2d& p : echoes_) turned.echoes.push_back(offset(p));
  for (const Vector2d& p : way_) turned.way.push_back(offset(p));
  return turned;
}

/// How many offsets find `what` somewhere in the box; no more than -1 where fewer than `least` do.
int PlaceSearch::Hits(const Pyramid& pyramid, const std::vector<TurnedSketch::Offset>& offsets,
                      const Box& box, std::uint8_t what, int least) {
  int may_miss = static_cast<int>(offsets.size()) - least;
  int hits = 0;
  for (const TurnedSketch::Offset& offset : offsets) {
    const std::uint8_t there =
        pyramid.At(box.level, box.column + offset.column, box.row + offset.row);
    if ((there & what) != 0)
      ++hits;
    else if (--may_miss < 0)
      return -1;
  }
  return hits;
}

bool PlaceSearch::MayFit(const TurnedSketch& turned, const Box& box, int* hits) const {
  if (Hits(pyramid_, turned.way, box, Pyramid::kFree, least_way_) < 0) return false;
  *hits = Hits(pyramid_, turned.echoes, box, Pyramid::kNear, least_echoes_);
  return *hits >= 0;
}

void PlaceSearch::Search(double turn, std::vector<Fit>* fits) const {
  const TurnedSketch turned = Turned(turn);
  const int edge = 1 << kTopLevel;
  std::vector<Box> boxes;
  for (int row = 0; row < pyramid_.rows(); row += edge)
    for (int column = 0; column < pyramid_.columns(); column += edge)
      boxes.push_back({kTopLevel, column, row});
  while (!boxes.empty()) {
    const Box box = boxes.back();
    boxes.pop_back();
    int hits = 0;
    if (!MayFit(turned, box, &hits)) continue;
    if (box.level > 0) {
      const int half = 1 << (box.level - 1);
      for (int k = 0; k < 4; ++k)
        boxes.push_back({box.level - 1, box.column + k % 2 * half, box.row + k / 2 * half});
      continue;
    }
    const Vector2d middle_M =
        origin_M_ + pyramid_.cell() * Vector2d(box.column + 0.5, box.row + 0.5);
    const bool is_here = (middle_M - middle_M_).norm() <= kElsewhere &&
                         std::abs(geometry::WrapToPi(turn)) <= kTurnedAway;
    if (!is_here) fits->push_back({hits / static_cast<double>(echoes_.size()), turn, middle_M});
  }
}

bool FitsBetter(const Fit& a, const Fit& b) { return a.share > b.share; }

std::vector<Fit> PlaceSearch::Run(const std::string& task) {
  const int num_turns =
      static_cast<int>(std::ceil(2.0 * geometry::kPi * std::max(reach_, 1.0) / pyramid_.cell()));
  std::vector<Fit> fits;
  for (int i = 0; i < num_turns; ++i) {
    Search(2.0 * geometry::kPi * i / num_turns, &fits);
    if (fits.size() > kMostFits) {
      std::stable_sort(fits.begin(), fits.end(), FitsBetter);
      fits.resize(kMostFits / 2);
    }
    base::ReportProgress(task, static_cast<double>(i) / num_turns);
  }
  base::ReportProgress(task, 1.0);
  std::stable_sort(fits.begin(), fits.end(), FitsBetter);
  return fits;
}

bool IsSamePlace(const Fit& a, const Fit& b) {
  return (a.middle_M - b.middle_M).norm() <= kElsewhere &&
         std::abs(geometry::WrapToPi(a.turn - b.turn)) <= kTurnedAway;
}

}  // namespace

std::vector<Pose2> FindOtherPlaces(const world::OccupancyGrid& map, const DriveSketch& sketch,
                                   double explained_distance, int most, const std::string& task) {
  if (sketch.way_M.empty() || sketch.echoes_M.empty()) return {};
  PlaceSearch search(map, sketch, explained_distance);
  std::vector<Fit> told;
  std::vector<Pose2> X_MS;
  for (const Fit& fit : search.Run(task)) {
    const auto is_told = [&](const Fit& other) { return IsSamePlace(fit, other); };
    if (std::any_of(told.begin(), told.end(), is_told)) continue;
    told.push_back(fit);
    const Vector2d& middle = search.middle_M();
    X_MS.push_back(Pose2{fit.middle_M.x(), fit.middle_M.y(), geometry::WrapToPi(fit.turn)} *
                   Pose2{-middle.x(), -middle.y(), 0.0});
    if (static_cast<int>(told.size()) == most) break;
  }
  return X_MS;
}

}  // namespace hires::localisation
