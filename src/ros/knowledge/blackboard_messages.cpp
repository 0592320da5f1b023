#include "hires/ros/knowledge/blackboard_messages.h"

#include <fmt/format.h>

#include <cmath>
#include <type_traits>

#include "hires/base/error.h"
#include "hires/base/overloaded.h"
#include "hires/base/short_text.h"

namespace hires_ros {
namespace {

namespace knowledge = hires::knowledge;
namespace temporal = hires::temporal;
using hires::base::ConfigError;
using temporal::kForever;

constexpr std::size_t kDefaultLimit = 1000;  // fluents in an answer

bool IsReal(const std::string& type) { return type == "xsd:float" || type == "xsd:double"; }
bool IsInteger(const std::string& type) { return type == "xsd:int" || type == "xsd:integer"; }

knowledge::Filler FillerOf(const hires::FluentProperty& message) {
  if (IsReal(message.type)) return message.real;
  if (IsInteger(message.type)) return message.integer;
  if (message.type == "xsd:boolean") return message.truth != 0;
  return message.text;
}

knowledge::Property FromMessage(const hires::FluentProperty& message) {
  return {message.role, message.type, FillerOf(message)};
}

/// Number, whole number, truth value or text go where readers of that type look for them.
hires::FluentProperty ToMessage(const knowledge::Property& property) {
  hires::FluentProperty message;
  message.role = property.role;
  message.type = property.type;
  std::visit(hires::base::Overloaded{
                 [&](double value) { message.real = value; },
                 [&](std::int64_t value) {
                   message.integer = value;
                   message.real = static_cast<double>(value);
                 },
                 [&](bool value) { message.truth = value; },
                 [&](const std::string& value) { message.text = value; },
             },
             property.filler);
  return message;
}

temporal::Bounds BoundsOf(double earliest, double latest, double for_zero) {
  const bool is_zero = earliest == 0.0 && latest == 0.0;
  if (is_zero && !std::signbit(earliest) && !std::signbit(latest)) return {for_zero, for_zero};
  return {earliest, latest};
}

/// The moment 0, so that it is not taken for "ever".
temporal::Bounds Unambiguous(const temporal::Bounds& bounds) {
  if (bounds.earliest == 0.0 && bounds.latest == 0.0) return {-0.0, -0.0};
  return bounds;
}

knowledge::Source SourceOf(std::uint8_t source) {
  switch (source) {
    case hires::Assertion::OBSERVATION:
      return knowledge::Source::kObservation;
    case hires::Assertion::KNOWLEDGE:
      return knowledge::Source::kKnowledge;
    case hires::Assertion::PERSON:
      return knowledge::Source::kPerson;
    case hires::Assertion::MONITOR:
      return knowledge::Source::kMonitor;
    default:
      throw ConfigError(fmt::format(
          "by.source is {}, wanted OBSERVATION (0), KNOWLEDGE (1), PERSON (2) or MONITOR (3)",
          source));
  }
}

std::uint8_t CodeOf(knowledge::Source source) {
  switch (source) {
    case knowledge::Source::kKnowledge:
      return hires::Assertion::KNOWLEDGE;
    case knowledge::Source::kPerson:
      return hires::Assertion::PERSON;
    case knowledge::Source::kMonitor:
      return hires::Assertion::MONITOR;
    case knowledge::Source::kObservation:
      break;
  }
  return hires::Assertion::OBSERVATION;
}

using Reach = knowledge::FluentQuery::ConceptFilter::Reach;
using TimeKind = knowledge::FluentQuery::TimeFilter::Kind;

void AppendConcepts(const std::vector<std::string>& names, Reach reach,
                    knowledge::FluentQuery* query) {
  for (const std::string& name : names) query->concepts.push_back({name, reach});
}

knowledge::FluentQuery::PropertyFilter FilterOf(const hires::FluentProperty& message) {
  if (message.type.empty()) return {message.role, std::nullopt};
  return {message.role, FillerOf(message)};
}

/// The filler's type is not known here; any type of its kind does.
hires::FluentProperty ToMessage(const knowledge::FluentQuery::PropertyFilter& filter) {
  if (!filter.filler) {
    hires::FluentProperty message;
    message.role = filter.role;
    return message;
  }
  const char* type = std::visit(
      hires::base::Overloaded{
          [](double) { return "xsd:double"; }, [](std::int64_t) { return "xsd:integer"; },
          [](bool) { return "xsd:boolean"; }, [](const std::string&) { return "xsd:string"; }},
      *filter.filler);
  return ToMessage(knowledge::Property{filter.role, type, *filter.filler});
}

knowledge::FluentQuery::TimeFilter TimeOf(const hires::FluentQuery& message) {
  knowledge::FluentQuery::TimeFilter time;
  if (message.time_kind > hires::FluentQuery::EVER) {
    throw ConfigError(fmt::format(
        "query.time_kind is {}, wanted NOW (0), AT (1), ALLEN (2), EVER (3)", message.time_kind));
  }
  constexpr TimeKind kKinds[] = {TimeKind::kNow, TimeKind::kAt, TimeKind::kAllen, TimeKind::kEver};
  time.kind = kKinds[message.time_kind];
  time.at = message.at;
  time.interval = {message.start, message.finish};
  for (const std::string& word : message.relations) {
    time.relations.push_back(temporal::ReadAllen(word));
  }
  return time;
}

std::optional<knowledge::Episode::Label> LabelOf(std::uint8_t world) {
  switch (world) {
    case hires::FluentQuery::REAL:
      return knowledge::Episode::Label::kReal;
    case hires::FluentQuery::IMAGINED:
      return knowledge::Episode::Label::kImagined;
    case hires::FluentQuery::BOTH:
      return std::nullopt;
    default:
      throw ConfigError(
          fmt::format("query.world is {}, wanted REAL (0), IMAGINED (1) or BOTH (2)", world));
  }
}

}  // namespace

knowledge::Fluent FromMessage(const hires::Fluent& message) {
  knowledge::Fluent fluent;
  fluent.concept_name = message.concept_name;
  fluent.instance = message.instance;
  fluent.properties.reserve(message.properties.size());
  for (const auto& property : message.properties)
    fluent.properties.push_back(FromMessage(property));
  fluent.start = BoundsOf(message.start_earliest, message.start_latest, -kForever);
  fluent.finish = BoundsOf(message.finish_earliest, message.finish_latest, kForever);
  return fluent;
}

hires::Fluent ToMessage(const knowledge::Fluent& fluent) {
  hires::Fluent message;
  message.concept_name = fluent.concept_name;
  message.instance = fluent.instance;
  message.properties.reserve(fluent.properties.size());
  for (const auto& property : fluent.properties) message.properties.push_back(ToMessage(property));
  const temporal::Bounds start = Unambiguous(fluent.start);
  const temporal::Bounds finish = Unambiguous(fluent.finish);
  message.start_earliest = start.earliest;
  message.start_latest = start.latest;
  message.finish_earliest = finish.earliest;
  message.finish_latest = finish.latest;
  return message;
}

std::vector<knowledge::Fluent> FromMessages(const std::vector<hires::Fluent>& messages) {
  std::vector<knowledge::Fluent> fluents;
  fluents.reserve(messages.size());
  for (const hires::Fluent& message : messages) fluents.push_back(FromMessage(message));
  return fluents;
}

std::vector<hires::Fluent> ToMessages(const std::vector<knowledge::Fluent>& fluents) {
  std::vector<hires::Fluent> messages;
  messages.reserve(fluents.size());
  for (const knowledge::Fluent& fluent : fluents) messages.push_back(ToMessage(fluent));
  return messages;
}

knowledge::Assertion FromMessage(const hires::Assertion& message) {
  return {SourceOf(message.source), message.episode, message.time};
}

hires::Assertion ToMessage(const knowledge::Assertion& assertion) {
  hires::Assertion message;
  message.source = CodeOf(assertion.source);
  message.episode = assertion.episode;
  message.time = assertion.time;
  return message;
}

knowledge::Episode FromMessage(const hires::Episode& message) {
  knowledge::Episode episode;
  episode.id = message.id;
  episode.name = message.name;
  episode.task = message.task;
  episode.outcome = message.outcome;
  if (message.imagined) episode.label = knowledge::Episode::Label::kImagined;
  episode.parent = message.parent;
  episode.start = message.start;
  episode.finish = message.finish;
  return episode;
}

hires::Episode ToMessage(const knowledge::Episode& episode) {
  hires::Episode message;
  message.id = episode.id;
  message.name = episode.name;
  message.task = episode.task;
  message.outcome = episode.outcome;
  message.imagined = episode.label == knowledge::Episode::Label::kImagined;
  message.parent = episode.parent;
  message.start = episode.start;
  message.finish = episode.finish;
  return message;
}

knowledge::FluentQuery FromMessage(const hires::FluentQuery& message) {
  knowledge::FluentQuery query;
  AppendConcepts(message.below, Reach::kBelow, &query);
  AppendConcepts(message.exact, Reach::kExact, &query);
  AppendConcepts(message.above, Reach::kAbove, &query);
  query.instance = message.instance;
  for (const auto& property : message.properties) query.properties.push_back(FilterOf(property));
  query.all_properties = !message.any_property;
  query.time = TimeOf(message);
  if (message.in_episode) query.episode = message.episode;
  query.label = LabelOf(message.world);
  query.sparql = message.sparql;
  query.limit = message.limit == 0 ? kDefaultLimit : message.limit;
  query.cursor = message.cursor;
  return query;
}

hires::FluentQuery ToMessage(const knowledge::FluentQuery& query) {
  hires::FluentQuery message;
  for (const auto& filter : query.concepts) {
    auto& names = filter.reach == Reach::kBelow   ? message.below
                  : filter.reach == Reach::kExact ? message.exact
                                                  : message.above;
    names.push_back(filter.name);
  }
  message.instance = query.instance;
  for (const auto& filter : query.properties) message.properties.push_back(ToMessage(filter));
  message.any_property = !query.all_properties;
  message.time_kind = static_cast<std::uint8_t>(query.time.kind);
  message.at = query.time.at;
  message.start = query.time.interval.start;
  message.finish = query.time.interval.finish;
  for (const temporal::Allen relation : query.time.relations) {
    message.relations.emplace_back(temporal::ToString(relation));
  }
  message.in_episode = query.episode.has_value();
  message.episode = query.episode.value_or(0);
  message.world = !query.label ? hires::FluentQuery::BOTH
                  : *query.label == knowledge::Episode::Label::kImagined
                      ? hires::FluentQuery::IMAGINED
                      : hires::FluentQuery::REAL;
  message.sparql = query.sparql;
  message.limit = static_cast<std::uint32_t>(query.limit);
  message.cursor = query.cursor;
  return message;
}

knowledge::Change FromMessage(const hires::FluentChange& message) {
  if (message.kind > hires::FluentChange::REMOVED) {
    throw ConfigError(
        fmt::format("kind is {}, wanted ADDED (0), UPDATED (1) or REMOVED (2)", message.kind));
  }
  knowledge::Change change;
  change.sequence = message.sequence;
  change.kind = static_cast<knowledge::Change::Kind>(message.kind);
  change.fluent = FromMessage(message.fluent);
  change.time = message.time;
  change.episode = message.episode;
  if (message.imagined) change.label = knowledge::Episode::Label::kImagined;
  change.source = SourceOf(message.source);
  return change;
}

hires::FluentChange ToMessage(const knowledge::Change& change) {
  hires::FluentChange message;
  message.sequence = change.sequence;
  message.kind = static_cast<std::uint8_t>(change.kind);
  message.fluent = ToMessage(change.fluent);
  message.time = change.time;
  message.episode = change.episode;
  message.imagined = change.label == knowledge::Episode::Label::kImagined;
  message.source = CodeOf(change.source);
  return message;
}

hires::FluentChanges ToMessage(const knowledge::DemandUpdate& update) {
  hires::FluentChanges message;
  message.snapshot = update.snapshot;
  message.first_sequence = update.first_sequence;
  message.last_sequence = update.last_sequence;
  message.changes.reserve(update.changes.size());
  for (const knowledge::Change& change : update.changes)
    message.changes.push_back(ToMessage(change));
  return message;
}

knowledge::DemandTopic FromMessage(const hires::DemandRequest& message) {
  knowledge::DemandTopic topic;
  topic.name = message.name;
  topic.exact = message.exact;
  topic.below = message.below;
  topic.above = message.above;
  topic.properties = message.properties;
  topic.all_properties = message.all_properties;
  topic.queries = message.queries;
  return topic;
}

}  // namespace hires_ros
