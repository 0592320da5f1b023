#include "hires/planning/operator_data.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "hires/base/error.h"
#include "hires/base/keys.h"
#include "hires/base/param_reader.h"
#include "hires/base/text.h"
#include "hires/planning/datum_reader.h"
#include "hires/planning/domain.h"

namespace hires::planning {
namespace {

using base::ConfigError;
using base::ParamReader;

constexpr int kMaxUnits = 1000;

bool Contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::string WithoutMarks(std::string_view name) {
  name.remove_prefix(std::min(name.find_first_not_of('!'), name.size()));
  return base::ToLower(name);
}

bool IsBookkeeping(const Operator& op) { return op.head.Head().substr(0, 2) == "!!"; }

std::string WithoutQuestionMark(const Datum& datum) {
  return datum.kind == Datum::Kind::kVariable ? datum.text.substr(1) : "";
}

std::vector<std::string> ArgumentsOf(const Operator& op) {
  std::vector<std::string> arguments;
  for (std::size_t i = 1; i < op.head.items.size(); ++i) {
    arguments.push_back(WithoutQuestionMark(op.head.items[i]));
  }
  return arguments;
}

void CollectPlainVariables(const Datum& datum, std::set<std::string>* names) {
  if (datum.kind == Datum::Kind::kVariable) names->insert(WithoutQuestionMark(datum));
  for (const Datum& item : datum.items) CollectPlainVariables(item, names);
  for (const Datum& item : datum.tail) CollectPlainVariables(item, names);
}

void CollectPlainVariables(const Formula& formula, std::set<std::string>* names) {
  CollectPlainVariables(formula.term, names);
  for (const Formula& part : formula.parts) CollectPlainVariables(part, names);
}

/// Those of the head and of the precondition: the ones that a step of a plan has bindings for.
std::vector<std::string> VariablesOf(const Operator& op) {
  std::set<std::string> names;
  CollectPlainVariables(op.head, &names);
  CollectPlainVariables(op.precondition.condition, &names);
  return {names.begin(), names.end()};
}

// ------------------------------------------------------------------------------------ durations --

double ReadBound(const ParamReader& in, const std::string& text) {
  double value = 0.0;
  if (!YAML::convert<double>::decode(YAML::Node(text), value) || !(value >= 0.0)) {
    in.Fail("duration", fmt::format("'{}' is no bound; wanted [min, max] in seconds, 0 or more, "
                                    "with .inf for max where it is open",
                                    text));
  }
  return value;
}

Duration ReadDuration(ParamReader in) {
  const std::vector<std::string> bounds = in.GetStrings("duration", "[min, max] in seconds");
  if (bounds.size() != 2) {
    in.Fail("duration", fmt::format("it has {} numbers, wanted [min, max]", bounds.size()));
  }
  Duration duration{ReadBound(in, bounds[0]), ReadBound(in, bounds[1]), {}};
  if (std::isinf(duration.min)) in.Fail("duration", "min is infinite; give it in seconds");
  if (duration.min > duration.max) {
    in.Fail("duration", fmt::format("min {} is above max {}; exchange or correct them",
                                    duration.min, duration.max));
  }
  if (in.Has("expected")) {
    const double longest = std::min(duration.max, std::numeric_limits<double>::max());
    duration.expected = in.Get("expected", base::Between(duration.min, longest));
  }
  return duration;
}

// ------------------------------------------------------------------------------------ resources --

/// `<arm>ManCapacity` is {"", "arm", "mancapacity"}; a name without argument is all `before`.
struct ResourceName {
  std::string before;
  std::string argument;
  std::string after;

