#pragma once

#include <map>
#include <optional>
#include <string>

#include "hires/execution/monitor.h"
#include "hires/knowledge/fluent.h"
#include "hires/knowledge/ontology.h"

namespace hires::execution {

/// The fluent that a record stands for, since `start` [s] main ROS time. An ontology that does not
/// know its concept has the general one. Types of the fillers are those of the ontology; what it
/// does not know is left for the Blackboard to refuse.
knowledge::Fluent FluentOf(const Record& record, double start, const knowledge::Ontology& ontology);

/// What an episode's outcome says: "no_plan: there is no plan ...", on one line, as long as the
/// Blackboard keeps it. Reasons quote files of any path and names of any number.
std::string EpisodeOutcome(const std::string& outcome, const std::string& reason);

/// What the Blackboard must be told of one record, in this order.
struct RecordWrites {
  std::optional<knowledge::Fluent> added;
  std::optional<knowledge::Fluent> updated;
  std::optional<std::string> ended;  ///< instance
};

/// Turns the records of one episode into what is written of them.
class EpisodeRecords {
 public:
  /// @param name  of the episode, which what begins in it names; empty for none.
  void Begin(const std::string& name);

  /// Asked again for a record that could not be written, it says the same.
  /// @param time  [s] of the record.
  RecordWrites WritesOf(const Record& record, double time, const knowledge::Ontology& ontology);
  /// It has been told that this instance ended.
  void Forget(const std::string& instance);

 private:
  std::string name_;
  std::map<std::string, double> begun_;  // [s] by instance in lower case
};

}  // namespace hires::execution
