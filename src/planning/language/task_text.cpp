#include "hires/planning/task_text.h"

#include <fmt/format.h>

#include "hires/base/error.h"
#include "hires/base/short_text.h"
#include "hires/base/text.h"
#include "hires/planning/datum_reader.h"
#include "hires/planning/shop2_reader.h"

namespace hires::planning {

namespace {

/// "serve(guest1)" would be a task whose one argument is a list, which no method takes.
void RefuseCall(std::string_view text, const std::string& source) {
  const std::size_t begin = text.find_first_not_of(" \t\r\n");
  const std::size_t open = text.find_first_of(" \t\r\n;(", begin);
  if (begin >= open || open == std::string_view::npos || text[open] != '(') return;
  std::string words(text.substr(begin, text.find(')', open) - begin));
  for (char& c : words)
    if (c == '(' || c == ',') c = ' ';
  throw base::ConfigError(
      fmt::format("{}: '{}' is written as a call; write the task and its arguments: {}", source,
                  base::Shortened(std::string(text)),
                  base::Shortened(base::Join(base::SplitWords(words), " "))));
}

}  // namespace

TaskNetwork ReadTasks(std::string_view text, const std::string& source) {
  RefuseCall(text, source);
  std::vector<Datum> data = ReadData(text, source);
  if (data.empty()) {
    throw base::ConfigError(fmt::format(
        "{}: names no task; write the task and its arguments: serve_coffee guest1", source));
  }
  const bool is_whole = data.size() == 1 && data[0].IsList();
  const Datum network = is_whole ? std::move(data[0]) : MakeList(std::move(data));
  // As text again, so that tasks mean here what they mean in a file.
  return ReadShop2Problems(fmt::format("(defproblem asked asked () {})", ToString(network)), source)
      .at(0)
      .tasks;
}

Datum ReadGroundTerm(std::string_view text, const std::string& source) {
  std::vector<Datum> data = ReadData(text, source);
  if (data.size() != 1) {
    throw base::ConfigError(
        fmt::format("{}: has {} terms, wanted exactly one; put several into "
                    "parentheses: (mug1 mug2)",
                    source, data.size()));
  }
  if (!IsGround(data[0])) {
    throw base::ConfigError(
        fmt::format("{}: {} has a variable, wanted a term without; name what it stands for", source,
                    Excerpt(data[0])));
  }
  return std::move(data[0]);
}

const Problem& FindProblem(const std::vector<Problem>& problems, const std::string& name) {
  std::vector<std::string> names;
  const Problem* found = nullptr;
  for (const Problem& problem : problems) {
    names.push_back(problem.name);
    if (base::ToLower(problem.name) != base::ToLower(name)) continue;
    if (found != nullptr) {
      throw base::ConfigError(fmt::format("{}: two problems are called '{}'; rename one",
                                          problem.source, problem.name));
    }
    found = &problem;
  }
  if (found == nullptr) throw base::ConfigError(base::UnknownName("problem", name, names));
  if (!found->fault.empty()) throw base::ConfigError(found->fault);
  return *found;
}

}  // namespace hires::planning