  bool Matches(const std::string& name) const {
    if (argument.empty()) return name == before;
    return name.size() > before.size() + after.size() &&
           name.compare(0, before.size(), before) == 0 &&
           name.compare(name.size() - after.size(), after.size(), after) == 0;
  }
};

ResourceName ParseResourceName(const std::string& text) {
  const std::string name = base::ToLower(text);
  const std::size_t open = name.find('<');
  const std::size_t close = name.find('>');
  if (open == std::string::npos || close == std::string::npos || close < open)
    return {name, "", ""};
  return {name.substr(0, open), name.substr(open + 1, close - open - 1), name.substr(close + 1)};
}

std::map<std::string, int> ReadCapacities(ParamReader in) {
  std::map<std::string, int> capacities;
  for (const std::string& key : in.Keys()) {
    const int units = in.Get(key, base::Between(1, kMaxUnits));
    if (!capacities.emplace(base::ToLower(key), units).second) {
      in.Fail(key, "it stands twice (case is ignored); keep one");
    }
  }
  return capacities;
}

/// The smallest capacity of the resources that the name may stand for.
int CapacityOf(const ParamReader& in, const std::string& key, const OperatorEntry& entry,
               const std::map<std::string, int>& capacities) {
  const ResourceName name = ParseResourceName(key);
  if (!name.argument.empty() && !Contains(entry.arguments, name.argument)) {
    in.Fail(key, base::UnknownName("argument", name.argument, entry.arguments));
  }
  int smallest = 0;
  for (const auto& [resource, units] : capacities) {
    if (name.Matches(resource)) smallest = smallest == 0 ? units : std::min(smallest, units);
  }
  if (smallest == 0) in.Fail(key, base::UnknownName("resource", key, base::KeysOf(capacities)));
  return smallest;
}

std::map<std::string, int> ReadResources(ParamReader in, const OperatorEntry& entry,
                                         const std::map<std::string, int>& capacities) {
  std::map<std::string, int> resources;
  for (const std::string& key : in.Keys()) {
    const int capacity = CapacityOf(in, key, entry, capacities);
    const int units = in.Get(key, base::Between(1, capacity));
    if (!resources.emplace(base::ToLower(key), units).second) {
      in.Fail(key, "it stands twice (case is ignored); keep one");
    }
  }
  return resources;
}

// ---------------------------------------------------------------------------------- disturbance --

/// An atom that steps change: no others can be disturbed for a while.
Datum ReadPattern(const ParamReader& in, const std::string& text, const PredicateSet& predicates) {
  std::vector<Datum> data = ReadData(text, "disturbs");
  if (data.size() != 1 || !data[0].IsList() || data[0].Head().empty()) {
    in.Fail("disturbs", fmt::format("'{}' is no atom; wanted (predicate arguments...)", text));
  }
  const std::string predicate(data[0].Head());
  if (!predicates.MayHave(predicate)) {
    in.Fail("disturbs", base::UnknownName("predicate that steps change", predicate,
                                          {predicates.names.begin(), predicates.names.end()}));
  }
  return std::move(data[0]);
}

std::vector<Datum> ReadDisturbs(ParamReader* in, const Domain& domain) {
  std::vector<Datum> patterns;
  for (const std::string& text : in->GetStrings("disturbs")) {
    patterns.push_back(ReadPattern(*in, text, ChangingPredicates(domain)));
  }
  return patterns;
}

// ---------------------------------------------------------------------------------- imagination --

std::vector<std::string> ReadParameters(ParamReader in, const OperatorEntry& entry) {
  std::vector<std::string> parameters;
  for (const std::string& text : in.GetStrings("parameters")) {
    const std::string name = base::ToLower(text);
    if (name.empty() || !Contains(entry.arguments, name)) {
      in.Fail("parameters", base::UnknownName("argument", name, entry.arguments));
    }
    if (Contains(parameters, name)) in.Fail("parameters", "'" + name + "' stands twice; keep one");
    parameters.push_back(name);
  }
  return parameters;
}

bool IsMotionSet(const OperatorEntry& entry, const std::string& argument) {
  return argument == "motion_set" || (entry.leg && entry.leg->motion_set == argument);
}

/// The default of a motion set may be left out.
std::map<std::string, std::string> ReadDefaults(ParamReader in, const OperatorEntry& entry,
                                                const std::vector<std::string>& parameters) {
  std::map<std::string, std::string> defaults;
  for (const std::string& name : parameters) {
    if (IsMotionSet(entry, name) && !in.Has(name)) continue;
    defaults[name] = base::ToLower(in.GetString(name));
    if (defaults[name].empty())
      in.Fail(name, "wanted the value that stands in while none is known");
  }
  return defaults;
}

ImagineData ReadImagine(ParamReader in, const OperatorEntry& entry) {
  ImagineData imagine;
  imagine.parameters = ReadParameters(in, entry);
  const bool may_be_left_out =
      std::all_of(imagine.parameters.begin(), imagine.parameters.end(),
                  [&](const std::string& name) { return IsMotionSet(entry, name); });
  if (in.Has("default") || !may_be_left_out) {
    imagine.defaults = ReadDefaults(in.Sub("default"), entry, imagine.parameters);
  }
  const std::string on_late = in.Get("on_late", base::OneOf({"default", "wait"}));
  imagine.on_late = on_late == "wait" ? OnLate::kWait : OnLate::kDefault;
  if (in.Has("min_success"))
    imagine.min_success = in.Get("min_success", base::Between(0.001, 0.999));
  return imagine;
}

// ----------------------------------------------------------------------------------------- legs --

Leg ReadLeg(ParamReader in) {
  Leg leg;
  leg.from = base::ToLower(in.GetString("from"));
  leg.to = base::ToLower(in.GetString("to"));
  leg.motion_set = base::ToLower(in.GetString("motion_set"));
  leg.duration = ReadDuration(in);
  return leg;
}

const Leg* FindLeg(const std::vector<Leg>& legs, const std::string& from, const std::string& to,
                   const std::string& motion_set) {
  for (const Leg& leg : legs) {
    if (leg.from == from && leg.to == to && leg.motion_set == motion_set) return &leg;
  }
  return nullptr;
}

std::vector<Leg> ReadLegs(std::vector<ParamReader> list) {
  std::vector<Leg> legs;
  for (ParamReader& in : list) {
    Leg leg = ReadLeg(in);
    if (FindLeg(legs, leg.from, leg.to, leg.motion_set) != nullptr) {
      in.Fail("from", fmt::format("the leg to '{}' with '{}' stands twice; keep one", leg.to,
                                  leg.motion_set));
    }
    legs.push_back(std::move(leg));
  }
  return legs;
}

std::string ReadVariable(ParamReader in, const std::string& key,
                         const std::vector<std::string>& variables) {
  std::string name = base::ToLower(in.GetString(key));
  if (name.empty() || !Contains(variables, name)) {
    in.Fail(key, base::UnknownName("variable of the operator", name, variables));
  }
  return name;
}

std::string ReadMotionSet(ParamReader in, const std::vector<Leg>& legs) {
  std::vector<std::string> known;
  for (const Leg& leg : legs) {
    if (!Contains(known, leg.motion_set)) known.push_back(leg.motion_set);
  }
  std::string name = base::ToLower(in.GetString("fixed_motion_set"));
  if (!Contains(known, name)) {
    in.Fail("fixed_motion_set", base::UnknownName("motion set of the legs", name, known));
  }
  return name;
}

LegVariables ReadLegVariables(ParamReader in, const Operator& op, const std::vector<Leg>& legs) {
  const std::vector<std::string> variables = VariablesOf(op);
  LegVariables leg;
  leg.from = ReadVariable(in, "from", variables);
  leg.to = ReadVariable(in, "to", variables);
  if (in.Has("fixed_motion_set")) {
    leg.fixed_motion_set = ReadMotionSet(in, legs);
  } else {
    leg.motion_set = ReadVariable(in, "motion_set", variables);
  }
  return leg;
}

// ------------------------------------------------------------------------------------ operators --

OperatorEntry ReadEntry(ParamReader in, const Operator& op, const Domain& domain,
                        const OperatorData& data) {
  OperatorEntry entry;
  entry.arguments = ArgumentsOf(op);
  entry.duration = ReadDuration(in);
  entry.resources = ReadResources(in.Sub("resources"), entry, data.capacities);
  if (in.Has("disturbs")) entry.disturbs = ReadDisturbs(&in, domain);
  if (in.Has("leg")) entry.leg = ReadLegVariables(in.Sub("leg"), op, data.legs);
  if (in.Has("imagine")) entry.imagine = ReadImagine(in.Sub("imagine"), entry);
  return entry;
}

SubtaskOrder ReadSubtaskOrder(ParamReader* in, Domain::Language language) {
  if (!in->Has("subtask_order")) return SubtaskOrder::kKept;
  const std::string order = in->Get("subtask_order", base::OneOf({"kept", "causal_links"}));
  if (order == "kept") return SubtaskOrder::kKept;
  if (language == Domain::Language::kHddl) {
    in->Fail(
        "subtask_order",
        "but HDDL's :ordered-subtasks are always kept; leave the key out, and write :subtasks with "
        "the :ordering that is needed");
  }
  return SubtaskOrder::kCausalLinks;
}

OperatorData Read(ParamReader in, const Domain& domain) {
  OperatorData data;
  data.subtask_order = ReadSubtaskOrder(&in, domain.language);
  data.capacities = ReadCapacities(in.Sub("capacities"));
  data.legs = ReadLegs(in.SubList("legs"));
  ParamReader operators = in.Sub("operators");
  for (const Operator& op : domain.operators) {
    if (IsBookkeeping(op)) continue;
    const std::string name = WithoutMarks(op.head.Head());
    data.operators[name] = ReadEntry(operators.Sub(name), op, domain, data);
  }
  in.RejectUnknownKeys();
  return data;
}

// ---------------------------------------------------------------------------------------- steps --

const OperatorEntry& EntryOf(const OperatorData& data, const PlanStep& step) {
  return EntryOf(data, step.task.Head());
}

/// By the step's bindings, else by its place among the arguments; "" where it is not known.
std::string ValueOf(const PlanStep& step, const OperatorEntry& entry, const std::string& variable) {
  for (const auto& [name, value] : step.bindings) {
    if (name == "?" + variable) return ToString(value);
  }
  const auto at = std::find(entry.arguments.begin(), entry.arguments.end(), variable);
  const std::size_t index = static_cast<std::size_t>(at - entry.arguments.begin()) + 1;
  return index < step.task.items.size() ? ToString(step.task.items[index]) : "";
}

std::string Instantiate(const std::string& resource, const PlanStep& step,
                        const OperatorEntry& entry) {
  const ResourceName name = ParseResourceName(resource);
  if (name.argument.empty()) return name.before;
  return name.before + ValueOf(step, entry, name.argument) + name.after;
}

}  // namespace

OperatorData LoadOperatorData(const std::string& path, const Domain& domain) {
  return Read(ParamReader::FromFile(path), domain);
}

OperatorData ReadOperatorData(const std::string& yaml, const std::string& source,
                              const Domain& domain) {
  return Read(ParamReader::FromString(yaml, source), domain);
}

SubtaskOrder LoadSubtaskOrder(const std::string& path, Domain::Language language) {
  ParamReader in = ParamReader::FromFile(path);
  return ReadSubtaskOrder(&in, language);
}

bool LacksDefaults(const OperatorData& data) {
  return std::any_of(data.operators.begin(), data.operators.end(), [](const auto& op) {
    const auto& imagine = op.second.imagine;
    return imagine && imagine->defaults.size() < imagine->parameters.size();
  });
}

const OperatorEntry& EntryOf(const OperatorData& data, std::string_view name) {
  const auto found = data.operators.find(WithoutMarks(name));
  if (found == data.operators.end()) {
    throw ConfigError(
        base::UnknownName("operator", WithoutMarks(name), base::KeysOf(data.operators)) +
        "; add it to the domain and to its sidecar");
  }
  return found->second;
}

std::map<std::string, int> ResourcesOf(const OperatorData& data, const PlanStep& step) {
  const OperatorEntry& entry = EntryOf(data, step);
  std::map<std::string, int> held;
  for (const auto& [resource, units] : entry.resources) {
    const std::string name = Instantiate(resource, step, entry);
    if (data.capacities.count(name) == 0) {
      throw ConfigError(
          fmt::format("step {}: {}", ToString(step.task),
                      base::UnknownName("resource", name, base::KeysOf(data.capacities))));
    }
    held[name] += units;
  }
  return held;
}

Duration DurationOf(const OperatorData& data, const PlanStep& step) {
  const OperatorEntry& entry = EntryOf(data, step);
  if (!entry.leg) return entry.duration;
  const std::string motion_set = entry.leg->fixed_motion_set.empty()
                                     ? ValueOf(step, entry, entry.leg->motion_set)
                                     : entry.leg->fixed_motion_set;
  const Leg* leg = FindLeg(data.legs, ValueOf(step, entry, entry.leg->from),
                           ValueOf(step, entry, entry.leg->to), motion_set);
  return leg == nullptr ? entry.duration : leg->duration;
}

}  // namespace hires::planning
