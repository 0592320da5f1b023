#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>

#include "hires/base/text.h"
#include "knowledge/yaml/fluent_yaml_documents.h"
#include "knowledge/yaml/fluent_yaml_text.h"

namespace hires::knowledge {
namespace {

Filler RealFiller(const Field& field) { return field.Real(); }
Filler IntegerFiller(const Field& field) { return field.Integer(); }
Filler TruthFiller(const Field& field) { return field.Truth(); }
Filler TextFiller(const Field& field) { return field.Text(); }

Filler IntFiller(const Field& field) {
  using Int = std::numeric_limits<std::int32_t>;
  const std::int64_t value = field.Integer();
  if (value < Int::min() || value > Int::max()) {
    field.Fail(fmt::format("is {}, an xsd:int has 32 bits; make it an xsd:integer", value));
  }
  return value;
}

struct ValueType {
  std::string_view name;
  Filler (*read)(const Field&);
};
constexpr std::array<ValueType, 6> kWrittenTypes = {{{"xsd:float", RealFiller},
                                                     {"xsd:double", RealFiller},
                                                     {"xsd:int", IntFiller},
                                                     {"xsd:integer", IntegerFiller},
                                                     {"xsd:boolean", TruthFiller},
                                                     {"xsd:string", TextFiller}}};

const ValueType& FindValueType(const std::string& type, const Field& field) {
  for (const ValueType& known : kWrittenTypes) {
    if (known.name == type) return known;
  }
  std::vector<std::string> names;
  for (const ValueType& known : kWrittenTypes) names.emplace_back(known.name);
  field.Fail(fmt::format("type '{}' is unknown; wanted one of {}, or a concept", Shown(type),
                         base::Join(names, ", ")));
}

Property ReadProperty(const Field& field) {
  const std::vector<Field> parts = field.Items("[property, filler type, filler]", 3);
  Property property{parts[0].Name(), parts[1].Name(), {}};
  property.filler = property.IsLink() ? Filler(parts[2].Name())
                                      : FindValueType(property.type, parts[1]).read(parts[2]);
  return property;
}

/// [0, 0] stands for `unbounded`, -infinity or infinity. The moment 0 itself, which the original
/// had no need of, is [-0.0, -0.0].
temporal::Bounds ReadBounds(const Field& field, double unbounded) {
  const std::vector<Field> ends = field.Items("[earliest, latest]", 2);
  const temporal::Bounds bounds{ends[0].Moment(), ends[1].Moment()};
  const bool all_zero = bounds.earliest == 0.0 && bounds.latest == 0.0;
  if (all_zero && !std::signbit(bounds.earliest) && !std::signbit(bounds.latest)) {
    return {unbounded, unbounded};
  }
  if (bounds.earliest > bounds.latest) {
    field.Fail(
        fmt::format("is [{}, {}]; wanted the earlier time first", bounds.earliest, bounds.latest));
  }
  return {bounds.earliest + 0.0, bounds.latest + 0.0};  // -0.0 becomes 0.0
}

void CheckTimes(const Fluent& fluent, const Field& start, const Field& finish) {
  if (fluent.start.earliest == temporal::kForever)
    start.Fail("is never; wanted a time before .inf");
  if (fluent.finish.latest == -temporal::kForever) {
    finish.Fail("is before all time; wanted a time after -.inf");
  }
  if (fluent.start.earliest > fluent.finish.latest) {
    finish.Fail(
        fmt::format("is at {} at the latest, before the fluent starts at {} at the "
                    "earliest; correct the times",
                    fluent.finish.latest, fluent.start.earliest));
  }
}

}  // namespace

const std::vector<std::string> kFluentKeys = {"Class_Instance", "StartTime", "FinishTime",
                                              "Properties"};

Fluent ReadFluent(const Fields& in) {
  Fluent fluent;
  const std::vector<Field> head =
      in.Require("Class_Instance", "write [concept, instance]").Items("[concept, instance]", 2);
  fluent.concept_name = head[0].Name();
  fluent.instance = head[1].Name();
  const Field start = in.Require("StartTime", "write [0, 0] where it is not bounded");
  const Field finish = in.Require("FinishTime", "write [0, 0] where it is not bounded");
  fluent.start = ReadBounds(start, -temporal::kForever);
  fluent.finish = ReadBounds(finish, temporal::kForever);
  CheckTimes(fluent, start, finish);
  const Field properties = in.Require("Properties", "write [] for none");
  for (const Field& item : properties.Items("a list of [property, filler type, filler]")) {
    fluent.properties.push_back(ReadProperty(item));
  }
  return fluent;
}

}  // namespace hires::knowledge
