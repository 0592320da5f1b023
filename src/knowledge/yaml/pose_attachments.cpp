#include "knowledge/yaml/pose_attachments.h"

#include <algorithm>
#include <set>

#include "hires/base/error.h"

namespace hires::knowledge {
namespace {

using InstanceSet = std::set<std::string, LessIgnoringCase>;

char LowerOf(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

}  // namespace

void FailModification(const std::string& where, const std::string& what) {
  throw base::ConfigError(where + ": " + what);
}

bool LessIgnoringCase::operator()(const std::string& a, const std::string& b) const {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(),
                                      [](char x, char y) { return LowerOf(x) < LowerOf(y); });
}

PoseAttachments::PoseAttachments(const std::vector<PoseModification>& modifications) {
  for (std::size_t i = 0; i < modifications.size(); ++i) Add(modifications[i], i);
}

void PoseAttachments::Add(const PoseModification& modification, std::size_t index) {
  const InstanceSet once(modification.attachments.begin(), modification.attachments.end());
  attached_[modification.instance].assign(once.begin(), once.end());
  index_[modification.instance] = index;
  for (const std::string& instance : once) carriers_[instance].push_back(modification.instance);
}

std::vector<std::string> PoseAttachments::Circle() const {
  const ByInstance<std::size_t> left = InOrBeforeCircles();
  if (left.empty()) return {};
  std::vector<std::string> walk = {left.begin()->first};
  ByInstance<std::size_t> visited;
  while (visited.emplace(walk.back(), walk.size() - 1).second) {
    const std::vector<std::string>& next = attached_.at(walk.back());
    walk.push_back(*std::find_if(next.begin(), next.end(), [&](const std::string& instance) {
      return left.count(instance) > 0;
    }));
  }
  walk.erase(walk.begin(), walk.begin() + static_cast<std::ptrdiff_t>(visited[walk.back()]));
  return walk;
}

std::vector<std::string> PoseAttachments::MovedWith(const std::string& instance) const {
  std::vector<std::string> moved = {instance};
  InstanceSet seen = {instance};
  for (std::size_t i = 0; i < moved.size(); ++i) {
    const auto attached = attached_.find(moved[i]);
    if (attached == attached_.end()) continue;
    for (const std::string& next : attached->second) {
      if (seen.insert(next).second) moved.push_back(next);
    }
  }
  return moved;
}

std::vector<std::string> PoseAttachments::WithoutAttachments() const {
  std::vector<std::string> without;
  for (const auto& [instance, carriers] : carriers_) {
    if (attached_.count(instance) == 0) without.push_back(instance);
  }
  for (const auto& [instance, attached] : attached_) {
    if (attached.empty()) without.push_back(instance);
  }
  return without;
}

// Takes away, again and again, what has nothing attached to it. The rest stands in circles or leads
// to one, and has so many attachments left.
ByInstance<std::size_t> PoseAttachments::InOrBeforeCircles() const {
  ByInstance<std::size_t> left;
  for (const auto& [instance, attached] : attached_) left[instance] = attached.size();
  std::vector<std::string> free = WithoutAttachments();
  while (!free.empty()) {
    const std::string instance = free.back();
    free.pop_back();
    left.erase(instance);
    const auto carriers = carriers_.find(instance);
    if (carriers == carriers_.end()) continue;
    for (const std::string& carrier : carriers->second) {
      if (--left[carrier] == 0) free.push_back(carrier);
    }
  }
  return left;
}

}  // namespace hires::knowledge
