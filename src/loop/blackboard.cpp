#include "loop/blackboard.h"

#include <utility>

#include "hires/knowledge/fluent_yaml.h"
#include "hires/knowledge/loading.h"
#include "hires/temporal/interval.h"

namespace hires::loop {

using knowledge::Assertion;
using knowledge::Change;
using knowledge::Episode;
using knowledge::Fluent;
using knowledge::Source;

Blackboard::Blackboard(std::shared_ptr<const knowledge::Ontology> ontology,
                       const std::string& store)
    : store_(store.empty() ? ":memory:" : store, std::move(ontology)), view_(store_) {}

void Blackboard::Load(const std::vector<std::string>& knowledge_files, std::uint64_t seed) {
  const base::Rng rng(seed);
  std::uint64_t number = 0;
  for (const std::string& path : knowledge_files) {
    const Assertion by{Source::kKnowledge, 0, -temporal::kForever};
    knowledge::Load(knowledge::LoadKnowledge(path), rng.Fork(number++), by, &store_);
  }
  view_ = knowledge::LiveView(store_);
}

void Blackboard::Apply(const std::vector<Change>& changes) {
  for (const Change& change : changes) view_.Apply(change);
}

void Blackboard::Write(const std::vector<Fluent>& added, const std::vector<Fluent>& updated,
                       const std::vector<std::string>& removed, const Assertion& by) {
  const std::uint64_t before = view_.sequence();
  if (!added.empty()) Apply(store_.Add(added, by));
  if (!updated.empty()) Apply(store_.Update(updated, by));
  if (!removed.empty()) Apply(store_.Remove(removed, by));
  if (listener_ && view_.sequence() != before) listener_();
}

Episode Blackboard::StartEpisode(const std::string& task, double time) {
  return store_.StartEpisode(task, Episode::Label::kReal, 0, time);
}

void Blackboard::FinishEpisode(std::int64_t id, const std::string& outcome, double time) {
  store_.FinishEpisode(id, outcome, time);
}

}  // namespace hires::loop
