#include "lab/src/reproduce/play_runner.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "cli/report_output.h"
#include "hires/base/error.h"
#include "hires/base/process.h"
#include "hires/base/run_processes.h"
#include "hires/base/text.h"

namespace hires::lab {
namespace {

using nlohmann::ordered_json;

constexpr double kGrace = 10.0;        // [s] for a play to end when it is asked to
constexpr double kAlmost = 0.95;       // of what is foretold; a play that lasts longer stays there
constexpr double kLongLasting = 1e-6;  // [s] against division by 0
constexpr std::chrono::milliseconds kLook{100};

std::string Replaced(std::string word, const std::string& what, const std::string& by) {
  for (std::size_t at = word.find(what); at != std::string::npos; at = word.find(what, at)) {
    word.replace(at, what.size(), by);
    at += by.size();
  }
  return word;
}

bool IsOfLab(const Play& play) { return ProgramNameOf(play) != "hires"; }

class PlayRunner {
 public:
  PlayRunner(const PlaysOrder& order, PlayStore* store) : order_(order), store_(*store) {}

  PlaysDone Run() {
    for (const Play& play : order_.plays) {
      store_.KeyOf(play);
      if (order_.again || !store_.Find(play)) Plan(play);
    }
    for (const Play& play : order_.plays) {
      if (done_.is_cancelled) {
        done_.missing[play.name] = "not reached; the same command goes on";
      } else {
        Take(play);
      }
    }
    return std::move(done_);
  }

 private:
  void Plan(const Play& play) {
    progress_.left += play.seconds;
    ++progress_.all;
  }

  void Take(const Play& play) {
    const auto stored = store_.Find(play);
    if (stored && !order_.again) return Read(play, *stored, false);
    for (const std::string& needed : NeededBy(play)) {
      if (done_.answers.count(needed) > 0) continue;
      done_.missing[play.name] = fmt::format("needs the answer of '{}', which is missing", needed);
      progress_.left -= play.seconds;
      return;
    }
    if (order_.again) store_.Forget(play);  // at its turn: interrupted, the others keep theirs
    RunPlay(play);
  }

  void RunPlay(const Play& play) {
    progress_.play = play.name;
    ++progress_.number;
    const double begin = base::SteadyNow();
    const auto ended = RunChild(play, begin);
    progress_.left -= play.seconds;
    if (!ended) {
      done_.is_cancelled = true;
      done_.missing[play.name] =
          order_.again ? "interrupted; the same command without --again goes on with it, and takes "
                         "the old answers of those after it"
                       : "interrupted; the same command goes on";
      return;
    }
    const double seconds = base::SteadyNow() - begin;
    progress_.done += seconds;
    if (!IsWhole(play, *ended)) {
      done_.missing[play.name] =
          fmt::format("{}: {} (all it said: {})", *ended, base::LastLineOf(store_.LogOf(play)),
                      store_.LogOf(play));
      return;
    }
    store_.Keep(play, seconds);
    Read(play, *store_.Find(play), true);
  }

  /// How it ended; nothing where it was interrupted.
  std::optional<std::string> RunChild(const Play& play, double begin) {
    base::ProcessOptions options;
    options.command = {IsOfLab(play) ? order_.lab_program : order_.program};
    for (const std::string& word : play.command) options.command.push_back(Filled(word, play));
    options.output = store_.LogOf(play);
    store_.MakeRoom(play);
    std::filesystem::remove(store_.AnswerOf(play));
    base::ChildProcess child(options);
    while (true) {
      if (const auto ended = child.Ended()) return ended;
      if (order_.cancelled()) {
        child.Terminate(kGrace);
        return std::nullopt;
      }
      Tell(play, base::SteadyNow() - begin);
      std::this_thread::sleep_for(kLook);
    }
  }

  void Tell(const Play& play, double elapsed) {
    if (!order_.on_progress) return;
    PlaysProgress now = progress_;
    now.done += elapsed;
    now.left -= std::min(elapsed, kAlmost * play.seconds);
    now.left = std::max(now.left, kLongLasting);
    order_.on_progress(now);
  }

  std::string Filled(std::string word, const Play& play) {
    word = Replaced(word, "{package}", order_.package);
    word = Replaced(word, "{answer}", store_.AnswerOf(play));
    word = Replaced(word, "{folder}", store_.FolderOf(play));
    for (const Play& other : order_.plays) {
      word = Replaced(word, "{" + other.name + "}", store_.AnswerOf(other));
      word = Replaced(word, "{" + other.name + "/folder}", store_.FolderOf(other));
    }
    return word;
  }

  bool IsWhole(const Play& play, const std::string& ended) {
    const bool is_done = std::any_of(play.done_codes.begin(), play.done_codes.end(), [&](int code) {
      return ended == fmt::format("exit code {}", code);
    });
    return is_done && std::filesystem::exists(store_.AnswerOf(play));
  }

  void Read(const Play& play, const PlayStore::Stored& stored, bool is_new) {
    auto content =
        ordered_json::parse(base::ReadTextFile(stored.path, std::size_t{1} << 30), nullptr, false);
    if (content.is_discarded()) {
      done_.missing[play.name] =
          stored.path + ": is no JSON; delete its folder, and it is played again";
      return;
    }
    std::vector<std::string> words{ProgramNameOf(play)};
    words.insert(words.end(), play.command.begin(), play.command.end());
    done_.answers[play.name] = {
        std::move(content), store_.KeyOf(play), stored.build, cli::CommandText(words),
        stored.seconds,     stored.date,        is_new};
  }

  const PlaysOrder& order_;
  PlayStore& store_;
  PlaysDone done_;
  PlaysProgress progress_;
};

}  // namespace

PlaysDone PlayAll(const PlaysOrder& order, PlayStore* store) {
  return PlayRunner(order, store).Run();
}

}  // namespace hires::lab
