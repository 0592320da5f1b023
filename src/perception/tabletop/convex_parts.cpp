#include "perception/tabletop/convex_parts.h"

#include <algorithm>
#include <cstdint>
#include <queue>

namespace hires::perception {
namespace {

// What one region knows of a neighbour; the sum over all pairs of surfels that border on each
// other. The neighbour knows the same: at `twin` in its own list.
struct Border {
  int other{0};
  int num_pairs{0};
  double concavity{0.0};
  int twin{0};
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
  int Find(int region, int other) const;
  int FindInShorter(int a, int b) const;
  void Erase(int region, int index);
  void Merge(int a, int b);
  void Push(int region, const Border& border);
  bool AreThere(int a, int b) const { return parent_[a] == a && parent_[b] == b; }
  const Border* Between(int a, int b) const;

  std::vector<std::vector<Border>> borders_;
  std::vector<int> parent_;
  std::vector<int> size_;
  // By the size of both, while these are joined: the smaller number above the larger, so that they
  // are sorted by one comparison.
  std::vector<std::vector<std::uint64_t>> flat_;
  bool is_flat_phase_{true};
  std::priority_queue<Candidate> queue_;
};

std::uint64_t PairOf(int a, int b) {
  const auto [lower, upper] = std::minmax(a, b);
  return static_cast<std::uint64_t>(lower) << 32 | static_cast<std::uint32_t>(upper);
}

// How far the normals lean towards each other, as a share of a sharp edge.
double Concavity(const Surfel& a, const Surfel& b, double sharp) {
  const Eigen::Vector3d along = (a.p_C - b.p_C).normalized();
  return std::clamp(-0.5 * (a.normal - b.normal).dot(along) / sharp, 0.0, 1.0);
}

Regions::Regions(const SurfelCloud& all, double sharp)
    : borders_(all.surfels.size()),
      parent_(all.surfels.size()),
      size_(all.surfels.size(), 1),
      flat_(all.surfels.size() + 1) {
  const int n = static_cast<int>(all.surfels.size());
  for (int i = 0; i < n; ++i) {
    parent_[i] = i;
    borders_[i].reserve(all.neighbours[i].size());
    for (const int j : all.neighbours[i]) borders_[i].push_back({j, 1, 0.0, 0});
  }
  for (int i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < borders_[i].size(); ++k) {
      Border& border = borders_[i][k];
      if (border.other < i) continue;
      border.twin = Find(border.other, i);
      border.concavity = Concavity(all.surfels[i], all.surfels[border.other], sharp);
      Border& back = borders_[border.other][border.twin];
      back.twin = static_cast<int>(k);
      back.concavity = border.concavity;
      Push(i, border);
    }
  }
}

void Regions::Push(int region, const Border& border) {
  if (is_flat_phase_) {
    if (border.concavity == 0.0)
      flat_[size_[region] + size_[border.other]].push_back(PairOf(region, border.other));
    return;
  }
  queue_.push({border.Mean(), size_[region] + size_[border.other], std::min(region, border.other),
               std::max(region, border.other)});
}

int Regions::RootOf(int surfel) const {
  while (parent_[surfel] != surfel) surfel = parent_[surfel];
  return surfel;
}

// Where in a region's list; -1: they do not border on each other.
int Regions::Find(int region, int other) const {
  const std::vector<Border>& borders = borders_[region];
  for (std::size_t i = 0; i < borders.size(); ++i)
    if (borders[i].other == other) return static_cast<int>(i);
  return -1;
}

// Where b stands in a's list.
int Regions::FindInShorter(int a, int b) const {
  if (borders_[a].size() <= borders_[b].size()) return Find(a, b);
  const int index = Find(b, a);
  return index < 0 ? -1 : borders_[b][index].twin;
}

// Of a region's list alone; the last one takes its place.
void Regions::Erase(int region, int index) {
  std::vector<Border>& borders = borders_[region];
  const Border& last = borders[index] = borders.back();
  borders_[last.other][last.twin].twin = index;
  borders.pop_back();
}

void Regions::Merge(int a, int b) {
  const bool a_has_more = borders_[a].size() >= borders_[b].size();
  const int into = a_has_more ? a : b, from = a_has_more ? b : a;
  Erase(into, FindInShorter(into, from));
  size_[into] += size_[from];
  std::vector<Border>& kept = borders_[into];
  for (const Border& border : borders_[from]) {
    if (border.other == into) continue;
    const int slot = FindInShorter(into, border.other);
    if (slot < 0) {
      borders_[border.other][border.twin].other = into;
      borders_[border.other][border.twin].twin = static_cast<int>(kept.size());
      kept.push_back(border);
      Push(into, border);
    } else {
      kept[slot].concavity += border.concavity;
      kept[slot].num_pairs += border.num_pairs;
      Border& back = borders_[border.other][kept[slot].twin];
      back.concavity = kept[slot].concavity;
      back.num_pairs = kept[slot].num_pairs;
      Erase(border.other, border.twin);
      Push(into, kept[slot]);
    }
  }
  borders_[from].clear();
  parent_[from] = into;
}

const Border* Regions::Between(int a, int b) const {
  const int index = FindInShorter(a, b);
  return index < 0 ? nullptr : &borders_[a][index];
}

void Regions::JoinFlat() {
  for (std::size_t size = 0; size < flat_.size(); ++size) {
    std::vector<std::uint64_t> pairs = std::move(flat_[size]);  // joining adds to others alone
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    for (const std::uint64_t pair : pairs) {
      const int a = static_cast<int>(pair >> 32), b = static_cast<int>(pair & 0xffffffff);
      if (!AreThere(a, b)) continue;
      const int size_now = size_[a] + size_[b];
      if (size_now != static_cast<int>(size)) {  // a region has grown: it is not yet its turn
        flat_[size_now].push_back(pair);
      } else if (const Border* border = Between(a, b); border && border->concavity == 0.0) {
        Merge(a, b);
      }
    }
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
