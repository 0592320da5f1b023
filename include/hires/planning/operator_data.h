#pragma once

#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hires/planning/domain.h"
#include "hires/planning/plan.h"

namespace hires::planning {

/// How long a step takes [s]. 0 <= min <= expected <= max; max may be infinite.
struct Duration {
  double min{0.0};
  double max{std::numeric_limits<double>::infinity()};
  std::optional<double> expected;  ///< where it has been measured
};

/// What the execution monitor does when imagination has no answer by the latest start of a step.
enum class OnLate {
  kDefault,  ///< goes on with the defaults
  kWait,     ///< waits for the answer
};

/// How an operator is imagined.
struct ImagineData {
  /// Arguments that imagination chooses, without their `?`. None: it only tells whether the step
  /// will succeed as it is planned.
  std::vector<std::string> parameters;
  /// Value of each parameter, in lower case. That of a motion set may be missing: then it is the
  /// robot's most cautious one among the alternatives.
  std::map<std::string, std::string> defaults;
  OnLate on_late{OnLate::kDefault};
  /// Share of successes that the lower end of an alternative's interval must reach to be
  /// recommended, in (0, 1); none: imagination's own default.
  std::optional<double> min_success;
};

/// Which variables of a driving operator tell the leg that it drives; without their `?`.
struct LegVariables {
  std::string from;
  std::string to;
  std::string motion_set;        ///< "" where the operator has one motion set for all
  std::string fixed_motion_set;  ///< that one, else ""
};

/// A drive between two areas with a motion set, names in lower case.
struct Leg {
  std::string from;
  std::string to;
  std::string motion_set;
  Duration duration;
};

/// What execution needs to know about an operator beside its preconditions and effects.
struct OperatorEntry {
  std::vector<std::string> arguments;  ///< of its head, without `?`; "" for what is no variable
  Duration duration;
  /// Units of each resource held while the step runs. `<arm>` in a name stands for the value of the
  /// argument ?arm: `<arm>ManCapacity` becomes leftarm1mancapacity.
  std::map<std::string, int> resources;
  /// Atoms that may not hold while the step runs, though they do before and after it: an arm that
  /// grasps is not at the side meanwhile. Variables of the head stand for the step's arguments,
  /// others for anything: (hasarmposture ?arm ?posture).
  std::vector<Datum> disturbs;
  std::optional<ImagineData> imagine;  ///< none: it cannot be imagined
  std::optional<LegVariables> leg;
};

/// The sidecar of a domain: durations, resources and imagination of its operators. All names are in
/// lower case, as in plans.
struct OperatorData {
  std::map<std::string, int> capacities;           ///< units of each resource that there are
  std::map<std::string, OperatorEntry> operators;  ///< by name, without `!`
  std::vector<Leg> legs;
  SubtaskOrder subtask_order{SubtaskOrder::kKept};  ///< of the plans that are carried out
};

/// Reads the sidecar and holds it against the domain: every operator of the domain has its entry
/// (those with `!!` are never executed and need none), and every name is known.
/// @throws ConfigError naming file, key and line, what came and what was wanted.
OperatorData LoadOperatorData(const std::string& path, const Domain& domain);

/// The same from text; `source` stands for the file in messages.
OperatorData ReadOperatorData(const std::string& yaml, const std::string& source,
                              const Domain& domain);

/// What the sidecar says of the order of subtasks, and nothing else of it: kept, where it says
/// nothing.  @throws ConfigError naming file and key; also where HDDL's order is not to be kept.
SubtaskOrder LoadSubtaskOrder(const std::string& path, Domain::Language language);

/// Whether an operator leaves out the default of a motion set, so that the robot's are needed.
bool LacksDefaults(const OperatorData& data);

/// The entry of an operator, named with its `!` or without.
/// @throws ConfigError with the nearest names if there is none.
const OperatorEntry& EntryOf(const OperatorData& data, std::string_view name);

/// Units of each resource that a step holds while it runs, by name of the resource in lower case.
/// @throws ConfigError where an argument makes up a resource that there is not.
std::map<std::string, int> ResourcesOf(const OperatorData& data, const PlanStep& step);

/// How long a step takes: as its leg where that is listed, else as the operator. A leg's `from` is
/// looked up in the step's bindings.
Duration DurationOf(const OperatorData& data, const PlanStep& step);

}  // namespace hires::planning
