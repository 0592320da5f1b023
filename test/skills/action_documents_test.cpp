// Holds files and documents that speak of actions against the catalogue, in both directions: what
// was forgotten is red, with what to add where.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <regex>
#include <set>

#include "hires/actions/catalogue.h"
#include "hires/base/text.h"
#include "hires/knowledge/ontology.h"
#include "hires/planning/operator_data.h"
#include "hires/planning/planning_files.h"

namespace hires::skills::action_documents_test {
namespace {

using actions::ActionSpec;
using actions::OwnActions;
using Names = std::set<std::string>;

constexpr char kImagine[] = "imagine";  // the execution monitor's own operator, none of the robot's
constexpr char kSpecs[] = "src/actions/own_actions.cpp";

std::string PathOf(const std::string& file) { return std::string(HIRES_SOURCE_DIR) + '/' + file; }

std::vector<const ActionSpec*> Operators() {
  std::vector<const ActionSpec*> operators;
  for (const auto& [name, spec] : OwnActions().specs()) {
    if (spec.is_operator) operators.push_back(&spec);
  }
  return operators;
}

// Lisp -------------------------------------------------------------------------------------------

constexpr char kLisp[] = "config/domains/restaurant.lisp";

const planning::Domain& TheDomain() {
  static const planning::Domain domain = planning::LoadDomain(PathOf(kLisp));
  return domain;
}

/// `!move_base` is called move_base elsewhere.
std::string NameOf(const planning::Operator& one) {
  return base::CanonicalName(std::string(one.head.Head()));
}

const planning::Operator* FindOperator(const std::string& name) {
  for (const planning::Operator& one : TheDomain().operators) {
    if (NameOf(one) == name) return &one;
  }
  return nullptr;
}

std::string HeadOf(const ActionSpec& spec) {
  std::string head = "(!" + spec.name;
  for (const auto& parameter : spec.parameters) head += " ?" + parameter.name;
  return head + ')';
}

Names EffectsOf(const ActionSpec& spec) {
  Names effects;
  for (const base::Atom& effect : spec.effects) {
    effects.insert(
        base::ToLower(fmt::format("({} {})", effect.predicate, base::Join(effect.arguments, " "))));
  }
  return effects;
}

Names AddsOf(const planning::Operator& one) {
  Names adds;
  for (const planning::Effect& effect : one.adds) adds.insert(planning::ToString(effect.term));
  return adds;
}

TEST(ActionDocumentsTest, LispHasAnOperatorForEachAction) {
  for (const ActionSpec* spec : Operators()) {
    const planning::Operator* one = FindOperator(spec->name);
    ASSERT_NE(one, nullptr) << kLisp << ": add (:operator " << HeadOf(*spec)
                            << " ...), or set is_operator to false in " << kSpecs;
    EXPECT_EQ(planning::ToString(one->head), HeadOf(*spec))
        << kLisp << ':' << one->place.line << " and " << kSpecs << " differ";
    EXPECT_EQ(AddsOf(*one), EffectsOf(*spec))
        << kLisp << ':' << one->place.line << ": what " << spec->name
        << " adds is not what its effects in " << kSpecs << " promise";
  }
}

TEST(ActionDocumentsTest, LispHasNoOperatorThatNobodyCanDo) {
  for (const planning::Operator& one : TheDomain().operators) {
    if (one.head.Head().substr(0, 2) == "!!") continue;  // bookkeeping, which nobody does
    const std::string name = NameOf(one);
    const ActionSpec* spec = OwnActions().Find(name);
    EXPECT_TRUE(name == kImagine || (spec != nullptr && spec->is_operator))
        << kLisp << ':' << one.place.line << ": operator " << name
        << " is no action; describe it in " << kSpecs
        << " and give it a maker in src/skills/skill_factory.cpp";
  }
}

// Sidecar ----------------------------------------------------------------------------------------

constexpr char kSidecar[] = "config/domains/restaurant.yaml";

/// One action at a time may have an arm, the head, the torso or the base.
std::string ResourceOf(const std::string& group) {
  if (group == actions::kBaseGroup) return "navigationcapacity";
  if (group == actions::kTorsoGroup) return "torsocapacity";
  if (group == actions::kHeadGroup) return "headcapacity";
  const bool is_parameter = group.front() == '?';
  return (is_parameter ? '<' + group.substr(1) + '>' : group) + "mancapacity";
}

Names ResourcesOf(const ActionSpec& spec) {
  Names resources;
  for (const std::string& group : spec.groups) resources.insert(ResourceOf(group));
  return resources;
}

TEST(ActionDocumentsTest, TheSidecarHoldsWhatActionsNeedForThemselves) {
  const planning::OperatorData data = planning::LoadOperatorData(PathOf(kSidecar), TheDomain());
  for (const ActionSpec* spec : Operators()) {
    const auto entry = data.operators.find(spec->name);
    ASSERT_NE(entry, data.operators.end()) << kSidecar << ": add an entry for " << spec->name;
    Names held;
    for (const auto& [resource, units] : entry->second.resources) held.insert(resource);
    EXPECT_EQ(held, ResourcesOf(*spec))
        << kSidecar << ": resources of " << spec->name << " do not fit its groups in " << kSpecs;
  }
  for (const auto& [name, entry] : data.operators) {
    EXPECT_TRUE(name == kImagine || OwnActions().Find(name) != nullptr)
        << kSidecar << ": the entry " << name << " is no action; remove it";
  }
}

// Ontology ---------------------------------------------------------------------------------------

constexpr char kOntology[] = "config/ontology/race.ttl";

const knowledge::Ontology& TheOntology() {
  static const knowledge::Ontology ontology =
      knowledge::Ontology::FromFiles({PathOf("config/ontology/upper.ttl"), PathOf(kOntology)});
  return ontology;
}

/// Everything below a concept but itself.
Names ConceptsBelow(const std::string& above) {
  Names names;
  for (const auto id : TheOntology().Below(TheOntology().Require(above))) {
    if (TheOntology().Name(id) != above) names.insert(TheOntology().Name(id));
  }
  return names;
}

void ExpectConcepts(const std::string& above, std::string (*concept_of)(const std::string&)) {
  Names wanted{concept_of(kImagine)};
  for (const ActionSpec* spec : Operators()) wanted.insert(concept_of(spec->name));
  const Names there = ConceptsBelow(above);
  for (const std::string& name : wanted) {
    EXPECT_EQ(there.count(name), 1u) << kOntology << ": add 'race:" << name
                                     << " a owl:Class ; rdfs:subClassOf upper:" << above << " .'";
  }
  for (const std::string& name : there) {
    EXPECT_EQ(wanted.count(name), 1u)
        << kOntology << ": " << name << " is of no action in " << kSpecs << "; remove it";
  }
}

TEST(ActionDocumentsTest, TheOntologyHasAnActivityAndATaskForEachAction) {
  ExpectConcepts("ElementaryRobotActivity", actions::ActivityConcept);
  ExpectConcepts("PrimitiveTask", actions::TaskConcept);
}

// Tables -----------------------------------------------------------------------------------------

using Row = std::vector<std::string>;  // cells

std::string Trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(' ');
  return first == std::string::npos ? ""
                                    : text.substr(first, text.find_last_not_of(' ') + 1 - first);
}

/// The rows of the table that begins with `header`.
std::vector<Row> TableOf(const std::string& file, const std::string& header) {
  const std::string text = base::ReadTextFile(PathOf(file));
  const auto begin = text.find(header);
  EXPECT_NE(begin, std::string::npos) << file << ": has no table '" << header << "'";
  std::vector<Row> rows;
  if (begin == std::string::npos) return rows;
  for (const std::string& line : base::Split(text.substr(begin), '\n')) {
    if (line.empty() || line.front() != '|') break;
    Row row;
    for (const std::string& cell : base::Split(line, '|')) row.push_back(Trimmed(cell));
    rows.push_back({row.begin() + 1, row.end() - 1});
  }
  rows.erase(rows.begin(), rows.begin() + 2);  // what it says above, and the line below that
  return rows;
}

/// What stands `so` in a cell.
std::vector<std::string> CodeIn(const std::string& cell) {
  static const std::regex code("`([^`]*)`");
  std::vector<std::string> found;
  for (std::sregex_iterator i(cell.begin(), cell.end(), code), end; i != end; ++i) {
    found.push_back((*i)[1]);
  }
  return found;
}

std::string ParametersInWords(const ActionSpec& spec) {
  std::vector<std::string> words;
  for (const auto& parameter : spec.parameters) {
    words.push_back(parameter.name);
    std::replace(words.back().begin(), words.back().end(), '_', ' ');
  }
  return words.empty() ? "none" : base::Join(words, ", ");
}

/// Names rows that are missing in a file, and those that nothing in the catalogue stands behind.
void ExpectRows(const std::string& file, const Names& listed, const Names& wanted) {
  for (const std::string& row : wanted) {
    EXPECT_EQ(listed.count(row), 1u) << file << ": has no row '" << row << "'; add it";
  }
  for (const std::string& row : listed) {
    EXPECT_EQ(wanted.count(row), 1u)
        << file << ": the row '" << row << "' is not as " << kSpecs << " says; correct one of them";
  }
}

TEST(ActionDocumentsTest, TheReadmeListsEachAction) {
  Names wanted, listed;
  for (const auto& [name, spec] : OwnActions().specs()) {
    wanted.insert(fmt::format("| `{}` | {} |", name, ParametersInWords(spec)));
  }
  for (const Row& row : TableOf("docs/actions.md", "| action | arguments | what it does |")) {
    listed.insert(fmt::format("| {} | {} |", row.at(0), row.at(1)));
  }
  ExpectRows("docs/actions.md", listed, wanted);
}

std::string RowOf(const std::string& signature, const Names& failures) {
  return fmt::format("{} fails with: {}", signature,
                     base::Join({failures.begin(), failures.end()}, ", "));
}

TEST(ActionDocumentsTest, TheNotesSayHowEachActionFails) {
  Names wanted, listed;
  for (const auto& [name, spec] : OwnActions().specs()) {
    Names failures;
    for (const base::FailureCode code : spec.failures) failures.insert(base::ToString(code));
    wanted.insert(RowOf(actions::Signature(spec), failures));
  }
  for (const Row& row :
       TableOf("docs/notes_skills.md", "| action | stages | fails with, beside `timed_out` |")) {
    const auto words = CodeIn(row.at(2));
    for (const std::string& signature : CodeIn(row.at(0))) {
      listed.insert(RowOf(signature, {words.begin(), words.end()}));
    }
  }
  ExpectRows("docs/notes_skills.md", listed, wanted);
}

}  // namespace
}  // namespace hires::skills::action_documents_test
