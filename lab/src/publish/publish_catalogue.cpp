#include "lab/src/publish/publish_catalogue.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <regex>
#include <set>

#include "hires/base/error.h"
#include "hires/base/param_reader.h"
#include "hires/base/text.h"
#include "lab/src/publish/template_text.h"

namespace hires::lab {
namespace {

constexpr double kLargestNumber = 1e12;
constexpr int kLargestCount = 2'000'000'000;
constexpr int kMostDigits = 6;

/// What is wrong with a file, all of it.
class Complaints {
 public:
  /// What cannot be read is noted, and reading goes on.
  void Try(const std::function<void()>& read) {
    try {
      read();
    } catch (const base::ConfigError& error) {
      Add(error.what());
    }
  }
  void Add(const std::string& what) { lines_.push_back(what); }
  bool empty() const { return lines_.empty(); }
  void ThrowIfAny() const {
    if (!empty()) throw base::ConfigError(base::Join(lines_, "\n"));
  }

 private:
  std::vector<std::string> lines_;
};

base::Bound<std::string> Like(const char* pattern, const std::string& wanted) {
  return {[expression = std::regex(pattern)](const std::string& text) {
            return std::regex_match(text, expression);
          },
          wanted};
}

void ReadCount(base::ParamReader* in, std::optional<int>* count) {
  if (in->Has("n")) *count = in->Get("n", base::Between(0, kLargestCount));
}

/// What the numbers of a series share.
PublishedNumber ReadShared(base::ParamReader* in, Complaints* complaints) {
  PublishedNumber shared;
  complaints->Try([&] { shared.truth = in->Get("truth", base::OneOf(Truths())); });
  complaints->Try([&] {
    if (in->Has("seed")) shared.seed = in->Get("seed", base::Between(0, kLargestCount));
  });
  complaints->Try([&] { ReadCount(in, &shared.n); });
  return shared;
}

/// What each number says of itself.
void ReadNumber(base::ParamReader* in, PublishedNumber* number, Complaints* complaints) {
  complaints->Try(
      [&] { number->name = in->Get("name", Like("[a-z0-9_]+", "small letters, digits and _")); });
  complaints->Try([&] { number->what = in->GetString("what"); });
  complaints->Try([&] {
    if (in->Has("unit")) number->unit = in->GetString("unit");
  });
  complaints->Try([&] { number->digits = in->Get("digits", base::Between(0, kMostDigits)); });
  complaints->Try([&] { ReadCount(in, &number->n); });
  for (const auto& [key, goal] :
       {std::pair{"at_least", &number->at_least}, std::pair{"at_most", &number->at_most}}) {
    complaints->Try([&, key = key, goal = goal] {
      if (in->Has(key)) *goal = in->Get(key, base::Between(-kLargestNumber, kLargestNumber));
    });
  }
}

std::string ReadPointer(base::ParamReader* in, const std::string& key) {
  return in->Get(key, Like("/.*", "a JSON pointer such as /measures/failed"));
}

void ReadPointers(base::ParamReader* in, std::vector<std::string>* pointers) {
  if (in->Has("at") == in->Has("largest_of")) {
    in->Fail("name", "which has both `at` and `largest_of`, or neither; wanted one of them");
  }
  if (in->Has("at")) return pointers->push_back(ReadPointer(in, "at"));
  *pointers = in->GetStrings("largest_of");
  for (const std::string& pointer : *pointers) {
    if (pointer.empty() || pointer[0] != '/') {
      in->Fail("largest_of", fmt::format("has '{}'; wanted JSON pointers", pointer));
    }
  }
}

PlayedNumber ReadPlayedNumber(base::ParamReader in, const PublishedNumber& shared,
                              Complaints* complaints) {
  PlayedNumber number{shared, {}, "", "", "", "", 1.0};
  ReadNumber(&in, &number.number, complaints);
  complaints->Try([&] { ReadPointers(&in, &number.at); });
  for (const auto& [key, field] :
       {std::pair{"over", &number.over}, std::pair{"low", &number.low},
        std::pair{"high", &number.high}, std::pair{"n_at", &number.n_at}}) {
    complaints->Try([&, key = key, field = field] {
      if (in.Has(key)) *field = ReadPointer(&in, key);
    });
  }
  complaints->Try([&] {
    if (in.Has("times")) number.times = in.Get("times", base::Positive());
  });
  return number;
}

PlayedSeries ReadPlayed(base::ParamReader in, Complaints* complaints) {
  PlayedSeries series;
  complaints->Try([&] { series.play = ReadPlay(in); });
  const PublishedNumber shared = ReadShared(&in, complaints);
  complaints->Try([&] {
    for (const base::ParamReader& number : in.SubList("numbers")) {
      series.numbers.push_back(ReadPlayedNumber(number, shared, complaints));
    }
  });
  return series;
}

PublishedNumber ReadKeptNumber(base::ParamReader in, PublishedNumber number,
                               Complaints* complaints) {
  const auto value = base::Between(-kLargestNumber, kLargestNumber);
  ReadNumber(&in, &number, complaints);
  complaints->Try([&] { number.value = in.Get("value", value); });
  complaints->Try([&] {
    if (in.Has("low") != in.Has("high")) in.Fail("name", "which has one end of an interval alone");
    if (!in.Has("low")) return;
    number.low = in.Get("low", value);
    number.high = in.Get("high", value);
    if (*number.low > *number.high) in.Fail("low", "which is above `high`");
  });
  return number;
}

void ReadKept(base::ParamReader in, std::vector<PublishedNumber>* kept, Complaints* complaints) {
  PublishedNumber shared = ReadShared(&in, complaints);
  shared.is_kept = true;
  complaints->Try([&] { shared.command = in.GetString("command"); });
  complaints->Try([&] {
    shared.date = in.Get("date", Like("[0-9]{4}-[0-9]{2}-[0-9]{2}", "a day such as 2026-11-28"));
  });
  complaints->Try([&] {
    shared.version = in.Get("version", Like("[0-9]+\\.[0-9]+\\.[0-9]+", "a version such as 0.2.0"));
  });
  complaints->Try([&] {
    for (const base::ParamReader& number : in.SubList("numbers")) {
      kept->push_back(ReadKeptNumber(number, shared, complaints));
    }
  });
}

PageRow ReadRow(base::ParamReader in, Complaints* complaints) {
  PageRow row;
  for (const auto& [key, field] :
       {std::pair{"what", &row.what}, std::pair{"ours", &row.ours},
        std::pair{"against", &row.against}, std::pair{"notes", &row.notes}}) {
    complaints->Try([&, key = key, field = field] { *field = in.GetString(key); });
  }
  complaints->Try([&] {
    if (in.Has("rests_on")) row.rests_on = in.GetString("rests_on");
  });
  return row;
}

/// The names of all numbers; those that come twice are complained about.
std::vector<std::string> CheckNumbers(const std::string& path, const PublishCatalogue& catalogue,
                                      Complaints* complaints) {
  std::vector<std::string> names;
  for (const PlayedSeries& series : catalogue.played) {
    for (const PlayedNumber& number : series.numbers) names.push_back(number.number.name);
  }
  for (const PublishedNumber& number : catalogue.kept) names.push_back(number.name);
  std::set<std::string> seen;
  for (const std::string& name : names) {
    if (seen.insert(name).second || name.empty()) continue;
    complaints->Add(
        fmt::format("{}: the number '{}' is named twice; wanted names that differ", path, name));
  }
  return names;
}

void CheckRows(const std::string& path, const PublishCatalogue& catalogue,
               const std::vector<std::string>& names, Complaints* complaints) {
  if (catalogue.rows.size() > kMostRows) {
    complaints->Add(
        fmt::format("{}: rows has {} entries, wanted at most {}; numbers without a row "
                    "stand on the page of details",
                    path, catalogue.rows.size(), kMostRows));
  }
  for (const PageRow& row : catalogue.rows) {
    for (const Placeholder& each :
         PlaceholdersOf(row.what + row.ours + row.against + row.rests_on)) {
      if (!each.is_known) {
        complaints->Add(fmt::format(
            "{}: row '{}': has {}; wanted {{name}}, {{name:interval}}, {{name:n}} or {{name:goal}}",
            path, row.what, each.text));
      } else if (std::count(names.begin(), names.end(), each.number) == 0) {
        complaints->Add(fmt::format("{}: row '{}': {}", path, row.what,
                                    base::UnknownName("number", each.number, names)));
      }
    }
  }
}

void CheckPlays(const std::string& path, const PublishCatalogue& catalogue,
                Complaints* complaints) {
  std::set<std::string> seen;
  double seconds = 0.0;
  for (const PlayedSeries& series : catalogue.played) {
    seconds += series.play.seconds;
    if (series.play.name.empty() || seen.insert(series.play.name).second) continue;
    complaints->Add(fmt::format("{}: the play '{}' is named twice; wanted names that differ", path,
                                series.play.name));
  }
  if (seconds > kLongestPublishing) {
    complaints->Add(
        fmt::format("{}: plays take {:.0f} s together, wanted at most {:.0f}; play fewer runs, or "
                    "keep what was measured",
                    path, seconds, kLongestPublishing));
  }
  if (!complaints->empty()) return;  // what could not be read may be what others need
  try {
    PlaysOf(catalogue);
  } catch (const base::ConfigError& error) {
    complaints->Add(path + ": " + error.what());
  }
}

}  // namespace

const std::vector<std::string>& Truths() {
  static const std::vector<std::string> truths{"same",        "foreign",   "harsh",    "simulated",
                                               "closed form", "published", "measured", "none"};
  return truths;
}

PublishCatalogue ReadPublishCatalogue(const std::string& path) {
  base::ParamReader in = base::ParamReader::FromFile(path);
  in.RequireKeys({"intro", "played", "kept", "rows", "remarks"});
  PublishCatalogue catalogue;
  Complaints complaints;
  complaints.Try([&] { catalogue.intro = in.GetString("intro"); });
  complaints.Try([&] { catalogue.remarks = in.GetString("remarks"); });
  complaints.Try([&] {
    for (const base::ParamReader& series : in.SubList("played")) {
      catalogue.played.push_back(ReadPlayed(series, &complaints));
    }
  });
  complaints.Try([&] {
    for (const base::ParamReader& series : in.SubList("kept")) {
      ReadKept(series, &catalogue.kept, &complaints);
    }
  });
  complaints.Try([&] {
    for (const base::ParamReader& row : in.SubList("rows")) {
      catalogue.rows.push_back(ReadRow(row, &complaints));
    }
  });
  // Keys behind one that cannot be read were not asked for: they are not unknown.
  if (complaints.empty()) complaints.Try([&] { in.RejectUnknownKeys(); });
  CheckRows(path, catalogue, CheckNumbers(path, catalogue, &complaints), &complaints);
  CheckPlays(path, catalogue, &complaints);
  complaints.ThrowIfAny();
  return catalogue;
}

std::vector<Play> PlaysOf(const PublishCatalogue& catalogue) {
  std::vector<Play> plays;
  std::vector<std::string> names;
  for (const PlayedSeries& series : catalogue.played) {
    plays.push_back(series.play);
    names.push_back(series.play.name);
  }
  return InOrder(plays, names);
}

}  // namespace hires::lab
