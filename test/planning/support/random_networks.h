#pragma once

#include <rapidcheck.h>

#include <algorithm>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "hires/planning/domain.h"
#include "hires/planning/shop2_reader.h"

namespace hires::test_support {

/// A small random domain with one problem, as SHOP2 text: a counterexample can be pasted into a
/// file and planned by hand.
struct RandomNetwork {
  std::string domain_text;
  std::string problem_text;

  planning::Domain domain() const { return planning::ReadShop2Domain(domain_text, "domain"); }
  planning::Problem problem() const {
    return planning::ReadShop2Problems(problem_text, "problem").at(0);
  }
};

inline void showValue(const RandomNetwork& network, std::ostream& out) {
  out << network.domain_text << network.problem_text;
}

/// What random networks are made of.
struct NetworkOptions {
  bool protections{false};  ///< operators protect what they add, others give it free
  bool immediate{true};     ///< some tasks are marked so
  bool variables{false};    ///< operators delete and add what variables stand for, also by forall
  bool recursion{false};    ///< tasks may lead to themselves; the search may have no end
  int num_tasks{3};         ///< compound tasks; without recursion each leads to later ones only
  int max_items{3};         ///< of a task network
};

/// Writes the text of a random network; every choice is RapidCheck's, so it can be made simpler.
class NetworkWriter {
 public:
  explicit NetworkWriter(const NetworkOptions& options) : options_(options) {}

  RandomNetwork Write() {
    std::string domain = "(defdomain random (\n";
    for (int i = 0; i < kNumOperators; ++i) domain += Operator(i);
    // These bind a variable that their task leaves open.
    domain += "  (:operator (!bind ?x) ((p ?x)) () ())\n";
    domain += "  (:method (choose ?x) ((q ?x)) ())\n";
    if (options_.variables) domain += OperatorsOfVariables();
    for (int i = 0; i < options_.num_tasks; ++i) {
      const int num_methods = 1 + Pick(2);
      for (int k = 0; k < num_methods; ++k) domain += Method(i);
    }
    domain += "))\n";
    return {domain, "(defproblem random random\n  (" + Facts() + ")\n  " +
                        Network(-1, {"a", "b"}, 2, 1) + ")\n"};
  }

 private:
  static constexpr int kNumOperators = 4;
  using Names = std::vector<std::string>;

  static int Pick(int count) {
    return *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(0, count));
  }
  static bool Chance(int percent) { return Pick(100) >= 100 - percent; }
  static std::string Of(const Names& names) { return names[Pick(static_cast<int>(names.size()))]; }
  static std::string Predicate() { return Of({"p", "q", "r"}); }
  static std::string Atom(const Names& arguments) {
    return "(" + Predicate() + " " + Of(arguments) + ")";
  }

  static std::string Facts() {
    std::string text;
    const int count = 2 + Pick(6);
    for (int i = 0; i < count; ++i) text += (i == 0 ? "" : " ") + Atom({"a", "b", "c"});
    return text;
  }

  /// Up to two goals over `known`, often none; one may bind ?y, which then joins `known`.
  static std::string Goals(Names* known) {
    std::string text;
    const int count = std::max(0, Pick(5) - 2);
    for (int i = 0; i < count; ++i) text += (i == 0 ? "" : " ") + Goal(known);
    return "(" + text + ")";
  }

  static std::string Goal(Names* known) {
    switch (Pick(8)) {
      case 0:
        return "(not " + Atom(*known) + ")";
      case 1:
        return "(not (" + Predicate() + " ?free))";
      case 2:
        return "(forall (?v) ((" + Predicate() + " ?v)) ((" + Predicate() + " ?v)))";
      case 3:
        return "(imply " + Atom({known->front(), "a"}) + " " + Atom(*known) + ")";
      case 4:
      case 5:
        known->push_back("?y");
        return "(" + Predicate() + " ?y)";
      default:
        return Atom(*known);
    }
  }

  std::string Operator(int index) const {
    Names known{"?x", "a"};
    const std::string head = "(!o" + std::to_string(index) + " ?x)";
    const std::string condition = Goals(&known);
    std::string deletes = Effects(known);
    std::string adds = Effects(known);
    if (options_.protections && index == 0) {
      const std::string atom = Atom({"?x", "a", "b"});
      adds += " " + atom + " (:protection " + atom + ")";
    }
    if (options_.protections && index == 1) deletes += " (:protection " + Atom({"?x", "a"}) + ")";
    return "  (:operator " + head + " " + condition + " (" + deletes + ") (" + adds + ") " +
           std::to_string(Pick(4)) + ")\n";
  }

