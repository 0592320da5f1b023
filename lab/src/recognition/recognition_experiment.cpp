#include "lab/src/recognition/recognition_experiment.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include "base/parallel.h"
#include "hires/base/resource_use.h"

namespace hires::lab {
namespace {

using perception::KnownModel;
using perception::RandomTable;
using perception::Recogniser;
using perception::RecognitionScore;
using perception::TabletopView;
using perception::ThingVerdict;

/// Recognisers that lack one form each, by the label of any model of it.
struct LeftOut {
  std::set<std::string> labels;
  std::vector<KnownModel> catalogue;  ///< what is left
  std::shared_ptr<const Recogniser> recogniser;
};

class TableTrial {
 public:
  explicit TableTrial(const RecognitionOrder& order);
  /// @param seconds  of the look at the whole catalogue.
  RecognitionScore Try(const RandomTable& table, std::uint64_t seed, double* seconds) const;
  std::vector<ThingVerdict> TryLeftOut(const RandomTable& table, std::uint64_t seed) const;

  const perception::RandomTables tables;

 private:
  const RecognitionOrder& order_;
  std::shared_ptr<const Recogniser> recogniser_;
  std::map<std::string, std::shared_ptr<const LeftOut>> without_;
};

TableTrial::TableTrial(const RecognitionOrder& order)
    : tables(order.robot, order.recogniser, order.variety),
      order_(order),
      recogniser_(
          std::make_shared<const Recogniser>(order.recogniser.catalogue, order.recogniser.params)) {
  const RecognitionScore kinds(order.recogniser.catalogue);
  for (const KnownModel& known : tables.catalogue()) {
    if (without_.count(known.label) > 0) continue;
    auto out = std::make_shared<LeftOut>();
    for (const std::string& label : kinds.LabelsLike(known.label)) out->labels.insert(label);
    for (const KnownModel& one : tables.catalogue())
      if (out->labels.count(one.label) == 0) out->catalogue.push_back(one);
    out->recogniser = std::make_shared<const Recogniser>(out->catalogue, order.recogniser.params);
    for (const std::string& label : out->labels) without_[label] = out;
  }
}

RecognitionScore TableTrial::Try(const RandomTable& table, std::uint64_t seed,
                                 double* seconds) const {
  const double begin = base::ThreadCpuSeconds();  // whatever else the machine does
  const TabletopView seen =
      perception::LookAtTable(recogniser_, table, order_.robot, base::Rng(seed));
  *seconds = base::ThreadCpuSeconds() - begin;
  RecognitionScore score(order_.recogniser.catalogue);
  score.Add(table, seen);
  return score;
}

std::vector<ThingVerdict> TableTrial::TryLeftOut(const RandomTable& table,
                                                 std::uint64_t seed) const {
  constexpr std::uint64_t kChoice = 1;
  std::vector<std::string> known;
  for (const perception::TableThing& thing : table.things)
    if (thing.is_known) known.push_back(thing.model);
  if (known.empty()) return {};
  const int chosen = base::Rng(seed).Fork(kChoice).Index(static_cast<int>(known.size()));
  const LeftOut& out = *without_.at(known[chosen]);
  RandomTable stranger = table;
  for (perception::TableThing& thing : stranger.things)
    if (out.labels.count(thing.model) > 0) thing.is_known = false;
  RecognitionScore score(out.catalogue);
  score.Add(stranger,
            perception::LookAtTable(out.recogniser, stranger, order_.robot, base::Rng(seed)));
  std::vector<ThingVerdict> verdicts;
  std::copy_if(score.things().begin(), score.things().end(), std::back_inserter(verdicts),
               [&](const ThingVerdict& one) { return out.labels.count(one.model) > 0; });
  return verdicts;
}

}  // namespace

std::optional<RecognitionReport> TryRecogniser(const RecognitionOrder& order,
                                               const base::Crew& crew) {
  const TableTrial trial(order);
  std::vector<RecognitionScore> scores(order.tables, RecognitionScore(order.recogniser.catalogue));
  std::vector<std::vector<ThingVerdict>> left_out(order.tables);
  std::vector<double> seconds(order.tables, 0.0);
  const auto work = [&](int task, const base::Advance& advance) {
    const std::uint64_t seed = order.seed + static_cast<std::uint64_t>(task);
    const RandomTable table = trial.tables.Make(seed);
    if (order.on_cloud) order.on_cloud(seed, table.cloud);
    scores[task] = trial.Try(table, seed, &seconds[task]);
    left_out[task] = trial.TryLeftOut(table, seed);
    advance(1.0);
  };
  if (!base::DoInParallel(order.tables, order.tables, crew, work)) return std::nullopt;
  RecognitionReport report{order.tables, order.seed, RecognitionScore(order.recogniser.catalogue),
                           order.variety};
  for (int i = 0; i < order.tables; ++i) {
    report.score.Append(scores[i]);
    for (ThingVerdict& thing : left_out[i]) {
      thing.table = i;
      report.left_out.push_back(std::move(thing));
    }
    report.seconds += seconds[i] / order.tables;
  }
  return report;
}

}  // namespace hires::lab
