#include "knowledge/yaml/fluent_yaml_modification.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "knowledge/yaml/fluent_yaml_documents.h"
#include "knowledge/yaml/fluent_yaml_text.h"
#include "knowledge/yaml/pose_attachments.h"

namespace hires::knowledge {
namespace {

constexpr std::array<std::string_view, 4> kAxes = {"hasX", "hasY", "hasZ", "hasYaw"};
constexpr int kMaxChoices = 1'000'000;

using PlaceOfEach = std::function<std::string(std::size_t)>;

void CheckDelta(const PoseModification& modification, const PoseModification::Delta& delta,
                const std::string& where) {
  if (std::count(kAxes.begin(), kAxes.end(), delta.property) == 0) {
    FailModification(where,
                     fmt::format("'{}' is moved along {}; wanted one of {}", modification.instance,
                                 delta.property, fmt::join(kAxes, ", ")));
  }
  if (delta.choices.size() != static_cast<std::size_t>(std::max(modification.choices, 0))) {
    FailModification(
        where, fmt::format("'{}', {}: has {} deltas, Choices says {}; give one delta for each "
                           "choice",
                           modification.instance, delta.property, delta.choices.size(),
                           modification.choices));
  }
  if (!std::all_of(delta.choices.begin(), delta.choices.end(),
                   [](double value) { return std::isfinite(value); })) {
    FailModification(where, fmt::format("'{}', {}: a delta is not finite; wanted numbers",
                                        modification.instance, delta.property));
  }
}

void CheckDeltas(const PoseModification& modification, const std::string& where) {
  if (modification.choices < 1) {
    FailModification(where, fmt::format("'{}': Choices is {}, wanted 1 or more",
                                        modification.instance, modification.choices));
  }
  std::set<std::string> seen;
  for (const PoseModification::Delta& delta : modification.modifications) {
    if (!seen.insert(delta.property).second) {
      FailModification(where, fmt::format("'{}', {}: is given twice; keep one",
                                          modification.instance, delta.property));
    }
    CheckDelta(modification, delta, where);
  }
}

void CheckInstances(const std::vector<PoseModification>& modifications, const PlaceOfEach& where) {
  ByInstance<std::size_t> seen;
  for (std::size_t i = 0; i < modifications.size(); ++i) {
    const auto [first, is_new] = seen.emplace(modifications[i].instance, i);
    if (is_new) continue;
    FailModification(where(i),
                     fmt::format("'{}' is modified twice (already: {}); make it one modification",
                                 modifications[i].instance, where(first->second)));
  }
}

void CheckGroups(const std::vector<PoseModification>& modifications, const PlaceOfEach& where) {
  std::map<std::string, std::size_t> seen;
  for (std::size_t i = 0; i < modifications.size(); ++i) {
    const PoseModification& modification = modifications[i];
    const PoseModification& first =
        modifications[seen.emplace(modification.group, i).first->second];
    if (first.choices == modification.choices) continue;
    FailModification(
        where(i),
        fmt::format("'{}' has {} choices, '{}' of the same group '{}' has {}; a group draws one "
                    "choice for all, so give all as many",
                    modification.instance, modification.choices, first.instance, modification.group,
                    first.choices));
  }
}

void CheckCircles(const std::vector<PoseModification>& modifications, const PlaceOfEach& where) {
  const PoseAttachments attachments(modifications);
  const std::vector<std::string> circle = attachments.Circle();
  if (circle.empty()) return;
  FailModification(
      where(attachments.IndexOf(circle.front())),
      fmt::format("attachments go in a circle: {}; take one out", base::Join(circle, " -> ")));
}

PoseModification::Delta ReadDelta(const Field& field, const PoseModification& modification) {
  const std::vector<Field> parts = field.Items("[property, [delta of each choice]]", 2);
  PoseModification::Delta delta{parts[0].Name(), {}};
  for (const Field& choice : parts[1].Items("a list of deltas")) {
    delta.choices.push_back(choice.Real());
  }
  // Also checked for all together, but only here the line is known.
  if (delta.choices.size() != static_cast<std::size_t>(modification.choices)) {
    field.Fail(
        fmt::format("'{}', {}: has {} deltas, Choices says {}; give one delta for each "
                    "choice",
                    Shown(modification.instance), Shown(delta.property), delta.choices.size(),
                    modification.choices));
  }
  return delta;
}

}  // namespace

int ReadChoices(const Field& field) {
  const std::int64_t choices = field.Integer();
  if (choices < 1 || choices > kMaxChoices) {
    field.Fail(fmt::format("is {}, wanted a whole number between 1 and {}", choices, kMaxChoices));
  }
  return static_cast<int>(choices);
}

const std::vector<std::string> kModificationKeys = {"Instance", "Group", "Choices", "Modifications",
                                                    "Attachments"};

PoseModification ReadModification(const Fields& in) {
  PoseModification modification;
  modification.instance = in.Require("Instance", "name the pose to change").Name();
  modification.group = in.Require("Group", "name what takes the same choice").Name();
  modification.choices = ReadChoices(in.Require("Choices", "say how many there are"));
  const Field deltas = in.Require("Modifications", "write [] for none");
  for (const Field& item : deltas.Items("a list of [property, [delta of each choice]]")) {
    modification.modifications.push_back(ReadDelta(item, modification));
  }
  if (const auto attachments = in.Find("Attachments")) {
    modification.attachments = attachments->Names();
  }
  modification.where = in.At();
  return modification;
}

void CheckModifications(const std::vector<PoseModification>& modifications,
                        const PlaceOfEach& where) {
  for (std::size_t i = 0; i < modifications.size(); ++i) {
    CheckDeltas(modifications[i], where(i));
  }
  CheckInstances(modifications, where);
  CheckGroups(modifications, where);
  CheckCircles(modifications, where);
}

}  // namespace hires::knowledge
