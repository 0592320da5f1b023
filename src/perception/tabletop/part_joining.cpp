#include "perception/tabletop/part_joining.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "perception/tabletop/hidden_face.h"
#include "perception/tabletop/part_shape.h"

namespace hires::perception {
namespace {

constexpr int kMinSurfels = 20;  // of a part that has faces

struct Extent {
  double lower{1e9}, upper{-1e9};
};

Extent ExtentAlong(const geometry::Polygon& outline, const Eigen::Vector2d& direction) {
  Extent extent;
  for (const Eigen::Vector2d& corner : outline) {
    extent.lower = std::min(extent.lower, direction.dot(corner));
    extent.upper = std::max(extent.upper, direction.dot(corner));
  }
  return extent;
}

class Joiner {
 public:
  Joiner(const Table& table, const SurfelCloud& all, std::vector<int> part,
         const PartJoiningParams& params)
      : table_(table), all_(all), params_(params) {
    for (std::size_t i = 0; i < part.size(); ++i)
      if (part[i] >= 0) members_[part[i]].push_back(static_cast<int>(i));
  }

  void JoinVessels();
  void JoinFloors();
  void JoinHidden(const PointCloud& cloud, const SeenDepth& seen, const base::Rng& rng);
  JoinedParts Result() const;

 private:
  std::vector<int> PartOfSurfels() const;
  bool IsFloor(const std::vector<int>& members, const Opening& opening) const;
  bool IsVessel(const PartShape& inner, const PartShape& outer) const;
  bool GoOnBehind(int a, int b, const std::map<int, std::vector<Face>>& faces,
                  const HiddenFaces& hidden) const;
  bool AreApart(int a, int b) const;
  double ShareOnFaces(const std::vector<int>& members, const std::vector<Face>& faces) const;
  void Merge(int into, int from);

