#include "knowledge/sparql/sparql_reach.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

namespace hires::knowledge::sparql {
namespace {

constexpr std::size_t kMaxBranches = 64;

/// Patterns that hold together: one choice of alternatives for every union.
using Branch = std::vector<const Pattern*>;
using Branches = std::vector<Branch>;
using Chain = std::vector<std::string>;

bool IsOfInstance(const Pattern& pattern) {
  return pattern.verb == Pattern::Verb::kType || pattern.verb == Pattern::Verb::kRole;
}

bool IsLink(const Pattern& pattern) {
  return pattern.verb == Pattern::Verb::kRole && pattern.object.kind == Kind::kInstance;
}

std::optional<Branches> Expand(const Group& group);

std::optional<Branches> Expand(const Element& element) {
  if (!element.IsUnion()) return Branches{{&element.pattern}};
  Branches branches;
  for (const Group& group : element.alternatives) {
    std::optional<Branches> more = Expand(group);
    if (!more || branches.size() + more->size() > kMaxBranches) return std::nullopt;
    for (Branch& branch : *more) branches.push_back(std::move(branch));
  }
  return branches;
}

Branches Combine(const Branches& left, const Branches& right) {
  Branches combined;
  for (const Branch& one : left) {
    for (const Branch& other : right) {
      combined.push_back(one);
      combined.back().insert(combined.back().end(), other.begin(), other.end());
    }
  }
  return combined;
}

/// All branches, or nothing where they are too many.
std::optional<Branches> Expand(const Group& group) {
  Branches branches{{}};
  for (const Element& element : group.elements) {
    const std::optional<Branches> more = Expand(element);
    if (!more || branches.size() * more->size() > kMaxBranches) return std::nullopt;
    branches = Combine(branches, *more);
  }
  return branches;
}

/// For each variable that links lead to from the root, a shortest chain of them.
std::map<int, Chain> ChainsFrom(int root, const Branch& branch) {
  std::map<int, Chain> chains{{root, {}}};
  std::vector<int> open{root};
  for (std::size_t i = 0; i < open.size(); ++i) {
    for (const Pattern* pattern : branch) {
      const int to = pattern->object.variable;
      if (pattern->subject.variable != open[i] || !IsLink(*pattern) || to == kNoVariable) continue;
      Chain chain = chains.at(open[i]);
      chain.push_back(pattern->role);
      if (chains.emplace(to, std::move(chain)).second) open.push_back(to);
    }
  }
  return chains;
}

/// Adds the chains to all that the branch looks at.  @return false if one is out of their reach.
bool Trace(int root, const Branch& branch, std::set<Chain>* chains) {
  const std::map<int, Chain> known = ChainsFrom(root, branch);
  for (const Pattern* pattern : branch) {
    if (!IsOfInstance(*pattern)) continue;
    const auto found = known.find(pattern->subject.variable);
    if (found == known.end()) return false;
    if (!found->second.empty()) chains->insert(found->second);
  }
  return true;
}

void Collect(const Group& group, Branch* patterns) {
  for (const Element& element : group.elements) {
    if (!element.IsUnion()) patterns->push_back(&element.pattern);
    for (const Group& inner : element.alternatives) Collect(inner, patterns);
  }
}

/// Relations that lead to an instance of which something else is asked, or that are not the root's.
std::vector<std::string> JoinedRoles(int root, const Branch& patterns) {
  std::set<int> asked;
  for (const Pattern* pattern : patterns) {
    if (IsOfInstance(*pattern)) asked.insert(pattern->subject.variable);
  }
  std::set<std::string> roles;
  for (const Pattern* pattern : patterns) {
    if (pattern->verb != Pattern::Verb::kRole) continue;
    const bool leads_on = pattern->object.IsVariable() && asked.count(pattern->object.variable) > 0;
    if (leads_on || pattern->subject.variable != root) roles.insert(pattern->role);
  }
  return {roles.begin(), roles.end()};
}

/// What stands in a place, for comparisons: the variable, or the instance's key.
using Place = std::pair<int, std::string>;

Place PlaceOf(const Term& term) {
  const auto* instance = std::get_if<Instance>(&term.constant);
  return {term.variable, instance != nullptr ? instance->key : ""};
}

/// For each subject in the branch besides the root, the relations that are asked of it.
std::map<Place, std::set<std::string>> RolesOf(int root, const Branch& branch) {
  std::map<Place, std::set<std::string>> roles;
  for (const Pattern* pattern : branch) {
    if (!IsOfInstance(*pattern) || pattern->subject.variable == root) continue;
    std::set<std::string>& asked = roles[PlaceOf(pattern->subject)];
    if (pattern->verb == Pattern::Verb::kRole) asked.insert(pattern->role);
  }
  return roles;
}

std::vector<Part> FindParts(int root, const Branches& branches) {
  std::map<Place, Part> parts;
  for (const Branch& branch : branches) {
    for (const auto& [place, roles] : RolesOf(root, branch)) {
      Part& part = parts[place];
      std::tie(part.variable, part.key) = place;
      part.roles.emplace_back(roles.begin(), roles.end());
    }
  }
  std::vector<Part> found;
  for (auto& [place, part] : parts) found.push_back(std::move(part));
  return found;
}

/// Where there are too many branches to tell: one for each pattern, which asks for the least.
Branches Separately(const Branch& patterns) {
  Branches branches;
  for (const Pattern* pattern : patterns) branches.push_back({pattern});
  return branches;
}

}  // namespace

Reach FindReach(const Query& query) {
  const int root = query.root();
  Branch patterns;
  Collect(query.where, &patterns);
  Reach reach;
  reach.joined_roles = JoinedRoles(root, patterns);
  reach.is_local = std::all_of(patterns.begin(), patterns.end(), [&](const Pattern* pattern) {
    return !IsOfInstance(*pattern) || pattern->subject.variable == root;
  });
  const std::optional<Branches> branches = Expand(query.where);
  std::set<Chain> chains;
  reach.is_traceable =
      branches && std::all_of(branches->begin(), branches->end(),
                              [&](const Branch& branch) { return Trace(root, branch, &chains); });
  if (reach.is_traceable) {
    reach.chains.assign(chains.begin(), chains.end());
  } else {
    reach.parts = FindParts(root, branches ? *branches : Separately(patterns));
  }
  return reach;
}

}  // namespace hires::knowledge::sparql
