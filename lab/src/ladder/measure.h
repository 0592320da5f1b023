#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hires/world/world.h"
#include "lab/src/ladder/ladder.h"

namespace hires::lab::ladder {

/// Plays pieces of work one after the other, on one thread at a time.
struct Player {
  /// Piece `round`, the same whenever it is asked for; @return what there is of it: [s] simulated,
  /// steps or answers.
  std::function<double(int round)> play;
  /// Objects at the end of what was played last; empty: they say nothing.
  std::function<world::WorldState()> state{};
};

/// A way to simulate something.
struct Way {
  std::string what;
  std::map<std::string, double> facts;
  std::function<Player()> make;  ///< each thread has a player of its own
};

/// Pieces of work that were played in one go.
struct Stretch {
  double amount{0.0};     ///< of all threads together
  double wall{0.0};       ///< [s]
  double processor{0.0};  ///< [s] of all threads together
  int rounds{0};          ///< of each thread
};

/// Stretches of one way, one for each repeat.
struct Measured {
  std::vector<Stretch> stretches;
  world::WorldState end;                             ///< of the first thread's player
  std::vector<double> Rates() const;                 ///< amount / wall
  std::vector<double> SecondsEach() const;           ///< wall / amount
  std::vector<double> ProcessorSecondsEach() const;  ///< processor / round
};

/// How long a measurement takes.
struct Effort {
  double seconds{1.0};  ///< [s] for all repeats of all ways together
  int repeats{5};       ///< fewer, but 2, where one round takes too long
  int max_rounds{1000};
};

/// Plays each way on as many threads as its place in `threads` says: a round that counts nowhere
/// (but where there is time for two rounds at most: then it is the first repeat), then stretches of
/// equally many rounds by turns, every other time in the opposite order, so that what else the
/// computer does meets all ways alike. Each repeat has rounds of its own, the same for all ways.
/// @return one for each way; nothing when cancelled.  @pre ways and threads are equally many.
std::optional<std::vector<Measured>> MeasureByTurns(const std::vector<const Way*>& ways,
                                                    const std::vector<int>& threads,
                                                    const Effort& effort,
                                                    const LadderClocks& clocks,
                                                    const std::function<bool()>& cancelled);

/// after / before with the t interval of the paired logarithms.
/// @pre equally many, all positive.
Interval RatioOf(const std::vector<double>& before, const std::vector<double>& after);

/// [m] the largest distance between objects of one name.
double Apart(const world::WorldState& a, const world::WorldState& b);

}  // namespace hires::lab::ladder
