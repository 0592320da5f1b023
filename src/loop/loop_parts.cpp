#include "loop/loop_parts.h"

#include <filesystem>

#include "hires/base/param_reader.h"
#include "hires/perception/recogniser_config.h"

namespace hires::loop {
namespace {

using base::Between;
using base::ParamReader;
using imagination::ResolvePath;

/// What a node alone needs is not looked at; the node itself refuses unknown keys.
void ReadMiddleLayer(const std::string& path, LoopConfig* config) {
  ParamReader in = ParamReader::FromFile(path);
  config->runner.time_limit = in.Get("time_limit", Between(0.1, 3600.0));
  config->runner.stale_after = config->scene.sensing.robot_state.stale_after;
  config->runner.stop = control::ReadStopParams(in.Sub("stopping"));
  config->scan = sensing::ReadScanParams(in.Sub("scan"));
}

TrackerParams ReadTracker(const std::string& path) {
  ParamReader in = ParamReader::FromFile(path);
  TrackerParams params;
  params.sweep = control::ReadSweepParams(in.Sub("sweep"));
  params.changes = translation::ReadChangeParams(in.Sub("changes"));
  translation::RefuseConcepts(in);
  params.floor = sensing::ReadFloorWatchParams(in.Sub("floor"));
  params.write_period = in.Get("write_period", Between(0.0, 10.0));
  return params;
}

ImaginationPace ReadPace(ParamReader in) {
  ImaginationPace pace;
  pace.speed = in.Get("speed", Between(0.1, 1e6));
  pace.workers = in.Get("workers", Between(1, 256));
  pace.translation = in.Get("translation", Between(0.0, 10.0));
  return pace;
}

LoopMessages ReadMessages(ParamReader in) {
  LoopMessages messages;
  messages.sensors = ReadMessageParams(in.Sub("sensors"), true);
  messages.looks = ReadMessageParams(in.Sub("looks"), true);
  messages.actions = ReadMessageParams(in.Sub("actions"), false);
  messages.blackboard = ReadMessageParams(in.Sub("blackboard"), false);
  return messages;
}

planning::PlanningKnowledge LoadPlanning(const std::string& domain) {
  planning::PlannerConfig config;
  config.domain = domain;
  return planning::LoadPlanningKnowledge(config);
}

translation::TranslatorContext ContextOf(const imagination::ImaginationSetup& world,
                                         std::shared_ptr<const knowledge::Ontology> ontology) {
  translation::TranslatorContext context = world.translator;
  context.ontology = std::move(ontology);
  return context;
}

void Override(const LoopFiles& files, LoopConfig* config) {
  imagination::OverridePaths(files.world, files.robot, files.objects, {}, &config->scene);
  config->scene.map = files.map;
  config->scene.areas = files.areas;
  if (!files.domain.empty()) {
    config->execution.domain = files.domain;
    config->execution.operators =
        std::filesystem::path(files.domain).replace_extension(".yaml").string();
  }
  if (!files.operators.empty()) config->execution.operators = files.operators;
}

}  // namespace

LoopConfig ReadLoopConfig(const std::string& path, const LoopFiles& files) {
  ParamReader in = ParamReader::FromFile(path);
  const auto file = [&](const char* key) { return ResolvePath(in.GetString(key), path); };
  LoopConfig config;
  config.imagination = imagination::ReadClientConfig(file("imagination_client"));
  config.execution = execution::ReadMonitorConfig(file("execution_monitor"));
  config.scene = imagination::ReadSetupConfig(config.imagination.scene);
  ReadMiddleLayer(file("middle_layer"), &config);
  config.sensors = sim_robot::ReadSimSensorParams(ParamReader::FromFile(file("sim_robot")));
  config.tracker = ReadTracker(file("world_tracker"));
  config.tracker.warm = perception::ReadWarmParams(ParamReader::FromFile(file("heat_reader")));
  config.recogniser = file("recogniser");
  config.truths = file("truths");
  config.pace = ReadPace(in.Sub("imagination"));
  config.planning_time = in.Get("planning_time", Between(0.0, 60.0));
  config.messages = ReadMessages(in.Sub("messages"));
  in.RejectUnknownKeys();
  Override(files, &config);
  return config;
}

LoopSetup::Parts::Parts(const std::string& path, const LoopFiles& files)
    : config(ReadLoopConfig(path, files)),
      world(imagination::LoadImaginationSetup(config.scene)),
      ontology(std::make_shared<const knowledge::Ontology>(
          knowledge::Ontology::FromFiles(config.execution.ontology))),
      context(ContextOf(world, ontology)),
      planning(LoadPlanning(config.execution.domain)),
      operators(planning::LoadOperatorData(config.execution.operators, planning.domain)) {}

LoopSetup::LoopSetup(const std::string& config, const LoopFiles& files)
    : parts_(std::make_unique<const Parts>(config, files)) {}

LoopSetup::~LoopSetup() = default;

const imagination::ImaginationSetup& LoopSetup::world() const { return parts_->world; }

const imagination::ClientConfig& LoopSetup::imagination() const {
  return parts_->config.imagination;
}

const planning::OperatorData& LoopSetup::operators() const { return parts_->operators; }

sim_robot::Truth LoopSetup::Parts::ReadTruth(const std::string& name) const {
  return sim_robot::FindTruth(name, config.truths);
}

sim_robot::SimSensorParams LoopSetup::Parts::SensorsUnder(const sim_robot::Truth& truth) const {
  sim_robot::SimSensorParams sensors = sim_robot::SensorsOf(truth, config.sensors);
  if (!sensors.sees_pictures) return sensors;
  const auto known = perception::ReadRecogniserConfig(config.recogniser, config.scene.objects);
  sensors.eye = std::make_shared<const perception::Recogniser>(known.catalogue, known.params);
  return sensors;
}

sim_robot::Truth LoopSetup::ReadTruth(const std::string& name) const {
  return parts_->ReadTruth(name);
}

}  // namespace hires::loop
