#pragma once

#include <string>

#include "hires/planning/datum_reader.h"
#include "hires/planning/functions.h"
#include "hires/planning/shop2_reader.h"
#include "hires/planning/term.h"
#include "planning/proof/program.h"
#include "planning/search/search_path.h"

namespace hires::test_support {

/// A compiled domain and problem with a path at its beginning.
struct PathBench {
  PathBench(const std::string& items, const std::string& facts, const std::string& tasks = "()")
      : domain(planning::ReadShop2Domain("(defdomain d (" + items + "))", "d.lisp")),
        problem(
            planning::ReadShop2Problems("(defproblem p d " + facts + " " + tasks + ")", "p.lisp")
                .at(0)) {}

  planning::Term Term(const std::string& text) {
    return terms.FromDatum(planning::ReadData(text, "text").at(0));
  }
  bool Holds(const std::string& atom) { return path.state().Holds(Term(atom)); }
  const planning::CompiledOperator& Operator(const std::string& name) {
    return *program.FindOperator(terms.Symbol(name));
  }
  const planning::CompiledPrecondition& Precondition(const std::string& task) {
    return program.Methods(terms.Symbol(task)).at(0)->branches.at(0).precondition;
  }

  planning::Domain domain;
  planning::Problem problem;
  planning::TermTable terms;
  planning::Program program{domain, problem, planning::Functions::Standard(), &terms};
  planning::SearchPath path{program, &terms};
};

}  // namespace hires::test_support
