#include "knowledge/fluents/store_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/locale/utf.hpp>
#include <cmath>
#include <limits>
#include <set>
#include <string_view>

#include "hires/base/error.h"
#include "hires/base/overloaded.h"
#include "hires/base/short_text.h"
#include "hires/base/text.h"
#include "hires/knowledge/name.h"

namespace hires::knowledge {
namespace {

/// What the execution monitor may speak of: this concept and all below.
constexpr const char* kOfMonitor = "ExecutionRecord";

constexpr std::array<std::string_view, 6> kValueTypes = {
    "xsd:float", "xsd:double", "xsd:int", "xsd:integer", "xsd:boolean", "xsd:string"};

enum class ValueKind { kNumber, kInteger, kTruth, kText };

bool IsUtf8(std::string_view text) {
  using Utf8 = boost::locale::utf::utf_traits<char>;
  for (const char* at = text.data(); at != text.data() + text.size();) {
    if (!boost::locale::utf::is_valid_codepoint(Utf8::decode(at, text.data() + text.size()))) {
      return false;
    }
  }
  return true;
}

/// Names in messages are cut, for who sends 10 MB does not want them back.
std::string Cut(const std::string& name) {
  constexpr std::size_t kShown = 60;
  return name.size() <= kShown ? name : name.substr(0, kShown) + "...";
}

[[noreturn]] void FailAt(const std::string& where, const std::string& what) {
  throw base::ConfigError(where + ": " + what);
}

std::string PlaceOf(const Fluent& fluent) {
  return fmt::format("fluent '{}' of {}", Cut(fluent.instance), Cut(fluent.concept_name));
}

std::string PlaceOf(const Fluent& fluent, const Property& property) {
  return fmt::format("{}, property '{}'", PlaceOf(fluent), Cut(property.role));
}

std::string Show(const Filler& filler) {
  return std::visit(
      base::Overloaded{[](const std::string& text) { return "the text '" + Cut(text) + "'"; },
                       [](double value) { return fmt::format("the number {}", value); },
                       [](std::int64_t value) { return fmt::format("the integer {}", value); },
                       [](bool value) { return fmt::format("the truth value {}", value); }},
      filler);
}

ValueKind KindOf(std::string_view type) {
  if (type == "xsd:boolean") return ValueKind::kTruth;
  if (type == "xsd:string") return ValueKind::kText;
  return type == "xsd:float" || type == "xsd:double" ? ValueKind::kNumber : ValueKind::kInteger;
}

/// Whether every value of `type` is one of `range`: integers are numbers as well.
bool Fits(std::string_view type, std::string_view range) {
  if (KindOf(range) == ValueKind::kNumber && KindOf(type) == ValueKind::kInteger) return true;
  return KindOf(type) == KindOf(range);
}

void RequireKnownType(const std::string& where, const std::string& type) {
  if (std::find(kValueTypes.begin(), kValueTypes.end(), type) != kValueTypes.end()) return;
  FailAt(where, fmt::format("type '{}' is unknown; wanted one of {}, or a concept", Cut(type),
                            fmt::join(kValueTypes, ", ")));
}

bool IsOfKind(const Filler& filler, ValueKind kind) {
  switch (kind) {
    case ValueKind::kNumber:
      return std::holds_alternative<double>(filler) || std::holds_alternative<std::int64_t>(filler);
    case ValueKind::kInteger:
      return std::holds_alternative<std::int64_t>(filler);
    case ValueKind::kTruth:
      return std::holds_alternative<bool>(filler);
    case ValueKind::kText:
      return std::holds_alternative<std::string>(filler);
  }
  return false;
}

bool IsOfValues(std::string_view range) { return range.substr(0, 4) == "xsd:"; }

/// Of what stands in a fluent: links are the names of others.
ValueKind KindIn(const Ontology::Relation& relation) {
  return IsOfValues(relation.range) ? KindOf(relation.range) : ValueKind::kText;
}

const char* WantedOf(ValueKind kind) {
  switch (kind) {
    case ValueKind::kNumber:
      return "a number";
    case ValueKind::kInteger:
      return "a whole number";
    case ValueKind::kTruth:
      return "true or false";
    case ValueKind::kText:
      return "a text, in quotes where it looks like something else";
  }
  return "";
}

void CheckNumber(const std::string& where, const Property& property) {
  if (const auto* real = std::get_if<double>(&property.filler); real && !std::isfinite(*real)) {
    FailAt(where, fmt::format("is {}; wanted a finite number", *real));
  }
  const auto* integer = std::get_if<std::int64_t>(&property.filler);
  using Int = std::numeric_limits<std::int32_t>;
  if (integer && property.type == "xsd:int" && (*integer < Int::min() || *integer > Int::max())) {
    FailAt(where, fmt::format("is {}; an xsd:int has 32 bits, use xsd:integer", *integer));
  }
}

void CheckText(const std::string& where, const Filler& filler) {
  const auto* text = std::get_if<std::string>(&filler);
  if (text == nullptr) return;
  if (text->size() > kMaxValueBytes) {
    FailAt(where, fmt::format("has a value of {} bytes, at most {} are kept; store a path to it",
                              text->size(), kMaxValueBytes));
  }
  if (!IsUtf8(*text)) FailAt(where, "has a value that is no UTF-8 text");
}

void CheckValue(const std::string& where, const Property& property, const std::string& range) {
  RequireKnownType(where, property.type);
  if (!range.empty() && (!IsOfValues(range) || !Fits(property.type, range))) {
    FailAt(where, fmt::format("is given as {}, the relation wants {}", property.type, range));
  }
  if (!IsOfKind(property.filler, KindOf(property.type))) {
    FailAt(where, fmt::format("is {}, which is no {}", Show(property.filler), property.type));
  }
  CheckNumber(where, property);
  CheckText(where, property.filler);
}

void CheckLink(const std::string& where, const Property& property, const std::string& range,
               const Ontology& ontology) {
  const Ontology::ConceptId type = ontology.Find(property.type);
  if (type == Ontology::kUnknown) {
    FailAt(where, base::UnknownName("type", property.type, ontology.ConceptNames()));
  }
  const auto* target = std::get_if<std::string>(&property.filler);
  if (target == nullptr) {
    FailAt(where,
           fmt::format("is {}; wanted the name of a {}", Show(property.filler), property.type));
  }
  const Ontology::ConceptId wanted = ontology.Find(range);
  if (!range.empty() && (wanted == Ontology::kUnknown || !ontology.IsA(type, wanted))) {
    FailAt(where, fmt::format("links to a {}, the relation wants {}", property.type, range));
  }
  CheckName(where, *target);
}

void CheckDomain(const std::string& where, const Ontology::Relation& relation,
                 Ontology::ConceptId subject, const Ontology& ontology) {
  if (relation.domain.empty()) return;
  std::vector<std::string> wanted;
  for (const Ontology::ConceptId id : relation.domain) {
    if (ontology.IsA(subject, id)) return;
    wanted.push_back(ontology.Name(id));
  }
  FailAt(where,
         fmt::format("is no property of this concept; wanted a {}", base::Join(wanted, " or ")));
}

void CheckProperty(const Fluent& fluent, const Property& property, Ontology::ConceptId subject,
                   const Ontology& ontology) {
  const std::string where = PlaceOf(fluent, property);
  const Ontology::Relation* relation = ontology.FindRelation(property.role);
  if (relation == nullptr) {
    FailAt(PlaceOf(fluent),
           base::UnknownName("relation", Cut(property.role), ontology.RelationNames()));
  }
  CheckDomain(where, *relation, subject, ontology);
  if (property.IsLink()) {
    CheckLink(where, property, relation->range, ontology);
  } else {
    CheckValue(where, property, relation->range);
  }
}

void CheckFunctional(const Fluent& fluent, const Ontology& ontology) {
  std::set<std::string_view> seen;
  for (const Property& property : fluent.properties) {
    if (seen.insert(property.role).second) continue;
    if (!ontology.FindRelation(property.role)->functional) continue;
    FailAt(PlaceOf(fluent, property), "is given twice, and there can be only one");
  }
}

void CheckCount(const Fluent& fluent) {
  if (fluent.properties.size() > kMaxProperties) {
    FailAt(PlaceOf(fluent), fmt::format("has {} properties, at most {} are kept; split it",
                                        fluent.properties.size(), kMaxProperties));
  }
}

void CheckSize(const Fluent& fluent) {
  std::size_t bytes = 0;
  for (const Property& property : fluent.properties) {
    const auto* text = std::get_if<std::string>(&property.filler);
    bytes += property.role.size() + property.type.size() + (text == nullptr ? 8 : text->size());
  }
  if (bytes > kMaxFluentBytes) {
    FailAt(PlaceOf(fluent),
           fmt::format("has {} bytes, at most {} are kept; split it", bytes, kMaxFluentBytes));
  }
}

void CheckBounds(const Fluent& fluent, const char* what, const temporal::Bounds& bounds) {
  if (bounds.earliest <= bounds.latest) return;  // false for NaN as well
  FailAt(PlaceOf(fluent), fmt::format("has a {} between {} and {}; wanted numbers in order", what,
                                      bounds.earliest, bounds.latest));
}

void CheckTimes(const Fluent& fluent) {
  CheckBounds(fluent, "start", fluent.start);
  CheckBounds(fluent, "finish", fluent.finish);
  if (fluent.start.earliest == temporal::kForever || fluent.finish.latest == -temporal::kForever) {
    FailAt(PlaceOf(fluent), "begins at the end of time, or ends before it; wanted a time between");
  }
}

}  // namespace

bool IsControl(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return byte < 0x20 || byte == 0x7f;
}

void CheckName(const std::string& what, const std::string& name) {
  if (name.empty()) FailAt(what, "the name is empty; give one");
  if (name.size() > kMaxNameBytes) {
    FailAt(what, fmt::format("the name '{}' has {} bytes, at most {} are kept; shorten it",
                             Cut(name), name.size(), kMaxNameBytes));
  }
  if (std::any_of(name.begin(), name.end(), IsControl)) {
    FailAt(what, "the name holds a control character; remove it");
  }
  if (!IsUtf8(name)) FailAt(what, "the name is no UTF-8 text; encode it so");
}

std::string AsName(std::string sentence) {
  constexpr std::size_t kOfEllipsis = 4;  // bytes
  std::replace_if(sentence.begin(), sentence.end(), IsControl, ' ');
  if (sentence.size() <= kMaxNameBytes) return sentence;
  return base::Shortened(sentence, kMaxNameBytes - kOfEllipsis);
}

bool CanHave(const Ontology::Relation& relation, const Filler& filler) {
  const ValueKind kind = KindIn(relation);
  const auto* real = std::get_if<double>(&filler);
  const bool is_whole = real != nullptr && *real == std::floor(*real);
  return IsOfKind(filler, kind) || (kind == ValueKind::kInteger && is_whole);
}

void CheckFiller(const Ontology::Relation& relation, const Filler& filler) {
  if (CanHave(relation, filler)) return;
  const std::string wanted = IsOfValues(relation.range)
                                 ? WantedOf(KindIn(relation))
                                 : fmt::format("the name of a {}", relation.range);
  throw base::ConfigError(fmt::format("property '{}' is asked for with {}; wanted {}",
                                      relation.name, Show(filler), wanted));
}

void CheckOrder(const std::string& instance, const temporal::Bounds& start,
                const temporal::Bounds& finish) {
  if (start.earliest <= finish.latest) return;
  throw base::ConfigError(
      fmt::format("fluent '{}': would end at {} before it begins at {}; correct the times",
                  Cut(instance), finish.latest, start.earliest));
}

void CheckFluent(const Fluent& fluent, const Ontology& ontology) {
  CheckName("fluent", fluent.instance);
  const Ontology::ConceptId subject = ontology.Find(fluent.concept_name);
  if (subject == Ontology::kUnknown) {
    FailAt(fmt::format("fluent '{}'", Cut(fluent.instance)),
           base::UnknownName("concept", Cut(fluent.concept_name), ontology.ConceptNames()));
  }
  CheckTimes(fluent);
  CheckCount(fluent);
  for (const Property& property : fluent.properties) {
    CheckProperty(fluent, property, subject, ontology);
  }
  CheckSize(fluent);
  CheckFunctional(fluent, ontology);
}

void CheckSource(Source source, const Fluent& fluent, const Ontology& ontology) {
  if (source != Source::kMonitor) return;
  const Ontology::ConceptId subject = ontology.Find(fluent.concept_name);
  const Ontology::ConceptId allowed = ontology.Find(kOfMonitor);
  const bool known = subject != Ontology::kUnknown && allowed != Ontology::kUnknown;
  if (known && ontology.IsA(subject, allowed)) return;
  FailAt(PlaceOf(fluent),
         fmt::format("the execution monitor may write what it does itself ({} and below) "
                     "and nothing else; write this as an observation",
                     kOfMonitor));
}

}  // namespace hires::knowledge
