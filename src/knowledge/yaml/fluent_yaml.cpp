#include "hires/knowledge/fluent_yaml.h"

#include <fmt/format.h>

#include <map>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "knowledge/yaml/fluent_yaml_documents.h"
#include "knowledge/yaml/fluent_yaml_field.h"
#include "knowledge/yaml/fluent_yaml_modification.h"
#include "knowledge/yaml/fluent_yaml_text.h"
#include "knowledge/yaml/fluent_yaml_tree.h"

namespace hires::knowledge {
namespace {

const std::vector<std::string> kTags = {"!Fluent", "!FluentPoseModification", "!DemandTopic",
                                        "!Scenario"};

/// Puts documents into a KnowledgeFile, and remembers where what stood.
class FileReader {
 public:
  explicit FileReader(const std::string& source) : source_(source) {}

  void Read(int document, const YamlNode& root) {
    const std::string where = fmt::format("{}: document {}", source_, document);
    if (root.tag == kTags[0]) {
      file_.fluents.push_back(ReadFluent(Fields(root, where, kFluentKeys)));
      file_.places.push_back(fmt::format("document {}, line {}", document, root.line));
    } else if (root.tag == kTags[1]) {
      file_.modifications.push_back(ReadModification(Fields(root, where, kModificationKeys)));
    } else if (root.tag == kTags[2]) {
      AddTopic(Fields(root, where, kTopicKeys));
    } else if (root.tag == kTags[3]) {
      file_.scenarios.push_back(ReadScenarioSetting(Fields(root, where, kScenarioKeys)));
    } else {
      FailTag(where, root);
    }
  }

  KnowledgeFile Finish() {
    CheckModifications(file_.modifications,
                       [&](std::size_t i) { return file_.modifications[i].where; });
    file_.source = source_;
    return std::move(file_);
  }

 private:
  void AddTopic(const Fields& fields) {
    DemandTopic topic = ReadTopic(fields);
    const auto [first, is_new] = topic_at_.emplace(topic.name, fields.At());
    if (!is_new) {
      throw base::ConfigError(
          fmt::format("{}: topic '{}' is demanded twice (already: {}); rename "
                      "one",
                      fields.At(), topic.name, first->second));
    }
    file_.topics.push_back(std::move(topic));
  }

  [[noreturn]] static void FailTag(const std::string& where, const YamlNode& root) {
    const std::string at = fmt::format("{}, line {}: ", where, root.line);
    if (root.tag.empty()) {
      throw base::ConfigError(at + "the document has no tag; begin it with one of " +
                              base::Join(kTags, ", "));
    }
    throw base::ConfigError(at + base::UnknownName("tag", Shown(root.tag), kTags));
  }

  const std::string& source_;
  KnowledgeFile file_;
  std::map<std::string, std::string> topic_at_;  // by name
};

}  // namespace

KnowledgeFile ReadKnowledge(std::string_view text, const std::string& source) {
  FileReader reader(source);
  VisitDocuments(text, source,
                 [&](int document, const YamlNode& root) { reader.Read(document, root); });
  return reader.Finish();
}

KnowledgeFile LoadKnowledge(const std::string& path) {
  return ReadKnowledge(base::ReadTextFile(path), path);
}

}  // namespace hires::knowledge
