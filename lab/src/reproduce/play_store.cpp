#include "lab/src/reproduce/play_store.h"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>

#include "hires/base/error.h"
#include "hires/base/hash.h"
#include "hires/base/local_time.h"
#include "hires/base/text.h"
#include "reports/text/configuration_hash.h"

namespace hires::lab {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

void MakeFolder(const std::string& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error) {
    throw base::ConfigError(fmt::format(
        "{}: cannot be made: {}; name another folder with --results", path, error.message()));
  }
}

std::string NoteOf(const std::string& folder) { return folder + "/played.json"; }

}  // namespace

std::string HashOfFile(const std::string& path) {
  base::Hasher hasher;
  hasher.Add(base::ReadTextFile(path, std::size_t{1} << 30));
  return base::HexOf(hasher.value());
}

PlayStore::PlayStore(Place place) : place_(std::move(place)) { MakeFolder(place_.folder); }

std::string PlayStore::KeyOf(const Play& play) {
  const auto known = keys_.find(play.name);
  if (known != keys_.end()) return known->second;
  base::Hasher hasher;
  hasher.Add(HIRES_VERSION);
  for (const std::string& word : play.command) hasher.Add(word);
  for (const std::string& input : play.inputs) hasher.Add(HashOfInput(input));
  for (const std::string& other : NeededBy(play)) hasher.Add(keys_.at(other));
  return keys_[play.name] = base::HexOf(hasher.value());
}

std::string PlayStore::HashOfInput(const std::string& input) {
  const auto known = inputs_.find(input);
  if (known != inputs_.end()) return known->second;
  // Catalogues rest on results, and not the reverse.
  return inputs_[input] = reports::InputHash(place_.package, input,
                                             {"lab/config/reproduce", "lab/config/publish"});
}

std::string PlayStore::FolderOf(const Play& play) {
  return place_.folder + "/" + play.name + "-" + KeyOf(play);
}

void PlayStore::MakeRoom(const Play& play) { MakeFolder(FolderOf(play)); }

std::optional<PlayStore::Stored> PlayStore::Find(const Play& play) {
  const std::string note = NoteOf(FolderOf(play));
  if (!fs::exists(note) || !fs::exists(AnswerOf(play))) return std::nullopt;
  const auto content = ordered_json::parse(base::ReadTextFile(note), nullptr, false);
  if (!content.is_object() || !content.contains("build") || !content["build"].is_string() ||
      !content.contains("wall_seconds") || !content["wall_seconds"].is_number()) {
    throw base::ConfigError(fmt::format(
        "{}: is broken; wanted build and wall_seconds; delete its folder, and it is played again",
        note));
  }
  if (!content.contains("date")) return std::nullopt;  // of when no day was noted
  return Stored{AnswerOf(play), content["build"], content["wall_seconds"], content["date"]};
}

void PlayStore::Keep(const Play& play, double seconds) {
  const ordered_json note{{"play", play.name},
                          {"build", place_.build},
                          {"wall_seconds", seconds},
                          {"date", base::LocalTime().substr(0, 10)}};
  base::ReplaceTextFile(NoteOf(FolderOf(play)), note.dump(1) + "\n");
}

void PlayStore::Forget(const Play& play) {
  std::error_code ignored;  // what remains is found by MakeFolder or the next play
  fs::remove_all(FolderOf(play), ignored);
}

}  // namespace hires::lab
