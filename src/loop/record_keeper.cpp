#include "loop/record_keeper.h"

#include "hires/base/text.h"
#include "hires/loop/record_fluent.h"

namespace hires::loop {

using execution::Record;
using knowledge::Assertion;
using knowledge::Source;

void RecordKeeper::BeginEpisode(const std::string& task, double time) {
  episode_ = blackboard_.StartEpisode(task, time);
  begun_.clear();
}

void RecordKeeper::EndEpisode(const std::string& outcome, double time) {
  blackboard_.FinishEpisode(episode_.id, outcome, time);
}

void RecordKeeper::Write(const Record& record, double time) {
  const std::string key = base::ToLower(record.instance);
  const Assertion by{Source::kMonitor, episode_.id, time};
  if (record.kind == Record::Kind::kBegin) {
    begun_[key] = time;
    knowledge::Fluent fluent = FluentOf(record, time, blackboard_.ontology());
    fluent.properties.push_back({"hasEpisode", "xsd:string", episode_.name});
    return blackboard_.Write({fluent}, {}, {}, by);
  }
  const auto begun = begun_.find(key);
  const double start = begun == begun_.end() ? time : begun->second;
  const knowledge::Fluent fluent = FluentOf(record, start, blackboard_.ontology());
  if (!fluent.properties.empty()) blackboard_.Write({}, {fluent}, {}, by);
  if (record.kind == Record::Kind::kUpdate) return;
  blackboard_.Write({}, {}, {record.instance}, by);
  begun_.erase(key);
}

}  // namespace hires::loop
