#include "robot/urdf/urdf_problems.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "hires/base/error.h"
#include "hires/base/short_text.h"

namespace hires::robot {

void UrdfProblems::Add(int line, const std::string& whole) {
  const std::string what = base::Shortened(whole);  // a name may be a file long
  const auto [begin, end] = problems_.equal_range(line);
  if (std::none_of(begin, end, [&](const auto& known) { return known.second == what; }))
    problems_.emplace(line, what);
}

void UrdfProblems::ThrowIfAny() const {
  if (problems_.empty()) return;
  std::vector<std::string> listed;
  for (const auto& [line, what] : problems_)
    listed.push_back(line > 0 ? fmt::format("{}; line {}", what, line) : what);
  if (listed.size() == 1) throw base::ConfigError(where_ + ": " + listed.front());
  throw base::ConfigError(base::AllThatIsWrong(where_, listed));
}

void UrdfProblems::Fail(int line, const std::string& what) {
  Add(line, what);
  ThrowIfAny();
  throw base::ConfigError(where_ + ": " + what);
}

}  // namespace hires::robot
