#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/parallel.h"
#include "hires/base/check.h"
#include "hires/base/text.h"
#include "hires/imagination/evidence.h"
#include "lab/src/experiment/kinds.h"
#include "lab/src/experiment/topple_shares.h"

namespace hires::lab {
namespace {

using imagination::OutcomeCounts;

constexpr std::uint64_t kResamplingStream = 1ULL << 32;  // chains take those from 0 on

/// One motion set, over all its chains.
struct LoopTotals {
  double duration{0.0};  // [s]
  int legs{0}, failed{0}, falls{0}, put_back{0}, restarted{0};
};

LoopTotals TotalsOf(const Chains& chains) {
  LoopTotals totals;
  for (const std::vector<Leg>& chain : chains) {
    for (const Leg& leg : chain) {
      totals.duration += leg.result.duration;
      totals.falls += leg.result.falls;
      totals.failed += !leg.result.action_finished;
      totals.put_back += leg.was_put_back;
      totals.restarted += leg.was_restarted;
      ++totals.legs;
    }
  }
  return totals;
}

/// What is compared: the same two sets, counted in one way.
struct Pair {
  std::string title;
  OutcomeCounts first, second;
};

TextTable CountsTable(const ToppleLoopConfig& loop, const std::vector<Pair>& pairs) {
  TextTable table{"Samples, as Table 6.5", {{"", "samples"}}};
  for (const CountedEvent& event : kCountedEvents) table.rows[0].push_back(event.name);
  table.rows[0].push_back("confidence");
  for (const Pair& pair : pairs) {
    for (int s = 0; s < 2; ++s) {
      const OutcomeCounts& counts = s == 0 ? pair.first : pair.second;
      std::vector<std::string> row{pair.title + ", " + loop.motion_sets[s],
                                   fmt::format("{}", counts.total())};
      for (const CountedEvent& event : kCountedEvents)
        row.push_back(fmt::format("{}", counts.*event.count));
      row.push_back(fmt::format("{:.3f}", imagination::Confidence(counts)));
      table.rows.push_back(std::move(row));
    }
  }
  return table;
}

/// "0.02931 (0.02609 .. 0.03284)"
std::string EstimateText(const Interval& interval, int decimals) {
  return fmt::format("{0:.{3}f} ({1:.{3}f} .. {2:.{3}f})", interval.estimate, interval.lower,
                     interval.upper, decimals);
}

const Interval& IntervalNamed(const std::string& name,
                              const std::vector<NamedInterval>& intervals) {
  const auto found =
      std::find_if(intervals.begin(), intervals.end(),
                   [&](const NamedInterval& interval) { return interval.name == name; });
  HIRES_CHECK(found != intervals.end(), "no interval of this name: " + name);
  return found->interval;
}

constexpr int kShareDecimals = 5, kRatioDecimals = 2;

TextTable LikelihoodTable(const ToppleLoopConfig& loop, const std::vector<ResampledCounts>& counted,
                          const std::vector<NamedInterval>& intervals) {
  TextTable table{
      fmt::format("Likelihood L per event, as Table 6.6, with 95 % intervals by resampling {} and "
                  "{} {}",
                  counted[0].num_parts, counted[1].num_parts,
                  loop.one_truth_per_chain ? "chains" : "rounds of the route"),
      {{"", "event", "L " + loop.motion_sets[0], "L " + loop.motion_sets[1], "ratio"}}};
  for (const CountRate& rate : kCountRates) {
    for (const CountedEvent& event : kCountedEvents) {
      std::vector<std::string> row{rate.title, event.name};
      for (const std::string& set : loop.motion_sets) {
        row.push_back(
            EstimateText(IntervalNamed(ShareName(event, set, rate), intervals), kShareDecimals));
      }
      row.push_back(EstimateText(IntervalNamed(RatioName(event, rate), intervals), kRatioDecimals));
      table.rows.push_back(std::move(row));
    }
  }
  const OutcomeCounts& first = loop.references.at(loop.motion_sets[0]).counts;
  const OutcomeCounts& second = loop.references.at(loop.motion_sets[1]).counts;
  for (const CountedEvent& event : kCountedEvents) {
    table.rows.push_back({"reference", event.name,
                          fmt::format("{:.{}f}", ShareOf(first, event), kShareDecimals),
                          fmt::format("{:.{}f}", ShareOf(second, event), kShareDecimals),
                          fmt::format("{:.{}f}", RatioOf(first, second, event), kRatioDecimals)});
  }
  return table;
}

/// "43.8 s", or "never".
std::string Every(double duration, double count) {
  return count > 0.0 ? fmt::format("{:.2f} s", duration / count) : "never";
}

TextTable RunTable(const ToppleLoopConfig& loop, const std::vector<LoopTotals>& totals,
                   const std::vector<ResampledCounts>& counted) {
  TextTable table{
      "Runs",
      {{"", "duration", "legs", "failed", "falls", "a fall every", "a topple sample every",
        "a shaking sample every", "put back between legs", "robot put to goal"}}};
  for (int s = 0; s < 2; ++s) {
    const LoopTotals& t = totals[s];
    table.rows.push_back({loop.motion_sets[s], fmt::format("{:.0f} s", t.duration),
                          fmt::format("{}", t.legs), fmt::format("{}", t.failed),
                          fmt::format("{}", t.falls), Every(t.duration, t.falls),
                          Every(t.duration, counted[s].all.at_10hz.topple),
                          Every(t.duration, counted[s].all.at_10hz.shaking),
                          fmt::format("{}", t.put_back), fmt::format("{}", t.restarted)});
  }
  for (const std::string& set : loop.motion_sets) {
    const ToppleReference& reference = loop.references.at(set);
    table.rows.push_back({"reference, " + set, fmt::format("{:.0f} s", reference.duration), "", "",
                          "", "", Every(reference.duration, reference.counts.topple),
                          Every(reference.duration, reference.counts.shaking), "", ""});
  }
  return table;
}

/// Samples of each kind and of all, as Table 6.5.
void AddCounts(const std::string& motion_set, const CountRate& rate, const LoopCounts& counted,
               std::vector<Measure>* measures) {
  const OutcomeCounts& counts = counted.*rate.counts;
  const auto add = [&](const std::string& what, int count) {
    measures->push_back({what + "_count_" + motion_set + rate.suffix, static_cast<double>(count)});
  };
  for (const CountedEvent& event : kCountedEvents) add(event.name, counts.*event.count);
  add("all", counts.total());
}

std::vector<Measure> MeasuresOf(const ToppleLoopConfig& loop, const std::vector<LoopTotals>& totals,
                                const std::vector<ResampledCounts>& counted) {
  std::vector<Measure> measures;
  for (const CountedEvent& event : kCountedEvents) {
    for (const CountRate& rate : kCountRates) {
      measures.push_back({RatioName(event, rate), RatioOf(counted[0].all.*rate.counts,
                                                          counted[1].all.*rate.counts, event)});
    }
  }
  for (int s = 0; s < 2; ++s) {
    const std::string& set = loop.motion_sets[s];
    measures.push_back({"confidence_" + set, imagination::Confidence(counted[s].all.at_20hz)});
    measures.push_back({"falls_" + set, static_cast<double>(totals[s].falls)});
    measures.push_back(
        {"failed_share_" + set, static_cast<double>(totals[s].failed) / totals[s].legs});
    measures.push_back({"duration_" + set, totals[s].duration});
    for (const CountRate& rate : kCountRates) {
      for (const CountedEvent& event : kCountedEvents) {
        measures.push_back(
            {ShareName(event, set, rate), ShareOf(counted[s].all.*rate.counts, event)});
      }
      AddCounts(set, rate, counted[s].all, &measures);
    }
    measures.push_back({"independent_parts_" + set, static_cast<double>(counted[s].num_parts)});
  }
  return measures;
}

nlohmann::ordered_json RowOf(const std::string& motion_set, int chain, int number, const Leg& leg) {
  return {{"motion_set", motion_set},
          {"chain", chain},
          {"leg", number},
          {"from", leg.from},
          {"to", leg.to},
          {"failure", base::ToString(leg.result.failure.code)},
          {"subjects", base::Join(leg.result.failure.subjects, " ")},
          {"touched", leg.touched},
          {"action_finished", leg.result.action_finished},
          {"duration", leg.result.duration},
          {"notopple", leg.result.counts.notopple},
          {"shaking", leg.result.counts.shaking},
          {"topple", leg.result.counts.topple},
          {"falls", leg.result.falls},
          {"max_tilt", leg.result.max_tilt},
          {"first_cause", leg.result.first_cause},
          {"put_back_after", leg.was_put_back},
          {"restarted", leg.was_restarted}};
}

void AddRows(const std::string& motion_set, const Chains& chains, Findings* findings) {
  for (std::size_t c = 0; c < chains.size(); ++c) {
    for (std::size_t i = 0; i < chains[c].size(); ++i) {
      findings->rows.push_back(
          RowOf(motion_set, static_cast<int>(c), static_cast<int>(i), chains[c][i]));
      findings->simulated_seconds += chains[c][i].result.simulated;
    }
  }
}

/// Round and round, from the first goal of the route, until the time is over.
std::vector<Leg> PlayOneChain(const ToppleLoopConfig& loop, Chain chain, const base::Crew& crew,
                              const base::Advance& advance) {
  // A leg that cannot even start takes no time: so many in a row end the chain.
  const std::size_t most_without_time = 2 * loop.route.size();
  std::size_t without_time = 0;
  std::vector<Leg> legs;
  double duration = 0.0;
  for (std::size_t next = 1; duration < loop.duration / loop.chains; ++next) {
    auto leg = chain.Drive(loop.route[next % loop.route.size()], crew.cancelled);
    if (!leg) break;
    without_time = leg->result.duration > 0.0 ? 0 : without_time + 1;
    duration += leg->result.duration;
    advance(leg->result.duration);
    legs.push_back(*std::move(leg));
    if (without_time >= most_without_time) break;
  }
  return legs;
}

/// What the load of one chain went through, leg by leg.
void TellExperiences(const std::string& motion_set, std::size_t number, std::vector<Leg>* legs,
                     const imagination::RolloutParams& params, const OnExperience& on_experience) {
  reports::ToppleMonitor monitor(params);
  for (Leg& leg : *legs) {
    knowledge::ExperienceBatch batch{fmt::format("{}/{}", motion_set, number),
                                     fmt::format("move_base_param({}, {})", leg.to, motion_set),
                                     {}};
    monitor.Begin();
    for (const reports::ToppleSample& sample : leg.samples) {
      if (const auto part = monitor.Add(sample)) batch.parts.push_back(*part);
    }
    leg.samples = {};
    on_experience(batch);
  }
}

}  // namespace

std::optional<std::vector<Chains>> PlayToppleLoop(const ToppleLoopConfig& loop,
                                                  const ExperimentConfig& config,
                                                  const std::shared_ptr<const Stage>& stage,
                                                  const base::Crew& crew,
                                                  const OnExperience& on_experience) {
  std::vector<Chains> by_set(2, Chains(loop.chains));
  const auto play = [&](int task, const base::Advance& advance) {
    const int set = task % 2, number = task / 2;
    const std::uint64_t seed = base::Rng(config.seed).Fork(number).seed();
    Chain chain(stage, loop.route.front(),
                {loop.motion_sets[set], seed, true, loop.one_truth_per_chain,
                 static_cast<bool>(on_experience)});
    by_set[set][number] = PlayOneChain(loop, std::move(chain), crew, advance);
  };
  if (!base::DoInParallel(2 * loop.chains, 2.0 * loop.duration, crew, play)) return std::nullopt;
  for (std::size_t set = 0; on_experience && set < by_set.size(); ++set) {
    for (std::size_t number = 0; number < by_set[set].size(); ++number) {
      TellExperiences(loop.motion_sets[set], number, &by_set[set][number], stage->setup.rollout,
                      on_experience);
    }
  }
  return by_set;
}

Findings SumUpToppleLoop(const ToppleLoopConfig& loop, std::uint64_t seed,
                         const std::vector<Chains>& by_set) {
  Findings findings;
  const base::Rng rng = base::Rng(seed).Fork(kResamplingStream);
  std::vector<LoopTotals> totals;
  std::vector<ResampledCounts> counted;
  for (int s = 0; s < 2; ++s) {
    totals.push_back(TotalsOf(by_set[s]));
    counted.push_back(Resample(IndependentParts(loop, by_set[s]), rng.Fork(s)));
    AddRows(loop.motion_sets[s], by_set[s], &findings);
  }
  std::vector<Pair> pairs;
  for (const CountRate& rate : kCountRates) {
    pairs.push_back({rate.title, counted[0].all.*rate.counts, counted[1].all.*rate.counts});
  }
  pairs.push_back({"reference", loop.references.at(loop.motion_sets[0]).counts,
                   loop.references.at(loop.motion_sets[1]).counts});
  findings.intervals = LoopIntervals(loop, counted);
  findings.tables = {CountsTable(loop, pairs), LikelihoodTable(loop, counted, findings.intervals),
                     RunTable(loop, totals, counted)};
  findings.measures = MeasuresOf(loop, totals, counted);
  return findings;
}

}  // namespace hires::lab
