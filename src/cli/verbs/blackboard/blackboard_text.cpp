#include "cli/verbs/blackboard/blackboard_text.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <type_traits>

#include "hires/base/text.h"
#include "reports/text/report_table.h"

namespace hires::cli {
namespace {

using nlohmann::ordered_json;

template <typename Number>
bool ReadWhole(const std::string& text, Number* number) {
  const char* end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, *number);
  return error == std::errc() && stopped == end;
}

std::string MomentText(double time) { return std::isinf(time) ? "ever" : fmt::format("{}", time); }

/// "ever", "12.5", "12.5..13".
std::string BoundsText(const temporal::Bounds& bounds) {
  if (bounds.earliest == bounds.latest) return MomentText(bounds.earliest);
  return MomentText(bounds.earliest) + ".." + MomentText(bounds.latest);
}

std::string FillerText(const knowledge::Filler& filler) {
  return std::visit([](const auto& value) { return fmt::format("{}", value); }, filler);
}

std::string PropertiesText(const knowledge::Fluent& fluent) {
  std::vector<std::string> texts;
  for (const knowledge::Property& property : fluent.properties) {
    texts.push_back(property.role + "=" + FillerText(property.filler));
  }
  return base::Join(texts, " ");
}

std::string Counted(std::size_t count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

std::size_t Total(const knowledge::LoadSummary& summary) {
  std::size_t total = 0;
  for (const auto& [name, count] : summary.concepts) total += count;
  return total;
}

ordered_json MomentJson(double time) {
  return std::isinf(time) ? ordered_json(nullptr) : ordered_json(time);
}

ordered_json PropertyJson(const knowledge::Property& property) {
  ordered_json filler;
  std::visit([&](const auto& value) { filler = value; }, property.filler);
  return ordered_json::array({property.role, property.type, filler});
}

ordered_json FluentJson(const knowledge::Fluent& fluent) {
  ordered_json properties = ordered_json::array();
  for (const knowledge::Property& property : fluent.properties) {
    properties.push_back(PropertyJson(property));
  }
  return {{"class", fluent.concept_name},
          {"instance", fluent.instance},
          {"start", {MomentJson(fluent.start.earliest), MomentJson(fluent.start.latest)}},
          {"finish", {MomentJson(fluent.finish.earliest), MomentJson(fluent.finish.latest)}},
          {"properties", properties}};
}

const char* LabelText(const knowledge::Episode& episode) {
  return episode.label == knowledge::Episode::Label::kReal ? "real" : "imagined";
}

ordered_json EpisodeJson(const knowledge::Episode& episode) {
  return {{"id", episode.id},
          {"name", episode.name},
          {"task", episode.task},
          {"outcome", episode.outcome},
          {"label", LabelText(episode)},
          {"parent", episode.parent},
          {"start", MomentJson(episode.start)},
          {"finish", MomentJson(episode.finish)}};
}

}  // namespace

knowledge::Filler ParseFiller(const std::string& text) {
  std::int64_t integer = 0;
  double real = 0.0;
  if (ReadWhole(text, &integer)) return integer;
  if (ReadWhole(text, &real) && std::isfinite(real)) return real;
  if (text == "true" || text == "false") return text == "true";
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') {
    return text.substr(1, text.size() - 2);
  }
  return text;
}

std::string LoadText(const knowledge::LoadSummary& summary) {
  std::vector<std::vector<std::string>> rows{{"class", "fluents"}};
  for (const auto& [name, count] : summary.concepts) rows.push_back({name, std::to_string(count)});
  std::string text = summary.concepts.empty() ? "" : reports::FormatTable(rows) + "\n";
  text += fmt::format("{} of {} {} added", Counted(Total(summary), "fluent"),
                      summary.concepts.size(), summary.concepts.size() == 1 ? "class" : "classes");
  if (summary.known > 0) text += fmt::format(", {} known already", summary.known);
  if (summary.modifications > 0) {
    text += ", " + Counted(summary.modifications, "modification") + " applied";
  }
  if (!summary.topics.empty()) text += "; topics: " + base::Join(summary.topics, ", ");
  return text + "\n";
}

std::string FluentsText(const std::vector<knowledge::Fluent>& fluents) {
  std::vector<std::vector<std::string>> rows{{"class", "instance", "since", "until", "properties"}};
  for (const knowledge::Fluent& fluent : fluents) {
    rows.push_back({fluent.concept_name, fluent.instance, BoundsText(fluent.start),
                    BoundsText(fluent.finish), PropertiesText(fluent)});
  }
  return (fluents.empty() ? "" : reports::FormatTable(rows) + "\n") +
         Counted(fluents.size(), "fluent") + "\n";
}

std::string EpisodesText(const std::vector<knowledge::Episode>& episodes) {
  std::vector<std::vector<std::string>> rows{
      {"#", "name", "label", "parent", "start", "finish", "outcome", "task"}};
  for (const knowledge::Episode& episode : episodes) {
    rows.push_back({std::to_string(episode.id), episode.name, LabelText(episode),
                    episode.parent == 0 ? "" : std::to_string(episode.parent),
                    fmt::format("{}", episode.start),
                    std::isinf(episode.finish) ? "runs" : fmt::format("{}", episode.finish),
                    episode.outcome, episode.task});
  }
  return (episodes.empty() ? "" : reports::FormatTable(rows) + "\n") +
         Counted(episodes.size(), "episode") + "\n";
}

std::string StatisticsText(const knowledge::Store::Statistics& s, const std::string& path) {
  return reports::FormatTable({{"store", path},
                               {"fluents", std::to_string(s.fluents)},
                               {"instances", std::to_string(s.instances)},
                               {"changes", std::to_string(s.changes)},
                               {"episodes", std::to_string(s.episodes)},
                               {"bytes", std::to_string(s.bytes)},
                               {"schema", std::to_string(s.schema)}});
}

ordered_json ToJson(const knowledge::LoadSummary& summary) {
  return {{"fluents", Total(summary)},
          {"classes", ordered_json(summary.concepts)},
          {"known", summary.known},
          {"modifications", summary.modifications},
          {"topics", summary.topics}};
}

ordered_json ToJson(const std::vector<knowledge::Fluent>& fluents) {
  ordered_json json = ordered_json::array();
  for (const knowledge::Fluent& fluent : fluents) json.push_back(FluentJson(fluent));
  return json;
}

ordered_json ToJson(const std::vector<knowledge::Episode>& episodes) {
  ordered_json json = ordered_json::array();
  for (const knowledge::Episode& episode : episodes) json.push_back(EpisodeJson(episode));
  return json;
}

ordered_json ToJson(const knowledge::Store::Statistics& s, const std::string& path) {
  return {{"store", path},        {"fluents", s.fluents},   {"instances", s.instances},
          {"changes", s.changes}, {"episodes", s.episodes}, {"bytes", s.bytes},
          {"schema", s.schema}};
}

}  // namespace hires::cli
