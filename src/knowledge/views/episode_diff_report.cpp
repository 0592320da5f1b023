#include "hires/knowledge/episode_diff_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "hires/base/overloaded.h"
#include "hires/base/text.h"

namespace hires::knowledge {
namespace {

using Json = nlohmann::ordered_json;
using Verdict = InstanceDiff::Verdict;
constexpr std::size_t kNumColumns = 6;
using Row = std::array<std::string, kNumColumns>;

std::string_view ToWord(Episode::Label label) {
  return label == Episode::Label::kReal ? "real" : "imagined";
}

std::string_view ToWord(Change::Kind kind) {
  if (kind == Change::Kind::kAdded) return "added";
  return kind == Change::Kind::kUpdated ? "updated" : "removed";
}

std::string_view ToWord(Verdict verdict) {
  switch (verdict) {
    case Verdict::kOnlyInA:
      return "only_in_a";
    case Verdict::kOnlyInB:
      return "only_in_b";
    case Verdict::kDiffering:
      return "differing";
    case Verdict::kSame:
      break;
  }
  return "same";
}

// Table -----------------------------------------------------------------------------------------

std::string ToText(const Filler& filler) {
  return std::visit(
      base::Overloaded{[](const std::string& text) { return text; },
                       [](bool truth) { return std::string(truth ? "true" : "false"); },
                       [](auto number) { return fmt::format("{}", number); }},
      filler);
}

std::string ToText(const std::vector<Filler>& fillers) {
  if (fillers.empty()) return "-";
  std::vector<std::string> texts;
  for (const Filler& filler : fillers) texts.push_back(ToText(filler));
  return base::Join(texts, ", ");
}

std::string Time(const std::optional<EpisodeChange>& change) {
  return change ? fmt::format("{:.3f}", change->time) : "-";
}

std::string KindOf(const ComparedChange& change) {
  if (!change.InBoth()) return std::string(ToWord((change.a ? change.a : change.b)->kind));
  const std::string_view a = ToWord(change.a->kind), b = ToWord(change.b->kind);
  return a == b ? std::string(a) : fmt::format("{}/{}", a, b);
}

std::string Remarks(const ComparedChange& change) {
  std::vector<std::string> remarks;
  if (!change.b) remarks.emplace_back("only in a");
  if (!change.a) remarks.emplace_back("only in b");
  if (change.other_concept) {
    remarks.push_back(fmt::format("concept {} | {}", change.a->fluent.concept_name,
                                  change.b->fluent.concept_name));
  }
  for (const PropertyDifference& difference : change.differences) {
    remarks.push_back(
        fmt::format("{} {} | {}", difference.role, ToText(difference.a), ToText(difference.b)));
  }
  if (change.out_of_order) remarks.emplace_back("out of order");
  if (change.late) remarks.emplace_back(change.delay > 0.0 ? "later in b" : "earlier in b");
  return base::Join(remarks, "; ");
}

bool IsPlain(const ComparedChange& change) {
  return change.SameContent() && !change.late && !change.out_of_order;
}

Row MakeRow(const std::string& instance, const ComparedChange& change) {
  return {instance,
          KindOf(change),
          Time(change.a),
          Time(change.b),
          change.InBoth() ? fmt::format("{:+.3f}", change.delay) : "-",
          IsPlain(change) ? "same" : Remarks(change)};
}

/// Numbers stand to the right of their columns; nothing stands behind the last word of a line.
std::string Line(const Row& row, const std::array<std::size_t, kNumColumns>& widths) {
  std::string line;
  for (std::size_t i = 0; i + 1 < kNumColumns; ++i) {
    const bool is_number = i >= 2;
    line += is_number ? fmt::format("{:>{}}  ", row[i], widths[i])
                      : fmt::format("{:<{}}  ", row[i], widths[i]);
  }
  return line + row.back() + "\n";
}

std::string Lines(const std::vector<Row>& rows) {
  std::array<std::size_t, kNumColumns> widths{};
  for (const Row& row : rows) {
    for (std::size_t i = 0; i < kNumColumns; ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  for (const Row& row : rows) text += Line(row, widths);
  return text;
}

std::string Describe(char letter, const Episode& episode) {
  const double duration = episode.finish - episode.start;
  return fmt::format("{}: episode {} ({}), {}, task '{}', {}\n", letter, episode.id, episode.name,
                     ToWord(episode.label), episode.task,
                     std::isfinite(duration)
                         ? fmt::format("outcome '{}' after {:.3f} s", episode.outcome, duration)
                         : "running");
}

std::string Summary(const EpisodeDiff& diff) {
  return fmt::format(
      "instances: {} same, {} differing, {} only in a, {} only in b; changes: {} late, {} out of "
      "order\n",
      diff.Count(Verdict::kSame), diff.Count(Verdict::kDiffering), diff.Count(Verdict::kOnlyInA),
      diff.Count(Verdict::kOnlyInB), diff.num_late(), diff.num_out_of_order());
}

// JSON ------------------------------------------------------------------------------------------

Json ToJsonTime(double time) { return std::isfinite(time) ? Json(time) : Json(nullptr); }

Json ToJson(const Episode& episode) {
  return {{"id", episode.id},
          {"name", episode.name},
          {"label", ToWord(episode.label)},
          {"task", episode.task},
          {"outcome", episode.outcome},
          {"parent", episode.parent},
          {"start", ToJsonTime(episode.start)},
          {"finish", ToJsonTime(episode.finish)}};
}

Json ToJson(const std::vector<Filler>& fillers) {
  Json list = Json::array();
  for (const Filler& filler : fillers) {
    std::visit([&](const auto& value) { list.push_back(value); }, filler);
  }
  return list;
}

Json ToJson(const std::optional<EpisodeChange>& change) {
  if (!change) return nullptr;
  return {{"change", ToWord(change->kind)},
          {"concept", change->fluent.concept_name},
          {"time", ToJsonTime(change->time)},
          {"moment", change->moment}};
}

Json ToJson(const ComparedChange& change) {
  Json differences = Json::array();
  for (const PropertyDifference& difference : change.differences) {
    differences.push_back(
        {{"role", difference.role}, {"a", ToJson(difference.a)}, {"b", ToJson(difference.b)}});
  }
  return {{"a", ToJson(change.a)},
          {"b", ToJson(change.b)},
          {"other_concept", change.other_concept},
          {"differences", std::move(differences)},
          {"delay", ToJsonTime(change.delay)},
          {"late", change.late},
          {"out_of_order", change.out_of_order}};
}

Json ToJson(const InstanceDiff& instance) {
  Json changes = Json::array();
  for (const ComparedChange& change : instance.changes) changes.push_back(ToJson(change));
  return {{"instance", instance.instance},
          {"verdict", ToWord(instance.verdict)},
          {"changes", std::move(changes)}};
}

Json ToJsonSummary(const EpisodeDiff& diff) {
  return {{"same", diff.Count(Verdict::kSame)},
          {"differing", diff.Count(Verdict::kDiffering)},
          {"only_in_a", diff.Count(Verdict::kOnlyInA)},
          {"only_in_b", diff.Count(Verdict::kOnlyInB)},
          {"late", diff.num_late()},
          {"out_of_order", diff.num_out_of_order()}};
}

}  // namespace

std::string ToTable(const EpisodeDiff& diff, bool all) {
  std::vector<Row> rows = {{"instance", "change", "time a", "time b", "delay", "a | b"}};
  for (const InstanceDiff& instance : diff.instances) {
    for (const ComparedChange& change : instance.changes) {
      if (all || !IsPlain(change)) rows.push_back(MakeRow(instance.instance, change));
    }
  }
  return Describe('a', diff.a) + Describe('b', diff.b) + (rows.size() > 1 ? Lines(rows) : "") +
         Summary(diff);
}

std::string ToJson(const EpisodeDiff& diff) {
  Json instances = Json::array();
  for (const InstanceDiff& instance : diff.instances) instances.push_back(ToJson(instance));
  const Json json = {{"a", ToJson(diff.a)},
                     {"b", ToJson(diff.b)},
                     {"summary", ToJsonSummary(diff)},
                     {"instances", std::move(instances)}};
  return json.dump(2) + "\n";
}

}  // namespace hires::knowledge
