#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "hires/knowledge/fluent.h"
#include "hires/knowledge/ontology.h"

namespace hires::knowledge {

/// How a query sees the world: the fluents that hold, by instance, by concept, by property.
class FluentView {
 public:
  virtual ~FluentView() = default;
  virtual const Fluent* Find(const std::string& instance) const = 0;
  /// Calls `visit` for every fluent of exactly that concept, by instance name; false ends it.
  virtual void OfConcept(const std::string& concept_name,
                         const std::function<bool(const Fluent&)>& visit) const = 0;
  virtual void All(const std::function<bool(const Fluent&)>& visit) const = 0;
  /// Fluents that have `role` with that filler (for a link: the instance's name).
  virtual void WithFiller(const std::string& role, const Filler& filler,
                          const std::function<bool(const Fluent&)>& visit) const = 0;
};

/// A query of the SPARQL subset that topic configurations use: "select [distinct] ?a ?b where
/// {...}" with triple patterns joined by ".", ";" and ",", nested groups, `union`, `a`, `rdf:type`,
/// `rdfs:subClassOf` plain and with `+` or `*`, relations of the ontology, typed literals; prefixes
/// upper, race, rdf, rdfs, owl, xsd and those declared by `prefix`. `rdf:type` gives the concept
/// stated; `rdf:type/rdfs:subClassOf*` style reasoning is written out by the query.
/// `rdfs:subClassOf` relates a concept to the nearest ones above it, with `+` to all of them, with
/// `*` to itself as well. Values compare as everywhere on the Blackboard: names and text without
/// regard to case, numbers by value. A name is its last part; a prefix that the ontology does not
/// use for it is an error. A variable stands for instances, concepts or values: its places tell
/// which, and only for one of them.
class Sparql {
 public:
  /// @throws ConfigError naming the place in the text (line:column), what came and what was wanted:
  ///   what is no SPARQL or beyond the subset (filter, optional, order by, paths, ...), unknown
  ///   prefixes, concepts, relations (nearest names), a value of another type than the relation's,
  ///   a first variable that some alternative leaves open, more than 64 kB, 100 nested groups, 1000
  ///   patterns, 64 variables.
  Sparql(std::string_view text, std::shared_ptr<const Ontology> ontology);
  Sparql(Sparql&&) noexcept;
  Sparql& operator=(Sparql&&) noexcept;
  ~Sparql();

  const std::vector<std::string>& variables() const;  ///< selected, with `?`
  /// Rows of names (instances, concepts, literals as text), sorted, without repetitions. A variable
  /// that an alternative leaves open is ""; an instance that holds no more is in lower case.
  /// @throws ConfigError after a million intermediate rows, or 4 million names in the answer; so do
  ///   Instances and Accepts.
  std::vector<std::vector<std::string>> Select(const FluentView& view) const;
  /// Instances that the first selected variable takes; with `candidate`, only whether it is one.
  std::vector<std::string> Instances(const FluentView& view) const;
  bool Accepts(const FluentView& view, const std::string& candidate) const;
  /// Roles over which a match looks at other instances: a change there can change the answer.
  const std::vector<std::string>& joined_roles() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace hires::knowledge
