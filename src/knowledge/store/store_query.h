#pragma once

#include <SQLiteCpp/Statement.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hires/knowledge/query.h"
#include "hires/knowledge/store.h"
#include "knowledge/store/store_writer.h"

namespace hires::knowledge {

/// What a validity is as a fluent, told as of a change: what was ended later is still open.
Fluent ToFluent(const Validity& validity, std::int64_t as_of, StoreParts* parts);

/// Whether the fluent has the role with that filler (text compares without regard to case, numbers
/// by value).
bool HasProperty(const Fluent& fluent, const FluentQuery::PropertyFilter& filter);

/// Statements that queries use.
struct QueryStatements {
  explicit QueryStatements(StoreFile* file);

  SQLite::Statement levels, window, open_of_concept, open_filler, replaced, removed, filler;
  SQLite::Statement episode, of_concept, instances, worlds, reach, stretch, newest;
};

/// Where in the order of answers a fluent stands.
struct QueryPosition {
  std::string name;
  std::int64_t world{0};
  double start{-temporal::kForever};
  std::int64_t id{0};
};
/// By name (case ignored), world, start, and order of writing.
bool operator<(const QueryPosition& a, const QueryPosition& b);

/// A place to go on from: the last fluent told, and the last change that the first page knew of.
struct QueryCursor {
  std::int64_t as_of{0};
  QueryPosition last;
};
std::string ToString(const QueryCursor& cursor);
QueryCursor ReadCursor(const std::string& text);  ///< @throws ConfigError

/// One page of the answer to one query. Several roads may lead to what can match
/// (docs/notes_blackboard.md lists them), and what was said decides which is the short one. So each
/// is followed for a few rows, then each for eight times as many, until one comes to its end. What
/// lies on it is sorted. Where there is too much on all of them, all instances are walked through
/// in order of their names, from where the page before ended. Either way memory is bounded.
class QueryRun {
 public:
  /// @param last  Sequence number of the last change.
  /// @throws ConfigError
  QueryRun(const FluentQuery& query, std::int64_t last, const Ontology& ontology, StoreParts* parts,
           QueryStatements* statements);
  FluentPage Page();

 private:
  struct Light {  // what tells cheaply whether a validity may match
    std::int64_t id{0}, instance{0}, world{0}, concept_id{0};
    double start{0.0};
  };
  struct Road {
    bool (QueryRun::*follow)(std::int64_t text){nullptr};  // whether it came to the road's end
    std::int64_t text{0};  // FillerHash of one that the query asks for, if the road needs it
  };

  void ReadConcepts(const FluentQuery& query, const Ontology& ontology);
  void AddConcepts(const FluentQuery::ConceptFilter& filter, const Ontology& ontology);
  void ReadProperties(const Ontology& ontology) const;
  void ReadTime();
  void ReadAllen();
  void ReadWorlds();
  void ReadSparql(const Ontology& ontology);
  FluentQuery StateQuery() const;
  void Restrict(const std::vector<std::string>& instances);

  bool FitsWorld(std::int64_t world) const;
  bool FitsConcept(std::int64_t concept_id) const;
  bool FitsTime(const Validity& validity) const;
  bool FitsProperties(const Fluent& fluent) const;
  bool Consider(const Validity& validity, const std::string& name);  // false: the page is full

  bool Spend(int work);
  bool Gather(const Light& light);
  static Light ReadLight(Rows* rows);
  bool GatherRows(Rows* rows, int work);
  bool GatherLevel(std::int64_t world, int level);
  bool GatherOpen();
  bool GatherOpenOfConcepts();
  bool GatherOpenWithText(std::int64_t text);
  bool GatherClosed(std::int64_t world);
  bool GatherClosed();
  bool GatherReopened();
  std::pair<std::int64_t, std::int64_t> WorldRange() const;
  std::vector<std::int64_t> WorldsToSearch() const;

  bool ByOpenText(std::int64_t text);
  bool ByText(std::int64_t text);
  bool ByEpisode(std::int64_t);
  bool ByTime(std::int64_t);
  bool ByInstances(std::int64_t);
  std::vector<std::int64_t> Texts() const;
  std::vector<Road> Roads() const;
  bool Follow(const Road& road, std::int64_t allowance);
  bool FindRoad();
  void TakeCandidates();

  void WalkList();
  void WalkAll();
  bool WalkInstance(const Instances::Named& named);
  bool WalkWorld(const Instances::Named& named, std::int64_t world);
  bool WalkStretch(const Instances::Named& named, QueryPosition from);
  QueryPosition FirstInReach(const Instances::Named& named, std::int64_t world);
  bool ConsiderNewest(const Instances::Named& named, std::int64_t world);

  const FluentQuery& query_;
  StoreParts* parts_;
  QueryStatements* statements_;
  std::int64_t last_;
  std::int64_t as_of_;
  std::optional<QueryPosition> from_;            // the cursor's
  std::optional<std::vector<bool>> concepts_;    // by word; none: any
  double earliest_finish_{-temporal::kForever};  // finish.latest lies after it,
  double latest_start_{temporal::kForever};      // and start.earliest not after this
  std::optional<std::int64_t> only_world_;
  std::optional<std::vector<Instances::Named>> list_;  // only these, by name
  std::int64_t allowance_{0};                          // work that the road may still cost
  bool is_endless_{false};                             // the road has too much on it
  std::vector<QueryPosition> candidates_;              // what lies on it
  FluentPage page_;
  QueryPosition told_;
};

}  // namespace hires::knowledge
