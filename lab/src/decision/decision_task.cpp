#include <algorithm>
#include <cmath>
#include <limits>

#include "hires/base/error.h"
#include "hires/base/hash.h"
#include "hires/base/param_reader.h"
#include "hires/base/rng.h"
#include "hires/base/text.h"
#include "hires/world/fall_code.h"
#include "lab/src/decision/decision.h"
#include "lab/src/seed.h"

namespace hires::lab {
namespace {

using base::Between;
using base::FailureCode;

enum TaskStreams : std::uint64_t { kTaskStream, kTruthStream, kImaginationStream };

DecisionConfig::Load ReadLoad(base::ParamReader in) {
  DecisionConfig::Load load;
  load.model = base::ToLower(in.GetString("model"));
  for (const std::string& posture : in.GetStrings("torso")) {
    load.torso.push_back(base::ToLower(posture));
  }
  if (load.torso.empty()) in.Fail("torso", "wanted at least one posture");
  return load;
}

DecisionConfig::Route ReadTaskRoute(base::ParamReader in) {
  return {base::ToLower(in.GetString("from")), base::ToLower(in.GetString("to"))};
}

template <typename T>
const T& OneOf(const std::vector<T>& all, base::Rng* rng) {
  return all[static_cast<std::size_t>(rng->Index(static_cast<int>(all.size())))];
}

double TorsoHeight(const imagination::ImaginationSetup& setup, const std::string& posture) {
  const auto& postures = setup.scene->robot.profile.upper_body->torso_postures;
  const auto found = postures.find(posture);
  if (found != postures.end()) return found->second;
  std::vector<std::string> names;
  for (const auto& entry : postures) names.push_back(entry.first);
  throw base::ConfigError(base::UnknownName("torso posture", posture, names));
}

/// Whether a code says what became of things (failure.h, the first block), and not of the robot,
/// its way or the plan.
bool IsOfThings(FailureCode code) {
  constexpr int kLastOfThings = 99;
  return code != FailureCode::kNone && static_cast<int>(code) <= kLastOfThings;
}

}  // namespace

DecisionConfig ReadDecisionConfig(const std::string& path) {
  base::ParamReader in = base::ParamReader::FromFile(path);
  DecisionConfig config;
  for (base::ParamReader& load : in.SubList("loads")) config.loads.push_back(ReadLoad(load));
  for (base::ParamReader& route : in.SubList("routes"))
    config.routes.push_back(ReadTaskRoute(route));
  if (config.loads.empty()) in.Fail("loads", "wanted at least one");
  if (config.routes.empty()) in.Fail("routes", "wanted at least one");
  base::ParamReader deadline = in.Sub("deadline");
  config.deadline_share = deadline.Get("share", Between(0.0, 1.0));
  config.deadline_lower = deadline.Get("lower", Between(0.1, 3600.0));
  config.deadline_upper = deadline.Get("upper", Between(config.deadline_lower, 3600.0));
  base::ParamReader factor = in.Sub("price_factor");
  config.factor_lower = factor.Get("lower", Between(1e-6, 1e3));
  config.factor_upper = factor.Get("upper", Between(config.factor_lower, 1e3));
  config.oracle_plays = in.Get("oracle_plays", Between(1, 100000));
  in.RejectUnknownKeys();
  return config;
}

std::string CellOf(const DecisionTask& task) {
  return task.load + "/" + task.from + "/" + task.to + "/" + task.torso;
}

DecisionTask DrawTask(const DecisionConfig& config, std::uint64_t seed, int number) {
  const base::Rng own = base::Rng(seed).Fork(static_cast<std::uint64_t>(number));
  base::Rng rng = own.Fork(kTaskStream);
  DecisionTask task;
  task.number = number;
  const DecisionConfig::Load& load = OneOf(config.loads, &rng);
  const DecisionConfig::Route& route = OneOf(config.routes, &rng);
  task.load = load.model;
  task.from = route.from;
  task.to = route.to;
  task.torso = OneOf(load.torso, &rng);
  const double deadline = rng.Uniform(config.deadline_lower, config.deadline_upper);
  if (rng.Bernoulli(config.deadline_share)) task.deadline = deadline;
  task.price_factor =
      std::exp(rng.Uniform(std::log(config.factor_lower), std::log(config.factor_upper)));
  task.truth_seed = SeedOf(own.Fork(kTruthStream));
  task.imagination_seed = SeedOf(own.Fork(kImaginationStream));
  base::Hasher cell;
  cell.Add(CellOf(task));
  task.oracle_seed = SeedOf(base::Rng(seed).Fork(cell.value()));
  return task;
}

imagination::StartState StartOf(const imagination::ImaginationSetup& setup,
                                const DecisionTask& task) {
  imagination::StartState start = imagination::MakeStartState(setup, task.from, {task.load});
  const std::string& joint = setup.scene->robot.profile.upper_body->torso_joint;
  start.robot.joints[joint] = TorsoHeight(setup, task.torso);
  return start;
}

base::ActionCall ActionOf(const DecisionTask& task, const std::string& motion_set) {
  return {"move_base_param", {task.to, motion_set}};
}

bool TruthPlay::fell() const {
  return std::count(failures.begin(), failures.end(), FailureCode::kObjectFell) > 0;
}

TruthPlay JudgeDrive(const base::Failure& failure, double duration,
                     const simulation::RunTruth& truth, const std::string& load) {
  TruthPlay play;
  play.duration = duration;
  if (failure) play.failures.push_back(failure.code);
  bool others_fell = false;
  for (const auto& [name, fate] : truth.objects) {
    if (fate.falls == 0) continue;
    if (name == base::ToLower(load)) {
      play.failures.push_back(world::CodeOf(fate.first_fall, world::FallenThing::kLoad));
    } else {
      others_fell = true;
    }
  }
  if (others_fell) play.failures.push_back(FailureCode::kKnockedOver);
  const bool is_known = failure.code == FailureCode::kRobotCollision;
  if (!truth.contact.empty() && !is_known) play.failures.push_back(FailureCode::kRobotCollision);
  return play;
}

imagination::Prices PricesOf(const DecisionTask& task, const imagination::Prices& prices,
                             double scale) {
  imagination::Prices own = imagination::Scaled(prices, scale);
  for (auto& [code, price] : own.of) {
    if (IsOfThings(code)) price *= task.price_factor;
  }
  own.deadline = task.deadline.value_or(std::numeric_limits<double>::infinity());
  return own;
}

double CostOf(const TruthPlay& play, const imagination::Prices& prices) {
  double cost = imagination::CostOfTime(play.duration, prices);
  for (const FailureCode code : play.failures) cost += imagination::PriceOf(code, prices);
  return cost;
}

const std::vector<double>& PriceScales() {
  static const std::vector<double> scales{1.0, 0.5, 2.0};
  return scales;
}

const std::vector<std::string>& AllArms() {
  static const std::vector<std::string> arms{kImaginationArm, kSlowArm,         kFastArm,
                                             kDefaultArm,     kDissertationArm, kOracleArm};
  return arms;
}

bool HasArm(const std::vector<std::string>& arms, const std::string& arm) {
  return std::count(arms.begin(), arms.end(), arm) > 0;
}

std::string ChoiceOf(const Advice& advice, const std::string& arm, const std::string& by_default) {
  using Outcome = imagination::ImaginationOutcome;
  if (advice.outcome == Outcome::kRanked || advice.outcome == Outcome::kClose ||
      advice.outcome == Outcome::kUndecided) {
    return advice.first;
  }
  const bool is_banned = advice.outcome == Outcome::kAllFailed && arm != kDissertationArm;
  return is_banned ? "" : by_default;
}

const std::vector<std::string>& DecisionAlternatives() {
  static const std::vector<std::string> sets{"slow", "fast"};
  return sets;
}

}  // namespace hires::lab
