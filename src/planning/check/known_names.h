#pragma once

#include <set>
#include <string>
#include <vector>

#include "hires/planning/domain.h"

namespace hires::planning {

/// All predicates that can hold at some time: by facts of domain and problem, heads of axioms, and
/// effects.
PredicateSet PredicatesGiven(const Domain& domain, const Problem& problem);

/// Those of the tasks' symbols that stand in no fact and nowhere in the domain, each once and with
/// what is spelt alike: "'gest1' (did you mean 'guest1'?)".
std::vector<std::string> UnknownSymbols(const std::vector<Datum>& tasks, const Domain& domain,
                                        const Problem& problem);

/// What conditions ask for though nothing can ever give it, where something that is spelt alike is
/// given: "d.lisp:4:12: operator '!take': no fact, axiom or effect gives any (emty ...); did you
/// mean 'empty'?". And facts of a problem's file that nothing in the domain has to do with, where
/// something spelt alike is given: "p.lisp:1:20: problem 'p': no operator, method or axiom has
/// anything to do with (hand-free ...); did you mean 'hand_free'?". Each name once. A name like
/// which there is nothing is left out: the state may bring it another time. HDDL declares its
/// predicates, and its reader has compared them.
std::vector<std::string> MisspeltPredicates(const Domain& domain, const Problem& problem);

}  // namespace hires::planning
