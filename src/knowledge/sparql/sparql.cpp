#include "hires/knowledge/sparql.h"

#include <utility>

#include "knowledge/sparql/sparql_engine.h"
#include "knowledge/sparql/sparql_reach.h"

namespace hires::knowledge {

struct Sparql::Implementation {
  Implementation(std::string_view text, std::shared_ptr<const Ontology> ontology)
      : engine(text, std::move(ontology)), reach(sparql::FindReach(engine.query())) {
    const sparql::Query& query = engine.query();
    for (const int variable : query.selected) {
      variables.push_back(query.variables[static_cast<std::size_t>(variable)]);
    }
  }

  sparql::Engine engine;
  sparql::Reach reach;
  std::vector<std::string> variables;
};

Sparql::Sparql(std::string_view text, std::shared_ptr<const Ontology> ontology)
    : implementation_(std::make_unique<Implementation>(text, std::move(ontology))) {}
Sparql::Sparql(Sparql&&) noexcept = default;
Sparql& Sparql::operator=(Sparql&&) noexcept = default;
Sparql::~Sparql() = default;

const std::vector<std::string>& Sparql::variables() const { return implementation_->variables; }

std::vector<std::vector<std::string>> Sparql::Select(const FluentView& view) const {
  return implementation_->engine.Select(view);
}

std::vector<std::string> Sparql::Instances(const FluentView& view) const {
  return implementation_->engine.Instances(view);
}

bool Sparql::Accepts(const FluentView& view, const std::string& candidate) const {
  return implementation_->engine.Accepts(view, candidate);
}

const std::vector<std::string>& Sparql::joined_roles() const {
  return implementation_->reach.joined_roles;
}

}  // namespace hires::knowledge
