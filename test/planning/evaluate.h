#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "hires/planning/datum_reader.h"
#include "hires/planning/functions.h"
#include "hires/planning/term.h"

/// Expressions written as text, for tests.
namespace hires::planning::test_support {

/// Variables with values given as text; "" is a variable without a value.
class TextVariables : public VariableValues {
 public:
  TextVariables(TermTable* terms, const std::map<std::string, std::string>& values) {
    for (const auto& [name, text] : values) {
      names_.push_back(name);
      values_.push_back(text.empty() ? Variable() : terms->FromDatum(ReadData(text, "value")[0]));
    }
  }

  int SlotOf(const std::string& name) {
    for (std::size_t i = 0; i < names_.size(); ++i) {
      if (names_[i] == name) return static_cast<int>(i);
    }
    names_.push_back(name);
    values_.push_back(Variable());
    return static_cast<int>(names_.size()) - 1;
  }

  Term Value(int slot) override { return values_[static_cast<std::size_t>(slot)]; }

 private:
  Term Variable() const {
    return {Term::Kind::kVariable, static_cast<std::uint32_t>(values_.size())};
  }

  std::vector<std::string> names_;
  std::vector<Term> values_;
};

/// The value of an expression, printed.
inline std::string Evaluate(const std::string& text,
                            const std::map<std::string, std::string>& values = {},
                            const Functions& functions = Functions::Standard()) {
  TermTable terms;
  TextVariables variables(&terms, values);
  const Expression expression(
      ReadData(text, "test.lisp").at(0),
      [&](const std::string& name) { return variables.SlotOf(name); }, functions, &terms,
      "test.lisp");
  return terms.ToString(expression.Evaluate(&terms, &variables));
}

}  // namespace hires::planning::test_support
