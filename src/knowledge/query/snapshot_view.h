#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <unordered_map>
#include <vector>

#include "hires/knowledge/sparql.h"

namespace hires::knowledge {

/// The fluents of one moment and one world, for the SPARQL part of a query. Where the bounds of two
/// validities of an instance both leave room for the moment, the later one is taken.
class SnapshotView : public FluentView {
 public:
  /// @param fluents  In the order of a query's answer.
  explicit SnapshotView(std::vector<Fluent> fluents);

  const Fluent* Find(const std::string& instance) const override;
  void OfConcept(const std::string& concept_name,
                 const std::function<bool(const Fluent&)>& visit) const override;
  void All(const std::function<bool(const Fluent&)>& visit) const override;
  void WithFiller(const std::string& role, const Filler& filler,
                  const std::function<bool(const Fluent&)>& visit) const override;

 private:
  std::vector<Fluent> fluents_;
  std::unordered_map<std::string, std::size_t> by_name_;  // lower case
  std::unordered_map<std::string, std::vector<std::size_t>> by_concept_;
  std::unordered_map<std::int64_t, std::vector<std::size_t>> by_text_;  // FillerHash
};

}  // namespace hires::knowledge
