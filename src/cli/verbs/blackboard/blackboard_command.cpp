#include "cli/verbs/blackboard/blackboard_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <nlohmann/json.hpp>

#include "cli/outputs.h"
#include "cli/verbs/blackboard/blackboard_text.h"
#include "cli/whole_number.h"
#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/knowledge/blackboard_config.h"
#include "hires/knowledge/episode_diff_report.h"
#include "reports/task/timeline.h"
#include "reports/text/report_json.h"
#include "reports/text/report_table.h"

namespace hires::cli {
namespace {

using knowledge::FluentQuery;

/// The Blackboard in a file, without a node.
class StoreAccess : public BlackboardAccess {
 public:
  StoreAccess(std::string path, std::shared_ptr<const knowledge::Ontology> ontology,
              const knowledge::StoreOptions& options)
      : path_(std::move(path)), store_(path_, std::move(ontology), options) {}

  knowledge::LoadSummary Load(const std::string& text, const std::string& path,
                              std::uint64_t seed) override {
    const knowledge::Assertion by{knowledge::Source::kKnowledge, 0, -temporal::kForever};
    return knowledge::Load(knowledge::ReadKnowledge(text, path), base::Rng(seed), by, &store_);
  }
  knowledge::FluentPage Query(const FluentQuery& query) override { return store_.Query(query); }
  std::vector<knowledge::Episode> Episodes() override { return store_.Episodes(); }
  knowledge::Store::Statistics Stats() override { return store_.Stats(); }
  std::string StorePath() override { return path_; }
  knowledge::EpisodeDiff Compare(const knowledge::Episode& a, const knowledge::Episode& b,
                                 const knowledge::EpisodeDiffOptions& how) override {
    return knowledge::Compare(store_, a, b, how);
  }

