#include "hires/base/param_reader.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "hires/base/error.h"
#include "hires/base/spelling.h"
#include "hires/base/text.h"

namespace hires::base {
namespace {

std::string LineOf(const YAML::Node& node) {
  const YAML::Mark mark = node.Mark();
  return mark.is_null() ? "" : fmt::format("; line {}", mark.line + 1);
}

std::string Written(const YAML::Node& node) {
  switch (node.Type()) {
    case YAML::NodeType::Scalar:
      return "'" + node.Scalar() + "'";
    case YAML::NodeType::Sequence:
      return "a list";
    case YAML::NodeType::Map:
      return "a map";
    default:
      return "empty";
  }
}

/// Null where the text is no YAML.
YAML::Node TextAsYaml(const std::string& text) {
  try {
    return YAML::Load(text);
  } catch (const YAML::Exception&) {
    return YAML::Node();
  }
}

/// Whether maps within maps lead to something by these keys.
bool HasPath(const YAML::Node& map, const std::vector<std::string>& keys) {
  YAML::Node node = map;
  for (const std::string& key : keys) {
    const YAML::Node& here = node;
    if (!here.IsMap() || !here[key].IsDefined()) return false;
    node.reset(here[key]);
  }
  return true;
}

bool HasLeadingZero(const YAML::Node& node) {
  if (!node.IsScalar()) return false;
  const std::string digits = node.Scalar().substr(node.Scalar().find_first_not_of("+-") == 1);
  return digits.size() > 1 && digits[0] == '0';
}

/// Whether letters are too many, too few or swapped. Another letter is no sign: start_x is not
/// start_y.
bool IsMistyped(const std::string& given, const std::string& wanted) {
  if (given.size() != wanted.size()) return AreSpeltAlike(given, wanted);
  return EditDistance(given, wanted) == 2 &&
         std::is_permutation(given.begin(), given.end(), wanted.begin());
}

/// A key that is missing may stand there mistyped; then one error says so.
/// @param read  keys that are something else.
void RefuseMistyped(const YAML::Node& map, const std::set<std::string>& read,
                    const std::string& missing, const std::string& where,
                    const std::string& prefix) {
  for (const auto& entry : map) {
    const std::string key = entry.first.Scalar();
    if (read.count(key) > 0 || !IsMistyped(key, missing)) continue;
    throw ConfigError(fmt::format("{}: {}{}", where,
                                  UnknownName("key", prefix + key, {prefix + missing}),
                                  LineOf(entry.first)));
  }
}

}  // namespace

Bound<double> Between(double lower, double upper) {
  return {[=](double x) { return x >= lower && x <= upper; },
          fmt::format("between {} and {}", lower, upper)};
}

Bound<double> Positive() {
  return {[](double x) { return x > 0.0 && std::isfinite(x); }, "a finite number above 0"};
}

Bound<int> Between(int lower, int upper) {
  return {[=](int x) { return x >= lower && x <= upper; },
          fmt::format("a whole number between {} and {}", lower, upper)};
}

Bound<std::string> OneOf(std::vector<std::string> choices) {
  const std::string wanted = "one of '" + Join(choices, "', '") + "'";
  return {[choices = std::move(choices)](const std::string& x) {
            return std::find(choices.begin(), choices.end(), x) != choices.end();
          },
          wanted};
}

std::optional<std::string> WordOf(bool value, const Bound<std::string>& bound) {
  static const std::vector<std::string> kTrue{"on", "yes", "true"}, kFalse{"off", "no", "false"};
  const std::vector<std::string>& words = value ? kTrue : kFalse;
  const auto fitting = std::find_if(words.begin(), words.end(), bound.holds);
  if (fitting == words.end()) return std::nullopt;
  return *fitting;
}

struct ParamReader::Map {
  Map(const YAML::Node& map, std::string file, std::string path);

  bool Has(const std::string& key) const;
  YAML::Node Require(const std::string& key);
  template <typename T>
  T Parse(const std::string& key, const char* type_name);
  template <typename T>
  T GetBounded(const std::string& key, const Bound<T>& bound, const char* type_name);
  [[noreturn]] void Fail(const std::string& key, const std::string& what) const;

