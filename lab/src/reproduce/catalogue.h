#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lab/src/reproduce/answer_field.h"
#include "lab/src/reproduce/play.h"

namespace hires::lab {

/// How near a number of ours has to come to the published one.
struct Acceptance {
  enum class Kind {
    kWithin,   ///< |ours - published| <= bound
    kFactor,   ///< published / bound <= ours <= published * bound; both above 0
    kAtLeast,  ///< ours >= bound; what is published is a saying, such as "more than twice"
    kAtMost,
    kAbove,  ///< the whole interval of ours is above the bound; decided only if it holds no bound
    kBelow,
    kShown  ///< it stands there, and is not judged
  };
  Kind kind{Kind::kWithin};
  double bound{0.0};
};

/// A number of ours beside that of the dissertation.
struct ComparedValue {
  std::string name;  ///< "fast EC1/ET2"
  std::string unit;
  AnswerField at;
  std::optional<AnswerField> over;  ///< the number is divided by this one
  std::optional<double> published;  ///< nothing: a saying alone
  Acceptance acceptance;
  /// Whether a number of ours beyond the published one, as accepted, counts as better: a higher
  /// speed does, a longer duration does not.
  bool may_be_better{false};
};

/// A table, figure, listing or section of the dissertation.
struct CatalogueItem {
  std::string name;     ///< "Table 6.5"
  std::string section;  ///< "6.3.2", "A.2"
  std::string title;
  std::vector<std::string> plays;     ///< whose answers it shows
  std::vector<std::string> drawings;  ///< by their names in scripts/report, PLAY:DRAWING
  std::vector<ComparedValue> values;
  std::string bounds;  ///< where the bounds of its values come from; empty: none is judged
  /// The dissertation has no number to compare with: what is judged is our own bound. An item that
  /// judges no value with a published number is one of these, or is refused.
  bool is_own{false};
  std::string holds;  ///< what it says where all values are as accepted, or there are none
  std::string fails;  ///< why, where they are not, as far as it is known
};

struct Catalogue {
  std::vector<Play> plays;
  std::vector<CatalogueItem> items;
};

/// @throws base::ConfigError naming file, entry and field: plays that are unknown, named twice or
/// need each other in a circle; items named twice; values without acceptance;
/// items that judge nothing published and are not called our own.
Catalogue ReadCatalogue(const std::string& path);

/// Items that were asked for, in the catalogue's order.
/// @param wanted  "all", an item's name ("table 6.5"), or a section with all below it ("6", "6.3",
/// "A"). What it is may be written out or short ("Figure 6.5", "fig 6.5", "Listing 5.1",
/// "chapter 5", "appendix A"), and stand in an entry of its own before the number.
/// @throws base::ConfigError for what nothing is called, with what is called alike.
std::vector<CatalogueItem> ItemsOf(const Catalogue& catalogue,
                                   const std::vector<std::string>& wanted);

/// What has to be played for these items, each after those whose answers it takes.
std::vector<Play> PlaysFor(const Catalogue& catalogue, const std::vector<CatalogueItem>& items);

}  // namespace hires::lab
