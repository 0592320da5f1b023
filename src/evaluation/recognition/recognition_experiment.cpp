#include "hires/evaluation/recognition/recognition_experiment.h"

#include <chrono>

#include "hires/evaluation/experiment_parallel.h"

namespace hires::evaluation {

using perception::RecognitionScore;

std::optional<RecognitionReport> TryRecogniser(const RecognitionOrder& order, const Crew& crew) {
  const perception::RandomTables tables(order.robot, order.objects);
  const perception::Recogniser recogniser(order.recogniser.catalogue, order.recogniser.params);
  std::vector<RecognitionScore> scores(order.tables, RecognitionScore(order.recogniser.catalogue));
  std::vector<double> seconds(order.tables, 0.0);
  const auto work = [&](int task, const Advance& advance) {
    const std::uint64_t seed = order.seed + static_cast<std::uint64_t>(task);
    const perception::RandomTable table = tables.Make(seed);
    const auto begin = std::chrono::steady_clock::now();
    const auto seen = recogniser.Recognise(table.cloud, table.stand, base::Rng(seed));
    seconds[task] = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    scores[task].Add(table, seen);
    advance(1.0);
  };
  if (!DoInParallel(order.tables, order.tables, crew, work)) return std::nullopt;
  RecognitionReport report{order.tables, order.seed, RecognitionScore(order.recogniser.catalogue)};
  for (int i = 0; i < order.tables; ++i) {
    report.score.Append(scores[i]);
    report.seconds += seconds[i] / order.tables;
  }
  return report;
}

}  // namespace hires::evaluation