  /// They take an atom or a list as their argument, gather it or read it in the state.
  std::string OperatorsOfVariables() const {
    const Names two{"a", "b"};
    Names known = two;
    const std::string each = "(forall (?v) ((" + Predicate() + " ?v)) (";
    const std::string also = Of({"", " ?f"});
    std::string text = "  (:operator (!note ?f) " + Goals(&known);
    text +=
        " (" + Effects(known) + ") (?f " + Effects(known) + ") " + std::to_string(Pick(4)) + ")\n";
    text += "  (:operator (!forget ?f) () (" + Effects(two) + " ?f) (" + Effects(two);
    text += ") (call length ?f))\n  (:operator (!all ?f) () () ?f)\n";
    text += "  (:operator (!each ?f) () (" + each + Atom({"?v", "a"}) + also + "))) (";
    text += each + Atom({"?v", "b"}) + also + "))))\n";
    text += "  (:operator (!pair ?f) () (" + each + "(forall (?w) ((" + Predicate() + " ?w)) (";
    text += Atom({"?v", "?w"}) + "))))) (" + also + "))\n";
    text += "  (:operator (!gather ?f) ((setof " + Atom({"?v"}) + " (" + Atom({"?v"});
    text += ") ?g) (assign ?h '" + Value(two) + ")) (" + Of({"?h", "?g"}) + ") (";
    text += Of({"?g", "?h"}) + " ?f))\n";
    text +=
        "  (:operator (!maybe ?f) ((imply " + Atom(two) + " " + Atom({"?y"}) + ") (exists (?z) (";
    text += Atom({"?z"}) + ") (" + Atom({"?w"}) + "))) (" + Atom({"?y"}) + " " + Atom({"?w"});
    return text + ") (?f))\n";
  }

  /// An atom, a list of some, or protections among them.
  std::string Value(const Names& known) const {
    if (Chance(40)) return Atom(known);
    std::string text;
    const int count = Pick(3);
    for (int i = 0; i < count; ++i) text += (i == 0 ? "" : " ") + Atom(known);
    if (!options_.protections || Chance(60)) return "(" + text + ")";
    const std::string atom = Atom(known);
    if (Chance(30)) return "(:protection " + atom + ")";
    return "(" + text + " " + atom + " (:protection " + atom + "))";
  }

  static std::string Effects(const Names& known) {
    std::string text;
    const int count = Pick(3);
    for (int i = 0; i < count; ++i) text += (i == 0 ? "" : " ") + Atom(known);
    return text;
  }

  std::string Method(int index) const {
    std::string text = "  (:method (t" + std::to_string(index) + " " + Of({"?x", "?x", "a"}) + ")";
    const bool has_x = text.find("?x") != std::string::npos;
    const int num_branches = 1 + Pick(2);
    for (int i = 0; i < num_branches; ++i) {
      Names known{has_x ? "?x" : "a", "b"};
      std::string condition = Goals(&known);
      if (Chance(15)) condition = "(:first " + condition.substr(1);
      text += "\n    " + condition + "\n    " + Network(index, known, 0, 1);
    }
    return text + ")\n";
  }

  /// A task network of `at_least` items or more, whose tasks come after task `index` if there is
  /// no recursion; `nesting` is how many levels of networks it may hold.
  std::string Network(int index, const Names& known, int at_least, int nesting) const {
    const int count = at_least + Pick(options_.max_items + 1 - at_least);
    if (count == 0) return "()";
    const bool is_unordered = Chance(60);
    Names names = known;
    std::string text;
    if (!is_unordered && nesting == 1 && index >= 0 && Chance(15)) {
      text += Of({" (!bind ?late)", " (choose ?late)"});  // for those that follow
      names.push_back("?late");
    }
    for (int i = 0; i < count; ++i) text += " " + Item(index, names, nesting);
    return (is_unordered ? "(:unordered" : "(:ordered") + text + ")";
  }

  std::string Item(int index, const Names& known, int nesting) const {
    if (nesting > 0 && Chance(20)) return Network(index, known, 1, nesting - 1);
    const int first = options_.recursion ? 0 : index + 1;
    const bool is_compound =
        first < options_.num_tasks && Chance(options_.recursion || index < 0 ? 70 : 40);
    if (!is_compound && options_.variables && Chance(50)) {
      const std::string value = Chance(20) ? "'" + Value(known) : Value(known);
      return "(" + Of({"!note", "!forget", "!all", "!each", "!pair", "!gather", "!maybe"}) + " " +
             value + ")";
    }
    const std::string name = is_compound
                                 ? "t" + std::to_string(first + Pick(options_.num_tasks - first))
                                 : "!o" + std::to_string(Pick(kNumOperators));
    const std::string task = name + " " + Of(known);
    return options_.immediate && Chance(15) ? "(:task :immediate " + task + ")" : "(" + task + ")";
  }

  const NetworkOptions options_;
};

/// Random networks; they become simpler when a property fails.
inline rc::Gen<RandomNetwork> RandomNetworks(const NetworkOptions& options = {}) {
  return rc::gen::exec([options] { return NetworkWriter(options).Write(); });
}

}  // namespace hires::test_support
