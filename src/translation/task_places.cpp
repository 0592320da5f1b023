#include "hires/translation/task_places.h"

#include <algorithm>

#include "hires/base/check.h"
#include "hires/base/text.h"
#include "hires/knowledge/state_view.h"

namespace hires::translation {
namespace {

using knowledge::Fluent;

class Places {
 public:
  Places(const TranslatorContext& context, const knowledge::FluentView& fluents)
      : context_(context),
        fluents_(fluents),
        atoms_(knowledge::StateAtoms(fluents, *context.ontology)) {}

  std::vector<std::string> Find() {
    const auto task = context_.ontology->Find("Task");
    if (task == knowledge::Ontology::kUnknown) return {};
    for (const auto below : context_.ontology->Below(task)) {
      fluents_.OfConcept(context_.ontology->Name(below), [&](const Fluent& fluent) {
        AddArgumentsOf(fluent);
        return true;
      });
    }
    return std::move(places_);
  }

 private:
  void AddArgumentsOf(const Fluent& task) {
    for (const knowledge::Property& property : task.properties) {
      const auto* text = std::get_if<std::string>(&property.filler);
      if (property.role == "hasArgument" && text) Add(base::ToLower(*text));
    }
  }

  void Add(const std::string& name) {
    const Area* area = context_.areas.Find(name);
    if (area && area->kind == AreaKind::kPlacing) return AddPlace(name);
    for (const base::Atom& atom : atoms_) AddRelated(name, atom);
  }

  /// Placing areas that an atom relates the name to.
  void AddRelated(const std::string& name, const base::Atom& atom) {
    const auto& arguments = atom.arguments;
    if (arguments.size() < 2) return;
    if (atom.predicate == "Connected" && arguments.size() == 3 &&
        (arguments[1] == name || arguments[2] == name)) {
      return AddPlace(arguments[0]);
    }
    if (arguments[0] != name) return;
    if (atom.predicate == "At") return Add(arguments[1]);  // a guest's seat
    if (base::ToLower(atom.predicate).rfind("hasplacingarea", 0) == 0) {
      return AddPlace(arguments[1]);
    }
    // What stands on the tray moves: it is looked at by its own name.
    if (atom.predicate == "On") AddPlace(arguments[1] == kTrayArea ? name : arguments[1]);
  }

  void AddPlace(const std::string& place) {
    if (place == kTrayArea) return;  // without a load there is nothing to see
    if (std::find(places_.begin(), places_.end(), place) == places_.end()) {
      places_.push_back(place);
    }
  }

  const TranslatorContext& context_;
  const knowledge::FluentView& fluents_;
  const std::vector<base::Atom> atoms_;
  std::vector<std::string> places_;
};

}  // namespace

std::vector<std::string> PlacesOfTasks(const TranslatorContext& context,
                                       const knowledge::FluentView& fluents) {
  HIRES_CHECK(context.ontology, "tasks are found by the ontology's concepts");
  return Places(context, fluents).Find();
}

}  // namespace hires::translation
