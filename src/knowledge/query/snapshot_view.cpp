#include "knowledge/query/snapshot_view.h"

#include <algorithm>
#include <utility>

#include "hires/base/text.h"
#include "knowledge/query/query_conditions.h"
#include "knowledge/store/store_codec.h"

namespace hires::knowledge {

SnapshotView::SnapshotView(std::vector<Fluent> fluents) {
  for (Fluent& fluent : fluents) {
    const auto [place, is_new] =
        by_name_.try_emplace(base::ToLower(fluent.instance), fluents_.size());
    if (is_new) {
      fluents_.push_back(std::move(fluent));
    } else {
      fluents_[place->second] = std::move(fluent);  // the later one
    }
  }
  for (std::size_t i = 0; i < fluents_.size(); ++i) {
    by_concept_[fluents_[i].concept_name].push_back(i);
    for (const Property& property : fluents_[i].properties) {
      const auto* text = std::get_if<std::string>(&property.filler);
      if (text == nullptr) continue;
      std::vector<std::size_t>& places = by_text_[FillerHash(property.role, *text)];
      if (places.empty() || places.back() != i) places.push_back(i);
    }
  }
}

const Fluent* SnapshotView::Find(const std::string& instance) const {
  const auto found = by_name_.find(base::ToLower(instance));
  return found == by_name_.end() ? nullptr : &fluents_[found->second];
}

void SnapshotView::OfConcept(const std::string& concept_name,
                             const std::function<bool(const Fluent&)>& visit) const {
  const auto found = by_concept_.find(concept_name);
  if (found == by_concept_.end()) return;
  for (const std::size_t place : found->second) {
    if (!visit(fluents_[place])) return;
  }
}

void SnapshotView::All(const std::function<bool(const Fluent&)>& visit) const {
  for (const Fluent& fluent : fluents_) {
    if (!visit(fluent)) return;
  }
}

void SnapshotView::WithFiller(const std::string& role, const Filler& filler,
                              const std::function<bool(const Fluent&)>& visit) const {
  const FluentQuery::PropertyFilter filter{role, filler};
  const auto* text = std::get_if<std::string>(&filler);
  if (text == nullptr) {
    return All([&](const Fluent& fluent) { return !HasProperty(fluent, filter) || visit(fluent); });
  }
  const auto found = by_text_.find(FillerHash(role, *text));
  if (found == by_text_.end()) return;
  for (const std::size_t place : found->second) {
    if (HasProperty(fluents_[place], filter) && !visit(fluents_[place])) return;
  }
}

}  // namespace hires::knowledge
