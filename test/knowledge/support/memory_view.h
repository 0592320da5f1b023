#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "hires/base/text.h"
#include "hires/knowledge/sparql.h"

namespace hires::test_support {

/// A few fluents in the order of their names, looked through one by one.
class MemoryView : public knowledge::FluentView {
 public:
  using Visit = std::function<bool(const knowledge::Fluent&)>;

  explicit MemoryView(std::vector<knowledge::Fluent> fluents) : fluents_(std::move(fluents)) {
    std::sort(fluents_.begin(), fluents_.end(), [](const auto& a, const auto& b) {
      return base::ToLower(a.instance) < base::ToLower(b.instance);
    });
  }

  const knowledge::Fluent* Find(const std::string& instance) const override {
    for (const knowledge::Fluent& fluent : fluents_) {
      if (base::ToLower(fluent.instance) == base::ToLower(instance)) return &fluent;
    }
    return nullptr;
  }
  void OfConcept(const std::string& concept_name, const Visit& visit) const override {
    Each([&](const auto& fluent) { return fluent.concept_name == concept_name; }, visit);
  }
  void All(const Visit& visit) const override {
    Each([](const auto&) { return true; }, visit);
  }
  void WithFiller(const std::string& role, const knowledge::Filler& filler,
                  const Visit& visit) const override {
    const auto has = [&](const knowledge::Property& property) {
      return property.role == role && Same(property.filler, filler);
    };
    Each(
        [&](const auto& fluent) {
          return std::any_of(fluent.properties.begin(), fluent.properties.end(), has);
        },
        visit);
  }

 private:
  void Each(const std::function<bool(const knowledge::Fluent&)>& fits, const Visit& visit) const {
    for (const knowledge::Fluent& fluent : fluents_) {
      if (fits(fluent) && !visit(fluent)) return;
    }
  }

  static double NumberOf(const knowledge::Filler& filler) {
    const auto* integer = std::get_if<std::int64_t>(&filler);
    return integer != nullptr ? static_cast<double>(*integer) : std::get<double>(filler);
  }
  static bool IsNumber(const knowledge::Filler& filler) {
    return std::holds_alternative<double>(filler) || std::holds_alternative<std::int64_t>(filler);
  }
  static bool Same(const knowledge::Filler& a, const knowledge::Filler& b) {
    if (IsNumber(a) && IsNumber(b)) return NumberOf(a) == NumberOf(b);
    const auto* x = std::get_if<std::string>(&a);
    const auto* y = std::get_if<std::string>(&b);
    return x != nullptr && y != nullptr ? base::ToLower(*x) == base::ToLower(*y) : a == b;
  }

  std::vector<knowledge::Fluent> fluents_;
};

}  // namespace hires::test_support
