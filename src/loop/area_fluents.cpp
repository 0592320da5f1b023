#include "loop/area_fluents.h"

#include <fmt/format.h>

#include <cctype>
#include <set>
#include <string>
#include <utility>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/planning/datum_reader.h"
#include "translation/stated_pose.h"

namespace hires::loop {
namespace {

using knowledge::Fluent;

bool IsBelow(const knowledge::Ontology& ontology, const std::string& below,
             const std::string& above) {
  const auto a = ontology.Find(below), b = ontology.Find(above);
  return a != knowledge::Ontology::kUnknown && b != knowledge::Ontology::kUnknown &&
         ontology.IsA(a, b);
}

/// Whether tasks and domains read a name as this one name.
bool IsReadAsItself(const std::string& name) {
  try {
    const auto data = planning::ReadData(name, "name");
    return data.size() == 1 && !data[0].IsList() && !data[0].IsNil() &&
           planning::IsGround(data[0]) && planning::ToString(data[0]) == base::ToLower(name);
  } catch (const base::ConfigError&) {
    return false;
  }
}

std::string AsSymbol(std::string name) {
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-') c = '_';
  if (name.empty() || !std::isalpha(static_cast<unsigned char>(name[0]))) name = "area_" + name;
  return name;
}

/// Empty: nothing speaks against it.
std::string WhyRefused(const std::string& name, const Fluent* known,
                       const knowledge::Ontology& ontology) {
  if (!IsReadAsItself(name)) {
    return fmt::format("a task cannot name the area '{}'; rename it, as '{}'", name,
                       AsSymbol(name));
  }
  if (known == nullptr || IsBelow(ontology, known->concept_name, "Area")) return "";
  return fmt::format("the area '{}' is called as a {} of the knowledge; rename it, as '{}Area'",
                     name, known->concept_name, name);
}

std::string ConceptOf(const std::string& name, const knowledge::Ontology& ontology) {
  for (const char* concept_name : {"FloorArea", "PlacingArea", "SittingArea"}) {
    const std::string begin = base::ToLower(concept_name);
    const bool is_called_so = base::ToLower(name).compare(0, begin.size(), begin) == 0;
    if (is_called_so && IsBelow(ontology, concept_name, "Area")) return concept_name;
  }
  return "Area";
}

/// Writes areas one after the other, each Pose by a name of its own.
class Writer {
 public:
  explicit Writer(const knowledge::FluentView& known) : known_(known) {}

  void Write(const world::NamedArea& area, const Fluent* known, const std::string& concept_name) {
    const std::string stated = known != nullptr ? translation::LinkOf(*known, "hasPose") : "";
    translation::StatedPose pose{stated.empty() ? NewName(area.name) : stated, "", {}};
    pose.X_FO.translation = {area.X_MA.x, area.X_MA.y, area.z.value_or(0.0)};
    pose.X_FO.rotation = geometry::RotationFromRpy(0.0, 0.0, area.X_MA.yaw);
    fluents_.push_back(translation::PoseFluent(pose));
    if (!stated.empty()) return;
    Fluent stands{known != nullptr ? known->concept_name : concept_name,
                  known != nullptr ? known->instance : area.name,
                  {{"hasPose", "Pose", pose.instance}}};
    if (known != nullptr)
      stands.properties.insert(stands.properties.begin(), known->properties.begin(),
                               known->properties.end());
    fluents_.push_back(std::move(stands));
  }

  std::vector<Fluent> Take() { return std::move(fluents_); }

 private:
  /// dock_1 and dock1 would share one.
  std::string NewName(const std::string& area) {
    const std::string wanted = translation::NameFor("pose", area);
    std::string name = wanted;
    for (int i = 2; known_.Find(name) != nullptr || !taken_.insert(base::ToLower(name)).second; ++i)
      name = fmt::format("{}_{}", wanted, i);
    return name;
  }

  const knowledge::FluentView& known_;
  std::set<std::string> taken_;
  std::vector<Fluent> fluents_;
};

}  // namespace

std::vector<Fluent> AreaFluents(const std::vector<world::NamedArea>& areas,
                                const knowledge::FluentView& known,
                                const knowledge::Ontology& ontology) {
  std::vector<std::string> refused;
  Writer writer(known);
  for (const world::NamedArea& area : areas) {
    const Fluent* same = known.Find(area.name);
    std::string why = WhyRefused(area.name, same, ontology);
    if (!why.empty()) {
      refused.push_back(std::move(why));
      continue;
    }
    writer.Write(area, same, ConceptOf(area.name, ontology));
  }
  if (!refused.empty()) throw base::ConfigError(base::Join(refused, "\n"));
  return writer.Take();
}

}  // namespace hires::loop
