#include "lab/src/reproduce/catalogue.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <set>

#include "hires/base/error.h"
#include "hires/base/param_reader.h"
#include "hires/base/spelling.h"
#include "hires/base/text.h"

namespace hires::lab {
namespace {

constexpr double kLargest = 1e12;

Acceptance ReadAcceptance(base::ParamReader* in, bool is_published) {
  using Kind = Acceptance::Kind;
  const std::map<std::string, Kind> kinds{{"within", Kind::kWithin},    {"factor", Kind::kFactor},
                                          {"at_least", Kind::kAtLeast}, {"at_most", Kind::kAtMost},
                                          {"above", Kind::kAbove},      {"below", Kind::kBelow}};
  std::vector<Acceptance> found;
  if (in->Has("shown") && in->GetBool("shown")) found.push_back({Kind::kShown, 0.0});
  for (const auto& [key, kind] : kinds) {
    if (in->Has(key)) found.push_back({kind, in->Get(key, base::Between(-kLargest, kLargest))});
  }
  if (found.size() != 1) {
    in->Fail("name", "which is accepted by " + std::to_string(found.size()) +
                         " rules; wanted one of within, factor, at_least, at_most, above, below, "
                         "shown");
  }
  const Acceptance& acceptance = found.front();
  if (!is_published && (acceptance.kind == Kind::kWithin || acceptance.kind == Kind::kFactor)) {
    in->Fail("name",
             "which has nothing published to be near to; wanted `published`, or at_least, at_most, "
             "above, below");
  }
  if (acceptance.kind == Kind::kFactor && acceptance.bound < 1.0) {
    in->Fail("factor", "below 1; wanted by which factor ours may be off, such as 1.5");
  }
  if (acceptance.kind == Kind::kWithin && acceptance.bound < 0.0) {
    in->Fail("within", "below 0; wanted by how much ours may be off");
  }
  return acceptance;
}

/// "/duration" of the item's first play, or "play:/duration".
AnswerField ReadField(base::ParamReader* in, const std::string& key,
                      const std::vector<std::string>& plays) {
  const std::string text = in->GetString(key);
  const std::size_t slash = text.find('/');
  const bool has_play = slash != std::string::npos && slash > 0 && text[slash - 1] == ':';
  if (slash == std::string::npos || (slash > 0 && !has_play)) {
    in->Fail(key, "wanted a JSON pointer such as /measures/failed, or PLAY:/measures/failed");
  }
  AnswerField field{has_play        ? text.substr(0, slash - 1)
                    : plays.empty() ? ""
                                    : plays.front(),
                    text.substr(slash)};
  if (std::count(plays.begin(), plays.end(), field.play) == 0) {
    in->Fail(key, fmt::format("of the play '{}', which is none of the item's", field.play));
  }
  return field;
}

ComparedValue ReadValue(base::ParamReader in, const std::vector<std::string>& plays) {
  ComparedValue value;
  value.name = in.GetString("name");
  if (in.Has("unit")) value.unit = in.GetString("unit");
  value.at = ReadField(&in, "at", plays);
  if (in.Has("over")) value.over = ReadField(&in, "over", plays);
  if (in.Has("published"))
    value.published = in.Get("published", base::Between(-kLargest, kLargest));
  value.acceptance = ReadAcceptance(&in, value.published.has_value());
  if (in.Has("may_be_better")) value.may_be_better = in.GetBool("may_be_better");
  const bool has_direction = value.acceptance.kind == Acceptance::Kind::kAtLeast ||
                             value.acceptance.kind == Acceptance::Kind::kAtMost;
  if (value.may_be_better && !(has_direction && value.published)) {
    in.Fail("may_be_better",
            "which needs `published`, and at_least or at_most to say what is better");
  }
  return value;
}

/// Whether a verdict rests on it.
bool HasBound(const ComparedValue& value) {
  return value.acceptance.kind != Acceptance::Kind::kShown;
}

/// "own" says whether an item is judged by what the dissertation says or by bounds of ours alone.
void ReadOwn(base::ParamReader* in, bool is_judged, CatalogueItem* item) {
  if (in->Has("own")) item->is_own = in->GetBool("own");
  if (item->is_own && !is_judged) in->Fail("own", "true, but nothing is judged; leave it out");
  const bool is_compared = std::any_of(
      item->values.begin(), item->values.end(),
      [](const ComparedValue& value) { return HasBound(value) && value.published.has_value(); });
  if (is_judged && !item->is_own && !is_compared) {
    in->Fail("item",
             "which judges no number beside a published one; write `own: true` if its bounds are "
             "our own, or `published` to a value that is judged");
  }
}

CatalogueItem ReadItem(base::ParamReader in) {
  CatalogueItem item;
  item.name = in.GetString("item");
  item.section = in.GetString("section");
  item.title = in.GetString("title");
  if (in.Has("plays")) item.plays = in.GetStrings("plays");
  if (in.Has("drawings")) item.drawings = in.GetStrings("drawings");
  item.holds = in.GetString("holds");
  if (in.Has("values")) {
    for (base::ParamReader value : in.SubList("values")) {
      item.values.push_back(ReadValue(value, item.plays));
    }
  }
  const bool is_judged = std::any_of(item.values.begin(), item.values.end(), HasBound);
  if (is_judged) {
    in.RequireKeys({"bounds", "fails"});
    item.bounds = in.GetString("bounds");
    item.fails = in.GetString("fails");
  }
  ReadOwn(&in, is_judged, &item);
  for (const std::string& drawing : item.drawings) {
    const std::string play = drawing.substr(0, drawing.find(':'));
    if (play == drawing || std::count(item.plays.begin(), item.plays.end(), play) == 0) {
      in.Fail("drawings",
              fmt::format("has '{}'; wanted PLAY:DRAWING of one of the item's plays", drawing));
    }
  }
  return item;
}

void CheckNames(const std::string& path, const Catalogue& catalogue) {
  std::set<std::string> names;
  const auto take = [&](const std::string& kind, const std::string& name) {
    if (name.empty() || !names.insert(kind + base::ToLower(name)).second) {
      throw base::ConfigError(
          fmt::format("{}: the {} '{}' is named twice or not at all; wanted names that differ",
                      path, kind, name));
    }
  };
  for (const Play& play : catalogue.plays) take("play", play.name);
  for (const CatalogueItem& item : catalogue.items) take("item", item.name);
}

void CheckPlays(const std::string& path, const Catalogue& catalogue) {
  for (const Play& play : catalogue.plays) {
    for (const std::string& name : NeededBy(play)) {
      RequirePlay(path + ": play " + play.name, catalogue.plays, name);
    }
  }
  for (const CatalogueItem& item : catalogue.items) {
    for (const std::string& name : item.plays) {
      RequirePlay(path + ": " + item.name, catalogue.plays, name);
    }
  }
  std::vector<std::string> all;
  for (const Play& play : catalogue.plays) all.push_back(play.name);
  InOrder(catalogue.plays, all);
}

/// "6.3.2" lies below "6.3", below "6" and is itself.
bool LiesBelow(const std::string& section, const std::string& above) {
  return section == above || section.compare(0, above.size() + 1, above + ".") == 0;
}

bool IsWanted(const CatalogueItem& item, const std::string& wanted) {
  return wanted == "all" || LiesBelow(base::ToLower(item.section), wanted) ||
         base::ToLower(item.name) == wanted;
}

/// How the catalogue names what is called so: "Fig." for "figure"; "" for a chapter, section or
/// appendix, which its number names; nothing where nothing is called so.
std::optional<std::string> KindOf(std::string word) {
  static const std::map<std::string, std::string> kKinds{
      {"fig", "Fig."},   {"figure", "Fig."},   {"tab", "Table"}, {"table", "Table"},
      {"list", "List."}, {"listing", "List."}, {"lst", "List."}, {"ch", ""},
      {"chap", ""},      {"chapter", ""},      {"sec", ""},      {"sect", ""},
      {"section", ""},   {"app", ""},          {"appendix", ""}};
  word = base::ToLower(word);
  if (!word.empty() && word.back() == '.') word.pop_back();
  const auto kind = kKinds.find(word);
  return kind == kKinds.end() ? std::nullopt : std::optional(kind->second);
}

/// As the catalogue writes it: "Fig. 6.5" for "figure 6.5", "6.1" for "section 6.1", "A" for
/// "appendix A".
std::string AsCatalogued(const std::string& wanted) {
  const std::vector<std::string> words = WordsIn(wanted);
  const auto kind = words.size() == 2 ? KindOf(words[0]) : std::nullopt;
  if (!kind) return wanted;
  return kind->empty() ? words[1] : *kind + " " + words[1];
}

/// "Table" and "6.5", as a shell hands over what stands in no quotes, are one name.
std::vector<std::string> Joined(const std::vector<std::string>& wanted) {
  std::vector<std::string> names;
  bool is_open = false;
  for (const std::string& word : wanted) {
    if (is_open) {
      names.back() += " " + word;
    } else {
      names.push_back(word);
    }
    is_open = !is_open && KindOf(word).has_value();
  }
  return names;
}

/// The item that is called so, else all that lies below that section.
std::vector<std::string> NamesOf(const Catalogue& catalogue, const std::string& wanted) {
  std::vector<std::string> names;
  const std::string catalogued = AsCatalogued(wanted);
  for (const std::string& each : {wanted, catalogued}) {
    for (const CatalogueItem& item : catalogue.items) {
      if (IsWanted(item, base::ToLower(each))) names.push_back(item.name);
    }
    if (!names.empty()) return names;
  }
  std::set<std::string> known{"all"};
  for (const CatalogueItem& item : catalogue.items) known.insert({item.section, item.name});
  const std::vector<std::string> names_known(known.begin(), known.end());
  constexpr char kLister[] = "hires_lab reproduce --list";
  const bool has_guess = !base::LikelyNames(catalogued, names_known).empty();
  throw base::ConfigError(
      base::UnknownName("table, figure or section", catalogued, names_known, kLister) +
      (has_guess ? fmt::format("; `{}` lists all", kLister) : ""));
}

}  // namespace

Catalogue ReadCatalogue(const std::string& path) {
  base::ParamReader in = base::ParamReader::FromFile(path);
  Catalogue catalogue;
  for (base::ParamReader& play : in.SubList("plays")) catalogue.plays.push_back(ReadPlay(play));
  for (base::ParamReader& item : in.SubList("items")) catalogue.items.push_back(ReadItem(item));
  in.RejectUnknownKeys();
  CheckNames(path, catalogue);
  CheckPlays(path, catalogue);
  return catalogue;
}

std::vector<CatalogueItem> ItemsOf(const Catalogue& catalogue,
                                   const std::vector<std::string>& wanted) {
  std::set<std::string> names;
  for (const std::string& word : Joined(wanted)) {
    for (const std::string& name : NamesOf(catalogue, word)) names.insert(name);
  }
  std::vector<CatalogueItem> items;
  std::copy_if(catalogue.items.begin(), catalogue.items.end(), std::back_inserter(items),
               [&](const CatalogueItem& item) { return names.count(item.name) > 0; });
  return items;
}

std::vector<Play> PlaysFor(const Catalogue& catalogue, const std::vector<CatalogueItem>& items) {
  std::vector<std::string> shown;
  for (const Play& play : catalogue.plays) {
    const bool is_shown = std::any_of(items.begin(), items.end(), [&](const CatalogueItem& item) {
      return std::count(item.plays.begin(), item.plays.end(), play.name) > 0;
    });
    if (is_shown) shown.push_back(play.name);
  }
  return InOrder(catalogue.plays, shown);
}

}  // namespace hires::lab
