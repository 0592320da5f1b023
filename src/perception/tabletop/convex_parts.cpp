#include "perception/tabletop/convex_parts.h"

#include <algorithm>
#include <queue>

namespace hires::perception {
namespace {

// What one region knows of a neighbour; the sum over all pairs of surfels that border on each
// other.
struct Border {
  int other{0};
  int num_pairs{0};
  double concavity{0.0};
  double Mean() const { return concavity / num_pairs; }
};

// Two regions that may be joined. Of equally concave borders the one between the smallest regions
// comes first: so regions grow everywhere alike, and where two things meet each is large before it
// is asked whether they are one. Then in a fixed order, for the same bits everywhere.
struct Candidate {
  double concavity;
  int size;  // surfels of both
  int a, b;
  bool operator<(const Candidate& o) const {
    if (concavity != o.concavity) return concavity > o.concavity;
    if (size != o.size) return size > o.size;
    return a != o.a ? a > o.a : b > o.b;
  }
};

/// Regions that grow. Most borders are not concave at all; these are joined first, by the size of
/// their regions alone, and the others, few by then, in order of their concavity.
class Regions {
 public:
  Regions(const SurfelCloud& surfels, double sharp);
  void JoinFlat();
  void JoinUpTo(double max_concavity);
  int RootOf(int surfel) const;
  const std::vector<Border>& borders(int root) const { return borders_[root]; }

 private:
  Border* Find(int region, int other);
  void Merge(int a, int b);
  void Push(int region, const Border& border);
  bool AreThere(int a, int b) const { return parent_[a] == a && parent_[b] == b; }
  const Border* Between(int a, int b);

