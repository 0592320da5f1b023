#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "hires/knowledge/live_view.h"
#include "hires/knowledge/store.h"

namespace hires::loop {

/// The Blackboard of a process that has no other: what is written is known at once.
class Blackboard {
 public:
  /// @param store  new file that keeps it; empty: none does.
  explicit Blackboard(std::shared_ptr<const knowledge::Ontology> ontology,
                      const std::string& store = "");

  /// Says what these knowledge files say.  @throws base::ConfigError naming file and line.
  void Load(const std::vector<std::string>& knowledge_files, std::uint64_t seed);

  /// Of all three at once: what is new comes before what ends, so that a hand is full before a
  /// place is empty, and no reader sees an object without a place.
  void Write(const std::vector<knowledge::Fluent>& added,
             const std::vector<knowledge::Fluent>& updated, const std::vector<std::string>& removed,
             const knowledge::Assertion& by);

  knowledge::Episode StartEpisode(const std::string& task, double time);
  void FinishEpisode(std::int64_t id, const std::string& outcome, double time);

  const knowledge::LiveView& view() const { return view_; }
  const knowledge::Ontology& ontology() const { return store_.ontology(); }
  /// Called after each write that changed something.
  void SetListener(std::function<void()> listener) { listener_ = std::move(listener); }

 private:
  void Apply(const std::vector<knowledge::Change>& changes);

  knowledge::Store store_;
  knowledge::LiveView view_;
  std::function<void()> listener_;
};

}  // namespace hires::loop
