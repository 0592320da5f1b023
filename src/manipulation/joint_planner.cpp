#include "manipulation/joint_planner.h"

#include <ompl/base/MotionValidator.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/StateValidityChecker.h>
#include <ompl/base/goals/GoalStates.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/base/terminationconditions/IterationTerminationCondition.h>
#include <ompl/datastructures/NearestNeighborsLinear.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/PathSimplifier.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>

#include <cmath>
#include <mutex>

#include "hires/base/rng.h"
#include "hires/geometry/angles.h"

// OMPL seeds every generator it makes from one process-wide stream, so what a planner draws depends
// on what ran before. Nothing here draws from those: states come from a sampler on base::Rng, the
// nearest neighbour is searched linearly (OMPL's default tree picks pivots at random), and the
// simplifier's generator gets a seed of its own.

namespace hires::manipulation {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;
using Space = ob::RealVectorStateSpace;

constexpr double kRange = 1.0;  // [rad] longest motion added to a tree; of the order of a posture

ArmJoints FromState(const ob::State* state, int dimension) {
  const double* values = state->as<Space::StateType>()->values;
  return {values, values + dimension};
}

void ToState(const ArmJoints& joints, ob::State* state) {
  std::copy(joints.begin(), joints.end(), state->as<Space::StateType>()->values);
}

class RngSampler : public ob::StateSampler {
 public:
  RngSampler(const ob::StateSpace* space, std::uint64_t seed)
      : ob::StateSampler(space), random_(seed) {}

  void sampleUniform(ob::State* state) override {
    const ob::RealVectorBounds& bounds = space_->as<Space>()->getBounds();
    double* values = state->as<Space::StateType>()->values;
    for (std::size_t i = 0; i < bounds.low.size(); ++i) {
      values[i] = random_.Uniform(bounds.low[i], bounds.high[i]);
    }
  }
  void sampleUniformNear(ob::State* state, const ob::State* near, double distance) override {
    const ob::RealVectorBounds& bounds = space_->as<Space>()->getBounds();
    const double* centre = near->as<Space::StateType>()->values;
    double* values = state->as<Space::StateType>()->values;
    for (std::size_t i = 0; i < bounds.low.size(); ++i) {
      values[i] = random_.Uniform(std::max(bounds.low[i], centre[i] - distance),
                                  std::min(bounds.high[i], centre[i] + distance));
    }
  }
  void sampleGaussian(ob::State* state, const ob::State* mean, double sd) override {
    const double* centre = mean->as<Space::StateType>()->values;
    double* values = state->as<Space::StateType>()->values;
    for (unsigned int i = 0; i < space_->getDimension(); ++i) {
      values[i] = random_.Normal(centre[i], sd);
    }
    space_->enforceBounds(state);
  }

 private:
  base::Rng random_;
};

class Validity : public ob::StateValidityChecker {
 public:
  Validity(const ob::SpaceInformationPtr& info, const MotionCheck& check)
      : ob::StateValidityChecker(info), check_(check), dimension_(info->getStateDimension()) {}
  bool isValid(const ob::State* state) const override {
    return check_.IsFree(FromState(state, dimension_));
  }

 private:
  const MotionCheck& check_;
  int dimension_;
};

class Motions : public ob::MotionValidator {
 public:
  Motions(const ob::SpaceInformationPtr& info, const MotionCheck& check)
      : ob::MotionValidator(info), check_(check), dimension_(info->getStateDimension()) {}
  bool checkMotion(const ob::State* from, const ob::State* to) const override {
    const ArmJoints a = FromState(from, dimension_), b = FromState(to, dimension_);
    return check_.IsFree(b) && check_.IsFree(a, b);
  }
  bool checkMotion(const ob::State* from, const ob::State* to,
                   std::pair<ob::State*, double>& last_valid) const override {
    if (checkMotion(from, to)) return true;
    if (last_valid.first != nullptr) si_->copyState(last_valid.first, from);
    last_valid.second = 0.0;
    return false;
  }

