#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "cli/verbs/imagine/imagine_start.h"
#include "hires/base/action.h"
#include "hires/imagination/imagination_setup.h"
#include "hires/imagination/report.h"
#include "hires/imagination/rollout_recording.h"
#include "hires/imagination/scheduler.h"
#include "hires/imagination/validated.h"

namespace hires::cli {

/// What `hires imagine` was asked.
struct ImagineQuery {
  base::ActionTemplate action;
  ImagineStart start;
  std::uint64_t seed{1};
  imagination::SchedulerParams scheduler;
  imagination::SetupConfig setup;
  imagination::Validated validated;
  bool own_scene{false};        ///< files were named that the workers may not have
  bool own_uncertainty{false};  ///< an uncertainty was named that the workers may not have
  int threads{1};
};

/// Answers a query through running nodes instead of in this process.
using ImagineRemotely = std::function<imagination::Report(
    const ImagineQuery&, const imagination::OnInterim&, const std::function<bool()>& cancelled)>;

/// Makes what saves a rollout of this setup as a bag.
using MakeRolloutBag = std::function<std::unique_ptr<imagination::RolloutSaver>(
    const std::string& path, const imagination::RolloutSetup& setup)>;

/// What `hires imagine` can do beyond this process; all may be empty.
struct ImagineBackends {
  ImagineRemotely imagine_remotely;
  MakeRolloutBag make_rollout_bag;
};

/// Exit code of the program (cli/exit_code.h).
int ExitCodeOf(const imagination::Report& report);

}  // namespace hires::cli