  const Table& table_;
  const SurfelCloud& all_;
  const PartJoiningParams& params_;
  std::map<int, std::vector<int>> members_;
  std::vector<int> vessels_;
};

void Joiner::Merge(int into, int from) {
  members_[into].insert(members_[into].end(), members_[from].begin(), members_[from].end());
  members_.erase(from);
}

// The far wall is seen from inside, the near one from outside, in front of it; both end at the rim
// and are as wide as the thing is.
bool Joiner::IsVessel(const PartShape& inner, const PartShape& outer) const {
  if (inner.inward < params_.min_inward || outer.inward > 0.0 ||
      std::abs(inner.top - outer.top) > params_.rim_tolerance) {
    return false;
  }
  const Eigen::Vector2d camera = Eigen::Vector2d::Zero();  // FromAbove has it at its origin
  const Eigen::Vector2d away = ((inner.middle + outer.middle) / 2.0 - camera).normalized();
  const Eigen::Vector2d across(-away.y(), away.x());
  const Extent a = ExtentAlong(inner.outline, across), b = ExtentAlong(outer.outline, across);
  const double both = std::min(a.upper, b.upper) - std::max(a.lower, b.lower);
  const double either = std::max(a.upper, b.upper) - std::min(a.lower, b.lower);
  return both > params_.min_same_width * either && away.dot(inner.middle - outer.middle) > 0.0 &&
         geometry::Distance(inner.outline, outer.outline) < params_.max_rim_gap * either;
}

void Joiner::JoinVessels() {
  std::map<int, PartShape> shapes;
  for (const auto& [part, members] : members_)
    if (const auto shape = ShapeOf(all_, members, table_)) shapes[part] = *shape;
  for (const auto& [inner, inner_shape] : shapes) {
    for (const auto& [outer, outer_shape] : shapes) {
      if (inner == outer || members_.count(inner) == 0 || members_.count(outer) == 0 ||
          !IsVessel(inner_shape, outer_shape)) {
        continue;
      }
      Merge(inner, outer);
    }
  }
  for (const auto& [part, members] : members_) {
    const auto shape = ShapeOf(all_, members, table_);
    if (shape && shape->inner_share > params_.min_inner_share) vessels_.push_back(part);
  }
}

// What lies in a vessel and shows no outer side: its floor, or the rest of its wall.
void Joiner::JoinFloors() {
  for (const int vessel : vessels_) {
    if (members_.count(vessel) == 0) continue;  // itself the floor of another
    const auto shape = ShapeOf(all_, members_.at(vessel), table_);
    const Opening opening{vessel, shape->outline, shape->top};
    std::vector<int> floors;
    for (const auto& [part, members] : members_) {
      if (part != vessel && IsFloor(members, opening)) floors.push_back(part);
    }
    for (const int floor : floors) Merge(vessel, floor);
  }
}

bool Joiner::IsFloor(const std::vector<int>& members, const Opening& opening) const {
  Eigen::Vector3d mean_normal = Eigen::Vector3d::Zero();
  int inside = 0;
  for (const int i : members) {
    mean_normal += all_.surfels[i].normal / static_cast<double>(members.size());
    inside += IsSeenThrough(opening, table_, all_.surfels[i].p_C);
  }
  const auto shape = ShapeOf(all_, members, table_);
  const bool is_inner = !shape || shape->inward > params_.min_inward ||
                        mean_normal.dot(table_.normal) > params_.min_flatness;
  return is_inner && inside >= params_.min_floor * static_cast<double>(members.size());
}

double Joiner::ShareOnFaces(const std::vector<int>& members, const std::vector<Face>& faces) const {
  const auto on_faces = std::count_if(members.begin(), members.end(), [&](int i) {
    return std::any_of(faces.begin(), faces.end(), [&](const Face& face) {
      return face.Holds(all_.surfels[i], params_.same_face);
    });
  });
  return static_cast<double>(on_faces) / static_cast<double>(members.size());
}

bool Joiner::AreApart(int a, int b) const {
  for (const int i : members_.at(a))
    for (const int j : members_.at(b))
      if ((all_.surfels[i].p_C - all_.surfels[j].p_C).norm() < params_.min_gap) return false;
  return true;
}

// Each face that both have is hidden between them: something seen there would be seen behind it.
bool Joiner::GoOnBehind(int a, int b, const std::map<int, std::vector<Face>>& faces,
                        const HiddenFaces& hidden) const {
  const std::vector<int>&members_a = members_.at(a), &members_b = members_.at(b);
  const double share =
      std::max(ShareOnFaces(members_a, faces.at(b)), ShareOnFaces(members_b, faces.at(a)));
  if (share < params_.min_same_face || !AreApart(a, b)) return false;
  double least = std::numeric_limits<double>::infinity();
  for (const Face& face : faces.at(a)) {
    const double share = hidden.ShareHidden(face, members_a, members_b, params_.same_face);
    if (share >= 0.0) least = std::min(least, share);
  }
  return least >= params_.min_hidden && least <= 1.0;
}

void Joiner::JoinHidden(const PointCloud& cloud, const SeenDepth& seen, const base::Rng& rng) {
  HiddenFaces hidden(cloud, table_, all_, seen, PartOfSurfels());
  std::map<int, std::vector<Face>> faces;
  for (const auto& [part, members] : members_) {
    if (members.size() > kMinSurfels)
      faces[part] = FacesOf(all_, members, params_.face_tolerance, rng.Fork(part));
  }
  for (const auto& [a, faces_a] : faces) {
    for (const auto& [b, faces_b] : faces) {
      if (a < b && members_.count(a) > 0 && members_.count(b) > 0 &&
          GoOnBehind(a, b, faces, hidden)) {
        Merge(a, b);
        hidden.Merge(a, b);
      }
    }
  }
}

std::vector<int> Joiner::PartOfSurfels() const {
  std::vector<int> out(all_.surfels.size(), -1);
  for (const auto& [part, members] : members_)
    for (const int i : members) out[i] = part;
  return out;
}

JoinedParts Joiner::Result() const {
  JoinedParts out;
  out.part.assign(all_.surfels.size(), -1);
  int num = 0;
  for (const auto& [part, members] : members_) {
    for (const int i : members) out.part[i] = num;
    if (std::find(vessels_.begin(), vessels_.end(), part) != vessels_.end()) {
      const auto shape = ShapeOf(all_, members, table_);
      out.openings.push_back({num, shape->outline, shape->top});
    }
    ++num;
  }
  return out;
}

}  // namespace

JoinedParts JoinParts(const PointCloud& cloud, const Table& table, const SurfelCloud& surfels,
                      const SeenDepth& seen, std::vector<int> part, const PartJoiningParams& params,
                      const base::Rng& rng) {
  Joiner joiner(table, surfels, std::move(part), params);
  joiner.JoinVessels();
  joiner.JoinFloors();
  joiner.JoinHidden(cloud, seen, rng);
  return joiner.Result();
}

bool IsSeenThrough(const Opening& opening, const Table& table, const Eigen::Vector3d& p_C) {
  const double height = table.HeightOf(p_C);
  if (height >= opening.height || table.offset <= opening.height) return false;
  const double share = (table.offset - opening.height) / (table.offset - height);
  return geometry::Contains(opening.outline, table.FromAbove(share * p_C)) &&
         geometry::Contains(opening.outline, table.FromAbove(p_C));
}

}  // namespace hires::perception
