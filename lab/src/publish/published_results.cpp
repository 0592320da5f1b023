#include "lab/src/publish/published_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "cli/report_output.h"
#include "hires/base/error.h"
#include "hires/base/text.h"
#include "lab/src/reproduce/answer_field.h"

namespace hires::lab {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

/// Of a number that stands in the answer of one play.
class AnswerReader {
 public:
  AnswerReader(std::string play, const ordered_json& answer)
      : play_(std::move(play)), answer_(answer) {}

  FoundNumber At(const std::string& pointer) const {
    const AnswerField field{play_, pointer};
    const Reading reading = ReadingAt(field, answer_);
    if (reading.found) return *reading.found;
    throw base::ConfigError(ToString(field) +
                            ": the answer has no value there; publish another number, or none");
  }

  FoundNumber LargestOf(const std::vector<std::string>& pointers) const {
    FoundNumber largest{-std::numeric_limits<double>::infinity()};
    for (const std::string& pointer : pointers) {
      const FoundNumber found = At(pointer);
      if (found.number > largest.number) largest = found;
    }
    return largest;
  }

 private:
  std::string play_;
  const ordered_json& answer_;
};

/// Nothing where an end is not finite: such an interval has no end there.
std::optional<double> EndOf(const std::optional<double>& end, double times) {
  if (!end || !std::isfinite(*end)) return std::nullopt;
  return *end * times;
}

/// Value, interval and count of a number, and when they were obtained.
void TakeAnswer(const PlaysDone::Answer& answer, const Play& play, const PlayedNumber& played,
                PublishedNumber* number) {
  const AnswerReader reader(play.name, answer.content);
  FoundNumber found = reader.LargestOf(played.at);
  if (!played.over.empty()) {
    found.number /= reader.At(played.over).number;
    found.lower = found.upper = std::nullopt;  // of what is divided, not of the quotient
  }
  if (!std::isfinite(found.number)) {
    throw base::ConfigError(number->name + ": is divided by 0; publish another number, or none");
  }
  if (!played.low.empty()) found.lower = reader.At(played.low).number;
  if (!played.high.empty()) found.upper = reader.At(played.high).number;
  number->value = found.number * played.times;
  number->low = EndOf(found.lower, played.times);
  number->high = EndOf(found.upper, played.times);
  if (!number->low || !number->high) number->low = number->high = std::nullopt;
  if (!played.n_at.empty()) number->n = std::lround(reader.At(played.n_at).number);
  number->date = answer.date;
  number->seconds = answer.seconds;
}

template <typename Value>
ordered_json OrNull(const std::optional<Value>& value) {
  return value ? ordered_json(*value) : ordered_json(nullptr);
}

template <typename Value>
std::optional<Value> ValueOrNone(const ordered_json& entry, const char* key) {
  return entry.at(key).is_null() ? std::nullopt : std::optional(entry.at(key).get<Value>());
}

PublishedNumber NumberFrom(const ordered_json& entry) {
  PublishedNumber number;
  number.name = entry.at("name");
  number.what = entry.at("what");
  number.value = ValueOrNone<double>(entry, "value");
  number.digits = entry.at("digits");
  number.unit = entry.at("unit");
  number.low = ValueOrNone<double>(entry, "low");
  number.high = ValueOrNone<double>(entry, "high");
  number.at_least = ValueOrNone<double>(entry, "at_least");
  number.at_most = ValueOrNone<double>(entry, "at_most");
  number.n = ValueOrNone<int>(entry, "n");
  number.truth = entry.at("truth");
  number.command = entry.at("command");
  number.seed = ValueOrNone<int>(entry, "seed");
  number.date = entry.at("date");
  number.version = entry.at("version");
  number.seconds = ValueOrNone<double>(entry, "seconds");
  number.is_kept = entry.at("kept");
  return number;
}

/// {0, 10, 2} for "0.10.2", so that it is later than 0.9.0.
std::vector<int> PartsOfVersion(const std::string& version) {
  std::vector<int> parts;
  for (const std::string& part : base::Split(version, '.')) {
    const bool is_number = !part.empty() && part.size() < 9 &&
                           part.find_first_not_of("0123456789") == std::string::npos;
    if (!is_number) return {};
    parts.push_back(std::stoi(part));
  }
  return parts;
}

}  // namespace

