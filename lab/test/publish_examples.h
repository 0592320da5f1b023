#pragma once

#include <string>

namespace hires::lab::publish_examples {

/// A catalogue of a play and a kept number.
/// @param plays  for `played`, and `rows` for the table: more of them.
inline std::string Catalogue(const std::string& plays = "", const std::string& rows = "") {
  return R"yaml(
intro: "Of {version}, {date}."
remarks: "No more."
played:
  - name: quick
    seconds: 1
    inputs: []
    command: "list --json {answer} --quiet"
    truth: same
    seed: 3
    n: 12
    numbers:
      - {name: share, what: "done", unit: "%", digits: 1, times: 100, at: /hits, over: /all, low: /lower, high: /upper}
      - {name: worst, what: "worst of two", digits: 2, at_least: 0.5, at_most: 0.7, largest_of: [/a, /b], n_at: /all}
      - {name: mean, what: "mean", unit: s, digits: 1, at: /time}
)yaml" + plays +
         R"yaml(
kept:
  - command: "long series"
    date: "2026-11-20"
    version: "0.1.0"
    truth: none
    numbers:
      - {name: speed, what: "steps", unit: steps/s, digits: 0, value: 480000}
rows:
  - {what: "tasks", ours: "{share} % ({share:interval}) of {share:n}, {worst} at worst ({worst:goal})", against: "nothing", rests_on: "{mean} s.", notes: docs/a.md}
  - {what: "speed", ours: "{speed}/s", against: "{mean} s", notes: docs/b.md}
)yaml" + rows;
}

}  // namespace hires::lab::publish_examples
