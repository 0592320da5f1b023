#include "world/sdf/polygon_cut.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hires::world {
namespace {

using Line = std::vector<Eigen::Vector2d>;
using Triangle = std::array<Eigen::Vector2d, 3>;

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

double TwiceArea(const Line& line) {
  double sum = 0.0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    sum += Cross(line[i] - line[0], line[(i + 1) % line.size()] - line[0]);
  }
  return sum;
}

double TwiceArea(const Triangle& t) { return Cross(t[1] - t[0], t[2] - t[0]); }

bool IsInside(const Eigen::Vector2d& p, const Line& line) {
  bool is_inside = false;
  for (std::size_t i = 0, k = line.size() - 1; i < line.size(); k = i++) {
    const Eigen::Vector2d &a = line[i], &b = line[k];
    if ((a.y() > p.y()) == (b.y() > p.y())) continue;
    if (p.x() < (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y()) + a.x()) is_inside = !is_inside;
  }
  return is_inside;
}

/// Corners that repeat the one before say nothing.
Line WithoutRepeats(const Line& line) {
  constexpr double kSame = 1e-9;  // [m]
  Line kept;
  for (const Eigen::Vector2d& p : line) {
    if (kept.empty() || (p - kept.back()).norm() > kSame) kept.push_back(p);
  }
  while (kept.size() > 1 && (kept.front() - kept.back()).norm() <= kSame) kept.pop_back();
  return kept;
}

/// Whether what lies just beside corner i towards p is enclosed by the line.
bool OpensTowards(const Line& line, std::size_t i, const Eigen::Vector2d& p) {
  const Eigen::Vector2d& before = line[(i + line.size() - 1) % line.size()];
  const Eigen::Vector2d &at = line[i], &after = line[(i + 1) % line.size()];
  const bool is_left_of_first = Cross(at - before, p - at) >= 0.0;
  const bool is_left_of_second = Cross(after - at, p - at) >= 0.0;
  return Cross(at - before, after - at) > 0.0 ? is_left_of_first && is_left_of_second
                                              : is_left_of_first || is_left_of_second;
}

/// Makes one line of an outer one and a hole in it, by a cut there and back: from the hole's corner
/// farthest in x to one of the outer line that it sees.
void CutToHole(const Line& hole, Line* outer) {
  const auto farthest = std::max_element(
      hole.begin(), hole.end(), [](const auto& a, const auto& b) { return a.x() < b.x(); });
  const Eigen::Vector2d p = *farthest;
  double nearest = std::numeric_limits<double>::infinity();
  std::size_t seen = 0;
  for (std::size_t i = 0; i < outer->size(); ++i) {
    const Eigen::Vector2d &a = (*outer)[i], &b = (*outer)[(i + 1) % outer->size()];
    if ((a.y() > p.y()) == (b.y() > p.y())) continue;
    const double x = a.x() + (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y());
    if (x < p.x() || x >= nearest) continue;
    nearest = x;
    seen = a.x() > b.x() ? i : (i + 1) % outer->size();
  }
  // Corners between the ray and the edge's end may hide it: then the one of least slope is seen.
  const Triangle view{p, Eigen::Vector2d(nearest, p.y()), (*outer)[seen]};
  const double side = TwiceArea(view);
  double least = std::abs((*outer)[seen].y() - p.y()) / ((*outer)[seen] - p).norm();
  for (std::size_t i = 0; i < outer->size(); ++i) {
    const Eigen::Vector2d& q = (*outer)[i];
    if (q == (*outer)[seen] || q.x() <= p.x() || !OpensTowards(*outer, i, p)) continue;
    const double one = Cross(view[1] - view[0], q - view[0]) * side;
    const double two = Cross(view[2] - view[1], q - view[1]) * side;
    const double three = Cross(view[0] - view[2], q - view[2]) * side;
    if (one < 0.0 || two < 0.0 || three < 0.0) continue;
    const double slope = std::abs(q.y() - p.y()) / (q - p).norm();
    if (slope >= least) continue;
    least = slope;
    seen = i;
  }
  // Cuts to other holes have made several corners of one place.
  const Eigen::Vector2d place = (*outer)[seen];
  for (std::size_t i = 0; i < outer->size(); ++i) {
    if ((*outer)[i] == place && OpensTowards(*outer, i, p)) seen = i;
  }
  Line joined(outer->begin(), outer->begin() + static_cast<std::ptrdiff_t>(seen) + 1);
  joined.insert(joined.end(), farthest, hole.end());
  joined.insert(joined.end(), hole.begin(), farthest + 1);
  joined.insert(joined.end(), outer->begin() + static_cast<std::ptrdiff_t>(seen), outer->end());
  *outer = std::move(joined);
}

