#include "world/sdf/model_links.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <numeric>
#include <sdf/Joint.hh>
#include <sdf/Link.hh>

#include "world/sdf/prune_sdf.h"
#include "world/sdf_file.h"
#include "world/sdf_model.h"

namespace hires::world {
namespace {

constexpr int kWorld = 0;

std::string TypeOf(const sdf::Joint& joint) {
  const sdf::ElementPtr element = joint.Element();
  return element->HasElement(kJointType) ? element->GetElement(kJointType)->Get<std::string>() : "";
}

class Collector {
 public:
  void Visit(const sdf::Model& model, const geometry::Pose3& X_MModel, const std::string& prefix,
             bool is_static) {
    is_static = is_static || model.Static();
    for (std::uint64_t i = 0; i < model.LinkCount(); ++i) {
      const sdf::Link& link = *model.LinkByIndex(i);
      const int number = static_cast<int>(result.links.size()) + 1;
      result.links.push_back(
          {&link, X_MModel * PoseIn(link.SemanticPose(), "__model__", Where(model), kMaxWritten),
           prefix + link.Name(), is_static ? kWorld : number});
      numbers_[prefix + link.Name()] = number;
      if (is_static) joined_.push_back({number, kWorld});
    }
    for (std::uint64_t i = 0; i < model.ModelCount(); ++i) {
      const sdf::Model& inner = *model.ModelByIndex(i);
      Visit(inner, X_MModel * PoseIn(inner.SemanticPose(), "__model__", Where(inner), kMaxWritten),
            prefix + inner.Name() + "::", is_static);
    }
    if (!is_static) TakeBrokenJoints(model);
    for (std::uint64_t i = 0; i < model.JointCount(); ++i) {
      VisitJoint(*model.JointByIndex(i), prefix, is_static);
    }
  }

  ModelLinks Take() {
    std::vector<int> group(result.links.size() + 1);
    std::iota(group.begin(), group.end(), 0);
    const std::function<int(int)> find = [&](int i) {
      while (group[i] != i) i = group[i] = group[group[i]];
      return i;
    };
    for (const auto& [a, b] : joined_) {
      const int one = find(a), other = find(b);
      group[std::max(one, other)] = std::min(one, other);
    }
    for (std::size_t i = 0; i < result.links.size(); ++i) {
      result.links[i].group = find(static_cast<int>(i) + 1);
    }
    return std::move(result);
  }

  ModelLinks result;

 private:
  void TakeBrokenJoints(const sdf::Model& model) {
    if (!result.broken_joint.empty() || !model.Element()->HasElement(kBrokenJoint)) return;
    const sdf::ElementPtr first = model.Element()->GetElement(kBrokenJoint);
    int num_more = 0;
    for (auto at = first->GetNextElement(kBrokenJoint); at != nullptr;
         at = at->GetNextElement(kBrokenJoint)) {
      ++num_more;
    }
    result.broken_joint = first->Get<std::string>();
    if (num_more > 0) result.broken_joint += fmt::format(" and {} more such joints", num_more);
    result.place_of_broken = first->Get<std::string>(kPlace);
  }

  void VisitJoint(const sdf::Joint& joint, const std::string& prefix, bool is_static) {
    if (is_static) return;
    std::string parent, child;
    const std::string place = PlaceOf(joint.Element());
    ThrowIfAny(joint.ResolveParentLink(parent), place);
    ThrowIfAny(joint.ResolveChildLink(child), place);
    if (TypeOf(joint) != "fixed") {
      result.has_moving_joint = true;
    } else {
      joined_.push_back({NumberOf(parent, prefix), NumberOf(child, prefix)});
    }
  }

  int NumberOf(const std::string& link, const std::string& prefix) const {
    const auto found = numbers_.find(prefix + link);
    return found == numbers_.end() ? kWorld : found->second;  // "world"
  }

  std::map<std::string, int> numbers_;
  std::vector<std::pair<int, int>> joined_;
};

}  // namespace

ModelLinks LinksOf(const sdf::Model& model) {
  Collector collector;
  collector.Visit(model, {}, "", false);
  return collector.Take();
}

}  // namespace hires::world
