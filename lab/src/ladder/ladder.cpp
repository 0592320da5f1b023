#include "lab/src/ladder/ladder.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "hires/base/check.h"
#include "hires/base/error.h"
#include "lab/src/ladder/own_rungs.h"
#include "lab/src/ladder/rungs.h"

namespace hires::lab {
namespace {

using ladder::Measured;
using ladder::OwnPlan;
using ladder::RungPlan;
using ladder::Way;

constexpr double kEfficiencyShare = 2.0;  // of the drive on one and on all threads

void CheckOrder(const LadderOrder& order) {
  if (!(order.seconds > 0.0 && order.seconds <= 86400.0)) {
    throw base::ConfigError(fmt::format(
        "ladder: seconds is {:g}, wanted more than 0 and at most 86400", order.seconds));
  }
  if (order.repeats < 2 || order.repeats > 1000) {
    throw base::ConfigError(fmt::format(
        "ladder: repeats is {}, wanted 2 to 1000: one repeat has no interval", order.repeats));
  }
  HIRES_CHECK(order.clocks.wall && order.clocks.processor, "a measurement needs its clocks");
}

LadderSide SideOf(const Way& way, const Measured& measured) {
  return {way.what, way.facts, measured.Rates()};
}

LadderPair PairOf(int threads, const RungPlan& plan, const std::vector<Measured>& both) {
  LadderPair pair{threads,
                  both[0].stretches.front().rounds,
                  SideOf(plan.before, both[0]),
                  SideOf(plan.after, both[1]),
                  {}};
  pair.ratio = ladder::RatioOf(pair.before.values, pair.after.values);
  return pair;
}

LadderOwn OwnOf(std::string id, std::string title, std::string unit, std::vector<double> values) {
  const Interval mean = MeanInterval(values);
  return {std::move(id), std::move(title), std::move(unit), std::move(values), mean};
}

/// Measures one plan after the other and tells how far it is.
class Climber {
 public:
  Climber(const LadderOrder& order, const base::Crew& crew)
      : order_(order),
        crew_(crew),
        places_(order.package_folder, order.seed),
        begin_(order.clocks.wall()) {}

  std::optional<LadderReport> Climb() {
    const std::vector<RungPlan> rungs = ladder::DissertationRungs(places_, order_.play_task);
    const std::vector<OwnPlan> own = ladder::RolloutSteps(places_);
    const OwnPlan answer =
        ladder::RankedAnswer(places_, order_.answer_rollouts, crew_.threads, crew_.cancelled);
    CountShares(rungs, own, answer);
    report_ = {crew_.threads, order_.seconds, order_.repeats, order_.seed, 0.0, {}, {}};
    for (const RungPlan& plan : rungs)
      if (!Measure(plan)) return std::nullopt;
    for (const OwnPlan& plan : own)
      if (!Measure(plan)) return std::nullopt;
    if (!MeasureThreads() || !Measure(answer)) return std::nullopt;
    if (task_) report_.own.push_back(*std::move(task_));
    report_.wall_seconds = order_.clocks.wall() - begin_;
    return std::move(report_);
  }

 private:
  void CountShares(const std::vector<RungPlan>& rungs, const std::vector<OwnPlan>& own,
                   const OwnPlan& answer) {
    shares_ = kEfficiencyShare + answer.share;
    for (const RungPlan& plan : rungs) shares_ += plan.share * (plan.on_all_cores ? 2.0 : 1.0);
    for (const OwnPlan& plan : own) shares_ += plan.share;
  }

  std::optional<std::vector<Measured>> Measure(const std::vector<const Way*>& ways,
                                               const std::vector<int>& threads, double share) {
    const ladder::Effort effort{order_.seconds * share / shares_, order_.repeats};
    auto measured = ladder::MeasureByTurns(ways, threads, effort, order_.clocks, crew_.cancelled);
    done_ += share;
    if (crew_.on_progress) crew_.on_progress(done_ / shares_, order_.clocks.wall() - begin_);
    return measured;
  }

  bool Measure(const RungPlan& plan) {
    const std::vector<const Way*> ways{&plan.before, &plan.after};
    const auto one = Measure(ways, {1, 1}, plan.share);
    if (!one) return false;
    LadderRung rung = plan.rung;
    rung.one_core = PairOf(1, plan, *one);
    if (plan.is_one_motion) rung.apart = ladder::Apart((*one)[0].end, (*one)[1].end);
    if (rung.id == "bare_robot") {
      task_ = OwnOf("task", "the scenario topple as a whole task, imagination included",
                    "s of processor", (*one)[0].ProcessorSecondsEach());
    }
    if (plan.on_all_cores) {
      const auto all = Measure(ways, {crew_.threads, crew_.threads}, plan.share);
      if (!all) return false;
      rung.all_cores = PairOf(crew_.threads, plan, *all);
    }
    report_.rungs.push_back(std::move(rung));
    return true;
  }

  bool Measure(const OwnPlan& plan) {
    const auto one = Measure({&plan.way}, {1}, plan.share);
    if (!one) return false;
    const Measured& measured = one->front();
    report_.own.push_back(OwnOf(plan.id, plan.title, plan.unit,
                                plan.counts_seconds ? measured.SecondsEach() : measured.Rates()));
    return true;
  }

  /// The same drives on one thread and on all of them.
  bool MeasureThreads() {
    const Way drive = ladder::DriveWay(places_.drawn(), order_.seed, "");
    const auto both = Measure({&drive, &drive}, {1, crew_.threads}, kEfficiencyShare);
    if (!both) return false;
    const std::vector<double> one = (*both)[0].Rates(), all = (*both)[1].Rates();
    std::vector<double> efficiency;
    for (std::size_t i = 0; i < one.size(); ++i)
      efficiency.push_back(all[i] / (one[i] * crew_.threads));
    const char* factor = "real-time factor";
    report_.own.push_back(OwnOf("drive", "rollouts of a drive, place as drawn", factor, one));
    report_.own.push_back(OwnOf("drive_all_cores",
                                fmt::format("the same on {} threads together", crew_.threads),
                                factor, all));
    report_.own.push_back(OwnOf("parallel_efficiency",
                                "all threads together / (one thread x their number)", "share",
                                efficiency));
    return true;
  }

  const LadderOrder& order_;
  const base::Crew& crew_;
  const ladder::Places places_;
  const double begin_;  // [s]
  double shares_{0.0}, done_{0.0};
  LadderReport report_;
  std::optional<LadderOwn> task_;
};

}  // namespace

std::optional<LadderReport> ClimbLadder(const LadderOrder& order, const base::Crew& crew) {
  CheckOrder(order);
  if (crew.cancelled && crew.cancelled()) return std::nullopt;
  return Climber(order, crew).Climb();
}

}  // namespace hires::lab