std::string DateOf(const PublishedResults& results) {
  std::string date;
  for (const PublishedNumber& number : results.numbers) {
    if (!number.is_kept) date = std::max(date, number.date);
  }
  return date;
}

std::string TypedCommand(const Play& play) {
  std::vector<std::string> words{ProgramNameOf(play)};
  for (std::size_t i = 0; i < play.command.size(); ++i) {
    std::string word = play.command[i];
    if (word == "--quiet") continue;
    if (word == "--json" && i + 1 < play.command.size() && play.command[i + 1] == "{answer}") {
      ++i;
      continue;
    }
    if (word[0] == '{' && word.find("}/") != std::string::npos) {
      word.erase(0, word.find("}/") + 2);
    }
    words.push_back(word);
  }
  return cli::CommandText(words);
}

PublishedResults ResultsOf(const PublishCatalogue& catalogue, const PlaysDone& done,
                           const std::string& version) {
  PublishedResults results{version, {}};
  std::vector<std::string> wrong;
  for (const PlayedSeries& series : catalogue.played) {
    const auto answer = done.answers.find(series.play.name);
    for (const PlayedNumber& played : series.numbers) {
      PublishedNumber number = played.number;
      number.version = version;
      number.command = TypedCommand(series.play);
      try {
        if (answer != done.answers.end()) TakeAnswer(answer->second, series.play, played, &number);
      } catch (const base::ConfigError& error) {
        wrong.push_back(error.what());
      }
      results.numbers.push_back(std::move(number));
    }
  }
  if (!wrong.empty()) throw base::ConfigError(base::Join(wrong, "\n"));
  results.numbers.insert(results.numbers.end(), catalogue.kept.begin(), catalogue.kept.end());
  return results;
}

ordered_json ToJson(const PublishedResults& results) {
  ordered_json numbers = ordered_json::array();
  for (const PublishedNumber& number : results.numbers) {
    numbers.push_back({{"name", number.name},
                       {"what", number.what},
                       {"value", OrNull(number.value)},
                       {"digits", number.digits},
                       {"unit", number.unit},
                       {"low", OrNull(number.low)},
                       {"high", OrNull(number.high)},
                       {"at_least", OrNull(number.at_least)},
                       {"at_most", OrNull(number.at_most)},
                       {"n", OrNull(number.n)},
                       {"truth", number.truth},
                       {"command", number.command},
                       {"seed", OrNull(number.seed)},
                       {"date", number.date},
                       {"version", number.version},
                       {"seconds", OrNull(number.seconds)},
                       {"kept", number.is_kept}});
  }
  return {{"version", results.version}, {"date", DateOf(results)}, {"numbers", numbers}};
}

PublishedResults ReadResults(const std::string& path) {
  const auto content = ordered_json::parse(base::ReadTextFile(path), nullptr, false);
  std::size_t entry = 0;
  try {
    PublishedResults results{content.at("version"), {}};
    for (const ordered_json& number : content.at("numbers")) {
      ++entry;
      results.numbers.push_back(NumberFrom(number));
    }
    return results;
  } catch (const ordered_json::exception& error) {
    throw base::ConfigError(
        fmt::format("{}: number {} cannot be read: {}; wanted what `hires_lab "
                    "publish` writes, which writes it again",
                    path, entry, error.what()));
  }
}

std::string ResultsPath(const std::string& package, const std::string& version) {
  return package + "/lab/results/" + version + ".json";
}

std::string NewestResults(const std::string& package) {
  const std::string folder = package + "/lab/results";
  std::vector<int> newest;
  std::string path;
  if (fs::is_directory(folder)) {
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
      if (entry.path().extension() != ".json") continue;
      const std::vector<int> version = PartsOfVersion(entry.path().stem().string());
      if (version <= newest) continue;
      newest = version;
      path = entry.path().string();
    }
  }
  if (!path.empty()) return path;
  throw base::ConfigError(folder +
                          ": has no results such as 0.2.0.json; `hires_lab publish` plays them");
}

}  // namespace hires::lab