bool IsEar(const Line& line, std::size_t i) {
  const std::size_t n = line.size();
  const Triangle ear{line[(i + n - 1) % n], line[i], line[(i + 1) % n]};
  if (TwiceArea(ear) <= 0.0) return false;
  return std::none_of(line.begin(), line.end(), [&](const Eigen::Vector2d& p) {
    if (p == ear[0] || p == ear[1] || p == ear[2]) return false;
    for (int k = 0; k < 3; ++k) {
      if (Cross(ear[(k + 1) % 3] - ear[k], p - ear[k]) < 0.0) return false;
    }
    return true;
  });
}

/// By cutting off ears. @return whether it could be cut to the end.
bool AppendTriangles(Line line, std::vector<Triangle>* triangles) {
  while (line.size() > 2) {
    const std::size_t n = line.size();
    std::size_t i = 0;
    while (i < n && !IsEar(line, i)) ++i;
    if (i < n) {
      triangles->push_back({line[(i + n - 1) % n], line[i], line[(i + 1) % n]});
    } else {  // corners on a straight line enclose nothing
      i = 0;
      while (i < n && std::abs(TwiceArea(
                          Triangle{line[(i + n - 1) % n], line[i], line[(i + 1) % n]})) > 1e-12) {
        ++i;
      }
      if (i == n) return false;
    }
    line.erase(line.begin() + static_cast<std::ptrdiff_t>(i));
  }
  return true;
}

}  // namespace

std::vector<Triangle> CutIntoTriangles(std::vector<Line> lines) {
  for (Line& line : lines) line = WithoutRepeats(line);
  std::vector<int> depth(lines.size(), 0);
  double area = 0.0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (lines[i].size() < 3) return {};
    for (std::size_t k = 0; k < lines.size(); ++k) {
      if (k != i && IsInside(lines[i].front(), lines[k])) ++depth[i];
    }
    const bool is_hole = depth[i] % 2 == 1;
    if ((TwiceArea(lines[i]) < 0.0) != is_hole) std::reverse(lines[i].begin(), lines[i].end());
    area += TwiceArea(lines[i]);
  }
  std::vector<Triangle> triangles;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (depth[i] % 2 == 1) continue;
    Line outer = lines[i];
    std::vector<std::size_t> holes;
    for (std::size_t k = 0; k < lines.size(); ++k) {
      if (depth[k] == depth[i] + 1 && IsInside(lines[k].front(), lines[i])) holes.push_back(k);
    }
    const auto farthest = [&](std::size_t k) {
      double x = -std::numeric_limits<double>::infinity();
      for (const Eigen::Vector2d& p : lines[k]) x = std::max(x, p.x());
      return x;
    };
    std::sort(holes.begin(), holes.end(),
              [&](std::size_t a, std::size_t b) { return farthest(a) > farthest(b); });
    for (const std::size_t k : holes) CutToHole(lines[k], &outer);
    if (!AppendTriangles(outer, &triangles)) return {};
  }
  double covered = 0.0;
  for (const Triangle& triangle : triangles) covered += TwiceArea(triangle);
  const bool is_all = std::abs(covered - area) <= 1e-6 * std::max(1e-6, std::abs(area));
  return is_all ? triangles : std::vector<Triangle>{};
}

}  // namespace hires::world
