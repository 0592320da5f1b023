#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>

#include "hires/knowledge/sparql.h"
#include "hires/knowledge/store.h"

namespace hires::knowledge {

/// What holds now in the real world, looked up in the store when it is asked for. Keeps what `Find`
/// found: make a new one after a change.
class StoreView : public FluentView {
 public:
  /// @param store  Must outlive the view.
  explicit StoreView(const Store& store) : store_(store) {}

  /// Answers `Find` for this fluent without asking the store; one that is removed is not found.
  void Remember(const Change& change);

  const Fluent* Find(const std::string& instance) const override;
  void OfConcept(const std::string& concept_name,
                 const std::function<bool(const Fluent&)>& visit) const override;
  void All(const std::function<bool(const Fluent&)>& visit) const override;
  void WithFiller(const std::string& role, const Filler& filler,
                  const std::function<bool(const Fluent&)>& visit) const override;
  /// Calls `visit` for each answer to the query, page by page; false ends it.
  void ForEach(FluentQuery query, const std::function<bool(const Fluent&)>& visit) const;

 private:
  const Store& store_;
  mutable std::map<std::string, std::optional<Fluent>> found_;  // by name in lower case
};

}  // namespace hires::knowledge
