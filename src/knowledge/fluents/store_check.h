#pragma once

#include <string>

#include "hires/knowledge/fluent.h"
#include "hires/knowledge/ontology.h"

namespace hires::knowledge {

constexpr std::size_t kMaxNameBytes = 1000;
constexpr std::size_t kMaxValueBytes = 1u << 20;
constexpr std::size_t kMaxProperties = 1000;
constexpr std::size_t kMaxFluentBytes = 8u << 20;  ///< of all names and values of one fluent

/// One of the control characters of ASCII.
bool IsControl(char c);

/// Does the fluent say something that the ontology allows, and the store can keep? Times are looked
/// at each for itself: bounds in order, nothing begins at the end of time or ends before it.
/// @throws ConfigError naming instance, property, what came and what was wanted.
void CheckFluent(const Fluent& fluent, const Ontology& ontology);

/// May `source` say something about this concept? The execution monitor may tell of its own doing
/// (ExecutionRecord and below), never of how the world is.  @throws ConfigError
void CheckSource(Source source, const Fluent& fluent, const Ontology& ontology);

/// Whether a fluent may have this value; whole numbers may be written as 2.0.
bool CanHave(const Ontology::Relation& relation, const Filler& filler);
/// @throws ConfigError unless it can, naming relation, what came and what was wanted.
void CheckFiller(const Ontology::Relation& relation, const Filler& filler);

/// UTF-8, not empty, at most kMaxNameBytes, no control characters.
/// @throws ConfigError beginning with `what`.
void CheckName(const std::string& what, const std::string& name);

/// @throws ConfigError unless start.earliest <= finish.latest, naming both.
void CheckOrder(const std::string& instance, const temporal::Bounds& start,
                const temporal::Bounds& finish);

}  // namespace hires::knowledge
