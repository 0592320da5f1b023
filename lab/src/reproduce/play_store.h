#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "lab/src/reproduce/play.h"

namespace hires::lab {

/// The content of a file: 16 digits.  @throws base::ConfigError if it cannot be read.
std::string HashOfFile(const std::string& path);

/// Answers of plays in a folder, each with what it rests on, so that nothing is played twice.
class PlayStore {
 public:
  struct Place {
    std::string folder;   ///< of the answers; made where it is missing
    std::string package;  ///< where config/, worlds/ and urdf/ lie
    std::string build;    ///< tells apart the programs that play
  };
  /// @throws base::ConfigError if the folder cannot be made.
  explicit PlayStore(Place place);

  /// What an answer rests on: the command, what counts of the play's inputs, this version, and the
  /// same of the plays whose answers it takes. 16 digits.
  /// @pre asked of those before.  @throws base::ConfigError for an input that cannot be read.
  std::string KeyOf(const Play& play);

  struct Stored {
    std::string path;     ///< of the answer
    std::string build;    ///< of the program that played it
    double seconds{0.0};  ///< [s] wall time it took
    std::string date;     ///< when it was done: "2026-11-28"
  };
  /// The answer of this key, if it is there.  @throws base::ConfigError for a broken file.
  std::optional<Stored> Find(const Play& play);

  /// Where the play of this key writes its answer, keeps what it needs to go on, and what it says.
  std::string FolderOf(const Play& play);
  /// Makes that folder where it is missing.  @throws base::ConfigError if it cannot be made.
  void MakeRoom(const Play& play);
  std::string AnswerOf(const Play& play) { return FolderOf(play) + "/answer.json"; }
  std::string LogOf(const Play& play) { return FolderOf(play) + "/log.txt"; }

  /// Notes that its answer is whole, as of today.
  void Keep(const Play& play, double seconds);
  /// Forgets it, with all that was kept to go on.
  void Forget(const Play& play);

  const std::string& build() const { return place_.build; }

 private:
  const Place place_;
  std::string HashOfInput(const std::string& input);

  std::map<std::string, std::string> keys_, inputs_;  // by play; by input: many plays share them
};

}  // namespace hires::lab
