#include "knowledge/store/store_episodes.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "hires/base/error.h"
#include "knowledge/fluents/store_check.h"

namespace hires::knowledge {
namespace {

constexpr double kYear10000 = 253402300800.0;  // [s] since 1970: names have four digits of a year

const std::string kColumns = "id, name, task, outcome, imagined, parent, start, finish";

Episode Read(Rows* rows) {
  Episode episode;
  episode.id = rows->Integer(0);
  episode.name = rows->Text(1);
  episode.task = rows->Text(2);
  episode.outcome = rows->Text(3);
  episode.label = rows->Integer(4) != 0 ? Episode::Label::kImagined : Episode::Label::kReal;
  episode.parent = rows->Integer(5);
  episode.start = rows->Real(6);
  episode.finish = rows->Real(7);
  return episode;
}

bool IsEpisodeNumber(const std::string& text) {
  return !text.empty() &&
         std::all_of(text.begin(), text.end(), [](char c) { return '0' <= c && c <= '9'; });
}

void CheckStart(double time) {
  if (time >= 0.0 && time < kYear10000) return;
  throw base::ConfigError(fmt::format(
      "an episode cannot start at {} s; wanted seconds since 1970, before the year 10000", time));
}

void CheckFinish(const Episode& episode, double time) {
  const std::string who = fmt::format("episode {} ({})", episode.id, episode.name);
  if (std::isfinite(episode.finish)) {
    throw base::ConfigError(fmt::format("{} has finished already, at {} s with outcome '{}'", who,
                                        episode.finish, episode.outcome));
  }
  if (!std::isfinite(time) || time < episode.start) {
    throw base::ConfigError(
        fmt::format("{} started at {} s and cannot finish at {} s; give a later time", who,
                    episode.start, time));
  }
}

}  // namespace

Episodes::Episodes(StoreFile* file)
    : insert_(file->database(), "INSERT INTO episode(" + kColumns +
                                    ") SELECT ifnull(max(id), 0) + 1, ?, ?, '', ?, ?, ?, ? "
                                    "FROM episode RETURNING id"),
      finish_(file->database(), "UPDATE episode SET outcome = ?, finish = ? WHERE id = ?"),
      by_id_(file->database(), "SELECT " + kColumns + " FROM episode WHERE id = ?"),
      by_name_(file->database(), "SELECT " + kColumns + " FROM episode WHERE name = ?"),
      alike_(file->database(), "SELECT count(*) FROM episode WHERE name >= ?1 AND name < ?1||'.'"),
      all_(file->database(), "SELECT " + kColumns + " FROM episode ORDER BY id"),
      imagined_(file->database(), "SELECT id FROM episode WHERE imagined = 1 ORDER BY id") {}

std::string Episodes::NewName(double time) {
  const auto seconds = static_cast<std::time_t>(time);
  const std::string name = fmt::format("{:%Y-%m-%dT%H:%M:%S}", fmt::gmtime(seconds));
  // Of one second: the name itself, then -2, -3, ... without a gap; '-' comes just before '.'.
  Rows rows(alike_, name);
  rows.Next();
  return rows.Integer(0) == 0 ? name : fmt::format("{}-{}", name, rows.Integer(0) + 1);
}

Episode Episodes::Start(const std::string& task, Episode::Label label, std::int64_t parent,
                        double time) {
  if (!task.empty()) CheckName("task of an episode", task);
  CheckStart(time);
  if (parent != 0) Require(parent);
  Episode episode;
  episode.name = NewName(time);
  episode.task = task;
  episode.label = label;
  episode.parent = parent;
  episode.start = time;
  Rows rows(insert_, episode.name, task, label == Episode::Label::kImagined, parent, time,
            episode.finish);
  rows.Next();
  episode.id = rows.Integer(0);
  rows.Next();  // to its end, which completes the insertion
  return episode;
}

Episode Episodes::Finish(std::int64_t id, const std::string& outcome, double time) {
  Episode episode = Require(id);
  CheckName("outcome of an episode", outcome);
  CheckFinish(episode, time);
  Rows(finish_, outcome, time, id).Run();
  episode.outcome = outcome;
  episode.finish = time;
  return episode;
}

std::optional<Episode> Episodes::Find(std::int64_t id) {
  Rows rows(by_id_, id);
  if (!rows.Next()) return std::nullopt;
  return Read(&rows);
}

std::optional<Episode> Episodes::Find(const std::string& id_or_name) {
  std::int64_t id = 0;
  if (IsEpisodeNumber(id_or_name)) {
    const char* end = id_or_name.data() + id_or_name.size();
    const bool fits = std::from_chars(id_or_name.data(), end, id).ec == std::errc();
    return fits ? Find(id) : std::nullopt;
  }
  Rows rows(by_name_, id_or_name);
  if (!rows.Next()) return std::nullopt;
  return Read(&rows);
}

Episode Episodes::Require(std::int64_t id) {
  if (auto episode = Find(id)) return *episode;
  throw base::ConfigError(fmt::format("there is no episode {}; start one, or list them", id));
}

std::vector<Episode> Episodes::All() {
  std::vector<Episode> episodes;
  Rows rows(all_);
  while (rows.Next()) episodes.push_back(Read(&rows));
  return episodes;
}

std::vector<std::int64_t> Episodes::Imagined() {
  std::vector<std::int64_t> ids;
  Rows rows(imagined_);
  while (rows.Next()) ids.push_back(rows.Integer(0));
  return ids;
}

}  // namespace hires::knowledge