 private:
  const MotionCheck& check_;
  int dimension_;
};

class SeededSimplifier : public og::PathSimplifier {
 public:
  SeededSimplifier(const ob::SpaceInformationPtr& info, std::uint64_t seed)
      : og::PathSimplifier(info) {
    rng_.setLocalSeed(static_cast<std::uint_fast32_t>(seed & 0xffffffffu));
  }
};

/// Limits; a continuous joint may make half a turn beyond start and goals.
ob::RealVectorBounds BoundsOf(const ArmKinematics& kinematics, const ArmJoints& start,
                              const std::vector<ArmJoints>& goals) {
  ob::RealVectorBounds bounds(start.size());
  for (std::size_t i = 0; i < start.size(); ++i) {
    bounds.low[i] = kinematics.lower()[i];
    bounds.high[i] = kinematics.upper()[i];
    if (std::isfinite(bounds.low[i])) continue;
    double low = start[i], high = start[i];
    for (const ArmJoints& goal : goals) {
      low = std::min(low, goal[i]);
      high = std::max(high, goal[i]);
    }
    bounds.low[i] = low - geometry::kPi;
    bounds.high[i] = high + geometry::kPi;
  }
  return bounds;
}

ob::SpaceInformationPtr MakeSpace(const MotionCheck& check, const ob::RealVectorBounds& bounds,
                                  std::uint64_t seed) {
  const auto space = std::make_shared<Space>(bounds.low.size());
  space->setBounds(bounds);
  space->setStateSamplerAllocator(
      [seed](const ob::StateSpace* s) { return std::make_shared<RngSampler>(s, seed); });
  const auto info = std::make_shared<ob::SpaceInformation>(space);
  info->setStateValidityChecker(std::make_shared<Validity>(info, check));
  info->setMotionValidator(std::make_shared<Motions>(info, check));
  info->setup();
  return info;
}

ob::ProblemDefinitionPtr MakeProblem(const ob::SpaceInformationPtr& info, const ArmJoints& start,
                                     const std::vector<ArmJoints>& goals) {
  const auto problem = std::make_shared<ob::ProblemDefinition>(info);
  ob::ScopedState<Space> state(info);
  ToState(start, state.get());
  problem->addStartState(state);
  const auto goal = std::make_shared<ob::GoalStates>(info);
  for (const ArmJoints& joints : goals) {
    ToState(joints, state.get());
    goal->addState(state);
  }
  problem->setGoal(goal);
  return problem;
}

void Simplify(const ob::SpaceInformationPtr& info, std::uint64_t seed, int tries,
              og::PathGeometric* path) {
  SeededSimplifier simplifier(info, seed);
  simplifier.reduceVertices(*path, tries, tries);
  simplifier.shortcutPath(*path, tries, tries);
  simplifier.reduceVertices(*path, tries, tries);
}

void SilenceOmpl() {
  static std::once_flag once;
  std::call_once(once, [] { ompl::msg::noOutputHandler(); });
}

}  // namespace

std::vector<ArmJoints> PlanByRrtConnect(const MotionCheck& check, const ArmKinematics& kinematics,
                                        const ArmJoints& start, const std::vector<ArmJoints>& goals,
                                        std::uint64_t seed, const ArmPathParams& params) {
  SilenceOmpl();
  const base::Rng rng(seed);
  const auto info = MakeSpace(check, BoundsOf(kinematics, start, goals), rng.Fork(0).seed());
  const auto problem = MakeProblem(info, start, goals);
  og::RRTConnect planner(info);
  planner.setNearestNeighbors<ompl::NearestNeighborsLinear>();
  planner.setRange(kRange);
  planner.setProblemDefinition(problem);
  planner.setup();
  ob::IterationTerminationCondition limit(params.max_iterations);
  if (planner.solve(limit) != ob::PlannerStatus::EXACT_SOLUTION) return {};
  auto path = *problem->getSolutionPath()->as<og::PathGeometric>();
  Simplify(info, rng.Fork(1).seed(), params.max_simplifications, &path);
  std::vector<ArmJoints> points;
  for (const ob::State* state : path.getStates()) {
    points.push_back(FromState(state, static_cast<int>(start.size())));
  }
  return points;
}

}  // namespace hires::manipulation
