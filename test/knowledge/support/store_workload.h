#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hires/base/rng.h"
#include "knowledge/support/store_world.h"

namespace hires::test_support {

/// What a writer says, batch after batch. The same seed says the same, so whoever knows the seed
/// knows what must be in the store after any number of batches.
struct StoreWorkload {
  std::uint64_t seed{0};
  int text_bytes{0};  ///< of a text that every fourth batch has with it

  /// Writes batch `number` (from 1) as of second `number`: one fluent, several together, or the end
  /// of one that the batch before opened. Every batch changes something.
  std::vector<knowledge::Change> Write(int number, knowledge::Store* store) const {
    base::Rng rng = base::Rng(seed).Fork(static_cast<std::uint64_t>(number));
    const knowledge::Assertion by = At(number);
    if (number % 5 == 0) return store->Remove({Fresh(number - 1)}, by);
    std::vector<knowledge::Fluent> fluents = {PoseAt(Fresh(number), number)};
    const int size = rng.Bernoulli(0.5) ? 0 : rng.Index(30);
    for (int i = 0; i < size; ++i) {
      fluents.push_back(PoseAt("pose" + std::to_string(rng.Index(100)), rng.Uniform(-10.0, 10.0)));
    }
    if (number % 4 == 0 && text_bytes > 0) {
      const std::string text(static_cast<std::size_t>(text_bytes),
                             static_cast<char>('a' + rng.Index(26)));
      fluents.push_back(MakeFluent(
          "Mug", "mug",
          {{"hasColour", "xsd:string", text}, {"hasCount", "xsd:int", std::int64_t{number}}}));
    }
    return store->Add(fluents, by);
  }

  /// The batch to go on with, by the last change of a store.
  static int Next(const knowledge::Store& store) {
    const std::uint64_t last = store.last_sequence();
    if (last == 0) return 1;
    return 1 + static_cast<int>(store.ChangesSince(last - 1, 1).at(0).time);
  }

 private:
  static std::string Fresh(int number) { return "fresh" + std::to_string(number); }
};

}  // namespace hires::test_support
