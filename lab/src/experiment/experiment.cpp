#include "lab/src/experiment/experiment.h"

#include <fmt/format.h>

#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>

#include "lab/src/experiment/kinds.h"
#include "lab/src/experiment/stage.h"
#include "hires/base/error.h"

namespace hires::lab {
namespace {

using base::ActionCall;

/// Drives that a kind will ask for: where they start, and what is done there.
using Drive = std::pair<std::string, ActionCall>;

/// One kind at work; what was played lives between the two calls.
class Kind {
 public:
  virtual ~Kind() = default;
  virtual std::vector<Drive> Drives() const = 0;
  virtual bool Play(const base::Crew& crew) = 0;  ///< false when cancelled
  virtual Findings SumUp() const = 0;
};

class Legs : public Kind {
 public:
  Legs(const LegsConfig& legs, const ExperimentConfig& config, std::shared_ptr<const Stage> stage)
      : legs_(legs), config_(config), stage_(std::move(stage)) {}
  std::vector<Drive> Drives() const override {
    std::vector<Drive> drives;
    for (const Goal& goal : config_.goals) {
      drives.emplace_back(goal.name, DriveTo(config_.goals.front().name, legs_.motion_set));
    }
    return drives;
  }
  bool Play(const base::Crew& crew) override {
    auto chains = PlayLegs(legs_, config_, stage_, crew);
    if (chains) chains_ = *std::move(chains);
    return chains.has_value();
  }
  Findings SumUp() const override { return SumUpLegs(config_, *stage_, chains_); }

 private:
  const LegsConfig& legs_;
  const ExperimentConfig& config_;
  std::shared_ptr<const Stage> stage_;
  Chains chains_;
};

class Paired : public Kind {
 public:
  Paired(const PairedConfig& paired, const ExperimentConfig& config,
         std::shared_ptr<const Stage> stage)
      : paired_(paired), config_(config), stage_(std::move(stage)) {}
  std::vector<Drive> Drives() const override {
    std::vector<Drive> drives;
    for (const std::string& set : paired_.motion_sets) {
      drives.emplace_back(paired_.from, DriveTo(paired_.to, set));
    }
    return drives;
  }
  bool Play(const base::Crew& crew) override {
    auto rollouts = PlayPaired(paired_, config_, *stage_, crew);
    if (rollouts) rollouts_ = *std::move(rollouts);
    return rollouts.has_value();
  }
  Findings SumUp() const override { return SumUpPaired(paired_, rollouts_); }

 private:
  const PairedConfig& paired_;
  const ExperimentConfig& config_;
  std::shared_ptr<const Stage> stage_;
  std::vector<Rollouts> rollouts_{2};
};

class ToppleLoop : public Kind {
 public:
  ToppleLoop(const ToppleLoopConfig& loop, const ExperimentConfig& config,
             std::shared_ptr<const Stage> stage, OnExperience on_experience)
      : loop_(loop),
        config_(config),
        stage_(std::move(stage)),
        on_experience_(std::move(on_experience)) {}
  std::vector<Drive> Drives() const override {
    std::vector<Drive> drives;
    for (const std::string& set : loop_.motion_sets) {
      for (const std::string& goal : loop_.route) {
        drives.emplace_back(goal, DriveTo(loop_.route.front(), set));
      }
    }
    return drives;
  }
  bool Play(const base::Crew& crew) override {
    auto chains = PlayToppleLoop(loop_, config_, stage_, crew, on_experience_);
    if (chains) by_set_ = *std::move(chains);
    return chains.has_value();
  }
  Findings SumUp() const override { return SumUpToppleLoop(loop_, config_.seed, by_set_); }

 private:
  const ToppleLoopConfig& loop_;
  const ExperimentConfig& config_;
  std::shared_ptr<const Stage> stage_;
  OnExperience on_experience_;
  std::vector<Chains> by_set_{2};
};

class Durations : public Kind {
 public:
  Durations(const DurationsConfig& durations, const ExperimentConfig& config,
            std::shared_ptr<const Stage> stage)
      : durations_(durations),
        config_(config),
        stage_(std::move(stage)),
        plays_(NothingPlayed(durations)) {}
  std::vector<Drive> Drives() const override {
    std::vector<Drive> drives;
    for (const DurationsConfig::Row& row : durations_.rows) {
      drives.emplace_back(StartOf(durations_, row), ActionOf(row));
    }
    return drives;
  }
  bool Play(const base::Crew& crew) override {
    auto plays = PlayDurations(durations_, config_, *stage_, crew);
    if (plays) plays_ = *std::move(plays);
    return plays.has_value();
  }
  Findings SumUp() const override { return SumUpDurations(durations_, plays_); }

