#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace hires::knowledge {

/// A value of a YAML document. Aliases share the node that they name.
struct YamlNode {
  enum class Kind { kNull, kScalar, kList, kMap };
  Kind kind{Kind::kNull};
  bool quoted{false};  ///< text whatever it looks like: 'On', "12", !!str 12
  int line{0};         ///< in the stream, counted from 1
  std::string tag;     ///< "!Fluent"; "" where none is written
  std::string text;    ///< of a scalar
  std::vector<std::shared_ptr<const YamlNode>> items;  ///< of a list; of a map key, value, key, ...

  std::size_t num_values{1};  ///< with everything below, aliases unfolded
  std::size_t num_bytes{0};   ///< of all text below, likewise
  std::size_t depth{1};       ///< of nesting, likewise
};

/// Calls `visit` with number (from 1) and root of every document that is not empty, one after
/// another: only one is in memory at a time.
/// @throws ConfigError naming source, document, line and key: no valid YAML, a value over 1 MB,
///   more than 100 levels, 100,000 values in a document, or what aliases unfold to: 1,000,000
///   values or 64 MB in the stream.
void VisitDocuments(std::string_view text, const std::string& source,
                    const std::function<void(int document, const YamlNode& root)>& visit);

}  // namespace hires::knowledge