 private:
  const std::string path_;
  knowledge::Store store_;
};

std::string BlackboardConfigPath(const BlackboardOptions& options,
                                 const std::string& package_folder) {
  return options.config.empty() ? package_folder + "/config/blackboard.yaml" : options.config;
}

std::shared_ptr<const knowledge::Ontology> LoadOntology(const BlackboardOptions& options,
                                                        const std::string& package_folder) {
  const std::string config = BlackboardConfigPath(options, package_folder);
  return std::make_shared<const knowledge::Ontology>(
      knowledge::Ontology::FromFiles(knowledge::ReadBlackboardConfig(config).ontology));
}

/// `load` writes the store; whatever else is asked reads it.
void CheckBlackboardFiles(const BlackboardOptions& options, const std::string& package_folder) {
  std::vector<VerbFile> outputs{{"--json", options.json, true}, {"--output", options.output}};
  std::vector<VerbFile> inputs{{"knowledge", options.file},
                               {"configuration", BlackboardConfigPath(options, package_folder)}};
  if (*options.load) {
    outputs.push_back({"--store", options.store});
  } else {
    inputs.push_back({"store", options.store});
  }
  CheckOutputs(outputs, inputs);
}

/// Only `load` makes a file, or changes one.
std::unique_ptr<BlackboardAccess> Open(const BlackboardOptions& options,
                                       const std::string& package_folder,
                                       const ConnectBlackboard& connect) {
  if (options.store.empty()) {
    if (connect) return connect();
    throw base::ConfigError("this build has no ROS nodes to ask; add --store FILE");
  }
  knowledge::StoreOptions how;
  how.read_only = !*options.load;
  return std::make_unique<StoreAccess>(options.store, LoadOntology(options, package_folder), how);
}

/// Episodes are named by number or by name.
knowledge::Episode FindEpisode(const std::string& name, BlackboardAccess* blackboard) {
  std::vector<std::string> known;
  for (const knowledge::Episode& episode : blackboard->Episodes()) {
    if (episode.name == name || std::to_string(episode.id) == name) return episode;
    known.push_back(episode.name);
  }
  throw base::ConfigError(base::UnknownName("episode", name, known) +
                          "; `hires blackboard episodes` lists them");
}

FluentQuery QueryOf(const BlackboardOptions& options, BlackboardAccess* blackboard) {
  using Reach = FluentQuery::ConceptFilter::Reach;
  FluentQuery query;
  if (!options.concept_name.empty()) {
    query.concepts.push_back({options.concept_name, options.exact ? Reach::kExact : Reach::kBelow});
  }
  query.instance = options.instance;
  for (const std::string& text : options.properties) {
    query.properties.push_back(ParsePropertyFilter(text));
  }
  if (!options.episode.empty()) {
    query.episode = FindEpisode(options.episode, blackboard).id;
    query.label.reset();
    query.time.kind = FluentQuery::TimeFilter::Kind::kEver;
  }
  if (options.imagined) query.label.reset();
  if (options.ever) query.time.kind = FluentQuery::TimeFilter::Kind::kEver;
  if (options.at) query.time = {FluentQuery::TimeFilter::Kind::kAt, *options.at, {}, {}};
  query.sparql = options.sparql;
  return query;
}

/// All pages, or as many fluents as --limit allows.
std::vector<knowledge::Fluent> Ask(const BlackboardOptions& options, BlackboardAccess* blackboard) {
  FluentQuery query = QueryOf(options, blackboard);
  std::vector<knowledge::Fluent> fluents;
  do {
    query.limit = 1000;
    if (options.limit > 0) query.limit = std::min(query.limit, options.limit - fluents.size());
    knowledge::FluentPage page = blackboard->Query(query);
    std::move(page.fluents.begin(), page.fluents.end(), std::back_inserter(fluents));
    query.cursor = page.next;
  } while (!query.cursor.empty() && (options.limit == 0 || fluents.size() < options.limit));
  return fluents;
}

void Emit(const nlohmann::ordered_json& json, const std::string& table, const std::string& path) {
  if (path == "-") {
    std::cout << json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
    return;
  }
  std::cout << table;
  if (!path.empty()) reports::WriteJson(json, path);
}

int RunLoad(const BlackboardOptions& options, BlackboardAccess* blackboard) {
  const knowledge::LoadSummary summary =
      blackboard->Load(base::ReadTextFile(options.file), options.file, options.seed);
  Emit(ToJson(summary), LoadText(summary), options.json);
  return 0;
}

int RunQuery(const BlackboardOptions& options, BlackboardAccess* blackboard) {
  const std::vector<knowledge::Fluent> fluents = Ask(options, blackboard);
  Emit(ToJson(fluents), FluentsText(fluents), options.json);
  return 0;
}

int RunExport(const BlackboardOptions& options, BlackboardAccess* blackboard) {
  const std::string text = knowledge::WriteFluents(Ask(options, blackboard));
  if (options.output.empty()) {
    std::cout << text;
  } else {
    base::ReplaceTextFile(options.output, text);
  }
  return 0;
}

int RunEpisodes(const BlackboardOptions& options, BlackboardAccess* blackboard) {
  const std::vector<knowledge::Episode> episodes = blackboard->Episodes();
  Emit(ToJson(episodes), EpisodesText(episodes), options.json);
  return 0;
}

int RunDiff(const BlackboardOptions& options, BlackboardAccess* blackboard) {
  knowledge::EpisodeDiffOptions how;
  how.tolerance = options.tolerance;
  how.time_tolerance = options.time_tolerance;
  const knowledge::EpisodeDiff diff = blackboard->Compare(
      FindEpisode(options.first, blackboard), FindEpisode(options.second, blackboard), how);
  Emit(nlohmann::ordered_json::parse(knowledge::ToJson(diff)),
       knowledge::ToTable(diff, options.all), options.json);
  return 0;
}

int RunStats(const BlackboardOptions& options, BlackboardAccess* blackboard) {
  const knowledge::Store::Statistics statistics = blackboard->Stats();
  Emit(ToJson(statistics, blackboard->StorePath()),
       StatisticsText(statistics, blackboard->StorePath()), options.json);
  return 0;
}

void AddJson(CLI::App* verb, BlackboardOptions* o) {
  verb->add_option("--json", o->json,
                   "write the answer to this file as well; -: print nothing else");
}

void AddFilter(CLI::App* verb, BlackboardOptions* o) {
  verb->add_option("--class", o->concept_name, "this concept and what is below it");
  verb->add_flag("--exact", o->exact, "just this concept")->needs("--class");
  verb->add_option("--instance", o->instance, "one instance");
  verb->add_option("--property", o->properties, "role, or role=value; may come several times")
      ->allow_extra_args(false);
  auto* at = verb->add_option("--at", o->at, "[s] what held then; default: what holds now");
  verb->add_flag("--ever", o->ever, "whatever held at any time")->excludes(at);
  verb->add_option("--episode", o->episode, "what was written in it; number or name");
  verb->add_flag("--imagined", o->imagined, "imagined ones, too");
  verb->add_option("--sparql", o->sparql, "select ?instance where {...}");
  verb->add_option("--limit", o->limit, "at most so many; default: all")
      ->check(NumberBetween(1, 2'147'483'647));
}

}  // namespace

FluentQuery::PropertyFilter ParsePropertyFilter(const std::string& text) {
  const std::size_t equals = text.find('=');
  FluentQuery::PropertyFilter filter;
  filter.role = text.substr(0, equals);
  if (filter.role.empty()) {
    throw base::ConfigError(
        fmt::format("--property '{}': no role; wanted role or role=value", text));
  }
  if (equals != std::string::npos) filter.filler = ParseFiller(text.substr(equals + 1));
  return filter;
}

void AddBlackboardVerb(CLI::App* app, BlackboardOptions* o) {
  o->verb = app->add_subcommand("blackboard", "what the robot knows: load, query, export, compare");
  o->verb->require_subcommand(1)->fallthrough();
  o->verb->add_option("--store", o->store, "this file, instead of the running node");
  o->verb->add_option("--config", o->config,
                      "names the ontology for --store; default: config/blackboard.yaml");
  o->load = o->verb->add_subcommand("load", "add what a YAML file says");
  o->load->add_option("file", o->file, "fluents, modifications, topics")->required();
  o->load->add_option("--seed", o->seed, "of the choices that modifications draw")
      ->check(WholeNumber());
  o->query = o->verb->add_subcommand("query", "list fluents");
  o->export_ = o->verb->add_subcommand("export", "fluents as YAML, in the format of load");
  for (CLI::App* verb : {o->query, o->export_}) AddFilter(verb, o);
  o->export_->add_option("--output", o->output, "file; default: standard output");
  o->episodes = o->verb->add_subcommand("episodes", "list episodes");
  o->diff = o->verb->add_subcommand("diff", "what two episodes have in common, and what not");
  o->diff->add_option("first", o->first, "number or name")->required();
  o->diff->add_option("second", o->second, "number or name")->required();
  o->diff->add_option("--tolerance", o->tolerance, "numbers may differ by so much; default: 0")
      ->check(CLI::NonNegativeNumber);
  o->diff->add_option("--time-tolerance", o->time_tolerance, "[s] times may; default: 0")
      ->check(CLI::NonNegativeNumber);
  o->diff->add_flag("--all", o->all, "list also what is the same");
  o->stats = o->verb->add_subcommand("stats", "how much is in the store");
  for (CLI::App* verb : {o->load, o->query, o->episodes, o->diff, o->stats}) AddJson(verb, o);
}

int RunBlackboardVerb(const BlackboardOptions& options, const std::string& package_folder,
                      const ConnectBlackboard& connect) {
  CheckBlackboardFiles(options, package_folder);
  const std::unique_ptr<BlackboardAccess> blackboard = Open(options, package_folder, connect);
  if (*options.load) return RunLoad(options, blackboard.get());
  if (*options.query) return RunQuery(options, blackboard.get());
  if (*options.export_) return RunExport(options, blackboard.get());
  if (*options.episodes) return RunEpisodes(options, blackboard.get());
  if (*options.diff) return RunDiff(options, blackboard.get());
  return RunStats(options, blackboard.get());
}

}  // namespace hires::cli
