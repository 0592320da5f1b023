#include "lab/src/publish/results_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "hires/base/text.h"
#include "lab/src/publish/template_text.h"

namespace hires::lab {
namespace {

constexpr char kGenerated[] =
    "<!-- Written by `hires_lab publish` from lab/results/{}.json and lab/config/publish.yaml. "
    "-->\n";

/// Replaces all of one placeholder.
std::string With(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at)) {
    text.replace(at, what.size(), by);
    at += by.size();
  }
  return text;
}

std::string OfVersion(const std::string& text, const PublishedResults& results) {
  return With(With(text, "{version}", results.version), "{date}", DateOf(results));
}

/// The numbers that a text names, each once, in the order of the results: what begins with "..."
/// stands behind what it goes on from.
std::vector<PublishedNumber> NumbersIn(const std::string& text, const PublishedResults& results) {
  std::set<std::string> named;
  for (const Placeholder& each : PlaceholdersOf(text)) named.insert(each.number);
  std::vector<PublishedNumber> numbers;
  std::copy_if(results.numbers.begin(), results.numbers.end(), std::back_inserter(numbers),
               [&](const PublishedNumber& number) { return named.count(number.name) > 0; });
  return numbers;
}

/// What stands on the page of results.
std::string ShownText(const PageRow& row) { return row.what + row.ours + row.against; }

void AppendOnce(const std::string& text, std::vector<std::string>* list) {
  if (std::count(list->begin(), list->end(), text) == 0) list->push_back(text);
}

std::string TruthsOf(const std::vector<PublishedNumber>& numbers) {
  std::vector<std::string> truths;
  for (const PublishedNumber& number : numbers) AppendOnce(number.truth, &truths);
  return truths.empty() ? "-" : base::Join(truths, ", ");
}

/// "2026-11-20 with 0.1.0"; without this version.
std::string DayOf(const PublishedNumber& number, const std::string& version) {
  return number.date + (number.version == version ? "" : " with " + number.version);
}

/// " (2026-11-20)" of kept numbers; nothing where all were played for this version.
std::string DaysOf(const std::vector<PublishedNumber>& numbers, const std::string& version) {
  std::vector<std::string> days;
  for (const PublishedNumber& number : numbers) {
    if (number.is_kept) AppendOnce(DayOf(number, version), &days);
  }
  std::sort(days.begin(), days.end());
  return days.empty() ? "" : " (" + base::Join(days, ", ") + ")";
}

/// Filled, and of which days it is.
std::string CellText(const std::string& text, const PublishedResults& results) {
  return Filled(text, results.numbers) + DaysOf(NumbersIn(text, results), results.version);
}

std::string RowText(const PageRow& row, const PublishedResults& results) {
  return fmt::format("| {} | {} | {} | {} |\n", Filled(row.what, results.numbers),
                     CellText(row.ours, results), CellText(row.against, results),
                     TruthsOf(NumbersIn(ShownText(row), results)));
}

std::string WithUnit(const PublishedNumber& number) {
  return ValueText(number) + (number.unit.empty() || !number.value ? "" : " " + number.unit);
}

/// A table of numbers, and below it the commands that gave them.
std::string NumbersTable(const std::vector<PublishedNumber>& numbers) {
  std::string text =
      "| number | value | interval | goal | n | truth | seed | day | version | by |\n"
      "|---|---|---|---|---|---|---|---|---|---|\n";
  std::vector<std::string> commands;
  for (const PublishedNumber& number : numbers) {
    const std::string took =
        number.seconds ? fmt::format(", {:.0f} s", *number.seconds) : std::string();
    AppendOnce(number.command + took, &commands);
    const auto by = std::find(commands.begin(), commands.end(), number.command + took);
    text += fmt::format("| {} | {} | {} | {} | {} | {} | {} | {}{} | {} | {} |\n", number.what,
                        WithUnit(number), IntervalText(number), GoalText(number),
                        number.n ? std::to_string(*number.n) : "-", number.truth,
                        number.seed ? std::to_string(*number.seed) : "-",
                        number.date.empty() ? "-" : number.date, number.is_kept ? ", kept" : "",
                        number.version, by - commands.begin() + 1);
  }
  text += '\n';
  for (std::size_t i = 0; i < commands.size(); ++i) {
    text += fmt::format("{}. {}\n", i + 1, commands[i]);
  }
  return text;
}

/// What a row rests on, and where more is told.
std::string RowDetails(const PageRow& row, const PublishedResults& results) {
  std::string text = "\n## " + Filled(row.what, results.numbers) + "\n";
  if (!row.rests_on.empty()) text += Filled(row.rests_on, results.numbers) + "\n\n";
  if (!row.notes.empty()) text += fmt::format("At length: [{0}](../../{0}).\n\n", row.notes);
  return text + NumbersTable(NumbersIn(ShownText(row) + row.rests_on, results));
}

std::vector<PublishedNumber> NumbersWithoutRow(const PublishCatalogue& catalogue,
                                               const PublishedResults& results) {
  std::set<std::string> shown;
  for (const PageRow& row : catalogue.rows) {
    for (const Placeholder& each : PlaceholdersOf(ShownText(row) + row.rests_on)) {
      shown.insert(each.number);
    }
  }
  std::vector<PublishedNumber> others;
  std::copy_if(results.numbers.begin(), results.numbers.end(), std::back_inserter(others),
               [&](const PublishedNumber& number) { return shown.count(number.name) == 0; });
  return others;
}

}  // namespace

std::string ResultsPage(const PublishCatalogue& catalogue, const PublishedResults& results) {
  std::string text = fmt::format(kGenerated, results.version) + "# How good is it?\n\n" +
                     OfVersion(catalogue.intro, results) +
                     "\n\n| what | ours | against what | truth |\n|---|---|---|---|\n";
  for (const PageRow& row : catalogue.rows) text += RowText(row, results);
  return text + "\n" + OfVersion(catalogue.remarks, results) + "\n";
}

std::string DetailsPage(const PublishCatalogue& catalogue, const PublishedResults& results) {
  std::string text = fmt::format(kGenerated, results.version) + "# Results in detail\n\n" +
                     fmt::format(
                         "Every number of [results](../../docs/results.md), version {}, "
                         "played until {}; \"kept\": measured before, and not played "
                         "for this version. `hires_lab publish` plays the others "
                         "again.\n",
                         results.version, DateOf(results));
  for (const PageRow& row : catalogue.rows) text += RowDetails(row, results);
  const std::vector<PublishedNumber> others = NumbersWithoutRow(catalogue, results);
  if (!others.empty()) text += "\n## Other numbers\n" + NumbersTable(others);
  return text;
}

}  // namespace hires::lab
