#include "knowledge/yaml/fluent_yaml_tree.h"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <sstream>
#include <unordered_map>

#include "hires/base/error.h"
#include "knowledge/fluents/store_check.h"
#include "knowledge/yaml/fluent_yaml_text.h"

namespace hires::knowledge {
namespace {

constexpr std::size_t kMaxNesting = 100;
constexpr std::size_t kMaxValues = 100'000;         // of a document
constexpr std::size_t kMaxAliasValues = 1'000'000;  // of a stream
constexpr std::size_t kMaxAliasBytes = 64u << 20;   // of a stream

using Kind = YamlNode::Kind;

/// What aliases have unfolded to so far.
struct AliasBudget {
  std::size_t values{0};
  std::size_t bytes{0};
};

/// Builds the tree of one document out of the parser's events, counting before it builds.
class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(const std::string& source, int document, int first_line, AliasBudget* aliases)
      : source_(source), document_(document), first_line_(first_line), aliases_(*aliases) {}

  std::shared_ptr<const YamlNode> root() const { return root_; }

  [[noreturn]] void Fail(const YAML::Mark& mark, const std::string& what) const {
    const std::string key = Key();
    throw base::ConfigError(fmt::format("{}: document {}, line {}{}: {}", source_, document_,
                                        LineOf(mark), key.empty() ? "" : ", " + key, what));
  }

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (root_) Fail(mark, "the document goes on after its end; begin another one with '---'");
  }
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const std::shared_ptr<YamlNode> node = Make(mark, Kind::kNull, "?");
    // The parser marks what comes after it, perhaps lines below.
    if (!open_.empty() && !open_.back().node->items.empty()) {
      node->line = std::min(node->line, open_.back().node->items.back()->line);
    }
    Close(node, anchor);
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    if (value.size() > kMaxValueBytes) {
      Fail(mark, fmt::format("has a value of {} bytes, at most {} are read; store a path to it",
                             value.size(), kMaxValueBytes));
    }
    const std::shared_ptr<YamlNode> node = Make(mark, Kind::kScalar, tag);
    node->text = value;
    node->num_bytes = value.size();
    Close(node, anchor);
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto named = anchors_.find(anchor);
    if (named == anchors_.end()) {
      Fail(mark, "an alias stands inside of what it names; write the value out");
    }
    const YamlNode& node = *named->second;
    Spend(mark, node);
    CountValues(mark, node.num_values);
    CheckDepth(mark, node.depth);
    Append(named->second);
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value /*style*/) override {
    Open(Make(mark, Kind::kList, tag), anchor);
  }
  void OnSequenceEnd() override { CloseInnermost(); }

  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value /*style*/) override {
    Open(Make(mark, Kind::kMap, tag), anchor);
  }
  void OnMapEnd() override { CloseInnermost(); }

 private:
  struct Collection {
    std::shared_ptr<YamlNode> node;
    YAML::anchor_t anchor;
  };

  int LineOf(const YAML::Mark& mark) const { return first_line_ + std::max(mark.line, 0); }

  /// Where the next value goes: "Properties item 2 item 3".
  std::string Key() const {
    constexpr std::size_t kShownLevels = 5;
    std::string key;
    for (std::size_t i = 0; i < std::min(open_.size(), kShownLevels); ++i) {
      const YamlNode& node = *open_[i].node;
      if (node.kind == Kind::kList) key += fmt::format(" item {}", node.items.size() + 1);
      if (node.kind == Kind::kMap && node.items.size() % 2 == 1) {
        key += fmt::format(" {}", Shown(node.items.back()->text));
      }
    }
    if (open_.size() > kShownLevels) key += " ...";
    return key.empty() ? key : key.substr(1);
  }

  void CheckDepth(const YAML::Mark& mark, std::size_t more) const {
    if (open_.size() + more <= kMaxNesting) return;
    Fail(mark,
         fmt::format("values are nested more than {} levels deep; flatten them", kMaxNesting));
  }

  void CountValues(const YAML::Mark& mark, std::size_t more) {
    num_values_ += more;
    if (num_values_ <= kMaxValues) return;
    Fail(mark, fmt::format("the document has more than {} values, aliases unfolded; split it",
                           kMaxValues));
  }

  void Spend(const YAML::Mark& mark, const YamlNode& node) {
    aliases_.values += node.num_values;
    aliases_.bytes += node.num_bytes;
    if (aliases_.values <= kMaxAliasValues && aliases_.bytes <= kMaxAliasBytes) return;
    Fail(mark,
         fmt::format("aliases unfold to {} values and {} bytes, at most {} and {} are read; write "
                     "values out and split the file",
                     aliases_.values, aliases_.bytes, kMaxAliasValues, kMaxAliasBytes));
  }

  std::shared_ptr<YamlNode> Make(const YAML::Mark& mark, Kind kind, const std::string& tag) {
    CheckDepth(mark, 1);
    CountValues(mark, 1);
    auto node = std::make_shared<YamlNode>();
    node->kind = kind;
    node->line = LineOf(mark);
    // The parser says "!" for quoted and "?" for plain.
    node->quoted = kind == Kind::kScalar && (tag == "!" || tag == "tag:yaml.org,2002:str");
    if (!node->quoted && tag != "?") node->tag = tag;
    return node;
  }

  void Open(std::shared_ptr<YamlNode> node, YAML::anchor_t anchor) {
    open_.push_back({std::move(node), anchor});
  }

  void CloseInnermost() {
    const Collection closed = std::move(open_.back());
    open_.pop_back();
    Close(closed.node, closed.anchor);
  }

  void Close(const std::shared_ptr<const YamlNode>& node, YAML::anchor_t anchor) {
    if (anchor != YAML::NullAnchor) anchors_[anchor] = node;
    Append(node);
  }

  void Append(const std::shared_ptr<const YamlNode>& node) {
    if (open_.empty()) {
      root_ = node;
      return;
    }
    YamlNode& parent = *open_.back().node;
    parent.items.push_back(node);
    parent.num_values += node->num_values;
    parent.num_bytes += node->num_bytes;
    parent.depth = std::max(parent.depth, node->depth + 1);
  }

  const std::string& source_;
  int document_;
  int first_line_;
  AliasBudget& aliases_;
  std::size_t num_values_{0};
  std::vector<Collection> open_;
  std::unordered_map<YAML::anchor_t, std::shared_ptr<const YamlNode>> anchors_;
  std::shared_ptr<const YamlNode> root_;
};

std::shared_ptr<const YamlNode> Parse(std::string_view text, TreeBuilder builder) {
  std::istringstream stream{std::string(text)};
  try {
    YAML::Parser parser(stream);
    while (parser.HandleNextDocument(builder)) {
    }
  } catch (const YAML::Exception& error) {
    builder.Fail(error.mark, fmt::format("no valid YAML: {}; look at quotes, brackets and "
                                         "indentation there",
                                         error.msg));
  }
  if (!builder.root() || builder.root()->kind == Kind::kNull) {
    builder.Fail(YAML::Mark(),
                 "the document has no content below its tag; write keys or remove it");
  }
  return builder.root();
}

}  // namespace

void VisitDocuments(std::string_view text, const std::string& source,
                    const std::function<void(int document, const YamlNode& root)>& visit) {
  DocumentSplitter splitter(text, source);
  AliasBudget aliases;
  while (const std::optional<DocumentText> document = splitter.Next()) {
    visit(splitter.number(), *Parse(document->text, TreeBuilder(source, splitter.number(),
                                                                document->first_line, &aliases)));
  }
}

}  // namespace hires::knowledge