  std::vector<std::vector<Border>> borders_;
  std::vector<int> parent_;
  std::vector<int> size_;
  std::vector<int> slot_;  // of a neighbour in the list that is being merged into; -1: not there
  std::vector<std::vector<std::pair<int, int>>>
      flat_;  // by the size of both, while these are joined
  bool is_flat_phase_{true};
  std::priority_queue<Candidate> queue_;
};

// How far the normals lean towards each other, as a share of a sharp edge.
double Concavity(const Surfel& a, const Surfel& b, double sharp) {
  const Eigen::Vector3d along = (a.p_C - b.p_C).normalized();
  return std::clamp(-0.5 * (a.normal - b.normal).dot(along) / sharp, 0.0, 1.0);
}

Regions::Regions(const SurfelCloud& all, double sharp)
    : borders_(all.surfels.size()),
      parent_(all.surfels.size()),
      size_(all.surfels.size(), 1),
      slot_(all.surfels.size(), -1),
      flat_(all.surfels.size() + 1) {
  for (std::size_t i = 0; i < all.surfels.size(); ++i) {
    parent_[i] = static_cast<int>(i);
    for (const int j : all.neighbours[i]) {
      borders_[i].push_back({j, 1, Concavity(all.surfels[i], all.surfels[j], sharp)});
      if (j > static_cast<int>(i)) Push(static_cast<int>(i), borders_[i].back());
    }
  }
}

void Regions::Push(int region, const Border& border) {
  if (is_flat_phase_) {
    if (border.concavity == 0.0)
      flat_[size_[region] + size_[border.other]].push_back(std::minmax(region, border.other));
    return;
  }
  queue_.push({border.Mean(), size_[region] + size_[border.other], std::min(region, border.other),
               std::max(region, border.other)});
}

int Regions::RootOf(int surfel) const {
  while (parent_[surfel] != surfel) surfel = parent_[surfel];
  return surfel;
}

Border* Regions::Find(int region, int other) {
  for (Border& border : borders_[region])
    if (border.other == other) return &border;
  return nullptr;
}

void Erase(std::vector<Border>* borders, int other) {
  const auto it = std::find_if(borders->begin(), borders->end(),
                               [&](const Border& border) { return border.other == other; });
  *it = borders->back();
  borders->pop_back();
}

void Regions::Merge(int a, int b) {
  const bool a_has_more = borders_[a].size() >= borders_[b].size();
  const int into = a_has_more ? a : b, from = a_has_more ? b : a;
  Erase(&borders_[into], from);
  size_[into] += size_[from];
  std::vector<Border>& kept = borders_[into];
  for (std::size_t i = 0; i < kept.size(); ++i) slot_[kept[i].other] = static_cast<int>(i);
  for (const Border& border : borders_[from]) {
    if (border.other == into) continue;
    Border* back = Find(border.other, from);
    const int slot = slot_[border.other];
    if (slot < 0) {
      kept.push_back(border);
      back->other = into;
      Push(into, border);
    } else {
      kept[slot].concavity += border.concavity;
      kept[slot].num_pairs += border.num_pairs;
      Erase(&borders_[border.other], from);
      *Find(border.other, into) = {into, kept[slot].num_pairs, kept[slot].concavity};
      Push(into, kept[slot]);
    }
  }
  for (const Border& border : kept) slot_[border.other] = -1;
  borders_[from].clear();
  parent_[from] = into;
}

// Looked for in the shorter list.
const Border* Regions::Between(int a, int b) {
  return borders_[a].size() < borders_[b].size() ? Find(a, b) : Find(b, a);
}

void Regions::JoinFlat() {
  for (std::size_t size = 0; size < flat_.size(); ++size) {
    std::sort(flat_[size].begin(), flat_[size].end());  // joining adds to lists further on alone
    for (const auto& [a, b] : flat_[size]) {
      if (!AreThere(a, b)) continue;
      const Border* border = Between(a, b);
      if (border == nullptr || border->concavity > 0.0) continue;
      const int size_now = size_[a] + size_[b];
      if (size_now != static_cast<int>(size)) {  // a region has grown: it is not yet its turn
        flat_[size_now].emplace_back(a, b);
      } else {
        Merge(a, b);
      }
    }
    flat_[size].clear();
  }
  is_flat_phase_ = false;
  for (std::size_t region = 0; region < borders_.size(); ++region)
    for (const Border& border : borders_[region])
      if (border.other > static_cast<int>(region)) Push(static_cast<int>(region), border);
}

void Regions::JoinUpTo(double max_concavity) {
  while (!queue_.empty() && queue_.top().concavity <= max_concavity) {
    const Candidate next = queue_.top();
    queue_.pop();
    if (!AreThere(next.a, next.b)) continue;
    const Border* border = Between(next.a, next.b);
    if (border == nullptr || border->Mean() != next.concavity) continue;  // an earlier state of it
    if (size_[next.a] + size_[next.b] == next.size) {
      Merge(next.a, next.b);
    } else {  // a region has grown: it is not yet its turn
      Push(border->other == next.a ? next.b : next.a, *border);
    }
  }
}

}  // namespace

std::vector<int> FindConvexParts(const SurfelCloud& all, const ConvexPartParams& params) {
  Regions regions(all, params.sharp);
  regions.JoinFlat();
  regions.JoinUpTo(params.max_concavity);
  const int n = static_cast<int>(all.surfels.size());
  std::vector<int> num_points(n, 0), part_of_root(n, -1), part(n, -1);
  for (int i = 0; i < n; ++i) num_points[regions.RootOf(i)] += all.surfels[i].num_points;
  int num_parts = 0;
  for (int i = 0; i < n; ++i) {
    const int root = regions.RootOf(i);
    if (num_points[root] >= params.min_points && part_of_root[root] < 0)
      part_of_root[root] = num_parts++;
    part[i] = part_of_root[root];
  }
  for (int i = 0; i < n; ++i) {  // crumbs go to the part that they share most of their border with
    if (part[i] >= 0) continue;
    int longest = 0;
    for (const Border& border : regions.borders(regions.RootOf(i))) {
      if (part_of_root[border.other] < 0 || border.num_pairs <= longest) continue;
      longest = border.num_pairs;
      part[i] = part_of_root[border.other];
    }
  }
  return part;
}

}  // namespace hires::perception
