#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "hires/planning/datum.h"
#include "planning/language/hddl_syntax.h"

namespace hires::planning {

/// What an HDDL domain declares. Types are numbered; 0 is `object`, the type of everything.
struct HddlVocabulary {
  static constexpr int kObject = 0;

  struct Type {
    std::string name;          ///< "place"; (either cup book) is "cup/book"
    std::vector<int> parents;  ///< in the order of declaration; none: object
    std::vector<int> members;  ///< of an (either ...); else empty
    std::vector<bool> is_a;    ///< by type, as far as those existed: itself and its ancestors
    bool is_joint{false};      ///< of objects listed with several types: the parents
  };
  struct Signature {
    std::string kind;  ///< "predicate", "function", "task", "action"
    std::string name;
    std::vector<int> types;  ///< of the arguments
  };
  /// The atoms that must hold before an action: those that no action can change, and the others.
  struct Needs {
    std::vector<std::string> parameters;
    std::vector<Datum> fixed, changing;
  };
  /// An object that a domain names and leaves for its problems to declare.
  struct OpenObject {
    std::string name;
    int type;  ///< which it must be of
    Place place;
    std::string construct;  ///< where it is named, for messages
  };
  using Signatures = std::map<std::string, Signature>;

  std::vector<Type> types;
  std::map<std::string, int> type_index;
  std::map<std::string, int> objects;     ///< constants (and a problem's objects): name to type
  std::vector<std::string> object_order;  ///< their names as declared
  Signatures predicates;
  Signatures functions;
  Signatures tasks;                    ///< compound ones and actions
  std::map<std::string, Needs> needs;  ///< of actions, by name with its `!`
  std::vector<OpenObject> open_objects;
  bool has_costs{false};        ///< (total-cost) is declared
  bool has_all_objects{false};  ///< no object may be left open any more
};

}  // namespace hires::planning

/// The parts of the HDDL reader.
namespace hires::planning::hddl {

/// Reads (:types ...). A type that stands behind a `-` only is declared by that, as in several
/// published domains.
/// @throws ConfigError where a type contains itself, or there are more than 1000.
void ReadTypeSection(const HddlSpot& spot, const Datum* section, HddlVocabulary* vocabulary);

/// Everything of type `type` is of type `other`.
bool IsA(const HddlVocabulary& vocabulary, int type, int other);

/// The number of a type written behind `-`; (either ...) makes a new one. Nothing written: object.
int TypeOf(const HddlSpot& spot, const HddlTyped& typed, HddlVocabulary* vocabulary);

/// Reads constants or objects, items 1 and after of `section`, into `vocabulary->objects`.
/// One that is listed with several types, here or before, is of all of them.
/// @throws ConfigError for (either ...) and where that makes too many types.
void ReadObjects(const HddlSpot& spot, const Datum& section, HddlVocabulary* vocabulary);

/// Reads a typed list of parameters as a signature.
HddlVocabulary::Signature ReadSignature(const HddlSpot& spot, std::string kind, std::string name,
                                        const Datum& list, std::size_t begin,
                                        HddlVocabulary* vocabulary);
void ReadPredicates(const HddlSpot& spot, const Datum& section, HddlVocabulary* vocabulary);
/// Functions other than (total-cost) must be constant: the initial state says their values.
void ReadFunctions(const HddlSpot& spot, const Datum& section, HddlVocabulary* vocabulary);

/// Types of the variables that stand around a term.
using HddlVariables = std::map<std::string, int>;

/// `term`, whose first item names one of `signatures`, checked: declared name, number of arguments,
/// declared variables and objects, objects of the right type. Several published domains name
/// objects that only their problems declare: those are kept as open objects.
const HddlVocabulary::Signature& CheckTerm(const HddlSpot& spot, const Datum& term,
                                           std::string_view kind,
                                           const HddlVocabulary::Signatures& signatures,
                                           const HddlVariables& variables,
                                           HddlVocabulary* vocabulary);
/// A variable or an object, declared; or else an open object of type `wanted`.  @return its type
int CheckArgument(const HddlSpot& spot, const Datum& argument, int wanted,
                  const HddlVariables& variables, HddlVocabulary* vocabulary);
/// @param spot  Of the problem whose objects were read.
/// @throws ConfigError if one that the domain left open is not declared, or of the wrong type.
void CheckOpenObjects(const HddlSpot& spot, const std::string& domain_source,
                      const HddlVocabulary& vocabulary);

std::string TypePredicate(const HddlVocabulary& vocabulary, int type);  ///< "%type-place"
std::string ValuePredicate(const std::string& function);                ///< "%value-length"
/// An atom as HDDL would have it: "(?x - place)" and "(= (length a b) number)" for those two.
std::string AsWritten(const Datum& atom);
/// The atoms that say of what types objects are, in the order of declaration, without what `known`
/// (null: nothing) says already.
/// @pre `known` has the first of the types of `vocabulary`.
std::vector<Datum> TypeFacts(const HddlSpot& spot, const HddlVocabulary& vocabulary,
                             const HddlVocabulary* known);

}  // namespace hires::planning::hddl
