#include "hires/imagination/rollout_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "hires/base/error.h"
#include "hires/base/text.h"

namespace hires::imagination {
namespace {

using Kind = RolloutChoice::Kind;

constexpr char kChoices[] = "worst, median, first_fall or a number from 0, and @RANK behind it";

int ParseNumber(const std::string& digits, const std::string& text) {
  int number = -1;
  const char* end = digits.data() + digits.size();
  const auto [rest, error] = std::from_chars(digits.data(), end, number);
  if (error == std::errc() && rest == end && number >= 0) return number;
  throw base::ConfigError(fmt::format("rollout '{}': wanted {}", text, kChoices));
}

/// -1 where there is none.
int IndexIn(const RolloutChoice& choice, const Evidence& evidence) {
  switch (choice.kind) {
    case Kind::kWorst:
      return evidence.worst_rollout;
    case Kind::kMedian:
      return evidence.median_rollout;
    case Kind::kFirstFailed:
      return evidence.first_failed;
    case Kind::kIndex:
      return choice.index < evidence.num_rollouts ? choice.index : -1;
  }
  return -1;
}

/// "alternative 3 has one: @3", for whoever asked the wrong one.
std::string OthersThatHave(const RolloutChoice& choice, const std::vector<Prediction>& ranking) {
  std::vector<std::string> others;
  for (std::size_t i = 0; i < ranking.size(); ++i) {
    if (IndexIn(choice, ranking[i].evidence) >= 0) others.push_back(fmt::format("@{}", i + 1));
  }
  if (others.empty()) return "no alternative has one; choose another";
  return "alternatives that have one: " + base::Join(others, ", ");
}

std::string WhyNot(const RolloutChoice& choice, const Evidence& evidence) {
  if (choice.kind == Kind::kFirstFailed) {
    return fmt::format("all {} rollouts succeeded", evidence.num_rollouts);
  }
  if (choice.kind == Kind::kIndex) {
    return fmt::format("there is no rollout {}: {} were played, counted from 0", choice.index,
                       evidence.num_rollouts);
  }
  return fmt::format("none of {} rollouts finished", evidence.num_rollouts);
}

void RequireRank(int rank, std::size_t num_alternatives) {
  if (rank <= static_cast<int>(num_alternatives)) return;
  throw base::ConfigError(
      fmt::format("rank {} of {} alternatives; choose a lower one", rank, num_alternatives));
}

PickedRollout PickOf(int rank, const RolloutChoice& choice,
                     const std::vector<Prediction>& ranking) {
  RequireRank(rank, ranking.size());
  const Evidence& evidence = ranking[rank - 1].evidence;
  const int index = IndexIn(choice, evidence);
  if (index >= 0) return {rank, index};
  throw base::ConfigError(fmt::format("alternative {}, {}: {}; {}", rank,
                                      ToString(ranking[rank - 1].action), WhyNot(choice, evidence),
                                      OthersThatHave(choice, ranking)));
}

PickedRollout PickWorstOfAll(const std::vector<Prediction>& ranking, const TiltOfRollout& tilt_of) {
  const bool some_failed = std::any_of(ranking.begin(), ranking.end(), [](const Prediction& p) {
    return p.evidence.first_failed >= 0;
  });
  std::optional<PickedRollout> worst;
  double largest = -1.0;
  for (std::size_t i = 0; i < ranking.size(); ++i) {
    const Evidence& evidence = ranking[i].evidence;
    if (evidence.worst_rollout < 0 || (some_failed && evidence.first_failed < 0)) continue;
    const double tilt = tilt_of(ranking[i].action, evidence.worst_rollout);
    if (tilt <= largest) continue;
    largest = tilt;
    worst = PickedRollout{static_cast<int>(i) + 1, evidence.worst_rollout};
  }
  if (worst) return *worst;
  throw base::ConfigError(
      "no rollout finished, so there is no worst one; choose one by its number");
}

}  // namespace

RolloutChoice ParseRolloutChoice(const std::string& text) {
  const std::size_t at = text.find('@');
  const std::string which = text.substr(0, at);
  RolloutChoice choice;
  if (at != std::string::npos) choice.rank = ParseNumber(text.substr(at + 1), text);
  if (choice.rank == 0) {
    throw base::ConfigError(fmt::format("rollout '{}': ranks count from 1", text));
  }
  if (which == "worst") {
    choice.kind = Kind::kWorst;
  } else if (which == "median") {
    choice.kind = Kind::kMedian;
  } else if (which == "first_fall") {
    choice.kind = Kind::kFirstFailed;
  } else {
    choice.kind = Kind::kIndex;
    choice.index = ParseNumber(which, text);
  }
  return choice;
}

void RequireRollout(const RolloutChoice& choice, std::size_t num_alternatives, int num_rollouts) {
  if (choice.rank) RequireRank(*choice.rank, num_alternatives);
  if (choice.kind != Kind::kIndex || choice.index < num_rollouts) return;
  throw base::ConfigError(fmt::format(
      "there is no rollout {}: at most {} of each alternative are played, counted from 0; choose a "
      "lower one or raise --rollouts",
      choice.index, num_rollouts));
}

PickedRollout PickRollout(const RolloutChoice& choice, const std::vector<Prediction>& ranking,
                          const TiltOfRollout& tilt_of) {
  if (choice.kind == Kind::kWorst && !choice.rank) return PickWorstOfAll(ranking, tilt_of);
  return PickOf(choice.rank.value_or(1), choice, ranking);
}

TiltOfRollout TiltsIn(const RolloutSetup& setup) {
  return [&setup](const base::ActionCall& action, int index) {
    return PlayRollout(setup, action, index)->max_tilt;
  };
}

std::optional<RolloutRecording> ReplayRollout(const RolloutSetup& setup,
                                              const Prediction& prediction, int index,
                                              const std::function<bool()>& cancelled,
                                              RolloutWatcher* watcher) {
  auto recording = RecordRollout(setup, prediction.action, index, cancelled, watcher);
  if (!recording || IsAmong(prediction.evidence, recording->result)) return recording;
  throw base::ConfigError(fmt::format(
      "rollout {} played here is none of those that were imagined; the workers have another build "
      "or another world, robot or objects than this program: give it theirs",
      index));
}

}  // namespace hires::imagination
