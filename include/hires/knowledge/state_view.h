#pragma once

#include <functional>
#include <string>
#include <vector>

#include "hires/base/action.h"
#include "hires/knowledge/ontology.h"
#include "hires/knowledge/sparql.h"

namespace hires::knowledge {

/// The fluents of a moment as the planner's atoms: On(mug1, placingareawestrighttable1),
/// RobotAt(floorareatamsrestaurant1), Holding(rightarm1, mug1), HasArmPosture(leftarm1,
/// armtuckedposture), HasTorsoPosture(torsoupposture), At(guest1, sittingareawesttable1), ...; the
/// table in docs/ontology.md has them all. Predicates are spelled as the domain does, arguments are
/// lower case and in the domain's order. By predicate, then arguments, each once. A fluent that
/// lacks a role of its row says nothing; where a state has two fillers of a role, the first counts.
std::vector<base::Atom> StateAtoms(const FluentView& view, const Ontology& ontology);
/// Those of the predicates that are wanted, in the same order.
std::vector<base::Atom> StateAtoms(const FluentView& view, const Ontology& ontology,
                                   const std::function<bool(const std::string&)>& is_wanted);

/// "The state, but with these effects": a view that looks its changes up first and everything else
/// in the view below, which it does not copy and which must outlive it. Names compare without
/// regard to case; whatever visits fluents goes by instance name, as the view below does.
///
/// Effects may concern what a fluent of its own says: the states, wishes and imagined failures of
/// the table. `Type` and the areas of furniture and seats follow from knowledge that several atoms
/// share; effects may name them only where they change nothing.
class ProjectedView : public FluentView {
 public:
  ProjectedView(const FluentView* below, const Ontology* ontology);

  /// No effect where it does not hold.
  /// @throws ConfigError for an atom that effects may not end.
  void Delete(const base::Atom& atom);
  /// State variables replace: RobotAt and HasTorsoPosture have one value; Holding and HasArmPosture
  /// one per arm, On one per object, At one per person. The fluent keeps its instance and whatever
  /// else it says.
  /// @throws ConfigError naming the atom: unknown predicate or posture (nearest names), another
  ///   number of arguments than the predicate has, an atom that effects may not bring about.
  void Add(const base::Atom& atom);

  /// What is found stays where it is until the next Delete or Add.
  const Fluent* Find(const std::string& instance) const override;
  void OfConcept(const std::string& concept_name,
                 const std::function<bool(const Fluent&)>& visit) const override;
  void All(const std::function<bool(const Fluent&)>& visit) const override;
  void WithFiller(const std::string& role, const Filler& filler,
                  const std::function<bool(const Fluent&)>& visit) const override;

 private:
  using Visit = std::function<bool(const Fluent&)>;

  const Fluent* FindAdded(const std::string& instance) const;
  bool IsHidden(const std::string& instance) const;
  void Hide(const std::string& instance);
  void Put(Fluent fluent);
  /// What `below` visits and is not hidden, and what was added and `fits`, by instance.
  void Merge(const std::function<void(const Visit&)>& below,
             const std::function<bool(const Fluent&)>& fits, const Visit& visit) const;

  const FluentView* below_;
  const Ontology* ontology_;
  std::vector<Fluent> added_;        ///< by instance, case ignored
  std::vector<std::string> hidden_;  ///< instances below that do not hold any more, likewise
};

}  // namespace hires::knowledge
