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
    std::optional<Filler> filler;  ///< any filler where empty
  };
  struct TimeFilter {
    enum class Kind { kNow, kAt, kAllen, kEver };
    Kind kind{Kind::kNow};  ///< kNow: not closed
    double at{0.0};         ///< kAt: holds at that time [s], as far as the bounds allow
    temporal::Interval
        interval;  ///< kAllen: the fluent's interval stands in one of `relations` to it
    std::vector<temporal::Allen> relations;
  };

  std::vector<ConceptFilter> concepts;  ///< any of them; empty: every concept
  std::string instance;                 ///< "" any
  std::vector<PropertyFilter> properties;
  bool all_properties{true};  ///< each of them, or one of them
  TimeFilter time;
  std::optional<std::int64_t> episode;                         ///< only what was written in it
  std::optional<Episode::Label> label{Episode::Label::kReal};  ///< empty: both
  std::string sparql;       ///< a select query on top: its ?instance must be the fluent's
  std::size_t limit{1000};  ///< at most so many in one answer
  std::string cursor;       ///< of the answer before; "" from the beginning
};

struct FluentPage {
  std::vector<Fluent> fluents;  ///< by instance name, then start
  std::string next;             ///< cursor of the next page; "" there is none
  std::uint64_t sequence{0};    ///< last change that the answer knows of
};

}  // namespace hires::knowledge
