#include "knowledge/query/access_paths.h"

#include <limits>
#include <string>
#include <utility>

#include "knowledge/store/store_codec.h"

namespace hires::knowledge {
namespace {

using TimeKind = FluentQuery::TimeFilter::Kind;

// A text that more validities ever had is no short cut to them.
constexpr std::int64_t kMaxOfText = 2'000;
constexpr int kWalkInstance = 16;  // work of an instance, and what holds of it
// The state of a restaurant is found at the first try; what a wrong path costs is a millisecond.
constexpr std::int64_t kFirstAllowance = 4096;
constexpr std::int64_t kPatience = 8;  // times as much work is allowed the next time
constexpr std::int64_t kUnlimited = std::numeric_limits<std::int64_t>::max();

}  // namespace

AccessPaths::AccessPaths(const QueryConditions& conditions, const PageStart& start,
                         std::int64_t last, StoreParts* parts, QueryStatements* statements)
    : conditions_(conditions),
      last_(last),
      parts_(parts),
      statements_(statements),
      collector_(conditions, start.after, &parts->instances),
      scan_(conditions, last, parts, statements, &collector_) {}

bool AccessPaths::ByOpenText(std::int64_t text) {
  return scan_.OpenWithText(text) && scan_.Closed() && scan_.Reopened();
}

bool AccessPaths::ByText(std::int64_t text) {
  Rows rows(statements_->filler, text);
  for (std::int64_t count = 0; rows.Next(); ++count) {
    if (count == kMaxOfText) return collector_.GiveUp();
    if (!collector_.Spend(kLookUp) || !collector_.Add(ReadIndexEntry(&rows))) return false;
  }
  return true;
}

bool AccessPaths::ByEpisode() {
  Rows rows(statements_->episode, *conditions_.query().episode);
  return collector_.AddRows(&rows, kLookUp);
}

bool AccessPaths::ByTime() { return scan_.Open() && scan_.Closed() && scan_.Reopened(); }

bool AccessPaths::ByInstances() {
  NamedInstances named;
  for (const std::int64_t concept_id : conditions_.concepts()->Numbers()) {
    Rows rows(statements_->of_concept, concept_id);
    while (rows.Next()) {
      if (named.size() == kMaxCandidates) return collector_.GiveUp();
      if (!collector_.Spend(kWalkInstance)) return false;
      named.push_back({rows.Integer(0), parts_->instances.Name(rows.Integer(0))});
    }
  }
  instances_ = std::move(named);
  return true;
}

/// Of which every match has each.
std::vector<std::int64_t> AccessPaths::Texts() const {
  const FluentQuery& query = conditions_.query();
  if (!query.all_properties && query.properties.size() > 1) return {};
  std::vector<std::int64_t> texts;
  for (const FluentQuery::PropertyFilter& filter : query.properties) {
    const auto* text = filter.filler ? std::get_if<std::string>(&*filter.filler) : nullptr;
    if (text != nullptr) texts.push_back(FillerHash(filter.role, *text));
  }
  return texts;
}

/// Those that lead to all that may match.
std::vector<AccessPaths::Path> AccessPaths::Choose() {
  const bool ever = conditions_.time_kind() == TimeKind::kEver;
  // Then what is open is all there can be, and there is an index for it.
  const bool now = conditions_.time_kind() == TimeKind::kNow && conditions_.as_of() == last_;
  const std::optional<std::int64_t>& episode = conditions_.query().episode;
  std::vector<Path> paths;
  for (const std::int64_t text : Texts()) {
    if (!ever) paths.emplace_back([this, text] { return ByOpenText(text); });
    if (!now) paths.emplace_back([this, text] { return ByText(text); });
  }
  if (episode && *episode != 0) paths.emplace_back([this] { return ByEpisode(); });
  if (!ever) paths.emplace_back([this] { return ByTime(); });
  if (conditions_.concepts() && !now) paths.emplace_back([this] { return ByInstances(); });
  return paths;
}

bool AccessPaths::Follow(const Path& path, std::int64_t allowance) {
  collector_.Begin(allowance);
  return path();
}

std::optional<Found> AccessPaths::Find() {
  std::vector<Path> paths = Choose();
  for (std::int64_t allowance = kFirstAllowance; !paths.empty(); allowance *= kPatience) {
    for (auto path = paths.begin(); path != paths.end();) {
      if (Follow(*path, paths.size() == 1 ? kUnlimited : allowance)) {
        if (instances_) return Found(std::move(*instances_));
        return Found(collector_.Take());
      }
      path = collector_.gave_up() ? paths.erase(path) : path + 1;
    }
  }
  return std::nullopt;
}

}  // namespace hires::knowledge
