#include "nodes/blackboard/blackboard_node.h"

#include <fmt/format.h>
#include <ros/package.h>
#include <ros/time.h>

#include <algorithm>
#include <cmath>

#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/base/process.h"
#include "hires/base/short_text.h"
#include "hires/base/text.h"
#include "hires/knowledge/fluent_yaml.h"
#include "hires/knowledge/loading.h"
#include "hires/ros/knowledge/blackboard_messages.h"
#include "hires/ros/names/topic_names.h"
#include "hires/ros/node/private_params.h"

namespace hires_ros {
namespace {

namespace knowledge = hires::knowledge;
using hires::base::ConfigError;
using hires::base::Log;
using hires::base::LogLevel;
using knowledge::Change;
using knowledge::Store;

constexpr std::size_t kDefaultChanges = 1000;  // of changes_since
constexpr std::size_t kMostChanges = 100'000;
constexpr std::uint32_t kDefaultExport = 10'000;  // fluents
constexpr std::uint32_t kMostFluents = 1'000'000;
constexpr double kDiagnosePeriod =
    0.25;  // [s] at which it is asked whether to; once a second it does

void LoadAtFirst(const std::vector<std::string>& paths, Store* store) {
  if (store->Stats().fluents > 0) return;
  for (const std::string& path : paths) {
    const knowledge::LoadSummary summary =
        knowledge::Load(knowledge::LoadKnowledge(path), hires::base::Rng(1),
                        {knowledge::Source::kKnowledge, 0, -hires::temporal::kForever}, store);
    std::size_t total = 0;
    for (const auto& [name, count] : summary.concepts) total += count;
    Log(LogLevel::kInfo, fmt::format("loaded={} fluents={}", path, total));
  }
}

std::vector<knowledge::DemandTopic> TopicsOf(const std::vector<std::string>& paths) {
  std::vector<knowledge::DemandTopic> topics;
  for (const std::string& path : paths) {
    const knowledge::KnowledgeFile file = knowledge::LoadKnowledge(path);
    topics.insert(topics.end(), file.topics.begin(), file.topics.end());
  }
  return topics;
}

hires::BlackboardError MakeError(std::uint8_t code, const std::string& message) {
  hires::BlackboardError error;
  error.code = code;
  error.message = hires::base::Shortened(message);
  return error;
}

knowledge::KnowledgeFile FileOf(const hires::LoadKnowledge::Request& asked) {
  if (asked.path.empty() && asked.text.empty()) {
    throw ConfigError("path and text are both empty; name a YAML file, or send its text");
  }
  if (asked.text.empty()) return knowledge::LoadKnowledge(asked.path);
  return knowledge::ReadKnowledge(asked.text, asked.path.empty() ? "text" : asked.path);
}

void Fill(const knowledge::LoadSummary& summary, hires::LoadKnowledge::Response* answer) {
  for (const auto& [name, count] : summary.concepts) {
    answer->concepts.push_back(name);
    answer->counts.push_back(static_cast<std::uint32_t>(count));
  }
  answer->known = static_cast<std::uint32_t>(summary.known);
  answer->modifications = static_cast<std::uint32_t>(summary.modifications);
  answer->topics = summary.topics;
}

Store OpenStore(const knowledge::BlackboardConfig& config,
                const std::shared_ptr<const knowledge::Ontology>& ontology) {
  knowledge::MakeFolderOf(config.store);
  const auto gone = knowledge::PruneOldStores(config.store, config.old_runs,
                                              std::filesystem::file_time_type::clock::now());
  for (const std::string& path : gone) Log(LogLevel::kInfo, "removed_old_store=" + path);
  Store store(config.store, ontology, config.options);
  LoadAtFirst(config.knowledge, &store);
  return store;
}

std::vector<Change> ChangesSince(const Store& store, std::uint64_t sequence, std::size_t limit) {
  if (sequence > store.last_sequence()) {
    throw ConfigError(fmt::format(
        "sequence is {}, wanted at most {}, the last change: it is of another store; ask from 0",
        sequence, store.last_sequence()));
  }
  return store.ChangesSince(sequence, limit);
}

/// All changes of one answer as one message.
hires::FluentChanges MessageOf(const std::vector<Change>& changes, std::uint64_t previous) {
  hires::FluentChanges message;
  message.first_sequence = changes.front().sequence;
  message.last_sequence = changes.back().sequence;
  message.previous = previous;
  for (const Change& change : changes) message.changes.push_back(ToMessage(change));
  return message;
}

knowledge::FluentQuery QueryOf(const hires::FluentQuery& asked) {
  if (asked.limit > kMostFluents) {
    throw ConfigError(fmt::format("query.limit is {}, wanted at most {}; ask for pages",
                                  asked.limit, kMostFluents));
  }
  return FromMessage(asked);
}

}  // namespace

knowledge::BlackboardConfig LoadBlackboardParams() {
  RejectUnknownPrivate({"config", "store", "durability", "knowledge", "topics", "threads"});
  const auto path = PrivateText("config");
  knowledge::BlackboardConfig config = knowledge::ReadBlackboardConfig(
      path && !path->empty() ? *path : ros::package::getPath("hires") + "/config/blackboard.yaml");
  const auto store = PrivateText("store");
  if (store && !store->empty()) config.store = knowledge::ExpandHome(*store);
  if (const auto word = PrivateWord("durability", hires::base::OneOf({"process", "power"}))) {
    config.options.durability =
        *word == "power" ? knowledge::Durability::kPower : knowledge::Durability::kProcess;
  }
  if (const auto files = PrivateWords("knowledge"); files && !files->empty()) {
    config.knowledge = *files;
  }
  if (const auto files = PrivateWords("topics"); files && !files->empty()) config.topics = *files;
  Override("threads", PrivateInt("threads"), hires::base::Between(1, 256), &config.threads);
  return config;
}

BlackboardNode::BlackboardNode(const knowledge::BlackboardConfig& config,
                               std::shared_ptr<const knowledge::Ontology> ontology,
                               ros::NodeHandle* nh)
    : config_(config), ontology_(std::move(ontology)), readers_(config.store, ontology_) {
  Store store = OpenStore(config_, ontology_);
  const Store::Statistics statistics = store.Stats();
  changes_before_ = statistics.changes;
  diagnosed_at_ = hires::base::SteadyNow();
  Log(LogLevel::kInfo, fmt::format("store={} fluents={} changes={}", config_.store,
                                   statistics.fluents, statistics.changes));
  StartWriting(std::move(store), nh);
  ServeAll();
  updater_.setHardwareID("blackboard");
  updater_.add("store", this, &BlackboardNode::Diagnose);
  timer_ = nh->createWallTimer(ros::WallDuration(kDiagnosePeriod),
                               boost::function<void(const ros::WallTimerEvent&)>(
                                   [this](const ros::WallTimerEvent&) { updater_.update(); }));
}

/// From here on the store belongs to the writer's thread, and so do the topics.
void BlackboardNode::StartWriting(Store store, ros::NodeHandle* nh) {
  topics_ =
      std::make_unique<BlackboardTopics>(config_, ontology_, store.last_sequence(), nh,
                                         [this](const std::function<void(const Store&)>& task) {
                                           ErrorOf([&] {
                                             writer_->RunAlways([&](Store* owned) {
                                               task(*owned);
                                               return std::vector<Change>();
                                             });
                                           });
                                         });
  writer_ = std::make_unique<hires::knowledge::BlackboardWriter>(
      std::move(store),
      hires::knowledge::BlackboardWriter::Limits{config_.max_waiting, config_.max_group},
      [] { return ros::Time::now().toSec(); },
      [this](const Store& owned, const std::vector<Change>& changes) {
        topics_->Publish(changes, owned);
      });
  const std::vector<knowledge::DemandTopic> topics = TopicsOf(config_.topics);
  writer_->RunAlways([&](Store* owned) {
    for (const knowledge::DemandTopic& topic : topics) topics_->Open(topic, *owned);
    return std::vector<Change>();
  });
}

void BlackboardNode::ServeAll() {
  Serve<hires::WriteFluents>("add", &BlackboardNode::OnAdd);
  Serve<hires::WriteFluents>("update", &BlackboardNode::OnUpdate);
  Serve<hires::RemoveFluents>("remove", &BlackboardNode::OnRemove);
  Serve<hires::QueryFluents>("query", &BlackboardNode::OnQuery);
  Serve<hires::LoadKnowledge>("load", &BlackboardNode::OnLoad);
  Serve<hires::ExportFluents>("export", &BlackboardNode::OnExport);
  Serve<hires::StartEpisode>("start_episode", &BlackboardNode::OnStartEpisode);
  Serve<hires::FinishEpisode>("finish_episode", &BlackboardNode::OnFinishEpisode);
  Serve<hires::ListEpisodes>("list_episodes", &BlackboardNode::OnListEpisodes);
  Serve<hires::ChangesSince>("changes_since", &BlackboardNode::OnChangesSince);
  Serve<hires::Demand>("demand", &BlackboardNode::OnDemand);
  Serve<hires::BlackboardStatistics>("statistics", &BlackboardNode::OnStatistics);
}

template <typename Service>
void BlackboardNode::Serve(const char* name,
                           void (BlackboardNode::*answer)(const typename Service::Request&,
                                                          typename Service::Response*)) {
  using Request = typename Service::Request;
  using Response = typename Service::Response;
  ros::NodeHandle nh;
  servers_.push_back(nh.advertiseService<Request, Response>(
      kBlackboard + std::string("/") + name, [this, answer](Request& asked, Response& given) {
        const hires::BlackboardError error = ErrorOf([&] { (this->*answer)(asked, &given); });
        if (error.code != hires::BlackboardError::NONE) given = Response();
        given.error = error;
        return true;
      }));
}

hires::BlackboardError BlackboardNode::ErrorOf(const std::function<void()>& call) {
  hires::BlackboardError error;
  try {
    call();
    return error;
  } catch (const ConfigError& refused) {
    error = MakeError(hires::BlackboardError::REFUSED, refused.what());
  } catch (const hires::knowledge::Unavailable& unavailable) {
    const bool is_busy = unavailable.reason == hires::knowledge::Unavailable::Reason::kBusy;
    error = MakeError(is_busy ? hires::BlackboardError::BUSY : hires::BlackboardError::ENDING,
                      unavailable.what());
  } catch (const std::exception& defect) {
    error = MakeError(hires::BlackboardError::INTERNAL, defect.what());
    Log(LogLevel::kError, "internal: " + error.message);
  }
  ++num_refused_;
  const std::lock_guard<std::mutex> lock(error_mutex_);
  last_error_ = error.message;
  return error;
}

/// What is kept in memory has one owner, which must read itself.
template <typename Call>
auto BlackboardNode::Read(const Call& call) {
  if (config_.store != ":memory:") return readers_.Read(call);
  decltype(call(std::declval<const Store&>())) result;
  writer_->Run([&](Store* store) {
    result = call(static_cast<const Store&>(*store));
    return std::vector<Change>();
  });
  return result;
}

double BlackboardNode::TimeOr(double time) const { return time == 0.0 ? writer_->Now() : time; }

void BlackboardNode::OnAdd(const hires::WriteFluents::Request& asked,
                           hires::WriteFluents::Response* answer) {
  const hires::knowledge::Written written =
      writer_->Add(FromMessages(asked.fluents), FromMessage(asked.by));
  answer->changed = static_cast<std::uint32_t>(written.num_changed);
  answer->sequence = written.sequence;
}

void BlackboardNode::OnUpdate(const hires::WriteFluents::Request& asked,
                              hires::WriteFluents::Response* answer) {
  const hires::knowledge::Written written =
      writer_->Update(FromMessages(asked.fluents), FromMessage(asked.by));
  answer->changed = static_cast<std::uint32_t>(written.num_changed);
  answer->sequence = written.sequence;
}

void BlackboardNode::OnRemove(const hires::RemoveFluents::Request& asked,
                              hires::RemoveFluents::Response* answer) {
  const hires::knowledge::Written written = writer_->Remove(asked.instances, FromMessage(asked.by));
  answer->changed = static_cast<std::uint32_t>(written.num_changed);
  answer->sequence = written.sequence;
}

void BlackboardNode::OnQuery(const hires::QueryFluents::Request& asked,
                             hires::QueryFluents::Response* answer) {
  const knowledge::FluentQuery query = QueryOf(asked.query);
  const knowledge::FluentPage page = Read([&](const Store& store) { return store.Query(query); });
  answer->fluents = ToMessages(page.fluents);
  answer->next = page.next;
  answer->sequence = page.sequence;
}

void BlackboardNode::OnLoad(const hires::LoadKnowledge::Request& asked,
                            hires::LoadKnowledge::Response* answer) {
  const knowledge::KnowledgeFile file = FileOf(asked);
  knowledge::Assertion by = FromMessage(asked.by);
  by.time = TimeOr(by.time);
  writer_->Run([&](Store* store) {
    topics_->Check(file.topics);
    std::vector<Change> changes;
    const knowledge::LoadSummary summary =
        knowledge::Load(file, hires::base::Rng(asked.seed), by, store, &changes);
    for (const knowledge::DemandTopic& topic : file.topics) topics_->Open(topic, *store);
    Fill(summary, answer);
    answer->sequence = store->last_sequence();
    return changes;
  });
}

void BlackboardNode::OnExport(const hires::ExportFluents::Request& asked,
                              hires::ExportFluents::Response* answer) {
  knowledge::FluentQuery query = QueryOf(asked.query);
  if (asked.query.limit == 0) query.limit = kDefaultExport;
  const knowledge::FluentPage page = Read([&](const Store& store) { return store.Query(query); });
  answer->text = knowledge::WriteFluents(page.fluents);
  answer->fluents = static_cast<std::uint32_t>(page.fluents.size());
  answer->next = page.next;
  answer->sequence = page.sequence;
}

void BlackboardNode::OnStartEpisode(const hires::StartEpisode::Request& asked,
                                    hires::StartEpisode::Response* answer) {
  const auto label =
      asked.imagined ? knowledge::Episode::Label::kImagined : knowledge::Episode::Label::kReal;
  writer_->Run([&](Store* store) {
    answer->episode =
        ToMessage(store->StartEpisode(asked.task, label, asked.parent, TimeOr(asked.time)));
    return std::vector<Change>();
  });
}

void BlackboardNode::OnFinishEpisode(const hires::FinishEpisode::Request& asked,
                                     hires::FinishEpisode::Response* answer) {
  writer_->Run([&](Store* store) {
    answer->episode = ToMessage(store->FinishEpisode(asked.id, asked.outcome, TimeOr(asked.time)));
    return std::vector<Change>();
  });
}

void BlackboardNode::OnListEpisodes(const hires::ListEpisodes::Request& asked,
                                    hires::ListEpisodes::Response* answer) {
  const auto is_asked = [&](std::int64_t id) {
    return asked.ids.empty() || std::count(asked.ids.begin(), asked.ids.end(), id) > 0;
  };
  for (const knowledge::Episode& episode :
       Read([](const Store& store) { return store.Episodes(); })) {
    if (is_asked(episode.id)) answer->episodes.push_back(ToMessage(episode));
  }
}

void BlackboardNode::OnChangesSince(const hires::ChangesSince::Request& asked,
                                    hires::ChangesSince::Response* answer) {
  if (asked.limit > kMostChanges) {
    throw ConfigError(fmt::format("limit is {}, wanted at most {}", asked.limit, kMostChanges));
  }
  const std::size_t limit = asked.limit == 0 ? kDefaultChanges : asked.limit;
  if (!asked.topic.empty()) {
    writer_->Run([&](Store* store) {
      BlackboardTopics::Missed missed = topics_->Since(asked.topic, asked.sequence, limit, *store);
      answer->messages = std::move(missed.messages);
      answer->more = missed.more;
      return std::vector<Change>();
    });
    return;
  }
  std::vector<Change> changes =
      Read([&](const Store& store) { return ChangesSince(store, asked.sequence, limit + 1); });
  answer->more = changes.size() > limit;
  if (answer->more) changes.pop_back();
  if (!changes.empty()) answer->messages.push_back(MessageOf(changes, asked.sequence));
}

void BlackboardNode::OnDemand(const hires::Demand::Request& asked,
                              hires::Demand::Response* answer) {
  const knowledge::DemandTopic topic = FromMessage(asked);
  writer_->Run([&](Store* store) {
    answer->topic = topics_->Open(topic, *store);
    return std::vector<Change>();
  });
}

void BlackboardNode::OnStatistics(const hires::BlackboardStatistics::Request& asked,
                                  hires::BlackboardStatistics::Response* answer) {
  const Store::Statistics statistics = Read([](const Store& store) { return store.Stats(); });
  answer->store = config_.store;
  answer->fluents = statistics.fluents;
  answer->instances = statistics.instances;
  answer->changes = statistics.changes;
  answer->episodes = statistics.episodes;
  answer->bytes = statistics.bytes;
  answer->schema = statistics.schema;
  answer->ontology = ontology_->hash();
  writer_->Run([&](Store*) {
    answer->topics = topics_->names();
    return std::vector<Change>();
  });
}

void BlackboardNode::Diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using Level = diagnostic_msgs::DiagnosticStatus;
  Store::Statistics statistics;
  const hires::BlackboardError error =
      ErrorOf([&] { statistics = Read([](const Store& store) { return store.Stats(); }); });
  if (error.code != hires::BlackboardError::NONE) {
    status.summary(Level::ERROR, error.message);
    return;
  }
  const double now = hires::base::SteadyNow();
  const double rate = static_cast<double>(statistics.changes - changes_before_) /
                      std::max(now - diagnosed_at_, 1e-3);
  changes_before_ = statistics.changes;
  diagnosed_at_ = now;
  const int waiting = writer_->num_waiting();
  status.summary(2 * waiting > config_.max_waiting ? Level::WARN : Level::OK,
                 fmt::format("{} fluents, {:.0f} changes/s, {} requests wait", statistics.fluents,
                             rate, waiting));
  status.add("fluents", statistics.fluents);
  status.add("changes_per_second", rate);
  status.add("queue", waiting);
  status.add("bytes", statistics.bytes);
  status.add("file", config_.store);
  status.add("refused", num_refused_.load());
  const std::lock_guard<std::mutex> lock(error_mutex_);
  status.add("last_error", last_error_);
}

}  // namespace hires_ros
