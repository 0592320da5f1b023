#pragma once

#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "lab/src/reproduce/play.h"
#include "lab/src/reproduce/play_store.h"

namespace hires::lab {

/// What became of the plays, by name.
struct PlaysDone {
  struct Answer {
    nlohmann::ordered_json content;
    std::string key, build, command;
    double seconds{0.0};  ///< [s] wall time
    std::string date;     ///< when it was played: "2026-11-28"
    bool is_new{false};   ///< played just now
  };
  std::map<std::string, Answer> answers;
  std::map<std::string, std::string> missing;  ///< why
  bool is_cancelled{false};
};

/// How far they are, in seconds of work.
struct PlaysProgress {
  std::string play;
  std::size_t number{0}, all{0};  ///< of the play, from 1, and of all that are to be played
  double done{0.0}, left{0.0};    ///< [s]
};

struct PlaysOrder {
  std::vector<Play> plays;           ///< each after those whose answers it takes
  std::string program, lab_program;  ///< that play: `hires` and `hires_lab`
  std::string package;
  bool again{false};  ///< what is there is played once more
  std::function<bool()> cancelled;
  std::function<void(const PlaysProgress&)> on_progress;  ///< may be empty
};

/// Plays what has no answer yet, each in a process of its own, one after the other; what fails is
/// told, and the others go on.
/// @pre called by the main thread: a child ends with the thread that started it.
PlaysDone PlayAll(const PlaysOrder& order, PlayStore* store);

}  // namespace hires::lab
