#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "hires/temporal/interval.h"

namespace hires::knowledge {

/// The filler of a property: a link to an instance, or a value.
using Filler = std::variant<std::string, double, std::int64_t, bool>;

/// One property of a fluent: [role, filler type, filler]. The type is a concept for a link
/// ("Pose"), or one of xsd:float, xsd:double, xsd:int, xsd:integer, xsd:boolean, xsd:string.
struct Property {
  std::string role;
  std::string type;
  Filler filler;
  bool IsLink() const { return type.compare(0, 4, "xsd:") != 0; }
};
bool operator==(const Property& a, const Property& b);

/// A statement about the world with bounds on when it begins and ends: an instance of a concept
/// with its properties. Times are main ROS time [s]; "since ever" is -infinity, "for ever"
/// +infinity.
struct Fluent {
  std::string concept_name;  ///< as the ontology spells it
  std::string instance;
  std::vector<Property> properties;  ///< in the order in which they were given
  temporal::Bounds start{-temporal::kForever, -temporal::kForever};
  temporal::Bounds finish{temporal::kForever, temporal::kForever};
};
bool operator==(const Fluent& a, const Fluent& b);

/// Who says so. The execution monitor tells what it does (activities, plans) and what came of it,
/// never what it only expects of the world.
enum class Source { kKnowledge, kObservation, kPerson, kMonitor };
std::string_view ToString(Source source);  ///< "knowledge", "observation", "person", "monitor"
Source ReadSource(std::string_view word);  ///< @throws ConfigError

/// One stretch of robot life, or of an imagined one.
struct Episode {
  enum class Label { kReal, kImagined };
  std::int64_t id{0};  ///< 0: what is known outside of any episode
  std::string name;    ///< start time, ISO 8601 with seconds, made unique with a suffix
  std::string task;
  std::string outcome;  ///< "" while it runs
  Label label{Label::kReal};
  std::int64_t parent{0};  ///< episode in which it was imagined, or that it repeats
  double start{0.0};       ///< [s]
  double finish{temporal::kForever};
};

/// One change of the Blackboard. Sequence numbers count from 1 without a gap, in the order in which
/// changes were acknowledged.
struct Change {
  enum class Kind { kAdded, kUpdated, kRemoved };
  std::uint64_t sequence{0};
  Kind kind{Kind::kAdded};
  Fluent fluent;     ///< after the change; of a removed one, with its closed validity
  double time{0.0};  ///< from when on it holds [s]
  std::int64_t episode{0};
  Episode::Label label{Episode::Label::kReal};
  Source source{Source::kObservation};
};

}  // namespace hires::knowledge
