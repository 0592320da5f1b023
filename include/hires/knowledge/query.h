#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hires/knowledge/fluent.h"
#include "hires/temporal/interval.h"

namespace hires::knowledge {

/// Which fluents are wanted: those that meet every condition given. An empty query means all that
/// hold now in the real world.
struct FluentQuery {
  struct ConceptFilter {
    enum class Reach { kExact, kBelow, kAbove };
    std::string name;
    Reach reach{Reach::kBelow};
  };
  struct PropertyFilter {
    std::string role;
    /// Any filler where empty. Text compares without regard to case; 1 and 1.0 are the same.
    std::optional<Filler> filler;
  };
  struct TimeFilter {
    enum class Kind { kNow, kAt, kAllen, kEver };
    Kind kind{Kind::kNow};  ///< kNow: not closed
    double at{0.0};  ///< kAt [s]: start.earliest <= at < finish.latest, that is, it may hold then
    /// kAllen: the fluent's interval may stand in one of `relations` to this one.
    temporal::Interval interval;
    std::vector<temporal::Allen> relations;
  };

  std::vector<ConceptFilter> concepts;  ///< any of them; empty: every concept
  std::string instance;                 ///< "" any
  std::vector<PropertyFilter> properties;
  bool all_properties{true};  ///< each of them, or one of them
  TimeFilter time;
  /// Only what was written in it. Who names an imagined one asks for its world, whatever `label`.
  std::optional<std::int64_t> episode;
  std::optional<Episode::Label> label{Episode::Label::kReal};  ///< empty: both
  /// A select query on top: its first variable must be the fluent's instance. It looks at the state
  /// of one world at the moment of the query (kAt, else now).
  std::string sparql;
  std::size_t limit{1000};  ///< at most so many in one answer
  std::string cursor;       ///< of the answer before; "" from the beginning
};

struct FluentPage {
  std::vector<Fluent> fluents;  ///< by instance name (case ignored), real ones first, then start
  std::string next;             ///< cursor of the next page; "" there is none
  std::uint64_t sequence{0};    ///< last change that the answer knows of
  std::uint64_t visited{0};     ///< rows of the store looked at for it: its cost on any machine
};

}  // namespace hires::knowledge
