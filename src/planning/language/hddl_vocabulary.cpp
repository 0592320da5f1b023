#include "planning/language/hddl_vocabulary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "hires/base/keys.h"
#include "hires/base/spelling.h"
#include "hires/base/text.h"
#include "hires/planning/datum_reader.h"

namespace hires::planning::hddl {
namespace {

// No name in a file begins with %.
constexpr char kTypePrefix[] = "%type-";
constexpr char kValuePrefix[] = "%value-";

// A chain of types costs the square of its length, and each object a fact for each of its types.
constexpr std::size_t kMaxTypes = 1000;
constexpr std::size_t kMaxTypeFacts = 5'000'000;

int AddType(const std::string& name, HddlVocabulary* vocabulary) {
  const auto [entry, is_new] =
      vocabulary->type_index.emplace(name, static_cast<int>(vocabulary->types.size()));
  if (is_new) vocabulary->types.push_back({name, {}, {}, {}, false});
  return entry->second;
}

void RequireFewTypes(const HddlSpot& spot, const Datum& at, const HddlVocabulary& vocabulary) {
  if (vocabulary.types.size() <= kMaxTypes) return;
  spot.Fail(at, fmt::format("{} types are declared, at most {} are read", vocabulary.types.size(),
                            kMaxTypes));
}

void AddAncestors(const HddlVocabulary::Type& parent, std::vector<bool>* is_a) {
  for (std::size_t i = 0; i < parent.is_a.size(); ++i) {
    if (parent.is_a[i]) (*is_a)[i] = true;
  }
}

/// Fills in what `type` is, its parents first.
/// @param path  Types being filled in now, to find circles.
void FillAncestors(const HddlSpot& spot, const Datum& section, int type, std::vector<int>* path,
                   HddlVocabulary* vocabulary) {
  HddlVocabulary::Type& self = vocabulary->types[type];
  if (!self.is_a.empty()) return;
  const auto again = std::find(path->begin(), path->end(), type);
  if (again != path->end()) {
    std::vector<std::string> names;
    for (auto it = again; it != path->end(); ++it) names.push_back(vocabulary->types[*it].name);
    spot.Fail(section, fmt::format("type '{}' contains itself ({} - {}); break the circle",
                                   self.name, base::Join(names, " - "), self.name));
  }
  path->push_back(type);
  std::vector<bool> is_a(vocabulary->types.size());
  is_a[type] = is_a[HddlVocabulary::kObject] = true;
  for (const int parent : self.parents) {
    FillAncestors(spot, section, parent, path, vocabulary);
    AddAncestors(vocabulary->types[parent], &is_a);
  }
  path->pop_back();
  self.is_a = std::move(is_a);
}

/// The number of (either a b ...), a new one unless it was there before.
int EitherType(std::vector<int> members, HddlVocabulary* vocabulary) {
  std::sort(members.begin(), members.end());
  members.erase(std::unique(members.begin(), members.end()), members.end());
  if (members.size() == 1) return members[0];
  std::vector<std::string> names;
  for (const int member : members) names.push_back(vocabulary->types[member].name);
  const int type = AddType(base::Join(names, "/"), vocabulary);
  vocabulary->types[type].members = std::move(members);
  return type;
}

/// The type of objects listed with all of `parents`, which no file can name.
HddlVocabulary::Type JointType(std::vector<int> parents, const HddlVocabulary& vocabulary) {
  HddlVocabulary::Type joint{"", {}, {}, std::vector<bool>(vocabulary.types.size()), true};
  std::vector<std::string> names;
  for (const int parent : parents) {
    names.push_back(vocabulary.types[parent].name);
    AddAncestors(vocabulary.types[parent], &joint.is_a);
  }
  joint.name = base::Join(names, " and ");
  joint.parents = std::move(parents);
  return joint;
}

/// The number of the type below both, which is made where there is none.
int TypeBelow(const HddlSpot& spot, const Datum& at, int a, int b, HddlVocabulary* vocabulary) {
  if (IsA(*vocabulary, a, b)) return a;
  if (IsA(*vocabulary, b, a)) return b;
  std::vector<HddlVocabulary::Type>& types = vocabulary->types;
  std::vector<int> parents = types[a].is_joint ? types[a].parents : std::vector<int>{a};
  parents.push_back(b);
  std::sort(parents.begin(), parents.end());
  const auto found = std::find_if(types.begin(), types.end(), [&](const auto& type) {
    return type.is_joint && type.parents == parents;
  });
  if (found != types.end()) return static_cast<int>(found - types.begin());
  types.push_back(JointType(std::move(parents), *vocabulary));
  RequireFewTypes(spot, at, *vocabulary);
  return static_cast<int>(types.size()) - 1;
}

void AddSignature(const HddlSpot& spot, const Datum& at, HddlVocabulary::Signature signature,
                  HddlVocabulary::Signatures* signatures) {
  const std::string name = signature.name;
  const std::string kind = signature.kind;
  if (!signatures->emplace(name, std::move(signature)).second) {
    spot.Fail(at, fmt::format("{} '{}' is declared twice; keep one", kind, name));
  }
}

/// (name ?x - type ...), a declaration.
const Datum& RequireDeclaration(const HddlSpot& spot, const Datum& form, std::string_view kind) {
  RequireList(spot, form, fmt::format("a {} such as (near ?a ?b - place)", kind));
  if (form.items.empty()) spot.Fail(form, fmt::format("() stands where a {} is wanted", kind));
  RequireName(spot, form.items[0], fmt::format("the name of a {}", kind));
  return form;
}

void CheckArgumentType(const HddlSpot& spot, const Datum& argument, int type, int wanted,
                       const HddlVocabulary::Signature& signature,
                       const HddlVocabulary& vocabulary) {
  // A variable may hold an object of a narrower type than it declares, so only objects can be told
  // to be wrong here.
  if (argument.kind == Datum::Kind::kVariable || IsA(vocabulary, type, wanted)) return;
  spot.Fail(argument, fmt::format("'{}' is of type {}, {} '{}' takes {} here; name another object "
                                  "or change the types",
                                  argument.text, vocabulary.types[type].name, signature.kind,
                                  signature.name, vocabulary.types[wanted].name));
}

bool IsOfType(const HddlVocabulary& vocabulary, const std::string& object, int type) {
  if (type >= static_cast<int>(vocabulary.types.size())) return false;
  const auto found = vocabulary.objects.find(object);
  return found != vocabulary.objects.end() && IsA(vocabulary, found->second, type);
}

}  // namespace

void ReadTypeSection(const HddlSpot& spot, const Datum* section, HddlVocabulary* vocabulary) {
  AddType("object", vocabulary);
  const Datum none;
  if (section == nullptr) section = &none;
  for (const HddlTyped& typed : ReadTypedList(spot, *section, 1, Datum::Kind::kSymbol, false)) {
    const int type = AddType(typed.datum->text, vocabulary);
    for (const std::string& name : typed.types) {
      const int parent = AddType(name, vocabulary);
      // `object - object` is written now and then.
      if (parent != HddlVocabulary::kObject) vocabulary->types[type].parents.push_back(parent);
    }
  }
  RequireFewTypes(spot, *section, *vocabulary);
  std::vector<int> path;
  for (std::size_t type = 0; type < vocabulary->types.size(); ++type) {
    FillAncestors(spot, *section, static_cast<int>(type), &path, vocabulary);
  }
}

bool IsA(const HddlVocabulary& vocabulary, int type, int other) {
  if (type == other || other == HddlVocabulary::kObject) return true;
  const HddlVocabulary::Type& self = vocabulary.types[type];
  const HddlVocabulary::Type& target = vocabulary.types[other];
  if (!self.members.empty()) {
    return std::all_of(self.members.begin(), self.members.end(),
                       [&](int member) { return IsA(vocabulary, member, other); });
  }
  if (!target.members.empty()) {
    return std::any_of(target.members.begin(), target.members.end(),
                       [&](int member) { return IsA(vocabulary, type, member); });
  }
  return static_cast<std::size_t>(other) < self.is_a.size() && self.is_a[other];
}

int TypeOf(const HddlSpot& spot, const HddlTyped& typed, HddlVocabulary* vocabulary) {
  std::vector<int> members;
  for (const std::string& name : typed.types) {
    const auto found = vocabulary->type_index.find(name);
    if (found == vocabulary->type_index.end()) {
      Datum at;
      at.place = typed.type_place;
      spot.Fail(at, base::UnknownName("type", name, base::KeysOf(vocabulary->type_index)));
    }
    members.push_back(found->second);
  }
  return members.empty() ? HddlVocabulary::kObject : EitherType(members, vocabulary);
}

void ReadObjects(const HddlSpot& spot, const Datum& section, HddlVocabulary* vocabulary) {
  for (const HddlTyped& typed : ReadTypedList(spot, section, 1, Datum::Kind::kSymbol, false)) {
    if (typed.types.size() > 1) {
      spot.Fail(*typed.datum, fmt::format("'{0}' is of two types by (either ...), which does not "
                                          "say of which; list it with each type that it is of, as "
                                          "in {0} - {1} {0} - {2}",
                                          typed.datum->text, typed.types[0], typed.types[1]));
    }
    const int type = TypeOf(spot, typed, vocabulary);
    const auto [entry, is_new] = vocabulary->objects.emplace(typed.datum->text, type);
    if (is_new) vocabulary->object_order.push_back(typed.datum->text);
    if (!is_new) {
      entry->second = TypeBelow(spot, *typed.datum, entry->second, type, vocabulary);
    }
  }
}

HddlVocabulary::Signature ReadSignature(const HddlSpot& spot, std::string kind, std::string name,
                                        const Datum& list, std::size_t begin,
                                        HddlVocabulary* vocabulary) {
  HddlVocabulary::Signature signature{std::move(kind), std::move(name), {}};
  for (const HddlTyped& typed : ReadTypedList(spot, list, begin, Datum::Kind::kVariable, false)) {
    signature.types.push_back(TypeOf(spot, typed, vocabulary));
  }
  return signature;
}

void ReadPredicates(const HddlSpot& spot, const Datum& section, HddlVocabulary* vocabulary) {
  for (std::size_t i = 1; i < section.items.size(); ++i) {
    const Datum& form = RequireDeclaration(spot, section.items[i], "predicate");
    AddSignature(spot, form,
                 ReadSignature(spot, "predicate", form.items[0].text, form, 1, vocabulary),
                 &vocabulary->predicates);
  }
}

void ReadFunctions(const HddlSpot& spot, const Datum& section, HddlVocabulary* vocabulary) {
  for (std::size_t i = 1; i < section.items.size(); ++i) {
    if (section.items[i].IsSymbol("-number")) continue;
    if (section.items[i].IsSymbol("-")) {  // (f ?x) - number
      if (i + 1 < section.items.size() && section.items[i + 1].IsSymbol("number")) {
        ++i;
        continue;
      }
      spot.Fail(section.items[i], "a function gives a number; write (name ?x - type) - number");
    }
    const Datum& form = RequireDeclaration(spot, section.items[i], "function");
    if (form.items[0].text == "total-cost") {
      if (form.items.size() > 1) spot.Fail(form, "(total-cost) takes no arguments");
      vocabulary->has_costs = true;
      continue;
    }
    AddSignature(spot, form,
                 ReadSignature(spot, "function", form.items[0].text, form, 1, vocabulary),
                 &vocabulary->functions);
  }
}

const HddlVocabulary::Signature& CheckTerm(const HddlSpot& spot, const Datum& term,
                                           std::string_view kind,
                                           const HddlVocabulary::Signatures& signatures,
                                           const HddlVariables& variables,
                                           HddlVocabulary* vocabulary) {
  RequireList(spot, term, fmt::format("a {} with its arguments in parentheses", kind));
  if (term.items.empty()) spot.Fail(term, fmt::format("() stands where a {} is wanted", kind));
  const std::string& name = RequireName(spot, term.items[0], fmt::format("the name of a {}", kind));
  const auto found = signatures.find(name);
  if (found == signatures.end()) {
    spot.Fail(term.items[0], base::UnknownName(kind, name, base::KeysOf(signatures)));
  }
  const HddlVocabulary::Signature& signature = found->second;
  const auto is_dash = [](const Datum& item) { return item.IsSymbol("-"); };
  if (std::any_of(term.items.begin(), term.items.end(), is_dash)) {
    spot.Fail(term, fmt::format("{} has types; write them in :parameters, and the names alone here",
                                Excerpt(term)));
  }
  if (term.items.size() - 1 != signature.types.size()) {
    spot.Fail(term,
              fmt::format("{} '{}' has {} in {}, its declaration has {}; make them agree",
                          signature.kind, name, base::Counted(term.items.size() - 1, "argument"),
                          Excerpt(term), signature.types.size()));
  }
  for (std::size_t i = 0; i < signature.types.size(); ++i) {
    const int type =
        CheckArgument(spot, term.items[i + 1], signature.types[i], variables, vocabulary);
    CheckArgumentType(spot, term.items[i + 1], type, signature.types[i], signature, *vocabulary);
  }
  return signature;
}

int CheckArgument(const HddlSpot& spot, const Datum& argument, int wanted,
                  const HddlVariables& variables, HddlVocabulary* vocabulary) {
  if (argument.kind == Datum::Kind::kVariable) {
    const auto found = variables.find(argument.text);
    if (found != variables.end()) return found->second;
    spot.Fail(argument, base::UnknownName("variable", argument.text, base::KeysOf(variables)) +
                            "; declare it among the parameters");
  }
  const std::string& name = RequireName(spot, argument, "an object or a variable");
  const auto found = vocabulary->objects.find(name);
  if (found != vocabulary->objects.end()) return found->second;
  if (vocabulary->has_all_objects) {
    spot.Fail(argument, base::UnknownName("object", name, base::KeysOf(vocabulary->objects)) +
                            "; declare it among the constants or objects");
  }
  vocabulary->open_objects.push_back({name, wanted, argument.place, spot.construct});
  return wanted;
}

void CheckOpenObjects(const HddlSpot& spot, const std::string& domain_source,
                      const HddlVocabulary& vocabulary) {
  for (const HddlVocabulary::OpenObject& open : vocabulary.open_objects) {
    const HddlSpot named{domain_source, open.construct};
    Datum at;
    at.place = open.place;
    const auto found = vocabulary.objects.find(open.name);
    if (found == vocabulary.objects.end()) {
      named.Fail(at, base::UnknownName("object", open.name, base::KeysOf(vocabulary.objects)) +
                         fmt::format("; declare it among the constants, or among the objects of {}",
                                     spot.construct));
    }
    if (IsA(vocabulary, found->second, open.type)) continue;
    named.Fail(at, fmt::format("'{}' must be of type {} here, {} declares it as {}; change one of "
                               "them",
                               open.name, vocabulary.types[open.type].name, spot.construct,
                               vocabulary.types[found->second].name));
  }
}

std::string TypePredicate(const HddlVocabulary& vocabulary, int type) {
  return kTypePrefix + vocabulary.types[type].name;
}

std::string ValuePredicate(const std::string& function) { return kValuePrefix + function; }

std::string AsWritten(const Datum& atom) {
  const std::string head(atom.Head());
  if (head.rfind(kTypePrefix, 0) == 0 && atom.items.size() == 2) {
    return fmt::format("({} - {})", ToString(atom.items[1]), head.substr(std::strlen(kTypePrefix)));
  }
  if (head.rfind(kValuePrefix, 0) != 0 || atom.items.size() < 2) return ToString(atom);
  Datum term = atom;
  term.items[0] = MakeSymbol(head.substr(std::strlen(kValuePrefix)));
  term.items.pop_back();
  return fmt::format("(= {} number)", ToString(term));
}

std::vector<Datum> TypeFacts(const HddlSpot& spot, const HddlVocabulary& vocabulary,
                             const HddlVocabulary* known) {
  std::vector<Datum> facts;
  for (int type = 0; type < static_cast<int>(vocabulary.types.size()); ++type) {
    if (vocabulary.types[type].is_joint) continue;
    const Datum predicate = MakeSymbol(TypePredicate(vocabulary, type));
    for (const std::string& name : vocabulary.object_order) {
      if (!IsOfType(vocabulary, name, type)) continue;
      if (known != nullptr && IsOfType(*known, name, type)) continue;
      facts.push_back(MakeList({predicate, MakeSymbol(name)}));
      if (facts.size() > kMaxTypeFacts) {
        spot.Fail(Datum{}, fmt::format("the objects have more than {} types in all; use fewer "
                                       "objects or a flatter hierarchy",
                                       kMaxTypeFacts));
      }
    }
  }
  return facts;
}

}  // namespace hires::planning::hddl
