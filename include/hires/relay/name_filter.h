#pragma once

#include <regex>
#include <set>
#include <string>
#include <vector>

namespace hires::relay {

/// Names of topics or services, as exact names and as regular expressions (ECMAScript) that must
/// cover the whole name. Every master has topics of its own that would fight when two meet
/// (/clock, /tf, /tf_static, /rosout, /rosout_agg): no expression ever covers those, only the
/// exact name does.
class NameFilter {
 public:
  /// @param patterns  Absolute: each begins with '/'.
  /// @param where     Key of the configuration, for messages.
  /// @throws base::ConfigError for a relative name, a bad or an overlong expression.
  NameFilter(const std::vector<std::string>& patterns, const std::string& where);
  NameFilter() = default;

  /// Names longer than 512 characters never match: real ones are short, and matching costs stack.
  bool Matches(const std::string& name) const;

  /// Everything either filter covers.
  void Add(const NameFilter& other);

  bool is_empty() const { return names_.empty() && expressions_.empty(); }

 private:
  void AddPattern(const std::string& pattern, const std::string& where);

  std::set<std::string> names_;
  std::vector<std::regex> expressions_;
};

/// Whether every master has a topic `name` of its own.
bool IsPrivateToMaster(const std::string& name);

}  // namespace hires::relay