 private:
  const DurationsConfig& durations_;
  const ExperimentConfig& config_;
  std::shared_ptr<const Stage> stage_;
  DurationPlays plays_;
};

class Braking : public Kind {
 public:
  Braking(const BrakingConfig& braking, const ExperimentConfig& config,
          std::shared_ptr<const Stage> stage)
      : braking_(braking),
        config_(config),
        stage_(std::move(stage)),
        plays_(BrakingCells(braking, *stage_)) {}
  std::vector<Drive> Drives() const override { return {}; }
  bool Play(const base::Crew& crew) override {
    auto plays = PlayBraking(braking_, config_, *stage_, crew);
    if (plays) plays_ = *std::move(plays);
    return plays.has_value();
  }
  Findings SumUp() const override { return SumUpBraking(braking_, plays_); }

 private:
  const BrakingConfig& braking_;
  const ExperimentConfig& config_;
  std::shared_ptr<const Stage> stage_;
  std::vector<BrakingPlay> plays_;
};

std::unique_ptr<Kind> MakeKind(const ExperimentConfig& config, std::shared_ptr<const Stage> stage,
                               const OnExperience& on_experience) {
  if (const auto* legs = std::get_if<LegsConfig>(&config.kind)) {
    return std::make_unique<Legs>(*legs, config, std::move(stage));
  }
  if (const auto* paired = std::get_if<PairedConfig>(&config.kind)) {
    return std::make_unique<Paired>(*paired, config, std::move(stage));
  }
  if (const auto* loop = std::get_if<ToppleLoopConfig>(&config.kind)) {
    return std::make_unique<ToppleLoop>(*loop, config, std::move(stage), on_experience);
  }
  if (const auto* braking = std::get_if<BrakingConfig>(&config.kind)) {
    return std::make_unique<Braking>(*braking, config, std::move(stage));
  }
  return std::make_unique<Durations>(std::get<DurationsConfig>(config.kind), config,
                                     std::move(stage));
}

/// What would go wrong after minutes goes wrong now.
void CheckBeforePlaying(const ExperimentConfig& config, const Stage& stage, const Kind& kind) {
  CheckExpectations(config.expect, kind.SumUp().measures);
  for (const auto& [start, action] : kind.Drives()) {
    imagination::CheckSetup(SetupAt(stage, start, config.seed), action);
  }
}

ExperimentReport Unplayed(const ExperimentConfig& config, const Stage& stage) {
  ExperimentReport report;
  report.name = config.name;
  report.kind = KindName(config);
  report.seed = config.seed;
  report.experiment_hash = config.hash;
  report.params_hash = stage.params_hash;
  return report;
}

std::optional<ExperimentReport> Run(const ExperimentConfig& config, const base::Crew& crew,
                                    const OnExperience& on_experience) {
  const auto begin = std::chrono::steady_clock::now();
  const auto stage = std::make_shared<const Stage>(MakeStage(config));
  const std::unique_ptr<Kind> kind = MakeKind(config, stage, on_experience);
  CheckBeforePlaying(config, *stage, *kind);
  if (!kind->Play(crew)) return std::nullopt;
  ExperimentReport report = Unplayed(config, *stage);
  report.findings = kind->SumUp();
  report.checks = CheckExpectations(config.expect, report.findings.measures);
  report.wall_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return report;
}

}  // namespace

std::optional<ExperimentReport> RunExperiment(const ExperimentConfig& config,
                                              const base::Crew& crew,
                                              const OnExperience& on_experience) {
  try {
    return Run(config, crew, on_experience);
  } catch (const base::ConfigError& error) {
    throw base::ConfigError(fmt::format("experiment '{}': {}", config.name, error.what()));
  }
}

ExperimentReport UnplayedReport(const ExperimentConfig& config) {
  return Unplayed(config, MakeStage(config));
}

}  // namespace hires::lab
