#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "knowledge/yaml/fluent_yaml_scalar.h"
#include "knowledge/yaml/fluent_yaml_tree.h"

namespace hires::knowledge {

/// A value and where it stands. Asking for something that it is not throws a ConfigError with
/// source, document, line, key, what came and what was wanted.
class Field {
 public:
  /// @param where  "kitchen.yaml: document 3"; line and key come from `node` and `key`.
  /// @param node   Must outlive this.
  Field(const YamlNode& node, const std::string& where, std::string key)
      : node_(&node), where_(&where), key_(std::move(key)) {}

  std::string At() const;  ///< "kitchen.yaml: document 3, line 12, Properties item 2"
  [[noreturn]] void Fail(const std::string& what) const;

  /// Items of a list of `size` (any where empty); `wanted` says in words what was wanted.
  std::vector<Field> Items(const std::string& wanted, std::optional<std::size_t> size = {}) const;

  /// Text that no reader of YAML 1.1 takes for anything else: quoted, or plain and neither On nor
  /// 12.
  std::string Text() const;
  std::string Name() const;                ///< as Text, and fit for an instance or concept
  std::vector<std::string> Names() const;  ///< a list of names
  double Real() const;                     ///< finite
  double Moment() const;                   ///< [s], may be .inf or -.inf
  std::int64_t Integer() const;
  bool Truth() const;

 private:
  const std::string& Plain(const std::string& wanted) const;
  template <typename Number>
  Number Convert(NumberOutcome (*read)(std::string_view, Number*), const std::string& wanted) const;
  std::string Written() const;
  void RejectTag() const;

  const YamlNode* node_;
  const std::string* where_;
  std::string key_;
};

/// The keys of a document. Each stands there once, and is known.
class Fields {
 public:
  /// @throws ConfigError for anything but a map with keys out of `known`.
  Fields(const YamlNode& root, std::string where, const std::vector<std::string>& known);
  Fields(const Fields&) = delete;  // fields point into it
  Fields& operator=(const Fields&) = delete;

  std::optional<Field> Find(const std::string& key) const;
  /// @param advice  What to write where there is nothing to say: "write [] for none".
  Field Require(const std::string& key, const std::string& advice) const;
  std::string At() const;  ///< "kitchen.yaml: document 3, line 12"

 private:
  void CheckKey(std::size_t at, const std::vector<std::string>& known) const;
  const YamlNode& root_;
  std::string where_;
};

}  // namespace hires::knowledge
