#include "hires/temporal/stn.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>
#include <utility>

#include "hires/base/check.h"

namespace hires::temporal {
namespace {

constexpr double kTicksPerSecond = 1e6;
constexpr std::int64_t kNever = std::int64_t{1} << 61;  // twice this still fits
constexpr int kNoEdge = -1;

std::int64_t ToTicks(double seconds) {
  if (std::isinf(seconds)) return seconds > 0.0 ? kNever : -kNever;
  return std::llround(seconds * kTicksPerSecond);
}

double ToSeconds(std::int64_t ticks) {
  if (ticks >= kNever) return kForever;
  return ticks <= -kNever ? -kForever : static_cast<double>(ticks) / kTicksPerSecond;
}

/// The sum, which neither grows beyond "never" nor comes back from it.
std::int64_t Sum(std::int64_t a, std::int64_t b) {
  return a >= kNever || b >= kNever ? kNever : std::clamp(a + b, -kNever, kNever);
}

void CheckBounds(const Bounds& bounds) {
  const auto is_fine = [](double bound) {
    return std::isinf(bound) || std::abs(bound) <= Stn::kLongest;
  };
  HIRES_CHECK(is_fine(bounds.earliest) && is_fine(bounds.latest),
              "a bound is no number or longer than Stn::kLongest");
  HIRES_CHECK(bounds.earliest < kForever && bounds.latest > -kForever,
              "bounds leave no time: earliest is +infinite or latest is -infinite");
}

}  // namespace

/// Points to go on from, the nearest first.
struct Stn::Relaxation {
  using Entry = std::pair<Ticks, Point>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> queue;
};

Stn::Stn() {
  AddPoint("origin");
  from_origin_.distance[kOrigin] = to_origin_.distance[kOrigin] = 0;
}

Stn::Point Stn::AddPoint(std::string name) {
  names_.push_back(std::move(name));
  leaving_.emplace_back();
  arriving_.emplace_back();
  potential_.push_back(0);
  for (Reach* reach : {&from_origin_, &to_origin_}) {
    reach->distance.push_back(kNever);
    reach->edge.push_back(kNoEdge);
  }
  return static_cast<Point>(names_.size()) - 1;
}

const std::string& Stn::NameOf(Point point) const {
  return names_.at(static_cast<std::size_t>(point));
}

Stn::Edge Stn::EdgeOf(EdgeId edge) const {
  const Constraint& constraint = constraints_[edge / 2];
  if (edge % 2 == 0) return {constraint.from, constraint.to, constraint.upper};
  return {constraint.to, constraint.from, -constraint.lower};
}

bool Stn::IsUseful(EdgeId edge) const { return EdgeOf(edge).length < kNever; }

void Stn::Link(EdgeId edge) {
  leaving_[EdgeOf(edge).from].push_back(edge);
  arriving_[EdgeOf(edge).to].push_back(edge);
}

void Stn::Unlink(ConstraintId id) {
  const auto remove = [](std::vector<EdgeId>* edges, EdgeId edge) {
    edges->erase(std::remove(edges->begin(), edges->end(), edge), edges->end());
  };
  for (const EdgeId edge : {2 * id, 2 * id + 1}) {
    remove(&leaving_[EdgeOf(edge).from], edge);
    remove(&arriving_[EdgeOf(edge).to], edge);
  }
}

std::optional<Stn::Conflict> Stn::Constrain(Point from, Point to, const Bounds& bounds,
                                            std::string why, ConstraintId* id) {
  NameOf(from), NameOf(to);  // both are there
  CheckBounds(bounds);
  const ConstraintId added = static_cast<ConstraintId>(constraints_.size());
  constraints_.push_back(
      {from, to, ToTicks(bounds.earliest), ToTicks(bounds.latest), std::move(why), true});
  for (const EdgeId edge : {2 * added, 2 * added + 1}) {
    if (!IsUseful(edge)) continue;
    Link(edge);
    const auto cycle = Repair(edge);
    if (!cycle) continue;
    Conflict conflict = Explain(*cycle, added);
    Unlink(added);
    constraints_.pop_back();
    return conflict;
  }
  for (const EdgeId edge : {2 * added, 2 * added + 1}) {
    Improve(Way::kFromOrigin, edge);
    Improve(Way::kToOrigin, edge);
  }
  if (id) *id = added;
  return std::nullopt;
}

/// Lowers the potential until `edge` and all others are kept by it. Where that cannot be: the edges
/// of a negative cycle, beginning with `edge`, and the potential is as before.
std::optional<std::vector<Stn::EdgeId>> Stn::Repair(EdgeId edge) {
  const Edge added = EdgeOf(edge);
  if (potential_[added.to] <= potential_[added.from] + added.length) return {};
  std::vector<Ticks> lowered(names_.size(), kNever);
  std::vector<EdgeId> reason(names_.size(), kNoEdge);
  std::vector<bool> is_settled(names_.size(), false);
  Relaxation open;
  // Keys say by how much a point falls: the one that falls most first, which none can outdo later.
  const auto lower = [&](EdgeId by, Ticks value) {
    const Point point = EdgeOf(by).to;
    if (value >= potential_[point] || value >= lowered[point]) return;
    lowered[point] = value;
    reason[point] = by;
    open.queue.push({value - potential_[point], point});
  };
  lower(edge, potential_[added.from] + added.length);
  while (!open.queue.empty()) {
    const Point point = open.queue.top().second;
    open.queue.pop();
    if (point == added.from) break;
    if (is_settled[point]) continue;
    is_settled[point] = true;
    for (const EdgeId next : leaving_[point]) {
      if (!is_settled[EdgeOf(next).to]) lower(next, lowered[point] + EdgeOf(next).length);
    }
  }
  if (reason[added.from] == kNoEdge) {
    for (std::size_t i = 0; i < potential_.size(); ++i) {
      potential_[i] = std::min(potential_[i], lowered[i]);
    }
    return {};
  }
  std::vector<EdgeId> cycle;
  Point at = added.from;
  do {
    cycle.push_back(reason[at]);
    at = EdgeOf(reason[at]).from;
  } while (at != added.from);
  std::reverse(cycle.begin(), cycle.end());
  return cycle;
}

std::string Stn::TextOf(EdgeId edge) const {
  const Constraint& constraint = constraints_[edge / 2];
  if (edge % 2 == 0) {
    return fmt::format("{} (at most {} s)", constraint.why, ToSeconds(constraint.upper));
  }
  return fmt::format("{} (at least {} s)", constraint.why, ToSeconds(constraint.lower));
}

Stn::Conflict Stn::Explain(const std::vector<EdgeId>& cycle, ConstraintId refused) const {
  Conflict conflict;
  std::vector<std::string> texts;
  for (const EdgeId edge : cycle) {
    conflict.cycle.push_back(edge / 2 == refused ? Conflict::kRefused : edge / 2);
    texts.push_back(TextOf(edge));
  }
  conflict.text = fmt::format("{}", fmt::join(texts, "; "));
  return conflict;
}

void Stn::Retract(ConstraintId id) {
  HIRES_CHECK(id >= 0 && id < static_cast<int>(constraints_.size()) && constraints_[id].is_active,
              "there is no constraint " + std::to_string(id));
  constraints_[id].is_active = false;
  Unlink(id);
  for (const EdgeId edge : {2 * id, 2 * id + 1}) {
    Forget(Way::kFromOrigin, edge);
    Forget(Way::kToOrigin, edge);
  }
}

/// The edge as it is walked: away from the origin, also where the paths lead to it.
Stn::Edge Stn::Along(Way way, EdgeId edge) const {
  Edge along = EdgeOf(edge);
  if (way == Way::kToOrigin) std::swap(along.from, along.to);
  return along;
}

const std::vector<Stn::EdgeId>& Stn::Leaving(Way way, Point point) const {
  return way == Way::kFromOrigin ? leaving_[point] : arriving_[point];
}

/// Distances in reduced lengths, which are never negative, but for a constant.
Stn::Ticks Stn::KeyOf(Way way, Point point, Ticks distance) const {
  return way == Way::kFromOrigin ? distance - potential_[point] : distance + potential_[point];
}

void Stn::Improve(Way way, EdgeId edge) {
  if (!IsUseful(edge)) return;
  Reach& known = reach(way);
  const Edge added = Along(way, edge);
  const Ticks through = Sum(known.distance[added.from], added.length);
  if (through >= known.distance[added.to]) return;
  known.distance[added.to] = through;
  known.edge[added.to] = edge;
  Relaxation open;
  open.queue.push({KeyOf(way, added.to, through), added.to});
  Relax(way, &known, &open);
}

/// What was reached through the edge is looked for again, beginning at its neighbours.
void Stn::Forget(Way way, EdgeId edge) {
  Reach& known = reach(way);
  if (known.edge[Along(way, edge).to] != edge) return;
  std::vector<Point> lost = {Along(way, edge).to};
  known.edge[lost[0]] = kNoEdge;
  for (std::size_t i = 0; i < lost.size(); ++i) {
    known.distance[lost[i]] = kNever;
    for (const EdgeId next : Leaving(way, lost[i])) {
      const Point point = Along(way, next).to;
      if (known.edge[point] != next) continue;
      known.edge[point] = kNoEdge;
      lost.push_back(point);
    }
  }
  Relaxation open;
  const Way back = way == Way::kFromOrigin ? Way::kToOrigin : Way::kFromOrigin;
  for (const Point point : lost) {
    for (const EdgeId arriving : Leaving(back, point)) {
      const Edge from = Along(way, arriving);
      const Ticks through = Sum(known.distance[from.from], from.length);
      if (through >= known.distance[point]) continue;
      known.distance[point] = through;
      known.edge[point] = arriving;
    }
    if (known.distance[point] < kNever) {
      open.queue.push({KeyOf(way, point, known.distance[point]), point});
    }
  }
  Relax(way, &known, &open);
}

void Stn::Relax(Way way, Reach* known, Relaxation* open) const {
  while (!open->queue.empty()) {
    const auto [key, point] = open->queue.top();
    open->queue.pop();
    if (key != KeyOf(way, point, known->distance[point])) continue;  // found a shorter way since
    for (const EdgeId edge : Leaving(way, point)) {
      const Edge next = Along(way, edge);
      const Ticks through = Sum(known->distance[point], next.length);
      if (through >= known->distance[next.to]) continue;
      known->distance[next.to] = through;
      known->edge[next.to] = edge;
      open->queue.push({KeyOf(way, next.to, through), next.to});
    }
  }
}

Bounds Stn::Of(Point point) const {
  const auto index = static_cast<std::size_t>(point);
  return {-ToSeconds(to_origin_.distance.at(index)), ToSeconds(from_origin_.distance.at(index))};
}

/// Shortest path, by a search that ends when `to` is reached.
Stn::Ticks Stn::Distance(Point from, Point to) const {
  Reach found{std::vector<Ticks>(names_.size(), kNever), std::vector<EdgeId>()};
  found.distance[from] = 0;
  Relaxation open;
  open.queue.push({KeyOf(Way::kFromOrigin, from, 0), from});
  while (!open.queue.empty() && open.queue.top().second != to) {
    const auto [key, point] = open.queue.top();
    open.queue.pop();
    if (key != KeyOf(Way::kFromOrigin, point, found.distance[point])) continue;
    for (const EdgeId edge : leaving_[point]) {
      const Edge next = EdgeOf(edge);
      const Ticks through = Sum(found.distance[point], next.length);
      if (through >= found.distance[next.to]) continue;
      found.distance[next.to] = through;
      open.queue.push({KeyOf(Way::kFromOrigin, next.to, through), next.to});
    }
  }
  return found.distance[to];
}

Bounds Stn::Between(Point from, Point to) const {
  NameOf(from), NameOf(to);  // both are there
  return {-ToSeconds(Distance(to, from)), ToSeconds(Distance(from, to))};
}

}  // namespace hires::temporal
