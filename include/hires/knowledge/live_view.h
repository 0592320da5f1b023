#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "hires/knowledge/fluent.h"
#include "hires/knowledge/sparql.h"
#include "hires/knowledge/store.h"

namespace hires::knowledge {

/// The real fluents that hold now (or held at `at`), kept in memory and brought up to date by
/// changes. Names and texts compare without regard to case, 1 and 1.0 are the same, as in queries
/// of the store; whatever visits fluents goes by instance name, case ignored. Where the bounds of
/// two validities of an instance both leave room for `at`, the later one is taken.
class LiveView : public FluentView {
 public:
  explicit LiveView(const Store& store);
  LiveView(const Store& store, double at);  ///< [s] main ROS time
  /// Of fluents that hold as of change `sequence`, for programs that have no store.
  LiveView(std::vector<Fluent> fluents, std::uint64_t sequence);
  LiveView(LiveView&&) noexcept;
  LiveView& operator=(LiveView&&) noexcept;
  ~LiveView() override;

  /// Real ones; imagined ones are ignored, and so are those that the view knows already (its
  /// sequence numbers are not above `sequence()`), so a stream of changes may begin before it.
  void Apply(const Change& change);
  std::uint64_t sequence() const;  ///< of the last change in it
  std::size_t size() const;        ///< fluents

  /// What is found stays where it is until a change of that instance is applied.
  const Fluent* Find(const std::string& instance) const override;
  void OfConcept(const std::string& concept_name,
                 const std::function<bool(const Fluent&)>& visit) const override;
  void All(const std::function<bool(const Fluent&)>& visit) const override;
  /// Text, links and truth values are found at once; for a number, all that have `role` are looked
  /// at, for numbers change all the time and are seldom asked for.
  void WithFiller(const std::string& role, const Filler& filler,
                  const std::function<bool(const Fluent&)>& visit) const override;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace hires::knowledge
