#include "execution/plan_network.h"

#include <fmt/format.h>

#include <algorithm>

#include "hires/base/check.h"

namespace hires::execution {
namespace {

using temporal::Bounds;
using temporal::kForever;

constexpr Bounds kLater{0.0, kForever};
constexpr double kGrowth = 0.1;  ///< of what a step took already: what it may still take

}  // namespace

void PlanNetwork::Layer::AddStep(const std::string& name, const Bounds& duration) {
  const int step = static_cast<int>(starts.size());
  starts.push_back(network.AddPoint("start of " + name));
  finishes.push_back(network.AddPoint("finish of " + name));
  lasts.emplace_back();
  is_ahead.push_back(kNone);
  SetAhead(step, starts[step], name + " has not begun");
  network.Constrain(finishes[step], end, kLater, "the plan has ended");
  AddDuration(step, duration, name + " lasts");
}

std::optional<temporal::Stn::Conflict> PlanNetwork::Layer::AddDuration(int step,
                                                                       const Bounds& bounds,
                                                                       const std::string& why) {
  Stn::ConstraintId id = kNone;
  auto conflict = network.Constrain(starts[step], finishes[step], bounds, why, &id);
  if (!conflict) lasts[step].push_back(id);
  return conflict;
}

void PlanNetwork::Layer::DropDurations(int step) {
  for (const Stn::ConstraintId id : lasts[step]) network.Retract(id);
  lasts[step].clear();
}

void PlanNetwork::Layer::SetAhead(int step, Stn::Point point, const std::string& why) {
  DropAhead(step);
  network.Constrain(now, point, kLater, why, &is_ahead[step]);
}

void PlanNetwork::Layer::DropAhead(int step) {
  if (is_ahead[step] != kNone) network.Retract(is_ahead[step]);
  is_ahead[step] = kNone;
}

void PlanNetwork::Layer::SetNow(double time) {
  const Stn::ConstraintId old = is_now;
  const auto conflict = network.Constrain(Stn::kOrigin, now, {time, kForever}, "now", &is_now);
  HIRES_CHECK(!conflict, "time contradicts the plan: " + conflict->text);
  if (old != kNone) network.Retract(old);
}

void PlanNetwork::Layer::Fix(Stn::Point point, double time, const std::string& why) {
  const auto conflict = network.Constrain(Stn::kOrigin, point, {time, time}, why);
  HIRES_CHECK(!conflict, "what happened contradicts the plan: " + conflict->text);
}

PlanNetwork::PlanNetwork(const PlanRun& run, const std::vector<int>& informs, double now,
                         double lead)
    : informs_(run.size(), kNone), started_(run.size()), lead_(lead), now_(now) {
  for (Layer* layer : {&bounds_, &expectation_}) {
    layer->now = layer->network.AddPoint("now");
    layer->end = layer->network.AddPoint("end of the plan");
  }
  for (int i = 0; i < run.size(); ++i) {
    const StepRun& step = run.at(i);
    is_imagine_.push_back(step.kind == StepRun::Kind::kImagine);
    names_.push_back(ToString(step.action));
    expected_.push_back(step.expected);
    bounds_.AddStep(names_[i], {step.duration.min, step.duration.max});
    // Imagining takes the robot no time: nothing is expected of it.
    expectation_.AddStep(names_[i], is_imagine_[i] ? kLater : Bounds{step.expected, step.expected});
  }
  AddOrder(run, informs);
  SetNow(now);
}

void PlanNetwork::AddOrder(const PlanRun& run, const std::vector<int>& informs) {
  for (int i = 0; i < run.size(); ++i) {
    for (const int before : run.at(i).after) {
      const std::string why = names_[before] + " comes before " + names_[i];
      for (Layer* layer : {&bounds_, &expectation_}) {
        layer->network.Constrain(layer->finishes[before], layer->starts[i], kLater, why);
      }
    }
    if (informs[i] < 0) continue;
    bounds_.network.Constrain(bounds_.finishes[i], bounds_.starts[informs[i]], kLater,
                              names_[informs[i]] + " is imagined before", &informs_[i]);
  }
}

void PlanNetwork::Expect(int step, double duration) {
  expected_[step] = duration;
  expectation_.DropDurations(step);
  expectation_.AddDuration(step, {duration, duration}, names_[step] + " lasts");
}

/// A step that goes on beyond what was thought goes on for a while.
void PlanNetwork::Extend(int step) {
  const double elapsed = now_ - *started_[step];
  const Bounds lasts = bounds_.network.Between(bounds_.starts[step], bounds_.finishes[step]);
  if (elapsed + lead_ > lasts.latest) bounds_.DropDurations(step);
  if (expected_[step] - elapsed >= lead_) return;
  Expect(step, elapsed + 2.0 * lead_ + kGrowth * elapsed);
}

void PlanNetwork::SetNow(double now) {
  now_ = now;
  for (const int step : running_) {
    if (!is_imagine_[step]) Extend(step);
  }
  bounds_.SetNow(now);
  expectation_.SetNow(now);
}

void PlanNetwork::Begin(int step, double started) {
  started_[step] = started;
  running_.push_back(step);
  for (Layer* layer : {&bounds_, &expectation_}) {
    layer->DropAhead(step);
    layer->Fix(layer->starts[step], started, names_[step] + " began");
  }
  if (!is_imagine_[step]) Extend(step);
  for (Layer* layer : {&bounds_, &expectation_}) {
    layer->SetAhead(step, layer->finishes[step], names_[step] + " has not ended");
  }
}

void PlanNetwork::End(int step, double finished) {
  running_.erase(std::remove(running_.begin(), running_.end(), step), running_.end());
  for (Layer* layer : {&bounds_, &expectation_}) {
    layer->DropAhead(step);
    layer->DropDurations(step);  // it took what it took
    layer->Fix(layer->finishes[step], finished, names_[step] + " ended");
  }
}

void PlanNetwork::Forget(int step) {
  if (informs_[step] == kNone) return;
  bounds_.network.Retract(informs_[step]);
  informs_[step] = kNone;
}

std::optional<std::string> PlanNetwork::Tighten(int step, const planning::Duration& duration) {
  if (duration.expected) Expect(step, *duration.expected);
  const auto conflict = bounds_.AddDuration(step, {duration.min, duration.max},
                                            names_[step] + " lasts, as imagined,");
  if (conflict) return conflict->text;
  return std::nullopt;
}

Bounds PlanNetwork::StartOf(int step) const { return bounds_.network.Of(bounds_.starts[step]); }
Bounds PlanNetwork::FinishOf(int step) const { return bounds_.network.Of(bounds_.finishes[step]); }

double PlanNetwork::ExpectedStart(int step) const {
  return expectation_.network.Of(expectation_.starts[step]).earliest;
}
double PlanNetwork::ExpectedFinish(int step) const {
  return expectation_.network.Of(expectation_.finishes[step]).earliest;
}

double PlanNetwork::LatestStart(int step) const {
  const Stn& network = expectation_.network;
  return network.Of(expectation_.end).earliest -
         network.Between(expectation_.starts[step], expectation_.end).earliest;
}

}  // namespace hires::execution
