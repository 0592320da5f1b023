#pragma once

#include <string>
#include <vector>

#include "hires/base/action.h"
#include "hires/knowledge/ontology.h"
#include "hires/knowledge/sparql.h"
#include "hires/knowledge/store.h"

namespace hires::knowledge {

/// The fluents of a moment as the planner's atoms: On(mug1, placingareawestrighttable1),
/// RobotAt(floorareatamsrestaurant1), Holding(rightarm1, mug1), HasArmPosture(leftarm1,
/// armtuckedposture), HasTorsoPosture(torsoupposture), At(guest1, sittingareawesttable1), ...
/// Arguments are lower case, in the order of the domain's predicates; sorted.
std::vector<base::Atom> StateAtoms(const FluentView& view, const Ontology& ontology);

/// "The state, but with these effects": a view that looks its changes up first and everything else
/// in the view below, which it does not copy.
class ProjectedView : public FluentView {
 public:
  ProjectedView(const FluentView* below, const Ontology* ontology);
  void Delete(const base::Atom& atom);  ///< no effect where it does not hold
  void Add(const base::Atom& atom);     ///< state variables (RobotAt, On of one object...) replace

  const Fluent* Find(const std::string& instance) const override;
  void OfConcept(const std::string& concept_name,
                 const std::function<bool(const Fluent&)>& visit) const override;
  void All(const std::function<bool(const Fluent&)>& visit) const override;
  void WithFiller(const std::string& role, const Filler& filler,
                  const std::function<bool(const Fluent&)>& visit) const override;

 private:
  const FluentView* below_;
  const Ontology* ontology_;
  std::vector<Fluent> added_;        ///< by instance
  std::vector<std::string> hidden_;  ///< instances below that do not hold any more
};

/// The fluents that hold now (or held at `at`), kept in memory and brought up to date by changes.
class LiveView : public FluentView {
 public:
  explicit LiveView(const Store& store);
  LiveView(const Store& store, double at);
  void Apply(const Change& change);  ///< real ones; imagined ones are ignored
  const Fluent* Find(const std::string& instance) const override;
  void OfConcept(const std::string& concept_name,
                 const std::function<bool(const Fluent&)>& visit) const override;
  void All(const std::function<bool(const Fluent&)>& visit) const override;
  void WithFiller(const std::string& role, const Filler& filler,
                  const std::function<bool(const Fluent&)>& visit) const override;
  ~LiveView() override;
  LiveView(LiveView&&) noexcept;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace hires::knowledge
