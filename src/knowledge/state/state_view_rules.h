#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "hires/base/action.h"
#include "hires/knowledge/fluent.h"
#include "hires/knowledge/ontology.h"
#include "hires/knowledge/sparql.h"

namespace hires::knowledge {

/// Where one argument of an atom comes from (or several: kRanked, kRest).
struct AtomPart {
  enum class Kind {
    kInstance,         ///< the fluent's instance
    kConcept,          ///< its concept
    kConceptAndAbove,  ///< its concept and every one above, up to the rule's: an atom for each
    kFirst,            ///< the first filler of `role`
    kEach,             ///< a filler of `role`: an atom for each
    kRanked,           ///< likewise, and as a further argument its rank, from 1
    kRest,             ///< all fillers of `role`, as so many arguments
    kContent,          ///< the concept of what fills `role`: an atom for each
  };
  Kind kind;
  std::string_view role{};
};

/// How fluents of one concept, and those below, are said as atoms of one predicate.
struct AtomRule {
  static constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();

  std::string_view predicate;
  std::string_view concept_name;
  std::vector<AtomPart> parts;

  // The way back, where each fluent says one atom. No `word`: there is none.
  std::string_view word{};  ///< instances are called by it and then the thing: onMug1
  /// How many arguments, from the first, say which state variable it is; kAll: no variable, each
  /// atom stands for itself.
  std::size_t num_keys{kAll};
  /// Whom the state belongs to, where the atom does not name him.
  std::string_view owner_role{}, owner_concept{};

  std::string_view except{};  ///< a concept below that says nothing
};

/// The rows of "From fluents to the planner's atoms" in docs/ontology.md.
const std::vector<AtomRule>& AtomRules();
/// Rules of that predicate, case ignored.
std::vector<const AtomRule*> RulesOf(std::string_view predicate);

/// Whether the rule speaks of fluents of that concept.
bool Covers(const AtomRule& rule, const Fluent& fluent, const Ontology& ontology);
/// What a fluent that the rule covers says, arguments in lower case; `view` tells what contents
/// are.
std::vector<base::Atom> AtomsOf(const AtomRule& rule, const Fluent& fluent, const FluentView& view,
                                const Ontology& ontology);

/// @throws ConfigError naming the atom unless it has as many arguments as the rule's predicate.
void CheckArguments(const AtomRule& rule, const base::Atom& atom);
/// Makes the fluent say the atom; `view` tells how names are spelled and what they are.
/// @pre the rule has a way back.  @throws ConfigError for a concept the rule does not know.
void Say(const AtomRule& rule, const base::Atom& atom, const FluentView& view,
         const Ontology& ontology, Fluent* fluent);

}  // namespace hires::knowledge
