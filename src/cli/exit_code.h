#pragma once

namespace hires::cli {

/// Exit codes of the programs.
enum ExitCode {
  kExitRecommended = 0,  ///< done; for imagine: there is a recommendation
  kExitBadInput = 1,     ///< the message says what is wrong
  kExitAllFailed = 2,    ///< every alternative fails
  kExitNoWorker = 3,     ///< there was no worker to ask
  kExitDoubtful = 3,     ///< for map: it is made, and much speaks against it
  kExitDeadline = 4,     ///< nothing finished by the deadline
  kExitUndecided = 5,    ///< too few rollouts to tell whether an alternative is good enough
  kExitCancelled = 130   ///< interrupted
};

}  // namespace hires::cli
