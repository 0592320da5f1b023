#include "knowledge/store/store_reasons.h"

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "hires/base/failure.h"
#include "knowledge/store/store_codec.h"
#include "knowledge/store/store_schema.h"

namespace hires::knowledge {
namespace {

const char* const kReason = "hasReason";

bool Has(const std::vector<Property>& properties, const std::string& role) {
  return std::any_of(properties.begin(), properties.end(),
                     [&](const Property& property) { return property.role == role; });
}

/// The code of a word as it was written then; some are called otherwise since.
std::optional<base::FailureCode> CodeOf(const std::string& word) {
  using Code = base::FailureCode;
  static const std::map<std::string, Code> former{{"did not stop", Code::kDidNotStop},
                                                  {"no_leave", Code::kNoPermit},
                                                  {"stopped", Code::kPreempted}};
  const auto found = former.find(word);
  return found != former.end() ? found->second : base::ParseFailureCode(word);
}

/// "no_path: r_hand touches book1" is a word and a detail. Where nobody knows the word it is
/// kOther, and the whole text is the detail.
base::Failure FailureOf(const std::string& text) {
  if (text.empty()) return {};
  const std::size_t end = text.find(": ");
  const auto code = CodeOf(text.substr(0, end));
  if (!code) return {base::FailureCode::kOther, {}, text};
  return {*code, {}, end == std::string::npos ? "" : text.substr(end + 2)};
}

std::vector<Property> WithFailure(const std::vector<Property>& old) {
  std::vector<Property> properties;
  for (const Property& property : old) {
    const auto* text = std::get_if<std::string>(&property.filler);
    if (property.role != kReason || text == nullptr) {
      properties.push_back(property);
      continue;
    }
    const base::Failure failure = FailureOf(*text);
    if (!failure) continue;
    properties.push_back({"hasFailure", property.type, ToString(failure.code)});
    if (failure.detail.empty()) continue;
    properties.push_back({"hasDetail", property.type, failure.detail});
  }
  return properties;
}

}  // namespace

ReasonMigration::ReasonMigration(SQLite::Database* database)
    : database_(database),
      words_(database, false),
      write_(*database, "UPDATE validity SET properties = ? WHERE id = ?"),
      unlist_(*database, "DELETE FROM filler WHERE hash = ? AND validity = ?"),
      unlist_open_(*database,
                   "DELETE FROM open_filler WHERE hash = ? AND world = ? AND validity = ?"),
      list_(*database, "INSERT OR IGNORE INTO filler(hash, validity) VALUES(?, ?)"),
      list_open_(*database,
                 "INSERT OR IGNORE INTO open_filler(hash, world, validity) VALUES(?, ?, ?)") {}

void ReasonMigration::Run() {
  if (!words_.Find(kReason)) return;
  for (const Record& record : OldRecords()) Rewrite(record);
}

std::vector<ReasonMigration::Record> ReasonMigration::OldRecords() {
  std::vector<Record> records;
  SQLite::Statement all(*database_, "SELECT id, world, closed, properties FROM validity");
  Rows rows(all);
  while (rows.Next()) {
    Record record{rows.Integer(0), rows.Integer(1), rows.Integer(2) == kNotClosed, {}};
    try {
      record.properties = DecodeProperties(rows.Text(3), &words_);
    } catch (const SQLite::Exception&) {
      continue;  // damaged: who reads it is told
    }
    if (!Has(record.properties, kReason) || !Has(record.properties, "hasAction")) continue;
    records.push_back(std::move(record));
  }
  return records;
}

void ReasonMigration::Rewrite(const Record& record) {
  for (const std::int64_t hash : TextHashes(record.properties)) {
    Rows(unlist_, hash, record.id).Run();
    Rows(unlist_open_, hash, record.world, record.id).Run();
  }
  const std::vector<Property> properties = WithFailure(record.properties);
  Rows(write_, Blob{EncodeProperties(properties, &words_)}, record.id).Run();
  for (const std::int64_t hash : TextHashes(properties)) {
    Rows(list_, hash, record.id).Run();
    if (record.is_open) Rows(list_open_, hash, record.world, record.id).Run();
  }
}

}  // namespace hires::knowledge
