#include "loop/record_keeper.h"

namespace hires::loop {

using execution::Record;
using knowledge::Assertion;
using knowledge::Source;

void RecordKeeper::BeginEpisode(const std::string& task, double time) {
  episode_ = blackboard_.StartEpisode(task, time);
  records_.Begin(episode_.name);
}

void RecordKeeper::EndEpisode(const std::string& outcome, double time) {
  blackboard_.FinishEpisode(episode_.id, outcome, time);
}

void RecordKeeper::Write(const Record& record, double time) {
  const Assertion by{Source::kMonitor, episode_.id, time};
  const execution::RecordWrites writes = records_.WritesOf(record, time, blackboard_.ontology());
  if (writes.added) blackboard_.Write({*writes.added}, {}, {}, by);
  if (writes.updated) blackboard_.Write({}, {*writes.updated}, {}, by);
  if (!writes.ended) return;
  blackboard_.Write({}, {}, {*writes.ended}, by);
  records_.Forget(*writes.ended);
}

}  // namespace hires::loop
