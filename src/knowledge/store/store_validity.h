#pragma once

#include <SQLiteCpp/Statement.h>

#include <cstdint>
#include <optional>
#include <string>

#include "hires/knowledge/fluent.h"
#include "knowledge/store/store_file.h"
#include "knowledge/store/store_schema.h"

namespace hires::knowledge {

/// One stretch of time in which an instance has one concept and one set of properties.
struct Validity {
  std::int64_t id{0};          ///< sequence number of the change that opened it
  std::int64_t instance{0};    ///< of Instances
  std::int64_t world{0};       ///< 0 the real one, else the imagined episode
  std::int64_t concept_id{0};  ///< of Words
  Source source{Source::kObservation};
  bool updated{false};
  std::int64_t episode{0};
  std::int64_t previous{0};
  std::int64_t closed{kNotClosed};
  temporal::Bounds start;
  temporal::Bounds finish;                   ///< as it stands
  temporal::Bounds given;                    ///< finish as given when it was opened
  double ended_before{-temporal::kForever};  ///< latest finish of the instance's earlier ones
  std::string properties;

  bool IsOpen() const { return closed == kNotClosed; }
};

/// The level at which the index by time finds this closed stretch; none if it takes no time.
std::optional<int> LevelOf(double start, double finish);

/// Columns of a validity, in the order in which `ReadValidity` takes them.
extern const char* const kValidityColumns;
Validity ReadValidity(Rows* rows);

/// Writes validities, and finds the last one of an instance.
class Validities {
 public:
  explicit Validities(StoreFile* file);
  void Insert(const Validity& validity);
  /// Writes `closed` and `finish` of a validity that was open.
  void Close(const Validity& validity);
  /// The last of an instance in a world, closed or not.
  std::optional<Validity> Last(std::int64_t instance, std::int64_t world);
  std::optional<Validity> Find(std::int64_t id);

 private:
  SQLite::Statement insert_, close_, last_, find_;
};

}  // namespace hires::knowledge
