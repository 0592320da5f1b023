#include "knowledge/yaml/fluent_yaml_field.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/temporal/interval.h"
#include "knowledge/fluents/store_check.h"
#include "knowledge/yaml/fluent_yaml_text.h"

namespace hires::knowledge {
namespace {

using Kind = YamlNode::Kind;

std::string MisreadAs(PlainMeaning meaning, const std::string& text) {
  if (meaning == PlainMeaning::kNull) return "is empty, wanted text; write \"\" if none is meant";
  return fmt::format("is {0}, which YAML 1.1 reads as a {1}; put it in quotes: \"{0}\"",
                     Shown(text), meaning == PlainMeaning::kTruth ? "truth value" : "number");
}

}  // namespace

std::string Field::At() const { return fmt::format("{}, line {}, {}", *where_, node_->line, key_); }

void Field::Fail(const std::string& what) const { throw base::ConfigError(At() + ": " + what); }

std::string Field::Written() const {
  switch (node_->kind) {
    case Kind::kNull:
      return "empty";
    case Kind::kScalar:
      return fmt::format("{}'{}'", node_->quoted ? "the quoted text " : "", Shown(node_->text));
    case Kind::kList:
      return fmt::format("a list of {}", node_->items.size());
    case Kind::kMap:
      return "a map";
  }
  return "";
}

void Field::RejectTag() const {
  if (node_->tag.empty()) return;
  Fail(fmt::format("has the tag '{}', which means nothing here; remove it", Shown(node_->tag)));
}

std::vector<Field> Field::Items(const std::string& wanted, std::optional<std::size_t> size) const {
  RejectTag();
  if (node_->kind != Kind::kList || (size && node_->items.size() != *size)) {
    Fail(fmt::format("is {}, wanted {}", Written(), wanted));
  }
  std::vector<Field> items;
  items.reserve(node_->items.size());
  for (std::size_t i = 0; i < node_->items.size(); ++i) {
    items.emplace_back(*node_->items[i], *where_, fmt::format("{} item {}", key_, i + 1));
  }
  return items;
}

std::string Field::Text() const {
  RejectTag();
  if (node_->kind == Kind::kNull) Fail(MisreadAs(PlainMeaning::kNull, ""));
  if (node_->kind != Kind::kScalar) Fail(fmt::format("is {}, wanted text", Written()));
  const PlainMeaning meaning = node_->quoted ? PlainMeaning::kText : MeaningOf(node_->text);
  if (meaning != PlainMeaning::kText) Fail(MisreadAs(meaning, node_->text));
  return node_->text;
}

std::string Field::Name() const {
  std::string name = Text();
  CheckName(At(), name);
  return name;
}

std::vector<std::string> Field::Names() const {
  std::vector<std::string> names;
  for (const Field& item : Items("a list of names")) names.push_back(item.Name());
  return names;
}

const std::string& Field::Plain(const std::string& wanted) const {
  RejectTag();
  if (node_->kind == Kind::kScalar && !node_->quoted) return node_->text;
  Fail(fmt::format("is {}, wanted {}{}", Written(), wanted,
                   node_->quoted ? "; remove the quotes" : ""));
}

template <typename Number>
Number Field::Convert(NumberOutcome (*read)(std::string_view, Number*),
                      const std::string& wanted) const {
  Number value{};
  const NumberOutcome outcome = read(Plain(wanted), &value);
  if (outcome == NumberOutcome::kRead) return value;
  Fail(outcome == NumberOutcome::kTooLarge
           ? fmt::format("is {}, which 64 bits cannot hold; wanted {}", Written(), wanted)
           : fmt::format("is {}, wanted {}", Written(), wanted));
}

double Field::Real() const { return Convert<double>(ReadReal, "a finite decimal number"); }

double Field::Moment() const {
  const std::string wanted = "a time in seconds, or .inf";
  const std::string text = base::ToLower(Plain(wanted).substr(0, 6));
  if (text == ".inf" || text == "+.inf") return temporal::kForever;
  if (text == "-.inf") return -temporal::kForever;
  return Convert<double>(ReadReal, wanted);
}

std::int64_t Field::Integer() const {
  return Convert<std::int64_t>(ReadInteger, "a whole decimal number");
}

bool Field::Truth() const {
  const std::optional<bool> truth = ReadTruth(Plain("true or false"));
  if (!truth) Fail(fmt::format("is {}, wanted true or false", Written()));
  return *truth;
}

Fields::Fields(const YamlNode& root, std::string where, const std::vector<std::string>& known)
    : root_(root), where_(std::move(where)) {
  if (root.kind != Kind::kMap) {
    throw base::ConfigError(fmt::format("{}: {} is no map; wanted the keys {}", At(), root.tag,
                                        base::Join(known, ", ")));
  }
  for (std::size_t i = 0; i < root.items.size(); i += 2) CheckKey(i, known);
}

void Fields::CheckKey(std::size_t at, const std::vector<std::string>& known) const {
  const YamlNode& key = *root_.items[at];
  const std::string where = fmt::format("{}, line {}", where_, key.line);
  if (key.kind != Kind::kScalar || std::count(known.begin(), known.end(), key.text) == 0) {
    throw base::ConfigError(where + ": " + base::UnknownName("key", Shown(key.text), known));
  }
  for (std::size_t i = 0; i < at; i += 2) {
    if (root_.items[i]->text != key.text) continue;
    throw base::ConfigError(fmt::format("{}: key {} stands twice, in line {} already; keep one",
                                        where, key.text, root_.items[i]->line));
  }
}

std::optional<Field> Fields::Find(const std::string& key) const {
  for (std::size_t i = 0; i < root_.items.size(); i += 2) {
    if (root_.items[i]->text == key) return Field(*root_.items[i + 1], where_, key);
  }
  return std::nullopt;
}

Field Fields::Require(const std::string& key, const std::string& advice) const {
  if (const std::optional<Field> field = Find(key)) return *field;
  throw base::ConfigError(fmt::format("{}: key {} is missing; {}", At(), key, advice));
}

std::string Fields::At() const { return fmt::format("{}, line {}", where_, root_.line); }

}  // namespace hires::knowledge
