#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "hires/planning/datum.h"

namespace hires::planning::hddl {

/// What is being read, for messages: "tidy.hddl:4:3: method 'm_go': <text>".
struct HddlSpot {
  std::string source;     ///< file
  std::string construct;  ///< "method 'm_go'", "(:types ...)"

  HddlSpot Within(std::string inner) const { return {source, std::move(inner)}; }
  [[noreturn]] void Fail(const Datum& at, const std::string& text) const;
};

/// A proper list.  @throws ConfigError: `wanted` says what it should be, "a list of parameters".
const Datum& RequireList(const HddlSpot& spot, const Datum& datum, std::string_view wanted);

/// The text of a symbol that can be a name: no keyword, no `-`, `=` or `<`, none of the characters
/// `!` and `%` in front that mark the planner's own names.
const std::string& RequireName(const HddlSpot& spot, const Datum& datum, std::string_view what);

/// A name or a variable with what stands behind its `-`.
struct HddlTyped {
  const Datum* datum{nullptr};     ///< the name or variable
  std::vector<std::string> types;  ///< several for (either a b); none if nothing is said
  Place type_place;
};

/// Reads `a b - t c - (either t u) d`, items `begin` and after of a list; `-t` is read as `- t`,
/// and commas between entries are passed over.
/// @param kind  kSymbol for names, kVariable for parameters.
/// @throws ConfigError also where a name stands twice (`unique`).
std::vector<HddlTyped> ReadTypedList(const HddlSpot& spot, const Datum& list, std::size_t begin,
                                     Datum::Kind kind, bool unique = true);

/// The fields `:name value` of a form, items `begin` and after.
class HddlFields {
 public:
  /// @throws ConfigError for names that are not `known`, stand twice or have no value.
  HddlFields(HddlSpot spot, const Datum& form, std::size_t begin,
             const std::vector<std::string>& known);

  const Datum* Find(const std::string& name) const;  ///< null if it is not there
  const Datum& Require(const std::string& name) const;
  /// The one of several spellings that is there.  @throws ConfigError if two are.
  const Datum* FindOneOf(const std::vector<std::string>& names) const;

 private:
  HddlSpot spot_;
  const Datum* form_;
  std::map<std::string, const Datum*> values_;
};

/// `((a) (b) ...)`, as SHOP2 has it, where `(and (a) (b) ...)` was to be written.
bool LacksAnd(const Datum& datum);

/// The items of `(and a b ...)`, with or without the `and`, of `()` none, else the datum itself.
std::vector<const Datum*> Conjuncts(const HddlSpot& spot, const Datum& datum);

/// The form `(define (domain name) ...)` or `(define (problem name) ...)`, the only one of its kind
/// in a text. @param kind  "domain" or "problem".
struct HddlDefinition {
  Datum form;
  std::string name;
};
HddlDefinition ReadDefinition(std::string_view text, const std::string& source,
                              std::string_view kind);

/// Requirements tell what the file may use, and need not: of those that are beyond this planner
/// (durative actions, numbers that change, preferences) there is one warning, and an error where
/// they are made use of. @throws ConfigError where one is no keyword.
void CheckRequirements(const HddlSpot& spot, const Datum& section,
                       std::vector<std::string>* warnings);

}  // namespace hires::planning::hddl