  const YAML::Node node;     // const, as looking up a key would add it otherwise
  const std::string where;   // file
  const std::string prefix;  // "" or "path.to."
  std::set<std::string> read;
  std::vector<ParamReader> subs;
};

ParamReader::Map::Map(const YAML::Node& map, std::string file, std::string path)
    : node(map), where(std::move(file)), prefix(std::move(path)) {
  if (!node.IsMap() && !node.IsNull()) {
    throw ConfigError(
        fmt::format("{}: {} is {}, wanted a map of keys{}", where,
                    prefix.empty() ? "the document" : prefix.substr(0, prefix.size() - 1),
                    Written(node), LineOf(node)));
  }
  std::set<std::string> seen;
  for (const auto& entry : node) {
    if (!seen.insert(entry.first.Scalar()).second) {
      throw ConfigError(fmt::format("{}: {}{} stands twice{}; keep one", where, prefix,
                                    entry.first.Scalar(), LineOf(entry.first)));
    }
  }
}

bool ParamReader::Map::Has(const std::string& key) const {
  return node.IsMap() && node[key].IsDefined();
}

YAML::Node ParamReader::Map::Require(const std::string& key) {
  read.insert(key);
  if (!Has(key)) {
    RefuseMistyped(node, read, key, where, prefix);
    throw ConfigError(
        fmt::format("{}: {}{} is missing{}; add it", where, prefix, key, LineOf(node)));
  }
  return node[key];
}

template <typename T>
T ParamReader::Map::Parse(const std::string& key, const char* type_name) {
  const YAML::Node value = Require(key);
  try {
    if (value.IsScalar()) return value.as<T>();
  } catch (const YAML::Exception&) {
  }
  throw ConfigError(fmt::format("{}: {}{} is {}, wanted {}{}", where, prefix, key, Written(value),
                                type_name, LineOf(value)));
}

template <typename T>
T ParamReader::Map::GetBounded(const std::string& key, const Bound<T>& bound,
                               const char* type_name) {
  T value = Parse<T>(key, type_name);
  if (!bound.holds(value)) Fail(key, "wanted " + bound.wanted);
  return value;
}

void ParamReader::Map::Fail(const std::string& key, const std::string& what) const {
  const YAML::Node value = node.IsMap() ? node[key] : YAML::Node();
  throw ConfigError(fmt::format("{}: {}{} is {}, {}{}", where, prefix, key,
                                value.IsDefined() ? Written(value) : "missing", what,
                                value.IsDefined() ? LineOf(value) : ""));
}

ParamReader::ParamReader(std::shared_ptr<Map> map) : map_(std::move(map)) {}

ParamReader ParamReader::FromFile(const std::string& path) {
  return FromString(ReadTextFile(path, 1u << 20), path);
}

ParamReader ParamReader::FromString(const std::string& yaml, const std::string& where) {
  try {
    const std::vector<YAML::Node> documents = YAML::LoadAll(yaml);
    if (documents.size() > 1) {
      throw ConfigError(fmt::format("{}: holds {} YAML documents, wanted one; remove the '---'{}",
                                    where, documents.size(), LineOf(documents[1])));
    }
    return ParamReader(
        std::make_shared<Map>(documents.empty() ? YAML::Node() : documents[0], where, ""));
  } catch (const YAML::Exception& error) {
    throw ConfigError(
        fmt::format("{}: no valid YAML: {}; line {}", where, error.msg, error.mark.line + 1));
  }
}

double ParamReader::Get(const std::string& key, const Bound<double>& bound) {
  return map_->GetBounded<double>(key, bound, "a number");
}
int ParamReader::Get(const std::string& key, const Bound<int>& bound) {
  // The YAML library would take 010 for the octal 8.
  if (HasLeadingZero(map_->Require(key))) Fail(key, "wanted a whole number without a leading 0");
  return map_->GetBounded<int>(key, bound, "a whole number");
}
std::string ParamReader::Get(const std::string& key, const Bound<std::string>& bound) {
  return map_->GetBounded<std::string>(key, bound, "text");
}
bool ParamReader::GetBool(const std::string& key) {
  return map_->Parse<bool>(key, "true or false");
}
std::string ParamReader::GetString(const std::string& key) {
  return map_->Parse<std::string>(key, "text");
}

std::vector<double> ParamReader::GetNumbers(const std::string& key, std::size_t size) {
  const YAML::Node list = map_->Require(key);
  std::vector<double> numbers;
  if (list.IsSequence()) {
    for (const YAML::Node& item : list) {
      double number = std::numeric_limits<double>::quiet_NaN();
      if (!YAML::convert<double>::decode(item, number) || !std::isfinite(number)) {
        Fail(key, fmt::format("item {} is {}, wanted a finite number", numbers.size() + 1,
                              Written(item)));
      }
      numbers.push_back(number);
    }
  }
  if (!list.IsSequence()) Fail(key, fmt::format("wanted a list of {} numbers", size));
  if (numbers.size() != size)
    Fail(key, fmt::format("wanted a list of {} numbers and not {}", size, numbers.size()));
  return numbers;
}

std::vector<std::string> ParamReader::GetStrings(const std::string& key,
                                                 const std::string& wanted) {
  const YAML::Node list = map_->Require(key);
  if (!list.IsSequence()) Fail(key, "wanted " + wanted);
  std::vector<std::string> strings;
  for (const YAML::Node& item : list) {
    if (!item.IsScalar()) Fail(key, "wanted " + wanted);
    strings.push_back(item.Scalar());
  }
  return strings;
}

bool ParamReader::Has(const std::string& key) const { return map_->Has(key); }

void ParamReader::RequireKeys(const std::vector<std::string>& keys) const {
  std::vector<std::string> missing;
  std::set<std::string> read = map_->read;
  read.insert(keys.begin(), keys.end());
  for (const std::string& path : keys) {
    if (HasPath(map_->node, Split(path, '.'))) continue;
    RefuseMistyped(map_->node, read, path, map_->where, map_->prefix);
    missing.push_back(map_->prefix + path);
  }
  if (missing.empty()) return;
  throw ConfigError(fmt::format("{}: {} {} missing; add {}", map_->where, Join(missing, ", "),
                                missing.size() == 1 ? "is" : "are",
                                missing.size() == 1 ? "it" : "them"));
}

ParamReader ParamReader::Sub(const std::string& key) {
  map_->subs.push_back(ParamReader(
      std::make_shared<Map>(map_->Require(key), map_->where, map_->prefix + key + ".")));
  return map_->subs.back();
}

std::optional<std::vector<std::pair<double, double>>> ParamReader::FindPairs(
    const std::string& key, const Bound<double>& bound) {
  YAML::Node list = map_->Require(key);
  if (list.IsScalar()) list.reset(TextAsYaml(list.Scalar()));
  if (!list.IsSequence() || (list.size() > 0 && !list[0].IsSequence())) return std::nullopt;
  std::vector<std::pair<double, double>> pairs;
  for (const YAML::Node& item : list) {
    std::pair<double, double> pair;
    const bool is_pair = item.IsSequence() && item.size() == 2 &&
                         YAML::convert<double>::decode(item[0], pair.first) &&
                         YAML::convert<double>::decode(item[1], pair.second) &&
                         bound.holds(pair.first) && bound.holds(pair.second);
    if (!is_pair) {
      Fail(key, fmt::format("item {} is {}, wanted a pair [x, y] of numbers {}", pairs.size() + 1,
                            YAML::Dump(item), bound.wanted));
    }
    pairs.push_back(pair);
  }
  return pairs;
}

std::vector<ParamReader> ParamReader::SubList(const std::string& key) {
  const YAML::Node list = map_->Require(key);
  if (!list.IsSequence()) Fail(key, "wanted a list of maps");
  std::vector<ParamReader> readers;
  for (std::size_t i = 0; i < list.size(); ++i) {
    readers.push_back(ParamReader(std::make_shared<Map>(
        list[i], map_->where, fmt::format("{}{}[{}].", map_->prefix, key, i))));
  }
  map_->subs.insert(map_->subs.end(), readers.begin(), readers.end());
  return readers;
}

std::vector<std::string> ParamReader::Keys() const {
  std::vector<std::string> keys;
  for (const auto& entry : map_->node) keys.push_back(entry.first.Scalar());
  return keys;
}

std::string ParamReader::Canonical() const { return YAML::Dump(map_->node); }

void ParamReader::RejectUnknownKeys() const {
  std::vector<std::string> wanted;
  for (const std::string& key : map_->read) wanted.push_back(map_->prefix + key);
  for (const auto& entry : map_->node) {
    const std::string key = entry.first.Scalar();
    if (map_->read.count(key) == 0) {
      throw ConfigError(fmt::format("{}: {}{}", map_->where,
                                    UnknownName("key", map_->prefix + key, wanted),
                                    LineOf(entry.first)));
    }
  }
  for (const ParamReader& sub : map_->subs) sub.RejectUnknownKeys();
}

void ParamReader::Fail(const std::string& key, const std::string& what) const {
  map_->Fail(key, what);
}

}  // namespace hires::base
